"""What a deformation changed in a glTF file, value by value and byte by byte, and whether it may.

Allowed (data/schema/formats.md 8): min and max of deformed accessors; bytes of their elements;
appended bufferViews, accessors, meshes, buffers, and the references to them; byteLength and URI of buffers; and
where geometry was compressed, what its decoding takes away."""

import base64
import functools
import json
import os
import re
import struct
import urllib.parse

DEFORMED = ("POSITION", "NORMAL", "TANGENT")
DRACO = "KHR_draco_mesh_compression"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
QUANTIZED = "KHR_mesh_quantization"
DECODED = {DRACO, QUANTIZED, *MESHOPT}

SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

WORD = re.compile(r'"(?:[^"\\]|\\.)*"|[^\s"{}\[\],:]+')
SIGNS = str.maketrans("{}[],:", "xxxxxx")

# A number as the file writes it, compared by its text; and no string.
Number = bytes
# The members of an object in the order of the file: (key, value) pairs.
Object = tuple


class Gltf:
    """A glTF file: text (of the JSON), json (of Numbers and Objects), plain (as json has it), buffers (bytes), chunks
    (kinds of a GLB)."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        self.path, self.data, self.kept = path, data, {}
        self.chunks = []
        binary = None
        if data[:4] == b"glTF":
            _, version, length = struct.unpack_from("<III", data)
            self.version, at = version, 12
            while at + 8 <= length:
                size, kind = struct.unpack_from("<II", data, at)
                self.chunks.append((kind, data[at + 8:at + 8 + size]))
                at += 8 + size
            self.whole = at == length == len(data)
            text = self.chunks[0][1]
            binary = self.chunks[1][1] if len(self.chunks) > 1 and self.chunks[1][0] == 0x004E4942 else None
        else:
            text = data
        self.text = text.decode("utf-8-sig")
        self.plain = json.loads(self.text)
        self.buffers = [self.content(buffer, binary if i == 0 else None)
                        for i, buffer in enumerate(self.plain.get("buffers", []))]

    @functools.cached_property
    def json(self):
        return json.loads(self.text, parse_int=str.encode, parse_float=str.encode, object_pairs_hook=Object)

    def content(self, buffer, binary):
        """Without a URI a buffer is the BIN chunk, or the fallback of a compression, which holds nothing."""
        uri = buffer.get("uri")
        if uri is None:
            return binary or b""
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1] + "==")
        with open(self.beside(uri), "rb") as file:
            return file.read()

    def kept_bytes(self, number, length, deformed):
        """A byte for each of a buffer's: 0 where elements of the accessors that are deformed lie, else 255."""
        if (number, length) not in self.kept:
            self.kept[number, length] = kept = bytearray(b"\xff" * length)
            count = len(self.plain.get("accessors", []))
            for index in sorted(range(count), key=lambda i: i not in deformed):
                for buffer, start, end in element_ranges(self.plain, index):
                    if buffer == number:
                        kept[start:end] = (b"\0" if index in deformed else b"\xff") * (end - start)
        return self.kept[number, length]

    @functools.cached_property
    def layout(self):
        """The JSON's white space, with an x for every word and sign."""
        return WORD.sub("x", self.text.rstrip("\0").rstrip()).translate(SIGNS)

    def beside(self, uri):
        return os.path.join(os.path.dirname(self.path), urllib.parse.unquote(uri))

    def external(self):
        """Indices of the buffers that are files."""
        return [i for i, buffer in enumerate(self.plain.get("buffers", []))
                if "uri" in buffer and not buffer["uri"].startswith("data:")]


def is_data(uri):
    return uri.startswith("data:")


def deformed_accessors(asset):
    found = set()
    for mesh in asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            for attributes in [primitive["attributes"], *primitive.get("targets", [])]:
                found |= {attributes[name] for name in DEFORMED if name in attributes}
    return found


def draco_accessors(asset):
    """Accessors whose values are in a Draco stream: decoded, they get bytes."""
    found = set()
    for mesh in asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            if DRACO in primitive.get("extensions", {}):
                names = primitive["extensions"][DRACO]["attributes"]
                found |= {primitive["attributes"][name] for name in names} | {primitive.get("indices")}
    return found


def element_ranges(asset, index):
    """(buffer, start, end) of what the elements of an accessor with plain bytes take, its sparse parts too."""
    accessor = asset["accessors"][index]
    size = SIZES[accessor["componentType"]] * WIDTHS[accessor["type"]]
    if "bufferView" in accessor:
        view = asset["bufferViews"][accessor["bufferView"]]
        if any(name in view.get("extensions", {}) for name in MESHOPT):
            return
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride, count = view.get("byteStride", size), accessor["count"]
        if stride == size:  # nothing between them: one range
            yield view["buffer"], start, start + count * size
            return
        for at in range(start, start + count * stride, stride):
            yield view["buffer"], at, at + size


class Change:
    """Collects what is different and not allowed."""

    def __init__(self, before, after):
        self.before, self.after = before, after
        self.found = []
        self.deformed = deformed_accessors(before.plain)
        self.compressed = draco_accessors(before.plain)

    def note(self, pointer, old, new):
        self.found.append(f"{pointer}: {str(old)[:60]} became {str(new)[:60]}")

    def walk(self, pointer, old, new):
        if isinstance(old, Object) and isinstance(new, Object):
            old, new = dict(old), dict(new)
            common = [key for key in old if key in new]
            if common != [key for key in new if key in old]:
                self.note(pointer, "the order of keys", "another")
            for key in list(old) + [key for key in new if key not in old]:
                self.step(f"{pointer}/{key}", old.get(key), new.get(key))
        elif isinstance(old, list) and isinstance(new, list):
            for i in range(max(len(old), len(new))):
                self.step(f"{pointer}/{i}", old[i] if i < len(old) else None, new[i] if i < len(new) else None)
        else:
            self.note(pointer, old, new)

    def step(self, pointer, old, new):
        if old != new and not self.allowed(pointer, old, new):
            self.walk(pointer, old, new)

    def allowed(self, pointer, old, new):
        """A difference that may be as it is; deeper values of others are looked at one by one."""
        parts = pointer.split("/")[1:]
        match parts:
            case ["accessors", i, ("bufferView" | "byteOffset")] if old is None:
                return int(i) in self.compressed and int(new) >= 0
            case [("extensionsUsed" | "extensionsRequired")]:
                return self.fewer_extensions(old, new)
            case [("accessors" | "bufferViews" | "meshes" | "buffers"), _] if old is None:
                return self.appended(parts[0], int(parts[1]))
            case ["accessors", i, ("min" | "max")]:
                # What a Draco stream holds need not be what its accessors say.
                return int(i) in self.deformed | self.compressed and None not in (old, new) and len(old) == len(new)
            case ["buffers", _, "byteLength"]:
                return int(new) >= int(old)
            case ["buffers", _, "uri"]:
                return is_data(old) == is_data(new) and (not is_data(old) or old.split(",")[0] == new.split(",")[0])
            case ["bufferViews", i, *rest]:
                return self.decoded_view(int(i), rest, old, new)
            case ["meshes", m, "primitives", p, *rest]:
                return self.reference(self.before.plain["meshes"][int(m)]["primitives"][int(p)], rest, old, new)
            case ["nodes", _, "mesh"]:
                return self.copied_mesh(int(old), int(new))
        return False

    def fewer_extensions(self, old, new):
        left = [name for name in old or [] if name in (new or [])]
        return left == (new or []) and new != [] and set(old or []) - set(left) <= DECODED

    def appended(self, kind, index):
        entry = self.after.plain[kind][index]
        if kind == "bufferViews":
            olds = self.before.plain.get("buffers", [])
            buffer = entry["buffer"]
            return buffer >= len(olds) or entry.get("byteOffset", 0) >= olds[buffer]["byteLength"]
        if kind == "meshes":
            return any(plain_mesh(entry) == plain_mesh(mesh) for mesh in self.before.plain["meshes"])
        return True

    def decoded_view(self, index, rest, old, new):
        """A meshopt view whose geometry was written back plain loses its extension and lies elsewhere."""
        had = self.before.plain["bufferViews"][index].get("extensions", {})
        return any(name in had for name in MESHOPT) and rest[:1] in (["extensions"], ["buffer"], ["byteOffset"])

    def reference(self, primitive, rest, old, new):
        compressed = DRACO in primitive.get("extensions", {})
        appended = new is not None and isinstance(new, Number) and int(new) >= len(self.before.plain["accessors"])
        match rest:
            case ["attributes", name]:
                return appended and (name in DEFORMED or compressed)
            case ["targets", _, name]:
                return appended and name in DEFORMED
            case ["indices"]:
                return appended and compressed
            case ["extensions"] if compressed:
                return tuple(member for member in old if member[0] != DRACO) == (new or ())
        return False

    def copied_mesh(self, old, new):
        return new >= len(self.before.plain["meshes"]) and \
            plain_mesh(self.before.plain["meshes"][old]) == plain_mesh(self.after.plain["meshes"][new])

    def bytes(self):
        """Old bytes differ only within elements of deformed accessors."""
        asset = self.before.plain
        for number, (old, new) in enumerate(zip(self.before.buffers, self.after.buffers)):
            stated = min(asset["buffers"][number]["byteLength"], len(old))
            grown = self.after.plain["buffers"][number]["byteLength"] > stated
            old, new = (old[:stated], new[:stated]) if grown else (old, new)
            if len(old) != len(new):
                self.note(f"buffer {number}", f"{len(old)} bytes", f"{len(new)} bytes")
            elif old != new:
                self.inside_elements(number, old, new)

    def inside_elements(self, number, old, new):
        keep = self.before.kept_bytes(number, len(old), self.deformed)
        bits = [int.from_bytes(data, "little") for data in (old, new, keep)]
        different = (bits[0] ^ bits[1]) & bits[2]
        if different:
            wrong = [i for i, byte in enumerate(different.to_bytes(len(old), "little")) if byte]
            self.note(f"buffer {number} byte {wrong[0]}", old[wrong[0]], f"{new[wrong[0]]} ({len(wrong)} such bytes)")

    def container(self):
        before, after = self.before, self.after
        kinds = [kind for kind, _ in before.chunks]
        if [kind for kind, _ in after.chunks][:len(kinds)] != kinds or before.chunks[2:] != after.chunks[2:]:
            self.note("chunks", kinds, [kind for kind, _ in after.chunks])
        if after.chunks and not after.whole:
            self.note("GLB", "its lengths", "do not add up")

    def white_space(self):
        """Where no value came or went, the JSON's own layout is as it was."""
        old, new = self.before.layout, self.after.layout
        if old != new and len("".join(old.split())) == len("".join(new.split())):
            self.note("JSON", "its white space", "another")


def plain_mesh(mesh):
    """A mesh without the references that a copy changes."""
    copy = json.loads(json.dumps(mesh))
    for primitive in copy["primitives"]:
        for attributes in [primitive["attributes"], *primitive.get("targets", [])]:
            for name in attributes:
                attributes[name] = None
        if primitive.get("extensions", {}).pop(DRACO, None) is not None and not primitive["extensions"]:
            del primitive["extensions"]
        primitive.pop("indices", None)
    return copy


def changes(before, target):
    """What is different in the file target and may not be: a list of lines. before: a Gltf."""
    change = Change(before, Gltf(target))
    change.walk("", change.before.json, change.after.json)
    change.container()
    change.white_space()
    change.bytes()
    return change.found


def own_names(target, count):
    stem = os.path.splitext(os.path.basename(target))[0]
    return [f"{stem}.bin" if i == 0 else f"{stem}-{i}.bin" for i in range(count)]


def not_same(before, target):
    """Why the file target is not that of before, byte for byte, but for the names of external buffers: a list of lines."""
    files = before.external()
    if not files:
        with open(target, "rb") as file:
            return [] if file.read() == before.data else ["the file differs"]
    after = Gltf(target)
    names = [urllib.parse.unquote(after.plain["buffers"][i]["uri"]) for i in files]
    found = []
    if names != own_names(target, len(files)):
        found.append(f"buffers are named {names}")
    if before.buffers != after.buffers:
        found.append("a buffer differs")
    old, new = before.data, after.data
    for i in files:
        if before.chunks:
            continue
        # In the order of the file, each URI once.
        old = old.replace(quoted(before, i), b"<buffer>")
        new = new.replace(quoted(after, i), b"<buffer>")
    if old != new:
        found.append("the file differs in more than its buffers' URIs")
    return found


def quoted(gltf, index):
    return b'"' + gltf.plain["buffers"][index]["uri"].encode() + b'"'
