#!/usr/bin/env python3
"""ffd lattice refine: more control points or higher degrees for the same map. authoring/refine-*.json hold right answers, worked
out in exact fractions by the basis functions' definition."""

import itertools
import json
import os
import random
import re

from author import deformed_points, offsets_of, reference_cases, rest_points
from bspline import knots as clamped_knots
from harness import (CUBE, INVALID, IO, LIMIT, OK, USAGE, case, carried, check, equal, lattice, main, near, repetitions)

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")


def refine(run, *options, source="l.json", target="r.json", **more):
    run.ffd("lattice", "refine", source, "-o", target, "--force", *options, **more)
    return json.loads(run.text(target)) if run.exists(target) else None


def as_list(knots, size, degree):
    """Knots that a keyword stands for, where it is "clamped"."""
    return clamped_knots(size, degree) if knots == "clamped" else knots


@case
def the_reference_cases(run):
    names = 0
    for name, of in reference_cases("refine"):
        names += 1
        expect = of["expect"]
        run.write("l.json", of["lattice"])
        options = of["command"].split()[3:-2]
        found = refine(run, *options)
        equal([found["size"], found["degree"]], [expect["size"], expect["degree"]], name)
        equal(found["moves"], [])
        tolerance = expect["tolerance"]
        equal([as_list(k, n, d) for k, n, d in zip(found["knots"], found["size"], found["degree"])],
              [as_list(k, n, d) for k, n, d in zip(expect["knots"], found["size"], found["degree"])], name)
        near(rest_points(found), expect["rest_points"], tolerance, name)
        near(deformed_points(found), expect["deformed_points"], tolerance, name)
        for i in expect["unmoved"]:
            equal(offsets_of(found)[i], [0, 0, 0], (name, i))
    equal(names, 6)


def random_lattice(kinds, degree, size, **members):
    moves = [{"at": [RANDOM.randrange(n) for n in size], "by": [RANDOM.uniform(-0.3, 0.3) for _ in range(3)]} for _ in range(4)]
    return lattice(size=size, degree=degree, knots=kinds, moves=moves, low=(-1, -1, -1), high=(1, 1, 1), **members)


@case
def the_map_stays(run):
    """Random lattices of all kinds of knots: what follows the refined one goes where it went before."""
    points = [[RANDOM.uniform(-0.9, 0.9) for _ in range(3)] for _ in range(40)]
    kinds = ("clamped", "open", "uniform")
    for _ in range(repetitions(20)):
        degree = [RANDOM.randint(1, 4) for _ in range(3)]
        size = [d + RANDOM.randint(1, 4) for d in degree]
        run.write("l.json", random_lattice([RANDOM.choice(kinds) for _ in range(3)], degree, size))
        options = RANDOM.choice((["--size", ",".join(str(n + RANDOM.randint(1, 4)) for n in size)],
                                 ["--degree", ",".join(str(d + RANDOM.randint(0, 2)) for d in degree[:2]) + f",{degree[2] + 1}"],
                                 ["--insert", "v:0.4375", "--size", str(max(size) + 3)]))
        run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--force", *options, "--report", "report.json", code=(OK, USAGE), err=lambda lines: True)
        report = json.loads(run.text("report.json"))["jobs"][0]
        if report["exit"]:  # 0.4375 is outside the domain of some uniform knots
            check("outside of the domain" in report["error"], report)
            continue
        near(carried(run, points, "r.json"), carried(run, points, "l.json"), 1e-13, options)
        most = 4 * 2.0 ** -52 * sum(report["refine"]["degree"]["after"]) * 20
        check(0 <= report["refine"]["largest_difference"] <= most, report)


@case
def a_box_at_rest_stays_a_box(run):
    run.write("l.json", lattice(size=(4, 5, 3), degree=(3, 2, 2), moves=[{"at": [0, 0, 0], "by": [0.25, 0, 0]}]))
    found = refine(run, "--size", "7")
    equal(found["rest"]["box"]["min"], [-2, -2, -2])
    moved = [i for i, d in enumerate(offsets_of(found)) if d != [0, 0, 0]]
    # Of 7 points along u the first 4 lie over those that the first one reaches, along v and w as many as their degrees say.
    check(0 in moved and len(moved) < 60 and all(i % 7 < 4 for i in moved), moved)
    equal(offsets_of(found)[0], [0.25, 0, 0], "the corner keeps its bits")
    check("deformed" not in refine(run, "--size", "7", source=still(run)), "a lattice that was never moved")
    check("points" in refine(run, "--size", "7", source=spaced(run))["rest"], "uniform spacing")


def still(run):
    run.write("still.json", lattice())
    return "still.json"


def spaced(run):
    run.write("spaced.json", lattice(rest={"box": {"min": [-2, -2, -2], "max": [2, 2, 2], "spacing": "uniform"}}))
    return "spaced.json"


@case
def a_box_round_a_mesh(run):
    """Without moves it stays for any mesh. With them it needs one, and is laid round it as ffd deform does."""
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(rest={"box": "mesh", "margin": 0.25}))
    found = refine(run, "--size", "6")
    equal([found["size"], found["rest"]["box"]], [[6, 6, 6], "mesh"])
    run.write("l.json", lattice(rest={"box": "mesh", "margin": 0.25}, moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    run.remove("r.json")
    refine(run, "--size", "6", code=INVALID, err="l.json: the box of the lattice is that of a mesh, and its moves need positions (--mesh)")
    check(not run.exists("r.json"), "an output")
    found = refine(run, "--size", "6", "--mesh", "a.obj")
    equal([found["rest"]["box"]["min"], found["rest"]["box"]["max"]], [[-1.5] * 3, [1.5] * 3])
    points = [[x / 4, 0.3, -0.2] for x in range(-4, 5)]
    run.write("p.obj", CUBE + "".join("v %r %r %r\n" % tuple(p) for p in points))
    ends = []
    for name in ("l.json", "r.json"):
        run.ffd("deform", "a.obj", "o.obj", "-l", name, "--force")
        ends.append([[float(x) for x in line.split()[1:]] for line in run.text("o.obj").splitlines() if line.startswith("v ")])
    near(ends[1], ends[0], 1e-15)
    # Two meshes, and a part of one.
    run.write("b.obj", "o near\nv 0 0 0\nv 3 1 1\nv 3 0 1\nf 1 2 3\no far\nv 99 0 0\nf 1 2 4\n")
    refine(run, "--size", "6", "--mesh", "a.obj", "--mesh", "b.obj", "--only", "object:near", code=USAGE, err=re.compile("a.obj: .*near"))
    found = refine(run, "--size", "6", "--mesh", "b.obj", "--only", "object:near")
    equal([found["rest"]["box"]["min"], found["rest"]["box"]["max"]], [[-0.75, -0.25, -0.25], [3.75, 1.25, 1.25]])
    run.write("empty.obj", "o near\n")
    refine(run, "--size", "6", "--mesh", "empty.obj", code=INVALID, err=lambda lines: "no vertex that the lattice could go round" in lines[-1])
    run.write("l.json", lattice(rest={"box": {"meshes": ["a.obj"]}, "margin": 0.25}, moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    equal(refine(run, "--size", "6")["rest"]["box"]["min"], [-1.5] * 3, "the meshes that it names")
    refine(run, "--size", "6", "--mesh", "a.obj", code=USAGE, err=re.compile("l.json: --mesh cannot be used: "))
    run.ffd("lattice", "refine", "l.json", "-o", "a.obj", "--size", "6", "--force", code=USAGE, err=re.compile("^a.obj: "))
    equal(run.text("a.obj"), CUBE)


@case
def moves_are_baked_with_their_values(run):
    run.write("l.json", lattice(parameters={"A": {"default": 0.5}}, moves=[{"at": [3, "all", "all"], "by": [{"$": "A"}, 0, {"$": "B"}]}]))
    refine(run, "--size", "5", code=INVALID, err=re.compile(r'l\.json:1: .*the placeholder "B" has no value'))
    found = refine(run, "--size", "5", "--set", "B=0.25")
    equal([found["moves"], "parameters" in found, offsets_of(found)[-1]], [[], False, [0.5, 0, 0.25]])
    equal(offsets_of(refine(run, "--size", "5", "--set", "B=0", "--set", "A=2"))[-1], [2, 0, 0])
    refine(run, "--size", "5", "--set", "B=1", "--set", "C=1", code=INVALID, err=re.compile(r'l.json: no lattice has the placeholder {"\$": "C"}'))


@case
def streams(run):
    run.write("l.json", lattice(moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}]))
    refine(run, "--size", "6")
    for source in ("l.json", "-"):
        out = run.ffd("lattice", "refine", source, "-o", "-", "--size", "6", stdin=run.read("l.json") if source == "-" else b"", data=True).out
        equal(out, run.read("r.json"), source)
    for options in (["--threads", "1"], ["--threads", "3"], ["-v"]):
        refine(run, "--size", "6", *options, target="s.json", err=lambda lines: True)
        equal(run.read("s.json"), run.read("r.json"), options)
    said = run.ffd("lattice", "refine", "l.json", "-o", "t.json", "--size", "6", "-v", lines=1, err=lambda lines: True).err
    check(re.fullmatch(r"l\.json: 4 x 4 x 4 control points of degree 3, 3, 3 become 6 x 6 x 6 of degree 3, 3, 3; the maps differ by "
                       r"at most [0-9.e-]+", said[0]), said)


@case
def the_report(run):
    run.write("l.json", lattice(moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}]))
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--degree", "4,3,5", "--report", "a.json")
    entry, = json.loads(run.text("a.json"))["jobs"]
    check(min(entry.pop("seconds").values()) >= 0)
    largest = entry["refine"].pop("largest_difference")
    check(0 <= largest < 1e-14, largest)
    equal(entry, {"input": "l.json", "output": "r.json", "outputs": ["r.json"], "status": "ok", "exit": 0, "error": None,
                  "refine": {"size": {"before": [4, 4, 4], "after": [5, 4, 6]}, "degree": {"before": [3, 3, 3], "after": [4, 3, 5]}}})
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--degree", "4", "--report", "b.jsonl", "--report-stable", code=IO, lines=1, err=lambda lines: True)
    entry = json.loads(run.text("b.jsonl"))
    equal([entry["status"], entry["exit"], entry["refine"], "seconds" in entry], ["failed", IO, None, False])
    check("exists already" in entry["error"], entry)
    out = run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--force", "--degree", "4", "--report", "-", data=True).json
    equal(out["jobs"][0]["outputs"], ["r.json"])
    before = run.read("l.json"), run.read("r.json")
    for output, report in (("r.json", "l.json"), ("r.json", "r.json"), ("r.json", "./r.json"), ("n.json", "n.json"), ("-", "l.json")):
        run.ffd("lattice", "refine", "l.json", "-o", output, "--force", "--degree", "4", "--report", report, code=USAGE,
                err=re.compile("the report would replace the lattice"))
        equal((run.read("l.json"), run.read("r.json")), before)
        check(not run.exists("n.json"), report)
    run.ffd("lattice", "refine", "l.json", "-o", "-", "--degree", "4", "--report", "-", code=USAGE, lines=1, err=lambda lines: True)
    run.ffd("lattice", "refine", "l.json", "-o", "n.json", "--degree", "4", "--report-stable", code=USAGE, lines=1, err=lambda lines: True)


@case
def measuring_takes_memory(run):
    """The sums of whole layers of control points: 63 MB a thread here. As many threads as fit measure, to the same number."""
    run.write("l.json", lattice(size=(2, 2, 2), degree=(1, 1, 1), moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}]))
    size = ["--size", "700,700,2"]
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", *size, "--memory", "120M")
    run.remove("r.json")
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", *size, "--memory", "120M", "-v", code=LIMIT,
            err="l.json: needs more than the 120 MB of memory allowed (--memory raises this)")
    check(not run.exists("r.json"), "an output")
    reports = set()
    for threads in ("1", "8"):
        run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--force", *size, "--memory", "180M", "--threads", threads,
                "--report", "r_report.json", "--report-stable")
        reports.add(run.text("r_report.json"))
    equal(len(reports), 1)


@case
def what_cannot_be_is_refused(run):
    run.write("l.json", lattice(moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}]))
    run.write("closed.json", lattice(knots=["clamped", "closed", "clamped"], rest={"cylinder": {
        "center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 1], "height": 2}}))
    run.write("a.obj", CUBE)
    for options, code, what in (
            ([], USAGE, "nothing would change"), (["--size", "4,4,4"], USAGE, "nothing would change"),
            (["--degree", "3"], USAGE, "nothing would change"), (["--size", "3,5,5"], USAGE, "--size 3 along u is less than the 4"),
            (["--degree", "2,3,3"], USAGE, "--degree 2 along u"), (["--degree", "15"], USAGE, "1 to 14"),
            (["--size", "5,5"], USAGE, "one or three whole numbers"), (["--size", "1e3"], USAGE, "three whole numbers"),
            (["--insert", "u:1.5"], USAGE, "the knot 1.5 is outside of the domain, 0 to 1"),
            (["--insert", "u:-0.001"], USAGE, "the knot -0.001 is outside"),
            (["--insert", "w:0.5,0.5,0.5,0.5"], USAGE, "the knot 0.5 would be there 4 times; degree 3 allows 3"),
            (["--insert", "u:0"], USAGE, "the knot 0 would be there 5 times; degree 3 allows 4"),
            (["--insert", "x:0.5"], USAGE, "u, v or w"), (["--insert", "u:"], USAGE, "u, v or w"), (["--insert", "u:0.5,"], USAGE, "u, v or w"),
            (["--insert", "u0.5"], USAGE, "u, v or w"), (["--insert", ""], USAGE, "u, v or w"), (["--insert", "u:nan"], USAGE, "u, v or w"),
            (["--size", "500"], LIMIT, "more than 67108864 control points"),
            (["--size", "200000000,4,4"], LIMIT, "--size: 200000000 control points along u are more than 67108864"),
            (["--size", "400"], LIMIT, "needs .* MB of memory"),
            # The Bezier pieces of degree 14 take 1,800 bytes a knot.
            (["--size", "40000,15,4", "--degree", "14,3,3", "--memory", "300M"], LIMIT, "40000 by 15 by 4 control points needs .* MB of memory"),
            (["--size", "5", "--mesh", "a.obj"], USAGE, "--mesh cannot be used: the lattice does not go round a mesh"),
            (["--size", "5", "--only", "group:a"], USAGE, "--only needs --mesh"),
            (["--size", "5", "--keep-moves"], USAGE, "keep-moves"),
            (["--size", "5", "--mesh", "-"], USAGE, "--mesh names a file"),
            (["--size", "5", "--mesh", "none.obj"], IO, "none.obj")):
        run.ffd("lattice", "refine", "l.json", "-o", "r.json", *options, code=code, lines=1, err=re.compile(what))
        check(not run.exists("r.json"), options)
    run.ffd("lattice", "refine", "closed.json", "-o", "r.json", "--insert", "v:7.25,-0.25", "--degree", "3,4,3")
    run.remove("r.json")
    for words, code in ((["none.json", "-o", "r.json"], IO), (["a.obj", "-o", "r.json"], INVALID), (["l.json"], USAGE), ([], USAGE),
                        (["l.json", "l.json", "-o", "r.json"], USAGE), (["l.json", "-o", "r.obj"], USAGE),
                        (["l.json", "-o", "r.csv"], USAGE), (["l.json", "-o", "r.npy"], USAGE), (["l.json", "-o", "r.xyz"], USAGE), (["l.json", "-o", "r.v2"], USAGE),
                        (["l.json", "-o", "l.json", "--force"], IO), (["l.json", "-o", "./l.json", "--force"], IO),
                        (["l.json", "-o", "no/r.json"], IO)):
        run.ffd("lattice", "refine", *words, "--size", "6", code=code, lines=1, err=lambda lines: True)
        check(not any(run.exists(f"r.{ending}") for ending in ("json", "obj", "csv", "npy", "xyz", "v2")), words)
    run.write("r.json", "old")
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--size", "6", code=IO, err="r.json: exists already (--force overwrites it)")
    equal(run.text("r.json"), "old")
    run.ffd("lattice", "refine", "l.json", "-o", "r.json", "--size", "6", "--force")
    equal(json.loads(run.text("r.json"))["size"], [6, 6, 6])


@case
def ends_of_the_domain_that_tear(run):
    """A knot that stands degree + 1 times at an end of the domain, with others beyond it, gives two control points the same knots. The
    one beyond the end acts on nothing."""
    along = [-2 + 2 * i / 3 for i in range(7)]
    bulge = [-9, 0.25, -0.125, 0.5, 0.125, 0.25, 9]
    for degree, knots, acting in ((1, [-1, 0, 0, 0.25, 0.5, 0.75, 1, 1, 3], slice(1, 6)),
                                  (2, [-2, -1, 0, 0, 0, 0.5, 1, 1, 1, 3], slice(2, 6))):
        run.write("l.json", lattice(size=(7, 2, 2), degree=(degree, 1, 1), knots=[knots, "clamped", "clamped"],
                                    rest={"points": [[x, y, z] for z in (-2, 2) for y in (-2, 2) for x in along]},
                                    deformed={"offsets": [[d, 0, 0] for _ in range(4) for d in bulge]}))
        first, last = along[acting][0], along[acting][-1]
        points = [[first + (last - first) * i / 20, 0.25, -0.5] for i in range(1, 20)]
        moved = carried(run, points, "l.json")
        check(moved != points, "it moves something")
        for options in (["--insert", "u:0.125,0.625"], ["--size", "9,2,2"], ["--degree", f"{degree + 1},1,1"]):
            found = refine(run, *options)
            near(carried(run, points, "r.json"), moved, 1e-13, (options, found["knots"][0]))
        run.ffd("lattice", "set", "l.json", "-o", "s.json", "--force", "--seam", "C0:u-,u+")
        found = json.loads(run.text("s.json"))
        count = found["size"][0]
        equal([p[0] for p in rest_points(found)[:count]], along[acting])
        equal([d[0] for d in offsets_of(found)[:count]], [0, *bulge[acting][1:-1], 0])


@case
def degree_size_and_knots_at_once(run):
    """First the degrees, then the knots, and from there on the size; parameters in any order and in several options."""
    run.write("l.json", lattice(size=(5, 4, 4), degree=(2, 3, 3), moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0]}]))
    texts = set()
    for first, second in itertools.permutations(("u:0.1,0.9", "u:0.2")):
        texts.add(json.dumps(refine(run, "--size", "13,4,4", "--insert", first, "--insert", second, "--degree", "3")))
    equal(len(texts), 1)
    found = json.loads(texts.pop())
    equal([found["size"], found["degree"]], [[13, 4, 4], [3, 3, 3]])
    # The 2 breakpoints of degree 2 are double in degree 3, the 3 knots are there, and 2 of the longest spans are halved.
    third, two_thirds = 1 / 3, 2 / 3
    check({0.1, 0.2, 0.9} <= set(found["knots"][0]), found["knots"][0])
    equal(sum(abs(t - third) < 1e-15 for t in found["knots"][0]) + sum(abs(t - two_thirds) < 1e-15 for t in found["knots"][0]), 4)


main()
