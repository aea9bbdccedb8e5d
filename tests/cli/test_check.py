#!/usr/bin/env python3
"""ffd check: what it prints, and its figures (those of the report too) against ones worked out here."""
import json
import math
import struct

from harness import (CUBE, CUBE_CORNERS, CUBE_FACES, EMBEDDING, INVALID, IO, NO, UNSUPPORTED, case, check, equal, glb,
                     gltf_json, lattice, main, near, obj_of)
from messages import anything

SHIFT = [{"by": [1, 0, 0]}]


# B-spline volumes worked out by the definition: Cox's recursion, derivatives by the quotients of its terms.

def clamped(n, degree):
    inner = n - degree
    return [0.0] * degree + [i / inner for i in range(inner + 1)] + [1.0] * degree


def quotient(a, b):
    return a / b if b else 0.0


def basis(knots, i, degree, u):
    if degree == 0:
        last = u == knots[-1] and knots[i] < knots[i + 1] == u
        return 1.0 if knots[i] <= u < knots[i + 1] or last else 0.0
    return (quotient(u - knots[i], knots[i + degree] - knots[i]) * basis(knots, i, degree - 1, u)
            + quotient(knots[i + degree + 1] - u, knots[i + degree + 1] - knots[i + 1]) * basis(knots, i + 1, degree - 1, u))


def slope(knots, i, degree, u):
    return degree * (quotient(basis(knots, i, degree - 1, u), knots[i + degree] - knots[i])
                     - quotient(basis(knots, i + 1, degree - 1, u), knots[i + degree + 1] - knots[i + 1]))


def greville(n, degree):
    knots = clamped(n, degree)
    return [sum(knots[i + 1:i + degree + 1]) / degree for i in range(n)]


class Volume:
    """The box [0,1]^3, affine at rest, so that x,y,z are u,v,w; its control points moved by move(i, j, k)."""

    def __init__(self, size, degree, move):
        self.size, self.degree = size, degree
        self.knots = [clamped(n, p) for n, p in zip(size, degree)]
        self.grid = [greville(n, p) for n, p in zip(size, degree)]
        self.moved = {(i, j, k): move(i, j, k)
                      for i in range(size[0]) for j in range(size[1]) for k in range(size[2])}

    def file(self, side=1.0, at=(0, 0, 0)):
        """The lattice over the box of this side, whose low corner is at `at`."""
        points = [[at[a] + side * (self.grid[a][n[a]] + self.moved[n][a]) for a in range(3)]
                  for n in sorted(self.moved, key=lambda n: n[::-1])]
        return {"format": "ffd-lattice", "version": 1, "size": list(self.size), "degree": list(self.degree),
                "rest": {"box": {"min": list(at), "max": [x + side for x in at]}}, "deformed": {"points": points}}

    def values(self, p, by=None):
        return [[(slope if a == by else basis)(self.knots[a], i, self.degree[a], p[a]) for i in range(self.size[a])]
                for a in range(3)]

    def sum(self, p, by=None):
        u, v, w = self.values(p, by)
        return [sum(u[i] * v[j] * w[k] * d[a] for (i, j, k), d in self.moved.items()) for a in range(3)]

    def deform(self, p):
        return [x + d for x, d in zip(p, self.sum(p))]

    def determinant(self, p):
        f = [[self.sum(p, c)[r] + (r == c) for c in range(3)] for r in range(3)]
        return (f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) - f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0])
                + f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]))

    def deviation(self, a, b, pieces=64):
        """The largest distance of the deformed edge from the straight one between its ends."""
        start, end = self.deform(a), self.deform(b)
        chord = [y - x for x, y in zip(start, end)]
        largest = 0.0
        for n in range(1, pieces):
            t = n / pieces
            q = self.deform([(1 - t) * x + t * y for x, y in zip(a, b)])
            along = sum((y - x) * c for x, y, c in zip(start, q, chord)) / sum(c * c for c in chord)
            along = min(max(along, 0.0), 1.0)
            largest = max(largest, math.dist(q, [x + along * c for x, c in zip(start, chord)]))
        return largest


CORNERS = [[float(x), float(y), float(z)] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
TRIANGLES = [t for a, b, c, d in CUBE_FACES for t in ([a, b, c], [a, c, d])]


def obj(points, faces):
    return obj_of(points) + "".join("f %s\n" % " ".join(map(str, f)) for f in faces)


def edges_of(faces):
    return sorted({tuple(sorted((f[i], f[(i + 1) % len(f)]))) for f in faces for i in range(len(f))})


def checked(run, *arguments, **expected):
    """The report's entry."""
    report = run.ffd("check", *arguments, "--report", "-", **expected).json
    equal([report["format"], report["version"], len(report["jobs"])], ["ffd-report", 1, 1])
    return report["jobs"][0]


def start(run, **members):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(**members))
    return ["a.obj", "-l", "l.json"]


@case
def text_of_a_clean_one(run):
    work = start(run, moves=SHIFT)
    lines = run.ffd("check", *work).text.splitlines()
    equal(lines[:3], ["a.obj", "  vertices       8: 8 inside", "  moved          8, by 1 at most"])
    check(lines[3].startswith("  folds          none, proven in the 1 cell inside the lattice; det J is at least "), lines[3])
    equal(lines[4:6], ["  flipped faces  0 of 6", "  torn edges     0"])
    equal(lines[6:9], ["  area           24, deformed 24", "  volume         8, deformed 8", "  det F          1 to 1 at the vertices"])
    check(lines[9].startswith("  edges          12, ") and lines[9].endswith(" on average"), lines[9])
    equal(len(lines), 10)
    equal(run.names(), ["a.obj", "l.json"])


@case
def text_of_a_folded_one(run):
    run.write("a.obj", obj(CORNERS, CUBE_FACES) + "v 9 9 9\nv nan 0 0\np 9 10\n")
    # x' = u + 2u(1-u): det F = 3 - 4u.
    run.write("l.json", Volume((3, 2, 2), (2, 1, 1), lambda i, j, k: [float(i == 1), 0, 0]).file())
    done = run.ffd("check", "a.obj", "-l", "l.json", lines=1)
    check(done.err[0].startswith("a.obj: 2 of 10 vertices are not inside: 1 outside"), done.err)
    lines = done.text.splitlines()
    equal(lines[1], "  vertices       10: 8 inside, 1 outside, 1 invalid")
    equal(lines[3], "  folds          some: 1 of 1 cell; det J is at least -1 of its mean at rest")
    check("deformed, det J is -1 (l.json)" in lines[4], lines[4])
    # The face at u = 1.
    equal(lines[5:7], ["  flipped faces  1 of 6", "  torn edges     0"])
    equal(lines[9], "  det F          -1 to 3 at the vertices")


@case
def where_text_and_report_go(run):
    work = start(run, moves=SHIFT)
    text = run.ffd("check", *work).text
    report = run.ffd("check", *work, "--report", "-", "--report-stable").text
    equal(json.loads(report)["format"], "ffd-report")
    equal(run.ffd("check", *work, "--report", "r.json", "--report-stable").text, text)
    equal(run.text("r.json"), report)
    equal(run.ffd("check", *work, "--quiet").text, "")
    equal(run.ffd("check", *work, "-q", "--report", "-", "--report-stable").text, report)
    equal(run.ffd("check", *work, "-v", "--force", "--in-place", "--resources", "reference").text, text)
    equal(run.names(), ["a.obj", "l.json", "r.json"])
    equal(run.text("a.obj"), CUBE)


@case
def members_of_the_report(run):
    work = start(run, high=(2, 2, 0), moves=SHIFT)
    job = checked(run, *work, lines=1)
    equal(list(job), ["input", "output", "status", "exit", "error", "vertices", "inside", "outside", "multiple", "singular",
                      "invalid", "unused", "hidden", "morph_targets", "moved", "shared_faces", "residual", "iterations", "folds", "flipped_faces", "tear", "volume", "area", "det", "edges", "bounds",
                      "displacement", "behind", "seconds"])
    equal(list(job["folds"]), ["verdict", "cells", "min_det", "relative_to", "folded_cells", "unknown_cells", "witness"])
    equal(list(job["edges"]), ["count", "deviation"])
    equal(list(job["edges"]["deviation"]), ["max", "mean"])
    equal(list(job["seconds"]), ["read", "embed", "deform", "judge", "write"])
    equal([job[key] for key in ("input", "output", "status", "exit", "error")], ["a.obj", None, "ok", 0, None])
    equal([job[key] for key in ("vertices", "inside", "outside", "moved")], [8, 4, 4, 4])
    equal([job["folds"][key] for key in ("verdict", "cells", "folded_cells", "unknown_cells", "witness")],
          ["none", 1, 0, 0, None])
    equal(job["bounds"]["before"], {"min": [-1, -1, -1], "max": [1, 1, 1]})
    near([*job["bounds"]["after"]["max"], job["displacement"]["max"]], [2, 1, 1, 1], 1e-14)
    # Four edges join a vertex that moves by 1 with one below the lattice that stays. The jump comes at the border,
    # 1/2 of the edge, where the moved half is furthest from the straight edge (1,0,2): 1/2 * 2/sqrt(5).
    equal(job["edges"]["count"], 12)
    near([job["edges"]["deviation"]["max"]], [1 / math.sqrt(5)], 0.02)
    check("seconds" not in checked(run, *work, "--report-stable", lines=1), "seconds")


def wave(i, j, k):
    return [0.03 * math.sin(3 * i + j - k), 0.04 * math.cos(2 * i - 3 * j + k), 0.05 * math.sin(i + 2 * j + 3 * k + 1)]


@case
def figures_of_a_wavy_volume(run):
    volume = Volume((5, 4, 3), (3, 2, 2), wave)
    points = [[0.1 + 0.8 * x, 0.05 + 0.9 * y, 0.2 + 0.7 * z] for x, y, z in CORNERS]
    run.write("a.obj", obj(points, TRIANGLES))
    for side, at in ((1.0, (0.0, 0.0, 0.0)), (4.0, (8.0, -2.0, 16.0))):
        run.write("a.obj", obj([[at[a] + side * p[a] for a in range(3)] for p in points], TRIANGLES))
        run.write("l.json", volume.file(side, at))
        job = checked(run, "a.obj", "-l", "l.json")
        dets = [volume.determinant(p) for p in points]
        near([job["det"]["min"], job["det"]["max"]], [min(dets), max(dets)], 1e-12)
        lengths = [side * math.dist(volume.deform(p), p) for p in points]
        near([job["displacement"]["max"]], [max(lengths)], 1e-13 * side)
        # In each cell the proof's bound is below every sample, and close to the least determinant.
        grid = [[u, v, w] for u in grid_of(12) for v in grid_of(8) for w in grid_of(8)]
        least = min(volume.determinant(p) for p in grid)
        equal([job["folds"]["verdict"], job["folds"]["cells"], job["folds"]["witness"]], ["none", 2 * 2 * 1, None])
        check(0.9 * least < job["folds"]["min_det"] <= least, job["folds"]["min_det"], least)
        # An edge's largest deviation is looked for to 1/64 of it.
        deviations = [side * volume.deviation(points[a - 1], points[b - 1]) for a, b in edges_of(TRIANGLES)]
        equal(job["edges"]["count"], len(deviations))
        for name, exact in (("max", max(deviations)), ("mean", sum(deviations) / len(deviations))):
            found = job["edges"]["deviation"][name]
            check(exact * (1 - 1 / 48) <= found <= exact * (1 + 1e-9), name, found, exact)
        equal(job["flipped_faces"], 0)


def grid_of(count):
    return [i / count for i in range(count + 1)]


@case
def deviation_of_a_parabola(run):
    """Edges along x bend to z' = z + 2u(1-u)h, the others stay straight."""
    run.write("a.obj", obj(CORNERS, CUBE_FACES))
    run.write("l.json", Volume((3, 2, 2), (2, 1, 1), lambda i, j, k: [0, 0, 0.25 * (i == 1)]).file())
    job = checked(run, "a.obj", "-l", "l.json")
    equal(job["edges"]["count"], 12)
    near([job["edges"]["deviation"]["max"], job["edges"]["deviation"]["mean"]], [0.125, 4 * 0.125 / 12], 1e-15)
    equal(job["moved"], 0)
    near([job["det"]["min"], job["det"]["max"]], [1, 1], 1e-15)


@case
def a_fold_has_a_witness(run):
    """Where x' = u + 2u(1-u)d turns round: u > (1 + 2d)/(4d)."""
    run.write("a.obj", obj(CORNERS, CUBE_FACES))
    for d in (0.51, 0.75, 1.0):
        volume = Volume((3, 2, 2), (2, 1, 1), lambda i, j, k, d=d: [d * (i == 1), 0, 0])
        run.write("l.json", volume.file(2.0, (1.0, 1.0, 1.0)))
        job = checked(run, "a.obj", "-l", "l.json", "--normals", "keep", lines=1)
        folds, witness = job["folds"], job["folds"]["witness"]
        equal([folds["verdict"], folds["cells"], folds["folded_cells"], folds["unknown_cells"]], ["some", 1, 1, 0])
        equal(list(witness), ["lattice", "uvw", "xyz", "rest", "det"])
        equal(witness["lattice"], 0)
        check((1 + 2 * d) / (4 * d) <= witness["uvw"][0] <= 1, d, witness)
        near(witness["rest"], [1 + 2 * u for u in witness["uvw"]], 1e-14)
        near(witness["xyz"], [1 + 2 * x for x in volume.deform(witness["uvw"])], 1e-14)
        near([witness["det"]], [volume.determinant(witness["uvw"])], 1e-12)
        check(witness["det"] <= 0 and 1 - 2 * d - 1e-9 <= witness["det"], d, witness)
        check(1 - 2 * d - 0.01 <= folds["min_det"] <= 1 - 2 * d, d, folds)


@case
def a_fold_in_one_cell_of_many(run):
    """Only one control point of 12 x 12 x 12 is pushed through its neighbours."""
    run.write("a.obj", obj(CORNERS, CUBE_FACES))
    run.write("l.json", lattice((12, 12, 12), (0, 0, 0), (1, 1, 1), [{"at": [6, 5, 7], "by": [0.35, 0, 0]}],
                                degree=[2, 2, 2]))
    folds = checked(run, "a.obj", "-l", "l.json")["folds"]
    # det = 1 + 0.35 N'(u) N(v) N(w), N' being -10 at most (at the knot 0.6), N 3/4 in the middle of a span and 1/2 at
    # its ends: det < 0 on both sides of the knot, and in the middle of the spans beside, not in those at the corners.
    equal([folds["verdict"], folds["cells"], folds["folded_cells"], folds["unknown_cells"]], ["some", 1000, 10, 0])
    check(-1.01 * 0.96875 < folds["min_det"] <= -0.96875, folds)
    near(folds["witness"]["uvw"], [0.55, 0.45, 0.65], 0.16)
    check(folds["min_det"] <= folds["witness"]["det"] <= 0, folds)


@case
def area_and_volume_are_right(run):
    """Of a cube that is stretched, of one without a lid, of one that --only tears."""
    stretch = [{"scale": {"factor": [2, 1, 3], "about": [0, 0, 0]}}]
    run.write("l.json", lattice(moves=stretch))
    for name, faces, volume, area in (("a.obj", CUBE_FACES, (1, 6), (6, 22)), ("b.obj", CUBE_FACES[:5], None, None)):
        run.write(name, obj(CORNERS, faces))
        entry = checked(run, name, "-l", "l.json")
        equal(entry["volume"], volume and {"before": 1, "after": 6})
        if area:
            equal(entry["area"], {"before": 6, "after": 22})
    text = run.ffd("check", "b.obj", "-l", "l.json").text
    check("  volume         none: the mesh is not closed\n" in text, text)
    run.write("cloud.obj", "v 0 0 0\nv 1 1 1\n")
    text = run.ffd("check", "cloud.obj", "-l", "l.json").text
    check("  volume         none: the mesh has no faces\n" in text, text)
    # What a primitive of no known mode draws is not known, so that nobody can say whether it is closed.
    asset, data = gltf_json([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    asset["meshes"][0]["primitives"][0]["mode"] = 9
    run.write("m.glb", glb(asset, data))
    text = run.ffd("check", "m.glb", "-l", "l.json", err=anything).text
    check("  area           not known\n  volume         not known\n" in text, text)
    # Large and far from the lattice: closed all the same.
    for side, told in (("1e100", "area           6e+200, deformed 6e+200\n  volume         1e+300, deformed 1e+300"),
                       ("1e110", "area           6e+220, deformed 6e+220\n  volume         too large for a double, deformed too large for a double"),
                       ("1e160", "area           too large for a double, deformed too large for a double\n"
                                 "  volume         too large for a double, deformed too large for a double")):
        run.write("large.obj", obj([[float(side) if x else 9.0 for x in p] for p in CORNERS], CUBE_FACES))
        check(f"  {told}\n" in run.ffd("check", "large.obj", "-l", "l.json", err=anything).text, side)
    entry = checked(run, "large.obj", "-l", "l.json", err=anything)
    equal([entry["volume"], entry["area"]], [None, None])
    # The quad at z = 1 has vertices of its own and moves away.
    lid = [n + 1 for n in range(4, 8)]
    top = next(f for f in CUBE_FACES if sorted(f) == lid)
    own = [9 + sorted(top).index(n) for n in top]
    sides = [f for f in CUBE_FACES if f != top]
    text = obj(CORNERS + CORNERS[4:], []) + "g box\n" + obj([], sides) + "g lid\n" + obj([], [own])
    run.write("c.obj", text)
    equal(checked(run, "c.obj", "-l", "l.json")["volume"], {"before": 1, "after": 6})
    equal(checked(run, "c.obj", "-l", "l.json", "--only", "group:lid")["volume"], {"before": 1, "after": None})
    check("  volume         1, deformed none: the mesh is not closed\n"
          in run.ffd("check", "c.obj", "-l", "l.json", "--only", "group:lid").text, "text")


@case
def a_mirror_has_det_minus_one_and_turns_every_face(run):
    """det F = -1, and every face shows another side."""
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}]))
    job = checked(run, "a.obj", "-l", "l.json")
    equal([job["folds"]["verdict"], job["flipped_faces"]], ["some", 6])
    near([job["det"]["min"], job["det"]["max"], job["folds"]["witness"]["det"]], [-1, -1, -1], 1e-13)
    check(-1.02 < job["folds"]["min_det"] <= -1 + 1e-13, job["folds"])
    # Two mirrors, one after the other, fold both, and turn the faces back.
    job = checked(run, "a.obj", "-l", "l.json", "-l", "l.json")
    equal([job["folds"]["verdict"], job["folds"]["cells"], job["flipped_faces"]], ["some", 2, 0])
    near([job["det"]["min"], job["det"]["max"]], [1, 1], 1e-13)


@case
def flipped_faces_are_those_in_the_fold(run):
    """Quads across x, the folded part of the volume being u > 3/4 (x' = u + 2u(1-u))."""
    xs = [0.1, 0.5, 0.7, 0.8, 0.95]
    points = [[x, y, z] for x in xs for y, z in ((0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75))]
    faces = [[4 * n + 1, 4 * n + 2, 4 * n + 3, 4 * n + 4] for n in range(len(xs))]
    run.write("a.obj", obj(points, faces))
    run.write("l.json", Volume((3, 2, 2), (2, 1, 1), lambda i, j, k: [float(i == 1), 0, 0]).file())
    job = checked(run, "a.obj", "-l", "l.json")
    equal(job["flipped_faces"], 2)
    near([job["det"]["min"], job["det"]["max"]], [3 - 4 * 0.95, 3 - 4 * 0.1], 1e-13)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "r.json", lines=1)
    reported = json.loads(run.read("r.json"))["jobs"][0]
    equal([reported["flipped_faces"], reported["det"], reported["folds"]], [2, job["det"], job["folds"]])


@case
def the_worst_of_several_lattices_counts(run):
    """Cells are summed, the worst verdict counts, the witness is of the first lattice that has one; det F is that of
    the whole, and of vertices that some lattice holds."""
    run.write("a.obj", obj([[2 * x, y, z] for x, y, z in CORNERS] + [[9, 9, 9]], CUBE_FACES) + "p 9\n")
    run.write("scale.json", lattice((4, 2, 2), (-1, -1, -1), (0.5, 2, 2), [{"scale": {"factor": [1, 2, 3],
                                                                                    "about": [0, 0, 0]}}]))
    run.write("fold.json", Volume((3, 2, 2), (2, 1, 1), lambda i, j, k: [0.75 * (i == 1), 0, 0]).file(1, (1.5, 0, 0)))
    run.write("whole.json", Volume((3, 2, 2), (2, 1, 1), lambda i, j, k: [0.75 * (i == 1), 0, 0]).file(9, (-1, -1, -1)))
    job = checked(run, "a.obj", "-l", "scale.json", "-l", "fold.json", "-l", "whole.json", lines=1)
    equal([job["folds"][key] for key in ("verdict", "cells", "folded_cells")], ["some", 3, 2])
    equal(job["folds"]["witness"]["lattice"], 1)
    check(-0.51 < job["folds"]["min_det"] <= -0.5, job["folds"])
    job = checked(run, "a.obj", "-l", "scale.json", lines=1)
    equal([job["inside"], job["outside"], job["folds"]["verdict"]], [4, 5, "none"])
    near([job["det"]["min"], job["det"]["max"]], [6, 6], 1e-12)
    # Each corner is inside one of the two, and outside the other: none of them counts as outside.
    job = checked(run, "a.obj", "-l", "scale.json", "-l", "fold.json", lines=1)
    equal([job["inside"], job["outside"]], [8, 1])
    near([job["det"]["max"]], [6], 1e-12)


@case
def vertices_that_are_not_finite(run):
    """check counts what deform keeps; their faces and edges are left out of the figures."""
    work = start(run, moves=SHIFT)
    run.write("a.obj", CUBE + "v nan 0 0\nv 0 inf 0\nf 1 2 9\np 10\n")
    job = checked(run, *work, lines=1)
    equal([job["status"], job["vertices"], job["inside"], job["invalid"], job["moved"]], ["ok", 10, 8, 2, 8])
    equal([job["flipped_faces"], job["edges"]["count"], job["det"]], [0, 12, {"min": 1, "max": 1, "outside": None}])
    equal(job["bounds"]["before"], {"min": [-1, -1, -1], "max": [1, 1, 1]})
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", lines=1)
    equal(run.text("b.obj").splitlines()[-4:-1], ["v nan 0 0", "v 0 inf 0", "f 1 2 9"])
    run.write("l.json", {**lattice(), "rest": {"box": "mesh"}, "moves": SHIFT})
    equal(checked(run, *work, lines=1)["inside"], 8)


@case
def meshes_without_faces_or_vertices(run):
    work = start(run, moves=SHIFT)
    for mesh, vertices in (("v 0 0 0\nv 1 1 1\n", 2), ("v 0 0 0\nv 1 1 1\nl 1 2\np 1\n", 2), ("o\n", 0)):
        run.write("a.obj", mesh)
        said = {"lines": int(vertices == 0)}
        job = checked(run, *work, **said)
        equal([job["vertices"], job["flipped_faces"], job["edges"]],
              [vertices, 0, {"count": 0, "deviation": {"max": 0, "mean": 0}}])
        equal(job["det"], {"min": 1, "max": 1, "outside": None} if vertices else None)
        equal(job["bounds"]["before"]["min"], [0, 0, 0] if vertices else None)
        check(f"  vertices       {vertices}" in run.ffd("check", *work, **said).text, "the text")


@case
def a_check_refuses_what_deform_refuses(run):
    """Everything that deform refuses but for outputs, with its codes, and nothing on standard output."""
    work = start(run, moves=SHIFT)
    run.write("far.json", lattice(moves=[{"by": [1e39, 0, 0]}]))
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    run.write("bad.obj", "v 0 0\n")
    run.write("bad.json", "{}")
    run.write("whole.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty int z\n"
              "end_header\n0 0 0\n")
    run.ffd("check", "missing.obj", "-l", "l.json", code=IO)
    run.ffd("check", "a.obj", "-l", "missing.json", code=IO)
    run.ffd("check", "bad.obj", "-l", "l.json", code=INVALID)
    run.ffd("check", "a.obj", "-l", "bad.json", code=INVALID)
    run.ffd("check", "whole.ply", "-l", "l.json", code=UNSUPPORTED)
    run.ffd("check", "a.glb", "-l", "far.json", code=INVALID)
    run.ffd("check", "a.obj", "-l", "l.json", "--report", "none/r.json", code=IO)
    run.write("l.json", lattice(high=(2, 2, 0), moves=SHIFT))
    run.ffd("check", *work, "--outside", "error", code=EMBEDDING)
    run.ffd("check", *work, "--outside", "error", "--report", "r.json", code=EMBEDDING)
    job = json.loads(run.read("r.json"))["jobs"][0]
    equal([job["status"], job["exit"], job["outside"], job["folds"], job["flipped_faces"], job["edges"]],
          ["failed", EMBEDDING, 4, None, None, None])


@case
def faces_that_are_not_valid(run):
    """They are among no figures, which is said; a gate of faces does not pass then, and --strict refuses them."""
    asset, data = with_triangles(CUBE_CORNERS, [[0, 1, 99]])
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=SHIFT))
    why = "there is an index 99, but the count of vertices is 8: what the primitive draws is not known"
    for command in (["deform", "a.glb", "b.glb"], ["check", "a.glb"]):
        run.ffd(*command, "-l", "l.json", "--strict", code=INVALID, err="a.glb:/meshes/0/primitives/0: " + why)
        for gate in ("tear", "flipped", "flipped=5", "edges=1", "folds,tear=1"):
            run.ffd(*command, "-l", "l.json", "--fail-on", gate, code=NO, err=(
                "a.glb: --fail-on tear, flipped and edges cannot be judged: the faces of 1 primitive are not known"))
        check(not run.exists("b.glb"), "refused")
    for command in (["deform", "a.glb", "b.glb"], ["check", "a.glb"]):
        run.ffd(*command, "-l", "l.json", "--fail-on", "folds,multiple", err="a.glb: /meshes/0/primitives/0: " + why)


@case
def a_mesh_from_standard_input_is_checked_alike(run):
    work = start(run, moves=SHIFT)
    done = run.ffd("check", "-", "-l", "l.json", "--input-format", "obj", stdin=CUBE.encode())
    equal(done.text, run.ffd("check", *work).text.replace("a.obj", "standard input"))
    done = run.ffd("check", "a.obj", "-l", "-", stdin=run.read("l.json"))
    equal(done.text, run.ffd("check", *work).text)


@case
def several_meshes_are_checked_one_by_one(run):
    start(run, moves=SHIFT)
    run.write("sub/a.obj", CUBE)
    one = run.ffd("check", "a.obj", "-l", "l.json").text
    text = run.ffd("check", "a.obj", "missing.obj", "sub/a.obj", "-l", "l.json", "--report", "r.json", code=1, lines=1).text
    equal(text, one + one.replace("a.obj", "sub/a.obj"))
    equal([(job["input"], job["output"], job["exit"]) for job in json.loads(run.read("r.json"))["jobs"]],
          [("a.obj", None, 0), ("missing.obj", None, IO), ("sub/a.obj", None, 0)])


def with_triangles(positions, triangles, nodes=None):
    asset, data = gltf_json(positions, nodes)
    indices = b"".join(struct.pack("<3H", *t) for t in triangles)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(indices)})
    asset["accessors"].append({"bufferView": 1, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"})
    asset["meshes"][0]["primitives"][0].update(indices=1, mode=4)
    asset["buffers"][0]["byteLength"] += len(indices)
    return asset, data + indices


@case
def gltf_in_the_scene(run):
    """The figures are those of the mesh as the scene shows it; of two nodes that show it, of both."""
    volume = Volume((5, 4, 3), (3, 2, 2), wave)
    points = [[0.125 + 0.75 * x, 0.25 + 0.5 * y, 0.25 + 0.5 * z] for x, y, z in CORNERS]
    own = [[p[0] * 2 - 4, p[1] * 2, p[2] * 2] for p in points]
    triangles = [[i - 1 for i in t] for t in TRIANGLES]
    run.write("l.json", volume.file())
    run.write("a.obj", obj(points, TRIANGLES))
    expected = checked(run, "a.obj", "-l", "l.json", "--report-stable")
    placed = {"mesh": 0, "scale": [0.5, 0.5, 0.5], "translation": [2, 0, 0]}
    figures = ("folds", "det", "flipped_faces", "edges", "displacement", "bounds", "inside")
    run.write("a.glb", glb(*with_triangles(own, triangles, [placed])))
    found = checked(run, "a.glb", "-l", "l.json", "--report-stable")
    equal([found[key] for key in figures], [expected[key] for key in figures])
    run.write("a.glb", glb(*with_triangles(own, triangles, [placed, {**placed, "translation": [2, 0, 50]}])))
    both = checked(run, "a.glb", "-l", "l.json", lines=1)
    equal([both["inside"], both["outside"], both["edges"]["count"]], [8, 8, 2 * expected["edges"]["count"]])
    equal(both["edges"]["deviation"]["max"], expected["edges"]["deviation"]["max"])
    near([both["edges"]["deviation"]["mean"]], [expected["edges"]["deviation"]["mean"] / 2], 1e-15)
    run.write("a.glb", glb(*with_triangles(points, triangles, [placed])))
    found = checked(run, "a.glb", "-l", "l.json", "--space", "mesh", "--report-stable")
    equal([found[key] for key in figures], [expected[key] for key in figures])
    # A node that mirrors: the faces are turned before and after, none by the deformation.
    run.write("a.glb", glb(*with_triangles([[-p[0], p[1], p[2]] for p in points], triangles,
                                           [{"mesh": 0, "scale": [-1, 1, 1]}])))
    found = checked(run, "a.glb", "-l", "l.json")
    equal([found["flipped_faces"], found["det"]], [0, expected["det"]])
    # Its faces are turned, so that they enclose what they did; two nodes enclose twice that.
    check(expected["volume"]["before"] > 0, expected["volume"])
    for name in ("volume", "area"):
        for when in ("before", "after"):
            near([found[name][when], both[name][when] / (2 if when == "before" else 1)],
                 [expected[name][when], expected[name][when] + (expected[name]["before"] if when == "after" else 0)], 1e-12)


@case
def a_node_without_inverse(run):
    """Its vertices stay, whatever they would do: no figure is of them."""
    triangles = [[i - 1 for i in t] for t in TRIANGLES]
    run.write("a.glb", glb(*with_triangles(CUBE_CORNERS, triangles, [{"mesh": 0, "scale": [1, 1, 0]}])))
    run.write("l.json", lattice(moves=SHIFT))
    job = checked(run, "a.glb", "-l", "l.json", lines=1)
    equal([job["moved"], job["det"], job["flipped_faces"], job["edges"]["count"]], [0, None, 0, 0])


@case
def threads_change_nothing(run):
    volume = Volume((5, 4, 3), (3, 2, 2), wave)
    points = [[(n * 37 % 101) / 101, (n * 53 % 103) / 103, (n * 71 % 107) / 107] for n in range(3000)]
    faces = [[n + 1, n + 2, n + 3] for n in range(2990)]
    run.write("a.obj", obj(points, faces))
    run.write("l.json", volume.file())
    texts = {run.ffd("check", "a.obj", "-l", "l.json", "--report", "-", "--report-stable", "-j", str(n)).text
             for n in (1, 2, 3)}
    equal(len(texts), 1)


@case
def figures_are_those_of_deform(run):
    """check does everything that deform does."""
    run.write("a.obj", obj(CORNERS, CUBE_FACES) + "v 3 3 3\n")
    run.write("l.json", Volume((5, 4, 3), (3, 2, 2), wave).file())
    for options in ([], ["--outside", "extend"], ["--outside", "extend", "--falloff", "2.5"], ["--normals", "keep"]):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", *options, "--force", "--report", "r.json", "--report-stable",
                lines=1)
        deformed = json.loads(run.read("r.json"))["jobs"][0]
        judged = checked(run, "a.obj", "-l", "l.json", *options, "--report-stable", lines=1)
        for job in (deformed, judged):
            del job["output"], job["edges"]
        equal(judged, deformed)


main()
