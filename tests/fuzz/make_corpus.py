#!/usr/bin/env python3
"""Writes the mesh files that fuzzing starts from, one for each thing that a reader knows.

    python3 tests/fuzz/make_corpus.py FOLDER [MODELS]
Makes FOLDER/obj, FOLDER/gltf and so on. With MODELS it makes them of the small models of that folder instead.
glTF text is followed by a 0 and the bytes of its first external buffer, whose name becomes m.bin."""

import base64
import copy
import json
import os
import re
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "cli"))
import foam_files as foam  # noqa: E402 (a neighbour of this folder)
import volume_files as volume  # noqa: E402
from gltf_asset import CODES, SIZES, GltfAsset  # noqa: E402 (a neighbour of this folder)

MOST_BYTES = 16384
CORNERS = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
TRIANGLES = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4]


class Builder(GltfAsset):
    def __init__(self):
        super().__init__(scene=0, scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], meshes=[], buffers=[])

    def accessor(self, rows, kind="VEC3", component=5126, bounds=False, **members):
        code = CODES[component]
        size = struct.calcsize(code) * SIZES[kind]
        gap = -size % 4 if kind != "SCALAR" else 0
        data = b"".join(struct.pack("<%d%s" % (SIZES[kind], code), *row) + b"\0" * gap for row in rows)
        view = self.view(data, **({"byteStride": size + gap} if gap else {}))
        return self.view_accessor(view, rows, kind, component, bounds, **members)

    def positions(self, rows=CORNERS, **members):
        return self.accessor(rows, bounds=True, **members)

    def indices(self, values=TRIANGLES, component=5123):
        return self.accessor([(v,) for v in values], "SCALAR", component)

    def mesh(self, *primitives, **members):
        self.asset["meshes"].append({"primitives": list(primitives), **members})
        return self

    def finished(self, uri=None):
        asset = copy.deepcopy(self.asset)
        asset["buffers"] = [{**({"uri": uri} if uri else {}), "byteLength": len(self.data)}]
        return asset


def plain():
    b = Builder()
    normals = [tuple(c * 0.5773502588272095 for c in p) for p in CORNERS]
    return b.mesh({"attributes": {"POSITION": b.positions(), "NORMAL": b.accessor(normals)}, "indices": b.indices()})


def tangents():
    b = Builder()
    return b.mesh({"attributes": {"POSITION": b.positions(), "NORMAL": b.accessor([(0, 0, 1)] * 8),
                                  "TANGENT": b.accessor([(1, 0, 0, -1)] * 8, "VEC4"),
                                  "TEXCOORD_0": b.accessor([(0, 1)] * 8, "VEC2")}, "indices": b.indices(component=5121)})


def materials():
    b = plain()
    view = b.view(b"\x89PNG\r\n\x1a\n...")
    colours = [{"baseColorFactor": [1, 0.5, 0, 1], "baseColorTexture": {"index": i}} for i in range(4)]
    b.asset |= {
        "materials": [{"name": "a", "pbrMetallicRoughness": c, "alphaMode": "MASK", "alphaCutoff": 0.25} for c in colours]
                     + [{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 1}}},
                         "alphaMode": "BLEND", "doubleSided": True}],
        "textures": [{"source": i, "sampler": 0} for i in range(3)] + [{"extensions": {"EXT_texture_webp": {"source": 0}}}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648}],
        "images": [{"uri": "m.png"}, {"uri": "data:image/png;base64,iVBORw0KGgo="}, {"bufferView": view, "name": "b"}]}
    b.asset["meshes"][0]["primitives"][0]["material"] = 2
    return b


def modes():
    b = Builder()
    position = b.positions()
    return b.mesh(*({"attributes": {"POSITION": position}, "mode": mode} for mode in range(7)))


def interleaved():
    b = Builder()
    view = b.view(b"".join(struct.pack("<6f", *p, 0, 0, 1) for p in CORNERS), byteStride=24)
    for offset in (0, 12):
        b.asset["accessors"].append({"bufferView": view, "byteOffset": offset, "componentType": 5126, "count": 8,
                                     "type": "VEC3"})
    b.asset["accessors"][0] |= {"min": [-1] * 3, "max": [1] * 3}
    return b.mesh({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": b.indices(component=5125)})


def sparse():
    b = Builder()
    for base in (True, False):
        at = b.positions() if base else len(b.asset["accessors"])
        if not base:
            b.asset["accessors"].append({"componentType": 5126, "count": 8, "type": "VEC3", "min": [0] * 3, "max": [1] * 3})
        b.asset["accessors"][at]["sparse"] = {
            "count": 2, "indices": {"bufferView": b.view(struct.pack("<2H", 1, 6)), "componentType": 5123},
            "values": {"bufferView": b.view(struct.pack("<6f", 0, 0, 1, 1, 1, 0))}}
    return b.mesh({"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 1}})


def quantized():
    b = Builder()
    b.asset |= {"extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"]}
    b.asset["nodes"] = [{"mesh": 0, "scale": [0.01, 0.01, 0.01]}]
    rows = [tuple(c * 100 for c in p) for p in CORNERS]
    return b.mesh({"attributes": {"POSITION": b.accessor(rows, component=5122, bounds=True),
                                  "NORMAL": b.accessor([(0, 0, 127)] * 8, component=5120, normalized=True)},
                   "indices": b.indices()},
                  {"attributes": {"POSITION": b.accessor([tuple((c + 1) * 127 for c in p) for p in CORNERS],
                                                         component=5121, bounds=True, normalized=True)}})


def morphs():
    b = Builder()
    targets = [{"POSITION": b.positions([(0, 0, 0.5)] * 8), "NORMAL": b.accessor([(0.1, 0, 0)] * 8)},
               {"POSITION": b.positions([(0.25 * x, 0, 0) for x, _, _ in CORNERS])}]
    return b.mesh({"attributes": {"POSITION": b.positions(), "NORMAL": b.accessor([(0, 0, 1)] * 8)},
                   "indices": b.indices(), "targets": targets}, weights=[0.5, 0], extras={"targetNames": ["a", "b"]})


def skin():
    b = Builder()
    b.asset["nodes"] = [{"mesh": 0, "skin": 0}, {"translation": [0, 0, 0.5], "children": [2]},
                        {"rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}]
    b.asset["scenes"] = [{"nodes": [0, 1]}]
    matrices = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -0.5, 1), (0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, -0.5, 1)]
    b.asset["skins"] = [{"joints": [1, 2], "skeleton": 1, "inverseBindMatrices": b.accessor(matrices, "MAT4")}]
    return b.mesh({"attributes": {"POSITION": b.positions(), "JOINTS_0": b.accessor([(0, 1, 0, 0)] * 8, "VEC4", 5121),
                                  "WEIGHTS_0": b.accessor([(0.25, 0.75, 0, 0)] * 8, "VEC4")}, "indices": b.indices()})


def skin_without_positions():
    """A second primitive that has weights only."""
    b = skin()
    primitives = b.asset["meshes"][0]["primitives"]
    primitives.append({"attributes": {"WEIGHTS_0": primitives[0]["attributes"]["WEIGHTS_0"]}, "mode": 0})
    return b


def nul_names():
    """Names that go on with U+0000."""
    b = morphs()
    primitive = b.asset["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {"NORMAL\0": primitive["attributes"].pop("NORMAL"), "POSITION\0": 1}
    primitive["targets"][1] = {"POSITION\0": primitive["targets"][1]["POSITION"]}
    b.asset["nodes"] = [{"mesh": 0, "name": "a\0b"}, {"mesh": 0, "translation": [3, 0, 0]}]
    b.asset["scenes"] = [{"nodes": [0, 1]}]
    return b


def nodes():
    b = Builder()
    b.asset["nodes"] = [{"children": [1, 2, 3]}, {"mesh": 0, "scale": [-1, 2, 0.5]},
                        {"mesh": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]},
                        {"mesh": 1, "scale": [0, 0, 0]}, {"mesh": 1, "name": "hidden"}]
    position = b.positions()
    normal = b.accessor([(0, 0, 1)] * 8)
    for _ in range(2):
        b.mesh({"attributes": {"POSITION": position, "NORMAL": normal}, "indices": b.indices(), "material": 0})
    b.asset["materials"] = [{"name": "m"}]
    return b


def instanced():
    b = Builder()
    b.asset["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    b.asset["nodes"] = [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {
        "TRANSLATION": b.accessor([(0, 0, 0), (4, 0, 0)])}}}}]
    return b.mesh({"attributes": {"POSITION": b.positions()}})


def surroundings():
    """What is in the scene beside meshes: levels of detail, a camera, a light, shapes, a joint, an animation; and splats."""
    b = Builder()
    used = ["MSFT_lod", "KHR_lights_punctual", "KHR_physics_rigid_bodies", "KHR_gaussian_splatting", "KHR_animation_pointer"]
    b.asset |= {"extensionsUsed": used, "cameras": [{}], "skins": [{"joints": [3]}],
                "extensions": {"VRMC_springBone": {"colliders": [{"node": 5}]}}, "scenes": [{"nodes": [0, 3]}]}
    b.asset["nodes"] = [{"mesh": 0, "name": "near", "children": [4], "extensions": {"MSFT_lod": {"ids": [1, 2]}}},
                        {"mesh": 0, "translation": [0.5, 0, 0], "children": [5]}, {"mesh": 0, "scale": [0.5, 1, 1]},
                        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
                        {"extensions": {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"shape": 0}}}}}, {"name": "hand\n"}]
    b.asset["animations"] = [{"samplers": [], "channels": [
        {"sampler": 0, "target": {"node": 0, "path": "rotation"}},
        {"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/4/scale"}}}}]}]
    return b.mesh({"attributes": {"POSITION": b.positions()}, "mode": 0, "extensions": {"KHR_gaussian_splatting": {}}})


def animated():
    """A skin with morph targets, and all that drives them: three interpolations, sparse and normalized values, pointers."""
    b = skin()
    primitive = b.asset["meshes"][0]["primitives"][0]
    primitive["targets"] = [{"POSITION": b.positions([(0, 0, 0.5)] * 8)}, {"POSITION": b.positions([(0.25, 0, 0)] * 8)}]
    times = b.accessor([(0,), (0.5,), (2,)], "SCALAR", bounds=True)
    values = [b.accessor([(0, 0, 0, 32767), (0, 0, 23170, 23170), (0, 0, -32767, 0)], "VEC4", 5122, normalized=True),
              b.accessor([(0, 0, i * 0.25) for i in range(9)]), b.accessor([(i * 51,) for i in range(6)], "SCALAR", 5121, normalized=True),
              len(b.asset["accessors"])]
    b.asset["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": b.view(struct.pack("<B", 1)), "componentType": 5121},
        "values": {"bufferView": b.view(struct.pack("<3f", 1, 2, 3))}}})
    kinds = ["LINEAR", "CUBICSPLINE", "STEP", "LINEAR"]
    targets = [{"node": 2, "path": "rotation"}, {"node": 1, "path": "translation"}, {"node": 0, "path": "weights"},
               {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/2/scale"}}},
               {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/0/alphaCutoff"}}}]
    b.asset |= {"extensionsUsed": ["KHR_animation_pointer"], "animations": [{
        "name": "walk\n", "samplers": [{"input": times, "output": v, "interpolation": k} for v, k in zip(values, kinds)],
        "channels": [{"sampler": min(i, 3), "target": t} for i, t in enumerate(targets)]}]}
    return b


def rigged():
    """What follows a deformation (--rig): a skin without inverse binds, a mesh and a matrix below joints, an uneven group, a
    sampler and an output of several channels, and what VRM has of it."""
    b = skin()
    del b.asset["skins"][0]["inverseBindMatrices"]
    b.asset["nodes"] = [{"mesh": 0, "skin": 0}, {"translation": [0, 0.5, 0], "children": [2, 3]},
                        {"translation": [0, 0.5, 0], "rotation": [0, 0, 0.6, 0.8], "children": [4]},
                        {"mesh": 1, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1]}, {"name": "hand"},
                        {"scale": [1, 2, 1], "children": [1]}]
    b.asset["scenes"] = [{"nodes": [0, 5]}]
    times = b.accessor([(0,), (1,)], "SCALAR", bounds=True)
    turns = b.accessor([(0, 0, 0, 1), (0.6, 0, 0, 0.8)], "VEC4")
    b.asset |= {"extensionsUsed": ["VRM"], "extensions": {"VRM": {"secondaryAnimation": {"boneGroups": []}}}, "animations": [{
        "samplers": [{"input": times, "output": turns}, {"input": times, "output": turns, "interpolation": "STEP"},
                     {"input": times, "output": b.accessor([(0, 0.5, 0), (0.25, 0.5, 0)], bounds=True)}],
        "channels": [{"sampler": s, "target": {"node": n, "path": path}} for s, n, path in
                     ((0, 1, "rotation"), (0, 2, "rotation"), (1, 4, "rotation"), (2, 1, "translation"), (2, 2, "translation"))]}]}
    return b.mesh({"attributes": {"POSITION": b.positions([(0, 0, 0), (0.5, 0, 0), (0, 0.5, 0)])}})


def strange():
    """What is carried through: extras, unknown extensions, long integers, names, images."""
    b = plain()
    b.asset |= {"extensionsUsed": ["ACME_x"], "extensions": {"ACME_x": {"n": 123456789012345678901234567890}},
                "extras": {"a\u00e4\n": [None, True, -0.0, 1e-7]}, "images": [{"uri": "none.png"}]}
    del b.asset["scene"]
    return b


def flawed():
    """What is not valid but has a plain meaning: strides and places of any number of bytes, primitives whose faces are not
    known, nodes that are named twice, a matrix with a rounding, a buffer with less than it states."""
    b = Builder()
    view = b.view(b"\0" + b"".join(struct.pack("<3fxx", *p) for p in CORNERS), byteStride=14)
    b.asset["accessors"].append({"bufferView": view, "byteOffset": 1, "componentType": 5126, "count": 8, "type": "VEC3"})
    indices = b.indices()
    b.asset["bufferViews"][-1]["byteStride"] = 0
    values = {"bufferView": b.view(struct.pack("<x6f", 0, 0, 1, 1, 1, 0)), "byteOffset": 1}
    b.asset["accessors"].append({"componentType": 5126, "count": 8, "type": "VEC3", "sparse": {
        "count": 2, "indices": {"bufferView": b.view(struct.pack("<xHH", 1, 6)), "byteOffset": 1, "componentType": 5123},
        "values": values}})
    wrong = b.accessor([(i,) for i in (0, 1, 8)], "SCALAR", 5123)
    b.asset["nodes"] = [{"children": [1, 1]}, {"mesh": 0, "matrix": [float(i % 5 == 0) for i in range(15)] + [1.000001]}]
    b.asset["scenes"] = [{"nodes": [1, 0, 0]}]
    return b.mesh({"attributes": {"POSITION": 0}, "indices": indices}, {"attributes": {"POSITION": 0}, "indices": wrong},
                  {"attributes": {"POSITION": 2}, "mode": -1}, {"attributes": {"POSITION": 0}, "indices": 0},
                  {"attributes": {"POSITION": 0}, "indices": 99})


ASSETS = [plain, tangents, modes, interleaved, sparse, quantized, morphs, skin, skin_without_positions, nul_names,
          nodes, instanced, surroundings, strange, flawed, materials, animated, rigged]


def glb_of(asset, data):
    text = json.dumps(asset, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data = data + b"\0" * (-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if data:
        chunks += struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


CUBE = "".join("v %g %g %g\n" % p for p in CORNERS)
OBJ = {
    "libraries": "mtllib a b.mtl c.mtl \\\n d.mtl\nmtllib e.mat\r\n# mtllib f.mtl\\\nmtllib g\rv 0 0 0\nusemtl h\n",
    "maps": "newmtl a\nmap_Kd -s 1 1 1 -o 0 0 0 two words.png\nbump -bm 1 b.png\nrefl -type cube_top c.png\r\n"
            "map_Ks\td.png\rmap_d -imfchan m e.png",
    "materials": "newmtl a b\nKd 0 0 0\nd -halo 0.5\nmap_Kd -clamp on m.png\nnewmtl c\nKd 0.5 1 .25\nTr 0.5\n"
                 "map_Kd /x.png\nnewmtl a b\nmap_Kd none.png\nnewmtl\nKd xyz 1 1 1\n",
    "plain": CUBE + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\n",
    "normals": "vn 0 0 1\n" + CUBE + "vn 1 0 0\nvt 0 1\nf 1/1/1 2/1/1 4/1/2\nf 1//1 3//2 4//2\nf 2 3/1 4\n",
    "negative": CUBE + "vn 0 0 1\nvn 0 1 0\nf -1//-1 -2//-1 -3//-2\nv 0 0 0\nf -1 -2 -3\nl 1 -1\np -1\n",
    "loose": CUBE.replace("\n", " \\ \n", 1) + "f 1 2 \\\t\r\n3 # \\ \nusemtl a\\ \nf 2 3 4\x1a\r\n",
    "words": "mtllib m.mtl\no a\ng b c\ns 1\nusemtl d\n" + CUBE + "s off\nf 1 2 3\ng e\nusemtl f\nf 4 5 6 7\n#x\n",
    "colours": "v 0 0 0 1 0.5 0\nv 1 0 0 1\nv 1e0 .5 -0.0 0 0 1\nf 1 2 3\n",
    "ends": "\ufeffv 0 0 0\r\nv 1 0 0\rv 0 \\\n 1 0\n\n\tv 1 1 \\\r\n1\nf 1 \\\n2 3\r\nf 2 3 4",
    "numbers": "v 1e-400 +1 -1e308\nv 0.1234567 0.12345678901234567 1E5\nv 00001 -.5 5.\nf 1 2 3\n",
    "not-finite": "v nan inf -inf\nv 0 0 0\nf 1 2 2\n",
    "free-form": CUBE + "cstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 3 4 5 6 7 8\nparm u 0 0 0 0 1 1 1 1\nend\ncurv 0 1 1 2 3 4\n",
    "many-normals": CUBE + "vn 0 0 1\n" + "f 1//1 2//1 4//1 3//1\nf 5//1 6//1 8//1 7//1\nf -8//-1 -7//-1 -3//-1 -4//-1\n",
}


def ply_files():
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4)]
    for name, order, kind, code in (("ascii", None, "float", "f"), ("ascii-double", None, "double", "d"),
                                    ("little", "<", "float", "f"), ("big", ">", "double", "d")):
        layout = {None: "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
        header = ("ply\nformat %s 1.0\ncomment c\nobj_info o\nelement vertex 8\n" % layout
                  + "".join("property %s %s\n" % (kind, axis) for axis in ("x", "y", "z", "nx", "ny", "nz"))
                  + "property uchar red\nelement face 3\nproperty list uchar int vertex_indices\n"
                  + "element extra 1\nproperty list ushort double l\nproperty int8 i\nend_header\n").encode()
        if order is None:
            body = "".join("%r %r %r 0 0 1 255\n" % p for p in CORNERS)
            body = (body + "".join("4 %d %d %d %d\n" % f for f in faces) + "2 0.5 1e9 -7\n").encode()
        else:
            body = b"".join(struct.pack(order + "6" + code + "B", *p, 0, 0, 1, 255) for p in CORNERS)
            body += b"".join(struct.pack(order + "B4i", 4, *f) for f in faces) + struct.pack(order + "Hddb", 2, 0.5, 1e9, -7)
        yield name, header + body
    yield "face-normals", b"ply\nformat ascii 1.0\nelement face 2\nproperty float nz\nproperty list uchar int vertex_indices\n" \
                          b"property float ny\nproperty double nx\nelement vertex 4\nproperty float x\nproperty float y\n" \
                          b"property float z\nend_header\n1 3 0 1 2 0 0\n-1 4 0 1 2 3 0 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    yield "strips", b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" \
                    b"element tristrips 2\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 1\n" \
                    b"4 0 1 3 2\n9 3 2 1 -1 0 0 1 2 3\n"
    yield "marks", b"\xef\xbb\xbfply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" \
                   b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" \
                   b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\x1a"
    yield "plain", b"ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty double x\r\nproperty float y\r\n" \
                   b"property short z\r\nelement face 0\r\nproperty list uchar uint vertex_index\r\nend_header\r\n1 2 3\r\n"


OFF = {
    "plain": "OFF\n8 3 0\n" + "".join("%g %g %g\n" % p for p in CORNERS) + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n",
    "colours": "COFF # c\n\n3 1 3\n0 0 0 1 0 0 1\n1 0 0 0 255 0 255\n# x\n0 1 0 0.5 0.5 0.5 1\n3 0 1 2 0.1 0.2 0.3\n",
    "normals": "NOFF\r\n3 1 0\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 0 0 1 0\r\n3 0 1 2 255 0 0\r\n",
    "mark": "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\x1a\n",
    "headless": "3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2",
}

STL_TEXT = ("solid a b\n" + "".join(
    " facet normal 0 0 1\n  outer loop\n" + "".join("   vertex %g %g %ge0\n" % CORNERS[c] for c in TRIANGLES[i:i + 3])
    + "  endloop\n endfacet\n" for i in range(0, 18, 3)) + "endsolid a b\n")
STL_BYTES = b"header".ljust(80, b" ") + struct.pack("<I", 6) + b"".join(
    struct.pack("<12fH", 0, 0, 1, *(x for c in TRIANGLES[i:i + 3] for x in CORNERS[c]), i) for i in range(0, 18, 3))


def of_volumes():
    for kind, is_binary in (("text", False), ("bytes", True)):
        yield "vtk", kind, volume.vtk(is_binary=is_binary)
        yield "vtk", "offsets-" + kind, volume.vtk(is_binary=is_binary, kind="double", offsets=True)
        yield "vtk", "polygons-" + kind, volume.vtk_polygons(is_binary=is_binary)
    yield "vtk", "grid", volume.vtk_grid()
    yield "vtk", "polyhedra", volume.vtk_polyhedra()
    yield "vtk", "kinds", volume.vtk_kinds()
    yield "su2", "plain", volume.su2(boxes=1)
    yield "su2", "flat", volume.su2_flat()
    yield "su2", "zones", volume.su2_zones()
    for encoding in volume.ENCODINGS:
        name = encoding.replace(" ", "-")
        yield "vtu", name, volume.vtu(encoding=encoding)
        yield "vtp", name, volume.vtp(encoding=encoding, order=">", word="Q")
        yield "vts", name, volume.vts(encoding=encoding, size=(3, 2, 2))
    for kind, is_binary in (("text", False), ("bytes", True)):
        yield "msh", "old-" + kind, volume.msh2(is_binary=is_binary)
        yield "msh", "old-parameters-" + kind, volume.msh2(is_binary=is_binary, parameters=True)
        yield "msh", "new-" + kind, volume.msh4(is_binary=is_binary, parameters=True)
    yield "msh", "tags", volume.msh2(tags=list(range(100, 0, -10)))
    yield "vtu", "polyhedra", volume.vtu_polyhedra(False)
    yield "vtu", "listed-faces", volume.vtu_polyhedra(True)
    yield "vtu", "pieces", volume.vtu(volume.POINTS * 2, pieces=2)
    for name, made in foam.ENCODINGS.items():
        yield "foam", name.replace(" ", "-"), foam.joined(made.files())
    yield "foam", "points", foam.Foam().points()
    yield "foam", "one-place", foam.Foam().header("vectorField", "points") + b"9{(0 0.5 1)}\n"


def crafted():
    for make in ASSETS:
        asset = make()
        name = make.__name__
        yield "glb", name, glb_of(asset.finished(), asset.data)
        yield "gltf", name, json.dumps(asset.finished("m.bin"), indent=1).encode() + b"\0" + asset.data
        if make is plain:
            yield "gltf", "data", json.dumps(asset.finished(data_uri(asset.data))).encode()
            odd = json.dumps(asset.finished(data_uri(asset.data).replace(";base64,", "; BASE64 ,").replace("A", " A")))
            yield "gltf", "data-odd", odd.replace('"byteLength": %d' % len(asset.data), '"byteLength": 100000').encode()
            yield "gltf", "backslash", json.dumps(asset.finished(".\\m.bin")).encode() + b"\0" + asset.data
            yield "glb", "none", glb_of({"asset": {"version": "2.0"}}, b"")
    for name, text in OBJ.items():
        yield "obj", name, text.encode()
    for name, data in ply_files():
        yield "ply", name, data
    for name, text in OFF.items():
        yield "off", name, text.encode()
    yield "stl", "text", STL_TEXT.encode()
    yield "stl", "loose", STL_TEXT.replace("\n", "\ncolor 0.5 0 1\n", 1).replace("endsolid", "end solid").encode() + b"\x1a"
    yield "stl", "bytes", STL_BYTES
    yield from of_volumes()


def of_models(models):
    for folder, _, names in sorted(os.walk(models)):
        for name in sorted(names):
            path = os.path.join(folder, name)
            stem, ending = os.path.splitext(name)
            kind = ending[1:].lower()
            if kind not in ("obj", "gltf", "glb", "ply", "off", "stl", "vtk", "su2", "vtu", "vtp", "vts", "msh") or os.path.getsize(path) > MOST_BYTES:
                continue
            with open(path, "rb") as file:
                data = file.read()
            buffer = re.search(rb'"uri"\s*:\s*"([^":]*\.bin)"', data) if kind == "gltf" else None
            if buffer:
                try:
                    with open(os.path.join(folder, buffer.group(1).decode()), "rb") as file:
                        data = data.replace(buffer.group(1), b"m.bin") + b"\0" + file.read()
                except OSError:
                    continue
            if len(data) <= MOST_BYTES:
                yield kind, stem, data


def main():
    folder = sys.argv[1]
    for kind, name, data in of_models(sys.argv[2]) if len(sys.argv) > 2 else crafted():
        os.makedirs(os.path.join(folder, kind), exist_ok=True)
        with open(os.path.join(folder, kind, name), "wb") as file:
            file.write(data)


main()
