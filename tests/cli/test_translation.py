#!/usr/bin/env python3
"""Where all offsets that act on a vertex are equal, its displacement is that offset to the bit; halves that differ by an
ulp keep the mesh that they share."""
import json
import math
import random
import struct

from gltf_build import Scene
from harness import case, check, equal, glb_split, gltf_vectors, lattice, main, obj_of, obj_vertices
from messages import anything

STEP = [0.1, -1 / 3, 100.0]
LOW, HIGH = [-2, -2, -2], [2, 2, 2]
BENT = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]


def vertices():
    numbers = random.Random(7)
    return [[numbers.uniform(-1.5, 1.5) for _ in range(3)] for _ in range(400)]


def carried(run, content, points, outside="error"):
    run.write("l.json", content)
    run.write("a.obj", obj_of(points))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--outside", outside, err=anything)
    return obj_vertices(run.text("b.obj"))


def moved(points, found, step, what=""):
    """Every point by this step: each coordinate is one addition of doubles."""
    equal(len(found), len(points), what)
    for p, q in zip(points, found):
        equal(q, [x + d for x, d in zip(p, step)], f"{what}: {p} moved")


@case
def a_lattice_that_is_moved_whole(run):
    numbers = random.Random(8)
    points = vertices()
    for kind, members in (("box", {}), ("open", {"knots": ["open", "uniform", "clamped"], "size": (6, 5, 4)}),
                          ("uniform spacing", {"rest": {"box": {"min": LOW, "max": HIGH, "spacing": "uniform"}}}),
                          ("turned", {"rest": {"box": {"min": [-4] * 3, "max": [4] * 3,
                                                       "axes": [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]}}}),
                          ("bent", {"size": (3, 3, 3), "rest": {"points": BENT}}),
                          ("rational", {"size": (3, 3, 3), "rest": {"points": BENT}, "weights": [numbers.uniform(0.5, 2) for _ in BENT]})):
        moved(points, carried(run, lattice(moves=[{"by": STEP}], **members), points), STEP, kind)


@case
def steps_add_up_in_their_order(run):
    total = [0.1 + 0.2, -0.7 + 0.1, 0.0]
    found = carried(run, lattice(moves=[{"by": [0.1, -0.7, 0]}, {"by": [0.2, 0.1, 0]}]), vertices())
    moved(vertices(), found, total)


@case
def a_part_that_moves_as_one(run):
    """Of twelve layers along x the first eight move: what has none of the others moves by that."""
    points = vertices()
    found = carried(run, lattice(size=(12, 4, 4), moves=[{"at": [[0, 7], "all", "all"], "by": STEP}]), points)
    # The spans of the domain are of 4/9; of the first five none has a layer beyond the eighth.
    whole = [p[0] < -2 + 5 * 4 / 9 for p in points]
    check(50 < sum(whole) < 350, "both kinds")
    moved([p for p, w in zip(points, whole) if w], [q for q, w in zip(found, whole) if w], STEP)


@case
def points_on_a_knot_move_as_what_acts_there(run):
    """Seven layers have knots at -1, 0 and 1: at 0 the layers 2 to 4 act, and at 2, the end, the last alone."""
    for layers, x in (([2, 4], 0.0), ([6, 6], 2.0), ([0, 0], -2.0), ([3, 6], 1.0), ([3, 6], 2.0)):
        for axis in range(3):
            points = vertices()
            for p in points:
                p[axis] = x
            at = ["all", "all", "all"]
            at[axis] = layers
            found = carried(run, lattice(size=(7, 7, 7), moves=[{"at": at, "by": STEP}]), points)
            moved(points, found, STEP, f"layers {layers} along {'xyz'[axis]}")


@case
def what_extends_moves_as_the_border(run):
    far = [[math.sin(n) * 9, math.cos(n) * 9, n / 10] for n in range(50)]
    found = carried(run, lattice(moves=[{"by": STEP}]), far, "extend")
    moved(far, found, STEP)


def scene_of(run, made, box):
    """JSON and data of the deformed scene."""
    run.write("a.glb", made.glb())
    run.write("l.json", box)
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", err=anything)
    return glb_split(run.read("b.glb"))


@case
def a_mirrored_half_keeps_its_mesh_to_an_ulp(run):
    """Two nodes, one mirrored, and a deformation symmetric about x = 0: one mesh, with the first node's bits."""
    points = [[0.1 + i / 7, j / 9 - 0.4, (i * j % 5) / 11] for i in range(6) for j in range(7)]
    box = lattice(low=(-1.1, -1.1, -1.1), high=(1.1, 1.1, 1.1), moves=[{"taper": {"axis": "y", "factor": 0.6}}])
    alone = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
    pair = Scene(nodes=[{"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]}], scene=0, scenes=[{"nodes": [0, 1]}])
    for made in (alone, pair):
        made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(points, bounds=True)}, "mode": 0}]}]
    expected, found = scene_of(run, alone, box), scene_of(run, pair, box)
    equal([len(found[0]["meshes"]), [node["mesh"] for node in found[0]["nodes"]]], [1, [0, 0]])
    equal(gltf_vectors(*found, 0), gltf_vectors(*expected, 0), "the first node's bits")
    # A twist about x is not symmetric: the halves differ, and so do their meshes.
    box["moves"].append({"twist": {"axis": "x", "degrees": 20}})
    equal(len(scene_of(run, pair, box)[0]["meshes"]), 2)


CORNERS = [(0, 0, 0), (0.25, 0, 0), (0.25, 0.25, 0)]


def ply_of(kind, points):
    head = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    return (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n{head}element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            + "".join("%.17g %.17g %.17g\n" % tuple(p) for p in points) + "3 0 1 2\n")


def stl_of(points):
    return b"binary".ljust(80) + struct.pack("<I3f9fH", 1, 0, 0, 1, *(x for p in points for x in p), 0)


def glb_of(points):
    made = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(points, bounds=True)}}]}]
    return made.glb()


@case
def floats_that_are_carried_far(run):
    """Where floats, or doubles, are too coarse for the shape, that is said and reported; not where they were so before."""
    says = "floats cannot hold: the precision of coordinates that far from the origin (off by up to 0.25, in a shape of 0.25)"
    far = [500000, 4649776, 0]

    def losses(name, low, step, expected=(), size=2):
        run.write("l.json", lattice(size=(2, 2, 2), degree=[1, 1, 1], low=low, high=[x + size for x in low], moves=[{"by": step}]))
        words = [name, "o" + name[1:], "-l", "l.json", "--force", "--report", "r.json"]
        run.ffd("deform", *words, err=expected if expected is anything else [f"{name}: {line}" for line in expected])
        return json.loads(run.text("r.json"))["jobs"][0].get("precision")

    for name, content in (("a.ply", ply_of("float", CORNERS)), ("a.stl", stl_of(CORNERS)), ("a.glb", glb_of(CORNERS))):
        run.write(name, content)
        equal(losses(name, [-1] * 3, far, [says]), {"error": 0.25, "side": 0.25}, name)
        equal(losses(name, [-1] * 3, [1, 0.1, 0]), None, f"{name}: near")
    run.write("d.ply", ply_of("double", CORNERS))
    equal(losses("d.ply", [-1] * 3, far), None, "doubles")
    run.write("f.ply", ply_of("float", [[4096 + x + 0.1, y, z] for x, y, z in CORNERS]))
    run.write("d.obj", "".join("v {} {} {}\n".format(*p) for p in CORNERS) + "f 1 2 3\n")
    run.write("d.off", "OFF\n3 1 0\n" + "".join("{} {} {}\n".format(*p) for p in CORNERS) + "3 0 1 2\n")
    doubles = "doubles cannot hold: the precision of coordinates that far from the origin (off by up to 8, in a shape of 0.25)"
    for name in ("d.ply", "d.obj", "d.off"):
        equal(losses(name, [-1] * 3, [0, 1e17, 0], [doubles]), {"error": 8, "side": 0.25}, name)
        equal(losses(name, [-1] * 3, [0, -1e9, 1e9]), None, f"{name}: doubles are fine enough")
    run.write("far.ply", ply_of("double", [[x, 1e17 + 64 * y, z] for x, y, z in CORNERS]))
    equal(losses("far.ply", [-1, 1e17 - 1000, -1], [0, 16, 0], size=2000), None, "no coarser than it was")
    equal(losses("f.ply", [4095, -1, -1], [1e-3, 0, 0]), None, "no coarser than it was")
    run.write("n.ply", ply_of("float", CORNERS + 3000 * [(math.nan,) * 3]))
    equal(losses("n.ply", [-1] * 3, far, anything), {"error": 0.25, "side": 0.25}, "beside many vertices that are not finite")


main()
