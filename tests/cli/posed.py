"""Where the vertices of a glTF file are at a time of an animation: nodes, skins, STEP, LINEAR and CUBICSPLINE. Small and
slow, and apart from the program's."""

import bisect
import math
import struct

from harness import glb_split

CODES = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), 5125: ("I", 1), 5126: ("f", 1)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
UNIT = [[float(r == c) for c in range(4)] for r in range(4)]


def product(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def point(m, p):
    return [m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3] for r in range(3)]


def columns(numbers):
    return [[numbers[4 * c + r] for c in range(4)] for r in range(4)]


def of_transform(t, q, s):
    x, y, z, w = q
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [[turn[r][c] * s[c] for c in range(3)] + [t[r]] for r in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def unit(q):
    length = math.sqrt(sum(x * x for x in q)) or 1
    return [x / length for x in q]


def slerp(a, b, f):
    dot = sum(x * y for x, y in zip(a, b))
    b = [-x for x in b] if dot < 0 else b
    angle = math.acos(min(1, abs(dot)))
    if angle < 1e-9:
        return unit([x + f * (y - x) for x, y in zip(a, b)])
    return [(math.sin((1 - f) * angle) * x + math.sin(f * angle) * y) / math.sin(angle) for x, y in zip(a, b)]


class Posed:
    def __init__(self, file):
        self.asset, self.data = glb_split(file)
        self.nodes = self.asset["nodes"]

    def read(self, index):
        accessor = self.asset["accessors"][index]
        code, scale = CODES[accessor["componentType"]]
        width = WIDTHS[accessor["type"]]
        size = struct.calcsize(code) * width
        rows = [(0,) * width] * accessor["count"]
        if "bufferView" in accessor:
            view = self.asset["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            stride = view.get("byteStride", size)
            rows = [struct.unpack_from(f"<{width}{code}", self.data, start + stride * i) for i in range(accessor["count"])]
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            views = [self.asset["bufferViews"][sparse[key]["bufferView"]] for key in ("indices", "values")]
            at = CODES[sparse["indices"]["componentType"]][0]
            for k in range(sparse["count"]):
                i, = struct.unpack_from("<" + at, self.data, views[0].get("byteOffset", 0) + struct.calcsize(at) * k)
                rows[i] = struct.unpack_from(f"<{width}{code}", self.data, views[1].get("byteOffset", 0) + size * k)
        divisor = scale if accessor.get("normalized") else 1
        return [[max(x / divisor, -1) if divisor > 1 else float(x) for x in row] for row in rows]

    def sample(self, sampler, path, time):
        times = [row[0] for row in self.read(sampler["input"])]
        values = self.read(sampler["output"])
        way = sampler.get("interpolation", "LINEAR")
        step = 3 if way == "CUBICSPLINE" else 1
        value = [values[step * i + (step == 3)] for i in range(len(times))]
        k = bisect.bisect_right(times, time) - 1
        if k < 0 or k + 1 >= len(times):
            return value[max(0, min(k, len(times) - 1))]
        span = times[k + 1] - times[k]
        f = (time - times[k]) / span
        if way == "STEP":
            return value[k]
        if way == "LINEAR":
            return slerp(value[k], value[k + 1], f) if path == "rotation" else [a + f * (b - a) for a, b in zip(value[k], value[k + 1])]
        out, into = values[3 * k + 2], values[3 * k + 3]
        found = [(2 * f**3 - 3 * f**2 + 1) * a + span * (f**3 - 2 * f**2 + f) * b + (3 * f**2 - 2 * f**3) * c + span * (f**3 - f**2) * d
                 for a, b, c, d in zip(value[k], out, value[k + 1], into)]
        return unit(found) if path == "rotation" else found

    def target(self, channel):
        target = channel["target"]
        pointer = target.get("extensions", {}).get("KHR_animation_pointer", {}).get("pointer")
        if pointer:
            parts = pointer.split("/")
            return int(parts[2]), parts[3]
        return target["node"], target["path"]

    def worlds(self, animation=None, time=0.0):
        own = {}
        if animation is not None:
            made = self.asset["animations"][animation]
            for channel in made["channels"]:
                node, path = self.target(channel)
                own[node, path] = self.sample(made["samplers"][channel["sampler"]], path, time)
        worlds = [None] * len(self.nodes)
        parents = {child: n for n, node in enumerate(self.nodes) for child in node.get("children", [])}

        def world(n):
            if worlds[n] is None:
                node = self.nodes[n]
                if "matrix" in node:
                    local = columns(node["matrix"])
                else:
                    local = of_transform(*(own.get((n, path), node.get(path, default)) for path, default in
                                           (("translation", [0, 0, 0]), ("rotation", [0, 0, 0, 1]), ("scale", [1, 1, 1]))))
                worlds[n] = product(world(parents[n]), local) if n in parents else local
            return worlds[n]

        return [world(n) for n in range(len(self.nodes))]

    def vertices(self, animation=None, time=0.0, attribute="POSITION"):
        """Of each node with a mesh and each of its primitives: the positions in the scene."""
        worlds = self.worlds(animation, time)
        found = {}
        for n, node in enumerate(self.nodes):
            if "mesh" not in node:
                continue
            for p, primitive in enumerate(self.asset["meshes"][node["mesh"]]["primitives"]):
                positions = self.read(primitive["attributes"][attribute])
                if "skin" not in node:
                    found[n, p] = [point(worlds[n], x) for x in positions]
                    continue
                skin = self.asset["skins"][node["skin"]]
                binds = [columns(m) for m in self.read(skin["inverseBindMatrices"])] if "inverseBindMatrices" in skin else None
                joints = [product(worlds[j], binds[i]) if binds else worlds[j] for i, j in enumerate(skin["joints"])]
                of, weights = (self.read(primitive["attributes"][key]) for key in ("JOINTS_0", "WEIGHTS_0"))
                found[n, p] = [[sum(w * point(joints[int(j)], x)[a] for j, w in zip(js, ws)) / sum(ws) for a in range(3)]
                               for x, js, ws in zip(positions, of, weights)]
        return found
