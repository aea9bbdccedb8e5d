"""Lattices made of lattices: the methods of Lattice give the bytes of ffd lattice set and ffd lattice refine."""

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
