"""Lattices of a plane: points (N, 2) and control points (n, m, 2)."""

import os
import pickle
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support
from scipy.interpolate import BSpline

RANDOM = support.rng("plane")
POINTS = RANDOM.uniform(-0.3, 2.3, (3000, 2)) * (1, 0.6)
POINTS[7, 1] = np.nan
PLANES = {
    "cubic": ffd.Lattice.plane((0, -0.2), (2, 1.1), (6, 4)),
    "mixed": ffd.Lattice.plane((0, -0.2), (2, 1.1), (4, 5), (1, 4)),
    "open": ffd.Lattice.plane((0, -0.2), (2, 1.1), (6, 5), 2, knots="open"),
    "listed": ffd.Lattice.plane((0, -0.2), (2, 1.1), (5, 4), (2, 3), knots=([0, 0, 0, 0.2, 0.2, 1, 1, 1], "clamped")),
}


def pushed(plane, by=0.1):
    return plane.rest + by * RANDOM.standard_normal(plane.rest.shape)


def curved():
    """A plane whose rest is no rectangle."""
    plane = PLANES["cubic"].moved(pushed(PLANES["cubic"], 0.03)).invert()
    return plane.moved(pushed(plane, 0.05))


class Numbers(unittest.TestCase):
    def test_displacements_are_sums_of_b_splines(self):
        for name, plane in PLANES.items():
            D = 0.1 * RANDOM.standard_normal(plane.rest.shape)
            embedding = plane.embed(POINTS)
            inside = embedding.status == ffd.Status.INSIDE
            self.assertTrue(np.array_equal(inside, ((POINTS >= (0, -0.2)) & (POINTS <= (2, 1.1))).all(axis=1)))
            # A rectangle: u and v are affine.
            low, high = plane.domain
            uv = low + (POINTS[inside] - (0, -0.2)) / (2, 1.3) * (high - low)
            self.assertLess(np.abs(embedding.uvw[inside] - uv).max(), 1e-14)
            one, other = (BSpline.design_matrix(np.clip(uv[:, a], low[a], high[a]), plane.knots[a], plane.degree[a]).toarray() for a in (0, 1))
            wanted = np.einsum("ni,nj,ijc->nc", one, other, D)
            found = plane.deform(embedding, offsets=D)
            self.assertLess(np.abs(found[inside] - POINTS[inside] - wanted).max(), 1e-14, name)
            self.assertEqual(found[~inside].tobytes(), POINTS[~inside].tobytes())
            basis = plane.basis(embedding)
            self.assertEqual((basis.shape, found.shape), ((3000, plane.size[0] * plane.size[1]), (3000, 2)))
            self.assertTrue(basis.has_canonical_format)
            matrix = np.einsum("ni,nj->nij", one, other).reshape(inside.sum(), -1)
            self.assertLess(np.abs(basis.toarray()[inside] - matrix).max(), 1e-14)
            self.assertEqual(np.count_nonzero(basis.toarray()[~inside]), 0)

    def test_the_program_has_the_same_bits_for_points_at_z_0(self):
        for kind in (np.float32, np.float64):
            points = POINTS.astype(kind)
            solid = np.column_stack([points, np.zeros(len(points), kind)])
            for plane in (*PLANES.values(), curved()):
                moved = plane.moved(pushed(plane))
                for outside, falloff in (("keep", 0.0), ("extend", 0.5)):
                    found = moved.deform(moved.embed(points, outside=outside, falloff=falloff))
                    options = ["--outside", outside] + (["--falloff", str(falloff)] if falloff else [])
                    wanted = support.deformed_by_program(solid, moved, *options)
                    self.assertEqual(found.tobytes(), np.ascontiguousarray(wanted[:, :2]).tobytes())
                    self.assertEqual(found.dtype, kind)
                    self.assertFalse(wanted[:, 2].any())

    def test_gradients_and_directions(self):
        plane = curved()
        points = RANDOM.uniform(0.3, 0.7, (50, 2)) * (2, 1)
        angle = RANDOM.uniform(0, 6, 50)
        along = np.column_stack([np.cos(angle), np.sin(angle)])
        normals = along[:, ::-1] * (1, -1)
        made = plane.deform(plane.embed(points), normals=normals, tangents=along, gradients=True)
        self.assertEqual((made.points.shape, made.normals.shape, made.tangents.shape, made.gradients.shape), ((50, 2), (50, 2), (50, 2), (50, 2, 2)))
        F = np.eye(2) + made.gradients
        for c in range(2):
            step = 1e-6 * np.eye(2)[c]
            slope = (plane.deform(plane.embed(points + step)) - plane.deform(plane.embed(points - step))) / 2e-6
            self.assertLess(np.abs(slope - F[:, :, c]).max(), 1e-6)
        turned = np.einsum("nrc,nc->nr", F, along)
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        self.assertLess(np.abs(made.tangents - turned).max(), 1e-12)
        self.assertLess(np.abs((made.normals * turned).sum(axis=1)).max(), 1e-12)
        self.assertLess(np.abs(np.linalg.norm(made.normals, axis=1) - 1).max(), 1e-14)
        self.assertTrue(((made.normals[:, 0] * turned[:, 1] - made.normals[:, 1] * turned[:, 0]) * np.linalg.det(F) > 0).all())

    def test_weights_of_points_change_along_the_plane(self):
        plane = PLANES["cubic"].moved(pushed(PLANES["cubic"]))
        x, y = np.meshgrid(np.linspace(0.2, 1.8, 9), np.linspace(0, 1, 7), indexing="ij")
        points = np.column_stack([x.ravel(), y.ravel()])
        index = np.arange(63).reshape(9, 7)
        corners = [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]]
        triangles = np.concatenate([np.stack([corners[i].ravel() for i in face], axis=1) for face in ((0, 1, 2), (0, 2, 3))])
        weight = points[:, 0] / 2
        embedding = plane.embed(points)
        made = plane.deform(embedding, weight=weight, triangles=triangles, gradients=True)
        plain = plane.deform(embedding, gradients=True)
        self.assertLess(np.abs(made.points - points - weight[:, None] * (plain.points - points)).max(), 1e-15)
        wanted = weight[:, None, None] * plain.gradients + (plain.points - points)[:, :, None] * np.array([0.5, 0])
        self.assertLess(np.abs(made.gradients - wanted).max(), 1e-12)

    def test_folds(self):
        plane = PLANES["cubic"]
        folds = plane.folds()
        self.assertEqual((folds.verdict, folds.min_det, folds.cells), ("none", 1, 3))
        Q = plane.rest.copy()
        Q[1, :, 0] += 1.2
        folds = plane.folds(Q)
        self.assertEqual((folds.verdict, folds.witness_uvw.shape, folds.witness_xyz.shape), ("some", (2,), (2,)))
        moved, jacobian = plane.moved(Q).evaluate(folds.witness_uvw[None], jacobians=True)
        self.assertEqual((moved.shape, jacobian.shape), ((1, 2), (1, 2, 2)))
        self.assertLess(np.linalg.det(jacobian[0]), 0)
        self.assertLess(np.abs(plane.evaluate(folds.witness_uvw[None], volume="rest")[0] - folds.witness_rest).max(), 1e-12)
        barrier = plane.fold_barrier(Q, floor=0.5)
        self.assertEqual(barrier.gradient.shape, Q.shape)
        self.assertLess(barrier.least, 0)
        step = 1e-6 * RANDOM.standard_normal(Q.shape)
        slope = plane.fold_barrier(Q + step, floor=0.5).value - plane.fold_barrier(Q - step, floor=0.5).value
        self.assertLess(abs(slope - 2 * (barrier.gradient * step).sum()), 1e-5 * abs(slope))
        # One cell, whose determinant grows evenly to twice that at rest: each coefficient counts once.
        square = ffd.Lattice.plane((0, 0), (1, 1), 2)
        wide = square.rest.copy()
        wide[..., 0] *= 0.5
        barrier = square.fold_barrier(wide, floor=1)
        self.assertLess(abs(barrier.value - 9 * 0.25), 1e-12)
        self.assertLess(abs(barrier.least - 0.5), 1e-12)
        some = plane.fold_barrier(Q, embedding=plane.embed([[1.9, 0.5]]))
        self.assertLess(some.value, plane.fold_barrier(Q).value)


class Products(unittest.TestCase):
    def test_products_are_those_of_the_matrices(self):
        for plane in (PLANES["mixed"], curved(), PLANES["cubic"].moved(pushed(PLANES["cubic"]), weights=RANDOM.uniform(0.5, 2, (6, 4)))):
            embedding = plane.embed(POINTS[8:308], outside="extend", falloff=0.4)
            B, W = plane.basis(embedding), plane.weights_jacobian(embedding)
            D, g, dw = RANDOM.standard_normal(plane.rest.shape), RANDOM.standard_normal((300, 2)), RANDOM.standard_normal(plane.size)
            self.assertEqual(W.shape, (300, 2, dw.size))
            self.assertLess(np.abs(plane.basis_times(embedding, D) - B @ D.reshape(-1, 2)).max(), 1e-13)
            self.assertLess(np.abs(plane.basis_transposed(embedding, g) - (B.T @ g).reshape(D.shape)).max(), 1e-12)
            self.assertLess(np.abs(plane.weights_times(embedding, dw) - W @ dw.ravel()).max(), 1e-13)
            self.assertEqual(plane.weights_times(embedding, dw).tobytes(), plane.weights_times(embedding, dw.ravel()).tobytes())
            self.assertLess(np.abs(plane.weights_transposed(embedding, g).ravel() - np.einsum("ncj,nc->j", W, g)).max(), 1e-12)
            own = np.ones(plane.size) if plane.weights is None else plane.weights
            step = np.zeros(plane.size)
            step[1, 2] = 1e-5
            slope = (plane.deform(embedding, weights=own + step) - plane.deform(embedding, weights=own - step)) / 2e-5
            self.assertLess(np.abs(slope - W[:, :, plane.size[1] + 2]).max(), 1e-8)

    def test_variants_and_outputs(self):
        plane = PLANES["cubic"]
        embedding = plane.embed(POINTS)
        Qs = np.stack([pushed(plane) for _ in range(4)])
        made = plane.deform(embedding, Qs)
        self.assertEqual(made.shape, (4, 3000, 2))
        self.assertEqual(made.tobytes(), b"".join(plane.deform(embedding, Q).tobytes() for Q in Qs))
        offsets = Qs - plane.rest
        into = np.empty((4, 3000, 4), np.float32)[..., ::2]
        self.assertIs(plane.deform(embedding, offsets=offsets, out=into), into)
        self.assertTrue(np.array_equal(into, plane.deform(embedding, offsets=offsets).astype(np.float32), equal_nan=True))
        out = np.full((3000, 2), 7.0)
        some = np.array([3, 5, 2000])
        self.assertIs(plane.deform(embedding, Qs[0], out=out, vertices=some), out)
        self.assertTrue(np.array_equal(out[some], made[0, some]) and (np.delete(out, some, axis=0) == 7).all())
        parts = plane.deform(embedding, Qs[0], vertices=some)
        self.assertTrue(np.array_equal(parts[some], made[0, some]))
        self.assertEqual(np.delete(parts, some, axis=0).tobytes(), np.delete(POINTS, some, axis=0).tobytes())
        both = POINTS.copy()
        self.assertEqual(plane.deform(embedding, Qs[0], points=both, out=both).tobytes(), made[0].tobytes())
        self.assertEqual(plane.deform(plane.embed(POINTS.astype(np.float32)), Qs[0]).dtype, np.float32)
        changed = embedding.affected([[2, 1]])
        Q = plane.rest.copy()
        Q[2, 1] += 0.1
        self.assertTrue(set(np.flatnonzero((np.nan_to_num(plane.deform(embedding, Q)) != np.nan_to_num(POINTS)).any(axis=1))) <= set(changed))
        mask = np.zeros((6, 4), bool)
        mask[2, 1] = True
        self.assertTrue(np.array_equal(embedding.affected(mask), changed) and 0 < len(changed) < 3000)

    def test_without_scipy_a_csr(self):
        from unittest import mock
        plane = PLANES["mixed"]
        embedding = plane.embed(POINTS)
        wanted = plane.basis(embedding)
        with mock.patch.dict("sys.modules", {"scipy.sparse": None}):
            found = plane.basis(embedding)
        self.assertIsInstance(found, ffd.Csr)
        self.assertTrue(all(np.array_equal(getattr(found, name), getattr(wanted, name)) for name in ("data", "indices", "indptr")))


class Lattices(unittest.TestCase):
    def test_shapes(self):
        plane = PLANES["listed"]
        self.assertEqual((plane.size, plane.degree, plane.rest.shape, plane.domain.shape), ((5, 4), (2, 3), (5, 4, 2), (2, 2)))
        self.assertEqual((len(plane.knots), plane.weights, plane.rest_weights, plane.offsets.shape), (2, None, None, (5, 4, 2)))
        self.assertEqual(ffd.Lattice.plane((0, 0), (1, 1)).size, (4, 4))
        self.assertEqual(ffd.Lattice.plane((0, 0), (1, 1), 2).degree, (1, 1))
        weighted = plane.moved(weights=np.full((5, 4), 2.0))
        self.assertEqual((weighted.weights.shape, weighted.moved().weights[1, 1]), ((5, 4), 2))
        self.assertIs(plane.moved(), plane)

    def test_it_does_what_its_solid_does(self):
        plane = PLANES["cubic"].moved(pushed(PLANES["cubic"]))
        other = PLANES["cubic"].moved(pushed(PLANES["cubic"]))
        turn = np.array([[0.0, -2.0, 3.0], [2.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
        for made, wanted in ((plane.refine((8, 6), (3, 4), insert={"u": [0.3]}), plane.solid.refine((8, 6, 2), (3, 4, 1), insert={"u": [0.3]})),
                             (plane.refine(8), plane.solid.refine((8, 8, 2))), (plane.strength(0.3), plane.solid.strength(0.3)),
                             (plane.blend(other, 0.2), plane.solid.blend(other.solid, 0.2)), (plane.add(other), plane.solid.add(other.solid)),
                             (plane.mirror("v"), plane.solid.mirror("v")), (plane.mirrored("y", 0.4), plane.solid.mirrored("y", 0.4)),
                             (plane.symmetrize("u-"), plane.solid.symmetrize("u-")), (plane.seal("C1"), plane.solid.seal("C1", "u-,u+,v-,v+")),
                             (plane.seal("C0", "u-,v+"), plane.solid.seal("C0", ["u-", "v+"])),
                             (plane.strength(0.1).invert(threads=1), plane.solid.strength(0.1).invert(threads=1))):
            self.assertIsInstance(made, ffd.PlaneLattice)
            self.assertEqual(made.text, wanted.text)
            # Both layers move alike, so that it is a plane again.
            self.assertEqual(ffd.PlaneLattice.of(wanted).rest.tobytes(), made.rest.tobytes())
        turned = plane.transform(turn)
        self.assertLess(np.abs(turned.deformed - (plane.deformed @ turn[:2, :2].T + turn[:2, 2])).max(), 1e-14)
        points = POINTS[8:] @ turn[:2, :2].T + turn[:2, 2]
        wanted = plane.deform(plane.embed(POINTS[8:])) @ turn[:2, :2].T + turn[:2, 2]
        self.assertLess(np.abs(turned.deform(turned.embed(points)) - wanted).max(), 1e-13)
        noisy = plane.jitter((0.1, 0), 5)
        self.assertTrue(np.array_equal(noisy.offsets[..., 1], plane.offsets[..., 1]))
        self.assertEqual(noisy.offsets[..., 0].tobytes(), plane.solid.jitter((0.1, 0, 0), 5).offsets[:, :, 0, 0].tobytes())

    def test_closed_directions(self):
        angle = np.arange(6) * np.pi / 3
        ring = np.stack([np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1) for r in (1.0, 1.5, 2.0)], axis=1)
        rest = np.zeros((6, 3, 2, 3))
        rest[..., :2], rest[..., 2] = ring[:, :, None], (-1.0, 1.0)
        plane = ffd.PlaneLattice.of(ffd.Lattice.from_points(rest, (3, 2, 1), knots=("closed", "clamped", "clamped")))
        moved = plane.moved(plane.rest * 1.1)
        points = 1.2 * np.column_stack([np.cos(np.linspace(0, 6, 40)), np.sin(np.linspace(0, 6, 40))])
        found = moved.deform(moved.embed(points))
        self.assertLess(np.abs(found - 1.1 * points).max(), 1e-12)
        sealed = moved.seal("C0")
        self.assertEqual(np.count_nonzero(sealed.offsets[:, [0, -1]]), 0)

    def test_files_are_those_of_a_doubled_layer(self):
        plane = PLANES["mixed"].moved(pushed(PLANES["mixed"]))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "plane.json")
            plane.save(path)
            loaded = ffd.Lattice.load(path)
            self.assertEqual((loaded.size, plane.text), ((4, 5, 2), loaded.text))
            again = ffd.PlaneLattice.of(loaded)
            self.assertEqual(again.deform(again.embed(POINTS)).tobytes(), plane.deform(plane.embed(POINTS)).tobytes())
            mesh = os.path.join(folder, "in.ply")
            with open(mesh, "wb") as file:
                file.write(support.ply(np.column_stack([POINTS[8:], np.zeros(2992)])))
            positions, result = ffd.positions_file(mesh, plane)
            self.assertTrue(np.array_equal(positions[:, :2], plane.deform(plane.embed(POINTS[8:]))) and result.moved > 1000)

    def test_pickles_stay_planes(self):
        plane = curved()
        embedding = plane.embed(POINTS, outside="extend")
        for one in (pickle.loads(pickle.dumps(embedding)),):
            self.assertIsInstance(one, ffd.PlaneEmbedding)
            self.assertEqual((one.uvw.tobytes(), one.status.tobytes()), (embedding.uvw.tobytes(), embedding.status.tobytes()))
            self.assertEqual(one.lattice.deform(one).tobytes(), plane.deform(embedding).tobytes())
        again = pickle.loads(pickle.dumps(plane))
        self.assertIsInstance(again, ffd.PlaneLattice)
        self.assertEqual((again.rest.tobytes(), again.offsets.tobytes()), (plane.rest.tobytes(), plane.offsets.tobytes()))
        self.assertEqual(repr(plane), "<PlaneLattice 6x4, degree 3, 3>")
        self.assertRegex(repr(embedding), "^<PlaneEmbedding of 3000 points: ")

    def test_a_great_and_a_small_plane(self):
        for size in (1e-9, 1e12):
            plane = ffd.Lattice.plane((0, 0), (size, 2 * size), 5)
            points = RANDOM.uniform(0, size, (50, 2))
            found = plane.deform(plane.embed(points, outside="error"), 1.5 * plane.rest)
            self.assertLess(np.abs(found - 1.5 * points).max(), 1e-15 * 10 * size)

    def refused(self, kind, words, function, *arguments, **more):
        with self.assertRaisesRegex(kind, words):
            function(*arguments, **more)

    def test_refusals(self):
        plane, solid = PLANES["cubic"], ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        embedding = plane.embed(POINTS)
        self.refused(TypeError, "use Lattice.plane", ffd.PlaneLattice)
        self.refused(TypeError, "use PlaneLattice.embed", ffd.PlaneEmbedding)
        self.refused(ValueError, r"low must have the shape \(2,\)", ffd.Lattice.plane, (0, 0, 0), (1, 1))
        self.refused(ValueError, "size must be one value, or two, not 3", ffd.Lattice.plane, (0, 0), (1, 1), (3, 3, 3))
        self.refused(ValueError, "degree must be one value, or two", ffd.Lattice.plane, (0, 0), (1, 1), 4, (1, 1, 1))
        self.refused(ValueError, "size must be 2 to .*, not 1", ffd.Lattice.plane, (0, 0), (1, 1), (1, 4))
        for make in (lambda: ffd.Lattice.box((0, 0, 0), (1, 1, 1), (5, 5, 1)), lambda: ffd.Lattice.around(np.zeros((3, 3)), (5, 5, 1))):
            self.refused(ValueError, "size 1 along w is less than 2: Lattice.plane makes a lattice of a plane", make)
        for low, high in (((0, 0), (0, 1)), ((0, 0), (np.nan, 1)), ((1, 1), (0, 0)), ((0, 0), (np.inf, 1))):
            self.refused(ffd.Error, "", ffd.Lattice.plane, low, high)
        self.refused(ValueError, r"points must have the shape \(N, 2\), not \(3000, 3\)", plane.embed, np.zeros((3000, 3)))
        self.refused(ValueError, "Q must have the shape", plane.deform, embedding, plane.solid.rest)
        self.refused(ValueError, r"Q must have the shape \(6, 4, 2\)", plane.deform, embedding, plane.rest[1:])
        self.refused(ValueError, r"offsets must have the shape", plane.deform, embedding, offsets=np.zeros((6, 4, 3)))
        self.refused(ValueError, r"D must have the shape \(6, 4, 2\)", plane.basis_times, embedding, np.zeros((2, 6, 4, 2)))
        self.refused(ValueError, r"dfdx must have the shape \(3000, 2\)", plane.basis_transposed, embedding, np.zeros((3000, 3)))
        self.refused(ValueError, r"out must have the shape \(N, 2\)", plane.deform, embedding, out=np.zeros((3000, 3)))
        self.refused(ValueError, r"normals must have the shape \(N, 2\)", plane.deform, embedding, normals=np.zeros((3000, 3)))
        self.refused(ValueError, r"uvw must have the shape \(N, 2\)", plane.evaluate, [[0, 0, 0]])
        self.refused(ValueError, "for one Q", plane.deform, embedding, plane.rest[None], gradients=True)
        self.refused(ValueError, "not both", plane.deform, embedding, plane.rest, offsets=plane.rest)
        self.refused(TypeError, "what PlaneLattice.embed returns, not Embedding", plane.deform, solid.embed([[0, 0, 0]]))
        self.refused(TypeError, "what embed returns, not PlaneEmbedding", solid.deform, embedding)
        self.refused(ffd.InvalidError, "another lattice", PLANES["open"].deform, embedding)
        self.refused(TypeError, "other must be a PlaneLattice, not Lattice", plane.add, solid)
        self.refused(ValueError, "a direction of a plane is u or v, not 'w'", plane.mirror, "w")
        self.refused(ValueError, "axis must be 'x' or 'y' in a plane, not 'z'", plane.mirrored, "z")
        self.refused(ValueError, "u-, v.* in a plane, not 'w.'", plane.symmetrize, "w+")
        self.refused(ValueError, "a side of a plane", plane.seal, "C1", ["w-"])
        self.refused(ValueError, "insert is u or v, not 'w'", plane.refine, insert={"w": [0.5]})
        self.refused(ValueError, r"matrix must have the shape \(3, 3\)", plane.transform, np.eye(4))
        self.refused(ValueError, "last row", plane.transform, np.ones((3, 3)))
        self.refused(AttributeError, "a lattice of a plane has no parameters_jacobian: its 3-D lattice, `solid`, has", getattr, plane, "parameters_jacobian")
        self.refused(AttributeError, "no attribute 'nonsense'", getattr, plane, "nonsense")
        self.refused(ValueError, "control_points must be integers", embedding.affected, [[0, 0, 0]])
        self.refused(ValueError, "control_points must be below", embedding.affected, [[6, 0]])
        for other in (solid, ffd.Lattice.box((0, 0, -1), (1, 1, 1), (3, 3, 2), (2, 2, 1)).mirrored("z", 1),
                      plane.solid.moved(plane.solid.rest + (0, 0, 1)), plane.solid.moved(plane.solid.rest * np.array([[[[1], [2]]]]))):
            self.refused(ValueError, "a plane needs two layers along w", ffd.PlaneLattice.of, other)
        self.refused(TypeError, "of a Lattice, not of str", ffd.PlaneLattice.of, "a.json")
        self.refused(ffd.EmbeddingError, "is outside", plane.embed, POINTS[8:], outside="error")
        self.refused(ffd.Cancelled, "", plane.embed, POINTS, progress=lambda done: False)


if __name__ == "__main__":
    unittest.main()
