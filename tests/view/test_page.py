#!/usr/bin/env python3
"""Pages of ffd view in Chromium, opened as files: the slider, colours, parts, marks, names, sizes of windows, and that
nothing is asked of a network. Those of `made` are made by hand, with what a page may have at the most; those of `real` by
the program, of a lattice that folds, of one that tears, and of names that are markup. `firefox`: five of these in Firefox.

    test_page.py FFD MAKE_PAGE MODEL.obj made|real|firefox

FFD_NODE names the folder whose node_modules holds playwright-core. FFD_SCREENSHOTS names a folder for pictures to be
looked at.
"""

import base64
import contextlib
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile

from browser import Screen, find_browser, run_script

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from gltf_arm import arm, face  # noqa: E402 (a neighbour of this folder)
from png_make import make_png  # noqa: E402

KINDS = ("torn", "fold", "hostile", "large", "empty")
# Control points of a real mesh: two that turn its middle inside out; one at the border of a box that ends in the mesh.
FOLD = {"size": [4, 4, 4], "rest": {"box": "mesh"},
        "moves": [{"at": [1, 1, 1], "by": [0, 0, 14]}, {"at": [2, 1, 1], "by": [0, 0, 14]}]}
TEAR = {"size": [3, 3, 3], "rest": {"box": {"min": [-1, -0.5, -1], "max": [0.1, 1.5, 2]}},
        "moves": [{"at": [2, 1, 1], "by": [-0.5, 0.9, 0]}]}
# One that moves nothing, very far away.
FAR = {"size": [5, 2, 2], "degree": [1, 1, 1], "rest": {"box": {"min": [-2, -2, -2], "max": [2, 2, 2]}},
       "moves": [{"at": [4, 1, 1], "by": [0, 1e4, 0]}]}
# An arm that becomes twice as wide.
WIDE = {"size": [3, 3, 3], "rest": {"box": {"min": [-3, -3, -3], "max": [3, 3, 3]}},
        "moves": [{"scale": {"factor": [1, 2, 1], "about": [0, 0, 0]}}]}
NAMES = ["</script><script>document.title='taken'</script>", "<img src=x onerror=alert(1)>", "\u202egpj.exe\n\"'&amp;",
         "__proto__", "x" * 100000]


def hostile_gltf():
    """A triangle for each name, which is its node's, its mesh's and its material's."""
    corners = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
    count = range(len(NAMES))
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(count)}],
            "nodes": [{"name": NAMES[i], "mesh": i, "translation": [i, 0, 0]} for i in count],
            "meshes": [{"name": NAMES[i], "primitives": [{"attributes": {"POSITION": 0}, "material": i}]} for i in count],
            "materials": [{"name": name} for name in NAMES],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0] * 3, "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + corners}]}


def looks_gltf():
    """Unit squares from left to right, with their materials: a texture of four colours; one of the right half alone; one
    that emits, of which the texture has other coordinates; one without light; and glass in front of red."""
    red, green, blue, yellow, grey = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (128, 128, 128)
    four = make_png([[red] * 32 + [green] * 32] * 32 + [[blue] * 32 + [yellow] * 32] * 32)
    halves = make_png([[grey] * 32 + [green] * 32] * 64)
    squares = [(0, 0), (1.2, 0), (2.4, 0), (3.6, 0), (4.8, 0), (4.8, -0.5)]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    places = [(x + dx, dy, z) for x, z in squares for dx, dy in corners]
    texcoords = [(dx, 1 - dy) for _ in squares for dx, dy in corners]
    data = b"".join(struct.pack("<3f", *place) for place in places) + b"".join(struct.pack("<2f", *uv) for uv in texcoords)
    indices = struct.pack("<6B2x", 0, 1, 2, 0, 2, 3)
    whole = data + indices + four + bytes(-len(four) % 4) + halves
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * len(places)},
             {"buffer": 0, "byteOffset": 12 * len(places), "byteLength": 8 * len(places)},
             {"buffer": 0, "byteOffset": len(data), "byteLength": 6},
             {"buffer": 0, "byteOffset": len(data) + 8, "byteLength": len(four)},
             {"buffer": 0, "byteOffset": len(data) + 8 + len(four) + -len(four) % 4, "byteLength": len(halves)}]
    accessors = [{"bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR"}]
    meshes = []
    for i in range(len(squares)):
        own = places[4 * i:4 * i + 4]
        accessors += [{"bufferView": 0, "byteOffset": 48 * i, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [min(p[a] for p in own) for a in range(3)], "max": [max(p[a] for p in own) for a in range(3)]},
                      {"bufferView": 1, "byteOffset": 32 * i, "componentType": 5126, "count": 4, "type": "VEC2"}]
        meshes.append({"primitives": [{"attributes": {"POSITION": 2 * i + 1, "TEXCOORD_0": 2 * i + 2}, "indices": 0, "material": i}]})
    right = {"KHR_texture_transform": {"offset": [0.5, 0], "scale": [0.5, 1]}}
    materials = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
                 {"pbrMetallicRoughness": {"baseColorTexture": {"index": 1, "extensions": right}}},
                 {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                  "emissiveTexture": {"index": 1, "extensions": right}},
                 {"pbrMetallicRoughness": {"baseColorFactor": [0, 0.2, 0.9, 1]}, "extensions": {"KHR_materials_unlit": {}}},
                 {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 0.3]}, "alphaMode": "BLEND"},
                 {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]
    return {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_texture_transform", "KHR_materials_unlit"], "scene": 0,
            "scenes": [{"nodes": list(range(len(meshes)))}], "nodes": [{"mesh": i} for i in range(len(meshes))], "meshes": meshes,
            "materials": materials, "textures": [{"source": 0}, {"source": 1}],
            "images": [{"bufferView": 3, "mimeType": "image/png"}, {"bufferView": 4, "mimeType": "image/png"}],
            "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(whole), "uri": "data:application/octet-stream;base64," + base64.b64encode(whole).decode()}]}


def splats_ply():
    """Long ellipsoids, a red one before a blue one; small green ones at the corners of 4 x 3."""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
    rows = [((0, 0, 0.2), (1, 0, 0), (0.8, 0.2, 0.05)), ((0, 0, -0.2), (0, 0, 1), (0.8, 0.2, 0.05)),
            *(((x, y, 0), (0, 1, 0), (0.02, 0.02, 0.02)) for x in (-2, 2) for y in (-1.5, 1.5))]
    head = f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\n" + "".join(f"property float {name}\n" for name in names) + "end_header\n"
    lines = [(*place, *((c - 0.5) / 0.28209479177387814 for c in color), 3, *map(math.log, size), 1, 0, 0, 0) for place, color, size in rows]
    return head + "".join(" ".join(map(repr, line)) + "\n" for line in lines)


def make_real(ffd, model, folder):
    """Pages as users make them."""
    def write(name, content):
        path = os.path.join(folder, name)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)
        return path

    hostile = write("<img src=x onerror=alert(2)>\n\u202e&amp;.gltf", hostile_gltf())
    shutil.copy(model, os.path.join(folder, "a.obj"))
    # One triangle that cannot be drawn.
    shutil.copy(model, os.path.join(folder, "fold.obj"))
    with open(os.path.join(folder, "fold.obj"), "a", encoding="ascii") as file:
        file.write("\nv nan 0 0\nf 1 2 -1\n")
    for name, height in (("low.obj", 1), ("high.obj", 2)):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(f"v 0 0 0\nv 1 0 0\nv 0 {height} 0\nf 1 2 3\n")
    subprocess.run([ffd, "view", "low.obj", "high.obj", "--color", "det", "-o", "real_pair.html", "-q"], cwd=folder, check=True)
    subprocess.run([ffd, "view", "high.obj", "-o", "real_alone.html", "-q"], cwd=folder, check=True)
    body = [(x * 0.5, y + 0.25 * x, z * (1 + y / 4)) for x in (0, 1) for y in (0, 3) for z in (0, 2)]
    for name, turn in (("y.obj", lambda x, y, z: (x, y, z)), ("z.obj", lambda x, y, z: (x, -z, y))):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write("".join("v {} {} {}\n".format(*turn(*point)) for point in body) +
                       "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
    for page, mesh, up in (("real_upright", "y.obj", "y"), ("real_turned", "z.obj", "z"), ("real_lying", "z.obj", "y")):
        subprocess.run([ffd, "view", mesh, "--up", up, "-o", page + ".html", "-q"], cwd=folder, check=True)
    write("looks.gltf", looks_gltf())
    up = write("up.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "degree": [1, 1, 1],
                           "rest": {"box": {"min": [-1, -1, -1], "max": [7, 2, 1]}}, "moves": [{"at": ["all", "all", "all"], "by": [0, 0.25, 0]}]})
    subprocess.run([ffd, "view", "looks.gltf", "-l", os.path.basename(up), "--camera", "front", "-o", "real_looks.html", "-q"],
                   cwd=folder, check=True)
    write("arm.gltf", arm(names=("turn", "</script><img src=x onerror=alert(4)>\n\u202e")))
    wide = write("wide.json", {"format": "ffd-lattice", "version": 1, **WIDE})
    subprocess.run([ffd, "view", "arm.gltf", "-l", wide, "--animation", "turn", "-o", "real_arm.html", "-q"], cwd=folder, check=True)
    with open(os.path.join(folder, "splats.ply"), "w", encoding="ascii") as file:
        file.write(splats_ply())
    tall = write("tall.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "degree": [1, 1, 1],
                               "rest": {"box": {"min": [-5, -5, -5], "max": [5, 5, 5]}}, "moves": [{"scale": {"factor": [1, 3, 1], "about": [0, 0, 0]}}]})
    subprocess.run([ffd, "view", "splats.ply", "-l", tall, "--camera", "front", "--no-cage", "-o", "real_splats.html", "-q"], cwd=folder, check=True)
    write("face.gltf", face(("up", "</script><img src=x onerror=alert(5)>\n\u202e"), [[0.5, 0], [0]]))
    subprocess.run([ffd, "view", "face.gltf", "-l", wide, "--color", "plain", "-o", "real_face.html", "-q"], cwd=folder, check=True)
    subprocess.run([ffd, "view", "face.gltf", "--morph", f"'<img src=x onerror=alert(6)>'={os.path.basename(wide)}", "-o", "real_morph.html", "-q"],
                   cwd=folder, check=True)
    for kind, mesh, moves in (("far", "high.obj", FAR), ("fold", "fold.obj", FOLD), ("tear", "a.obj", TEAR), ("hostile", os.path.basename(hostile), FOLD)):
        lattice = write("<b>cage.json" if kind == "hostile" else kind + ".json",
                        {"format": "ffd-lattice", "version": 1, **moves})
        subprocess.run([ffd, "view", mesh, "-l", os.path.basename(lattice), "-o", f"real_{kind}.html", "-q"], cwd=folder,
                       check=True)


def make_by_hand(make_page, model, folder):
    for kind in KINDS:
        words = [make_page, kind, os.path.join(folder, kind + ".html")]
        subprocess.run(words + ([model] if kind in ("torn", "fold") else []), check=True, stdout=subprocess.DEVNULL)


def main():
    ffd, make_page, model = [os.path.abspath(path) for path in sys.argv[1:4]]
    origin = sys.argv[4]
    found = find_browser(*(("firefox-esr", "firefox") if origin == "firefox" else ()))
    with tempfile.TemporaryDirectory() as folder:
        if origin == "made":
            make_by_hand(make_page, model, folder)
        else:
            make_real(ffd, model, folder)
        with Screen() if origin == "firefox" else contextlib.nullcontext():
            code = run_script("page.mjs", found, folder, folder, 140, origin)
    sys.exit(code)


main()
