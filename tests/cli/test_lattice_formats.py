#!/usr/bin/env python3
"""ffd lattice convert: lattices of other programs. authoring/interop-*.json hold what these programs, or exact arithmetic of their
formulas, make of some points."""

import base64
import itertools
import json
import math
import os
import random
import re
import struct

from author import broken, offsets_of, reference_cases, rest_points
from harness import CUBE, INVALID, LIMIT, UNSUPPORTED, USAGE, case, check, equal, lattice, main, near, obj_vertices, repetitions
from lattice_files import SU2, Vts, grid, npy, plot3d, refitter, su2_box

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")


def convert(run, source, target, *more, **options):
    run.ffd("lattice", "convert", source, "-o", target, "--force", *more, **options)
    return json.loads(run.text(target)) if target.endswith(".json") else None


def random_offsets(count, most=0.1):
    return [[RANDOM.uniform(-most, most) for _ in range(3)] for _ in range(count)]


def refitter_of(source):
    """That of Blender's data: the columns of the matrix are perpendicular."""
    matrix = source["matrix_world"]
    scale = [math.sqrt(sum(matrix[r][c] ** 2 for r in range(3))) for c in range(3)]
    rotation = [[matrix[r][c] / scale[c] for c in range(3)] for r in range(3)]
    return refitter(source["size"], source["types"], rotation, [row[3] for row in matrix[:3]], scale, source["rest"], source["deformed"], kind="d")


@case
def what_other_programs_make(run):
    kinds = 0
    for name, of in reference_cases("interop"):
        kinds += 1
        run.write("BEFORE.obj", "".join("v {!r} {!r} {!r}\n".format(*p) for p in of["before"]) + "p 1\n")
        for member in ("prm", "rest_file", "deformed_file"):
            if member in of:
                ending = "prm" if member == "prm" else re.search(r"REST\.(\w+)", of["command"])[1]
                run.write({"prm": "X", "rest_file": "REST", "deformed_file": "DEFORMED"}[member] + "." + ending, of[member])
        command = of["command"]
        if "npz" in of or "source" in of:
            run.write("X.npz", base64.b64decode(of["npz"]) if "npz" in of else refitter_of(of["source"]))
            command = command if "npz" in of else "lattice convert X.npz -o CONVERTED; " + command
        for part in command.split(";"):
            names = {"L": "L.json", "L0": "L0.json", "CONVERTED": "C.json", "BEFORE": "BEFORE.obj", "OUT": "OUT.obj"}
            run.ffd(*(names.get(word, word) for word in part.split()), "--force", err=lambda lines: True, lines=None)
        near(obj_vertices(run.text("OUT.obj")), of["expect"]["after"], of["expect"].get("tolerance", 1e-13), name)
    equal(kinds, 8)


def turn(axis, angle):
    a, b = (axis + 1) % 3, (axis + 2) % 3
    rows = [[float(r == c) for c in range(3)] for r in range(3)]
    rows[a][a] = rows[b][b] = math.cos(angle)
    rows[b][a], rows[a][b] = math.sin(angle), -math.sin(angle)
    return rows


def times(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(3)) for c in range(3)] for r in range(3)]


@case
def lattices_of_blender_in_json(run):
    """What an add-on has kept as JSON is what an array file says of the same object."""
    types, angles = ["KEY_BSPLINE", "KEY_CARDINAL", "KEY_CATMULL_ROM"], [0.3, -0.4, 0.5]
    size, location, scale = (3, 2, 4), [1.0, -2.0, 0.5], [2.0, 1.5, -1.0]
    rest = [[-0.5 + i / 2, -0.5 + j, -0.5 + k / 3] for k in range(4) for j in range(2) for i in range(3)]
    moved = [[x + RANDOM.uniform(-0.1, 0.1) for x in p] for p in rest]
    half = [[p + (q - p) / 2 for p, q in zip(*both)] for both in zip(rest, moved)]
    run.write("a.npz", refitter(size, types, times(turn(2, angles[2]), times(turn(1, angles[1]), turn(0, angles[0]))), location, scale, rest, half, kind="d"))
    content = {"lattice_points": size, "lattice_object_location": location, "lattice_object_rotation": angles, "lattice_object_scale": scale,
               "lattice_interpolation_v": types[1], "lattice_interpolation_w": types[2], "lattice_modifier": {"strength": 0.5, "object": "x"}, "deformed_control_points": moved}
    run.write("a.json", content)
    first, second = (convert(run, name, "b.json", lines=1, err=re.compile("Blender's lattices act")) for name in ("a.npz", "a.json"))
    for member in ("size", "degree", "knots"):
        equal(first[member], second[member])
    near(rest_points(second), rest_points(first), 1e-14) if all(k == "clamped" for k in first["knots"]) else None
    near(sum(([first["rest"]["box"][m]] for m in ("min", "max")), []), [second["rest"]["box"][m] for m in ("min", "max")], 1e-14)
    near(offsets_of(second), offsets_of(first), 1e-14)
    for change, code, what in (
            ({"lattice_points": [3, 2, 5]}, INVALID, r"a\.json:1: /deformed_control_points"), ({"lattice_points": [3, 2.5, 4]}, INVALID, "2.5 is not a number of points"),
            ({"lattice_object_scale": None}, INVALID, "lattice_object_scale"), ({"lattice_interpolation_v": "KEY_CUBIC"}, INVALID, "KEY_CUBIC"),
            ({"lattice_object_scale": [1, 1, 0]}, INVALID, "has the scale 0 along z"), ({"lattice_points": [1e6, 1e6, 1e6]}, LIMIT, "more than 67108864"),
            ({"format": "ffd-lattice"}, INVALID, "unknown member|is missing|lattice_points")):
        run.write("a.json", {**content, **change})
        run.ffd("lattice", "convert", "a.json", "-o", "n.json", code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)


@case
def lattices_of_blender(run):
    """A direction of one point, negative scales, and what is refused."""
    identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    rest = [[x, y, 0.0] for y in (-0.5, 0.0, 0.5) for x in (-0.5, 0.5)]
    deformed = [[x + 0.25, y, z] for x, y, z in rest]
    types = ["KEY_LINEAR", "KEY_LINEAR", "KEY_BSPLINE"]
    parts = dict(size=(2, 3, 1), types=types, rotation=identity, location=[1, 2, 3], scale=[-2, 1, 4], rest=rest, deformed=deformed)
    advice = re.compile(r"a\.npz: Blender's lattices act beyond their box \(--outside extend\), and z is up in Blender: for glTF turn the lattice by -90 degrees about x \(`ffd lattice set`\)")
    for kind, packed in itertools.product("fd", (False, True)):
        run.write("a.npz", refitter(**parts, kind=kind, packed=packed))
        found = convert(run, "a.npz", "b.json", lines=1, err=advice)
        equal([found["size"], found["degree"], offsets_of(found)], [[2, 3, 2], [1, 1, 1], [[-0.5, 0, 0]] * 12])
        equal([rest_points(found)[0], rest_points(found)[11]], [[2, 1.5, 1], [0, 2.5, 5]])
    whole, odd = refitter(**parts), [[0.1, -0.5, 0.0]] + rest[1:]
    for data, code, what in (
            (refitter(**parts, version=2), UNSUPPORTED, "is of version 2, not 3"), (refitter(**{**parts, "scale": [1, 0, 1]}), INVALID, "has the scale 0 along y"),
            (refitter(**{**parts, "types": ["KEY_LINEAR", "KEY_CUBIC", "KEY_LINEAR"]}), UNSUPPORTED, 'the interpolation "KEY_CUBIC"'), (refitter(**{**parts, "rest": odd}), INVALID, "not on an even grid"),
            (refitter(**{**parts, "size": (2, 3, 2)}), INVALID, "of 18 elements, not of 36"), (refitter(**{**parts, "size": (65535, 65535, 65535)}), LIMIT, "more than 67108864"),
            (refitter(**{**parts, "size": (60000, 1000, 1)}), INVALID, "too few points"), (refitter(**parts, interp=None), INVALID, 'no array "interp"'),
            (refitter(**parts, magic=npy("|S4", "(1,)", b"MESH")), UNSUPPORTED, "not LATZ"), (refitter(**parts, U=npy("|S4", "(1,)", b"LATZ")), UNSUPPORTED, "another type than numbers"),
            (refitter(**parts, use_outside=b"x") , 0, ""), (refitter(**parts, rotation_quat=npy("<f4", "(4,)", b"\0" * 8)), INVALID, "not those of an array"), (whole[:-30], INVALID, "no end record"),
            (whole[:200] + b"\xff" * 40 + whole[240:], INVALID, ""), (b"PK", INVALID, "no end record"), (refitter(**parts, **{f"m{n}": b"" for n in range(60)}), LIMIT, "members; at most 64 are read"),
            (refitter(**{**parts, "location": [math.inf, 0, 0]}), INVALID, "not finite")):
        run.write("a.npz", data)
        run.ffd("lattice", "convert", "a.npz", "-o", "n.json", code=code, lines=1, err=re.compile(what))
        check(bool(code) != run.exists("n.json"), what)
        run.remove("n.json") if not code else None
    run.ffd("lattice", "convert", "b.json", "-o", "n.npz", code=USAGE, lines=1, err=re.compile("no ending of a lattice that is written"))


def same(run, source, target, what):
    """Two lattices have the same control points, offsets, weights, degrees and knots, to the bit."""
    convert(run, source, "one.csv")
    convert(run, target, "two.csv")
    equal(run.read("two.csv"), run.read("one.csv"), what)


@case
def out_and_back(run):
    """All that a format holds, to the bit."""
    for _ in range(repetitions(5)):
        size = [RANDOM.randint(2, 5) for _ in range(3)]
        count = size[0] * size[1] * size[2]
        plain = [min(3, n - 1) for n in size]
        points = [[i + RANDOM.uniform(-0.2, 0.2), j + RANDOM.uniform(-0.2, 0.2), k + RANDOM.uniform(-0.2, 0.2)]
                  for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
        run.write("plain.json", lattice(size=size, degree=plain, rest={"points": points}))
        for ending in ("xyz", "fmt", "npy", "obj", "csv", "vtk", "vts"):
            convert(run, "plain.json", f"a.{ending}")
            convert(run, f"a.{ending}", "b.json")
            same(run, "plain.json", "b.json", ending)
        run.write("both.json", lattice(size=size, degree=plain, rest={"points": points}, deformed={"offsets": random_offsets(count)}))
        convert(run, "both.json", "a.obj")
        near(offsets_of(convert(run, "a.obj", "b.json")), offsets_of(json.loads(run.text("both.json"))), 1e-14)
        degree = [RANDOM.randint(1, n - 1) for n in size]
        knots = [RANDOM.choice(["clamped", "open", sorted(RANDOM.uniform(0, 1) for _ in range(n + d + 1))]) for n, d in zip(size, degree)]
        run.write("all.json", lattice(size=size, degree=degree, knots=knots, rest={"points": points}, weights=[RANDOM.uniform(0.5, 2) for _ in range(count)],
                                      deformed={"offsets": random_offsets(count), "weights": [RANDOM.uniform(0.5, 2) for _ in range(count)]}))
        for ending in ("csv", "vtk", "vts"):
            convert(run, "all.json", f"a.{ending}")
            convert(run, f"a.{ending}", "b.json")
            same(run, "all.json", "b.json", ending)
    run.write("round.json", lattice(size=(3, 6, 3), degree=(2, 3, 2), knots=["clamped", "closed", "clamped"], deformed={"offsets": random_offsets(54)},
                                    rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}))
    convert(run, "round.json", "a.vtk")
    convert(run, "a.vtk", "b.json")
    same(run, "round.json", "b.json", "closed knots")
    # A cage of a closed direction ends where it began.
    convert(run, "round.json", "a.obj", lines=1, err=re.compile("a cage holds positions alone, not the knots of u, closed knots of v, knots of w|closed knots of v"))
    check(re.search(r"^l 1 4 7 10 13 16 1$", run.text("a.obj"), re.M), "a ring")


@case
def boxes_of_pygem(run):
    for _ in range(repetitions(5)):
        size = [RANDOM.randint(2, 6) for _ in range(3)]
        angles = [RANDOM.uniform(-180, 180), RANDOM.choice([90, -90, RANDOM.uniform(-89, 89)]), RANDOM.uniform(-180, 180)]
        run.write("box.json", lattice(size=size, degree=[n - 1 for n in size], low=(-1, 0, 2), high=(2, 1, 4),
                                      deformed={"offsets": random_offsets(size[0] * size[1] * size[2])}))
        run.ffd("lattice", "set", "box.json", *(w for letter, angle in zip("zyx", angles[::-1]) for w in ("--rotate", f"{letter},{angle!r}")),
                *(["--scale", "-1"] if RANDOM.random() < 0.3 else []), "-o", "turned.json", "--force")
        convert(run, "turned.json", "a.prm")
        found, turned = convert(run, "a.prm", "b.json"), json.loads(run.text("turned.json"))
        equal([found["size"], found["degree"]], [turned["size"], turned["degree"]])
        near(rest_points(found), rest_points(turned), 1e-14)
        near(offsets_of(found), offsets_of(turned), 1e-15)
    text = "[Box info]\nN CONTROL POINTS x = 3\nn control points y: 1\nn control points z=2\n; a comment\nbox length x: -2\nbox length y: 1\nbox length z: 4\n" \
           "box origin x: 1\nbox origin y: 2\nbox origin z: 3\nrotation angle x: 0\nrotation angle y: 0\nrotation angle z: 0\n\n" \
           "[Parameters weights]\nparameter x: 1 0 1 9\n\n   # within\n   1 0 1 0.25\nparameter y: 2 0 0 0.5\nparameter z: 0 0 0 -1\n"
    run.write("a.prm", text)
    found = convert(run, "a.prm", "b.json")
    equal([found["size"], found["degree"]], [[3, 2, 2], [2, 1, 1]])
    near(rest_points(found)[::11], [[1, 2, 3], [-1, 3, 7]], 0)
    moved = {n: d for n, d in enumerate(offsets_of(found)) if any(d)}
    equal(moved, {0: [0, 0, -4], 3: [0, 0, -4], 2: [0, 0.5, 0], 5: [0, 0.5, 0], 7: [-0.5, 0, 0], 10: [-0.5, 0, 0]})
    for change, code, what in (
            (("POINTS x = 3", "POINTS x = 16"), UNSUPPORTED, r"a\.prm:2: 16 control points are Bernstein polynomials of degree 15"),
            (("POINTS x = 3", "POINTS x = 0"), INVALID, r"a\.prm:2: 0 is not a number of control points"),
            (("POINTS x = 3", "POINTS x = 2.5"), INVALID, "2.5 is not a number"), (("length y: 1", "length y: 0"), INVALID, r"a\.prm:7: the box has no length"),
            (("box origin y: 2\n", ""), INVALID, r'has no "box origin y" in the section \[Box info\]'), (("1 0 1 9", "1 1 1 9"), INVALID, r'"1" is not an index below 1'),
            (("1 0 1 9", "1 0 1"), INVALID, "three indices and a"), (("1 0 1 9", "1 0 1 nan"), INVALID, "finite"), (("origin x: 1", "origin x: one"), INVALID, "not one finite number"),
            (("box origin x: 1", "box origin x: 1\nBox Origin X: 2"), INVALID, "is there twice, first in line 9")):
        run.write("a.prm", text.replace(*change))
        run.ffd("lattice", "convert", "a.prm", "-o", "n.json", code=code, lines=1, err=re.compile(what))
    for content in (lattice(size=(5, 4, 4)), lattice(knots=["open", "clamped", "clamped"]), lattice(weights=[1.0] * 63 + [2.0]), lattice(rest={"points": [[i % 4, i // 4 % 4, i // 16] for i in range(64)]})):
        run.write("no.json", content)
        run.ffd("lattice", "convert", "no.json", "-o", "n.prm", code=UNSUPPORTED, lines=1, err=re.compile("a box of Bernstein polynomials alone"))
    check(not run.exists("n.json") and not run.exists("n.prm"))


@case
def grids_of_plot3d(run):
    blocks = [((3, 2, 2), grid(3, 2, 2)), ((2, 4, 3), grid(2, 4, 3))]
    run.write("a.xyz", plot3d(blocks))
    for number, (size, points) in enumerate(blocks):
        found = convert(run, "a.xyz", "b.json", "--block", str(number))
        equal([found["size"], rest_points(found)], [list(size), points])
    run.write("a.fmt", plot3d(blocks[:1], ""))
    equal(convert(run, "a.fmt", "b.json")["size"], [3, 2, 2])
    run.ffd("lattice", "convert", "a.fmt", "-o", "b.json", "--force", "--degree", "1")
    run.write("rest.json", lattice(size=(2, 4, 3), degree=(1, 3, 2), rest={"points": grid(2, 4, 3)}))
    run.ffd("lattice", "set", "rest.json", "--deformed", "a.xyz", "--block", "1", "-o", "c.json")
    check("deformed" not in json.loads(run.text("c.json")), "the same points")
    run.write("z.xyz", plot3d([((2, 3, 4), [[x, y, z] for x in (2.0, 0.0) for y in (1.0, 2.0, 4.0) for z in (0.0, 1.0, 3.0, 4.0)])]))
    found = convert(run, "z.xyz", "b.json", "--order", "auto", lines=1, err=re.compile("2 x 3 x 4 control points"))
    equal(rest_points(found)[::23], [[0, 1, 0], [2, 4, 4]])
    for text, more, code, what in (
            (plot3d(blocks), [], UNSUPPORTED, r"has 2 blocks, which are several lattices: choose one, from 0 \(--block\)"),
            (plot3d(blocks), ["--block", "2"], USAGE, "has no block 2: there are 2, from 0"), (plot3d(blocks), ["--block", "WING"], USAGE, "has numbered blocks"),
            (plot3d(blocks) + "1\n", [], INVALID, "numbers, which are not those of Plot3D"), ("", [], INVALID, "has 0 numbers"), ("a b c", [], INVALID, "are not those"),
            ("1\n2 2 2\n" + "0 " * 24 + "1 " * 8, [], UNSUPPORTED, "IBLANK"), ("2 2 2\n" + "0 " * 32, [], UNSUPPORTED, "IBLANK"),
            (b"\1\0\0\0" + b"\0" * 60, [], UNSUPPORTED, "binary"), ("1\n2 2 1\n" + "0 " * 12, [], INVALID, "has 1 control point along w, which has no extent"),
            ("1\n2 2 2\n" + "0 " * 23 + "x", [], INVALID, r'a\.xyz:3: "x" is not a finite number'), ("1\n99999999999 99999999999 99999999999\n", [], INVALID, "are not those")):
        run.write("a.xyz", text)
        run.ffd("lattice", "convert", "a.xyz", "-o", "n.json", *more, code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)


@case
def boxes_of_su2(run):
    run.write("a.su2", SU2 + su2_box("WING", (4, 3, 2)))
    found = convert(run, "a.su2", "b.json")
    equal([found["size"], found["degree"]], [[4, 3, 2], [3, 2, 1]])
    near(rest_points(found), [[2 * i / 3, j / 2, 3 * k] for k in range(2) for j in range(3) for i in range(4)], 1e-15)
    points = [[i, j, k, 2 * i / 3, j / 2, 3 * k + 0.25 * i * j] for i in range(4) for j in range(3) for k in range(2)]
    RANDOM.shuffle(points)
    run.write("b.su2", SU2 + su2_box("WING", (4, 3, 2), points=points) + su2_box("TAIL", (5, 3, 2), "BSPLINE_UNIFORM", (4, 3, 2)))
    run.ffd("lattice", "set", "b.json", "--deformed", "b.su2", "--block", "WING", "-o", "c.json")
    near(offsets_of(json.loads(run.text("c.json"))), [[0, 0, 0.25 * i * j] for k in range(2) for j in range(3) for i in range(4)], 1e-15)
    found = convert(run, "b.su2", "b.json", "--block", "TAIL")
    equal([found["size"], found["degree"], found["knots"]], [[5, 3, 2], [3, 2, 1], ["clamped"] * 3])
    flat = [[i, j, i * 1.5, j * 1.0] for i in range(3) for j in range(2)]
    run.write("flat.su2", su2_box("AIRFOIL", (3, 2, 1), points=flat, flat=True))
    found = convert(run, "flat.su2", "b.json")
    equal([found["size"], found["degree"]], [[3, 2, 2], [2, 1, 1]])
    equal(rest_points(found), [[i * 1.5, j, z] for z in (-0.5, 0.5) for j in range(2) for i in range(3)])
    run.write("flat.su2", su2_box("AIRFOIL", (3, 2, 1), flat=True))
    equal(rest_points(convert(run, "flat.su2", "b.json"))[-1], [2, 1, 0.5])
    whole = su2_box("WING", (4, 3, 2), points=points)
    for text, more, code, what in (
            (run.text("b.su2"), [], UNSUPPORTED, r"has 2 FFD boxes, which are several lattices: choose one \(--block\) of WING, TAIL"),
            (run.text("b.su2"), ["--block", "KEEL"], USAGE, 'has no FFD box "KEEL"'), (SU2, [], INVALID, "has no FFD box"),
            (su2_box("W", (16, 2, 2)), [], UNSUPPORTED, "degree 15 along I; degrees to 14"), (su2_box("W", (4, 3, 2), "NURBS"), [], UNSUPPORTED, "NURBS"),
            (su2_box("W", (4, 3, 2), "BSPLINE_UNIFORM", (5, 3, 2)), [], INVALID, "4 control points along I, too few for order 5"),
            (su2_box("W", (4, 3, 2), "BSPLINE_UNIFORM"), [], INVALID, "no BSPLINE_ORDER_I"), (su2_box("W", (4, 3, 2), points=points[1:]), [], INVALID, "23 control points, but its degrees need 24"),
            (su2_box("W", (4, 3, 2), points=points[1:] + points[1:2]), [], INVALID, "is there twice"), (whole.replace("FFD_DEGREE_J= 2\n", ""), [], INVALID, "no FFD_DEGREE_J"),
            (whole.replace("FFD_CORNER_POINTS= 8", "FFD_CORNER_POINTS= 7"), [], INVALID, "7 corners"), (whole, ["--degree", "2"], USAGE, "tells its degree itself"),
            (whole, ["--size", "2"], USAGE, "tells its size itself"), (whole[:500], [], INVALID, ""), (whole[:whole.index("FFD_SURFACE")][:-40], [], INVALID, "not an index below|ends where a number")):
        run.write("a.su2", text)
        run.ffd("lattice", "convert", "a.su2", "-o", "n.json", *more, code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)
    run.ffd("lattice", "convert", "b.json", "-o", "n.su2", code=USAGE, lines=1, err=re.compile(r"n\.su2: has no ending of a lattice that is written: \.json"))


@case
def cages(run):
    run.write("a.obj", "".join("v {} {} {}\n".format(*p) for p in grid(3, 4, 2)) + "f 1 2 3\n")
    # Without a size of its own the points tell the order, unless they are to be taken as they stand.
    found = re.compile(r"(a|both|hint)\.obj: 3 x 4 x 2 control points along u, v, w")
    for size, order, said in (("3,4,2", [], {"err": found}), ("4,2,3", [], {"err": found}), ("2,4,3", ["--order", "auto"], {"err": found}),
                              ("3,4,2", ["--order", "uvw"], {})):
        made = convert(run, "a.obj", "b.json", "--size", size, *order, **said)
        equal([made["size"], made["degree"], rest_points(made)], [[3, 4, 2], [2, 3, 1], grid(3, 4, 2)])
    # Both states get the order of the first; some cells of the other one are turned over.
    back = [p for k in range(2) for j in range(4) for p in grid(3, 4, 2)[3 * (4 * k + j):][:3][::-1]]
    run.write("both.obj", "".join("v {} {} {}\n".format(*p) for p in back + [[9 * math.cos(7 * x), y, z + 0.5 * x] for x, y, z in back]))
    made = convert(run, "both.obj", "b.json", "--size", "3,4,2", err=found)
    equal(rest_points(made), grid(3, 4, 2))
    near(offsets_of(made), [[9 * math.cos(7 * x) - x, 0, 0.5 * x] for x, _, _ in grid(3, 4, 2)], 1e-15 * 4)
    run.write("hint.obj", "# ffd-lattice size 3 4 2\n" + run.text("a.obj"))
    equal(convert(run, "hint.obj", "b.json")["size"], [3, 4, 2])
    equal(convert(run, "hint.obj", "b.json", "--order", "auto", err=found)["size"], [3, 4, 2])
    # Any order of so few points may by chance have all its cells of one sign: the layers here are turned against each other.
    lower, upper = grid(3, 4, 2)[:12], grid(3, 4, 2)[12:]
    run.write("mixed.obj", "".join("v {} {} {}\n".format(*p) for p in lower + upper[::-1]))
    for name, more, code, what in (
            ("a.obj", [], USAGE, r"has 24 points in a row: give .* \(--size\)"), ("a.obj", ["--size", "3,3,3"], INVALID, "has 24 points, but a lattice of 3 x 3 x 3"),
            ("hint.obj", ["--size", "3,4,2"], USAGE, "tells its size itself"), ("mixed.obj", ["--size", "3,4,2"], INVALID, "is not a grid of 3 x 4 x 2 points in any order"),
            ("none.obj", ["--size", "2"], INVALID, "has no points"), ("nan.obj", ["--size", "2"], INVALID, r"nan\.obj:1: v is not followed by three finite"),
            ("a.obj", ["--size", "3,4,2", "--block", "1"], USAGE, "has no blocks: --block is not for it")):
        run.write("none.obj", "f 1 2 3\n")
        run.write("nan.obj", "v 1 2 nan\n")
        run.ffd("lattice", "convert", name, "-o", "n.json", *more, code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)
    run.ffd("lattice", "refine", "b.json", "--size", "5", "-o", "n.obj", code=USAGE, lines=1, err=re.compile("has the ending of a mesh"))


def binary_vtk(version="3.0", kind="double"):
    """A grid as VTK writes it in binary, with arrays that mean nothing here."""
    code = {"double": "d", "float": "f"}[kind]
    points = [x for p in grid(3, 2, 2) for x in p]
    data = f"# vtk DataFile Version {version}\nvtk output\nBINARY\nDATASET STRUCTURED_GRID\nDIMENSIONS 3 2 2\nPOINTS 12 {kind}\n".encode()
    data += struct.pack(f">36{code}", *points) + b"\n"
    data += b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n" if version == "5.1" else b""
    data += b"CELL_DATA 2\nSCALARS weight int 1\nLOOKUP_TABLE default\n" + struct.pack(">2i", 7, 8) + b"\nPOINT_DATA 12\n"
    data += b"SCALARS colour unsigned_char 3\nLOOKUP_TABLE own\n" + bytes(36) + b"\nLOOKUP_TABLE own 2\n" + bytes(8) + b"\n"
    data += b"TEXTURE_COORDINATES uv 2 float\n" + struct.pack(">24f", *range(24)) + b"\nVECTORS offset float\n" + struct.pack(">36f", *([0.5] * 36)) + b"\n"
    return data + b"FIELD FieldData 2\nother 2 12 long\n" + struct.pack(">24q", *range(24)) + b"\nweight 1 12 double\n" + struct.pack(">12d", *([2.0] * 11 + [1.0])) + b"\n"


@case
def grids_of_vtk(run):
    rounded = re.compile(r"o\.vtk: VTK writes text with 11 digits: write binary for all of them")
    run.write("l.json", lattice())
    convert(run, "l.json", "o.vtk")
    for title, said in (("lattice of ffd", {}), ("vtk output", {"err": rounded}), ("vtk output of mine", {})):
        run.write("o.vtk", run.text("o.vtk").replace(run.text("o.vtk").splitlines()[1], title, 1))
        convert(run, "o.vtk", "b.json", **said)
    for version in ("3.0", "4.2", "5.1"):
        for kind in ("double", "float"):
            run.write("a.vtk", binary_vtk(version, kind))
            found = convert(run, "a.vtk", "b.json")
            equal([found["size"], found["degree"], rest_points(found)], [[3, 2, 2], [2, 1, 1], grid(3, 2, 2)])
            equal([offsets_of(found), found["weights"]], [[[0.5] * 3] * 12, [2] * 11 + [1]])
    equal(convert(run, "a.vtk", "b.json", "--degree", "1")["degree"], [1, 1, 1])
    run.write("w.json", lattice(weights=[2.0] * 32 + [1.0] * 32))
    convert(run, "w.json", "w.vtk")
    text, data = run.text("w.vtk"), binary_vtk()
    for content, more, code, what in (
            (text.replace("# vtk", "# vkt"), [], INVALID, "does not begin with"), (text.replace("STRUCTURED_GRID", "POLYDATA"), [], UNSUPPORTED, "a POLYDATA, not a STRUCTURED_GRID"),
            (text.replace("ASCII", "TEXT"), [], INVALID, '"TEXT" is not ASCII or BINARY'), (text.replace("DIMENSIONS 4 4 4", "DIMENSIONS 4 4 5"), [], INVALID, "there are 64 points, but the dimensions"),
            (text.replace("DIMENSIONS 4 4 4\n", ""), [], INVALID, "POINTS are there before DIMENSIONS"), (text.replace("DIMENSIONS 4 4 4", "DIMENSIONS 16 4 1"), [], INVALID, "1 control point along w"),
            (text.replace("3 3 3\n", "3 3 15\n", 1), [], INVALID, 'has 15 in the array "ffd_degree"'), (text.replace("0 0 0 0 1 1 1 1", "0 0 0 0 1 1 1 x", 1), [], INVALID, r'a\.vtk:\d+: "x" is not a finite number'),
            (text.replace("ffd_knots_u 8", "ffd_knots_u 7").replace("0 0 0 0 1 1 1 1", "0 0 0 0 1 1 1", 1), [], INVALID, 'array "ffd_knots_u" of 7 numbers, not of 8'),
            (text.replace("weight", "offset"), [], INVALID, "twice|components"), (re.sub(r"\n2\n", "\n-2\n", text, count=1), [], INVALID, "the weight -2, which is not positive"),
            (text, ["--degree", "2"], USAGE, "tells its degree itself"), (data[:-40], [], INVALID, "ends within an array"), (data[:300], [], INVALID, "ends within"),
            (text.replace("POINTS 64 double", "POINTS 64 string"), [], UNSUPPORTED, 'the type "string"'), (text.replace("VECTORS", "VOXELS"), [], UNSUPPORTED, "|"),
            (text.replace("DIMENSIONS 4 4 4", "DIMENSIONS 4000000 4000000 4"), [], LIMIT, "more than 67108864 control points")):
        run.write("a.vtk", content)
        run.ffd("lattice", "convert", "a.vtk", "-o", "n.json", *more, code=(code,) if what != "|" else (INVALID, UNSUPPORTED), lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)


@case
def grids_of_vtk_in_xml(run):
    points, offsets = grid(3, 4, 2), [[0.25 * i, 0.5, -1.0] for i in range(24)]
    for place, packed, order, header, encoding, kind in itertools.product(("binary", "appended"), (False, True), ("LittleEndian", "BigEndian"), ("UInt32", "UInt64"),
                                                                          ("raw", "base64"), "df"):
        run.write("a.vts", Vts(place, packed, order, header, encoding).file(points, offsets, kind=kind))
        found = convert(run, "a.vts", "b.json")
        equal([found["size"], rest_points(found), offsets_of(found)], [[3, 4, 2], points, offsets], (place, packed, order, header, encoding, kind))
    run.write("w.json", lattice(size=(3, 4, 5), degree=(2, 1, 4), weights=[2.0] * 32 + [1.0] * 28, deformed={"offsets": random_offsets(60), "weights": [1.5] * 60}))
    convert(run, "w.json", "w.vts")
    convert(run, "w.vts", "b.json")
    same(run, "w.json", "b.json", "vts")
    text, plain, packed = run.text("w.vts"), Vts("appended", False).file(points, offsets), Vts("binary", True).file(points, offsets)
    bomb = Vts("appended", True, block=1 << 20)
    bomb.array("Points", 3, [0.0] * 400000)
    for content, code, what in (
            (text.replace("StructuredGrid", "ImageData"), UNSUPPORTED, "is a ImageData of VTK"), (packed.replace(b"vtkZLib", b"vtkLZ4"), UNSUPPORTED, "vtkLZ4DataCompressor"),
            ("<!DOCTYPE x>\n" + text, INVALID, "document type"), (text.replace('Name="offset"', 'Name="&amp;"'), INVALID, "entities"), (text[:-1000], INVALID, ""),
            (text.replace("<Piece Extent=", "<Piece Extents="), INVALID, "without an Extent"), (text.replace("0 2 0 3 0 4", "0 2 0 3 0 5"), INVALID, r"ends where a number|is not of"),
            (text.replace("0 2 0 3 0 4", "0 2 0 3 0 0"), INVALID, "has 1 control point along w"), (text.replace("0 2 0 3 0 4", "0 2 0 3 x"), INVALID, "not six whole numbers"),
            (text.replace("Float64", "Float80"), UNSUPPORTED, "Float80"), (re.sub(r'(Name="points"[^>]*>\n)\S+', r"\1half", text), INVALID, '"half" is not a finite number'), (plain[:-400], INVALID, "ends"),
            (plain.replace(b'offset="0"', b'offset="99999"'), INVALID, "at the offset 99999"),
            (Vts("binary", True, excess=1).file(points, offsets), INVALID, "are longer than what they should hold"),
            (Vts("binary", True, excess=-1).file(points, offsets), INVALID, "are shorter than what they should hold"),
            (re.sub(rb"eJ\w{6}", b"eJAAAAAA", packed, count=1), INVALID, "broken|shorter|longer|compressed"), (b"no XML", INVALID, "does not begin with a tag of XML"), (text.replace("Piece", "Peace"), INVALID, "no Piece|outside of a Piece"),
            (text.replace("</VTKFile>", ""), INVALID, "ends before </VTKFile>"), (plain.replace(b"</VTKFile>", b""), INVALID, "ends before </VTKFile>"),
            (bomb.front.encode() + b'<StructuredGrid><Piece Extent="0 1 0 1 0 1"><Points><DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/>'
             + b'</Points></Piece></StructuredGrid><AppendedData encoding="raw">_' + bomb.appended + b"</AppendedData></VTKFile>", INVALID, "more than 192 bytes")):
        run.write("a.vts", content)
        run.ffd("lattice", "convert", "a.vts", "-o", "n.json", code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), what)


@case
def other_commands_name_this_one(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice())
    for ending, what in (("xyz", "Plot3D"), ("prm", "a file of PyGeM"), ("vtk", "a structured grid"), ("su2", "a mesh of SU2")):
        run.write("b.su2", su2_box("W", (2, 2, 2)))
        if ending != "su2":
            convert(run, "l.json", f"b.{ending}")
        run.ffd("deform", "a.obj", "o.obj", "-l", f"b.{ending}", code=INVALID, err=f"b.{ending}: is not JSON: of {what} `ffd lattice convert` makes a lattice file")
    run.write("b.json", {"lattice_points": [2, 2, 2], "deformed_control_points": []})
    run.ffd("deform", "a.obj", "o.obj", "-l", "b.json", code=INVALID, err="b.json: is no lattice file: of a lattice of Blender `ffd lattice convert` makes one")
    run.ffd("lattice", "convert", "l.json", "-o", "l.obj")
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.obj", code=INVALID, err="l.obj: is not JSON: of a cage `ffd lattice convert` makes a lattice file")


@case
def broken_files(run):
    """Bytes changed, cut and doubled anywhere: a lattice, or one line and exit 2, 4, 6 or 7."""
    run.write("l.json", lattice(size=(3, 2, 4), degree=(2, 1, 3), deformed={"offsets": random_offsets(24)}))
    for ending in ("vtk", "vts", "prm", "obj"):
        convert(run, "l.json", f"a.{ending}")
    convert(run, "l.json", "a.xyz", "--part", "rest")
    points = [[i, j, k, i, j, k] for i in range(3) for j in range(2) for k in range(2)]
    run.write("a.su2", SU2 + su2_box("W", (3, 2, 2), points=points))
    run.write("c.vtk", binary_vtk())
    run.write("c.vts", Vts("binary", True).file(grid(3, 4, 2), random_offsets(24)))
    run.write("d.vts", Vts("appended", True).file(grid(3, 4, 2), random_offsets(24)))
    flat = [[x, y, 0.0] for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
    for name, packed in (("a.npz", False), ("c.npz", True)):
        run.write(name, refitter((2, 2, 1), ["KEY_BSPLINE"] * 3, [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0], [1, 1, 1], flat, flat, packed=packed))
    for name in ("a.npz", "c.npz", "a.vtk", "a.prm", "a.obj", "a.xyz", "a.su2", "c.vtk", "a.vts", "c.vts", "d.vts"):
        whole = run.read(name)
        for _ in range(repetitions(40)):
            run.write("b" + name[1:], broken(whole, RANDOM, b"\0\n,-#e9.\xff[= "))
            run.ffd("lattice", "convert", "b" + name[1:], "-o", "b.json", "--force", code=(0, USAGE, INVALID, UNSUPPORTED, LIMIT), lines=None,
                    err=lambda lines: len(lines) <= 1)
            check(run.names() is not None)


main()
