#!/usr/bin/env python3
"""Images of random u,v,w are found again: none is outside, however steep the weights, however thin the lattice; those
inside hold the promised bound in 40 digits. Points within the tolerance of a border point are inside.
FFD_SEED=N takes others, FFD_CASES=N so many points."""
import json
import math
import os
import random
import struct
from decimal import Decimal

from bspline import basis, greville, knots
from exact_volume import evaluate, residual_by_bound, tolerance
from harness import case, check, equal, main, npy, repetitions
from messages import anything

CASES = int(os.environ.get("FFD_CASES") or repetitions(20000))
SEED = int(os.environ.get("FFD_SEED") or (random.randrange(10 ** 6) if os.environ.get("FFD_CASES") else 33))
EACH = 200  # points of a lattice


class Direction:
    """Knots of a kind: as the file has them, the functions at a parameter, and where the control points stand."""

    def __init__(self, numbers, kind, degree):
        n = degree + 1 + numbers.randrange(3)
        self.degree, self.kind, self.n = degree, kind, n
        if kind == "clamped":
            self.t, self.places = knots(n, degree), greville(n, degree)
        elif kind == "list":
            inner = [(i + numbers.uniform(0.8, 1.2)) / (n - degree) for i in range(n - degree - 1)]
            self.t = [0.0] * (degree + 1) + inner + [1.0] * (degree + 1)
            self.places = [sum(self.t[i + 1:i + degree + 1]) / degree for i in range(n)]
        elif kind == "closed":
            self.n = n = n + degree + 2
            self.t = [(i - degree) / n for i in range(n + 2 * degree + 1)]
            self.places = [i / n for i in range(n)]
        else:
            self.t = [(i - degree) / (n - degree) if kind == "open" else i / (n + degree) for i in range(n + degree + 1)]
            low, side = self.t[degree], self.t[n] - self.t[degree]
            self.places = [(sum(self.t[i + 1:i + degree + 1]) / degree - low) / side for i in range(n)]
        self.file = self.t if kind == "list" else kind

    def functions(self, share):
        """(control point, value) at a share of the domain."""
        t, d = self.t, self.degree
        low, high = t[d], t[-1 - d]
        u = low + share * (high - low)
        values = ((i % self.n, basis(t, i, d, u)) for i in range(len(t) - d - 1))
        return [(i, x) for i, x in values if x]


def turn(numbers):
    """A random rotation, by a unit quaternion."""
    q = [numbers.gauss(0, 1) for _ in range(4)]
    size = math.sqrt(sum(x * x for x in q))
    w, x, y, z = (c / size for c in q)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def net(numbers, directions, thickness, far):
    """A turned sheet of this thickness, mostly curved and uneven; round an axis where v is closed."""
    matrix, rows = turn(numbers), []
    bend = numbers.choice((0, 1, 1, 1))
    uneven = [0.1 * bend * min(b - a for a, b in zip(d.places, d.places[1:])) for d in directions]
    shift = [numbers.uniform(-far, far) for _ in range(3)]
    for w in directions[2].places:
        for v in directions[1].places:
            for u in directions[0].places:
                if directions[1].kind == "closed":
                    p = [(1 + u) * math.cos(2 * math.pi * v), (1 + u) * math.sin(2 * math.pi * v), w + 0.05 * u * u]
                else:
                    p = [u + 0.04 * bend * v * v, v - 0.05 * bend * u * v, w + 0.05 * bend * u * u]
                p = [(x + numbers.uniform(-e, e)) * f for x, e, f in zip(p, uneven, (1, 1, thickness))]
                rows.append([sum(m * x for m, x in zip(row, p)) + s for row, s in zip(matrix, shift)])
    return rows


def image(directions, points, weights, shares):
    found = [direction.functions(share) for direction, share in zip(directions, shares)]
    n, m = directions[0].n, directions[1].n
    terms = [(i + n * (j + m * k), a * b * c) for k, c in found[2] for j, b in found[1] for i, a in found[0]]
    terms = [(i, h * weights[i]) for i, h in terms]
    total = math.fsum(h for _, h in terms)
    return [math.fsum(h * points[i][a] for i, h in terms) / total for a in range(3)]


class Sheet:
    """A random lattice, turned and mostly curved and uneven, with weights from 1 to 10^steepness."""

    def __init__(self, numbers, steepness, thickness, far=1, kinds=("clamped", "open", "uniform", "list"), closed=0.2):
        kinds = [numbers.choice(kinds) for _ in range(3)]
        if numbers.random() < closed:
            kinds[1] = "closed"
        self.directions = [Direction(numbers, kind, numbers.choice((1, 1, 2, 3, 3, 4))) for kind in kinds]
        self.points = net(numbers, self.directions, thickness, far)
        self.weights = [10 ** numbers.uniform(0, steepness) for _ in self.points]
        self.steepness, self.thickness = steepness, thickness

    def __str__(self):
        return f"weights to 10^{self.steepness:.1f}, thickness {self.thickness:.1e}"

    def images(self, numbers):
        return [image(self.directions, self.points, self.weights, [numbers.random() for _ in range(3)]) for _ in range(EACH)]

    def write(self, run, vertices):
        run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [d.n for d in self.directions],
                             "degree": [d.degree for d in self.directions], "knots": [d.file for d in self.directions],
                             "rest": {"points": self.points}, **({"weights": self.weights} if self.steepness else {})})
        run.write("a.ply", f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty double x\n"
                  "property double y\nproperty double z\nend_header\n".encode()
                  + b"".join(struct.pack("<3d", *p) for p in vertices))

    def embed(self, run, vertices):
        """u,v,w and status of each."""
        self.write(run, vertices)
        run.ffd("embed", "a.ply", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", "--force", err=anything)
        return npy(run.read("e.npy"))[2], npy(run.read("s.npy"))[2]


def statuses(run, numbers, steepness, thickness, far):
    """Those of the images on one lattice."""
    sheet = Sheet(numbers, steepness, thickness, far)
    found = sheet.embed(run, sheet.images(numbers))[1]
    # They are taken for what they are when they come from the file.
    run.ffd("deform", "a.ply", "o.ply", "-l", "l.json", "--embedding", "e.npy", "--force", err=anything)
    return found


def none_is_outside(run, most_steep, most_thin, most_singular=None, far=1):
    numbers = random.Random(SEED)
    total = singular = 0
    while total < CASES / 5:
        steepness = numbers.choice((0, 1)) * numbers.uniform(0, most_steep)
        thickness = 10 ** -(numbers.choice((0, 1)) * numbers.uniform(0, most_thin))
        found = statuses(run, numbers, steepness, thickness, far)
        check(found.count(1) == 0, f"FFD_SEED={SEED}: {found.count(1)} of {EACH} are outside, after {total}; weights to "
              f"10^{steepness:.1f}, thickness {thickness:.1e}; {run.text('l.json')[:120]}")
        total, singular = total + EACH, singular + found.count(3)
    check(most_singular is None or singular <= most_singular * total, f"{singular} of {total} are singular")


@case
def images_under_steep_weights_are_found(run):
    none_is_outside(run, 4, 0, 1e-3)


@case
def images_in_thin_sheets_are_found(run):
    none_is_outside(run, 0, 12, 1e-3)


@case
def images_under_steep_weights_in_thin_sheets_are_found(run):
    none_is_outside(run, 4, 12, 1e-3)


@case
def thin_sheets_far_from_the_origin(run):
    none_is_outside(run, 0, 9, 1e-3, far=1000)


@case
def steeper_and_thinner(run):
    none_is_outside(run, 6, 14)


@case
def images_inside_hold_the_bound(run):
    """In 40 digits, for a sample; and the report's residual is what it says."""
    numbers = random.Random(SEED)
    total = singular = 0
    while total < CASES / 5:
        sheet = Sheet(numbers, numbers.uniform(0, 6), 10 ** -(numbers.choice((0, 1)) * numbers.uniform(0, 12)))
        vertices = sheet.images(numbers)
        places, found = sheet.embed(run, vertices)
        run.ffd("check", "a.ply", "-l", "l.json", "--report", "r.json", "--force", err=anything)
        most = Decimal(json.loads(run.read("r.json"))["jobs"][0]["residual"]["max"])
        diagonal = Decimal(math.dist([min(p[a] for p in sheet.points) for a in range(3)],
                                     [max(p[a] for p in sheet.points) for a in range(3)]))
        for i in numbers.sample(range(EACH), 10):
            if found[i] == 0:
                residual, part = residual_by_bound(sheet.directions, sheet.points, sheet.weights, places[i], vertices[i])
                check(part <= 1, f"FFD_SEED={SEED}: {part:.4g} of the bound at {places[i]}, after {total}; {sheet}")
                check(residual <= most * diagonal + max(tolerance(sheet.points, vertices[i])) / 4,
                      f"FFD_SEED={SEED}: the residual is {residual:.4g} of {diagonal:.4g}, reported {most:.4g}; {sheet}")
        total, singular = total + EACH, singular + found.count(3)
    check(singular <= 5e-3 * total, f"{singular} of {total} are singular")


@case
def steep_weights_do_not_make_one_root_two(run):
    """Turned sheets with weights that vary along the thin direction alone are one to one: no image is multiple."""
    numbers = random.Random(SEED)
    for _ in range(max(CASES // 2000, 1)):
        sheet = Sheet(numbers, 4, 10 ** -numbers.uniform(9, 13), kinds=("clamped", "list"), closed=0)
        n, m, _ = (d.n for d in sheet.directions)
        sheet.weights = [sheet.weights[i // (n * m)] for i in range(len(sheet.points))]
        flat, matrix = [d.places for d in sheet.directions], turn(numbers)
        sheet.points = [[r[0] * u + r[1] * v + r[2] * w * sheet.thickness for r in matrix]
                        for w in flat[2] for v in flat[1] for u in flat[0]]
        found = sheet.embed(run, sheet.images(numbers))[1]
        equal((found.count(1), found.count(2)), (0, 0), f"FFD_SEED={SEED}: outside and multiple; {sheet}")


def border_points(numbers, sheet, share):
    """Points on faces, edges and corners, moved by this share of the tolerance in each coordinate, mostly outwards."""
    moved = []
    for _ in range(EACH):
        fixed = numbers.sample(range(3), numbers.choice((1, 1, 2, 3)))
        ends = [numbers.randrange(2) if a in fixed else numbers.random() for a in range(3)]
        uvw = [d.t[d.degree] + x * (d.t[-1 - d.degree] - d.t[d.degree]) for d, x in zip(sheet.directions, ends)]
        c, jacobian = evaluate(sheet.directions, sheet.points, sheet.weights, uvw)
        out = [sum(row[a] if ends[a] else -row[a] for a in fixed) for row in jacobian]
        sign = [(1 if x > 0 else -1) if numbers.random() < 0.8 else numbers.choice((1, -1)) for x in out]
        moved.append([float(x + s * share * t) for x, s, t in zip(c, sign, tolerance(sheet.points, [float(x) for x in c]))])
    return moved


@case
def points_within_the_tolerance_of_the_border_are_inside(run):
    """Affine, sheared, curved and rational volumes, turned: the border point of least squares is often another one."""
    numbers = random.Random(SEED)
    for k in range(max(CASES // 2000, 4)):
        sheet = Sheet(numbers, k % 2 * numbers.uniform(0, 2), 1, kinds=("clamped", "open"), closed=0)
        if k % 4 == 0:
            shear, matrix, flat = numbers.uniform(0, 1), turn(numbers), [d.places for d in sheet.directions]
            sheet.points = [[m[0] * (u + shear * v) + m[1] * v + m[2] * w for m in matrix]
                            for w in flat[2] for v in flat[1] for u in flat[0]]
        found = sheet.embed(run, border_points(numbers, sheet, Decimal("0.9")))[1]
        check(found.count(1) == 0, f"FFD_SEED={SEED}: {found.count(1)} of {EACH} are outside; {sheet}, lattice {k}")


@case
def a_point_near_a_common_face_is_in_one_of_two_blocks(run):
    """Turned boxes side by side: a vertex within the tolerance of their common face's edge is in the one or the other."""
    numbers = random.Random(SEED)
    for _ in range(max(CASES // 20000, 1)):
        sheet = Sheet(numbers, 0, 1, kinds=("clamped",), closed=0)
        matrix, flat = turn(numbers), [d.places for d in sheet.directions]

        def block(low, high, matrix=matrix, flat=flat):
            return [[m[0] * (low + u * (high - low)) + m[1] * v + m[2] * w for m in matrix]
                    for w in flat[2] for v in flat[1] for u in flat[0]]

        lattice = None
        for name, low, high in (("b.json", 1, 2), ("l.json", 0, 1)):
            sheet.points = block(low, high)
            sheet.write(run, border_points(numbers, sheet, Decimal("0.9")))
            if name != "l.json":
                lattice = run.read("l.json")
        run.write("b.json", lattice)
        run.ffd("check", "a.ply", "-l", "l.json", "-l", "b.json", "--blocks", "--report", "r.json", "--force", err=anything)
        job = json.loads(run.read("r.json"))["jobs"][0]
        equal((job["inside"], job["outside"]), (EACH, 0), f"FFD_SEED={SEED}")


print(f"FFD_SEED={SEED}", flush=True)
main()
