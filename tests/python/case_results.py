"""Results are those of the program, to the bit, and those that others compute."""

import glob
import os
import pickle
import unittest

import ffd_mesh as ffd
import numpy as np
import support


class Bits(unittest.TestCase):
    def test_control_points_that_were_set_do_what_a_file_of_them_does(self):
        random = support.rng("bits")
        for dtype in (np.float32, np.float64):
            for weights in (False, True):
                lattice = support.curved(random, weights=weights)
                Q = support.pushed(random, lattice)
                points = random.uniform(-0.2, 1.2, (300, 3)).astype(dtype)
                for outside in ("keep", "extend"):
                    embedding = lattice.embed(points, outside=outside)
                    found = lattice.deform(embedding, Q)
                    wanted = support.deformed_by_program(points, lattice.moved(Q), "--outside", outside)
                    self.assertEqual(found.tobytes(), wanted.tobytes(), (dtype, weights, outside))
                    self.assertTrue(np.array_equal(lattice.deform(embedding), points))

    def test_files_with_moves_and_normals(self):
        random = support.rng("files")
        points = random.uniform(-1, 1, (400, 3)).astype(np.float32)
        normals = random.standard_normal((400, 3)).astype(np.float32)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        for path in sorted(glob.glob(os.path.join(support.DATA, "lattices", "*.json"))):
            if ffd.parameters(path):
                continue
            lattice = ffd.Lattice.load(path).fit(points)
            found = lattice.deform(lattice.embed(points), normals=normals)
            wanted = support.deformed_by_program(points, lattice, normals=normals)
            self.assertEqual(found.points.tobytes(), np.ascontiguousarray(wanted[:, :3]).tobytes(), path)
            self.assertEqual(found.normals.tobytes(), np.ascontiguousarray(wanted[:, 3:]).tobytes(), path)

    def test_a_lattice_round_points_is_that_of_lattice_new(self):
        points = support.rng("around").uniform(-1, 2, (50, 3))
        with open("cloud.ply", "wb") as file:
            file.write(support.ply(points))
        support.program("lattice", "new", "cloud.ply", "-o", "new.json", "--force", "--size", "5,4,3", "--degree", "3,2,1", "--margin", "0.1")
        theirs = ffd.Lattice.load("new.json").fit(points)
        ours = ffd.Lattice.around(points, size=(5, 4, 3), degree=(3, 2, 1), margin=0.1)
        self.assertTrue(np.array_equal(ours.rest, theirs.rest))
        self.assertEqual([list(k) for k in ours.knots], [list(k) for k in theirs.knots])

    def test_a_box_with_even_spacing_is_that_of_a_file(self):
        for knots, axes in (("default", None), (("clamped", "default", "clamped"), np.eye(3)[[1, 2, 0]]), (["clamped", [0, 0, 0, 0, 1, 1, 1, 1], "clamped"], None)):
            box = {"min": [0, 0.1, 0], "max": [1, 2, 1 / 3], "spacing": "uniform"} | ({} if axes is None else {"axes": axes.tolist()})
            wanted = ffd.Lattice.parse({"format": "ffd-lattice", "version": 1, "size": [8, 4, 4], "rest": {"box": box},
                                        "knots": ["clamped" if knots == "default" or kind == "default" else kind for kind in (list(knots) if knots != "default" else [knots] * 3)]})
            found = ffd.Lattice.box((0, 0.1, 0), (1, 2, 1 / 3), (8, 4, 4), knots=knots, axes=axes, spacing="uniform")
            self.assertEqual((found.rest.tobytes(), found.degree), (wanted.rest.tobytes(), (3, 3, 3)))
            self.assertEqual([list(k) for k in found.knots], [list(k) for k in wanted.knots])
        self.assertEqual(ffd.Lattice.box((0, 0, 0), (1, 1, 1), (3, 4, 5), 2, spacing="uniform").degree, (2, 2, 2))
        for bad in ({"spacing": "even"}, {"spacing": "uniform", "size": (3, 3)}, {"spacing": "uniform", "knots": "bent"}, {"spacing": "uniform", "knots": "open"}, {"spacing": "uniform", "degree": 9}):
            with self.assertRaises(ValueError):
                ffd.Lattice.box((0, 0, 0), (1, 1, 1), **bad)

    def test_text_and_pickles_keep_every_bit(self):
        random = support.rng("text")
        lattice = support.curved(random, weights=True)
        lattice = lattice.moved(support.pushed(random, lattice), weights=random.uniform(0.5, 2, lattice.size))
        points = random.uniform(-0.1, 1.1, (100, 3))
        embedding = lattice.embed(points, outside="extend", falloff=0.5)
        found = lattice.deform(embedding)
        for again in (ffd.Lattice.parse(lattice.text), pickle.loads(pickle.dumps(lattice))):
            for name in ("rest", "offsets", "deformed", "rest_weights", "weights"):
                self.assertTrue(np.array_equal(getattr(again, name), getattr(lattice, name)), name)
            self.assertEqual(again.deform(embedding).tobytes(), found.tobytes())
        other = pickle.loads(pickle.dumps(embedding))
        self.assertEqual(other.uvw.tobytes(), embedding.uvw.tobytes())
        self.assertEqual(other.lattice.deform(other).tobytes(), found.tobytes())
        fitted = ffd.Lattice.load(os.path.join(support.DATA, "lattices", "twist.json")).fit(points)
        for one in (fitted, fitted.moved(fitted.deformed + 0.1)):
            again = pickle.loads(pickle.dumps(one))
            self.assertTrue(np.array_equal(again.rest, one.rest) and np.array_equal(again.offsets, one.offsets))
        content = {"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "rest": {"box": "mesh"},
                   "parameters": {"A": {"default": 10, "min": 0}}, "moves": [{"twist": {"axis": "z", "degrees": {"$": "A"}}}]}
        asked = ffd.Lattice.parse(content)
        self.assertEqual(asked.parameters["A"], ffd.Parameter("A", 10, None, None, 0.0, None))
        for one in (asked, asked.fit(points), asked.fit(points).moved(offsets=0 * asked.fit(points).rest), asked.fit(points).embed(points)):
            again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(one))))
            self.assertEqual(getattr(again, "lattice", again).parameters, asked.parameters)
        with self.assertRaises(ffd.InvalidError):
            ffd.Embedding.from_bytes(embedding.to_bytes()[:-1], lattice, points)

    def test_threads_and_instruction_sets_change_nothing(self):
        random = support.rng("threads")
        lattice = support.curved(random)
        points = random.uniform(-0.1, 1.1, (9000, 3)).astype(np.float32)
        Q = support.pushed(random, lattice)
        wanted = lattice.deform(lattice.embed(points, threads=1, isa="scalar"), Q, threads=1, isa="scalar").tobytes()
        self.assertEqual(lattice.deform(lattice.embed(points, threads=5), Q, threads=7).tobytes(), wanted)


class Calculus(unittest.TestCase):
    def test_the_basis_is_the_derivative_by_the_control_points(self):
        random = support.rng("derivative")
        for weights in (False, True):
            lattice = support.curved(random, size=(4, 3, 5), weights=weights)
            Q = support.pushed(random, lattice)
            embedding = lattice.embed(random.uniform(-0.2, 1.2, (60, 3)), outside="extend", falloff=0.4)
            B = lattice.basis(embedding)
            self.assertEqual(B.shape, (60, 60))
            self.assertTrue(B.has_canonical_format)
            for i, j, k in ((0, 0, 0), (3, 1, 2), (1, 2, 4)):
                step = np.zeros(lattice.rest.shape)
                step[i, j, k, 2] = 1e-5
                slope = (lattice.deform(embedding, Q + step) - lattice.deform(embedding, Q - step)) / 2e-5
                column = B[:, [(i * 3 + j) * 5 + k]].toarray().ravel()
                self.assertLess(np.abs(slope[:, 2] - column).max(), 1e-6)
            D, dfdx = random.standard_normal(lattice.rest.shape), random.standard_normal((60, 3))
            self.assertLess(np.abs(B @ D.reshape(-1, 3) - lattice.basis_times(embedding, D)).max(), 1e-12)
            self.assertLess(np.abs((B.T @ dfdx).reshape(D.shape) - lattice.basis_transposed(embedding, dfdx)).max(), 1e-12)
            moved = np.abs(lattice.deform(embedding, offsets=D) - lattice.basis_times(embedding, D) - embedding.points).max()
            self.assertLess(moved, 1e-12)

    def test_only_what_is_affected_moves(self):
        random = support.rng("affected")
        lattice = support.curved(random, size=(7, 6, 5), degree=2)
        embedding = lattice.embed(random.uniform(-0.1, 1.1, (500, 3)))
        Q = lattice.rest.copy()
        Q[2, 3, 1] += 0.05
        out = lattice.deform(embedding, Q)
        moved = np.flatnonzero((out != embedding.points).any(axis=1))
        affected = embedding.affected([[2, 3, 1]])
        self.assertTrue(set(moved) <= set(affected) and len(affected) < 500)
        mask = np.zeros(lattice.size, bool)
        mask[2, 3, 1] = True
        self.assertTrue(np.array_equal(embedding.affected(mask), affected))
        self.assertTrue(np.array_equal(lattice.deform(embedding, Q, vertices=affected), out))

    def test_gradients_are_those_of_the_displacement(self):
        random = support.rng("gradients")
        lattice = support.curved(random)
        Q, points = support.pushed(random, lattice), random.uniform(0.2, 0.8, (40, 3))
        found = lattice.deform(lattice.embed(points), Q, gradients=True).gradients
        for c in range(3):
            step = 1e-6 * np.eye(3)[c]
            ahead, behind = points + step, points - step
            slope = (lattice.deform(lattice.embed(ahead), Q) - ahead - lattice.deform(lattice.embed(behind), Q) + behind) / 2e-6
            self.assertLess(np.abs(slope - found[:, :, c]).max(), 1e-6)

    def test_evaluation_is_that_of_geomdl(self):
        from geomdl import NURBS
        random = support.rng("geomdl")
        lattice = support.curved(random, size=(4, 5, 3), degree=2, weights=True)
        volume = NURBS.Volume()
        volume.degree = lattice.degree
        # Theirs has v fastest, then u, then w.
        weights, points = (np.ascontiguousarray(a.transpose(2, 0, 1, *range(3, a.ndim))) for a in (lattice.rest_weights, lattice.rest))
        weighted = np.concatenate([points * weights[..., None], weights[..., None]], axis=-1).reshape(-1, 4)
        volume.set_ctrlpts(weighted.tolist(), *lattice.size)
        volume.knotvector = [list(knots) for knots in lattice.knots]
        uvw = random.uniform(0, 1, (20, 3))
        theirs = np.array(volume.evaluate_list(uvw.tolist()))
        self.assertLess(np.abs(lattice.evaluate(uvw, volume="rest") - theirs).max(), 1e-12)

    def test_evaluation_undoes_embedding(self):
        random = support.rng("evaluate")
        lattice = support.curved(random, weights=True)
        points = random.uniform(0.2, 0.8, (50, 3))
        embedding = lattice.embed(points)
        found, jacobians = lattice.evaluate(embedding.uvw, volume="rest", jacobians=True)
        self.assertLess(np.abs(found - points).max(), 1e-13)
        self.assertTrue((np.linalg.det(jacobians) > 0).all())

    def test_the_barrier_goes_down_along_its_gradient(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 2, 3), size=(4, 5, 6))
        least, value, _ = lattice.fold_barrier()
        self.assertAlmostEqual(least, 1, places=12)
        self.assertEqual(value, 0)
        Q = lattice.rest.copy()
        Q[1, :, :, 0] += 1.5
        self.assertEqual(lattice.folds(Q).verdict, "some")
        start = lattice.fold_barrier(Q)
        step = 1e-7
        moved = lattice.fold_barrier(Q - step * start.gradient)
        self.assertLess(start.least, 0)
        self.assertAlmostEqual((start.value - moved.value) / (step * np.sum(start.gradient**2)), 1, places=4)
        # Only the cell of the point counts.
        some = lattice.fold_barrier(Q, embedding=lattice.embed(np.array([[0.1, 0.1, 0.1]])))
        self.assertTrue(0 < some.value < start.value)
        self.assertEqual(np.count_nonzero(some.gradient[:, 4]), 0)
        with self.assertRaises(ffd.UnsupportedError):
            lattice.moved(weights=np.full((4, 5, 6), 2.0)).fold_barrier()
        with self.assertRaises(ValueError):
            lattice.fold_barrier(Q[1:])

    def test_folds_are_found_and_excluded(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=4)
        folds = lattice.folds()
        self.assertEqual((folds.verdict, folds.min_det, folds.relative_to), ("none", 1, "place"))
        Q = lattice.rest.copy()
        Q[1, :, :, 0] += 2
        folds = lattice.folds(Q)
        self.assertEqual((folds.verdict, folds.relative_to), ("some", "mean"))
        jacobian = lattice.moved(Q).evaluate(folds.witness_uvw[None], jacobians=True)[1][0]
        self.assertLess(np.linalg.det(jacobian), 0)
