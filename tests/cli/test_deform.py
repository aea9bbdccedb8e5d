#!/usr/bin/env python3
"""ffd deform: one mesh, many meshes, in place, the options and the report."""
import json
import math
import os
import re
from random import Random

from harness import (CUBE, CUBE_CORNERS, EMBEDDING, INVALID, IO, NO, OK, PNG, USAGE, case, check, equal, glb,
                     glb_positions, glb_split, gltf_json, gltf_vectors, lattice, main, near, obj_of, obj_vertices)

MOVE = [{"by": [1, 0, 0]}]
# Displaces the middle of the box only, in x, by an amount that depends on the place.
BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0, 0]}]


def bernstein(t):
    return [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3]


def bump(p, low=-2, high=2):
    """The displacement in x that BUMP gives to p: 4x4x4 cubic clamped points, one cell of Bernstein polynomials."""
    weights = [bernstein((x - low) / (high - low)) for x in p]
    return 0.5 * math.prod(w[1] + w[2] for w in weights)


def start(run, moves=MOVE, **members):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=moves, **members))


@case
def the_documented_displacement(run):
    start(run, BUMP)
    points = CUBE_CORNERS + [[0.0, 0.0, 0.0], [0.25, -0.5, 1.75], [2.0, 0.0, 0.0], [-2.0, -2.0, -2.0]]
    run.write("p.obj", obj_of(points))
    run.ffd("deform", "p.obj", "q.obj", "-l", "l.json")
    near(obj_vertices(run.text("q.obj")), [[p[0] + bump(p), p[1], p[2]] for p in points], 1e-15, "positions")


@case
def moves_that_move_no_vertex_are_told(run):
    """Because they reach no control point, do nothing to those that they reach, or these act on no vertex; and why."""
    lies = r" \(the mesh lies from -1 -1 -1 to 1 1 1\)$"
    idle = "^a.obj: no vertex moves: the move of l.json moves no control point" + lies
    far = {"point": [90, 50, 0], "by": [0, 0, 1], "radius": 0.5}
    for move in ({"pull": far}, {"by": [0, 0, 0]}, {"by": [1, 0, 0], "weight": 0}, {"scale": {"factor": 1}},
                 {"by": [1, 0, 0], "falloff": {"center": [50, 0, 0], "radius": 1}}, {"twist": {"axis": "x", "degrees": 0}}):
        start(run, [move])
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=re.compile(idle))
        equal(run.read("b.obj"), run.read("a.obj"), str(move))
    run.ffd("view", "a.obj", "-l", "l.json", "-o", "v.html", err=re.compile(idle))
    run.ffd("check", "a.obj", "-l", "l.json")
    start(run, [{"pull": far}, {"by": [0, 0, 0]}])
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=re.compile("the moves of l.json move no control point"))
    # Control points move, and act on no vertex: in a lattice of 8 x 8 x 8 cells those in one corner.
    many = {"size": (8, 8, 8), "degree": [1, 1, 1], "low": (-7, -7, -7), "high": (7, 7, 7)}
    start(run, [{"at": [0, 0, [0, 1]], "by": [0, 0, 1]}], **many)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force",
            err=re.compile("^a.obj: no vertex moves, though l.json moves 2 control points" + lies))
    run.write("c.json", lattice(moves=[{"pull": far}]))
    run.write("m.json", lattice(moves=MOVE))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "-l", "m.json", "-l", "c.json", "--force",
            err="a.obj: the move of c.json moves no control point")
    # A lattice without moves is meant to do nothing, and a mesh outside has a message of its own.
    start(run, [])
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force")
    start(run, MOVE, low=(5, 5, 5), high=(6, 6, 6))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=re.compile("8 of 8 vertices are not inside"))


@case
def moves_that_the_floats_of_a_file_cannot_hold_are_told(run):
    """Far from the origin a float is a multiple of 0.5 or 1: a move of 0.1 leaves the file as it was. Not where a vertex moves, nor doubles."""
    far = [[5e6 + x, 8e6 + y, 7e6 + z] for x, y, z in CUBE_CORNERS]
    region = {"low": (4.9e6, 7.9e6, 6.9e6), "high": (5.1e6, 8.1e6, 7.1e6)}
    start(run, [{"by": [0.1, 0.1, 0.1]}], **region)

    def ply(kind, points):
        return f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n" + "".join(f"property {kind} {a}\n" for a in "xyz") + "end_header\n" \
            + "".join("{} {} {}\n".format(*p) for p in points)
    told = re.compile(r"no vertex moves in the output: its numbers are too coarse for displacements of 0\.173205 at most \(the mesh lies from 5e\+06 ")
    for name, content in (("f.ply", ply("float", far)), ("f.glb", glb(*gltf_json(far)))):
        run.write(name, content)
        run.ffd("deform", name, "o" + name, "-l", "l.json", err=told)
        equal(run.read("o" + name), run.read(name))
    for name, content in (("d.ply", ply("double", far)), ("a.obj", obj_of(far))):
        run.write(name, content)
        run.ffd("deform", name, "o" + name, "-l", "l.json")
    start(run, [{"at": [0, "all", "all"], "by": [0.1, 0, 0]}, {"at": [3, "all", "all"], "by": [9, 0, 0]}], **region)
    run.ffd("deform", "f.ply", "of.ply", "-l", "l.json", "--force")
    run.ffd("deform", "f.glb", "of.glb", "-l", "l.json", "--force", "--as-morph", "a")


@case
def a_morph_target_that_moves_nothing_is_told_with_the_reason(run):
    """Of --as-morph and of each --morph; what moves beside it does not hide it."""
    start(run, [{"pull": {"point": [90, 50, 0], "by": [0, 0, 1], "radius": 0.5}}])
    run.write("m.json", lattice(moves=MOVE))
    lies = r" \(the mesh lies from -1 -1 -1 to 1 1 1\)"
    zeros = "no vertex moves: all offsets of the morph target are 0"
    for options, expected in ((["-l", "l.json", "--as-morph", "far"], [f"a.obj: the move of l.json moves no control point{lies}", f"a.obj: {zeros}"]),
                              (["--morph", "far=l.json"], [f"a.obj: the move of l.json moves no control point{lies}", f"a.obj: {zeros}"]),
                              (["-l", "m.json", "-l", "l.json", "--as-morph", "far"], ["a.obj: the move of l.json moves no control point"])):
        done = run.ffd("deform", "a.obj", "b.glb", *options, "--force", err=lambda said: None)
        found = [line for line in done.err if "control point" in line or "no vertex" in line]
        check(len(found) == len(expected) and all(re.fullmatch(e, f) for e, f in zip(expected, found)), options, done.err)
    run.ffd("deform", "a.obj", "b.glb", "--morph", "near=m.json", "--morph", "far=l.json", "--force",
            err=lambda said: equal(len([line for line in said if "far" in line and "moves no control point" in line]), 1, str(said)))
    run.ffd("view", "a.obj", "-l", "l.json", "--as-morph", "far", "-o", "v.html",
            err=re.compile("^a.obj: no vertex moves: the move of l.json moves no control point"))


@case
def a_row_of_a_table_that_moves_nothing_is_told(run):
    start(run, [{"twist": {"axis": "x", "degrees": {"$": "D"}}}])
    run.write("t.csv", "D\n0\n30\n")
    done = run.ffd("batch", "--in", "a.obj", "--lattice", "l.json", "--csv", "t.csv", "--out-dir", ".", err=lambda said: None)
    equal([line.split(":")[:2] for line in done.err if "no vertex moves" in line], [["t.csv", "2"]])


@case
def a_mesh_that_is_turned_inside_out_is_told(run):
    """With the number of faces where they are counted, in any format, also where it is a morph target."""
    mirror = [{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}]
    start(run, mirror)
    for out in ("b.obj", "b.ply", "b.glb"):
        run.ffd("deform", "a.obj", out, "-l", "l.json", "--normals", "keep",
                err=lambda said: equal(said[0], "a.obj: the mesh turns inside out at 8 of 8 vertices: det F falls to -1, at vertex 0"))
    done = run.ffd("deform", "a.obj", "m.glb", "--morph", "in=l.json", err=lambda said: None)
    equal(len([line for line in done.err if "turns inside out at 8 of 8 vertices" in line]), 1)
    faces = json.loads(run.ffd("info", "a.obj", "--json", data=True).out)["contents"]["faces"]
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--report", "r.json",
            err=re.compile(f"; {faces} of {faces} faces are turned over$"))
    equal(json.loads(run.text("r.json"))["jobs"][0]["flipped_faces"], faces)
    # A triangle that spans a half turn is turned over though the volume does not fold: det F does not show it.
    run.write("t.obj", obj_of([[-1, -1, 0], [1, -1, 0], [0, 1, 0]]) + "f 1 2 3\n")
    run.write("twist.json", lattice(size=(4, 9, 4), moves=[{"twist": {"axis": "y", "degrees": 700, "about": [0, 0, 0]}}]))
    turned = json.loads(run.ffd("check", "t.obj", "-l", "twist.json", "--report", "-", data=True, err=lambda said: None).out)["jobs"][0]
    done = run.ffd("deform", "t.obj", "u.obj", "-l", "twist.json", "--report", "r.json", "--force", err=lambda said: None)
    equal(len([line for line in done.err if line.endswith(f"{turned['flipped_faces']} of 1 face is turned over")]), turned["flipped_faces"])
    # In a lattice of which a part folds, the vertices in that part.
    start(run, [{"at": [1, 0, 0], "by": [-9, 0, 0]}], size=(2, 2, 2), degree=[1, 1, 1])
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=re.compile("turns inside out at [1-7] of 8 vertices"))


COLLAPSE = "the mesh collapses at {} of {} vertices: det F is 0 within rounding, first at vertex {}"
TURN = [{"rotate": {"axis": [1, 2, 3], "degrees": 31}}]
# To a plane, to a tilted plane, to a line, to a point; to a plane by the second of two lattices, and by the first.
COLLAPSES = [[{"scale": {"factor": [1, 0, 1]}}], TURN + [{"scale": {"factor": [1, 0, 1]}}] + TURN, [{"scale": {"factor": [0, 0, 1]}}],
             [{"to": [0, 0, 0]}], [{"scale": {"factor": 0, "about": [0.1, 0.2, 0.3]}}]]


def tilted_ball(run):
    """A ball of 10 x 10 faces that leans, off the origin: its coordinates and F have no round numbers."""
    rows, points = 10, []
    for i in range(rows + 1):
        for j in range(rows):
            a, b = math.pi * i / rows, 2 * math.pi * j / rows
            x, y, z = math.sin(a) * math.cos(b), math.cos(a), math.sin(a) * math.sin(b)
            points.append([0.3 + 0.61 * x + 0.2 * y, 0.17 - 0.2 * x + 0.61 * y + 0.1 * z, -0.4 + 0.73 * z])
    faces = [[1 + i * rows + j, 1 + (i + 1) * rows + j, 1 + (i + 1) * rows + (j + 1) % rows, 1 + i * rows + (j + 1) % rows]
             for i in range(rows) for j in range(rows)]
    run.write("a.obj", obj_of(points) + "".join("f {} {} {} {}\n".format(*f) for f in faces))
    return len(points)


@case
def a_mesh_that_collapses_is_told(run):
    """One line in deform, check and a batch; what is a rounding is not turned inside out, nor are its faces turned over."""
    count = tilted_ball(run)
    run.write("still.json", lattice(moves=BUMP))
    for moves in COLLAPSES:
        for low in (-9, -2.000001):
            run.write("l.json", lattice(moves=moves, low=(low,) * 3, high=(2, 2, 2.5)))
            said = "a.obj: " + COLLAPSE.format(count, count, 0)
            for chain in (["-l", "l.json"], ["-l", "still.json", "-l", "l.json"], ["-l", "l.json", "-l", "still.json"]):
                run.ffd("deform", "a.obj", "b.obj", *chain, "--force", err=said)
                done = run.ffd("deform", "a.obj", "b.obj", *chain, "--report", "r.json", "--force", lines=2)
                equal(done.err[0], said)
                check(re.match("a.obj: the deformed volume folds in 1 of [12] cells?, as at ", done.err[1]), done.err)
                check("turned over" not in done.err[1] and "inside out" not in done.err[1], done.err)
                report = json.loads(run.text("r.json"))["jobs"][0]
                equal([report["flipped_faces"], report["det"]["min"], report["det"]["max"]], [0, 0, 0])
                check("flipped faces  0 of" in run.ffd("check", "a.obj", *chain, err=said).text, moves)
                run.ffd("check", "a.obj", *chain, "--fail-on", "flipped", err=said)
    # Half of it lies outside and is extended: det F is 0 there, too.
    run.write("cut.json", lattice(moves=COLLAPSES[0], low=(-2.000001,) * 3, high=(2, 2, -0.4)))
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "cut.json", "--outside", "extend", "--report", "r.json", "--force", err=lambda said: None)
    equal([line for line in done.err if "inside out" in line or "turned over" in line], [])
    equal(len([line for line in done.err if "the mesh collapses at " in line]), 1)
    equal(len([line for line in done.err if "outside the lattice det F falls to 0, at vertex" in line and "the mesh collapses there" in line]), 1, done.err)
    done = run.ffd("batch", "--in", "a.obj", "--lattice", "l.json", "--out-dir", "o", err=lambda said: None)
    equal(len([line for line in done.err if COLLAPSE.format(count, count, 0) in line]), 1, done.err)


@case
def a_part_that_collapses_hides_no_fold(run):
    """One layer is laid into the next one: vertices between them collapse; those beyond turn inside out where it goes further."""
    count = tilted_ball(run)
    def layers(by):
        return lattice(size=(2, 4, 2), degree=[1, 1, 1], low=(-1.5, -1.5, -1.5), high=(1.5, 1.5, 1.5),
                       moves=[{"at": ["all", [2, 3], "all"], "by": [0, by, 0]}])
    run.write("l.json", layers(-1))
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", lines=1)
    collapsed = int(re.fullmatch("a.obj: the mesh collapses at ([0-9]+) of 110 vertices: .*", done.err[0])[1])
    check(0 < collapsed < count, done.err)
    run.write("l.json", layers(-1.001))
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", lines=2)
    equal(done.err[0].split(":")[1], f" the mesh turns inside out at {collapsed} of {count} vertices")
    check(re.fullmatch("a.obj: [1-9][0-9]* of 100 faces are turned over", done.err[1]), done.err)
    # A mesh that is flattened much, but not to nothing, is told nothing of.
    run.write("l.json", lattice(moves=[{"scale": {"factor": [1, 1e-9, 1]}}]))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force")


# Slides the upper part of a space through the lower one: rigidly at the corners of a cube, whose det F is 1.
SLIDE = lattice(size=(2, 2, 33), low=(-4, -4, -4), high=(4, 4, 4), moves=[{"at": [[0, 1], [0, 1], [17, 32]], "by": [0, 0, -6]}])


@case
def faces_that_are_turned_over_are_told(run):
    """Though det F > 0 at every vertex, in each format, with the count of check; and where no vertex moves none is."""
    run.write("a.obj", CUBE)
    run.write("l.json", SLIDE)
    run.write("shift.json", lattice(moves=[{"by": [0.25, 0, 0]}], low=(-9, -9, -9), high=(9, 9, 9)))
    for ending in ("obj", "off", "ply", "stl", "gltf", "glb"):
        name = f"in.{ending}"
        run.ffd("deform", "a.obj", name, "-l", "shift.json", "-q")
        job = json.loads(run.ffd("check", name, "-l", "l.json", "--report", "-", data=True, err=lambda said: None).out)["jobs"][0]
        faces = 6 if ending in ("obj", "off", "ply") else 12
        equal([job["flipped_faces"], job["det"]["min"] > 0], [faces * 2 // 3, True], name)
        told = f"{name}: {job['flipped_faces']} of {faces} faces are turned over"
        count = lambda said: equal([line for line in said if "turned over" in line], [told])
        run.ffd("deform", name, f"out.{ending}", "-l", "l.json", err=count)
        run.ffd("deform", name, "morph.glb", "-l", "l.json", "--as-morph", "slide", "--force", err=count)
        run.ffd("deform", name, "normals.obj", "-l", "l.json", "--normals", "recompute", "--force", err=count)
        run.ffd("deform", name, f"out.{ending}", "-l", "l.json", "--force", "-q")
        run.ffd("deform", name, "--in-place", "-l", "l.json", err=count)
    run.ffd("deform", "a.obj", "m.glb", "--morph", "near=shift.json", "--morph", "far=l.json",
            err=lambda said: equal([line for line in said if "turned over" in line],
                                   ['a.obj: morph target "far": 4 of 6 faces are turned over']))
    run.write("jobs.jsonl", json.dumps({"in": "a.obj", "out": "batch.ply", "lattice": "l.json"}) + "\n")
    done = run.ffd("batch", "jobs.jsonl", err=lambda said: None)
    equal(len([line for line in done.err if "4 of 6 faces are turned over" in line]), 1, done.err)
    for vertices in (128, 129):
        run.write("large.obj", CUBE + "v 1 1 1\n" * (vertices - 8))
        run.ffd("deform", "large.obj", "b.obj", "-l", "l.json", "--force",
                err=lambda said: equal(any("4 of 6 faces are turned over" in line for line in said), vertices == 128, said))
    run.write("still.json", lattice(moves=[]))
    run.ffd("deform", "a.obj", "b.obj", "-l", "still.json", "--force")


@case
def turned_faces_are_counted_as_check_counts_them(run):
    """In random lattices, which end in a sheet of triangles and quads with slivers, or hold it."""
    side = 6
    points = [[x / side, y / side, 0.2 * math.sin(0.9 * x) * math.cos(y)] for y in range(side + 1) for x in range(side + 1)]
    faces = []
    for y in range(side):
        for x in range(side):
            v = y * (side + 1) + x + 1
            quad = [v, v + 1, v + side + 2, v + side + 1]
            faces += [quad] if x % 2 else [quad[:3], [quad[0], *quad[2:]]]
    for seed in range(26):  # slivers, which a gentle bend turns over
        random = Random(seed)
        first, way = [random.uniform(0.1, 0.6) for _ in range(2)], [random.uniform(0.02, 0.3) for _ in range(2)]
        off = random.choice((1e-4, 1e-3, 1e-2)) * random.choice((-1, 1))
        points += [[*first, 0], [first[0] + way[0] / 2 - off * way[1], first[1] + way[1] / 2 + off * way[0], 0],
                   [first[0] + way[0], first[1] + way[1], 0]]
        faces.append([len(points) - 2, len(points) - 1, len(points)])
    run.write("a.obj", obj_of(points) + "".join("f " + " ".join(map(str, f)) + "\n" for f in faces))
    found = []
    for seed in range(24):
        random = Random(seed)
        size = [random.choice((3, 4, 6)) for _ in range(3)]
        bend, degrees = random.choice((0.002, 0.01, 0.4)), random.choice((0.5, 3, 200))
        moves = [{"at": [random.randrange(n) for n in size], "by": [random.uniform(-bend, bend) for _ in range(3)]} for _ in range(3)]
        moves += [{"twist": {"axis": random.choice("xyz"), "degrees": degrees}}] * random.randrange(2)
        run.write("l.json", lattice(size, (0, 0, -0.3), (random.choice((0.7, 1)), 1, 0.3), moves))
        options = random.choice(([], [], ["--outside", "extend"]))
        job = json.loads(run.ffd("check", "a.obj", "-l", "l.json", *options, "--report", "-", data=True, err=lambda said: None).out)["jobs"][0]
        told = [f"a.obj: {job['flipped_faces']} of {len(faces)} faces are turned over"]
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", *options, "--force",
                err=lambda said: equal([line for line in said if "turned over" in line], told if job["flipped_faces"] else [], f"seed {seed}"))
        found.append(job["flipped_faces"])
    check(0 < found.count(0) < len(found), found)


@case
def only_numbers_of_moved_vertices_change(run):
    text = ("# kept \t\nmtllib no such.mtl\no thing\nv\t-1.50 1e0 +.5 # why\nv 5 5 5.000 0.1 0.2 0.3\nvt 0 1\nvn 0 0 1\n"
            "g a b\nusemtl m\ns 1\nf 1/1/1 2/1/1 1/1/1\nl 1 2\nunknown stuff\n")
    start(run, [{"by": [0.25, 0, 0]}])
    run.write("t.obj", text.replace("\n", "\r\n"))
    run.ffd("deform", "t.obj", "u.obj", "-l", "l.json",
            err=['t.obj: line 13: "unknown" is no statement of OBJ: it is left as it is',
                 "t.obj: 1 of 2 vertices is not inside: 1 outside (left where it is)",
                 "t.obj: 1 vertex of a stays; the largest step to a neighbour is 0.25 (see --outside extend, --falloff, a larger "
                 "lattice)"])
    equal(run.text("u.obj"), text.replace("-1.50 1e0 +.5", "-1.25 1e0 +.5").replace("\n", "\r\n"))


@case
def several_lattices_follow_each_other(run):
    start(run)
    run.write("second.json", lattice(moves=[{"scale": {"factor": 2, "about": [0, 0, 0]}}]))
    moved = [[2 * (p[0] + 1), 2 * p[1], 2 * p[2]] for p in CUBE_CORNERS]
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "-l", "second.json")
    near(obj_vertices(run.text("b.obj")), moved, 1e-14)
    run.ffd("deform", "a.obj", "c.obj", "-l", "second.json", "-l", "l.json")
    near(obj_vertices(run.text("c.obj")), [[2 * p[0] + 1, 2 * p[1], 2 * p[2]] for p in CUBE_CORNERS], 1e-14)


@case
def a_lattice_round_the_mesh(run):
    start(run, rest={"box": "mesh", "margin": 0.1}, units="box", moves=[{"by": [0.5, 0, 0]}])
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json")
    near(obj_vertices(run.text("b.obj")), [[p[0] + 0.5 * 2 * 1.2, p[1], p[2]] for p in CUBE_CORNERS], 1e-14)


@case
def vertices_outside_stay_and_are_told_of(run):
    start(run, high=(2, 2, 0))
    run.write("l.json", lattice(high=(2, 2, 0), moves=MOVE))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json",
            err=["a.obj: 4 of 8 vertices are not inside: 4 outside (left where they are)",
                 "a.obj: 4 vertices stay; the largest step to a neighbour is 1 (see --outside extend, --falloff, a larger "
                 "lattice)"])
    expected = [[p[0] + (p[2] < 0), p[1], p[2]] for p in CUBE_CORNERS]
    near(obj_vertices(run.text("b.obj")), expected, 1e-15)
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--outside", "keep", "-q", err=[])
    equal(run.read("c.obj"), run.read("b.obj"))
    done = run.ffd("deform", "a.obj", "d.obj", "-l", "l.json", "--outside", "error", code=EMBEDDING)
    check(done.err[0].startswith("a.obj: 4 of 8 "), done.err[0])
    check(not run.exists("d.obj"), "an output was written")
    run.ffd("deform", "a.obj", "d.obj", "-l", "l.json", "--outside=error", "-q", code=EMBEDDING)


@case
def nothing_moves_nothing_changes(run):
    start(run, moves=[])
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--outside", "error")
    equal(run.text("b.obj"), CUBE)


@case
def normals_turn_by_the_cofactor_matrix(run):
    start(run, moves=[{"scale": {"factor": [1, 2, 1], "about": [0, 0, 0]}}])
    run.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0.6 0.8 0\nvn 0 0 1\nf 1//1 2//1 3//2\n")
    run.ffd("deform", "n.obj", "t.obj", "-l", "l.json")
    lines = [line.split() for line in run.text("t.obj").splitlines()]
    x, y = 0.6, 0.4  # cof(F) n = (2 x, y, 2 z), made a unit vector
    length = math.hypot(x, y)
    near([float(v) for v in lines[3][1:]], [x / length, y / length, 0], 1e-15)
    equal(lines[4], ["vn", "0", "0", "1"])
    run.ffd("deform", "n.obj", "k.obj", "-l", "l.json", "--normals", "keep")
    check("vn 0.6 0.8 0\n" in run.text("k.obj") and "v 0 2 0\n" in run.text("k.obj"), run.text("k.obj"))


@case
def zero_normals_stay_in_silence(run):
    """A zero normal keeps its text, and is not told of as one that the deformation collapses."""
    start(run, moves=[{"scale": {"factor": [1, 1, 0], "about": [0, 0, 0]}}])
    run.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0.0 -0 0\nvn 1 0 0\nf 1//1 2//1 3//1\n")
    flat = "n.obj: " + COLLAPSE.format(3, 3, 0)
    run.ffd("deform", "n.obj", "t.obj", "-l", "l.json", err=[flat])
    check("vn 0.0 -0 0\n" in run.text("t.obj"), run.text("t.obj"))
    run.write("n.obj", run.text("n.obj").replace("f 1//1", "f 1//2"))
    run.ffd("deform", "n.obj", "u.obj", "-l", "l.json", err=["n.obj: 1 normal is kept: the deformation collapses it", flat])


@case
def glb_positions_and_bounds(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json")
    moved = [[p[0] + 1, p[1], p[2]] for p in CUBE_CORNERS]
    equal(glb_positions(run.read("b.glb")), [moved])
    after, _ = glb_split(run.read("b.glb"))
    equal([after["accessors"][0]["min"], after["accessors"][0]["max"]], [[0, -1, -1], [2, 1, 1]])
    asset["accessors"][0]["min"], asset["accessors"][0]["max"] = [0, -1, -1], [2, 1, 1]
    equal(after, asset, "the rest of the JSON")


@case
def spaces_of_gltf(run):
    start(run)
    run.write("l.json", lattice(low=(8, -2, -2), high=(12, 2, 2), moves=MOVE))
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS, nodes=[{"mesh": 0, "translation": [10, 0, 0], "scale": [0.5, 1, 1]}])))
    run.ffd("deform", "a.glb", "scene.glb", "-l", "l.json")
    # One unit in the scene is two of the mesh.
    near(glb_positions(run.read("scene.glb"))[0], [[p[0] + 2, p[1], p[2]] for p in CUBE_CORNERS], 1e-6)
    run.ffd("deform", "a.glb", "mesh.glb", "-l", "l.json", "--space", "mesh", lines=1)
    equal(run.read("mesh.glb"), run.read("a.glb"), "outside in its own space")
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy")
    check(b"\x00\x00\xf8\x7f" not in run.read("e.npy"), "all are inside in the scene")


@case
def gltf_with_a_buffer_of_its_own(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="data%20of.bin")
    run.write("in/a.gltf", asset)
    run.write("in/data of.bin", data)
    run.folder_of("out")
    run.ffd("deform", "in/a.gltf", "out/b.gltf", "-l", "l.json")
    equal(run.names("out"), ["b.bin", "b.gltf"])
    equal(run.read("in/data of.bin"), data, "the input's buffer")
    after = json.loads(run.read("out/b.gltf"))
    equal(after["buffers"][0]["uri"], "b.bin")
    equal(gltf_vectors(after, run.read("out/b.bin"), 0), [[p[0] + 1, p[1], p[2]] for p in CUBE_CORNERS])
    run.ffd("deform", "in/a.gltf", "in/c.gltf", "-l", "l.json")
    equal(run.names("in"), ["a.gltf", "c.bin", "c.gltf", "data of.bin"])
    run.ffd("deform", "in/a.gltf", "out/b.gltf", "-l", "l.json", code=IO)
    run.ffd("deform", "in/a.gltf", "out/b.gltf", "-l", "l.json", "--force")


@case
def resources_of_gltf_are_copied_or_named(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="a.bin")
    asset["images"] = [{"uri": "maps/one.png"}]
    run.write("in/a.gltf", asset)
    run.write("in/a.bin", data)
    run.write("in/maps/one.png", PNG + b"picture")
    for folder in ("copy", "refer", "taken"):
        run.folder_of(folder)
    run.ffd("deform", "in/a.gltf", "copy/b.gltf", "-l", "l.json")
    equal(run.read("copy/maps/one.png"), PNG + b"picture")
    equal(json.loads(run.read("copy/b.gltf"))["images"], asset["images"])
    run.ffd("deform", "in/a.gltf", "refer/b.gltf", "-l", "l.json", "--resources", "reference")
    uri = json.loads(run.read("refer/b.gltf"))["images"][0]["uri"]
    equal(os.path.normpath(os.path.join(run.path("refer"), uri)), run.path("in/maps/one.png"))
    equal(run.names("refer"), ["b.bin", "b.gltf"])
    run.write("taken/maps/one.png", b"another")
    run.ffd("deform", "in/a.gltf", "taken/b.gltf", "-l", "l.json", code=IO)
    equal(run.names("taken"), ["maps"])
    equal(run.read("taken/maps/one.png"), b"another")


@case
def many_to_a_folder(run):
    start(run)
    run.write("sub/b.obj", CUBE)
    run.write("c.glb", glb(*gltf_json(CUBE_CORNERS)))
    run.folder_of("out")
    run.ffd("deform", "a.obj", "sub/b.obj", "c.glb", "--out-dir", "out", "-l", "l.json")
    equal(run.names("out"), ["a.obj", "b.obj", "c.glb"])
    equal(run.read("out/a.obj"), run.read("out/b.obj"))
    run.ffd("deform", "a.obj", "--out-dir", "out/", "-l", "l.json", code=IO,
            err="out/a.obj: exists already (--force overwrites it)")
    run.ffd("deform", "a.obj", "--out-dir", "out/", "-l", "l.json", "--force")


@case
def one_failing_mesh_of_many(run):
    start(run)
    run.write("bad.obj", "v 0 0\n")
    run.write("z.obj", CUBE)
    run.folder_of("out")
    done = run.ffd("deform", "a.obj", "bad.obj", "missing.obj", "z.obj", "--out-dir", "out", "-l", "l.json", "--report",
                   "r.json", code=NO, lines=2)
    check(done.err[0].startswith("bad.obj:1: ") and done.err[1].startswith("missing.obj: "), done.err)
    equal(run.names("out"), ["a.obj", "z.obj"])
    jobs = json.loads(run.read("r.json"))["jobs"]
    equal([(job["input"], job["output"], job["status"], job["exit"]) for job in jobs],
          [("a.obj", "out/a.obj", "ok", OK), ("bad.obj", "out/bad.obj", "failed", INVALID),
           ("missing.obj", "out/missing.obj", "failed", IO), ("z.obj", "out/z.obj", "ok", OK)])
    equal([job["error"] for job in jobs], [None, *done.err, None])


@case
def one_mesh_to_a_folder_has_its_own_code(run):
    start(run)
    run.write("bad.obj", "v 0 0\n")
    run.folder_of("out")
    run.ffd("deform", "bad.obj", "--out-dir", "out", "-l", "l.json", code=INVALID)
    run.ffd("deform", "missing.obj", "--out-dir", "out", "-l", "l.json", code=IO)
    run.ffd("deform", "bad.obj", "--in-place", "-l", "l.json", code=INVALID)


@case
def equal_names_are_refused_before_any_work(run):
    start(run)
    run.write("sub/a.obj", CUBE)
    run.write("b.obj", CUBE)
    run.folder_of("out")
    done = run.ffd("deform", "b.obj", "a.obj", "sub/a.obj", "--out-dir", "out", "-l", "l.json", code=USAGE)
    check("a.obj" in done.err[0] and "sub/a.obj" in done.err[0], done.err)
    equal(run.names("out"), [])
    run.ffd("deform", "a.obj", "b.obj", "a.obj", "--out-dir", "out", "-l", "l.json", code=USAGE, err="a.obj: is named twice")
    run.ffd("deform", "a.obj", "b.obj", "a.obj", "--in-place", "-l", "l.json", code=USAGE, err="a.obj: is named twice")
    equal(run.text("a.obj"), CUBE)


@case
def the_folder_of_many_is_made(run):
    start(run)
    run.write("b.obj", CUBE)
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "x/y", "-l", "l.json")
    equal(run.names("x/y"), ["a.obj", "b.obj"])
    run.ffd("deform", "a.obj", "--out-dir", "one/", "-l", "l.json")
    equal(run.names("one"), ["a.obj"])
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "b.obj", "-l", "l.json", code=IO, err="b.obj: is not a folder")
    run.ffd("deform", "a.obj", "--out-dir", "b.obj/c", "-l", "l.json", code=IO)
    equal(run.text("b.obj"), CUBE)


@case
def other_folders_are_not_made(run):
    """Those of OUT, of a report and of a depfile: who mistypes one gets no file in a place that nobody looks at."""
    start(run)
    for words in (["none/b.obj"], ["b.obj", "--report", "none/r.json"], ["b.obj", "--depfile", "none/b.d"],
                  ["--out-dir", "out", "--report", "none/r.json"], ["--out-dir", "out", "--depfile", "none/b.d"]):
        run.ffd("deform", "a.obj", *words, "-l", "l.json", code=IO)
        equal(run.names(), ["a.obj", "l.json"], words)


@case
def a_job_that_fails_leaves_no_folder(run):
    start(run)
    run.write("broken.obj", "v 1 2\n")
    run.ffd("deform", "a.obj", "--out-dir", "x/y", "-l", "l.json", "--only", "group:none", code=USAGE)
    run.ffd("deform", "broken.obj", "--out-dir", "x/y", "-l", "l.json", code=INVALID)
    run.ffd("deform", "a.obj", "broken.obj", "--out-dir", "x/y", "-l", "l.json", "--timeout", "1e-9", code=NO, lines=2)
    equal(run.names(), ["a.obj", "broken.obj", "l.json"])


@case
def in_place_gives_the_same_file(run):
    start(run)
    run.write("b.obj", CUBE)
    run.ffd("deform", "a.obj", "out.obj", "-l", "l.json")
    run.ffd("deform", "a.obj", "b.obj", "--in-place", "-l", "l.json")
    equal(run.read("a.obj"), run.read("out.obj"))
    equal(run.read("b.obj"), run.read("out.obj"))
    equal(run.names(), ["a.obj", "b.obj", "l.json", "out.obj"])
    run.ffd("deform", "a.obj", "--in-place", "--force", "-l", "l.json")
    check(run.read("a.obj") != run.read("out.obj"), "the second time moves again")


@case
def in_place_gltf(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="own.bin")
    run.write("m/a.gltf", asset)
    run.write("m/own.bin", data)
    run.ffd("deform", "m/a.gltf", "--in-place", "-l", "l.json")
    after = json.loads(run.read("m/a.gltf"))
    buffer = run.read("m/" + after["buffers"][0]["uri"])
    equal(gltf_vectors(after, buffer, 0), [[p[0] + 1, p[1], p[2]] for p in CUBE_CORNERS])


@case
def the_report_counts_what_was_told(run):
    start(run, high=(2, 2, 0))
    run.write("l.json", lattice(high=(2, 2, 0), moves=MOVE))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "r.json", lines=2)
    report = json.loads(run.read("r.json"))
    equal([report["format"], report["version"], len(report["jobs"])], ["ffd-report", 1, 1])
    job = report["jobs"][0]
    equal(list(job), ["input", "output", "outputs", "status", "exit", "error", "vertices", "inside", "outside", "multiple", "singular",
                      "invalid", "unused", "hidden", "morph_targets", "moved", "shared_faces", "residual", "iterations", "folds", "flipped_faces", "tear", "volume", "area", "det", "edges",
                      "bounds", "displacement", "behind", "seconds"])
    equal([job[key] for key in ("input", "output", "status", "exit", "error")], ["a.obj", "b.obj", "ok", 0, None])
    equal([job[key] for key in ("vertices", "inside", "outside", "multiple", "singular", "invalid", "moved")],
          [8, 4, 4, 0, 0, 0, 4])
    equal(job["bounds"]["before"], {"min": [-1, -1, -1], "max": [1, 1, 1]})
    near(job["bounds"]["after"]["max"], [2, 1, 1], 1e-15)
    near([job["displacement"]["max"]], [1], 1e-15)
    near([job["displacement"]["rms"]], [math.sqrt(0.5)], 1e-15)
    check(0 <= job["residual"]["rms"] <= job["residual"]["max"] < 1e-14, job["residual"])
    equal(set(job["seconds"]), {"read", "embed", "deform", "judge", "write"})
    check(all(value >= 0 for value in job["seconds"].values()), job["seconds"])


@case
def residuals_are_of_the_vertices_with_a_place(run):
    axes = {"box": {"min": [-1, -1, -1], "max": [1, 1, 1], "axes": [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]}}
    run.write("l.json", lattice(moves=MOVE, rest=axes))
    points = [[math.sin(7 * i + a) / 2 for a in range(3)] for i in range(200)]
    found = []
    for beyond in ([], [[9, 9, 9 + i] for i in range(600)]):
        run.write("p.obj", "".join("v %r %r %r\n" % tuple(p) for p in points + beyond))
        run.ffd("deform", "p.obj", "q.obj", "-l", "l.json", "--report", "r.json", "--force", "-q")
        found.append(json.loads(run.read("r.json"))["jobs"][0]["residual"])
    check(0 < found[0]["rms"] < 0.8 * found[0]["max"] < 1e-14, found)
    equal(found[1]["max"], found[0]["max"])
    near([found[1]["rms"] / found[0]["rms"]], [1], 1e-12)


@case
def report_that_is_stable(run):
    start(run, BUMP)
    texts = set()
    for n in range(3):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--report", "r.json", "--report-stable", "-j", str(n + 1))
        texts.add(run.read("r.json"))
    equal(len(texts), 1)
    check("seconds" not in json.loads(texts.pop())["jobs"][0], "seconds")


@case
def report_on_standard_output(run):
    start(run)
    equal(run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "-").json["jobs"][0]["moved"], 8)
    run.ffd("deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json", "--report", "-", code=USAGE)
    failed = run.ffd("deform", "none.obj", "c.obj", "-l", "l.json", "--report=-", code=IO, data=True)
    equal(failed.json["jobs"][0]["error"], failed.err[0])


@case
def report_that_cannot_be_written(run):
    start(run)
    run.folder_of("folder")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "none/r.json", code=IO)
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--report", "folder", code=IO)
    for name in ("a.obj", "d.obj", "l.json"):
        run.ffd("deform", "a.obj", "d.obj", "-l", "l.json", "--report", name, code=USAGE)
    equal([run.text("a.obj"), run.exists("d.obj")], [CUBE, False])


@case
def verbose_and_quiet(run):
    start(run)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "-v", err="a.obj: 8 of 8 vertices moved, by 1 at most")
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "-v", "-q", err=[])
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "-q", code=IO)


@case
def threads_change_nothing(run):
    start(run, BUMP)
    outputs = set()
    for n in ("1", "2", "5", "1024"):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--threads", n)
        outputs.add(run.read("b.obj"))
    equal(len(outputs), 1)


main()
