#!/usr/bin/env python3
"""The material libraries of an OBJ and their maps go with an output in another folder (--resources)."""

import json
import os

from harness import CUBE, IO, LIMIT, PNG, case, check, equal, gltf_json, lattice, main
from messages import anything, no_line, one_line

UP = lattice(moves=[{"by": [0, 0, 1]}])
MTL = "# materials\n\nnewmtl red\nKd 1 0 0\n"


def start(run, head, **files):
    """in/m.obj with these lines before the mesh, and other files of the folder; out, which is empty."""
    run.write("l.json", UP)
    run.write("in/m.obj", head + CUBE)
    for name, content in files.items():
        run.write("in/" + name, content)
    os.makedirs(run.path("out"), exist_ok=True)


def tree(run, folder="out"):
    root = run.path(folder)
    return sorted(os.path.relpath(os.path.join(at, name), root) for at, _, names in os.walk(root) for name in names)


def deform(run, *more, out="out/m.obj", **options):
    return run.ffd("deform", "in/m.obj", out, "-l", "l.json", *more, **options)


@case
def libraries_and_maps_are_copied(run):
    """Names with blanks, several libraries in a line, options of maps, folders, backslashes, each word for a map."""
    maps = {"a.png": "map_Kd a.png", "two words.png": "map_Ks -s 1 1 1 -o 0 0 0 two words.png", "bump.png": "  bump -bm 1 bump.png",
            "sub/cube.png": "refl -type cube_top sub\\cube.png", "n.png": "norm n.png", "p.png": "map_Pr p.png", "d.jpg": "disp -mm 0 1 d.jpg",
            "decal.tga": "DECAL -clamp on decal.tga", "3 d.png": "map_d -s 2 3 d.png", "#1.png": "map_Ke -t 0 #1.png",
            "last.png": "map_bump -imfchan l -texres 512 last.png"}
    content = {name: PNG + name.encode() for name in maps}
    content["decal.tga"] = bytes([0, 0, 2] + [0] * 13 + [24, 0])
    content["3 d.png"] = PNG
    start(run, "mtllib one.mtl\nmtllib two words.mtl sub/three.mtl \\\n  four.MTL\n# mtllib no.mtl\ng mtllib no.mtl\n", **content)
    run.write("in/one.mtl", MTL + "\r\n".join(maps.values()) + "\nmap_aat on\n# map_Kd no.png")
    run.write("in/two words.mtl", MTL + "map_Kd 3 d.png\r")
    run.write("in/sub/three.mtl", "\ufeff" + MTL + "map_Kd cube.png\nmap_Ka ../a.png\nmap_Kd bump.png\n")
    run.write("in/four.MTL", "# none\n")
    run.write("in/3.png", PNG)
    done = deform(run, err=anything)
    one_line(done, 'm.obj: the image "d.png" is missing and was not copied')
    equal(len(done.err), 1, done.err)
    expected = sorted(["m.obj", "one.mtl", "two words.mtl", "sub/three.mtl", "four.MTL", *maps])
    equal(tree(run), expected)
    for name in expected:
        if name != "m.obj":
            equal(run.read("out/" + name), run.read("in/" + name), name)
    text = run.text("out/m.obj")
    equal(text[:text.index("v ")], run.text("in/m.obj")[:run.text("in/m.obj").index("v ")], "no other line changes")
    # Once more: the copies are there. In its own folder, and through streams, nothing is copied or said.
    deform(run, out="out/n.obj", err=anything)
    deform(run, out="in/n.obj")
    run.ffd("deform", "-", "out/s.obj", "--input-format", "obj", "-l", "l.json", stdin=run.read("in/m.obj"))
    deform(run, "--output-format", "obj", out="-", data=True)
    equal(tree(run), sorted([*expected, "n.obj", "s.obj"]))


@case
def a_sample_with_names_that_have_blanks(run):
    """`mtllib a b.mtl second.mtl` are two files, or three words where only the last is a file."""
    start(run, "mtllib a b.mtl second.mtl\n", **{"a b.mtl": MTL, "second.mtl": MTL})
    deform(run)
    equal(tree(run), ["a b.mtl", "m.obj", "second.mtl"])
    run.remove("in/a b.mtl")
    run.write("in/b.mtl", MTL)
    one_line(deform(run, "--force", err=anything), 'the material library "a" does not have the ending of a material library')
    equal(tree(run), ["a b.mtl", "b.mtl", "m.obj", "second.mtl"])
    # One file whose name looks like two.
    start(run, "mtllib x.mtl y.mtl\n", **{"x.mtl y.mtl": MTL})
    deform(run, "--force")
    check(run.exists("out/x.mtl y.mtl"), tree(run))


@case
def nothing_else_can_be_copied(run):
    """Whatever an OBJ and its libraries name: no file that is no material library, and no map that is no image."""
    left = {"id_rsa": "does not have the ending", "notes.txt": "does not have the ending", "secret.mtl": "does not have the content",
            ".hidden.mtl": "hidden", ".git/a.mtl": "hidden", "link.mtl": "link", "linked/b.mtl": "link", "zero.mtl": "does not have the content",
            "none.mtl": "is missing", "../up.mtl": "cannot be copied: it is outside", "out.mtl": "cannot be copied: .*outside",
            "dir.mtl": "cannot be copied: .* is not a file", "pipe.mtl": "cannot be copied: .* is not a file"}
    maps = {"key.pem": "does not have the ending", "text.png": "does not have the content", ".x.png": "hidden", "../up.png": "outside"}
    start(run, "".join(f"mtllib {name}\n" for name in [*left, "/etc/passwd.mtl", "C:\\x\\y.mtl", "\\\\host\\z.mtl", "."]) + "mtllib good.mtl\n")
    run.write("in/good.mtl", MTL + "".join(f"map_Kd {name}\n" for name in [*maps, "/etc/x.png", "c:/y.png", "-o"]) + "map_Kd\nmap_Kd -s 1 1\n")
    for name in ("id_rsa", "notes.txt", "secret.mtl", "key.pem", "text.png"):
        run.write("in/" + name, "-----BEGIN KEY-----\nnewmtl x\n")
    run.write("in/zero.mtl", b"newmtl a\n\0")
    for name in (".hidden.mtl", ".git/a.mtl", "real.mtl", "folder/b.mtl"):
        run.write("in/" + name, MTL)
    run.write("up.mtl", MTL)
    for name in ("in/.x.png", "up.png"):
        run.write(name, PNG)
    os.symlink("real.mtl", run.path("in/link.mtl"))
    os.symlink("folder", run.path("in/linked"))
    os.symlink("../up.mtl", run.path("in/out.mtl"))
    run.folder_of("in/dir.mtl")
    os.mkfifo(run.path("in/pipe.mtl"))
    run.folder_of("far/out")
    done = deform(run, out="far/out/m.obj", err=anything)
    for name, why in (*left.items(), *maps.items()):
        one_line(done, f'"{name}" .*{why}'.replace('"..', r'"\.\.'))
    equal(len(done.err), len(left) + len(maps), done.err)
    equal(tree(run, "far"), ["out/good.mtl", "out/m.obj"])
    # One level up the output reaches the very files: nothing to say.
    no_line(deform(run, err=anything), "up.mtl")
    # By reference none is copied, and the libraries that the output does not reach are named.
    run.write("in/m.obj", "mtllib good.mtl ../up.mtl none.mtl\n" + CUBE)
    run.folder_of("ref")
    done = deform(run, "--resources", "reference", out="ref/m.obj", err=anything)
    equal([line.partition(": the ")[2] for line in done.err],
          [f'output does not reach the material library "{name}" (--resources copy copies it)' for name in ("good.mtl", "none.mtl")])
    equal(tree(run, "ref"), ["m.obj"])


@case
def a_file_that_is_there_stays(run):
    start(run, "mtllib m.mtl\n", **{"m.mtl": MTL + "map_Kd t.png\n", "t.png": PNG})
    run.write("out/t.png", "precious")
    for force in ([], ["--force"], ["--if-changed"]):
        deform(run, *force, code=IO, err="out/t.png: already exists and is not the image to be copied there (--resources reference copies none)")
        equal(tree(run), ["t.png"], "none of the set is written")
    run.remove("out/t.png")
    run.write("out/m.mtl", "precious")
    deform(run, code=IO, err="out/m.mtl: already exists and is not the material library to be copied there (--resources reference copies none)")
    equal(tree(run), ["m.mtl"])
    run.remove("out/m.mtl")
    # An output must not have the name of what goes with it, nor replace it in its own folder.
    for out, why in (("out/m.mtl", "is also the path of the "), ("in/m.mtl", "is an image or a material library of the input in/m.obj and "),
                     ("in/t.png", "is an image or a material library of the input in/m.obj and ")):
        deform(run, "--output-format", "obj", "--force", out=out, code=IO, err=lambda said, why=why: check(why in said[0], said))
    equal([run.text("in/m.mtl"), run.read("in/t.png")], [MTL + "map_Kd t.png\n", PNG])
    # Whoever deforms in place, or writes another format, does not need them.
    run.ffd("deform", "in/m.obj", "out/m.glb", "-l", "l.json", err=anything)
    run.ffd("deform", "in/m.obj", "--in-place", "-l", "l.json")
    equal(tree(run), ["m.glb"])


@case
def a_dry_run_sees_what_stands_beside_the_output(run):
    """Copies of an OBJ, images of a glTF, its buffers and those of a conversion: what the first job would refuse."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    start(run, "mtllib m.mtl\n", **{"m.mtl": MTL, "t.png": PNG})
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="g.bin")
    run.write("in/g.gltf", {**asset, "images": [{"uri": "t.png"}]})
    run.write("in/up.gltf", {**asset, "images": [{"uri": "../t.png"}]})
    run.write("in/g.bin", data)
    for name, out, there, said in (("m.obj", "m.obj", "m.mtl", "out/m.mtl: already exists and is not the material library"),
                                   ("g.gltf", "g.gltf", "t.png", "out/t.png: already exists and is not the image"),
                                   ("g.gltf", "x.gltf", "x.bin", "out/x.bin: exists already"),
                                   ("m.obj", "y.gltf", "y.bin", "out/y.bin: exists already"),
                                   ("up.gltf", "up.gltf", "", 'the image "../t.png" cannot be copied')):
        run.write("j.jsonl", json.dumps({"in": "in/" + name, "lattice": "l.json", "out": "out/" + out}) + "\n")
        if there:
            run.ffd("batch", "j.jsonl", "--dry-run", err=anything)
            run.write("out/" + there, "precious")
        before = tree(run)
        for dry in (["--dry-run"], []):
            one_line(run.ffd("batch", "j.jsonl", *dry, code=1, err=anything), "^j.jsonl:1: .*" + said)
            equal(tree(run), before)
        run.remove("out/" + (there or "none"))


@case
def what_the_output_was_made_from(run):
    """Depfiles have them, and --resume looks at them."""
    start(run, "mtllib m.mtl\n", **{"m.mtl": MTL + "map_Kd t.png\n", "t.png": PNG})
    deform(run, "--depfile", "d")
    equal(run.text("d"), "out/m.obj: in/m.obj in/m.mtl in/t.png l.json\n")
    deform(run, "--depfile", "d", "--force", "--resources", "reference")
    equal(run.text("d"), "out/m.obj: in/m.obj l.json\n")
    for name in tree(run):
        run.remove("out/" + name)
    jobs = [{"in": "in/m.obj", "lattice": "l.json", "out": f"out/{name}.obj"} for name in "ab"]
    run.write("j.jsonl", "".join(json.dumps(job) + "\n" for job in jobs))

    def batch(*expected, code=0):
        run.ffd("batch", "j.jsonl", "-j", "1", "--resume", "--journal", "j", "--force", "--report", "r.json", code=code, err=anything)
        equal({job["status"] for job in json.loads(run.read("r.json"))["jobs"]}, set(expected))

    batch("ok")
    equal(tree(run), ["a.obj", "b.obj", "m.mtl", "t.png"])
    batch("skipped")
    run.write("in/t.png", PNG + b"other")  # its copy is not replaced
    batch("failed", code=1)
    run.remove("out/t.png")
    batch("ok")
    for name in ("m.mtl", "a.obj"):
        run.remove("out/" + name)
    batch("ok", "skipped")  # the first job brings back what the second one lacks
    batch("skipped")
    equal(tree(run), ["a.obj", "b.obj", "m.mtl", "t.png"])


@case
def a_short_file_cannot_ask_for_any_number(run):
    start(run, "mtllib " + " ".join(f"{i}.mtl" for i in range(65537)) + "\n")
    deform(run, code=LIMIT, err="in/m.obj: names more than 65536 material libraries or maps")
    start(run, "mtllib " + "x" * (1 << 20) + "y\n")
    deform(run, code=LIMIT, err="in/m.obj: a mtllib statement has more than 1048576 bytes")
    start(run, "".join(f"mtllib {i}{'x' * 1000000}\n" for i in range(17)))
    deform(run, code=LIMIT, err="in/m.obj: the names of its material libraries or maps have more than 16777216 bytes")
    start(run, "mtllib m.mtl none.mtl\n" * 300000, **{"m.mtl": MTL + "map_Kd same.png\n" * 300000})
    done = deform(run, err=anything)
    equal(len(done.err), 2, done.err)
    equal(tree(run), ["m.mtl", "m.obj"])


main()
