#!/usr/bin/env python3
"""ffd compare: 0 the same, 1 not (with the difference on stdout), other codes for failures."""
import struct

from harness import CUBE, CUBE_CORNERS, INVALID, IO, NO, USAGE, case, check, glb, gltf_json, main


def differ(run, a, b, *arguments):
    done = run.ffd("compare", a, b, *arguments, code=NO)
    check(done.out.count(b"\n") == 1 and done.out.endswith(b"\n"), f"not one line: {done.out!r}")
    check(a in done.text and b in done.text, done.text)
    run.ffd("compare", b, a, *arguments, code=NO)
    return done.text


def same(run, a, b, *arguments):
    run.ffd("compare", a, b, *arguments, out="")
    run.ffd("compare", b, a, *arguments, out="")


@case
def equal_files(run):
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE)
    same(run, "a.obj", "b.obj")
    same(run, "a.obj", "a.obj", "--tolerance", "0")


@case
def positions(run):
    run.write("a.obj", "v 0 0 0\nv 1 2 3\n")
    run.write("b.obj", "v 0 0 0\nv 1 2.25 3\n")
    text = differ(run, "a.obj", "b.obj")
    check("vertex 2" in text and "line 2" in text and "0.25" in text, text)
    differ(run, "a.obj", "b.obj", "--tolerance", "0.2499")
    same(run, "a.obj", "b.obj", "--tolerance", "0.25")
    same(run, "a.obj", "b.obj", "--tolerance=1e3")


@case
def numbers_are_compared_as_numbers(run):
    run.write("a.obj", "v 0.5 1 100\n")
    run.write("b.obj", "v .50 1.0e0 1E2\n")
    same(run, "a.obj", "b.obj")
    run.write("c.obj", "v 0.5 1.0000000000000002 100\n")
    differ(run, "a.obj", "c.obj")


@case
def all_else_of_obj(run):
    text = "mtllib m.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng part\nusemtl red\ns 1\nf 1/1/1 2/1/1 3/1/1\n"
    run.write("a.obj", text)
    for old, new in (("m.mtl", "n.mtl"), ("thing", "things"), ("vt 0 0", "vt 0 0.5"), ("vn 0 0 1", "vn 0 1 0"),
                     ("g part", "g other"), ("red", "blue"), ("s 1", "s 2"), ("f 1/1/1 2/1/1 3/1/1", "f 1/1/1 3/1/1 2/1/1"),
                     ("f 1/1/1", "f 1//1"), ("v 0 1 0\n", "v 0 1 0\nv 0 1 0\n"),
                     ("usemtl red\n", ""), ("s 1\n", "s 1\nl 1 2\n")):
        check(old in text, old)
        run.write("b.obj", text.replace(old, new, 1))
        differ(run, "a.obj", "b.obj", "--tolerance", "10")


@case
def glb_positions(run):
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    run.write("b.glb", glb(asset, data[:12] + struct.pack("<f", 1.125) + data[16:]))
    same(run, "a.glb", "a.glb")
    differ(run, "a.glb", "b.glb", "--tolerance", "0.124")
    check("0.125" in differ(run, "a.glb", "b.glb"), "the coordinate that differs")
    same(run, "a.glb", "b.glb", "--tolerance", "0.125")


@case
def all_else_of_gltf(run):
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    for change in ({"nodes": [{"mesh": 0, "name": "x"}]}, {"nodes": [{"mesh": 0, "translation": [1, 0, 0]}]},
                   {"extras": {"x": 1}}, {"materials": [{}]},
                   {"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}]}):
        run.write("b.glb", glb({**asset, **change}, data))
        differ(run, "a.glb", "b.glb", "--tolerance", "10")


@case
def containers_of_gltf(run):
    """A .gltf with a .bin and a .glb of the same content are the same mesh."""
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    run.write("b.gltf", gltf_json(CUBE_CORNERS, uri="b.bin")[0])
    run.write("b.bin", data)
    same(run, "b.gltf", "b.gltf")
    run.write("c.gltf", gltf_json(CUBE_CORNERS, uri="c.bin")[0])
    run.write("c.bin", data)
    same(run, "b.gltf", "c.gltf")


@case
def other_formats_differ(run):
    run.write("a.obj", CUBE)
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    differ(run, "a.obj", "a.glb")


@case
def failures(run):
    run.write("a.obj", CUBE)
    run.write("bad.obj", "v 1 2\n")
    run.folder_of("d.obj")
    for name, code in (("none.obj", IO), ("bad.obj", INVALID), ("d.obj", IO), ("x.txt", USAGE)):
        run.ffd("compare", "a.obj", name, code=code)
        run.ffd("compare", name, "a.obj", code=code)


@case
def streams_quiet_verbose(run):
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE.replace("1", "2"))
    run.ffd("compare", "-", "a.obj", "--input-format", "obj", stdin=CUBE.encode())
    done = run.ffd("compare", "b.obj", "-", "--input-format", "obj", stdin=CUBE.encode(), code=NO)
    check(done.text.startswith("b.obj and standard input differ: "), done.text)
    run.ffd("compare", "a.obj", "-", stdin=CUBE.encode(), code=USAGE)
    run.ffd("compare", "-", "-", "--input-format", "obj", stdin=CUBE.encode(), code=USAGE)
    run.ffd("compare", "a.obj", "b.obj", "-q", code=NO, out="")
    run.ffd("compare", "a.obj", "a.obj", "-v", err="8 positions compared, largest difference of a coordinate 0")


@case
def with_deform(run):
    """As users do: a deformed file is the same as one deformed again, and not the same as its input."""
    run.write("a.obj", CUBE)
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                         "moves": [{"by": [0, 0, 0.5]}]})
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json")
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json")
    same(run, "b.obj", "c.obj")
    differ(run, "a.obj", "b.obj")
    same(run, "a.obj", "b.obj", "--tolerance", "0.5")


main()
