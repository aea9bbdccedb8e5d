"""The cubic lattices round the meshes of meshes.py."""

import json
import math

BOX = {"min": [-0.1, -0.1, -1.2], "max": [10.1, 10.1, 1.2]}
TWIST = {"twist": {"axis": "z", "degrees": 20}}
SIZE = 8


def bend(x, y, z):
    return [x + 0.15 * math.sin(0.9 * y), y + 0.15 * math.sin(1.1 * x), z + 0.1 * math.sin(x + y)]


def bent_points():
    steps = [i / (SIZE - 1) for i in range(SIZE)]
    return [bend(-0.6 + 11.2 * x, -0.6 + 11.2 * y, -1.5 + 3.0 * z) for z in steps for y in steps for x in steps]


# The rest map of a box is affine; one with bent control points is inverted cell by cell.
RESTS = {"box": {"box": BOX}, "warped": {"points": bent_points()}}


def write(path, size, rest, moves):
    lattice = {"format": "ffd-lattice", "version": 1, "size": [size] * 3, "rest": rest, "moves": moves}
    with open(path, "w", encoding="ascii") as file:
        json.dump(lattice, file)
    return path


def write_kind(path, kind, more=()):
    """8 x 8 x 8, a box or warped, with more moves."""
    push = {"at": [[2, 5], [2, 5], [4, 7]], "by": [0.3, 0.2, 0.5]}
    return write(path, SIZE, RESTS[kind], [TWIST, push, *more])


def write_box(path, size):
    last = size - 1
    push = {"at": [[1, last], [1, last], [last // 2, last]], "by": [0.3, 0.2, 0.5]}
    return write(path, size, RESTS["box"], [TWIST, push])
