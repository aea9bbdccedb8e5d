"""Weights of points: the reference case, the bits of jobs on files, what is refused."""

import json
import os
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("weight")


def sheet(side=30):
    """Points of a bent sheet, its normals and triangles."""
    x, y = (v.ravel() for v in np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side)))
    points = np.stack([x, y, 0.3 * np.sin(2 * x) * y], axis=1)
    normals = np.stack([-0.6 * np.cos(2 * x) * y, -0.3 * np.sin(2 * x), np.ones_like(x)], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
    triangles = np.concatenate([np.stack([a, a + 1, a + side + 1], axis=1), np.stack([a, a + side + 1, a + side], axis=1)])
    return points, normals, triangles


def mesh(points, normals, triangles):
    """A binary PLY with faces, and how many bytes of vertices it has behind its head."""
    rows = np.hstack([points, normals])
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
            + "".join(f"property double {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
            + f"element face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n")
    faces = np.zeros(len(triangles), dtype=[("n", "u1"), ("corners", "<u4", 3)])
    faces["n"], faces["corners"] = 3, triangles
    return head.encode() + rows.tobytes() + faces.tobytes()


def rows_of(data, count):
    return np.frombuffer(data.split(b"end_header\n", 1)[1][:48 * count]).reshape(count, 6)


class Weight(unittest.TestCase):
    def setUp(self):
        self.points, self.normals, self.triangles = sheet()
        lattice = ffd.Lattice.box((-1.2, -1.2, -1), (1.2, 1.2, 1), size=(5, 4, 4))
        self.lattice = lattice.moved(offsets=RANDOM.uniform(-0.2, 0.2, (5, 4, 4, 3)))
        self.emb = self.lattice.embed(self.points)
        self.weight = np.clip(RANDOM.uniform(-0.2, 1.2, len(self.points)), 0, 1)

    def test_the_reference_case(self):
        with open(os.path.join(support.SOURCE, "tests", "cli", "authoring", "weight-npy.json"), encoding="utf-8") as file:
            of = json.load(file)
        lattice = ffd.Lattice.parse(json.dumps(of["lattice"]))
        found = lattice.deform(lattice.embed(np.array(of["before"])), weight=np.clip(of["weight"], 0, 1), triangles=np.array(of["triangles"]),
                               normals=np.array(of["normals"]))
        np.testing.assert_allclose(found.points, of["expect"]["after"], rtol=0, atol=of["expect"]["tolerance"])
        np.testing.assert_allclose(found.normals, of["expect"]["normals"], rtol=0, atol=of["expect"]["normal_tolerance"])

    def test_the_bits_of_jobs(self):
        found = self.lattice.deform(self.emb, weight=self.weight, triangles=self.triangles, normals=self.normals)
        expected = np.hstack([found.points, found.normals])
        data, count = mesh(self.points, self.normals, self.triangles), len(self.points)
        with tempfile.TemporaryDirectory() as folder:
            source, out, array = (os.path.join(folder, name) for name in ("in.ply", "out.ply", "w.npy"))
            np.save(array, self.weight)
            with open(source, "wb") as file:
                file.write(data)
            with open(array, "rb") as file:
                stored = file.read()
            for weight in (array, self.weight, stored, list(self.weight), self.weight[:, None]):
                result = ffd.deform_file(source, out, self.lattice, weight=weight, force=True)
                with open(out, "rb") as file:
                    self.assertTrue((rows_of(file.read(), count) == expected).all())
                self.assertEqual(result.weight.zero, int((self.weight == 0).sum()))
                self.assertEqual(ffd.check_file(source, self.lattice, weight=weight).weight.one, int((self.weight == 1).sum()))
            inverted = ffd.deform_bytes(data, self.lattice, name="in.ply", weight="1-" + array)
            again = ffd.deform_bytes(data, self.lattice, name="in.ply", weight=1 - self.weight)
            self.assertEqual(inverted.data, again.data)
            self.assertIsNone(ffd.check_file(source, self.lattice).weight)
            for weight, error in (("mask", ffd.ArgumentError), ("color:r", ffd.InvalidError), (self.weight[1:], ffd.InvalidError),
                                  (np.full(count, np.nan), ffd.InvalidError), (np.zeros(count, complex), (TypeError, ValueError))):
                with self.assertRaises(error):
                    ffd.deform_file(source, out, self.lattice, weight=weight, force=True)

    def test_weights_of_0_and_1(self):
        plain = self.lattice.deform(self.emb, normals=self.normals)
        one = self.lattice.deform(self.emb, weight=np.ones(len(self.points)), triangles=self.triangles, normals=self.normals)
        self.assertTrue((one.points == plain.points).all() and (one.normals == plain.normals).all())
        zero = self.lattice.deform(self.emb, weight=np.zeros(len(self.points)), triangles=self.triangles, normals=self.normals)
        self.assertTrue((zero.points == self.points).all() and (zero.normals == self.normals).all())
        half = self.lattice.deform(self.emb, weight=self.weight.astype(np.float32), threads=1)
        w = self.weight.astype(np.float32).astype(float)[:, None]
        np.testing.assert_allclose(half, self.points + w * (plain.points - self.points), rtol=0, atol=1e-15)

    def test_some_points(self):
        whole = self.lattice.deform(self.emb, weight=self.weight)
        chosen = np.arange(3, len(self.points), 7)
        some = self.lattice.deform(self.emb, weight=self.weight, vertices=chosen)
        self.assertTrue((some[chosen] == whole[chosen]).all())
        others = np.setdiff1d(np.arange(len(self.points)), chosen)
        self.assertTrue((some[others] == self.points[others]).all())

    def test_what_is_refused(self):
        bad = self.weight.copy()
        bad[17] = 1.5
        with self.assertRaisesRegex(ValueError, "17"):
            self.lattice.deform(self.emb, weight=bad)
        bad[17] = np.nan
        with self.assertRaisesRegex(ValueError, "17"):
            self.lattice.deform(self.emb, weight=bad, triangles=self.triangles, gradients=True)
        with self.assertRaisesRegex(ValueError, "triangles"):
            self.lattice.deform(self.emb, weight=self.weight, normals=self.normals)
        for options in ({"weight": self.weight[1:]}, {"weight": self.weight, "triangles": self.triangles[:, :2], "normals": self.normals},
                        {"weight": self.weight, "triangles": self.triangles + len(self.points), "normals": self.normals},
                        {"triangles": self.triangles}, {"weight": self.weight, "triangles": -self.triangles, "normals": self.normals}):
            with self.assertRaises((ValueError, TypeError)):
                self.lattice.deform(self.emb, **options)
