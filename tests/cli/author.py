"""Lattice files beside their right answers: control points of boxes and of files with points, offsets, weights."""

import glob
import json
import os
import struct

from bspline import greville

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "authoring")


def reference_cases(kind):
    """(name, case) of the right answers of a kind: authoring/KIND-*.json."""
    for path in sorted(glob.glob(os.path.join(FOLDER, f"{kind}-*.json"))):
        with open(path, encoding="utf-8") as file:
            yield os.path.basename(path), json.load(file)


def broken(data, random, marks):
    """Bytes of which one to four are changed to marks, cut out or doubled, half of these among the first 200."""
    data = bytearray(data)
    for _ in range(random.randint(1, 4)):
        at = random.randrange(min(len(data), random.choice([200, 1 << 30])))
        action = random.randrange(3)
        if action == 0:
            data[at] = random.choice(marks)
        elif action == 1:
            del data[at:at + random.randint(1, 40)]
        else:
            data[at:at] = data[at:at + random.randint(1, 40)]
        if not data:
            break
    return bytes(data)


def offsets_of(content):
    count = content["size"][0] * content["size"][1] * content["size"][2]
    return [list(map(float, p)) for p in content.get("deformed", {}).get("offsets", [[0, 0, 0]] * count)]


def rest_points(content):
    """At rest: those of the file, or of a box at the Greville abscissae of clamped knots."""
    rest = content["rest"]
    if "points" in rest:
        return [list(map(float, p)) for p in rest["points"]]
    box = rest["box"]
    axes = box.get("axes", [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    along = [[low + t * (high - low) for t in greville(n, d)]
             for low, high, n, d in zip(box["min"], box["max"], content["size"], content["degree"])]
    return [[sum(c * axis[x] for c, axis in zip((u, v, w), axes)) for x in range(3)]
            for w in along[2] for v in along[1] for u in along[0]]


def deformed_points(content):
    return [[p + d for p, d in zip(*both)] for both in zip(rest_points(content), offsets_of(content))]


def array(values, shape, descr="<f8", fortran=False, version=1, behind=b""):
    """An array file as numpy.save writes it."""
    head = "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }" % (descr, fortran, shape)
    size = 10 if version == 1 else 12
    head += " " * (-(size + len(head) + 1) % 64) + "\n"
    length = struct.pack("<H" if version == 1 else "<I", len(head))
    kind = {"f8": "d", "f4": "f"}[descr[1:]]
    return b"\x93NUMPY" + bytes([version, 0]) + length + head.encode() + struct.pack(f"{descr[0]}{len(values)}{kind}", *values) + behind
