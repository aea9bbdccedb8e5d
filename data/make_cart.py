#!/usr/bin/env python3
"""Makes models/cart.glb, a cart with a sword on it, whose wheels an animation turns.

    python3 make_cart.py [OUT]         default: models/cart.glb beside this script

The same bytes every time. y is up, the cart drives along x. The model is CC0-1.0.
"""

import json
import math
import os
import struct
import sys

SIDES = 20  # of a wheel


def box(low, high, steps=(1, 1, 1), narrow=0.0):
    """A box, each side in steps. narrow: by how much of it the top is narrower in x and z than the bottom."""
    points, faces = [], []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            base = len(points)
            for i in range(steps[first] + 1):
                for j in range(steps[second] + 1):
                    share = [0.0, 0.0, 0.0]
                    share[axis], share[first], share[second] = side, i / steps[first], j / steps[second]
                    width = 1 - narrow * share[1]
                    points.append([low[a] + (high[a] - low[a]) * (share[a] if a == 1 else 0.5 + (share[a] - 0.5) * width) for a in range(3)])
            row = steps[second] + 1
            for i in range(steps[first]):
                for j in range(steps[second]):
                    a = base + i * row + j
                    quad = [a, a + row, a + row + 1, a + 1]
                    faces += quads([quad if side else quad[::-1]])
    return points, faces


def quads(corners):
    return [i for a, b, c, d in corners for i in (a, b, c, a, c, d)]


def rim(z, outer=0.5, inner=0.37, half=0.06):
    """A ring round the z axis."""
    points = [[r * math.cos(2 * math.pi * s / SIDES), r * math.sin(2 * math.pi * s / SIDES), z + d]
              for s in range(SIDES) for r, d in ((outer, -half), (outer, half), (inner, half), (inner, -half))]
    corner = lambda s, k: 4 * (s % SIDES) + k % 4
    return points, quads([[corner(s, k), corner(s + 1, k), corner(s + 1, k + 1), corner(s, k + 1)] for s in range(SIDES) for k in range(4)])


def joined(*shapes):
    points, faces = [], []
    for more, corners in shapes:
        faces += [len(points) + i for i in corners]
        points += more
    return points, faces


def wheels():
    """Two wheels of three spokes, each spoke from rim to rim, and their axle, round the origin."""
    shapes = [box((-0.05, -0.05, -0.85), (0.05, 0.05, 0.85))]
    for z in (-0.85, 0.85):
        shapes.append(rim(z))
        for k in range(3):
            turn = math.pi * k / 3
            points, faces = box((-0.4, -0.035, z - 0.03), (0.4, 0.035, z + 0.03))
            shapes.append(([[x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn), w] for x, y, w in points], faces))
    return joined(*shapes)


def bed():
    return joined(box((-1.7, 0.55, -0.7), (1.7, 0.7, 0.7), (16, 1, 2)), box((-1.7, 0.7, -0.7), (1.7, 1.0, -0.62), (16, 2, 1)),
                  box((-1.7, 0.7, 0.62), (1.7, 1.0, 0.7), (16, 2, 1)), box((1.7, 0.56, -0.06), (3.0, 0.68, 0.06), (8, 1, 1)))


def hilt():
    return joined(box((-0.05, 0.7, -0.05), (0.05, 1.1, 0.05), (1, 3, 1)), box((-0.25, 1.1, -0.06), (0.25, 1.2, 0.06), (4, 1, 1)))


def blade():
    return box((-0.1, 1.2, -0.025), (0.1, 3.0, 0.025), (1, 14, 1), narrow=0.75)


class Asset:
    def __init__(self):
        self.data = bytearray()
        self.views, self.accessors, self.meshes = [], [], []

    def add(self, code, kind, rows, bounds=False):
        component = {"f": 5126, "H": 5123}[code]
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(rows) * len(rows[0]) * struct.calcsize(code)})
        rows = [struct.unpack(f"<{len(row)}{code}", struct.pack(f"<{len(row)}{code}", *row)) for row in rows]
        self.data += b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows)
        self.data += b"\0" * (-len(self.data) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if bounds:
            accessor |= {"min": [min(column) for column in zip(*rows)], "max": [max(column) for column in zip(*rows)]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def mesh(self, name, *shapes):
        """A mesh of a primitive for each (material, shape)."""
        self.meshes.append({"name": name, "primitives": [
            {"attributes": {"POSITION": self.add("f", "VEC3", points, bounds=True)}, "indices": self.add("H", "SCALAR", [[i] for i in faces]), "material": material}
            for material, (points, faces) in shapes]})
        return len(self.meshes) - 1


def colour(name, *rgb):
    return {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*rgb, 1], "metallicFactor": 0}}


def cart():
    asset = Asset()
    nodes = [{"name": "cart", "children": [1, 2, 3, 4]}, {"name": "bed", "mesh": asset.mesh("bed", (0, bed()))},
             {"name": "front", "mesh": asset.mesh("wheels", (1, wheels())), "translation": [1.1, 0.5, 0]},
             {"name": "back", "mesh": 1, "translation": [-1.1, 0.5, 0]},
             {"name": "sword", "mesh": asset.mesh("sword", (1, hilt()), (2, blade())), "translation": [-0.9, 0, 0]}]
    times = asset.add("f", "SCALAR", [[k / 2] for k in range(5)], bounds=True)
    turns = asset.add("f", "VEC4", [[0, 0, -math.sin(k * math.pi / 4), math.cos(k * math.pi / 4)] for k in range(5)])
    channels = [{"sampler": 0, "target": {"node": node, "path": "rotation"}} for node in (2, 3)]
    document = {"asset": {"version": "2.0", "generator": "data/make_cart.py", "copyright": "CC0-1.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": nodes, "meshes": asset.meshes,
                "materials": [colour("wood", 0.45, 0.26, 0.12), colour("iron", 0.12, 0.12, 0.14), colour("steel", 0.3, 0.36, 0.45)],
                "animations": [{"name": "roll", "samplers": [{"input": times, "output": turns}], "channels": channels}],
                "bufferViews": asset.views, "accessors": asset.accessors, "buffers": [{"byteLength": len(asset.data)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(asset.data), b"BIN\0") + asset.data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "models", "cart.glb")
    with open(out, "wb") as file:
        file.write(cart())


main()
