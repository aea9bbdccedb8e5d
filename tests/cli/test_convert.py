#!/usr/bin/env python3
"""Conversions: every format into every other one, read back here by small readers of their own; what targets cannot
hold; the containers of glTF."""
import base64
import json
import math
import re
import struct
from random import Random

from gltf_build import Scene
from harness import (INVALID, IO, PNG, SANITIZED, USAGE, case, check, equal, float32, glb, glb_split, gltf_json, lattice, main,
                     near)
from messages import anything, one_line

FORMATS = ("obj", "ply", "off", "stl", "glb", "gltf")
FLOATS = ("stl", "glb", "gltf")
STILL = lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[])
MOVED = lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"at": ["all", "all", [2, 3]], "by": [0.5, 0.25, -0.125]}])

# Two objects; a quad, an L of six corners, a bent quad with a corner turned in, a triangle; each corner with a texture
# coordinate and a normal of its own face, except for the last face.
SHAPE = """mtllib none.mtl
o first one
v 0.1 0.2 0.30000000000000004
v 1 0 0
v 1.1 1 0
v 0 1 0.7
v 3 0 0
v 3 3 0
v 2 3 0
v 2 1 0
vt 0 0
vt 0.25 0
vt 1 1
vt 0 0.625
vn 0 0 1
vn 0 -1 0
vn 0.6 0 0.8
usemtl red
f 1/1/1 2/2/1 3/3/1 4/4/1
f 2/1/1 5/2/1 6/3/1 7/4/1 8/2/1 3/1/1
o second
g left
v -1 -1 0
v 1 -1 1
v -0.5 -0.5 0.25
v -1 1 1
usemtl blue
f 9/1/2 10/2/2 11/3/2 12/4/2
usemtl red
f 1/1/3 10/2/3 2/3/3
"""
CORNERS = 17


# Readers. Each gives the faces in order, a face as its corners: (position, texture coordinate, normal).

def read_obj(data):
    values, faces = {"v": [], "vt": [], "vn": []}, []

    def pick(kind, text):
        return tuple(values[kind][int(text) - 1]) if text else None

    for line in data.decode().splitlines():
        key, *words = line.split() or [""]
        if key in values:
            values[key].append([float(x) for x in words][:2 if key == "vt" else 3])
        elif key == "f":
            corners = [(word + "//").split("/")[:3] for word in words]
            faces.append([(pick("v", v), pick("vt", t), pick("vn", n)) for v, t, n in corners])
    return faces


PLY_TYPES = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d"}


def ply_elements(data):
    header, body = data.split(b"end_header\n", 1)
    lines = header.decode().split("\n")
    equal(lines[:2], ["ply", "format binary_little_endian 1.0"], "the header")
    elements, at = {}, 0
    for line in lines[2:-1]:
        key, *words = line.split()
        if key == "element":
            elements[words[0]] = (int(words[1]), [])
        else:
            list(elements.values())[-1][1].append(words)
    for name, (count, properties) in elements.items():
        rows = []
        for _ in range(count):
            row = {}
            for words in properties:
                size = 1
                if words[0] == "list":
                    size, = struct.unpack_from("<" + PLY_TYPES[words[1]], body, at)
                    at += struct.calcsize("<" + PLY_TYPES[words[1]])
                code = f"<{size}{PLY_TYPES[words[-2]]}"
                found = struct.unpack_from(code, body, at)
                at += struct.calcsize(code)
                row[words[-1]] = list(found) if words[0] == "list" else found[0]
            rows.append(row)
        elements[name] = rows
    equal(at, len(body), "the PLY's size")
    return elements


def read_ply(data):
    elements = ply_elements(data)
    vertices, faces = elements["vertex"], []
    for face in elements.get("face", []):
        corners = []
        for i, v in enumerate(face["vertex_indices"]):
            row = vertices[v]
            texcoord = tuple(face["texcoord"][2 * i:2 * i + 2]) if "texcoord" in face else \
                (row["s"], row["t"]) if "s" in row else None
            normal = (row["nx"], row["ny"], row["nz"]) if "nx" in row else None
            corners.append(((row["x"], row["y"], row["z"]), texcoord, normal))
        faces.append(corners)
    return faces


def read_off(data):
    lines = data.decode().split("\n")
    head, counts = lines[0], [int(x) for x in lines[1].split()]
    vertices, faces = [], []
    for line in lines[2:2 + counts[0]]:
        numbers = [float(x) for x in line.split()]
        position, normal, texcoord = tuple(numbers[:3]), None, None
        if "N" in head:
            normal = tuple(numbers[3:6])
        if "ST" in head:
            texcoord = tuple(numbers[-2:])
        vertices.append((position, texcoord, normal))
    for line in lines[2 + counts[0]:2 + counts[0] + counts[1]]:
        count, *corners = [int(x) for x in line.split()]
        equal(len(corners), count, line)
        faces.append([vertices[c] for c in corners])
    equal(lines[2 + sum(counts):], [""], "the end of the OFF")
    return [face for face in faces if len(face) > 2]


def read_stl(data):
    count, = struct.unpack_from("<I", data, 80)
    equal(len(data), 84 + 50 * count, "the STL's size")
    check(not data.startswith(b"solid"), "the STL's header says text")
    faces = []
    for i in range(count):
        numbers = struct.unpack_from("<12fH", data, 84 + 50 * i)
        corners = [numbers[3:6], numbers[6:9], numbers[9:12]]
        expected = normal_of(corners)
        if expected:
            near(numbers[:3], expected, 1e-6, "the facet's normal")
        faces.append([(c, None, None) for c in corners])
    return faces


def read_accessor(asset, buffer, number):
    accessor = asset["accessors"][number]
    view = asset["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    code = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[accessor["componentType"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", struct.calcsize(f"<{width}{code}"))
    return [struct.unpack_from(f"<{width}{code}", buffer, start + stride * i) for i in range(accessor["count"])]


def read_asset(asset, buffer):
    faces = []
    for mesh in asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            if primitive.get("mode", 4) != 4:
                continue
            attributes = {key: read_accessor(asset, buffer, a) for key, a in primitive["attributes"].items()}
            vertices = list(zip(attributes["POSITION"],
                                [(u, 1 - v) for u, v in attributes["TEXCOORD_0"]] if "TEXCOORD_0" in attributes
                                else [None] * len(attributes["POSITION"]),
                                attributes.get("NORMAL", [None] * len(attributes["POSITION"]))))
            indices = [i for i, in read_accessor(asset, buffer, primitive["indices"])]
            faces += [[vertices[i] for i in indices[t:t + 3]] for t in range(0, len(indices), 3)]
    return faces


def read_faces(run, name):
    data = run.read(name)
    if name.endswith(".gltf"):
        asset = json.loads(data)
        return read_asset(asset, run.read(asset["buffers"][0]["uri"].replace("%20", " ")))
    if name.endswith(".glb"):
        return read_asset(*glb_split(data))
    return {"obj": read_obj, "ply": read_ply, "off": read_off, "stl": read_stl}[name[-3:]](data)


def normal_of(corners):
    sides = [[corners[i][a] - corners[0][a] for a in range(3)] for i in (1, 2)]
    cross = [sides[0][(a + 1) % 3] * sides[1][(a + 2) % 3] - sides[0][(a + 2) % 3] * sides[1][(a + 1) % 3]
             for a in range(3)]
    length = math.sqrt(sum(c * c for c in cross))
    return [c / length for c in cross] if length > 1e-9 else None


def area_vector(corners):
    """Newell's sum: the same for a polygon and the triangles it is cut into."""
    total = [0.0, 0.0, 0.0]
    for p, q in zip(corners, corners[1:] + corners[:1]):
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            total[a] += (p[b] * q[c] - p[c] * q[b]) / 2
    return total


def places(faces):
    return [[corner[0] for corner in face] for face in faces]


def rounded(faces, target):
    if target not in FLOATS:
        return [[tuple(p) for p in face] for face in faces]
    return [[tuple(float32(x) for x in p) for p in face] for face in faces]


def check_places(found, expected, target, what):
    """Polygons are the same, corner by corner; or they are cut into n - 2 triangles of their corners, in order of the
    faces where one primitive holds them all."""
    expected = rounded(expected, target)
    if target not in FLOATS:
        equal(found, expected, what)
        return
    equal(len(found), sum(len(face) - 2 for face in expected), f"{what}: triangles")
    left = [[tuple(p) for p in face] for face in found]
    for face in expected:
        own = [t for t in left if all(p in face for p in t)]
        own = own[:len(face) - 2]
        equal(len(own), len(face) - 2, f"{what}: triangles of {face}")
        for triangle in own:
            left.remove(triangle)
        near([sum(x) for x in zip(*(area_vector(t) for t in own))], area_vector(face), 1e-6, what)
        # No triangle is turned over against the face.
        for triangle in own:
            dot = sum(a * b for a, b in zip(area_vector(triangle), area_vector(face)))
            check(dot > 0, f"{what}: {triangle} of {face} is turned over")


def start(run):
    run.write("still.json", STILL)
    run.write("moved.json", MOVED)
    run.write("a.obj", SHAPE)


def convert(run, source, target, *options, lattice="still.json", **more):
    more.setdefault("lines", 1)
    return run.ffd("deform", source, target, "-l", lattice, *options, **more)


def some_line(run, source, target, *options, **more):
    """Whether there is something to warn of depends on the pair."""
    return run.ffd("deform", source, target, "-l", "still.json", *options, "-q", **more)


@case
def every_format_becomes_every_other_one(run):
    start(run)
    run.ffd("deform", "a.obj", "m.obj", "-l", "moved.json")
    moved = places(read_faces(run, "m.obj"))
    check(moved != places(read_obj(SHAPE.encode())), "the lattice moves")
    for first in FORMATS[1:]:
        # Deformed and converted at once, and one after the other, are the same bytes.
        convert(run, "a.obj", f"m.{first}", lattice="moved.json")
        convert(run, "m.obj", f"s.{first}")
        if first == "gltf":
            equal(run.text("m.gltf").replace("m.bin", "s.bin"), run.text("s.gltf"))
            equal(run.read("m.bin"), run.read("s.bin"))
        else:
            equal(run.read(f"m.{first}"), run.read(f"s.{first}"))
        check_places(places(read_faces(run, f"m.{first}")), moved, first, f"obj to {first}")
    for source in FORMATS:
        before = places(read_faces(run, f"m.{source}"))
        for target in FORMATS:
            if {source, target} <= {"glb", "gltf"}:
                continue
            name = f"{source}-{target}.{target}"
            some_line(run, f"m.{source}", name)
            check_places(places(read_faces(run, name)), before, target, name)


@case
def doubles_go_round(run):
    """Coordinates, faces and their order come back as they were, by whatever way without floats."""
    start(run)
    for way in (["ply"], ["off"], ["ply", "off"], ["off", "ply"]):
        name = "a.obj"
        for n, ending in enumerate(way + ["obj"]):
            some_line(run, name, f"{n}.{ending}", "--force")
            name = f"{n}.{ending}"
        found, expected = run.text(name).splitlines(), SHAPE.splitlines()
        equal([[float(x) for x in line.split()[1:]] for line in found if line.startswith("v ")],
              [[float(x) for x in line.split()[1:]] for line in expected if line.startswith("v ")], name)
        equal([[word.split("/")[0] for word in line.split()] for line in found if line.startswith("f ")],
              [[word.split("/")[0] for word in line.split()] for line in expected if line.startswith("f ")], name)
    equal(len(read_faces(run, "0.ply")), 4)


@case
def texture_coordinates_and_normals_go_where_the_target_holds_them(run):
    """Texture coordinates and normals of every corner, where the target holds them."""
    start(run)
    faces = read_obj(SHAPE.encode())
    for target in ("glb", "gltf"):
        convert(run, "a.obj", f"b.{target}")
        expected = {(tuple(float32(x) for x in p), t, n) for face in faces for p, t, n in face}
        found = {(tuple(p), tuple(t), tuple(round(x, 6) for x in n))
                 for face in read_faces(run, f"b.{target}") for p, t, n in face}
        equal(found, expected, target)
    convert(run, "a.obj", "b.ply", err="a.obj: PLY cannot hold: vertex normals (a vertex has several), object names, "
                                       "group names, materials")
    equal([[t for _, t, _ in face] for face in read_faces(run, "b.ply")], [[t for _, t, _ in face] for face in faces])
    equal({n for face in read_faces(run, "b.ply") for _, _, n in face}, {None})
    # Back in OBJ they are there as before.
    for source in ("b.glb", "b.ply"):
        some_line(run, source, "c.obj", "--force")
        equal({t for face in read_faces(run, "c.obj") for _, t, _ in face}, {t for face in faces for _, t, _ in face})

    one_each = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.5\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n"
    run.write("one.obj", one_each)
    for target in ("ply", "off", "glb"):
        run.ffd("deform", "one.obj", f"one.{target}", "-l", "still.json")
        equal(read_faces(run, f"one.{target}"), read_obj(one_each.encode()), target)
        run.ffd("deform", f"one.{target}", f"{target}.obj", "-l", "still.json")
        equal(read_faces(run, f"{target}.obj"), read_obj(one_each.encode()), f"{target} to obj")


@case
def normals_of_the_deformation(run):
    start(run)
    run.write("turn.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"rotate": {"axis": "x", "degrees": 90}}]))
    run.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
    for options, expected in (((), (0, -1, 0)), (("--normals", "keep"), (0, 0, 1))):
        for target in ("ply", "off", "glb", "gltf"):
            run.ffd("deform", "one.obj", f"one.{target}", "-l", "turn.json", "--force", *options)
            for face in read_faces(run, f"one.{target}"):
                for position, _, normal in face:
                    near(normal, expected, 1e-7, target)
                    near([position[1]], [0], 1e-7, target)


@case
def names_go_along(run):
    start(run)
    convert(run, "a.obj", "b.glb")
    asset, _ = glb_split(run.read("b.glb"))
    equal([mesh.get("name") for mesh in asset["meshes"]], ["first one", "second/left"])
    equal([node.get("name") for node in asset["nodes"]], ["first one", "second/left"])
    equal([material["name"] for material in asset["materials"]], ["red", "blue"])
    equal([[p["material"] for p in mesh["primitives"]] for mesh in asset["meshes"]], [[0], [1, 0]])
    convert(run, "b.glb", "c.obj", err="b.glb: OBJ cannot hold: materials (their names are kept)")
    found = [line for line in run.text("c.obj").splitlines() if line.split()[0] in ("o", "g", "usemtl", "mtllib")]
    equal(found, ["o first one", "usemtl red", "o second/left", "usemtl blue", "usemtl red"])


def triangle_asset(nodes, **members):
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], nodes=nodes, normals=[[0, 0, 1]] * 3)
    asset.update(members)
    return asset, data


@case
def scenes_are_placed(run):
    """Positions are where the nodes put them; under a mirror faces still look the way their normals do."""
    run.write("still.json", STILL)
    turned = [0.7071067811865476, 0, 0, 0.7071067811865476]
    run.write("a.glb", glb(*triangle_asset([
        {"mesh": 0, "name": "shifted", "translation": [1, 2, 3]},
        {"mesh": 0, "scale": [-2, 1, 1]},
        {"name": "parent", "rotation": turned, "children": [3]},
        {"mesh": 0, "name": "low\\", "scale": [1, 2, 4]}], scenes=[{"nodes": [0, 1, 2]}])))
    run.ffd("deform", "a.glb", "b.obj", "-l", "still.json", err="a.glb: OBJ cannot hold: the node hierarchy")
    faces = read_faces(run, "b.obj")
    near(places(faces), [[(1, 2, 3), (2, 2, 3), (1, 3, 3)], [(0, 0, 0), (0, 1, 0), (-2, 0, 0)],
                         [(0, 0, 0), (1, 0, 0), (0, 0, 2)]], 1e-7)
    for face in faces:
        for _, _, normal in face:
            near(normal, normal_of([corner[0] for corner in face]), 1e-7)
    equal([line for line in run.text("b.obj").splitlines() if line.startswith("o")], ["o shifted", "o node 1", "o low_"])
    # In its own space a mesh appears once, and that is said.
    run.ffd("deform", "a.glb", "c.obj", "-l", "still.json", "--space", "mesh",
            err="a.glb: OBJ cannot hold: the node hierarchy, the transforms of nodes (--space mesh)")
    equal(places(read_faces(run, "c.obj")), [[(0, 0, 0), (1, 0, 0), (0, 1, 0)]])


@case
def quantized_positions_become_numbers(run):
    """They come out as the fractions that they are, and what moves is not rounded to their steps."""
    run.write("still.json", STILL)
    run.write("shift.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [0.001, 0, 0]}]))
    asset, _ = gltf_json([[0, 0, 0]] * 3)
    asset["extensionsUsed"] = asset["extensionsRequired"] = ["KHR_mesh_quantization"]
    asset["accessors"][0].update(componentType=5120, normalized=True, min=[-127, 0, 0], max=[127, 127, 0])
    asset["bufferViews"][0].update(byteLength=12, byteStride=4)
    asset["meshes"][0]["primitives"][0]["mode"] = 4
    asset["buffers"][0]["byteLength"] = 12
    run.write("a.glb", glb(asset, struct.pack("<12b", -127, 0, 0, 0, 100, 0, 0, 0, 3, 127, 0, 0)))
    exact = [(-1.0, 0.0, 0.0), (100 / 127, 0.0, 0.0), (3 / 127, 1.0, 0.0)]
    run.ffd("deform", "a.glb", "b.obj", "-l", "still.json")
    equal(places(read_faces(run, "b.obj")), [exact])
    run.ffd("deform", "a.glb", "c.obj", "-l", "shift.json")
    near(places(read_faces(run, "c.obj"))[0], [(x + 0.001, y, z) for x, y, z in exact], 1e-7)


@case
def modes_of_drawing(run):
    run.write("still.json", STILL)
    points = [[x, y, 0.0] for x in (0, 1, 2) for y in (0, 1)]
    asset, data = gltf_json(points)
    expected = {0: ("p", [[i] for i in range(6)]), 1: ("l", [[0, 1], [2, 3], [4, 5]]),
                2: ("l", [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0]]),
                3: ("l", [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]]), 4: ("f", [[0, 1, 2], [3, 4, 5]]),
                5: ("f", [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]),
                6: ("f", [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])}
    for mode, (key, elements) in expected.items():
        asset["meshes"][0]["primitives"][0]["mode"] = mode
        run.write("a.glb", glb(asset, data))
        run.ffd("deform", "a.glb", "b.obj", "-l", "still.json", "--force")
        found = [line.split() for line in run.text("b.obj").splitlines() if line[0] in "plf"]
        equal([words[0] for words in found], [key] * len(elements), f"mode {mode}")
        found = [[int(w) - 1 for w in words[1:]] for words in found]
        if key == "f":  # a triangle may begin with any of its corners
            found, elements = ([min(t[i:] + t[:i] for i in range(3)) for t in kind] for kind in (found, elements))
        equal(found, elements, f"mode {mode}")


@case
def lines_points_and_clouds(run):
    run.write("still.json", STILL)
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\nf 1 2 3\nl 1 2 4\np 4\n")
    run.ffd("deform", "a.obj", "a.ply", "-l", "still.json")
    elements = ply_elements(run.read("a.ply"))
    equal([len(elements["vertex"]), elements["edge"]], [5, [{"vertex1": 0, "vertex2": 1}, {"vertex1": 1, "vertex2": 3}]])
    run.ffd("deform", "a.obj", "a.off", "-l", "still.json")
    equal(run.text("a.off").splitlines()[7:], ["3 0 1 2", "2 0 1", "2 1 3", "1 3"])
    run.ffd("deform", "a.obj", "a.glb", "-l", "still.json", err="a.obj: glTF cannot hold: vertices that nothing uses")
    asset, data = glb_split(run.read("a.glb"))
    primitives = asset["meshes"][0]["primitives"]
    equal([p["mode"] for p in primitives], [4, 1, 0])
    positions = read_accessor(asset, data, primitives[1]["attributes"]["POSITION"])
    equal([positions[i] for i, in read_accessor(asset, data, primitives[1]["indices"])],
          [(0, 0, 0), (1, 0, 0), (1, 0, 0), (0, 0, 1)])
    run.ffd("deform", "a.obj", "a.stl", "-l", "still.json",
            err="a.obj: STL cannot hold: lines, points, vertices that nothing uses")
    for name in ("a.ply", "a.off"):
        run.ffd("deform", name, "b.obj", "-l", "still.json", "--force")
        lines = run.text("b.obj").splitlines()
        equal(lines[5:8], ["f 1 2 3", "l 1 2", "l 2 4"], name)

    cloud = "v 1 2 3\nv 4 5 6\nv 7 8 8.5\n"
    run.write("cloud.obj", cloud)
    for target in ("ply", "off", "glb"):
        run.ffd("deform", "cloud.obj", f"cloud.{target}", "-l", "still.json")
        run.ffd("deform", f"cloud.{target}", "back.obj", "-l", "still.json", "--force")
        equal([line for line in run.text("back.obj").splitlines() if line.startswith("v")], cloud.splitlines(), target)
    run.ffd("deform", "cloud.obj", "cloud.stl", "-l", "still.json", err="cloud.obj: STL cannot hold: points")
    run.write("empty.obj", "o\n")
    for target in FORMATS[1:]:
        run.ffd("deform", "empty.obj", f"empty.{target}", "-l", "still.json", err="empty.obj: there are no vertices to deform")
        run.ffd("deform", f"empty.{target}", "nothing.obj", "-l", "still.json", "--force",
                err=f"empty.{target}: there are no vertices to deform")
        equal(run.text("nothing.obj"), "o default\n", target)
        run.ffd("info", "nothing.obj")


def to_linear(c):
    """sRGB's curve, IEC 61966-2-1."""
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def to_srgb(c):
    return 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055


def colours_of(asset, data):
    """The stored numbers of the first primitive's colours, and their accessor."""
    number = asset["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
    return read_accessor(asset, data, number), asset["accessors"][number]


@case
def colours_go_along(run):
    run.write("still.json", STILL)
    run.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0.501961 0.2 1\nv 0 1 0 0 0.498039 0\nf 1 2 3\n")
    bytes_ = [(255, 0, 0), (128, 51, 255), (0, 127, 0)]
    run.ffd("deform", "a.obj", "a.ply", "-l", "still.json")
    equal([(v["red"], v["green"], v["blue"]) for v in ply_elements(run.read("a.ply"))["vertex"]], bytes_)
    run.ffd("deform", "a.obj", "a.off", "-l", "still.json")
    equal([line.split()[3:] for line in run.text("a.off").splitlines()[2:5]],
          [[str(c) for c in (*colour, 255)] for colour in bytes_])
    run.ffd("deform", "a.obj", "a.glb", "-l", "still.json")
    asset, data = glb_split(run.read("a.glb"))
    equal(read_accessor(asset, data, asset["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]),
          [(*(round(65535 * to_linear(c / 255)) for c in colour), 65535) for colour in bytes_])
    for name in ("a.ply", "a.off", "a.glb"):
        run.ffd("deform", name, "b.obj", "-l", "still.json", "--force")
        found = [[float(x) for x in line.split()[4:]] for line in run.text("b.obj").splitlines() if line.startswith("v ")]
        equal(found, [[c / 255 for c in colour] for colour in bytes_], name)
    run.ffd("deform", "a.obj", "a.stl", "-l", "still.json", err="a.obj: STL cannot hold: vertex colours")
    # Finer than bytes: as they are.
    run.write("fine.obj", "v 0 0 0 0.123 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n")
    for target in ("off", "ply", "glb"):
        run.ffd("deform", "fine.obj", f"fine.{target}", "-l", "still.json")
        run.ffd("deform", f"fine.{target}", "b.obj", "-l", "still.json", "--force")
        near([float(run.text("b.obj").split()[4])], [0.123], 1e-8, target)
    run.write("fine.obj", "v 0 0 0 0.123 0 1 0.3\nv 1 0 0 0 0 0 1\nv 0 1 0 0 0 1 0\nf 1 2 3\n")
    run.ffd("deform", "fine.obj", "fine.glb", "-l", "still.json", "--force")
    near(colours_of(*glb_split(run.read("fine.glb")))[0], [(to_linear(0.123), 0, 1, 0.3), (0, 0, 0, 1), (0, 0, 1, 0)], 2e-8)
    # With alpha, and with w instead.
    run.write("alpha.obj", "v 0 0 0 1 0 0.2 0.4\nv 1 0 0 0 0 0 1\nv 0 1 0 0 0 1 0\nf 1 2 3\n")
    run.ffd("deform", "alpha.obj", "alpha.ply", "-l", "still.json")
    equal([(v["red"], v["green"], v["blue"], v["alpha"]) for v in ply_elements(run.read("alpha.ply"))["vertex"]],
          [(255, 0, 51, 102), (0, 0, 0, 255), (0, 0, 255, 0)])
    run.write("w.obj", "v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0\nf 1 2 3\n")
    run.ffd("deform", "w.obj", "w.ply", "-l", "still.json")
    equal(list(ply_elements(run.read("w.ply"))["vertex"][0]), ["x", "y", "z"])
    run.write("w.obj", "v 0 0 0 1\nv 1 0 0 2\nv 0 1 0\nf 1 2 3\n")
    run.ffd("deform", "w.obj", "w.off", "-l", "still.json", err="w.obj: OFF cannot hold: w of vertices")
    # Bytes in text.
    run.write("bytes.obj", "v 0 0 0 51 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 102\nf 1 2 3\n")
    run.ffd("deform", "bytes.obj", "bytes.ply", "-l", "still.json")
    equal([v["red"] for v in ply_elements(run.read("bytes.ply"))["vertex"]], [51, 0, 0])


@case
def one_colour_above_1_leaves_the_others(run):
    """Only whole numbers are bytes; the factor 255 would make the mesh black."""
    run.write("still.json", STILL)
    rest = "v 1 0 0 0.5 0.5 1.0001\nv 0 1 0 0 0.25 0\nf 1 2 3\n"
    run.write("a.obj", "v 0 0 0 2 0 1.5\n" + rest)
    for target, name in (("ply", "PLY"), ("off", "OFF"), ("glb", "glTF")):
        run.ffd("deform", "a.obj", f"a.{target}", "-l", "still.json", err=f"a.obj: above 1, and 1 in {name}: 2 colours")
        run.ffd("deform", f"a.{target}", "b.obj", "-l", "still.json", "--force")
        found = [float(x) for line in run.text("b.obj").splitlines() if line.startswith("v ") for x in line.split()[4:]]
        near(found, [1, 0, 1, 0.5, 0.5, 1, 0, 0.25, 0], 1e-7, target)
    # More than a byte holds, and less than 0, are no bytes either.
    for other in ("256 0 0", "51 -1 0"):
        run.write("a.obj", f"v 0 0 0 {other}\nv 1 0 0 0 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n")
        run.ffd("deform", "a.obj", "a.ply", "-l", "still.json", "--force", err="a.obj: above 1, and 1 in PLY: 1 colour")


def cloud_of_colours(rows, component, normalized=True):
    """A GLB of points with these colours."""
    scene = Scene()
    attributes = {"POSITION": scene.add([[i % 16 / 2, i // 16 / 2, 0] for i in range(len(rows))], bounds=True),
                  "COLOR_0": scene.add(rows, component, "VEC4", normalized=normalized)}
    scene.asset.update(scenes=[{"nodes": [0]}], scene=0, nodes=[{"mesh": 0}],
                       meshes=[{"primitives": [{"mode": 0, "attributes": attributes}]}])
    return scene.glb()


COLOUR_BYTES = [(b, 255 - b, b ^ 85, b * 7 % 256) for b in range(256)]


@case
def every_byte_of_a_colour_comes_back(run):
    """sRGB of 8 bits is linear in glTF, finer than 8 bits, and the same bytes again; alpha is linear everywhere."""
    run.write("still.json", STILL)
    vertices = "".join(f"{i % 16 / 2} {i // 16 / 2} 0 {r} {g} {b} {a}\n" for i, (r, g, b, a) in enumerate(COLOUR_BYTES))
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 256\nproperty float x\nproperty float y\nproperty float z\n"
                       "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nend_header\n"
                       + vertices)

    def bytes_of(name):
        return [(v["red"], v["green"], v["blue"], v["alpha"]) for v in ply_elements(run.read(name))["vertex"]]

    run.ffd("deform", "a.ply", "a.glb", "-l", "still.json")
    found, accessor = colours_of(*glb_split(run.read("a.glb")))
    equal([accessor["componentType"], accessor["type"], accessor["normalized"]], [5123, "VEC4", True])
    equal(found, [(*(round(65535 * to_linear(c / 255)) for c in row[:3]), 257 * row[3]) for row in COLOUR_BYTES])
    some_line(run, "a.glb", "b.ply")
    equal(bytes_of("b.ply"), COLOUR_BYTES)
    some_line(run, "a.glb", "b.obj")
    equal([[float(x) for x in line.split()[4:]] for line in run.text("b.obj").splitlines() if line[0] == "v"],
          [[c / 255 for c in row[:3]] for row in COLOUR_BYTES])
    # Floats of another program.
    rows = [(*(float32(to_linear(c / 255)) for c in row[:3]), float32(row[3] / 255)) for row in COLOUR_BYTES]
    run.write("f.glb", cloud_of_colours(rows, 5126, normalized=False))
    some_line(run, "f.glb", "c.ply")
    equal(bytes_of("c.ply"), COLOUR_BYTES)


@case
def linear_colours_become_those_for_display(run):
    run.write("still.json", STILL)
    # Linear bytes become bytes, for programs that read no others, where the target has such.
    run.write("a.glb", cloud_of_colours(COLOUR_BYTES, 5121))
    some_line(run, "a.glb", "a.ply")
    equal([(v["red"], v["green"], v["blue"], v["alpha"]) for v in ply_elements(run.read("a.ply"))["vertex"]],
          [(*(round(255 * to_srgb(c / 255)) for c in row[:3]), row[3]) for row in COLOUR_BYTES])
    some_line(run, "a.glb", "a.obj")
    near([[float(x) for x in line.split()[4:]] for line in run.text("a.obj").splitlines() if line[0] == "v"],
         [[to_srgb(c / 255) for c in row[:3]] for row in COLOUR_BYTES], 0.01 / 255)
    # Floats, and those beyond 0 to 1, which viewers clamp.
    rows = [(0.5, 0.001, 0.25, 0.5), (2.0, -1.0, 1.0, 2.0), (0.75, 0.003, 0.004, 1.0)]
    run.write("f.glb", cloud_of_colours(rows, 5126, normalized=False))
    clamped = [[to_srgb(min(max(float32(c), 0), 1)) for c in row[:3]] for row in rows]
    some_line(run, "f.glb", "f.obj")
    near([[float(x) for x in line.split()[4:]] for line in run.text("f.obj").splitlines() if line[0] == "v"],
         clamped, 1e-15)
    for target in ("ply", "off"):
        some_line(run, "f.glb", f"f.{target}")
    near([(v["red"], v["green"], v["blue"]) for v in ply_elements(run.read("f.ply"))["vertex"]], clamped, 1e-7)
    near([[float(x) for x in line.split()[3:6]] for line in run.text("f.off").splitlines()[2:5]], clamped, 1e-15)


@case
def colours_of_shorts(run):
    run.write("still.json", STILL)
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                       "property ushort red\nproperty ushort green\nproperty ushort blue\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\n0 0 0 65535 0 1\n1 0 0 32768 0 0\n0 1 0 0 0 0\n"
                       "3 0 1 2\n")
    run.ffd("deform", "a.ply", "a.obj", "-l", "still.json")
    found = [[float(x) for x in line.split()[4:]] for line in run.text("a.obj").splitlines() if line.startswith("v ")]
    equal(found, [[1, 0, 1 / 65535], [32768 / 65535, 0, 0], [0, 0, 0]])


@case
def texture_coordinates_of_ply_are_floats(run):
    """Others are passed over by MeshLab: those of vertices, and those of corners."""
    run.write("still.json", STILL)
    for second, wanted in (("1/1 3/3 4/4", "property float s\nproperty float t\n"),
                           ("1/5 3/3 4/4", "property list uchar float texcoord\n")):
        run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.1 0\nvt 1 0.3\nvt 1 1\nvt 0 1\nvt 0.5 0.7\n"
                           f"f 1/1 2/2 3/3\nf {second}\n")
        run.ffd("deform", "a.obj", "a.ply", "-l", "still.json", "--force")
        check(wanted.encode() in run.read("a.ply").split(b"end_header")[0], second)
        equal([[t for _, t, _ in face] for face in read_faces(run, "a.ply")],
              [[tuple(float32(x) for x in t) for _, t, _ in face] for face in read_obj(run.read("a.obj"))], second)


@case
def faces_of_ply_whose_texture_coordinates_do_not_fit(run):
    """A list that is not two numbers for each corner is left out with a warning, and leaves no coordinate that nothing
    uses. A face with an empty list has none."""
    run.write("still.json", STILL)
    head = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
            "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n")
    good, short, none = "3 0 1 2 6 0.5 0 1 0.25 1 1\n", "3 0 2 3 4 0 0 1 1\n", "3 0 2 3 0\n"
    for faces, coordinates, line in (
            ([good, short], 3, "1 face has texture coordinates, which are not two numbers for each corner, and is left out"),
            ([short, good, short], 3, "2 faces have texture coordinates, which are not two numbers for each corner, and are left out"),
            ([short], 0, "1 face has texture coordinates, which are not two numbers for each corner, and is left out"),
            ([none, good], 3, None)):
        run.write("a.ply", head.format(len(faces)) + "".join(faces))
        run.ffd("deform", "a.ply", "a.obj", "-l", "still.json", "--force", err=f"a.ply: {line}" if line else [])
        text = run.text("a.obj").splitlines()
        equal([line for line in text if line.startswith("vt")], ["vt 0.5 0", "vt 1 0.25", "vt 1 1"][:coordinates])
        equal([line for line in text if line.startswith("f")],
              ["f 1/1 2/2 3/3" if face == good else "f 1 3 4" for face in faces])
        run.ffd("deform", "a.ply", "a.stl", "-l", "still.json", "--force", err=anything)


@case
def faces_of_many_corners(run):
    """PLY counts corners, and twice as many texture coordinates, by bytes as long as these suffice."""
    run.write("still.json", STILL)
    for corners in (127, 128, 255, 256):
        ring = [(round(math.cos(2 * math.pi * i / corners), 6), round(math.sin(2 * math.pi * i / corners), 6))
                for i in range(corners)]
        face = " ".join(f"{i}/{i}" for i in range(1, corners + 1))
        run.write("a.obj", "".join(f"v {x} {y} 0\n" for x, y in ring) + "".join(f"vt {x} {y}\n" for x, y in ring) +
                  f"f {face}\nf 1/2 2/3 3/1\n")
        run.ffd("deform", "a.obj", "a.ply", "-l", "still.json", "--force")
        rows = ply_elements(run.read("a.ply"))["face"]
        equal([len(row["vertex_indices"]) for row in rows], [corners, 3], corners)
        equal(rows[0]["texcoord"], [float32(x) for point in ring for x in point], corners)


@case
def equal_corners_share_a_vertex(run):
    """Also where an OBJ says the same by different numbers; and where an STL repeats it."""
    run.write("still.json", STILL)
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 2\nvt 0 0\nvt -0 0\n"
                       "f 1/1/1 2/1/1 3/2/1\nf 1/2/2 3/1/2 4/1/2\n")
    run.ffd("deform", "a.obj", "a.glb", "-l", "still.json")
    asset, data = glb_split(run.read("a.glb"))
    primitive, = asset["meshes"][0]["primitives"]
    equal([len(read_accessor(asset, data, a)) for a in primitive["attributes"].values()], [4, 4, 4])
    equal(read_accessor(asset, data, primitive["attributes"]["POSITION"]), [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    convert(run, "a.obj", "a.stl")
    run.ffd("deform", "a.stl", "b.obj", "-l", "still.json")
    equal(run.text("b.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")


@case
def stl_corners_that_meet(run):
    """Corners at one position of the STL are one vertex, whatever the lattice: also where it brings others there."""
    run.write("still.json", STILL)
    run.write("flat.json", lattice(low=(-1, -1, -1), high=(3, 3, 3), moves=[{"scale": {"factor": [1, 1, 0]}}]))
    corners = [(x, y, z) for z in (0.0, 2.0) for x, y in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))] + [(0.0, 0.0, -0.0)]
    facets = [(0, 1, 2), (3, 4, 5), (6, 1, 4), (0, 4, 3)]
    run.write("a.stl", b"binary".ljust(80) + struct.pack("<I", len(facets)) +
              b"".join(struct.pack("<12fH", 0, 0, 0, *(x for c in facet for x in corners[c]), 0) for facet in facets))
    for lattice_file in ("still.json", "flat.json"):
        for target in ("obj", "ply", "off", "glb", "gltf"):
            run.ffd("deform", "a.stl", f"b.{target}", "-l", lattice_file, "--force", "-q")
            vertices = run.ffd("info", f"b.{target}", "--json").json["vertices"]
            equal([vertices, len(read_faces(run, f"b.{target}"))], [6, 4], f"{target}, {lattice_file}")
        run.ffd("deform", "a.stl", "b.obj", "-l", lattice_file, "--force", "-q")
        equal(run.text("b.obj").split("f", 1)[1], " 1 2 3\nf 4 5 6\nf 1 2 5\nf 1 5 4\n", lattice_file)
    near([p[2] for face in read_faces(run, "b.obj") for p, _, _ in face], [1.0] * 12, 1e-12, "all is flat")
    run.ffd("deform", "a.stl", "morph.glb", "-l", "flat.json", "--as-morph", "flat", "-q")
    asset, data = glb_split(run.read("morph.glb"))
    primitive, = asset["meshes"][0]["primitives"]
    near([x[2] for x in read_accessor(asset, data, primitive["targets"][0]["POSITION"])], [1, 1, 1, -1, -1, -1], 1e-6)


@case
def many_vertices_need_long_indices(run):
    """65535 vertices are the most that 16 bits number."""
    run.write("still.json", STILL)
    for count, component in ((65535, 5123), (65538, 5125)):
        run.write("a.obj", "".join(f"v {i * 1e-5:.5f} {i % 2} {i % 3}\n" for i in range(count)) +
                  "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, count, 3)))
        run.ffd("deform", "a.obj", "a.glb", "-l", "still.json", "--force")
        asset, data = glb_split(run.read("a.glb"))
        primitive, = asset["meshes"][0]["primitives"]
        equal(asset["accessors"][primitive["indices"]]["componentType"], component)
        equal([i for i, in read_accessor(asset, data, primitive["indices"])], list(range(count)))


@case
def conversions_go_through_streams(run):
    start(run)
    for target in FORMATS[1:]:
        convert(run, "a.obj", f"b.{target}")
        done = run.ffd("deform", "-", "-", "--input-format", "obj", "--output-format", target, "-l", "still.json",
                       stdin=SHAPE.encode(), lines=1)
        check(done.err[0].startswith("standard input: "), done.err)
        if target != "gltf":
            equal(done.out, run.read(f"b.{target}"), target)
            continue
        asset = done.json
        head, payload = asset["buffers"][0]["uri"].split(",")
        equal([head, base64.b64decode(payload)], ["data:application/octet-stream;base64", run.read("b.bin")])
        equal(len(payload), (asset["buffers"][0]["byteLength"] + 2) // 3 * 4)
    run.ffd("deform", "a.obj", "-", "-l", "still.json", code=USAGE)


@case
def outputs_are_not_overwritten(run):
    start(run)
    run.write("b.bin", b"mine")
    convert(run, "a.obj", "b.gltf", code=IO, err="b.bin: exists already (--force overwrites it)")
    equal([run.read("b.bin"), run.exists("b.gltf")], [b"mine", False])
    convert(run, "a.obj", "b.gltf", "--force")
    equal(read_faces(run, "b.gltf") != [], True)
    convert(run, "a.obj", "b.gltf", code=IO)
    # Nor the input, force or not.
    run.write("c.bin", SHAPE)
    convert(run, "c.bin", "c.gltf", "--input-format", "obj", "--force", code=IO,
            err="c.bin: is the input and is not overwritten by a buffer")
    equal([run.text("c.bin"), run.exists("c.gltf")], [SHAPE, False])


@case
def numbers_that_do_not_fit(run):
    run.write("still.json", STILL)
    run.write("a.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n")
    for target, name in (("stl", "STL"), ("glb", "glTF"), ("gltf", "glTF")):
        run.ffd("deform", "a.obj", f"b.{target}", "-l", "still.json", "-q", code=INVALID,
                err=f"b.{target}: x of vertex 1 (counted from 0) is 1e+39, too large for the numbers of {name}")
        check(not run.exists(f"b.{target}") and not run.exists("b.bin"), "an output of a failure")
    run.ffd("deform", "a.obj", "b.ply", "-l", "still.json", "-q")


@case
def numbers_that_are_not_finite(run):
    """Readers of PLY take them; STL and glTF have no vertex that nothing uses."""
    run.write("still.json", STILL)
    for word, value in (("nan", math.nan), ("inf", math.inf), ("-inf", -math.inf)):
        for used in (True, False):
            run.write("a.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 {word} 0\nf 1 2 3\n" + ("f 1 2 4\n" if used else ""))
            for target, name in (("obj", "OBJ"), ("off", "OFF"), ("stl", "STL"), ("glb", "glTF"), ("gltf", "glTF")):
                run.ffd("deform", "a.obj", "a.ply", "-l", "still.json", "-q", "--force")
                refused = used or target in ("obj", "off")
                run.ffd("deform", "a.ply", f"b.{target}", "-l", "still.json", "-q", "--force", code=INVALID if refused else 0,
                        err=f"b.{target}: y of vertex 3 (counted from 0) is not finite ({word}): readers of {name} take no such number"
                        if refused else None)
                equal(run.exists(f"b.{target}"), not refused, f"{word} {used} {target}")
                run.remove(f"b.{target}")
            run.write("a.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 0\nv {word} 0 0\nf 1 2 3\nl 1 4\np 4\n")
            run.ffd("deform", "a.obj", "b.stl", "-l", "still.json", "-q")
            run.remove("b.stl")
            data = run.read("a.ply").split(b"end_header\n", 1)[1]
            found = struct.unpack("<3d", data[72:96])[1]
            check(found == value or (found != found and value != value), f"{word}: {found}")


@case
def attributes_that_are_not_finite(run):
    """Without them the shape is still what it is. Readers of PLY take them."""
    run.write("still.json", STILL)
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {n}\n" for n in "x y z nx ny nz s t".split())
              + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
              "0 0 0 nan 0 1 nan 0.5\n1 0 0 0 inf 1 0 0\n0 1 0 0 0 1 0 -inf\n3 0 1 2\n")
    for target, name in (("obj", "OBJ"), ("off", "OFF"), ("glb", "glTF")):
        one_line(run.ffd("deform", "a.ply", f"b.{target}", "-l", "still.json", err=anything), "not finite", name, "2 normals", "2 texture")
        check(not any(word in run.read(f"b.{target}") for word in (b"nan", b"inf")), target)
    equal([line for line in run.text("b.obj").splitlines() if line.startswith("vn") or line.startswith("vt")],
          ["vt 0 0", "vt 0 0", "vt 0 0", "vn 0 0 0", "vn 0 0 0", "vn 0 0 1"])


@case
def texture_coordinates_beyond_floats(run):
    """PLY and glTF hold them as floats: 1e300 is no infinity there."""
    run.write("still.json", STILL)
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1e300 0\nvt 0.5 -1e39\nvt 0.5 0.25\nvn 0 0 1e300\nf 1/1/1 2/2/1 3/3/1\n")
    for target, name in (("ply", "PLY"), ("glb", "glTF"), ("gltf", "glTF")):
        run.ffd("deform", "a.obj", f"b.{target}", "-l", "still.json",
                err=f"a.obj: not finite as numbers of {name}, and zero: 0 normals, 2 texture coordinates, 0 colours")
        run.ffd("deform", f"b.{target}", "b.obj", "-l", "still.json", "--force", err=anything)
        equal([line for line in run.text("b.obj").splitlines() if line.startswith("vt")],
              ["vt 0 0", "vt 0 0", "vt 0.5 0.25"] if target == "ply" else ["vt 0 0", "vt 0 0", "vt 0.5 0.25"], target)
    run.ffd("deform", "a.obj", "b.off", "-l", "still.json", err=[])
    check("1e+300 0" in run.text("b.off"), run.text("b.off"))


@case
def a_scene_that_shows_nothing(run):
    made = Scene(nodes=[{"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}}], scene=0, scenes=[{"nodes": [0]}],
                 extensionsUsed=["KHR_node_visibility"])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add([[0, 0, 0], [1, 0, 0], [0, 1, 0]], bounds=True)}}]}]
    run.write("a.glb", made.glb())
    run.write("still.json", STILL)
    for target in ("obj", "ply", "stl"):
        one_line(run.ffd("deform", "a.glb", f"b.{target}", "-l", "still.json", err=anything), "scene is empty", "no vertices")


@case
def places_that_floats_lose(run):
    """A shape far from the origin, as in a map's coordinates, is another shape in floats."""
    far = "v 4500000.25 -9000000 100\nv {} -9000000 100\nv 4500000.25 -8999999 100.5\nf 1 2 3\n"
    run.write("still.json", lattice(low=(0, -1e7, 0), high=(1e7, 0, 1e3), moves=[]))
    run.write("far.obj", far.format("4500001.3"))
    run.ffd("deform", "far.obj", "far.stl", "-l", "still.json",
            err="far.obj: STL cannot hold: the precision of coordinates that far from the origin")
    for target in ("ply", "off", "glb", "gltf"):
        run.ffd("deform", "far.obj", f"far.{target}", "-l", "still.json")
    run.write("exact.obj", far.format("4500001.5").replace("0.25", "0.5"))
    run.ffd("deform", "exact.obj", "exact.stl", "-l", "still.json")


def translation_of(asset):
    found = {tuple(node.get("translation", ())) for node in asset["nodes"]}
    equal(len(found), 1, "all nodes stand at one place")
    return list(found.pop())


@case
def far_shapes_keep_their_details_in_gltf(run):
    """From where floats have steps above 1e-6 of the diagonal on, the nodes have a translation: on each axis the
    multiple next to the middle of the power of two next above the diagonal."""
    run.write("still.json", lattice(low=(0, 0, 0), high=(1e7, 1e7, 1e7), moves=[]))
    run.write("top.json", lattice(low=(0, 0, 0), high=(1e7, 1e7, 1e7), moves=[{"by": [0.125, 0, 1e-3]}]))
    quad = [(0.125, 0.01, 0), (0.375, 0.01, 0), (0.375, 0.26, 0), (0.125, 0.26, 0)]
    tile = [(500000 + x, 4649776 + y, 120 + z) for x, y, z in quad]

    def write(name, places, faces="f 1//1 2//1 3//1\ng two\nf 1//1 3//1 4//1\n"):
        run.write(name, "".join("v %.17g %.17g %.17g\n" % p for p in places) + "vn 0 0 1\n" + faces)

    write("tile.obj", tile)
    run.ffd("deform", "tile.obj", "tile.glb", "-l", "still.json")
    asset, data = glb_split(run.read("tile.glb"))
    equal([len(asset["meshes"]), translation_of(asset)], [2, [500000.5, 4649776, 120]])
    shift = translation_of(asset)
    found = [[a + b for a, b in zip(p, shift)] for face in places(read_faces(run, "tile.glb")) for p in face]
    near(found, [tile[i] for i in (0, 1, 2, 0, 2, 3)], 2.0 ** -25 * 0.51, "half a step of what is left")
    for mesh in asset["meshes"]:
        accessor = asset["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
        near([accessor["min"][:2], accessor["max"][:2]], [[-0.375, 0.01], [-0.125, 0.26]], 1e-7)
    # It is told to those who ask, and read back as what it was.
    run.ffd("deform", "tile.obj", "tile.gltf", "-l", "still.json", "-v", err=lambda lines: any(
        x.endswith("too far from the origin for floats: the nodes have a translation, (500000.5, 4649776, 120)") for x in lines))
    for source in ("tile.glb", "tile.gltf"):
        run.ffd("deform", source, "back.obj", "-l", "still.json", "--force")
        near([p for face in places(read_faces(run, "back.obj")) for p in face], [tile[i] for i in (0, 1, 2, 0, 2, 3)],
             1e-7)
    # Its neighbour has the same.
    write("next.obj", [(x + 0.25, y, z) for x, y, z in tile])
    run.ffd("deform", "next.obj", "next.glb", "-l", "still.json")
    equal(translation_of(glb_split(run.read("next.glb"))[0]), shift)
    # Normals and morph targets have nothing to do with it.
    run.ffd("deform", "tile.obj", "morph.glb", "-l", "top.json", "--as-morph", "up")
    asset, data = glb_split(run.read("morph.glb"))
    equal(translation_of(asset), shift)
    for mesh in asset["meshes"]:
        primitive, = mesh["primitives"]
        equal(read_accessor(asset, data, primitive["attributes"]["NORMAL"]), [(0, 0, 1)] * 3)
        near(read_accessor(asset, data, primitive["targets"][0]["POSITION"]), [(0.125, 0, 1e-3)] * 3, 1e-9)


@case
def far_objects_keep_their_shape_beside_one_at_the_origin(run):
    """Each object is judged by its own size. One that floats keep stays where it is."""
    tile = [(500000.25, 4649776.01, 120), (500000.5, 4649776.01, 120), (500000.5, 4649776.26, 120)]
    marker = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    text = ["o tile\n", *("v %r %r %r\n" % p for p in tile), "f 1 2 3\n",
            "o marker\n", *("v %r %r %r\n" % p for p in marker), "f 4 5 6\n"]
    run.write("two.obj", "".join(text))
    run.write("still.json", lattice(low=(0, 0, 0), high=(1e7, 1e7, 1e7), moves=[]))
    run.ffd("deform", "two.obj", "two.gltf", "-l", "still.json", "-v", err=lambda lines: any(
        "1 of 2 nodes have a translation, the first (500000.5, 4649776, 120)" in x for x in lines))
    run.ffd("deform", "two.obj", "two.glb", "-l", "still.json", err=[])
    asset, _ = glb_split(run.read("two.glb"))
    equal([node.get("translation") for node in asset["nodes"]], [[500000.5, 4649776, 120], None])
    run.ffd("deform", "two.glb", "back.obj", "-l", "still.json")
    near([p for face in places(read_faces(run, "back.obj")) for p in face], tile + marker, 1e-7)
    run.ffd("deform", "two.obj", "two.stl", "-l", "still.json",
            err="two.obj: STL cannot hold: the precision of coordinates that far from the origin, object names")
    # A small object of a model in its usual place is no reason.
    run.write("near.obj", "".join(text).replace("500000", "3").replace("4649776", "2"))
    run.ffd("deform", "near.obj", "near.glb", "-l", "still.json", err=[])
    equal(translation_of(glb_split(run.read("near.glb"))[0]), [])


@case
def near_shapes_stay_at_the_origin_in_gltf(run):
    run.write("still.json", lattice(low=(-9e4, -9e4, -9e4), high=(9e4, 9e4, 9e4), moves=[]))
    for places_, wanted in (
            ([(7, 0, 0), (8, 0, 0), (7, 1, 0)], []),  # steps of 2^-20 at 8, of 2^-21 below, and a diagonal of 1.4
            ([(31, 0, 0), (30.5, 0, 0), (31, 0.5, 0)], [31, 0, 0]),
            ([(0, 0, -31), (0, -0.5, -31), (0.5, 0, -31)], [0, 0, -31]),
            ([(3, 3, 3)] * 3, []),  # without a size there is nothing to lose
            ([(50000, 0, 0), (0, 50000, 0), (0, 0, -50000)], [])):
        # The last vertex is in no face: it is not written, and does not count.
        run.write("a.obj", "".join("v %r %r %r\n" % p for p in places_) + "v 9e4 0 0\nf 1 2 3\n")
        run.ffd("deform", "a.obj", "a.glb", "-l", "still.json", "--force", "-q")
        equal(translation_of(glb_split(run.read("a.glb"))[0]), wanted, places_)


@case
def what_a_conversion_needs_to_be_valid(run):
    """A texture coordinate is not looked at until it is converted."""
    run.write("still.json", STILL)
    for text, says in (
            ("vt 0 0\nf 1/1 2/2 3/1\n", "a.obj:5: texture coordinate index 2 is out of range: the file has 1"),
            ("vt 0 x\nf 1/1 2/1 3/1\n", "a.obj:4: texture coordinate v is not a number: \"x\"")):
        run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + text)
        run.ffd("deform", "a.obj", "b.obj", "-l", "still.json", "--force")
        for target in FORMATS[1:]:
            run.ffd("deform", "a.obj", f"b.{target}", "-l", "still.json", code=INVALID, err=says)
    run.write("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3\n")
    run.ffd("deform", "none.obj", "none.glb", "-l", "still.json")
    equal(list(glb_split(run.read("none.glb"))[0]["meshes"][0]["primitives"][0]["attributes"]), ["POSITION"])


@case
def a_gltf_and_a_glb_hold_the_same_json(run):
    """A .gltf and a .glb hold the same JSON, but for the buffer's place; images come along."""
    run.write("still.json", STILL)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="a.bin")
    asset["images"] = [{"uri": "pictures/a.png"}]
    asset["extras"] = {"large": 12345678901234567890}
    run.write("a.gltf", asset)
    run.write("a.bin", data)
    run.write("pictures/a.png", PNG + b"a picture")
    run.folder_of("out")
    run.ffd("deform", "a.gltf", "out/b.glb", "-l", "still.json")
    check(not run.exists("out/pictures"), "the image is in the GLB")
    found, chunk = glb_split(run.read("out/b.glb"))
    expected = json.loads(json.dumps(asset))
    expected["images"][0]["uri"] = "data:image/png;base64," + base64.b64encode(PNG + b"a picture").decode()
    del expected["buffers"][0]["uri"]
    equal([found, chunk[:len(data)]], [expected, data])
    # A file may go on behind its buffer.
    run.write("a.bin", data + b"more" * 50000)
    run.ffd("deform", "a.gltf", "out/more.glb", "-l", "still.json", err=re.compile("200036 bytes, more than its byteLength 36$"))
    equal(run.read("out/more.glb"), run.read("out/b.glb"), "without what follows the buffer")
    run.write("a.bin", data)
    run.ffd("deform", "out/b.glb", "out/c.gltf", "-l", "still.json")
    expected["buffers"][0]["uri"] = "c.bin"
    equal([json.loads(run.text("out/c.gltf")), run.read("out/c.bin")], [expected, data])
    run.ffd("compare", "out/b.glb", "out/b.glb")
    done = run.ffd("deform", "out/b.glb", "-", "--output-format", "gltf", "-l", "still.json")
    expected["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    equal(done.json, expected)
    done = run.ffd("deform", "a.gltf", "-", "--output-format", "glb", "-l", "still.json")
    equal(done.out, run.read("out/b.glb"))
    # A chunk that only a GLB can hold is said to be left out.
    more = run.read("out/b.glb") + struct.pack("<II", 4, 0x12345678) + b"more"
    run.write("more.glb", more[:8] + struct.pack("<I", len(more)) + more[12:])
    run.ffd("deform", "more.glb", "more.gltf", "-l", "still.json",
            err="more.glb: the GLB's further chunks (12 bytes) are left out: a .gltf cannot hold them")


@case
def hurried_cuts_are_said(run):
    """A polygon that is too tangled to be cut well: triangles are made all the same, and a line says what they are worth."""
    start(run)
    numbers = Random(7)
    corners = 3000
    run.write("t.obj", "".join(f"v {numbers.random()} {numbers.random()} 0\n" for _ in range(corners))
              + "f " + " ".join(map(str, range(1, corners + 1))) + "\nf 1 2 3 4\n")
    said = "t.obj: 1 polygon has so many corners that finding a cut without overlaps takes too long: triangles may overlap"
    # A sanitizer needs not see one cut five times.
    for target in ("t.stl",) if SANITIZED else ("t.stl", "t.glb", "t.gltf"):
        check(said in convert(run, "t.obj", target, err=list).err, target)
    for target in ("t.html",) if SANITIZED else ("t.html", "t.png"):
        check(said in run.ffd("view", "t.obj", "-o", target, err=list).err, target)
    check(said not in convert(run, "t.obj", "t.ply", err=list).err, "a PLY has polygons")


@case
def quiet_says_nothing(run):
    start(run)
    convert(run, "a.obj", "b.stl", "-q", err=[])
    convert(run, "a.obj", "c.stl", err="a.obj: STL cannot hold: polygons (written as triangles), vertex normals, texture "
                                       "coordinates, object names, group names, materials")
    equal(run.read("b.stl"), run.read("c.stl"))


@case
def unknown_formats_are_refused(run):
    start(run)
    run.ffd("deform", "a.obj", "b.fbx", "-l", "still.json", code=USAGE)
    run.ffd("deform", "a.obj", "b.obj.txt", "-l", "still.json", code=USAGE)
    equal(sorted(run.names()), ["a.obj", "moved.json", "still.json"])


@case
def obj_with_a_part_kept(run):
    """Vertices that a selected face shares move with it, also in the other's faces, as in OBJ; a normal that both
    name at one vertex is turned in the selected face only."""
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0.6 0.8\ng one\nf 1//1 2//1 3//1\n"
                       "g two\nf 1//1 3//1 4//1\n")
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9),
                                moves=[{"rotate": {"axis": "z", "degrees": 90, "about": [0, 0, 0]}}]))
    turned, kept = (-0.6, 0, 0.8), (0, 0.6, 0.8)
    for target in ("obj", "glb"):
        run.ffd("deform", "a.obj", f"b.{target}", "-l", "l.json", "--only", "group:two", "--force", "-q")
        one, two = read_faces(run, f"b.{target}")
        for face, normal in ((one, kept), (two, turned)):
            for _, _, n in face:
                near(n, normal, 1e-6, target)
        near([p for p, _, _ in one], [(0, 0, 0), (1, 0, 0), (-1, 1, 0)], 1e-6, target)
        near([p for p, _, _ in two], [(0, 0, 0), (-1, 1, 0), (-1, 0, 0)], 1e-6, target)


@case
def the_same_beside_what_was_read(run):
    """A report's figures look at the rest shape to the end; without one results may take its place."""
    side = 40
    corner = [f"{i + 1}//{i + 1}" for i in range(side * side)]
    faces = [[k, k + 1, k + side + 1, k + side] for k in range(side * side - side) if (k + 1) % side]
    run.write("a.obj", "".join(f"v {i % side / 8} {i // side / 8} {i % 7 / 16}\n" for i in range(side * side))
              + "".join(f"vn {i % 3 - 1} 0.5 {i % 5}\n" for i in range(side * side))
              + "".join(("g two\n" if n == len(faces) // 2 else "") + "f " + " ".join(corner[k] for k in face) + "\n"
                        for n, face in enumerate(faces)))
    run.write("l.json", lattice(low=(-1, -1, -1), high=(6, 6, 2), moves=[{"twist": {"axis": "z", "degrees": 40}}]))
    for target in ("obj", "glb", "gltf", "ply", "off", "stl"):
        for options in ([], ["--only", "group:two"], ["--normals", "keep"], ["--as-morph", "bent"]):
            if "--as-morph" in options and target not in ("glb", "gltf"):
                continue
            run.ffd("deform", "a.obj", f"b.{target}", "-l", "l.json", "-q", "--force", *options)
            names = [name for name in run.names() if name.startswith("b.")]
            before = [run.read(name) for name in names]
            run.ffd("deform", "a.obj", f"b.{target}", "-l", "l.json", "-q", "--force", "--report", "r.json", *options)
            equal([run.read(name) for name in names], before, f"{target} {options}")


main()
