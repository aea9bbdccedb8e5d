"""Many variants of the control points in one call: (K, N, 3), each with the bits of a call of its own."""

import gc
import os
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("variants")
LATTICE = support.curved(RANDOM, (5, 6, 4))
WEIGHTED = support.curved(RANDOM, weights=True)
POINTS = RANDOM.uniform(-0.1, 1.1, (300, 3))
POINTS[7] = np.nan


def pushed(lattice, count):
    return lattice.rest + RANDOM.normal(scale=0.05, size=(count, *lattice.rest.shape))


class Variants(unittest.TestCase):
    def same(self, lattice, embedding, key, many, **more):
        made = lattice.deform(embedding, **{key: many}, **more)
        more.pop("out", None)
        wanted = [lattice.deform(embedding, **{key: one}, **more) for one in many]
        again = [lattice.moved(**{key: one}).deform(embedding, **more) for one in many]
        self.assertEqual(made.shape, (len(many), len(embedding), 3))
        self.assertEqual(made.tobytes(), b"".join(one.tobytes() for one in wanted))
        self.assertEqual(made.tobytes(), b"".join(one.tobytes() for one in again))
        return made

    def test_each_row_is_a_call(self):
        for kind in (np.float32, np.float64):
            for lattice in (LATTICE, WEIGHTED):
                embedding = lattice.embed(POINTS.astype(kind), outside="extend", falloff=0.2)
                for count in (0, 1, 2, 9, 20):
                    Qs = pushed(lattice, count)
                    made = self.same(lattice, embedding, "Q", Qs, threads=1 + count % 2)
                    self.assertEqual(made.dtype, kind)
                    self.same(lattice, embedding, "offsets", Qs - lattice.rest, weight=RANDOM.random(300))

    def test_weights_of_control_points_are_one_set(self):
        embedding, Qs, weights = LATTICE.embed(POINTS), pushed(LATTICE, 4), RANDOM.uniform(0.5, 2, LATTICE.size)
        made = LATTICE.deform(embedding, Qs, weights=weights)
        self.assertEqual(made.tobytes(), b"".join(LATTICE.moved(Q, weights=weights).deform(embedding).tobytes() for Q in Qs))

    def test_out_is_any_array_or_map(self):
        embedding, Qs = LATTICE.embed(POINTS), pushed(LATTICE, 9)
        wanted = LATTICE.deform(embedding, Qs)
        for out in (np.empty((9, 300, 3)), np.empty((9, 300, 5))[..., 1:4], np.empty((300, 9, 3)).transpose(1, 0, 2), np.empty((18, 300, 3))[::2],
                    np.asfortranarray(np.empty((9, 300, 3)))):
            self.assertIs(LATTICE.deform(embedding, Qs, out=out), out)
            self.assertTrue(np.array_equal(out, wanted, equal_nan=True))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "variants.npy")
            out = np.lib.format.open_memmap(path, "w+", np.float32, (9, 300, 3))
            LATTICE.deform(embedding, Qs, out=out)
            out.flush()
            del out
            self.assertTrue(np.array_equal(np.load(path), wanted.astype(np.float32), equal_nan=True))

    def test_what_is_refused(self):
        embedding, Qs = LATTICE.embed(POINTS), pushed(LATTICE, 3)
        frozen = np.empty((3, 300, 3))
        frozen.flags.writeable = False
        for message, more in (("normals, tangents, gradients and vertices", {"normals": POINTS}), ("vertices", {"vertices": [1]}),
                              ("gradients", {"gradients": True}), ("not both", {"offsets": Qs}), ("triangles", {"triangles": [[0, 1, 2]]}),
                              ("out must have the shape", {"out": np.empty((2, 300, 3))}), ("read-only", {"out": frozen}),
                              ("share their memory", {"out": np.lib.stride_tricks.as_strided(np.empty((300, 3)), (3, 300, 3), (0, 24, 8))}),
                              ("weight= is of points", {"weights": np.ones(300)}), ("weights= is of control points", {"weight": np.ones(LATTICE.size)})):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                LATTICE.deform(embedding, Qs, **more)
        with self.assertRaisesRegex(ValueError, "Q must have the shape"):
            LATTICE.deform(embedding, Qs[:, :-1])
        with self.assertRaisesRegex(TypeError, "out must be an array"):
            LATTICE.deform(embedding, Qs, out=[1])
        Qs[1, 2, 3, 1, 0] = np.inf
        with self.assertRaisesRegex(ffd.InvalidError, "variant 1: .*finite"):
            LATTICE.deform(embedding, Qs)
        with self.assertRaises(ffd.InvalidError):
            WEIGHTED.deform(embedding, pushed(WEIGHTED, 2))

    def test_out_in_the_control_points(self):
        room = np.zeros(3 * (LATTICE.rest.size + 900))
        offsets, out = room[:3 * LATTICE.rest.size].reshape(3, *LATTICE.rest.shape), room[:2700].reshape(3, 300, 3)
        embedding = LATTICE.embed(POINTS)
        with self.assertRaisesRegex(ValueError, "out is memory of offsets"):
            LATTICE.deform(embedding, offsets=offsets, out=out)
        wanted = LATTICE.deform(embedding, offsets=offsets[0] + 0.1)
        offsets[0] += 0.1
        self.assertTrue(np.array_equal(LATTICE.deform(embedding, offsets=offsets[0], out=room[:900].reshape(300, 3)), wanted, equal_nan=True))

    def test_progress_cancels(self):
        embedding, Qs, told = LATTICE.embed(POINTS), pushed(LATTICE, 40), []
        LATTICE.deform(embedding, Qs, progress=told.append, threads=1)
        self.assertEqual(told, sorted(told))
        self.assertEqual(told[-1], 1)
        with self.assertRaises(ffd.Cancelled):
            LATTICE.deform(embedding, Qs, progress=lambda done: False)


class Basis(unittest.TestCase):
    def test_it_owns_its_memory(self):
        embedding = LATTICE.embed(POINTS)
        matrix = LATTICE.basis(embedding)
        data, wanted = matrix.data, matrix.data.copy()
        self.assertTrue(data.flags.writeable)
        del matrix
        gc.collect()
        self.assertTrue(np.array_equal(data, wanted))

    def test_columns_ascend_in_the_order_of_reshape(self):
        for lattice in (LATTICE, WEIGHTED):
            embedding, matrix = lattice.embed(POINTS), lattice.basis(lattice.embed(POINTS))
            for start, end in zip(matrix.indptr[:-1], matrix.indptr[1:]):
                self.assertTrue((np.diff(matrix.indices[start:end]) > 0).all())
            D = RANDOM.normal(size=lattice.rest.shape)
            csr = ffd._values.Csr(matrix.data, matrix.indices, matrix.indptr, matrix.shape)
            rows = np.repeat(np.arange(300), np.diff(csr.indptr))
            product = np.zeros((300, 3))
            np.add.at(product, rows, csr.data[:, None] * D.reshape(-1, 3)[csr.indices])
            self.assertTrue(np.allclose(product, lattice.basis_times(embedding, D)))


if __name__ == "__main__":
    unittest.main()
