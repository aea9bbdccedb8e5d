#!/usr/bin/env python3
"""The previews of lattices that `ffd lattice convert` writes as .glb, of random and of extreme lattices, before the Khronos glTF
validator: it finds nothing, of any severity.

    previews.py FFD

FFD_NODE names the folder whose node_modules holds gltf-validator; the seed is printed, FFD_SEED repeats a run."""

import json
import os
import random
import subprocess
import sys
import tempfile

from validate import answers, find_packages

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)


def random_lattice():
    degree = [RANDOM.randint(1, 4) for _ in range(3)]
    size = [p + 1 + RANDOM.randint(1, 3) for p in degree]
    count, far = size[0] * size[1] * size[2], RANDOM.choice([1, 1e-30, 1e30])
    content = {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "moves": [], "knots": [RANDOM.choice(["clamped", "open", "closed"]) for _ in size],
               "rest": {"points": [[far * RANDOM.uniform(-1, 1) for _ in range(3)] for _ in range(count)]}}
    if RANDOM.random() < 0.7:
        content["deformed"] = {"offsets": [[far * RANDOM.uniform(-1, 1) for _ in range(3)] for _ in range(count)]}
    if RANDOM.random() < 0.5:
        content["weights"] = [RANDOM.uniform(0.5, 2) for _ in range(count)]
    return content


def others():
    """All points in one place, and many of them: indices of 16 bits do not suffice."""
    still = {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "degree": [1, 1, 1], "moves": [], "rest": {"points": [[1.0, 2.0, 3.0]] * 8}}
    many = {"format": "ffd-lattice", "version": 1, "size": [42, 42, 42], "moves": [{"at": [1, 1, 1], "by": [1, 0, 0]}], "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}
    tube = {"format": "ffd-lattice", "version": 1, "size": [3, 6, 3], "degree": [2, 3, 2], "knots": ["clamped", "closed", "clamped"], "moves": [],
            "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}}
    return [still, many, tube]


def main():
    ffd, = sys.argv[1:]
    node_folder = find_packages("gltf-validator")
    print(f"seed {SEED} (FFD_SEED)")
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for number, content in enumerate(others() + [random_lattice() for _ in range(20)]):
            source, target = (os.path.join(folder, f"{number}{ending}") for ending in (".json", ".glb"))
            with open(source, "w", encoding="utf-8") as file:
                json.dump(content, file)
            subprocess.run([ffd, "lattice", "convert", source, "-o", target], check=True)
            paths.append(target)
        found = [json.loads(line) for line in answers(node_folder, paths)]
        wrong = [one for one in found if one.get("failed") or one["codes"]]
    for one in wrong:
        print(one)
    print(f"{len(found)} previews validated, {len(wrong)} failed")
    sys.exit(1 if wrong or len(found) != len(paths) else 0)


main()
