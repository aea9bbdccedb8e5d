#!/usr/bin/env python3
"""What ffd animate makes of a twist, of a turned mesh, of a skinned figure and of an OBJ, played: at twenty times the slow evaluator
and three.js show what `deform --time` gives, within the bound of the report. The Khronos validator says nothing of the files that
it does not say of what they were made of.

FFD_NODE names the folder whose node_modules holds three and gltf-validator; without it only the evaluator is asked.
"""

import json
import math
import os
import sys

import viewer
from harness import case, check, equal, lattice, main
from messages import anything
from pose import Rig, size_of
from validate import answers

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "data", "models")
TWIST = {"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": "mesh", "margin": 0.05},
         "moves": [{"twist": {"axis": "y", "degrees": {"$": "A"}}}],
         "keys": [{"time": 0, "set": {"A": 0}}, {"time": 1.25, "set": {"A": 180}}, {"time": 1.5, "set": {"A": 90}}]}
POINTS = {**TWIST, "moves": [], "units": "box", "keys": [{"time": 0.25, "moves": []}, {"time": 1, "moves": [{"at": ["all", "top", "all"], "by": [0.4, 0, 0]}]},
                                                         {"time": 1.5, "moves": [{"at": ["all", [2, 5], "all"], "by": [0, 0.3, 0.2]}]}]}
CLOSE = 2e-6  # of the size: single precision, of what is shown and of the still
STEP = 7  # of many vertices


def times_of(content, count=20):
    first, last = content["keys"][0]["time"], content["keys"][-1]["time"]
    return [first - 0.1] + [first + (last - first) * i / (count - 3) for i in range(count - 2)] + [last + 0.1]


def shapes_of(run, source, time):
    run.ffd("deform", source, "s.glb", "-l", "k.json", "--time", repr(time), "--force", "-q", err=anything)
    return Rig(run.path("s.glb"))


def farthest(a, b):
    return max(math.dist(p, q) for key in a for p, q in zip(a[key], b[key], strict=True))


def plays(run, source, content, *options):
    run.write("k.json", content)
    run.ffd("animate", source, "o.glb", "-l", "k.json", "--report", "r.json", "--force", *options, err=anything)
    told = json.loads(run.text("r.json"))["jobs"][0]["animation"]
    rig = Rig(run.path("o.glb"))
    number = [animation.get("name") for animation in rig.asset["animations"]].index("k")
    chosen = {key: range(0, len(shape.positions), STEP) for key, shape in rig.shapes.items()}
    times, stills = times_of(content), []
    size = size_of(rig.vertices())
    for time in times:
        stills.append(shapes_of(run, source, time).vertices(None, 0.0, chosen))
        off = farthest(rig.vertices(number, max(time, 0), chosen), stills[-1])
        check(off <= told["bound"] + CLOSE * size, f"at {time} the evaluator is off by {off}, the bound is {told['bound']}")
    if viewer.missing():
        print("three.js is not asked:", viewer.missing())
        return
    shown = viewer.shown([(run.path("o.glb"), [(number, max(time, 0)) for time in times], STEP)])[0]
    for time, there, still in zip(times, shown, stills, strict=True):
        off = max(math.dist(p, q) for key, points in zip(sorted(still), there, strict=True) for p, q in zip(points, still[key], strict=True))
        check(off <= told["bound"] + CLOSE * size, f"at {time} three.js is off by {off}, the bound is {told['bound']}")


def codes_of(*paths):
    found = [json.loads(line) for line in answers(os.environ["FFD_NODE"], list(paths))]
    equal([line.get("failed") for line in found], [None] * len(paths))
    return [(line["codes"], line["errors"]) for line in found]


@case
def a_twist_is_played_within_its_bound(run):
    run.write("k.json", TWIST)
    for source in ("spot.obj", "banner_red.glb", "knight.glb"):
        plays(run, os.path.join(DATA, source), TWIST)
    plays(run, os.path.join(DATA, "banner_red.glb"), TWIST, "--targets", "keys", "--tolerance", "1e-2r")
    plays(run, os.path.join(DATA, "banner_red.glb"), TWIST, "--targets", "2")


@case
def points_are_played_within_their_bound(run):
    plays(run, os.path.join(DATA, "banner_red.glb"), POINTS)
    plays(run, os.path.join(DATA, "spot.obj"), POINTS, "--targets", "keys")


@case
def the_validator_says_nothing_new(run):
    if viewer.missing() or not os.path.isdir(os.path.join(os.environ["FFD_NODE"], "node_modules", "gltf-validator")):
        print("the validator is not asked")
        return
    for name in ("spot.obj", "banner_red.glb", "knight.glb"):
        source = os.path.join(DATA, name)
        if name.endswith(".obj"):
            run.ffd("deform", source, "plain.glb", "-l", os.path.join(DATA, "..", "lattices", "twist.json"), "--force", err=anything)
        for content, options in ((TWIST, ["--force"]), (TWIST, ["--normals", "keep"]), (POINTS, ["--targets", "keys"])):
            run.write("k.json", content)
            run.ffd("animate", source, "o.glb", "-l", "k.json", "--force", *options, err=anything)
            run.ffd("animate", source, "o.gltf", "-l", "k.json", "--force", *options, err=anything)
            before = run.path("plain.glb") if name.endswith(".obj") else source
            old, *new = codes_of(before, run.path("o.glb"), run.path("o.gltf"))
            for codes, errors in new:
                equal(sorted(set(codes) - set(old[0])), [], f"{name}: codes")
                equal([error for error in errors if error not in old[1]], [], f"{name}: errors")


main()
