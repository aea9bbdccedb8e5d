#!/usr/bin/env python3
"""Makes the sample meshes that are our own: a fluted column, a vase and a checkered plank, as OBJ files.

    python3 data/make_models.py [FOLDER]        default: models/ beside this script

The same bytes every time. All three have texture coordinates and normals; y is up.
"""

import math
import os
import sys


class Obj:
    """An OBJ file in the making; equal texts of vt and vn are written once."""

    def __init__(self, title):
        self.lines = [f"# {title}", "# made by data/make_models.py, CC0-1.0"]
        self.pools = {"v": {}, "vt": {}, "vn": {}}
        self.faces = []

    def add(self, kind, values):
        text = kind + "".join(f" {x + 0.0:.6f}" for x in values)
        text = text.replace(" -0.000000", " 0.000000")
        pool = self.pools[kind]
        return pool.setdefault(text, len(pool) + 1)

    def say(self, line):
        self.faces.append(line)

    def face(self, corners):
        """corners: (v, vt, vn) indices, counter-clockwise as seen from outside."""
        self.faces.append("f " + " ".join("/".join(map(str, corner)) for corner in corners))

    def write(self, path):
        body = [text for pool in self.pools.values() for text in pool]
        with open(path, "w", encoding="ascii", newline="\n") as file:
            file.write("\n".join(self.lines + body + self.faces) + "\n")


def revolve(obj, profile, around, radius_at, texture_repeat):
    """A surface of revolution about y, its radius modulated round the axis.

    profile: (radius, height) pairs from the bottom to the top of the outside (then on down the inside, if
    any); radius_at(r, k): the radius at the k-th of around steps.
    """
    rows = len(profile)

    def point(row, k):
        radius, height = profile[row]
        angle = 2 * math.pi * (k % around) / around
        r = radius_at(radius, k % around)
        return (r * math.sin(angle), height, r * math.cos(angle))

    length = [0.0]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length.append(length[-1] + math.hypot(r1 - r0, y1 - y0))

    def normal(row, k):
        # Across the two grid directions, by central differences.
        a, b = point(row, k - 1), point(row, k + 1)
        c, d = point(max(row - 1, 0), k), point(min(row + 1, rows - 1), k)
        u = [b[i] - a[i] for i in range(3)]
        v = [d[i] - c[i] for i in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        size = math.sqrt(sum(x * x for x in n))
        return [x / size for x in n]

    def corner(row, k):
        return (
            obj.add("v", point(row, k)),
            obj.add("vt", (texture_repeat * k / around, length[row] / length[-1])),
            obj.add("vn", normal(row, k)),
        )

    for row in range(rows - 1):
        for k in range(around):
            obj.face([corner(row, k), corner(row, k + 1), corner(row + 1, k + 1), corner(row + 1, k)])


def ring_cap(obj, height, inner, around, radius_at, radius, up):
    """The flat end of a column: a ring down to a small polygon, no vertex on the axis."""
    normal = obj.add("vn", (0, 1 if up else -1, 0))

    def corner(r, k):
        angle = 2 * math.pi * (k % around) / around
        x, z = r * math.sin(angle), r * math.cos(angle)
        return (obj.add("v", (x, height, z)), obj.add("vt", (0.5 + 0.25 * x, 0.5 + 0.25 * z)), normal)

    middle = []
    for k in range(around):
        quad = [corner(radius_at(radius, k % around), k), corner(radius_at(radius, (k + 1) % around), k + 1),
                corner(inner, k + 1), corner(inner, k)]
        obj.face(quad if up else quad[::-1])
        middle.append(corner(inner, k))
    obj.face(middle if up else middle[::-1])


def column():
    """A Doric shaft: 20 flutes, a slight swelling (entasis), height 8, radius about 1."""
    obj = Obj("a fluted column, 8 high")
    around, rows, flutes = 80, 48, 20

    def fluted(radius, k):
        return radius * (1 - 0.07 * abs(math.sin(math.pi * flutes * k / around)))

    profile = []
    for row in range(rows + 1):
        t = row / rows
        profile.append((1 - 0.18 * t + 0.08 * math.sin(math.pi * t), 8 * t))
    obj.say("o column")
    obj.say("g shaft")
    revolve(obj, profile, around, fluted, 4)
    obj.say("g ends")
    ring_cap(obj, 0, 0.25, around, fluted, profile[0][0], False)
    ring_cap(obj, 8, 0.25, around, fluted, profile[-1][0], True)
    return obj


def vase():
    """A vase with a wall: up the outside, over the lip, down the inside; height 3."""
    obj = Obj("a vase with an inside, 3 high")
    outside = []
    for step in range(33):
        t = step / 32
        outside.append((0.62 + 0.42 * math.sin(math.pi * (1.25 * t + 0.12)) + 0.2 * t * t, 3 * t))
    inside = [(r - 0.06, max(y, 0.12)) for r, y in reversed(outside) if y > 0.12]
    floor = inside[-1][0]
    profile = [(0.04, 0.0)] + outside + inside + [(0.5 * floor, 0.12), (0.04, 0.12)]
    obj.say("o vase")
    revolve(obj, profile, 48, lambda radius, k: radius, 2)
    return obj


def plank():
    """A plank of 12 x 1 x 3 whose squares have two materials in turn."""
    obj = Obj("a checkered plank, 12 x 1 x 3")
    obj.lines.append("mtllib plank.mtl")
    per_unit, size = 4, (12, 1, 3)
    squares = {"light": [], "dark": []}
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            normal = [0, 0, 0]
            normal[axis] = 2 * side - 1
            for i in range(size[a] * per_unit):
                for j in range(size[b] * per_unit):
                    corners = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0.0, 0.0, 0.0]
                        p[axis] = size[axis] * (side - 0.5)
                        p[a] = (i + di) / per_unit - size[a] / 2
                        p[b] = (j + dj) / per_unit - size[b] / 2
                        uv = ((i + di) / per_unit, (j + dj) / per_unit)
                        corners.append((obj.add("v", p), obj.add("vt", uv), obj.add("vn", normal)))
                    colour = "dark" if (i // per_unit + j // per_unit + axis + side) % 2 else "light"
                    squares[colour].append(corners if side else corners[::-1])
    obj.say("o plank")
    for colour, faces in squares.items():
        obj.say(f"usemtl {colour}")
        for corners in faces:
            obj.face(corners)
    return obj


PLANK_MATERIALS = """\
# made by data/make_models.py, CC0-1.0
newmtl light
Kd 0.870000 0.720000 0.530000
newmtl dark
Kd 0.360000 0.200000 0.090000
"""


def main():
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), "models")
    folder = sys.argv[1] if len(sys.argv) > 1 else default
    os.makedirs(folder, exist_ok=True)
    for make in (column, vase, plank):
        make().write(os.path.join(folder, make.__name__ + ".obj"))
    with open(os.path.join(folder, "plank.mtl"), "w", encoding="ascii", newline="\n") as file:
        file.write(PLANK_MATERIALS)


if __name__ == "__main__":
    main()
