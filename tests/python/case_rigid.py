"""Parts that move as one piece: rigid= and uniform= of jobs, and what their results say."""

import json
import unittest

import ffd_mesh as ffd
import numpy as np

OBJ = (b"g a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3\nf 1 3 4\n"
       b"g b\nv 3 0 0\nv 4 0 0\nv 4 1 1\nv 3 1 0\nf 5 6 7\nf 5 7 8\n")
LATTICE = {"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "rest": {"box": "mesh", "margin": 0.1},
           "moves": [{"bend": {"axis": "x", "toward": "y", "degrees": 60}}, {"scale": {"factor": [1.5, 1, 1]}}]}


def points_of(data):
    return np.array([line.split()[1:4] for line in data.decode().splitlines() if line.startswith("v ")], float)


class Rigid(unittest.TestCase):
    def setUp(self):
        self.lattice = json.dumps(LATTICE).encode()

    def deformed(self, **options):
        done = ffd.deform_bytes(OBJ, self.lattice, name="in.obj", **options)
        return points_of(done.data), done.result

    def nearest(self, x, y):
        a, b = x - x.mean(0), y - y.mean(0)
        u, _, vt = np.linalg.svd(b.T @ a)
        return a @ (u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt).T + y.mean(0)

    def test_parts_move_as_one(self):
        before, (free, nothing) = points_of(OBJ), self.deformed()
        self.assertEqual(nothing.rigid, [])
        moved, result = self.deformed(rigid=["group:a"], uniform="group:b")
        np.testing.assert_allclose(moved[:4], self.nearest(before[:4], free[:4]), rtol=0, atol=1e-12)
        self.assertEqual([(part.part, part.pieces) for part in result.rigid], [("group:a", 1), ("group:b", 1)])
        self.assertEqual(result.rigid[0].scale, 1)
        self.assertGreater(result.rigid[1].scale, 1)
        self.assertAlmostEqual(result.rigid[0].distance, np.linalg.norm(moved[:4] - free[:4], axis=1).max(), places=12)
        each, result = self.deformed(rigid="component")
        np.testing.assert_allclose(each[4:], self.nearest(before[4:], free[4:]), rtol=0, atol=1e-12)
        self.assertEqual(result.rigid[0].pieces, 2)

    def test_what_is_refused(self):
        for options in ({"rigid": ["group:c"]}, {"rigid": ["a"]}, {"rigid": ["group:a"], "uniform": ["group:a"]}):
            with self.assertRaises(ffd.ArgumentError):
                self.deformed(**options)
