#!/usr/bin/env python3
"""Makes a picture to be looked at: the pages and pictures of thirty models beside three.js, on one camera, with the figures of
test_looks.py. Run it by hand.

    sheet.py FFD OUT.png [FILE...]

FFD_MODELS names the folder of the models, FFD_NODE the folder whose node_modules holds playwright-core and three. FILE: other
models than these, names below that folder.
"""

import html
import os
import subprocess
import sys
import tempfile

from browser import HERE, find_browser
from test_looks import MODELS, look_at

KHRONOS = ("Suzanne", "ToyCar", "GlamVelvetSofa", "SheenCloth", "TwoSidedPlane", "MorphPrimitivesTest",
           "MeshPrimitiveModes", "Box With Spaces")
MORE = (*(f"{name}/glTF/{name}.gltf" for name in KHRONOS), "kenney/coin.glb", "kenney/character.glb", "kenney/flag.glb", "alien.glb", "banner_red.gltf.glb",
        "IridescenceSuzanne.glb", "MetalRoughSpheresNoTextures.glb", "AnimatedMorphSphere.glb", "ShapeCollection.glb", "NormalTangentTest.glb")
CELL = (400, 300)


def picture_of(ffd, name, folder, shots):
    target = os.path.join(shots, name.replace("/", "-") + ".picture.png")
    subprocess.run([ffd, "view", name, "-o", target, "--color", "plain", "--size", f"{2 * CELL[0]}x{2 * CELL[1]}", "-q"], cwd=folder, check=True)


def sheet(looks):
    """A page of rows: page, three.js, picture."""
    rows = []
    for name, difference, agreement in looks:
        cells = "".join(f'<img src="{html.escape(name.replace("/", "-"))}.{kind}.png">' for kind in ("page", "three", "picture"))
        colours = "no common block" if difference is None else f"{difference:.3f}"
        rows.append(f"<div>{cells}<p>{html.escape(name.split('/')[-1])}: colours {colours}, silhouettes {agreement:.4f}</p></div>")
    width, height = CELL
    return (f"<style>body {{ display: grid; grid-template-columns: repeat(2, {3 * width}px); gap: 4px; margin: 0; font: 15px sans-serif; background: #dde }}"
            f"img {{ width: {width - 2}px; height: {height}px; object-fit: contain; margin: 1px; vertical-align: top }} p {{ margin: 0 6px 4px }}</style>"
            + "".join(rows))


def main():
    ffd, out = (os.path.abspath(path) for path in sys.argv[1:3])
    files = sys.argv[3:] or [*MODELS, *MORE]
    with tempfile.TemporaryDirectory() as folder:
        shots = os.path.join(folder, "shots")
        os.mkdir(shots)
        looks = look_at(ffd, os.environ["FFD_MODELS"], files, folder, shots)
        for name in files:
            picture_of(ffd, name, folder, shots)
        page = os.path.join(shots, "sheet.html")
        with open(page, "w", encoding="utf-8") as file:
            file.write(sheet(looks))
        subprocess.run(["node", os.path.join(HERE, "shoot.mjs"), *find_browser(), folder, page, out], check=True,
                       env={**os.environ, "HOME": folder})
    for name, difference, agreement in looks:
        print(f"{name}: blocks differ by {difference}, silhouettes agree to {agreement}")


main()
