#!/usr/bin/env python3
"""The arithmetic of the scripts for Blender (data/blender/ffd_lattice_math.py), without Blender: beside `ffd lattice convert`, which has
the same of its own, beside what Blender made of points (../cli/authoring), and beside the program on the same lattices. It needs NumPy,
which Blender has: an interpreter that has it is looked for.

    FFD=... PYTHONPATH=tests/cli python3 tests/blender/test_arithmetic.py a_lattice_of_blender_is_that_of_convert
"""

import json
import math
import os
import random
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "data", "blender"))
try:
    import numpy as np
except ImportError:
    if sys.executable != "/usr/bin/python3" and subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True, check=False).returncode == 0:
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
    print("SKIP: NumPy: no interpreter here has it (.ci/setup test)")
    sys.exit(77)

import ffd_lattice_math as maths
from author import reference_cases
from harness import case, check, equal, lattice, main, near, obj_vertices, repetitions

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = np.random.default_rng(SEED)
print(f"seed {SEED} (FFD_SEED)")
EPS = np.finfo(float).eps


def rotation():
    q, _ = np.linalg.qr(RANDOM.normal(size=(3, 3)))
    return q if np.linalg.det(q) > 0 else -q


def quaternion(r):
    w = np.sqrt(max(0, 1 + r[0, 0] + r[1, 1] + r[2, 2])) / 2
    return [w, (r[2, 1] - r[1, 2]) / (4 * w), (r[0, 2] - r[2, 0]) / (4 * w), (r[1, 0] - r[0, 1]) / (4 * w)]


def turned(q):
    """The rotation of a quaternion."""
    w, x, y, z = np.array(q) / np.sqrt(np.dot(q, q))
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def grid(size, first, step):
    w, v, u = np.meshgrid(*(first[d] + step[d] * np.arange(size[d]) for d in (2, 1, 0)), indexing="ij")
    return np.stack([u, v, w], axis=-1)


def write_npz(run, size, types, q, location, scale, rest, deformed):
    np.savez(run.path("a.npz"), magic=np.array([b"LATZ"], "|S4"), version=np.array([3], np.uint16), name=np.array([b"x"], "|S64"),
             U=np.array([size[0]], np.uint16), V=np.array([size[1]], np.uint16), W=np.array([size[2]], np.uint16),
             interp=np.array([t.encode() for t in types], "|S16"), location=location, rotation_quat=q, scale=scale,
             use_outside=np.zeros(1, np.uint8), points_rest=rest.reshape(-1, 3), points_deform=deformed.reshape(-1, 3))


@case
def a_lattice_of_blender_is_that_of_convert(run):
    """Without a matrix to the bit. With one the sides of the box and the offsets are sums in another order: within 16 eps."""
    for number in range(repetitions(40)):
        size = [int(n) for n in RANDOM.integers(1, 7, 3)]
        types = [maths.TYPES[i] for i in RANDOM.integers(0, 4, 3)]
        first, step = RANDOM.uniform(-2, 0, 3), RANDOM.uniform(0.5, 1.5, 3)
        is_plain = number % 2 == 0
        if is_plain:
            first, step = np.floor(4 * first) / 4, np.ceil(4 * step) / 4  # whose multiples are exact
        q = [1.0, 0, 0, 0] if is_plain else quaternion(rotation())
        location, scale = (np.zeros(3), np.ones(3)) if is_plain else (RANDOM.uniform(-2, 2, 3), RANDOM.uniform(0.5, 2, 3) * RANDOM.choice([-1, 1], 3))
        rest = grid(size, first, step)
        deformed = rest + RANDOM.uniform(-1, 1, rest.shape)
        write_npz(run, size, types, q, location, scale, rest, deformed)
        run.ffd("lattice", "convert", "a.npz", "-o", "a.json", "--force", err=lambda lines: None, lines=None)
        wanted = json.loads(run.text("a.json"))
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = turned(q) * scale, location
        step = [(rest[-1, -1, -1, d] - rest[0, 0, 0, d]) / (n - 1) if n > 1 else 0.0 for d, n in enumerate(size)]
        found = json.loads(maths.text_of(maths.lattice_document(types, size, rest[0, 0, 0], step, matrix, deformed - rest)))
        for member in ("size", "degree", "knots"):
            equal(found[member], wanted[member], f"{types} {size}: {member}")
        moved, right = np.array(found["deformed"]["offsets"]), np.array(wanted["deformed"]["offsets"])
        boxes = [np.array([box["rest"]["box"][m] for m in ("min", "max")] + box["rest"]["box"]["axes"]) for box in (found, wanted)]
        if is_plain:
            check((moved == right).all() and (boxes[0] == boxes[1]).all(), f"{types} {size}: {abs(moved - right).max()}")
        check(abs(moved - right).max() <= 16 * EPS * abs(right).max(), types, size, abs(moved - right).max())
        check(abs(boxes[0] - boxes[1]).max() <= 16 * EPS * abs(boxes[1]).max(), types, size, abs(boxes[0] - boxes[1]).max())


@case
def what_blender_makes(run):
    """Blender's own results, inside and outside; by the program, by single precision."""
    count = 0
    for name, of in reference_cases("interop"):
        if "source" not in of:
            continue
        count += 1
        source = of["source"]
        size = source["size"]
        rest, deformed = (np.array(source[member]).reshape(size[::-1] + [3]) for member in ("rest", "deformed"))
        step = [(rest[-1, -1, -1, d] - rest[0, 0, 0, d]) / (n - 1) for d, n in enumerate(size)]
        before, after = np.array(of["before"]), np.array(of["expect"]["after"])
        for up in "zy":
            turn = maths.TO_Y_UP if up == "y" else np.eye(3)
            document = maths.lattice_document(source["types"], size, rest[0, 0, 0], step, source["matrix_world"], deformed - rest, up)
            run.write("a.json", maths.text_of(document))
            run.write("a.obj", "".join("v {!r} {!r} {!r}\n".format(*p) for p in (before @ turn.T).tolist()) + "p 1\n")
            run.ffd("deform", "a.obj", "b.obj", "-l", "a.json", "--outside", "extend", "--force", err=lambda lines: None, lines=None)
            near(obj_vertices(run.text("b.obj")), (after @ turn.T).tolist(), of["expect"]["tolerance"], f"{name}, {up} up")
    equal(count, 3)


@case
def sheared_lattices_are_points(run):
    """Inside they are what Blender makes: the same lattice in its own space, taken to the world."""
    for _ in range(repetitions(6)):
        size = [int(n) for n in RANDOM.integers(1, 5, 3)]
        types = [maths.TYPES[i] for i in RANDOM.integers(0, 4, 3)]
        offsets = RANDOM.uniform(-0.2, 0.2, size[::-1] + [3])
        matrix = np.eye(4)
        matrix[:3] = RANDOM.uniform(-1, 1, (3, 4)) + 2 * np.eye(4)[:3]
        document = maths.lattice_document(types, size, [-1.0] * 3, [0.5] * 3, matrix, offsets)
        check("points" in document["rest"], "the axes are not perpendicular")
        run.write("own.json", maths.text_of(maths.lattice_document(types, size, [-1.0] * 3, [0.5] * 3, np.eye(4), offsets)))
        run.write("world.json", maths.text_of(document))
        own = [-1 + RANDOM.uniform(0, 1, 60) * (n - 1) * 0.5 for n in size]
        own = np.stack(own, axis=-1)
        for name, points in (("own", own), ("world", own @ matrix[:3, :3].T + matrix[:3, 3])):
            run.write(f"{name}.obj", "".join("v {!r} {!r} {!r}\n".format(*p) for p in points.tolist()) + "p 1\n")
            run.ffd("deform", f"{name}.obj", f"{name}-after.obj", "-l", f"{name}.json", "--force", "--snap", "1e-9", err=lambda lines: None, lines=None)
        expected = np.array(obj_vertices(run.text("own-after.obj"))) @ matrix[:3, :3].T + matrix[:3, 3]
        near(obj_vertices(run.text("world-after.obj")), expected.tolist(), 1e-9, f"{types} {size}")


@case
def rounded_axes_become_perpendicular(run):
    """Those of Blender's floats are so to 1e-7 only; a lattice far away is not shifted by that."""
    for _ in range(20):
        matrix = np.eye(4)
        matrix[:3, :3] = (rotation() * RANDOM.uniform(0.1, 10, 3)).astype(np.float32)
        matrix[:3, 3] = RANDOM.uniform(-1e4, 1e4, 3)
        axes, scales, origin = maths.box_of(matrix)
        check(abs(axes @ axes.T - np.eye(3)).max() < 4 * EPS, "the axes")
        check(abs(axes.T @ origin - matrix[:3, 3]).max() < 1e-11, "the origin")
        check(abs(axes.T * scales - matrix[:3, :3]).max() < 1e-5, "the matrix")


def spline(size, degree, knots, box=None, **members):
    count = int(np.prod(size))
    deformed = {"offsets": RANDOM.uniform(-0.1, 0.1, (count, 3)).tolist(), **members.pop("deformed", {})}
    return lattice(size=size, degree=degree, knots=knots, deformed=deformed, rest={"box": {"min": [-1, 0, 2], "max": [2, 1.5, 4], **(box or {})}}, **members)


def blenders_result(wanted, points):
    """What Blender makes of points within its lattice: its splines by the definition in lattice.md of what export writes."""
    document = maths.lattice_document(wanted.types, wanted.size, wanted.low, (wanted.high - wanted.low) / (np.array(wanted.size) - 1), np.eye(4), np.zeros(wanted.size[::-1] + [3]))
    document["rest"]["box"]["axes"] = wanted.axes.tolist()
    document["deformed"] = {"offsets": maths.blended(wanted.offsets, wanted.types).reshape(-1, 3).tolist()}
    return document


def compare(run, content, tolerance, size=None, **expected):
    """The lattice of Blender and the file do the same to points in the box."""
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(content)), size)
    for name, value in expected.items():
        equal(getattr(wanted, name), value, f"{content['degree']} {content['knots']}: {name}")
    box = content["rest"]["box"]
    axes = np.array(box.get("axes", np.eye(3)))
    fractions = np.concatenate([RANDOM.uniform(0, 1, (200, 3)), RANDOM.choice([0.0, 0.5, 1.0], (20, 3))])
    points = (np.array(box["min"]) + fractions * (np.array(box["max"]) - box["min"])) @ axes
    run.write("a.obj", "".join("v {!r} {!r} {!r}\n".format(*p) for p in points.tolist()) + "p 1\n")
    run.write("file.json", json.dumps(content))
    run.write("blender.json", maths.text_of(blenders_result(wanted, points)))
    for name in ("file", "blender"):
        run.ffd("deform", "a.obj", f"{name}.obj", "-l", f"{name}.json", "--force", "--outside", "extend", err=lambda lines: None, lines=None)
    near(obj_vertices(run.text("blender.obj")), obj_vertices(run.text("file.obj")), tolerance + 1.25 * wanted.error, str(content["knots"]))
    return wanted


@case
def exact_lattices_of_ffd(run):
    """Boxes of degree 1 and cubics with even inner knots, whatever their ends, along any axes."""
    for _ in range(repetitions(12)):
        size, degree, knots = [], [], []
        for _ in range(3):
            if RANDOM.random() < 0.3:
                size.append(int(RANDOM.integers(2, 7)))
                degree.append(1)
                knots.append("clamped")
                continue
            n = int(RANDOM.integers(4, 9))
            ends = [[0.0] * 4 + [float(i) for i in range(1, n - 3)] + [n - 3.0] * 4, [-9, -3, -0.5, *map(float, range(n - 2)), n - 2.5, n, n + 4]]
            size.append(n)
            degree.append(3)
            knots.append([None, "clamped", "open", "uniform", *ends][RANDOM.integers(1, 6)])
        axes = rotation().tolist()
        wanted = compare(run, spline(size, degree, knots, {"axes": axes}), 1e-13, is_exact=True, error=0.0)
        for d in range(3):
            equal([wanted.types[d], wanted.size[d]], [maths.LINEAR if degree[d] == 1 else maths.BSPLINE, size[d]])


@case
def open_knots_keep_their_offsets(run):
    """They are Blender's own splines: the offsets are its points', to a few bits."""
    content = spline([5, 6, 4], [3, 3, 3], ["open", "uniform", "open"])
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(content)))
    given = np.array(content["deformed"]["offsets"]).reshape(4, 6, 5, 3)
    check(abs(wanted.offsets - given).max() <= 8 * EPS, abs(wanted.offsets - given).max())
    matrix, own = wanted.placed([-0.5, -0.5, -0.5], [0.5, 0.5, 0.5])
    corners = np.array([matrix[:3, :3] @ [x, x, x] + matrix[:3, 3] for x in (-0.5, 0.5)])
    sides = np.array([3, 1.5, 2]) / (np.array([5, 6, 4]) - 3)
    near(corners.tolist(), [(np.array([-1, 0, 2]) - sides).tolist(), (np.array([2, 1.5, 4]) + sides).tolist()], 1e-14)
    near((own @ matrix[:3, :3].T).reshape(-1).tolist(), given.reshape(-1).tolist(), 1e-15)


@case
def other_boxes_are_fitted(run):
    """Other degrees and knots, weights, even spacing; the error is told, and the size can be chosen."""
    clamped = ["clamped"] * 3
    compare(run, spline([3, 2, 3], [2, 1, 2], clamped), 1e-13, is_exact=False, size=[4, 4, 4])
    compare(run, spline([6, 4, 4], [4, 3, 3], clamped), 1e-9, is_exact=False)
    compare(run, spline([5, 4, 4], [3, 3, 3], [[0, 0, 0, 0, 0.3, 1, 1, 1, 1], "clamped", "clamped"]), 1e-9, is_exact=False)
    compare(run, spline([5, 4, 4], [3, 3, 3], clamped, {"spacing": "uniform"}), 1e-9, is_exact=False)
    weights = RANDOM.uniform(0.7, 1.4, 48).tolist()
    compare(run, spline([4, 4, 3], [3, 2, 2], clamped, weights=weights), 1e-9, is_exact=False)
    compare(run, spline([4, 4, 3], [3, 3, 2], ["open", "clamped", "clamped"], deformed={"weights": weights}), 1e-9, is_exact=False)
    compare(run, spline([4, 4, 3], [3, 2, 2], clamped, weights=weights, deformed={"weights": [1] * 48}), 1e-9, is_exact=False)
    compare(run, spline([4, 4, 4], [3, 3, 3], clamped, weights=[2.5] * 64), 1e-13, is_exact=True)
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(spline([6, 4, 4], [5, 3, 3], clamped))), [5, 9, 64])
    equal(wanted.size, [5, 9, 64])
    # One more span than Blender has points for.
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(spline([65, 2, 2], [3, 1, 1], clamped))))
    check(not wanted.is_exact and wanted.size[0] == 64 and math.prod(wanted.size) <= 32000, wanted.size)
    # More points in all than Blender takes.
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(spline([38, 38, 25], [3, 3, 1], clamped))))
    check(not wanted.is_exact and math.prod(wanted.size) <= 32000, wanted.size)
    wanted = maths.BlenderLattice(maths.BoxLattice(json.dumps(spline([64, 64, 2], [1, 3, 1], clamped))))
    equal([wanted.is_exact, wanted.size], [True, [64, 64, 2]])


@case
def the_error_of_a_fit_is_found(run):
    """It falls with the size, and is near to the largest one of many places: it is looked for at three in each span, and at its ends."""
    content = spline([7, 6, 3], [5, 3, 1], [[0, 0, 0, 0, 0, 0, 0.2, 1, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0.1, 0.15, 1, 1, 1, 1], "clamped"])
    content["deformed"]["offsets"][84:] = [[0, 0, 0]] * 42  # the last layer of w has no error
    found = [maths.BlenderLattice(maths.BoxLattice(json.dumps(content)), [n] * 3) for n in (4, 8, 16, 32)]
    check(found[0].error > 10 * found[3].error and found[2].error > 2 * found[3].error, [f.error for f in found])
    wanted = found[1]
    lattice_of = maths.BoxLattice(json.dumps(content))
    sites = [np.linspace(0, 1, 41)] * 3
    values = wanted.offsets
    for d in range(3):
        values = maths.along(maths.basis(maths.even_knots(wanted.size[d]), 3, sites[d]), values, d)
    worst = np.sqrt(((values - lattice_of.displacements(sites)) ** 2).sum(axis=-1)).max()
    check(0.8 * worst <= wanted.error <= 1.2 * worst, wanted.error, worst)


@case
def y_up_and_back(run):
    content = maths.lattice_document([maths.BSPLINE] * 3, [4, 5, 4], [-1.0] * 3, [0.5] * 3, np.diag([1.0, 2, 3, 1]), RANDOM.uniform(-1, 1, (4, 5, 4, 3)), "y")
    equal((maths.TO_Y_UP @ [1, 2, 3]).tolist(), [1, 3, -2])
    wanted = maths.BlenderLattice(maths.BoxLattice(maths.text_of(content)), up="y")
    near(wanted.axes.tolist(), np.eye(3).tolist(), 0)
    near([wanted.low.tolist(), wanted.high.tolist()], [[-2, -4, -6], [1.5, 4, 4.5]], 1e-14)
    equal([wanted.size, wanted.is_exact], [[8, 9, 8], True])


@case
def what_is_refused(run):
    good = spline([4, 4, 4], [3, 3, 3], ["clamped"] * 3)
    mesh = {"rest": {"box": "mesh"}}
    for change, what in (
            ({"version": 2}, "is of version 2"), ({"format": "x"}, "is not a lattice file"), ({"keys": [{"time": 0}]}, "--time T"), ({"moves": [{"by": [0, 0, 1]}]}, "has moves: `ffd lattice convert`"),
            (mesh, "--mesh MESH"), ({"rest": {"box": {"meshes": ["a.obj"]}}}, "--mesh MESH"), ({"rest": {"cylinder": {}}}, "is not a box"), ({"rest": {"points": []}}, "is not a box"),
            ({"size": [4, 4]}, "has a size"), ({"size": [4, 4, 1]}, "has a size"), ({"size": [4, 4, True]}, "has a size"), ({"degree": [3, 3, 4]}, "has degree 4 and 4"), ({"degree": [3, 3, 15]}, "has a degree"),
            ({"knots": ["closed", "open", "open"]}, "closed direction"), ({"knots": ["open"]}, "not three"), ({"knots": [[0, 1], "open", "open"]}, "not 8 numbers"),
            ({"knots": [[0, 0, 0, 0, 1, 1, 1, 0], "open", "open"]}, "fall"), ({"deformed": {"offsets": [[0, 0, 0]]}}, "64 x 3"), ({"deformed": {"points": "x"}}, "deformed points that are not 64 x 3"),
            ({"weights": [0] * 64}, "not above 0"), ({"weights": list(range(1, 65)), "knots": ["open"] * 3}, "not clamped"), ({"extra": 1}, 'unknown member "extra"'),
            ({"deformed": {"offsets": [["1", "2", "3"]] * 64}}, "64 x 3"), ({"deformed": {"offsets": [[1, 2]] * 63 + [[1, 2, 3]]}}, "64 x 3"), ({"deformed": {"offsets": [[10**400, 0, 0]] * 64}}, "64 x 3"),
            ({"size": [10**400, 4, 4]}, "has a size"), ({"knots": [[0, 0, 0, 0, 1, 1, 1, 10**400], "open", "open"]}, "8 numbers"), ({"size": [6, 4, 4], "degree": [1, 3, 3], "knots": [[0, 0, 1, 1, 1, 2, 3, 3], "open", "open"]}, "more than 1 times"), ({"deformed": []}, "no object"), ({"rest": []}, "is not a box"),
            ({"size": [2**26, 2, 2]}, "more than 67108864"),
            ({"rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 0]}}}, 'not above "min"'), ({"rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1], "axes": [[1, 0, 0], [1, 1, 0], [0, 0, 1]]}}}, "perpendicular"),
            ({"knots": ["open"] * 3, "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": "uniform"}}}, "evenly spaced")):
        try:
            maths.BoxLattice(json.dumps({**good, **change}))
        except maths.Refused as error:
            check(what in str(error) and "\n" not in str(error), what, str(error))
            continue
        check(False, f"{change} is not refused")
    for text in ("", "[]", '{"format": "ffd-lattice", "version": NaN}', "[" * 100000):
        try:
            maths.BoxLattice(text)
        except maths.Refused as error:
            check("\n" not in str(error), str(error))
            continue
        check(False, f"{text[:20]} is not refused")
    for matrix, offset, what in ((np.diag([1.0, 0, 1, 1]), 0, "scale 0 along y"), (np.diag([1.0, np.nan, 1, 1]), 0, "not finite"), (np.eye(4), np.inf, "not finite")):
        try:
            maths.lattice_document([maths.BSPLINE] * 3, [2, 2, 2], [0.0] * 3, [1.0] * 3, matrix, np.full((2, 2, 2, 3), offset))
        except maths.Refused as error:
            check(what in str(error), what, str(error))
            continue
        check(False, f"{what} is not refused")


@case
def numbers_read_back(run):
    values = [0.1, -0.0, 1e300, 5e-324, 1 / 3, 2.0**53 + 2, -1.0, 1e15, float(np.float32(0.1))]
    equal(json.loads(maths.text_of({"a": values, "b": [[1, 2.5]], "c": "Größe"})), {"a": values, "b": [[1, 2.5]], "c": "Größe"})
    equal(maths.text_of([1.0, 2.5]), "[1, 2.5]")


@case
def names_of_files(run):
    taken = set()
    for owner, modifier, name in (("Cube", "Lattice", "Cube-Lattice.json"), ("cube", "lattice", "cube-lattice-2.json"), ("a/b\\c", "x:y*", "a_b_c-x_y_.json"),
                                  ("../..", "x", "_._..-x.json"), ("Größe 形", "ü", "Größe 形-ü.json"), ("a\nb\x7f", '?"<>|', "a_b_-_____.json"), ("Cube", "Lattice", "Cube-Lattice-3.json"),
                                  (".hidden", "x", "_hidden-x.json"), ("", "", "-.json")):
        equal(maths.file_name(owner, modifier, taken), name)


@case
def sizes_of_a_fit(run):
    equal([maths.checked_size("31"), maths.checked_size("4,5,64")], [[31, 31, 31], [4, 5, 64]])
    for text in ("3,4,4", "4,4", "65", "x", "4,4,4,4", "", "-8", "8.5"):
        try:
            maths.checked_size(text)
        except maths.Refused as error:
            check("from 4 to 64" in str(error), str(error))
            continue
        check(False, f"{text} is not refused")
    try:
        maths.checked_size("32")
        check(False, "a lattice that Blender makes smaller is not refused")
    except maths.Refused as error:
        check("has 32768 points, and a lattice of Blender at most 32000" in str(error), str(error))


main()
