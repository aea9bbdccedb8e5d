#!/usr/bin/env python3
"""Converts every OBJ, PLY, OFF and STL model of FFD_MODELS and of data/models to GLB and .gltf, and every glTF to the
other formats and back, and holds all that is glTF against the Khronos glTF validator: it has no error. A model that is
not valid, or needs what this build does not have, is refused with exit 4 or 6; every other end is a failure.

    convert.py FFD

FFD_NODE names the folder whose node_modules holds gltf-validator.
"""

import os
import sys
import tempfile

from jobs import deform_all
from validate import INVALID, UNSUPPORTED, find_packages, job, model_roots, models, validate

OTHERS = (".obj", ".ply", ".off", ".stl")
EMBEDDING = 5


def conversions(folder):
    """(source, target) pairs, each target in a folder of its own: those that begin with a model, and those that go on
    with what these have made."""
    first, then = [], []
    for number, root in enumerate(model_roots()):
        for model in models(root, (".gltf", ".glb")):
            for ending in OTHERS:
                base = os.path.join(folder, str(number), model + ending)
                first.append((os.path.join(root, model), base + ending))
                then.append((base + ending, base + ".glb"))
        for model in models(root, OTHERS):
            for ending in (".glb", ".gltf"):
                first.append((os.path.join(root, model), os.path.join(folder, str(number), model + ending)))
    return first, then


def main():
    ffd, = sys.argv[1:]
    node_folder = find_packages("gltf-validator")
    written, failed, refused = [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        for pairs in conversions(folder):
            pairs = [(source, target) for source, target in pairs if os.path.exists(source)]  # else it was refused
            ended = deform_all(ffd, folder, [job("twist", source, target) for source, target in pairs])
            for (source, target), (code, message) in zip(pairs, ended):
                refused += code in (INVALID, EMBEDDING, UNSUPPORTED)
                if code == 0:
                    written.append(target)
                elif code not in (INVALID, EMBEDDING, UNSUPPORTED) or os.path.exists(target):
                    failed.append(f"{source}: exit {code}: {message}")
        found = validate(node_folder, [path for path in written if path.endswith((".glb", ".gltf"))])
        for path, errors in found.items():
            if errors:
                failed.append(f"{os.path.relpath(path, folder)}: {errors if isinstance(errors, str) else errors[:3]}")
    for line in failed:
        print(line)
    print(f"{len(written)} files converted, {refused} refused, {len(found)} validated, {len(failed)} failed")
    sys.exit(1 if failed or not found else 0)


main()
