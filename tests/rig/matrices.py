"""Affine maps of space as twelve numbers (three rows of four), and quaternions (x, y, z, w), for the tests of rigs."""

import math

UNIT = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def times(a, b):
    """First b, then a."""
    return tuple(a[4 * i] * b[j] + a[4 * i + 1] * b[4 + j] + a[4 * i + 2] * b[8 + j] + (a[4 * i + 3] if j == 3 else 0.0)
                 for i in range(3) for j in range(4))


def product(*maps):
    found = maps[0]
    for one in maps[1:]:
        found = times(found, one)
    return found


def apply(m, p):
    x, y, z = p
    return (m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
            m[8] * x + m[9] * y + m[10] * z + m[11])


def turn(m, v):
    """The linear part, of a vector."""
    return apply(linear(m), v)


def linear(m):
    return (m[0], m[1], m[2], 0.0, m[4], m[5], m[6], 0.0, m[8], m[9], m[10], 0.0)


def origin(m):
    return (m[3], m[7], m[11])


def placed(m, p):
    """The linear part of m, with this origin."""
    return (m[0], m[1], m[2], p[0], m[4], m[5], m[6], p[1], m[8], m[9], m[10], p[2])


def determinant(m):
    return (m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8])
            + m[2] * (m[4] * m[9] - m[5] * m[8]))


def inverse(m):
    d = determinant(m)
    rows = [((m[5] * m[10] - m[6] * m[9]) / d, (m[2] * m[9] - m[1] * m[10]) / d, (m[1] * m[6] - m[2] * m[5]) / d),
            ((m[6] * m[8] - m[4] * m[10]) / d, (m[0] * m[10] - m[2] * m[8]) / d, (m[2] * m[4] - m[0] * m[6]) / d),
            ((m[4] * m[9] - m[5] * m[8]) / d, (m[1] * m[8] - m[0] * m[9]) / d, (m[0] * m[5] - m[1] * m[4]) / d)]
    x, y, z = origin(m)
    return tuple(v for a, b, c in rows for v in (a, b, c, -(a * x + b * y + c * z)))


def transposed(m):
    """Of the linear part."""
    return (m[0], m[4], m[8], 0.0, m[1], m[5], m[9], 0.0, m[2], m[6], m[10], 0.0)


def sum_of(a, b, s=1.0, t=1.0):
    return tuple(s * x + t * y for x, y in zip(a, b))


def norm(m):
    return math.sqrt(sum(x * x for x in m))


def of_columns(*columns):
    return tuple(x for row in zip(*columns) for x in (*row, 0.0))


def of_numbers(m):
    """A glTF matrix: sixteen numbers by columns."""
    return tuple(m[4 * j + i] for i in range(3) for j in range(4))


def to_numbers(m):
    return [x for j in range(4) for x in (m[j], m[4 + j], m[8 + j], 1.0 if j == 3 else 0.0)]


def of_quaternion(q):
    x, y, z, w = q
    return (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0.0,
            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0.0,
            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0.0)


def of_parts(t, q, s):
    """What translation, rotation and scale of a node make."""
    m = of_quaternion(q)
    return tuple(x for i in range(3) for x in (m[4 * i] * s[0], m[4 * i + 1] * s[1], m[4 * i + 2] * s[2], t[i]))


def quaternion(m):
    """Of a rotation: from the largest of the four, which no rounding makes small."""
    a, b, c = m[0], m[5], m[10]
    four = [1 + a - b - c, 1 - a + b - c, 1 - a - b + c, 1 + a + b + c]
    k = four.index(max(four))
    s = 2 * math.sqrt(four[k])
    xy, xz, yz = m[1] + m[4], m[2] + m[8], m[6] + m[9]
    wx, wy, wz = m[9] - m[6], m[2] - m[8], m[4] - m[1]
    rest = [(s * s / 4, xy, xz, wx), (xy, s * s / 4, yz, wy), (xz, yz, s * s / 4, wz), (wx, wy, wz, s * s / 4)][k]
    return tuple(x / s for x in rest)


def quaternions_product(a, b):
    """First b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def about(axis, degrees):
    """The quaternion of a turn."""
    half = math.radians(degrees) / 2
    size = math.sqrt(sum(x * x for x in axis))
    return (*(math.sin(half) * x / size for x in axis), math.cos(half))
