#!/usr/bin/env python3
"""The published schema of lattice files beside the program that reads them: what the program accepts the schema
accepts; what breaks a rule that a schema can express both refuse; what a schema cannot express stands in a list.

    test_lattice_schema.py JUDGE     the program tests/support/judge_lattices.c
"""
import copy
import glob
import json
import os
import re
import subprocess
import sys

from harness import INVALID, LIMIT, OK, SECONDS, UNSUPPORTED, case, check, equal, main
from schema import Schema

JUDGE = os.path.abspath(sys.argv.pop(1))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# For the placeholders of the files that are read.
VALUES = {"DEGREES": "30", "GIRTH": "1.2", "HEIGHT": "0.9", "SHIFT": "[0, 0, 0]", "A": "1"}

faults = Schema("ffd-lattice.schema.json").faults


def judge(run, contents, values=None):
    """The program's exit code and message for each lattice file, all in one process. values: of their placeholders, if
    not VALUES for all."""
    lines = []
    for number, content in enumerate(contents):
        run.write(f"{number}.json", content)
        settings = values[number] if values else VALUES
        lines.append("\t".join([run.path(f"{number}.json"), *(f"{key}={value}" for key, value in settings.items())]) + "\n")
    done = subprocess.run([JUDGE], input="".join(lines).encode(), capture_output=True, timeout=SECONDS, check=False)
    check(done.returncode == 0, f"{JUDGE}: exit {done.returncode}; {done.stderr.decode()}")
    told = [line.split(" ", 1) for line in done.stdout.decode("utf-8", "backslashreplace").splitlines()]
    equal(len(told), len(contents), "lines of the judge")
    return [(int(code), words) for code, words in told]


# Lattices to begin with

BOX = {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}
CORNERS = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
POINTS = {**BOX, "rest": {"points": CORNERS}}
PIPE = {"center": [0, 0, 0], "axis": "z", "radius": [0.5, 1], "height": 2}
CYLINDER = {**BOX, "size": [2, 6, 2], "rest": {"cylinder": PIPE}}
SECTOR = {**BOX, "size": [2, 4, 2], "rest": {"cylinder": {**PIPE, "angle": [0, 90]}}}
RING = {**BOX, "size": [2, 4, 2], "degree": [1, 2, 1],
        "rest": {"points": [[r * x, r * y, z] for z in (0, 1) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1)) for r in (1, 2)]}}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
RICH = [
    {**BOX, "size": [4, 5, 3], "degree": [3, 2, 1], "knots": ["clamped", [0, 0, 0, 1, 2, 3, 3, 3], "unclamped"],
     "rest": {"box": {"min": [0, 0, 0], "max": [1, 2, 3], "spacing": "greville", "axes": [[0, 1, 0], [1, 0, 0], [0, 0, 1]]}},
     "units": "box",
     "moves": [{"at": [-1, [1, -2], "all"], "weight": 0.3, "rotate": {"axis": [1, 1, 1], "degrees": 33, "about": [0.1, 0.2, 0.3]}},
               {"within": {"min": [0, 0, 0], "max": [1, 1, 0.5]}, "twist": {"axis": "y", "degrees": -45}},
               {"taper": {"axis": "z", "factor": 0.7, "about": [0, 0, 0]}}]},
    {**BOX, "size": [3, 3, 3], "knots": ["clamped", "clamped", [0, 0, 0, 1, 1, 1]],
     "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": "uniform"}},
     "moves": [{"bend": {"axis": "x", "toward": [1, 1, 0], "degrees": 20}}, {"scale": {"factor": [1, 2, 3]}},
               {"scale": {"factor": 2, "about": [0, 0, 0]}}, {"at": [0, 0, 0], "to": [0.5, 0.5, 0.5]}, {"matrix": IDENTITY}]},
    {**BOX, "size": [2, 2, 3], "units": "box", "moves": [
        {"falloff": {"axis": "x", "from": 0, "to": 1}, "mirror": "x", "pull": {"point": [0, 0, 0], "by": [0, 1, 0], "radius": 0.5}},
        {"falloff": {"center": [0, 0, 0], "radius": 2}, "weight": 0.5, "by": [0.1, 0, 0]}]},
    {**BOX, "rest": {"box": "mesh"}, "units": "mesh", "moves": [
        {"at": ["first", ["bottom", "last"], "top"], "mirror": {"axis": "x", "at": 0.5}, "pull": {"point": [0, 0, 0], "by": [0, 1, 0], "radius": 0.5}},
        {"mirror": {"point": [0.5, 0.5, 0.5], "normal": [1, 2, 0]}, "falloff": {"center": [0, 0, 0], "radius": 2}, "by": [0.1, 0, 0]}]},
    {**BOX, "moves": [{"jitter": {"sigma": [0, 0.5, 1], "seed": 9007199254740991}}, {"at": [1, "all", "all"], "weight": 0.5, "falloff": {
        "center": [0, 0, 0], "radius": 1}, "jitter": {"sigma": 0.1, "seed": {"$": "SEED"}}}]},
    {**BOX, "moves": [{"within": {"min": [0, 0, 0], "max": [1, 1, 1]}, "mirror": "z", "radius": 2, "drag": [
        {"point": [0.5, 0.5, 0.5], "by": [0, 0.1, 0]}, {"point": [0, 0, 0], "by": [0, 0, 0]}]}]},
    {**BOX, "size": [2, 2, 3], "moves": [{"mirror": "y", "weight": 1, "bend": {"axis": "z", "toward": "x", "degrees": 0, "exact": True}}]},
    {**BOX, "rest": {"box": "mesh", "margin": 0.1}, "moves": [{"by": [0.1, 0.2, -0.3]}]},
    {**BOX, "rest": {"box": "mesh", "margin": [0.1, 0, 0.2]}, "moves": [{"by": [0.1, 0.2, -0.3]}]},
    {**CYLINDER, "rest": {"cylinder": {**PIPE, "zero": [1, 0, 0], "angle": [-90, 270]}},
     "knots": ["open", {"closed": [0, 1, 2, 3, 4, 5, 6]}, "uniform"], "weights": [1.5] * 24},
    {**SECTOR, "units": "world", "moves": []},
    {**POINTS, "weights": [1, 2, 1, 1, 1, 1, 1, 0.5], "deformed": {"points": CORNERS, "weights": [1, 1, 1, 1, 1, 1, 1, 3]}},
    {**RING, "knots": ["clamped", "periodic", "clamped"], "deformed": {}},
    {**POINTS, "moves": [{"at": [{"$": "A"}, "all", 0], "by": [0, {"$": "A"}, 0]}]},
    {**BOX, "deformed": {"offsets": CORNERS, "weights": [2] * 8}, "parameters": {
        "A": {"default": 1, "min": 0, "max": 90, "unit": "degrees", "comment": "how far"}, "B": {"default": [0, 1, "x"]}, "C": {}},
     "moves": [{"by": [{"$": "A"}, {"$": "-A"}, {"$": "-A", "times": 0.5}]}]},
    {**BOX, "keys": [{"time": 0, "offsets": CORNERS}, {"time": 1.5, "moves": [{"by": [{"$": "A"}, 0, 0]}], "name": "up"}], "moves": []},
    {**BOX, "keys": [{"time": 0, "offsets": CORNERS}, {"time": 2, "offsets": CORNERS}], "deformed": {"weights": [2] * 8}},
    {**BOX, "keys": [{"time": 0, "set": {"K": [0, [1, 2]], "M": 1}}, {"time": 1, "set": {"K": [1, [2, 3]], "M": 2}}],
     "moves": [{"by": {"$": "K"}}, {"weight": {"$": "M"}, "by": [0, 0, 0]}]},
]


def moved(*moves, base=BOX):
    return {**base, "moves": list(moves)}


MOVES, SET, USE = {"time": 0, "moves": []}, {"time": 0, "set": {"K": 1}}, [{"by": [{"$": "K"}, 0, 0]}]


def keyed(keys, **members):
    return {**BOX, **members, "keys": keys}


def without(base, *path):
    copied = copy.deepcopy(base)
    holder = copied
    for key in path[:-1]:
        holder = holder[key]
    del holder[path[-1]]
    return copied


def boxed(**members):
    return {**BOX, "rest": {"box": {**BOX["rest"]["box"], **members}}}


def piped(**members):
    return {**CYLINDER, "rest": {"cylinder": {**PIPE, **members}}}


def last_row(place):
    return [*IDENTITY[:place], 0.5, *IDENTITY[place + 1:]]


# One for each rule that the schema expresses.
BROKEN = {
    "an object": [BOX],
    "format is there": without(BOX, "format"),
    "format": {**BOX, "format": "ffd-latice"},
    "version is there": without(BOX, "version"),
    "version is a number": {**BOX, "version": "1"},
    "no version below 1": {**BOX, "version": 0},
    "size is there": without(BOX, "size"),
    "rest is there": without(BOX, "rest"),
    "no other member": {**BOX, "wieghts": [1] * 8},
    "size of 3": {**BOX, "size": [2, 2]},
    "size of 3 only": {**BOX, "size": [2, 2, 2, 2]},
    "size is an array": {**BOX, "size": {}},
    "size from 2": {**BOX, "size": [2, 1, 2]},
    "size is whole": {**BOX, "size": [2, 2.5, 2]},
    "no placeholder outside moves": {**BOX, "size": [2, {"$": "A"}, 2]},
    "degree of 3": {**BOX, "degree": [1, 1]},
    "degree of 3 only": {**BOX, "degree": [1, 1, 1, 1]},
    "degree from 1": {**BOX, "degree": [1, 0, 1]},
    "degree to 14": {**BOX, "size": [2, 2, 16], "degree": [1, 1, 15]},
    "degree is whole": {**BOX, "degree": [1, 1.5, 1]},
    "null is not a default": {**BOX, "degree": None},
    "knots is an array": {**BOX, "knots": "clamped"},
    "knots of 3": {**BOX, "knots": ["clamped", "clamped"]},
    "knots of 3 only": {**BOX, "knots": ["clamped"] * 4},
    "knots: a word": {**BOX, "knots": ["clamped", "clamp", "clamped"]},
    "knots: numbers": {**BOX, "knots": [[0, 0, "1", 1], "open", "open"]},
    "knots: four at least": {**BOX, "knots": [[0, 0, 1], "open", "open"]},
    "a closed list is an array": {**RING, "knots": ["open", {"closed": 4}, "open"]},
    "a closed list: three at least": {**RING, "knots": ["open", {"closed": [0, 1]}, "open"]},
    "a closed list: numbers": {**RING, "knots": ["open", {"closed": [0, 1, 2, 3, None]}, "open"]},
    "a closed list by its name": {**RING, "knots": ["open", {"closd": [0, 1, 2, 3, 4]}, "open"]},
    "a closed list: no other member": {**RING, "knots": ["open", {"closed": [0, 1, 2, 3, 4], "open": 1}, "open"]},
    "a closed list is there": {**RING, "knots": ["open", {}, "open"]},
    "a box is not closed": {**BOX, "knots": ["open", "closed", "open"]},
    "a box is not periodic": {**BOX, "knots": ["periodic", "open", "open"]},
    "a box has no closed list": {**BOX, "knots": ["open", "open", {"closed": [0, 1, 2]}]},
    "a mesh's box is not closed": {**BOX, "rest": {"box": "mesh"}, "knots": ["open", "closed", "open"]},
    "u of a cylinder is not closed": {**CYLINDER, "knots": ["closed", "closed", "open"]},
    "w of a cylinder is not closed": {**CYLINDER, "knots": ["open", "closed", {"closed": [0, 1, 2]}]},
    "uniform spacing is clamped": {**boxed(spacing="uniform"), "knots": ["clamped", "open", "clamped"]},
    "rest is an object": {**BOX, "rest": []},
    "rest is not a text": {**BOX, "rest": "box"},
    "rest is one of three": {**BOX, "rest": {}},
    "rest is only one of three": {**BOX, "rest": {"box": "mesh", "points": CORNERS}},
    "rest: no other member": {**BOX, "rest": {"box": "mesh", "bocks": 1}},
    "a box: the word": {**BOX, "rest": {"box": "mseh"}},
    "a box: min": without(BOX, "rest", "box", "min"),
    "a box: max": without(BOX, "rest", "box", "max"),
    "a box: 3 numbers": boxed(max=[1, 1]),
    "a box: 3 numbers only": boxed(max=[1, 1, 1, 1]),
    "a box: numbers": boxed(max=[1, None, 1]),
    "a box: spacing": boxed(spacing="even"),
    "a box: 3 axes": boxed(axes=[[1, 0, 0], [0, 1, 0]]),
    "a box: 3 axes only": boxed(axes=[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]]),
    "a box: axes are an array": boxed(axes="xyz"),
    "a box: axes are vectors": boxed(axes=[[1, 0, 0], [0, 1, 0], "z"]),
    "a box: no other member": boxed(margin=0.1),
    "margin from 0": {**BOX, "rest": {"box": "mesh", "margin": -0.1}},
    "margin is a number": {**BOX, "rest": {"box": "mesh", "margin": "0"}},
    "margins are three": {**BOX, "rest": {"box": "mesh", "margin": [0, 0]}},
    "margins are three only": {**BOX, "rest": {"box": "mesh", "margin": [0, 0, 0, 0]}},
    "margins are numbers": {**BOX, "rest": {"box": "mesh", "margin": [0, 0, "0"]}},
    "margins from 0": {**BOX, "rest": {"box": "mesh", "margin": [0, -0.1, 0]}},
    "meshes are a list": {**BOX, "rest": {"box": {"meshes": "a.obj"}}},
    "meshes: one at least": {**BOX, "rest": {"box": {"meshes": []}}},
    "meshes: names": {**BOX, "rest": {"box": {"meshes": ["a.obj", 3]}}},
    "meshes: a name is not empty": {**BOX, "rest": {"box": {"meshes": [""]}}},
    "meshes: not a stream": {**BOX, "rest": {"box": {"meshes": ["-"]}}},
    "meshes: no other member": {**BOX, "rest": {"box": {"meshes": ["a.obj"], "min": [0, 0, 0]}}},
    "no margin round a given box": {**BOX, "rest": {**BOX["rest"], "margin": 0.1}},
    "no margin round a cylinder": {**CYLINDER, "rest": {"cylinder": PIPE, "margin": 0.1}},
    "no margin round points": {**POINTS, "rest": {"points": CORNERS, "margin": 0.1}},
    "points: eight at least": {**POINTS, "rest": {"points": CORNERS[:7]}},
    "points are an array": {**POINTS, "rest": {"points": 8}},
    "points: vectors": {**POINTS, "rest": {"points": [*CORNERS[:7], [1, 1]]}},
    "a cylinder: center": without(CYLINDER, "rest", "cylinder", "center"),
    "a cylinder is an object": {**CYLINDER, "rest": {"cylinder": 2}},
    "a cylinder: axis": without(CYLINDER, "rest", "cylinder", "axis"),
    "a cylinder: radius": without(CYLINDER, "rest", "cylinder", "radius"),
    "a cylinder: height": without(CYLINDER, "rest", "cylinder", "height"),
    "a cylinder: no other member": piped(angel=[0, 90]),
    "a cylinder: the axis' word": piped(axis="w"),
    "a cylinder: an axis has a direction": piped(axis=[0, 0.0, -0.0]),
    "a cylinder: zero has a direction": piped(zero=[0, 0, 0]),
    "a cylinder: r0 from 0": piped(radius=[-1, 1]),
    "a cylinder: r1 above 0": piped(radius=[0, 0]),
    "a cylinder: two radii": piped(radius=[1]),
    "a cylinder: radii are an array": piped(radius=1),
    "a cylinder: r0 is a number": piped(radius=["0", 1]),
    "a cylinder: r1 is a number": piped(radius=[0, "1"]),
    "a cylinder: only two radii": piped(radius=[0, 1, 2]),
    "a cylinder: a height": piped(height=0),
    "a cylinder: the height is a number": piped(height="2"),
    "a cylinder: two angles": piped(angle=[90]),
    "a cylinder: angles are an array": piped(angle=90),
    "a cylinder: angles are numbers": piped(angle=[0, "90"]),
    "a cylinder: only two angles": piped(angle=[0, 90, 180]),
    "weights: eight at least": {**BOX, "weights": [1] * 7},
    "weights are positive": {**BOX, "weights": [1] * 7 + [0]},
    "weights are numbers": {**BOX, "weights": [1] * 7 + ["1"]},
    "weights are an array": {**BOX, "weights": None},
    "deformed is an object": {**BOX, "deformed": []},
    "deformed: no other member": {**BOX, "deformed": {"point": CORNERS}},
    "deformed: points": {**BOX, "deformed": {"points": CORNERS[1:]}},
    "deformed: weights": {**BOX, "deformed": {"weights": [1] * 7 + [-1]}},
    "deformed: points or offsets": {**BOX, "deformed": {"points": CORNERS, "offsets": CORNERS}},
    "deformed: offsets": {**BOX, "deformed": {"offsets": CORNERS[1:]}},
    "deformed: offsets are vectors": {**BOX, "deformed": {"offsets": [0] * 8}},
    "parameters are an object": {**BOX, "parameters": [{"default": 1}]},
    "a parameter is an object": {**BOX, "parameters": {"A": 1}},
    "a parameter: no other member": {**BOX, "parameters": {"A": {"defualt": 1}}},
    "a parameter: min": {**BOX, "parameters": {"A": {"min": "0"}}},
    "a parameter: max": {**BOX, "parameters": {"A": {"max": None}}},
    "a parameter: unit": {**BOX, "parameters": {"A": {"unit": 3}}},
    "a parameter: comment": {**BOX, "parameters": {"A": {"comment": 3}}},
    "a parameter has a name": {**BOX, "parameters": {"": {}}},
    "a parameter: its name has no minus": {**BOX, "parameters": {"-A": {}}},
    "keys are an array": keyed({}),
    "keys are two": keyed([MOVES]),
    "a key is an object": keyed([MOVES, 1]),
    "a key: no other member": keyed([MOVES, {**MOVES, "tim": 1}]),
    "a key: its time": keyed([{"moves": []}, MOVES]),
    "a key: its time is a number": keyed([MOVES, {"time": "1", "moves": []}]),
    "a key: its time is not negative": keyed([{"time": -1, "moves": []}, MOVES]),
    "a key: its time has single precision": keyed([MOVES, {"time": 1e39, "moves": []}]),
    "a key gives something": keyed([MOVES, {"time": 1}]),
    "a key gives one thing": keyed([MOVES, {"time": 1, "moves": [], "offsets": CORNERS}]),
    "a key: offsets are vectors": keyed([MOVES, {"time": 1, "offsets": [0] * 8}]),
    "a key: moves are moves": keyed([MOVES, {"time": 1, "moves": [7]}]),
    "a key: set is an object": keyed([SET, {"time": 1, "set": [1]}], moves=USE),
    "a key: set is not empty": keyed([{"time": 0, "set": {}}, {"time": 1, "set": {}}], moves=USE),
    "a key: values are numbers": keyed([SET, {"time": 1, "set": {"K": "x"}}], moves=USE),
    "a key: values are arrays of numbers": keyed([SET, {"time": 1, "set": {"K": [True]}}], moves=USE),
    "keys are of one kind": keyed([SET, {"time": 1, "moves": []}], moves=USE),
    "keys that set need moves": keyed([SET, {"time": 1, "set": {"K": 1}}], moves=[]),
    "keys in place of moves": keyed([MOVES, {"time": 1, "moves": []}], moves=USE),
    "keys in place of offsets": keyed([{"time": 0, "offsets": CORNERS}, {"time": 1, "offsets": CORNERS}], deformed={"offsets": CORNERS}),
    "keys in place of points": keyed([{"time": 0, "offsets": CORNERS}, {"time": 1, "offsets": CORNERS}], deformed={"points": CORNERS}),
    "units": {**BOX, "units": "boxes"},
    "moves are an array": {**BOX, "moves": {}},
    "moves are no placeholder": {**BOX, "moves": {"$": "A"}},
    "a move is an object": moved(7),
    "a move: no other member": moved({"att": [0, 0, 0], "by": [0, 0, 0]}),
    "a move: an action": moved({"at": [0, 0, 0]}),
    "a move: one action": moved({"by": [0, 0, 0], "to": [0, 0, 0]}),
    "a move: one selection": moved({"at": [0, 0, 0], "within": {"min": [0, 0, 0], "max": [1, 1, 1]}, "by": [0, 0, 0]}),
    "at: three": moved({"at": [0, 0], "by": [0, 0, 0]}),
    "at: three only": moved({"at": [0, 0, 0, 0], "by": [0, 0, 0]}),
    "at: an array": moved({"at": "all", "by": [0, 0, 0]}),
    "at: whole": moved({"at": [0, 0.5, 0], "by": [0, 0, 0]}),
    "at: the word": moved({"at": [0, "any", 0], "by": [0, 0, 0]}),
    "at: a first and a last": moved({"at": [[0], 0, 0], "by": [0, 0, 0]}),
    "at: whole ranges": moved({"at": [[0, "all"], 0, 0], "by": [0, 0, 0]}),
    "at: only these": moved({"at": [[0, 1, 1], 0, 0], "by": [0, 0, 0]}),
    "at: an index beyond any size": moved({"at": [0, 0, 16777216], "by": [0, 0, 0]}),
    "at: an index before any size": moved({"at": [0, 0, -16777217], "by": [0, 0, 0]}),
    "within: min": moved({"within": {"max": [1, 1, 1]}, "by": [0, 0, 0]}),
    "within: an object": moved({"within": [[0, 0, 0], [1, 1, 1]], "by": [0, 0, 0]}),
    "within: max": moved({"within": {"min": [0, 0, 0]}, "by": [0, 0, 0]}),
    "within: vectors": moved({"within": {"min": 0, "max": [1, 1, 1]}, "by": [0, 0, 0]}),
    "within: no other member": moved({"within": {"min": [0, 0, 0], "max": [1, 1, 1], "mid": 0}, "by": [0, 0, 0]}),
    "weight from 0": moved({"weight": -0.5, "by": [0, 0, 0]}),
    "weight to 1": moved({"weight": 1.5, "by": [0, 0, 0]}),
    "by: a vector": moved({"by": [0, 0]}),
    "by: numbers": moved({"by": [0, "0", 0]}),
    "to: a vector": moved({"to": [0, 0, 0, 0]}),
    "scale: a factor": moved({"scale": {"about": [0, 0, 0]}}),
    "scale: an object": moved({"scale": 2}),
    "scale: a number or three": moved({"scale": {"factor": "2"}}),
    "scale: not two": moved({"scale": {"factor": [1, 2]}}),
    "scale: about is a vector": moved({"scale": {"factor": 1, "about": 0}}),
    "scale: no other member": moved({"scale": {"factor": 1, "abuot": [0, 0, 0]}}),
    "rotate: axis": moved({"rotate": {"degrees": 3}}),
    "rotate: an object": moved({"rotate": 3}),
    "rotate: degrees": moved({"rotate": {"axis": "z"}}),
    "rotate: no other member": moved({"rotate": {"axis": "z", "degrees": 3, "angle": 3}}),
    "rotate: an axis has a direction": moved({"rotate": {"axis": [0, 0, 0], "degrees": 3}}),
    "matrix: 16": moved({"matrix": [1, 2, 3]}),
    "matrix: 16 only": moved({"matrix": [*IDENTITY, 0]}),
    "matrix: an array": moved({"matrix": 1}),
    "matrix: numbers": moved({"matrix": ["1", *IDENTITY[1:]]}),
    **{f"matrix: number {place} of the last row": moved({"matrix": last_row(place)}) for place in (12, 13, 14, 15)},
    "twist: axis": moved({"twist": {"degrees": 3}}),
    "twist: degrees": moved({"twist": {"axis": "z", "degrees": "3"}}),
    "taper: axis": moved({"taper": {"factor": 2}}),
    "taper: an object": moved({"taper": 2}),
    "taper: factor": moved({"taper": {"axis": "x", "factor": None}}),
    "taper: a factor": moved({"taper": {"axis": "x"}}),
    "taper: no other member": moved({"taper": {"axis": "x", "factor": 2, "degrees": 3}}),
    "bend: axis": moved({"bend": {"toward": "x", "degrees": 3}}),
    "bend: an object": moved({"bend": 3}),
    "bend: toward": moved({"bend": {"axis": "x", "degrees": 3}}),
    "bend: degrees": moved({"bend": {"axis": "x", "toward": "y"}}),
    "bend: toward has a direction": moved({"bend": {"axis": "x", "toward": [0, 0, 0], "degrees": 3}}),
    "bend: no other member": moved({"bend": {"axis": "x", "toward": "y", "degrees": 3, "radius": 3}}),
    "bend: exact or not": moved({"bend": {"axis": "x", "toward": "y", "degrees": 3, "exact": 1}}),
    "bend: exact without a falloff": moved({"falloff": {"center": [0, 0, 0], "radius": 1}, "bend": {
        "axis": "x", "toward": "y", "degrees": 3, "exact": True}}, base={**BOX, "size": [3, 2, 2]}),
    "bend: exact without a weight": moved({"weight": 0.5, "bend": {"axis": "x", "toward": "y", "degrees": 3, "exact": True}},
                                          base={**BOX, "size": [3, 2, 2]}),
    "twist: not exact": moved({"twist": {"axis": "z", "degrees": 3, "exact": True}}),
    "exact: in the bend": moved({"exact": True, "bend": {"axis": "x", "toward": "y", "degrees": 3}}, base={**BOX, "size": [3, 2, 2]}),
    "pull: an object": moved({"pull": [0, 0, 0]}),
    "pull: point": moved({"pull": {"by": [0, 0, 0], "radius": 1}}),
    "pull: by": moved({"pull": {"point": [0, 0, 0], "radius": 1}}),
    "pull: radius": moved({"pull": {"point": [0, 0, 0], "by": [0, 0, 0]}}),
    "pull: radius above 0": moved({"pull": {"point": [0, 0, 0], "by": [0, 0, 0], "radius": 0}}),
    "pull: radius is a number": moved({"pull": {"point": [0, 0, 0], "by": [0, 0, 0], "radius": "1"}}),
    "pull: vectors": moved({"pull": {"point": [0, 0], "by": [0, 0, 0], "radius": 1}}),
    "pull: no other member": moved({"pull": {"point": [0, 0, 0], "by": [0, 0, 0], "radius": 1, "about": [0, 0, 0]}}),
    "pull: the only action": moved({"pull": {"point": [0, 0, 0], "by": [0, 0, 0], "radius": 1}, "by": [0, 0, 0]}),
    "falloff: an object": moved({"falloff": 0.5, "by": [0, 0, 0]}),
    "falloff: along or round": moved({"falloff": {}, "by": [0, 0, 0]}),
    "falloff: not both": moved({"falloff": {"axis": "x", "from": 0, "to": 1, "center": [0, 0, 0], "radius": 1}, "by": [0, 0, 0]}),
    "falloff: from": moved({"falloff": {"axis": "x", "to": 1}, "by": [0, 0, 0]}),
    "falloff: to": moved({"falloff": {"axis": "x", "from": 1}, "by": [0, 0, 0]}),
    "falloff: axis": moved({"falloff": {"from": 0, "to": 1}, "by": [0, 0, 0]}),
    "falloff: an axis has a direction": moved({"falloff": {"axis": [0, 0, 0], "from": 0, "to": 1}, "by": [0, 0, 0]}),
    "falloff: center": moved({"falloff": {"radius": 1}, "by": [0, 0, 0]}),
    "falloff: radius": moved({"falloff": {"center": [0, 0, 0]}, "by": [0, 0, 0]}),
    "falloff: radius above 0": moved({"falloff": {"center": [0, 0, 0], "radius": -1}, "by": [0, 0, 0]}),
    "falloff is no action": moved({"falloff": {"center": [0, 0, 0], "radius": 1}}),
    "mirror: a word": moved({"mirror": "u", "by": [0, 0, 0]}),
    "mirror: not a direction": moved({"mirror": [1, 0, 0], "by": [0, 0, 0]}),
    "mirror is no action": moved({"mirror": "x"}),
    "mirror: a plane has a place": moved({"mirror": {"axis": "x"}, "by": [0, 0, 0]}),
    "mirror: a plane has a direction": moved({"mirror": {"at": 0}, "by": [0, 0, 0]}),
    "mirror: the direction is one": moved({"mirror": {"axis": [0, 0, 0], "at": 0}, "by": [0, 0, 0]}),
    "mirror: one kind of plane": moved({"mirror": {"axis": "x", "at": 0, "point": [0, 0, 0]}, "by": [0, 0, 0]}),
    "mirror: at is a number": moved({"mirror": {"axis": "x", "at": [0, 0, 0]}, "by": [0, 0, 0]}),
    "mirror: a normal": moved({"mirror": {"point": [0, 0, 0]}, "by": [0, 0, 0]}),
    "mirror: a plane is not empty": moved({"mirror": {}, "by": [0, 0, 0]}),
    "jitter: sigma": moved({"jitter": {"seed": 1}}),
    "jitter: seed": moved({"jitter": {"sigma": 1}}),
    "jitter: sigma from 0 on": moved({"jitter": {"sigma": -1, "seed": 1}}),
    "jitter: one or three sigmas": moved({"jitter": {"sigma": [1, 1], "seed": 1}}),
    "jitter: whole seeds": moved({"jitter": {"sigma": 1, "seed": 0.5}}),
    "jitter: seeds from 0 on": moved({"jitter": {"sigma": 1, "seed": -1}}),
    "jitter: seeds up to 2^53 - 1": moved({"jitter": {"sigma": 1, "seed": 2**53}}),
    "jitter: no mirror": moved({"mirror": "x", "jitter": {"sigma": 1, "seed": 1}}),
    "jitter: no other member": moved({"jitter": {"sigma": 1, "seed": 1, "about": [0, 0, 0]}}),
    "drag: a list": moved({"drag": {"point": [0, 0, 0], "by": [0, 0, 0]}}),
    "drag: not empty": moved({"drag": []}),
    "drag: point": moved({"drag": [{"by": [0, 0, 0]}]}),
    "drag: by": moved({"drag": [{"point": [0, 0, 0]}]}),
    "drag: no other member": moved({"drag": [{"point": [0, 0, 0], "by": [0, 0, 0], "radius": 1}]}),
    "drag: no weight": moved({"weight": 1, "drag": [{"point": [0, 0, 0], "by": [0, 0, 0]}]}),
    "drag: no falloff": moved({"falloff": {"center": [0, 0, 0], "radius": 1}, "drag": [{"point": [0, 0, 0], "by": [0, 0, 0]}]}),
    "drag: the only action": moved({"by": [0, 0, 0], "drag": [{"point": [0, 0, 0], "by": [0, 0, 0]}]}),
    "drag: radius above 0": moved({"radius": 0, "drag": [{"point": [0, 0, 0], "by": [0, 0, 0]}]}),
    "radius: of a drag": moved({"radius": 1, "by": [0, 0, 0]}),
    "units: a mesh to count in": {**BOX, "units": "mesh"},
    "units: points are no mesh": {**POINTS, "units": "mesh"},
    "a placeholder has no other members": moved({"by": {"$": "A", "plus": 2}}),
    "a placeholder: times": moved({"weight": {"$": "A", "times": "2"}, "by": [0, 0, 0]}),
    "a placeholder has a name": moved({"weight": {"$": 1}, "by": [0, 0, 0]}),
    "a placeholder is not an empty object": moved({"weight": {}, "by": [0, 0, 0]}),
    "JSON": json.dumps(BOX).encode()[:-1],
    "JSON has no NaN": json.dumps(BOX).encode().replace(b"[0, 0, 0]", b"[NaN, 0, 0]"),
}

# One for each rule that the schema does not express.
UNSEEN = {
    "times of keys rise": keyed([{"time": 1, "moves": []}, {"time": 1, "moves": []}]),
    "keys give the same placeholders": keyed([SET, {"time": 1, "set": {"M": 1}}], moves=USE),
    "keys give values of one shape": keyed([SET, {"time": 1, "set": {"K": [1]}}], moves=USE),
    "keys give placeholders of the moves": keyed([{"time": 0, "set": {"M": 1}}, {"time": 1, "set": {"M": 1}}], moves=[{"by": [0, 0, 0]}]),
    "a parameter: min is not above max": {**BOX, "parameters": {"A": {"min": 1, "max": 0}}},
    "a parameter: the default is within": {**BOX, "parameters": {"A": {"min": 1, "default": [2, 0]}}},
    "points are as many as size says": {**POINTS, "size": [3, 2, 2]},
    "weights are as many as size says": {**BOX, "size": [3, 2, 2], "weights": [1] * 8},
    "deformed points are as many as size says": {**BOX, "size": [3, 2, 2], "deformed": {"points": CORNERS}},
    "knots are as many as size and degree say": {**BOX, "knots": [[0, 0, 0, 1, 1], "open", "open"]},
    "breakpoints are as many as size says": {**RING, "knots": ["open", {"closed": [0, 1, 2, 3]}, "open"]},
    "the degree is less than the size": {**BOX, "degree": [2, 1, 1]},
    "knots do not fall": {**BOX, "knots": ["open", "open", [0, 0, 1, 0.5]]},
    "knots have a domain": {**BOX, "knots": ["open", "open", [0, 1, 1, 2]]},
    "inner knots repeat d times at most": {**BOX, "size": [2, 2, 4], "degree": [1, 1, 1], "knots": ["open", "open", [0, 0, 1, 1, 2, 2]]},
    "end knots repeat d+1 times at most": {**BOX, "size": [2, 2, 3], "degree": [1, 1, 1], "knots": ["open", "open", [0, 0, 0, 1, 1]]},
    "breakpoints at the seam repeat d times at most": {**RING, "knots": ["open", {"closed": [0, 0, 1, 4, 4]}, "open"]},
    "knots are not too far apart": {**BOX, "knots": ["open", "open", [-1.5e308, 0, 1, 1.5e308]]},
    "knots are not too close": {**BOX, "knots": ["open", "open", [0, 0, 1e-309, 1e-309]]},
    "a part of a cylinder is not closed": {**SECTOR, "knots": ["open", "closed", "open"]},
    "uniform spacing: a list is clamped": {**boxed(spacing="uniform"), "knots": ["clamped", [0, 1, 2, 3], "clamped"]},
    "a box has a side": boxed(min=[0, 2, 0]),
    "a box' side is finite": boxed(min=[-1e308, 0, 0], max=[1e308, 1, 1]),
    "axes have the length 1": boxed(axes=[[1, 0, 0], [0, 2, 0], [0, 0, 1]]),
    "axes are perpendicular": boxed(axes=[[1, 0, 0], [0.6, 0.8, 0], [0, 0, 1]]),
    "zero is not along axis": piped(zero=[0, 0, 5]),
    "r0 is less than r1": piped(radius=[1, 1]),
    "angles have a span": piped(angle=[90, 90]),
    "angles span a turn at most": piped(angle=[0, 361]),
    "a ring has points enough": {**CYLINDER, "size": [2, 2, 2]},
    "points are not too far away": {**POINTS, "rest": {"points": [*CORNERS[:7], [1e308, 1, 1]]}, "size": [2, 2, 2],
                                    "deformed": {"points": [*CORNERS[:7], [-1e308, 1, 1]]}},
    "weights times points are finite": {**POINTS, "rest": {"points": [*CORNERS[:7], [1e200, 1, 1]]}, "weights": [1] * 7 + [1e200]},
    "an index is within the size": moved({"at": [0, 2, 0], "by": [0, 0, 0]}),
    "an index from the end is within the size": moved({"at": [0, 0, -3], "by": [0, 0, 0]}),
    "a range is not empty": moved({"at": [[-1, 0], 0, 0], "by": [0, 0, 0]}),
    "within: max is not below min": moved({"within": {"min": [0, 3, 0], "max": [1, 2, 1]}, "by": [0, 0, 0]}),
    "within: a point rests there": moved({"within": {"min": [5, 5, 5], "max": [6, 6, 6]}, "by": [0, 0, 0]}),
    "toward is not along axis": moved({"bend": {"axis": "x", "toward": [-2, 0, 0], "degrees": 3}}),
    "an exact bend has its degree": moved({"bend": {"axis": "x", "toward": "y", "degrees": 3, "exact": True}}),
    "an exact bend has arcs below 180 degrees": moved({"bend": {"axis": "x", "toward": "y", "degrees": 180, "exact": True}},
                                                      base={**BOX, "size": [3, 2, 2]}),
    "from is not to": moved({"falloff": {"axis": "x", "from": 1, "to": 1}, "by": [0, 0, 0]}),
    "a mirror image is there": moved({"at": [0, 0, 0], "mirror": "x", "by": [0, 0, 1]}, base={**POINTS, "rest": {
        "points": [*CORNERS[:1], [1, 0.5, 0], *CORNERS[2:]]}}),
    "a dragged place is inside": moved({"drag": [{"point": [0, 0, 2], "by": [0, 0, 0]}]}),
    "a drag has control points": moved({"radius": 0.1, "drag": [{"point": [0.5, 0.5, 0.5], "by": [0, 0, 0]}]}),
    "a moved point is finite": moved({"by": [1.5e308, 0, 0]}, {"by": [1.5e308, 0, 0]}),
    "fractions are of a region": moved({"by": [0, 0, 0]}, base={**POINTS, "rest": {"points": [[x, y, 0] for x, y, _ in CORNERS]},
                                                                "units": "box"}),
    "the value of a placeholder": moved({"by": {"$": "A"}}),
    "a number is finite": json.dumps(BOX).encode().replace(b"[1, 1, 1]", b"[1e999, 1, 1]"),
    "a key occurs once": json.dumps(BOX).encode().replace(b'{"format"', b'{"version": 1, "format"'),
}


@case
def the_files_of_the_project_that_the_program_accepts_the_schema_accepts(run):
    contents, names = [], []
    for path in sorted(glob.glob(os.path.join(ROOT, "data", "**", "*.json"), recursive=True)
                       + glob.glob(os.path.join(ROOT, "tests", "fuzz", "corpus", "lattice", "*"))):
        with open(path, "rb") as file:
            content = file.read()
        # Points may follow behind a 0 in the corpus.
        contents += [content, content.split(b"\0")[0]] if b"\0" in content else [content]
        names += [os.path.basename(path)] * (len(contents) - len(names))
    accepted = 0
    for name, content, (code, words) in zip(names, contents, judge(run, contents)):
        found = faults(content)
        check(code != OK or found == [], f"{name}: accepted by the program, by the schema not: {found}")
        accepted += code == OK
        check(not name.startswith("bad-") or code != OK, f"{name} is accepted: {words}")
    check(accepted > 100, f"only {accepted} files")


@case
def the_examples_of_the_papers_are_accepted_by_both(run):
    contents = []
    for name, least in (("README.md", 2), ("data/tutorial.md", 6), ("data/schema/lattice.md", 4)):
        with open(os.path.join(ROOT, name), encoding="utf-8") as file:
            blocks = re.findall(r"^```json[^\n]*\n(.*?)^```$", file.read(), re.M | re.S)
        found = [block.encode() for block in blocks if block.startswith("{") and '"ffd-lattice"' in block]
        check(len(found) >= least, f"{name} has only {len(found)} lattice files")
        contents += found
    for content, (code, words) in zip(contents, judge(run, contents)):
        equal((code, words, faults(content)), (OK, "", []), content.decode())


@case
def what_breaks_a_rule_of_the_schema_the_program_refuses_too(run):
    check(len(BROKEN) > 100, f"only {len(BROKEN)} rules")
    for (rule, content), (code, words) in zip(BROKEN.items(), judge(run, BROKEN.values())):
        check(code == INVALID, f"{rule}: exit {code} from the program; {words}")
        check(faults(content), f"{rule}: the schema has nothing to say")
    for rule, content, expected in (("a newer version", {**BOX, "version": 2}, UNSUPPORTED),
                                    ("a size beyond the limit", {**BOX, "size": [2, 2, 16777217]}, LIMIT)):
        (code, words), = judge(run, [content])
        equal(code, expected, f"{rule}: {words}")
        check(faults(content), f"{rule}: the schema has nothing to say")


@case
def what_the_schema_cannot_express_the_program_refuses(run):
    """A rule that moves from here into the schema goes to BROKEN."""
    for (rule, content), (code, words) in zip(UNSEEN.items(), judge(run, UNSEEN.values())):
        check(code == INVALID, f"{rule}: exit {code} from the program; {words}")
        equal(faults(content), [], f"{rule}: the schema can tell")
    for rule, content, values, expected in (
            ("the product of the sizes", {**BOX, "size": [4096, 4096, 5]}, None, LIMIT),
            ("a placeholder has a value", moved({"by": {"$": "A"}}), [{}], INVALID)):
        (code, words), = judge(run, [content], values)
        equal((code, faults(content)), (expected, []), f"{rule}: {words}")


def paths(value, path=()):
    """The places of all members and elements; of arrays the first three."""
    inner = list(value.items()) if isinstance(value, dict) else list(enumerate(value))[:3] if isinstance(value, list) else []
    for key, member in inner:
        yield (*path, key)
        yield from paths(member, (*path, key))


def changed(base, path, value):
    copied = copy.deepcopy(base)
    holder = copied
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    return copied


@case
def what_the_program_accepts_of_changed_files_the_schema_accepts(run):
    others = (None, True, 0, 1, -1, 0.5, 3, 1e9, "x", "all", "mesh", "open", "closed", [0, 0, 0], [3, 2, 1], [0, 1], {},
              {"closed": [0, 1, 2, 3, 4]}, {"$": "A"}, {"min": [0, 0, 0], "max": [1, 1, 1]})
    contents = [content for base in RICH for path in paths(base)
                for content in (without(base, *path), *(changed(base, path, value) for value in others))]
    judged = judge(run, contents)
    accepted = [content for content, (code, _) in zip(contents, judged) if code == OK]
    refused = [content for content, (code, _) in zip(contents, judged) if code != OK]
    check(len(accepted) > 500 and len(refused) > 1000, f"{len(accepted)} accepted, {len(refused)} refused")
    for content in accepted:
        equal(faults(content), [], f"accepted by the program, by the schema not: {json.dumps(content)}")
    # Most of these the schema refuses too: what it lets pass is of the kinds of UNSEEN.
    sample = refused[::20]
    seen = sum(faults(content) != [] for content in sample)
    check(seen > 0.8 * len(sample), f"the schema refuses only {seen} of {len(sample)}")


@case
def a_placeholder_can_stand_for_every_value_of_a_move(run):
    contents, values = [], []
    for base in RICH[:3]:
        for number, move in enumerate(base["moves"]):
            for path in [(), *paths(move)]:
                value = move
                for key in path:
                    value = value[key]
                contents.append(changed(base, ("moves", number, *path), {"$": "A"}))
                values.append({"A": json.dumps(value)})
    check(len(contents) > 50, f"only {len(contents)} places")
    for content, (code, words) in zip(contents, judge(run, contents, values)):
        equal((code, words, faults(content)), (OK, "", []), json.dumps(content))


main()
