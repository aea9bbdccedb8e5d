"""Drags and mirrored pulls of lattice files against NumPy: the least norm by the pseudoinverse of the basis, and the
formula of a pull."""

import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("moves")
BOX = {"min": [-1.0, 0.0, 2.0], "max": [2.0, 3.0, 5.0]}
SHAPES = [{"size": [5, 4, 6], "rest": {"box": BOX}},
          {"size": [6, 6, 5], "degree": [2, 4, 1], "knots": ["open", "clamped", "uniform"], "rest": {"box": BOX}},
          {"size": [4, 4, 4], "rest": {"box": BOX}, "weights": RANDOM.uniform(0.5, 2, 64).tolist()},
          {"size": [3, 9, 4], "rest": {"cylinder": {"center": [0, 0, 0], "axis": "z", "radius": [0.5, 2], "height": 3}}}]


def lattice_of(shape, *moves):
    return ffd.Lattice.parse({"format": "ffd-lattice", "version": 1, **shape, "moves": list(moves)})


def places_in(shape, count):
    if "cylinder" in shape["rest"]:
        radius, angle, z = RANDOM.uniform(0.6, 1.9, count), RANDOM.uniform(0, 6.28, count), RANDOM.uniform(-1.4, 1.4, count)
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])
    return RANDOM.uniform(np.array(BOX["min"]) + 0.1, np.array(BOX["max"]) - 0.1, (count, 3))


def least(lattice, places, by, chosen):
    """The changes by NumPy, of the chosen control points."""
    rows = lattice.basis(lattice.embed(places))
    basis = np.zeros((len(places), chosen.size))
    for row in range(len(places)):
        columns = slice(rows.indptr[row], rows.indptr[row + 1])
        basis[row, rows.indices[columns]] = rows.data[columns]
    basis[:, ~chosen.ravel()] = 0
    changes = np.linalg.pinv(basis, rcond=1e-10) @ by
    return changes.reshape(lattice.rest.shape), by - basis @ changes


class Drags(unittest.TestCase):
    def check(self, shape, places, by, chosen, **more):
        drags = [{"point": p.tolist(), "by": v.tolist()} for p, v in zip(places, by)]
        lattice = lattice_of(shape, {**more, "drag": drags})
        wanted, missed = least(lattice_of(shape), places, by, chosen)
        self.assertLess(np.abs(lattice.offsets - wanted).max(), 1e-9 * np.abs(wanted).max())
        self.assertFalse(lattice.offsets[~chosen].any())
        moved = lattice.deform(lattice.embed(places)) - places
        self.assertLess(np.abs(moved - (by - missed)).max(), 1e-12 * np.abs(by).max())
        return missed

    def test_the_least_norm(self):
        for shape in SHAPES:
            for count in (1, 2, 7, 15):
                places, by = places_in(shape, count), RANDOM.standard_normal((count, 3))
                rest = lattice_of(shape).rest
                missed = self.check(shape, places, by, np.ones(rest.shape[:3], bool))
                self.assertLess(np.abs(missed).max(), 1e-10)

    def test_only_near_control_points(self):
        for shape in SHAPES:
            places, by = places_in(shape, 3), RANDOM.standard_normal((3, 3))
            rest = lattice_of(shape).rest
            near = (np.linalg.norm(rest[..., None, :] - places, axis=-1) <= 1.3).any(axis=-1)
            self.assertTrue(near.any() and not near.all())
            self.check(shape, places, by, near, radius=1.3)

    def test_contradictions_are_met_by_least_squares(self):
        for shape in SHAPES:
            places, by = places_in(shape, 4), RANDOM.standard_normal((4, 3))
            places[2] = places[1]
            missed = self.check(shape, places, by, np.ones(lattice_of(shape).rest.shape[:3], bool))
            self.assertGreater(np.abs(missed).max(), 0.01)

    def test_many_places_in_one_cell(self):
        """More than its 8 control points can meet."""
        shape = {"size": [2, 2, 2], "rest": {"box": BOX}}
        places, by = places_in(shape, 40), RANDOM.standard_normal((40, 3))
        self.check(shape, places, by, np.ones((2, 2, 2), bool))


class MirroredPulls(unittest.TestCase):
    def test_both_weights_act_on_all_points(self):
        for normal, offset in (([1.0, 0.0, 0.0], 0.25), ([0.0, -1.0, 0.0], -1.0), ([2.0, -1.0, 2.0], 4.0)):
            n = np.array(normal) / np.linalg.norm(normal)
            for shape in SHAPES:
                point, by, radius = places_in(shape, 1)[0], RANDOM.standard_normal(3), 2.2
                image = point - 2 * (n @ point - offset) * n
                pull = {"pull": {"point": point.tolist(), "by": by.tolist(), "radius": radius}}
                for mirror in ({"axis": normal, "at": offset}, {"point": (offset * n).tolist(), "normal": normal}):
                    lattice = lattice_of(shape, {"mirror": mirror, **pull})
                    wanted = np.zeros_like(lattice.rest)
                    for place, vector in ((point, by), (image, by - 2 * (n @ by) * n)):
                        x = np.minimum(np.linalg.norm(lattice.rest - place, axis=-1) / radius, 1)
                        wanted += ((1 - x * x) ** 2)[..., None] * vector
                    self.assertTrue(wanted.any())
                    self.assertLess(np.abs(lattice.offsets - wanted).max(), 1e-14 * max(1, np.abs(by).max()))


class FractionsOfTheMesh(unittest.TestCase):
    def test_the_margin_does_not_matter(self):
        points = RANDOM.uniform([-3, 1, 0], [2, 5, 9], (50, 3))
        low, side = points.min(axis=0), np.ptp(points, axis=0)
        for margin in (0, 0.05, [0.3, 0, 1]):
            lattice = lattice_of({"size": [4, 5, 4], "rest": {"box": "mesh", "margin": margin}, "units": "mesh"},
                                 {"scale": {"factor": [1, 1.4, 1], "about": [0.5, 0, 0.5]}}).fit(points)
            wanted = points + np.array([0, 0.4, 0]) * (points - low)
            self.assertLess(np.abs(lattice.deform(lattice.embed(points)) - wanted).max(), 1e-13 * side.max())


if __name__ == "__main__":
    unittest.main()
