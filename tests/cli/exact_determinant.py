"""Rational B-spline volumes in whole numbers: det J without any rounding, by the definition and apart from the program."""

from fractions import Fraction
from math import lcm


def preset(kind, n, degree):
    """The knots of a kind as doubles; a list is itself."""
    if isinstance(kind, list):
        return kind
    if kind == "uniform":
        return [i / (n + degree) for i in range(n + degree + 1)]
    inner = [i - degree for i in range(n + degree + 1)]
    if kind == "clamped":
        inner = [min(max(i, 0), n - degree) for i in inner]
    return [i / (n - degree) for i in inner]


def greville(t, n, degree):
    """Where the control points of a box stand, as shares of the domain."""
    low, high = t[degree], t[n]
    return [(sum(t[i + 1:i + degree + 1]) / degree - low) / (high - low) for i in range(n)]


def whole(numbers):
    """Numbers times their common denominator, and that."""
    numbers = [Fraction(x) for x in numbers]
    denominator = lcm(*(x.denominator for x in numbers))
    return [int(x * denominator) for x in numbers], denominator


def functions(t, degree, span, u):
    """The values and slopes at u of the basis functions span-degree..span."""
    values, slopes = [Fraction(1)], []
    for d in range(1, degree + 1):
        low, values = values, [Fraction(0)] * (d + 1)
        slopes = [Fraction(0)] * (d + 1)
        for r, value in enumerate(low):
            i = span - d + 1 + r
            length = t[i + d] - t[i]
            values[r + 1] += (u - t[i]) / length * value
            values[r] += (t[i + d] - u) / length * value
            slopes[r + 1] += d / length * value
            slopes[r] -= d / length * value
    return values, slopes


class ExactVolume:
    def __init__(self, size, degree, knots, points, weights=None):
        self.size, self.degree = size, degree
        self.knots = [[Fraction(x) for x in t] for t in knots]
        self.points, self.unit = whole([x for p in points for x in p])
        self.weights, _ = whole(weights or [1] * len(points))

    def spans(self, a):
        t = self.knots[a]
        return [i for i in range(self.degree[a], self.size[a]) if t[i] < t[i + 1]]

    def place(self, numbers):
        """A random place, often beside an end of its cell: its parameters, and its spans."""
        spans = [numbers.choice(self.spans(a)) for a in range(3)]
        shares = [Fraction(numbers.choice((0, 1, numbers.random(), numbers.random() ** 8, 1 - numbers.random() ** 8)))
                  for _ in range(3)]
        ends = [(t[s], t[s + 1]) for t, s in zip(self.knots, spans)]
        return [low + x * (high - low) for x, (low, high) in zip(shares, ends)], spans

    def determinant(self, uvw, spans=None):
        uvw = [Fraction(u) for u in uvw]
        spans = spans or [max(i for i in self.spans(a) if self.knots[a][i] <= u or i == self.spans(a)[0])
                          for a, u in enumerate(uvw)]
        values, slopes, factor = [], [], Fraction(1)
        for t, d, s, u in zip(self.knots, self.degree, spans, uvw):
            found = functions(t, d, s, u)
            (value, unit), (slope, steep) = whole(found[0]), whole(found[1])
            values.append(value)
            slopes.append(slope)
            factor *= Fraction(unit, steep)
        rows = [[0] * 4 for _ in range(4)]  # by u, v, w, and the value: of A and W
        first = [s - d for s, d in zip(spans, self.degree)]
        for k, w in enumerate(values[2]):
            for j, v in enumerate(values[1]):
                at = first[0] + self.size[0] * (first[1] + j + self.size[1] * (first[2] + k))
                for i, u in enumerate(values[0]):
                    h, point = self.weights[at + i], self.points[3 * (at + i):3 * (at + i) + 3]
                    for row, f in zip(rows, (slopes[0][i] * v * w, u * slopes[1][j] * w, u * v * slopes[2][k], u * v * w)):
                        f *= h
                        for r, x in enumerate(point):
                            row[r] += f * x
                        row[3] += f
        *columns, (*a, weight) = rows
        x, y, z = ([c[r] * weight - a[r] * c[3] for r in range(3)] for c in columns)
        value = sum(x[r] * (y[(r + 1) % 3] * z[(r + 2) % 3] - y[(r + 2) % 3] * z[(r + 1) % 3]) for r in range(3))
        return Fraction(value, weight ** 6) * factor / self.unit ** 3
