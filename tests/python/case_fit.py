"""Fits: right answers, the bytes of the command, what is refused."""

import glob
import json
import math
import os
import subprocess
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("fit")
SIDE = 9


def body():
    """Points of a bent sheet, where they are wanted, and its triangles."""
    x, y = (v.ravel() for v in np.meshgrid(np.linspace(-1, 1, SIDE), np.linspace(-1, 1, SIDE)))
    points = np.stack([x, y, 0.5 * x * y], axis=1)
    wanted = points * (1.25, 1, 1) + np.stack([0.125 * y * y, 0.25 * x, 0.125 * np.sin(2 * x)], axis=1)
    a = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)[:-1, :-1].ravel()
    return points, wanted, np.concatenate([np.stack([a, a + 1, a + SIDE + 1], axis=1), np.stack([a, a + SIDE + 1, a + SIDE], axis=1)])


def obj(points, triangles):
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles.tolist())


def derivative(knots, degree, order, u):
    """The basis functions of a knot vector, or their derivatives, at u: (len(u), n), by the recurrence of Cox and de Boor."""
    if order > 0:
        lower = derivative(knots, degree - 1, order - 1, u)
        scaled = [degree / (knots[i + degree] - knots[i]) * lower[:, i] if knots[i + degree] > knots[i] else 0 * u for i in range(lower.shape[1])]
        return np.stack([scaled[i] - scaled[i + 1] for i in range(len(scaled) - 1)], axis=1)
    values = [((knots[i] <= u) & (u < knots[i + 1])) * 1.0 for i in range(len(knots) - 1)]
    for d in range(1, degree + 1):
        rise = [(u - knots[i]) / max(knots[i + d] - knots[i], 1e-300) * values[i] for i in range(len(values))]
        fall = [(knots[i + d + 1] - u) / max(knots[i + d + 1] - knots[i + 1], 1e-300) * values[i + 1] for i in range(len(values) - 1)]
        values = [a + b for a, b in zip(rise, fall)]
    return np.stack(values, axis=1)


def gram(knots, degree, order, points, length):
    """The integrals of products of derivatives over the domain, as if it had this length; closed ones by wrapped functions."""
    nodes, weights = np.polynomial.legendre.leggauss(degree + 1)
    low, high = knots[degree], knots[-degree - 1]
    whole = np.zeros((len(knots) - degree - 1,) * 2)
    for a, b in zip(knots[degree:-degree - 1], knots[degree + 1:len(knots) - degree]):
        if b > a:
            values = derivative(knots, degree, order, (a + b) / 2 + (b - a) / 2 * nodes)
            whole += values.T @ (values * (weights * (b - a) / 2 / (high - low))[:, None])
    wrap = np.arange(len(whole)) % points
    folded = np.zeros((points, points))
    np.add.at(folded, (wrap[:, None], wrap[None, :]), whole)
    return folded * ((high - low) / length) ** (2 * order) * length


def lines(rest, direction, closed):
    """The mean length of the lines of control points."""
    steps = np.diff(rest, axis=direction, append=np.take(rest, [0], axis=direction)) if closed else np.diff(rest, axis=direction)
    return np.linalg.norm(steps, axis=3).sum(axis=direction).mean()


def bending(lattice, closed):
    """The energy of a thin plate, (n, n), in Python's order of the control points."""
    lengths = [lines(lattice.rest, a, closed[a]) for a in range(3)]
    g = [[gram(np.array(lattice.knots[a]), lattice.degree[a], q, lattice.size[a], lengths[a]) for q in range(2 if 1 in lattice.degree else 3)] for a in range(3)]

    def product(*orders):
        return np.kron(np.kron(g[0][orders[0]], g[1][orders[1]]), g[2][orders[2]])
    if 1 in lattice.degree:
        return product(1, 0, 0) + product(0, 1, 0) + product(0, 0, 1)
    return product(2, 0, 0) + product(0, 2, 0) + product(0, 0, 2) + 2 * (product(1, 1, 0) + product(1, 0, 1) + product(0, 1, 1))


def dense_fit(base, closed, source, target, weights, smooth):
    """The offsets (n, 3) by dense matrices: the nearest affine map, then what bends the least."""
    affine = np.linalg.lstsq(np.sqrt(weights)[:, None] * np.c_[np.ones(len(source)), source], np.sqrt(weights)[:, None] * (target - source), rcond=None)[0]
    left = target - source - np.c_[np.ones(len(source)), source] @ affine
    embedding = base.embed(source)
    b = base.basis(embedding)
    b = b @ np.eye(b.shape[1])
    normal, energy = b.T @ (weights[:, None] * b) / weights.sum(), bending(base, closed)
    t = np.trace(normal)
    found = np.linalg.solve(normal + smooth * t / np.trace(energy) * energy, b.T @ (weights[:, None] * left) / weights.sum())
    rest = base.rest.reshape(-1, 3)
    return found + np.c_[np.ones(len(rest)), rest] @ affine


class Fits(unittest.TestCase):
    def setUp(self):
        self.points, self.wanted, self.triangles = body()

    def test_the_reference_cases(self):
        folder = os.path.join(support.SOURCE, "tests", "cli", "authoring")
        paths = sorted(glob.glob(os.path.join(folder, "fit-*.json")) + glob.glob(os.path.join(folder, "handle-*.json")))
        self.assertEqual(len(paths), 5)
        for path in paths:
            with open(path, encoding="utf-8") as file:
                of = json.load(file)
            exact = [i for i, w in enumerate(of["weight"]) if w == "exact"]
            weights = [1 if w == "exact" else w for w in of["weight"]]
            found = ffd.fit(np.array(of["before"]), np.array(of["after"]), ffd.Lattice.parse({**of["base"], "moves": []}), weights=weights,
                            exact=exact, handles="--handles" in of["command"], smooth=of["smooth"])
            offsets = found.lattice.offsets.transpose(2, 1, 0, 3).reshape(-1, 3)
            np.testing.assert_allclose(offsets, of["expect"]["offsets"], rtol=0, atol=of["expect"]["tolerance"], err_msg=path)
            self.assertEqual(found.report["exact"], len(exact))
            self.assertAlmostEqual(found.report["residual"]["max"], found.residuals.max(), delta=0)

    def test_the_bytes_of_the_command(self):
        """fit, fit_file and the program give the same lattice and the same report."""
        with tempfile.TemporaryDirectory() as folder:
            def at(name):
                return os.path.join(folder, name)
            for name, points in (("a.obj", self.points), ("b.obj", self.wanted)):
                with open(at(name), "w", encoding="utf-8") as file:
                    file.write(obj(points, self.triangles))
            for options, more in (({}, []), ({"smooth": 0.1, "robust": True, "symmetric": "v"}, ["--smooth", "0.1", "--robust", "--symmetric", "v"]),
                                  ({"within": "0.01r", "size": (5, 6, 4)}, ["--within", "0.01r", "--size", "5,6,4"])):
                subprocess.run([support.FFD, "fit", at("a.obj"), at("b.obj"), "-o", at("c.json"), "--force", "-q", "--report",
                                at("r.json"), "--report-stable", *more], check=True)
                made = ffd.fit_file(at("a.obj"), at("b.obj"), at("p.json"), force=True, **options)
                found = ffd.fit(self.points, self.wanted, triangles=self.triangles, **options)
                with open(at("c.json"), "rb") as one, open(at("p.json"), "rb") as other, open(at("r.json"), encoding="utf-8") as report:
                    expected = one.read()
                    self.assertEqual(other.read(), expected)
                    told = json.load(report)["jobs"][0]["fit"]
                self.assertEqual([made.report, made.warnings, set(made.seconds)], [told, [], {"read", "fit", "write"}])
                self.assertEqual(found.report, told)
                found.lattice.save(at("q.json"), force=True)
                with open(at("q.json"), "rb") as file:
                    self.assertEqual(file.read(), expected)
            with open(at("pairs.csv"), "w", encoding="utf-8") as file:
                file.write("vertex,x,y,z,weight\n3,0,0,1,exact\n40,0.5,0,0,\n")
            made = ffd.fit_file(at("a.obj"), None, at("h.json"), pairs=at("pairs.csv"), handles=True, base=at("p.json"))
            self.assertEqual([made.report["pairs"], made.report["exact"], made.report["smooth_chosen_by"]], [2, 1, "default"])
            for call, error in ((lambda: ffd.fit_file(at("a.obj"), at("b.obj"), at("h.json")), ffd.ExistsError),
                                (lambda: ffd.fit_file(at("a.obj"), None, at("x.json")), ffd.ArgumentError),
                                (lambda: ffd.fit_file(at("a.obj"), at("b.obj"), at("x.json"), base=at("p.json"), size=4), ffd.ArgumentError),
                                (lambda: ffd.fit_file(at("a.obj"), at("none.obj"), at("x.json")), ffd.FileError)):
                with self.assertRaises(error):
                    call()
            with open(at("m.obj"), "w", encoding="utf-8") as file:
                file.write(obj(self.points * (-2, 1, 1), self.triangles))
            with self.assertRaises(ffd.GateError) as gate:
                ffd.fit_file(at("a.obj"), at("m.obj"), at("x.json"), fail_on="folds")
            self.assertEqual([gate.exception.result["folds"]["verdict"], gate.exception.result["smooth"]], ["some", 100])
            self.assertFalse(os.path.exists(at("x.json")))

    def test_a_known_lattice_is_found_again(self):
        lattice = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=(4, 5, 4), degree=3, knots="clamped")
        lattice = lattice.moved(offsets=RANDOM.uniform(-0.125, 0.125, (4, 5, 4, 3)))
        points = RANDOM.uniform(-1, 1, (800, 3))
        base = lattice.strength(0)
        found = ffd.fit(points, lattice.deform(lattice.embed(points)), base, smooth=0)
        np.testing.assert_allclose(found.lattice.offsets, lattice.offsets, rtol=0, atol=1e-9)
        self.assertLess(found.residuals.max(), 1e-10)
        from_there = ffd.fit(points, lattice.deform(lattice.embed(points)), lattice, smooth=1)
        np.testing.assert_allclose(from_there.lattice.offsets, lattice.offsets, rtol=0, atol=1e-12)

    def test_beside_a_dense_solve(self):
        """Closed, rational and curved bases, of degrees that differ, too."""
        turn, height = np.linspace(0, 2 * np.pi, 7, endpoint=False), np.linspace(0, 2, 5)
        ring = np.stack([np.stack([[[r * np.cos(a), r * np.sin(a), z] for z in height] for r in (0.5, 0.9, 1.3)]) for a in turn])
        box = np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 4), np.linspace(-1, 1, 6), indexing="ij"), axis=-1)
        curved = box + 0.12 * np.sin(2 * box[..., [1, 2, 0]])
        for points, degree, knots, rational in ((ring, (3, 2, 3), ("closed", "clamped", "clamped"), False), (ring, (2, 1, 2), ("closed", "clamped", "open"), False),
                                                (box, (3, 3, 3), "clamped", True), (curved, (2, 3, 4), "clamped", False), (curved, (3, 2, 2), "open", True)):
            weights = RANDOM.uniform(0.5, 2, points.shape[:3]) if rational else None
            base = ffd.Lattice.from_points(points, degree, knots=knots, weights=weights)
            low, high = base.domain
            source = base.evaluate(RANDOM.uniform(low, high, (700, 3)), volume="rest")
            target = source * (1.1, 1, 0.9) + 0.1 * np.sin(3 * source[:, [2, 0, 1]])
            counts = RANDOM.uniform(0.1, 3, 700)
            for smooth in (1, 0.01):
                found = ffd.fit(source, target, base, weights=counts, smooth=smooth)
                self.assertEqual(found.report["used"], 700)
                expected = dense_fit(base, [kind == "closed" for kind in (knots if isinstance(knots, tuple) else [knots] * 3)], source, target, counts, smooth)
                np.testing.assert_allclose(found.lattice.offsets.reshape(-1, 3), expected, rtol=0, atol=1e-9, err_msg=f"{degree} {knots} {smooth}")

    def test_cross_validation_without_the_exact_rows(self):
        """The value that chose S, by dense matrices: the trace is that of the soft rows alone."""
        base = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=(4, 5, 4), degree=3, knots="clamped")
        source = RANDOM.uniform(-1, 1, (60, 3))
        target = source + 0.03 * np.sin(3 * source[:, [1, 2, 0]]) + RANDOM.normal(0, 0.003, source.shape)
        for exact in ([], [3, 17, 40]):
            found = ffd.fit(source, target, base, exact=exact)
            soft = np.setdiff1d(np.arange(60), exact)
            b = base.basis(base.embed(source[soft]))
            b = b @ np.eye(b.shape[1])
            normal, energy = b.T @ b / len(soft), bending(base, [False] * 3)
            smooth = found.report["smooth"] if found.report["smooth_chosen_by"] == "gcv" else None
            self.assertIsNotNone(smooth)
            matrix = normal + smooth * np.trace(normal) / np.trace(energy) * energy
            left = 1 - np.trace(np.linalg.solve(matrix, normal)) / len(soft)
            self.assertAlmostEqual(found.report["gcv"], np.mean(found.residuals[soft] ** 2) / left ** 2, delta=1e-9 * found.report["gcv"])

    def test_residuals_and_pairs_that_do_not_count(self):
        base = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=4)
        points = np.concatenate([self.points, [[5, 0, 0]]])
        weights = np.ones(len(points))
        weights[7] = 0
        found = ffd.fit(points, points + (0, 0, 0.5), base, weights=weights, smooth=1)
        self.assertEqual([found.report["pairs"], found.report["used"], found.report["outside"]], [len(points), len(points) - 2, 1])
        self.assertEqual(np.flatnonzero(np.isnan(found.residuals)).tolist(), [7, len(points) - 1])
        self.assertLess(np.nanmax(found.residuals), 1e-14)

    def test_progress(self):
        told = []
        ffd.fit(self.points, self.wanted, size=8, smooth=1, progress=told.append)
        self.assertTrue(told and all(0 <= done <= 1 for done in told))
        with self.assertRaises(ffd.Cancelled):
            ffd.fit(self.points, self.wanted, smooth=1, progress=lambda done: False)

    def test_refusals(self):
        a, b = self.points, self.wanted
        base = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=4)
        broken = b.copy()
        broken[3, 1] = math.nan
        for call, error in ((lambda: ffd.fit(a, b[1:]), ValueError), (lambda: ffd.fit(a, broken), ffd.InvalidError),
                            (lambda: ffd.fit(a, b, smooth=-1), ffd.ArgumentError), (lambda: ffd.fit(a, b, smooth="much"), ValueError),
                            (lambda: ffd.fit(a, b, smooth=1, within=1), ValueError), (lambda: ffd.fit(a, b, symmetric="x"), ValueError),
                            (lambda: ffd.fit(a, b, exact=[len(a)]), ffd.ArgumentError), (lambda: ffd.fit(a, b, exact=[-1]), ValueError),
                            (lambda: ffd.fit(a, b, handles=True, robust=True), ffd.ArgumentError), (lambda: ffd.fit(a, b, "base.json"), TypeError),
                            (lambda: ffd.fit(a, b, weights=np.ones(3)), ValueError), (lambda: ffd.fit(a, b, weights=-np.ones(len(a))), ffd.InvalidError),
                            (lambda: ffd.fit(a, b, weights=np.ones(len(a)), triangles=self.triangles), ValueError),
                            (lambda: ffd.fit(a + 9, b, base), ffd.EmbeddingError), (lambda: ffd.fit(a, b, within=1e-14), ffd.UnmetError),
                            (lambda: ffd.fit(a[[0, 0]], b[:2], base, exact=[0, 1]), ffd.UnmetError), (lambda: ffd.fit(a, b, size=39), ffd.LimitError)):
            with self.assertRaises(error):
                call()
