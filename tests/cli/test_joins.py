#!/usr/bin/env python3
"""--seam: faces of lattices that are held still. authoring/seam-*.json hold right answers in exact fractions; exact_seam.py works
them out for random lattices."""

import json
import math
import os
import random
import re
import struct
from fractions import Fraction

import batches
from author import reference_cases
from exact_seam import Volume, coefficients
from gltf_build import Scene, vectors
from harness import (CUBE, INVALID, NO, USAGE, carried, case, check, equal, lattice, main, near, obj_of, obj_vertices, repetitions)
from messages import anything, entry, no_line, one_line
from npy import npy

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
FACES = ("u-", "u+", "v-", "v+", "w-", "w+")


@case
def the_reference_cases(run):
    names = 0
    for name, of in reference_cases("seam"):
        names += 1
        run.write("L", of["lattice"])
        places = of["expect"]["points"]
        run.write("points.obj", obj_of([p["before"] for p in places]))
        run.ffd("deform", "points.obj", "out.obj", "-l", "L", "--force", *of["command"].split()[5:])
        near(obj_vertices(run.text("out.obj")), [p["after"] for p in places], of["expect"]["tolerance"], name)
    equal(names, 3)


# Random lattices, beside exact fractions.

def random_knots(n, d):
    """Of any kind; lists have inner knots of any distance, and ends that are repeated in part."""
    kind = RANDOM.choice(("clamped", "open", "uniform", "list"))
    if kind != "list":
        return kind
    inner = sorted(RANDOM.choice((1, 0.01, 3)) * RANDOM.random() + i for i in range(n - d - 1))
    first, last = -0.5, n + 3.0
    low = sorted(first - RANDOM.choice((0, 0.25, 1)) for _ in range(d))
    high = sorted(last + RANDOM.choice((0, 0.25, 1)) for _ in range(d))
    return [*low, first, *inner, last, *high]


def bent(grid):
    """Control points of a curved volume that does not fold."""
    return [[x + 0.05 * math.sin(2 * y), y + 0.07 * x * x, z + 0.05 * math.sin(x + 2 * y)] for x, y, z in grid]


def random_lattice(closes):
    degree = [RANDOM.randint(1, 4) for _ in range(3)]
    size = [d + 1 + RANDOM.randint(0, 3) for d in degree]
    if closes:
        degree[1], size[1] = 3, 7
    knots = [random_knots(n, d) for n, d in zip(size, degree)]
    count = size[0] * size[1] * size[2]
    if closes:
        knots[1] = "closed"
        points = [[(1 + i / size[0]) * f(2 * math.pi * j / size[1]) for f in (math.cos, math.sin)] + [k / size[2]]
                  for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
    else:
        points = bent([[i / size[0], j / size[1], k / size[2]] for k in range(size[2]) for j in range(size[1]) for i in range(size[0])])
    content = lattice(size=size, degree=degree, knots=knots, rest={"points": points},
                      deformed={"offsets": [[RANDOM.uniform(-0.02, 0.02) for _ in range(3)] for _ in range(count)]})
    if RANDOM.random() < 0.5:
        content["weights"] = [RANDOM.uniform(0.9, 1.1) for _ in range(count)]
        if RANDOM.random() < 0.5:
            content["deformed"]["weights"] = [h * RANDOM.choice((1, RANDOM.uniform(0.9, 1.1))) for h in content["weights"]]
    return content


def random_faces(content):
    """A continuity and faces of the lattice that may have it."""
    open_ones = [f for f in FACES if content["knots"]["uvw".index(f[0])] != "closed"]
    faces = RANDOM.sample(open_ones, RANDOM.randint(1, len(open_ones)))
    return RANDOM.randint(0, min(2, min(content["degree"]["uvw".index(f[0])] for f in faces) - 1)), faces


def random_place(direction):
    share = RANDOM.choice((0, 1e-3, 1 - 1e-3, 1, RANDOM.random(), RANDOM.random()))
    return direction.first + (direction.last - direction.first) * Fraction(share)


@case
def the_map_is_that_of_the_definition(run):
    """Any knots, degrees and weights, weights that move, curved and closed volumes: what the program makes of random places is what
    exact fractions make of the clamped map without its outermost layers."""
    for turn in range(repetitions(12)):
        content = random_lattice(turn % 3 == 2)
        k, faces = random_faces(content)
        volume = Volume(content)
        run.write("l.json", content)
        places = [[random_place(d) for d in volume.directions] for _ in range(25)]
        rest = [volume.place(p) for p in places]
        moved = [[float(x + d) for x, d in zip(p, volume.displacement(uvw, k, faces))] for p, uvw in zip(rest, places)]
        run.write("a.obj", obj_of([[float(x) for x in p] for p in rest]))
        seam = f"C{k}:{','.join(faces)}"
        found = entry(run, "deform", "a.obj", "b.obj", "-l", "l.json", "--seam", seam)
        equal(found["inside"], 25, "rounding does not take a place outside")
        near(obj_vertices(run.text("b.obj")), moved, 2e-13, (seam, content["knots"], content["degree"]))
        equal(found["seam"], {"continuity": f"C{k}", "faces": [sorted(faces, key=FACES.index)]})


@case
def displacement_and_derivatives_vanish_on_held_faces(run):
    """Of the lattice that `ffd lattice set` writes, in exact fractions: along each direction the numerator of the displacement is
    a polynomial whose first k + 1 coefficients at the face are 0, not nearly. The written lattice deforms as --seam does."""
    for turn in range(repetitions(8)):
        content = random_lattice(turn % 3 == 2)
        k, faces = random_faces(content)
        run.write("l.json", content)
        seam = f"C{k}:{','.join(faces)}"
        run.ffd("lattice", "set", "l.json", "--seam", seam, "-o", "s.json", "--force", err=anything)
        written = json.loads(run.text("s.json"))
        volume = Volume(written)
        for face in faces:
            a, at_end = "uvw".index(face[0]), face[1] == "+"
            direction = volume.directions[a]
            ends = [t for t in direction.t if direction.first < t < direction.last] + [direction.last if not at_end else direction.first]
            length = min(abs(t - (direction.last if at_end else direction.first)) for t in ends)
            uvw = [random_place(d) for d in volume.directions]
            steps = [length * Fraction(i, 2 * direction.degree + 1) for i in range(2 * direction.degree + 1)]
            values = []
            for step in steps:
                uvw[a] = direction.last - step if at_end else direction.first + step
                values.append(volume.parts(uvw)[0])
            for axis in range(3):
                found = coefficients([value[axis] for value in values], steps)
                equal(found[:k + 1], [0] * (k + 1), (seam, face, content["knots"], content["degree"]))
        grid = [[0.1 + 0.15 * i, 0.1 + 0.2 * j, 0.3] for i in range(6) for j in range(5)]
        near(carried(run, grid, "s.json", err=anything), carried_with(run, grid, "l.json", "--seam", seam), 1e-13, seam)


def carried_with(run, points, name, *options):
    run.write("with-in.obj", obj_of(points))
    run.ffd("deform", "with-in.obj", "with-out.obj", "-l", name, "--force", *options, err=anything)
    return obj_vertices(run.text("with-out.obj"))


# Which faces a mesh cuts.

def sheet(low, high, n=9, z=lambda x, y: 0.3):
    """A square grid of quads over these x and y."""
    points = [[low[0] + (high[0] - low[0]) * i / (n - 1), low[1] + (high[1] - low[1]) * j / (n - 1)] for j in range(n) for i in range(n)]
    quads = [(j * n + i + 1, j * n + i + 2, (j + 1) * n + i + 2, (j + 1) * n + i + 1) for j in range(n - 1) for i in range(n - 1)]
    return [[x, y, z(x, y)] for x, y in points], quads


def obj_with(points, quads, head=""):
    return obj_of(points) + head + "".join("f %d %d %d %d\n" % quad for quad in quads)


PUSH = [{"at": ["all", "all", "all"], "by": [0.1, 0.05, 0.2]}]


def cut_of(points, quads, low, high):
    """The faces of a box, and the vertices outside with a neighbour inside."""
    inside = [all(a <= x <= b for x, a, b in zip(p, low, high)) for p in points]
    edges = {(a - 1, b - 1) for quad in quads for a, b in zip(quad, quad[1:] + quad[:1])}
    outside = {a for edge in edges for a, b in (edge, edge[::-1]) if inside[b] and not inside[a]}
    return ({FACES[2 * a + side] for v in outside for a in range(3) for side in (0, 1)
             if (points[v][a] > high[a] if side else points[v][a] < low[a])}, len(outside))


@case
def the_faces_that_a_mesh_cuts(run):
    """Of random boxes and sheets: each is named, with the vertices, and the result is that of naming them."""
    for _ in range(repetitions(12)):
        low, high = [RANDOM.uniform(-2, 0) for _ in range(3)], [RANDOM.uniform(0.5, 2) for _ in range(3)]
        points, quads = sheet([RANDOM.uniform(-3, 0), RANDOM.uniform(-3, 0)], [RANDOM.uniform(0.5, 3), RANDOM.uniform(0.5, 3)],
                              z=lambda x, y: 0.3 + 0.4 * math.sin(x + y))
        faces, count = cut_of(points, quads, low, high)
        run.write("a.obj", obj_with(points, quads))
        run.write("l.json", lattice(size=(6, 6, 6), low=low, high=high, moves=PUSH))
        done = run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1", "--force", "--report", "r.json", "-v", err=anything)
        found = json.loads(run.text("r.json"))["jobs"][0]
        equal(found["seam"], {"continuity": "C1", "faces": [sorted(faces, key=FACES.index)]})
        if not faces:
            one_line(done, "l.json: the mesh cuts no face: none is held")
            continue
        words = " ".join(sorted(faces, key=FACES.index))
        one_line(done, rf"l\.json: the mesh cuts {len(faces)} faces?, held at C1: {re.escape(words)} \({count} vert")
        equal(found["tear"]["edges"], 0, "nothing is torn")
        run.ffd("deform", "a.obj", "named.obj", "-l", "l.json", "--seam", "C1:" + words.replace(" ", ","), "--force", err=anything)
        equal(run.read("o.obj"), run.read("named.obj"))
        run.ffd("deform", "a.obj", "plain.obj", "-l", "l.json", "--force", err=anything)
        check(run.read("o.obj") != run.read("plain.obj"))


@case
def a_mesh_that_is_not_cut_stays_as_without(run):
    """Inside, outside, of points, or in the plane of a face."""
    run.write("l.json", lattice(moves=PUSH))
    points, quads = sheet([-1, -1], [1, 1])
    for name, content in (("inside.obj", obj_with(points, quads)), ("points.obj", obj_of([[0, 0, 0], [5, 0, 0]])),
                          ("outside.obj", obj_with([[x + 9, y, z] for x, y, z in points], quads)),
                          ("apart.obj", obj_with(points + [[x + 9, y, z] for x, y, z in points], quads + [tuple(v + 81 for v in q) for q in quads]))):
        run.write(name, content)
        run.ffd("deform", name, "plain.obj", "-l", "l.json", "--force", err=anything)
        done = run.ffd("deform", name, "o.obj", "-l", "l.json", "--seam", "C1", "--force", "--report", "r.json", "-v", err=anything)
        equal(run.read("o.obj"), run.read("plain.obj"), name)
        one_line(done, "cuts no face: none is held")
        no_line(run.ffd("deform", name, "o.obj", "-l", "l.json", "--seam", "C1", "--force", err=anything), "no face")
        equal(json.loads(run.text("r.json"))["jobs"][0]["seam"], {"continuity": "C1", "faces": [[]]})
    # Its border is in the planes v- and v+, and it leaves through u+ alone.
    points, quads = sheet([-1, -2], [3, 2])
    run.write("flush.obj", obj_with(points, quads))
    equal(entry(run, "deform", "flush.obj", "o.obj", "-l", "l.json", "--seam", "C0")["seam"]["faces"], [["u+"]])
    for options in ([], ["--seam", "none"], ["--seam", "none:u-,w+"]):
        found = entry(run, "deform", "flush.obj", "o.obj", "-l", "l.json", *options)
        check("seam" not in found, options)
        run.ffd("deform", "flush.obj", "plain.obj", "-l", "l.json", "--force", err=anything)
        equal(run.read("o.obj"), run.read("plain.obj"), options)


@case
def curved_closed_and_turned_volumes_are_cut_too(run):
    """A cylinder whose axis and whose closed direction are no faces, a box that stands askew, a full turn whose two ends meet."""
    points, quads = sheet([-1.5, -0.5], [1.5, 0.5], n=13)
    run.write("a.obj", obj_with(points, quads))
    ring = {"center": [0, 0, -1], "axis": [0, 0, 1], "radius": [0.25, 1], "height": 3}
    run.write("ring.json", lattice(size=(5, 8, 6), knots=["clamped", "closed", "clamped"], rest={"cylinder": ring}, moves=PUSH))
    found = entry(run, "deform", "a.obj", "o.obj", "-l", "ring.json", "--seam", "C1")
    equal(found["seam"]["faces"], [["u-", "u+"]])
    equal(found["tear"]["edges"], 0)
    run.ffd("deform", "a.obj", "n.obj", "-l", "ring.json", "--seam", "C1:u-,u+", "--force", err=anything)
    equal(run.read("o.obj"), run.read("n.obj"))
    # Upright, through the last face of w, with vertices on the axis.
    upright = [[x, y, 2.5 + z] for x, z, y in sheet([-0.5, -2], [0.5, 0.5], n=9)[0]]
    upright = [[x, y - 0.3, z] for x, y, z in upright]
    run.write("up.obj", obj_with(upright, sheet([0, 0], [1, 1])[1]))
    run.write("full.json", lattice(size=(4, 8, 6), knots=["clamped", "closed", "clamped"], rest={"cylinder": {**ring, "radius": [0, 1]}}, moves=PUSH))
    equal(entry(run, "deform", "up.obj", "o.obj", "-l", "full.json", "--seam", "C1")["seam"]["faces"], [["w+"]])
    run.write("turn.json", lattice(size=(4, 9, 6), knots=["clamped"] * 3, rest={"cylinder": {**ring, "angle": [0, 360]}}, moves=PUSH))
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "turn.json", "--seam", "C0")["seam"]["faces"], [["u-", "u+"]])
    # A full turn round a square, whose ends meet in a plane that stands askew on the edge: what is past it is beyond the outside alone.
    corners = ((1, 0), (0, -1), (-1, 0), (0, 1), (1, 0))
    square = [[x, r * y - 0.4 * (1.5 - r) * z, r * z + 0.4 * (1.5 - r) * y] for r in (0.5, 1, 1.5) for y, z in corners for x in (-2, 0, 2)]
    run.write("square.json", lattice(size=(3, 5, 3), degree=(1, 1, 1), knots=["clamped"] * 3, rest={"points": square}, moves=[
        {"at": [1, "all", 1], "by": [0.1, 0, 0]}]))
    past = [[x, y, 0.05 if x > 0 else -0.05] for x, y, _ in sheet([-1, 0.7], [1, 4.7], n=9)[0]]
    run.write("past.obj", obj_with(past, sheet([0, 0], [1, 1], n=9)[1]))
    equal(entry(run, "deform", "past.obj", "o.obj", "-l", "square.json", "--seam", "C0")["seam"]["faces"], [["w+"]])
    half = math.sqrt(0.5)
    askew = {"min": [-1, -1, -2], "max": [1, 1, 2], "axes": [[half, half, 0], [-half, half, 0], [0, 0, 1]]}
    run.write("askew.json", lattice(rest={"box": askew}, moves=PUSH))
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "askew.json", "--seam", "C0")["seam"]["faces"], [["u-", "u+", "v-", "v+"]])


@case
def each_lattice_of_a_chain_is_held(run):
    """The second lattice meets the mesh where the first one has left it."""
    points, quads = sheet([-3, -1], [3, 1], n=21)
    run.write("a.obj", obj_with(points, quads))
    lift = {"at": ["all", "all", "all"], "by": [0, 0, 1.5]}
    run.write("lift.json", lattice(size=(7, 4, 4), low=(-3.5, -2, -2), high=(3.5, 2, 2), moves=[lift]))
    run.write("high.json", lattice(size=(6, 4, 4), low=(-1, -2, 1), high=(1.5, 2, 3), moves=PUSH))
    found = entry(run, "deform", "a.obj", "o.obj", "-l", "lift.json", "-l", "high.json", "--seam", "C1")
    equal(found["seam"]["faces"], [[], ["u-", "u+"]], "at rest the mesh is below the second one")
    run.write("low.json", lattice(size=(6, 6, 6), low=(-2, -2, -1), high=(2, 2, 0.8), moves=[lift]))
    found = entry(run, "deform", "a.obj", "two.obj", "-l", "low.json", "-l", "low.json", "--seam", "C1")
    equal(found["seam"]["faces"], [["u-", "u+"], ["u-", "u+", "w+"]])
    # One by one it is the same.
    run.ffd("deform", "a.obj", "first.obj", "-l", "low.json", "--seam", "C1", "--force", err=anything)
    run.ffd("deform", "first.obj", "second.obj", "-l", "low.json", "--seam", "C1:u-,u+,w+", "--force", err=anything)
    near(obj_vertices(run.text("two.obj")), obj_vertices(run.text("second.obj")), 1e-12)
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "low.json", "-l", "high.json", "--seam", "C0:u-")["seam"]["faces"], [["u-"], ["u-"]])
    # A box round the mesh is laid round what the held lattice before it leaves.
    run.write("round.json", lattice(rest={"box": "mesh", "margin": 0.1}, moves=PUSH))
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "low.json", "-l", "round.json", "--seam", "C1")["seam"]["faces"], [["u-", "u+"], []])


@case
def faces_between_blocks_are_free(run):
    """Two boxes side by side, a sheet that leaves both through their sides; also where a vertex is in the plane between them, and
    where the two stand at an angle."""
    points, quads = sheet([-1.8, -3], [1.8, 3], n=13)
    run.write("a.obj", obj_with(points, quads))
    run.write("left.json", lattice(size=(4, 6, 4), low=(-2, -2, -2), high=(0, 2, 2), moves=PUSH))
    run.write("right.json", lattice(size=(4, 6, 4), low=(0, -2, -2), high=(2, 2, 2), moves=PUSH))
    check(any(p[0] == 0 for p in points), "a row of vertices is in the plane between them")
    done = run.ffd("deform", "a.obj", "o.obj", "-l", "left.json", "-l", "right.json", "--blocks", "--seam", "C1", "--force",
                   "--report", "r.json", err=anything)
    found = json.loads(run.text("r.json"))["jobs"][0]
    equal(found["seam"]["faces"], [["v-", "v+"], ["v-", "v+"]])
    equal([found["tear"]["edges"], found["shared_faces"]["disagreeing"]], [0, 0])
    one_line(done, "left.json: the mesh cuts 2 faces, held at C1: v- v+")
    one_line(done, "right.json: the mesh cuts 2 faces, held at C1: v- v+")
    # Without --blocks each is cut by itself.
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "left.json", "-l", "right.json", "--seam", "C0")["seam"]["faces"],
          [["u+", "v-", "v+"], ["u-", "v-", "v+"]])

    def wedge(side):
        """A box of which the outer end is lower, so that there is a ridge where the two meet."""
        return [[side * x, y, z - 0.5 * x] for z in (-1, 0, 1) for y in (-2, -1, 0, 1, 2)
                for x in ((0, 1, 2) if side > 0 else (2, 1, 0))]
    for name, side in (("left.json", -1), ("right.json", 1)):
        run.write(name, lattice(size=(3, 5, 3), degree=(2, 2, 2), rest={"points": wedge(side)}, moves=PUSH))
    run.write("ridge.obj", obj_with([[x, 0.5 * y, 0.9 - 0.5 * abs(x) if abs(x) > 0.4 else 1.8] for x, y, _ in points], quads))
    faces = entry(run, "deform", "ridge.obj", "o.obj", "-l", "left.json", "-l", "right.json", "--blocks", "--seam", "C0")["seam"]["faces"]
    equal(faces, [["w+"], ["w+"]])


@case
def weights_shorten_what_held_lattices_do(run):
    """The faces are those of a mesh without weights, also of a second lattice: weights are of what all lattices do together."""
    points, quads = sheet([-3, -1], [3, 1], n=21)
    weights = [RANDOM.choice((0, 1, RANDOM.random())) for _ in points]
    run.write("a.obj", obj_with(points, quads))
    run.write("w.npy", npy(weights))
    run.write("lift.json", lattice(size=(7, 4, 4), low=(-3.5, -2, -2), high=(3.5, 2, 2), moves=[{"by": [0, 0, 1.5]}]))
    run.write("high.json", lattice(size=(6, 4, 4), low=(-1, -2, 1), high=(1.5, 2, 3), moves=PUSH))
    both = ["-l", "lift.json", "-l", "high.json", "--seam", "C1"]
    found = entry(run, "deform", "a.obj", "whole.obj", *both)
    weighted = entry(run, "deform", "a.obj", "o.obj", *both, "--weight", "w.npy")
    equal([weighted["seam"], weighted["tear"]["edges"]], [found["seam"], 0])
    equal(found["seam"]["faces"], [[], ["u-", "u+"]])
    whole = obj_vertices(run.text("whole.obj"))
    near(obj_vertices(run.text("o.obj")), [[a + w * (b - a) for a, b in zip(p, q)] for p, q, w in zip(points, whole, weights)], 1e-12)


@case
def what_is_selected_snapped_or_extended_counts(run):
    points, quads = sheet([-3, -1], [3, 1], n=25)
    run.write("l.json", lattice(size=(7, 6, 4), moves=PUSH))
    n = 25
    left = [q for q in quads if points[q[0] - 1][0] < -0.01]
    right = [q for q in quads if q not in left]
    run.write("a.obj", obj_of(points) + "g left\n" + "".join("f %d %d %d %d\n" % q for q in left)
              + "g right\n" + "".join("f %d %d %d %d\n" % q for q in right))
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1")["seam"]["faces"], [["u-", "u+"]])
    for group, face in (("left", "u-"), ("right", "u+")):
        equal(entry(run, "deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1", "--only", f"group:{group}")["seam"]["faces"], [[face]])
    # All that is outside of this one is within the snap.
    run.write("near.obj", obj_with([[x * 0.7, y, z] for x, y, z in points], quads))
    equal(entry(run, "deform", "near.obj", "o.obj", "-l", "l.json", "--seam", "C1")["seam"]["faces"], [["u-", "u+"]])
    equal(entry(run, "deform", "near.obj", "o.obj", "-l", "l.json", "--seam", "C1", "--snap", "0.2")["seam"]["faces"], [[]])
    # What is held passes on nothing.
    run.ffd("deform", "a.obj", "plain.obj", "-l", "l.json", "--seam", "C1", "--force", err=anything)
    for options in (["--outside", "extend"], ["--outside", "extend", "--falloff", "2"]):
        run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1", *options, "--force", err=anything)
        equal(run.read("o.obj"), run.read("plain.obj"), options)
    check(n * n == len(points))


# The other commands, and ways to say it.

def start(run):
    points, quads = sheet([-3, -1], [3, 1], n=17, z=lambda x, y: 0.3 + 0.1 * x * y)
    run.write("a.obj", obj_with(points, quads))
    run.write("l.json", lattice(size=(7, 5, 4), moves=[{"at": ["all", [1, 3], "all"], "by": [0.1, 0.05, {"$": "Z"}]}],
                              parameters={"Z": {"default": 0.3}}))
    return points, quads


@case
def an_embedding_is_that_of_the_lattice_as_it_is(run):
    start(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", err=anything)
    for seam in ("C1", "C0:u-", "C1:all"):
        run.ffd("deform", "a.obj", "searched.obj", "-l", "l.json", "--seam", seam, "--force", err=anything)
        run.ffd("deform", "a.obj", "reused.obj", "-l", "l.json", "--seam", seam, "--embedding", "e.npy", "--force", err=anything)
        equal(run.read("searched.obj"), run.read("reused.obj"), seam)


@case
def check_and_view_take_it(run):
    start(run)
    done = run.ffd("check", "a.obj", "-l", "l.json", "--seam", "C1", "--report", "r.json", err=anything)
    found = json.loads(run.text("r.json"))["jobs"][0]
    equal([found["seam"]["faces"], found["tear"]["edges"], found["folds"]["verdict"]], [[["u-", "u+"]], 0, "none"])
    one_line(done, "the mesh cuts 2 faces")
    run.ffd("check", "a.obj", "-l", "l.json", "--fail-on", "tear", code=NO, err=anything)
    run.ffd("check", "a.obj", "-l", "l.json", "--seam", "C1", "--fail-on", "tear", err=anything)
    # The proof is of the lattice with its held faces: it folds only there, or only without.
    run.write("folds.json", lattice(size=(7, 5, 4), moves=[{"at": [0, "all", "all"], "by": [3, 0, 0]}]))
    run.ffd("check", "a.obj", "-l", "folds.json", "--fail-on", "folds", code=NO, err=anything)
    run.ffd("check", "a.obj", "-l", "folds.json", "--fail-on", "folds", "--seam", "C0:u-", err=anything)
    run.write("slides.json", lattice(size=(7, 5, 4), moves=[{"by": [6, 0, 0]}]))
    run.ffd("check", "a.obj", "-l", "slides.json", "--fail-on", "folds", err=anything)
    run.ffd("check", "a.obj", "-l", "slides.json", "--fail-on", "folds", "--seam", "C0:u+", code=NO, err=anything)
    run.ffd("view", "a.obj", "-l", "l.json", "--seam", "C1", "-o", "held.png", err=anything)
    run.ffd("lattice", "set", "l.json", "--seam", "C1:u-,u+", "-o", "s.json")
    run.ffd("view", "a.obj", "-l", "s.json", "-o", "set.png", err=anything)
    equal(run.read("held.png"), run.read("set.png"), "the cage is that of the held lattice")
    one_line(run.ffd("view", "a.obj", "a.obj", "-l", "l.json", "--seam", "C1", "-o", "files.png", err=anything), "not used.*--seam")
    one_line(run.ffd("check", "a.obj", "-l", "l.json", "--seam", "C1", "--picture", "c.png", err=anything), "the mesh cuts 2 faces")


@case
def a_batch_takes_it_for_all_jobs_and_for_one(run):
    """The rows of a table share the mesh and its u,v,w, whichever faces are held."""
    batches.start(run)
    start(run)
    for name, seam, z in (("one.obj", "C1", 0.3), ("two.obj", "C0:u+", 0.3), ("three.obj", "none", 0.3), ("four.obj", "C1", -0.5)):
        run.ffd("deform", "a.obj", name, "-l", "l.json", "--seam", seam, "--set", f"Z={z}", err=anything)
    run.write("t.csv", "out,Z\nc1.obj,0.3\nc4.obj,-0.5\n")
    for more in ([], ["--force", "-j", "1"]):
        run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "l.json", "--seam", "C1", *more, err=anything)
        equal([run.read("c1.obj"), run.read("c4.obj")], [run.read("one.obj"), run.read("four.obj")])
    jobs = [batches.job(1, options={"seam": "C0:u+"}), batches.job(2), batches.job(3, options={"seam": "none"}), batches.job(4, set={"Z": -0.5})]
    run.write("m.jsonl", batches.lines_of(jobs))
    run.ffd("batch", "m.jsonl", "--seam", "C1", "--report", "r.jsonl", err=anything)
    for single, made in (("two.obj", "o1.obj"), ("one.obj", "o2.obj"), ("three.obj", "o3.obj"), ("four.obj", "o4.obj")):
        equal(run.read(made), run.read(single), made)
    found = sorted((json.loads(line) for line in run.text("r.jsonl").splitlines()), key=lambda job: job["output"])
    both = {"continuity": "C1", "faces": [["u-", "u+"]]}
    equal([job.get("seam") for job in found], [{"continuity": "C0", "faces": [["u+"]]}, both, None, both])
    # What depends on the option is made anew, and only that.
    said = run.ffd("batch", "m.jsonl", "--seam", "C0", "--resume", err=anything).err
    check("2 done, 2 up to date" in said[-1], said)
    run.write("bad.jsonl", batches.lines_of([batches.job(8, options={"seam": "C5"})]))
    run.ffd("batch", "bad.jsonl", code=(NO, USAGE, INVALID), err=anything)
    run.write("bad.jsonl", batches.lines_of([batches.job(8, options={"seam": "C3:u-"}), batches.job(9, options={"seam": "C1"})]))
    run.ffd("batch", "bad.jsonl", code=(NO, USAGE, INVALID), err=anything)
    check(not run.exists("o8.obj"))


@case
def morph_targets_have_their_own(run):
    points, quads = sheet([-3, -1], [3, 1], n=9)
    scene = Scene()
    place = scene.add(points, bounds=True)
    indices = scene.add([[v - 1] for q in quads for v in (q[0], q[1], q[2], q[0], q[2], q[3])], 5125, "SCALAR")
    scene.asset.update(scene=0, scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}],
                       meshes=[{"primitives": [{"attributes": {"POSITION": place}, "indices": indices}]}])
    run.write("a.glb", scene.glb())
    run.write("l.json", lattice(size=(7, 5, 4), moves=PUSH))
    run.write("k.json", lattice(size=(7, 5, 4), low=(-5, -2, -2), high=(2, 2, 2), moves=PUSH))
    run.ffd("deform", "a.glb", "o.glb", "-l", "l.json", "--seam", "C1", err=anything)
    done = run.ffd("deform", "a.glb", "m.glb", "--morph", "one=l.json", "--morph", "two=k.json", "--seam", "C1", "--report", "m-r.json", err=anything)
    one_line(done, 'morph target "one": l.json: the mesh cuts 2 faces')
    one_line(done, 'morph target "two": k.json: the mesh cuts 1 face, held at C1: u\\+')
    equal(json.loads(run.text("m-r.json"))["jobs"][0]["seam"], {"continuity": "C1", "faces": [["u-", "u+"], ["u+"]]})
    equal(entry(run, "deform", "a.glb", "s.glb", "-l", "l.json", "--as-morph", "one", "--seam", "C1")["seam"]["faces"], [["u-", "u+"]])
    for name in ("m.glb", "s.glb"):
        target = json.loads(run.read(name)[20:20 + int.from_bytes(run.read(name)[12:16], "little")])["meshes"][0]["primitives"][0]["targets"][0]
        moved = vectors(run.read("o.glb"), place)
        near([[p + d for p, d in zip(*both)] for both in zip(vectors(run.read("a.glb"), place), vectors(run.read(name), target["POSITION"]))],
             moved, 1e-6, name)


@case
def derivatives_are_those_of_the_held_lattice(run):
    """By the control points of the file: --check compares with differences. What held layers would do is left out."""
    start(run)
    for turn in range(repetitions(6)):
        content = random_lattice(turn % 3 == 2)
        k, faces = random_faces(content)
        volume = Volume(content)
        run.write("j.json", content)
        run.write("p.obj", obj_of([[float(x) for x in volume.place([random_place(d) for d in volume.directions])] for _ in range(20)]))
        for options in ([], ["--outside", "extend"], ["--components"]):
            run.ffd("jacobian", "p.obj", "-l", "j.json", "-o", "J.npz", "--seam", f"C{k}:{','.join(faces)}", "--check", "--force",
                    *options, data=True, err=anything)
    for options in (["--wrt", "parameters"], ["--wrt", "parameters", "--outside", "extend"], ["-l", "l.json", "--of", "0"], ["-l", "l.json"]):
        run.ffd("jacobian", "a.obj", "-l", "l.json", "-o", "J.npz", "--seam", "C1", "--check", "--force", *options, data=True, err=anything)
    # A product moves the mesh as the changed lattice does: J times offsets is the whole displacement, for it is linear in them.
    offsets = [[0.1, 0.05, 0.3] if 1 <= point // 7 % 5 <= 3 else [0, 0, 0] for point in range(140)]
    head = b"{'descr': '<f8', 'fortran_order': False, 'shape': (140, 3), }".ljust(117) + b"\n"
    run.write("v.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + b"".join(struct.pack("<3d", *row) for row in offsets))
    run.ffd("jacobian", "a.obj", "-l", "l.json", "-o", "x.npy", "--seam", "C1", "--times", "v.npy", data=True, err=anything)
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1", "--force", err=anything)
    product = struct.unpack_from(f"<{3 * 289}d", run.read("x.npy"), len(run.read("x.npy")) - 24 * 289)
    near([[q - p for p, q in zip(*both)] for both in zip(obj_vertices(run.text("a.obj")), obj_vertices(run.text("o.obj")))],
         [list(product[i:i + 3]) for i in range(0, len(product), 3)], 1e-14)


@case
def threads_and_instruction_sets_change_nothing(run):
    points, quads = sheet([-3, -3], [3, 3], n=80)
    run.write("a.obj", obj_with(points, quads))
    run.write("box.json", lattice(size=(6, 6, 4), moves=PUSH))
    run.write("bent.json", lattice(size=(5, 5, 4), rest={"points": [
        [x + 0.1 * y * y, y, z] for z in (-2, -1, 1, 2) for y in (-2, -1, 0, 1, 2) for x in (-2, -1, 0, 1, 2)]}, moves=PUSH))
    for lattices in (["box.json"], ["bent.json"], ["box.json", "bent.json"], ["bent.json", "box.json", "--blocks"]):
        options = [word for name in lattices for word in ((name,) if name.startswith("--") else ("-l", name))]
        texts = set()
        for more in (["--threads", "1"], ["--threads", "3"], ["--isa", "scalar"]):
            run.ffd("deform", "a.obj", "o.obj", *options, "--seam", "C1", "--force", *more, err=anything)
            texts.add(run.read("o.obj"))
        equal(len(texts), 1, lattices)


@case
def what_the_mesh_cuts_is_held_in_a_lattice_file(run):
    """ffd lattice set --seam without faces, round one mesh or several."""
    start(run)
    run.write("up.obj", obj_with(*[[[[x, z, y] for x, y, z in points], quads] for points, quads in [sheet([-1, -3], [1, 1])]][0]))
    run.ffd("lattice", "set", "l.json", "--seam", "C1:u-,u+", "-o", "named.json")
    one_line(run.ffd("lattice", "set", "l.json", "--seam", "C1", "--mesh", "a.obj", "-o", "cut.json", err=anything),
             "l.json: the mesh cuts 2 faces, held at C1: u- u\\+ \\(\\d+ vertices outside have an edge to inside\\)")
    equal(run.read("named.json"), run.read("cut.json"))
    run.ffd("lattice", "set", "l.json", "--seam", "C1:cut", "--mesh", "a.obj", "-o", "cut.json", "--force", err=anything)
    equal(run.read("named.json"), run.read("cut.json"))
    one_line(run.ffd("lattice", "set", "l.json", "--seam", "C1", "--mesh", "a.obj", "--mesh", "up.obj", "-o", "both.json", err=anything),
             "l.json: the meshes cut 3 faces, held at C1: u- u\\+ w-")
    # As it is when its turn comes.
    run.ffd("lattice", "set", "l.json", "--move", "-1.5,0,0", "--seam", "C1", "--mesh", "a.obj", "-o", "moved.json",
            err=re.compile("the mesh cuts 1 face, held at C1: u\\+"))
    run.write("in.obj", CUBE)
    done = run.ffd("lattice", "set", "l.json", "--seam", "C1", "--mesh", "in.obj", "-o", "free.json", "-v", err=anything)
    one_line(done, "l.json: the mesh cuts no face: none is held")
    run.ffd("lattice", "set", "l.json", "--strength", "1", "-o", "same.json")
    equal(run.read("free.json"), run.read("same.json"))
    run.ffd("lattice", "set", "l.json", "--seam", "C1", "-o", "n.json", code=USAGE,
            err=re.compile(r"--seam without faces holds those that a mesh cuts.*\(--mesh\)"))
    run.ffd("lattice", "set", "l.json", "--seam", "C1", "--mesh", "none.obj", "-o", "n.json", code=3, lines=1)
    run.ffd("lattice", "set", "l.json", "--seam", "C3", "--mesh", "a.obj", "-o", "n.json", code=USAGE, lines=1)
    check(not run.exists("n.json"))


@case
def what_cannot_be_held_is_refused(run):
    """With exit 2 and one line, and without an output; named faces before the mesh is read."""
    start(run)
    run.write("low.json", lattice(size=(5, 4, 4), degree=(2, 1, 3), moves=PUSH))
    run.write("ring.json", lattice(size=(5, 8, 6), knots=["clamped", "closed", "clamped"], rest={"cylinder": {
        "center": [0, 0, -1], "axis": [0, 0, 1], "radius": [0.25, 1], "height": 3}}, moves=PUSH))
    for name, seam, what in (
            ("l.json", "C3", "not C0, C1, C2 or none"), ("l.json", "c1", "not C0, C1, C2 or none"), ("l.json", "C1:", "not C0, C1, C2 or none"),
            ("l.json", "C1:x+", "not C0, C1, C2 or none"), ("l.json", "C1:u+,", "not C0"), ("l.json", "C1:u+ v+", "not C0"),
            ("l.json", "none:x+", "not C0"), ("l.json", "C1:all,u+", "not C0"), ("l.json", "", "not C0"),
            ("low.json", "C2:u-", "low.json: C2 needs degree 3 along u, which has degree 2"),
            ("low.json", "C1:w+,v-", "low.json: C1 needs degree 2 along v, which has degree 1"),
            ("low.json", "C1:all", "low.json: C1 needs degree 2 along v, which has degree 1"),
            ("ring.json", "C0:v-", "ring.json: direction v is closed: it has no faces"),
            ("low.json", "C2", "low.json: C2 needs degree 3 along u, which has degree 2")):
        for command in (["deform", "a.obj", "o.obj"], ["check", "a.obj"], ["jacobian", "a.obj", "-o", "o.npz"], ["view", "a.obj", "-o", "o.png"]):
            done = run.ffd(*command, "-l", name, "--seam", seam, code=USAGE, lines=1)
            check(what in done.err[0], done.err)
        check(not any(run.exists(name) for name in ("o.obj", "o.npz", "o.png")), seam)
    for name, seam in (("low.json", "C2:u-"), ("ring.json", "C1:v+")):
        done = run.ffd("deform", "missing.obj", "o.obj", "-l", name, "--seam", seam, code=USAGE, lines=1)
        check("missing" not in done.err[0], done.err)
    equal(entry(run, "deform", "a.obj", "o.obj", "-l", "ring.json", "--seam", "C0:all")["seam"]["faces"], [["u-", "u+", "w-", "w+"]])
    # One of several that cannot.
    run.ffd("deform", "a.obj", "n.obj", "-l", "l.json", "-l", "ring.json", "--seam", "C0:v-", code=USAGE, lines=1)
    # A mesh whose faces are not valid cannot tell what it cuts.
    run.write("bad.obj", obj_of([[0, 0, 0], [9, 0, 0], [0, 1, 0]]) + "f 1 2 7\n")
    run.ffd("deform", "bad.obj", "n.obj", "-l", "l.json", "--seam", "C1", code=INVALID, lines=1)
    check(not run.exists("n.obj"))


@case
def a_lattice_with_few_layers_is_warned_of(run):
    start(run)
    few = re.compile("l.json: faces held at C1 leave nothing that moves of 4 x 5 x 4 control points")
    run.write("l.json", lattice(size=(4, 5, 4), moves=PUSH))
    for seam in ("C1", "C1:u-,u+"):
        done = run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", seam, "--force", err=anything)
        one_line(done, few.pattern)
        no_line(done, "no vertex moves")
        equal(obj_vertices(run.text("o.obj")), obj_vertices(run.text("a.obj")))
    for size, seam, warns in (((5, 5, 4), "C1", False), ((4, 5, 4), "C0", False), ((4, 5, 4), "C2:u+", False), ((4, 4, 4), "C1:v-,v+", True)):
        run.write("l.json", lattice(size=size, moves=PUSH))
        said = run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", seam, "--force", err=anything).err
        equal(any("leave nothing that moves" in line for line in said), warns, (size, seam))
    run.write("l.json", lattice(size=(4, 5, 4)))
    no_line(run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--seam", "C1", "--force", err=anything), "leave nothing")


main()
