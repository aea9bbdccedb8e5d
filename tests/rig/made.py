"""Rigs made for tests: an arm of three joints in a skin, with what hangs on it and stands beside it, and animations."""

import math

from gltf_build import Scene
from matrices import about, inverse, of_parts, to_numbers

FLOAT, SHORT, UBYTE = 5126, 5122, 5121
RINGS, SIDES, LENGTH, RADIUS = 9, 5, 4.0, 0.4
TIMES = [0.0, 0.4, 1.0, 1.5]
JOINTS = ("shoulder", "elbow", "hand")


def tube():
    """Points round the x axis with weights for shoulder, elbow and hand, and triangles."""
    points, joints, weights, faces = [], [], [], []
    for ring in range(RINGS):
        x = LENGTH * ring / (RINGS - 1)
        bent = min(max((x - 1.2) / 1.6, 0.0), 1.0)
        for side in range(SIDES):
            a = 2 * math.pi * side / SIDES + 0.3 * ring
            points.append([x, RADIUS * math.cos(a), RADIUS * math.sin(a)])
            joints.append([0, 1, 2, 0])
            weights.append([1 - bent, bent, 0, 0] if ring < RINGS - 1 else [0, 0.25, 0.75, 0])
            if ring:
                i, j = (ring - 1) * SIDES + side, (ring - 1) * SIDES + (side + 1) % SIDES
                faces += [[i], [j], [i + SIDES], [j], [j + SIDES], [i + SIDES]]
    return points, joints, weights, faces


class Arm(Scene):
    """Nodes by name; a test changes them, adds some and asks for glb()."""

    def __init__(self, animated=True, morphs=False, normals=False, **root):
        super().__init__(scene=0, scenes=[{"nodes": []}], nodes=[], meshes=[], skins=[])
        self.names = {}
        self.node("root", None, **{"translation": [0.3, -0.2, 0.5], **root})
        self.node("shoulder", "root")
        self.node("elbow", "shoulder", translation=[2.0, 0.0, 0.0])
        self.node("hand", "elbow", translation=[1.8, 0.0, 0.0])
        self.node("socket", "hand", translation=[0.1, 0.2, 0.05])
        self.node("eye", "hand", translation=[0.15, -0.2, 0.1], rotation=about((1, 2, 0), 25), camera=0)
        self.node("lamp", "elbow", translation=[0.2, 0.5, 0.1], extensions={"KHR_lights_punctual": {"light": 0}})
        self.node("car", "root", translation=[1.0, -1.0, 0.5])  # a group, which keeps its matrix
        self.node("axle", "car", translation=[0.4, 0.1, -0.2], rotation=about((0, 1, 1), 30))
        self.node("wheel", "axle", translation=[0.0, 0.0, 0.2], scale=[1.2, 1.2, 1.2], mesh=1)
        self.node("skin", "root", mesh=0, skin=0)
        self.asset["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
        self.asset["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
        self.asset["extensionsUsed"] = ["KHR_lights_punctual"]
        points, joints, weights, faces = tube()
        attributes = {"POSITION": self.add(points, bounds=True), "JOINTS_0": self.add(joints, UBYTE, "VEC4"),
                      "WEIGHTS_0": self.add(weights, shape="VEC4")}
        primitive = {"attributes": attributes, "indices": self.add(faces, 5123, "SCALAR")}
        if normals:
            attributes["NORMAL"] = self.add([[0.0, y / RADIUS, z / RADIUS] for _, y, z in points])
            attributes["TANGENT"] = self.add([[0.0, -z / RADIUS, y / RADIUS, 1.0] for _, y, z in points], shape="VEC4")
        if morphs:
            primitive["targets"] = [{"POSITION": self.add([[0.0, 0.1 * y, 0.2 * x * z] for x, y, z in points], bounds=True)},
                                    {"POSITION": self.add([[0.1 * z, 0.0, 0.1] for _, _, z in points], bounds=True)}]
        self.asset["meshes"].append({"primitives": [primitive]})
        rim = [[0.3 * math.cos(a), 0.3 * math.sin(a), z] for z in (0.0, 0.1) for a in range(6)]
        attributes = {"POSITION": self.add(rim, bounds=True)}
        if normals:
            attributes["NORMAL"] = self.add([[x / 0.3, y / 0.3, 0.0] for x, y, _ in rim])
            attributes["TANGENT"] = self.add([[-y / 0.3, x / 0.3, 0.0, -1.0] for x, y, _ in rim], shape="VEC4")
        self.asset["meshes"].append({"primitives": [{"attributes": attributes}]})
        self.binds = self.inverse_binds()
        self.asset["skins"].append({"joints": [self.names[name] for name in JOINTS],
                                    "inverseBindMatrices": self.matrices(self.binds)})
        if animated:
            self.animate()

    def node(self, name, parent, **members):
        number = self.names[name] = len(self.asset["nodes"])
        self.asset["nodes"].append({"name": name, **members})
        if parent is None:
            self.asset["scenes"][0]["nodes"].append(number)
        else:
            self.asset["nodes"][self.names[parent]].setdefault("children", []).append(number)
        return number

    def __getitem__(self, name):
        return self.asset["nodes"][self.names[name]]

    def inverse_binds(self):
        """Of the arm stretched along x."""
        return [inverse(of_parts((x, 0, 0), (0, 0, 0, 1), (1, 1, 1))) for x in (0.0, 2.0, 3.8)]

    def matrices(self, rows):
        return self.add([to_numbers(m) for m in rows], shape="MAT4")

    def times(self, times=TIMES):
        return self.add([[t] for t in times], shape="SCALAR", bounds=True)

    def channel(self, name, path, values, interpolation=None, times=None, component=FLOAT, animation=0, pointer=False):
        """A channel with its sampler. CUBICSPLINE: values are in-tangent, value, out-tangent of each key."""
        while len(self.asset.setdefault("animations", [])) <= animation:
            self.asset["animations"].append({"channels": [], "samplers": []})
        if component != FLOAT:
            values = [[round(x * 32767) for x in value] for value in values]
        shape = {"rotation": "VEC4", "weights": "SCALAR"}.get(path, "VEC3")
        output = self.add(values, component, shape, **({"normalized": True} if component != FLOAT else {}))
        sampler = {"input": self.times() if times is None else times, "output": output}
        if interpolation:
            sampler["interpolation"] = interpolation
        there = self.asset["animations"][animation]
        there["samplers"].append(sampler)
        self.target(name, path, len(there["samplers"]) - 1, animation, pointer)
        return output

    def target(self, name, path, sampler, animation=0, pointer=False):
        target = {"node": self.names[name], "path": path}
        if pointer:
            text = f"/nodes/{self.names[name]}/{path}"
            target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": text}}}
            self.asset["extensionsUsed"] = sorted({*self.asset["extensionsUsed"], "KHR_animation_pointer"})
        self.asset["animations"][animation]["channels"].append({"sampler": sampler, "target": target})

    def animate(self):
        self.channel("shoulder", "rotation", turns((0, 0, 1), [0, 40, 95, -20]))
        self.channel("elbow", "rotation", cubic(turns((0, 1, 0.3), [10, -60, 30, 80])), "CUBICSPLINE")
        self.channel("shoulder", "translation", [[0.1, 0, 0], [0.2, 0.1, 0], [0, 0.2, 0.3], [0.1, 0, 0]])
        self.channel("hand", "rotation", turns((1, 0, 0), [0, 45, 90, 0]), "STEP")
        self.channel("hand", "scale", [[1, 1, 1], [1.1, 1.1, 1.1], [0.9, 0.9, 0.9], [1, 1, 1]])
        self.channel("axle", "rotation", turns((0, 0, 1), [0, 90, 180, 270]))
        self.channel("axle", "translation", cubic([[0.4, 0.1, -0.2], [0.5, 0.1, -0.2], [0.6, 0.2, -0.1], [0.4, 0.1, -0.2]]),
                     "CUBICSPLINE")
        self.channel("eye", "translation", [[0.15, -0.2, 0.1], [0.2, -0.2, 0.1], [0.15, -0.1, 0.1], [0.15, -0.2, 0.1]])


def turns(axis, angles):
    return [list(about(axis, a)) for a in angles]


def cubic(values):
    """With tangents that are not those of a straight line."""
    found = []
    for k, value in enumerate(values):
        tangent = [0.3 * math.sin(k + i + x) for i, x in enumerate(value)]
        found += [tangent, value, [0.8 * x for x in tangent]]
    return found


def posed(arm):
    """The default pose is another than that of the inverse binds."""
    arm["shoulder"]["rotation"] = about((0, 1, 1), 35)
    arm["elbow"]["rotation"] = about((0, 0, 1), 50)
    return arm

