"""Frames of an animation: points are twisted more and more about the y axis.

    python3 twist_frames.py POINTS DEGREES FRAMES

POINTS is text, x y z a line (numpy.savetxt writes it so). Frame n goes to frame-n.txt in the same form; the last one
is twisted by DEGREES. The points are embedded once, and every frame costs an evaluation of the volume only."""

import sys

import ffd


def read(path):
    with open(path, encoding="ascii") as file:
        return [[float(x) for x in line.split()] for line in file if line.strip()]


def write(path, points):
    with open(path, "w", encoding="ascii") as file:
        file.writelines(" ".join(map(repr, point)) + "\n" for point in points)


def twist(points, degrees):
    """A lattice round the points whose layers along y turn, the last one by so many degrees."""
    box = {"min": [min(column) for column in zip(*points)], "max": [max(column) for column in zip(*points)]}
    return ffd.Lattice({"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": box},
                        "moves": [{"twist": {"axis": "y", "degrees": degrees}}]})


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    points, degrees, frames = read(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])
    locations = twist(points, 0).locate(points)
    for frame in range(1, frames + 1):
        lattice = twist(points, degrees * frame / frames)
        write(f"frame-{frame}.txt", lattice.displace(points, locations))


if __name__ == "__main__":
    main()
