#!/usr/bin/env python3
"""Lattices with keys: stills at a time (--time), what `info` tells of them, and what is refused. authoring/time-*.json and
authoring/animate-*.json hold right answers."""

import json
import math
import re

from author import deformed_points, offsets_of, reference_cases
from harness import CUBE, EMBEDDING, INVALID, IO, NO, USAGE, case, check, equal, lattice, main, near, obj_of, obj_vertices

TURN = {"twist": {"axis": "y", "degrees": {"$": "A"}}}
SETS = [{"time": 1, "set": {"A": 0}}, {"time": 2, "set": {"A": 90}}, {"time": 4, "set": {"A": 30}}]


def shift(*by):
    return [{"at": ["all", 3, "all"], "by": list(by)}]


def moved(run, keys, time, moves=(), *options, **members):
    """The offsets of a lattice of 4^3 points with these keys at a time."""
    run.write("k.json", lattice(moves=list(moves), keys=keys, **members))
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "o.json", "--force", "--time", str(time), *options)
    return offsets_of(json.loads(run.text("o.json")))


@case
def the_reference_cases(run):
    for kind in ("time", "animate"):
        for name, of in reference_cases(kind):
            run.write("l.json", of["lattice"])
            run.write("m.obj", obj_of(of["before"]))
            for frame in of["expect"]["frames"]:
                run.ffd("deform", "m.obj", "o.obj", "-l", "l.json", "--time", repr(frame["time"]), "--force", "-q")
                near(obj_vertices(run.text("o.obj")), frame["points"], of["expect"]["tolerance"], f"{name} at {frame['time']}")


@case
def values_go_linearly_between_keys(run):
    for time, angle in ((0, 0), (-3, 0), (1, 0), (1.5, 45), (2, 90), (3, 60), (4, 30), (99, 30)):
        found = moved(run, SETS, time, [TURN])
        run.write("l.json", lattice(moves=[TURN]))
        run.ffd("lattice", "set", "l.json", "--strength", "1", "-o", "o.json", "--force", "--set", f"A={angle}")
        equal(found, offsets_of(json.loads(run.text("o.json"))), time)


@case
def arrays_of_values_and_other_placeholders(run):
    moves = [{"at": ["all", 3, "all"], "by": {"$": "-S", "times": 0.5}}, {"scale": {"factor": {"$": "F"}}}]
    keys = [{"time": 0, "set": {"S": [0, 2, 4]}}, {"time": 1, "set": {"S": [4, 2, 0]}, "comment": "the end"}]
    half = {"parameters": {"F": {"default": 1}, "S": {"min": 0, "max": 4}}}
    found = moved(run, keys, 0.25, moves, **half)
    near(found[12], [-0.5, -1, -1.5], 1e-15)
    equal(found[0], [0, 0, 0])
    near(moved(run, keys, 0.25, moves, "--set", "F=2", **half)[0], [2 * x - x for x in (-2, -2, -2)], 1)
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "o.json", "--force", "--time", "0", "--set", "S=[0,0,0]", code=USAGE, lines=1,
            err=re.compile('--set cannot give "S": the keys do'))
    run.write("k.json", lattice(moves=moves, keys=keys))
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "n.json", "--time", "0", code=INVALID, lines=1,
            err=re.compile('the placeholder "F" has no value'))


@case
def points_go_straight_between_keys(run):
    offsets = [[0, 0, 0]] * 64
    ends = [[0.5 * i, 0, 1] for i in range(64)]
    keys = [{"time": 0.5, "offsets": offsets}, {"time": 1.5, "moves": shift(1, 2, 3)}, {"time": 2, "offsets": ends}]
    equal(moved(run, keys, 0), offsets)
    near(moved(run, keys, 1)[12], [0.5, 1, 1.5], 1e-15)
    equal(moved(run, keys, 1)[0], [0, 0, 0])
    near(moved(run, keys, 1.75)[12], [(1 + 6) / 2, 1, 2], 1e-15)
    equal(moved(run, keys, 7), ends)
    # Moves of a key start from the points of `deformed`, each key by itself.
    start = [[0, 0, 1]] * 64
    keys = [{"time": 0, "moves": shift(1, 0, 0)}, {"time": 1, "moves": shift(2, 0, 0)}]
    found = moved(run, keys, 0.5, deformed={"offsets": start})
    near([found[0], found[12]], [[0, 0, 1], [1.5, 0, 1]], 1e-15)


@case
def moves_of_keys_have_placeholders_and_weights(run):
    keys = [{"time": 0, "moves": []}, {"time": 1, "moves": [{"at": ["all", 3, "all"], "by": [{"$": "X"}, 0, 0]}]}]
    near(moved(run, keys, 0.5, (), "--set", "X=3")[12], [1.5, 0, 0], 1e-15)
    bend = {"bend": {"axis": "y", "toward": "x", "degrees": 90, "exact": True}}
    run.write("k.json", lattice(size=[3, 5, 3], degree=[2, 2, 2], knots=["clamped", [0, 0, 0, 1, 1, 2, 2, 2], "clamped"],
                                keys=[{"time": 0, "moves": []}, {"time": 1, "moves": [bend]}]))
    weights = []
    for time in ("0", "0.5", "1"):
        run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "o.json", "--force", "--time", time)
        weights.append(json.loads(run.text("o.json")).get("deformed", {}).get("weights", [1] * 45))
    near(weights[1], [(1 + w) / 2 for w in weights[2]], 1e-15)
    near(weights[2][3:4], [math.cos(math.pi / 8)], 1e-15)


@case
def a_still_is_that_of_a_lattice_without_keys(run):
    run.write("a.obj", CUBE)
    run.write("k.json", lattice(moves=[TURN], keys=SETS))
    run.write("l.json", lattice(moves=[{"twist": {"axis": "y", "degrees": 45}}]))
    for command, end in ((["deform", "a.obj"], "obj"), (["view", "a.obj", "-o"], "png")):
        run.ffd(*command, f"k.{end}", "-l", "k.json", "--time", "1.5", "--force")
        run.ffd(*command, f"l.{end}", "-l", "l.json", "--force")
        equal(run.read(f"k.{end}"), run.read(f"l.{end}"), end)
    run.ffd("jacobian", "a.obj", "-l", "k.json", "--time", "1.5", "-o", "k.npz", data=True)
    run.ffd("jacobian", "a.obj", "-l", "l.json", "-o", "l.npz", data=True)
    equal(run.read("k.npz"), run.read("l.npz"))
    told = [run.ffd("check", "a.obj", "-l", name, "--report", "-", "--report-stable", *more).json["jobs"][0]
            for name, more in (("k.json", ["--time", "1.5"]), ("l.json", []))]
    equal(told[0], told[1])
    # The first key without --time; each lattice of a chain has its own.
    run.ffd("deform", "a.obj", "f.obj", "-l", "k.json", lines=1, err=re.compile("no vertex moves: the move of k.json moves no control point"))
    equal(run.read("f.obj"), run.read("a.obj"))
    run.ffd("deform", "a.obj", "two.obj", "-l", "l.json", "-l", "k.json", "--time", "1.5", "--force")
    run.ffd("deform", "a.obj", "both.obj", "-l", "l.json", "-l", "l.json", "--force")
    equal(run.read("two.obj"), run.read("both.obj"))


@case
def a_box_round_a_mesh_and_chosen_moments(run):
    run.write("a.obj", CUBE)
    content = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh"}, "units": "box", "moves": [TURN], "keys": SETS}
    run.write("k.json", content)
    run.ffd("deform", "a.obj", "k.obj", "-l", "k.json", "--time", "1.5")
    content["moves"], content["keys"] = [{"twist": {"axis": "y", "degrees": 45}}], None
    del content["keys"]
    run.write("l.json", content)
    run.ffd("deform", "a.obj", "l.obj", "-l", "l.json")
    equal(run.read("k.obj"), run.read("l.obj"))
    # Offsets need no mesh; moves do.
    ends = [[0.5 * i, 0, 1] for i in range(64)]
    content["moves"], content["keys"] = [], [{"time": 0, "offsets": [[0, 0, 0]] * 64}, {"time": 2, "offsets": ends}]
    run.write("k.json", content)
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "o.json", "--time", "1")
    made = json.loads(run.text("o.json"))
    equal([offsets_of(made), made["rest"]["box"]], [[[x / 2 for x in p] for p in ends], "mesh"])
    content["keys"][1] = {"time": 2, "moves": shift(1, 0, 0)}
    run.write("k.json", content)
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "p.json", "--time", "1", code=INVALID, lines=1, err=re.compile("positions"))
    run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "p.json", "--time", "1", "--mesh", "a.obj")


@case
def refine_and_convert_take_a_moment(run):
    run.write("k.json", lattice(moves=[TURN], keys=SETS))
    run.write("l.json", lattice(moves=[{"twist": {"axis": "y", "degrees": 45}}]))
    for command in (["refine", "--size", "6"], ["convert"], ["set", "--strength", "0.5"], ["set", "--blend", "k.json,0.3"]):
        made = []
        for name, more in (("k.json", ["--time", "1.5"]), ("l.json", [])):
            if name == "l.json" and "k.json,0.3" in command:
                command = [*command[:2], "l.json,0.3"]
            run.ffd("lattice", command[0], name, *command[1:], "-o", "o.json", "--force", *more)
            made.append(run.read("o.json"))
        equal(made[0], made[1], command)
        run.ffd("lattice", command[0], "k.json", *command[1:], "-o", "p.json", code=USAGE, lines=1,
                err=re.compile(r"has keys, and one moment of them is needed \(--time\)"))
        run.ffd("lattice", command[0], "l.json", *command[1:], "-o", "p.json", "--time", "1", code=USAGE, lines=1, err=re.compile("keys: --time is for"))
    run.ffd("lattice", "convert", "k.json", "--time", "1.5", "-o", "k.csv")
    run.ffd("lattice", "convert", "k.csv", "--time", "1.5", "-o", "p.json", code=USAGE, lines=1, err=re.compile("has no keys"))


@case
def info_lists_the_keys(run):
    run.write("k.json", lattice(moves=[TURN], keys=SETS))
    equal(run.ffd("info", "k.json", "--json").json["keys"], {"kind": "set", "count": 3, "first": 1.0, "last": 4.0})
    check(re.search(r"\nkeys\n  kind +set\n  count +3\n  first +1\n  last +4\n", run.ffd("info", "k.json").text), "text")
    run.write("k.json", lattice(keys=[{"time": 0.25, "moves": []}, {"time": 2, "moves": shift(1, 0, 0)}]))
    equal(run.ffd("info", "k.json", "--json").json["keys"], {"kind": "points", "count": 2, "first": 0.25, "last": 2.0})
    run.write("l.json", lattice())
    check("keys" not in run.ffd("info", "l.json", "--json").json, "no keys")


@case
def a_time_where_no_lattice_has_keys(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=shift(1, 0, 0)))
    for command in (["deform", "a.obj", "o.obj"], ["check", "a.obj"], ["view", "a.obj", "-o", "o.png"], ["jacobian", "a.obj", "-o", "o.npz"]):
        run.ffd(*command, "-l", "l.json", "--time", "1", code=USAGE, lines=1, err=re.compile('l.json: has no keys: --time is for lattices that have "keys"'))
    run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "-l", "l.json", "--time", "1", code=USAGE, lines=1, err=re.compile("nor another lattice has keys"))
    for text in ("", "x", "nan", "inf", "1s", "1e999"):
        run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--time", text, code=USAGE, lines=1, err=re.compile("--time: .* is not a number of seconds"))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "o.npy", "--time", "1", code=USAGE, err=re.compile("unknown option"), lines=None)


@case
def a_job_and_a_column_choose_the_time(run):
    run.write("a.obj", CUBE)
    run.write("k.json", lattice(moves=[TURN], keys=SETS))
    run.write("one.json", lattice(moves=[{"twist": {"axis": "y", "degrees": 45}}]))
    run.ffd("deform", "a.obj", "right.obj", "-l", "one.json")
    right = run.read("right.obj")
    run.write("jobs.jsonl", '{"in": "a.obj", "lattice": "k.json", "out": "m.obj", "options": {"time": 1.5}}\n')
    run.ffd("batch", "jobs.jsonl", err=lambda lines: True)
    equal(run.read("m.obj"), right)
    run.write("t.csv", "out,time\nt0.obj,1.5\nt1.obj,2\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "k.json", "--report", "r.json", err=lambda lines: True)
    equal(run.read("t0.obj"), right)
    equal([job["set"] for job in json.loads(run.text("r.json"))["jobs"]], [{"time": 1.5}, {"time": 2}])
    # A row that says nothing has the time of the command.
    run.write("t.csv", "out,time\nu0.obj,\nu1.obj,2\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "k.json", "--time", "1.5", err=lambda lines: True)
    equal([run.read("u0.obj"), run.read("u1.obj")], [right, run.read("t1.obj")])
    # Stills as rows of an array.
    run.ffd("batch", "--csv", "t.csv", "--csv-ignore", "out", "--in", "a.obj", "-l", "k.json", "--positions", "all.npy", data=True, err=lambda lines: True)
    equal([row.get("set") for row in json.loads(run.text("all.json"))["jobs"]], [{}, {"time": 2}])


@case
def a_column_that_is_a_placeholder_or_both(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"twist": {"axis": "y", "degrees": {"$": "time"}}}]))
    run.write("t.csv", "out,time\np.obj,45\n")
    run.write("one.json", lattice(moves=[{"twist": {"axis": "y", "degrees": 45}}]))
    run.ffd("deform", "a.obj", "right.obj", "-l", "one.json")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "l.json", err=lambda lines: True)
    equal(run.read("p.obj"), run.read("right.obj"))
    run.write("k.json", lattice(moves=[TURN, {"scale": {"factor": {"$": "time"}}}], keys=SETS))
    run.write("t.csv", "out,time\nq.obj,1\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "k.json", "--report", "r.json", code=NO, err=lambda lines: True, lines=None)
    job = json.loads(run.text("r.json"))["jobs"][0]
    equal(job["exit"], INVALID)
    check("the time of the keys or a placeholder of that name" in job["error"], job["error"])
    run.write("k.json", lattice(moves=[TURN], keys=SETS))
    run.write("t.csv", "out,time\nr.obj,soon\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "k.json", "--report", "r.json", code=NO, err=lambda lines: True, lines=None)
    equal(json.loads(run.text("r.json"))["jobs"][0]["exit"], INVALID)
    equal([name for name in run.names() if name in ("q.obj", "r.obj")], [])


@case
def keys_give_no_columns_of_derivatives(run):
    run.write("a.obj", CUBE)
    moves = [TURN, {"at": ["all", 3, "all"], "by": [{"$": "X"}, 0, 0]}]
    run.write("k.json", lattice(moves=moves, keys=SETS))
    run.ffd("jacobian", "a.obj", "-l", "k.json", "--time", "1.5", "--set", "X=0.1", "--wrt", "parameters", "--check", "-o", "k.npz", data=True)
    equal(run.text("k.columns.txt"), "X\n")
    run.write("k.json", lattice(keys=[{"time": 0, "moves": []}, {"time": 1, "moves": moves[1:]}]))
    run.ffd("jacobian", "a.obj", "-l", "k.json", "--set", "X=0.1", "--wrt", "parameters", "-o", "l.npz", code=6, lines=1,
            err=re.compile("derivatives by placeholders in the moves of keys are not supported"))


REFUSALS = (
    (dict(keys={}), "must be an array of keys"),
    (dict(keys=[]), "has 0 keys, but needs at least 2"),
    (dict(keys=SETS[:1], moves=[TURN]), "has 1 key, but needs at least 2"),
    (dict(keys=[1, 2]), "/keys/0"),
    (dict(keys=[{"moves": []}, {"time": 1, "moves": []}]), '"time" is missing'),
    (dict(keys=[{"time": "0", "moves": []}, {"time": 1, "moves": []}]), "/keys/0/time"),
    (dict(keys=[{"time": -1, "moves": []}, {"time": 1, "moves": []}]), "the time -1 is less than 0"),
    (dict(keys=[{"time": 0, "moves": []}, {"time": 1e39, "moves": []}]), "the time 1e+39 is too large"),
    (dict(keys=[{"time": 1, "moves": []}, {"time": 1, "moves": []}]), "the time 1 is not after that of the key before, 1"),
    (dict(keys=[{"time": 2, "moves": []}, {"time": 1, "moves": []}]), "the time 1 is not after that of the key before, 2"),
    (dict(keys=[{"time": 1, "moves": []}, {"time": 1.00000001, "moves": []}]), "the same in single precision"),
    (dict(keys=[{"time": 0}, {"time": 1, "moves": []}]), 'a key has "offsets", "moves" or "set"'),
    (dict(keys=[{"time": 0, "moves": [], "set": {"A": 1}}, {"time": 1, "moves": []}]), 'has both "moves" and "set"'),
    (dict(keys=[{"time": 0, "moves": [], "offsets": []}, {"time": 1, "moves": []}]), 'has both "offsets" and "moves"'),
    (dict(keys=[SETS[0], {"time": 9, "moves": []}], moves=[TURN]), "a file has keys of one kind"),
    (dict(keys=[{"time": 0, "moves": []}, SETS[1]], moves=[TURN]), "a file has keys of one kind"),
    (dict(keys=[{"time": 0, "moves": [], "seconds": 1}, {"time": 1, "moves": []}]), 'unknown key "seconds"; use "time"'),
    (dict(keys=[{"time": 0, "moves": []}, {"time": 1, "moves": []}], moves=shift(1, 0, 0)), "stand in place of these moves"),
    (dict(keys=[{"time": 0, "offsets": [[0, 0, 0]] * 64}, {"time": 1, "offsets": [[0, 0, 0]] * 64}], deformed={"offsets": [[0, 0, 1]] * 64}),
     "the offsets of all keys stand in place of these"),
    (dict(keys=[{"time": 0, "offsets": [[0, 0, 0]] * 64}, {"time": 1, "offsets": [[0, 0, 0]] * 64}], deformed={"points": [[0, 0, 1]] * 64}),
     "the offsets of all keys stand in place of these"),
    (dict(keys=[{"time": 0, "offsets": [[0, 0, 0]] * 63}, {"time": 1, "moves": []}]), "/keys/0/offsets"),
    (dict(keys=[{"time": 0, "moves": []}, {"time": 1, "moves": [{"by": [1, 2]}]}]), "/keys/1/moves/0/by"),
    (dict(keys=[{"time": 0, "moves": [{"within": {"min": [9, 9, 9], "max": [9, 9, 9]}, "by": [1, 2, 3]}]}, {"time": 1, "moves": []}]),
     "/keys/0/moves/0: selects no control point"),
    (dict(keys=[{"time": 0, "set": {}}, {"time": 1, "set": {}}], moves=[TURN]), "not an empty one"),
    (dict(keys=[{"time": 0, "set": {"A": "x"}}, {"time": 1, "set": {"A": "y"}}], moves=[TURN]), 'is the text "x"'),
    (dict(keys=[{"time": 0, "set": {"A": 1}}, {"time": 1, "set": {"A": [1]}}], moves=[TURN]), "has another shape in the first key"),
    (dict(keys=[{"time": 0, "set": {"A": [[1], 2]}}, {"time": 1, "set": {"A": [[1, 2]]}}], moves=[TURN]), "has another shape in the first key"),
    (dict(keys=[{"time": 0, "set": {"A": 1}}, {"time": 1, "set": {"B": 1}}], moves=[TURN]), 'the first key does not give "B"'),
    (dict(keys=[{"time": 0, "set": {"A": 1, "B": 2}}, {"time": 1, "set": {"A": 1}}], moves=[TURN]), 'does not give "B"'),
    (dict(keys=[{"time": 0, "set": {"A": 1, "B": 2}}, {"time": 1, "set": {"A": 1, "B": 3}}], moves=[TURN]), 'the moves have no placeholder {"$": "B"}'),
    (dict(keys=[{"time": 0, "set": {"A": 1}}, {"time": 1, "set": {"A": 2}}]), 'the moves have no placeholder {"$": "A"}'),
    (dict(keys=SETS, moves=[TURN], parameters={"A": {"max": 80}}), "90 is greater than the max of"),
    (dict(keys=SETS, moves=[{"jitter": {"sigma": 1, "seed": {"$": "A"}}}]), None),
)


@case
def what_cannot_be_is_refused(run):
    run.write("a.obj", CUBE)
    for members, what in REFUSALS:
        run.write("k.json", lattice(**members))
        if what:
            run.ffd("deform", "a.obj", "o.obj", "-l", "k.json", code=INVALID, lines=1, err=re.compile("k.json:[0-9]+: .*" + re.escape(what)))
    # A seed between two keys is not whole; at the keys it is.
    run.ffd("deform", "a.obj", "o.obj", "-l", "k.json", "--time", "1.25", code=INVALID, lines=1, err=re.compile("seed 22.5 is not a whole number"))
    run.ffd("deform", "a.obj", "p.obj", "-l", "k.json", "--time", "2")
    check(not run.exists("o.obj"), "no output")


@case
def bounds_hold_between_keys_too(run):
    """Rounding between two values at a bound does not take one beyond it."""
    run.write("k.json", lattice(moves=[TURN], keys=[{"time": 0, "set": {"A": 0.1}}, {"time": 3, "set": {"A": 0.1}}], parameters={"A": {"min": 0.1, "max": 0.1}}))
    for time in (0.1, 1, 2.9):
        run.ffd("lattice", "set", "k.json", "--strength", "1", "-o", "o.json", "--force", "--time", str(time))


main()
