#!/usr/bin/env python3
"""ffd animate: lattices with keys played as morph targets, beside stills of them (--time) and within the bound that the report
gives. authoring/animate-*.json holds right answers."""

import json
import math
import os
import random
import re

from animations import Played
from author import reference_cases
from gltf_build import Scene
from harness import (CUBE, INVALID, IO, LIMIT, SANITIZED, UNSUPPORTED, USAGE, case, check, equal, glb, glb_positions, glb_split, gltf_json, lattice, main,
                     near, obj_vertices)
from messages import anything
from npy import npy

TWIST = {"twist": {"axis": "y", "degrees": {"$": "A"}}}
TURN = [{"time": 0, "set": {"A": 0}}, {"time": 1, "set": {"A": 120}}, {"time": 1.5, "set": {"A": 0}}]
SEED = int(os.environ.get("FFD_SEED", "") or random.randrange(10**9))
RANDOM = random.Random(SEED)
print(f"FFD_SEED={SEED}")


def cloud(count, reach=1.9):
    return [[struct_float(RANDOM.uniform(-reach, reach)) for _ in range(3)] for _ in range(count)]


def struct_float(x):
    """A number that single precision holds."""
    return round(x * 4096) / 4096


def write_points(run, points, name="m.glb"):
    run.write(name, glb(*gltf_json(points)))


def animated(run, *options, report=True, source="m.glb", **expected):
    """The entry of the report."""
    expected.setdefault("err", anything)
    words = ["--report", "r.json", "--report-stable"] if report else []
    run.ffd("animate", source, "o.glb", "-l", "k.json", "--force", *words, *options, **expected)
    return json.loads(run.text("r.json"))["jobs"][0] if report and not expected.get("code") else None


def still(run, time, *options):
    run.ffd("deform", "m.glb", "s.glb", "-l", "k.json", "--time", repr(time), "--force", "-q", *options, err=anything)
    return glb_positions(run.read("s.glb"))[0]


def slack(played, points):
    """Single precision of targets and weights: 2^-23 of the coordinates and of the sum of |w| times the targets; and that of the
    still, which is stored in single precision too."""
    most = max(abs(x) for p in points for x in p)
    heaviest = max(sum(map(abs, row)) for row in played.rows)
    largest = max((abs(x) for t in range(len(played.rows[0])) for p in played.target(t) for x in p), default=0)
    return 3 * 2**-23 * (most + (1 + heaviest) * (largest + most))


def check_played(run, entry, points, times, *options, name="k"):
    played, told = Played(run.read("o.glb"), name), entry["animation"]
    loose = slack(played, points)
    for time in times:
        off = max(math.dist(p, q) for p, q in zip(played.places(time), still(run, time, *options)))
        check(off <= told["bound"] + loose, f"at {time} a vertex is off by {off}, more than {told['bound']} and {loose}")
    return played


@case
def the_reference_cases(run):
    for name, of in reference_cases("animate"):
        run.write("k.json", of["lattice"])
        write_points(run, of["before"])
        entry = animated(run, "--targets", "keys")
        played = Played(run.read("o.glb"), "k")
        equal([len(played.rows[0]), entry["animation"]["targets"]], [of["expect"]["targets"]] * 2, name)
        for frame in of["expect"]["frames"]:
            near(played.weights(frame["time"]), frame["weights"], of["expect"]["tolerance"], f"{name}: weights at {frame['time']}")
            near(played.places(frame["time"]), frame["points"], of["expect"]["tolerance"], f"{name}: places at {frame['time']}")
            near(still(run, frame["time"]), frame["points"], of["expect"]["tolerance"], f"{name}: still at {frame['time']}")


def random_lattice():
    """A path of one of both kinds, and its last time."""
    size, time = [RANDOM.randint(3, 5) for _ in range(3)], RANDOM.choice([0, RANDOM.random()])
    count, keys = size[0] * size[1] * size[2], []
    of_values = RANDOM.random() < 0.5
    for _ in range(RANDOM.randint(2, 6)):
        if of_values:
            keys.append({"time": time, "set": {"A": RANDOM.uniform(-150, 150), "B": [RANDOM.uniform(-0.5, 0.5) for _ in range(3)]}})
        elif RANDOM.random() < 0.7:
            keys.append({"time": time, "offsets": [[RANDOM.uniform(-0.4, 0.4) for _ in range(3)] for _ in range(count)]})
        else:
            keys.append({"time": time, "moves": [{"at": ["all", -1, "all"], "by": [RANDOM.uniform(-1, 1), 0, 0]}]})
        time += RANDOM.uniform(0.05, 0.7)
    moves = [TWIST, {"at": ["all", "top", "all"], "by": {"$": "B"}}] if of_values else []
    return lattice(size=size, moves=moves, keys=keys), keys[0]["time"], keys[-1]["time"]


@case
def what_is_played_is_within_the_bound(run):
    """At samples and between them, whatever the targets are."""
    points = cloud(30, 2.5)
    write_points(run, points)
    for number in range(2 if SANITIZED else 14):
        content, first, last = random_lattice()
        run.write("k.json", content)
        options = RANDOM.choice([[], ["--targets", "keys"], ["--targets", str(RANDOM.randint(1, 4))]])
        tolerance = RANDOM.choice(["1e-2r", "1e-3r", "0.02"])
        entry = animated(run, "--tolerance", tolerance, "--fps", RANDOM.choice(["60", "10", "24"]), *options)
        told = entry["animation"]
        diagonal = math.sqrt(48)
        near([told["tolerance"]], [float(tolerance.rstrip("r")) * (diagonal if "r" in tolerance else 1)], 1e-12)
        if len(options) == 0 or options[1] == "keys":
            check(told["bound"] <= told["tolerance"], f"{number}: {told}")
        played = check_played(run, entry, points, [first - 1, last + 1] + [RANDOM.uniform(first, last) for _ in range(8)])
        equal([len(played.times), len(played.rows[0])], [told["keys"], told["targets"]])
        near([max(abs(w) for row in played.rows for w in row)], [told["largest_weight"]], 1e-6)
        equal([name for name in played.names], [f"k-{i + 1}" for i in range(told["targets"])])
        near([played.times[0], played.times[-1]], [first, last], 1e-6)


@case
def weights_and_held_faces_are_those_of_stills(run):
    """A vertex of weight 0 stays, and so does one at a held face."""
    points = cloud(30, 2.5) + [[0.5, 1.25, -2]]
    weights = [RANDOM.choice([0, 1, RANDOM.random()]) for _ in points]
    write_points(run, points)
    run.write("w.npy", npy(weights))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    for options in (["--weight", "w.npy"], ["--seam", "C1:w-"], ["--weight", "1-w.npy", "--seam", "C0:all"]):
        entry = animated(run, *options)
        played, told = Played(run.read("o.glb"), "k"), entry["animation"]
        loose = slack(played, points)
        for time in (0.25, 1, 1.4):
            places, expected = played.places(time), still(run, time, *options)
            check(max(map(math.dist, places, expected)) <= told["bound"] + loose, f"{options} at {time}")
            for v, (place, point) in enumerate(zip(places, points)):
                if options[:2] == ["--weight", "w.npy"] and weights[v] == 0 or "--seam" in options and v == len(points) - 1:
                    near(place, point, loose, f"{options}: vertex {v} moves")
    animated(run, "--weight", "attribute:_MASK", report=False, code=INVALID, err=anything)


@case
def faces_are_held_at_all_times(run):
    """--seam: the bound holds beside stills with the same faces."""
    points = cloud(30, 2.5)
    write_points(run, points)
    for _ in range(2 if SANITIZED else 6):
        content, first, last = random_lattice()
        run.write("k.json", {**content, "knots": [RANDOM.choice(["clamped", "uniform"]) for _ in range(3)], "degree": [2, 2, 2]})
        seam = ["--seam", RANDOM.choice(["C0:u-", "C0:v+,w-", "C1:w+", "C1:v-"])]
        entry = animated(run, *RANDOM.choice([[], ["--targets", "keys"]]), *seam)
        if entry["animation"]["targets"]:
            played = Played(run.read("o.glb"), "k")
            check_played(run, entry, points, [first, last] + [RANDOM.uniform(first, last) for _ in range(6)], *seam)
    # What the mesh cuts is found once, and is the same at all times.
    n = 9
    sheet = [[-3 + 6 * i / (n - 1), -1 + 2 * j / (n - 1), 0.2] for j in range(n) for i in range(n)]
    run.write("m.obj", "".join("v %r %r %r\n" % tuple(p) for p in sheet) + "".join(
        "f %d %d %d %d\n" % (a, a + 1, a + n + 1, a + n) for a in range(1, n * (n - 1)) if a % n))
    run.write("k.json", lattice(size=(6, 5, 4), moves=[{"at": ["all", [1, 3], "all"], "by": {"$": "B"}}], keys=[
        {"time": 0, "set": {"B": [0, 0, 0]}}, {"time": 1, "set": {"B": [0, 0.5, 0.4]}}, {"time": 2, "set": {"B": [0.6, 0, 0.1]}}]))
    said = run.ffd("animate", "m.obj", "o.glb", "-l", "k.json", "--seam", "C1", "--force", err=anything).err
    equal(len([line for line in said if "k.json: the mesh cuts 2 faces, held at C1: u- u+" in line]), 1, said)
    cut = run.read("o.glb")
    run.ffd("animate", "m.obj", "o.glb", "-l", "k.json", "--seam", "C1:u-,u+", "--force", err=anything)
    equal(run.read("o.glb"), cut)
    run.write("k.json", lattice(degree=(1, 3, 3), moves=[TWIST], keys=TURN))
    run.ffd("animate", "m.obj", "n.glb", "-l", "k.json", "--seam", "C1", code=USAGE, err=re.compile("C1 needs degree 2 along u"))
    check(not run.exists("n.glb"))


@case
def targets_are_shapes_of_the_path_in_the_order_of_their_times(run):
    points = cloud(20)
    write_points(run, points)
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    for options in ([], ["--targets", "3"], ["--targets", "keys"]):
        animated(run, *options)
        played, before = Played(run.read("o.glb"), "k"), -1
        for number in range(len(played.rows[0])):
            # The weights are 1 and 0 where the shape is a kept time; find its time by its own target.
            shape = [[a + b for a, b in zip(p, o)] for p, o in zip(points, played.target(number))]
            own = [time for time, row in zip(played.times, played.rows) if row == [float(i == number) for i in range(len(row))]]
            for time in own[:1]:
                near(still(run, time), shape, 1e-5, f"target {number} at {time}")
                check(time > before, "the order of times")
                before = time
        check(before >= 0, "some target's time is kept")


@case
def a_path_of_two_shapes_needs_two_targets(run):
    """D(t) = a(t) D1 + b(t) D2 plays exactly with two targets, however many keys it has."""
    points = cloud(25)
    write_points(run, points)
    shapes = [[[RANDOM.uniform(-0.4, 0.4) for _ in range(3)] for _ in range(64)] for _ in range(2)]
    keys = [{"time": 0.1 * k, "offsets": [[math.cos(k) * a + math.sin(2 * k) * b for a, b in zip(p, q)] for p, q in zip(*shapes)]} for k in range(25)]
    run.write("k.json", lattice(keys=keys))
    entry = animated(run)
    equal(entry["animation"]["targets"], 2)
    equal(entry["animation"]["samples"], 25)
    check(entry["animation"]["bound"] < 1e-3 * math.sqrt(48), "bound")
    check_played(run, entry, points, [0.1 * k + 0.03 for k in range(24)])
    told = animated(run, "--targets", "7", "--tolerance", "1e-6")["animation"]
    equal(told["targets"], 2)  # all is exact with these
    check(told["bound"] < 3e-6, "bound")


@case
def times_that_others_reproduce_are_dropped(run):
    write_points(run, cloud(10))
    ends = [[0.5, 0.25, 0]] * 64
    straight = [{"time": t, "offsets": [[t / 8 * x for x in p] for p in ends]} for t in range(9)]
    run.write("k.json", lattice(keys=straight))
    told = animated(run)["animation"]
    equal([told["targets"], told["keys"], told["samples"]], [1, 2, 9])
    corner = straight[:5] + [{"time": 4 + t, "offsets": [[(4 - t) / 8 * x for x in p] for p in ends]} for t in range(1, 5)]
    run.write("k.json", lattice(keys=corner))
    told = animated(run)["animation"]
    equal([told["targets"], told["keys"]], [1, 3])
    equal(Played(run.read("o.glb"), "k").times, [0.0, 4.0, 8.0])
    # With a target for each key all keys stay.
    told = animated(run, "--targets", "keys")["animation"]
    equal([told["targets"], told["keys"], told["bound"]], [7, 9, 0])


@case
def few_targets_are_off_with_a_warning(run):
    write_points(run, cloud(10))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    whole = animated(run)["animation"]
    told = animated(run, "--targets", "1", err=lambda said: check(any("more than the tolerance of" in line for line in said), said))["animation"]
    equal(told["targets"], 1)
    check(told["bound"] > told["tolerance"] >= whole["bound"], "bounds")
    # The tolerance rules the times alone then.
    check(told["keys"] < told["samples"], "times are dropped")


@case
def fast_paths_are_sampled_more_often(run):
    """180 degrees in a fifth of a second at 10 samples a second."""
    points = cloud(20)
    write_points(run, points)
    keys = [{"time": 0, "set": {"A": 0}}, {"time": 0.2, "set": {"A": 180}}]
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=keys))
    coarse, fine = (animated(run, "--fps", "10", "--tolerance", tolerance) for tolerance in ("100", "1e-3r"))
    equal(coarse["animation"]["samples"], 3)
    check(fine["animation"]["samples"] > 20, fine)
    check_played(run, fine, points, [0.01 * k for k in range(20)])
    equal(animated(run, "--tolerance", "100")["animation"]["samples"], 13)  # ceil(60 x 0.2) parts
    equal(animated(run, "--tolerance", "100", "--fps", "1")["animation"]["samples"], 2)


@case
def nothing_moves_at_any_time(run):
    write_points(run, cloud(5))
    run.write("k.json", lattice(moves=[TWIST], keys=[{"time": 0, "set": {"A": 0}}, {"time": 1, "set": {"A": 360}}], size=(2, 2, 2), degree=[1, 1, 1]))
    run.write("k.json", lattice(keys=[{"time": 0, "moves": []}, {"time": 1, "offsets": [[0, 1e-14, 0]] * 64}]))
    entry = animated(run, err=lambda said: equal(said, ["m.glb: k.json moves no control point at any time: there are no morph targets, and no animation"]))
    equal([entry["animation"]["targets"], entry["animation"]["keys"], entry["animation"]["bytes"]], [0, 0, 0])
    equal(run.read("o.glb"), run.read("m.glb"))
    # Only what no vertex follows.
    write_points(run, [[9.0, 9.0, 9.0], [9.0, 9.5, 9.0]])
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    equal(animated(run)["animation"]["targets"], 0)
    equal(run.read("o.glb"), run.read("m.glb"))


@case
def a_mesh_gets_the_targets_that_move_it(run):
    """Two meshes at two ends of a lattice, of which one moves first and then the other; the same times and weights."""
    scene = Scene(nodes=[{"mesh": 0}, {"mesh": 1}], scenes=[{"nodes": [0, 1]}])
    ends = ([[-1.5, -1.9, 0.0], [-1.2, -1.8, 0.5]], [[1.5, 1.9, 0.0], [1.2, 1.8, 0.5]])
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add(points, bounds=True)}, "mode": 0}]} for points in ends]
    run.write("m.glb", scene.glb())
    sizes = {"size": (8, 8, 8)}
    keys = [{"time": 0, "moves": []}, {"time": 1, "moves": [{"at": ["all", [0, 1], "all"], "by": [0.3, 0, 0]}]},
            {"time": 2, "moves": [{"at": ["all", [6, 7], "all"], "by": [0, 0, 0.4]}]}]
    run.write("k.json", lattice(keys=keys, **sizes))
    entry = animated(run, "--name", "wave")
    equal(entry["animation"]["targets"], 1)
    both = [Played(run.read("o.glb"), "wave", node) for node in (0, 1)]
    equal([one.names for one in both], [["wave-1"], ["wave-2"]])
    equal(both[0].times, both[1].times)
    equal([[one.weights(t)[0] for t in (0, 1, 2)] for one in both], [[0, 1, 0], [0, 0, 1]])
    equal([mesh["weights"] for mesh in both[0].asset["meshes"]], [[0], [0]])


@case
def offsets_of_zero_are_not_stored(run):
    inside, outside = cloud(10, 1.5), [[9.0 + i / 64, 0.0, 0.0] for i in range(20)]
    write_points(run, inside + outside)
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    animated(run)
    played = Played(run.read("o.glb"), "k")
    accessor = played.asset["accessors"][played.mesh["primitives"][0]["targets"][0]["POSITION"]]
    equal([accessor["sparse"]["count"], accessor["count"], "bufferView" in accessor], [10, 30, False])
    write_points(run, inside + outside[:19])
    animated(run)
    played = Played(run.read("o.glb"), "k")
    check("sparse" not in played.asset["accessors"][played.mesh["primitives"][0]["targets"][0]["POSITION"]], "19 of 29 are 0: less than two thirds")


@case
def normals_are_differences_of_those_of_each_target(run):
    points = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 1.0, 0.5]]
    normals = [[0.0, 0.0, 1.0], [0.6000000238418579, 0.0, 0.800000011920929], [1.0, 0.0, 0.0]]
    run.write("m.glb", glb(*gltf_json(points, normals=normals)))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    animated(run, "--targets", "2", err=lambda said: equal(sum("normals are those of each morph target alone" in line for line in said), 1))
    played = Played(run.read("o.glb"), "k")
    for number in range(2):
        time = next(time for time, row in zip(played.times, played.rows) if row[number] == 1 and sum(map(abs, row)) == 1)
        still(run, time)
        asset, data = glb_split(run.read("s.glb"))
        shown = Played.__new__(Played)
        shown.asset, shown.data, shown.mesh = asset, data, asset["meshes"][0]
        from animations import vectors
        right = vectors(asset, data, shown.mesh["primitives"][0]["attributes"]["NORMAL"])
        near([[a + b for a, b in zip(n, o)] for n, o in zip(normals, played.target(number, "NORMAL"))], right, 1e-6)
    animated(run, "--normals", "keep", err=lambda said: equal(any("normals" in line for line in said), False))
    equal(list(Played(run.read("o.glb"), "k").mesh["primitives"][0]["targets"][0]), ["POSITION"])


@case
def what_was_there_is_replaced_or_extended(run):
    """An animation and targets of these names are replaced, with a note; others keep their weights, and animations of weights get 0."""
    write_points(run, cloud(10))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    animated(run, "--name", "old", "--targets", "2")
    os.rename(run.path("o.glb"), run.path("m.glb"))
    animated(run, "--targets", "3")
    new, old = (Played(run.read("o.glb"), name) for name in ("k", "old"))
    equal(new.names, ["old-1", "old-2", "k-1", "k-2", "k-3"])
    check(all(row[2:] == [0, 0, 0] for row in old.rows) and all(row[:2] == [0, 0] for row in new.rows), "zeros")
    size = os.path.getsize(run.path("o.glb"))
    os.rename(run.path("o.glb"), run.path("m.glb"))
    said = []
    entry = animated(run, "--targets", "3", err=said.extend)
    check(any('has an animation "k" already: it is replaced' in line for line in said), said)
    check(any('has a morph target "k-1" already: it is replaced' in line for line in said), said)
    equal(Played(run.read("o.glb"), "k").names, new.names)
    equal(entry["animation"]["bytes"], os.path.getsize(run.path("o.glb")) - size)


@case
def nodes_that_see_other_results_get_copies(run):
    scene = Scene(nodes=[{"mesh": 0}, {"mesh": 0, "translation": [0, 1, 0]}], scenes=[{"nodes": [0, 1]}])
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add([[0.5, -1.0, 0.25], [0.25, 0.5, 0.5]], bounds=True)}, "mode": 0}]}]
    run.write("m.glb", scene.glb())
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    animated(run)
    low, high = (Played(run.read("o.glb"), "k", node) for node in (0, 1))
    check(low.asset["nodes"][0]["mesh"] != low.asset["nodes"][1]["mesh"], "a mesh of its own")
    check(low.places(1) != high.places(1), "another shape")


@case
def other_formats_are_converted(run):
    run.write("m.obj", CUBE)
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    entry = animated(run, source="m.obj")
    played = Played(run.read("o.glb"), "k")
    check(entry["animation"]["bytes"] > 0, entry)
    for time in (0.3, 1, 1.4):
        run.ffd("deform", "m.obj", "s.glb", "-l", "k.json", "--time", str(time), "--force", err=anything)
        right = glb_positions(run.read("s.glb"))[0]
        found = played.places(time)
        check(max(math.dist(p, q) for p, q in zip(sorted(found), sorted(right))) <= entry["animation"]["bound"] + 1e-6, time)
    run.ffd("animate", "m.obj", "o.gltf", "-l", "k.json", err=anything)
    run.ffd("animate", "m.obj", "o.vrm", "-l", "k.json", err=anything)
    equal(run.read("o.vrm"), run.read("o.glb"))


@case
def the_report_is_whole_and_stable(run):
    points = cloud(8) + [[9.0, 9.0, 9.0]]
    write_points(run, points)
    run.write("turning.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    run.ffd("animate", "m.glb", "o.glb", "-l", "turning.json", "--report", "r.json", err=anything)
    entry = json.loads(run.text("r.json"))["jobs"][0]
    equal(list(entry), ["input", "output", "outputs", "status", "exit", "error", "vertices", "inside", "outside", "multiple", "singular", "invalid",
                        "animation", "seconds"])
    equal([entry[key] for key in ("input", "output", "outputs", "status", "exit", "error", "vertices", "inside", "outside", "multiple", "singular", "invalid")],
          ["m.glb", "o.glb", ["o.glb"], "ok", 0, None, 9, 8, 1, 0, 0, 0])
    equal(list(entry["animation"]), ["name", "targets", "keys", "samples", "tolerance", "bound", "largest_weight", "bytes"])
    equal(entry["animation"]["name"], "turning")
    equal(entry["animation"]["bytes"], os.path.getsize(run.path("o.glb")) - os.path.getsize(run.path("m.glb")))
    equal(list(entry["seconds"]), ["read", "plan", "deform", "write"])
    run.ffd("animate", "m.glb", "o.glb", "-l", "turning.json", "--report", "r.json", code=IO, lines=1, err=re.compile("o.glb"))
    entry = json.loads(run.text("r.json"))["jobs"][0]
    equal([entry["status"], entry["exit"], entry["animation"]], ["failed", IO, None])


@case
def the_same_bytes_with_any_threads_and_instructions(run):
    write_points(run, cloud(5000))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    for options in ([], ["--targets", "keys", "--tolerance", "1e-2r"]):
        made = set()
        for more in (["--threads", "1"], ["--threads", "2"], ["--isa", "scalar"], ["--isa", "auto"]):
            entry = animated(run, *options, *more)
            made.add((run.read("o.glb"), json.dumps(entry["animation"])))
        equal(len(made), 1)


@case
def options_of_deform_are_taken(run):
    points = cloud(8) + [[2.5, 0.0, 0.0]]
    write_points(run, points)
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST, {"scale": {"factor": {"$": "F"}}}], keys=TURN))
    entry = animated(run, "--set", "F=1.2", "--outside", "extend", "--falloff", "4")
    played = Played(run.read("o.glb"), "k")
    off = max(math.dist(p, q) for p, q in zip(played.places(1), still(run, 1.0, "--set", "F=1.2", "--outside", "extend", "--falloff", "4")))
    check(off <= entry["animation"]["bound"] + 1e-5, off)
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    run.ffd("animate", "m.glb", "d.glb", "-l", "k.json", "--depfile", "d.d", err=anything)
    equal(run.text("d.d"), "d.glb: m.glb k.json\nm.glb:\nk.json:\n" if "\nm.glb:" in run.text("d.d") else "d.glb: m.glb k.json\n")
    before = os.stat(run.path("d.glb")).st_mtime_ns
    run.ffd("animate", "m.glb", "d.glb", "-l", "k.json", "--if-changed", err=anything)
    equal(os.stat(run.path("d.glb")).st_mtime_ns, before)
    content = {"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": "mesh", "margin": 0.1}, "moves": [TWIST], "keys": TURN}
    run.write("k.json", content)
    check_played(run, animated(run), points, [0.2, 0.9, 1.3])


@case
def many_targets_bring_a_warning(run):
    write_points(run, cloud(10))
    run.write("k.json", lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN))
    entry = animated(run, "--targets", "keys", err=lambda said: check(any("some viewers play only 8" in line for line in said), said))
    check(entry["animation"]["targets"] > 8, entry)


@case
def what_cannot_be_is_refused(run):
    write_points(run, cloud(4))
    run.write("m.obj", CUBE)
    good = lattice(size=(4, 6, 4), moves=[TWIST], keys=TURN)
    run.write("k.json", good)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    files = run.names()
    base = ["animate", "m.glb", "o.glb", "-l", "k.json"]
    for words, what in (
            (["animate", "m.glb", "o.glb"], "no lattice is given"), (base + ["-l", "k.json"], "one lattice"), (["animate", "m.glb", "-l", "k.json"], "IN and OUT"),
            (["animate", "m.glb", "o.obj", "-l", "k.json"], "cannot hold an animation"), (["animate", "m.glb", "o.ply", "-l", "k.json"], "cannot hold"),
            (["animate", "m.glb", "o.xyz", "-l", "k.json"], "cannot hold"), (["animate", "m.xyz", "o.glb", "-l", "k.json"], "xyz"),
            (["animate", "-", "o.glb", "-l", "k.json"], "streams"), (["animate", "m.glb", "-", "-l", "k.json"], "streams"),
            (base + ["--tolerance", "0"], "not a number above 0"), (base + ["--tolerance", "-1"], "--tolerance"), (base + ["--tolerance", "x"], "--tolerance"),
            (base + ["--fps", "0.5"], "1 to 1000"), (base + ["--fps", "1001"], "1 to 1000"), (base + ["--fps", "nan"], "1 to 1000"),
            (base + ["--targets", "0"], "auto, keys or a number"), (base + ["--targets", "1.5"], "auto, keys"), (base + ["--targets", "some"], "auto, keys"),
            (base + ["--name", ""], "--name"), (base + ["--name", "x" * 256], "1 to 255 bytes"), (base + ["--normals", "recompute"], "recompute"),
            (base + ["--rig", "follow"], "--rig"), (base + ["--rig", "keep"], "--rig"), (base + ["--blocks"], "--blocks"), (base + ["--as-morph", "a"], "--as-morph"), (base + ["--time", "1"], "--time"),
            (base + ["--morph", "a=k.json"], "--morph"), (base + ["--fail-on", "folds"], "--fail-on"), (base + ["--embedding", "e.npy"], "--embedding"),
            (base + ["--in-place"], "--in-place"), (base + ["--out-dir", "d"], "--out-dir"), (base + ["--output-format", "glb"], "--output-format"),
            (base + ["--input-format", "glb"], "--input-format"), (base + ["--shared-box"], "--shared-box"), (base + ["--clip", "a: 0"], "--clip"),
            (base + ["--set", "A=1"], "the keys do"), (base + ["--report-stable"], "needs --report"), (base + ["--falloff", "1"], "needs --outside extend")):
        run.ffd(*words, code=USAGE, err=lambda said, what=what, words=words: check(what in said[0], f"{words}: {said}"), lines=None)
        equal(run.names(), files, words)
    for content, code, what in (
            (json.loads(run.text("l.json")), INVALID, "has no keys: there is nothing to animate"),
            ({**good, "moves": [{"jitter": {"sigma": 1, "seed": {"$": "A"}}}]}, INVALID, "is not a whole number"),
            ({**good, "moves": [TWIST, {"scale": {"factor": {"$": "F"}}}]}, INVALID, 'the placeholder "F" has no value'),
            (lattice(size=[3, 5, 3], degree=[2, 2, 2], knots=["clamped", [0, 0, 0, 1, 1, 2, 2, 2], "clamped"],
                     moves=[{"bend": {"axis": "y", "toward": "x", "degrees": {"$": "A"}, "exact": True}}], keys=TURN), UNSUPPORTED, "the weights of control points move"),
            ({**good, "keys": [{"time": 0, "set": {"A": 0}}, {"time": 100000, "set": {"A": 1}}]}, LIMIT, "memory")):
        run.write("k.json", content)
        run.ffd(*base, code=code, err=re.compile(re.escape(what)), lines=1)
        equal(run.names(), files, what)
    run.write("k.json", good)
    run.ffd("animate", "none.glb", "o.glb", "-l", "k.json", code=IO, lines=1)
    run.ffd("animate", "m.glb", "o.glb", "-l", "none.json", code=IO, lines=1)
    run.ffd("animate", "m.glb", "m.glb", "-l", "k.json", "--force", code=IO, lines=1, err=re.compile("is the input"))
    equal(run.names(), files)
    keys = [{"time": t, "offsets": [[t + 1.0, 0, 0]] * 8} for t in range(1100)]
    run.write("k.json", lattice(size=(2, 2, 2), keys=keys))
    run.ffd(*base, "--targets", "keys", code=LIMIT, lines=1, err=re.compile("would have 1100 morph targets, more than 1024"))
    run.ffd(*base, "--timeout", "1e-9", code=LIMIT, lines=1, err=re.compile("timeout"))
    equal(run.names(), files)


main()
