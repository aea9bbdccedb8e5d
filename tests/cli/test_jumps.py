#!/usr/bin/env python3
"""Jumps of the displacement where both ends of an edge move: between blocks, between parts of a border, at axes and
overlaps. Each figure is worked out by hand."""
import math
import random

from harness import NO, case, check, equal, gltf_json, glb, lattice, main, near, obj_of, threaded_case
from page import Page
from messages import anything, counts, entry, no_line, one_line

UP, DOWN = [{"by": [0, 0, 0.3]}], [{"by": [0, 0, -0.3]}]


def both(*names):
    return [word for name in names for word in ("-l", name)]


def box(run, name, low, high, moves, size=(3, 3, 3)):
    run.write(name, lattice(size=size, low=low, high=high, moves=moves))


def side_by_side(run, *parts):
    """Boxes along x, from y and z 0 to 1: (from, to, moves). Returns the options."""
    names = [f"{n}.json" for n in range(len(parts))]
    for name, (first, last, moves) in zip(names, parts):
        box(run, name, (first, 0, 0), (last, 1, 1), moves)
    return both(*names) + ["--blocks"]


def square(run, first, last, name="a.obj"):
    """Two edges lead along x from first to last, at y = 0.2 and 0.8."""
    run.write(name, f"v {first} 0.2 0.5\nv {last} 0.2 0.5\nv {last} 0.8 0.5\nv {first} 0.8 0.5\nf 1 2 3 4\n")


def torn(run, edges, largest, *options, mesh="a.obj", tolerance=1e-12):
    """What check and deform report. Returns the member, and what deform says."""
    out = "out" + mesh[mesh.index("."):]
    found = [entry(run, *command, *options)["tear"] for command in (["check", mesh], ["deform", mesh, out])]
    equal(found[1], found[0], "check and deform")
    equal(found[0]["edges"], edges, "torn edges")
    near([found[0]["largest"]], [largest], tolerance, "the largest step")
    done = run.ffd("deform", mesh, out, *options, "--force", err=anything)
    (one_line if edges else no_line)(done, "the largest step to a neighbour is")
    return found[0], done


@case
def blocks_that_move_their_common_face_apart(run):
    """No vertex lies on the face, as in most meshes. Where they move alike nothing is torn."""
    square(run, 0.5, 1.5)
    options = side_by_side(run, (0, 1, UP), (1, 2, DOWN))
    found, done = torn(run, 2, 0.6, *options)
    equal(found["vertex"], 1, "an end in the later one")
    one_line(done, "blocks", "differently", r"\b0\.6\b", r"\b2 torn edges\b", "move alike")
    for gate, code in (("tear", NO), ("tear=0.59", NO), ("tear=0.61", 0)):
        run.ffd("deform", "a.obj", "gated.obj", *options, "--fail-on", gate, "--force", code=code, err=anything)
        equal(run.exists("gated.obj"), code == 0, gate)
    text = run.ffd("check", "a.obj", *options, err=anything).text
    check("neighbouring blocks move their common faces differently" in text, text)
    torn(run, 0, 0, *side_by_side(run, (0, 1, UP), (1, 2, UP)))


@case
def a_threshold_holds_between_blocks(run):
    for step, edges in ((0.0009, 0), (0.0011, 2)):
        square(run, 0.5, 1.5)
        torn(run, edges, step if edges else 0, *side_by_side(run, (0, 1, []), (1, 2, [{"by": [0, 0, step]}])))


@case
def a_field_that_goes_on_is_not_torn(run):
    """z grows by x/2 in both; then by x in the second, from 1/2 on the face; then from 3/4 on."""
    def lean(slope, shift=0.0):
        return [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, slope, 0, 1, shift, 0, 0, 0, 1]}]

    square(run, 0.4, 1.7)
    torn(run, 0, 0, *side_by_side(run, (0, 1, lean(0.5)), (1, 2, lean(0.5))))
    torn(run, 0, 0, *side_by_side(run, (0, 1, lean(0.5)), (1, 2, lean(1, -0.5))))
    torn(run, 2, 0.25, *side_by_side(run, (0, 1, lean(0.5)), (1, 2, lean(1, -0.25))))


@case
def across_a_gap(run):
    """From one block to another with nothing between. What moves alike is not torn; at its ends each goes with its own."""
    square(run, 0.5, 2.5)
    torn(run, 2, 0.6, *side_by_side(run, (0, 1, UP), (2, 3, DOWN)))
    torn(run, 0, 0, *side_by_side(run, (0, 1, UP), (2, 3, UP)))


@case
def across_a_gap_one_after_the_other(run):
    """Boxes that are no blocks: in the gap those of the nearer end act."""
    square(run, 0.5, 2.5)
    box(run, "first.json", (0, 0, 0), (1, 1, 1), UP)
    for moves, edges, largest in ((DOWN, 2, 0.6), (UP, 0, 0)):
        box(run, "second.json", (2, 0, 0), (3, 1, 1), moves)
        torn(run, edges, largest, *both("first.json", "second.json"))


@case
def out_of_the_lattice_that_follows(run):
    """The first ends at x = 0, and lifts by 2 + 3.6 x along y, there out of the second, which leans with y and ends at 1.5. Both
    ends are in the second: one of its displacements stands for both sides of the border."""
    run.write("a.obj", obj_of([[-0.5, 0, 0], [0.5, 0, 0]]) + "f 1 2 1\n")
    box(run, "lift.json", (-2, -9, -9), (0, 9, 9), [{"matrix": [1, 0, 0, 0, 3.6, 1, 0, 2, 0, 0, 1, 0, 0, 0, 0, 1]}])
    box(run, "lean.json", (-9, -9, -9), (9, 1.5, 9), [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1]}])
    torn(run, 1, 2, *both("lift.json", "lean.json"), tolerance=1e-9)


@case
def through_a_block(run):
    """From the first into the third of three; both move alike, and the one between otherwise. The edge jumps there and
    back. The same where the ends are in one block, and an earlier one is within it."""
    square(run, 0.5, 2.5)
    torn(run, 2, 0.6, *side_by_side(run, (0, 1, UP), (1, 2, DOWN), (2, 3, UP)))
    torn(run, 0, 0, *side_by_side(run, (0, 1, UP), (1, 2, UP), (2, 3, UP)))
    found = entry(run, "check", "a.obj", *side_by_side(run, (1, 2, DOWN), (0, 3, UP)))["tear"]
    equal([found["edges"], found["largest"]], [2, 0.6])


@case
def through_a_box_within_another(run):
    """Lattices one after the other: the second lifts the middle of what the first one moves along x, where that comes to lie.
    The edge passes it from 0.9 to 1.1, which is a twentieth of it."""
    square(run, 0, 4)
    box(run, "all.json", (-9, -9, -9), (9, 9, 9), [{"by": [0.5, 0, 0]}])
    box(run, "some.json", (1.4, -9, -9), (1.6, 9, 9), UP)
    for order in (("all.json", "some.json"), ("some.json", "all.json")):
        found = entry(run, "check", "a.obj", *both(*order))["tear"]
        equal([found["edges"], found["largest"]], [2, 0.3], order)


@case
def round_one_corner(run):
    """Four blocks round x = y = 1 that lift by 0, 1, 2 and 4. One edge leads from the first through the corner into the last,
    one passes beside it through the second, and one lies in the first."""
    names = []
    for n, lift in enumerate((0, 1, 2, 4)):
        names.append(f"{n}.json")
        x, y = n % 2, n // 2
        box(run, names[-1], (x, y, 0), (x + 1, y + 1, 1), [{"by": [0, 0, lift]}])
    for points, largest in (([[0.5, 0.5], [1.5, 1.5]], 4), ([[0.5, 0.45], [1.5, 1.45]], 3), ([[0.45, 0.5], [1.45, 1.5]], 2),
                            ([[0.5, 0.9], [1.5, 0.8]], 1)):
        run.write("a.obj", obj_of([p + [0.5] for p in points]) + "f 1 2 1\n")
        torn(run, 1, largest, *both(*names), "--blocks", tolerance=1e-9)


@case
def what_is_not_selected_would_move_as_its_block(run):
    """--only: the end that is not selected is in the other block, and would go with that."""
    run.write("a.obj", "v 0.5 0.2 0.5\nv 0.5 0.8 0.5\nv 0.75 0.5 0.5\nv 1.5 0.5 0.5\ng one\nf 1 2 3\ng two\nf 2 3 4\n")
    options = side_by_side(run, (0, 1, UP), (1, 2, [{"by": [0, 0, 0.5]}]))
    torn(run, 2, 0.2, *options)
    found, done = torn(run, 2, 0.5, *options, "--only", "group:one")
    equal(found["vertex"], 3)
    one_line(done, "--only does not select")


@case
def blocks_of_which_another_becomes_the_nearest(run):
    """--outside extend: between two blocks that lift by 0.3 and lower by as much the nearest border changes at x = 2, one
    away from both. A falloff leaves of each what it says there, and none that is shorter than that way is torn."""
    square(run, 1.5, 2.5)
    options = side_by_side(run, (0, 1, UP), (3, 4, DOWN)) + ["--outside", "extend"]
    found, done = torn(run, 2, 0.6, *options)
    equal(found["vertex"], 1)
    one_line(done, "blocks")
    torn(run, 2, 0.6 * fade(1 / 1.5), *options, "--falloff", "1.5")
    torn(run, 0, 0, *options, "--falloff", "0.9")
    # Both ends follow the first, beside the second.
    square(run, -2, -1)
    torn(run, 0, 0, *options)


def fade(s):
    return 1 - s ** 3 * (10 - 15 * s + 6 * s * s)


def horseshoe(run, moves, name="l.json", gap=1.0):
    """Arms along y from -2 to 0, at x from gap to gap + 1 and mirrored, which a half ring joins; z from -1/2 to 1/2. Degree 1
    along it, so that the arms are straight."""
    line = [(-1, -2.0), (-1, -1.0), (-1, 0.0)] + [(-math.cos(math.pi * n / 6), math.sin(math.pi * n / 6)) for n in range(1, 6)]
    line += [(1, 0.0), (1, -1.0), (1, -2.0)]
    points = [[r * x, r * y if y > 0 else y, z] for z in (-0.5, 0.5) for r in (gap, gap + 1) for x, y in line]
    run.write(name, lattice(size=(11, 2, 2), degree=[1, 1, 1], rest={"points": points}, moves=moves))


ARM = [{"at": [[0, 2], "all", "all"], "by": [0, 0, 1]}]


def between_the_arms(run, reach, name="a.obj"):
    run.write(name, f"v {-reach} -1.5 0\nv {reach} -1.5 0\nv {reach} -1.2 0\nv {-reach} -1.2 0\nf 1 2 3 4\n")


@case
def between_the_arms_of_a_horseshoe(run):
    """The nearest border changes from one arm to the other at x = 0. The figures of det F do not show it. A falloff leaves of
    the one arm what it says at a distance of 1."""
    horseshoe(run, ARM)
    for reach in (0.2, 0.05, 0.99):
        between_the_arms(run, reach)
        found, done = torn(run, 2, 1, "-l", "l.json", "--outside", "extend", tolerance=1e-9)
        one_line(done, "border", "--falloff", r"\b2 torn edges\b")
    judged = entry(run, "check", "a.obj", "-l", "l.json", "--outside", "extend")
    equal(judged["det"]["outside"], 1)
    torn(run, 2, fade(0.8), "-l", "l.json", "--outside", "extend", "--falloff", "1.25", tolerance=1e-9)
    torn(run, 0, 0, "-l", "l.json", "--outside", "extend", "--falloff", "0.95")
    text = run.ffd("check", "a.obj", "-l", "l.json", "--outside", "extend", err=anything).text
    check("the nearest part of the lattice's border changes" in text, text)
    run.ffd("deform", "a.obj", "gated.obj", "-l", "l.json", "--outside", "extend", "--fail-on", "tear=0.99", code=NO, err=anything)
    check(not run.exists("gated.obj"), "it is written all the same")
    # All of it lifted: no jump, whatever becomes the nearest.
    horseshoe(run, [{"by": [0, 0, 1]}])
    torn(run, 0, 0, "-l", "l.json", "--outside", "extend")


@case
def vertices_that_stay_between_the_arms(run):
    """Without extend what lies between them stays, and so do the figures: the step is that of the nearest border."""
    horseshoe(run, ARM)
    run.write("a.obj", "v -1.5 -1.5 0\nv -0.5 -1.5 0\nv -0.5 -1.2 0\nv 0.5 -1.5 0\nv 1.5 -1.5 0\nv 0.5 -1.2 0\nf 1 2 3\nf 5 6 4\n")
    equal(torn(run, 2, 1, "-l", "l.json", tolerance=1e-9)[0]["vertex"], 1)
    # An edge that leaves a volume and comes back to it is within one map.
    between_the_arms(run, 1.25)
    torn(run, 0, 0, "-l", "l.json")


def judged(run, edges, largest, *options):
    """What is counted where the figures are asked for."""
    for command in (["check", "a.obj"], ["deform", "a.obj", "out.obj"]):
        found = entry(run, *command, *options)["tear"]
        equal([found["edges"], found["vertex"]], [edges, 1 if edges else None])
        near([found["largest"]], [largest], 1e-9)
    run.ffd("deform", "a.obj", "gated.obj", *options, "--force", "--fail-on", "tear", code=NO if edges else 0, err=anything)


@case
def what_moves_one_end_jumps_on_its_way_to_the_one_that_stays(run):
    """The arm that moves is left at x = -1, and the end that stays lies nearer to the other one, which does not move."""
    horseshoe(run, ARM)
    for first, last in ((-1.5, 0.3), (-1.9, 0.9)):
        run.write("a.obj", f"v {first} -1.5 0\nv {last} -1.5 0\nv {last} -1.2 0\nv {first} -1.2 0\nf 1 2 3 4\n")
        judged(run, 2, 1, "-l", "l.json")
    # From the other arm the nearest border changes nothing where both stay; all lifted: one step, that of the border.
    run.write("a.obj", "v 1.5 -1.5 0\nv 0.3 -1.5 0\nv 0.3 -1.2 0\nv 1.5 -1.2 0\nf 1 2 3 4\n")
    judged(run, 0, 0, "-l", "l.json")


@case
def from_block_to_block_and_out(run):
    """The end that stays is beside the second block, whose far face does not move. The jump is on the common face."""
    square(run, 0.5, 2.5)
    fades = [{"at": [0, "all", "all"], "by": [0, 0, -0.3]}]
    judged(run, 2, 0.6, *side_by_side(run, (0, 1, UP), (1, 2, fades)))
    judged(run, 0, 0, *side_by_side(run, (0, 1, [{"at": [-1, "all", "all"], "by": [0, 0, -0.3]}]), (1, 2, fades)))


@case
def lattices_one_after_the_other_extend(run):
    """A box before or after the horseshoe moves all it extends to by 5 along z, or turns it about z."""
    horseshoe(run, ARM)
    between_the_arms(run, 0.2)
    box(run, "far.json", (-9, -9, -9), (-8, -8, -8), [{"by": [0, 0, 0.25]}])
    for order in (("l.json", "far.json"), ("far.json", "l.json")):
        torn(run, 2, 1, *both(*order), "--outside", "extend", tolerance=1e-9)


DIAMOND = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]


def ring(run, moves, rays=None, radii=(1.0, 2.0), knots="clamped"):
    """About z, z from 0 to 1: straight from ray to ray; closed, without a seam, if knots are."""
    rays = DIAMOND if rays is None else rays
    points = [[r * x, r * y, h] for h in (0.0, 1.0) for x, y in rays for r in radii]
    run.write("l.json", lattice(size=(2, len(rays), 2), degree=[1, 1, 1], knots=["clamped", knots, "clamped"],
                                rest={"points": points}, moves=moves))


@case
def in_the_hole_of_a_ring(run):
    """The first ray lifts by 2. From 0.1 0.3 the nearest side of the diamond is the first one, and beyond x = 0 the second,
    which does not move: at 0 0.3 the foot on the first side is 0.35 0.65, and goes up by 2 * 0.35. With a seam there is the
    same jump, and no other."""
    run.write("a.obj", obj_of([[0.1, 0.3, 0.5], [-0.1, 0.3, 0.5], [-0.3, 0.3, 0.25]]) + "f 1 2 3\n")
    for rays, knots in ((DIAMOND, "closed"), (DIAMOND + DIAMOND[:1], "clamped")):
        at = [0, 4] if len(rays) == 5 else [0]
        ring(run, [{"at": ["all", n, "all"], "by": [0, 0, 2]} for n in at], rays=rays, knots=knots)
        torn(run, 2, 0.7, "-l", "l.json", "--outside", "extend", tolerance=1e-9)
        torn(run, 2, 0.7 * fade(0.35 * math.sqrt(2) / 0.8), "-l", "l.json", "--outside", "extend", "--falloff", "0.8",
             tolerance=1e-9)
        torn(run, 0, 0, "-l", "l.json")


@case
def an_axis_that_the_moves_open(run):
    """The inner ends of four rays are one point at 0 0. One of them is lifted by 1 beside the others: edges that meet the axis
    from its side are torn from those of the other sides. Lifted as one, they are not."""
    run.write("a.obj", obj_of([[0.5, 0, 0.5], [-0.5, 0, 0.5], [0.125, 0.5, 0.5]]) + "f 1 2 3\n")
    ring(run, [{"at": [0, 0, "all"], "by": [0, 0, 1]}], radii=(0.0, 1.0), knots="closed")
    found, done = torn(run, 1, 1, "-l", "l.json", tolerance=1e-9)
    one_line(done, "axis")
    check("axis" in run.ffd("check", "a.obj", "-l", "l.json", err=anything).text, "the text of check")
    # A vertex on the axis goes with the first ray.
    run.write("b.obj", obj_of([[0, 0, 0.5], [-0.5, 0, 0.5], [0.125, 0.125, 0.5]]) + "f 1 2 3\n")
    torn(run, 2, 1, "-l", "l.json", mesh="b.obj", tolerance=1e-9)
    ring(run, [{"at": [0, "all", "all"], "by": [0, 0, 1]}], radii=(0.0, 1.0), knots="closed")
    for mesh in ("a.obj", "b.obj"):
        torn(run, 0, 0, "-l", "l.json", mesh=mesh)


@case
def into_an_overlap(run):
    """Five quarters of a turn: the first quarter is held twice, and the first part has it. The last rays lift by 2: along the
    edges from the fourth quarter into the first the displacement rises to 2 at y = 0, and is 0 from there on."""
    ring(run, [{"at": ["all", [4, 5], "all"], "by": [0, 0, 2]}], rays=DIAMOND + DIAMOND[:2])
    run.write("a.obj", obj_of([[1.125, -0.25, 0.5], [1.125, 0.25, 0.5], [1.375, 0.25, 0.5], [1.375, -0.25, 0.5]]) + "f 1 2 3 4\n")
    found = entry(run, "check", "a.obj", "-l", "l.json")
    counts(found, inside=2, multiple=2)
    found, done = torn(run, 2, 2, "-l", "l.json", tolerance=1e-9)
    one_line(done, "overlaps itself")


@case
def morph_targets_are_judged_by_themselves(run):
    """--morph: of two targets one is torn; and --as-morph of blocks."""
    asset, data = gltf_json([[-0.2, -1.5, 0], [0.2, -1.5, 0], [0.2, -1.2, 0]])
    asset["meshes"][0]["primitives"][0]["mode"] = 4
    run.write("a.glb", glb(asset, data))
    horseshoe(run, ARM)
    horseshoe(run, [{"by": [0, 0, 1]}], name="m.json")
    job = entry(run, "deform", "a.glb", "b.glb", "--morph", "one=l.json", "--morph", "all=m.json", "--outside", "extend")
    equal([target["tear"]["edges"] for target in job["morphs"]], [2, 0])
    near([target["tear"]["largest"] for target in job["morphs"]], [1, 0], 1e-9)
    equal(job["tear"]["edges"], 2)
    options = side_by_side(run, (-1, 0, UP), (0, 1, DOWN))
    box(run, "0.json", (-1, -2, -1), (0, 0, 1), UP)
    box(run, "1.json", (0, -2, -1), (1, 0, 1), DOWN)
    found = entry(run, "deform", "a.glb", "c.glb", *options, "--as-morph", "wave")["tear"]
    equal([found["edges"], found["largest"]], [2, 0.6])


@case
def a_page_shows_the_torn_edges(run):
    square(run, 0.5, 1.5)
    options = side_by_side(run, (0, 1, UP), (1, 2, DOWN))
    run.ffd("view", "a.obj", *options, "-o", "p.html", err=anything)
    page = Page(run.read("p.html"))
    equal(sorted(ends for ends, _ in page.tears()), [(1, 0), (2, 3)], "the end in the later block first")
    near([step for _, step in page.tears()], [0.6] * 2, 1e-12, "their steps")


def grid(columns, rows):
    """Quads from 0 to 2 in x and y, at z = 0.5, none of whose corners is on x = 1 or y = 1."""
    points = [[2 * (x + 0.5) / columns, 2 * (y + 0.5) / rows, 0.5] for y in range(rows) for x in range(columns)]
    return points, [[y * columns + x + d for d in (0, 1, columns + 1, columns)]
                    for y in range(rows - 1) for x in range(columns - 1)]


@threaded_case
def formats_threads_and_the_order_change_nothing(run):
    """A grid through four blocks, as OBJ, OFF, PLY and GLB, in two orders. Each row and column of edges between blocks is torn.
    Without a report deform reads the faces between blocks only, and finds the same."""
    points, quads = grid(12, 10)
    triangles = [[q[i] for i in t] for q in quads for t in ((0, 1, 2), (0, 2, 3))]
    names = []
    for n, lift in enumerate((0, 0.125, 0.5, 0.25)):
        names.append(f"{n}.json")
        box(run, names[-1], (n % 2, n // 2, 0), (n % 2 + 1, n // 2 + 1, 1), [{"by": [0, 0, lift]}])
    options = both(*names) + ["--blocks"]
    # Edges between the halves: 10 and 12 straight ones, one diagonal in each of 9 and 11 quads; one of these diagonals is
    # between both halves.
    across = 10 + 12 + 9 + 11 - 1
    order = list(range(len(points)))
    random.Random(3).shuffle(order)
    number = {v: n for n, v in enumerate(order)}
    for places, faces in ((points, triangles), ([points[v] for v in order], [[number[v] for v in t] for t in triangles[::-1]])):
        asset, data = gltf_json([places[v] for t in faces for v in t])
        asset["meshes"][0]["primitives"][0]["mode"] = 4
        rows = "".join("%r %r %r\n" % tuple(p) for p in places)
        listed = "".join("3 %d %d %d\n" % tuple(t) for t in faces)
        meshes = {"a.obj": obj_of(places) + "".join("f %d %d %d\n" % tuple(v + 1 for v in t) for t in faces),
                  "a.off": f"OFF\n{len(places)} {len(faces)} 0\n{rows}{listed}",
                  "a.ply": f"ply\nformat ascii 1.0\nelement vertex {len(places)}\n" + "".join(f"property double {c}\n" for c in "xyz")
                  + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n{rows}{listed}",
                  "a.glb": glb(asset, data)}
        for name, content in meshes.items():
            run.write(name, content)
            found, done = torn(run, across, 0.5, *options, mesh=name)
            one_line(done, rf"\b{across} torn edges\b")
    texts = {run.ffd("check", "a.obj", *options, "--report", "-", "--report-stable", "-j", str(n), "--isa", isa, err=anything).text
             for n in (1, 2, 3) for isa in ("auto", "scalar")}
    equal(len(texts), 1, "reports")


@case
def edges_in_a_lattice_that_folds_are_left_out_if_nobody_asks(run):
    """To cut some 1,000 edges of a lattice that folds everywhere takes 80 times as long as to find their ends. Few are cut, and
    those of which one end stays are counted all the same."""
    draw = random.Random(3)
    points = [[place / 5 + draw.uniform(-0.5, 0.5) for place in (i, j, k)] for k in range(6) for j in range(6) for i in range(6)]
    run.write("l.json", lattice(size=(6, 6, 6), rest={"points": points}, moves=[{"twist": {"axis": "z", "degrees": 5}}]))
    places = [[draw.random() for _ in range(3)] for _ in range(400)]
    for name, faces in (("few.obj", range(1, 12, 5)), ("many.obj", range(1, 398))):
        run.write(name, obj_of(places) + "".join(f"f {v} {v + 1} {v + 2}\n" for v in faces))
        done = run.ffd("deform", name, "out.obj", "-l", "l.json", "--force", err=anything)
        left = rf"^{name}: torn edges of which both ends move are not counted: .*see --report"
        (one_line if name == "many.obj" else no_line)(done, left)
        one_line(done, "stay; the largest step to a neighbour is")
    run.write("normals.obj", obj_of(places) + "vn 0 0 1\n" + "".join(f"f {v}//1 {v + 1}//1 {v + 2}//1\n" for v in range(1, 398)))
    one_line(run.ffd("deform", "normals.obj", "out.obj", "-l", "l.json", "--force", "--normals", "recompute", err=anything),
             "^normals.obj: torn edges of which both ends move are not counted")
    threaded = run.ffd("deform", "many.obj", "out.obj", "-l", "l.json", "--force", "-j3", err=anything)
    untimed = [[line for line in one.err if ": the search for " not in line] for one in (threaded, done)]  # a slow machine is told so
    equal(*untimed, "of any threads")


main()
