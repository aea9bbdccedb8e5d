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

MODELS = ("Knight", "Fox", "TextureTransformMultiTest", "MultiUVTest", "UnlitTest", "VertexColorTest",
          "ClearCoatTest", "AnimatedMorphCube", "RiggedFigure", "TransmissionTest")
MOST_DIFFERENCE, LEAST_AGREEMENT = 0.12, 0.99


def main():
    ffd, models = os.path.abspath(sys.argv[1]), os.environ.get("FFD_MODELS", "")
    if not os.path.isdir(models):
        skip("FFD_MODELS does not name a folder")
    found = find_browser()
    if not os.path.isdir(os.path.join(found[0], "node_modules", "three")):
        skip("three is not installed (tests/run.sh installs it)")
    with tempfile.TemporaryDirectory() as folder:
        for name in MODELS:
            (path, *_) = sorted(glob.glob(os.path.join(models, "**", name + ".glb"), recursive=True))
            shutil.copy(path, folder)
            subprocess.run([ffd, "view", name + ".glb", "-o", name + ".html", "-q"], cwd=folder, check=True)
        done = subprocess.run(["node", os.path.join(HERE, "looks.mjs"), *found, folder, *MODELS], check=True, capture_output=True, text=True,
                              env={**os.environ, "HOME": folder}, timeout=380)
    failed = 0
    for name, difference, agreement in map(json.loads, done.stdout.splitlines()):
        is_wrong = difference is None or difference > MOST_DIFFERENCE or agreement < LEAST_AGREEMENT
        failed += is_wrong
        print(f"{'FAILED' if is_wrong else 'passed'}  {name}: blocks differ by {difference}, silhouettes agree to {agreement}")
    if done.stdout.count("\n") != len(MODELS) or failed:
        sys.exit(1)


main()
