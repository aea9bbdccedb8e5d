"""Derivatives by the placeholders of a lattice file and by weights, and lattices that are reflected in a plane."""

import json
import os
import pickle
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("derivatives")
BEND = {
    "format": "ffd-lattice", "version": 1, "size": [3, 3, 5], "degree": [2, 2, 2],
    "knots": ["clamped", "clamped", [0, 0, 0, 1, 1, 2, 2, 2]],
    "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
    "parameters": {"S": {"default": [0.1, 0, -0.1]}, "A": {"default": 30}, "B": {"default": 1}},
    "moves": [{"bend": {"axis": "z", "toward": "x", "degrees": {"$": "A"}, "exact": True}},
              {"by": {"$": "S"}, "at": ["all", "all", -1]}, {"twist": {"axis": "z", "degrees": {"$": "B", "times": 5}}}],
}
# Round the mesh, and with keys that give one of the two values.
KEYED = {
    "format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh"},
    "parameters": {"A": {"default": 10}, "T": {"default": 0.2}},
    "moves": [{"twist": {"axis": "y", "degrees": {"$": "A"}}}, {"taper": {"axis": "y", "factor": {"$": "T"}}}],
    "keys": [{"time": 0, "set": {"A": 0}}, {"time": 2, "set": {"A": 90}}],
}


def by_program(points, lattice, *options):
    """The matrix and the columns' names of ffd jacobian for a lattice file in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, name) for name in ("in.ply", "J.npy", "lattice.json")]
        with open(names[0], "wb") as file:
            file.write(support.ply(points))
        with open(names[2], "w", encoding="utf-8") as file:
            file.write(json.dumps(lattice))
        support.program("jacobian", names[0], "-l", names[2], "-o", names[1], "--wrt", "parameters", *options)
        with open(os.path.join(folder, "J.columns.txt"), encoding="utf-8") as file:
            return np.load(names[1]), tuple(file.read().split())


class Parameters(unittest.TestCase):
    def test_values_are_those_of_the_call(self):
        """Later changes of the list or array that was given change nothing."""
        move = {"scale": {"factor": {"$": "S"}}}
        text = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
                "parameters": {"S": {"default": [1, 1, 1]}}, "moves": [move, move]}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "l.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(text, file)
            for given in ([1.1, 1, 1], np.array([1.1, 1, 1])):
                lattice = ffd.Lattice.load(path, {"S": given})
                embedding = lattice.embed(np.full((1, 3), 0.3))
                before = lattice.parameters_jacobian(embedding)
                given[0] = 3
                self.assertTrue(np.array_equal(lattice.parameters_jacobian(embedding), before))

    def test_the_matrix_is_that_of_the_program(self):
        for kind in (np.float32, np.float64):
            points = RANDOM.uniform(-0.2, 1.2, (300, 3)).astype(kind)
            for content, values, time, options in (
                    (BEND, None, None, ()), (BEND, {"A": 45, "S": [0, 0.2, 0]}, None, ("--set", "A=45", "--set", "S=[0,0.2,0]")),
                    (KEYED, {"T": 0.7}, None, ("--set", "T=0.7")), (KEYED, None, 1.5, ("--time", "1.5"))):
                lattice = ffd.Lattice.parse(content).fit(points)
                lattice = lattice if time is None else lattice.at(time)
                for outside in (["keep"], ["extend", "--falloff", "0.3"]):
                    embedding = lattice.embed(points, outside=outside[0], falloff=float((outside + [0, 0])[2]))
                    found = lattice.parameters_jacobian(embedding, values)
                    wanted, names = by_program(points, content, *options, "--outside", *outside)
                    self.assertTrue(np.array_equal(found, wanted), (kind, options, outside))
                    self.assertEqual(lattice.parameter_columns, names)
                    self.assertTrue((np.abs(found).max(axis=(0, 1)) > 0).all())

    def test_files_with_values_keep_them(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bend.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(json.dumps(BEND))
            lattice = ffd.Lattice.load(path, {"A": 50})
        points = RANDOM.uniform(0, 1, (40, 3))
        embedding = lattice.embed(points)
        wanted, _ = by_program(points, BEND, "--set", "A=50")
        for one in (lattice, pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(lattice))))):
            self.assertTrue(np.array_equal(one.parameters_jacobian(embedding), wanted))
        wanted, _ = by_program(points, BEND, "--set", "A=20")
        self.assertTrue(np.array_equal(lattice.parameters_jacobian(embedding, {"A": 20}), wanted))
        fitted = ffd.Lattice.parse(KEYED).fit(points).at(1)
        again = pickle.loads(pickle.dumps(fitted))
        self.assertTrue(np.array_equal(again.parameters_jacobian(again.embed(points)), fitted.parameters_jacobian(fitted.embed(points))))

    def test_differences(self):
        points = RANDOM.uniform(-0.1, 1.1, (50, 3))
        lattice = ffd.Lattice.parse(BEND)
        embedding = lattice.embed(points, outside="extend")
        found = lattice.parameters_jacobian(embedding, {"A": 40})
        self.assertEqual(found.shape, (50, 3, 5))

        def moved(values):
            content = BEND | {"parameters": {name: {"default": value} for name, value in ({"S": [0.1, 0, -0.1], "A": 40, "B": 1} | values).items()}}
            return ffd.Lattice.parse(content).deform(embedding)

        for column, (name, step) in enumerate((("A", 1e-4), ("S", 1e-6), ("S", 1e-6), ("S", 1e-6), ("B", 1e-4))):
            sides = []
            for way in (1, -1):
                value = np.array([0.1, 0, -0.1]) if name == "S" else {"A": 40.0, "B": 1.0}[name]
                if name == "S":
                    value[column - 1] += way * step
                    value = value.tolist()
                else:
                    value += way * step
                sides.append(moved({name: value}))
            self.assertLess(np.abs((sides[0] - sides[1]) / (2 * step) - found[:, :, column]).max(), 1e-8, name)

    def test_products_are_those_of_the_matrix(self):
        lattice = ffd.Lattice.parse(BEND)
        embedding = lattice.embed(RANDOM.uniform(0, 1, (9000, 3)))
        found = lattice.parameters_jacobian(embedding)
        dp, g = RANDOM.standard_normal(5), RANDOM.standard_normal((9000, 3))
        self.assertLess(np.abs(lattice.parameters_times(embedding, dp) - found @ dp).max(), 1e-12)
        back = lattice.parameters_transposed(embedding, g)
        self.assertLess(np.abs(back - np.einsum("ncm,nc->m", found, g)).max(), 1e-9)
        for more in ({"threads": 1}, {"threads": 5}):
            self.assertEqual(lattice.parameters_transposed(embedding, g, **more).tobytes(), back.tobytes())
            self.assertEqual(lattice.parameters_jacobian(embedding, **more).tobytes(), found.tobytes())
        other = lattice.parameters_times(embedding, dp, {"A": 10})
        self.assertLess(np.abs(other - lattice.parameters_jacobian(embedding, {"A": 10}) @ dp).max(), 1e-12)

    def test_lattices_without_placeholders_have_no_columns(self):
        plain = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        embedding = plain.embed(RANDOM.uniform(0, 1, (7, 3)))
        self.assertEqual(plain.parameters_jacobian(embedding).shape, (7, 3, 0))
        self.assertEqual(plain.parameters_times(embedding, []).tolist(), [[0, 0, 0]] * 7)
        self.assertEqual(plain.parameters_transposed(embedding, np.ones((7, 3))).shape, (0,))
        self.assertEqual(plain.parameter_columns, ())
        text = ffd.Lattice.parse(plain.text)
        self.assertEqual(text.parameters_jacobian(embedding, {}).shape, (7, 3, 0))

    def test_refusals(self):
        lattice = ffd.Lattice.parse(BEND)
        embedding = lattice.embed(RANDOM.uniform(0, 1, (7, 3)))
        edited = lattice.moved(offsets=lattice.offsets)
        for one in (edited, pickle.loads(pickle.dumps(edited))):
            with self.assertRaisesRegex(ffd.InvalidError, "were set"):
                one.parameters_jacobian(embedding)
        for values, kind, words in (({"C": 1}, ValueError, "no placeholder 'C'"), (3, TypeError, "must be a dict"),
                                    ({"A": [1, 2]}, ffd.InvalidError, "degrees"), ({"A": "x"}, ffd.InvalidError, "")):
            with self.assertRaisesRegex(kind, words):
                lattice.parameters_jacobian(embedding, values)
        with self.assertRaisesRegex(ValueError, "no placeholder 'C'"):
            ffd.Lattice.box((0, 0, 0), (1, 1, 1)).parameters_jacobian(ffd.Lattice.box((0, 0, 0), (1, 1, 1)).embed([[0, 0, 0]]), {"C": 1})
        with self.assertRaisesRegex(ValueError, r"dp must have the shape \(5,\)"):
            lattice.parameters_times(embedding, [1])
        with self.assertRaisesRegex(ValueError, "g must have the shape"):
            lattice.parameters_transposed(embedding, [1])
        with self.assertRaisesRegex(ffd.InvalidError, "another lattice"):
            lattice.parameters_jacobian(ffd.Lattice.box((0, 0, 0), (1, 1, 1)).embed([[0, 0, 0]]))
        with self.assertRaisesRegex(TypeError, "what embed returns"):
            lattice.weights_jacobian(None)
        jitter = ffd.Lattice.parse(BEND | {"moves": [{"jitter": {"sigma": 0.1, "seed": {"$": "A"}}}]})
        with self.assertRaisesRegex(ffd.InvalidError, "seed of a jitter"):
            jitter.parameters_jacobian(embedding)
        with self.assertRaises(ffd.Cancelled):
            lattice.parameters_jacobian(embedding, progress=lambda done: False)


class Weights(unittest.TestCase):
    def test_differences(self):
        for weights in (False, True):
            lattice = support.curved(RANDOM, (4, 3, 5), weights=weights)
            lattice = lattice.moved(support.pushed(RANDOM, lattice), weights=RANDOM.uniform(0.5, 2, lattice.size) if weights else None)
            embedding = lattice.embed(RANDOM.uniform(-0.2, 1.2, (40, 3)), outside="extend", falloff=0.5)
            found = lattice.weights_jacobian(embedding)
            self.assertEqual((found.shape, found.dtype), ((40, 3, 60), np.float64))
            own = np.ones(lattice.size) if lattice.weights is None else lattice.weights
            for i, j, k in ((0, 0, 0), (3, 1, 2), (1, 2, 4), (2, 0, 3)):
                step = np.zeros(lattice.size)
                step[i, j, k] = 1e-5
                slope = (lattice.deform(embedding, weights=own + step) - lattice.deform(embedding, weights=own - step)) / 2e-5
                self.assertLess(np.abs(slope - found[:, :, (i * 3 + j) * 5 + k]).max(), 1e-8)
            self.assertGreater(np.abs(found).max(), 0.01)
            dw, g = RANDOM.standard_normal(lattice.size), RANDOM.standard_normal((40, 3))
            ahead = lattice.weights_times(embedding, dw)
            self.assertLess(np.abs(ahead - found @ dw.ravel()).max(), 1e-12)
            self.assertEqual(lattice.weights_times(embedding, dw.ravel()).tobytes(), ahead.tobytes())
            back = lattice.weights_transposed(embedding, g)
            self.assertEqual(back.shape, lattice.size)
            self.assertLess(np.abs(back.ravel() - np.einsum("ncj,nc->j", found, g)).max(), 1e-12)

    def test_refusals(self):
        lattice = support.curved(RANDOM)
        embedding = lattice.embed(RANDOM.uniform(0, 1, (5, 3)))
        with self.assertRaisesRegex(ValueError, "dw must have the shape"):
            lattice.weights_times(embedding, np.ones(3))
        with self.assertRaisesRegex(ffd.InvalidError, "another lattice"):
            support.curved(RANDOM).weights_jacobian(embedding)


class Mirrored(unittest.TestCase):
    def test_reflected_points_go_to_reflected_places(self):
        box = ffd.Lattice.box((0, -0.1, 0.2), (1, 1.3, 1), size=(4, 5, 4))
        for rest in (support.curved(RANDOM, weights=True), box, ffd.Lattice.around(RANDOM.uniform(0, 1, (9, 3)), shape="cylinder")):
            lattice = rest.moved(support.pushed(RANDOM, rest))
            points = RANDOM.uniform(0.3, 0.7, (200, 3))
            for axis, at in (("x", 0.0), ("y", 0.3), ("z", -2.5)):
                made = lattice.mirrored(axis, at)
                column = "xyz".index(axis)

                def reflected(of):
                    of = of.copy()
                    of[..., column] = 2 * at - of[..., column]
                    return of

                self.assertLess(np.abs(made.rest - reflected(lattice.rest)).max(), 4e-15)
                self.assertEqual((made.size, made.degree), (lattice.size, lattice.degree))
                embedding = made.embed(reflected(points))
                self.assertTrue(np.array_equal(embedding.status, lattice.embed(points).status))
                found = made.deform(embedding)
                self.assertLess(np.abs(found - reflected(lattice.deform(lattice.embed(points)))).max(), 1e-13)
                self.assertGreater(np.abs(found - embedding.points).max(), 0.001)
            twice = lattice.mirrored("y").mirrored("y")
            self.assertTrue(np.array_equal(twice.rest, lattice.rest) and np.array_equal(twice.offsets, lattice.offsets))
        self.assertIn('"box"', box.mirrored("x", 0.5).text)

    def test_refusals(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        for axis in ("u", 0, None, "xy"):
            with self.assertRaisesRegex(ValueError, "axis must be 'x', 'y' or 'z'"):
                lattice.mirrored(axis)
        for at in (np.inf, np.nan):
            with self.assertRaises(ffd.ArgumentError):
                lattice.mirrored("x", at)
        with self.assertRaises(ffd.InvalidError):
            ffd.Lattice.parse({"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh"}}).mirrored("x")


if __name__ == "__main__":
    unittest.main()
