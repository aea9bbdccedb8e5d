#!/usr/bin/env python3
"""ffd embed: u,v,w and statuses as NumPy files."""
import math
import os
import struct

from harness import (CUBE, CUBE_CORNERS, INVALID, IO, USAGE, case, check, equal, glb, gltf_json, lattice, main, near, npy,
                     threaded_case)


def start(run, **members):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(**members))


def uvw(p, low=-2, high=2):
    return [(x - low) / (high - low) for x in p]


@case
def both_arrays_have_a_row_for_each_vertex(run):
    start(run)
    run.write("a.obj", CUBE + "v 3 0 0\nv 0.5 0.25 2\np 9 10\n")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy",
            err="a.obj: 1 of 10 vertices is not inside: 1 outside (no u,v,w)")
    descr, shape, rows = npy(run.read("e.npy"))
    equal([descr, shape], ["<f8", (10, 3)])
    near(rows[:8], [uvw(p) for p in CUBE_CORNERS], 1e-15)
    check(all(math.isnan(x) for x in rows[8]), rows[8])
    near(rows[9], uvw([0.5, 0.25, 2]), 1e-15)
    equal(npy(run.read("s.npy")), ("|u1", (10,), [0] * 8 + [1, 0]))


def trailer(data):
    """What follows the array: the statuses, and the footer's members by name."""
    footer = dict(zip(("positions", "lattice", "content", "count", "version", "reserved", "magic"),
                      struct.unpack("<16s16s16sQII8s", data[-72:])))
    statuses = data[10 + struct.unpack_from("<H", data, 8)[0] + 24 * footer["count"]:-72]
    return list(statuses), footer


def embedding(run, mesh="a.obj", lattice_file="l.json", *more):
    """The footer of an embedding."""
    run.ffd("embed", mesh, "-l", lattice_file, "-o", "e.npy", "--force", "-q", *more)
    return trailer(run.read("e.npy"))[1]


@case
def the_trailer_holds_statuses_and_hashes(run):
    start(run)
    for mesh in (CUBE, CUBE + "v 3 0 0\nv nan 0 0\nv 0.5 0.25 2\n", "o\n"):
        run.write("a.obj", mesh)
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", "-q", "--force")
        data = run.read("e.npy")
        statuses, footer = trailer(data)
        equal(statuses, npy(run.read("s.npy"))[2])
        equal([footer[name] for name in ("count", "version", "reserved", "magic")],
              [len(statuses), 1, 0, b"ffd-embd"])
        equal(len(data), 10 + struct.unpack_from("<H", data, 8)[0] + 25 * len(statuses) + 72)


@case
def hashes_of_what_u_v_w_depends_on(run):
    start(run)
    first = embedding(run)
    bent = lattice(moves=[{"at": [0, 0, 0], "by": [0, 0, 1]}])
    run.write("moved.json", bent)
    run.write("more.obj", "mtllib none.mtl\r\n" + CUBE.replace("\n", "\r\n") + "vn 0 0 1\r\n")
    for mesh, lattice_file, more in (("a.obj", "moved.json", ()), ("more.obj", "l.json", ()),
                                     ("a.obj", "l.json", ("-j", "1")), ("a.obj", "l.json", ("-j", "5"))):
        equal(embedding(run, mesh, lattice_file, *more), first)
    lines = CUBE.splitlines()
    run.write("swapped.obj", "\n".join([lines[0], lines[2], lines[1], *lines[3:]]) + "\n")
    run.write("nudged.obj", CUBE.replace("v 1 ", "v 1.0000000000000002 "))
    for mesh in ("swapped.obj", "nudged.obj"):
        other = embedding(run, mesh)
        check(other["positions"] != first["positions"], mesh)
        equal(other["lattice"], first["lattice"])
    for name, other in (("box", lattice(high=(2, 2, 3))), ("degree", lattice(degree=[3, 2, 3])),
                        ("weights", lattice(weights=[2] + 63 * [1])), ("size", lattice(size=(4, 5, 4)))):
        run.write("o.json", other)
        footer = embedding(run, lattice_file="o.json")
        check(footer["lattice"] != first["lattice"], name)
        equal(footer["positions"], first["positions"])


@case
def hashes_of_placed_positions(run):
    """glTF: where the nodes show the mesh; the same positions in another file are the same positions, if its numbers
    round alike."""
    start(run, low=(-20, -20, -20), high=(20, 20, 20))
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    same = embedding(run, "a.glb")["positions"]
    exact = embedding(run)["positions"]
    check(exact != same, "floats stand for other numbers than text does")
    for kind, expected in (("float", same), ("double", exact)):
        run.write("a.ply", f"ply\nformat ascii 1.0\nelement vertex {len(CUBE_CORNERS)}\n"
                  + "".join(f"property {kind} {axis}\n" for axis in "xyz") + "end_header\n"
                  + "".join("%r %r %r\n" % tuple(p) for p in CUBE_CORNERS))
        equal(embedding(run, "a.ply")["positions"], expected, kind)
    run.write("moved.glb", glb(*gltf_json(CUBE_CORNERS, nodes=[{"mesh": 0, "translation": [10, 0, 0]}])))
    check(embedding(run, "moved.glb")["positions"] != same, "another place")
    equal(embedding(run, "moved.glb", "l.json", "--space", "mesh")["positions"], same)


@case
def parameters_in_the_range_of_the_knots(run):
    start(run, size=(5, 4, 4), knots=["uniform", "open", [-1, -1, -1, -1, 3, 3, 3, 3]])
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    rows = npy(run.read("e.npy"))[2]
    # uniform: n = 5, p = 3, t_i = i/8, the domain [3/8, 5/8].
    near(rows, [[(3 + 2 * a) / 8, b, -1 + 4 * c] for a, b, c in (uvw(p) for p in CUBE_CORNERS)], 1e-14)


@case
def images_under_a_general_lattice_are_the_vertices(run):
    points = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]
    start(run, size=(3, 3, 3), rest={"points": points})
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy")
    equal(npy(run.read("s.npy"))[2], [0] * 8)
    for p, (u, v, w) in zip(CUBE_CORNERS, npy(run.read("e.npy"))[2]):
        b = [[(1 - t) ** 2, 2 * t * (1 - t), t * t] for t in (u, v, w)]
        at = [sum(b[0][n % 3] * b[1][n // 3 % 3] * b[2][n // 9] * points[n][a] for n in range(27)) for a in range(3)]
        near(at, p, 1e-14)


@case
def statuses_say_what_was_found(run):
    """An axis that is collapsed is singular or answered; points outside, and coordinates that are no numbers."""
    run.write("a.obj", "v 0.5 0 0\nv 9 0 0\nv nan 0 0\nv 0 inf 0\n")
    run.write("l.json", lattice())
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", lines=1)
    equal(npy(run.read("s.npy"))[2], [0, 1, 4, 4])
    check(all(math.isnan(x) for row in npy(run.read("e.npy"))[2][1:] for x in row), "NaN where there is none")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", lines=1)
    equal(run.read("b.obj"), run.read("a.obj"))


@case
def a_value_that_no_placeholder_takes(run):
    start(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--set", "Q=1", code=INVALID,
            err='l.json: no lattice has the placeholder {"$": "Q"} (--set)')


@case
def an_empty_mesh_gives_empty_arrays(run):
    start(run)
    run.write("a.obj", "o nothing\n")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", err="a.obj: there are no vertices")
    equal(npy(run.read("e.npy")), ("<f8", (0, 3), []))
    equal(npy(run.read("s.npy")), ("|u1", (0,), []))


@case
def vertices_of_gltf_come_in_json_order(run):
    """Meshes and primitives in JSON order, an accessor once for each node that shows it."""
    start(run, low=(-20, -20, -20), high=(20, 20, 20))
    nodes = [{"mesh": 0, "translation": [10, 0, 0]}, {"mesh": 0, "translation": [0, -5, 0]}]
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS, nodes=nodes)))
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy")
    rows = npy(run.read("e.npy"))[2]
    placed = [[x + d for x, d in zip(p, node["translation"])] for node in nodes for p in CUBE_CORNERS]
    near(rows, [uvw(p, -20, 20) for p in placed], 1e-15)
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "m.npy", "--space", "mesh")
    near(npy(run.read("m.npy"))[2], [uvw(p, -20, 20) for p in CUBE_CORNERS], 1e-15)


@case
def lattice_round_the_mesh(run):
    start(run, rest={"box": "mesh", "margin": 0})
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    near(npy(run.read("e.npy"))[2], [uvw(p, -1, 1) for p in CUBE_CORNERS], 0)


@case
def outputs_of_embed_are_not_replaced_without_force(run):
    start(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy")
    before = run.read("e.npy")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", code=IO, err="e.npy: exists already (--force overwrites it)")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "n.npy", "--status", "s.npy", code=IO)
    check(not run.exists("n.npy"), "both files or none")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", "--force")
    equal(run.read("e.npy"), before)
    equal(run.ffd("embed", "a.obj", "-l", "l.json", "-o", "-").out, before)
    equal(run.ffd("embed", "-", "--input-format", "obj", "-l", "l.json", "-o", "-", stdin=CUBE.encode()).out, before)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "-", "--status", "-", code=USAGE)
    run.folder_of("k")
    os.symlink("k", run.path("link"))
    for one, two in (("x.npy", "x.npy"), ("./x.npy", "x.npy"), ("x.npy", "k/../x.npy"), ("k/x.npy", "link//x.npy"),
                     (run.path("x.npy"), "x.npy"), ("e.npy", "./e.npy")):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", one, "--status", two, "--force", code=USAGE, lines=None)
        check(not run.exists("x.npy") and not run.exists("k/x.npy"), "nothing is written")
    equal(run.read("e.npy"), before)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "x.npy", "--status", "k/x.npy")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "-", "--status", "./-.npy")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "none/e.npy", code=IO)
    run.ffd("embed", "none.obj", "-l", "l.json", "-o", "x.npy", code=IO)
    run.ffd("embed", "a.obj", "-l", "none.json", "-o", "x.npy", code=IO)


@case
def outputs_of_embed_are_arrays(run):
    """By their names, as those of jacobian and --positions are; a stream has none. Nothing is written, and nothing read."""
    start(run)
    run.folder_of("k")
    for name in ("e", "e.bin", "e.json", "e.npz", "npy", "e.npy.txt", "k/.e"):
        before = run.names()
        for outputs in (["-o", name], ["-o", "e.npy", "--status", name]):
            for mesh in ("a.obj", "none.obj"):
                run.ffd("embed", mesh, "-l", "l.json", *outputs, "--force", code=USAGE, err=f"{name}: must end in .npy: it is an array")
        equal(run.names(), before)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "E.NPY", "--status", "k/e.npy")
    check(run.exists("E.NPY") and run.exists("k/e.npy"), run.names())


@case
def inputs_are_not_overwritten(run):
    start(run)
    lattice_text = run.text("l.json")
    for name in ("a.obj", "l.json"):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", name, "--force", code=USAGE)
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", name, "--force", code=USAGE)
    equal([run.text("a.obj"), run.text("l.json"), run.exists("e.npy")], [CUBE, lattice_text, False])


@threaded_case
def threads_change_nothing(run):
    points = "".join(f"v {x / 50} {x % 7 / 4} {x % 11 / 6}\n" for x in range(-100, 100) for _ in range(60))
    run.write("a.obj", points)
    bent = [[x + 0.1 * y * y, y, z + 0.05 * x] for z in range(-2, 3) for y in range(-2, 3) for x in range(-3, 4)]
    run.write("l.json", lattice(size=(7, 5, 5), rest={"points": bent}))
    outputs = set()
    for n in ("1", "2", "7"):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--force", "-q", "-j", n)
        outputs.add(run.read("e.npy"))
    equal(len(outputs), 1)


main()
