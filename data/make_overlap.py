#!/usr/bin/env python3
"""Draws data/overlap.svg anew from the program's real output: python3 data/make_overlap.py FFD [PICTURE]

A plain strip is deformed by lattices/overlap.json, whose volume folds nowhere and overlaps itself: it is bent by more
than a full turn. Every cell is drawn half transparent, so that what lies twice in one place is darker."""

import os
import subprocess
import sys
import tempfile

LENGTH, HEIGHT = (-6.0, 6.0), (-0.5, 0.5)
CELLS = (80, 6)
PIXELS = 480


def write_strip(path):
    columns, rows = CELLS[0] + 1, CELLS[1] + 1
    with open(path, "w", encoding="ascii") as file:
        for z in (-1.5, 1.5):  # two layers, so that the strip's bounds are those of a bar
            for j in range(rows):
                for i in range(columns):
                    x = LENGTH[0] + (LENGTH[1] - LENGTH[0]) * i / CELLS[0]
                    y = HEIGHT[0] + (HEIGHT[1] - HEIGHT[0]) * j / CELLS[1]
                    file.write(f"v {x:.9g} {y:.9g} {z:.9g}\n")
        for j in range(CELLS[1]):
            for i in range(CELLS[0]):
                first = j * columns + i + 1
                file.write(f"f {first} {first + 1} {first + columns + 1} {first + columns}\n")


def read_obj(path):
    points, faces = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words[0] == "v":
                points.append((float(words[1]), -float(words[2])))
            else:
                faces.append([int(word) - 1 for word in words[1:]])
    return points[: len(points) // 2], faces


def write_svg(path, points, faces):
    lo = [min(point[a] for point in points) for a in range(2)]
    hi = [max(point[a] for point in points) for a in range(2)]
    scale = (PIXELS - 20) / max(hi[a] - lo[a] for a in range(2))
    place = [tuple(round(10 + (point[a] - lo[a]) * scale, 1) for a in range(2)) for point in points]
    size = [round(20 + (hi[a] - lo[a]) * scale) for a in range(2)]
    with open(path, "w", encoding="ascii") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}">\n')
        file.write('<rect width="100%" height="100%" fill="white"/>\n')
        file.write('<g style="fill:#4878b0; fill-opacity:0.4; stroke:#1c3350; stroke-width:0.5">\n')
        for face in faces:
            corners = " ".join(f"{place[i][0]},{place[i][1]}" for i in face)
            file.write(f'<polygon points="{corners}"/>\n')
        file.write("</g>\n</svg>\n")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: make_overlap.py FFD [PICTURE]")
    data = os.path.dirname(os.path.abspath(__file__))
    picture = sys.argv[2] if len(sys.argv) == 3 else os.path.join(data, "overlap.svg")
    with tempfile.TemporaryDirectory() as folder:
        before, after = os.path.join(folder, "strip.obj"), os.path.join(folder, "bent.obj")
        write_strip(before)
        subprocess.run([sys.argv[1], "deform", before, after, "-l", os.path.join(data, "lattices", "overlap.json"),
                        "--quiet"], check=True)
        write_svg(picture, *read_obj(after))


main()
