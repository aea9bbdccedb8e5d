#!/usr/bin/env python3
"""u,v,w of a vertex depend on the vertex and the lattice only: not on its place in the file, its neighbours, or the
number of threads, to the bit."""
import math
import random
import struct

from harness import SANITIZED, case, check, equal, glb, gltf_json, main

SECTION = [(i, j, k) for k in range(4) for j in range(4) for i in range(4)]


def lattice(size, degree, points, **members):
    return {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "rest": {"points": points},
            "moves": [{"at": [0, 0, 0], "by": [0.25, 0.125, -0.5]}], **members}


def bar(degrees, columns=14):
    """A bar on an arc, past a full turn overlapping itself."""
    points = []
    for k in range(3):
        for j in range(columns):
            angle = math.radians(degrees) * j / (columns - 1)
            points += [[(1 + i / 2) * math.cos(angle), (1 + i / 2) * math.sin(angle), k - 1] for i in range(3)]
    return lattice([3, columns, 3], [2, 3, 2], points)


def folded():
    draw = random.Random(11)
    return lattice([5, 4, 4], [3, 2, 3], [[draw.uniform(-2, 2) for _ in range(3)] for _ in range(80)])


def rational():
    draw = random.Random(12)
    points = [[i - 1.5 + 0.1 * j * j, j - 1.5 - 0.1 * i * k, k - 1.5] for i, j, k in SECTION]
    return lattice([4, 4, 4], [3, 3, 2], points, weights=[draw.uniform(0.5, 2) for _ in SECTION])


def cylinder():
    return {"format": "ffd-lattice", "version": 1, "size": [4, 8, 4],
            "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 2], "height": 3}},
            "moves": [{"at": [3, 0, 0], "by": [0.5, 0, 0]}]}


def box():
    return {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4],
            "rest": {"box": {"min": [-2, -2, -1], "max": [2, 2, 1]}}, "moves": [{"at": [3, 3, 3], "by": [1, 1, 1]}]}


LATTICES = {"c": bar(250), "overlap": bar(500), "folded": folded(), "rational": rational(), "cylinder": cylinder(),
            "box": box(), "stretched": {**box(), "rest": {"box": {**box()["rest"]["box"], "spacing": "uniform"}}}}


def vertices(count):
    """Also on axes, planes, corners, far away, and twice."""
    draw = random.Random(13)
    points = [(draw.uniform(-2.2, 2.2), draw.uniform(-2.2, 2.2), draw.uniform(-1.1, 1.1)) for _ in range(count)]
    points += [(0, 0, 0.25), (0, 0, -1), (1, 0, 0), (1.5, 0, -1), (2, 2, 1), (-2, -2, -1), (-0.0, 0.0, 0.0),
               (1e300, 0, 0), (5e-324, 0, 0.5), (0.1, 0.2, 1e9)]
    return [tuple(map(float, p)) for p in points + points[:count // 4]]


def obj(points):
    return "".join("v %r %r %r\n" % p for p in points)


def embed(run, mesh, lattice_file, *more):
    """For each vertex: the bytes of its u,v,w and its status."""
    run.ffd("embed", mesh, "-l", lattice_file, "-o", "e.npy", "--status", "s.npy", "--force", "-q", *more)
    data, statuses = run.read("e.npy"), run.read("s.npy")
    data = data[10 + struct.unpack_from("<H", data, 8)[0]:]
    statuses = statuses[10 + struct.unpack_from("<H", statuses, 8)[0]:]
    return [(data[24 * i:24 * i + 24], statuses[i]) for i in range(len(statuses))]


def deformed(run, mesh, lattice_file, *more):
    """The lines of the deformed vertices."""
    run.ffd("deform", mesh, "o.obj", "-l", lattice_file, "--force", "-q", *more)
    return [line for line in run.text("o.obj").splitlines() if line.startswith("v ")]


@case
def every_order_and_thread_count(run):
    points = vertices(400 if SANITIZED else 8000)
    order = list(range(len(points)))
    random.Random(14).shuffle(order)
    run.write("a.obj", obj(points))
    run.write("b.obj", obj([points[i] for i in order]))
    seen = set()
    for name, content in LATTICES.items():
        run.write("l.json", content)
        first = embed(run, "a.obj", "l.json", "-j", "1")
        equal(len(first), len(points))
        seen |= {status for _, status in first}
        equal(embed(run, "a.obj", "l.json", "-j", "2"), first, f"{name}, two threads")
        for threads in ("2",) if SANITIZED else ("1", "2"):
            other = embed(run, "b.obj", "l.json", "-j", threads)
            for place, i in enumerate(order):
                equal(other[place], first[i], f"{name}: vertex {points[i]} at {place} of the other file")
        moved = deformed(run, "a.obj", "l.json", "-j", "1")
        other = deformed(run, "b.obj", "l.json", "-j", "2")
        equal(other, [moved[i] for i in order], f"{name}, deformed")
        check(moved != obj(points).splitlines(), name, "moves nothing")
        same = {}
        for p, found in zip(points, first):
            # -0 and 0 are one place.
            equal(same.setdefault(tuple(x + 0.0 for x in p), found), found, f"{name}: {p} twice")
    check({0, 1, 2, 3} <= seen, "statuses seen:", seen)


@case
def alone_and_in_company(run):
    points = vertices(40)[:50]
    run.write("a.obj", obj(points))
    for name, content in LATTICES.items():
        run.write("l.json", content)
        first = embed(run, "a.obj", "l.json")
        run.write("double.obj", obj([p for p in points for _ in range(3)]))
        equal(embed(run, "double.obj", "l.json"), [found for found in first for _ in range(3)], f"{name}, three times")
        run.write("strangers.obj", "".join(obj([p]) + "v nan 0 0\nv 0 -1e308 1e308\n" for p in points))
        equal(embed(run, "strangers.obj", "l.json")[::3], first, f"{name}, among strangers")
        for i in range(0, len(points), 25 if SANITIZED else 7):
            run.write("one.obj", obj([points[i]]))
            equal(embed(run, "one.obj", "l.json"), [first[i]], f"{name}: {points[i]} alone")


@case
def other_files_same_places(run):
    """Single precision positions in a GLB and as numbers of an OBJ."""
    points = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in vertices(200)[:200]]
    run.write("a.obj", obj(points))
    run.write("a.glb", glb(*gltf_json(points)))
    for name, content in LATTICES.items():
        run.write("l.json", content)
        equal(embed(run, "a.glb", "l.json"), embed(run, "a.obj", "l.json"), name)


main()
