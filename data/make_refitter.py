#!/usr/bin/env python3
"""Makes what the recipe "A body's clothes by a refitter" needs: a body, a folder of clothes, and the refitter of a stouter body.

    python3 data/make_refitter.py [FOLDER]        default: refit/ in the current folder

FOLDER/body.glb and FOLDER/clothes/*.glb have y up. FOLDER/stout.npz is a lattice object of Blender, z up, in the layout of body
refitters: a ZIP of NumPy arrays. The same bytes every time; CC0-1.0.
"""

import json
import math
import os
import struct
import sys
import zipfile

AROUND = 48
# Height, half width and half depth of the body, from the knees to the crown.
BODY = [(0.50, 0.15, 0.13), (0.75, 0.18, 0.15), (0.95, 0.20, 0.16), (1.10, 0.16, 0.12), (1.30, 0.19, 0.14), (1.42, 0.20, 0.12),
        (1.48, 0.08, 0.08), (1.54, 0.07, 0.08), (1.62, 0.10, 0.12), (1.72, 0.10, 0.12), (1.80, 0.04, 0.05)]


def shape(height):
    """Half width and half depth at a height, by a smooth curve through those of BODY."""
    k = max(1, next((k for k, row in enumerate(BODY) if row[0] >= height), len(BODY) - 1))
    (a, *low), (b, *high) = BODY[k - 1:k + 1]
    t = min(max((height - a) / (b - a), 0), 1)
    t *= t * (3 - 2 * t)
    return [x + t * (y - x) for x, y in zip(low, high)]


def tube(bottom, top, rows, cloth, flare=0.0):
    """Triangles of a tube round the body, `cloth` away from it. flare: how much wider it is below."""
    points, faces = [], []
    for row in range(rows + 1):
        height = bottom + (top - bottom) * row / rows
        wide, deep = (x + cloth + flare * (1 - row / rows) for x in shape(height))
        for k in range(AROUND):
            angle = 2 * math.pi * k / AROUND
            points.append((wide * math.sin(angle), height, deep * math.cos(angle)))
    for row in range(rows):
        for k in range(AROUND):
            a, b = row * AROUND + k, row * AROUND + (k + 1) % AROUND
            faces += [a, b, b + AROUND, a, b + AROUND, a + AROUND]
    return points, faces


def normals(points, faces):
    sums = [[0.0] * 3 for _ in points]
    for corner in range(0, len(faces), 3):
        p, q, r = (points[i] for i in faces[corner:corner + 3])
        u, v = ([b - a for a, b in zip(p, other)] for other in (q, r))
        for i in faces[corner:corner + 3]:
            for x in range(3):
                sums[i][x] += u[(x + 1) % 3] * v[(x + 2) % 3] - u[(x + 2) % 3] * v[(x + 1) % 3]
    return [[x / math.hypot(*n) for x in n] for n in sums]


def write_glb(path, name, colour, points, faces):
    streams = [struct.pack(f"<{3 * len(points)}f", *(x for p in rows for x in p)) for rows in (points, normals(points, faces))]
    streams.append(struct.pack(f"<{len(faces)}H", *faces))
    edges = [[struct.unpack("<f", struct.pack("<f", pick(axis)))[0] for axis in zip(*points)] for pick in (min, max)]
    views = [{"buffer": 0, "byteOffset": sum(map(len, streams[:k])), "byteLength": len(stream)} for k, stream in enumerate(streams)]
    asset = {"asset": {"version": "2.0", "copyright": "CC0-1.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": name, "mesh": 0}],
             "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0}, "doubleSided": True}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": edges[0], "max": edges[1]},
                           {"bufferView": 1, "componentType": 5126, "count": len(points), "type": "VEC3"},
                           {"bufferView": 2, "componentType": 5123, "count": len(faces), "type": "SCALAR"}],
             "bufferViews": views, "buffers": [{"byteLength": sum(map(len, streams))}]}
    text, data = json.dumps(asset).encode(), b"".join(streams)
    text, data = text + b" " * (-len(text) % 4), data + b"\0" * (-len(data) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text
                   + struct.pack("<I4s", len(data), b"BIN\0") + data)


def array(descr, shape_, data):
    head = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape_}, }}"
    head += " " * (-(11 + len(head)) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + data


def write_refitter(path):
    """A lattice of 5 x 5 x 9 points round the body, up to the neck: wider and deeper at the waist, less so above and below."""
    size, location, scale = (5, 5, 9), (0, 0, 1), (0.7, 0.6, 1.2)
    rest = [[i / (n - 1) - 0.5 for i, n in zip(index, size)] for index in ((i, j, k) for k in range(9) for j in range(5) for i in range(5))]
    moved = [[x * (1 + 0.35 * math.exp(-20 * (z - 0.06) ** 2)), y * (1 + 0.9 * math.exp(-20 * (z - 0.06) ** 2)), z] for x, y, z in rest]
    members = {"magic": array("|S4", "(1,)", b"LATZ"), "version": array("<u2", "(1,)", struct.pack("<H", 3)),
               "name": array("|S64", "(1,)", b"stout".ljust(64, b"\0")), "interp": array("|S16", "(3,)", b"KEY_BSPLINE".ljust(16, b"\0") * 3),
               "rotation_quat": array("<f4", "(4,)", struct.pack("<4f", 1, 0, 0, 0)), "use_outside": array("|u1", "(1,)", b"\0")}
    members |= {name: array("<u2", "(1,)", struct.pack("<H", n)) for name, n in zip("UVW", size)}
    members |= {name: array("<f4", "(3,)", struct.pack("<3f", *numbers)) for name, numbers in (("location", location), ("scale", scale))}
    members |= {name: array("<f4", f"({len(rest)}, 3)", struct.pack(f"<{3 * len(rest)}f", *(x for p in points for x in p)))
                for name, points in (("points_rest", rest), ("points_deform", moved))}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name + ".npy"), data)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "refit"
    os.makedirs(os.path.join(folder, "clothes"), exist_ok=True)
    write_glb(os.path.join(folder, "body.glb"), "body", (0.8, 0.6, 0.5), *tube(0.5, 1.8, 52, 0))
    for name, colour, parts in (("tunic", (0.2, 0.4, 0.6), (0.62, 1.43, 36, 0.012, 0.05)), ("belt", (0.3, 0.2, 0.1), (1.03, 1.1, 4, 0.025)),
                                ("hat", (0.5, 0.1, 0.1), (1.7, 1.95, 12, 0.02, 0.1))):
        write_glb(os.path.join(folder, "clothes", name + ".glb"), name, colour, *tube(*parts))
    write_refitter(os.path.join(folder, "stout.npz"))


if __name__ == "__main__":
    main()
