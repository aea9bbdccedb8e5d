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

from validate import INVALID, UNSUPPORTED, deform, find_packages, model_roots, models, validate

OTHERS = (".obj", ".ply", ".off", ".stl")
EMBEDDING = 5


def conversions(folder, root, number):
    """(source, target) pairs, each target in a folder of its own."""
    for model in models(root, (".gltf", ".glb")):
        for ending in OTHERS:
            base = os.path.join(folder, str(number), model + ending)
            yield os.path.join(root, model), base + ending
            yield base + ending, base + ".glb"
    for model in models(root, OTHERS):
        for ending in (".glb", ".gltf"):
            yield os.path.join(root, model), os.path.join(folder, str(number), model + ending)


def main():
    ffd, = sys.argv[1:]
    node_folder = find_packages("gltf-validator")
    written, failed, refused = [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        for number, root in enumerate(model_roots()):
            for source, target in conversions(folder, root, number):
                if not os.path.exists(source):  # it was refused
                    continue
                os.makedirs(os.path.dirname(target), exist_ok=True)
                code, message = deform(ffd, "twist", source, target)
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
