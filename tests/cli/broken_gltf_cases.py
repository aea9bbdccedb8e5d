"""Crafted glTF files: at least one for each code of the Khronos glTF validator's list of issues that says
something of what ffd reads: the container, the JSON, buffers, accessors, meshes, skins, nodes and scenes. Codes
about cameras, materials, textures, images and the values of animations say nothing of that."""

import base64
import copy
import json
import struct

from gltf_asset import CODES, FLOAT, SHORT, SIZES, UBYTE, UINT, USHORT, GltfAsset
from harness import IO, INVALID, OK, UNSUPPORTED, pad

CORNERS = [(x, y, z) for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
CORNER_NORMALS = [tuple(c * 0.5773502691896258 for c in p) for p in CORNERS]
TRIANGLES = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4]
JSON, BIN = 0x4E4F534A, 0x004E4942


class Model(GltfAsset):
    """A cube of triangles with normals that a case changes before it becomes a file."""

    def __init__(self):
        super().__init__(scene=0, scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], meshes=[], buffers=[{}])
        position = self.add(CORNERS, bounds=True)
        self.primitive = {"attributes": {"POSITION": position, "NORMAL": self.add(CORNER_NORMALS)},
                          "indices": self.add(TRIANGLES, "SCALAR", USHORT, target=34963)}
        self.asset["meshes"] = [{"primitives": [self.primitive]}]

    def add(self, rows, kind="VEC3", component=FLOAT, bounds=False, target=34962, **members):
        rows = [row if isinstance(row, (tuple, list)) else (row,) for row in rows]
        data = b"".join(struct.pack(f"<{SIZES[kind]}{CODES[component]}", *row) for row in rows)
        view = self.view(data, **({"target": target} if target else {}))
        return self.view_accessor(view, rows, kind, component, bounds, **members)

    def set(self, path, value):
        place = self.asset
        *way, last = [int(key) if key.isdigit() else key for key in path.split("/")]
        for key in way:
            place = place[key]
        if value is None:
            del place[last]
        else:
            place[last] = value
        return self

    def put(self, view, offset, form, *values):
        """Other bytes into a bufferView."""
        struct.pack_into(form, self.data, self.asset["bufferViews"][view]["byteOffset"] + offset, *values)
        return self

    def morph(self, rows=None, **attributes):
        rows = rows or [(0.0, 0.0, 0.5)] * 8
        self.primitive["targets"] = [{"POSITION": self.add(rows, bounds=True), **attributes}]
        return self

    def skin(self):
        self.primitive["attributes"] |= {"JOINTS_0": self.add([(0, 1, 0, 0)] * 8, "VEC4", UBYTE),
                                         "WEIGHTS_0": self.add([(0.25, 0.75, 0, 0)] * 8, "VEC4")}
        unit = tuple(float(i % 5 == 0) for i in range(16))
        self.asset["nodes"] = [{"mesh": 0, "skin": 0}, {"children": [2]}, {}]
        self.asset["scenes"][0]["nodes"] = [0, 1]
        self.asset["skins"] = [{"joints": [1, 2], "inverseBindMatrices": self.add([unit] * 2, "MAT4", target=None)}]
        return self

    def sparse(self, indices=(1, 6)):
        self.asset["accessors"][0]["sparse"] = {
            "count": len(indices),
            "indices": {"bufferView": self.view(struct.pack(f"<{len(indices)}H", *indices)), "componentType": USHORT},
            "values": {"bufferView": self.view(struct.pack("<3f", 1, 1, 1) * len(indices))}}
        return self

    def text(self, uri=None):
        asset = copy.deepcopy(self.asset)
        if asset.get("buffers"):
            asset["buffers"][0] = {"byteLength": len(self.data), **({"uri": uri} if uri else {}),
                                   **asset["buffers"][0]}
        return json.dumps(asset).encode()

    def glb(self):
        return glb_of((JSON, pad(self.text(), b" ")), (BIN, pad(bytes(self.data), b"\0")))

    def gltf(self, kind="application/octet-stream"):
        return self.text(f"data:{kind};base64," + base64.b64encode(self.data).decode())


def glb_of(*chunks, magic=0x46546C67, version=2, length=None):
    body = b"".join(struct.pack("<II", len(data), kind) + data for kind, data in chunks)
    return struct.pack("<III", magic, version, 12 + len(body) if length is None else length) + body


def chunks_of(model):
    return (JSON, pad(model.text(), b" ")), (BIN, pad(bytes(model.data), b"\0"))


def changed(path, value):
    return lambda: Model().set(path, value).glb()


def made(change):
    """A file of the model that change, a function of it, has changed."""
    def make():
        model = Model()
        change(model)
        return model.glb()
    return make


def container(change):
    return lambda: change(Model())


def quantized(model, **members):
    view = model.view(struct.pack("<4h", 100, 100, 100, 0) * 8, byteStride=8, target=34962)
    model.primitive["attributes"]["POSITION"] = model.view_accessor(view, [(100, 100, 100)] * 8, "VEC3", SHORT, True, **members)


def shared_view(model):
    model.asset["accessors"][1]["bufferView"] = 0


def unaligned_view(model):
    model.data[0:0] = b"\0" * 2
    for view in model.asset["bufferViews"]:
        view["byteOffset"] += 2


def spread(stride, first=0):
    """The positions at bytes of their own choice."""
    def make():
        model = Model()
        rows = b"".join(struct.pack("<3f", *p).ljust(stride, b"\0") for p in CORNERS)
        view = model.view(b"\0" * first + rows, target=34962, **({"byteStride": stride} if stride != 12 else {}))
        return model.set("accessors/0/bufferView", view).set("accessors/0/byteOffset", first).glb()
    return make


def stride(view, value):
    return made(lambda m: m.set(f"bufferViews/{view}/byteStride", value))


# In place of an exit code: the meaning is plain. A warning and a flaw in the report; INVALID with --strict.
PLAIN = "plain"
# Likewise, but nothing that ffd reads or writes depends on it: no word, and INVALID with --strict.
FORMAL = "formal"

# Code of the validator, exit code of ffd deform, what is crafted, the file's ending, the function that makes it.
CASES = [
    # Input and output, JSON schema.
    ("IO_ERROR", IO, "the buffer's file is not there", ".gltf", lambda: Model().text("none.bin")),
    ("ARRAY_LENGTH_NOT_IN_LIST", FORMAL, "a min of 2 numbers", ".glb", changed("accessors/0/min", [-1, -1])),
    ("ARRAY_LENGTH_NOT_IN_LIST", INVALID, "a matrix of 15 numbers", ".glb", changed("nodes/0/matrix", [1.0] * 15)),
    ("INVALID_INDEX", INVALID, "a child that is a text", ".glb", changed("nodes/0/children", ["x"])),
    ("ARRAY_TYPE_MISMATCH", INVALID, "a mesh that is a number", ".glb", changed("meshes", [1])),
    ("DUPLICATE_ELEMENTS", PLAIN, "a root twice", ".glb", changed("scenes/0/nodes", [0, 0])),
    ("DUPLICATE_ELEMENTS", PLAIN, "a child twice", ".glb",
     made(lambda m: m.set("nodes", [{"children": [1, 1]}, {"mesh": 0}]))),
    ("EMPTY_ENTITY", PLAIN, "no primitives", ".glb", changed("meshes/0/primitives", [])),
    ("EMPTY_ENTITY", FORMAL, "no animations", ".glb", changed("animations", [])),
    ("EMPTY_ENTITY", FORMAL, "no children", ".glb", changed("nodes/0/children", [])),
    ("EMPTY_ENTITY", FORMAL, "no attributes", ".glb", changed("meshes/0/primitives/0/attributes", {})),
    ("EMPTY_ENTITY", FORMAL, "a morph target of nothing", ".glb", made(lambda m: m.morph().set("meshes/0/primitives/0/targets/0", {}))),
    ("INVALID_INDEX", INVALID, "a negative mesh", ".glb", changed("nodes/0/mesh", -1)),
    ("INVALID_INDEX", INVALID, "a negative accessor", ".glb", changed("meshes/0/primitives/0/attributes/POSITION", -1)),
    ("INVALID_JSON", INVALID, "an end too early", ".gltf", lambda: Model().gltf()[:-1]),
    ("INVALID_JSON", INVALID, "bytes that are no UTF-8", ".gltf",
     lambda: Model().gltf().replace(b'"asset"', b'"x\xff":1,"asset"')),
    ("INVALID_URI", IO, "a buffer's URI that is not a URI", ".gltf", lambda: Model().text("http://[x")),
    ("PATTERN_MISMATCH", INVALID, "a version that is none", ".glb", changed("asset/version", "two")),
    ("TYPE_MISMATCH", INVALID, "a count that is a text", ".glb", changed("accessors/0/count", "8")),
    ("TYPE_MISMATCH", INVALID, "nodes that are an object", ".glb", changed("nodes", {})),
    ("TYPE_MISMATCH", INVALID, "a byteOffset with a fraction", ".glb", changed("bufferViews/0/byteOffset", 0.5)),
    ("TYPE_MISMATCH", INVALID, "a translation of words", ".glb", changed("nodes/0/translation", "xyz")),
    ("UNDEFINED_PROPERTY", INVALID, "no version", ".glb", changed("asset/version", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no count", ".glb", changed("accessors/0/count", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no type", ".glb", changed("accessors/0/type", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no primitives", ".glb", changed("meshes/0/primitives", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no attributes", ".glb", changed("meshes/0/primitives/0/attributes", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no byteLength of a view", ".glb", changed("bufferViews/0/byteLength", None)),
    ("UNDEFINED_PROPERTY", INVALID, "no joints", ".glb", made(lambda m: m.skin().set("skins/0/joints", None))),
    ("UNEXPECTED_PROPERTY", OK, "a property of nobody's", ".glb", changed("accessors/0/colour", 1)),
    ("UNSATISFIED_DEPENDENCY", FORMAL, "a byteOffset without view", ".glb",
     made(lambda m: m.set("accessors/1/bufferView", None).set("accessors/1/byteOffset", 4))),
    ("VALUE_MULTIPLE_OF", PLAIN, "a stride of 14", ".glb", spread(14)),
    ("VALUE_NOT_IN_LIST", INVALID, "a component type of nobody's", ".glb", changed("accessors/0/componentType", 5124)),
    ("VALUE_NOT_IN_LIST", INVALID, "VEC5", ".glb", changed("accessors/0/type", "VEC5")),
    ("VALUE_NOT_IN_RANGE", PLAIN, "mode 7", ".glb", changed("meshes/0/primitives/0/mode", 7)),
    ("VALUE_NOT_IN_RANGE", INVALID, "a count of 0", ".glb", changed("accessors/0/count", 0)),
    ("VALUE_NOT_IN_RANGE", INVALID, "a negative byteLength", ".glb", changed("bufferViews/0/byteLength", -1)),
    ("VALUE_NOT_IN_RANGE", INVALID, "a stride of 256", ".glb", stride(0, 256)),
    ("VALUE_NOT_IN_RANGE", PLAIN, "a stride of 0", ".glb", stride(0, 0)),
    ("VALUE_NOT_IN_RANGE", PLAIN, "mode -1", ".glb", changed("meshes/0/primitives/0/mode", -1)),
    ("VALUE_NOT_IN_RANGE", INVALID, "a stride of 256 in a view of nobody's", ".glb",
     made(lambda m: m.view(bytes(512), byteStride=256))),
    ("VALUE_NOT_IN_RANGE", FORMAL, "a sparse count of 0", ".glb",
     made(lambda m: m.sparse().set("accessors/0/sparse/count", 0))),

    # Accessors, buffers and their views.
    ("ACCESSOR_NORMALIZED_INVALID", PLAIN, "normalized floats", ".glb", changed("accessors/1/normalized", True)),
    ("ACCESSOR_OFFSET_ALIGNMENT", PLAIN, "an offset of 2 for floats", ".glb", spread(12, 2)),
    ("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", PLAIN, "sparse values at 2 bytes of 4", ".glb",
     made(lambda m: m.sparse().set("accessors/0/sparse/values/byteOffset", 2) and m.data.extend(b"\0\0")
          or m.set(f"bufferViews/{len(m.asset['bufferViews']) - 1}/byteLength", 26))),
    ("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", INVALID, "9 sparse values of 8", ".glb",
     made(lambda m: m.sparse(tuple(range(9))))),
    ("ACCESSOR_SPARSE_INDEX_OOB", INVALID, "a sparse value of element 8 of 8", ".glb", made(lambda m: m.sparse((1, 8)))),
    ("ACCESSOR_SPARSE_INDICES_NON_INCREASING", INVALID, "sparse indices 6, 1", ".glb", made(lambda m: m.sparse((6, 1)))),
    ("ACCESSOR_SPARSE_INDICES_NON_INCREASING", INVALID, "a sparse index twice", ".glb", made(lambda m: m.sparse((6, 6)))),
    ("ACCESSOR_SMALL_BYTESTRIDE", INVALID, "a stride of 8 for 12 bytes", ".glb", stride(0, 8)),
    ("ACCESSOR_TOO_LONG", INVALID, "9 elements of 8", ".glb", changed("accessors/0/count", 9)),
    ("ACCESSOR_TOO_LONG", INVALID, "2^31 elements", ".glb", changed("accessors/0/count", 2**31)),
    ("ACCESSOR_TOO_LONG", INVALID, "2^53 - 1 elements", ".glb", changed("accessors/0/count", 2**53 - 1)),
    ("ACCESSOR_TOO_LONG", INVALID, "an offset of 2^53 - 4", ".glb", changed("accessors/0/byteOffset", 2**53 - 4)),
    ("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", PLAIN, "views at 2 bytes of 4", ".glb", made(unaligned_view)),
    ("ACCESSOR_INVALID_FLOAT", FORMAL, "a position that is NaN", ".glb",
     made(lambda m: m.put(0, 12, "<f", float("nan")))),
    ("ACCESSOR_INVALID_FLOAT", FORMAL, "a position that is infinite", ".glb",
     made(lambda m: m.put(0, 12, "<f", float("-inf")))),
    ("ACCESSOR_INVALID_FLOAT", OK, "a normal that is NaN", ".glb",
     made(lambda m: m.put(1, 12, "<f", float("nan")))),
    ("ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", PLAIN, "a position beyond max", ".glb", changed("accessors/0/max", [1, 1, 0.5])),
    ("ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", PLAIN, "a position beyond min", ".glb", changed("accessors/0/min", [-1, -0.5, -1])),
    ("ACCESSOR_MAX_MISMATCH", FORMAL, "a max that is not reached", ".glb", changed("accessors/0/max", [1, 1, 2])),
    ("ACCESSOR_MIN_MISMATCH", FORMAL, "a min that is not reached", ".glb", changed("accessors/0/min", [-1, -1, -2])),
    ("ACCESSOR_VECTOR3_NON_UNIT", OK, "a normal of length 2", ".glb", made(lambda m: m.put(1, 0, "<3f", 0, 0, 2))),
    ("ACCESSOR_INVALID_SIGN", OK, "a tangent of handedness 0.5", ".glb",
     made(lambda m: m.primitive["attributes"].update(TANGENT=m.add([(1, 0, 0, 0.5)] * 8, "VEC4")))),
    ("ACCESSOR_INDEX_OOB", PLAIN, "a triangle of vertex 8 of 8", ".glb", made(lambda m: m.put(2, 4, "<H", 8))),
    ("ACCESSOR_INDEX_PRIMITIVE_RESTART", PLAIN, "an index of 65535", ".glb",
     made(lambda m: m.put(2, 4, "<H", 65535))),
    ("ACCESSOR_INDEX_TRIANGLE_DEGENERATE", OK, "a triangle of one vertex", ".glb",
     made(lambda m: m.put(2, 0, "<3H", 0, 0, 0))),
    ("BUFFER_BYTE_LENGTH_MISMATCH", PLAIN, "a data URI that is too short", ".gltf",
     lambda: Model().set("buffers/0/byteLength", 4096).gltf()),
    ("BUFFER_BYTE_LENGTH_MISMATCH", INVALID, "a buffer's file that is too short", ".gltf",
     lambda: Model().set("buffers/0/byteLength", 4096).text("short.bin")),
    ("BUFFER_GLB_CHUNK_TOO_BIG", PLAIN, "a BIN chunk with 8 bytes more", ".glb",
     container(lambda m: glb_of(chunks_of(m)[0], (BIN, chunks_of(m)[1][1] + b"\0" * 8)))),
    ("BUFFER_MISSING_GLB_DATA", UNSUPPORTED, "no BIN chunk", ".glb", container(lambda m: glb_of(chunks_of(m)[0]))),
    ("BUFFER_VIEW_INVALID_BYTE_STRIDE", PLAIN, "a stride of indices", ".glb",
     made(lambda m: m.set("bufferViews/2/byteStride", 4).set("accessors/2/count", 9))),
    ("BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", INVALID, "a stride of 252 in 96 bytes", ".glb", stride(0, 252)),
    ("BUFFER_VIEW_TOO_LONG", INVALID, "a view longer than the buffer", ".glb", changed("bufferViews/0/byteLength", 10**6)),
    ("BUFFER_VIEW_TOO_LONG", INVALID, "a view that begins at 2^53 - 1", ".glb",
     changed("bufferViews/0/byteOffset", 2**53 - 1)),
    ("BUFFER_VIEW_TARGET_OVERRIDE", FORMAL, "a view of vertices and of indices", ".glb",
     changed("bufferViews/2/target", 34962)),
    ("BUFFER_VIEW_TARGET_OVERRIDE", FORMAL, "a view of indices that holds positions", ".glb",
     changed("bufferViews/0/target", 34963)),
    ("BUFFER_VIEW_TARGET_OVERRIDE", FORMAL, "a view without target that holds normals and indices", ".glb",
     made(lambda m: m.set("bufferViews/1/target", None).set("accessors/2", {
         "bufferView": 1, "componentType": USHORT, "count": 18, "type": "SCALAR"})
          and m.put(1, 0, "<18H", *TRIANGLES))),
    ("BUFFER_VIEW_TARGET_MISSING", OK, "a view without target", ".glb", changed("bufferViews/0/target", None)),

    # Meshes.
    ("MESH_INVALID_WEIGHTS_COUNT", PLAIN, "2 weights of 1 target", ".glb",
     made(lambda m: m.morph().set("meshes/0/weights", [0.5, 0.5]))),
    ("MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", PLAIN, "targets in one of 2 primitives", ".glb",
     made(lambda m: m.asset["meshes"][0]["primitives"].append(copy.deepcopy(m.primitive)) or m.morph())),
    ("MESH_PRIMITIVE_INVALID_ATTRIBUTE", FORMAL, "an attribute of nobody's", ".glb",
     made(lambda m: m.primitive["attributes"].update(COLOUR=1))),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", FORMAL, "texture coordinates of 3 numbers", ".glb",
     made(lambda m: m.primitive["attributes"].update(TEXCOORD_0=m.add([(0, 0, 0)] * 8)))),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", FORMAL, "texture coordinates that are whole numbers", ".glb",
     made(lambda m: m.primitive["attributes"].update(TEXCOORD_0=m.add([(0, 0)] * 8, "VEC2", SHORT)))),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", FORMAL, "colours of 2 numbers", ".glb",
     made(lambda m: m.primitive["attributes"].update(COLOR_0=m.add([(0, 0)] * 8, "VEC2")))),
    ("MESH_PRIMITIVE_INVALID_ATTRIBUTE", FORMAL, "weights in a morph target", ".glb",
     made(lambda m: m.skin().morph(WEIGHTS_0=m.add([(0, 0, 0)] * 8)))),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", FORMAL, "colours with a sign", ".glb",
     made(lambda m: m.primitive["attributes"].update(COLOR_0=m.add([(0, 0, 0, 0)] * 8, "VEC4", SHORT, normalized=True)))),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", FORMAL, "an attribute of one's own in 32 bits", ".glb",
     made(lambda m: m.primitive["attributes"].update(_ID=m.add(range(8), "SCALAR", UINT)))),
    ("MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", FORMAL, "texture coordinates 1 without 0", ".glb",
     made(lambda m: m.primitive["attributes"].update(TEXCOORD_1=m.add([(0, 0)] * 8, "VEC2")))),
    ("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", PLAIN, "joints without weights", ".glb",
     made(lambda m: m.skin().set("meshes/0/primitives/0/attributes/WEIGHTS_0", None))),
    ("MESH_PRIMITIVE_NO_POSITION", OK, "no positions", ".glb", changed("meshes/0/primitives/0/attributes/POSITION", None)),
    ("MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL", OK, "tangents alone", ".glb",
     made(lambda m: m.set("meshes/0/primitives/0/attributes/NORMAL", None) and m.primitive["attributes"].update(
         TANGENT=m.add([(1, 0, 0, 1)] * 8, "VEC4")))),
    ("MESH_PRIMITIVE_ACCESSOR_UNALIGNED", FORMAL, "texture coordinates at odd bytes", ".glb",
     made(lambda m: m.primitive["attributes"].update(TEXCOORD_0=m.add([(0, 0)] * 9, "VEC2", UBYTE, normalized=True))
          or m.set("accessors/3/count", 8).set("bufferViews/3/byteOffset", len(m.data) - 17).set(
              "bufferViews/3/byteLength", 17))),
    ("MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", FORMAL, "two accessors of one view", ".glb", made(shared_view)),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", PLAIN, "positions of whole numbers", ".glb", made(quantized)),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", INVALID, "positions of 4 numbers", ".glb",
     made(lambda m: m.primitive["attributes"].update(POSITION=m.add([(1, 1, 1, 1)] * 8, "VEC4")))),
    ("MESH_PRIMITIVE_INCOMPATIBLE_MODE", OK, "17 corners of triangles", ".glb", changed("accessors/2/count", 17)),
    ("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", PLAIN, "indices that are floats", ".glb",
     changed("meshes/0/primitives/0/indices", 0)),
    ("MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", PLAIN, "a stride of indices", ".glb",
     made(lambda m: m.set("bufferViews/2/byteStride", 4).set("accessors/2/count", 9))),
    ("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", INVALID, "a target of 7 vertices", ".glb",
     made(lambda m: m.morph([(0.0, 0.0, 0.5)] * 7))),
    ("MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", FORMAL, "a target's tangents alone", ".glb",
     made(lambda m: m.morph(TANGENT=m.add([(0, 0, 0)] * 8)))),
    ("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", PLAIN, "no min and max", ".glb",
     made(lambda m: m.set("accessors/0/min", None).set("accessors/0/max", None))),
    ("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", INVALID, "7 normals of 8 vertices", ".glb", changed("accessors/1/count", 7)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such accessor", ".glb", changed("meshes/0/primitives/0/attributes/POSITION", 9)),
    ("UNRESOLVED_REFERENCE", PLAIN, "no such material", ".glb", changed("meshes/0/primitives/0/material", 0)),
    ("UNRESOLVED_REFERENCE", PLAIN, "no such indices", ".glb", changed("meshes/0/primitives/0/indices", 9)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such target", ".glb",
     made(lambda m: m.set("meshes/0/primitives/0/targets", [{"POSITION": 9}]))),
    ("UNRESOLVED_REFERENCE", INVALID, "no such bufferView", ".glb", changed("accessors/0/bufferView", 9)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such buffer", ".glb", changed("bufferViews/0/buffer", 9)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such mesh", ".glb", changed("nodes/0/mesh", 9)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such child", ".glb", changed("nodes/0/children", [9])),
    ("UNRESOLVED_REFERENCE", INVALID, "no such root", ".glb", changed("scenes/0/nodes", [9])),
    ("UNRESOLVED_REFERENCE", INVALID, "no such scene", ".glb", changed("scene", 9)),
    ("UNRESOLVED_REFERENCE", INVALID, "no such skin", ".glb", made(lambda m: m.skin().set("nodes/0/skin", 9))),
    ("UNRESOLVED_REFERENCE", INVALID, "no such joint", ".glb", made(lambda m: m.skin().set("skins/0/joints", [1, 9]))),
    ("UNRESOLVED_REFERENCE", INVALID, "no such bind matrices", ".glb",
     made(lambda m: m.skin().set("skins/0/inverseBindMatrices", 99))),
    ("UNRESOLVED_REFERENCE", INVALID, "no such sparse values", ".glb",
     made(lambda m: m.sparse().set("accessors/0/sparse/values/bufferView", 99))),

    # Nodes, skins, scenes.
    ("NODE_EMPTY", OK, "an empty node", ".glb", made(lambda m: m.asset["nodes"].append({}))),
    ("NODE_LOOP", INVALID, "a node that is its own child", ".glb", changed("nodes/0/children", [0])),
    ("NODE_LOOP", INVALID, "three nodes in a circle", ".glb",
     made(lambda m: m.set("nodes", [{"mesh": 0}, {"children": [2]}, {"children": [3]}, {"children": [1]}]))),
    ("NODE_PARENT_OVERRIDE", INVALID, "a node of two parents", ".glb",
     made(lambda m: m.set("nodes", [{"children": [2]}, {"children": [2]}, {"mesh": 0}]).set("scenes/0/nodes", [0, 1]))),
    ("NODE_MATRIX_DEFAULT", OK, "a matrix that does nothing", ".glb",
     changed("nodes/0/matrix", [float(i % 5 == 0) for i in range(16)])),
    ("NODE_MATRIX_NON_TRS", PLAIN, "a matrix that shears", ".glb",
     changed("nodes/0/matrix", [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])),
    ("NODE_MATRIX_TRS", PLAIN, "a matrix and a translation", ".glb",
     made(lambda m: m.set("nodes/0/matrix", [2.0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]).set(
         "nodes/0/translation", [0, 0, 1]))),
    ("ROTATION_NON_UNIT", PLAIN, "a rotation of length 0.7", ".glb", changed("nodes/0/rotation", [0, 0, 0.5, 0.5])),
    ("NODE_SKINNED_MESH_WITHOUT_SKIN", OK, "a skinned mesh without skin", ".glb",
     made(lambda m: m.skin().set("nodes/0/skin", None))),
    ("NODE_SKIN_WITH_NON_SKINNED_MESH", PLAIN, "a skin without joints and weights", ".glb",
     made(lambda m: [m.skin(), m.set("meshes/0/primitives/0/attributes/JOINTS_0", None),
                     m.set("meshes/0/primitives/0/attributes/WEIGHTS_0", None)])),
    ("NODE_WEIGHTS_INVALID", PLAIN, "2 weights of 1 target", ".glb",
     made(lambda m: m.morph().set("nodes/0/weights", [0.5, 0.5]))),
    ("SCENE_NON_ROOT_NODE", PLAIN, "a root that has a parent", ".glb",
     made(lambda m: m.set("nodes", [{"children": [1]}, {"mesh": 0}]).set("scenes/0/nodes", [0, 1]))),
    ("INVALID_IBM_ACCESSOR_COUNT", INVALID, "1 bind matrix of 2 joints", ".glb",
     made(lambda m: m.skin().set(f"accessors/{len(m.asset['accessors']) - 1}/count", 1))),
    ("SKIN_IBM_INVALID_FORMAT", INVALID, "bind matrices that are vectors", ".glb",
     made(lambda m: m.skin().set("skins/0/inverseBindMatrices", 0))),
    ("ACCESSOR_JOINTS_INDEX_OOB", INVALID, "joint 2 of 2", ".glb",
     made(lambda m: m.skin().put(3, 1, "<B", 2))),
    ("ACCESSOR_WEIGHTS_NON_NORMALIZED", PLAIN, "weights of sum 0.5", ".glb",
     made(lambda m: m.skin().put(4, 0, "<2f", 0.25, 0.25))),
    ("ACCESSOR_WEIGHTS_NEGATIVE", PLAIN, "a negative weight", ".glb",
     made(lambda m: m.skin().put(4, 0, "<2f", -0.25, 1.25))),

    # Versions and extensions.
    ("UNKNOWN_ASSET_MAJOR_VERSION", UNSUPPORTED, "glTF 3.0", ".glb", changed("asset/version", "3.0")),
    ("UNKNOWN_ASSET_MINOR_VERSION", OK, "glTF 2.7", ".glb", changed("asset/version", "2.7")),
    ("ASSET_MIN_VERSION_GREATER_THAN_VERSION", UNSUPPORTED, "needs a reader of 2.5", ".glb",
     changed("asset/minVersion", "2.5")),
    ("UNDECLARED_EXTENSION", FORMAL, "an extension that is not declared", ".glb", changed("nodes/0/extensions", {"ACME_x": {}})),
    ("UNDECLARED_EXTENSION", FORMAL, "an extension within one that is declared", ".glb",
     made(lambda m: m.set("extensionsUsed", ["KHR_materials_clearcoat"]).set("textures", [{}]).set("materials", [
         {"extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0, "extensions": {"ACME_y": {}}}}}}]))),
    ("UNSUPPORTED_EXTENSION", OK, "an extension of nobody's", ".glb",
     made(lambda m: m.set("extensionsUsed", ["ACME_x"]).set("nodes/0/extensions", {"ACME_x": {}}))),
    ("UNSUPPORTED_EXTENSION", UNSUPPORTED, "a required extension of nobody's", ".glb",
     made(lambda m: m.set("extensionsUsed", ["ACME_x"]).set("extensionsRequired", ["ACME_x"]).set(
         "nodes/0/extensions", {"ACME_x": {}}))),
    ("UNSATISFIED_DEPENDENCY", PLAIN, "a required extension that is not used", ".glb",
     changed("extensionsRequired", ["KHR_materials_unlit"])),

    # The GLB container.
    ("GLB_CHUNK_LENGTH_UNALIGNED", PLAIN, "a JSON chunk of odd length", ".glb",
     container(lambda m: glb_of((JSON, m.text() + b" " * (1 + -len(m.text()) % 4)), chunks_of(m)[1]))),
    ("GLB_CHUNK_TOO_BIG", INVALID, "a chunk of 2^32 - 4 bytes", ".glb",
     container(lambda m: m.glb()[:12] + struct.pack("<I", 2**32 - 4) + m.glb()[16:])),
    ("GLB_DUPLICATE_CHUNK", PLAIN, "two BIN chunks", ".glb", container(lambda m: glb_of(*chunks_of(m), chunks_of(m)[1]))),
    ("GLB_EMPTY_CHUNK", INVALID, "an empty JSON chunk", ".glb", container(lambda m: glb_of((JSON, b""), chunks_of(m)[1]))),
    ("GLB_INVALID_MAGIC", INVALID, "another magic", ".glb", container(lambda m: glb_of(*chunks_of(m), magic=0x46546C68))),
    ("GLB_INVALID_VERSION", UNSUPPORTED, "version 1", ".glb", container(lambda m: glb_of(*chunks_of(m), version=1))),
    ("GLB_EXTRA_DATA", PLAIN, "4 bytes behind the length", ".glb", container(lambda m: m.glb() + b"junk")),
    ("GLB_LENGTH_MISMATCH", INVALID, "a length beyond the file", ".glb",
     container(lambda m: glb_of(*chunks_of(m), length=10**6))),
    ("GLB_LENGTH_TOO_SMALL", INVALID, "a length of 8", ".glb", container(lambda m: glb_of(*chunks_of(m), length=8))),
    ("GLB_UNEXPECTED_BIN_CHUNK", UNSUPPORTED, "BIN as the third chunk", ".glb",
     container(lambda m: glb_of(chunks_of(m)[0], (0x12345678, b"\0\0\0\0"), chunks_of(m)[1]))),
    ("GLB_UNEXPECTED_END_OF_CHUNK_DATA", INVALID, "an end within the JSON", ".glb", container(lambda m: m.glb()[:60])),
    ("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", INVALID, "an end within a chunk's header", ".glb",
     container(lambda m: m.glb()[:16])),
    ("GLB_UNEXPECTED_END_OF_HEADER", INVALID, "an end within the header", ".glb", container(lambda m: m.glb()[:8])),
    ("GLB_UNEXPECTED_FIRST_CHUNK", INVALID, "BIN as the first chunk", ".glb",
     container(lambda m: glb_of(*reversed(chunks_of(m))))),
    ("GLB_UNKNOWN_CHUNK_TYPE", OK, "a chunk of nobody's", ".glb",
     container(lambda m: glb_of(*chunks_of(m), (0x12345678, b"\1\2\3\4")))),
    ("BUFFER_DATA_URI_MIME_TYPE_INVALID", OK, "a buffer that calls itself a text", ".gltf",
     lambda: Model().gltf("text/plain")),
    ("NON_RELATIVE_URI", IO, "a buffer on a server", ".gltf", lambda: Model().text("http://localhost/x.bin")),
]
