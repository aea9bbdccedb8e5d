"""The map of a lattice with held faces in exact fractions: knots inserted by polar forms, then the layers put back to rest.
A second way, which shares nothing with the program; what counts is the definition (Piegl & Tiller 5.2, 4.2)."""

from fractions import Fraction
from itertools import product


class Direction:
    """One direction: its knots, where they are evaluated, and which of its control points stand for which."""

    def __init__(self, knots, points, degree):
        self.degree, self.points, self.closed = degree, points, False
        if isinstance(knots, dict) or knots in ("closed", "periodic"):
            ends = [Fraction(i, points) for i in range(points + 1)] if isinstance(knots, str) else [Fraction(t) for t in knots["closed"]]
            period = ends[-1] - ends[0]
            self.closed = True
            self.t = [ends[i % points] + i // points * period for i in range(-degree, points + degree + 1)]
            self.first, self.last = ends[0], ends[-1]
            return
        n, d = points, degree
        uniform = [Fraction(i - d, n - d) for i in range(n + d + 1)]
        if knots == "clamped":
            self.t = [min(max(t, Fraction(0)), Fraction(1)) for t in uniform]
        elif knots in ("open", "unclamped"):
            self.t = uniform
        elif knots == "uniform":
            self.t = [Fraction(i, n + d) for i in range(n + d + 1)]
        else:
            self.t = [Fraction(t) for t in knots]
        self.first, self.last = self.t[d], self.t[n]

    def span(self, u):
        """The index s of the span t_s <= u < t_(s+1); the last one at the end of the domain."""
        s = max(i for i in range(self.degree, len(self.t) - 1 - self.degree) if self.t[i] <= u and self.t[i] < self.t[i + 1])
        return s

    def polar(self, span, arguments):
        """{control point: factor}: the polar form of the piece of a span."""
        d = self.degree
        rows = [{span - d + k: Fraction(1)} for k in range(d + 1)]
        for level, u in enumerate(arguments, 1):
            rows = [self._mix(rows[k], rows[k + 1], span - d + level + k, level, u) for k in range(d - level + 1)]
        return {i: f for i, f in rows[0].items() if f}

    def _mix(self, left, right, i, level, u):
        a = (u - self.t[i]) / (self.t[i + self.degree - level + 1] - self.t[i])
        return {k: (1 - a) * left.get(k, 0) + a * right.get(k, 0) for k in {*left, *right}}

    def basis(self, u):
        """{control point: value}."""
        found = {}
        for i, f in self.polar(self.span(u), [u] * self.degree).items():
            found[i % self.points if self.closed else i] = found.get(i % self.points if self.closed else i, 0) + f
        return found

    def held(self, k, first, last):
        """{control point: value} at u, as a function: without the k + 1 outermost layers of the clamped form at these ends."""
        if not (first or last):
            return self.basis
        d, inner = self.degree, [t for t in self.t if self.first < t < self.last]
        clamped = Direction([self.first] * (d + 1) + inner + [self.last] * (d + 1), d + 1 + len(inner), d)
        shares = []
        for i in range(clamped.points):
            # Any span in the support tells the control point.
            s = next(s for s in range(i, i + d + 1) if clamped.t[s] < clamped.t[s + 1])
            shares.append(self.polar(self.span(clamped.t[s]), clamped.t[i + 1:i + d + 1]))
        gone = [i for i in range(clamped.points) if (first and i <= k) or (last and clamped.points - 1 - i <= k)]

        def factors(u):
            found = {}
            for i, f in clamped.basis(u).items():
                for j, share in ({} if i in gone else shares[i]).items():
                    found[j] = found.get(j, 0) + f * share
            return found
        return factors


def fractions(rows):
    return [[Fraction(x) for x in row] for row in rows]


class Volume:
    """A lattice file with points at rest (points: those of a box, if it has none) and offsets."""

    def __init__(self, content, points=None):
        self.size, degree = content["size"], content.get("degree", [3, 3, 3])
        self.directions = [Direction(k, n, d) for k, n, d in zip(content.get("knots", ["clamped"] * 3), self.size, degree)]
        count = self.size[0] * self.size[1] * self.size[2]
        self.rest = fractions(points if points is not None else content["rest"]["points"])
        self.offsets = fractions(content.get("deformed", {}).get("offsets", [[0, 0, 0]] * count))
        self.weights = [Fraction(h) for h in content.get("weights", [1] * count)]
        self.moved = [Fraction(h) for h in content.get("deformed", {}).get("weights", self.weights)]

    def factors(self, bases):
        return {i + self.size[0] * (j + self.size[1] * k): a * b * c
                for (i, a), (j, b), (k, c) in product(*(basis.items() for basis in bases))}

    def place(self, uvw):
        """C at rest."""
        factors = self.factors([d.basis(u) for d, u in zip(self.directions, uvw)])
        total = sum(f * self.weights[i] for i, f in factors.items())
        return [sum(f * self.weights[i] * self.rest[i][a] for i, f in factors.items()) / total for a in range(3)]

    def parts(self, uvw, k=0, faces=()):
        """Numerator and denominator of the displacement, polynomials in each span, with faces ("u-") held at C^k."""
        bases = [d.basis(u) for d, u in zip(self.directions, uvw)]
        free = [d.held(k, name + "-" in faces, name + "+" in faces)(u) for d, name, u in zip(self.directions, "uvw", uvw)]
        at_rest, moves = self.factors(bases), self.factors(free)
        low = sum(f * self.weights[i] for i, f in at_rest.items())
        point = [sum(f * self.weights[i] * self.rest[i][a] for i, f in at_rest.items()) for a in range(3)]
        # What is held keeps the numbers at rest; what is free has those that moved.
        more = sum(f * (self.moved[i] - self.weights[i]) for i, f in moves.items())
        by = [sum(f * (self.moved[i] * (self.rest[i][a] + self.offsets[i][a]) - self.weights[i] * self.rest[i][a])
                  for i, f in moves.items()) for a in range(3)]
        return [(p + q) * low - p * (low + more) for p, q in zip(point, by)], low * (low + more)

    def displacement(self, uvw, k=0, faces=()):
        numerator, denominator = self.parts(uvw, k, faces)
        return [x / denominator for x in numerator]


def coefficients(values, at):
    """Those of the polynomial with these values at these distances from 0: c_0, c_1, .."""
    n = len(at)
    table = list(values)
    for level in range(1, n):
        for i in range(n - 1, level - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (at[i] - at[i - level])
    result = [Fraction(0)] * n
    for i in range(n - 1, -1, -1):
        result = [table[i] if j == 0 else Fraction(0) for j in range(n)] if i == n - 1 else [
            (result[j - 1] if j else Fraction(0)) - at[i] * result[j] + (table[i] if j == 0 else 0) for j in range(n)]
    return result
