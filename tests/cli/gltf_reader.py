"""A small reader of glTF files for tests, apart from the program's: containers, buffers, accessors of every type,
sparse ones too. And what a deformed file must have in common with the file it comes from."""
import base64
import json
import os
import struct
import urllib.parse

from harness import check, equal, float32

TYPES = {5120: ("b", 1), 5121: ("B", 1), 5122: ("h", 2), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}
SCALES = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
FLOAT = 5126
DEFORMED = ("POSITION", "NORMAL", "TANGENT")


class Gltf:
    def __init__(self, path):
        self.path = path
        with open(path, "rb") as file:
            self.bytes = file.read()
        self.bin = None
        if self.bytes[:4] == b"glTF":
            at = 12
            while at < struct.unpack_from("<I", self.bytes, 8)[0]:
                size, kind = struct.unpack_from("<II", self.bytes, at)
                chunk = self.bytes[at + 8:at + 8 + size]
                if kind == 0x4E4F534A:
                    self.asset = json.loads(chunk)
                elif kind == 0x004E4942:
                    self.bin = chunk
                at += 8 + size
        else:
            self.asset = json.loads(self.bytes.decode("utf-8-sig"))
        self.buffers = [self._load(i, buffer) for i, buffer in enumerate(self.asset.get("buffers", []))]

    def _load(self, number, buffer):
        uri = buffer.get("uri")
        if uri is None:
            data = self.bin if number == 0 and self.bin is not None else None
        elif uri.startswith("data:"):
            data = base64.b64decode(uri.split(",", 1)[1])
        else:
            with open(os.path.join(os.path.dirname(self.path), urllib.parse.unquote(uri)), "rb") as file:
                data = file.read()
        if data is None:
            return None
        check(len(data) >= buffer["byteLength"], f"{self.path}: buffer {number} is too short")
        return data[:buffer["byteLength"]]

    def accessor(self, index):
        return self.asset["accessors"][index]

    def place(self, index):
        """Of an accessor with a bufferView: buffer, first byte, stride, bytes of an element."""
        accessor = self.accessor(index)
        view = self.asset["bufferViews"][accessor["bufferView"]]
        size = TYPES[accessor["componentType"]][1] * COUNTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", size)
        if accessor["count"]:
            check(accessor.get("byteOffset", 0) + (accessor["count"] - 1) * stride + size <= view["byteLength"],
                  f"accessor {index} leaves its view")
        return view["buffer"], start, stride, size

    def _read(self, view, offset, code, width, count, stride):
        view = self.asset["bufferViews"][view]
        start = view.get("byteOffset", 0) + offset
        data = self.buffers[view["buffer"]]
        size = struct.calcsize(f"<{width}{code}")
        if stride == size and count:
            return list(struct.iter_unpack(f"<{width}{code}", data[start:start + size * count]))
        return [struct.unpack_from(f"<{width}{code}", data, start + stride * i) for i in range(count)]

    def stored(self, index):
        """The elements of an accessor as they are stored: tuples of numbers."""
        accessor = self.accessor(index)
        code, size = TYPES[accessor["componentType"]]
        width = COUNTS[accessor["type"]]
        if "bufferView" in accessor:
            _, _, stride, _ = self.place(index)
            elements = self._read(accessor["bufferView"], accessor.get("byteOffset", 0), code, width,
                                  accessor["count"], stride)
        else:
            elements = [(0,) * width] * accessor["count"]
        sparse = accessor.get("sparse")
        if sparse:
            kind, bytes_of_index = TYPES[sparse["indices"]["componentType"]]
            where = self._read(sparse["indices"]["bufferView"], sparse["indices"].get("byteOffset", 0), kind, 1,
                               sparse["count"], bytes_of_index)
            values = self._read(sparse["values"]["bufferView"], sparse["values"].get("byteOffset", 0), code, width,
                                sparse["count"], size * width)
            for (i,), value in zip(where, values):
                elements[i] = value
        return elements

    def decoded(self, index):
        """What they stand for."""
        accessor = self.accessor(index)
        elements = self.stored(index)
        if not accessor.get("normalized"):
            return [tuple(float(x) for x in element) for element in elements]
        scale = SCALES[accessor["componentType"]]
        return [tuple(max(x / scale, -1.0) for x in element) for element in elements]

    def step(self, index):
        """Between neighbouring numbers of an accessor's type; 0 for float."""
        accessor = self.accessor(index)
        if accessor["componentType"] == FLOAT:
            return 0
        return 1 / SCALES[accessor["componentType"]] if accessor.get("normalized") else 1

    def primitives(self):
        return [primitive for mesh in self.asset.get("meshes", []) for primitive in mesh["primitives"]]


def attribute_sets(asset):
    """The attributes of every primitive and of its morph targets."""
    for mesh in asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            yield primitive["attributes"]
            yield from primitive.get("targets", [])


def deformed_accessors(asset):
    return {attributes[name] for attributes in attribute_sets(asset) for name in DEFORMED if name in attributes}


def without(members, *names):
    return {key: value for key, value in members.items() if key not in names}


def check_bounds(file, index):
    """min and max, where there are any, are those of what is stored."""
    accessor = file.accessor(index)
    for key, edge in (("min", min), ("max", max)):
        if key in accessor:
            found = [edge(column) for column in zip(*file.stored(index))]
            wanted = [float32(x) if accessor["componentType"] == FLOAT else x
                      for x in accessor[key]]
            equal(wanted, found, f"{key} of accessor {index}")


def check_rest(before, after):
    """All that a deformation must leave alone is as it was; what it adds is at the end."""
    old, new = before.asset, after.asset
    changeable = ("buffers", "bufferViews", "accessors", "meshes", "nodes", "extensionsUsed", "extensionsRequired")
    equal(without(new, *changeable), without(old, *changeable), "the top of the JSON")
    for key in ("bufferViews", "accessors", "meshes", "nodes"):
        check(len(new.get(key, [])) >= len(old.get(key, [])), f"{key} were lost")
    views = old.get("bufferViews", [])
    equal(new.get("bufferViews", [])[:len(views)], views, "bufferViews")
    deformed = deformed_accessors(old)
    for i, accessor in enumerate(old.get("accessors", [])):
        free = ("min", "max") if i in deformed else ()
        equal(without(new["accessors"][i], *free), without(accessor, *free), f"accessor {i}")
    for mesh, other in zip(old.get("meshes", []), new.get("meshes", [])):
        equal(without(other, "primitives"), without(mesh, "primitives"), "a mesh")
        for a, b in zip(mesh["primitives"], other["primitives"], strict=True):
            equal(without(b, "attributes", "targets"), without(a, "attributes", "targets"), "a primitive")
            for before_it, after_it in zip([a["attributes"], *a.get("targets", [])],
                                           [b["attributes"], *b.get("targets", [])], strict=True):
                equal(list(after_it), list(before_it), "attributes")
                for name in before_it:
                    check(after_it[name] == before_it[name]
                          or (name in DEFORMED and after_it[name] >= len(old["accessors"])), f"{name} has changed")
    check_bytes(before, after, deformed)


def check_bytes(before, after, deformed):
    """The buffers' bytes are those of before but in the elements of deformed accessors."""
    masks = [bytearray(len(data)) if data is not None else bytearray() for data in before.buffers]
    for index in deformed:
        if "bufferView" not in before.accessor(index):
            continue
        buffer, start, stride, size = before.place(index)
        for i in range(before.accessor(index)["count"] if before.buffers[buffer] is not None else 0):
            masks[buffer][start + stride * i:start + stride * i + size] = b"\xff" * size
    for number, (old, mask) in enumerate(zip(before.buffers, masks)):
        new = after.buffers[number]
        if old is None:
            check(new is None, f"buffer {number} had no bytes")
            continue
        check(len(new) >= len(old), f"buffer {number} is shorter")
        # As whole numbers: a loop over the bytes takes longer than the program.
        a, b, free = (int.from_bytes(data, "little") for data in (old, new[:len(old)], mask))
        changed = (a ^ b) & ~free
        check(not changed, f"byte {((changed & -changed).bit_length() - 1) // 8} of buffer {number} has changed")
