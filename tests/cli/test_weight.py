#!/usr/bin/env python3
"""--weight: each vertex moves by its weight times the displacement. Beside weights, slopes and determinants worked out here, and
authoring/weight-*.json, which holds right answers in 40 digits."""

import json
import math
import struct

from author import reference_cases
from batches import batch, lines_of
from gltf_arm import arm
from gltf_asset import UBYTE, USHORT
from gltf_build import SHEAR, SHIFT, Scene
from gltf_reader import Gltf
from harness import (CUBE, INVALID, IO, NO, SANITIZED, USAGE, case, check, equal, float32, glb_positions, glb_split, gltf_vectors,
                     lattice, main, near, threaded_case)
from messages import anything, counts, entry, no_line, one_line
from npy import npy


def ply(points, triangles=(), normals=None, more=()):
    """A PLY of doubles. more: further properties of the vertices, (type, name, numbers)."""
    names = ["double x", "double y", "double z"] + (["double nx", "double ny", "double nz"] if normals else [])
    rows = [list(p) + list(normals[i] if normals else []) for i, p in enumerate(points)]
    for kind, name, numbers in more:
        names.append(f"{kind} {name}")
        rows = [row + [number] for row, number in zip(rows, numbers)]
    faces = f"element face {len(triangles)}\nproperty list uchar int vertex_indices\n" if triangles else ""
    return (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n" + "".join(f"property {name}\n" for name in names) + faces + "end_header\n"
            + "".join(" ".join(map(repr, row)) + "\n" for row in rows) + "".join("%d %s\n" % (len(t), " ".join(map(str, t))) for t in triangles))


def rows_of(text, count):
    return [list(map(float, line.split())) for line in text.split("end_header\n")[1].splitlines()[:count]]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def unit(v):
    return [x / math.sqrt(dot(v, v)) for x in v]


def slopes(points, weights, triangles):
    """The definition: in each triangle g = a e1 + b e2 with g.e1 = dw1 and g.e2 = dw2; the mean by area over a position."""
    sums, areas = {}, {}
    for t in triangles:
        e, f = (minus(points[t[k]], points[t[0]]) for k in (1, 2))
        area = math.sqrt(dot(cross(e, f), cross(e, f))) / 2
        if area == 0:
            continue
        first, second = (weights[t[k]] - weights[t[0]] for k in (1, 2))
        det = dot(e, e) * dot(f, f) - dot(e, f) ** 2
        a, b = (first * dot(f, f) - second * dot(e, f)) / det, (second * dot(e, e) - first * dot(e, f)) / det
        for corner in t:
            at = tuple(points[corner])
            sums[at] = [s + area * (a * x + b * y) for s, x, y in zip(sums.get(at, [0, 0, 0]), e, f)]
            areas[at] = areas.get(at, 0) + area
    return [[s / areas[tuple(p)] for s in sums[tuple(p)]] if tuple(p) in sums else [0, 0, 0] for p in points]


def weighted(point, weight, slope):
    """A point under SHEAR, x' = x + 0.05 x y, and F = I + w E + d g^T there."""
    x, y, _ = point
    shift, gradient = 0.05 * x * y, [0.05 * y, 0.05 * x, 0]
    return [x + weight * shift, *point[1:]], [[1 + weight * gradient[0] + shift * slope[0], weight * gradient[1] + shift * slope[1], shift * slope[2]],
                                              [0, 1, 0], [0, 0, 1]]


def by(matrix, vector):
    return [dot(row, vector) for row in matrix]


def cofactor(f):
    return [cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])]


def determinant(f):
    return dot(f[0], cross(f[1], f[2]))


# A bent sheet of 4 x 4 points, each with a weight that has a short fraction, also of 255 and of single precision.
SHEET = [[float(x), float(y), 0.25 * x * y] for y in range(4) for x in range(4)]
TRIANGLES = [t for y in range(3) for x in range(3) for a in [4 * y + x] for t in ([a, a + 1, a + 5], [a, a + 5, a + 4])]
WEIGHTS = [(37 * v % 16) / 15 for v in range(16)]
BYTES = [17 * (37 * v % 16) for v in range(16)]
UP = [unit([-0.25 * y, -0.25 * x, 1]) for x, y, _ in SHEET]
ALONG = [unit([1, 0, 0.25 * y]) for x, y, _ in SHEET]


def sheet(attributes=None, **more):
    """The sheet as a GLB with normals and tangents; attributes: further ones, each (rows, component type, type, members)."""
    scene = Scene(nodes=[{"mesh": 0, "name": "node"}], scenes=[{"nodes": [0]}], scene=0)
    made = {"POSITION": scene.add(SHEET, bounds=True), "NORMAL": scene.add(UP), "TANGENT": scene.add([[*t, -1.0] for t in ALONG], shape="VEC4")}
    for name, (rows, component, shape, members) in (attributes or {}).items():
        made[name] = scene.add(rows, component, shape, **members)
    indices = scene.add([(c,) for t in TRIANGLES for c in t], UBYTE, "SCALAR")
    scene.asset["meshes"] = [{"name": "Sheet", "primitives": [{"attributes": made, "indices": indices}]}]
    scene.asset.update(more)
    return scene


def floats(numbers):
    return [[n] for n in numbers], 5126, "SCALAR", {}


def begin(run):
    run.write("shear.json", SHEAR)
    run.write("shift.json", SHIFT)
    run.write("w.npy", npy(WEIGHTS))


def deform(run, name, weight, *options, out="out", **expected):
    out += name[name.index("."):]
    done = run.ffd("deform", name, out, "-l", "shear.json", "--force", *(["--weight", weight] if weight else []), *options, **expected)
    return done, run.read(out)


@case
def the_reference_case(run):
    for name, of in reference_cases("weight"):
        run.write("L.json", of["lattice"])
        run.write("M.ply", ply(of["before"], of["triangles"], of["normals"]))
        for kind, shape in (("<f8", None), ("<f4", None), (">f8", None), ("<f8", f"({len(of['weight'])}, 1)")):
            run.write("W.npy", npy(of["weight"], kind, shape))
            job = entry(run, "deform", "M.ply", "OUT.ply", "-l", "L.json", "--weight", "W.npy",
                        err=lambda lines: one_of(lines, f"{of['clamped']} weights are below 0 or above 1"))
            rows = rows_of(run.text("OUT.ply"), len(of["before"]))
            near([row[:3] for row in rows], of["expect"]["after"], of["expect"]["tolerance"], name)
            near([row[3:6] for row in rows], of["expect"]["normals"], of["expect"]["normal_tolerance"], name)
            kept = [min(max(w, 0), 1) for w in of["weight"]]
            equal(job["weight"], {"zero": kept.count(0), "one": kept.count(1), "clamped": of["clamped"], "mean": sum(kept) / len(kept)}, name)


def one_of(lines, text):
    check(len([line for line in lines if text in line]) == 1, lines, "have no line with", text)


@case
def normals_and_tangents_are_those_of_the_map(run):
    begin(run)
    run.write("in.glb", sheet().glb())
    asset, data = glb_split(deform(run, "in.glb", "w.npy")[1])
    attributes = asset["meshes"][0]["primitives"][0]["attributes"]
    # What the file holds: single precision.
    points = [[float32(x) for x in p] for p in SHEET]
    g = slopes(points, WEIGHTS, TRIANGLES)
    found = {name: gltf_vectors(asset, data, attributes[name]) for name in ("POSITION", "NORMAL")}
    accessor = asset["accessors"][attributes["TANGENT"]]
    start = asset["bufferViews"][accessor["bufferView"]]["byteOffset"]
    tangents = list(struct.iter_unpack("<4f", data[start:start + 16 * 16]))
    for v, point in enumerate(points):
        place, f = weighted(point, WEIGHTS[v], g[v])
        normal = unit(by(cofactor(f), UP[v]))
        carried = by(f, ALONG[v])
        tangent = unit([c - dot(carried, normal) * n for c, n in zip(carried, normal)])
        near(found["POSITION"][v], place, 1e-6, v)
        near(found["NORMAL"][v], normal, 1e-6, v)
        near(tangents[v], [*tangent, -1], 1e-6, v)
    # Without the slopes they would be others by degrees.
    off = [unit(by(cofactor(weighted(p, w, [0, 0, 0])[1]), n)) for p, w, n in zip(points, WEIGHTS, UP)]
    check(min(dot(a, b) for a, b in zip(off, found["NORMAL"])) < math.cos(math.radians(2)), "the slopes make no difference")
    # A seam in the texture: vertices at one position have one slope, whichever triangles name them.
    doubled = [[16 + c if c in (5, 6) and t % 2 else c for c in corners] for t, corners in enumerate(TRIANGLES)]
    extra = {21: 5, 22: 6}
    order = list(range(16)) + [extra.get(v, 0) for v in range(16, 23)]
    run.write("seam.ply", ply([SHEET[v] for v in order], doubled, [UP[v] for v in order]))
    run.write("whole.ply", ply(SHEET, TRIANGLES, UP))
    run.write("more.npy", npy([WEIGHTS[v] for v in order]))
    whole = rows_of(deform(run, "whole.ply", "w.npy")[1].decode(), 16)
    parts = rows_of(deform(run, "seam.ply", "more.npy", lines=0)[1].decode(), 23)
    for v in (21, 22):
        equal(parts[v], parts[extra[v]], "at one position")
    near(parts[:16], whole, 1e-15)


@case
def every_source_gives_the_same_bytes(run):
    begin(run)
    shares = [[b, 255 - b, 0, 255] for b in BYTES]
    attributes = {"_FFD": floats(WEIGHTS), "_BYTE": ([[b, ] for b in BYTES], UBYTE, "SCALAR", {"normalized": True}),
                  "_SHORT": ([[257 * b] for b in BYTES], USHORT, "SCALAR", {"normalized": True}),
                  "COLOR_0": ([[0, b, 0, 128] for b in BYTES], UBYTE, "VEC4", {"normalized": True}),
                  "JOINTS_0": ([[0, 1, 0, 2]] * 16, UBYTE, "VEC4", {}), "WEIGHTS_0": (shares, UBYTE, "VEC4", {"normalized": True})}
    scene = sheet(attributes, skins=[{"joints": [1, 2, 3]}])
    scene.asset["nodes"] = [{"mesh": 0, "skin": 0}, {"name": "arm"}, {"name": "leg"}, {"name": "rest"}]
    scene.asset["scenes"] = [{"nodes": [0, 1, 2, 3]}]
    run.write("in.glb", scene.glb())
    run.write("f4.npy", npy([float32(w) for w in WEIGHTS]))
    run.write("half.npy", npy([w / 2 for w in WEIGHTS]))
    expected = deform(run, "in.glb", "w.npy", err=anything)[1]
    same = deform(run, "in.glb", "f4.npy", err=anything)[1]
    for source in ("attribute:_BYTE", "attribute:_SHORT", "color:g", "attribute:_byte"):
        equal(deform(run, "in.glb", source, err=anything)[1], expected, source)
    for source in ("attribute:_FFD", "attribute:_ffd"):
        equal(deform(run, "in.glb", source, err=anything)[1], same, source)
    near(*(glb_positions(file)[0] for file in (same, expected)), 1e-6)
    # The skin's weights sum to 2: half of each is the share of the first joint.
    equal(glb_positions(deform(run, "in.glb", "joint:arm", err=anything)[1]), glb_positions(deform(run, "in.glb", "half.npy", err=anything)[1]))
    # The other channels, of a VEC3 too, whose alpha is 1.
    run.write("0.npy", npy([0] * 16))
    equal(deform(run, "in.glb", "color:r", err=anything)[1], deform(run, "in.glb", "0.npy", err=anything)[1])
    near([p[0] for p in glb_positions(deform(run, "in.glb", "color:a", err=anything)[1])[0]],
         [x * (1 + 0.05 * y * 128 / 255) for x, y, _ in SHEET], 1e-6)
    scene.asset["accessors"][scene.asset["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]].update(type="VEC3")
    run.write("rgb.glb", scene.glb())
    equal(deform(run, "rgb.glb", "color:a", err=anything)[1], deform(run, "rgb.glb", None, err=anything)[1])
    # OBJ and PLY.
    run.write("in.obj", "".join("v %r %r %r %r %r 0\n" % (*p, w, 1 - w) for p, w in zip(SHEET, WEIGHTS)) + "".join("f %d %d %d\n" % tuple(c + 1 for c in t) for t in TRIANGLES))
    equal(deform(run, "in.obj", "color:r")[1], deform(run, "in.obj", "w.npy")[1])
    mirrored = [1 - w for w in WEIGHTS]
    run.write("m.npy", npy(mirrored))
    equal(deform(run, "in.obj", "color:g")[1], deform(run, "in.obj", "m.npy")[1])
    more = [("uchar", "red", BYTES), ("ushort", "green", [257 * b for b in BYTES]), ("double", "mask", WEIGHTS), ("float", "blue", [0.5] * 16),
            ("uchar", "alpha", [255] * 16)]
    run.write("in.ply", ply(SHEET, TRIANGLES, UP, more))
    expected = deform(run, "in.ply", "w.npy")[1]
    for source in ("color:r", "color:g", "property:red", "property:green", "property:mask"):
        equal(deform(run, "in.ply", source)[1], expected, source)
    equal(deform(run, "in.ply", "property:alpha")[1], deform(run, "in.ply", None)[1])
    near([row[0] for row in rows_of(deform(run, "in.ply", "color:b")[1].decode(), 16)], [x * (1 + 0.025 * y) for x, y, _ in SHEET], 1e-15)


@case
def inverted_is_one_minus_what_is_clamped(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES, UP, [("double", "mask", [1 - w for w in WEIGHTS])]))
    run.write("off.npy", npy([3 * w - 1 for w in WEIGHTS]))
    run.write("on.npy", npy([1 - min(max(3 * w - 1, 0), 1) for w in WEIGHTS]))
    expected = deform(run, "in.ply", "on.npy")[1]
    job = entry(run, "deform", "in.ply", "out.ply", "-l", "shear.json", "--weight", "1-off.npy")
    equal(run.read("out.ply"), expected)
    counts(job["weight"], zero=sum(w >= 2 / 3 for w in WEIGHTS), one=sum(w <= 1 / 3 for w in WEIGHTS), clamped=sum(not 1 / 3 <= w <= 2 / 3 for w in WEIGHTS))
    near([job["weight"]["mean"]], [sum(1 - min(max(3 * w - 1, 0), 1) for w in WEIGHTS) / 16], 1e-15)
    near([c for row in rows_of(deform(run, "in.ply", "1-property:mask")[1].decode(), 16) for c in row],
         [c for row in rows_of(deform(run, "in.ply", "w.npy")[1].decode(), 16) for c in row], 1e-14)


@case
def weights_of_0_keep_all_bits_and_weights_of_1_change_none(run):
    begin(run)
    for name, number in (("0.npy", 0), ("1.npy", 1)):
        run.write(name, npy([number] * 16))
    run.write("in.glb", sheet().glb())
    run.write("in.ply", ply(SHEET, TRIANGLES, UP))
    run.write("in.obj", "".join("v %r %r %r\n" % tuple(p) for p in SHEET) + "".join("f %d %d %d\n" % tuple(c + 1 for c in t) for t in TRIANGLES))
    for name in ("in.glb", "in.ply", "in.obj"):
        done, same = deform(run, name, "0.npy", lines=1)
        one_line(done, "no vertex moves: all weights are 0")
        equal(same, run.read(name), name)
        plain = deform(run, name, None)[1]
        equal(deform(run, name, "1.npy")[1], plain, name)
        for normals in ("recompute", "keep"):
            equal(deform(run, name, "1.npy", "--normals", normals, err=anything)[1], deform(run, name, None, "--normals", normals, err=anything)[1], name)
    # Several lattices: w times what they do together.
    both = ("-l", "shift.json")
    plain = rows_of(deform(run, "in.ply", None, *both)[1].decode(), 16)
    found = rows_of(deform(run, "in.ply", "w.npy", *both)[1].decode(), 16)
    near([row[:3] for row in found], [[a + w * (b - a) for a, b in zip(p, row)] for p, w, row in zip(SHEET, WEIGHTS, plain)], 1e-15)
    equal(deform(run, "in.ply", "1.npy", *both)[1], deform(run, "in.ply", None, *both)[1])
    equal(deform(run, "in.ply", "1.npy", "--blocks", *both, err=anything)[1], deform(run, "in.ply", None, "--blocks", *both, err=anything)[1])


@case
def what_is_no_source_of_weights_is_refused(run):
    begin(run)
    run.write("in.glb", sheet({"_FFD": floats(WEIGHTS), "_VEC": ([[0, 0]] * 16, 5126, "VEC2", {}), "_INT": ([[1]] * 16, UBYTE, "SCALAR", {}),
                               "_Ffd2": floats(WEIGHTS), "_fFD2": floats(WEIGHTS)}).glb())
    run.write("in.ply", ply(SHEET, TRIANGLES, None, [("int", "whole", [1] * 16), ("double", "odd", [1] * 15 + ["nan"])]))
    run.write("in.obj", CUBE)
    run.write("in.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n")
    run.write("in.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    cases = [("in.glb", "attribute:", USAGE, "names nothing"), ("in.glb", "1-", USAGE, "no source"), ("in.glb", "mask", USAGE, "no source"),
             ("in.glb", "group:mask", USAGE, "no source"), ("in.glb", "color:x", USAGE, "no channel"), ("in.glb", "color:", USAGE, "names nothing"),
             ("in.glb", "1-joint:", USAGE, "names nothing"), ("in.glb", "none.npy", IO, "none.npy"),
             ("in.glb", "attribute:_NONE", INVALID, "mesh \"Sheet\" has no attribute \"_NONE\""),
             ("in.glb", "attribute:_VEC", INVALID, "mesh \"Sheet\" .*_VEC.*SCALAR"), ("in.glb", "attribute:_INT", INVALID, "Sheet.*_INT"),
             ("in.glb", "attribute:_ffd2", INVALID, "Sheet.*no attribute"), ("in.glb", "color:r", INVALID, "Sheet.*COLOR_0"),
             ("in.glb", "joint:a", INVALID, "no skin has a joint \"a\""), ("in.glb", "property:red", INVALID, "in.glb.*property"),
             ("in.ply", "attribute:_FFD", INVALID, "in.ply.*attribute"), ("in.ply", "property:none", INVALID, "in.ply.*\"none\""),
             ("in.ply", "property:whole", INVALID, "in.ply.*type int"), ("in.ply", "property:odd", INVALID, "in.ply.*vertex 15.*nan"),
             ("in.ply", "color:r", INVALID, "in.ply.*red"), ("in.ply", "joint:a", INVALID, "in.ply"),
             ("in.obj", "color:r", INVALID, "in.obj:2: .*colour"), ("in.obj", "property:x", INVALID, "in.obj"),
             ("in.stl", "color:r", INVALID, "in.stl"), ("in.off", "color:r", INVALID, "in.off"), ("in.off", "property:x", INVALID, "in.off")]
    for name, source, code, pattern in cases:
        done = run.ffd("deform", name, "new" + name[2:], "-l", "shear.json", "--weight", source, code=code, lines=1)
        one_line(done, pattern)
        check(not run.exists("new" + name[2:]), "an output was written")
    # Colours of some vertices only.
    run.write("some.obj", "v 0 0 0 1 1 1\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n")
    one_line(run.ffd("check", "some.obj", "-l", "shear.json", "--weight", "color:r", code=INVALID), "some.obj:3: ")
    one_line(run.ffd("check", "some.obj", "-l", "shear.json", "--weight", "color:a", code=INVALID), "some.obj:1: ")
    for command in (["deform", "in.glb", "new.glb"], ["check", "in.glb"], ["view", "in.glb", "-o", "v.html"]):
        one_line(run.ffd(*command, "-l", "shear.json", "--rig", "follow", "--weight", "w.npy", code=USAGE), "--rig follow.*--weight")
        run.ffd(*command, "-l", "shear.json", "--weight", "w.npy", "--weight", "w.npy", code=USAGE)
    run.folder_of("out")
    one_line(run.ffd("deform", "in.glb", "in.ply", "--out-dir", "out", "-l", "shear.json", "--weight", "w.npy", code=USAGE), "several IN")
    # The weights are no output.
    run.ffd("deform", "in.ply", "w.npy", "-l", "shear.json", "--weight", "w.npy", "--force", "--output-format", "ply", code=IO)
    one_line(run.ffd("deform", "in.ply", "new.ply", "-l", "shear.json", "--weight", "w.npy", "--report", "w.npy", code=USAGE), "weights")


@case
def arrays_that_are_none_of_weights_are_refused(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES))
    good = npy(WEIGHTS)
    huge = npy([], shape="(1000000000000000000,)")
    broken = {"empty": b"", "text": b"0 1 2\n", "short": good[:-1], "long": good + b"\0", "head": good[:40], "magic": good[:9], "huge": huge,
              "type": npy([1] * 16, "<i4"), "count": npy(WEIGHTS[1:]), "square": npy(WEIGHTS, shape="(4, 4)"), "row": npy(WEIGHTS, shape="(1, 16)"),
              "deep": npy(WEIGHTS, shape="(16, 1, 1)"), "none": npy([1], shape="()"), "negative": npy(WEIGHTS, shape="(-16,)"),
              "overflow": npy(WEIGHTS, shape="(4294967296, 4294967297)"), "nan": npy(WEIGHTS[:7] + [math.nan] + WEIGHTS[8:]),
              "infinite": npy(WEIGHTS[:7] + [math.inf] + WEIGHTS[8:], "<f4"), "bits": good.replace(b"<f8", b"<f9")}
    for name, content in broken.items():
        run.write(f"{name}.npy", content)
        done = run.ffd("deform", "in.ply", "new.ply", "-l", "shear.json", "--weight", f"{name}.npy", "--memory", "100M", code=INVALID, lines=1)
        one_line(done, f"{name}\\.npy")
        check(not run.exists("new.ply"), name)
    one_line(run.ffd("check", "in.ply", "-l", "shear.json", "--weight", "count.npy", code=INVALID), r"\(15,\)", r"\(16,\)")
    one_line(run.ffd("check", "in.ply", "-l", "shear.json", "--weight", "1-nan.npy", code=INVALID), "vertex 7 ", "nan")


@case
def only_selected_vertices_need_weights(run):
    scene = sheet({"_FFD": floats(WEIGHTS)})
    bare = {"POSITION": scene.add([[5, 5, 5], [6, 5, 5], [5, 6, 5]], bounds=True)}
    scene.asset["meshes"].append({"name": "Bare", "primitives": [{"attributes": bare}]})
    scene.asset["nodes"].append({"mesh": 1, "name": "bare"})
    scene.asset["scenes"][0]["nodes"].append(1)
    begin(run)
    run.write("in.glb", scene.glb())
    one_line(run.ffd("check", "in.glb", "-l", "shear.json", "--weight", "attribute:_FFD", code=INVALID), "mesh \"Bare\"")
    job = entry(run, "check", "in.glb", "-l", "shear.json", "--weight", "attribute:_FFD", "--only", "node:node")
    equal(job["vertices"], 16)
    near([job["weight"]["mean"]], [sum(WEIGHTS) / 16], 1e-7)
    # In an array they have a place, and may hold anything.
    run.write("all.npy", npy([float32(w) for w in WEIGHTS] + [math.nan, 7, -7]))
    again = entry(run, "check", "in.glb", "-l", "shear.json", "--weight", "all.npy", "--only", "node:node")
    equal({**again, "seconds": 0}, {**job, "seconds": 0})
    one_line(run.ffd("check", "in.glb", "-l", "shear.json", "--weight", "w.npy", code=INVALID), r"\(16,\)", r"\(19,\)")
    # Primitives that share their positions give them one weight each.
    primitive = scene.asset["meshes"][0]["primitives"][0]
    other = {**primitive["attributes"], "_FFD": scene.add([[0.5]] * 16, 5126, "SCALAR")}
    scene.asset["meshes"] = scene.asset["meshes"][:1]
    scene.asset["nodes"], scene.asset["scenes"] = scene.asset["nodes"][:1], [{"nodes": [0]}]
    scene.asset["meshes"][0]["primitives"] = [primitive, {**primitive, "attributes": other}]
    run.write("two.glb", scene.glb())
    one_line(run.ffd("check", "two.glb", "-l", "shear.json", "--weight", "attribute:_FFD", code=INVALID), "Sheet", "different weights")
    del other["_FFD"]
    run.write("two.glb", scene.glb())
    equal(entry(run, "check", "two.glb", "-l", "shear.json", "--weight", "attribute:_FFD")["vertices"], 16)


@case
def joints_are_found_in_every_skin(run):
    begin(run)
    asset = arm()
    asset["nodes"][1]["name"], asset["nodes"][2]["name"] = "upper", "lower"
    run.write("in.gltf", asset)
    run.ffd("deform", "in.gltf", "all.gltf", "-l", "shear.json", err=anything)
    run.ffd("deform", "in.gltf", "part.gltf", "-l", "shear.json", "--weight", "joint:lower", err=anything)
    before, whole, part = (positions(run, name) for name in ("in.gltf", "all.gltf", "part.gltf"))
    equal(part[:4], before[:4])
    equal(part[4:], whole[4:])
    one_line(run.ffd("check", "in.gltf", "-l", "shear.json", "--weight", "joint:lowr", code=INVALID), "nearest: lower")
    run.write("bare.glb", sheet(skins=[{"joints": [0]}]).glb())
    one_line(run.ffd("check", "bare.glb", "-l", "shear.json", "--weight", "joint:node", code=INVALID), "Sheet", "no skin")


def positions(run, name):
    file = Gltf(run.path(name))
    return file.decoded(file.primitives()[0]["attributes"]["POSITION"])


@case
def positions_that_are_torn_apart_are_counted(run):
    begin(run)
    points = [[1, 1, 0], [2, 1, 0], [1, 2, 0], [1, 2, 0], [2, 1, 0], [2, 2, 0], [1, 2, 0]]
    weights = [1, 1, 0.25, 1, 1, 1, 0.25]
    run.write("in.ply", ply([[float(c) for c in p] for p in points], [[0, 1, 2], [3, 4, 5]]))
    run.write("t.npy", npy(weights))
    for command in (["deform", "in.ply", "out.ply"], ["check", "in.ply"]):
        job = entry(run, *command, "-l", "shear.json", "--weight", "t.npy")
        equal(job["tear"]["edges"], 1, command)
        equal(job["tear"]["vertex"], 3)
        near([job["tear"]["largest"]], [0.75 * 0.05 * 2], 1e-15)
    one_line(run.ffd("deform", "in.ply", "out.ply", "-l", "shear.json", "--weight", "t.npy", "--force", lines=1), "different weights", "--weight")
    one_line(run.ffd("deform", "in.ply", "new.ply", "-l", "shear.json", "--weight", "t.npy", "--fail-on", "tear", code=NO, err=anything), "different weights")
    run.ffd("deform", "in.ply", "new.ply", "-l", "shear.json", "--weight", "t.npy", "--fail-on", "tear=0.1", lines=1)
    shown = run.ffd("check", "in.ply", "-l", "shear.json", "--weight", "t.npy", err=anything).text
    check("at vertex 3; vertices at one position have different weights\n" in shown, shown)
    # Where nothing moves nothing is torn.
    run.write("still.json", lattice(low=(-10, -10, -10), high=(10, 10, 10)))
    equal(entry(run, "check", "in.ply", "-l", "still.json", "--weight", "t.npy")["tear"]["edges"], 0)
    run.write("even.npy", npy([0.5] * 7))
    equal(entry(run, "check", "in.ply", "-l", "shear.json", "--weight", "even.npy")["tear"]["edges"], 0)


@case
def the_step_of_a_torn_edge_is_times_the_weight_of_the_end_that_moves(run):
    begin(run)
    run.write("half.json", lattice(size=(2, 2, 2), low=(-10, -10, -10), high=(1.5, 10, 10), moves=[{"by": [0, 0, 1]}]))
    run.write("in.ply", ply([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 1.0, 0.0]], [[0, 1, 3], [0, 3, 2]]))
    for weights, largest, vertex in (([1, 1, 1, 1], 1, 1), ([0.25, 1, 0.5, 1], 0.5, 3), ([0, 1, 0, 1], 0, None)):
        run.write("s.npy", npy(weights))
        job = entry(run, "check", "in.ply", "-l", "half.json", "--weight", "s.npy")
        near([job["tear"]["largest"]], [largest], 1e-12, weights)
        check(job["tear"]["vertex"] == vertex or largest == 1, job["tear"])
        equal(job["tear"]["edges"] > 0, largest > 0)


@case
def determinants_and_flipped_faces_are_those_of_the_map(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES, UP))
    for weights in (WEIGHTS, [0 if v % 4 < 2 else 1 for v in range(16)]):
        run.write("d.npy", npy(weights))
        dets = [determinant(weighted(p, w, g)[1]) for p, w, g in zip(SHEET, weights, slopes(SHEET, weights, TRIANGLES))]
        job = entry(run, "check", "in.ply", "-l", "shear.json", "--weight", "d.npy")
        near([job["det"]["min"], job["det"]["max"]], [min(dets), max(dets)], 1e-12)
        equal(job["flipped_faces"], 0)
        equal(job["folds"], entry(run, "check", "in.ply", "-l", "shear.json")["folds"], "the proof is of w = 1")
        # Straight edges lie beside a surface that is curved by the weights too.
        check(job["edges"]["deviation"]["max"] > 0.01, job["edges"])
    # A step of the weights that folds the surface.
    run.write("far.json", lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [3, 0, 0]}]))
    run.write("step.npy", npy([1 if v % 4 < 2 else 0 for v in range(16)]))
    job = entry(run, "check", "in.ply", "-l", "far.json", "--weight", "step.npy")
    check(job["det"]["min"] < 0, job["det"])
    done = run.ffd("deform", "in.ply", "out.ply", "-l", "far.json", "--weight", "step.npy", "--force", err=anything)
    one_line(done, "inside out")
    # Linear weights and a shift: the map of the surface is affine, its edges are straight.
    run.write("linear.npy", npy([p[0] / 3 for p in SHEET]))
    near([entry(run, "check", "in.ply", "-l", "shift.json", "--weight", "linear.npy")["edges"]["deviation"]["max"]], [0], 1e-12)


@case
def morph_targets_have_the_weights_of_their_vertices(run):
    begin(run)
    scene = sheet({"_FFD": floats(WEIGHTS)})
    primitive = scene.asset["meshes"][0]["primitives"][0]
    lift = [[0.5, 0.25 * y, 0.0] for _, y, _ in SHEET]
    primitive["targets"] = [{"POSITION": scene.add(lift, bounds=True), "NORMAL": scene.add([[0.0, 0.0, 0.0]] * 16)}]
    scene.asset["meshes"][0]["weights"] = [0]
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "out.glb", "-l", "shear.json", "--weight", "attribute:_FFD")
    asset, data = glb_split(run.read("out.glb"))
    target = asset["meshes"][0]["primitives"][0]["targets"][0]
    weights, points = ([[float32(x) for x in row] for row in rows] for rows in ([[w] for w in WEIGHTS], SHEET))
    g = slopes(points, [w for w, in weights], TRIANGLES)
    found, turned = (gltf_vectors(asset, data, target[name]) for name in ("POSITION", "NORMAL"))
    for v, point in enumerate(points):
        w, = weights[v]
        moved = [a + float32(b) for a, b in zip(point, lift[v])]
        base, f = weighted(point, w, g[v])
        there, h = weighted(moved, w, g[v])
        near(found[v], minus(there, base), 2e-6, v)
        near(turned[v], minus(unit(by(cofactor(h), UP[v])), unit(by(cofactor(f), UP[v]))), 2e-6, v)
    # As a target of its own, alone or with others: the offsets are w d.
    run.write("bare.glb", sheet({"_FFD": floats(WEIGHTS)}).glb())
    for options in (("-l", "shear.json", "--as-morph", "new"), ("--morph", "new=shear.json", "--morph", "other=shift.json")):
        run.ffd("deform", "bare.glb", "morph.glb", *options, "--weight", "attribute:_FFD", "--force")
        asset, data = glb_split(run.read("morph.glb"))
        offsets = read_floats(asset, data, asset["meshes"][0]["primitives"][0]["targets"][0]["POSITION"])
        near(offsets, [[weights[v][0] * 0.05 * x * y, 0, 0] for v, (x, y, _) in enumerate(points)], 1e-6)
    # Judged is the shape that default weights show.
    scene.asset["meshes"][0]["weights"] = [1]
    run.write("shown.glb", scene.glb())
    job = entry(run, "check", "shown.glb", "-l", "shear.json", "--weight", "attribute:_FFD")
    shown = [[a + float32(b) for a, b in zip(p, m)] for p, m in zip(points, lift)]
    dets = [determinant(weighted(p, w, s)[1]) for p, (w,), s in zip(shown, weights, slopes(shown, [w for w, in weights], TRIANGLES))]
    near([job["det"]["min"], job["det"]["max"]], [min(dets), max(dets)], 1e-12)


def read_floats(asset, data, number):
    """The rows of an accessor of floats, which may be sparse."""
    accessor = asset["accessors"][number]
    rows = gltf_vectors(asset, data, number) if "bufferView" in accessor else [[0.0] * 3 for _ in range(accessor["count"])]
    sparse = accessor.get("sparse")
    if sparse:
        indices, values = sparse["indices"], sparse["values"]
        code, size = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4)}[indices["componentType"]]
        begin_at = [asset["bufferViews"][part["bufferView"]].get("byteOffset", 0) + part.get("byteOffset", 0) for part in (indices, values)]
        places = struct.unpack_from(f"<{sparse['count']}{code}", data, begin_at[0])
        for k, place in enumerate(places):
            rows[place] = list(struct.unpack_from("<3f", data, begin_at[1] + 12 * k))
        check(size > 0, "a size")
    return rows


@case
def without_faces_the_slopes_are_zero(run):
    begin(run)
    run.write("in.ply", ply(SHEET, (), UP))
    done, found = deform(run, "in.ply", "w.npy", lines=1)
    one_line(done, "in.ply has no faces", "--weight") if any("in.ply has" in line for line in done.err) else one_line(done, "no faces", "--weight")
    rows = rows_of(found.decode(), 16)
    for v, point in enumerate(SHEET):
        place, f = weighted(point, WEIGHTS[v], [0, 0, 0])
        near(rows[v], [*place, *unit(by(cofactor(f), UP[v]))], 1e-14, v)
    run.write("even.npy", npy([0.5] * 16))
    no_line(deform(run, "in.ply", "even.npy")[0], "faces")


@case
def a_jacobian_has_rows_times_the_weights(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES))
    for options in ((), ("--components",), ("-l", "shift.json", "--of", "0")):
        numbers = {}
        for name, weight in (("plain", ()), ("weighted", ("--weight", "w.npy"))):
            run.ffd("jacobian", "in.ply", "-l", "shear.json", *options, *weight, "-o", f"{name}.mtx", "--check", "--force", out=None)
            lines = [line.split() for line in run.text(f"{name}.mtx").splitlines() if not line.startswith("%")]
            numbers[name] = {(int(r), int(c)): float(x) for r, c, x in lines[1:]}
            rows = int(lines[0][0])
        per = rows // 16
        equal(set(numbers["weighted"]), {key for key in numbers["plain"] if WEIGHTS[(key[0] - 1) // per] > 0}, options)
        for key, value in numbers["weighted"].items():
            near([value], [WEIGHTS[(key[0] - 1) // per] * numbers["plain"][key]], 1e-16, key)
    run.write("p.json", {**json.loads(json.dumps(SHEAR)), "moves": [{"at": ["all", "all", 1], "by": [{"$": "A"}, 0, 0]}],
                         "parameters": {"A": {"default": 0.5}}})
    run.ffd("jacobian", "in.ply", "-l", "p.json", "--wrt", "parameters", "--weight", "1-w.npy", "-o", "p.npy", "--check", out=None)
    one_line(run.ffd("jacobian", "in.ply", "-l", "shear.json", "-o", "w.npy", "--weight", "w.npy", "--wrt", "parameters", "--force", code=IO), "w.npy")


@case
def a_batch_reads_weights_beside_its_manifest(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES, UP, [("double", "mask", WEIGHTS)]))
    run.write("jobs/w.npy", npy(WEIGHTS))
    run.write("jobs/none.npy", npy(WEIGHTS[1:]))
    sources = ["w.npy", "1-w.npy", "property:mask", "1-property:mask"]
    jobs = [{"in": "../in.ply", "lattice": "../shear.json", "out": f"o{i}.ply", "options": {"weight": source}} for i, source in enumerate(sources)]
    run.write("jobs/m.jsonl", lines_of(jobs))
    batch(run, "jobs/m.jsonl", "--report", "r.json", "-j", "1", done=4)
    for i, source in enumerate(("w.npy", "1-w.npy", "property:mask", "1-property:mask")):
        equal(run.read(f"jobs/o{i}.ply"), deform(run, "in.ply", source)[1], source)
    equal([job["weight"]["zero"] for job in json.loads(run.read("r.json"))["jobs"]], [1] * 4)
    # Up to date by what the array holds.
    batch(run, "jobs/m.jsonl", "--resume", "-j", "1", kept=4)
    run.write("jobs/w.npy", npy(WEIGHTS[::-1]))
    batch(run, "jobs/m.jsonl", "--resume", "-j", "1", done=2, kept=2)
    # Refused one by one; as an option of the whole batch too.
    wrong = [{**jobs[0], "out": f"w{i}.ply", "options": {"weight": source}} for i, source in enumerate(("none.npy", "color:", "property:none"))]
    run.write("jobs/w.jsonl", lines_of(wrong))
    batch(run, "jobs/w.jsonl", failed=[r"\(15,\)", "names nothing", "no property"])
    run.ffd("batch", "--in", "in.ply", "-l", "shear.json", "--out-dir", "o", "--weight", "mask", code=USAGE)
    batch(run, "--in", "in.ply", "-l", "shear.json", "--out-dir", "o", "--weight", "w.npy", done=1)
    equal(run.read("o/in.ply"), deform(run, "in.ply", "w.npy")[1])
    # No job reads what another one writes.
    run.write("jobs/c.jsonl", lines_of([{**jobs[0], "out": "x.npy", "options": {"output-format": "ply"}},
                                        {**jobs[0], "out": "y.ply", "options": {"weight": "x.npy"}}]))
    batch(run, "jobs/c.jsonl", done=1, failed=["the weights"])
    # A depfile and the outputs of a run name it.
    run.ffd("deform", "in.ply", "out.ply", "-l", "shear.json", "--weight", "1-w.npy", "--force", "--depfile", "d.d")
    equal(sorted(run.text("d.d").split()[1:]), ["in.ply", "shear.json", "w.npy"])


@case
def a_view_shows_weighted_positions(run):
    begin(run)
    run.write("in.ply", ply(SHEET, TRIANGLES))
    run.write("0.npy", npy([0] * 16))
    # What is deformed by weights and then shown, is what weights show.
    run.ffd("deform", "in.ply", "out.ply", "-l", "shear.json", "--weight", "w.npy")
    for name, options in (("v", ("in.ply", "-l", "shear.json", "--weight", "w.npy")), ("same", ("in.ply", "out.ply")),
                          ("plain", ("in.ply", "-l", "shear.json"))):
        run.ffd("view", *options, "-o", f"{name}.png", "--size", "80x80", "--no-cage", err=anything)
    equal(run.read("v.png"), run.read("same.png"))
    check(run.read("v.png") != run.read("plain.png"), "the weights show nothing")
    run.ffd("view", "in.ply", "-l", "shear.json", "--weight", "w.npy", "-o", "v.html", err=anything)
    check("\"weight\"" in run.text("v.html"), "the page has no report of the weights")
    run.ffd("view", "in.ply", "-l", "shear.json", "--weight", "w.npy", "-o", "w.npy", "--force", code=USAGE)
    one_line(run.ffd("view", "in.ply", "--weight", "w.npy", "-o", "f.html", lines=1), "not used", "--weight")


@threaded_case
def neither_threads_nor_instruction_sets_change_a_byte(run):
    begin(run)
    side = 40 if SANITIZED else 200
    points = [[x * 3 / side, y * 3 / side, 0.1 * math.sin(9 * x / side)] for y in range(side) for x in range(side)]
    points += points[-side:]  # a seam
    faces = [t for y in range(side - 1) for x in range(side - 1) for a in [side * y + x] for t in ([a, a + 1, a + side + 1], [a, a + side + 1, a + side])]
    faces += [[side * side + x, side * side + x + 1, x] for x in range(side - 1)]
    run.write("in.ply", ply(points, faces, [[0.0, 0.0, 1.0]] * len(points)))
    run.write("big.npy", npy([0.5 + 0.5 * math.sin(p[0] * p[1] + (i >= side * side)) for i, p in enumerate(points)]))
    expected = None
    for options in (("--threads", "1", "--isa", "scalar"), ("--threads", "1"), ("--threads", "2"), ("--threads", "5", "--isa", "sse2")):
        job = entry(run, "check", "in.ply", "-l", "shear.json", "--weight", "big.npy", "--report-stable", *options)
        run.ffd("deform", "in.ply", "out.ply", "-l", "shear.json", "--weight", "big.npy", "--force", *options, err=anything)
        found = (run.read("out.ply"), job)
        expected = expected or found
        check(found == expected, options)
    equal(expected[1]["tear"]["edges"], side - 1)  # the corner does not move


main()
