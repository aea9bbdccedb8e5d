#!/usr/bin/env python3
"""Draws data/pictures/greville.svg anew from what ffd info says: python3 data/make_greville.py FFD [PICTURE]

Where the layers of seven control points stand along one side of a box, with clamped and with open knots."""

import json
import os
import subprocess
import sys
import tempfile

KNOTS = ("clamped", "open")
SIZE = 7
LEFT, WIDTH, HEIGHT = 220, 360, 84  # of a box in pixels; height of a row


def layers(ffd, folder, knots):
    path = os.path.join(folder, "lattice.json")
    with open(path, "w", encoding="ascii") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [SIZE, 4, 4], "knots": [knots] * 3,
                   "rest": {"box": "mesh"}}, file)
    said = subprocess.run([ffd, "info", path, "--json"], check=True, stdout=subprocess.PIPE).stdout
    return json.loads(said)["layer_fractions"]["u"]


def row(title, number, fractions):
    top = 10 + number * HEIGHT
    middle = top + 32
    yield f'<text x="10" y="{middle + 5}">{title}</text>'
    yield f'<rect x="{LEFT}" y="{top}" width="{WIDTH}" height="64" fill="#dbe6f4" stroke="#8aa4c8"/>'
    places = [round(LEFT + WIDTH * fraction, 1) for fraction in fractions]
    yield f'<path d="M{places[0]} {middle}H{places[-1]}" stroke="#2255cc"/>'
    for k, x in enumerate(places):
        yield f'<circle cx="{x}" cy="{middle}" r="5" fill="#2255cc"/>'
        yield f'<text x="{x}" y="{middle - 11}" text-anchor="middle">{k}</text>'


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: make_greville.py FFD [PICTURE]")
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pictures", "greville.svg")
    with tempfile.TemporaryDirectory() as folder:
        rows = [line for number, knots in enumerate(KNOTS)
                for line in row(f"{knots} knots", number, layers(sys.argv[1], folder, knots))]
    width, height = LEFT + WIDTH + 110, 10 + HEIGHT * len(KNOTS)
    with open(sys.argv[2] if len(sys.argv) == 3 else default, "w", encoding="ascii") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                   'font-family="sans-serif" font-size="14">\n')
        file.write('<rect width="100%" height="100%" fill="white"/>\n')
        file.write("\n".join(rows) + "\n</svg>\n")


if __name__ == "__main__":
    main()
