#!/usr/bin/env python3
"""Deforms every glTF model of FFD_MODELS and of data/models that a small reader of its own can read, and
evaluates what the scene then shows by itself: node transforms, skins, morph targets, in double precision, with a
Bezier volume over a box. Positions, normals, tangents and the offsets of morph targets of the output must be
those of the input, deformed; with --as-morph the base stays and a further target holds the difference.

    scene.py FFD TABLE      TABLE: the outcome of every model is written there
"""

import base64
import json
import math
import operator
import os
import random
import struct
import sys
import tempfile
import urllib.parse

from jobs import deform_all

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(os.path.dirname(os.path.dirname(HERE)), "data")
MOST = 150  # vertices looked at, of each primitive under each node
INVALID = 4
UNSUPPORTED = 6
COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
COMPONENTS = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), 5125: ("I", 1),
              5126: ("f", 1)}
SHAPES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
UNIT = [[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0]]


class Elements:
    """The elements of an accessor, each decoded when it is asked for."""

    def __init__(self, count, width, element):
        self.count, self.width, self.element = count, width, element
        self.known = {}  # those that are sparse, and those that were asked for

    def __len__(self):
        return self.count

    def __getitem__(self, i):
        if i not in self.known:
            self.known[i] = self.element(i) if self.element else [0.0] * self.width
        return self.known[i]


class Asset:
    """A glTF file with its buffers."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        chunk = None
        if data[:4] == b"glTF":
            size = struct.unpack_from("<I", data, 12)[0]
            text, rest = data[20:20 + size], data[20 + size:]
            chunk = rest[8:] if rest else None
        else:
            text = data
        self.json = json.loads(text.decode("utf-8-sig"))
        self.buffers = [self.load(path, buffer, chunk) for buffer in self.json.get("buffers", [])]
        self.read_before = {}

    @staticmethod
    def load(path, buffer, chunk):
        uri = buffer.get("uri")
        if uri is None:
            return chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(os.path.dirname(path), urllib.parse.unquote(uri)), "rb") as file:
            return file.read()

    def list(self, key):
        return self.json.get(key, [])

    def elements(self, view, offset, stride, code, width, scale):
        view = self.json["bufferViews"][view]
        layout = struct.Struct(f"<{width}{code}")
        start, step = view.get("byteOffset", 0) + offset, stride or view.get("byteStride", layout.size)

        def element(i):
            values = layout.unpack_from(self.buffers[view["buffer"]], start + i * step)
            return [max(v / scale, -1.0) for v in values] if scale else [float(v) for v in values]

        return element

    def accessor(self, number):
        """The elements of an accessor."""
        if number in self.read_before:
            return self.read_before[number]
        a = self.json["accessors"][number]
        code, scale = COMPONENTS[a["componentType"]]
        width, scale = SHAPES[a["type"]], scale if a.get("normalized") else 0
        plain = self.elements(a["bufferView"], a.get("byteOffset", 0), 0, code, width, scale) if "bufferView" in a else None
        values = Elements(a["count"], width, plain)
        if "sparse" in a:
            indices, content = a["sparse"]["indices"], a["sparse"]["values"]
            index = self.elements(indices["bufferView"], indices.get("byteOffset", 0), 0,
                                  COMPONENTS[indices["componentType"]][0], 1, 0)
            size = struct.calcsize("<" + code) * width
            element = self.elements(content["bufferView"], content.get("byteOffset", 0), size, code, width, scale)
            for i in range(a["sparse"]["count"]):
                values.known[int(index(i)[0])] = element(i)
        self.read_before[number] = values
        return values

    def quantum(self, number):
        """What a result can be off by: half a step of an integer accessor (also where the output has floats instead),
        0 for floats."""
        a = self.json["accessors"][number]
        scale = COMPONENTS[a["componentType"]][1]
        return 0.0 if a["componentType"] == 5126 else 0.5 / (scale if a.get("normalized") else 1)


def multiply(a, b):
    """Of 3x4 matrices, whose fourth rows are 0 0 0 1."""
    return [[sum(a[r][k] * b[k][c] for k in range(3)) + (a[r][3] if c == 3 else 0) for c in range(4)] for r in range(3)]


def local(node):
    if "matrix" in node:
        m = node["matrix"]
        return [[m[4 * c + r] for c in range(4)] for r in range(3)]
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    s, t = node.get("scale", [1, 1, 1]), node.get("translation", [0, 0, 0])
    rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [[rotation[r][c] * s[c] for c in range(3)] + [t[r]] for r in range(3)]


def worlds(asset):
    """The world matrices of all nodes, and the numbers of those that the scene shows."""
    nodes = asset.list("nodes")
    children = {child for node in nodes for child in node.get("children", [])}
    roots = [n for n in range(len(nodes)) if n not in children]
    world = {}

    def place(number, parent):
        world[number] = multiply(parent, local(nodes[number]))
        for child in nodes[number].get("children", []):
            place(child, world[number])

    for root in roots:
        place(root, UNIT)
    shown = []

    def show(number):
        shown.append(number)
        for child in nodes[number].get("children", []):
            show(child)

    scenes = asset.list("scenes")
    for root in scenes[asset.json.get("scene", 0)].get("nodes", []) if scenes else roots:
        show(root)
    return world, shown


def skin_matrices(asset, skin, world):
    inverse = asset.accessor(skin["inverseBindMatrices"]) if "inverseBindMatrices" in skin else None
    result = []
    for i, joint in enumerate(skin["joints"]):
        bind = [[inverse[i][4 * c + r] for c in range(4)] for r in range(3)] if inverse else UNIT
        result.append(multiply(world[joint], bind))
    return result


def vertex_matrix(asset, attributes, matrices, i):
    total, result, n = 0.0, [[0.0] * 4 for _ in range(3)], 0
    while f"JOINTS_{n}" in attributes:
        joints, weights = asset.accessor(attributes[f"JOINTS_{n}"])[i], asset.accessor(attributes[f"WEIGHTS_{n}"])[i]
        for joint, weight in zip(joints, weights):
            total += weight
            for r in range(3):
                for c in range(4):
                    result[r][c] += weight * matrices[int(joint)][r][c]
        n += 1
    return [[v / total for v in row] for row in result] if total > 0 else result


def apply(m, p, offset=True):
    return [sum(m[r][c] * p[c] for c in range(3)) + (m[r][3] if offset else 0) for r in range(3)]


def product(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(3)) for c in range(3)] for r in range(3)]


def cofactor(m):
    return [[m[(r + 1) % 3][(c + 1) % 3] * m[(r + 2) % 3][(c + 2) % 3]
             - m[(r + 1) % 3][(c + 2) % 3] * m[(r + 2) % 3][(c + 1) % 3] for c in range(3)] for r in range(3)]


def inverse(m):
    """Of the linear part; None where there is none."""
    c = cofactor(m)
    det = sum(m[0][k] * c[0][k] for k in range(3))
    size = max(abs(v) for row in m for v in row[:3])
    if not abs(det) > 1e-12 * size ** 3:
        return None
    return [[c[k][r] / det for k in range(3)] for r in range(3)]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


class Volume:
    """A Bezier volume of degree 3 over a box, whose 64 control points are moved."""

    def __init__(self, low, high, seed):
        draw = random.Random(seed)
        self.low, self.side = low, [b - a for a, b in zip(low, high)]
        self.moves = [[draw.uniform(-0.15, 0.15) * s for s in self.side] for _ in range(64)]
        self.along = list(zip(*self.moves))

    def file(self, path):
        points = [[self.low[a] + self.side[a] * n / 3 + move[a] for a, n in enumerate((i, j, k))]
                  for (i, j, k), move in zip(((n % 4, n // 4 % 4, n // 16) for n in range(64)), self.moves)]
        high = [a + b for a, b in zip(self.low, self.side)]
        with open(path, "w", encoding="ascii") as file:
            json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 4, 4],
                       "rest": {"box": {"min": self.low, "max": high}}, "deformed": {"points": points}}, file)

    def displacement(self, x):
        """The displacement, and its derivative by x; zeros outside."""
        u = [(x[a] - self.low[a]) / self.side[a] for a in range(3)]
        delta, gradient = [0.0] * 3, [[0.0] * 3 for _ in range(3)]
        if not all(0 <= t <= 1 for t in u):
            return delta, gradient
        basis = [[(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3] for t in u]
        slope = [[-3 * (1 - t) ** 2 / s, 3 * (1 - t) * (1 - 3 * t) / s, 3 * t * (2 - 3 * t) / s, 3 * t * t / s]
                 for t, s in zip(u, self.side)]
        yz = [b * c for c in basis[2] for b in basis[1]]
        tables = [[row * x for row in yz for x in basis[0]], [row * x for row in yz for x in slope[0]],
                  [b * c * x for c in basis[2] for b in slope[1] for x in basis[0]],
                  [b * c * x for c in slope[2] for b in basis[1] for x in basis[0]]]
        sums = [[sum(map(operator.mul, table, moves)) for table in tables] for moves in self.along]
        return [row[0] for row in sums], [row[1:] for row in sums]

    def near_border(self, x):
        """A point that rounding may put on either side."""
        u = [(x[a] - self.low[a]) / self.side[a] for a in range(3)]
        return any(min(abs(t), abs(t - 1)) < 1e-9 for t in u)


class Shape:
    """A vertex deformed: position, normal and tangent in the mesh's own space."""

    def __init__(self, volume, matrix, position, normal, tangent):
        place = apply(matrix, position)
        delta, gradient = volume.displacement(place)
        back = inverse(matrix)
        self.unsure = volume.near_border(place)
        self.still = back is None or not any(delta)
        self.position, self.normal, self.tangent = position, normal, tangent
        if back is None or not any(map(any, gradient)):
            return
        self.position = [p + d for p, d in zip(position, apply(back, delta, False))]
        f = product(product(back, [row[:3] for row in gradient]), [row[:3] for row in matrix])
        f = [[f[r][c] + (r == c) for c in range(3)] for r in range(3)]
        if normal:
            self.normal = unit(apply(cofactor(f), normal, False))
        if tangent:
            t = apply(f, tangent, False)
            along = sum(a * b for a, b in zip(t, self.normal))
            self.tangent = unit([a - along * b for a, b in zip(t, self.normal)])


def add(a, b):
    return [x + y for x, y in zip(a, b)] if a and b else a


def values_at(asset, attributes, i, names=("POSITION", "NORMAL", "TANGENT")):
    return [asset.accessor(attributes[name])[i][:3] if name in attributes else None for name in names]


class Comparison:
    """What one model's output shows against what it should."""

    def __init__(self, before, after, volume):
        self.before, self.after, self.volume = before, after, volume
        self.vertices = self.moved = self.offsets = self.skinned = 0
        self.worst, self.where = 0.0, ""

    def near(self, found, expected, size, quantum, what):
        for a, b in zip(found, expected):
            off = max(abs(a - b) - quantum * 1.01, 0) / max(size, 1e-30)
            if off > self.worst:
                self.worst, self.where = off, f"{what}: {found} instead of {expected}"

    def vertex(self, old, new, matrix, i, what):
        p, n, t = values_at(self.before, old["attributes"], i)
        t = t if n else None
        base = Shape(self.volume, matrix, p, n, t)
        if base.unsure:
            return
        q = values_at(self.after, new["attributes"], i)
        reach = max(1e-30, *(abs(v) for v in base.position))
        for name, found, expected, size in zip(("POSITION", "NORMAL", "TANGENT"), q,
                                               (base.position, base.normal, base.tangent), (reach, 1, 1)):
            if expected:
                self.near(found, expected, size, self.before.quantum(old["attributes"][name]), f"{what} {name} {i}")
        self.vertices += 1
        self.moved += not base.still
        for k, (was, now) in enumerate(zip(old.get("targets", []), new.get("targets", []))):
            self.target(was, now, base, matrix, (p, n, t), i, f"{what} target {k}")

    def target(self, was, now, base, matrix, vertex, i, what):
        offsets = values_at(self.before, was, i)
        shape = Shape(self.volume, matrix, *(add(a, b) for a, b in zip(vertex, offsets)))
        if shape.unsure:
            return
        found = values_at(self.after, now, i)
        for name, f, o, a, b in zip(("POSITION", "NORMAL", "TANGENT"), found, offsets,
                                    (shape.position, shape.normal, shape.tangent),
                                    (base.position, base.normal, base.tangent)):
            if not o or not a:
                continue
            expected = [x - y for x, y in zip(a, b)] if not (base.still and shape.still) else o
            # Offsets may be small differences of large numbers: the reference is no better than these.
            size = max(*(abs(v) for v in expected), *(1e-7 * abs(v) for v in a)) if name == "POSITION" else 1
            self.near(f, expected, size, self.before.quantum(was[name]), f"{what} {name} {i}")
            self.offsets += 1

    def added_target(self, old, new, matrix, i, what):
        """The base as it was, and the deformation in the last target."""
        vertex = values_at(self.before, old["attributes"], i)
        base = Shape(self.volume, matrix, vertex[0], vertex[1], vertex[2] if vertex[1] else None)
        if base.unsure:
            return
        if values_at(self.after, new["attributes"], i) != vertex:
            self.worst, self.where = math.inf, f"{what}: the base of vertex {i} has changed"
        # A mesh of which nothing moves gets none.
        added = (new.get("targets", [])[len(old.get("targets", [])):] or [{}])[0]
        found = values_at(self.after, added, i)
        self.vertices += 1
        self.moved += not base.still
        for name, offset, a, b in zip(("POSITION", "NORMAL", "TANGENT"), found, vertex,
                                      (base.position, base.normal, base.tangent)):
            if not a or not b:
                continue
            expected = [y - x for x, y in zip(a, b)]
            size = max(*(abs(v) for v in expected), *(1e-7 * abs(v) for v in a)) if name == "POSITION" else 1
            self.near(offset or [0.0] * 3, expected, size, 0, f"{what} added {name} {i}")
            self.offsets += 1

    def run(self, added=False):
        world, shown = worlds(self.before)
        for number in shown:
            node, now = self.before.list("nodes")[number], self.after.list("nodes")[number]
            if "mesh" not in node:
                continue
            mesh, copy = self.before.list("meshes")[node["mesh"]], self.after.list("meshes")[now["mesh"]]
            matrices = None
            if "skin" in node:
                matrices = skin_matrices(self.before, self.before.list("skins")[node["skin"]], world)
                self.skinned += 1
            for k, (old, new) in enumerate(zip(mesh["primitives"], copy["primitives"])):
                count = len(self.before.accessor(old["attributes"]["POSITION"]))
                for i in looked_at(count):
                    matrix = vertex_matrix(self.before, old["attributes"], matrices, i) if matrices else world[number]
                    look_at = self.added_target if added else self.vertex
                    look_at(old, new, matrix, i, f"node {number} primitive {k}")


def looked_at(count):
    """The vertices of a primitive that are looked at, MOST and some."""
    return range(0, count, max(1, count // MOST))


def bounds(asset):
    """Of all that is looked at in the scene, targets included."""
    world, shown = worlds(asset)
    low, high = [math.inf] * 3, [-math.inf] * 3
    for number in shown:
        node = asset.list("nodes")[number]
        if "mesh" not in node:
            continue
        matrices = skin_matrices(asset, asset.list("skins")[node["skin"]], world) if "skin" in node else None
        for primitive in asset.list("meshes")[node["mesh"]]["primitives"]:
            attributes = primitive["attributes"]
            targets = [asset.accessor(t["POSITION"]) for t in primitive.get("targets", []) if "POSITION" in t]
            positions = asset.accessor(attributes["POSITION"])
            for i in looked_at(len(positions)):
                p = positions[i]
                matrix = vertex_matrix(asset, attributes, matrices, i) if matrices else world[number]
                for q in [p] + [add(p, t[i]) for t in targets]:
                    x = apply(matrix, q)
                    low, high = [min(a, b) for a, b in zip(low, x)], [max(a, b) for a, b in zip(high, x)]
    return low, high


def volumes(low, high):
    """A volume round everything, and one round a part of it."""
    side = max(b - a for a, b in zip(low, high)) or 1.0
    pad = [0.1 * (b - a) + 0.01 * side for a, b in zip(low, high)]
    around = [a - p for a, p in zip(low, pad)], [b + p for b, p in zip(high, pad)]
    middle = [a + 0.313 * (b - a) if b > a else c for a, b, c in zip(low, high, around[0])]
    return {"all": Volume(*around, 1), "part": Volume(middle, around[1], 2)}


def models():
    roots = [os.path.join(DATA, "models")] + [r for r in [os.environ.get("FFD_MODELS")] if r]
    for root in roots:
        for folder, folders, names in os.walk(root):
            folders.sort()
            for name in sorted(names):
                if name.endswith((".gltf", ".glb")):
                    yield os.path.join(folder, name), os.path.relpath(os.path.join(folder, name), root)


class Model:
    """A model, the volumes that it is deformed by, and what is known of it: rows of the table."""

    def __init__(self, path, name):
        self.path, self.name, self.rows, self.runs = path, name, [], []
        with open(path, "rb") as file:
            content = file.read()
        if any(extension.encode() in content for extension in COMPRESSED):
            self.skip("compressed")
            return
        try:
            self.before = Asset(path)
            low, high = bounds(self.before)
        except (OSError, KeyError, IndexError, TypeError, struct.error) as problem:
            self.skip(f"not read: {type(problem).__name__}")
            return
        if not all(math.isfinite(v) for v in low + high):
            self.skip("nothing finite is shown")
            return
        around = volumes(low, high)
        self.runs = [("all", around["all"], {}), ("part", around["part"], {}), ("morph", around["part"], {"as-morph": "bent"})]

    def skip(self, why):
        self.rows = [(self.name, "", "skipped", why)]

    def jobs(self, folder):
        """Writes lattices into the folder; the jobs go on with files there."""
        os.makedirs(folder)
        for kind, volume, options in self.runs:
            volume.file(os.path.join(folder, f"{kind}.json"))
            yield {"in": self.path, "out": os.path.join(folder, kind + os.path.splitext(self.name)[1]),
                   "lattice": os.path.join(folder, f"{kind}.json"), "options": options}

    def look(self, kind, volume, options, target, code, message):
        if code != 0:
            outcome = {UNSUPPORTED: "refused", INVALID: "invalid"}.get(code, "FAILED")
            self.rows.append((self.name, kind, outcome, message.replace(self.path, self.name)))
            return
        comparison = Comparison(self.before, Asset(target), volume)
        comparison.run(bool(options))
        # Floats are rounded to 2^-24 of the largest coordinate, which M^-1 F M's own rounding can add to.
        right = comparison.worst <= 2e-6
        self.rows.append((self.name, kind, "right" if right else "FAILED",
                          f"{comparison.vertices} vertices, {comparison.moved} moved, {comparison.offsets} offsets, "
                          f"{comparison.skinned} skinned nodes" + ("" if right else "; " + comparison.where)))


def main():
    ffd, table = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        found = [Model(path, name) for path, name in models()]
        jobs = [(model, run, job) for number, model in enumerate(found)
                for run, job in zip(model.runs, list(model.jobs(os.path.join(folder, str(number)))))]
        ended = deform_all(os.path.abspath(ffd), folder, [job for _, _, job in jobs], "--resources", "reference")
        for (model, run, job), (code, message) in zip(jobs, ended):
            model.look(*run, job["out"], code, message)
    rows = [row for model in found for row in model.rows]
    with open(table, "w", encoding="utf-8") as file:
        file.writelines("\t".join(row) + "\n" for row in rows)
    failed = [row for row in rows if row[2] == "FAILED"]
    for row in failed:
        print("\t".join(row))
    counts = {what: sum(row[2] == what for row in rows) for what in ("right", "refused", "invalid", "skipped", "FAILED")}
    print(f"{len(rows)} runs: {', '.join(f'{count} {what}' for what, count in counts.items())}; {table}")
    sys.exit(1 if failed or not counts["right"] else 0)


main()
