"""What a glTF shows at a time of an animation, from the text of the format alone and apart from the program: nodes,
animations, skins, morph targets, in double precision, to the world position of every vertex. Slow and plain."""

import bisect
import math
import re

import gltf_reader
from gltf_reader import Gltf
from matrices import UNIT, apply, inverse, of_numbers, of_parts, product, transposed, turn
from vectors import unit

gltf_reader.COUNTS.setdefault("MAT4", 16)
REST = {"translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0), "scale": (1.0, 1.0, 1.0)}


class Node:
    def __init__(self, number, members):
        self.number, self.members = number, members
        self.name = members.get("name")
        self.children = members.get("children", [])
        self.parent = None
        self.matrix = of_numbers(members["matrix"]) if "matrix" in members else None
        self.parts = {path: tuple(map(float, members.get(path, rest))) for path, rest in REST.items()}
        self.mesh, self.skin, self.weights = (members.get(key) for key in ("mesh", "skin", "weights"))

    def local(self, parts=None):
        if self.matrix:
            return self.matrix
        parts = {**self.parts, **(parts or {})}
        return of_parts(parts["translation"], parts["rotation"], parts["scale"])


class Skin:
    def __init__(self, joints, inverse_binds):
        self.joints, self.inverse_binds = joints, inverse_binds


class Shape:
    """A primitive under a node: positions, offsets of targets, and of each vertex (joint of the skin, weight)."""

    def __init__(self, positions, targets, influences, edges, normals, tangents):
        self.positions, self.targets, self.influences, self.edges = positions, targets, influences, edges
        self.normals, self.tangents = normals, tangents  # None where there are none; those of targets are not read


class Channel:
    def __init__(self, node, path, times, values, interpolation, accessors):
        self.node, self.path, self.times, self.values = node, path, times, values
        self.interpolation = interpolation
        self.accessors = accessors  # of times and of values

    def at(self, time):
        times, cubic = self.times, self.interpolation == "CUBICSPLINE"
        value = (lambda k: self.values[3 * k + 1]) if cubic else (lambda k: self.values[k])
        if time <= times[0]:
            return value(0)
        if time >= times[-1]:
            return value(len(times) - 1)
        k = bisect.bisect_right(times, time) - 1
        span = times[k + 1] - times[k]
        s = (time - times[k]) / span
        if self.interpolation == "STEP":
            return value(k)
        if cubic:
            return self.spline(k, s, span)
        if self.path == "rotation":
            return slerp(value(k), value(k + 1), s)
        return tuple(a + s * (b - a) for a, b in zip(value(k), value(k + 1)))

    def spline(self, k, s, span):
        (_, v0, b0), (a1, v1, _) = self.values[3 * k:3 * k + 3], self.values[3 * k + 3:3 * k + 6]
        h = (2 * s**3 - 3 * s**2 + 1, span * (s**3 - 2 * s**2 + s), -2 * s**3 + 3 * s**2, span * (s**3 - s**2))
        found = tuple(h[0] * p + h[1] * m + h[2] * q + h[3] * n for p, m, q, n in zip(v0, b0, v1, a1))
        if self.path != "rotation":
            return found
        size = math.sqrt(sum(x * x for x in found))
        return tuple(x / size for x in found)


def slerp(a, b, s):
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        cosine, b = -cosine, tuple(-x for x in b)
    if cosine > 1 - 1e-12:
        return tuple(x + s * (y - x) for x, y in zip(a, b))
    angle = math.acos(cosine)
    p, q = math.sin((1 - s) * angle) / math.sin(angle), math.sin(s * angle) / math.sin(angle)
    return tuple(p * x + q * y for x, y in zip(a, b))


class Rig:
    """A glTF file, ready to be shown at any time of any of its animations."""

    def __init__(self, path):
        self.file = Gltf(path)
        asset = self.asset = self.file.asset
        self.decoded = {}
        self.nodes = [Node(i, members) for i, members in enumerate(asset.get("nodes", []))]
        for node in self.nodes:
            for child in node.children:
                self.nodes[child].parent = node.number
        self.order = []  # parents before children; nodes outside of the scene too, for joints may stand there
        self.shown = set()
        self.walk()
        self.skins = [self.skin(members) for members in asset.get("skins", [])]
        self.shapes = {(node.number, p): self.shape(node, primitive) for node in self.nodes
                       if node.mesh is not None and node.number in self.shown
                       for p, primitive in enumerate(asset["meshes"][node.mesh]["primitives"])
                       if "POSITION" in primitive["attributes"]}
        self.animations = [self.channels(animation) for animation in asset.get("animations", [])]

    def walk(self):
        roots = [node.number for node in self.nodes if node.parent is None]
        scenes = self.asset.get("scenes")
        shown = scenes[self.asset.get("scene", 0)].get("nodes", []) if scenes else roots
        for begin, is_shown in ((shown, True), (roots, False)):
            waiting = list(begin)
            while waiting:
                number = waiting.pop()
                if is_shown:
                    self.shown.add(number)
                elif number in self.shown:
                    continue
                self.order.append(number)
                waiting += self.nodes[number].children

    def values(self, accessor):
        if accessor not in self.decoded:
            self.decoded[accessor] = self.file.decoded(accessor)
        return self.decoded[accessor]

    def skin(self, members):
        joints = members["joints"]
        if "inverseBindMatrices" not in members:
            return Skin(joints, [UNIT] * len(joints))
        return Skin(joints, [of_numbers(m) for m in self.values(members["inverseBindMatrices"])[:len(joints)]])

    def shape(self, node, primitive):
        attributes = primitive["attributes"]
        positions = self.values(attributes["POSITION"])
        targets = [self.values(target["POSITION"]) if "POSITION" in target else None
                   for target in primitive.get("targets", [])]
        influences = None
        if node.skin is not None and "JOINTS_0" in attributes:
            sets = [k for k in range(8) if f"JOINTS_{k}" in attributes]
            joints = [self.file.stored(attributes[f"JOINTS_{k}"]) for k in sets]
            weights = [self.values(attributes[f"WEIGHTS_{k}"]) for k in sets]
            influences = [influence(sum(js, ()), sum(ws, ())) for js, ws in zip(zip(*joints), zip(*weights))]
        normals, tangents = (self.values(attributes[name]) if name in attributes else None for name in ("NORMAL", "TANGENT"))
        return Shape(positions, targets, influences, self.edges(primitive, len(positions)), normals, tangents)

    def edges(self, primitive, count):
        if primitive.get("mode", 4) != 4:
            return []
        corners = ([i for (i,) in self.file.stored(primitive["indices"])] if "indices" in primitive
                   else list(range(count)))
        found = set()
        for a, b, c in zip(corners[::3], corners[1::3], corners[2::3]):
            found |= {(min(e), max(e)) for e in ((a, b), (b, c), (c, a)) if e[0] != e[1]}
        return sorted(found)

    def channels(self, animation):
        found = []
        for channel in animation["channels"]:
            node, path = target_of(channel["target"], self.asset)
            if path is None:
                continue
            sampler = animation["samplers"][channel["sampler"]]
            times = [t for (t,) in self.values(sampler["input"])]
            values, kind = self.values(sampler["output"]), sampler.get("interpolation", "LINEAR")
            if path == "weights":
                width = len(values) // (len(times) * (3 if kind == "CUBICSPLINE" else 1))
                values = [sum(values[i:i + width], ()) for i in range(0, len(values), width)]
            found.append(Channel(node, path, times, values, kind, (sampler["input"], sampler["output"])))
        return found

    def span(self, animation):
        """The first and the last time of an animation."""
        times = [t for channel in self.animations[animation] for t in (channel.times[0], channel.times[-1])]
        return (min(times), max(times)) if times else (0.0, 0.0)

    def times(self, animation, count):
        first, last = self.span(animation)
        return [first + (last - first) * (i + 0.37) / count for i in range(count)]

    def state(self, animation, time):
        """What channels set: node -> path -> value."""
        found = {}
        for channel in self.animations[animation] if animation is not None else []:
            found.setdefault(channel.node, {})[channel.path] = channel.at(time)
        return found

    def worlds(self, animation=None, time=0.0):
        state, found = self.state(animation, time), [None] * len(self.nodes)
        for number in self.order:
            node = self.nodes[number]
            local = node.local(state.get(number))
            found[number] = product(found[node.parent], local) if node.parent is not None else local
        return found

    def joints(self, skin, worlds):
        skin = self.skins[skin]
        return [product(worlds[joint], bind) for joint, bind in zip(skin.joints, skin.inverse_binds)]

    def weights(self, node, state):
        mesh = self.asset["meshes"][node.mesh]
        return state.get(node.number, {}).get("weights") or node.weights or mesh.get("weights") or []

    def vertices(self, animation=None, time=0.0, chosen=None):
        """(node, primitive) -> the world positions of its vertices, or of those that chosen names."""
        state, worlds, found = self.state(animation, time), self.worlds(animation, time), {}
        skins = {}
        for key, shape in self.shapes.items():
            node = self.nodes[key[0]]
            numbers = range(len(shape.positions)) if chosen is None else chosen[key]
            points = morphed(shape, self.weights(node, state), numbers)
            if shape.influences is None:
                found[key] = [apply(worlds[key[0]], p) for p in points]
                continue
            if node.skin not in skins:
                skins[node.skin] = self.joints(node.skin, worlds)
            found[key] = [apply(blend(skins[node.skin], shape.influences[i]), p) for i, p in zip(numbers, points)]
        return found

    def directions(self, animation=None, time=0.0):
        """(node, primitive, kind) -> the directions of its normals (by the inverse transposed) and tangents in the world."""
        worlds, found = self.worlds(animation, time), {}
        for key, shape in self.shapes.items():
            joints = shape.influences and self.joints(self.nodes[key[0]].skin, worlds)
            maps = [blend(joints, some) for some in shape.influences] if joints else [worlds[key[0]]] * len(shape.positions)
            if shape.normals:
                found[*key, "normal"] = [unit(turn(transposed(inverse(m)), n)) for m, n in zip(maps, shape.normals)]
            if shape.tangents:
                found[*key, "tangent"] = [unit(turn(m, t[:3])) for m, t in zip(maps, shape.tangents)]
        return found


def target_of(target, asset):
    """Node and path of a channel; path None where it is of nothing that moves a vertex."""
    pointer = target.get("extensions", {}).get("KHR_animation_pointer", {}).get("pointer")
    if pointer is None:
        return target.get("node"), target["path"] if "node" in target else None
    match = re.fullmatch(r"/nodes/(\d+)/(translation|rotation|scale|weights)", pointer)
    if match:
        return int(match.group(1)), match.group(2)
    return None, None


def influence(joints, weights):
    """(joint, weight) of a vertex, the weights made to sum to 1."""
    found = [(j, w) for j, w in zip(joints, weights) if w != 0]
    size = sum(w for _, w in found)
    return [(j, w / size) for j, w in found] if found else [(joints[0], 1.0)]


def blend(matrices, influences):
    if len(influences) == 1:
        return matrices[influences[0][0]]
    parts = [(matrices[j], w) for j, w in influences]
    return [sum(m[i] * w for m, w in parts) for i in range(12)]


def morphed(shape, weights, numbers):
    active = [(target, w) for target, w in zip(shape.targets, weights) if w and target is not None]
    if not active:
        return [shape.positions[i] for i in numbers]
    return [tuple(x + sum(w * target[i][a] for target, w in active) for a, x in enumerate(shape.positions[i]))
            for i in numbers]


def size_of(positions):
    """The diagonal of what is shown."""
    points = [p for some in positions.values() for p in some]
    return math.dist(*([edge(column) for column in zip(*points)] for edge in (min, max)))


def largest_difference(a, b):
    """Between two answers of vertices()."""
    assert a.keys() == b.keys()
    return max((math.dist(p, q) for key in a for p, q in zip(a[key], b[key], strict=True)), default=0.0)
