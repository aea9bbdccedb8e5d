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


def write_kind(path, kind, more=(), size=SIZE):
    """8 x 8 x 8, a box (which may have another size) or warped, with more moves."""
    middle, last = [size // 4, size - size // 4 - 1], size - 1
    push = {"at": [middle, middle, [size // 2, last]], "by": [0.3, 0.2, 0.5]}
    return write(path, size, RESTS[kind], [TWIST, push, *more])


def write_cut(path):
    """The box without the last twentieth of the meshes along x."""
    box = {"min": BOX["min"], "max": [9.5, *BOX["max"][1:]]}
    return write(path, SIZE, {"box": box}, [TWIST])


def write_warped_cut(path):
    """The warped one with its last points pulled in along x, so that it ends before the meshes do."""
    points = [[min(x, 5) + 0.9 * max(x - 5, 0), y, z] for x, y, z in bent_points()]
    return write(path, SIZE, {"points": points}, [TWIST])


def write_box(path, size):
    last = size - 1
    push = {"at": [[1, last], [1, last], [last // 2, last]], "by": [0.3, 0.2, 0.5]}
    return write(path, size, RESTS["box"], [TWIST, push])


def write_blocks(stem, side):
    """side^3 boxes of 4 x 4 x 4 that share faces and fill BOX, as files that begin with stem."""
    low, high = BOX["min"], BOX["max"]
    paths = []
    for number in range(side ** 3):
        place = number % side, number // side % side, number // side ** 2
        ends = [[a + (b - a) * (i + end) / side for a, b, i in zip(low, high, place)] for end in (0, 1)]
        paths.append(write(f"{stem}-{number}.json", 4, {"box": {"min": ends[0], "max": ends[1]}}, [{"by": [0.3, 0.2, 0.5]}]))
    return paths
