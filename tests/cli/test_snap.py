#!/usr/bin/env python3
"""The border of a lattice: a vertex that misses the volume by no more than its file's rounding is inside, and with
--snap by no more than that."""
import json
import math
import os
import random
import re
import struct

from batches import lines_of, start
from bspline import BoxVolume
from gltf_build import Scene
from harness import (INVALID, NO, SANITIZED, USAGE, case, check, equal, float32, glb_split, gltf_vectors, lattice,
                     main, near, npy, obj_of, obj_vertices)
from messages import anything, counts, entry

# Misses the face x = 1 by a millionth, as a file of six decimals does; a second one by three, a third is far away.
NEAR = [[1.000001, 0.5, 0.25], [0.5, -0.000003, 0.75], [1.5, 0.5, 0.5], [0.5, 0.5, 0.5]]
LOW, HIGH = [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]


def bend(p):
    return [0.2 * p[1] * p[2], 0.1 * p[0] * p[0], 0.3 * p[0] * p[1]]


def begin(run):
    volume = BoxVolume(LOW, HIGH, bend)
    run.write("a.obj", obj_of(NEAR))
    run.write("l.json", {**lattice(low=LOW, high=HIGH), "deformed": {
        "points": [[x + d for x, d in zip(p, offset)] for p, offset in zip(volume.points, volume.offsets)]}})
    return volume


# The option, and which of NEAR are inside with it.
SNAPS = ([], [3]), (["--snap", "2e-6"], [0, 3]), (["--snap", "4e-6"], [0, 1, 3]), (["--snap", "1e-6r"], [0, 3]), (
    ["--snap", "2e-6r"], [0, 1, 3]), (["--snap", "0"], [3])


@case
def what_snaps_moves_with_the_nearest_point_of_the_border(run):
    volume = begin(run)
    for options, inside in SNAPS:
        found = entry(run, "deform", "a.obj", "b.obj", "-l", "l.json", *options)
        counts(found, inside=len(inside), outside=4 - len(inside))
        near(obj_vertices(run.text("b.obj")), [volume.deform(p) if i in inside else p for i, p in enumerate(NEAR)], 1e-14,
             str(options))
        counts(entry(run, "check", "a.obj", "-l", "l.json", *options), inside=len(inside))
        run.ffd("check", "a.obj", "-l", "l.json", *options, "--fail-on", "outside", code=NO, err=anything)


@case
def u_v_w_are_those_of_the_border(run):
    begin(run)
    for options, inside in SNAPS:
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", "--force", *options, err=anything)
        equal(npy(run.read("s.npy"))[2], [int(i not in inside) for i in range(4)], str(options))
        for i in inside:
            near(npy(run.read("e.npy"))[2][i], [min(max(x, 0), 1) for x in NEAR[i]], 1e-14, str(options))


@case
def curved_lattices_snap_too(run):
    """A quarter of a ring, of radius 1 to 2 by straight pieces: a point beyond the inner side is at the nearest place."""
    rest = [[r * x, r * y, h] for h in (0.0, 1.0) for x, y in ((1.0, 0.0), (0.0, 1.0)) for r in (1.0, 2.0)]
    run.write("l.json", lattice(size=(2, 2, 2), degree=[1, 1, 1], rest={"points": rest}, moves=[{"at": [0, 0, "all"], "by": [0, 0, 1]}]))
    miss = 1e-6 / math.sqrt(2)
    run.write("a.obj", obj_of([[0.75 - miss, 0.25 - miss, 0.5]]))
    counts(entry(run, "deform", "a.obj", "b.obj", "-l", "l.json"), inside=0, outside=1)
    counts(entry(run, "deform", "a.obj", "b.obj", "-l", "l.json", "--snap", "1.1e-6"), inside=1, outside=0)
    near(obj_vertices(run.text("b.obj")), [[0.75 - miss, 0.25 - miss, 1.25]], 1e-9)


@case
def equal_positions_get_equal_bits(run):
    begin(run)
    run.write("a.obj", obj_of(NEAR[:1] * 3 + NEAR))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--snap", "2e-6", err=anything)
    equal(len(set(run.text("b.obj").splitlines()[:4])), 1)


@case
def in_a_batch(run):
    start(run)
    begin(run)
    run.ffd("deform", "a.obj", "one.obj", "-l", "l.json", "--snap", "4e-6", err=anything)
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json", "out": "many.obj", "options": {"snap": "4e-6"}}]))
    run.ffd("batch", "m.jsonl", err=anything)
    equal(run.read("many.obj"), run.read("one.obj"))
    run.ffd("batch", "m.jsonl", "--snap", "4e-6", "--force", err=anything)
    equal(run.read("many.obj"), run.read("one.obj"))


@case
def an_embedding_knows_what_snapped(run):
    begin(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--snap", "4e-6", err=anything)
    run.ffd("deform", "a.obj", "one.obj", "-l", "l.json", "--snap", "4e-6", err=anything)
    run.ffd("deform", "a.obj", "two.obj", "-l", "l.json", "--snap", "4e-6", "--embedding", "e.npy", err=anything)
    equal(run.read("two.obj"), run.read("one.obj"))


@case
def values_that_make_no_sense(run):
    begin(run)
    for value in ("", "-1", "nan", "inf", "x", "1rr", "r", "-1r"):
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--snap", value, code=USAGE)
        check("--snap" in done.err[0] and "unknown option" not in done.err[0], done.err)


# The file's own rounding.

UP = [{"at": ["all", "all", -1], "by": [0, 0, 0.05]}]


def tenth(**members):
    return lattice(low=(0, 0, 0), high=(0.1, 0.1, 0.1), moves=UP, **members)


def glb_of(rows, node=None):
    made = Scene(nodes=[{"mesh": 0, **(node or {})}], scene=0, scenes=[{"nodes": [0]}])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(rows, bounds=True)}, "mode": 0}]}]
    return made.glb()


@case
def a_float_stands_for_its_rounding_cell(run):
    """The float nearest to 0.1 is a fifth of an ulp beyond it, and inside; the next one is not."""
    run.write("l.json", tenth())
    tenth_bits = struct.unpack("<I", struct.pack("<f", 0.1))[0]
    for ulps, inside in ((-1, 1), (0, 1), (1, 0)):
        x = struct.unpack("<f", struct.pack("<I", tenth_bits + ulps))[0]
        run.write("a.glb", glb_of([[x, 0.05, 0.05]]))
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=inside, outside=1 - inside)
        for header, data in (("binary_little_endian", struct.pack("<3f", x, 0.05, 0.05)), ("ascii", b"%r 0.05 0.05\n" % x)):
            run.write("a.ply", f"ply\nformat {header} 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                      "end_header\n".encode() + data)
            counts(entry(run, "check", "a.ply", "-l", "l.json"), inside=inside, outside=1 - inside)


@case
def other_text_is_the_double_it_reads_as(run):
    """0.10000000149, the float nearest to 0.1, is outside as text of an OBJ; 0.1 is inside."""
    run.write("l.json", tenth())
    for text, inside in (("0.1", 1), ("0.10000000149011612", 0), ("0.10000001", 0)):
        run.write("a.obj", f"v {text} 0.05 0.05\n")
        counts(entry(run, "check", "a.obj", "-l", "l.json"), inside=inside, outside=1 - inside)
        run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double z\n"
                  f"end_header\n{text} 0.05 0.05\n")
        counts(entry(run, "check", "a.ply", "-l", "l.json"), inside=inside, outside=1 - inside)


def as_text(run, ending, points):
    """Writes points as a text with the digits that they are given with."""
    rows = [" ".join(p) for p in points]
    head = f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\nproperty double x\nproperty double y\nproperty double z\nend_header\n"
    facets = "".join(f"facet normal 0 0 1\nouter loop\nvertex {r}\nvertex {r}\nvertex {r}\nendloop\nendfacet\n" for r in rows)
    run.write("a" + ending, {".obj": "".join(f"v {r}\n" for r in rows), ".off": f"OFF\n{len(rows)} 0 0\n" + "\n".join(rows) + "\n",
                             ".ply": head + "\n".join(rows) + "\n", ".stl": f"solid a\n{facets}endsolid a\n"}[ending])


def told_miss(done, who):
    """Returns the distance in the line of the vertices outside, as text."""
    found = re.search(rf"; {who} the lattice by at most (\S+), see --snap\)", "\n".join(done.err))
    check(found, who, "is not in", done.err)
    return found.group(1)


@case
def a_miss_by_the_digits_of_a_text_is_said(run):
    """0.333334 in a box that ends at 1/3: outside, but the line says by how much, so that --snap of that is enough."""
    third = 1 / 3
    run.write("l.json", lattice(low=(0, 0, 0), high=(third, third, third), moves=UP))
    near_by = [["0.333334", "0.1", "0.1"], ["0.333334", "0.333334", "0.2"], ["0.1", "0.1", "-0.0000001"]]
    inside, far, farther = ["0.1", "0.2", "0.1"], ["0.34", "0.1", "0.1"], ["0.2", "0.2", "0.5"]
    largest = math.hypot(0.333334 - third, 0.333334 - third)
    for ending in (".obj", ".off", ".ply", ".stl"):
        each = 3 if ending == ".stl" else 1
        for points, who in (([*near_by, inside, far, farther], f"{3 * each} of them miss"), ([*near_by, inside], "all miss"),
                            ([near_by[1], inside, far], "3 of them miss" if each == 3 else "1 of them misses"),
                            ([near_by[1], inside], "all miss" if each == 3 else "it misses")):
            as_text(run, ending, points)
            for words in (["check"], ["deform", "o" + ending, "--force"], ["embed", "-o", "e.npy", "--force"]):
                command = [words[0], "a" + ending, *words[1:], "-l", "l.json"]
                by = told_miss(run.ffd(*command, err=anything), who)
                check(largest <= float(by) <= 1.1 * largest and float(f"{float(by):.1e}") == float(by), by, largest)
            left = each * sum(p in (far, farther) for p in points)
            counts(entry(run, "check", "a" + ending, "-l", "l.json", "--snap", by), inside=each * len(points) - left, outside=left)
    # Farther away than 1e-5 of the diagonal, moved with the border, or in several lattices: nothing is said.
    as_text(run, ".obj", [["0.33334", "0.1", "0.1"], inside])
    quiet = [["check", "a.obj", "-l", "l.json"]]
    as_text(run, ".ply", [*near_by, inside])
    quiet += [["check", "a.ply", "-l", "l.json", "--outside", "extend"], ["check", "a.ply", "-l", "l.json", "-l", "l.json"]]
    for words in quiet:
        check("see --snap" not in "\n".join(run.ffd(*words, err=anything).err), words)


@case
def a_miss_of_a_curved_lattice_is_said(run):
    """A cylinder and a curved volume: what is said is enough for --snap, whatever the number of threads."""
    run.write("c.json", {"format": "ffd-lattice", "version": 1, "size": [4, 8, 4], "degree": [3, 3, 3], "moves": UP,
                         "rest": {"cylinder": {"center": [0, 0, 0], "axis": "z", "radius": [0.2, 1], "height": 1}}})
    volume = BoxVolume(LOW, HIGH, bend)
    run.write("b.json", {**lattice(low=LOW, high=HIGH, moves=UP), "rest": {"points": [[x + d for x, d in zip(p, o)] for p, o in zip(volume.points, volume.offsets)]}})
    for name, miss in (("c.json", 3.1e-6), ("c.json", 2.2e-5), ("b.json", 1.23e-6)):
        angles = [0.37 * i for i in range(200)]
        if name == "c.json":
            points = [[(1 + miss) * math.cos(t), (1 + miss) * math.sin(t), 0.25] for t in angles]
        else: # below the face w = 0
            points = [[x, y, z - miss] for x, y, z in (volume.deform([i / 16, i / 20, 0]) for i in range(1, 15))]
        run.write("a.obj", obj_of(points))
        by = told_miss(run.ffd("check", "a.obj", "-l", name, err=anything), r"(?:all miss|at least \d+ of them miss)")
        check(0.8 * miss < float(by) < 1.2 * miss, by, miss)
        counts(entry(run, "check", "a.obj", "-l", name, "--snap", by), inside=len(points), outside=0)
        for threads in ("1", "4"):
            equal(told_miss(run.ffd("check", "a.obj", "-l", name, "-j", threads, err=anything), r"(?:all miss|at least \d+ of them miss)"), by)


@case
def a_quantized_step_is_rounding_too(run):
    """16 bits from 0 to 1: 0.25 is stored as 16384/65535, a quarter of a step beyond it. The next step is outside."""
    run.write("l.json", lattice(low=(0, 0, 0), high=(0.25, 0.25, 0.25), moves=UP))
    for stored, inside in ((16383, 1), (16384, 1), (16385, 0)):
        row = [stored, 9000, 9000]
        made = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}], extensionsUsed=["KHR_mesh_quantization"],
                     extensionsRequired=["KHR_mesh_quantization"])
        view = made.view(struct.pack("<4H", *row, 0), byteStride=8)
        positions = made.view_accessor(view, [row], "VEC3", 5123, True, normalized=True)
        made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": positions}, "mode": 0}]}]
        run.write("a.glb", made.glb())
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=inside, outside=1 - inside)


@case
def the_rounding_is_carried_through_the_node(run):
    """Ten times the size, and turned by 90 degrees about z."""
    turn = {"scale": [10, 10, 10], "rotation": [0, 0, math.sqrt(0.5), math.sqrt(0.5)]}
    run.write("l.json", lattice(low=(-1, 0, 0), high=(0, 1, 1), moves=[{"by": [0, 0, 1]}]))
    run.write("a.glb", glb_of([[0.1, 0.1, 0.1], [0.1, 0.05, 0.1]], node=turn))
    counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=2, outside=0)


@case
def far_from_the_origin_a_curved_lattice_holds_its_corners(run):
    """At coordinates of 1e6 a float's ulp is 1/16: the corners are stored beside their places."""
    rest = [[1e6 + x + 0.03007 * y * z, 2e6 + y + 0.01013 * x * z, z] for z in (0.0, 10.0) for y in (0.0, 10.0) for x in (0.0, 10.0)]
    run.write("l.json", lattice(size=(2, 2, 2), degree=[1, 1, 1], rest={"points": rest}, moves=[{"by": [0, 0, 1]}]))
    run.write("a.glb", glb_of(rest))
    counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=8, outside=0, multiple=0)
    run.write("a.obj", obj_of(rest))
    counts(entry(run, "check", "a.obj", "-l", "l.json"), inside=8, outside=0, multiple=0)


@case
def the_border_of_turned_lattices_is_inside_whichever_coordinate_is_rounded_most(run):
    """Points of faces, edges and corners of eight trilinear lattices, each far away along another axis, as floats."""
    def number(*seeds):
        return math.sin(sum((2.3 + 1.7 * i) * seed for i, seed in enumerate(seeds)))

    for n in range(8):
        offset = [10.0 ** (2 + n % 5) if a == n % 3 else 3.7 * a * (n % 2) for a in range(3)]
        turn = [number(n, a) for a in range(4)]
        length = math.sqrt(sum(x * x for x in turn))
        x, y, z, w = (q / length for q in turn)
        rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        corners = []
        for i in range(8):
            p = [side * ((i >> a & 1) + 0.03 * (n % 2) * number(n, i, a)) for a, side in enumerate((1, 3, 10))]
            corners.append([sum(row[a] * p[a] for a in range(3)) + offset[r] for r, row in enumerate(rows)])

        def place(uvw, corners=corners):
            weights = [math.prod(t if i >> a & 1 else 1 - t for a, t in enumerate(uvw)) for i in range(8)]
            return [math.fsum(h * p[a] for h, p in zip(weights, corners)) for a in range(3)]

        points = []
        for k in range(150):
            uvw = [number(n, k, a) / 2 + 0.5 for a in range(3)]
            for a in range(k % 3 + 1):
                uvw[(k + a) % 3] = (k >> a + 2) % 2
            points.append(place(uvw))
        run.write("l.json", lattice(size=(2, 2, 2), degree=[1, 1, 1], rest={"points": corners}, moves=UP))
        run.write("a.glb", glb_of(points))
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=150, outside=0, multiple=0)


def write_binary(run, path, order, code, kind, rows):
    run.write(path, (f"ply\nformat binary_{order}_endian 1.0\nelement vertex {len(rows)}\n"
                     + "".join(f"property {kind} {axis}\n" for axis in "xyz") + "end_header\n").encode()
              + b"".join(struct.pack(("<" if order == "little" else ">") + "3" + code, *p) for p in rows))


@case
def a_new_lattice_holds_its_mesh_wherever_it_stands(run):
    """All shapes, without a margin, at offsets up to 1e8, in all formats. FFD_SEED=N takes other points."""
    seed = int(os.environ.get("FFD_SEED") or 33)
    numbers = random.Random(seed)
    for far in (None, 6) if SANITIZED else (None, 3, 4, 6, 8):
        offset = [(0 if far is None else 10 ** numbers.uniform(far - 1, far)) * numbers.choice((-1, 0.3, 1)) for _ in range(3)]
        sides = [10 ** numbers.uniform(-1, 1) for _ in range(3)]
        moved = [[o + s * numbers.uniform(-1, 1) for o, s in zip(offset, sides)] for _ in range(60)]
        run.write("a.obj", obj_of(moved))
        run.write("a.off", f"OFF\n{len(moved)} 0 0\n" + "".join("%r %r %r\n" % tuple(p) for p in moved))
        run.write("a.glb", glb_of(moved))
        for kind in ("float", "double"):
            run.write(f"{kind}.ply", f"ply\nformat ascii 1.0\nelement vertex {len(moved)}\n"
                      + "".join(f"property {kind} {axis}\n" for axis in "xyz") + "end_header\n" + obj_of(moved).replace("v ", ""))
        write_binary(run, "little.ply", "little", "f", "float", moved)
        write_binary(run, "big.ply", "big", "f", "float", moved)
        run.write("a.stl", b"\0" * 80 + struct.pack("<I", 20) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *moved[3 * k], *moved[3 * k + 1], *moved[3 * k + 2], 0) for k in range(20)))
        shapes = [], ["--axes", "principal"], ["--shape", "cylinder"], ["--shape", "cylinder", "--axis", "1,2,3"]
        for place, mesh in enumerate(("a.obj", "a.off", "a.glb", "float.ply", "double.ply", "little.ply", "big.ply", "a.stl")):
            # With a sanitizer every mesh and every shape, not all of both.
            for shape in shapes[place % 2::2] if SANITIZED else shapes:
                run.ffd("lattice", "new", mesh, "-o", "n.json", "--margin", "0", "--force", *shape, err=anything)
                found = entry(run, "check", mesh, "-l", "n.json")
                equal([found["outside"], found["invalid"]], [0, 0], f"FFD_SEED={seed}: {mesh} {shape} at {offset}")


def quantized(rows, normalized, node, component=5123):
    made = Scene(nodes=[{"mesh": 0, **node}], scene=0, scenes=[{"nodes": [0]}], extensionsUsed=["KHR_mesh_quantization"],
                 extensionsRequired=["KHR_mesh_quantization"])
    view = made.view(b"".join(struct.pack("<4" + {5122: "h", 5123: "H"}[component], *row, 0) for row in rows), byteStride=8)
    positions = made.view_accessor(view, rows, "VEC3", component, True, normalized=normalized)
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": positions}, "mode": 0}]}]
    return made.glb()


@case
def integers_stand_for_one_step(run):
    """10 hundredths reach from 0.095 to 0.105; 1/2 of 32767 steps, which is between two, from 16383/32767."""
    for high, inside in ((0.0951, 1), (0.0949, 0)):
        run.write("l.json", lattice(low=(0, 0, 0), high=(high, 1, 1), moves=UP))
        run.write("a.glb", quantized([[10, 50, 50]], False, {"scale": [0.01] * 3}))
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=inside, outside=1 - inside)
    run.write("l.json", lattice(low=(-1, -1, -1), high=(0.5, 0.5, 0.5), moves=UP))
    for stored, inside in ((16383, 1), (16384, 1), (16385, 0)):
        run.write("a.glb", quantized([[stored, 0, -5]], True, {}, 5122))
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=inside, outside=1 - inside)


@case
def the_rounding_is_carried_through_a_skin(run):
    """0.1 as a float, by a joint ten times as large; the next float misses by more than its own half ulp."""
    run.write("l.json", lattice(low=(0, 0, 0), high=(1, 1, 1), moves=UP))
    tenth_bits = struct.unpack("<I", struct.pack("<f", 0.1))[0]
    for ulps, inside in ((0, 1), (1, 0)):
        x = struct.unpack("<f", struct.pack("<I", tenth_bits + ulps))[0]
        made = Scene(nodes=[{"mesh": 0, "skin": 0}, {"scale": [10, 10, 10]}], scene=0, scenes=[{"nodes": [0, 1]}],
                     skins=[{"joints": [1]}])
        made.asset["meshes"] = [{"primitives": [{"mode": 0, "attributes": {
            "POSITION": made.add([[x, 0.05, 0.05]], bounds=True), "JOINTS_0": made.add([[0] * 4], component=5121, shape="VEC4"),
            "WEIGHTS_0": made.add([[1, 0, 0, 0]], shape="VEC4")}}]}]
        run.write("a.glb", made.glb())
        counts(entry(run, "check", "a.glb", "-l", "l.json"), inside=inside, outside=1 - inside)


@case
def edges_behind_another_lattice_have_the_rounding_of_where_it_brings_them(run):
    """The first brings all to 1e6, where a float stands for 1/32 to both sides (0.04 under a node, or by a joint, ten times
    as large): the second misses that by 0.02 and lifts it. What lies between the vertices goes along: straight edges stay
    true."""
    corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0]]
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [0, 1e6, 0]}]))
    run.write("m.json", lattice(low=(-9, 1e6 + 0.02, -9), high=(9, 1e6 + 9, 9), moves=[{"by": [0, 0, 1]}]))
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + obj_of(corners).replace("v ", "") + "3 0 1 2\n")
    for name, skin in (("node.glb", {}), ("skin.glb", {"skin": 0})):
        scaled = {"scale": [10, 10, 10]}
        made = Scene(nodes=[{"mesh": 0, **(skin or scaled)}, scaled], scene=0, scenes=[{"nodes": [0, 1]}])
        attributes = {"POSITION": made.add([[x / 10 for x in p] for p in corners], bounds=True)}
        if skin:
            made.asset["skins"] = [{"joints": [1]}]
            attributes["JOINTS_0"] = made.add([[0] * 4] * 3, component=5121, shape="VEC4")
            attributes["WEIGHTS_0"] = made.add([[1, 0, 0, 0]] * 3, shape="VEC4")
        made.asset["meshes"] = [{"primitives": [{"attributes": attributes}]}]
        run.write(name, made.glb())
    for name in ("a.ply", "node.glb", "skin.glb"):
        found = entry(run, "check", name, "-l", "l.json", "-l", "m.json")
        equal([found["inside"], found["tear"]["edges"]], [3, 0], name)
        near([found["edges"]["deviation"]["max"]], [0], 1e-9, name)


@case
def a_morph_target_has_the_rounding_of_base_and_offset(run):
    """0.05 and 0.05 as floats: each stands for 1.86e-9 to both sides, their sum for 3.72e-9."""
    part = float32(0.05)
    for miss, inside in ((3e-9, True), (4.5e-9, False)):
        made = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
        made.asset["meshes"] = [{"primitives": [{
            "mode": 0, "attributes": {"POSITION": made.add([[part, 0, 0]], bounds=True)},
            "targets": [{"POSITION": made.add([[part, 0, 0]], bounds=True)}]}]}]
        run.write("a.glb", made.glb())
        run.write("l.json", lattice(low=(-1, -1, -1), high=(2 * part - miss, 1, 1), moves=[{"by": [0, 0, 1]}]))
        run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", err=anything)
        moved = gltf_vectors(*glb_split(run.read("b.glb")), 1)[0]
        equal(moved[2], 0 if inside else -1, f"misses by {miss}")


@case
def behind_another_lattice_a_vertex_stands_for_as_much_as_if_it_were_stored(run):
    """Ten times as large, 0.1 misses the second box by ten times as much; a float of 1 stands for that, text does not."""
    run.write("ten.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"scale": {"factor": 10, "about": [0, 0, 0]}}]))
    run.write("one.json", lattice(low=(0, 0, 0), high=(1, 1, 1), moves=UP))
    x = float32(0.1)
    run.write("a.glb", glb_of([[x, 0.05, 0.05]]))
    run.write("a.obj", f"v {x!r} 0.05 0.05\n")
    # The first one makes it ten times as large, about 0; the second one moves what is in it up.
    for mesh, moves in (("a.glb", True), ("a.obj", False)):
        bounds = entry(run, "check", mesh, "-l", "ten.json", "-l", "one.json")["bounds"]["after"]
        check((bounds["max"][2] > 0.5001) == moves, mesh, bounds)


@case
def edges_along_the_border_follow_their_ends(run):
    """A straight edge between moved vertices beside the border is moved all along: the surface does not deviate."""
    run.write("l.json", lattice(size=(2, 2, 2), degree=[1, 1, 1], low=(0, 0, 0), high=(0.1, 0.1, 0.1), moves=[{"by": [0, 0, 1]}]))
    corners = [[x, y, z] for z in (0, 0.1) for y in (0, 0.1) for x in (0, 0.1)]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 8\n" + "".join(f"property float {axis}\n" for axis in "xyz")
              + "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
              + "".join("%r %r %r\n" % tuple(p) for p in corners) + "".join("4 %d %d %d %d\n" % tuple(f) for f in faces))
    done = run.ffd("check", "a.ply", "-l", "l.json", "--report", "r.json", err=anything)
    edges = json.loads(run.read("r.json"))["jobs"][0]["edges"]
    equal(edges["count"], 12, str(done.out))
    near([edges["deviation"]["max"]], [0], 1e-15)


@case
def jobs_with_other_snaps_share_no_u_v_w(run):
    start(run)
    begin(run)
    snaps = "4e-6", "0", "2e-6", "2e-6r"
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json", "out": f"{i}.obj", "options": {"snap": snap}}
                                   for i, snap in enumerate(snaps)]))
    run.ffd("batch", "m.jsonl", "-j", "1", err=anything)
    for i, snap in enumerate(snaps):
        run.ffd("deform", "a.obj", "one.obj", "-l", "l.json", "--snap", snap, "--force", err=anything)
        equal(run.read(f"{i}.obj"), run.read("one.obj"), snap)


@case
def an_embedding_of_another_snap_or_number_type_is_refused(run):
    begin(run)
    for made, used in ((["--snap", "4e-6"], []), ([], ["--snap", "4e-6"]), (["--snap", "4e-6"], ["--snap", "4e-6r"])):
        run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--force", *made, err=anything)
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--embedding", "e.npy", *used, code=INVALID, err=anything)
        check("--snap" in done.err[0], done.err)
    run.write("l.json", tenth())
    rows = [[float32(0.1), 0.05, 0.05]]
    run.write("a.glb", glb_of(rows))
    run.write("a.obj", obj_of(rows))
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy", "--force")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--embedding", "e.npy", code=INVALID, err=anything)


@case
def new_lattices_hold_what_is_placed_and_quantized(run):
    """Under a turned and scaled node far away, as floats and as integers; as text of an STL; as doubles of a binary PLY."""
    turn = [0.1, -0.5, 0.3, math.sqrt(1 - 0.01 - 0.25 - 0.09)]
    points = [[math.sin(n) * 3, math.sin(2.3 * n), math.sin(4.1 * n) * 0.01] for n in range(60)]
    for offset in (0.0, 1e6) if SANITIZED else (0.0, 12345.678, 1e6, 1e8):
        node = {"translation": [offset, -0.7 * offset, 0.001 * offset], "rotation": turn, "scale": [3, 1, 0.02]}
        moved = [[x + offset, y - 0.7 * offset, z + 0.001 * offset] for x, y, z in points]
        run.write("a.glb", glb_of(points, node))
        run.write("q.glb", quantized([[int(20000 + 5000 * x) for x in p] for p in points], True, node))
        run.write("a.stl", "solid a\n" + "".join(
            "facet normal 0 0 0\nouter loop\n" + "".join("vertex %r %r %r\n" % tuple(p) for p in moved[n:n + 3])
            + "endloop\nendfacet\n" for n in range(0, 60, 3)) + "endsolid a\n")
        write_binary(run, "a.ply", "little", "d", "double", moved)
        for mesh in ("a.glb", "q.glb", "a.stl", "a.ply"):
            for shape in ([], ["--axes", "principal"], ["--shape", "cylinder", "--axis", "1,2,3"]):
                run.ffd("lattice", "new", mesh, "-o", "n.json", "--margin", "0", "--force", *shape, err=anything)
                found = entry(run, "check", mesh, "-l", "n.json")
                equal([found["outside"], found["invalid"]], [0, 0], f"{mesh} {shape} at {offset}")


@case
def why_a_vertex_is_singular(run):
    """On the axis of a full cylinder the lattice collapses. On that of a pipe of exact circles (P&T 7.5) all of the
    border is equally near: a snap that all but reaches it has too much to look at."""
    run.write("a.obj", "v 0 0 0.5\nv 0.75 0 0.5\n")
    run.write("l.json", lattice(size=(2, 6, 2), rest={"cylinder": {
        "center": [0, 0, 0.5], "axis": "z", "radius": [0, 1], "height": 1}}))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy",
            err="a.obj: 1 of 2 vertices is not inside: 1 singular (where the lattice folds or collapses)")
    corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    turn = [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1]
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [2, 9, 2], "degree": [1, 2, 1], "knots": ["clamped", turn, "clamped"],
                         "rest": {"points": [[r * x, r * y, z] for z in (0, 1) for x, y in corners for r in (0.5, 1)]},
                         "weights": [math.sqrt(0.5) if j % 2 else 1 for _ in (0, 1) for j in range(9) for _ in (0, 1)],
                         "moves": []})
    said = "for 1 vertex the search ended at its limits: there may be u,v,w that it did not find"
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--force", "--snap", repr(0.5 - 5e-11),
            err=lambda lines: equal(lines, ["a.obj: 1 of 2 vertices is not inside: 1 singular", "a.obj: " + said]))


main()
