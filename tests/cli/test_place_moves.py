#!/usr/bin/env python3
"""Moves that name places: what falls short of what it asks is said in one line; planes of mirrors that do not fit the mesh;
fractions of the mesh itself."""
import json
import os
import random
import re
import struct

from gltf_build import Scene
from harness import INVALID, case, check, equal, lattice, main, near, obj_of, obj_vertices
from messages import anything, lines_with, no_line, one_line

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data")


def deform(run, **members):
    run.write("l.json", json.dumps(members) if "rest" in members else lattice(**members))
    return run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=anything)


def round_mesh(moves, margin=0, **members):
    return {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh", "margin": margin}, "moves": moves, **members}


GRID = [[x, y, z] for z in (0, 0.5, 1) for y in (0, 0.5, 1) for x in (0, 0.5, 1)]
UNIT = {"low": [0, 0, 0], "high": [1, 1, 1]}


@case
def a_pull_that_falls_short_is_one_line(run):
    """With both lengths and the distance of the layers; where no vertex moves, that line alone."""
    run.write("a.obj", obj_of(GRID))
    pull = {"point": [0.5, 0.5, 0.5], "by": [0, 0.3, 0]}
    done = deform(run, moves=[{"pull": {**pull, "radius": 0.4}}], **UNIT)
    found = obj_vertices(run.text("b.obj"))[13][1] - 0.5
    check(0 < found < 0.15, found)
    equal(done.err, [f"a.obj: l.json: /moves/0: asked 0.3, the mesh moves {found:.3g}: the layers are 0.333 apart"])
    done = deform(run, moves=[{"pull": {**pull, "radius": 0.1}}], **UNIT)
    equal(done.err, ["a.obj: l.json: /moves/0: asked 0.3, the mesh moves 0: the layers are 0.333 apart"])
    equal(run.read("b.obj"), run.read("a.obj"))
    # Half of it is enough; a weight is a part of what is asked.
    equal(deform(run, moves=[{"pull": {**pull, "radius": 1}}], **UNIT).err, [])
    equal(deform(run, moves=[{"weight": 0.01, "pull": {**pull, "radius": 1}}], **UNIT).err, [])
    done = deform(run, moves=[{"weight": 0.5, "pull": {**pull, "radius": 0.4}}], **UNIT)
    one_line(done, "asked 0.15, the mesh moves")
    # The move that falls short most, and how many more do. Other moves do not count as its own.
    done = deform(run, moves=[{"by": [0, 1, 0]}, {"pull": {**pull, "radius": 0.4}}, {"pull": {**pull, "radius": 0.3}}], **UNIT)
    one_line(done, r"^a\.obj: l\.json: /moves/2: asked 0\.3, the mesh moves 0\.000694: .* \(1 more move falls short\)$")
    # A place beyond the volume is not judged.
    no_line(deform(run, moves=[{"pull": {"point": [0.5, 1.5, 0.5], "by": [0, 0.3, 0], "radius": 0.8}}], **UNIT), "asked")
    # In fractions of a box with sides 2, 4, 1 lengths are those of the world.
    done = deform(run, size=(4, 4, 4), low=[0, 0, 0], high=[2, 4, 1], units="box", moves=[
        {"pull": {"point": [0.5, 0.5, 0.5], "by": [0, 0.25, 0], "radius": 0.4}}])
    one_line(done, r"asked 1, the mesh moves 0\.\d+: the layers are 1\.33 apart$")
    # Each command tells it, and a batch for each job.
    run.ffd("check", "a.obj", "-l", "l.json", err=anything)
    run.write("m.jsonl", "".join(json.dumps({"in": "a.obj", "lattice": "l.json", "out": name}) + "\n" for name in ("c.obj", "d.obj")))
    equal(len(lines_with(run.ffd("batch", "m.jsonl", err=anything), "asked 1, the mesh moves")), 2)


@case
def a_falloff_round_a_centre_is_judged_there(run):
    run.write("a.obj", obj_of(GRID))
    ball = {"center": [0.5, 0.5, 0.5], "radius": 0.35}
    done = deform(run, moves=[{"falloff": ball, "by": [0, 0, 0.2]}], **UNIT)
    found = obj_vertices(run.text("b.obj"))[13][2] - 0.5
    equal(done.err, [f"a.obj: l.json: /moves/0: asked 0.2, the mesh moves {found:.3g}: the layers are 0.333 apart"])
    # A turn about the centre asks for nothing there; one about another place for a chord: 2 sin 45 degrees times 0.5.
    no_line(deform(run, moves=[{"falloff": ball, "rotate": {"axis": "z", "degrees": 90, "about": [0.5, 0.5, 0]}}], **UNIT), "asked")
    done = deform(run, moves=[{"falloff": ball, "rotate": {"axis": "z", "degrees": 90, "about": [0, 0.5, 0]}}], **UNIT)
    one_line(done, "asked 0.707, the mesh moves")
    # A falloff along an axis has no place.
    no_line(deform(run, moves=[{"falloff": {"axis": "x", "from": 0, "to": 0.1}, "by": [0, 0, 1]}], **UNIT), "asked")
    # Mirrored onto itself it does twice as much as one.
    run.write("l.json", lattice(moves=[{"mirror": {"axis": "x", "at": 0.5}, "falloff": ball, "by": [0, 0, 0.2]}], **UNIT))
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", err=anything)
    near([obj_vertices(run.text("c.obj"))[13][2] - 0.5], [2 * found], 1e-15)


@case
def a_drag_that_misses_is_one_line(run):
    run.write("a.obj", obj_of(GRID))
    two = [{"point": [0.5, 0.5, 0.5], "by": [0, 0.3, 0]}, {"point": [0.5, 0.5, 0.5], "by": [0, 0.1, 0]}]
    done = deform(run, moves=[{"by": [1, 0, 0]}, {"drag": two}], **UNIT)
    near(obj_vertices(run.text("b.obj"))[13], [1.5, 0.7, 0.5], 1e-14)
    equal(done.err, ["a.obj: l.json: /moves/1: the control points cannot take all places as far as the drag asks: the largest miss "
                     "is 0.1 of 0.3, at 0.5 0.5 0.5"])
    equal(deform(run, moves=[{"drag": two[:1]}, {"drag": two[1:]}], **UNIT).err, [])
    near(obj_vertices(run.text("b.obj"))[13], [0.5, 0.9, 0.5], 1e-14)


def figure(shift=0.0, beside=0):
    """A cloud that is symmetric to x = shift, and vertices beside it that are not."""
    draw = random.Random(3)
    half = [[draw.uniform(0.01, 1), draw.uniform(0, 2), draw.uniform(-1, 1)] for _ in range(500)]
    return [[shift + s * x, y, z] for s in (1, -1) for x, y, z in half] + [[shift + 2 + 0.1 * i, 1, 0] for i in range(beside)]


@case
def the_middle_of_a_mesh_that_is_not_symmetric_is_said(run):
    """Fewer than 99 in 100 vertices with an image; not where a plane is named."""
    pull = {"point": [0.5, 1, 0], "by": [0, 0, 0.4], "radius": 1.5}
    for beside, wanted in ((0, False), (100, True)):
        run.write("a.obj", obj_of(figure(0.25, beside)))
        done = deform(run, **round_mesh([{"mirror": "x", "pull": pull}]))
        middle = 0.25 + (0 if not beside else (2 + 0.1 * 99 - max(abs(x - 0.25) for x, _, _ in figure(0.25))) / 2)
        found = lines_with(done, "mirror")
        equal(len(found), int(wanted), str(done.err))
        if wanted:
            check(found[0].startswith('a.obj: "mirror": "x" in l.json takes the middle of its box, the plane x = '), found)
            near([float(found[0].split("x = ")[1].split(",")[0])], [middle], 1e-9)
            check('{"axis": "x", "at": 0} names a plane' in found[0], found)
        no_line(deform(run, **round_mesh([{"mirror": {"axis": "x", "at": 0.25}, "pull": pull}])), "mirror")
        no_line(deform(run, **round_mesh([{"mirror": {"point": [0.25, 0, 0], "normal": "x"}, "pull": pull}])), "mirror")
    # 1000 vertices and the two that pin the box: ten without an image are 99 in 100, eleven are fewer.
    corners = [[-3, 0, -2], [3, 0, -2]]
    for lonely, wanted in ((9, 0), (12, 1)):
        run.write("a.obj", obj_of(figure() + corners + [[0.02 + 0.05 * i, 0.5, 5] for i in range(lonely)]))
        equal(len(lines_with(deform(run, **round_mesh([{"mirror": "x", "by": [0, 0, 0.1]}])), "mirror")), wanted, f"{lonely} vertices")
    # Within 1e-3 of the diagonal is an image. One line for each lattice and axis, of the vertices as it gets them.
    draw = random.Random(5)
    run.write("a.obj", obj_of([[x + draw.uniform(-1, 1) * 1e-3, y, z] for x, y, z in figure()] + corners))
    no_line(deform(run, **round_mesh([{"mirror": "x", "by": [0, 0, 0.1]}])), "mirror")
    run.write("a.obj", obj_of(figure()))
    run.write("skew.json", lattice(low=[-2, -1, -2], high=[2, 3, 2], moves=[{"at": ["top", "all", "all"], "by": [2, 0, 0]}]))
    run.write("l.json", round_mesh([{"mirror": "x", "pull": pull}, {"mirror": "x", "by": [0, 0, 0.1]}]))
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "skew.json", "-l", "l.json", "--force", err=anything)
    equal(len(lines_with(done, '"mirror": "x" in l.json')), 1, str(done.err))


@case
def positions_of_several_parts_count_once(run):
    """Two primitives share them, with normals of their own. Behind another lattice the vertices of the parts after them once were
    looked for beyond the list."""
    made = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
    points = figure()
    shared, right, left = (made.add(rows, bounds=True) for rows in (points, points[:500], points[500:]))
    normals = [made.add([[0.0, y, 1.0 - y]] * len(points)) for y in (0.0, 1.0)]
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": shared, "NORMAL": normal}, "mode": 0} for normal in normals] +
                             [{"attributes": {"POSITION": half}, "mode": 0} for half in (right, left)]}]
    run.write("a.glb", made.glb())
    run.write("up.json", lattice(low=[-2, -1, -2], high=[2, 4, 2], moves=[{"by": [0, 0.5, 0]}]))
    run.write("l.json", round_mesh([{"mirror": "x", "by": [0, 0, 0.1]}]))
    for before in ([], ["-l", "up.json"]):
        no_line(run.ffd("check", "a.glb", *before, "-l", "l.json", err=anything), "mirror")


def morphed(weights=None):
    """A man of height 2 on the floor, whose morph targets reach below it and far above."""
    made = Scene(nodes=[{"mesh": 0}], scene=0)
    made.asset["scenes"] = [{"nodes": [0]}]
    points = [[x, y, z] for y in (0.0, 1.0, 2.0) for x in (-0.5, 0.5) for z in (-0.25, 0.25)]
    primitive = {"attributes": {"POSITION": made.add(points, bounds=True)},
                 "targets": [{"POSITION": made.add([[0.0, by, 0.0]] * len(points), bounds=True)} for by in (-3.0, 7.0)]}
    made.asset["meshes"] = [{"primitives": [primitive], **({"weights": weights} if weights else {})}]
    return made, points


@case
def a_foot_stays_on_the_floor(run):
    """The sample lattice `taller`, with any margin, and of a mesh with morph targets: its own shape counts, as default weights
    show it."""
    with open(os.path.join(DATA, "lattices", "taller.json"), encoding="utf-8") as file:
        taller = json.load(file)
    equal(taller["units"], "mesh")
    for margin in (0, taller["rest"]["margin"], 0.3, [0.05, 0, 0.2]):
        taller["rest"]["margin"] = margin
        run.write("taller.json", json.dumps(taller))
        run.write("a.obj", obj_of([[x, y + 1, z] for x, y, z in GRID]))
        run.ffd("deform", "a.obj", "b.obj", "-l", "taller.json", "--force", err=anything)
        near(sum(obj_vertices(run.text("b.obj")), []), sum(([x, 1 + 1.4 * y, z] for x, y, z in GRID), []), 1e-14, str(margin))
        for weights, floor, height in ((None, 0.0, 2.0), ([1, 0], -3.0, 2.0), ([0, 0.5], 3.5, 2.0)):
            made, points = morphed(weights)
            run.write("a.glb", made.glb())
            box = run.ffd("info", "a.glb", "--json", err=anything).json["bounds"]
            near([box["min"][1], box["max"][1]], [floor, floor + height], 1e-6)
            run.ffd("deform", "a.glb", "b.glb", "-l", "taller.json", "--force", err=anything)
            box = run.ffd("info", "b.glb", "--json", err=anything).json["bounds"]
            near([box["min"][1], box["max"][1]], [floor, floor + 1.4 * height], 2e-6, f"margin {margin}, weights {weights}")
    # Boxes round named meshes, and of several inputs together.
    run.write("p.obj", obj_of([[0, 1, 0], [1, 2, 1]]))
    run.write("q.obj", obj_of([[0, 3, 0], [1, 5, 1]]))
    run.write("named.json", json.dumps({**taller, "rest": {"box": {"meshes": ["p.obj", "q.obj"]}, "margin": 0.1}}))
    run.ffd("deform", "p.obj", "b.obj", "-l", "named.json", "--force", err=anything)
    near(obj_vertices(run.text("b.obj"))[1], [1, 1 + 1.4, 1], 1e-14)
    run.ffd("deform", "p.obj", "q.obj", "--out-dir", "o", "-l", "taller.json", "--shared-box", err=anything)
    near(sum(obj_vertices(run.text("o/q.obj")), []), [0, 1 + 1.4 * 2, 0, 1, 1 + 1.4 * 4, 1], 1e-14)


@case
def fractions_of_a_mesh_need_one(run):
    run.write("a.obj", obj_of(GRID))
    run.write("l.json", {**lattice(), "units": "mesh"})
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", code=INVALID, err='l.json:1: /units: "mesh" needs a rest box round a mesh: '
            '{"box": "mesh"} or {"meshes": [..]}')


@case
def info_names_what_options_ask_for(run):
    made, _ = morphed()
    asset = made.asset
    asset["meshes"][0]["extras"] = {"targetNames": ["low", "high"]}
    asset["meshes"].append({"primitives": asset["meshes"][0]["primitives"], "extras": {"targetNames": ["low"]}})
    asset["nodes"] += [{"name": "hip", "children": [2]}, {"name": "knee"}, {"mesh": 1, "camera": 0}]
    asset["scenes"] = [{"nodes": [0, 1, 3], "name": "stage"}, {"nodes": []}]
    asset["skins"] = [{"joints": [2, 1]}, {"joints": [2]}]
    asset["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                        {"name": "side", "type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
    times, turns = made.add([[0.0], [0.5], [1.125]], shape="SCALAR", bounds=True), made.add([[0.0, 0.0, 0.0, 1.0]] * 3, shape="VEC4")
    channels = [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]
    asset["animations"] = [{"name": "walk", "samplers": [{"input": times, "output": turns}], "channels": channels},
                           {"samplers": [{"input": 99, "output": turns}], "channels": channels}]
    run.write("a.glb", made.glb())
    told = run.ffd("info", "a.glb", "--json", err=anything, data=True).json
    equal(told["morph_targets"], ["low", "high", None])
    equal(told["joints"], ["hip", "knee"])
    equal(told["cameras"], [None, "side"])
    equal(told["scenes"], ["stage", None])
    equal(told["animations"], [{"name": "walk", "seconds": 1.125}, {"name": None, "seconds": None}])
    text = run.ffd("info", "a.glb", err=anything, data=True).text
    for line in ("  walk  *1.125 s", "morph targets  *low, high, \\(no name\\)", "joints  *hip, knee", "cameras  *\\(no name\\), side"):
        check(len(re.findall(f"(?m)^{line}$", text)) == 1, line, text)
    # Numbers of people have six digits, those of programs all.
    run.write("a.obj", obj_of([[0.123456789, 0, 0], [1, 2, 1e-9 / 3]]))
    check("0.123457 0 0\n" in run.ffd("info", "a.obj", err=anything, data=True).text, "six digits")
    told = run.ffd("info", "a.obj", "--json", err=anything, data=True).json
    equal(told["bounds"]["min"][0], 0.123456789)
    equal([told[key] for key in ("animations", "morph_targets", "joints", "cameras", "scenes")], [[]] * 5)


@case
def times_that_samplers_share_are_read_once(run):
    """Minutes, where each of 100,000 samplers read two million times."""
    count = 2000000
    made, _ = morphed()
    times = made.view_accessor(made.view(struct.pack(f"<{count}f", *range(count))), [[0.0], [float(count - 1)]], "SCALAR", 5126, True)
    made.asset["accessors"][times]["count"] = count
    turns = made.add([[0.0, 0.0, 0.0, 1.0]] * 3, shape="VEC4")
    made.asset["animations"] = [{"samplers": [{"input": times, "output": turns}] * 100000,
                                 "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]
    run.write("a.glb", made.glb())
    told = run.ffd("info", "a.glb", "--json", err=anything, data=True).json
    equal(told["animations"], [{"name": None, "seconds": count - 1}])


main()
