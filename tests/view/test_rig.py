#!/usr/bin/env python3
"""What a page's own scripts make of animations: the places of vertices before and after, normals and joints against
closed forms of an arm, in each interpolation.

    test_rig.py FFD SCRIPTS
"""

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
from gltf_arm import arm  # noqa: E402 (a neighbour of this folder)

SKIPPED = 77
SHARES = (0, 0.25, 0.5, 0.8, 1)
WIDER = {"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "rest": {"box": {"min": [-3, -3, -3], "max": [3, 3, 3]}},
         "moves": [{"scale": {"factor": [1, 2, 1], "about": [0, 0, 0]}}]}
PLACES = [(x, y) for x in (0, 1, 1.01, 2) for y in (-0.1, 0.1)]


def smooth(u):
    return 3 * u * u - 2 * u ** 3


def angle(u, interpolation):
    if interpolation == "STEP":
        return math.pi / 2 if u == 1 else 0
    if interpolation == "CUBICSPLINE":
        return 2 * math.atan2(smooth(u) * 0.5 ** 0.5, 1 - smooth(u) + smooth(u) * 0.5 ** 0.5)
    return u * math.pi / 2


def lift(u, interpolation):
    if interpolation == "STEP":
        return 3 if u == 1 else 0
    if interpolation == "CUBICSPLINE":
        return 3 * smooth(u) + 2 * (u ** 3 - 2 * u * u + u) - 4 * (u ** 3 - u * u)
    return 3 * u


def turned(place, a):
    x, y = place[0] - 1, place[1]
    return (1 + math.cos(a) * x - math.sin(a) * y, math.sin(a) * x + math.cos(a) * y, 0)


def expected(name, share, wider, interpolation):
    """The arm's vertices; the lower half is the last four."""
    places = [(x, wider * y) for x, y in PLACES]
    if name != "turn":
        return [(x, y, lift(share, interpolation)) for x, y in places]
    return [(x, y, 0) if i < 4 else turned((x, y), angle(share, interpolation)) for i, (x, y) in enumerate(places)]


def far(found, there):
    return max(math.dist(p, q) for p, q in zip(found, there, strict=True))


def check_page(folder, ffd, scripts, interpolation):
    failed = []
    with open(os.path.join(folder, "a.gltf"), "w", encoding="utf-8") as file:
        json.dump(arm(interpolation=interpolation), file)
    subprocess.run([ffd, "view", "a.gltf", "-l", "l.json", "-o", "p.html", "--force", "-q"], cwd=folder, check=True)
    done = subprocess.run(["node", os.path.join(HERE, "rig.mjs"), scripts, os.path.join(folder, "p.html"), *map(str, SHARES)],
                          capture_output=True, text=True, check=True)
    for name, time, before, after, normals, joints in json.loads(done.stdout):
        share = time / 2
        # At rest positions have 16 bits.
        tolerance = 1e-6 if name != "rest" else 1e-4
        for side, points, wider in (("before", before, 1), ("after", after, 2)):
            off = far(points, expected(name, share, wider, interpolation) if name != "rest" else
                      [(x, wider * y, 0) for x, y in PLACES])
            if not off <= tolerance:
                failed.append(f"{interpolation} {name} at {time}, {side}: {off} off")
        if normals and far([n for _, n in normals], [(0, 0, 1)] * len(normals)) > 1e-4:
            failed.append(f"{interpolation} {name} at {time}: normals {normals}")
        if joints and far(joints, [(x, 0, expected(name, share, 1, interpolation)[0][2]) for x in (0, 1)]) > 1e-6:
            failed.append(f"{interpolation} {name} at {time}: joints {joints}")
    return failed


def main():
    ffd, scripts = [os.path.abspath(path) for path in sys.argv[1:]]
    if not shutil.which("node"):
        print("SKIP: node is not there")
        sys.exit(SKIPPED)
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "l.json"), "w", encoding="utf-8") as file:
            json.dump(WIDER, file)
        for interpolation in ("LINEAR", "STEP", "CUBICSPLINE"):
            failed += check_page(folder, ffd, scripts, interpolation)
    print(*failed, f"{len(failed)} differences", sep="\n")
    sys.exit(1 if failed else 0)


main()
