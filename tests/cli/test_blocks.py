#!/usr/bin/env python3
"""--blocks: several lattices at once, each vertex in one of them; and what is said and counted of several lattices that
act one after the other."""
import json
import math
import random
import re

from batches import batch, lines_of
from bspline import BoxVolume
from harness import NO, USAGE, case, check, equal, lattice, main, near, obj_of, obj_vertices, threaded_case
from messages import anything, counts, entry, no_line, one_line


def both(*names):
    return [word for name in names for word in ("-l", name)]


def obj(points, faces=()):
    return obj_of(points) + "".join("f %d %d %d\n" % tuple(f) for f in faces)


def wave(p):
    """A displacement that both blocks have on their common face."""
    return [0.1 * math.sin(3 * p[1] + p[2]), 0.15 * math.cos(2 * p[0] - p[2]), 0.2 * math.sin(p[0] + 2 * p[1] + 3 * p[2])]


def block(low, high, field=wave):
    """A block's file, and the same volume worked out here."""
    volume = BoxVolume(low, high, field)
    points = [[x + d for x, d in zip(p, field(p))] for p in volume.points]
    return {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": low, "max": high}},
            "deformed": {"points": points}}, volume


BOXES = (([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]), ([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]))
# The beam of two boxes that touch at x = 1; vertices 2 and 4 are on the common face.
BEAM = "v 0.5 0 0\nv 1 0 0\nv 1.5 0 0\nv 1 1 0\nf 1 2 4\nf 2 3 4\n"


def beam(run, left=0.5, right=0.5):
    run.write("beam.obj", BEAM)
    for name, low, high, up in (("a.json", 0, 1, left), ("b.json", 1, 2, right)):
        run.write(name, lattice(low=(low, -2, -2), high=(high, 2, 2), moves=[{"by": [0, 0, up]}]))


def heights(run, name="out.obj"):
    return [p[2] for p in obj_vertices(run.text(name))]


@threaded_case
def two_blocks_that_share_a_face(run):
    """4000 points, a tenth of them on the face, each as its block alone would carry it."""
    numbers = random.Random(5)
    volumes = []
    for name, (low, high) in zip(("a.json", "b.json"), BOXES):
        content, volume = block(low, high)
        run.write(name, content)
        volumes.append(volume)
    points = [[1.0 if n % 10 == 0 else 2 * numbers.random(), numbers.random(), numbers.random()] for n in range(4000)]
    run.write("a.obj", obj(points, [[n, n + 1, n + 2] for n in range(1, 3998, 3)]))
    expected = [volumes[p[0] > 1].deform(p) for p in points]
    for order in (("a.json", "b.json"), ("b.json", "a.json")):
        found = entry(run, "deform", "a.obj", "out.obj", *both(*order), "--blocks")
        counts(found, vertices=4000, inside=4000, outside=0, multiple=0)
        equal(found["tear"]["edges"], 0)
        near(obj_vertices(run.text("out.obj")), expected, 1e-13)
    judged = entry(run, "check", "a.obj", *both("a.json", "b.json"), "--blocks")
    counts(judged, inside=4000, moved=4000)


@case
def a_thousand_blocks_make_one_field(run):
    """10 x 10 x 10 blocks of degree 1 whose corners move by x y z: together that very field, as each is trilinear."""
    side, names = 10, []
    for k in range(side):
        for j in range(side):
            for i in range(side):
                corners = [[float(x), float(y), float(z)] for z in (k, k + 1) for y in (j, j + 1) for x in (i, i + 1)]
                names.append(f"l/{i}-{j}-{k}.json")
                run.write(names[-1], {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2],
                                      "rest": {"box": {"min": corners[0], "max": corners[-1]}},
                                      "deformed": {"points": [[x, y, z + 1e-3 * x * y * z] for x, y, z in corners]}})
    numbers = random.Random(6)
    points = [[side * numbers.random() for _ in range(3)] for _ in range(500)]
    run.write("a.obj", obj(points + [[12, 5, 5]]))
    found = entry(run, "deform", "a.obj", "out.obj", *both(*names), "--blocks")
    counts(found, vertices=501, inside=500, outside=1)
    near(obj_vertices(run.text("out.obj")), [[x, y, z + 1e-3 * x * y * z] for x, y, z in points] + [[12, 5, 5]], 1e-13)


@case
def the_first_that_holds_the_vertex_has_it(run):
    run.write("a.obj", "v 0.5 0 0\nv 1.5 0 0\nv 2.5 0 0\n")
    run.write("a.json", lattice(low=(0, -1, -1), high=(2, 1, 1), moves=[{"by": [0, 0, 1]}]))
    run.write("b.json", lattice(low=(1, -1, -1), high=(3, 1, 1), moves=[{"by": [0, 0, 2]}]))
    for order, expected in ((("a.json", "b.json"), [1, 1, 2]), (("b.json", "a.json"), [1, 2, 2])):
        one_line(run.ffd("deform", "a.obj", "out.obj", *both(*order), "--blocks", "--force", err=anything), "overlap")
        equal(heights(run), expected, str(order))


def overlapping(run, names, mesh="a.obj"):
    """What check says of blocks that overlap, and reports."""
    done = run.ffd("check", mesh, *both(*names), "--blocks", "--report", "r.json", err=anything)
    return done, json.loads(run.read("r.json"))["jobs"][0]


@case
def volumes_that_overlap_are_named(run):
    """A box in the half of a larger one, whose sides it shares. Where the larger one is the first it has all, and nothing is
    torn; else the displacement jumps where the small one ends, and nowhere else."""
    run.write("a.obj", obj([[x / 4, y / 2, 0] for y in range(5) for x in range(9)],
                           [[y * 9 + x + 1, y * 9 + x + 2, y * 9 + x + 11] for y in range(4) for x in range(8)]))
    run.write("small.json", lattice(low=(0, 0, -1), high=(1, 2, 1), moves=[{"by": [0, 0, 0.5]}]))
    run.write("large.json", lattice(low=(0, 0, -1), high=(2, 2, 1), moves=[{"by": [0, 0, 0.125]}]))
    done, found = overlapping(run, ("large.json", "small.json"))
    one_line(done, "overlap", "large.json and small.json", "first -l")
    equal([found["shared_faces"]["disagreeing"], found["tear"]["edges"]], [0, 0])
    done, found = overlapping(run, ("small.json", "large.json"))
    one_line(done, "overlap", "small.json and large.json")
    equal([found["shared_faces"]["disagreeing"], found["shared_faces"]["largest"]], [5, 0.375])
    near([found["tear"]["largest"]], [0.375], 1e-15)
    done = run.ffd("deform", "a.obj", "out.obj", *both("small.json", "large.json", "large.json"), "--blocks", err=anything)
    one_line(done, "overlap", "small.json and large.json", "2 more pairs")


@case
def volumes_that_overlap_anywhere(run):
    """Bars that cross, boxes that share a ten-thousandth, one within another; halves of tubes, one a little longer. What
    only touches does not overlap, in whatever order."""
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

    def box(low, high):
        return lattice(low=low, high=high, size=(2, 2, 2))

    def tube(first, last, r0=1):
        return {"format": "ffd-lattice", "version": 1, "size": [3, 7, 2], "rest": {"cylinder": {
            "center": [0, 0, 0], "axis": [0, 0, 1], "zero": [1, 0, 0], "radius": [r0, r0 + 1], "height": 2,
            "angle": [first, last]}}}

    for first, second, overlap in (
            (box((0, 0, 0), (10, 1, 1)), box((2, -5, 0.25), (3, 5, 0.75)), True),
            (box((0, 0, 0), (1, 1, 1)), box((0.9999, 0, 0), (2, 1, 1)), True),
            (box((0, 0, 0), (9, 9, 9)), box((4, 4, 4), (5, 5, 5)), True),
            (tube(0, 180), tube(170, 360), True), (tube(0, 180), box((-3, -3, -3), (3, 3, 3)), True),
            (tube(0, 180), tube(180, 360), False), (tube(0, 180), tube(0, 180, 2.5), False),
            (box((0, 0, 0), (0.1, 0.1, 0.1)), box((0.1, 0, 0), (0.7, 0.1, 0.1)), False),
            (box((1e6, 0, 0), (1e6 + 0.1, 1, 1)), box((1e6 + 0.1, 0.5, 0), (1e6 + 1, 2, 1)), False)):
        run.write("a.json", first)
        run.write("b.json", second)
        for names in (("a.json", "b.json"), ("b.json", "a.json")):
            done, _ = overlapping(run, names)
            (one_line if overlap else no_line)(done, "overlap")


@case
def a_block_that_holds_the_vertex_goes_before_one_that_misses_it(run):
    """With a snap: 0.05 beyond the first box, in the second, which has it, and as far from the common face no vertex is on
    it. One that both miss goes with the first."""
    run.write("a.obj", "v 1.05 0 0\nv 0.5 0 0\nv 0.95 0.5 0\nv 1.5 2.05 0\nv 0.5 2.05 0\nv 1 2.05 0\nf 1 2 3\nf 4 5 6\n")
    for name, low, up in (("a.json", 0, 1), ("b.json", 1, 2)):
        run.write(name, lattice(low=(low, -2, -2), high=(low + 1, 2, 2), moves=[{"by": [0, 0, up]}]))
    for order, both_have in ((("a.json", "b.json"), 1), (("b.json", "a.json"), 2)):
        found = entry(run, "deform", "a.obj", "out.obj", *both(*order), "--blocks", "--snap", "0.1")
        equal(heights(run), [2, 1, 1, 2, 1, both_have], order)
        equal(found["shared_faces"]["disagreeing"], 1, order)
        counts(found, inside=6, outside=0)


@case
def all_act_on_the_mesh_at_rest(run):
    """What the first carries into the second is not moved again."""
    run.write("a.obj", "v 0.5 0 0\n")
    run.write("a.json", lattice(low=(0, -1, -1), high=(1, 1, 1), moves=[{"by": [1, 0, 0]}]))
    run.write("b.json", lattice(low=(1, -1, -1), high=(2, 1, 1), moves=[{"by": [0, 0, 1]}]))
    run.ffd("deform", "a.obj", "out.obj", *both("a.json", "b.json"), "--blocks")
    equal(obj_vertices(run.text("out.obj")), [[1.5, 0, 0]])


@case
def a_common_face_that_disagrees_is_torn(run):
    """One lifts by 1/2, the other by 1/4. The face is the first one's; edges from it into the second are torn."""
    beam(run, 0.5, 0.25)
    found = entry(run, "deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks")
    equal(heights(run), [0.5, 0.5, 0.25, 0.5])
    check(found["tear"]["edges"] >= 2, found["tear"])
    near([found["tear"]["largest"]], [0.25], 1e-15)
    run.ffd("deform", "beam.obj", "gated.obj", *both("a.json", "b.json"), "--blocks", "--fail-on", "tear", code=NO, err=anything)
    check(not run.exists("gated.obj"), "a violated gate writes nothing")


@case
def what_the_disagreement_is_called(run):
    """One line names how many vertices, how far and what to do; the report has them, and the gate's limit is the
    difference."""
    beam(run, 0.5, 0.25)
    done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks", err=anything)
    one_line(done, r"\b2 vertices", "differently", r"0\.25\b", "move alike")
    found = entry(run, "check", "beam.obj", *both("a.json", "b.json"), "--blocks")
    equal(found["shared_faces"], {"moved_twice": 0, "disagreeing": 2, "largest": 0.25})
    run.ffd("check", "beam.obj", *both("a.json", "b.json"), "--blocks", "--fail-on", "tear=0.26", err=anything)
    run.ffd("check", "beam.obj", *both("a.json", "b.json"), "--blocks", "--fail-on", "tear=0.24", code=NO, err=anything)


@case
def edges_that_leave_all_blocks_are_torn(run):
    """From x = 1.5, which the second block lifts by 1/4, to 5, which is in none: the border nearest to it would lift it
    by 1/4. With extend nothing is torn there."""
    beam(run, 0.25, 0.25)
    run.write("beam.obj", BEAM + "v 5 0 0\nf 3 4 5\n")
    found = entry(run, "deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks")
    equal([found["tear"]["edges"], found["tear"]["largest"], found["tear"]["vertex"]], [2, 0.25, 4])
    found = entry(run, "deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks", "--outside", "extend")
    equal(found["tear"]["edges"], 0)


@case
def extend_goes_by_the_nearest_of_all(run):
    beam(run, 0.5, 0.25)
    run.write("beam.obj", "v 0.5 0 0\nv -1 0 0\nv 3 0 0\nv 1.5 0 0\n")
    found = entry(run, "deform", "beam.obj", "out.obj", *both("b.json", "a.json"), "--blocks", "--outside", "extend")
    counts(found, inside=2, outside=2, moved=4)
    equal(heights(run), [0.5, 0.5, 0.25, 0.25])


def still(run, name, low, high):
    run.write(name, lattice(low=low, high=high))


@case
def among_many_blocks_the_nearest_border_is_followed(run):
    """9 x 9 blocks, of which each lifts by its own number: a point outside follows the one whose border is nearest,
    which is looked for here in all; with a falloff only as far as that reaches."""
    boxes, names = [], []
    for n in range(81):
        low = [3.0 * (n % 9), 2.5 * (n // 9), 0.0]
        boxes.append((low, [low[0] + 1 + n % 2, low[1] + 1, 1.0]))
        names.append(f"{n}.json")
        run.write(names[-1], lattice(low=boxes[-1][0], high=boxes[-1][1], moves=[{"by": [0, 0, 1 + n]}]))
    numbers = random.Random(7)
    points = [[numbers.uniform(-9, 36), numbers.uniform(-9, 32), numbers.uniform(-5, 5)] for _ in range(600)]

    def nearest(p):
        distances = [math.sqrt(sum(max(a - x, x - b, 0) ** 2 for x, a, b in zip(p, *box))) for box in boxes]
        return min(range(81), key=lambda n: distances[n]), min(distances)

    run.write("a.obj", obj(points))
    run.ffd("deform", "a.obj", "out.obj", *both(*names), "--blocks", "--outside", "extend", err=anything)
    near(heights(run), [p[2] + 1 + nearest(p)[0] for p in points], 1e-12)
    run.ffd("deform", "a.obj", "out.obj", *both(*names), "--blocks", "--outside", "extend", "--falloff", "2", "--force", err=anything)
    expected = []
    for p in points:
        block, distance = nearest(p)
        s = min(distance / 2, 1)
        expected.append(p[2] + (1 + block) * (1 - s ** 3 * (10 - 15 * s + 6 * s * s)))
    near(heights(run), expected, 1e-11)


@case
def every_vertex_is_in_one_of_two_curved_blocks(run):
    """Two halves of a tube that meet at two faces, both lifted: every vertex is in one of them and rises by 1."""
    for name, angle in (("a.json", [0, 180]), ("b.json", [180, 360])):
        run.write(name, {"format": "ffd-lattice", "version": 1, "size": [2, 7, 2],
                         "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "zero": [1, 0, 0], "radius": [1, 2],
                                               "height": 2, "angle": angle}}, "moves": [{"by": [0, 0, 1]}]})
    points = [[1.5 * math.cos(0.1 * n), 1.5 * math.sin(0.1 * n), n % 7 / 7 - 0.5] for n in range(200)]
    points += [[side * (1.1 + 0.01 * n), 0, 0] for n in range(80) for side in (-1, 1)]
    run.write("a.obj", obj(points))
    found = entry(run, "deform", "a.obj", "out.obj", *both("a.json", "b.json"), "--blocks")
    counts(found, vertices=360, inside=360, outside=0, moved=360)
    equal(found["shared_faces"]["disagreeing"], 0)
    near(heights(run), [p[2] + 1 for p in points], 1e-13)


@case
def normals_follow_the_block_that_has_the_vertex(run):
    """One shears along z by x, the other does nothing: the normal 0 0 1 leans over in the first only."""
    run.write("a.obj", "v 0.25 0 0\nv 0.75 0 0\nv 1.5 0 0\nv 0.5 1 0\nv 1.75 1 0\n" + "vn 0 0 1\n" * 5
              + "f 1//1 2//2 4//4\nf 3//3 5//5 4//4\n")
    run.write("a.json", lattice(low=(0, -2, -2), high=(1, 2, 2), moves=[{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1]}]))
    still(run, "b.json", (1, -2, -2), (2, 2, 2))
    run.ffd("deform", "a.obj", "out.obj", *both("a.json", "b.json"), "--blocks", err=anything)
    normals = [[float(x) for x in line.split()[1:]] for line in run.text("out.obj").splitlines() if line.startswith("vn")]
    lean = [-math.sqrt(0.5), 0, math.sqrt(0.5)]
    near(normals[:5], [lean, lean, [0, 0, 1], lean, [0, 0, 1]], 1e-12)


@case
def a_box_round_the_mesh_is_round_the_mesh_at_rest(run):
    run.write("a.obj", "v 0 0 0\nv 1 1 1\nv 5 0 0\n")
    run.write("a.json", lattice(low=(4, -1, -1), high=(6, 1, 1), moves=[{"by": [100, 0, 0]}]))
    run.write("b.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                         "moves": [{"by": [0, 0, 1]}]})
    run.ffd("deform", "a.obj", "out.obj", *both("a.json", "b.json"), "--blocks", err=anything)
    equal(obj_vertices(run.text("out.obj")), [[0, 0, 1], [1, 1, 2], [105, 0, 0]])


@case
def one_block_is_the_same_as_without_blocks(run):
    """Is the same as without --blocks."""
    beam(run)
    run.ffd("deform", "beam.obj", "plain.obj", "-l", "a.json", err=anything)
    run.ffd("deform", "beam.obj", "block.obj", "-l", "a.json", "--blocks", err=anything)
    equal(run.read("block.obj"), run.read("plain.obj"))


@case
def edges_through_several_blocks_are_measured(run):
    """check measures an edge through three blocks of which only the middle one moves: its middle rises by 1."""
    run.write("a.obj", "v 0.5 0 0\nv 2.5 0 0\nv 0.5 1 0\nf 1 2 3\n")
    still(run, "a.json", (0, -2, -2), (1, 2, 2))
    run.write("b.json", lattice(low=(1, -2, -2), high=(2, 2, 2), moves=[{"by": [0, 0, 1]}]))
    still(run, "c.json", (2, -2, -2), (3, 2, 2))
    judged = entry(run, "check", "a.obj", *both("a.json", "b.json", "c.json"), "--blocks")
    near([judged["edges"]["deviation"]["max"]], [1], 1e-12)
    equal([judged["folds"]["verdict"], judged["folds"]["cells"]], ["none", 3])


@case
def a_manifest_takes_blocks(run):
    beam(run)
    run.ffd("deform", "beam.obj", "one.obj", *both("a.json", "b.json"), "--blocks")
    run.write("m.jsonl", lines_of([{"in": "beam.obj", "lattice": ["a.json", "b.json"], "out": "many.obj", "options": {"blocks": True}}]))
    batch(run, "m.jsonl", done=1)
    equal(run.read("many.obj"), run.read("one.obj"))
    run.write("m.jsonl", lines_of([{"in": "beam.obj", "lattice": ["a.json", "b.json"], "out": "chain.obj", "options": {"blocks": False}}]))
    run.ffd("batch", "m.jsonl", err=anything)
    equal(heights(run, "chain.obj"), [0.5, 1, 0.5, 1])


@case
def in_a_manifest_it_is_true(run):
    beam(run)
    for value in ("yes", 1):
        run.write("m.jsonl", lines_of([{"in": "beam.obj", "lattice": ["a.json", "b.json"], "out": "b.obj", "options": {"blocks": value}}]))
        one_line(run.ffd("batch", "m.jsonl", code=NO, err=anything), "--blocks takes no value", r"\btrue\b")
    run.ffd("deform", "beam.obj", "b.obj", "-l", "a.json", "--blocks=yes", code=USAGE, err=re.compile("takes no value"))


@case
def an_embedding_is_of_one_lattice(run):
    beam(run)
    run.ffd("embed", "beam.obj", "-l", "a.json", "-o", "e.npy", err=anything)
    run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks", "--embedding", "e.npy", code=USAGE,
            err=re.compile("--embedding"))
    check(not run.exists("out.obj"), "nothing is written")


@case
def one_after_the_other_says_what_both_move(run):
    beam(run)
    done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), err=anything)
    one_line(done, r"\b2 vertices on a face common to two lattices are moved by both", "see --blocks")
    run.write("b.json", lattice(low=(1, -2, -2), high=(2, 2, 2)))
    done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--force", err=anything)
    no_line(done, "--blocks")


@case
def what_fades_to_the_common_face_moves_nothing_there(run):
    """Of layers along x the one at the common face stays: of both lattices, or of one of them, in either order. What is
    left there by a rounding is not moved either."""
    def layers(name, low, high, at):
        run.write(name, lattice(size=(3, 2, 2), low=(low, -2, -2), high=(high, 2, 2),
                                moves=[{"at": [n, "all", "all"], "by": [0, 0, 0.5]} for n in at]))

    for face in (1, 0.7):
        run.write("beam.obj", BEAM.replace("v 1 ", f"v {face} "))
        for first, second, twice in (((0, 1), (1, 2), 0), ((0, 1, 2), (1, 2), 0), ((0, 1), (0, 1, 2), 0), ((2,), (0,), 2)):
            layers("a.json", 0, face, first)
            layers("b.json", face, 2, second)
            for order in (("a.json", "b.json"), ("b.json", "a.json")):
                found = entry(run, "deform", "beam.obj", "out.obj", *both(*order))
                equal(found["shared_faces"]["moved_twice"], twice, f"{face} {first} {second} {order}")
                done = run.ffd("deform", "beam.obj", "out.obj", *both(*order), "--force", err=anything)
                (one_line if twice else no_line)(done, "moved by both")


@case
def with_extend_all_are_moved_by_both(run):
    """Not only what is on the common face: --blocks is no remedy for a mistake then."""
    beam(run)
    for options in ([], ["--falloff", "0.25"]):
        done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--outside", "extend", *options, "--force",
                       err=anything)
        no_line(done, "common to two lattices")


def float_beam(run, face, left, right):
    """The beam as float32 with the common face at x = face."""
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
              f"{face / 2} 0 0\n{face} 0 0\n{face * 1.5} 0 0\n{face} 1 0\n3 0 1 3\n3 1 2 3\n")
    for name, low, high, moves in (("a.json", 0, face, left), ("b.json", face, 2 * face, right)):
        run.write(name, lattice(low=(low, -2, -2), high=(high, 2, 2), moves=moves))


@case
def blocks_within_the_rounding(run):
    """Both lean by x/2, which on their common face is one displacement, in either order; and where the second lifts by
    1/4 beside that, the two vertices there, which go with the first, are torn from those of the other."""
    lean = [{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1]}]
    for face in (0.1, 0.7):
        float_beam(run, face, lean, lean)
        for order in (("a.json", "b.json"), ("b.json", "a.json")):
            found = entry(run, "check", "a.ply", *both(*order), "--blocks")
            equal([found["shared_faces"]["disagreeing"], found["tear"]["edges"]], [0, 0], f"{face} {order}")
        float_beam(run, face, lean, lean + [{"by": [0, 0, 0.25]}])
        for order in (("a.json", "b.json"), ("b.json", "a.json")):
            found = entry(run, "check", "a.ply", *both(*order), "--blocks")
            equal([found["shared_faces"]["disagreeing"], found["tear"]["edges"]], [2, 2], f"{face} {order}")
            near([found["shared_faces"]["largest"], found["tear"]["largest"]], [0.25, 0.25], 1e-12)


def float_grid(run, xs, ys, zs):
    """Squares in planes z, whose corners a PLY stores as float32."""
    points = [[x, y, z] for z in zs for y in ys for x in xs]
    wide, high = len(xs), len(ys)
    faces = [[(k * high + j) * wide + i + d for d in (0, 1, wide + 1, wide)]
             for k in range(len(zs)) for j in range(high - 1) for i in range(wide - 1)]
    run.write("a.ply", "ply\nformat ascii 1.0\n" + f"element vertex {len(points)}\n"
              + "".join(f"property float {axis}\n" for axis in "xyz")
              + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
              + "".join("%r %r %r\n" % tuple(p) for p in points) + "".join("4 %d %d %d %d\n" % tuple(f) for f in faces))


def offsets(run, name, low, high, field, size=4):
    """A block whose control points, by their places from 0 to 1 of the block, move by what field says."""
    moves = [{"at": [i, j, k], "by": field(i / (size - 1), j / (size - 1), k / (size - 1))}
             for k in range(size) for j in range(size) for i in range(size)]
    run.write(name, lattice(size=(size,) * 3, low=low, high=high, moves=moves))


def rough(n):
    """Numbers from -1/2 to 1/2 that differ much from one to the next."""
    return math.sin(12.9898 * n) * 43758.5453 % 1 - 0.5


def apart(run, names, expected, mesh="a.ply"):
    """In both orders so many vertices disagree, and some edges are torn only where any do."""
    for order in (names, names[::-1]):
        found = entry(run, "check", mesh, *both(*order), "--blocks")
        equal(found["shared_faces"]["disagreeing"], expected, order)
        equal(found["tear"]["edges"] > 0, expected > 0, order)


@case
def steep_blocks_within_the_rounding(run):
    """Of float32 numbers the common face at `face` lies in one of the blocks, by as much as 1/128. Both move its control
    points alike, and the others by as much as their sides, in all directions: the slopes differ. Control points
    of the face that move otherwise are found."""
    for face in (1.1, 100.1, 5000.3, 100000.1):
        float_grid(run, [face - 1, face - 0.5, face, face + 0.5, face + 1], [0, 0.3, 0.6, 1], [0, 0.5, 1])
        for off, expected in ((0, 0), (0.01, 9)):
            for name, end in (("a.json", 0), ("b.json", 1)):
                def field(x, y, z):
                    common = x == 1 - end
                    seed = 7 * y + 31 * z + (0 if common else 101 * x + 57 + end)
                    return [rough(seed + c) + (off * end * (y == 1) if common else 0) for c in range(3)]
                offsets(run, name, [face - 1 + end, 0, 0], [face + end, 1, 1], field)
            # The control points y = 1 act on the vertices at 0.3, 0.6 and 1, in three planes.
            apart(run, ("a.json", "b.json"), expected)


@threaded_case
def steep_blocks_far_from_the_origin(run):
    """Two blocks at 1e6, the first 0.001 thin and rising by 1 across, whose common face is bent: what the rounding of a
    double makes of that slope is no difference. A control point of the face that moves otherwise is."""
    far, wide = 1e6, 0.001

    def bent(y, x, z):
        return [far + x, far / 3 + y + 0.2 * x * x + 0.1 * x * z, far / 7 + z]

    grid = [(i / 2, k / 2) for k in range(3) for i in range(3)]

    def layered(name, low, high, by, more=()):
        points = [bent(y, x, z) for z in (0, 0.5, 1) for y in (low, high) for x in (0, 0.5, 1)]
        run.write(name, {"format": "ffd-lattice", "version": 1, "size": [3, 2, 3], "rest": {"points": points},
                         "moves": [{"at": ["all", layer, "all"], "by": by}] + list(more)})

    # The face y = 0 as a quadratic surface with these control points.
    def bernstein(t):
        return [(1 - t) ** 2, 2 * t * (1 - t), t * t]

    def on_face(u, w):
        weights = [a * b for b in bernstein(w) for a in bernstein(u)]
        return [sum(h * bent(0, *p)[c] for h, p in zip(weights, grid)) for c in range(3)]

    numbers = random.Random(8)
    points = [on_face(numbers.random(), numbers.random()) for _ in range(300)]
    run.write("a.obj", obj(points, [[n, n + 1, n + 2] for n in range(1, 299)]))
    layer = 0
    layered("a.json", -wide, 0, [0, 0, 1])
    layer = 1
    layered("b.json", 0, 1, [0, 0, 1])
    apart(run, ("a.json", "b.json"), 0, "a.obj")
    layered("b.json", 0, 1, [0, 0, 1], [{"at": [1, 0, 1], "by": [0, 1e-3, 0]}])
    for order in (("a.json", "b.json"), ("b.json", "a.json")):
        found = entry(run, "check", "a.obj", *both(*order), "--blocks")
        check(found["shared_faces"]["disagreeing"] > 250, found["shared_faces"])


@case
def a_common_face_within_the_rounding(run):
    """0.1 and 0.7 as float32 lie on either side of these faces: by 1e-8, which is more than a point on a face may be off.
    The lattice on the wrong side holds them by their rounding, and both move them. So does --snap for a gap."""
    for face in (0.1, 0.7):
        float_beam(run, face, *[[{"by": [0, 0, 0.5]}]] * 2)
        for order in (("a.json", "b.json"), ("b.json", "a.json")):
            found = entry(run, "deform", "a.ply", "out.ply", *both(*order))
            equal(found["shared_faces"]["moved_twice"], 2, f"{face} {order}")
    beam(run)
    for end in (1, 1.0003):  # of the first; the second begins beyond it
        for name, low, high in (("a.json", 0, end), ("b.json", 1.0006, 2)):
            run.write(name, lattice(low=(low, -2, -2), high=(high, 2, 2), moves=[{"by": [0, 0, 0.5]}]))
        for order in (("a.json", "b.json"), ("b.json", "a.json")):
            for options, twice in (([], 0), (["--snap", "0.001"], 2)):
                found = entry(run, "deform", "beam.obj", "out.obj", *both(*order), *options)
                equal(found["shared_faces"]["moved_twice"], twice, f"{end} {order} {options}")


@case
def a_common_face_within_coarse_rounding(run):
    """Float32 numbers that lie by more than 1e-4 of a box' side on either side of the face: both boxes move all nine."""
    for face in (5000.3, 100000.1):
        float_grid(run, [face - 0.5, face, face + 0.5], [0.1, 0.3, 0.6], [0.2, 0.5, 0.8])
        for name, low in (("a.json", face - 1), ("b.json", face)):
            run.write(name, lattice(low=(low, 0, 0), high=(low + 1, 1, 1), moves=[{"by": [0, 0, 0.0625]}]))
        for order in (("a.json", "b.json"), ("b.json", "a.json")):
            found = entry(run, "deform", "a.ply", "out.ply", *both(*order))
            equal(found["shared_faces"]["moved_twice"], 9, f"{face} {order}")


@case
def boxes_round_the_same_mesh_share_no_face(run):
    """Their vertices on the border are on the same side of it."""
    run.write("a.obj", obj([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]))
    for name in ("a.json", "b.json"):
        run.write(name, {"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "rest": {"box": "mesh"},
                         "moves": [{"twist": {"axis": "z", "degrees": 10}}]})
    no_line(run.ffd("deform", "a.obj", "out.obj", *both("a.json", "b.json"), err=anything), "--blocks")


@case
def a_common_face_that_leaves_its_plane(run):
    """Both push along x: what the first brings into the second is on the common face at rest, and is moved by both."""
    run.write("beam.obj", BEAM)
    for name, low, high in (("a.json", 0, 1), ("b.json", 1, 2)):
        run.write(name, lattice(low=(low, -2, -2), high=(high, 2, 2), moves=[{"by": [0.125, 0, 0]}]))
    found = entry(run, "deform", "beam.obj", "out.obj", *both("a.json", "b.json"))
    equal(found["shared_faces"], {"moved_twice": 2, "disagreeing": 0, "largest": 0})


@case
def a_chain_counts_what_is_outside_of_every_lattice(run):
    """Each vertex of the beam is in one lattice or the other: none is outside, and the gate passes."""
    beam(run)
    for command in (["check", "beam.obj"], ["deform", "beam.obj", "out.obj"]):
        done = run.ffd(*command, *both("a.json", "b.json"), "--fail-on", "outside", err=anything)
        no_line(done, "not inside")
    run.write("beam.obj", BEAM + "v 5 0 0\nf 3 4 5\n")
    done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--force", err=anything)
    one_line(done, r"\b1 of 5 vertices is not inside")
    run.ffd("check", "beam.obj", *both("a.json", "b.json"), "--fail-on", "outside", code=NO, err=anything)


@case
def outside_of_all_blocks(run):
    beam(run)
    run.write("beam.obj", BEAM + "v 5 0 0\nf 3 4 5\n")
    done = run.ffd("deform", "beam.obj", "out.obj", *both("a.json", "b.json"), "--blocks", err=anything)
    one_line(done, r"\b1 of 5 vertices is not inside")
    equal(heights(run), [0.5, 0.5, 0.5, 0.5, 0])
    run.ffd("check", "beam.obj", *both("a.json", "b.json"), "--blocks", "--fail-on", "outside", code=NO, err=anything)
    run.ffd("deform", "beam.obj", "no.obj", *both("a.json", "b.json"), "--blocks", "--outside", "error", code=5)


@threaded_case
def threads_change_nothing(run):
    for name, (low, high) in zip(("a.json", "b.json"), BOXES):
        run.write(name, block(low, high)[0])
    run.write("a.obj", obj([[(n * 37 % 101) / 50, (n * 53 % 103) / 103, (n * 71 % 107) / 107] for n in range(3000)]))
    outputs = set()
    for n in (1, 2, 3):
        run.ffd("deform", "a.obj", "out.obj", *both("a.json", "b.json"), "--blocks", "--force", "-j", str(n), err=anything)
        outputs.add(run.read("out.obj"))
    equal(len(outputs), 1)


main()
