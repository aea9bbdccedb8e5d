#!/usr/bin/env python3
"""Edges of a mesh that are torn at the border of a lattice: how many, by how much, where; what is said of them."""
import math
import random
import re
import struct

from bspline import BoxVolume
from harness import NO, OK, case, check, equal, glb, gltf_json, lattice, main, near, obj_of
from messages import anything, entry, no_line, one_line

# Holds x up to 1.5 and all else.
LOW, HIGH = (-10, -10, -10), (1.5, 10, 10)
UP = [{"by": [0, 0, 0.25]}]


def strip(columns, rows=1, start=1):
    """Squares of side 1 along x and y, as OBJ; the first vertex has the number `start`."""
    text = "".join(f"v {x} {y} 0\n" for y in range(rows + 1) for x in range(columns + 1))
    wide = columns + 1
    return text + "".join(f"f {k} {k + 1} {k + 1 + wide} {k + wide}\n" for y in range(rows) for x in range(columns)
                          for k in [start + y * wide + x])


def start(run, mesh, moves=UP, **members):
    run.write("a.obj", mesh)
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=moves, **members))


def torn(run, edges, largest, *options, mesh="a.obj", tolerance=1e-12):
    """What check and deform report. Returns the member."""
    out = "out" + mesh[mesh.index("."):]
    found = [entry(run, *command, "-l", "l.json", *options)["tear"] for command in (["check", mesh], ["deform", mesh, out])]
    equal(found[1], found[0], "check and deform")
    equal(found[0]["edges"], edges, "torn edges")
    near([found[0]["largest"]], [largest], tolerance, "the largest step")
    return found[0]


@case
def edges_across_the_border_are_counted(run):
    """Of a strip of three squares two edges lead from what moves to what stays."""
    start(run, strip(3))
    torn(run, 2, 0.25)


@case
def the_step_is_that_of_the_border_point_nearest_to_the_end_that_stays(run):
    """Two vertices stay; the displacement of the border differs between them, and the place of the larger is named."""
    moves = [{"at": [-1, -1, "all"], "by": [0, 0, 1]}, {"at": [-1, 2, "all"], "by": [0, 0, 0.5]}]
    start(run, "v 1 1 0\nv 2 2 0\nv 1 4 0\nv 2 6 0\nf 1 2 4 3\n", moves)
    grid = [-10, -10 + 20 / 3, -10 + 40 / 3, 10]

    def lifted(p):
        near_end = p[0] == HIGH[0]
        return [0, 0, near_end * (1.0 * (p[1] == 10) + 0.5 * (abs(p[1] - grid[2]) < 1e-9))]

    volume = BoxVolume(LOW, HIGH, lifted)
    steps = [volume.displacement([2, y, 0])[2] for y in (2, 6)]
    check(steps[1] > 1.5 * steps[0] > 0.01, steps)
    found = torn(run, 2, steps[1])
    equal(found["vertex"], 3, "the vertex that stays, from 0")


@case
def a_lattice_that_fades_to_its_border_tears_nothing(run):
    start(run, strip(3), [{"at": [1, "all", "all"], "by": [0, 0, 1]}])
    torn(run, 0, 0)
    equal(entry(run, "check", "a.obj", "-l", "l.json")["moved"], 4)


@case
def extend_and_falloff_tear_nothing(run):
    start(run, strip(3))
    torn(run, 0, 0, "--outside", "extend")
    torn(run, 0, 0, "--outside", "extend", "--falloff", "0.75")


@case
def a_step_counts_above_a_thousandth_of_the_edge(run):
    for length, step, edges in ((1, 0.0009, 0), (1, 0.0011, 2), (100, 0.09, 0), (100, 0.11, 2)):
        x = 1 + length
        start(run, f"v 1 0 0\nv {x} 0 0\nv {x} 1 0\nv 1 1 0\nf 1 2 3 4\n", [{"by": [0, 0, step]}])
        torn(run, edges, step if edges else 0)


@case
def equal_positions_are_one(run):
    """Two groups with vertices of their own meet in a row: the edge there is one, and one that has moved does not part
    from its twin."""
    start(run, "g low\n" + strip(2) + "g high\n" + "".join(f"v {x} {y} 0\n" for y in (1, 2) for x in range(3))
          + "f 7 8 11 10\nf 8 9 12 11\n")
    torn(run, 3, 0.25)


@case
def a_part_that_is_not_selected_tears_where_it_would_have_moved(run):
    """--only: the step is the displacement that the end which is not selected has inside the lattice."""
    start(run, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\nv -0.5 2 0\ng one\nf 1 2 3 4\ng two\nf 4 3 5 6\n")
    torn(run, 0, 0)
    found = torn(run, 2, 0.25, "--only", "group:one")
    check(found["vertex"] in (4, 5), "the vertex that stays, from 0:", found)


@case
def a_part_that_is_not_selected_would_move_as_the_lattice_does_there(run):
    """Not as its border: z grows by x/2, and x is 1/2 and -1/4."""
    start(run, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\nv -0.25 2 0\ng one\nf 1 2 3 4\ng two\nf 4 3 5 6\n",
          [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1]}])
    equal(torn(run, 2, 0.25, "--only", "group:one")["vertex"], 4)


@case
def a_part_that_is_not_selected_and_outside(run):
    """It would go with the border."""
    start(run, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\ng one\nf 1 2 3 4\ng two\nf 2 5 6 3\n")
    equal(torn(run, 2, 0.25, "--only", "group:one")["vertex"], 4)


@case
def a_part_with_vertices_of_its_own_that_is_not_selected(run):
    """Two groups that meet in a row, as above, of which one is selected: what is at its positions goes with it. Two edges
    lead to the border, and two from the row into the other group."""
    start(run, "g low\n" + strip(2) + "g high\n" + "".join(f"v {x} {y} 0\n" for y in (1, 2) for x in range(3))
          + "f 7 8 11 10\nf 8 9 12 11\n")
    torn(run, 4, 0.25, "--only", "group:low")


@case
def each_of_several_lattices_tears_at_its_own_border(run):
    """The second one ends before the first: two edges at each border. Where both end at one place an edge counts once, and
    the displacement jumps by what both do."""
    start(run, strip(3))
    for high, edges, largest in ((0.5, 4, 0.5), (HIGH[0], 2, math.hypot(0.25, 0.5))):
        run.write("m.json", lattice(low=LOW, high=(high, 10, 10), moves=[{"by": [0, 0.5, 0]}]))
        torn(run, edges, largest, "-l", "m.json")


@case
def neighbours_in_other_lattices_have_steps_of_their_own(run):
    """The end at 2 0 stays. Of its neighbours one is in the first lattice, the other in both; between these two is the
    border of the second."""
    start(run, "v 1 0 0\nv 1 1 0\nv 2 0 0\nf 1 2 3\n")
    run.write("m.json", lattice(low=(-10, 0.5, -10), high=HIGH, moves=[{"by": [0, 0.5, 0]}]))
    equal(torn(run, 3, math.hypot(0.25, 0.5), "-l", "m.json")["vertex"], 2)


def boxes(run, *moves, first=1.5, width=20):
    """Boxes side by side along x: the first ends where the second begins, and so on. Returns the options."""
    names = [f"box{n}.json" for n in range(len(moves))]
    for n, (name, of) in enumerate(zip(names, moves)):
        low, high = (-10 if n == 0 else first + (n - 1) * width), first + n * width
        run.write(name, lattice(low=(low, -10, -10), high=(high, 10, 10), moves=of))
    return [word for name in names for word in ("-l", name)]


def judged(run, edges, largest, options, *more, tolerance=1e-12):
    """What a job with these lattices only reports of a.obj, and what it says."""
    found = entry(run, "check", "a.obj", *options, *more)["tear"]
    equal(found["edges"], edges, "torn edges")
    near([found["largest"]], [largest], tolerance, "the largest step")
    return found, run.ffd("deform", "a.obj", "b.obj", *options, *more, "--force", err=anything)


@case
def boxes_that_abut_and_move_alike_tear_nothing(run):
    """Each vertex is in one of the two; the edges across their common face have the same displacement on both sides."""
    run.write("a.obj", strip(3))
    for options in (boxes(run, UP, UP), boxes(run, UP, UP)[2:] + boxes(run, UP, UP)[:2]):
        done = judged(run, 0, 0, options)[1]
        no_line(done, "step")
        no_line(done, r"\bstays?\b")
        run.ffd("check", "a.obj", *options, "--fail-on", "tear", err=anything)


@case
def a_field_that_goes_on_in_the_next_box_tears_nothing(run):
    """z grows by x/2 in both: the ends of an edge across move differently, but nowhere is there a jump."""
    lean = [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1]}]
    run.write("a.obj", strip(3))
    judged(run, 0, 0, boxes(run, lean, lean))
    # The second lifts by 1/4 beside that.
    judged(run, 2, 0.25, boxes(run, lean, lean + UP))


@case
def boxes_that_abut_and_move_differently(run):
    """Both ends of the two edges across move: nothing stays, and that is not said."""
    run.write("a.obj", "g Beam\n" + strip(3))
    options = boxes(run, UP, [{"by": [0, 0.5, 0.25]}])
    found, done = judged(run, 2, 0.5, options)
    equal([found["part"], found["vertex"]], ["group:Beam", 2])
    one_line(done, "lattices", "differently", r"\b0\.5\b", "vertex 2 of Beam", r"\b2 torn edges\b", "--blocks")
    no_line(done, r"\bstays?\b")
    done = run.ffd("check", "a.obj", *options, "--fail-on", "tear=0.49", code=NO, err=anything)
    one_line(done, "differently")
    run.ffd("check", "a.obj", *options, "--fail-on", "tear=0.51", err=anything)


@case
def a_small_box_in_a_large_one_tears_at_its_own_border(run):
    """In either order; what the large one does to both ends is no step. The large one leans, so that what the small one
    brings into it is carried on: by 1/2 along x and so by 1/4 along z."""
    run.write("a.obj", strip(3))
    run.write("small.json", lattice(low=LOW, high=HIGH, moves=[{"by": [0.5, 0, 0]}]))
    run.write("large.json", lattice(low=(-50, -50, -50), high=(50, 50, 50),
                                    moves=[{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1]}]))
    for order, step in ((("large", "small"), 0.5), (("small", "large"), math.hypot(0.5, 0.25))):
        options = [word for name in order for word in ("-l", name + ".json")]
        found, done = judged(run, 2, step, options)
        equal(found["vertex"], 2)
        no_line(done, r"\bstays?\b")


def layers(run, name, low, high, lifts):
    """A box of layers along x (degree 1), of which each lifts by its number."""
    run.write(name, lattice(size=(len(lifts), 2, 2), low=(low, 0, -9), high=(high, 1, 9),
                            moves=[{"at": [n, "all", "all"], "by": [0, 0, lift]} for n, lift in enumerate(lifts) if lift]))


def edge(run, start, end):
    """A triangle whose long sides lead from start to end along x, one of them on the boxes' common side y = 1."""
    run.write("a.obj", f"v {start} 1 0.5\nv {end} 1 0.5\nv {start} 0.5 0.5\nf 1 2 3\n")


def in_either_order(run, edges, largest, *names):
    for order in (names, names[::-1]):
        judged(run, edges, largest, [word for name in order for word in ("-l", name)])


@case
def an_edge_that_leaves_several_lattices_at_once(run):
    """From 1.5 to 4.5, out of a box that ends at 2 and one that ends at 4. Nothing is torn where both fade to their ends;
    else the end that stays would go with the lattice that does not."""
    edge(run, 1.5, 4.5)
    layers(run, "a.json", 0, 2, [0, 0.25, 0])
    layers(run, "b.json", 0, 4, [0, 0.5, 0])
    in_either_order(run, 0, 0, "a.json", "b.json")
    layers(run, "a.json", 0, 2, [0.25, 0.25])
    in_either_order(run, 2, 0.25, "a.json", "b.json")
    layers(run, "a.json", 0, 2, [0, 0.25, 0])
    layers(run, "b.json", 0, 4, [0, 0, 0.5])
    in_either_order(run, 2, 0.5, "a.json", "b.json")


@case
def an_edge_that_leaves_several_lattices_within_another(run):
    """The same, but all is in a box that lifts everything: both ends move. Each border is looked at by itself, and borders
    at one place together: two that lift by as much as they lower tear nothing."""
    edge(run, 1.5, 4.5)
    layers(run, "all.json", 0, 8, [1, 1])
    for of_a, of_b, edges, largest in (([0, 0.25, 0], [0, 0.5, 0], 0, 0), ([0.25, 0.25], [0, 0.5, 0], 2, 0.25),
                                       ([0.25, 0.25], [0.5, 0.5], 2, 0.5)):
        layers(run, "a.json", 0, 2, of_a)
        layers(run, "b.json", 0, 4, of_b)
        in_either_order(run, edges, largest, "a.json", "b.json", "all.json")
    for down, edges in ((-0.25, 0), (-0.5, 2)):
        layers(run, "a.json", 0, 2, [0.25, 0.25])
        layers(run, "b.json", 1, 2, [down, down])
        in_either_order(run, edges, 0.25 if edges else 0, "a.json", "b.json", "all.json")


@case
def an_edge_from_one_lattice_into_another(run):
    """They overlap from 1 to 2, or there is a gap between them. Where both fade to their ends nothing is torn; what one
    does at its end, where the other is on both sides, is a step, in either order. Through a gap the edge goes on in the
    next lattice."""
    edge(run, 0.5, 4)
    for of_a, of_b, edges, largest in (([0, 0.25, 0], [0, 0.5, 0], 0, 0), ([0, 0.25, 0.125], [0, 0.5, 0], 2, 0.125),
                                       ([0, 0.25, 0], [0.0625, 0.5, 0], 2, 0.0625)):
        layers(run, "a.json", 0, 2, of_a)
        layers(run, "b.json", 1, 5, of_b)
        in_either_order(run, edges, largest, "a.json", "b.json")
    for of_b, edges, largest in (([0.25, 0.25], 0, 0), ([0.75, 0.75], 2, 0.5)):
        layers(run, "a.json", 0, 2, [0.25, 0.25])
        layers(run, "b.json", 3, 5, of_b)
        in_either_order(run, edges, largest, "a.json", "b.json")


@case
def an_edge_that_leaves_many_lattices(run):
    """Forty boxes within one that lifts all, each longer than the one before. The shortest or the longest one lifts
    to its end, and is found."""
    edge(run, 0.5, 9)
    layers(run, "all.json", 0, 9, [1, 1])
    names = [f"box{n}.json" for n in range(40)]
    for lifts, largest in (({0: 0.25}, 0.25), ({39: 0.5}, 0.5)):
        for n, name in enumerate(names):
            layers(run, name, 0, 1 + n / 8, [lifts.get(n, 0)] * 2 if n in lifts else [0, 0.001, 0])
        found = judged(run, 2, largest, [word for name in ["all.json"] + names for word in ("-l", name)], tolerance=0.05)[0]
        equal(found["vertex"], 1)


@case
def borders_that_another_lattice_turns(run):
    """One lattice turns everything by a quarter about 0 0 1/2, so that lattices after it are left along y; those before it
    end at x = 2. One lifts by as much as the other lowers, and they end at one place, or the second one later."""
    edge(run, 1.5, 4.5)
    run.write("turn.json", lattice(low=(-9, -9, -9), high=(9, 9, 9),
                                   moves=[{"rotate": {"axis": "z", "degrees": 90, "about": [0, 0, 0.5]}}]))
    layers(run, "a.json", 0, 2, [0.25, 0.25])
    for end, edges in ((2, 0), (3, 2)):
        for name, high, lift in (("turned-a.json", 2, 0.25), ("turned-b.json", end, -0.25)):
            run.write(name, lattice(size=(2, 2, 2), low=(-1, 0, -9), high=(0, high, 9), moves=[{"by": [0, 0, lift]}]))
        for order in (("turn", "turned-a", "turned-b"), ("a", "turn", "turned-b")):
            judged(run, edges, 0.25 if edges else 0, [word for name in order for word in ("-l", name + ".json")], tolerance=1e-9)


@case
def only_what_no_lattice_moves_stays(run):
    """Of columns at 0 .. 5 the first lattice has 0 and 1, the second 3: 2, 4 and 5 stay, two vertices each. A lattice that
    moves nothing holds all of them, and leaves them where they are."""
    run.write("a.obj", strip(5))
    run.write("far.json", lattice(low=(2.5, -10, -10), high=(3.5, 10, 10), moves=UP))
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    run.write("still.json", lattice(low=(-50, -50, -50), high=(50, 50, 50)))
    for more in ([], ["-l", "still.json"]):
        done = judged(run, 6, 0.25, ["-l", "l.json", "-l", "far.json"], *more)[1]
        one_line(done, r"\b6 vertices stay\b", r"\b0\.25\b")


@case
def a_lattice_elsewhere_does_not_count_for_what_is_not_selected(run):
    """The step of an end that is not selected is what the lattices of its neighbour would do."""
    start(run, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\nv -0.5 2 0\ng one\nf 1 2 3 4\ng two\nf 4 3 5 6\n")
    run.write("far.json", lattice(low=(50, -1, -1), high=(60, 1, 1), moves=[{"by": [0, 9, 0]}]))
    for options in (["-l", "l.json", "-l", "far.json"], ["-l", "far.json", "-l", "l.json"]):
        judged(run, 2, 0.25, options, "--only", "group:one")


@case
def a_row_of_many_boxes(run):
    """The marks of ten lattices take more than a byte. One of them moves otherwise than its two neighbours."""
    run.write("a.obj", "".join(f"v {x + 0.5} {y} 0\n" for y in range(2) for x in range(10))
              + "".join(f"f {k} {k + 1} {k + 11} {k + 10}\n" for k in range(1, 10)))
    judged(run, 0, 0, boxes(run, *[UP] * 10, first=1, width=1))
    for other in (3, 8):
        moves = [[{"by": [0, 1, 0.25]}] if n == other else UP for n in range(10)]
        judged(run, 4, 1, boxes(run, *moves, first=1, width=1))


def draw_hidden(run, asset, data):
    asset["extensionsUsed"] = ["KHR_node_visibility"]
    asset["meshes"][0]["primitives"][0]["mode"] = 4
    run.write("a.glb", glb(asset, data))


@case
def what_is_hidden_is_not_torn(run):
    """Two nodes show one mesh across the border, one of them hidden: its edges do not count, and its vertices do not stay.
    Nor does a hidden twin lend its place to what is not selected."""
    triangle = [[1, 0, 0], [2, 0, 0], [1, 1, 0]]
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    for first, second, edges in (({}, {}, 4), ({}, hidden, 2), (hidden, {}, 2), (hidden, hidden, 0)):
        nodes = [{"mesh": 0, "name": "a", **first}, {"mesh": 0, "name": "b", "translation": [0, 5, 0], **second}]
        asset, data = gltf_json(triangle, nodes=nodes)
        draw_hidden(run, asset, data)
        torn(run, edges, 0.25 if edges else 0, mesh="a.glb", tolerance=1e-6)
    # Without names the vertices of all are counted.
    asset, data = gltf_json(triangle, nodes=[{"mesh": 0}, {"mesh": 0, "translation": [0, 5, 0], **hidden}])
    draw_hidden(run, asset, data)
    one_line(run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", err=anything), r"\b1 vertex stays\b")
    # Of the faces across the border there is only the hidden one, whose vertices come after those of the other.
    asset, data = gltf_json(triangle, nodes=[{"mesh": 0, "translation": [-3, 0, 0]}, {"mesh": 0, **hidden}])
    draw_hidden(run, asset, data)
    no_line(run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", err=anything), "largest step")
    # Two triangles with vertices of their own: b, which is not selected, stands where a hidden and selected one does too.
    nodes = [{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "translation": [-1, 0, 0]},
             {"mesh": 0, "name": "c", "translation": [-1, 0, 0], **hidden}]
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], nodes=nodes)
    draw_hidden(run, asset, data)
    torn(run, 2, 0.25, "--only", "node:a", "--only", "node:c", mesh="a.glb", tolerance=1e-6)
    torn(run, 2, 0.25, "--only", "node:a", mesh="a.glb", tolerance=1e-6)


@case
def a_warning_of_deform_names_the_part_and_the_remedy(run):
    start(run, "g Knight_Sword\n" + strip(2))
    found = torn(run, 2, 0.25)
    equal(found["part"], "group:Knight_Sword")
    for options in ([], ["-v"]):
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", *options, err=anything)
        one_line(done, r"\b2 vertices\b", "Knight_Sword", r"\b0\.25\b", "--outside extend", "--falloff", "larger lattice")
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--outside", "extend", err=anything)
    no_line(done, "step")
    check("0.25" in run.ffd("check", "a.obj", "-l", "l.json", err=anything).text, "the text of check")


@case
def check_prints_why_edges_are_torn(run):
    def printed(*options):
        return line_of(run.ffd("check", "a.obj", *options, err=anything).text, "torn")

    start(run, strip(3))
    told_by = printed("-l", "l.json")
    check("2 vertices stay" not in told_by and "4 vertices stay" in told_by, told_by)
    other = boxes(run, UP, [{"by": [0, 0.5, 0.25]}])
    told_by = printed(*other)
    check("the lattices move its two ends differently" in told_by, told_by)
    run.write("a.obj", "v 1 0 0\nv 1.5 0 0\nv 1.5 1 0\nv 2 0 0\nf 1 2 3\nf 2 4 3\n")
    told_by = printed(*other, "--blocks")
    check("blocks move 2 vertices on their faces differently" in told_by, told_by)


@case
def what_no_face_uses_does_not_stay(run):
    """The vertices that stay are those that are not inside: 8, 9 and 10 are in no face."""
    for mesh in (strip(3), "g low\n" + strip(3)):
        start(run, mesh + "v 7 7 7\nv 8 8 8\nv 1 0.5 0\n")
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=anything)
        one_line(done, r"\b4 of 11 vertices are not inside")
        one_line(done, r"\b4 vertices( of low)? stay\b")


@case
def a_limit_of_the_gate_is_kept_to_rounding(run):
    """data/reference.md: a figure within 1e-12 of its limit is no more than that."""
    start(run, strip(3))
    for part, code in ((0.9e-12, OK), (1.1e-12, NO)):
        run.ffd("check", "a.obj", "-l", "l.json", "--fail-on", f"tear={0.25 / (1 + part)!r}", code=code, err=anything)


@case
def the_node_of_a_gltf_is_named(run):
    """In the scene's lengths: the node doubles what its mesh has."""
    triangles = [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0], [1, 0, 0], [0.5, 0.5, 0]]
    asset, data = gltf_json(triangles, nodes=[{"mesh": 0, "name": "Sword", "scale": [2, 2, 2]}])
    asset["meshes"][0]["primitives"][0]["mode"] = 4
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    # Without indices: the two vertices at 1,0,0 and at 1,1,0 are one each. Only x = 2 stays, at the end of two edges.
    found = torn(run, 2, 0.25, mesh="a.glb", tolerance=1e-6)
    equal([found["part"], found["vertex"]], ["node:Sword", 4])
    one_line(run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", err=anything), r"\b1 vert(ex|ices)\b", "Sword", r"\b0\.25\b")


@case
def a_name_is_cut_between_characters(run):
    """In the message and in the report; what would break a line or steer a terminal is replaced."""
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    for name, shown, part in (("\u65e5" * 100, "\u65e5" * 66, "\u65e5" * 83), ("a\u009b31m\u2028\u202eb", "a??31m??????b", "a??31m??????b")):
        asset, data = gltf_json([[0, 0, 0], [2, 0, 0], [0, 1, 0]], nodes=[{"mesh": 0, "name": name}])
        asset["meshes"][0]["primitives"][0]["mode"] = 4
        run.write("a.glb", glb(asset, data))
        equal(torn(run, 2, 0.25, mesh="a.glb")["part"], f"node:{part}")
        one_line(run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", err=anything), f" of {re.escape(shown)} stays;")
        run.write("a.obj", f"g {name}\nv 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n")
        equal(torn(run, 2, 0.25)["part"], f"group:{shown}")


@case
def primitives_of_a_mesh_meet(run):
    """Two primitives with vertices of their own share an edge across the border: it is one."""
    sides = ([[1, 0, 0], [2, 0, 0], [1, 1, 0]], [[2, 0, 0], [1, 0, 0], [1, -1, 0]])
    asset, data = gltf_json(sides[0] + sides[1])
    size = 36
    asset["bufferViews"] = [{"buffer": 0, "byteOffset": size * i, "byteLength": size} for i in range(2)]
    asset["accessors"] = [{"bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [min(c) for c in zip(*p)], "max": [max(c) for c in zip(*p)]}
                          for i, p in enumerate(sides)]
    asset["meshes"][0]["primitives"] = [{"attributes": {"POSITION": i}, "mode": 4} for i in range(2)]
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    torn(run, 3, 0.25, mesh="a.glb", tolerance=1e-6)


@case
def the_proof_says_where_it_holds(run):
    """The whole volume turns by 180 degrees about z: no fold inside; beyond a side face, where only y is turned, det F
    is -1."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1),
                                moves=[{"rotate": {"axis": "z", "degrees": 180, "about": [0, 0, 0]}}]))
    run.write("a.obj", "v 0 0 0\nv 0.5 0 0\nv 3 0 0\nv 3 0.5 0\nf 1 2 3\nf 2 3 4\n")
    kept = run.ffd("check", "a.obj", "-l", "l.json", err=anything).text
    check("inside the lattice" in line_of(kept, "folds"), kept)
    check("outside it" not in kept, kept)
    text = run.ffd("check", "a.obj", "-l", "l.json", "--outside", "extend", err=anything).text
    check("none, proven" in text and "outside it det F falls to -1" in " ".join(text.split()), text)


def line_of(text, word):
    return next(line for line in text.splitlines() if line.split()[:1] == [word])


def plain_tears(points, faces):
    """How many edges lead across x = 1.5, in the plainest way: of vertices at one position the first one counts."""
    first = {}
    places = [first.setdefault(tuple(p), i) for i, p in enumerate(points)]
    edges = {frozenset((places[a], places[b])) for f in faces for a, b in zip(f, f[1:] + f[:1])}
    return sum(len({points[v][0] > HIGH[0] for v in edge}) == 2 for edge in edges)


def indexed_glb(points, faces, code):
    """Triangles with indices of a struct's code; None: without."""
    drawn = points if code else [points[v] for f in faces for v in f]
    asset, data = gltf_json(drawn)
    primitive = asset["meshes"][0]["primitives"][0]
    primitive["mode"] = 4
    if code:
        indices = struct.pack(f"<{3 * len(faces)}{code}", *(v for f in faces for v in f))
        asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(indices)})
        asset["accessors"].append({"bufferView": 1, "componentType": {"H": 5123, "I": 5125}[code], "count": 3 * len(faces),
                                   "type": "SCALAR"})
        primitive["indices"] = 1
        data += indices
        asset["buffers"][0]["byteLength"] = len(data)
    return glb(asset, data)


def binary_ply(points, faces, order, count_code, code):
    names = {"<": "little", ">": "big", "B": "uchar", "i": "int", "I": "uint", "H": "ushort"}
    head = (f"ply\nformat binary_{names[order]}_endian 1.0\nelement vertex {len(points)}\n"
            + "".join(f"property float {axis}\n" for axis in "xyz") + f"element face {len(faces)}\nproperty uchar red\n"
            f"property list {names[count_code]} {names[code]} vertex_indices\nproperty float area\nend_header\n")
    return head.encode() + b"".join(struct.pack(order + "3f", *p) for p in points) + b"".join(
        struct.pack(f"{order}B{count_code}{len(f)}{code}f", 7, len(f), *f, 0.5) for f in faces)


@case
def a_border_through_what_is_drawn_at_random(run):
    """Each format has the edges of the plainest count; vertices share positions, and some are in no face. Without a report
    deform reads only the faces across the border: the largest step is the same, wherever the border moves most."""
    draw = random.Random(5)
    run.write("l.json", lattice(low=LOW, high=HIGH, moves=UP))
    for n in range(3):
        run.write(f"{n}.json", lattice(low=(-4, -4, -4), high=(1.5, 4, 4), moves=[{"at": [-1, n, "all"], "by": [0, 0, 0.5]}]))
    for corners in ((3, 3), (3, 9)):
        points = [[draw.randrange(-40, 41) / 16 + 0.03125, draw.randrange(-40, 41) / 16, draw.randrange(-1, 2)] for _ in range(900)]
        near_by = [sorted(draw.sample(range(k, k + 12), draw.randint(*corners)), key=lambda _: draw.random())
                   for k in range(0, 880, 2)]
        faces = [f for f in near_by if len({tuple(points[v]) for v in f}) == len(f)]
        expected = plain_tears(points, faces)
        check(expected > 200, expected)
        vertices = "".join("%r %r %r\n" % tuple(p) for p in points)
        meshes = {"a.obj": vertices.replace("\n", "\nv ").join(["v ", ""])[:-2]
                  + "".join(f"f {' '.join(str(v + 1) for v in f)}\n" for f in faces),
                  "a.off": f"OFF\n{len(points)} {len(faces)} 0\n{vertices}"
                  + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in faces),
                  **{f"{n}.ply": binary_ply(points, faces, *codes) for n, codes in enumerate(("<Bi", ">BI", "<BH", ">HI"))}}
        if corners == (3, 3):
            meshes.update({f"{code}.glb": indexed_glb(points, faces, code) for code in ("H", "I", None)})
        told_of = {}
        for name, content in meshes.items():
            run.write(name, content)
            found = torn(run, expected, 0.25, "-j", str(1 + len(told_of) % 2), mesh=name, tolerance=1e-6)
            told_of[name] = found["vertex"]
            for n in range(3):
                largest = entry(run, "check", name, "-l", f"{n}.json")["tear"]["largest"]
                one_line(run.ffd("deform", name, "out" + name[-4:], "-l", f"{n}.json", "--force", err=anything),
                     rf"the largest step to a neighbour is {re.escape(format(largest, '.6g'))}\b")
        of_order = {vertex for name, vertex in told_of.items() if name != "None.glb"}
        equal(len(of_order), 1, f"the vertex with the largest step: {told_of}")


@case
def threads_change_nothing(run):
    points = [[math.cos(n) * 2, math.sin(2 * n) * 2, math.sin(3 * n)] for n in range(3000)]
    run.write("a.obj", obj_of(points)
              + "".join(f"f {n} {n + 1} {n + 2}\n" for n in range(1, 2990)))
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"twist": {"axis": "z", "degrees": 40}}]))
    texts = {run.ffd("check", "a.obj", "-l", "l.json", "--report", "-", "--report-stable", "-j", str(n), err=anything).text
             for n in (1, 2, 3)}
    equal(len(texts), 1)
    check('"tear"' in texts.pop(), "no member of that name")


main()
