"""Refined lattices against knot insertion and degree elevation in exact fractions, by the basis functions' definition: the
control points of the finer basis that give the same values at as many places as it has functions."""

import unittest
from fractions import Fraction

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("refine")


def values(knots, degree, count, u):
    """All basis functions at u, by the triangle of Cox and de Boor."""
    rows = [Fraction(int(knots[i] <= u < knots[i + 1])) for i in range(len(knots) - 1)]
    for d in range(1, degree + 1):
        rows = [(rows[i] * (u - knots[i]) / (knots[i + d] - knots[i]) if knots[i] < knots[i + d] else 0) +
                (rows[i + 1] * (knots[i + d + 1] - u) / (knots[i + d + 1] - knots[i + 1]) if knots[i + 1] < knots[i + d + 1] else 0)
                for i in range(len(rows) - 1)]
    return rows[:count]


def value_at(lattice, numbers, uvw):
    """The sum of numbers (nu, nv, nw) by the basis functions at u, v, w, exactly."""
    rows = [values([Fraction(t) for t in lattice.knots[a].tolist()], lattice.degree[a], lattice.size[a], Fraction(uvw[a]))
            for a in range(3)]
    return sum(rows[0][i] * rows[1][j] * rows[2][k] * Fraction(float(numbers[i, j, k]))
               for i in range(lattice.size[0]) if rows[0][i] for j in range(lattice.size[1]) if rows[1][j]
               for k in range(lattice.size[2]) if rows[2][k])


GRADED = [0.0, 0.0, 0.0, 0.0, 2.0 ** -20, 2.0 ** -19, 0.25, 1.0, 1.0, 1.0, 1.0]
CASES = [((5, 4, 3), (3, 2, 1), "clamped", {"insert": {"u": [0.25, 0.75], "w": [0.25]}}),
         ((5, 4, 3), (3, 2, 2), "open", {"degree": (4, 3, 2), "size": (9, 6, 4)}),
         ((7, 3, 3), (3, 2, 2), (GRADED, "uniform", "clamped"), {"insert": {"u": [2.0 ** -21, 0.125]}, "size": (11, 4, 3)})]


class Refine(unittest.TestCase):
    def lattice(self, size, degree, knots):
        rest = RANDOM.uniform(-1, 1, (*size, 3))
        offsets = RANDOM.uniform(-1, 1, rest.shape) * RANDOM.integers(0, 2, (*size, 1))
        return ffd.Lattice.from_points(rest, degree, knots=knots).moved(offsets=offsets)

    def test_the_same_map_in_fractions(self):
        for size, degree, knots, wish in CASES:
            lattice = self.lattice(size, degree, knots)
            fine = lattice.refine(**wish)
            for uvw in RANDOM.uniform(lattice.domain[0], lattice.domain[1], (12, 3)):
                for before, after in ((lattice.rest, fine.rest), (lattice.offsets, fine.offsets)):
                    for c in range(3):
                        off = value_at(fine, after[..., c], uvw) - value_at(lattice, before[..., c], uvw)
                        self.assertLess(abs(off), 4 * 2.0 ** -52 * sum(fine.degree) * np.abs(before).max(), (size, wish, uvw))

    def test_the_knots_are_those_asked_for(self):
        lattice = self.lattice((5, 4, 3), (3, 2, 1), "clamped")
        fine = lattice.refine(insert={"v": [0.5]})
        self.assertEqual((fine.size, fine.degree), ((5, 5, 3), (3, 2, 1)))
        self.assertEqual(fine.knots[1].tolist(), sorted([*lattice.knots[1].tolist(), 0.5]))

    def test_refusals(self):
        lattice = self.lattice((5, 4, 3), (3, 2, 1), "clamped")
        for wish, said in (({}, "nothing would change"), ({"size": 4}, "is less than the 5 control points"),
                           ({"degree": 15}, "is not between"), ({"degree": 0}, "degree must be at least 1, not 0"),
                           ({"insert": {"u": [2]}}, "outside of the domain"), ({"insert": {"x": [0.5]}}, "not 'x'")):
            with self.assertRaisesRegex(ValueError, said):
                lattice.refine(**wish)
