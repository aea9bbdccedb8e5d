"""Lattices made of lattices: the methods of Lattice give the bytes of ffd lattice set and ffd lattice refine."""

import json
import os
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("author")
TURN = np.array([[0.0, -2.0, 0.0, 3.0], [2.0, 0.0, 0.0, -1.0], [0.0, 0.0, 2.0, 0.5], [0.0, 0.0, 0.0, 1.0]])


class Author(unittest.TestCase):
    def lattice(self):
        lattice = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=(4, 5, 4))
        return lattice.moved(offsets=RANDOM.uniform(-0.1, 0.1, (4, 5, 4, 3)))

    def test_the_bytes_of_the_program(self):
        first, second = self.lattice(), self.lattice()
        matrix = ",".join(repr(float(x)) for x in TURN.ravel())
        with tempfile.TemporaryDirectory() as folder:
            a, b, out = (os.path.join(folder, name) for name in ("a.json", "b.json", "o.json"))
            first.save(a)
            second.save(b)
            for words, made in ((["set", "--strength", "0.3"], first.strength(0.3)), (["set", "--blend", f"{b},0.25"], first.blend(second, 0.25)),
                                (["set", "--add", b], first.add(second)), (["set", "--mirror", "v"], first.mirror("v")),
                                (["set", "--symmetrize", "v-"], first.symmetrize("v-")), (["set", "--symmetrize", "u+"], first.symmetrize("u+")),
                                (["set", "--seam", "C1:u-,w+"], first.seal("C1", ["u-", "w+"])), (["set", "--seam", "C0:all"], first.seal("C0")),
                                (["set", "--transform", matrix], first.transform(TURN)), (["set", "--invert"], first.invert(threads=1)),
                                (["refine", "--size", "6", "--insert", "u:0.3"], first.refine(6, insert={"u": [0.3]}))):
                support.program("lattice", *words, a, "-o", out, "--force")
                with open(out, encoding="utf-8") as file:
                    self.assertEqual(file.read(), made.text, words)

    def test_right_answers(self):
        """Those of reference cases, one of each kind."""
        def case(name):
            with open(os.path.join(support.SOURCE, "tests", "cli", "authoring", name + ".json"), encoding="utf-8") as file:
                return json.load(file)

        def lattice(source):
            return ffd.Lattice.parse(json.dumps(source))

        def near(found, expected, tolerance):
            # u is the fastest in files, and the first axis of arrays.
            found = np.asarray(found)
            rows = found.transpose(2, 1, 0, 3).reshape(-1, 3) if found.ndim == 4 else found.transpose(2, 1, 0).reshape(-1)
            self.assertLessEqual(np.abs(rows - np.array(expected)).max(), tolerance)

        of = case("refine-elevate-clamped")
        made, expect = lattice(of["lattice"]).refine(degree=(4, 4, 3)), of["expect"]
        near(made.rest, expect["rest_points"], float(expect["tolerance"]))
        near(made.deformed, expect["deformed_points"], float(expect["tolerance"]))
        of = case("set-blend-weights")
        made, expect = lattice(of["lattice"]).blend(lattice(of["other"]), 0.25), of["expect"]
        near(made.offsets, expect["offsets"], float(expect["tolerance"]))
        near(made.weights, expect["deformed_weights"], float(expect["tolerance"]))
        of = case("seam-clamped-C1")
        near(lattice(of["lattice"]).seal("C1", ["u-"]).deformed, of["expect"]["deformed_points_clamped"], float(of["expect"]["tolerance"]))
        of = case("jitter-all")
        near(lattice(of["lattice"]).offsets, of["expect"]["offsets"], 0)

    def test_tables_and_arrays(self):
        first = self.lattice()
        with tempfile.TemporaryDirectory() as folder:
            a, b, c, table, array = (os.path.join(folder, name) for name in ("a.json", "b.json", "c.json", "t.csv", "p.npy"))
            first.save(a)
            first.save(table)
            support.program("lattice", "convert", a, "-o", b.replace("b.json", "b.csv"))
            with open(table, "rb") as own, open(b.replace("b.json", "b.csv"), "rb") as programs:
                self.assertEqual(own.read(), programs.read())
            self.assertEqual(ffd.convert_lattice(table, c), [])
            for loaded in (ffd.Lattice.load(table), ffd.Lattice.load(c)):
                self.assertTrue((loaded.offsets == first.offsets).all() and (loaded.rest == first.rest).all())
            first.save(array, part="deformed")
            self.assertTrue((np.load(array) == first.deformed).all())
            self.assertTrue((ffd.Lattice.load(array).rest == first.deformed).all())
            np.save(array, np.asfortranarray(first.rest))
            self.assertTrue((ffd.Lattice.load(array, degree=2).rest == first.rest).all())
            np.save(array, first.rest.transpose(2, 1, 0, 3).reshape(-1, 3).astype(">f8"))
            self.assertTrue((ffd.Lattice.load(array, size=(4, 5, 4)).rest == first.rest).all())
            # Backwards along u, and with w as the fastest direction: the points tell the order.
            np.save(array, np.asarray(first.rest)[::-1])
            self.assertTrue((ffd.Lattice.load(array, order="auto").rest == first.rest).all())
            self.assertEqual(ffd.convert_lattice(array, c, order="auto", force=True), [f"{array}: 4 x 5 x 4 control points along u, v, w"])
            first.refine(degree=4).save(b, part="rest")
            with self.assertLogs("ffd_mesh", "WARNING") as said:
                self.assertEqual(len(ffd.convert_lattice(b, array, force=True)), 1)
            self.assertIn("not the knots of u, knots of v, knots of w", said.output[0])
            for call, error in ((lambda: first.save(array), ffd.ExistsError), (lambda: first.save(array, force=True), ffd.ArgumentError),
                                (lambda: ffd.Lattice.load(array, size=3), ffd.ArgumentError), (lambda: ffd.Lattice.load(a, size=3), ValueError),
                                (lambda: ffd.Lattice.load(array, size=(4, None, 4)), ffd.ArgumentError),
                                (lambda: ffd.convert_lattice(a, "x.txt"), ffd.ArgumentError), (lambda: first.save(b, part="all"), ValueError),
                                (lambda: ffd.Lattice.load(table, {"A": 1}), ffd.ArgumentError)):
                with self.assertRaises(error):
                    call()

    def test_noise_is_that_of_the_move(self):
        text = ('{"format": "ffd-lattice", "version": 1, "size": [4, 5, 4], "rest": {"box": {"min": [-1, -1, -1], "max": [1, 1, 1]}}, '
                '"moves": [{"jitter": {"sigma": [0.1, 0, 0.3], "seed": 12345678901}}]}')
        moved = ffd.Lattice.parse(text)
        still = ffd.Lattice.box((-1, -1, -1), (1, 1, 1), size=(4, 5, 4))
        self.assertTrue((still.jitter([0.1, 0, 0.3], 12345678901).offsets == moved.offsets).all())
        self.assertTrue((still.jitter(0.1, 7).offsets == 0.1 * still.jitter(1, 7).offsets).all())
        self.assertIn('"jitter"', moved.text)
        self.assertTrue((ffd.Lattice.parse(moved.text).offsets == moved.offsets).all())
        for sigma, seed in ((-1, 1), ([1, 1], 1), (1, -1), (1, 2**53)):
            with self.assertRaises(ValueError):
                still.jitter(sigma, seed)

    def test_wrong_values(self):
        lattice = self.lattice()
        for call in (lambda: lattice.mirror("x"), lambda: lattice.symmetrize("u"), lambda: lattice.symmetrize("x+"),
                     lambda: lattice.seal("C"), lambda: lattice.seal("C1", "x+"), lambda: lattice.seal("C1", []), lambda: lattice.seal("C3"),
                     lambda: lattice.transform(np.eye(3)), lambda: lattice.strength(float("nan"))):
            with self.assertRaises((ValueError, ffd.ArgumentError)):
                call()
        for call in (lambda: lattice.transform(np.zeros((4, 4)) + np.diag([0, 0, 0, 1.0])), lambda: lattice.add(ffd.Lattice.box((0, 0, 0), (1, 1, 1))),
                     lambda: lattice.moved(offsets=RANDOM.uniform(-9, 9, (4, 5, 4, 3))).invert()):
            with self.assertRaises(ffd.InvalidError):
                call()


if __name__ == "__main__":
    unittest.main()
