"""B-spline volumes with clamped uniform knots over a box, worked out by the definition, apart from the program."""


def knots(n, degree):
    return [0.0] * degree + [i / (n - degree) for i in range(n - degree + 1)] + [1.0] * degree


def greville(n, degree):
    t = knots(n, degree)
    return [sum(t[i + 1:i + degree + 1]) / degree for i in range(n)]


def basis(t, i, degree, u):
    if degree == 0:
        return 1.0 if t[i] <= u < t[i + 1] or t[i] < u == t[i + 1] == t[-1] else 0.0
    left, right = t[i + degree] - t[i], t[i + degree + 1] - t[i + 1]
    return ((u - t[i]) / left * basis(t, i, degree - 1, u) if left else 0.0) + (
        (t[i + degree + 1] - u) / right * basis(t, i + 1, degree - 1, u) if right else 0.0)


def slope(t, i, degree, u):
    """The derivative of a basis function."""
    left, right = t[i + degree] - t[i], t[i + degree + 1] - t[i + 1]
    return degree * ((basis(t, i, degree - 1, u) / left if left else 0.0)
                     - (basis(t, i + 1, degree - 1, u) / right if right else 0.0))


class BoxVolume:
    """The affine volume over a box; its control points, u fastest, are moved by what move(point) gives."""

    def __init__(self, low, high, move, size=(4, 4, 4), degree=(3, 3, 3)):
        self.low, self.high, self.degree = low, high, degree
        self.knots = [knots(n, d) for n, d in zip(size, degree)]
        grid = [[a + g * (b - a) for g in greville(n, d)] for a, b, n, d in zip(low, high, size, degree)]
        self.points = [[x, y, z] for z in grid[2] for y in grid[1] for x in grid[0]]
        self.offsets = [move(p) for p in self.points]

    def displacement(self, p):
        """That of the nearest point of the box."""
        uvw = [min(max((x - a) / (b - a), 0.0), 1.0) for x, a, b in zip(p, self.low, self.high)]
        n = [[basis(t, i, d, x) for i in range(len(t) - d - 1)] for t, d, x in zip(self.knots, self.degree, uvw)]
        factors = [u * v * w for w in n[2] for v in n[1] for u in n[0]]
        return [sum(f * offset[a] for f, offset in zip(factors, self.offsets)) for a in range(3)]

    def deform(self, p):
        return [x + d for x, d in zip(p, self.displacement(p))]

    def holds(self, p):
        return all(a <= x <= b for x, a, b in zip(p, self.low, self.high))

    def gradient(self, p):
        """The deformation's, as three rows of four with nothing in the last column."""
        uvw = [(x - a) / (b - a) for x, a, b in zip(p, self.low, self.high)]
        n = [[basis(t, i, d, x) for i in range(len(t) - d - 1)] for t, d, x in zip(self.knots, self.degree, uvw)]
        s = [[slope(t, i, d, x) / (b - a) for i in range(len(t) - d - 1)]
             for t, d, x, a, b in zip(self.knots, self.degree, uvw, self.low, self.high)]
        rows = [[float(row == column) for column in range(3)] for row in range(3)]
        for column in range(3):
            u, v, w = (s[a] if a == column else n[a] for a in range(3))
            factors = [x * y * z for z in w for y in v for x in u]
            for row in range(3):
                rows[row][column] += sum(f * offset[row] for f, offset in zip(factors, self.offsets))
        return tuple(x for row in rows for x in (*row, 0.0))
