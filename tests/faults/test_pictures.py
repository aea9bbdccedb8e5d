#!/usr/bin/env python3
"""What pictures left out or coloured otherwise than other viewers do (wild3-*, artist-*). Each case draws small models and looks
at pixels.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_pictures.py wild3_02_glass_is_seen
"""

import base64
import json
import math
import struct

from harness import case, check, equal, lattice, main
from messages import anything, one_line
from png import read_png
from png_make import make_png

SIDE = 64
LIFT = lattice(moves=[{"at": ["all", "all", 1], "by": [0, 0.5, 0]}], size=[2, 2, 2])
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def drawn(run, *arguments, command="view", color="plain"):
    """The rows of a picture, from the front."""
    out = ["--picture", "p.png"] if command == "check" else ["-o", "p.png", "--size", f"{SIDE}x{SIDE}", "--color", color]
    run.ffd(command, *arguments, *out, "--camera", "front", "--force", err=anything)
    return read_png(run.read("p.png"))


def middle(run, *arguments, **options):
    return drawn(run, *arguments, **options)[SIDE // 2][SIDE // 2]


def light(byte):
    x = byte / 255
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4


def is_color(found, wanted, what, tolerance=3):
    """wanted: linear light"""
    for a, b in zip(found, wanted):
        byte = 255 * (12.92 * b if b <= 0.0031308 else 1.055 * b ** (1 / 2.4) - 0.055)
        check(abs(a - byte) <= tolerance, f"{what}: {found}, not {wanted}")


def mixed(over, under, alpha):
    return [alpha * a + (1 - alpha) * light(b) for a, b in zip(over, under)]


def obj(run, name, statements):
    run.write(name + ".mtl", "newmtl m\n" + statements)
    run.write(name + ".obj", f"mtllib {name}.mtl\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) +
              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n")


def gltf(run, name, material, attributes=(), images=(), mode=4, extensions=None, points=None):
    """A square, or points, with a material. attributes: (name, rows of floats)"""
    points = points or CORNERS
    indices = [0, 1, 2, 0, 2, 3] if mode == 4 else list(range(len(points)))
    data, views, accessors = b"", [], []
    kinds = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
    for rows in [points, *(rows for _, rows in attributes)]:
        packed = b"".join(struct.pack("<" + "f" * len(row), *row) for row in rows)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(rows), "type": kinds[len(rows[0])]})
        data += packed
    accessors[0] |= {"min": [min(p[a] for p in points) for a in range(3)], "max": [max(p[a] for p in points) for a in range(3)]}
    packed = struct.pack("<" + "H" * len(indices), *indices)
    views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
    accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"})
    data += packed
    primitive = {"attributes": {"POSITION": 0, **{key: i + 1 for i, (key, _) in enumerate(attributes)}}, "mode": mode,
                 "indices": len(accessors) - 1, "material": 0}
    asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "meshes": [{"primitives": [primitive]}], "materials": [material], "accessors": accessors, "bufferViews": views,
             "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    if images:
        asset |= {"images": [{"uri": "data:image/png;base64," + base64.b64encode(image).decode()} for image in images],
                  "textures": [{"source": i} for i in range(len(images))]}
    used = sorted(set(material.get("extensions", {})) | {key for value in material.values() if isinstance(value, dict)
                                                        for key in value.get("extensions", {})})
    if extensions:
        primitive["extensions"] = extensions
        used += list(extensions)
    if used:
        asset["extensionsUsed"] = used
    run.write(name + ".gltf", json.dumps(asset))


@case
def wild3_02_glass_is_seen(run):
    """A pane of glass lets the background through; coloured by displacement it is solid."""
    run.write("l.json", LIFT)
    blue = [0, 0, 1, 0.3]
    clear = make_png([[(255, 255, 255, 76)] * 4] * 4)
    grey = make_png([[(76, 76, 76)] * 4] * 4)
    texcoords = ("TEXCOORD_0", [(0, 1), (1, 1), (1, 0), (0, 0)])
    unlit = {"KHR_materials_unlit": {}}
    run.write("clear.png", clear)
    run.write("grey.png", grey)
    gltf(run, "factor", {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": blue}, "extensions": unlit})
    gltf(run, "texture", {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1], "baseColorTexture": {"index": 0}},
                          "extensions": unlit}, [texcoords], [clear])
    gltf(run, "vertices", {"alphaMode": "BLEND", "extensions": unlit}, [("COLOR_0", [blue] * 4)])
    for name in ("factor", "texture", "vertices"):
        rows = drawn(run, name + ".gltf")
        is_color(rows[SIDE // 2][SIDE // 2], mixed([0, 0, 1], rows[SIDE // 2][0], 76 / 255), name)
    for name, statements in (("d", "d 0.3\n"), ("tr", "Tr 0.7\n"), ("mapd", "map_d grey.png\n"), ("alpha", "map_Kd clear.png\nmap_d clear.png\n")):
        obj(run, name, "Kd 0 0 1\n" + statements)
        obj(run, "none", "Kd 0 0 1\nd 0\n")
        obj(run, "solid", "Kd 0 0 1\n")
        glass, none, solid = (drawn(run, each + ".obj") for each in (name, "none", "solid"))
        check(glass != none and glass != solid, name, "is not seen, or solid")
        is_color(glass[SIDE // 2][SIDE // 2],
                 [0.3 * light(a) + 0.7 * light(b) for a, b in zip(solid[SIDE // 2][SIDE // 2], none[SIDE // 2][SIDE // 2])], name)
        for color in ("displacement", "status", "det"):
            halves = [[row[SIDE // 2 + 2:] for row in drawn(run, each + ".obj", "-l", "l.json", color=color)] for each in (name, "solid")]
            check(halves[0] == halves[1], name, color, "is not solid")
        check(drawn(run, name + ".obj", "-l", "l.json", command="check") != drawn(run, "none.obj", "-l", "l.json", command="check"), name)
        check(drawn(run, name + ".obj", "-l", "l.json", "--frames", "3") != drawn(run, "none.obj", "-l", "l.json", "--frames", "3"), name)


@case
def wild3_02_a_soft_edge_stays_soft(run):
    """Alpha from 0 to 1 across a texture: all steps are seen, not two."""
    ramp = make_png([[(255, 0, 0, 4 * x) for x in range(64)]] * 2)
    gltf(run, "soft", {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
         [("TEXCOORD_0", [(0, 1), (1, 1), (1, 0), (0, 0)])], [ramp])
    row = drawn(run, "soft.gltf")[SIDE // 2]
    check(len({pixel for pixel in row}) > 30, len(set(row)), "colours")
    run.write("soft.gltf", run.text("soft.gltf").replace("BLEND", "MASK"))
    check(len({pixel for pixel in drawn(run, "soft.gltf")[SIDE // 2]}) < 6, "a mask is cut out")


@case
def wild3_03_tr_one_means_opaque(run):
    """A scan whose writer says Tr 1 for opaque has the picture of the same scan without Tr."""
    run.write("t.png", make_png([[(200, 40, 40)] * 2] * 2))
    for text in ("Tr 1\n", "Tr 1.0\n", "Tr 1.000000\n", "d 1\nTr 1\n", "d 0\nTr 0\n"):
        obj(run, "scan", "Kd 1 1 1\n" + text + "illum 1\nmap_Kd t.png\n")
        obj(run, "opaque", "Kd 1 1 1\nillum 1\nmap_Kd t.png\n")
        check(drawn(run, "scan.obj") == drawn(run, "opaque.obj"), text)
    obj(run, "scan", "Tr 1\nmap_Kd t.png\n")
    one_line(run.ffd("view", "scan.obj", "-o", "q.png", "--size", "20x20", err=anything), '"Tr 1" of 1 material')
    run.write("scan.mtl", "newmtl m\nTr 1\nnewmtl other\nTr 0.5\n")
    check(drawn(run, "scan.obj") != drawn(run, "opaque.obj"), "where another material has another Tr it is clear")


@case
def wild3_07_points_and_lines_have_colours(run):
    run.write("l.json", LIFT)
    grid = [(x / 10, y / 10, 0) for x in range(11) for y in range(11)]
    bright = lambda rows: {tuple(pixel) for row in rows for pixel in row if max(pixel) > 2 * min(pixel) + 40}
    for name, color in (("red", (230, 20, 20)), ("blue", (20, 20, 230))):
        run.write(name + ".ply", f"ply\nformat ascii 1.0\nelement vertex {len(grid)}\nproperty float x\nproperty float y\nproperty float z\n"
                  "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n" +
                  "".join("{} {} {} ".format(*p) + "{} {} {}\n".format(*color) for p in grid))
        gltf(run, name + "-vertices", {}, [("COLOR_0", [[light(c) for c in color]] * len(grid))], mode=0, points=grid)
        gltf(run, name + "-material", {"pbrMetallicRoughness": {"baseColorFactor": [*(light(c) for c in color), 1]}}, mode=0, points=grid)
        gltf(run, name + "-lines", {"pbrMetallicRoughness": {"baseColorFactor": [*(light(c) for c in color), 1]}}, mode=3, points=CORNERS)
        run.write(name + ".mtl", "newmtl m\nKd {} {} {}\n".format(*(c / 255 for c in color)))
        run.write(name + ".obj", f"mtllib {name}.mtl\nv 0 0 0\nv 1 1 0\nv 1 0 0\nusemtl m\nl 1 2\np 3\n")
        for model in (name + ".ply", name + "-vertices.gltf", name + "-material.gltf", name + "-lines.gltf", name + ".obj"):
            found = bright(drawn(run, model))
            most = 12 if model.endswith("ply") or "-m" in model or "-v" in model else 90  # a line is thinner than two pixels
            check(any(max(abs(a - b) for a, b in zip(pixel, color)) < most for pixel in found), model, found)
            moved = drawn(run, model, "-l", "l.json", "--no-cage", color="displacement")
            after = bright([row[SIDE // 2 + 2:] for row in moved[:48]])
            check(all(min(abs(a - b) for a, b in zip(pixel, color)) > 12 or pixel[1] > 60 for pixel in after) and after, model, "after")


@case
def wild3_11_what_emits_light_is_bright(run):
    black = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}
    gltf(run, "lamp", {"pbrMetallicRoughness": black, "emissiveFactor": [1, 0.6, 0.1]})
    is_color(middle(run, "lamp.gltf"), [1, 0.6, 0.1], "a factor")
    gltf(run, "lamp", {"pbrMetallicRoughness": black, "emissiveFactor": [0.2, 0.1, 0],
                       "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}}})
    is_color(middle(run, "lamp.gltf"), [0.6, 0.3, 0], "a strength")
    # The texture's own set, and its transform: its right half is green.
    halves = make_png([[(0, 0, 0)] * 8 + [(0, 255, 0)] * 8] * 2)
    left = ("TEXCOORD_0", [(0.1, 0.5)] * 4), ("TEXCOORD_1", [(0.8, 0.5)] * 4)
    for info, wanted in (({"index": 0}, 0), ({"index": 0, "texCoord": 1}, 1),
                         ({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.6, 0]}}}, 1),
                         ({"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"texCoord": 0}}}, 0),
                         ({"index": 0, "extensions": {"KHR_texture_transform": {"rotation": math.pi, "offset": [1, 1]}}}, 1)):
        gltf(run, "lamp", {"pbrMetallicRoughness": black | {"baseColorTexture": {"index": 0}}, "emissiveFactor": [1, 1, 1],
                           "emissiveTexture": info}, left, [halves])
        is_color(middle(run, "lamp.gltf"), [0, wanted, 0], str(info))
    run.write("t.png", make_png([[(0, 0, 255)] * 2] * 2))
    for statements, wanted in (("Ke 1 0 0\n", [1, 0, 0]), ("map_Ke t.png\n", [0, 0, 1]), ("Ke 0 0 0\nmap_Ke t.png\n", [0, 0, 1]),
                               ("Ke 0 0 0\n", [0, 0, 0])):
        obj(run, "lamp", "Kd 0 0 0\n" + statements)
        is_color(middle(run, "lamp.obj"), wanted, statements)
    gltf(run, "flat", {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.5, 0.2, 1]}, "extensions": {"KHR_materials_unlit": {}}})
    is_color(middle(run, "flat.gltf"), [0.9, 0.5, 0.2], "no lamp lights it", 1)


def splats(run, name, rows):
    """rows: place, colour 0 to 1, opacity, standard deviations"""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    body = b""
    for place, color, opacity, sizes in rows:
        body += struct.pack("<14f", *place, *((c - 0.5) / 0.28209479177387814 for c in color), math.log(opacity / (1 - opacity)),
                            *(math.log(s) for s in sizes), 1, 0, 0, 0)
    run.write(name, ("ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(rows) + "".join(f"property float {n}\n" for n in names) +
                     "end_header\n").encode() + body)


@case
def artist_20_splats_have_colour_size_and_form(run):
    run.write("l.json", lattice(moves=[{"scale": {"factor": [1, 3, 1], "about": [0, 0, 0]}}], low=(-9, -9, -9), high=(9, 9, 9)))
    rows = [((-1, 0, 0), (1, 0, 0), 0.99, (0.3, 0.1, 0.1)), ((1, 0, 0), (0, 0, 1), 0.99, (0.1, 0.3, 0.1)),
            ((0, -1, 0), (0, 0.5, 0), 0.99, (0.01,) * 3), ((0, 1, 0), (0, 0.5, 0), 0.99, (0.01,) * 3)]
    splats(run, "a.ply", rows)
    is_red, is_blue = (lambda p: p[0] > 2 * p[1] and p[0] > 2 * p[2]), (lambda p: p[2] > 2 * p[0] and p[2] > 2 * p[1])

    def spread(pixels, found):
        seen = [(x, y) for y, row in enumerate(pixels) for x, pixel in enumerate(row) if found(pixel)]
        check(seen, "no such splat")
        return [max(p[a] for p in seen) - min(p[a] for p in seen) + 1 for a in range(2)]

    found = drawn(run, "a.ply")
    red, blue = spread(found, is_red), spread(found, is_blue)
    check(red[0] > 1.8 * red[1] and blue[1] > 1.8 * blue[0], red, blue)
    # After a stretch along y by three the red one is round, and the blue one longer still.
    run.ffd("view", "a.ply", "-l", "l.json", "-o", "p.png", "--size", "400x400", "--camera", "front", "--color", "plain", "--no-cage",
            "--force", err=anything)
    after = [row[202:] for row in read_png(run.read("p.png"))[60:]]
    red, blue = spread(after, is_red), spread(after, is_blue)
    check(abs(red[0] - red[1]) < 0.25 * red[0] and blue[1] > 5 * blue[0], red, blue)
    # A splat far away that is nearly clear makes nothing smaller.
    splats(run, "far.ply", [*rows, ((500, 900, 0), (1, 1, 1), 0.004, (0.1,) * 3)])
    check(drawn(run, "far.ply") == found, "the same picture")
    # The same ones in glTF.
    attributes = [("KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", [[(c - 0.5) / 0.28209479177387814 for c in row[1]] for row in rows]),
                  ("KHR_gaussian_splatting:OPACITY", [[row[2]] for row in rows]), ("KHR_gaussian_splatting:SCALE", [row[3] for row in rows]),
                  ("KHR_gaussian_splatting:ROTATION", [[0, 0, 0, 1]] * 4)]
    gltf(run, "a", {}, attributes, mode=0, points=[row[0] for row in rows],
         extensions={"KHR_gaussian_splatting": {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}})
    again = drawn(run, "a.gltf")
    equal(max(abs(a - b) for one, other in zip(found, again) for p, q in zip(one, other) for a, b in zip(p, q)) <= 2, True, "glTF")


def extent(rows, panel):
    """Width and height of what is drawn in the panel before (0) or after (1), which has no cage."""
    half, low, high = len(rows[0]) // 2, len(rows) // 8, len(rows) * 4 // 5
    seen = [(x, y) for y in range(low, high) for x in range(panel * half + 2, (panel + 1) * half - 2)
            if max(abs(a - b) for a, b in zip(rows[y][x], rows[y][panel * half + 2])) > 24]
    return [max(p[a] for p in seen) - min(p[a] for p in seen) + 1 for a in range(2)]


@case
def artist_25_variants_can_be_compared(run):
    """The same mesh before is as large in each row of a sweep, a variant twice as tall is twice as tall, and colours have one scale."""
    run.write("cube.obj", "".join(f"v {x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)) +
              "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
    run.write("t.json", lattice(moves=[{"scale": {"factor": [1, {"$": "T"}, 1], "about": [0, -1, 0]}}]))
    run.write("t.csv", "out,T\nsmall.obj,0.5\nlarge.obj,2\ngiant.obj,3.5\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "cube.obj", "-l", "t.json", "--out-dir", "out", "--view", "pics", "--camera", "front",
            "--no-cage", "--size", "640x360", err=anything)
    small, large = [read_png(run.read(f"pics/{name}.obj.png")) for name in ("small", "large")]
    check(extent(small, 0) == extent(large, 0), extent(small, 0), extent(large, 0))
    check(abs(extent(large, 1)[1] - 4 * extent(small, 1)[1]) <= 6, extent(large, 1), extent(small, 1))
    check(abs(extent(large, 1)[1] - 2 * extent(large, 0)[1]) <= 3 and extent(large, 1)[0] == extent(small, 1)[0], extent(large, 1))
    legend = len(small) * 5 // 6
    check(small[legend:] == large[legend:], "the scales of colours differ")


main()
