#!/usr/bin/env python3
"""ffd embed: u,v,w and statuses as NumPy files."""
import math

from harness import (CUBE, CUBE_CORNERS, INVALID, IO, USAGE, case, check, equal, glb, gltf_json, lattice, main, near, npy)


def start(run, **members):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(**members))


def uvw(p, low=-2, high=2):
    return [(x - low) / (high - low) for x in p]


@case
def both_arrays(run):
    start(run)
    run.write("a.obj", CUBE + "v 3 0 0\nv 0.5 0.25 2\n")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy",
            err="a.obj: 1 of 10 vertices are not inside: 1 outside (left where they are)")
    descr, shape, rows = npy(run.read("e.npy"))
    equal([descr, shape], ["<f8", (10, 3)])
    near(rows[:8], [uvw(p) for p in CUBE_CORNERS], 1e-15)
    check(all(math.isnan(x) for x in rows[8]), rows[8])
    near(rows[9], uvw([0.5, 0.25, 2]), 1e-15)
    equal(npy(run.read("s.npy")), ("|u1", (10,), [0] * 8 + [1, 0]))


@case
def parameters_in_the_range_of_the_knots(run):
    start(run, size=(5, 4, 4), knots=["uniform", "open", [-1, -1, -1, -1, 3, 3, 3, 3]])
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    rows = npy(run.read("e.npy"))[2]
    # uniform: n = 5, p = 3, t_i = i/8, the domain [3/8, 5/8].
    near(rows, [[(3 + 2 * a) / 8, b, -1 + 4 * c] for a, b, c in (uvw(p) for p in CUBE_CORNERS)], 1e-14)


@case
def general_lattices(run):
    points = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]
    start(run, size=(3, 3, 3), rest={"points": points})
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy")
    equal(npy(run.read("s.npy"))[2], [0] * 8)
    for p, (u, v, w) in zip(CUBE_CORNERS, npy(run.read("e.npy"))[2]):
        b = [[(1 - t) ** 2, 2 * t * (1 - t), t * t] for t in (u, v, w)]
        at = [sum(b[0][n % 3] * b[1][n // 3 % 3] * b[2][n // 9] * points[n][a] for n in range(27)) for a in range(3)]
        near(at, p, 1e-14)


@case
def statuses(run):
    """An axis that is collapsed is singular or answered; points outside, and coordinates that are no numbers."""
    run.write("a.obj", "v 0.5 0 0\nv 9 0 0\nv nan 0 0\nv 0 inf 0\n")
    run.write("l.json", lattice())
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", lines=1)
    equal(npy(run.read("s.npy"))[2], [0, 1, 4, 4])
    check(all(math.isnan(x) for row in npy(run.read("e.npy"))[2][1:] for x in row), "NaN where there is none")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", code=INVALID,
            err="a.obj: vertex 2 (counted from 0) has a coordinate that is not finite")


@case
def an_empty_mesh(run):
    start(run)
    run.write("a.obj", "# nothing\n")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy")
    equal(npy(run.read("e.npy")), ("<f8", (0, 3), []))
    equal(npy(run.read("s.npy")), ("|u1", (0,), []))


@case
def gltf_order(run):
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
def outputs(run):
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
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "none/e.npy", code=IO)
    run.ffd("embed", "none.obj", "-l", "l.json", "-o", "x.npy", code=IO)
    run.ffd("embed", "a.obj", "-l", "none.json", "-o", "x.npy", code=IO)


@case
def inputs_are_not_overwritten(run):
    start(run)
    lattice_text = run.text("l.json")
    for name in ("a.obj", "l.json"):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", name, "--force", code=USAGE)
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", name, "--force", code=USAGE)
    equal([run.text("a.obj"), run.text("l.json"), run.exists("e.npy")], [CUBE, lattice_text, False])


@case
def threads_change_nothing(run):
    points = "".join(f"v {x / 50} {x % 7 / 4} {x % 11 / 6}\n" for x in range(-100, 100) for _ in range(15))
    run.write("a.obj", points)
    bent = [[x + 0.1 * y * y, y, z + 0.05 * x] for z in range(-2, 3) for y in range(-2, 3) for x in range(-3, 4)]
    run.write("l.json", lattice(size=(7, 5, 5), rest={"points": bent}))
    outputs = set()
    for n in ("1", "2", "7"):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--force", "-q", "-j", n)
        outputs.add(run.read("e.npy"))
    equal(len(outputs), 1)


main()
