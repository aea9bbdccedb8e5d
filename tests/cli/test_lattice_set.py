#!/usr/bin/env python3
"""ffd lattice set: operations on what a lattice does. authoring/set-*.json and seam-*.json hold right answers in exact fractions."""

import json
import os
import random
import re

from author import array, deformed_points, offsets_of, reference_cases, rest_points
from harness import CUBE, INVALID, IO, USAGE, case, carried, check, equal, lattice, main, near, repetitions

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
PLACES = [[RANDOM.uniform(-1.5, 1.5) for _ in range(3)] for _ in range(30)]

COVERS = "a.json: the inverse covers the deformed volume only: other places of the volume at rest are outside of it"


def change(run, *operations, source="a.json", target="o.json", **more):
    run.ffd("lattice", "set", source, *operations, "-o", target, "--force", **more)
    return json.loads(run.text(target))


def random_offsets(count, most=0.2):
    return [[RANDOM.uniform(-most, most) for _ in range(3)] for _ in range(count)]


def write(run, name, most=0.2, **members):
    """A lattice of 4 x 5 x 4 control points in a box, all of which are displaced."""
    content = lattice(size=(4, 5, 4), degree=(3, 3, 3), deformed={"offsets": random_offsets(80, most)}, **members)
    run.write(name, content)
    return content


@case
def the_reference_cases(run):
    names = 0
    for name, of in reference_cases("set"):
        names += 1
        expect, tolerance = of["expect"], of["expect"]["tolerance"]
        run.write("A", of["lattice"])
        if "other" in of:
            run.write("B", of["other"])
        found = change(run, *of["command"].split()[3:-2], source="A", target="O.json")
        equal([found["moves"], found["size"]], [[], of["lattice"]["size"]], name)
        if "offsets" in expect:
            near(offsets_of(found), expect["offsets"], tolerance, name)
        if "rest_points" in expect:
            near(rest_points(found), expect["rest_points"], tolerance, name)
            near(deformed_points(found), expect["deformed_points"], tolerance, name)
        ones = [1.0] * len(offsets_of(found))
        near(found.get("weights", ones), expect.get("weights", of["lattice"].get("weights", ones)), tolerance, name)
        if "deformed_weights" in expect:
            near(found["deformed"].get("weights", found.get("weights", ones)), expect["deformed_weights"], tolerance, name)
    equal(names, 5)


@case
def what_changes_nothing_changes_no_byte(run):
    weights = [RANDOM.uniform(0.5, 2) for _ in range(80)]
    for members in ({}, {"weights": weights}):
        write(run, "a.json", **members)
        write(run, "b.json", **members)
        run.ffd("lattice", "set", "a.json", "--strength", "1", "-o", "same.json", "--force")
        run.ffd("lattice", "set", "b.json", "--strength", "1", "-o", "other.json", "--force")
        for operations, name in ((["--blend", "b.json,0"], "same.json"), (["--blend", "b.json,1"], "other.json"),
                                 (["--mirror", "u", "--mirror", "u"], "same.json"), (["--strength", "1", "--move", "0,0,0"], "same.json"),
                                 (["--rotate", "y,90", "--rotate", "y,-90"], "same.json"), (["--scale", "2", "--scale", "0.5"], "same.json")):
            if "--mirror" in operations and members:
                continue  # these weights are not symmetric
            change(run, *operations)
            equal(run.read("o.json"), run.read(name), operations)
        check("deformed" not in change(run, "--strength", "0"), "no displacement is left")
        check("deformed" not in change(run, "--blend", "a.json,0.5", "--strength", "0"), "nor here")


@case
def half_and_twice_the_edit(run):
    content = write(run, "a.json", most=0.05)
    for strength in (0.5, 2, -1):
        change(run, "--strength", str(strength))
        ends, moved = carried(run, PLACES, "o.json"), carried(run, PLACES, "a.json")
        near(ends, [[p + strength * (q - p) for p, q in zip(*both)] for both in zip(PLACES, moved)], 1e-14, strength)
    other = write(run, "b.json", most=0.05)
    found = change(run, "--add", "b.json")
    equal(offsets_of(found), [[x + y for x, y in zip(*both)] for both in zip(offsets_of(content), offsets_of(other))])
    # In the order given: half of both is not half of one.
    near(offsets_of(change(run, "--add", "b.json", "--strength", "0.5")), [[d / 2 for d in p] for p in offsets_of(found)], 1e-17)
    near(offsets_of(change(run, "--strength", "0.5", "--add", "b.json")),
         [[x / 2 + y for x, y in zip(*both)] for both in zip(offsets_of(content), offsets_of(other))], 1e-17)


@case
def weights_change_as_displacements_do(run):
    rest = [1 + 0.1 * min(i % 4, 3 - i % 4) + 0.05 * (i // 4) for i in range(80)]  # symmetric along u
    moved = {}
    for name in ("a.json", "b.json"):
        content = write(run, name, most=0.02, weights=rest)
        content["deformed"]["weights"] = moved[name] = [h * RANDOM.uniform(0.98, 1.02) for h in rest]
        run.write(name, content)
    found = change(run, "--add", "b.json")
    equal(found["weights"], rest)
    near(found["deformed"]["weights"], [p + (q - h) for p, q, h in zip(moved["a.json"], moved["b.json"], rest)], 1e-15)
    near(change(run, "--strength", "0.5")["deformed"]["weights"], [(h + q) / 2 for h, q in zip(rest, moved["a.json"])], 1e-15)
    equal(change(run, "--mirror", "u")["deformed"]["weights"], [moved["a.json"][i - i % 4 + 3 - i % 4] for i in range(80)])
    found = change(run, "--invert", err=COVERS)
    equal([found["weights"], found["deformed"]["weights"]], [moved["a.json"], rest])


@case
def what_is_not_there_is_not_written(run):
    """No weights where all are 1 again, and no zero with a sign."""
    content = write(run, "a.json")
    content["deformed"]["weights"] = [1.0] * 79 + [2.0]
    run.write("weights.json", content)
    for operations in (["--blend", "weights.json,0"], ["--blend", "weights.json,0.5", "--add", "weights.json", "--seam", "C0:u+,v+,w+"]):
        found = change(run, *operations)
        check("weights" not in found and "weights" not in found["deformed"], operations)
    equal(change(run, "--strength", "0", source="weights.json").keys(), change(run, "--strength", "0").keys())
    run.write("a.json", {**content, "deformed": {"offsets": [[0.5, 0, -0.25]] + [[0, 0, 0]] * 79}})
    for operations in (["--mirror", "u"], ["--mirror", "v", "--mirror", "v"], ["--symmetrize", "w-"], ["--strength", "-1"], ["--strength", "-0.5"],
                       ["--invert", "-q"], ["--scale", "-1"], ["--rotate", "x,180"], ["--blend", "a.json,-1"]):
        change(run, *operations)
        check(not re.search(r"-0[],]", run.text("o.json")), operations)


def numpy_order(points, size):
    """Control points, u fastest, as an array (n_u, n_v, n_w, 3) has them."""
    n, m, o = size
    return [x for i in range(n) for j in range(m) for k in range(o) for x in points[i + n * (j + m * k)]]


@case
def control_points_that_a_file_has(run):
    content, other = write(run, "a.json"), write(run, "b.json")
    size, rest = content["size"], rest_points(content)
    moved, offsets = deformed_points(other), offsets_of(other)
    run.write("rest.json", {member: value for member, value in content.items() if member != "deformed"})
    change(run, "--strength", "1", source="b.json", target="same.json")
    for name in ("b.json", "b.csv"):
        if name == "b.csv":
            run.ffd("lattice", "convert", "b.json", "-o", "b.csv")
        for source in ("a.json", "rest.json"):
            change(run, "--deformed", name, source=source)
            equal(run.read("o.json"), run.read("same.json"), name)  # of one rest: to the bit
            change(run, "--deformed-offsets", name, source=source)
            equal(run.read("o.json"), run.read("same.json"), name)
    for name, points in (("moved", moved), ("offsets", offsets)):
        run.write(f"{name}-4.npy", array(numpy_order(points, size), "(4, 5, 4, 3)"))
        run.write(f"{name}-2.npy", array([x for p in points for x in p], "(80, 3)"))
        run.write(f"{name}.json", lattice(size=size, rest={"points": points}))
    for name in ("moved-4.npy", "moved-2.npy", "moved.json"):
        found = change(run, "--deformed", name)
        equal(rest_points(found), rest, name)
        near(offsets_of(found), [[q - p for p, q in zip(*both)] for both in zip(rest, moved)], 1e-15, name)
    for name in ("offsets-4.npy", "offsets-2.npy", "offsets.json"):
        equal(offsets_of(change(run, "--deformed-offsets", name)), offsets, name)
    # Zeros of a file that has offsets are zeros.
    run.ffd("lattice", "convert", "rest.json", "-o", "still.csv")
    check("deformed" not in change(run, "--deformed-offsets", "still.csv"), "nothing moves")
    # Moves of the other file count, and what follows works on the result.
    run.write("moves.json", lattice(size=size, moves=[{"at": [1, 2, 1], "by": [{"$": "X"}, 0, 0]}]))
    found = offsets_of(change(run, "--deformed", "moves.json", "--strength", "2", "--set", "X=0.25"))
    equal([i for i in range(80) if any(found[i])], [29])
    equal(found[29], [0.5, 0, 0])
    # A box round a mesh needs no positions for displacements.
    run.write("mesh.json", lattice(size=size, rest={"box": "mesh"}))
    found = change(run, "--deformed-offsets", "offsets-4.npy", source="mesh.json")
    equal([found["rest"]["box"], offsets_of(found)], ["mesh", offsets])


@case
def weights_that_a_file_has(run):
    weights, moved = [[RANDOM.uniform(0.5, 2) for _ in range(80)] for _ in range(2)]
    content = write(run, "a.json")
    heavy = write(run, "heavy.json", weights=weights)
    heavy["deformed"]["weights"] = moved
    run.write("heavy.json", heavy)
    for option in ("--deformed", "--deformed-offsets"):
        found = change(run, option, "heavy.json")
        equal([found["weights"], found["deformed"]["weights"], offsets_of(found)], [[1] * 80, moved, offsets_of(heavy)])
        found = change(run, option, "a.json", source="heavy.json")
        equal([found["weights"], found["deformed"]["weights"], offsets_of(found)], [weights, moved, offsets_of(content)])


@case
def files_whose_control_points_do_not_fit(run):
    write(run, "a.json")
    run.write("finer.json", lattice(size=(5, 5, 4)))
    run.write("mesh.json", lattice(size=(4, 5, 4), rest={"box": "mesh"}))
    run.write("few.npy", array([0.0] * 237, "(79, 3)"))
    run.write("turned.npy", array([0.0] * 240, "(5, 4, 4, 3)"))
    run.write("inf.npy", array([float("inf")] * 240, "(80, 3)"))
    run.write("none.csv", "i,j,k,x,y,z,dx,dy,dz\n")
    for operations, code, what in (
            (["--deformed", "finer.json"], INVALID, r"finer\.json: has 5 x 5 x 4 control points, but the lattice has 4 x 5 x 4"),
            (["--deformed-offsets", "turned.npy"], INVALID, r"turned\.npy: has 5 x 4 x 4 control points, but the lattice has 4 x 5 x 4"),
            (["--deformed", "few.npy"], INVALID, r"few\.npy: has 79 points, but the lattice has 4 x 5 x 4 control points"),
            (["--deformed", "inf.npy"], INVALID, r"inf\.npy: "), (["--deformed", "none.csv"], INVALID, r"none\.csv:2: there are no control points"),
            (["--deformed", "mesh.json"], INVALID, "need positions"), (["--deformed", "gone.npy"], IO, r"gone\.npy"),
            (["--deformed", ""], USAGE, "the name of a lattice"), (["--deformed", "a.obj"], INVALID, r"a\.obj"),
            (["--deformed", "turned.npy", "--set", "X=1"], INVALID, "placeholder"), (["--deformed", "turned.npy", "--block", "0"], USAGE, "block")):
        run.write("a.obj", CUBE)
        run.ffd("lattice", "set", "a.json", *operations, "-o", "o.json", code=code, lines=1, err=re.compile(what))
        check(not run.exists("o.json"), operations)
    run.ffd("lattice", "convert", "a.json", "-o", "a.csv")
    for operations in (["--add", "a.csv"], ["--blend", "a.csv,0.5"]):
        run.ffd("lattice", "set", "a.json", *operations, "-o", "o.json", code=INVALID, lines=1,
                err=re.compile("a\\.csv: is not JSON: of a table `ffd lattice convert` makes a lattice file"))
    run.write("own.csv", "")
    run.ffd("lattice", "set", "a.json", "--deformed", "own.csv", "-o", "own.csv", "--force", code=IO, lines=1, err=re.compile("is an input of this command"))


@case
def the_inverse_leads_back(run):
    for _ in range(repetitions(5)):
        write(run, "a.json", most=0.15)
        change(run, "--invert", target="back.json", err=COVERS)
        near(carried(run, carried(run, PLACES, "a.json"), "back.json"), PLACES, 1e-13)
        # Refined and inverted, in either order, is the same map.
        run.ffd("lattice", "refine", "a.json", "-o", "fine.json", "--size", "7", "--force")
        change(run, "--invert", source="fine.json", target="fine-back.json", err=re.compile("^fine.json: the inverse covers"))
        near(carried(run, carried(run, PLACES, "a.json"), "fine-back.json"), PLACES, 1e-13)
    change(run, "--invert", "-q", target="back.json")
    run.write("still.json", lattice())
    equal(change(run, "--invert", source="still.json").get("deformed"), None, "nothing moves, and nothing is outside")
    run.write("a.json", lattice(moves=[{"at": [1, 1, 1], "by": [60, 0, 0]}]))
    run.ffd("lattice", "set", "a.json", "--invert", "-o", "n.json", code=INVALID, lines=1,
            err=re.compile(r"a\.json: the lattice folds at u,v,w = .*: it has no inverse there"))
    check(not run.exists("n.json"))


@case
def places_elsewhere(run):
    """The map becomes M f M^-1: what M makes of a place moves to what M makes of its end."""
    write(run, "a.json", most=0.1)
    ends = carried(run, PLACES, "a.json")
    for operations, place in ((["--move", "1,-2,0.5"], lambda x, y, z: [x + 1, y - 2, z + 0.5]),
                              (["--rotate", "z,90,1,0,0"], lambda x, y, z: [1 - y, x - 1, z]),
                              (["--scale", "3,0,1,0"], lambda x, y, z: [3 * x, 3 * y - 2, 3 * z]),
                              (["--transform", "1,0.5,0,2, 0,1,0,0, 0,0,-2,0, 0,0,0,1".replace(" ", "")],
                               lambda x, y, z: [x + 0.5 * y + 2, y, -2 * z])):
        found = change(run, *operations)
        equal("box" in found["rest"], operations[0] != "--transform", operations)
        near(carried(run, [place(*p) for p in PLACES], "o.json"), [place(*p) for p in ends], 1e-13, operations)
    run.write("a.json", lattice(knots=["clamped", "closed", "clamped"], rest={"cylinder": {
        "center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}))
    check("points" in change(run, "--move", "1,0,0")["rest"] and "cylinder" in change(run, "--strength", "2")["rest"], "a cylinder")


@case
def held_faces_join_smoothly(run):
    """Towards a face held at Ck the displacement falls like the (k+1)-th power of the distance at least."""
    size = 8
    for knots in ([0, 0, 0, 0, 0.2, 0.4, 0.5, 0.8, 1, 1, 1, 1], list(range(12)), [-0.4, -0.3, -0.1, 0, 0.1, 0.3, 0.35, 0.8, 1, 1, 1.2, 1.5]):
        run.write("a.json", lattice(size=(size, 4, 4), knots=[knots, "clamped", "clamped"], deformed={"offsets": random_offsets(size * 16, 0.05)}))
        for k in (0, 1, 2):
            change(run, "--seam", f"C{k}:u-,u+")
            for end in (-2, 2):
                places = [[end * (1 - share), y, -0.2] for share in (0.002, 0.001) for y in (-1.5, -0.7, 0.3, 1.1)]
                moved = [max(abs(q - p) for p, q in zip(*both)) for both in zip(places, carried(run, places, "o.json"))]
                far, close = max(moved[:4]), max(moved[4:])
                check(0 < close and far > 0.8 * 2 ** (k + 1) * close, (knots, k, end, far, close))


@case
def what_a_seam_keeps(run):
    """Control points of other layers keep their bits where nothing is clamped; held ones have no offset, and their weights at rest."""
    content = write(run, "a.json", weights=[RANDOM.uniform(0.5, 2) for _ in range(80)])
    content["deformed"]["weights"] = [RANDOM.uniform(0.5, 2) for _ in range(80)]
    run.write("a.json", content)
    for seam, held in (("C1:u+", lambda i, j, k: i >= 2), ("C0:v-,w+", lambda i, j, k: j == 0 or k == 3),
                       ("C0:all", lambda i, j, k: i in (0, 3) or j in (0, 4) or k in (0, 3))):
        found = change(run, "--seam", seam)
        equal([found["knots"], found["rest"]["box"]["max"]], [["clamped"] * 3, [2, 2, 2]])
        for point in range(80):
            still = held(point % 4, point // 4 % 5, point // 20)
            equal(offsets_of(found)[point], [0, 0, 0] if still else offsets_of(content)[point], (seam, point))
            equal(found["deformed"]["weights"][point], (content if still else content["deformed"])["weights"][point], (seam, point))
    run.write("closed.json", lattice(size=(4, 5, 4), knots=["clamped", "closed", "clamped"], rest={"cylinder": {
        "center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}, deformed={"offsets": random_offsets(80)}))
    found = change(run, "--seam", "C0:all", source="closed.json")
    equal([any(offsets_of(found)[p]) for p in range(80)], [p % 4 in (1, 2) and p // 20 in (1, 2) for p in range(80)])
    write(run, "a.json")
    run.ffd("lattice", "set", "a.json", "--seam", "C1:u-,u+", "-o", "n.json", lines=1,
            err=re.compile("a\\.json: faces held at C1 leave nothing that moves of 4 x 5 x 4 control points"))
    check("deformed" not in json.loads(run.text("n.json")), "nothing moves")
    run.ffd("lattice", "set", "n.json", "--seam", "C1:u-,u+", "-o", "m.json")
    # A box that is not laid round a mesh yet.
    run.write("still.json", lattice(rest={"box": "mesh"}, knots=["open", "clamped", "clamped"], deformed={"offsets": [[0.25, 0, 0]] * 64}))
    found = change(run, "--seam", "C1:u-", source="still.json")
    equal([found["rest"]["box"], sum(any(p) for p in offsets_of(found))], ["mesh", (found["size"][0] - 2) * 16])


@case
def mirror_images(run):
    content = write(run, "a.json")
    found = offsets_of(change(run, "--mirror", "v"))
    for k in range(4):
        for j in range(5):
            for i in range(4):
                x, y, z = offsets_of(content)[i + 4 * (4 - j + 5 * k)]
                equal(found[i + 4 * (j + 5 * k)], [x, -y, z])
    found = offsets_of(change(run, "--symmetrize", "v-"))
    for k in range(4):
        for i in range(4):
            equal(found[i + 4 * (0 + 5 * k)], offsets_of(content)[i + 4 * (0 + 5 * k)], "the first half stays")
            x, _, z = offsets_of(content)[i + 4 * (2 + 5 * k)]
            equal(found[i + 4 * (2 + 5 * k)], [x, 0, z], "the middle layer")
            x, y, z = found[i + 4 * (1 + 5 * k)]
            equal(found[i + 4 * (3 + 5 * k)], [x, -y, z], "the other half")


@case
def what_cannot_be_is_refused(run):
    write(run, "a.json")
    run.write("finer.json", lattice(size=(5, 5, 4)))
    run.write("other.json", lattice(size=(4, 5, 4), low=(-2, -2, -1)))
    run.write("closed.json", lattice(size=(4, 5, 4), knots=["clamped", "closed", "clamped"], rest={"cylinder": {
        "center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}))
    run.write("odd.json", lattice(knots=[[0, 0, 0, 0, 0.3, 1, 1, 1, 1], "clamped", "clamped"], size=(5, 4, 4)))
    run.write("low.json", lattice(degree=(3, 1, 3)))
    run.write("heavy.json", lattice(size=(4, 5, 4), weights=[1.0] * 79 + [2.0], deformed={"weights": [1.5] * 80}))
    run.write("mesh.json", lattice(rest={"box": "mesh"}, moves=[{"at": [1, 1, 1], "by": [1, 0, 0]}]))
    run.write("a.obj", CUBE)
    for source, operations, code, what in (
            ("a.json", [], USAGE, "needs at least one operation"),
            ("a.json", ["--strength", "x"], USAGE, "a number"), ("a.json", ["--strength", "nan"], USAGE, "a number"),
            ("a.json", ["--blend", "a.json"], USAGE, "a lattice and a number"), ("a.json", ["--blend", ",1"], USAGE, "a lattice and a number"),
            ("a.json", ["--mirror", "x"], USAGE, "u, v or w"), ("a.json", ["--symmetrize", "u"], USAGE, "the half that stays"),
            ("a.json", ["--transform", "1,0,0"], USAGE, "16 numbers"),
            ("a.json", ["--transform", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,1,1"], USAGE, "the last row of the matrix is 0 0 1 1"),
            ("a.json", ["--move", "1,2"], USAGE, "three numbers"), ("a.json", ["--rotate", "90"], USAGE, "an axis and degrees"),
            ("a.json", ["--rotate", "y,90,1"], USAGE, "an axis and degrees"), ("a.json", ["--scale", ""], USAGE, "a factor"),
            ("a.json", ["--seam", "C1"], USAGE, "--seam without faces holds those that a mesh cuts"), ("a.json", ["--seam", "none:u-"], USAGE, "not C0, C1 or C2"), ("a.json", ["--seam", "C3:all"], USAGE, "not C0, C1, C2 or none"),
            ("a.json", ["--seam", "C1:u"], USAGE, "not C0, C1, C2 or none"), ("a.json", ["--seam", "C1:u-,"], USAGE, "not C0, C1, C2 or none"),
            ("a.json", ["--seam", "1:all"], USAGE, "not C0, C1, C2 or none"), ("closed.json", ["--seam", "C0:v+"], USAGE, "direction v is closed: it has no faces"),
            ("a.json", ["--seam", "C1:w-,x+"], USAGE, "not C0, C1, C2 or none"),
            ("low.json", ["--seam", "C1:u+,v-"], USAGE, "C1 needs degree 2 along v, which has degree 1"),
            ("a.json", ["--strength", "2", "--report", "r.json"], USAGE, "report"),
            ("a.json", ["--strength", "2", "--mesh", "a.obj"], USAGE, "--mesh cannot be used"),
            ("a.json", ["--scale", "0"], INVALID, "determinant of the matrix is 0"),
            ("a.json", ["--transform", "1,2,3,0,4,5,6,0,7,8,9,0,0,0,0,1"], INVALID, "determinant of the matrix is 0"),
            ("a.json", ["--move", "0,1e17,0"], INVALID, r"the box would have no extent along v there: it would reach from 1e\+17 to 1e\+17"),
            ("a.json", ["--move", "1.7e308,0,0", "--scale", "2"], INVALID, "a.json: "),
            ("a.json", ["--blend", "finer.json,0.5"], INVALID, "^finer.json: the two lattices differ in size: refine one of them"),
            ("a.json", ["--add", "a.json", "--add", "other.json"], INVALID, "^other.json: the two lattices differ in rest"), ("a.json", ["--add", "closed.json"], INVALID, "differ in knots"),
            ("a.json", ["--add", "heavy.json"], INVALID, "differ in weights at rest"), ("a.json", ["--add", "none.json"], IO, "none.json"),
            ("closed.json", ["--mirror", "v"], INVALID, "direction v is closed"), ("odd.json", ["--mirror", "u"], INVALID, "the knots along u are not symmetric"),
            ("heavy.json", ["--mirror", "u"], INVALID, "the weights at rest are not symmetric along u"),
            ("heavy.json", ["--strength", "-9"], INVALID, "weights are positive"),
            ("closed.json", ["--mirror", "u"], INVALID, "the first and the last layer of u have the same middle"),
            ("mesh.json", ["--strength", "2"], INVALID, "its moves need positions \\(--mesh\\)")):
        run.ffd("lattice", "set", source, *operations, "-o", "o.json", code=code, lines=1, err=re.compile(what))
        check(not run.exists("o.json"), operations)
    equal(change(run, "--strength", "2", "--mesh", "a.obj", source="mesh.json")["rest"]["box"]["max"], [1, 1, 1])
    run.write("still.json", lattice(rest={"box": "mesh", "margin": 0.1}, deformed={"offsets": [[0.25, 0, 0]] * 64}))
    found = change(run, "--strength", "2", "--add", "still.json", source="still.json", target="s.json")
    equal([found["rest"]["box"], offsets_of(found)[0]], ["mesh", [0.75, 0, 0]])
    run.ffd("lattice", "set", "still.json", "--mirror", "u", "-o", "none.json", code=INVALID, lines=1, err=re.compile("positions"))
    for words, code in ((["-o", "a.json", "--force"], IO), (["--add", "b.json", "-o", "b.json", "--force"], IO), (["-o", "o.obj"], USAGE), ([], USAGE)):
        write(run, "b.json")
        run.ffd("lattice", "set", "a.json", "--strength", "2", *words, code=code, lines=1, err=lambda lines: True)
    # The determinant is no number of double, but not 0.
    equal(change(run, "--scale", "1e-150", "--move", "0,0,0", "--scale", "1e150")["size"], [4, 5, 4])
    # A file name with a comma, and streams.
    run.write("b,c.json", run.read("a.json"))
    equal(offsets_of(change(run, "--blend", "b,c.json,0.25")), offsets_of(json.loads(run.text("a.json"))))
    out = run.ffd("lattice", "set", "-", "--strength", "2", "-o", "-", stdin=run.read("a.json"), data=True).out
    change(run, "--strength", "2")
    equal(out, run.read("o.json"))
    run.ffd("lattice", "set", "-", "--add", "-", "-o", "-", code=USAGE, lines=1, err=re.compile("standard input can be read only once"))


main()
