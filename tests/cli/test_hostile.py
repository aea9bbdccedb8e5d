#!/usr/bin/env python3
"""Lattices made to be hard: huge, folded all over, without volume, at the ends of the range of doubles. Each run
ends in time and memory with a clear message or with true statuses: every u,v,w is put back into C, evaluated
here, and what is called inside must have no second u,v,w that random starts come upon."""
import math
import os
import random
import resource
import struct

from harness import CUBE, INVALID, LIMIT, OK, SANITIZED, case, check, equal, lattice, main, npy, obj_of, repetitions
from vectors import cross, dot

INSIDE, OUTSIDE, MULTIPLE, SINGULAR, POINT_INVALID = range(5)
EPSILON = 2.0**-52
GIGA = 2**30

# A sanitizer needs terabytes of addresses and several times the time.
CPU_SECONDS = 200 if SANITIZED else 20
# Control points along each direction of the largest lattices: 200 in the soak run.
LARGE = int(os.environ.get("FFD_LARGE") or 100)
MEMORY = ["--memory", "4G"] if LARGE > 100 else []


def limits(addresses):
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (3 * CPU_SECONDS, 3 * CPU_SECONDS))
        if not SANITIZED:
            resource.setrlimit(resource.RLIMIT_AS, (addresses, addresses))
    return limit


class Spline:
    """C of clamped uniform knots over [0,1]; point(i, j, k) tells the control points."""

    def __init__(self, size, degree, point):
        self.size, self.degree, self.point = size, degree, point
        self.knots = [[min(max(i - d, 0), n - d) / (n - d) for i in range(n + d + 1)]
                      for n, d in zip(size, degree)]

    def basis(self, a, u):
        """The first function that is not 0, the values and the derivatives of those (P&T A2.2 by rising degree)."""
        n, d, t = self.size[a], self.degree[a], self.knots[a]
        s = min(max(int(u * (n - d)), 0), n - d - 1) + d
        while s > d and u < t[s]:
            s -= 1
        while s < n - 1 and u >= t[s + 1]:
            s += 1
        values, lower = [1.0], []
        for e in range(1, d + 1):
            lower, values = values, [0.0] * (e + 1)
            for r in range(e):
                part = lower[r] / (t[s + r + 1] - t[s + r + 1 - e])
                values[r] += (t[s + r + 1] - u) * part
                values[r + 1] += (u - t[s + r + 1 - e]) * part
        slopes = [0.0] * (d + 1)
        for r in range(d):
            part = d * lower[r] / (t[s + r + 1] - t[s + r + 1 - d])
            slopes[r] -= part
            slopes[r + 1] += part
        return s - d, values, slopes

    def __call__(self, uvw, origin):
        """C - origin, and the columns of J."""
        (first, nu, du), (second, nv, dv), (third, nw, dw) = (self.basis(a, uvw[a]) for a in range(3))
        sums = [[0.0] * 3 for _ in range(4)]
        for k, (c, dc) in enumerate(zip(nw, dw)):
            layer = [[0.0] * 3 for _ in range(3)]  # the sum over i and j, its derivatives by u and by v
            for j, (b, db) in enumerate(zip(nv, dv)):
                x = y = z = along_x = along_y = along_z = 0.0
                for i, (a, da) in enumerate(zip(nu, du)):
                    p = self.point(first + i, second + j, third + k)
                    here_x, here_y, here_z = p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]
                    x += a * here_x
                    y += a * here_y
                    z += a * here_z
                    along_x += da * here_x
                    along_y += da * here_y
                    along_z += da * here_z
                for total, factor, row in zip(layer, (b, b, db), ((x, y, z), (along_x, along_y, along_z), (x, y, z))):
                    for r in range(3):
                        total[r] += factor * row[r]
            for total, factor, row in zip(sums, (c, c, c, dc), (*layer, layer[0])):
                for r in range(3):
                    total[r] += factor * row[r]
        return sums[0], sums[1:]


def newton(spline, p, uvw, residual):
    """A root from a random start, or None."""
    for _ in range(15):
        value, (cu, cv, cw) = spline(uvw, p)
        if max(map(abs, value)) <= residual:
            return uvw
        normals = cross(cv, cw), cross(cw, cu), cross(cu, cv)
        det = dot(cu, normals[0])
        if det == 0 or not math.isfinite(det):
            return None
        uvw = [min(max(t - dot(value, n) / det, 0.0), 1.0) for t, n in zip(uvw, normals)]
    return None


def embed(run, mesh, lattice_file, code=OK, again=True, addresses=2 * GIGA):
    """Runs embed within the limits; the rows and statuses, or None after a failure of an allowed code. again: a
    second run by one thread gives the same bytes, which a sanitizer does not change."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = run.ffd("embed", mesh, "-l", lattice_file, "-o", "e.npy", "--status", "s.npy", "--force", "-q", *MEMORY, code=code,
                   preexec_fn=limits(addresses))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    check(seconds <= CPU_SECONDS, f"{lattice_file}: {seconds:.1f} s of CPU time")
    if done.code != OK:
        check(not run.exists("e.npy") and not run.exists("s.npy"), "nothing is written")
        return None
    found = npy(run.read("e.npy"))[2], npy(run.read("s.npy"))[2]
    if not again or SANITIZED:
        return found
    run.ffd("embed", mesh, "-l", lattice_file, "-o", "one.npy", "--force", "-q", "-j", "1", *MEMORY,
            preexec_fn=limits(addresses))
    equal(run.read("one.npy"), run.read("e.npy"), "one thread")
    return found


def write_points(run, points):
    run.write("m.obj", obj_of(points))


def write_lattice(run, size, degree, points):
    """Returns C and the bounds of the control points."""
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree,
                         "rest": {"points": points}})
    bounds = [(min(p[a] for p in points), max(p[a] for p in points)) for a in range(3)]
    return Spline(size, degree, lambda i, j, k: points[i + size[0] * (j + size[1] * k)]), bounds


def verify(spline, bounds, points, found):
    """What the statuses say of u,v,w, and C(u,v,w) = p up to src/maths.md 6.6 and the rounding of this evaluation.
    Returns how often each status stands."""
    rows, statuses = found
    equal(len(statuses), len(points))
    for p, uvw, status in zip(points, rows, statuses):
        none = any(math.isnan(t) for t in uvw)
        check(none == (status == OUTSIDE) or status == SINGULAR, p, uvw, status)
        if none:
            continue
        check(all(0 <= t <= 1 for t in uvw), p, uvw)
        for a, value in enumerate(spline(uvw, p)[0]):
            low, high = bounds[a]
            allowed = 64 * EPSILON * (high - low + max(abs(p[a] - low), abs(p[a] - high)))
            if status == SINGULAR:  # where the search stood still
                allowed += 2e-6 * (high - low)
            check(abs(value) <= allowed, f"{p} has status {status} at {uvw}, where C - p is {value}")
    return [statuses.count(status) for status in range(5)]


def look_for_more(spline, bounds, points, found, draw, starts):
    """No start leads to another root of a point that is called inside, and to none of one that is called
    outside. Roots are numbers, which no sanitizer changes."""
    if SANITIZED:
        return 1
    extent = max(high - low for low, high in bounds)
    roots = 0
    for p, uvw, status in zip(points, *found):
        if status not in (INSIDE, OUTSIDE):
            continue
        for _ in range(starts):
            root = newton(spline, p, [draw.random() for _ in range(3)], 8 * EPSILON * extent)
            if root is None:
                continue
            roots += 1
            check(status == INSIDE and max(abs(s - t) for s, t in zip(root, uvw)) < 1e-6,
                  f"{p} has status {status} at {uvw}, but also {root}")
    return roots


def within(draw, bounds, count):
    return [[draw.uniform(low, high) for low, high in bounds] for _ in range(count)]


def wave(n):
    """Control points of a smooth warp of n x n x n, in whole numbers."""
    sway = [round(3 * n * math.sin(6 * i / n) / 10) for i in range(n)]
    return sway, lambda i, j, k: (20 * i + sway[j], 20 * j + sway[k], 20 * k + sway[i])


def write_wave(run, n):
    sway, point = wave(n)
    with open(run.path("l.json"), "w", encoding="ascii") as file:
        file.write('{"format":"ffd-lattice","version":1,"size":[%d,%d,%d],"rest":{"points":[' % (n, n, n))
        for k in range(n):
            file.write(",\n" if k else "")
            file.write(",".join("[%d,%d,%d]" % (20 * i + sway[j], 20 * j + sway[k], 20 * k + sway[i])
                                for j in range(n) for i in range(n)))
        file.write("]}}")
    most = 20 * (n - 1) + max(sway)
    return Spline([n] * 3, [3] * 3, point), [(min(sway), most)] * 3


@case
def sixty_cubed_control_points(run):
    draw = random.Random(1)
    spline, bounds = write_wave(run, 24 if SANITIZED else 60)
    known = [[draw.random() for _ in range(3)] for _ in range(300)]
    points = [spline(uvw, (0, 0, 0))[0] for uvw in known] + within(draw, bounds, 300)
    write_points(run, points)
    found = embed(run, "m.obj", "l.json")
    counts = verify(spline, bounds, points, found)
    equal(found[1][:300], [INSIDE] * 300)
    for expected, uvw in zip(known, found[0]):
        check(max(abs(s - t) for s, t in zip(expected, uvw)) < 1e-12, expected, uvw)
    check(counts[OUTSIDE] > 10 and counts[INSIDE] + counts[OUTSIDE] == 600, counts)


@case
def many_control_points(run):
    """A file of 15 MB, or of 120 MB in the soak run: within 17 times as much the program answers, or says that it
    cannot."""
    if SANITIZED:
        return
    draw = random.Random(2)
    spline, bounds = write_wave(run, LARGE)
    points = within(draw, bounds, 600)
    write_points(run, points)
    found = embed(run, "m.obj", "l.json", code=(OK, LIMIT), again=False, addresses=2 * GIGA * LARGE**3 // 200**3)
    if found:
        counts = verify(spline, bounds, points, found)
        check(counts[INSIDE] > 400 and counts[INSIDE] + counts[OUTSIDE] == 600, counts)


@case
def files_of_many_control_points(run):
    """Every command takes such a file, and refuses what is left of it."""
    n = LARGE if LARGE > 100 else 30
    write_wave(run, n)
    run.write("m.obj", CUBE)
    options = {} if SANITIZED else {"preexec_fn": limits(2 * GIGA)}
    run.ffd("info", "l.json", **options)
    if n <= 100:  # that none of seven million cells folds is proven in a minute
        run.ffd("check", "m.obj", "-l", "l.json", "-q", **options)
    run.ffd("deform", "m.obj", "same.obj", "-l", "l.json", "-q", **options)
    equal(run.text("same.obj"), CUBE, "a lattice that moves nothing")
    run.ffd("lattice", "new", "m.obj", "-o", "new.json", "--size", f"{n},{n},{n}", *MEMORY, **options)
    run.ffd("deform", "m.obj", "as-new.obj", "-l", "new.json", "-q", *MEMORY, **options)
    equal(run.text("as-new.obj"), CUBE, "a new lattice")
    whole = run.text("l.json")
    point = whole.rindex("[")
    for what, text in (("cut", whole[:-3]), ("half", whole[:len(whole) // 2]), ("one point less", whole[:point - 1] + "]}}"),
                       ("NaN", whole[:point] + "[NaN,0,0]]}}"), ("infinite", whole[:point] + "[1e999,0,0]]}}")):
        run.write("l.json", text)
        done = run.ffd("deform", "m.obj", "bad.obj", "-l", "l.json", code=INVALID, **options)
        check(done.err[0].startswith("l.json"), what, done.err)
        check(not run.exists("bad.obj"), what)


@case
def a_cylinder_of_many_control_points(run):
    """As above, but from a short file: the budget allows the search."""
    if SANITIZED:
        return
    draw, n = random.Random(3), LARGE
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [n, n, n],
                         "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "zero": [1, 0, 0],
                                               "radius": [0, 2], "height": 4, "angle": [0, 360]}}})
    points = [[draw.uniform(-2.2, 2.2), draw.uniform(-2.2, 2.2), draw.uniform(-2.2, 2.2)] for _ in range(1000)]
    write_points(run, points)
    rows, statuses = embed(run, "m.obj", "l.json", again=False)
    for (x, y, z), (u, v, w), status in zip(points, rows, statuses):
        radius, turn = math.hypot(x, y), math.atan2(y, x) / (2 * math.pi) % 1
        if radius > 2.001 or abs(z) > 2:
            equal(status, OUTSIDE, (x, y, z))
        elif radius < 2:
            equal(status, INSIDE, (x, y, z))
            check(abs(w - (z + 2) / 4) < 1e-12, z, w)
            # v is nearly the angle: rings of many points are nearly round.
            check(abs(v - turn) < 1e-5 or abs(v - turn) > 1 - 1e-5, turn, v)
            check(abs(u - radius / 2) < 1e-3, radius, u)


@case
def random_control_points_are_answered_truly(run):
    """Thousands of folds: nearly every point has many u,v,w or none."""
    roots, side = 0, 7 if SANITIZED else 12
    for size, degree, count in (([side] * 3, [3] * 3, 32), ([side] * 3, [1] * 3, 32), ([6, 5, 4], [4, 2, 3], 48)):
        draw = random.Random(sum(size))
        control = [[draw.random() for _ in range(3)] for _ in range(math.prod(size))]
        spline, bounds = write_lattice(run, size, degree, control)
        known = [[draw.random() for _ in range(3)] for _ in range(count // 2)]
        points = [spline(uvw, (0, 0, 0))[0] for uvw in known] + within(draw, bounds, count // 2)
        write_points(run, points)
        found = embed(run, "m.obj", "l.json")
        counts = verify(spline, bounds, points, found)
        check(OUTSIDE not in found[1][:count // 2], "a point of the volume is called outside")
        for uvw, row, status in zip(known, *found):
            check(status != INSIDE or max(abs(s - t) for s, t in zip(uvw, row)) < 1e-6, uvw, row)
        check(counts[MULTIPLE] > count // 8, counts)
        roots += look_for_more(spline, bounds, points, found, draw, 12)
    check(roots > 0, "no start found a root")


@case
def lattices_without_volume_are_refused(run):
    """Control points in a plane, on a line, at a point: the lattice is refused."""
    draw = random.Random(4)
    write_points(run, within(draw, [(0, 3)] * 3, 100) + [[1, 1, 0], [1, 0, 0], [0, 0, 0], [1.5, 1.5, 1.5]])
    grid = [(i, j, k) for k in range(4) for j in range(4) for i in range(4)]
    for name, flat in (("plane", lambda i, j, k: [i, j, 0]), ("oblique plane", lambda i, j, k: [i, j, i + 2 * j]),
                       ("line", lambda i, j, k: [i, 0, 0]), ("diagonal", lambda i, j, k: [i + j] * 3),
                       ("point", lambda i, j, k: [0, 0, 0]), ("far point", lambda i, j, k: [1e6, -1e6, 3])):
        write_lattice(run, [4] * 3, [3] * 3, [flat(*at) for at in grid])
        check(embed(run, "m.obj", "l.json", code=INVALID) is None, name)
    # One cell of many.
    control = [[min(i, 3) if j < 5 else i, j, k] for k in range(4) for j in range(4) for i in range(8)]
    write_lattice(run, [8, 4, 4], [1, 3, 3], control)
    equal(embed(run, "m.obj", "l.json", code=INVALID), None)


@case
def lattices_of_hardly_any_volume_are_refused_or_answered_truly(run):
    """Planes and lines up to rounding: refused, or answered truly."""
    draw = random.Random(5)
    for thickness in (1e-9, 1e-13, 1e-15, 1e-16, 1e-18, 1e-100, 5e-324):
        for bend in (0, 0.25):
            size = [5, 4, 4]
            control = [[i + bend * j * j, j - bend * i * k, thickness * k + bend * i * i]
                       for k in range(4) for j in range(4) for i in range(5)]
            spline, bounds = write_lattice(run, size, [3] * 3, control)
            points = [spline([draw.random() for _ in range(3)], (0, 0, 0))[0] for _ in range(20)]
            points += within(draw, bounds, 20)
            write_points(run, points)
            found = embed(run, "m.obj", "l.json", code=(OK, INVALID))
            if found:
                verify(spline, bounds, points, found)


@case
def collapsed_all_over(run):
    """Only one control point is apart; layers fall together; every second layer is turned back."""
    draw, known, count = random.Random(6), repetitions(30), repetitions(10)
    grid = [(i, j, k) for k in range(5) for j in range(5) for i in range(5)]
    shapes = {
        "one apart": lambda i, j, k: [1, 1, 1] if i + j + k == 12 else [0, 0, 0],
        "layers together": lambda i, j, k: [i // 2 * 2, j, k],
        "to an edge": lambda i, j, k: [i * (4 - k), j * (4 - k), k * 1.0],
        "to and fro": lambda i, j, k: [i + 3 * (j % 2), j + 3 * (k % 2), k + 3 * (i % 2)],
        "two corners at one": lambda i, j, k: [i * j, j * k, k * i],
        "all on a sphere": lambda i, j, k: [math.sin(i) * math.cos(j + k), math.sin(i) * math.sin(j + k), math.cos(i)],
    }
    for name, shape in shapes.items():
        for degree in (1, 2, 4):
            spline, bounds = write_lattice(run, [5] * 3, [degree] * 3, [list(map(float, shape(*at))) for at in grid])
            points = [spline([draw.choice((0, 0.25, 0.5, 1, draw.random())) for _ in range(3)], (0, 0, 0))[0]
                      for _ in range(known)] + within(draw, bounds, count)
            write_points(run, points)
            found = embed(run, "m.obj", "l.json", code=(OK, INVALID))
            if found:
                verify(spline, bounds, points, found)
                check(OUTSIDE not in found[1][:known], f"{name}, degree {degree}: a point of the volume is outside")
                look_for_more(spline, bounds, points, found, draw, 4)


@case
def ends_of_the_range(run):
    """Sizes from 1e-300 to 1e300, and points that no sum can hold."""
    draw = random.Random(7)
    for scale in (1e-300, 1e-150, 1e-30, 1e30, 1e100, 1e150, 1e300):
        control = [[scale * (i + 0.1 * j * j), scale * (j - 0.05 * i * k), scale * (k + 0.1 * i)]
                   for k in range(4) for j in range(4) for i in range(4)]
        spline, bounds = write_lattice(run, [4] * 3, [3] * 3, control)
        points = [spline([draw.random() for _ in range(3)], (0, 0, 0))[0] for _ in range(20)]
        write_points(run, points + [[1e308] * 3, [-1e308, 0, 0], [0, 5e-324, 0]])
        found = embed(run, "m.obj", "l.json", code=(OK, INVALID))
        if found:
            verify(spline, bounds, points, (found[0][:20], found[1][:20]))
            equal(found[1][:20], [INSIDE] * 20, f"scale {scale}")
            check(found[1][20] == OUTSIDE and found[1][21] == OUTSIDE, found[1][20:])


@case
def points_of_all_bits(run):
    """Coordinates drawn from all 64-bit patterns, in a box and in a bent lattice."""
    draw = random.Random(8)
    points = [struct.unpack("<3d", draw.randbytes(24)) for _ in range(500)]
    points = [p for p in points if all(map(math.isfinite, p))]
    run.write("m.obj", "v nan 0 0\n" + "".join("v %r %r %r\n" % p for p in points) + "v 0 -inf 0\n")
    run.write("box.json", lattice())
    bent = [[i + 0.1 * j * j, j - 0.05 * i * k, k + 0.1 * i] for k in range(4) for j in range(4) for i in range(4)]
    spline, bounds = write_lattice(run, [4] * 3, [3] * 3, bent)
    rows, statuses = embed(run, "m.obj", "l.json")
    equal([statuses[0], statuses[-1]], [POINT_INVALID] * 2)
    verify(spline, bounds, points, (rows[1:-1], statuses[1:-1]))
    _, statuses = embed(run, "m.obj", "box.json")
    inside = [all(abs(x) <= 2 for x in p) for p in points]
    equal(statuses[1:-1], [INSIDE if within_box else OUTSIDE for within_box in inside])


main()
