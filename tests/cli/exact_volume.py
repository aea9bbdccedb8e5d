"""A rational B-spline volume in 40 digits, and the bound that a vertex called inside holds."""
from decimal import Decimal, getcontext

getcontext().prec = 40
EPS = Decimal(2) ** -52


def functions(t, degree, count, u):
    """(control point, value, slope) of the functions that act at u; their control points repeat after `count`."""
    t, u = [Decimal(x) for x in t], Decimal(u)
    spans = [i for i in range(degree, len(t) - degree - 1) if t[i] < t[i + 1]]
    span = max((i for i in spans if t[i] <= u), default=spans[0])
    values, before = [Decimal(1)], []
    for k in range(1, degree + 1):
        before, values = values, [Decimal(0)] * (k + 1)
        for r, x in enumerate(before):
            low, high = t[span - k + 1 + r], t[span + 1 + r]
            values[r] += (high - u) * x / (high - low)
            values[r + 1] += (u - low) * x / (high - low)
    slopes = [Decimal(0)] * (degree + 1)
    for r, x in enumerate(before):
        step = degree * x / (t[span + 1 + r] - t[span - degree + 1 + r])
        slopes[r] -= step
        slopes[r + 1] += step
    return [((span - degree + r) % count, values[r], slopes[r]) for r in range(degree + 1)]


def evaluate(directions, points, weights, uvw):
    """C(u,v,w) and its Jacobian, rows by x, y, z. Each direction has t, degree and n, the number of control points."""
    along = [functions(d.t, d.degree, d.n, u) for d, u in zip(directions, uvw)]
    n, m = directions[0].n, directions[1].n
    sums = [[Decimal(0)] * 4 for _ in range(4)]
    for k, c, dc in along[2]:
        for j, b, db in along[1]:
            for i, a, da in along[0]:
                at = i + n * (j + m * k)
                h = Decimal(weights[at])
                p = [h * Decimal(x) for x in points[at]] + [h]
                for total, basis in zip(sums, (a * b * c, da * b * c, a * db * c, a * b * dc)):
                    for r in range(4):
                        total[r] += basis * p[r]
    place, *slopes = sums
    c = [x / place[3] for x in place[:3]]
    return c, [[(slope[r] - c[r] * slope[3]) / place[3] for slope in slopes] for r in range(3)]


def tolerance(points, p):
    return [16 * EPS * (max(abs(Decimal(q[a])) for q in points) + abs(Decimal(p[a]))) for a in range(3)]


def residual_by_bound(directions, points, weights, uvw, p):
    """The residual at u,v,w, and its largest part of the bound in a coordinate: the tolerance, and what the rounding of
    u,v,w in the range of the knots moves C by."""
    c, jacobian = evaluate(directions, points, weights, uvw)
    grain = [EPS * (abs(Decimal(u)) + abs(Decimal(d.t[d.degree]))) for d, u in zip(directions, uvw)]
    residual = [abs(x - Decimal(y)) for x, y in zip(c, p)]
    bound = [tol + sum(abs(slope) * g for slope, g in zip(row, grain))
             for tol, row in zip(tolerance(points, p), jacobian)]
    return sum(r * r for r in residual).sqrt(), max(r / b for r, b in zip(residual, bound))
