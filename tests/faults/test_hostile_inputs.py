#!/usr/bin/env python3
"""Files that were made to do harm (siege-*): a journal, a lattice, an embedding, and the images that a model names. The
inputs are made here.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_hostile_inputs.py siege_10_an_embedding_that_misses_a_vertex_is_refused
"""

import json
import os
import re
import resource
import struct

from harness import INVALID, LIMIT, NO, PNG, SANITIZED, case, check, equal, gltf_json, lattice, main, obj_of
from messages import anything, one_line

TWIST = [{"twist": {"axis": "y", "degrees": 40}}]
BOX = lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=TWIST)


def sheet(moved=None):
    """A sheet of 9 x 9 vertices, of which one may be moved by 0.3."""
    vertices = [[i / 8, j / 8, i * j % 3 / 10] for j in range(9) for i in range(9)]
    if moved is not None:
        vertices[moved][0] += 0.3
    return (obj_of(vertices)
            + "".join(f"f {k + 1} {k + 2} {k + 11} {k + 10}\n" for k in range(71) if k % 9 < 8))


@case
def siege_06_a_journal_of_more_records_than_it_has_is_refused(run):
    """A journal that tells of more records than it has, or than there can be: refused at once."""
    run.write("a.obj", sheet())
    run.write("l.json", BOX)
    run.write("s.jsonl", json.dumps({"in": "a.obj", "lattice": "l.json", "out": "b.obj"}) + "\n")
    run.write("j", "")
    for version, slots, size in ((1, 1 << 40, 1 << 43), (2, 1 << 40, 1 << 43), (2, 1 << 34, 64 + (1 << 41)), (2, (1 << 64) - 1, 1 << 20),
                                 (2, 3000, 4096)):
        run.write("j", b"ffd-journal %d\n\0\0" % version + struct.pack("<Q", slots) + bytes(40))
        os.truncate(run.path("j"), size)
        run.ffd("batch", "s.jsonl", "--journal", "j", "--resume", code=INVALID,
                err=f"j: is a damaged journal: it has not the {slots} records that it tells of; to begin a new one, remove it")
        equal(os.path.getsize(run.path("j")), size, "it is left as it is")
    # One that was cut off while it was made is made anew.
    run.write("j", b"ffd-journal 2\n\0\0" + struct.pack("<Q", 1024) + bytes(1000))
    run.ffd("batch", "s.jsonl", "--journal", "j", "--resume", "-q")
    run.ffd("batch", "s.jsonl", "--journal", "j", "--resume", lines=1)


@case
def siege_09_millions_of_control_points_take_little_memory(run):
    """A line that asks for 67 million control points: described in little memory; else refused before they are made."""
    run.write("a.obj", sheet())
    options = {} if SANITIZED else {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_AS, (10 ** 9, 10 ** 9))}
    rests = {"box.json": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "mesh.json": {"box": "mesh"},
             "cylinder.json": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 1], "height": 1}}}
    for name, rest in rests.items():
        run.write(name, lattice(size=(406, 406, 407), rest=rest))
        facts = run.ffd("info", name, "--json", **options).json
        equal([facts["control_points"], facts["size"], facts["rest_bounds"]], [67088252, [406, 406, 407], None])
        equal(facts.get("points_unknown"), None if name == "mesh.json" else "the control points need 4898 MB of memory (--memory allows more)")
        why = re.compile(name + ": a lattice of 406 by 406 by 407 control points needs 4898 MB of memory, but 84 MB are left of the 100 MB "
                         r"allowed \(--memory raises this\)$")
        for words in (["deform", "a.obj", "o.obj", "-l"], ["check", "a.obj", "-l"], ["embed", "a.obj", "-o", "e.npy", "-l"]):
            run.ffd(*words, name, code=LIMIT, err=why, **options)
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--size", "406,406,407", code=LIMIT, err=re.compile("needs 4898 MB of memory"), **options)
    # Where not even the knots fit, with what is made of them.
    for count in (1 << 24, 4000000, 1000000):
        run.write("long.json", lattice(size=(count, 2, 2)))
        run.ffd("info", "long.json", code=LIMIT, err=re.compile(f"^long.json: a lattice of {count} by 2 by 2 "), **options)
    check(not run.exists("o.obj") and not run.exists("e.npy") and not run.exists("n.json"), "nothing is written")


@case
def lattices_share_the_memory(run):
    """What one leaves is for the others and for the mesh; a job has at most 1,024."""
    run.write("a.obj", sheet())
    run.write("l.json", lattice(size=(80, 80, 80), low=(-1, -1, -1), moves=[{"by": [1, 0, 0]}]))
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json")
    three = ["deform", "a.obj", "three.obj", *["-l", "l.json"] * 3]
    run.ffd(*three, code=LIMIT)
    run.ffd(*three, "--memory", "200M", err=anything)
    run.write("s.json", lattice(moves=[{"by": [1e-3, 0, 0]}]))
    many = ["-l", "s.json"] * 1025
    run.ffd("deform", "a.obj", "many.obj", *many, code=LIMIT, err=re.compile("a job has at most 1024 lattices, not 1025"))
    run.write("m.jsonl", json.dumps({"in": "a.obj", "out": "m.obj", "lattice": ["s.json"] * 1025}) + "\n")
    run.ffd("batch", "m.jsonl", "-q", code=NO, err=re.compile("a job has at most 1024 lattices, not 1025"),
            env={**os.environ, "XDG_CACHE_HOME": run.path("cache")})


# A volume that turns round at x = 2: behind x = 1 each place has two u,v,w.
TURNED = {"format": "ffd-lattice", "version": 1, "size": [3, 2, 2], "degree": [1, 1, 1], "moves": TWIST,
          "rest": {"points": [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 2, 1)]}}


@case
def siege_10_an_embedding_that_misses_a_vertex_is_refused(run):
    """u,v,w that miss a vertex, be it inside or multiple, with hashes that say all is well: refused, nothing is written."""
    place = "v 0.5 0.5 0.5\nv %g 0.5 0.5\np 1 2\n"
    for lattice_file, mesh, moved, vertex, far in ((BOX, sheet(), sheet(40), 40, 0.3), (TURNED, place % 1.25, place % 1.5, 1, 0.25)):
        run.write("a.obj", mesh)
        run.write("other.obj", moved)
        run.write("l.json", lattice_file)
        for name in ("a", "other"):
            run.ffd("embed", name + ".obj", "-l", "l.json", "-o", name + ".npy", "--force", err=anything)
        # The hash of the content is right; those of mesh and lattice are taken from the right embedding.
        right, other = run.read("a.npy"), run.read("other.npy")
        run.write("forged.npy", other[:-72] + right[-72:-40] + other[-40:])
        run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "forged.npy", "--report", "r.json", code=INVALID, err=re.compile(
            rf"^forged.npy: u,v,w of vertex {vertex} \(counted from 0\) lead to a place {far} away from it: they are not what ffd embed wrote$"))
        check(not run.exists("o.obj"), "nothing is written")
        run.ffd("deform", "a.obj", "p.obj", "-l", "l.json", "--embedding", "a.npy", "--force", err=anything)


@case
def siege_11_what_is_no_image_is_not_copied(run):
    """A model names scripts, hidden files, a link and what only seems to be an image: none is copied, which is said."""
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="m.bin")
    left = {".bashrc": "does not have the ending", "Makefile": "does not have the ending", ".git/hooks/post-checkout": "does not have the ending",
            ".hidden.png": "hidden", ".git/a.png": "hidden", "text.png": "does not have the content", "link.png": "link",
            "linked/a.png": "link", "empty.jpg": "does not have the content"}
    asset["images"] = [{"uri": uri} for uri in [*left, "kept.png", "a/b.webp"]]
    run.write("pk/m.gltf", asset)
    run.write("pk/m.bin", data)
    for name in left:
        if "link" not in name:
            run.write("pk/" + name, PNG if "hidden" in name or "a.png" in name else "" if "empty" in name else "echo owned")
    run.write("pk/kept.png", PNG + b"...")
    run.write("pk/a/b.webp", b"RIFF\x10\0\0\0WEBPVP8 ")
    os.symlink("kept.png", run.path("pk/link.png"))
    os.symlink("a", run.path("pk/linked"))
    run.write("pk/a/a.png", PNG)
    run.write("l.json", BOX)
    run.folder_of("dst")
    done = run.ffd("deform", "pk/m.gltf", "dst/m.gltf", "-l", "l.json", err=anything)
    equal(len(done.err), len(left), done.err)
    for name, why in left.items():
        one_line(done, f'"{name}" .*{why}.* was not copied'.replace(".bash", r"\.bash"))
    equal(sorted(os.path.relpath(os.path.join(folder, name), run.path("dst"))
                 for folder, _, names in os.walk(run.path("dst")) for name in names), ["a/b.webp", "kept.png", "m.bin", "m.gltf"])
    # In its own folder and by reference nothing is copied, and there is nothing to say.
    run.ffd("deform", "pk/m.gltf", "pk/n.gltf", "-l", "l.json")
    run.ffd("deform", "pk/m.gltf", "dst/r.gltf", "-l", "l.json", "--resources", "reference")


main()
