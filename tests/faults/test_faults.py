#!/usr/bin/env python3
"""What once went wrong in silence, one folder each: embedding (maths-*), the fold proof (maths3-*), and files and situations that users of such
tools have reported (wild-*). Each case runs the program on the files of its folder and says what is right.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_faults.py wild_22_unused_outlier
"""

import json
import math
import os
import shutil
import struct

from bspline import BoxVolume
from exact_determinant import ExactVolume, preset
from gltf_reader import Gltf
from harness import INVALID, NO, UNSUPPORTED, case, check, equal, float32, main, near, npy, obj_of, obj_vertices
from messages import anything, counts, entry, no_line, one_line

HERE = os.path.dirname(os.path.abspath(__file__))
EPS = 2.0 ** -52
# Half an ulp of a float32 that is at most 1, and the few roundings of a double before it.
HALF_FLOAT = 2.0 ** -25 * 1.001


def use(run, name):
    shutil.copytree(os.path.join(HERE, name), run.folder, dirs_exist_ok=True)


def positions(run, name, mesh=0):
    gltf = Gltf(run.path(name))
    return [list(p) for p in gltf.decoded(gltf.asset["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"])]


def target(run, name, mesh=0):
    gltf = Gltf(run.path(name))
    return [list(p) for p in gltf.decoded(gltf.asset["meshes"][mesh]["primitives"][0]["targets"][0]["POSITION"])]


def info(run, name):
    return run.ffd("info", name, "--json", err=anything).json


QUAD = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
QUAD_MOVED = [[x + 1, y, z] for x, y, z in QUAD]


# Embedding

@case
def maths_01_steep_weights(run):
    """Every vertex is inside, at the u,v,w that 50 digits give, and moves by exactly the offset of all points."""
    use(run, "maths-01-steep-weights")
    job = entry(run, "deform", "m.obj", "out.obj", "-l", "weights.json")
    counts(job, vertices=4, inside=4, outside=0, multiple=0, singular=0, invalid=0, moved=4)
    equal(obj_vertices(run.text("out.obj")), [[0.14, 0.25, 1.76], [0.09, 0.2, 1.8], [0.04, 0.12, 1.74], [0.14, 0.25, 1.75]])
    run.ffd("embed", "m.obj", "-l", "weights.json", "-o", "u.npy", "--status", "s.npy", err=anything)
    equal(npy(run.read("s.npy"))[2], [0, 0, 0, 0])
    near(npy(run.read("u.npy"))[2][:3], [[0.25767391987355846, 0.40046197004981401, 0.66502870191204811],
                                         [0.2536352307046217, 0.40641089789680549, 0.66559816398509564],
                                         [0.25168767979241076, 0.39788172748051722, 0.66537337467014557]], 1e-9)


def trilinear(points, uvw):
    weights = [(u * v * w) for w in (1 - uvw[2], uvw[2]) for v in (1 - uvw[1], uvw[1]) for u in (1 - uvw[0], uvw[0])]
    return [math.fsum(h * p[a] for h, p in zip(weights, points)) for a in range(3)]


@case
def maths_02_thin_turned(run):
    """Images of u,v,w in [0.2, 0.8]: none is outside."""
    use(run, "maths-02-thin-turned")
    run.ffd("embed", "m.ply", "-l", "l.json", "-o", "u.npy", "--status", "s.npy", err=anything)
    statuses = npy(run.read("s.npy"))[2]
    equal({status: statuses.count(status) for status in set(statuses)}, {0: 100}, "how many of each status")
    corners = json.loads(run.text("l.json"))["rest"]["points"]
    vertices = list(struct.iter_unpack("<3d", run.read("m.ply").partition(b"end_header\n")[2]))
    largest = [max(abs(p[a]) for p in corners) for a in range(3)]
    for i, (uvw, p) in enumerate(zip(npy(run.read("u.npy"))[2], vertices)):
        check(all(0 <= x <= 1 for x in uvw), i, uvw)
        for a, x in enumerate(trilinear(corners, uvw)):
            check(abs(x - p[a]) <= 20 * EPS * (largest[a] + abs(p[a])), f"vertex {i}: the residual is {x - p[a]}")


@case
def maths_03_principal_axes(run):
    """The lattice that is made round a mesh holds every vertex of it, far from the origin too."""
    use(run, "maths-03-principal-axes")
    run.ffd("lattice", "new", "m.obj", "-o", "l.json", "--axes", "principal", "--margin", "0")
    run.ffd("embed", "m.obj", "-l", "l.json", "-o", "u.npy", "--status", "s.npy")
    equal(npy(run.read("s.npy"))[2], [0, 0, 0, 0])

@case
def maths3_01_steep_weights_residual(run):
    """An iteration goes on until the promised bound holds: weights of 1e6 leave z right to what u,v,w can hold."""
    use(run, "maths3-01-steep-weights-residual")
    job = entry(run, "deform", "m.obj", "out.obj", "-l", "l.json")
    counts(job, vertices=3, inside=3)
    check(job["residual"]["max"] <= 4e-11, "the residual", job["residual"])
    near([p[2] for p in obj_vertices(run.text("out.obj"))],
         [0.165714284214286464, 0.960624999945092628, 0.990115997981637305], 3e-13)


@case
def maths3_02_steep_weights_thin_positions(run):
    """A sheet of 1e-9: its w is known to 8e-6, and no worse with a weight of 1000."""
    use(run, "maths3-02-steep-weights-thin-positions")
    job = entry(run, "deform", "m.obj", "out.obj", "-l", "l.json")
    counts(job, vertices=3, inside=3, multiple=0, singular=0)
    near([p[2] for p in obj_vertices(run.text("out.obj"))], [0.6579805893726, 0.6469908132558, 0.6501431644502], 8e-6)


@case
def maths3_04_turned_box_tolerance(run):
    """Each vertex differs from some point of the border by at most 0.918 of the tolerance in every coordinate."""
    use(run, "maths3-04-turned-box-tolerance")
    job = entry(run, "check", "m.obj", "-l", "l.json")
    counts(job, vertices=6, inside=6, outside=0)
    equal(job["tear"]["edges"], 0)


@case
def maths3_05_cylinder_seam_open_knots(run):
    """No vertex on the seam of a full turn is multiple, whatever the knots along v, also where it collapses to an axis."""
    use(run, "maths3-05-cylinder-seam-open-knots")
    file = json.loads(run.text("l.json"))
    counts(entry(run, "check", "m.obj", "-l", "l.json"), vertices=5, inside=5, multiple=0)
    seam = [[r, 0, z / 4] for r in (0.55, 0.7, 0.9) for z in (-3, 0, 4)]
    run.write("seam.obj", obj_of(seam))
    for kind in ("open", "uniform", [0, 0.1, 0.3, 0.4, 0.6, 0.7, 0.8, 1, 1.3], "clamped"):
        for inner in (0, 0.5):
            file["knots"][1] = kind
            file["rest"]["cylinder"]["radius"][0] = inner
            run.write("s.json", file)
            counts(entry(run, "check", "seam.obj", "-l", "s.json"), vertices=9, inside=9, multiple=0)


def rays(*ends):
    """A lattice of degree 1 through rays from one point of the plane z = 0 to another, of height 1."""
    points = [[*p, z] for z in (0, 1) for ray in ends for p in ray]
    return {"format": "ffd-lattice", "version": 1, "size": [2, len(ends), 2], "degree": [1, 1, 1], "rest": {"points": points}}


@case
def faces_that_overlap_in_a_plane_are_a_seam_where_the_volume_goes_on(run):
    """Sibling of maths3-05: a full turn whose first and last ray have other radii. One that comes back overlaps itself."""
    turned = [[[0, 1], [0, 2]], [[-1, 0], [-2, 0]], [[0, -1], [0, -2]]]
    run.write("turn.json", rays([[1, 0], [2, 0]], *turned, [[1.25, 0], [2.25, 0]]))
    run.write("m.obj", obj_of([[x, 0, z] for x in (1.25, 1.5, 2) for z in (0, 0.5, 1)]))
    counts(entry(run, "check", "m.obj", "-l", "turn.json"), vertices=9, inside=9, multiple=0)
    run.ffd("embed", "m.obj", "-l", "turn.json", "-o", "u.npy")
    # The least u,v,w: u is less on the last ray.
    near(npy(run.read("u.npy"))[2], [[x - 1.25, 1, z] for x in (1.25, 1.5, 2) for z in (0, 0.5, 1)], 1e-15)
    run.write("back.json", rays([[1, 0], [2, 0]], [[1, 1], [2, 1]], [[1.25, 0], [2.25, 0]]))
    counts(entry(run, "check", "m.obj", "-l", "back.json"), vertices=9, multiple=9)


@case
def weights_times_a_factor_move_nothing(run):
    """Sibling of maths3-09: deformed weights count by their ratios to those at rest."""
    use(run, "maths3-09-unmoved-lattice-folds")
    file = json.loads(run.text("l2.json"))
    for rest, factor in (([1] * 64, 7), ([1 + i % 7 for i in range(64)], 0.3), (file["weights"], 3)):
        run.write("f.json", {**file, "weights": rest, "deformed": {"weights": [factor * h for h in rest]}})
        one_line(run.ffd("deform", "m.obj", "out.obj", "-l", "f.json", "--fail-on", "folds", "--force", err=anything),
             f"the deformed weights of f.json are those at rest times {factor}: a common factor moves nothing")
        equal(run.read("out.obj"), run.read("m.obj"))


@case
def maths3_10_box_weights_open_knots(run):
    """With weights, and knots that are not clamped, the volume is not the whole box: by how much is said."""
    use(run, "maths3-10-box-weights-open-knots")
    # The border's control points along u: (h-1 - 1 h+1 ...) with weights 1, 2, 3 in turn, h N = 1/6, 4/6, 1/6.
    file = json.loads(run.text("l.json"))
    off = 0
    for first in range(0, 64, 4):
        h = file["weights"][first:first + 4]
        for row, end in (((h[0], 4 * h[1], h[2]), 0), ((h[1], 4 * h[2], h[3]), 1)):
            off = max(off, abs(row[2] - row[0]) / sum(row))
    for a in (4, 16):
        for first in (i for i in range(64) if i // a % 4 == 0):
            h = file["weights"][first:first + 4 * a:a]
            off = max(off, abs(h[2] - h[0]) / (h[0] + 4 * h[1] + h[2]), abs(h[3] - h[1]) / (h[1] + 4 * h[2] + h[3]))
    for arguments in (("check", "m.obj", "-l", "l.json"), ("embed", "m.obj", "-l", "l.json", "-o", "u.npy"),
                      ("jacobian", "m.obj", "-l", "l.json", "-o", "j.npz")):
        done = run.ffd(*arguments, err=anything)
        one_line(done, "l.json", "not its whole box", "u, v, w", "not clamped", f"{off:.3g} off")
    near([info(run, "l.json")["border_off"]], [off], 1e-15)
    # Where the weights do not vary along the open direction, and where all knots are clamped, nothing is missing.
    for knots, weights in (("open", [1 + i // 4 for i in range(64)]), ("clamped", file["weights"])):
        along = ["open", "clamped", "clamped"] if knots == "open" else ["clamped"] * 3
        run.write("s.json", {**file, "knots": along, "weights": weights})
        done = run.ffd("check", "m.obj", "-l", "s.json", "--report", "r.json", "--force", err=anything)
        no_line(done, "whole box")
        counts(json.loads(run.read("r.json"))["jobs"][0], inside=6, outside=0)
        check("border_off" not in info(run, "s.json"), knots)


@case
def cylinders_that_weights_change_are_named(run):
    """Siblings of maths3-10: a cylinder's ends, and its radii where the weights are no product f(u,w) g(v)."""
    run.write("m.obj", obj_of([[0.75, 0.1, 0], [0.6, 0.2, 0.3], [0.7, 0, 0.9]]))
    cylinder = {"format": "ffd-lattice", "version": 1, "size": [3, 6, 4], "degree": [2, 2, 2],
                "rest": {"cylinder": {"center": [0, 0, 0], "axis": "z", "radius": [0.5, 1], "height": 2}}}
    count = 3 * 6 * 4
    product = [(1 + i % 3 + 2 * (i // 18)) * (1 + i // 3 % 6) for i in range(count)]
    mixed = [1 + i * i % 7 for i in range(count)]

    def warned(weights, *knots):
        run.write("l.json", {**cylinder, "knots": list(knots), "weights": weights})
        done = run.ffd("check", "m.obj", "-l", "l.json", err=anything)
        off = info(run, "l.json").get("border_off", 0)
        if off:
            one_line(done, "l.json", "not its whole cylinder", f"{off:.3g} off")
        else:
            no_line(done, "whole cylinder")
        return off

    equal(warned(product, "clamped", "closed", "clamped"), 0)
    equal(warned(product, "clamped", "clamped", "clamped"), 0)
    check(warned(product, "open", "closed", "clamped") > 0.01)
    check(warned(product, "clamped", "closed", "open") > 0.01)
    check(warned(mixed, "clamped", "closed", "clamped") > 0.01)
    equal(warned([2] * count, "open", "open", "open"), 0)


@case
def a_box_round_a_mesh_that_weights_change_is_named(run):
    run.write("m.obj", obj_of([[0, 0, 0], [1, 2, 3], [0.5, 1, 2]]))
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "degree": [2, 2, 2],
                         "knots": ["open", "clamped", "clamped"], "rest": {"box": "mesh", "margin": 0.5},
                         "weights": [1 + i % 3 for i in range(27)]})
    # Along u the ends are (P0 + 2 P1)/3 and (2 P1 + 3 P2)/5 of the points at -1.5, 0.5, 2.5 and the sides -0.5, 1.5.
    one_line(run.ffd("check", "m.obj", "-l", "l.json", err=anything), "l.json", "not its whole box", "along u that", "0.333 off")


# Torn edges

@case
def maths3_11_blocks_jump_unseen(run):
    """The blocks move their common face apart, between the vertices: two edges jump by 0.6 there, as without --blocks."""
    use(run, "maths3-11-blocks-jump-unseen")
    both = ("-l", "a.json", "-l", "b.json")
    for options in (both, both + ("--blocks",)):
        tear = entry(run, "check", "m.obj", *options)["tear"]
        equal([tear["edges"], tear["largest"]], [2, 0.6], options)
        run.ffd("deform", "m.obj", "out.obj", *options, "--fail-on", "tear", code=NO, err=anything)
        check(not run.exists("out.obj"), "nothing is written")
    one_line(run.ffd("deform", "m.obj", "out.obj", *both, "--blocks", err=anything), "blocks", "differently", r"\b0\.6\b")


@case
def maths3_12_extend_jumps_between_arms(run):
    """Between the arms of a horseshoe, of which one moves by 1, the nearest border changes: two edges jump by 1."""
    use(run, "maths3-12-extend-jumps-between-arms")
    options = ("-l", "l.json", "--outside", "extend")
    tear = entry(run, "check", "m.obj", *options)["tear"]
    equal(tear["edges"], 2)
    near([tear["largest"]], [1], 1e-9)
    run.ffd("deform", "m.obj", "out.obj", *options, "--fail-on", "tear,folds", code=NO, err=anything)
    check(not run.exists("out.obj"), "nothing is written")
    one_line(run.ffd("deform", "m.obj", "out.obj", *options, err=anything), "border", r"\bstep to a neighbour is 1\b")


# The fold proof

@case
def maths3_07_min_det_no_bound(run):
    """min_det is no more than the determinant at a place, by the mean at rest in 40 digits; at the witness it is not positive."""
    use(run, "maths3-07-min-det-no-bound")
    folds = entry(run, "check", "m.obj", "-l", "l.json")["folds"]
    file = json.loads(run.text("l.json"))
    knots = [preset(kind, n, d) for kind, n, d in zip(file["knots"], file["size"], file["degree"])]
    volume = ExactVolume(file["size"], file["degree"], knots, file["deformed"]["points"], file["weights"])
    mean = 165.4623
    det = float(volume.determinant([0, 1741.1972197840012, -4.979537120675159])) / mean
    near([det], [-2.6431584], 1e-6)
    equal([folds["verdict"], folds["relative_to"]], ["some", "mean"])
    check(1.02 * det < folds["min_det"] < det + 1e-6, folds, det)
    there = float(volume.determinant(folds["witness"]["uvw"]))
    check(there <= 0, folds)
    near([folds["witness"]["det"]], [there / mean], 1e-6 * abs(there / mean))


@case
def maths3_09_unmoved_lattice_folds(run):
    """What moves nothing is free of folds, whatever the weights are."""
    use(run, "maths3-09-unmoved-lattice-folds")
    for name in ("l.json", "l2.json"):
        folds = entry(run, "check", "m.obj", "-l", name, "--fail-on", "folds")["folds"]
        equal([folds["verdict"], folds["min_det"], folds["relative_to"], folds["witness"]], ["none", 1, "place", None], name)


# 4x4 matrices, as rows.

def product(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def local_matrix(node):
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    sx, sy, sz = node.get("scale", [1, 1, 1])
    tx, ty, tz = node.get("translation", [0, 0, 0])
    return [[sx * (1 - 2 * (y * y + z * z)), sy * 2 * (x * y - z * w), sz * 2 * (x * z + y * w), tx],
            [sx * 2 * (x * y + z * w), sy * (1 - 2 * (x * x + z * z)), sz * 2 * (y * z - x * w), ty],
            [sx * 2 * (x * z - y * w), sy * 2 * (y * z + x * w), sz * (1 - 2 * (x * x + y * y)), tz], [0, 0, 0, 1]]


def solve(m, d):
    """x with M x = d, of the linear part, by Cramer's rule."""
    def det(c):
        return (c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) - c[0][1] * (c[1][0] * c[2][2] - c[1][2] * c[2][0])
                + c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]))

    a = [row[:3] for row in m[:3]]
    return [det([[d[r] if c == k else a[r][c] for c in range(3)] for r in range(3)]) / det(a) for k in range(3)]


@case
def maths_04_skin_weights_not_one(run):
    """Vertices stand where the weights, divided by their sum, place them; a warning says of how many."""
    use(run, "maths-04-skin-weights-not-one")
    done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", err=anything)
    one_line(done, r"\b30\b", "weights", r"\bsum\b")
    file = json.loads(run.text("l.json"))
    box = file["rest"]["box"]
    volume = BoxVolume(box["min"], box["max"], lambda p: p, (5, 5, 5))
    volume.offsets = [[y - x for x, y in zip(p, q)] for p, q in zip(volume.points, file["deformed"]["points"])]
    gltf = Gltf(run.path("a.glb"))
    asset = gltf.asset
    skin = asset["skins"][0]
    parent = {child: i for i, node in enumerate(asset["nodes"]) for child in node.get("children", [])}

    def world(n):
        m = local_matrix(asset["nodes"][n])
        return product(world(parent[n]), m) if n in parent else m

    view = asset["bufferViews"][asset["accessors"][skin["inverseBindMatrices"]]["bufferView"]]
    start = view.get("byteOffset", 0)
    binds = [struct.unpack_from("<16f", gltf.buffers[0], start + 64 * i) for i in range(len(skin["joints"]))]
    joints = [product(world(n), [[bind[4 * c + r] for c in range(4)] for r in range(4)])
              for n, bind in zip(skin["joints"], binds)]
    attributes = asset["meshes"][0]["primitives"][0]["attributes"]
    offsets = gltf.decoded(asset["meshes"][0]["primitives"][0]["targets"][0]["POSITION"])
    base, shown = [], []
    for p, m, j, w in zip(gltf.decoded(attributes["POSITION"]), offsets, gltf.stored(attributes["JOINTS_0"]),
                          gltf.decoded(attributes["WEIGHTS_0"])):
        total = math.fsum(w)
        matrix = [[sum(w[k] / total * joints[j[k]][r][c] for k in range(4)) for c in range(4)] for r in range(4)]

        def moved(q, matrix=matrix):
            x = [sum(matrix[r][c] * q[c] for c in range(3)) + matrix[r][3] for r in range(3)]
            return [a + b for a, b in zip(q, solve(matrix, volume.displacement(x)))]

        base.append(moved(p))
        shown.append(moved([a + b for a, b in zip(p, m)]))
    found = positions(run, "b.glb")
    near(found, base, 2e-6, "positions")
    near([[a + b for a, b in zip(p, m)] for p, m in zip(found, target(run, "b.glb"))], shown, 3e-6, "the morph target")


# The border of a lattice

CUBE_STEPS = [[x, y, z] for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.05, 0.1)]


def lifted(p):
    """The top layer of the box [0, 0.1] goes up by 0.05: cubic, so by 0.05 w^3."""
    return [*p[:2], p[2] + 0.05 * min(p[2] / 0.1, 1) ** 3]


@case
def wild_01_border_float32(run):
    """A cube of 0.1 stored as float32 is inside the box [0, 0.1]."""
    use(run, "wild-01-border-float32")
    job = entry(run, "deform", "cube.gltf", "out.gltf", "-l", "box.json", err=[])
    counts(job, vertices=12, inside=12, outside=0, singular=0, moved=8)
    near(positions(run, "out.gltf"), [lifted([float32(x) for x in p]) for p in CUBE_STEPS], HALF_FLOAT / 4)


@case
def wild_01b_border_float_ply(run):
    """The same as text of an ascii PLY's float."""
    use(run, "wild-01b-border-float-ply")
    job = entry(run, "deform", "cube.ply", "out.ply", "-l", "box.json", err=[])
    counts(job, vertices=12, inside=12, outside=0, singular=0, moved=8)
    rows = [[float(x) for x in line.split()] for line in run.text("out.ply").partition("end_header\n")[2].splitlines()]
    near(rows, [lifted([float32(x) for x in p]) for p in CUBE_STEPS], HALF_FLOAT / 2)


@case
def wild_02_junk_obj(run):
    """A pointer of Git LFS is no mesh: exit 4, and what it seems to be is said."""
    use(run, "wild-02-junk-obj")
    run.ffd("deform", "model.obj", "out.obj", "-l", "box.json", "--fail-on", "outside", code=INVALID,
            err="model.obj:1: is not an OBJ file: it has no statement of one; it seems to be a Git LFS pointer: the file itself is not there")
    check(not run.exists("out.obj"), "an output of junk")


@case
def wild_02b_junk_html_to_glb(run):
    """So is a page that says that the model was not found."""
    use(run, "wild-02b-junk-html-to-glb")
    run.ffd("deform", "model.obj", "out.glb", "-l", "box.json", code=INVALID,
            err="model.obj:1: is not an OBJ file: it has no statement of one; it seems to be an HTML page")
    check(not run.exists("out.glb"), "an output of junk")


@case
def wild_03_nan_check_deform(run):
    """A point without a measurement: kept and counted as invalid, with a warning, by check and deform alike."""
    use(run, "wild-03-nan-check-deform")
    for command in (["check", "scan.ply"], ["deform", "scan.ply", "out.ply"]):
        done = run.ffd(*command, "-l", "box.json", "--report", "r.json", err=anything)
        one_line(done, r"\b1\b", "invalid")
        counts(entry(run, *command, "-l", "box.json"), status="ok", exit=0, vertices=3, inside=2, outside=0, invalid=1, moved=2)
    equal(run.text("out.ply").partition("end_header\n")[2], "1 0 0\nnan nan nan\n2 1 1\n")
    run.ffd("embed", "scan.ply", "-l", "box.json", "-o", "u.npy", "--status", "s.npy", err=anything)
    equal(npy(run.read("s.npy"))[2], [0, 4, 0])
    run.remove("out.ply")
    for command in (["check", "scan.ply"], ["deform", "scan.ply", "out.ply"]):
        run.ffd(*command, "-l", "box.json", "--fail-on", "invalid", code=NO, err=anything)
    check(not run.exists("out.ply"), "a violated gate writes nothing")


# What stays behind

@case
def wild_04_splat_ply(run):
    """The volume turns by 90 degrees: the splats turn with it, and nothing has to be said of them."""
    use(run, "wild-04-splat-ply")
    done = run.ffd("deform", "splat.ply", "out.ply", "-l", "turn.json", err=anything)
    no_line(done, "splat")
    check(run.read("splat.ply") != run.read("out.ply"), "they turn")
    rows = [[float(x) for x in line.split()] for line in run.text("out.ply").partition("end_header\n")[2].splitlines()]
    near([row[:3] for row in rows], [[0, 1, 0], [0, 2, 0]], 1e-6)
    equal([row[6:13] for row in rows], [[.1, .1, .1, 1, -1, -4, -4]] * 2, "colour, opacity and scales")
    near([row[13:] for row in rows], [[.5 ** .5, 0, 0, .5 ** .5]] * 2, 1e-6, "rotations")


@case
def wild_05_msft_lod(run):
    """The coarse stand-in is deformed as it will be shown: in the place of the node it stands for."""
    use(run, "wild-05-msft-lod")
    done = run.ffd("deform", "lod.gltf", "out.gltf", "-l", "move.json", err=anything)
    no_line(done, "left as it is|not in the scene")
    equal(positions(run, "out.gltf", 0), QUAD_MOVED)
    equal(positions(run, "out.gltf", 1), QUAD_MOVED)


@case
def wild_06_mesh_manifold_copy(run):
    """The extension demands the accessor of the primitives, in the mesh and in its copy."""
    use(run, "wild-06-mesh-manifold-copy")
    run.ffd("deform", "solid.gltf", "out.gltf", "-l", "twist.json", err=anything)
    meshes = Gltf(run.path("out.gltf")).asset["meshes"]
    equal([[p["attributes"]["POSITION"] for p in mesh["primitives"]] for mesh in meshes], [[0, 0], [6, 6]])
    equal([mesh["extensions"]["EXT_mesh_manifold"] for mesh in meshes],
          [{"manifoldPrimitive": {"mode": 4, "indices": 3, "attributes": {"POSITION": position}}, "mergeIndices": 4,
            "mergeValues": 5} for position in (0, 6)])


@case
def wild_07_mirrored_instance(run):
    """A half model and its mirror image keep their shared mesh; what lies on the plane stays on it."""
    use(run, "wild-07-mirrored-instance")
    run.ffd("deform", "half.gltf", "out.gltf", "-l", "taper.json", err=[])
    before, after = Gltf(run.path("half.gltf")).asset, Gltf(run.path("out.gltf")).asset
    equal([len(after["meshes"]), after["nodes"]], [1, before["nodes"]])
    found = positions(run, "out.gltf")
    # x and z shrink by 1 - f/2, with f = (y + 1.1)/2.2: linear in y and in x or z, which B-splines reproduce.
    factors = [1 - (p[1] + 1.1) / 4.4 for p in positions(run, "half.gltf")]
    near(found, [[p[0] * f, p[1], p[2] * f] for p, f in zip(positions(run, "half.gltf"), factors)], 1e-7)
    near([p[0] for p in found[:2]], [0, 0], 1e-7)


@case
def wild_07d_pure_translation(run):
    """Every control point moves by (100, 0, 0): every vertex by exactly that."""
    use(run, "wild-07d-pure-translation")
    run.ffd("deform", "m.obj", "out.obj", "-l", "move.json")
    equal(run.text("out.obj"), "v 100 0 0\nv 100 0 1\nv 100 1 1\nf 1 2 3\n")


@case
def wild_08_morph_default_weights(run):
    """The box goes round base and target, and what is shown, base + 1 x target at z = 5, moves."""
    use(run, "wild-08-morph-default-weights")
    run.ffd("deform", "m.gltf", "out.gltf", "-l", "box.json", err=[])

    def up(z):
        return ((z + 0.25) / 5.5) ** 3  # the box from 0 to 5 with a margin of 0.05; its top layer goes up by 1

    base, offsets = positions(run, "out.gltf"), target(run, "out.gltf")
    near(base, [[x, y, up(0)] for x, y, _ in QUAD], 1e-9)
    near(offsets, [[0, 0, 5 + up(5) - up(0)]] * 4, 5e-7)
    near([[a + b for a, b in zip(p, m)] for p, m in zip(base, offsets)], [[x, y, 5 + up(5)] for x, y, _ in QUAD], 5e-7)
    equal(info(run, "m.gltf")["bounds"], {"min": [0, 0, 5], "max": [1, 1, 5]})


@case
def wild_10_required_visibility(run):
    """KHR_node_visibility may be required; an extension that nobody knows may, if the user says so."""
    use(run, "wild-10-required-visibility")
    run.ffd("deform", "m.gltf", "out.gltf", "-l", "move.json", err=[])
    equal(positions(run, "out.gltf"), QUAD_MOVED)
    run.write("m.gltf", run.text("m.gltf").replace("KHR_node_visibility", "ACME_x"))
    done = run.ffd("deform", "m.gltf", "none.gltf", "-l", "move.json", code=UNSUPPORTED)
    one_line(done, '"ACME_x"', "--allow-extension ACME_x")
    run.ffd("deform", "m.gltf", "out.gltf", "-l", "move.json", "--force", "--allow-extension", "ACME_x", err=[])
    equal(positions(run, "out.gltf"), QUAD_MOVED)


@case
def wild_11_vrm_ending(run):
    """A .vrm is a GLB: what comes out is what a .glb of the same bytes becomes."""
    use(run, "wild-11-vrm-ending")
    run.ffd("deform", "avatar.vrm", "out.vrm", "-l", "move.json", err=[])
    shutil.copy(run.path("avatar.vrm"), run.path("avatar.glb"))
    run.ffd("deform", "avatar.glb", "out.glb", "-l", "move.json", err=[])
    equal(run.read("out.vrm"), run.read("out.glb"))
    near(positions(run, "out.vrm"), [[x + 1, y, z] for x, y, z in positions(run, "avatar.vrm")], 1e-6)


@case
def wild_12_parts_one_box(run):
    """Two parts that meet at x = 1: with --shared-box they still do; without it a line warns, once."""
    use(run, "wild-12-parts-one-box")
    low, high = [-0.15, -0.05, -0.05], [3.15, 1.05, 1.05]
    radius = 3.3 / math.radians(60)

    def bend(p):
        angle, t = (p[0] - low[0]) / radius, p[2] - 0.5
        return [low[0] + (radius - t) * math.sin(angle) - p[0], 0, 0.5 + radius - (radius - t) * math.cos(angle) - p[2]]

    volume = BoxVolume(low, high, bend)
    run.folder_of("o")
    run.ffd("deform", "body.obj", "door.obj", "--out-dir", "o", "-l", "bend.json", "--shared-box", err=[])
    found = {name: obj_vertices(run.text("o/" + name)) for name in ("body.obj", "door.obj")}
    for name, vertices in found.items():
        near(vertices, [volume.deform(p) for p in obj_vertices(run.text(name))], 1e-13, name)
    equal([found["body.obj"][i] for i in (1, 2)], [found["door.obj"][i] for i in (0, 3)], "the common border, to the bit")
    done = run.ffd("deform", "body.obj", "door.obj", "--out-dir", "o", "-l", "bend.json", "--force", lines=1)
    one_line(done, "box", "--shared-box")
    run.ffd("lattice", "new", "body.obj", "door.obj", "-o", "both.json")
    box = json.loads(run.text("both.json"))["rest"]["box"]
    near([box["min"], box["max"]], [low, high], 1e-14)


@case
def wild_13_sockets_stay(run):
    """What stays behind is said, a line a kind: the socket on the body's corner, and the camera."""
    use(run, "wild-13-sockets-stay")
    done = run.ffd("deform", "rig.gltf", "out.gltf", "-l", "move.json", lines=2)
    one_line(done, r"\b1 socket", "socket_hand")
    one_line(done, r"\b1 camera", r"\bcam\b")
    equal(positions(run, "out.gltf"), QUAD_MOVED)
    equal(Gltf(run.path("out.gltf")).asset["nodes"], Gltf(run.path("rig.gltf")).asset["nodes"])


@case
def wild_13c_wheel_pivot(run):
    """The vertices of an animated wheel move and its pivot stays: a line names the node."""
    use(run, "wild-13c-wheel-pivot")
    done = run.ffd("deform", "car.gltf", "out.gltf", "-l", "move.json", lines=1)
    one_line(done, r"\b1\b", "pivot", r"\bwheel\b")
    near(positions(run, "out.gltf"), [[x + 1, y, z] for x, y, z in positions(run, "car.gltf")], 1e-7)


# The vertices of wild-14*: each moves by 1 along x, and every other byte stays.
def stl_is_moved(run, name, said, line):
    use(run, name)
    place = f"line {line}: " if line else ""
    run.ffd("deform", "part.stl", "out.stl", "-l", "move.json", err=[f"part.stl: {place}{said}"])
    equal(run.read("out.stl"), run.read("part.stl").replace(b"vertex 1", b"vertex 2").replace(b"vertex 0", b"vertex 1"))
    run.ffd("deform", "part.stl", "none.stl", "-l", "move.json", "--strict", code=INVALID,
            err=f"part.stl:{line}: {said}" if line else f"part.stl: {said}")


@case
def wild_14_stl_end_solid(run):
    stl_is_moved(run, "wild-14-stl-end-solid", '"endsolid" is written as two words', 9)


@case
def wild_14b_stl_color(run):
    stl_is_moved(run, "wild-14b-stl-color", 'a line "color", which STL does not have, is kept as it is', 2)


@case
def wild_14e_stl_ctrl_z(run):
    stl_is_moved(run, "wild-14e-stl-ctrl-z", "a Ctrl-Z, the end mark of old texts, ends the file", 0)


@case
def wild_15_data_uri_case(run):
    """";BASE64," is the same marker: the vertices are those of the quad, a line says it, and --strict refuses the file."""
    use(run, "wild-15-data-uri-case")
    done = run.ffd("deform", "m.gltf", "out.gltf", "-l", "box.json", err=anything)
    equal(done.err, ['m.gltf: /buffers/0/uri: the head of the data URI does not end with ";base64" in small letters'])
    equal(positions(run, "out.gltf"), QUAD_MOVED)
    check(";BASE64," in run.text("out.gltf"), "the head of the URI keeps its text")
    run.ffd("deform", "m.gltf", "none.gltf", "-l", "box.json", "--strict", code=INVALID)


@case
def wild_16_csv_semicolon(run):
    """A table as spreadsheets save it in most of Europe is read, which is said; --strict refuses it."""
    use(run, "wild-16-csv-semicolon")
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    run.folder_of("o")
    arguments = ["batch", "--csv", "sweep.csv", "--in", "m.obj", "-l", "sweep.json", "--out-dir", "o"]
    said = "the columns are separated by semicolons: numbers may have a decimal comma"
    run.ffd(*arguments, "--strict", code=4, err=f"sweep.csv:1: {said}")
    done = run.ffd(*arguments, err=anything)
    equal(done.err[0], f"sweep.csv: line 1: {said}")
    run.ffd("deform", "m.obj", "single.obj", "-l", "sweep.json", "--set", "DEGREES=30")
    equal((run.names("o"), run.read("o/a.obj")), (["a.obj"], run.read("single.obj")))


def swept(run, name):
    """The table of a folder is read as one with commas is; what is said of it."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    run.folder_of("o")
    arguments = ["batch", "--csv", name, "--in", "m.obj", "-l", "sweep.json", "--out-dir", "o"]
    done = run.ffd(*arguments, err=anything)
    run.ffd("deform", "m.obj", "single.obj", "-l", "sweep.json", "--set", "DEGREES=30", "--force")
    equal((run.names("o"), run.read("o/a.obj")), (["a.obj"], run.read("single.obj")))
    said = done.err[0]
    run.ffd(*arguments, "--strict", "--force", code=(1, INVALID), err=anything)
    os.unlink(run.path("o/a.obj"))
    os.rmdir(run.path("o"))
    return said


@case
def wild3_22_shared_buffer_in_place(run):
    """Two models that share a buffer are each moved once, in whatever order; one alone leaves its neighbour as it was."""
    names = ["chair.gltf", "chair_blue.gltf"]
    at_rest, moved = [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[1, 0, 0], [2, 0, 0], [2, 1, 0]]
    told = "chair.gltf: chair.bin is a file of chair_blue.gltf too, and stays: chair-1.bin is written in place of it"

    def begin():
        for name in run.names():
            run.remove(name)
        use(run, "wild3-22-shared-buffer-in-place")

    def shown():
        return [positions(run, name) for name in names]

    begin()
    blue = "chair_blue.gltf: chair.bin was a file of chair.gltf too, and stays: chair_blue.bin is written in place of it"
    run.ffd("deform", *names, "--in-place", "-l", "move.json", err=[told, blue])
    equal(shown(), [moved, moved])
    begin()
    run.ffd("deform", *names[::-1], "--in-place", "-l", "move.json", err=[blue, told])
    equal(shown(), [moved, moved])
    begin()
    run.ffd("deform", "chair.gltf", "--in-place", "-l", "move.json", err=told)
    equal(shown(), [moved, at_rest])
    run.ffd("deform", "chair.gltf", "--in-place", "-l", "move.json")
    equal((shown(), run.names()), ([[[2, 0, 0], [3, 0, 0], [3, 1, 0]], at_rest],
                                   ["chair-1.bin", "chair.bin", "chair.gltf", "chair_blue.gltf", "move.json"]))
    # Another model is written over the first.
    begin()
    os.mkdir(run.path("new"))
    for name in ("chair_blue.gltf", "chair.bin"):
        shutil.move(run.path(name), run.path("new/" + name))
        shutil.copy(run.path("new/" + name), run.path(name))
    run.ffd("deform", "new/chair_blue.gltf", "chair.gltf", "-l", "move.json", "--force",
            err="new/chair_blue.gltf: " + told.partition(": ")[2])
    equal((shown(), positions(run, "new/chair_blue.gltf")), ([moved, at_rest], at_rest))
    # And converted over it: a mesh of another format.
    run.write("cube.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    run.write("z.gltf", run.text("chair_blue.gltf").replace("chair.bin", "cube.bin"))
    shutil.copy(run.path("chair.bin"), run.path("cube.bin"))
    run.ffd("deform", "cube.obj", "cube.gltf", "-l", "move.json", "--force",
            err="cube.obj: cube.bin is a file of z.gltf too, and stays: cube-1.bin is written in place of it")
    equal((positions(run, "cube.gltf"), positions(run, "z.gltf")), (moved, at_rest))


@case
def wild3_09_batch_to_another_format(run):
    """The outputs of a folder that is converted have the ending of their format."""
    use(run, "wild3-09-batch-to-another-format")
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    run.folder_of("out")
    run.ffd("batch", "--in", "parts/*.obj", "-l", "twist.json", "--out-dir", "out", "--output-format", "glb", err=anything)
    equal(run.names("out"), ["a.glb", "b.glb"])
    equal(info(run, "out/a.glb")["mesh_format"], "glTF")


@case
def wild3_16_table_dialects(run):
    """Columns that are separated by tabs, and the column without a name that pandas writes, are read; both are said."""
    use(run, "wild3-16-table-dialects")
    equal(swept(run, "tab.csv"), "tab.csv: line 1: the columns are separated by tabs: numbers may have a decimal comma")
    equal(swept(run, "index.csv"), "index.csv: line 1: column 1 has no name, as the index of pandas (index=False), and is left out")


@case
def wild3_16b_table_blanks(run):
    """Blanks behind the commas are no part of a name or a value."""
    use(run, "wild3-16b-table-blanks")
    equal(swept(run, "t.csv"), 't.csv: line 1: blanks beside "DEGREES" are left out')


@case
def wild_17_obj_backslash_blank(run):
    """A blank behind the backslash at a line's end: the line goes on, which is said, and --strict refuses it."""
    use(run, "wild-17-obj-backslash-blank")
    said = "blanks follow the backslash at the end of the line: it goes on in the next"
    run.ffd("deform", "m.obj", "out.obj", "-l", "move.json", err=[f"m.obj: line 1: {said}"])
    equal(run.text("out.obj"), "v 1 0 \\ \n0\nv 2 0 0\nv 2 1 0\nf 1 2 3\n")
    run.ffd("deform", "m.obj", "none.obj", "-l", "move.json", "--strict", code=INVALID, err=f"m.obj:1: {said}")


@case
def wild_18_skin_zero_weights(run):
    """A vertex without weights follows its first joint, and moves with its neighbours."""
    use(run, "wild-18-skin-zero-weights")
    job = entry(run, "deform", "m.gltf", "out.gltf", "-l", "move.json")
    counts(job, vertices=4, inside=4, moved=4)
    equal(positions(run, "out.gltf"), QUAD_MOVED)


@case
def wild_19_ply_face_normals(run):
    """The face is turned by 90 degrees, and its normal with it, as those of its vertices are."""
    use(run, "wild-19-ply-face-normals")
    run.ffd("deform", "m.ply", "out.ply", "-l", "turn.json", err=[])
    a, b, c, face = [[float(x) for x in line.split()] for line in run.text("out.ply").splitlines()[-4:]]
    near([v[3:] for v in (a, b, c)] + [face[4:]], [[0, -1, 0]] * 4, 1e-15)
    equal(face[:4], [3, 0, 1, 2])


@case
def wild_20_uri_backslash(run):
    """sub\\m.bin is sub/m.bin where no file has that very name; a line says it, and --strict refuses the file."""
    use(run, "wild-20-uri-backslash")
    done = run.ffd("deform", "m.gltf", "out.gltf", "-l", "move.json", err=anything)
    equal(done.err, ['m.gltf: /buffers/0/uri: the URI has backslashes for slashes: "sub/m.bin" is read'])
    equal(positions(run, "out.gltf"), QUAD_MOVED)
    run.ffd("deform", "m.gltf", "none.gltf", "-l", "move.json", "--strict", code=INVALID)


# Boxes

@case
def wild_21_hidden_node(run):
    """A hidden node (KHR_node_visibility) is no part of what is shown: of bounds, boxes, conversions and gates."""
    use(run, "wild-21-hidden-node")
    equal(info(run, "m.gltf")["bounds"], {"min": [0, 0, 0], "max": [1, 1, 0]})
    run.ffd("deform", "m.gltf", "out.obj", "-l", "box.json", err=anything)
    # A flat mesh is in the middle of its box, where the cubic top layer counts 1/8.
    near(obj_vertices(run.text("out.obj")), [[x, y, 0.125] for x, y, _ in QUAD], 1e-12)
    run.ffd("deform", "m.gltf", "out.gltf", "-l", "box.json", "--fail-on", "outside", err=anything)
    near(positions(run, "out.gltf"), [[x, y, 0.125] for x, y, _ in QUAD], 1e-7)


@case
def wild_22_unused_outlier(run):
    """The vertex that no face uses, a thousand away, does not widen the box, and no gate fails for it."""
    use(run, "wild-22-unused-outlier")
    run.ffd("lattice", "new", "m.obj", "-o", "l.json", err=anything)
    box = json.loads(run.text("l.json"))["rest"]["box"]
    near([box["min"], box["max"]], [[999.95, 999.95, -0.05], [1001.05, 1001.05, 1.05]], 1e-12)
    run.ffd("deform", "m.obj", "out.obj", "-l", "box.json", "--fail-on", "outside", err=anything)
    equal(run.text("out.obj").splitlines()[0], "v 0 0 0")
    near(obj_vertices(run.text("out.obj"))[1:],
         [[x, y, z + ((z + 0.05) / 1.1) ** 3] for x, y, z in obj_vertices(run.text("m.obj"))[1:]], 1e-12)


# Several lattices

@case
def wild_24_abutting_lattices(run):
    """Two boxes that touch at x = 1 both lift by 0.5. Side by side the beam rises by 0.5; one after the other the two
    vertices on the common face rise by 1, which is said."""
    use(run, "wild-24-abutting-lattices")
    job = entry(run, "deform", "beam.obj", "out.obj", "-l", "a.json", "-l", "b.json", "--blocks", err=[])
    counts(job, vertices=4, inside=4, outside=0, moved=4)
    equal(job["tear"]["edges"], 0)
    equal(run.text("out.obj"), "v 0.5 0 0.5\nv 1 0 0.5\nv 1.5 0 0.5\nv 1 1 0.5\nf 1 2 4\nf 2 3 4\n")
    done = run.ffd("deform", "beam.obj", "out.obj", "-l", "a.json", "-l", "b.json", "--force", err=anything)
    one_line(done, r"\b2 vertices", "common", "--blocks")
    equal([p[2] for p in obj_vertices(run.text("out.obj"))], [0.5, 1, 0.5, 1])


@case
def wild_25_animation_pointer_copy(run):
    """The weight of the copy is animated as that of the mesh, by a second channel of the same sampler."""
    use(run, "wild-25-animation-pointer-copy")
    run.ffd("deform", "m.gltf", "out.gltf", "-l", "twist.json", err=anything)
    asset = Gltf(run.path("out.gltf")).asset
    equal([node["mesh"] for node in asset["nodes"]], [0, 1])
    equal(asset["animations"], [{
        "channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {
            "KHR_animation_pointer": {"pointer": f"/meshes/{mesh}/weights/0"}}}} for mesh in (0, 1)],
        "samplers": [{"input": 2, "output": 3}]}])


# Conversions

@case
def wild_09_far_obj_to_glb(run):
    """Details of 0.25 m at UTM coordinates: the node has the offset, and the quad its size."""
    use(run, "wild-09-far-obj-to-glb")
    run.ffd("deform", "site.obj", "same.obj", "-l", "box.json")
    done = run.ffd("deform", "site.obj", "out.glb", "-l", "box.json", err=anything)
    no_line(done, "precision")
    equal(Gltf(run.path("out.glb")).asset["nodes"], [{"mesh": 0, "translation": [500000.5, 4649776, 120]}])
    near(positions(run, "out.glb"), [[x - 500000.5, y - 4649776, z - 120] for x, y, z in obj_vertices(run.text("same.obj"))],
         HALF_FLOAT / 2)


def obj_texcoords(run, name):
    """Those of the corners, in the order of the faces' vertices."""
    lines = [line.split() for line in run.text(name).splitlines()]
    values = [[float(x) for x in words[1:]] for words in lines if words[0] == "vt"]
    found = {}
    for words in lines:
        for corner in words[1:] if words[0] == "f" else []:
            v, vt = corner.split("/")[:2]
            found[int(v)] = values[int(vt) - 1]
    return [found[v] for v in sorted(found)]


@case
def wild_26_gltfpack_uv_to_obj(run):
    """Integers that KHR_texture_transform brings to [0, 1]: it is applied, then v turned over."""
    use(run, "wild-26-gltfpack-uv-to-obj")
    run.ffd("deform", "packed.gltf", "out.obj", "-l", "move.json", err=anything)
    near(obj_texcoords(run, "out.obj"), [[0, 1], [1, 1], [1, 1 - 1024 / 4095], [0, 1 - 1024 / 4095]], 1e-15)


@case
def wild_26c_texcoord_1_to_obj(run):
    """The set that the base colour takes; that the other one stays behind is said."""
    use(run, "wild-26c-texcoord-1-to-obj")
    done = run.ffd("deform", "m.gltf", "out.obj", "-l", "move.json", lines=1)
    one_line(done, "further texture coordinates")
    equal(obj_texcoords(run, "out.obj"), [[0, 1], [1, 1], [1, 0], [0, 0]])


@case
def wild_27_ply_texcoord_type(run):
    """MeshLab passes over texture coordinates that are doubles."""
    use(run, "wild-27-ply-texcoord-type")
    run.ffd("deform", "m.obj", "out.ply", "-l", "move.json")
    header, body = run.read("out.ply").split(b"end_header\n")
    check(b"property list uchar float texcoord\n" in header, header)
    size = struct.calcsize("<B3iB6f")
    equal([struct.unpack_from("<6f", body, 4 * 24 + size * i + 14) for i in range(2)],
          [(0, 0, 1, 0, 1, 1), (0.5, 0.5, 1, 1, 0, 1)])


@case
def wild_28_morph_weights_to_obj(run):
    """A conversion writes the shape that the default weights show."""
    use(run, "wild-28-morph-weights-to-obj")
    run.ffd("deform", "m.gltf", "out.obj", "-l", "move.json", err=anything)
    near(obj_vertices(run.text("out.obj")), [[x + 1, y, 5] for x, y, _ in QUAD], 1e-12)


@case
def wild_29_colour_space_obj_to_gltf(run):
    """Colours of an OBJ are those of a display, COLOR_0 of glTF is linear."""
    use(run, "wild-29-colour-space-obj-to-gltf")
    run.ffd("deform", "c.obj", "out.gltf", "-l", "move.json", err=[])
    gltf = Gltf(run.path("out.gltf"))
    colours = gltf.decoded(gltf.asset["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"])
    near([list(c) for c in colours], [[((0.5 + 0.055) / 1.055) ** 2.4, ((0.25 + 0.055) / 1.055) ** 2.4, 1, 1]] * 3, 1e-8)


# Batches

@case
def siege_08_one_output_of_two_jobs(run):
    """The later job fails before it works, in every mode, and names both lines; the first result stays."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    for name, x in (("a", 0), ("b", 10)):
        run.write(f"{name}.obj", "".join(f"v {x + i / 8} {j / 8} 0\n" for j in range(2) for i in range(2)) + "f 1 2 4 3\n")
    run.write("twist.json", {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh", "margin": 0.05},
                             "moves": [{"twist": {"axis": "y", "degrees": 40}}]})
    run.write("dup.jsonl", "".join(json.dumps({"in": f"{name}.obj", "lattice": "twist.json", "out": "same.obj"}) + "\n" for name in "ab"))
    run.ffd("deform", "a.obj", "single.obj", "-l", "twist.json")
    told = 'dup.jsonl:2: "same.obj" is written by the job of line 1 too'
    for mode, summary in ((["--resume"], "1 done, 0 up to date, 1 failed"), (["--resume"], "0 done, 1 up to date, 1 failed"),
                          (["--force"], "1 done, 0 up to date, 1 failed"), (["--resume", "--dry-run"], "0 to do, 1 up to date, 1 failed"),
                          (["--force", "--dry-run"], "1 to do, 0 up to date, 1 failed")):
        done = run.ffd("batch", "dup.jsonl", "-j", "2", *mode, code=NO, err=anything)
        equal(done.err[:-1], [told], mode)
        check(done.err[-1].endswith(summary), mode, done.err)
        equal(run.read("same.obj"), run.read("single.obj"), str(mode))


main()
