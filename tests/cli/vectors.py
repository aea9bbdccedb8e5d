"""Vectors of any number of coordinates, as lists."""

import math


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    """The vector of length 1 in this direction; None where there is none."""
    size = math.sqrt(dot(v, v))
    return [x / size for x in v] if size > 0 else None
