"""Rigs drawn at random: any hierarchy, poses, scales, skins and animations, with what files have in common shared or not."""

from bspline import BoxVolume
from gltf_build import Scene
from made import FLOAT, SHORT, UBYTE
from matrices import about, inverse, of_parts, product, to_numbers
from rule import Deformation
from vectors import cross, unit

POINTS = 4  # vertices of a mesh


class Drawn(Scene):
    def __init__(self, random, uneven):
        super().__init__(scene=0, scenes=[{"nodes": []}], nodes=[], meshes=[], cameras=[], skins=[], animations=[])
        self.random, self.uneven, self.made = random, uneven, {}
        self.asset["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
        self.parents = []
        for number in range(random.randint(3, 14)):
            self.parents.append(random.choice([None, *range(number)][-4:]) if number else None)
            self.asset["nodes"].append(self.node(number))
            if self.parents[number] is None:
                self.asset["scenes"][0]["nodes"].append(number)
            else:
                self.asset["nodes"][self.parents[number]].setdefault("children", []).append(number)
        self.free = [n for n, node in enumerate(self.asset["nodes"]) if "matrix" not in node]
        for _ in range(random.randint(0, 2)):
            self.skin()
        for node in random.sample(range(len(self.parents)), random.randint(1, 3)):
            self.dress(node)
        for _ in range(random.randint(1, 2)):
            self.animate()
        for key in ("skins", "animations", "meshes"):
            if not self.asset[key]:
                del self.asset[key]

    def vector(self, size):
        return [self.random.uniform(-size, size) for _ in range(3)]

    def turn(self):
        return list(about(self.vector(1), self.random.uniform(-170, 170)))

    def scale(self):
        kind = self.random.random()
        if kind < 0.5:
            return None
        if self.uneven and kind > 0.8:
            return [self.random.uniform(0.6, 1.5) for _ in range(3)]
        one = self.random.uniform(0.6, 1.5)
        return [one * self.random.choice([1, 1, 1, -1])] * 3

    def node(self, number):
        node = {"name": f"n{number}"}
        parts = {"translation": self.vector(1.0), "rotation": self.turn(), "scale": self.scale()}
        if self.random.random() < 0.2:
            node["matrix"] = to_numbers(of_parts(parts["translation"], parts["rotation"], parts["scale"] or (1, 1, 1)))
            return node
        node |= {key: value for key, value in parts.items() if value and self.random.random() < 0.8}
        if self.random.random() < 0.1:
            node["camera"] = 0
        return node

    def world(self, number):
        node = self.asset["nodes"][number]
        local = of_parts(node.get("translation", (0, 0, 0)), node.get("rotation", (0, 0, 0, 1)), node.get("scale", (1, 1, 1)))
        if "matrix" in node:
            local = tuple(node["matrix"][4 * j + i] for i in range(3) for j in range(4))
        return local if self.parents[number] is None else product(self.world(self.parents[number]), local)

    def skin(self):
        count = len(self.parents)
        joints = self.random.sample(range(count), self.random.randint(1, min(4, count)))
        skin = {"joints": joints}
        kind = self.random.random()
        if kind < 0.3 and "binds" in self.made and self.made["binds"][1] >= len(joints):
            skin["inverseBindMatrices"] = self.made["binds"][0]
        elif kind < 0.85:
            # Those of the default pose, or of another one.
            binds = [product(inverse(self.world(j)), of_parts(self.vector(0.3), self.turn(), (1, 1, 1)) if kind < 0.5
                             else of_parts((0, 0, 0), (0, 0, 0, 1), (1, 1, 1))) for j in joints]
            skin["inverseBindMatrices"] = self.add([to_numbers(m) for m in binds], shape="MAT4")
            self.made["binds"] = skin["inverseBindMatrices"], len(joints)
        self.asset["skins"].append(skin)

    def mesh(self, joints):
        attributes = {"POSITION": self.add([self.vector(1.0) for _ in range(POINTS)], bounds=True)}
        if self.random.random() < 0.5:
            normals = [unit(self.vector(1.0)) for _ in range(POINTS)]
            attributes["NORMAL"] = self.add(normals)
            attributes["TANGENT"] = self.add([[*unit(cross(n, self.vector(1.0))), 1.0] for n in normals], shape="VEC4")
        if joints:
            attributes["JOINTS_0"] = self.add([[self.random.randrange(joints) for _ in range(4)] for _ in range(POINTS)], UBYTE, "VEC4")
            # Mostly one joint has most of it: sums of turned matrices come near to having no inverse.
            attributes["WEIGHTS_0"] = self.add([[0.8, 0.2, 0, 0] if self.random.random() < 0.5 else [1, 0, 0, 0]
                                                for _ in range(POINTS)], FLOAT, "VEC4")
        primitive = {"mode": 0, "attributes": attributes}
        if self.random.random() < 0.3:
            primitive["targets"] = [{"POSITION": self.add([self.vector(0.2) for _ in range(POINTS)], bounds=True)}]
        self.asset["meshes"].append({"primitives": [primitive]})
        return len(self.asset["meshes"]) - 1

    def dress(self, number):
        """A mesh for a node, in a skin or not, new or one that another node has."""
        node, skins = self.asset["nodes"][number], self.asset["skins"]
        skin = self.random.randrange(len(skins)) if skins and self.random.random() < 0.6 else None
        width = min((len(some["joints"]) for some in skins), default=0)  # also where the node has none: nothing forbids it
        known = self.made.setdefault(("mesh", width), [])
        if not known or self.random.random() < 0.6:
            known.append(self.mesh(width))
        node["mesh"] = self.random.choice(known)
        if skin is not None:
            node["skin"] = skin

    def sampler(self, path):
        keys = self.random.randint(1, 4)
        kind = self.random.choice(["LINEAR", "STEP", "CUBICSPLINE"] if keys > 1 else ["LINEAR", "STEP"])
        make = {"translation": lambda: self.vector(1.0), "rotation": self.turn, "scale": lambda: [self.random.uniform(0.7, 1.4)] * 3}[path]
        rows = [make() for _ in range(keys)]
        if kind == "CUBICSPLINE":
            width = len(rows[0])
            rows = [row for value in rows for row in ([self.random.uniform(-0.3, 0.3) for _ in range(width)], value,
                                                      [self.random.uniform(-0.3, 0.3) for _ in range(width)])]
        is_short = path == "rotation" and self.random.random() < 0.3
        if is_short:
            rows = [[round(32767 * x) for x in row] for row in rows]
        times = self.add([[0.1 + 0.3 * k] for k in range(keys)], shape="SCALAR", bounds=True)
        output = self.add(rows, SHORT if is_short else FLOAT, "VEC4" if path == "rotation" else "VEC3",
                          **({"normalized": True} if is_short else {}))
        return {"input": times, "output": output, "interpolation": kind}

    def animate(self):
        animation, samplers = {"channels": [], "samplers": []}, {}
        for number in self.random.sample(self.free, min(len(self.free), self.random.randint(1, 5))):
            for path in self.random.sample(["translation", "rotation", "scale"], self.random.randint(1, 3)):
                known = self.made.setdefault(path, [])
                if not known or self.random.random() < 0.6:
                    known.append(self.sampler(path))
                sampler = self.random.choice(known)
                if id(sampler) not in samplers:
                    samplers[id(sampler)] = len(animation["samplers"])
                    animation["samplers"].append(sampler)
                animation["channels"].append({"sampler": samplers[id(sampler)], "target": {"node": number, "path": path}})
        if animation["channels"]:
            self.asset["animations"].append(animation)


def drawn_deformation(random):
    """One or two volumes, large or cutting the scene."""
    volumes = []
    for _ in range(random.randint(1, 2)):
        size = random.choice([12.3, 12.3, 2.1])
        low, high = [-size + random.uniform(-0.5, 0.5) for _ in range(3)], [size + random.uniform(-0.5, 0.5) for _ in range(3)]
        moves = [[random.uniform(-0.1, 0.1) * size for _ in range(3)] for _ in range(27)]
        waiting = iter(moves)
        volumes.append(BoxVolume(low, high, lambda _, waiting=waiting: next(waiting), (3, 3, 3), (2, 2, 2)))
    return Deformation(*volumes)
