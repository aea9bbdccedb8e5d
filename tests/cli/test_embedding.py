#!/usr/bin/env python3
"""ffd deform --embedding: u,v,w of an earlier `ffd embed` give the same bytes as a search, and only those that
were made for this mesh and this rest lattice are taken."""
import random
import re
import struct

from harness import CUBE, CUBE_CORNERS, INVALID, IO, USAGE, case, check, equal, glb, gltf_json, lattice, main, npy

BENT = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]
UP = [{"at": [1, 1, 1], "by": [0, 0.25, 1]}]
TWIST = [{"twist": {"axis": "z", "degrees": 40}}]
MANY = "".join(f"v {x / 50} {x % 7 / 4} {x % 11 / 6}\n" for x in range(-100, 100) for _ in range(15))


def bent(**members):
    return lattice(size=(3, 3, 3), rest={"points": BENT}, **members)


def refused(run, why, mesh="a.obj", lattice_file="l.json", code=INVALID):
    run.ffd("deform", mesh, "o.obj", "-l", lattice_file, "--embedding", "e.npy", code=code, err="e.npy: " + why)
    check(not run.exists("o.obj"), "nothing is written")


def start(run, mesh=CUBE):
    run.write("a.obj", mesh)
    run.write("l.json", bent(moves=UP))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "-q", "--force")


def deform_both_ways(run, mesh, lattice_file, *more):
    """The output with and without the embedding."""
    ending = mesh[mesh.index("."):]
    said = [run.ffd("deform", mesh, name + ending, "-l", lattice_file, "--force", "-q", *options, *more)
            for name, options in (("searched", ()), ("reused", ("--embedding", "e.npy")))]
    equal(said[1].err, said[0].err)
    return run.read("searched" + ending), run.read("reused" + ending)


@case
def the_same_bytes_as_a_search(run):
    for mesh in (CUBE, MANY, "o nothing\n"):
        start(run, mesh)
        for moves in (UP, TWIST, []):
            run.write("m.json", bent(moves=moves))
            for threads in ("1", "3"):
                searched, reused = deform_both_ways(run, "a.obj", "m.json", "-j", threads, "-q")
                equal(reused, searched)
            equal(reused != run.read("a.obj"), bool(moves) and mesh != "o nothing\n", "it is deformed")


@case
def an_embedding_of_a_scene_serves_its_deformation(run):
    run.write("l.json", lattice(low=(-20, -20, -20), high=(20, 20, 20), moves=TWIST))
    nodes = [{"mesh": 0, "translation": [10, 0, 0]}, {"mesh": 0, "translation": [0, -5, 0], "scale": [2, 1, 1]}]
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS, nodes=nodes)))
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy")
    searched, reused = deform_both_ways(run, "a.glb", "l.json")
    equal(reused, searched)
    run.ffd("deform", "a.glb", "o.glb", "-l", "l.json", "--embedding", "e.npy", "--space", "mesh", code=INVALID,
            err="e.npy: was made for another mesh: it is of 16 vertices, not 8")


@case
def of_positions_that_stand_twice(run):
    """Two primitives with the same positions and normals of their own: the positions count once."""
    run.write("l.json", bent(moves=TWIST))
    asset, data = gltf_json(CUBE_CORNERS + CUBE_CORNERS[:1], normals=9 * [[0.0, 0.0, 1.0]])
    asset["buffers"][0]["byteLength"] += 9 * 12
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 9 * 12})
    asset["accessors"].append({**asset["accessors"][1], "bufferView": 2})
    primitives = asset["meshes"][0]["primitives"]
    primitives.append({**primitives[0], "attributes": {"POSITION": 0, "NORMAL": 2}})
    run.write("a.glb", glb(asset, data + struct.pack("<27f", *(9 * [0.6, 0.0, 0.8]))))
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy")
    searched, reused = deform_both_ways(run, "a.glb", "l.json")
    equal(reused, searched)
    check(searched != run.read("a.glb"), "it is deformed")
    equal(npy(run.read("e.npy"))[1], (9, 3))


@case
def statuses_are_kept(run):
    start(run, CUBE + "v 30 0 0\nv 0.5 0.25 2\np 9 10\n")
    for more in ((), ("--report", "r.json", "--report-stable")):
        searched, reused = deform_both_ways(run, "a.obj", "l.json", *more)
        equal(reused, searched)
    reports = []
    for options in ((), ("--embedding", "e.npy")):
        done = run.ffd("deform", "a.obj", "o.obj", "--force", "-l", "l.json", *options, "--report", "r.json",
                       "--report-stable", lines=1)
        reports.append((done.err, [run.text("r.json").count(x) for x in ('"outside": 1', '"inside": 9')]))
        run.ffd("deform", "a.obj", "x.obj", "-l", "l.json", "--outside", "error", *options, code=5)
    equal(reports[1], reports[0])
    equal(reports[0][1], [1, 1])


@case
def stale_ones_are_refused(run):
    start(run)
    lines = CUBE.splitlines()
    run.write("swapped.obj", "\n".join([lines[0], lines[2], lines[1], *lines[3:]]) + "\n")
    run.write("nudged.obj", CUBE.replace("v 1 ", "v 1.0000000000000002 "))
    run.write("more.obj", CUBE + "v 0 0 0\n")
    for mesh in ("swapped.obj", "nudged.obj"):
        refused(run, "was made for another mesh: its positions, or their number type, differ", mesh)
    refused(run, "was made for another mesh: it is of 8 vertices, not 9", "more.obj")
    moved = [list(p) for p in BENT]
    moved[13][0] += 1e-12
    for other in (lattice(size=(3, 3, 3), rest={"points": moved}, moves=UP), bent(degree=[1, 2, 2], moves=UP),
                  bent(weights=[2] + 26 * [1], moves=UP), lattice(moves=UP)):
        run.write("o.json", other)
        refused(run, "was made for another rest lattice, or with another --snap", lattice_file="o.json")


@case
def what_is_no_embedding_is_refused(run):
    start(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "x.npy", "--status", "s.npy")
    whole, status = run.read("e.npy"), run.read("s.npy")
    array = whole[:-(72 + 8)]
    none = "is not an embedding written by ffd embed, or not a whole one"
    for data, why in ((b"", none), (status, none), (array, none), (whole[:-1], none), (whole + b"\0", none),
                      (array[:200] + b"\1" + array[201:] + whole[len(array):],
                       "is damaged: its content is not what ffd embed wrote"),
                      (whole[:-16] + b"\2" + whole[-15:],
                       "is an embedding of format version 2, this program reads version 1")):
        run.write("e.npy", data)
        refused(run, why)
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "none.npy", code=IO)
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", ".", code=IO)


def graft(run, moved, lattice_file, *more):
    """Writes as e.npy the u,v,w of another mesh with the hashes of a.obj's embedding."""
    run.write("other.obj", moved)
    for name in ("a", "other"):
        run.ffd("embed", name + ".obj", "-l", lattice_file, "-o", name + ".npy", "-q", "--force", *more)
    right, other = run.read("a.npy"), run.read("other.npy")
    run.write("e.npy", other[:-72] + right[-72:-40] + other[-40:])


@case
def what_misses_a_vertex_is_refused(run):
    """By more than roundings, however little; of several the first one is named."""
    why = r"^e\.npy: u,v,w of vertex {} \(counted from 0\) lead to a place .* away from it: they are not what ffd embed wrote$"
    weights = [10.0 ** (i % 4) for i in range(27)]
    for members in ({}, {"weights": weights}, {"rest": {"box": {"min": [-2, -2, -2], "max": [2, 2, 2]}}}):
        start(run)
        run.write("l.json", lattice(size=(3, 3, 3), moves=UP, **{"rest": {"points": BENT}, **members}))
        for step in ("1e-9", "0.5"):
            graft(run, CUBE.replace("v 1 ", f"v {1 - float(step)!r} "), "l.json")
            run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "e.npy", code=INVALID, err=re.compile(why.format(1)))
            check(not run.exists("o.obj"), "nothing is written")
    # What is outside of one part and inside of the other is not looked for again: it keeps its status, and is counted (and torn off).
    graft(run, CUBE.replace("v 1 ", "v 30 "), "l.json")
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "e.npy", lines=2)


@case
def what_is_on_the_border_is_taken(run):
    """What float32 or --snap brings to the border is as near to it as they allow, and no other place of it is."""
    numbers = random.Random(34)
    points = [[0.1 * numbers.random() for _ in range(3)] for _ in range(300)]
    for p in points:
        p[numbers.randrange(3)] = numbers.choice((0, 0.1))
    run.write("f.ply", "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
              + "".join("%r %r %r\n" % tuple(p) for p in points))
    run.write("l.json", lattice(low=(0, 0, 0), high=(0.1, 0.1, 0.1), moves=TWIST))
    run.ffd("embed", "f.ply", "-l", "l.json", "-o", "e.npy")
    searched, reused = deform_both_ways(run, "f.ply", "l.json")
    equal(reused, searched)
    away = CUBE + "".join("v %r %r %r\n" % tuple(2 + 0.009 * numbers.random() if a == i % 3 else 2 - 4 * numbers.random()
                                                 for a in range(3)) for i in range(200))
    start(run, away)
    run.write("l.json", lattice(size=(3, 3, 3), rest={"points": BENT}, moves=TWIST))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--snap", "0.3", "-q", "--force")
    searched, reused = deform_both_ways(run, "a.obj", "l.json", "--snap", "0.3")
    equal(reused, searched)
    run.write("l.json", lattice(moves=UP))
    start_of = CUBE + "v 2.25 0 0\n"
    run.write("a.obj", start_of)
    graft(run, start_of.replace("2.25 0", "2.25 0.5"), "l.json", "--snap", "0.3")
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "e.npy", "--snap", "0.3", code=INVALID,
            err=re.compile("vertex 8 .* lead to a place 0.559 away"))


@case
def the_embedding_is_not_overwritten(run):
    start(run)
    before = run.read("e.npy")
    run.write("e.obj", before)
    refusal = (USAGE, IO)
    run.ffd("deform", "a.obj", "e.obj", "-l", "l.json", "--embedding", "e.obj", "--force", code=refusal, lines=None)
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--embedding", "e.npy", "--report", "e.npy", code=refusal,
            lines=None)
    equal([run.read("e.obj"), run.read("e.npy")], [before, before])


main()
