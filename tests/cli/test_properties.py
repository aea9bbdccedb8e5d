#!/usr/bin/env python3
"""What holds whatever the mesh, through the program, on OBJ and glTF (tests/property has more of it on OBJ).
The seed is printed; FFD_SEED repeats a run."""
import base64
import json
import math
import os
import random
import re
import struct

from harness import (INVALID, MODELS, OK, SANITIZED, UNSUPPORTED, announce, case, check, equal, float32, glb, glb_positions, glb_split,
                     gltf_json, gltf_vectors, lattice, main, near, obj_of, obj_vertices, threaded_case)

announce("(face is|faces are) turned over$")

SEED = int(os.environ.get("FFD_SEED") or struct.unpack("<I", os.urandom(4))[0])
# The instruction sets that kernels are compiled for, as far as this processor has them.
try:
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as cpuinfo:
        FLAGS = set(next((line for line in cpuinfo if line.startswith("flags")), "").split())
except OSError:
    FLAGS = set()
ISAS = ["auto", "scalar"] + [name for name, flag in (("sse2", "sse2"), ("avx2", "avx2"), ("avx512", "avx512vl"))
                             if flag in FLAGS]
FLOAT_EPS = 2.0 ** -23
# A node with two parents; a corner of a face that is named 0.
NOT_VALID = {"cube_att.gltf", "unassigned-skeleton.gltf", "synthetic_partial_attrib_0_obj.obj"}


def cloud(draw, count=300):
    return [[float32(draw.uniform(-1, 1)) for _ in range(3)] for _ in range(count)]


def unit(draw):
    v = [draw.gauss(0, 1) for _ in range(3)]
    length = math.sqrt(sum(x * x for x in v))
    return [float32(x / length) for x in v]


def rest_kinds(draw):
    """Lattices that hold the cube from -1 to 1: affine, separable and general inversion, all kinds of knots."""
    bent = [[x + 0.1 * y * y, y + 0.1 * math.sin(x + z), z - 0.08 * x * y] for z in (-1.5, -0.5, 0.5, 1.5)
            for y in (-1.5, -0.5, 0.5, 1.5) for x in (-1.5, -0.5, 0.5, 1.5)]
    return {
        "affine": {"size": (4, 5, 6)},
        "open": {"size": (6, 5, 4), "knots": ["open", "uniform", "clamped"], "degree": [2, 3, 1]},
        "separable": {"rest": {"box": {"min": [-2, -2, -2], "max": [2, 2, 2], "spacing": "uniform"}}, "size": (7, 5, 4)},
        "general": {"size": (4, 4, 4), "rest": {"points": bent}},
        "rational": {"size": (4, 4, 4), "weights": [draw.uniform(0.5, 2) for _ in range(64)]},
        "round": {"size": (4, 8, 4), "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 2.5],
                                                           "height": 3}}},
    }


def write_meshes(run, draw):
    points = cloud(draw)
    run.write("a.obj", obj_of(points))
    asset, data = gltf_json(points, normals=[unit(draw) for _ in points])
    run.write("a.glb", glb(asset, data))
    run.write("b.gltf", gltf_json(points, uri="b.bin")[0])
    run.write("b.bin", gltf_json(points)[1])
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    run.write("d.gltf", json.dumps({**asset, "buffers": [{"byteLength": len(data), "uri": uri}]}, indent=1))
    return points


@case
def an_identity_lattice_leaves_every_byte(run):
    """An identity lattice leaves every byte; of a .gltf with a buffer of its own only the buffer's name differs."""
    draw = random.Random(SEED)
    write_meshes(run, draw)
    for kind, members in rest_kinds(draw).items():
        for moves in ([], [{"by": [0, 0, 0]}], [{"weight": 0, "twist": {"axis": "z", "degrees": 90}}]):
            run.write("l.json", lattice(**{**members, "moves": moves}))
            for name in ("a.obj", "a.glb", "d.gltf"):
                out = "out" + name[1:]
                # The points on a cylinder's axis are singular, which is a warning.
                run.ffd("deform", name, out, "-l", "l.json", "--force", "-q")
                equal(run.read(out), run.read(name), f"{kind}: {name}")
            run.ffd("deform", "b.gltf", "out.gltf", "-l", "l.json", "--force", "-q")
            equal(run.text("out.gltf").replace("out.bin", "b.bin"), run.text("b.gltf"), kind)
            equal(run.read("out.bin"), run.read("b.bin"), kind)


@case
def affine_maps_and_translations(run):
    draw = random.Random(SEED + 1)
    points = write_meshes(run, draw)
    for kind, members in rest_kinds(draw).items():
        m = [[draw.uniform(-1, 1) for _ in range(3)] for _ in range(3)]
        by = [draw.uniform(-3, 3) for _ in range(3)]
        for moves, linear in (([{"matrix": [*m[0], by[0], *m[1], by[1], *m[2], by[2], 0, 0, 0, 1]}], m),
                              ([{"by": by}], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])):
            run.write("l.json", lattice(**{**members, "moves": moves}))
            moved = [[sum(r[c] * p[c] for c in range(3)) + t for r, t in zip(linear, by)] for p in points]
            run.ffd("deform", "a.obj", "out.obj", "-l", "l.json", "--force", "-q", "--outside", "error")
            near(obj_vertices(run.text("out.obj")), moved, 1e-13, kind)
            run.ffd("deform", "a.glb", "out.glb", "-l", "l.json", "--force", "-q", "--outside", "error")
            near(glb_positions(run.read("out.glb"))[0], moved, 4 * FLOAT_EPS, kind)


@case
def normals_follow_an_affine_map(run):
    """cof(A) n, normalised; a translation keeps the bytes of the normals."""
    draw = random.Random(SEED + 2)
    write_meshes(run, draw)
    before, data = glb_split(run.read("a.glb"))
    normals = gltf_vectors(before, data, 1)
    m = [[2, 0.5, 0], [0, 1, -0.25], [0.125, 0, 0.75]]
    cofactors = [[m[(r + 1) % 3][(c + 1) % 3] * m[(r + 2) % 3][(c + 2) % 3] - m[(r + 1) % 3][(c + 2) % 3] * m[(r + 2) % 3][(c + 1) % 3]
                  for c in range(3)] for r in range(3)]
    for kind, members in rest_kinds(draw).items():
        run.write("l.json", lattice(**{**members, "moves": [{"matrix": [*m[0], 1, *m[1], 2, *m[2], 3, 0, 0, 0, 1]}]}))
        run.ffd("deform", "a.glb", "out.glb", "-l", "l.json", "--force", "-q")
        asset, data = glb_split(run.read("out.glb"))
        for n, found in zip(normals, gltf_vectors(asset, data, 1)):
            expected = [sum(row[c] * n[c] for c in range(3)) for row in cofactors]
            length = math.sqrt(sum(x * x for x in expected))
            near(found, [x / length for x in expected], 4 * FLOAT_EPS, kind)
    run.write("l.json", lattice(moves=[{"by": [1, 2, 3]}]))
    run.ffd("deform", "a.glb", "out.glb", "-l", "l.json", "--force")
    # The gradient of a moved lattice is 0 to rounding only: the float normals must not change by more.
    near(gltf_vectors(*glb_split(run.read("out.glb")), 1), normals, FLOAT_EPS)


@case
def what_no_moved_control_point_reaches_keeps_its_bytes(run):
    """What no moved control point reaches keeps its bytes; all else of the files too."""
    draw = random.Random(SEED + 3)
    points = write_meshes(run, draw)
    run.write("l.json", lattice(size=(10, 4, 4), low=(-1, -1, -1), high=(1, 1, 1),
                                moves=[{"at": [0, "all", "all"], "by": [0, 0.5, 0]}]))
    end = -1 + 2 / 7  # ten clamped cubic control points: the first acts in the first of seven spans
    run.ffd("deform", "a.obj", "out.obj", "-l", "l.json")
    run.ffd("deform", "a.glb", "out.glb", "-l", "l.json")
    old, new = run.text("a.obj").splitlines(), run.text("out.obj").splitlines()
    asset, before = glb_split(run.read("a.glb"))
    out, after = glb_split(run.read("out.glb"))
    equal(len(after), len(before))
    moved = 0
    for n, p in enumerate(points):
        if p[0] >= end:
            equal(new[n], old[n])
            equal(after[12 * n:12 * n + 12], before[12 * n:12 * n + 12])
            normal = 12 * (len(points) + n)
            equal(after[normal:normal + 12], before[normal:normal + 12])
        moved += new[n] != old[n]
        equal(new[n].split()[1::2], old[n].split()[1::2], "x and z")
    check(10 < moved < len(points), f"{moved} moved")
    for accessor in (asset, out):
        del accessor["accessors"][0]["min"], accessor["accessors"][0]["max"]
    equal(out, asset, "the JSON")


@threaded_case
def a_large_mesh_gives_what_its_pieces_give(run):
    """Also where some of what is written together moves and some does not."""
    draw = random.Random(SEED + 5)
    points = sorted(cloud(draw, 69999))
    points[40000:40003] = [[0.9, 0.5, 0.5]] * 3
    normals = [unit(draw) for _ in points]
    moves = [{"at": [[2, 4], [0, 3], [0, 3]], "by": [0.3, 0.2, 0.1]}]
    run.write("l.json", lattice(size=(8, 4, 4), degree=[1, 1, 1], rest={"box": {"min": [-2, -2, -2], "max": [2, 2, 2]}}, moves=moves))

    def deformed(first, last, threads):
        run.write("a.glb", glb(*gltf_json(points[first:last], normals=normals[first:last])))
        run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", "-q", "-j", threads)
        asset, data = glb_split(run.read("b.glb"))
        streams = [gltf_vectors(asset, data, stream) for stream in (0, 1)]
        for name, edge in (("min", min), ("max", max)):
            equal([float32(x) for x in asset["accessors"][0][name]], [edge(axis) for axis in zip(*streams[0])], name)
        return streams

    whole = deformed(0, len(points), "3")
    equal(deformed(0, len(points), "1"), whole, "one thread")
    for first, last in ((0, 3), (3, 3000), (3000, 20001), (20001, 69999)):
        equal(deformed(first, last, "2"), [stream[first:last] for stream in whole], f"vertices {first} to {last}")
    moved = sum(old != new for old, new in zip(points, whole[0]))
    check(10000 < moved < 69000, f"{moved} moved")


@threaded_case
def order_company_threads_and_format_change_nothing(run):
    draw = random.Random(SEED + 4)
    points = write_meshes(run, draw) + cloud(draw, 500 if SANITIZED else 3000)
    for kind, members in rest_kinds(draw).items():
        run.write("l.json", lattice(**{**members, "moves": [{"twist": {"axis": "z", "degrees": 50}},
                                                           {"at": [1, 1, 1], "by": [0.1, 0.2, 0.3]}]}))
        run.write("a.obj", obj_of(points))
        run.ffd("deform", "a.obj", "one.obj", "-l", "l.json", "--force", "-q", "-j", "1")
        run.ffd("deform", "a.obj", "many.obj", "-l", "l.json", "--force", "-q", "-j", "5")
        equal(run.read("many.obj"), run.read("one.obj"), kind)
        for isa in ISAS:
            run.ffd("deform", "a.obj", "isa.obj", "-l", "l.json", "--force", "-q", "--isa", isa)
            equal(run.read("isa.obj"), run.read("one.obj"), f"{kind}, {isa}")
        straight = obj_vertices(run.text("one.obj"))
        numbers = draw.sample(range(len(points)), len(points) // 5)
        run.write("part.obj", obj_of(points[n] for n in numbers))
        run.ffd("deform", "part.obj", "part-out.obj", "-l", "l.json", "--force", "-q")
        equal(obj_vertices(run.text("part-out.obj")), [straight[n] for n in numbers], kind)
        run.write("part.glb", glb(*gltf_json([points[n] for n in numbers])))
        run.ffd("deform", "part.glb", "part-out.glb", "-l", "l.json", "--force", "-q")
        equal(glb_positions(run.read("part-out.glb"))[0], [[float32(x) for x in straight[n]] for n in numbers], kind)


def long_obj(draw, backwards):
    """Many statements of all kinds and dialects, in no order; backwards: indices count back."""
    lines, vertices, normals = [], 0, 0
    for _ in range(9000):
        kind = draw.randrange(10)
        if kind < 4 or vertices < 3 or normals < 2:
            lines.append("v" + "".join(" %.7g" % draw.uniform(-0.9, 0.9) for _ in range(3)))
            lines.append("vn" + "".join(" %.7g" % draw.uniform(-1, 1) for _ in range(3)) + draw.choice(("", " ", "# n")))
            vertices += 1
            normals += 1
        elif kind < 8:
            corners = [(draw.randrange(vertices), draw.randrange(max(0, normals - 9), normals)) for _ in range(3)]
            lines.append("f " + draw.choice((" ", " \\\n ")).join(
                f"{v - vertices}//{n - normals}" if backwards else f"{v + 1}//{n + 1}" for v, n in corners))
        else:
            lines.append(draw.choice(("# C:\\here\\", "", "g a#b", "vt 0.5 0.25", "l 1 2", "surf 0 1 0 1 1 2", "s off")))
    return "".join(line + draw.choice(("\n", "\n", "\n", "\r\n", "\r")) for line in lines) + "g end\n"


@threaded_case
def blocks_change_nothing(run):
    """A long OBJ is read and written in blocks; comments behind it make them longer."""
    draw = random.Random(SEED + 6)
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"twist": {"axis": "z", "degrees": 50}}]))
    for backwards in (False, True):
        text = long_obj(draw, backwards)
        for padding in ("", "# padding\n" * 90000, "# padding\n" * 300000):
            run.write("a.obj", text + padding)
            for threads in ("1", "2", "5"):
                run.ffd("deform", "a.obj", "out.obj", "-l", "l.json", "--force", "-q", "-j", threads)
                out = run.read("out.obj").replace(padding.encode(), b"")
                if not padding and threads == "1":
                    expected = out
                equal(out == expected, True, f"{backwards}, {len(padding)}, {threads}")
        check(len(expected) > len(text) * 1.2, "few numbers have changed")


@case
def two_lattices_are_one_on_the_result_of_the_other(run):
    """-l A -l B is B on the result of A, with one rounding at the end."""
    draw = random.Random(SEED + 5)
    write_meshes(run, draw)
    run.write("first.json", lattice(moves=[{"scale": {"factor": 0.5, "about": [0, 0, 0]}}]))
    run.write("second.json", lattice(moves=[{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.3, 0.2, 0.1]}]))
    for ending, read, error in (("obj", lambda name: obj_vertices(run.text(name)), 1e-15),
                                ("glb", lambda name: glb_positions(run.read(name))[0], 4 * FLOAT_EPS)):
        run.ffd("deform", f"a.{ending}", f"both.{ending}", "-l", "first.json", "-l", "second.json")
        run.ffd("deform", f"a.{ending}", f"step.{ending}", "-l", "first.json")
        run.ffd("deform", f"step.{ending}", f"steps.{ending}", "-l", "second.json")
        near(read(f"both.{ending}"), read(f"steps.{ending}"), error, ending)
        run.ffd("deform", f"a.{ending}", f"other.{ending}", "-l", "second.json", "-l", "first.json")
        check(read(f"other.{ending}") != read(f"both.{ending}"), "the order has no effect")


@case
def a_lattice_that_moves_back_gives_the_mesh_again(run):
    """A lattice that moves the mesh, then the one that moves it back: the mesh again, to rounding."""
    draw = random.Random(SEED + 6)
    points = write_meshes(run, draw)
    run.write("there.json", lattice(moves=[{"rotate": {"axis": "z", "degrees": 30, "about": [0, 0, 0]}}]))
    run.write("back.json", lattice(low=(-9, -9, -9), high=(9, 9, 9),
                                   moves=[{"rotate": {"axis": "z", "degrees": -30, "about": [0, 0, 0]}}]))
    run.ffd("deform", "a.obj", "out.obj", "-l", "there.json", "-l", "back.json")
    near(obj_vertices(run.text("out.obj")), points, 1e-14)


@threaded_case
def sample_models_with_buffers_of_their_own(run):
    """.gltf models: the JSON but for the buffers' names, the buffers and the images come through unchanged."""
    if not MODELS:
        return
    run.write("l.json", lattice(rest={"box": "mesh"}))
    count = refused = 0
    for folder, _, names in sorted(os.walk(MODELS)):
        for name in sorted(names):
            if not name.endswith(".gltf"):
                continue
            own = run.folder_of(f"own{count}")
            done = run.ffd("deform", os.path.join(folder, name), f"{own}/out.gltf", "-l", "l.json", "-q",
                           code=(OK, UNSUPPORTED, INVALID) if name in NOT_VALID else (OK, UNSUPPORTED))
            count += 1
            if done.code != OK:
                equal(run.names(own), [])
                refused += 1
                continue
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                before = file.read()
            blank = re.compile(r'("uri"\s*:\s*)"(?!data:)[^"]*(\.bin|\.glbin)"')
            equal(blank.sub(r"\1", run.text(f"{own}/out.gltf")), blank.sub(r"\1", before), name)
    check(count > 30 and refused < count / 2, f"{count} models, {refused} refused")


print(f"FFD_SEED={SEED}")
main()
