#!/usr/bin/env python3
"""Pages of real models beside three.js, with one camera and the page's lights: the mean colours of blocks of 8x8 pixels and the
silhouettes agree. White materials without a texture, which a page darkens, are left out of the choice.

    test_looks.py FFD

FFD_MODELS names the folder of the models, FFD_NODE the folder whose node_modules holds playwright-core and three.
"""

import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile

from browser import HERE, find_browser, skip

MODELS = ("Knight.glb", "Fox.glb", "TextureTransformMultiTest.glb", "MultiUVTest.glb", "UnlitTest.glb", "VertexColorTest.glb",
          "ClearCoatTest.glb", "AnimatedMorphCube.glb", "RiggedFigure.glb", "TransmissionTest.glb",
          "BoxVertexColors/glTF/BoxVertexColors.gltf", "TextureEncodingTest/glTF/TextureEncodingTest.gltf")
MOST_DIFFERENCE, LEAST_AGREEMENT = 0.12, 0.99


def look_at(ffd, models, files, folder, shots=None):
    """[file, difference of the colours, agreement of the silhouettes] of each, whose name is looked for in the folder of the
    models; a .gltf comes with the folder that it is in. shots: folder for pictures of both, or None."""
    found = find_browser()
    if not os.path.isdir(os.path.join(found[0], "node_modules", "three")):
        skip("three is not installed (tests/run.sh installs it)")
    for name in files:
        (path, *_) = sorted(glob.glob(os.path.join(models, "**", name), recursive=True))
        if "/" in name or name.endswith(".gltf"):
            shutil.copytree(os.path.dirname(path), os.path.join(folder, os.path.dirname(name)), dirs_exist_ok=True)
        else:
            shutil.copy(path, folder)
        subprocess.run([ffd, "view", name, "-o", name + ".html", "--color", "plain", "-q"], cwd=folder, check=True)
    env = {**os.environ, "HOME": folder, **({"FFD_SCREENSHOTS": shots} if shots else {})}
    done = subprocess.run(["node", os.path.join(HERE, "looks.mjs"), *found, folder, *files], check=True, stdout=subprocess.PIPE, text=True, env=env,
                          timeout=380 if not shots else None)
    return [json.loads(line) for line in done.stdout.splitlines()]


def main():
    ffd, models = os.path.abspath(sys.argv[1]), os.environ.get("FFD_MODELS", "")
    if not os.path.isdir(models):
        skip("FFD_MODELS does not name a folder")
    with tempfile.TemporaryDirectory() as folder:
        looks = look_at(ffd, models, MODELS, folder)
    failed = 0
    for name, difference, agreement in looks:
        is_wrong = difference is None or difference > MOST_DIFFERENCE or agreement < LEAST_AGREEMENT
        failed += is_wrong
        print(f"{'FAILED' if is_wrong else 'passed'}  {name}: blocks differ by {difference}, silhouettes agree to {agreement}")
    if len(looks) != len(MODELS) or failed:
        sys.exit(1)


if __name__ == "__main__":
    main()
