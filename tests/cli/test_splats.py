#!/usr/bin/env python3
"""Gaussian splats: their ellipsoids and spherical harmonics beside exact ones that are computed here, in 40 digits and by
values in directions; what stays as it is, and what is said."""
import base64
import decimal
import json
import math
import random
import re
import struct
from decimal import Decimal

from gltf_build import SHIFT, Scene
from gltf_reader import Gltf
from harness import INVALID, case, check, equal, float32, lattice, main, obj_of, threaded_case
from messages import anything, lines_with, one_line
from page import read_page

decimal.getcontext().prec = 40

SIZES = {"float": "f", "double": "d"}
ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">"}
REST = {0: 0, 1: 9, 2: 24, 3: 45}


def names_of(rests, scales=3):
    return (["x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"] + [f"f_rest_{i}" for i in range(rests)]
            + ["opacity"] + [f"scale_{i}" for i in range(scales)] + [f"rot_{i}" for i in range(4)])


def rounded(value, real):
    return float32(value) if real == "float" else value


def cloud(count, rests, real, seed=1, scales=3, span=5):
    """Rows by name, of numbers that the type holds."""
    chance = random.Random(seed)
    rows = []
    for _ in range(count):
        row = dict.fromkeys(names_of(rests, scales), 0.0)
        row |= {name: chance.uniform(-span, span) for name in "xyz"}
        row |= {f"rot_{i}": chance.gauss(0, 1) for i in range(4)} | {f"scale_{i}": chance.uniform(-7, -1) for i in range(scales)}
        row |= {f"f_rest_{i}": chance.gauss(0, 0.3) for i in range(rests)} | {"opacity": 2.5}
        rows.append({name: rounded(value, real) for name, value in row.items()})
    return rows


def ply(rows, encoding="binary_little_endian", real="float", names=None, types=()):
    """types: of those that are not of the type `real`, by name."""
    names = names or list(rows[0])
    reals = dict.fromkeys(names, real) | dict(types)
    head = (f"ply\nformat {encoding} 1.0\nelement vertex {len(rows)}\n" + "".join(f"property {reals[n]} {n}\n" for n in names)
            + "end_header\n")
    if encoding == "ascii":
        return (head + "".join(" ".join(repr(row[n]) for n in names) + "\n" for row in rows)).encode()
    code = ORDERS[encoding] + "".join(SIZES[reals[n]] for n in names)
    return head.encode() + b"".join(struct.pack(code, *(row[n] for n in names)) for row in rows)


def read(data):
    head, body = data.split(b"end_header\n", 1)
    words = [line.split() for line in head.decode().splitlines()]
    encoding = next(w[1] for w in words if w[0] == "format")
    properties = [(w[1], w[2]) for w in words if w[0] == "property"]
    if encoding == "ascii":
        return [dict(zip((n for _, n in properties), map(float, line.split()))) for line in body.decode().splitlines()]
    code = ORDERS[encoding] + "".join(SIZES[real] for real, _ in properties)
    return [dict(zip((n for _, n in properties), values)) for values in struct.iter_unpack(code, body)]


def matrix(q):
    """Of a quaternion w, x, y, z of any length; of Decimals too."""
    w, x, y, z = q
    s = 2 / (w * w + x * x + y * y + z * z)
    return [[1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
            [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
            [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)]]


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(row) for row in zip(*a)]


def turn_of(axis, degrees):
    """A quaternion."""
    length, half = math.hypot(*axis), math.radians(degrees) / 2
    return [math.cos(half)] + [math.sin(half) * a / length for a in axis]


def quaternion(row):
    return [row[f"rot_{i}"] for i in range(4)]


def covariance(row):
    rotation = matrix([Decimal(q) for q in quaternion(row)])
    sizes = [Decimal(row[name]).exp() if name in row else Decimal(0) for name in ("scale_0", "scale_1", "scale_2")]
    half = [[r * s for r, s in zip(line, sizes)] for line in rotation]
    return product(half, transposed(half))


def harmonics(direction, degree):
    """Values of the functions of degrees 1 to degree, from their definition: m below 0 with the sine, and the
    Condon-Shortley phase."""
    x, y, z = direction
    angle, values = math.atan2(y, x), []
    for n in range(1, degree + 1):
        for m in range(-n, n + 1):
            k = abs(m)
            # d^(n+k)/dz^(n+k) of (z^2 - 1)^n / (2^n n!)
            legendre = sum((-1) ** j * math.comb(n, j) * math.perm(2 * n - 2 * j, n + k) * z ** (n - 2 * j - k)
                           for j in range((n - k) // 2 + 1)) / (2 ** n * math.factorial(n))
            factor = math.sqrt((2 * n + 1) / (4 * math.pi) * math.factorial(n - k) / math.factorial(n + k) * (2 if m else 1))
            values.append((-1) ** k * factor * (1 - z * z) ** (k / 2) * legendre * (math.sin(k * angle) if m < 0 else math.cos(k * angle)))
    return values


def colours(row, rests, direction):
    """What the harmonics of degree 1 on show from a direction, of each channel."""
    count = rests // 3
    values = harmonics(direction, next(degree for degree, n in REST.items() if n == rests))
    return [sum(value * row[f"f_rest_{count * k + i}"] for i, value in enumerate(values)) for k in range(3)]


DIRECTIONS = [[c / math.hypot(*d) for c in d] for d in
              ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 3), (-3, 1, 2), (2, -2, 1), (-1, -1, 3), (3, 1, -2), (1, -4, -1))]


def check_colours(before, after, rests, turn, tolerance):
    """The colours are those that were seen from the directions turned back."""
    for row, made in zip(before, after):
        for d in DIRECTIONS:
            back = [sum(turn[k][i] * d[k] for k in range(3)) for i in range(3)]
            for found, expected in zip(colours(made, rests, d), colours(row, rests, back)):
                check(abs(found - expected) <= tolerance, found, expected)


def check_covariances(before, after, gradients, tolerance):
    """F covariance F^T, with errors relative to the sizes along the axes of space."""
    for row, made, f in zip(before, after, gradients):
        f = [[Decimal(x) for x in line] for line in f]
        exact, found = product(product(f, covariance(row)), transposed(f)), covariance(made)
        for i in range(3):
            for j in range(3):
                check(abs(exact[i][j] - found[i][j]) <= Decimal(tolerance) * (exact[i][i] * exact[j][j]).sqrt(), row, made)


def by(f):
    return lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"matrix": [x for line in f for x in (*line, 0)] + [0, 0, 0, 1]}])


def deform(run, data, box, *options, warned=0):
    run.write("a.ply", data)
    run.write("l.json", box)
    done = run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--force", "--report", "r.json", *options, err=anything)
    equal(len(lines_with(done, "plat")), warned, done.err)
    return run.read("b.ply")


def entry(run):
    """The run's only job in its report."""
    return json.loads(run.text("r.json"))["jobs"][0]


@case
def a_turned_cloud_is_the_cloud_turned(run):
    """The quaternion is the turn's times the old one, with its length; the sizes keep their bytes."""
    turn = turn_of([1, 2, 3], 100)
    w, x, y, z = turn
    for real, encoding, degree in (("float", "binary_little_endian", 3), ("double", "binary_big_endian", 3), ("float", "ascii", 3),
                                   ("double", "binary_little_endian", 2), ("float", "binary_big_endian", 1), ("double", "ascii", 0)):
        before = cloud(20, REST[degree], real)
        after = read(deform(run, ply(before, encoding, real), by(matrix(turn))))
        step = 2e-7 if real == "float" else 1e-14
        for row, made in zip(before, after):
            a, b, c, d = quaternion(row)
            for found, expected in zip(quaternion(made), (w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                                                          w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a)):
                check(abs(found - expected) <= 5 * step, real, found, expected)
            for i in range(3):
                check(abs(made[f"scale_{i}"] - row[f"scale_{i}"]) <= (0 if real == "float" else 2e-15), made)
            equal([made[name] for name in ("opacity", "f_dc_1", "nx", "nz")], [2.5, 0, 0, 0])
        check_colours(before, after, REST[degree], matrix(turn), 10 * step)
        if encoding == "binary_little_endian":
            equal(read(deform(run, ply(before, encoding, real, list(before[0])[::-1]), by(matrix(turn)))),
                  after, "properties in another order")
    equal(entry(run)["splats"], {"carried": 20, "flattened": 0, "broken": 0})


@case
def equal_sizes_do_not_turn_by_themselves(run):
    """A ball's axes are any three: those it had, turned, are taken. So are those of a ball that grows."""
    before = [row | {f"scale_{i}": -2.0 for i in range(3)} for row in cloud(9, 0, "double")]
    turn = turn_of([3, -1, 2], 25)
    w, x, y, z = turn
    after = read(deform(run, ply(before, real="double"), by([[2 * e for e in line] for line in matrix(turn)])))
    for row, made in zip(before, after):
        a, b, c, d = quaternion(row)
        for found, expected in zip(quaternion(made), (w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                                                      w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a)):
            check(abs(found - expected) < 1e-13, found, expected)
        check(all(abs(made[f"scale_{i}"] + 2 - math.log(2)) < 1e-14 for i in range(3)), made)


@case
def harmonics_of_a_sheared_cloud_turn_by_its_rotation(run):
    """The harmonics turn by the rotation of F, here by atan(k/2); sizes differ by up to e^15."""
    k = 0.7
    shear = [[1, k, 0], [0, 1, 0], [0, 0, 1]]
    before = cloud(40, 45, "double", seed=2)
    before[0] |= {"scale_0": -18.0, "scale_1": -3.0, "scale_2": -3.0}
    after = read(deform(run, ply(before, real="double"), by(shear)))
    check_covariances(before, after, [shear] * 40, 1e-10)
    check_colours(before, after, 45, matrix(turn_of([0, 0, -1], math.degrees(math.atan(k / 2)))), 1e-13)
    few = [{name: rounded(value, "float") for name, value in row.items()} for row in before]
    check_covariances(few[1:], read(deform(run, ply(few), by(shear)))[1:], [shear] * 39, 3e-4)


@case
def a_small_change_is_small(run):
    """Axes keep their order and signs."""
    before = cloud(40, 9, "double", seed=3)
    f = [[1 + 1e-6, 2e-6, 0], [-1e-6, 1, 1e-6], [0, 3e-6, 1 - 2e-6]]
    for row, made in zip(before, read(deform(run, ply(before, real="double"), by(f)))):
        for name in row:
            if name not in "xyz":
                check(abs(made[name] - row[name]) <= 1e-3, name, row[name], made[name])


@case
def a_mirror_mirrors_splats(run):
    mirror = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]
    before = cloud(10, 45, "double", seed=4)
    after = read(deform(run, ply(before, real="double"), by(mirror)))
    check_covariances(before, after, [mirror] * 10, 1e-11)
    check_colours(before, after, 45, mirror, 1e-13)


@case
def each_splat_of_a_bent_cloud_has_its_own_gradient(run):
    """F differs from splat to splat: differences of the lattice's own displacements tell it."""
    box = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"bend": {"axis": "z", "toward": [1, 0, 0], "degrees": 140}}])
    before = cloud(12, 24, "double", seed=5)
    after = read(deform(run, ply(before, real="double"), box))
    h, points = 1e-3, []
    for row in before:
        for axis in range(3):
            for side in (h, -h):
                points.append([row[n] + (side if i == axis else 0) for i, n in enumerate("xyz")])
    run.write("p.obj", obj_of(points))
    run.ffd("deform", "p.obj", "q.obj", "-l", "l.json")
    moved = [[float(x) for x in line.split()[1:]] for line in run.text("q.obj").splitlines()]
    gradients = [transposed([[(a - b) / (2 * h) for a, b in zip(moved[6 * s + 2 * axis], moved[6 * s + 2 * axis + 1])] for axis in range(3)])
                 for s in range(12)]
    check_covariances(before, after, gradients, 1e-4)


def page_covariances(page, name):
    """Of each vertex xx, xy, xz, yy, yz, zz."""
    data = base64.b64decode(page.blocks[name])
    return [[most * q / 32767 for q in rounded_to] for most, *rounded_to in struct.iter_unpack("<f6h", data)]


@case
def pages_have_the_ellipsoids_before_and_after(run):
    """In 16 bits of the largest entry of each; without a deformation once."""
    rows = cloud(300, 0, "float", seed=7)
    shear = [[1, 0.7, 0], [0, 1, 0], [0, 0.5, 1]]
    run.write("a.ply", ply(rows))
    run.write("l.json", by(shear))
    run.ffd("view", "a.ply", "-l", "l.json", "-o", "p.html")
    page = read_page(run, "p.html")
    pairs = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    f = [[Decimal(x) for x in line] for line in shear]
    for name, change in (("data-splat-before", None), ("data-splat-after", f)):
        for row, found in zip(rows, page_covariances(page, name), strict=True):
            exact = product(product(change, covariance(row)), transposed(change)) if change else covariance(row)
            most = max(abs(x) for line in exact for x in line)
            check(all(abs(float(exact[i][j]) - x) <= 2e-5 * float(most) for (i, j), x in zip(pairs, found)), name, row, found)
    run.ffd("view", "a.ply", "-o", "alone.html")
    alone = read_page(run, "alone.html")
    check("data-splat-before" in alone.blocks and "data-splat-after" not in alone.blocks, "the same ellipsoids twice")
    equal([alone.scene["points"], alone.scene["notices"]], [300, []], "all splats")


@case
def a_page_of_many_splats_says_what_it_leaves_out(run):
    rows = cloud(50, 0, "float", seed=8)
    run.write("a.ply", ply([rows[i % 50] for i in range(200050)]))
    run.ffd("view", "a.ply", "-o", "p.html", err=re.compile("of 200050 vertices are drawn"))
    page = read_page(run, "p.html")
    check(0 < page.scene["points"] <= 200000 and len(page_covariances(page, "data-splat-before")) == page.scene["points"], "splats that are left")


@case
def what_does_not_change_keeps_its_bytes(run):
    for encoding in ("ascii", *ORDERS):
        data = ply(cloud(9, 45, "float"), encoding)
        equal(deform(run, data, by([[1, 0, 0], [0, 1, 0], [0, 0, 1]])) == data, True, encoding)
        moved = read(deform(run, data, lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 2, 3]}])))
        for row, made in zip(read(data), moved):
            equal([row[n] for n in row if n not in "xyz"], [made[n] for n in made if n not in "xyz"])
            check(row["x"] != made["x"], made)
    far = [row | {"x": row["x"] + 90} for row in cloud(5, 9, "float")]
    data, near = ply(far + cloud(5, 9, "float")), by(matrix(turn_of([0, 0, 1], 30)))
    equal(read(deform(run, data, near))[:5], read(data)[:5], "outside")


@threaded_case
def any_threads_and_lanes(run):
    data = ply(cloud(5000, 45, "float", seed=6))
    bend = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"twist": {"axis": "z", "degrees": 200}}])
    first = deform(run, data, bend, "--threads", "1", "--isa", "scalar")
    for options in (["--threads", "2"], ["--threads", "5", "--isa", "sse2"]):
        equal(deform(run, data, bend, *options) == first, True, options)


@case
def sizes_of_a_flattened_cloud_stay_numbers(run):
    """Sizes that F takes away stay numbers."""
    before = cloud(8, 45, "float", seed=7)
    after = read(deform(run, ply(before), by([[1, 0, 0], [0, 1, 0], [0, 0, 0]]), warned=1))
    equal(entry(run)["splats"], {"carried": 8, "flattened": 8, "broken": 0})
    for row, made in zip(before, after):
        check(all(math.isfinite(value) for value in made.values()), made)
        check(min(made[f"scale_{i}"] for i in range(3)) < -20, made)
        equal([made[n] for n in made if "rest" in n], [row[n] for n in row if "rest" in n])
    deform(run, ply(before), by([[0, 0, 0], [0, 0, 0], [0, 0, 0]]), warned=1)
    check(all(math.isfinite(value) for made in read(run.read("b.ply")) for value in made.values()), "a point is left")


@case
def disks_of_two_sizes(run):
    shear = [[1, 0.3, 0], [0, 1, 0.5], [0, 0, 1.5]]
    before = cloud(10, 9, "double", seed=8, scales=2)
    after = read(deform(run, ply(before, real="double"), by(shear)))
    check_covariances(before, after, [shear] * 10, 1e-9)


@case
def numbers_of_two_types(run):
    """Each number is what it is in a file of doubles, as its type holds it."""
    shear = by([[1, 0.3, 0], [0, 1, 0.5], [0, 0, 1.5]])
    before = cloud(20, 9, "float", seed=10)
    doubles = read(deform(run, ply(before, real="double"), shear))
    for encoding in ("ascii", *ORDERS):
        for wide in (("rot_0", "rot_2"), ("scale_2",), ("rot_3", "scale_0", "scale_1")):
            after = read(deform(run, ply(before, encoding, types=dict.fromkeys(wide, "double")), shear))
            for made, expected in zip(after, doubles):
                for name in [f"rot_{i}" for i in range(4)] + [f"scale_{i}" for i in range(3)]:
                    real = "double" if name in wide else "float"
                    equal(rounded(made[name], real), rounded(expected[name], real), (encoding, wide, name))


@case
def harmonics_that_do_not_fit(run):
    """Those of a colour that a float cannot hold when they have turned, or one of which is no number, stay."""
    turn = by(matrix(turn_of([1, 2, 3], 30)))
    for degree in (1, 2, 3):
        functions, before = REST[degree] // 3, cloud(40, REST[degree], "float", seed=11)
        before[3] |= {f"f_rest_{i}": rounded(3.4e38, "float") for i in range(3)}
        before[38] |= {f"f_rest_{REST[degree] - 1}": math.nan}
        run.write("a.ply", ply(before))
        run.write("l.json", turn)
        one_line(run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--force", err=anything), r"\b2\b",
             "splats have spherical harmonics that are not numbers, or too large")
        after = read(run.read("b.ply"))
        for splat, row in enumerate(after):
            for channel in range(3):
                names = [f"f_rest_{channel * functions + i}" for i in range(functions)]
                stays = repr([row[n] for n in names]) == repr([before[splat][n] for n in names])
                equal(stays, (splat, channel) in ((3, 0), (38, 2)), (degree, splat, channel))


@case
def splats_that_are_no_numbers(run):
    """Two have no rotation, one a size that is not a number: they move. Sizes of 0 and harmonics that are none stay."""
    before = cloud(6, 9, "float", seed=9)
    before[0] |= dict.fromkeys(("rot_0", "rot_1", "rot_2", "rot_3"), 0.0)
    before[1] |= {"rot_2": math.nan}
    before[2] |= {"scale_1": math.inf}
    before[3] |= {"scale_1": -math.inf}
    before[4] |= {"f_rest_3": math.nan}
    data = ply(before)
    run.write("a.ply", data)
    run.write("l.json", by(matrix(turn_of([1, 2, 3], 30))))
    done = run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--report", "r.json", err=anything)
    one_line(done, r"\b3\b", "splats move without their rotation and scales")
    one_line(done, r"\b1\b", "splat has spherical harmonics that are not numbers")
    equal(entry(run)["splats"], {"carried": 3, "flattened": 0, "broken": 3})
    after = read(run.read("b.ply"))
    for i in range(3):
        equal(repr([after[i][n] for n in after[i] if n not in "xyz"]), repr([before[i][n] for n in before[i] if n not in "xyz"]))
        check(after[i]["x"] != before[i]["x"], i)
    equal(after[3]["scale_1"], -math.inf)
    equal([after[4][f"f_rest_{i}"] for i in (4, 5)], [before[4][f"f_rest_{i}"] for i in (4, 5)])
    check(after[4]["f_rest_6"] != before[4]["f_rest_6"], after[4])


@case
def headers_that_are_not_of_splats(run):
    turn = by(matrix(turn_of([1, 2, 3], 30)))
    rows = cloud(3, 7, "float")
    after = read(deform(run, ply(rows), turn, warned=1))
    for row, made in zip(rows, after):
        equal([made[f"f_rest_{i}"] for i in range(7)], [row[f"f_rest_{i}"] for i in range(7)])
        check(made["rot_1"] != row["rot_1"], "the ellipsoids follow")
    one_line(run.ffd("check", "a.ply", "-l", "l.json", err=anything), r"\b7\b", "f_rest", "9, 24 or 45")
    for missing in ("rot_2", "scale_0", "rot_", "scale_"):
        names = [name for name in names_of(0) if name != missing and not (missing.endswith("_") and name.startswith(missing))]
        rows = [{name: row[name] for name in names} for row in cloud(3, 0, "float")]
        after = read(deform(run, ply(rows), turn, warned=1))
        equal([[made[n] for n in names[3:]] for made in after], [[row[n] for n in names[3:]] for row in rows])
        one_line(run.ffd("check", "a.ply", "-l", "l.json", err=anything), "no " + missing, "not Gaussian splats")
    # Scales alone may be anything.
    rows = [{name: row[name] for name in ("x", "y", "z", "scale_0")} for row in cloud(3, 0, "float")]
    deform(run, ply(rows), turn)
    rows = [row | {"filter_3D": 0.5} for row in cloud(3, 0, "float")]
    equal([made["filter_3D"] for made in read(deform(run, ply(rows), turn, warned=1))], [0.5] * 3)
    one_line(run.ffd("check", "a.ply", "-l", "l.json", err=anything), "filter_3D", "stays")
    text = ply(cloud(2, 9, "float"), "ascii").decode()
    for column in (9, 19, 22):
        lines = text.splitlines()
        lines[-1] = " ".join("huge" if i == column else word for i, word in enumerate(lines[-1].split()))
        run.write("a.ply", "\n".join(lines) + "\n")
        one_line(run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--force", code=INVALID, err=anything), "not a number", "huge")
    whole = text.replace("property float scale_0", "property int scale_0")
    one_line(run_of(run, whole), r"\b2\b", "rotations and scales stay")


def run_of(run, text):
    run.write("a.ply", text)
    return run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--force", err=anything)


@case
def a_cloud_is_described(run):
    for degree, rests in REST.items():
        run.write("a.ply", ply(cloud(4, rests, "float")))
        equal(run.ffd("info", "a.ply", "--json", data=True).json["contents"]["gaussian_splats"], {"count": 4, "sh_degree": degree})
    check("gaussian splats" in run.ffd("info", "a.ply", data=True).text, "the text")


# glTF

PREFIX = "KHR_gaussian_splatting:"
HARMONICS = [f"SH_DEGREE_{n}_COEF_{i}" for n in (1, 2, 3) for i in range(2 * n + 1)]


def unit(q):
    length = math.hypot(*q)
    return [x / length for x in q]


def splats_of(rows, rests, made, rotation=None, scale=None):
    """The attributes of the rows of a cloud in a scene. rotation, scale: members of these accessors, and the numbers of
    their steps."""
    def add(values, shape, steps=None, component=5126, **members):
        return made.add([[round(x * steps) if steps else x for x in v] for v in values], component, shape, **members)
    count = rests // 3
    attributes = {"POSITION": made.add([[row[n] for n in "xyz"] for row in rows], bounds=True),
                  PREFIX + "ROTATION": add([(lambda w, x, y, z: [x, y, z, w])(*unit(quaternion(row))) for row in rows], "VEC4", **rotation or {}),
                  PREFIX + "SCALE": add([[math.exp(row[f"scale_{i}"]) for i in range(3)] for row in rows], "VEC3", **scale or {}),
                  PREFIX + "OPACITY": made.add([[0.5]] * len(rows), shape="SCALAR"),
                  PREFIX + "SH_DEGREE_0_COEF_0": made.add([[0.1, 0.2, 0.3]] * len(rows))}
    for i, name in enumerate(HARMONICS[:count]):
        attributes[PREFIX + name] = made.add([[row[f"f_rest_{count * k + i}"] for k in range(3)] for row in rows])
    return attributes


def scene(attributes, made, nodes=({},), **members):
    made.asset |= {"nodes": [{"mesh": 0} | node for node in nodes], "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
                   "extensionsUsed": ["KHR_gaussian_splatting"],
                   "meshes": [{"primitives": [{"attributes": attributes, "mode": 0, "extensions": {
                       "KHR_gaussian_splatting": {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}}} | members]}]}
    return made.glb()


def rows_of(file, mesh, names):
    """As rows of a PLY file."""
    attributes = file.asset["meshes"][mesh]["primitives"][0]["attributes"]
    read = {name: file.decoded(number) for name, number in attributes.items()}
    rows = []
    for i, q in enumerate(read[PREFIX + "ROTATION"]):
        row = dict(zip("xyz", read["POSITION"][i])) | {f"rot_{k}": q[k - 1] for k in range(4)}
        row |= {f"scale_{k}": math.log(s) for k, s in enumerate(read[PREFIX + "SCALE"][i])}
        row |= {f"f_rest_{len(names) * k + n}": read[PREFIX + name][i][k] for n, name in enumerate(names) for k in range(3)}
        rows.append(row)
    return rows


def deform_glb(run, data, box, *options, warned=0):
    run.write("a.glb", data)
    run.write("l.json", box)
    done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", "--report", "r.json", *options, err=anything)
    equal(len(lines_with(done, "plat")), warned, done.err)
    return Gltf(run.path("a.glb")), Gltf(run.path("b.glb"))


@case
def a_sheared_gltf(run):
    k = 0.7
    shear = [[1, k, 0], [0, 1, 0], [0, 0, 1]]
    for rests in (45, 24, 9, 0):
        made = Scene()
        names = HARMONICS[:rests // 3]
        a, b = deform_glb(run, scene(splats_of(cloud(20, rests, "float", seed=11), rests, made), made), by(shear))
        before, after = rows_of(a, 0, names), rows_of(b, 0, names)
        check_covariances(before, after, [shear] * 20, 3e-4)
        check_colours(before, after, rests, matrix(turn_of([0, 0, -1], math.degrees(math.atan(k / 2)))), 2e-6)
        equal(len(b.asset["accessors"]), len(a.asset["accessors"]), "they are written in place")
    equal(entry(run)["splats"], {"carried": 20, "flattened": 0, "broken": 0})
    deform_glb(run, scene(splats_of(cloud(5, 45, "float"), 45, made := Scene()), made), by([[1, 0, 0], [0, 1, 0], [0, 0, 1]]))
    equal(run.read("a.glb") == run.read("b.glb"), True, "nothing changes")


@case
def nodes_that_turn_and_stretch(run):
    """Two nodes show one mesh, each somewhere else: each of them gets what its own splats become in the scene."""
    box = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"matrix": [1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0.2, 1.1, 0, 0, 0, 0, 1], "weight": 1}])
    world = [[1, 0.5, 0], [0, 1, 0], [0, 0.2, 1.1]]
    polar = world
    for _ in range(60):  # Newton, in another form than the program's: X' = (X + inverse transposed)/2
        cofactors = [[polar[(r + 1) % 3][(c + 1) % 3] * polar[(r + 2) % 3][(c + 2) % 3]
                      - polar[(r + 1) % 3][(c + 2) % 3] * polar[(r + 2) % 3][(c + 1) % 3] for c in range(3)] for r in range(3)]
        size = sum(x * y for x, y in zip(polar[0], cofactors[0]))
        polar = [[(x + y / size) / 2 for x, y in zip(r, s)] for r, s in zip(polar, cofactors)]
    turns = [turn_of([1, 1, 0], 50), turn_of([0, 2, 1], -110)]
    scales = [[0.5, 0.5, 0.5], [1.5, 0.4, 0.8]]
    nodes = [{"rotation": [*q[1:], q[0]], "scale": s} for q, s in zip(turns, scales)]
    made = Scene()
    a, b = deform_glb(run, scene(splats_of(cloud(9, 45, "float", seed=12, span=2), 45, made), made, nodes), box)
    meshes = [node["mesh"] for node in b.asset["nodes"]]
    equal(sorted(meshes), [0, 1])
    for mesh, q, s in zip(meshes, turns, scales):
        place = [[x * y for x, y in zip(row, s)] for row in matrix(q)]
        before, after = rows_of(a, 0, HARMONICS), rows_of(b, mesh, HARMONICS)
        check_placed(before, after, place, world)
        back = product(transposed(matrix(q)), product(polar, matrix(q)))
        check_colours(before, after, 45, back, 3e-6)
    check("KHR_gaussian_splatting" in b.asset["meshes"][1]["primitives"][0]["extensions"], "a copy is of splats")


def check_placed(before, after, place, f):
    place, f = [[[Decimal(x) for x in line] for line in m] for m in (place, f)]
    for row, made in zip(before, after):
        shown = [product(product(place, covariance(r)), transposed(place)) for r in (row, made)]
        exact = product(product(f, shown[0]), transposed(f))
        for i in range(3):
            for j in range(3):
                check(abs(exact[i][j] - shown[1][i][j]) <= Decimal(3e-4) * (exact[i][i] * exact[j][j]).sqrt(), row, made)


@case
def a_node_that_follows(run):
    """With --rig follow the node turns, and its splats do what is left of the deformation."""
    world = [[0.8, -0.7, 0], [0.6, 0.9, 0.1], [0, 0.2, 1.1]]
    q, made = turn_of([1, 1, 0], 50), Scene()
    a, b = deform_glb(run, scene(splats_of(cloud(9, 45, "float", seed=16, span=2), 45, made), made, [{"rotation": [*q[1:], q[0]]}]),
                      by(world), "--rig", "follow")
    x, y, z, w = b.asset["nodes"][0]["rotation"]
    check(abs(w - q[0]) > 1e-3, "the node turns")
    before, after = rows_of(a, 0, HARMONICS), rows_of(b, 0, HARMONICS)
    turned = matrix([w, x, y, z])
    check_covariances(before, after, [product(transposed(turned), product(world, matrix(q)))] * 9, 3e-4)


@case
def whole_numbers_of_gltf(run):
    """Rotations in steps of 1/32767 and scales in steps of 1/65535 stay in these types while they fit."""
    rows = [row | {f"scale_{i}": -1.0 - i for i in range(3)} for row in cloud(20, 9, "float", seed=13)]
    turn = matrix(turn_of([1, 2, 3], 40))
    for grown in (1, 4):
        made = Scene()
        data = scene(splats_of(rows, 9, made, {"component": 5122, "normalized": True, "steps": 32767},
                               {"component": 5123, "normalized": True, "steps": 65535}), made)
        f = [[grown * x for x in line] for line in turn]
        a, b = deform_glb(run, data, by(f))
        types = [b.asset["accessors"][b.asset["meshes"][0]["primitives"][0]["attributes"][PREFIX + n]]["componentType"]
                 for n in ("ROTATION", "SCALE")]
        equal(types, [5122, 5123 if grown == 1 else 5126])
        check_covariances(rows_of(a, 0, HARMONICS[:3]), rows_of(b, 0, HARMONICS[:3]), [f] * 20, 4e-3)


@case
def harmonics_that_share_an_accessor(run):
    """All coefficients are one accessor, and a second primitive shows its numbers as something else."""
    made = Scene()
    rows = cloud(6, 45, "float", seed=14)
    attributes = splats_of(rows, 45, made)
    shared = attributes[PREFIX + HARMONICS[0]]
    attributes |= {PREFIX + name: shared for name in HARMONICS} | {"_OTHER": shared}
    turn = matrix(turn_of([1, 2, 3], 40))
    a, b = deform_glb(run, scene(attributes, made), by(turn))
    check_colours(rows_of(a, 0, HARMONICS), rows_of(b, 0, HARMONICS), 45, turn, 3e-6)
    other = b.asset["meshes"][0]["primitives"][0]["attributes"]["_OTHER"]
    equal(b.decoded(other), a.decoded(shared))


@case
def gltf_that_is_not_quite_of_splats(run):
    turn = by(matrix(turn_of([1, 2, 3], 30)))
    made, rows = Scene(), cloud(4, 9, "float", seed=15)
    attributes = splats_of(rows, 9, made)
    logarithms = attributes | {PREFIX + "SCALE": made.add([[row[f"scale_{i}"] for i in range(3)] for row in rows])}
    a, b = deform_glb(run, scene(logarithms, made), turn, warned=1)
    number = logarithms[PREFIX + "SCALE"]
    equal(b.decoded(number), a.decoded(number), "as PLY files have them")
    one_line(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "negative", "logarithms")
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", "--strict", code=INVALID, err=anything)
    some = {name: number for name, number in attributes.items() if not name.endswith("SH_DEGREE_1_COEF_1")}
    a, b = deform_glb(run, scene(some, made), turn, warned=1)
    one_line(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "not complete", "not turned")
    equal(b.decoded(some[PREFIX + "SH_DEGREE_1_COEF_0"]), a.decoded(some[PREFIX + "SH_DEGREE_1_COEF_0"]))
    without = {name: number for name, number in attributes.items() if not name.endswith("ROTATION")}
    a, b = deform_glb(run, scene(without, made), turn, warned=1)
    equal(b.decoded(attributes[PREFIX + "SCALE"]), a.decoded(attributes[PREFIX + "SCALE"]))
    broken = attributes | {PREFIX + "SH_DEGREE_1_COEF_1": made.add([[math.nan, 0, 0]] * 4)}
    deform_glb(run, scene(broken, made), turn, warned=1)
    a, b = deform_glb(run, scene(attributes, made), turn, "--as-morph", "turned", warned=1)
    equal(b.decoded(attributes[PREFIX + "ROTATION"]), a.decoded(attributes[PREFIX + "ROTATION"]))
    alone = entry(run)["behind"]
    equal([(left["kind"], left["count"]) for left in alone], [("splat", 4)])
    run.write("shift.json", SHIFT)
    run.ffd("deform", "a.glb", "c.glb", "--morph", "shifted=shift.json", "--morph", "turned=l.json", "--report", "r.json", err=anything)
    equal(entry(run)["behind"], alone, "the target that leaves most behind")


@case
def a_gltf_of_splats_is_described(run):
    made = Scene()
    run.write("a.glb", scene(splats_of(cloud(4, 24, "float"), 24, made), made, [{}, {"translation": [1, 2, 3]}]))
    equal(run.ffd("info", "a.glb", "--json", data=True).json["contents"]["gaussian_splats"], {"count": 8, "sh_degree": 2})


if __name__ == "__main__":
    main()
