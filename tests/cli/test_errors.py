#!/usr/bin/env python3
"""Files that are not valid: the exit code and the whole message, and nothing else: no output, crash or hang."""
import json
import os
import re
import struct

from harness import (CUBE, CUBE_CORNERS, EMBEDDING, INVALID, IO, LIMIT, OK, UNSUPPORTED, case, check, equal, glb, gltf_json,
                     lattice, main, pad)

# The text behind the file's name.
OBJ = [
    ("v 1 2\n", INVALID, ":1: a vertex needs 3 numbers, found 2"),
    ("v 1 2 x\n", INVALID, ':1: coordinate z of a vertex is not a number: "x"'),
    ("v\n", INVALID, ":1: a vertex needs 3 numbers, found 0"),
    ("v 1,5 2 3\n", INVALID, ':1: coordinate x of a vertex is not a number: "1,5"'),
    ("v 0x1 2 3\n", INVALID, ':1: coordinate x of a vertex is not a number: "0x1"'),
    ("v --1 0 0\n", INVALID, ':1: coordinate x of a vertex is not a number: "--1"'),
    ("v 1e 0 0\n", INVALID, ':1: coordinate x of a vertex is not a number: "1e"'),
    ("v 1 2 3\nf 1 2 3\n", INVALID, ":2: vertex index 2 is out of range: the file has 1"),
    ("v 1 2 3\nf 0\n", INVALID, ":2: vertex index 0 is out of range: indices start at 1"),
    ("v 1 2 3\nf -2 1 1\n", INVALID, ":2: vertex index -2 is out of range: 1 comes before it"),
    ("v 1 2 3\nf 1//2/3 1 1\n", INVALID, ':2: not a corner (v, v/t, v//n or v/t/n): "1//2/3"'),
    ("v 1 2 3\nf a b c\n", INVALID, ':2: not a corner (v, v/t, v//n or v/t/n): "a"'),
    ("v 1 2 3\nf 1.5 1 1\n", INVALID, ':2: not a corner (v, v/t, v//n or v/t/n): "1.5"'),
    ("v 1 2 3\nf 99999999999999999999 1 1\n", INVALID,
     ":2: vertex index 99999999999999999999 is out of range: the file has 1"),
    ("vn 1 2\n", INVALID, ":1: a normal needs 3 numbers, found 2"),
    ("vn x y z\n", INVALID, ':1: coordinate x of a normal is not a number: "x"'),
    ("v 1 2 3\nl 1 5\n", INVALID, ":2: vertex index 5 is out of range: the file has 1"),
    ("v 1 2 3\np 2\n", INVALID, ":2: vertex index 2 is out of range: the file has 1"),
    ("v 1 2 3\r\nf 4 4 4\r\n", INVALID, ":2: vertex index 4 is out of range: the file has 1"),
    ("v 1 2 3\rf 4 4 4\r", INVALID, ":2: vertex index 4 is out of range: the file has 1"),
    ("v 1 2 3 # x\n\\\nv 1\n", INVALID, ":3: a vertex needs 3 numbers, found 1"),
    ("v 1 \\\n2\n\nv 1 2 3\n", INVALID, ":1: a vertex needs 3 numbers, found 2"),
    ("\ufeffv 1 2\n", INVALID, ":1: a vertex needs 3 numbers, found 2"),
    ("# x\n\tv 1 2 \u0001\n", INVALID, ':2: coordinate z of a vertex is not a number: "?"'),
]

LATTICES = [
    ("", INVALID, ":1: not valid JSON: a value is expected, found the end of the text (column 1)"),
    ("{", INVALID, ":1: not valid JSON: a key in double quotes is expected, found the end of the text (column 2)"),
    ("[]", INVALID, ":1: a lattice is an object, not an array of 0"),
    ("1", INVALID, ":1: a lattice is an object, not the number 1"),
    ("null", INVALID, ":1: a lattice is an object, not null"),
    ('{"format":"ffd-lattice",}', INVALID, ":1: not valid JSON: one comma too many (column 24)"),
    ('{\n"format":"ffd-lattice"\n"version":1}', INVALID, ":3: not valid JSON: ',' or '}' is expected, found '\"' (column 1)"),
    (b'\xff\xfe', INVALID, ":1: is text in UTF-16: it must be UTF-8"),
    ('{"format": "ffd-lattice"}'.encode("utf-16-le"), INVALID, ":1: is text in UTF-16: it must be UTF-8"),
    (' {"format": "ffd-lattice"}'.encode("utf-16-be"), INVALID, ":1: is text in UTF-16: it must be UTF-8"),
    ('{"format":"ffd-lattice", // one\n}', INVALID,
     ':1: not valid JSON: JSON has no comments; a lattice has the member "comment" for them (column 26)'),
    (CUBE, INVALID, ":1: not valid JSON; it seems to be an OBJ file"),
    ("# a mesh\n" + CUBE, INVALID, ":1: not valid JSON; it seems to be an OBJ file"),
    (b"\x89PNG\r\n\x1a\n", INVALID, ":1: not valid JSON; it seems to be a PNG image"),
    ('{"format":"ffd-lattice","format":"x"}', INVALID, ':1: /format: not valid JSON: duplicate key "format" in an object (column 25)'),
    ("[" * 100000, INVALID, ":1: not valid JSON: values are nested more than 256 deep, found '[' (column 257)"),
    ('{"a":NaN}', INVALID, ":1: not valid JSON: JSON has no NaN (column 6)"),
    ('{"format":"ffd-lattice","version":1,"size":[1e999,4,4]}', INVALID,
     ":1: not valid JSON: the number 1e999 is too large (column 45)"),
    ({}, INVALID, ':1: "format" is missing'),
    (lattice(format="x"), INVALID, ':1: /format: unknown word "x"; the only known one is "ffd-lattice"'),
    (lattice(format=1), INVALID, ':1: /format: must be a word like "ffd-lattice", not the number 1'),
    (lattice(version=2), UNSUPPORTED, ":1: /version: version 2 is newer than 1, the newest known here"),
    (lattice(version="1"), INVALID, ':1: /version: must be a whole number, not the text "1"'),
    (lattice(size=[4, 4]), INVALID, ":1: /size: must be an array of 3 sizes, not an array of 2"),
    (lattice(size=[1, 4, 4]), INVALID, ':1: /size/0: is 1, but a direction has at least 2 control points: a plane needs two layers that move alike: '
     '"size": [5, 5, 2], "degree": [3, 3, 1], and "at": [i, j, "all"]'),
    (lattice(size=[4, 4, 4.5]), INVALID, ":1: /size/2: must be a whole number, not the number 4.5"),
    (lattice(size=[10 ** 9] * 3), LIMIT, ":1: /size/0: size 1000000000 makes more than 67108864 control points"),
    (lattice(size="4"), INVALID, ":1: /size: must be an array of 3 sizes, not an array of 1"),
    (lattice(degree=[3, 3]), INVALID, ":1: /degree: must be an array of 3 degrees, not an array of 2"),
    (lattice(degree=[0, 3, 3]), INVALID, ":1: /degree/0: degree 0 is not between 1 and 14: degree 1 between two layers that move alike does the same"),
    (lattice(degree=[15, 3, 3]), INVALID, ":1: /degree/0: degree 15 is not between 1 and 14: as many control points of a lower degree each move a smaller part"),
    (lattice(degree=[4, 3, 3]), INVALID, ":1: /degree/0: degree 4 needs at least 5 control points, not 4"),
    (lattice(sise=[4, 4, 4]), INVALID, ':1: /sise: unknown key "sise"; the nearest known one is "size"'),
    (lattice(knots=["clamped"]), INVALID, ":1: /knots: must be an array of 3 knot vectors, not an array of 1"),
    (lattice(knots=["clampd", "open", "open"]), INVALID,
     ':1: /knots/0: unknown word "clampd"; the nearest known one is "clamped"'),
    (lattice(knots=["closed", "clamped", "clamped"]), INVALID,
     ":1: /knots/0: direction u of a box cannot be closed: its points do not form a ring"),
    (lattice(knots=[[0, 0, 0, 0, 1, 1, 1], "clamped", "clamped"]), INVALID,
     ":1: /knots/0: must be an array of 8 knots, not an array of 7"),
    (lattice(knots=[[0, 0, 0, 0, 1, 1, 1, 0.5], "clamped", "clamped"]), INVALID,
     ":1: /knots/0: direction u: knot 7 is 0.5, less than knot 6, 1"),
    (lattice(knots=[[0] * 8, "clamped", "clamped"]), INVALID,
     ":1: /knots/0: direction u: the domain is empty, knot 3 and knot 4 are both 0"),
    (lattice(knots=[[0, 0, 0, 0, 1, 1, 1, "x"], "clamped", "clamped"]), INVALID,
     ':1: /knots/0/7: must be a number, not the text "x"'),
    (lattice(size=[6, 4, 4], knots=[[0, 0, 0, 0.5, 0.5, 0.5, 0.5, 1, 1, 1], "clamped", "clamped"]), INVALID,
     ":1: /knots/0: direction u: the domain is empty, knot 3 and knot 6 are both 0.5"),
    (lattice(rest={}), INVALID, ':1: /rest: needs exactly one of "box", "cylinder", "points"'),
    (lattice(rest={"box": {}}), INVALID, ':1: /rest/box: "min" is missing'),
    (lattice(rest={"box": {"min": [0, 0, 0]}}), INVALID, ':1: /rest/box: "max" is missing'),
    (lattice(rest={"box": {"min": [0, 0, 0], "max": [1, 1]}}), INVALID,
     ":1: /rest/box/max: must be an array of 3 numbers, not an array of 2"),
    (lattice(rest={"box": {"min": [0, 0, 0], "max": [1, 1, 0]}}), INVALID,
     ":1: /rest/box: max 0 of direction w is not more than min 0"),
    (lattice(rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": "even"}}), INVALID,
     ':1: /rest/box/spacing: unknown word "even"; known ones are "greville", "uniform"'),
    (lattice(rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1], "axes": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}}), INVALID,
     ":1: /rest/box/axes: axis 2 has the length 2, not 1"),
    (lattice(rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1], "axes": [[1, 0, 0], [1, 0, 0], [0, 0, 1]]}}), INVALID,
     ":1: /rest/box/axes: axes 0 and 1 are not perpendicular: their dot product is 1"),
    (lattice(rest={"box": "meshes"}), INVALID, ':1: /rest/box: unknown word "meshes"; the nearest known one is "mesh"'),
    (lattice(rest={"box": "mesh", "margin": -1}), INVALID, ":1: /rest/margin: margin -1 is less than 0"),
    (lattice(rest={"box": "mesh", "cylinder": {}}), INVALID,
     ':1: /rest: needs exactly one of "box", "cylinder", "points"'),
    (lattice(rest={"points": [[0, 0, 0]]}), INVALID, ":1: /rest/points: must be an array of 64 points, not an array of 1"),
    (lattice(rest={"points": [[0, 0, 0]] * 64}), INVALID,
     ": the rest lattice has no volume in cell (0, 0, 0): its control points lie in a plane or on a line"),
    (lattice(rest={"points": [[0, 0]] * 64}), INVALID, ":1: /rest/points/0: must be an array of 3 numbers, not an array of 2"),
    (lattice(rest={"cylinder": {}}), INVALID, ':1: /rest/cylinder: "center" is missing'),
    (lattice(rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 0], "radius": [0, 1], "height": 1}}), INVALID,
     ":1: /rest/cylinder/axis: must not be 0 0 0: that is not a direction"),
    (lattice(rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [1, 0], "height": 1}}), INVALID,
     ":1: /rest/cylinder/radius: radii 1 and 0 are not 0 <= r0 < r1"),
    (lattice(rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 1], "height": 0}}), INVALID,
     ":1: /rest/cylinder/height: height 0 is not more than 0"),
    (lattice(rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 1], "height": 1,
                                "angle": [0, 400]}}), INVALID,
     ":1: /rest/cylinder/angle: 0 to 400 degrees is not an angle of more than 0, at most 360"),
    (lattice(weights=[1]), INVALID, ":1: /weights: must be an array of 64 weights, not an array of 1"),
    (lattice(weights=[0] * 64), INVALID, ":1: /weights/0: weight 0 is not positive"),
    (lattice(weights=[-1] * 64), INVALID, ":1: /weights/0: weight -1 is not positive"),
    (lattice(deformed={"points": []}), INVALID, ":1: /deformed/points: must be an array of 64 points, not an array of 0"),
    (lattice(deformed={"pts": []}), INVALID, ':1: /deformed/pts: unknown key "pts"; the nearest known one is "points"'),
    (lattice(units="metres"), INVALID, ':1: /units: unknown word "metres"; known ones are "world", "box", "mesh"'),
    (lattice(moves=[1]), INVALID, ":1: /moves/0: must be an object, not the number 1"),
    (lattice(moves=[{}]), INVALID, ":1: /moves/0: has no action: by, to, scale, rotate, matrix, twist, taper, bend, pull, drag or jitter"),
    (lattice(moves=[{"by": [1, 2]}]), INVALID, ":1: /moves/0/by: must be an array of 3 numbers, not an array of 2"),
    (lattice(moves=[{"by": [1, 2, 3], "to": [1, 2, 3]}]), INVALID,
     ':1: /moves/0: has two actions, "by" and "to"; a move has one'),
    (lattice(moves=[{"at": [4, 0, 0], "by": [0, 0, 0]}]), INVALID,
     ":1: /moves/0/at/0: index 4 is outside 0 to 3 (or -4 to -1)"),
    (lattice(moves=[{"at": [-5, 0, 0], "by": [0, 0, 0]}]), INVALID,
     ":1: /moves/0/at/0: index -5 is outside 0 to 3 (or -4 to -1)"),
    (lattice(moves=[{"at": [[2, 1], 0, 0], "by": [0, 0, 0]}]), INVALID,
     ":1: /moves/0/at/0: the range from 2 to 1 is empty"),
    (lattice(moves=[{"at": ["al", 0, 0], "by": [0, 0, 0]}]), INVALID,
     ':1: /moves/0/at/0: is the text "al", not an index (0, "first" or "bottom": the first layer; -1, "last" or "top": the last), a range [lo, hi] or "all"'),
    (lattice(moves=[{"at": [0, 0], "by": [0, 0, 0]}]), INVALID, ":1: /moves/0/at: must be an array of 3 selections, not an array of 2"),
    (lattice(moves=[{"at": [0, 0, 0], "within": {"min": [0, 0, 0], "max": [1, 1, 1]}, "by": [0, 0, 0]}]), INVALID,
     ':1: /moves/0: has both "at" and "within"; a move selects its points by one of them'),
    (lattice(moves=[{"weight": 2, "by": [0, 0, 0]}]), INVALID, ":1: /moves/0/weight: weight 2 is not between 0 and 1"),
    (lattice(moves=[{"wieght": 1, "by": [0, 0, 0]}]), INVALID,
     ':1: /moves/0/wieght: unknown key "wieght"; the nearest known one is "weight"'),
    (lattice(moves=[{"twits": {}}]), INVALID, ':1: /moves/0/twits: unknown key "twits"; the nearest known one is "twist"'),
    (lattice(moves=[{"twist": {"axis": "q", "degrees": 1}}]), INVALID,
     ':1: /moves/0/twist/axis: unknown word "q"; known ones are "x", "y", "z"'),
    (lattice(moves=[{"twist": {"axis": "z"}}]), INVALID, ':1: /moves/0/twist: "degrees" is missing'),
    (lattice(moves=[{"rotate": {"axis": [0, 0, 0], "degrees": 1}}]), INVALID,
     ":1: /moves/0/rotate/axis: must not be 0 0 0: that is not a direction"),
    (lattice(moves=[{"matrix": [1] * 16}]), INVALID, ":1: /moves/0/matrix: the last row is 1 1 1 1, not 0 0 0 1"),
    (lattice(moves=[{"matrix": [1] * 15}]), INVALID, ":1: /moves/0/matrix: must be an array of 16 numbers, not an array of 15"),
    (lattice(moves=[{"scale": {"factor": "x"}}]), INVALID,
     ':1: /moves/0/scale/factor: must be a number, not the text "x"'),
    (lattice(moves=[{"bend": {"axis": "z", "toward": [0, 0, 1], "degrees": 9}}]), INVALID,
     ":1: /moves/0/bend/toward: is parallel to the axis, which it must not be"),
    (lattice(moves=[{"taper": {"axis": "z"}}]), INVALID, ':1: /moves/0/taper: "factor" is missing'),
    (lattice(moves=[{"at": [0.5, 0, 0], "by": [0, 0, 0]}]), INVALID,
     ":1: /moves/0/at/0: must be a whole number, not the number 0.5"),
    (lattice(moves=[{"by": [1e+308, 0, 0]}, {"by": [1e+308, 0, 0]}]), INVALID,
     ":1: /moves/1: moves control point 0,0,0 to a position that is not finite"),
    (lattice(moves=[{"within": {"min": [1, 1, 1], "max": [0, 0, 0]}, "by": [0, 0, 0]}]), INVALID,
     ":1: /moves/0/within: max 0 is less than min 1"),
    (lattice(moves=[{"within": {"min": [7, 7, 7], "max": [8, 8, 8]}, "by": [1, 0, 0]}]), INVALID,
     ":1: /moves/0: selects no control point: none is within these bounds at rest"),
]


def start(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))


def refused(run, name, content, code, message):
    """deform, embed, info and compare refuse the mesh in the same words, where they look at all of it."""
    ending = os.path.splitext(name)[1]
    run.write(name, content)
    run.ffd("deform", name, "out" + ending, "-l", "l.json", code=code, err=name + message)
    run.ffd("embed", name, "-l", "l.json", "-o", "out.npy", code=code, err=name + message)
    check(not run.exists("out" + ending) and not run.exists("out.npy"), "an output was written")


@case
def broken_obj_files_are_refused_with_their_line(run):
    start(run)
    for content, code, message in OBJ:
        refused(run, "m.obj", content, code, message)
        run.ffd("info", "m.obj", code=code, err="m.obj" + message)
        run.ffd("lattice", "new", "m.obj", "-o", "n.json", code=code, err="m.obj" + message)
        run.ffd("compare", "m.obj", "a.obj", code=code, err="m.obj" + message)
        run.ffd("compare", "a.obj", "m.obj", code=code, err="m.obj" + message)


@case
def broken_lattice_files_are_refused_with_their_place(run):
    start(run)
    for content, code, message in LATTICES:
        run.write("t.json", content)
        run.ffd("deform", "a.obj", "out.obj", "-l", "t.json", code=code, err="t.json" + message)
        run.ffd("deform", "a.obj", "out.obj", "-l", "l.json", "-l", "t.json", code=code, err="t.json" + message)
        run.ffd("embed", "a.obj", "-l", "t.json", "-o", "out.npy", code=code, err="t.json" + message)
        # A rest lattice without volume can be described; only what inverts it must refuse it.
        if "no volume" not in message:
            run.ffd("info", "t.json", code=code, err="t.json" + message)
        check(not run.exists("out.obj") and not run.exists("out.npy"), "an output was written")


@case
def obj_positions_that_are_not_finite(run):
    start(run)
    for word in ("nan", "inf", "-inf", "1e999", "-1e999", "NaN"):
        run.write("m.obj", CUBE + f"p 9\nv 0 {word} 0\n")
        run.ffd("deform", "m.obj", "out.obj", "-l", "l.json", "--force",
                err="m.obj: 1 of 9 vertices is not inside: 1 invalid (not finite; left where it is)")
        equal(run.text("out.obj").splitlines()[-1], f"v 0 {word} 0")


@case
def obj_files_that_are_strange_but_valid(run):
    start(run)
    for content in ("v 0 0 0", "v 0 0 0 \\", "\\\n\\\nv 0 0 0\n", "v 1e-400 0 0\n",
                    "v 0 0 0\n" * 3 + "f 1 2 3 " + "1 " * 20000, "v 0 0 0\nf -1 -1 -1\n", "f 1 1 1\nv 0 0 0\n", "f\n", "vt x\n"):
        run.write("m.obj", content)
        run.ffd("deform", "m.obj", "out.obj", "-l", "l.json", "--force", lines="v 0" not in content and "v 1" not in content)
        run.ffd("compare", "m.obj", "out.obj", "--tolerance", "1")
        run.ffd("info", "m.obj")
    for content in ("", "\n", "# x", "\0\0\0", "x" * 100000, "V 1 2\n", "\r\n\r\r\n"):
        run.write("m.obj", content)
        run.ffd("deform", "m.obj", "none.obj", "-l", "l.json", code=INVALID)


def changed(asset, path, value):
    """A copy of the asset with the value at the path ("accessors/0/count")."""
    asset = json.loads(json.dumps(asset))
    *way, last = [int(key) if key.isdigit() else key for key in path.split("/")]
    place = asset
    for key in way:
        place = place[key]
    place[last] = value
    return asset


@case
def broken_glb_containers_are_refused(run):
    start(run)
    good = glb(*gltf_json(CUBE_CORNERS))
    size = len(good)
    for content, code, message in (
            (b"", INVALID, ': is not a GLB file: it does not start with "glTF"'),
            (b"XXXX" + good[4:], INVALID, ': is not a GLB file: it does not start with "glTF"'),
            (good[:11], INVALID, ": GLB: the file has 11 bytes, less than its header"),
            (good[:40], INVALID, f": GLB: the header states a size of {size}, the file has 40 bytes"),
            (good[:-1], INVALID, f": GLB: the header states a size of {size}, the file has {size - 1} bytes"),
            (good[:8] + struct.pack("<I", 5) + good[12:], INVALID, f": GLB: the header states a size of 5, the file has {size} bytes"),
            (good[:12] + struct.pack("<I", 2**32 - 1) + good[16:], INVALID,
             f": GLB: the chunk at byte 12 states a size of 4294967295, but only {size - 20} bytes follow"),
            (good[:4] + struct.pack("<I", 3) + good[8:], UNSUPPORTED, ": GLB: the version is 3, only 2 is known"),
            (good[:4] + struct.pack("<I", 1) + good[8:], UNSUPPORTED, ": GLB: the version is 1, only 2 is known")):
        refused(run, "m.glb", content, code, message)
        run.ffd("info", "m.glb", code=code, err="m.glb" + message)
    for length in range(len(good)):
        if length % 7 == 0 or length < 30:
            run.write("m.glb", good[:length])
            run.ffd("deform", "m.glb", "out.glb", "-l", "l.json", code=INVALID)


@case
def broken_json_of_gltf_is_refused(run):
    start(run)
    for text, message in (
            ("{", ":1: not valid JSON: a key in double quotes is expected, found the end of the text (column 2)"),
            ("[]", ": is not glTF: the JSON is not an object"),
            ("null", ": is not glTF: the JSON is not an object"),
            ("{}", ':1: "asset" is missing'),
            ('{"asset":{"version":"2.0"}', ":1: not valid JSON: ',' or '}' is expected, found the end of the text (column 27)"),
            ('{"asset":{"version":"2.0"}} x', ":1: not valid JSON: nothing may follow the value, found 'x' (column 29)"),
            ('{\n"asset":{"version":"2.0"},\n"x":,}', ":3: not valid JSON: a value is expected, found ',' (column 5)"),
            ('{"asset":{"version":2.0}}', ":1: /asset/version: a string is expected, not 2.0"),
            ('{"asset":{"version":"2.0"},"meshes":{}}', ":1: /meshes: an array of objects is expected, not {}"),
            ("[" * 100000, ":1: not valid JSON: values are nested more than 256 deep, found '[' (column 257)"),
            ('{"a":' * 300 + "1" + "}" * 300, ":1: not valid JSON: values are nested more than 256 deep, found '{' (column 1281)")):
        refused(run, "m.gltf", text, INVALID, message)
        chunk = pad(text.encode(), b" ")
        if "the end of the text" in message:
            message = f"{message.split(' (')[0]} (column {len(chunk) + 1})"
        file = struct.pack("<IIIII", 0x46546C67, 2, 20 + len(chunk), len(chunk), 0x4E4F534A) + chunk
        # Values in a GLB file have no line.
        refused(run, "m.glb", file, INVALID, message if "not valid JSON" in message else re.sub("^:1: ?(/?)", r":\1" if ":1: /" in message else ": ", message))


@case
def gltf_references_and_sizes(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS)
    for path, value, code, message in (
            ("asset/version", "1.0", UNSUPPORTED, ':/asset/version: glTF version "1.0" is not known, only 2'),
            ("scene", 5, INVALID, ":/scene: there is no scene 5, only 1"),
            ("scenes/0/nodes", [7], INVALID, ":/scenes/0/nodes: there is no node 7, only 1"),
            ("nodes/0/mesh", 3, INVALID, ":/nodes/0/mesh: there is no mesh 3, only 1"),
            ("nodes/0/children", [0], INVALID, ":/nodes/0: the node is its own ancestor, or below one that is"),
            ("nodes/0/matrix", [1] * 15, INVALID, ":/nodes/0/matrix: 16 numbers are expected, not 15"),
            ("meshes/0/primitives/0/attributes/POSITION", 4, INVALID,
             ":/meshes/0/primitives/0/attributes/POSITION: there is no accessor 4, only 1"),
            ("meshes/0/primitives/0/mode", "x", INVALID,
             ':/meshes/0/primitives/0/mode: a mode from 0 to 6 is expected, not "x"'),
            ("accessors/0/count", 9, INVALID,
             ":/accessors/0/count: 9 elements need 108 bytes of bufferView 0, which has 96"),
            ("accessors/0/count", 2**31, INVALID,
             ":/accessors/0/count: 2147483648 elements need 25769803776 bytes of bufferView 0, which has 96"),
            ("accessors/0/count", 2**62, INVALID,
             ":/accessors/0/count: an integer from 0 to 2^53 is expected, not 4611686018427387904"),
            ("accessors/0/count", -1, INVALID, ":/accessors/0/count: an integer from 0 to 2^53 is expected, not -1"),
            ("accessors/0/byteOffset", 4, INVALID,
             ":/accessors/0/count: 8 elements need 100 bytes of bufferView 0, which has 96"),
            ("accessors/0/type", "VEC2", INVALID,
             ":/meshes/0/primitives/0/attributes/POSITION: its accessor is not a VEC3"),
            ("accessors/0/bufferView", 3, INVALID, ":/accessors/0/bufferView: there is no bufferView 3, only 1"),
            ("bufferViews/0/buffer", 1, INVALID, ":/bufferViews/0/buffer: there is no buffer 1, only 1"),
            ("bufferViews/0/byteLength", 10**6, INVALID,
             ":/bufferViews/0/byteLength: bytes 0 to 1000000 are outside buffer 0 of 96 bytes"),
            ("bufferViews/0/byteOffset", 2**40, INVALID,
             ":/bufferViews/0/byteLength: bytes 1099511627776 to 1099511627872 are outside buffer 0 of 96 bytes"),
            ("bufferViews/0/byteStride", 253, INVALID,
             ":/bufferViews/0/byteStride: a multiple of 4 from 4 to 252 is expected, not 253"),
            ("bufferViews/0/byteStride", 8, INVALID,
             ":/accessors/0/bufferView: its elements have 12 bytes, more than the byteStride 8"),
            ("extensionsRequired", ["ACME_x"], UNSUPPORTED,
             ':/extensionsRequired/0: the required extension "ACME_x" is not known (--allow-extension ACME_x deforms the file '
             "all the same)")):
        refused(run, "m.glb", glb(changed(asset, path, value), data), code, message)


@case
def gltf_positions_that_are_not_finite(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS)
    for value in ("nan", "inf", "-inf"):
        run.write("m.glb", glb(asset, data[:24] + struct.pack("<f", float(value)) + data[28:]))
        run.ffd("deform", "m.glb", "out.glb", "-l", "l.json", "--force",
                err="m.glb: 1 of 8 vertices is not inside: 1 invalid (not finite; left where it is)")
        before, after = run.read("m.glb"), run.read("out.glb")
        equal(after[-len(data) + 24:-len(data) + 36], before[-len(data) + 24:-len(data) + 36], "the vertex")


@case
def gltf_buffers_outside_the_folder(run):
    start(run)
    run.write("outside.bin", gltf_json(CUBE_CORNERS)[1])
    run.folder_of("m/folder")
    os.symlink("../outside.bin", run.path("m/link.bin"))
    os.symlink("nothing", run.path("m/dangling.bin"))
    for uri in ("../outside.bin", "%2e%2e/outside.bin", "%2E%2E%2Foutside.bin", "folder/../../outside.bin", "link.bin",
                "/etc/hostname", "%2Fetc%2Fhostname", "file:///etc/hostname", "FILE:///etc/hostname", "http://localhost/x.bin",
                "none.bin", "dangling.bin", "folder", "", ".", "/dev/zero", "/dev/stdin", run.path("outside.bin")):
        run.write("m/m.gltf", gltf_json(CUBE_CORNERS, uri="x")[0] | {"buffers": [{"byteLength": 96, "uri": uri}]})
        done = run.ffd("deform", "m/m.gltf", "m/out.gltf", "-l", "l.json", code=IO)
        check(done.err[0].startswith("m/m.gltf:"), done.err[0])
        run.ffd("info", "m/m.gltf", code=IO)
        check(not run.exists("m/out.gltf") and not run.exists("m/out.bin"), "an output was written")


@case
def broken_data_uris_are_refused(run):
    start(run)
    for uri, message in (("data:application/octet-stream;base64,!!!!", ":1: /buffers/0/uri: the data URI is not valid base64"),
                         ("data:application/octet-stream;base64,AAAA",
                          ":1: /buffers/0: the buffer has 3 bytes, less than its byteLength 96")):
        refused(run, "m.gltf", json.dumps(gltf_json(CUBE_CORNERS, uri=uri)[0]), INVALID, message)


@case
def files_that_are_not_there(run):
    start(run)
    run.folder_of("d.obj")
    run.folder_of("d.json")
    run.ffd("deform", "none.obj", "o.obj", "-l", "l.json", code=IO, err="none.obj: cannot be opened: No such file or directory")
    run.ffd("deform", "a.obj", "o.obj", "-l", "none.json", code=IO, err="none.json: cannot be opened: No such file or directory")
    run.ffd("deform", "a.obj/x.obj", "o.obj", "-l", "l.json", code=IO, err="a.obj/x.obj: cannot be opened: Not a directory")
    run.ffd("deform", "d.obj", "o.obj", "-l", "l.json", code=IO, err="d.obj: is a folder")
    run.ffd("deform", "a.obj", "o.obj", "-l", "d.json", code=IO, err="d.json: is a folder")


@case
def results_that_do_not_fit(run):
    """A deformed position that the file's numbers cannot hold is refused, not written as infinity."""
    start(run)
    run.write("far.json", lattice(moves=[{"by": [3e38, 0, 0]}, {"by": [3e38, 0, 0]}]))
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    done = run.ffd("deform", "a.glb", "o.glb", "-l", "far.json", code=INVALID)
    check(done.err[0].startswith("a.glb: ") and not run.exists("o.glb"), done.err[0])


@case
def random_damage_never_crashes(run):
    """Bytes changed, dropped or doubled at places that a fixed rule chooses: some exit code of the table."""
    start(run)
    asset, data = gltf_json(CUBE_CORNERS)
    seed = 12345
    for name, good in (("m.glb", glb(asset, data)), ("m.obj", CUBE.encode()), ("t.json", json.dumps(lattice()).encode())):
        for _ in range(150):
            seed = (seed * 1103515245 + 12345) % 2**31
            at, kind, byte = seed // 8 % len(good), seed % 3, seed // 65536 % 256
            bad = (good[:at] + bytes([byte]) + good[at + 1:], good[:at] + good[at + 1:], good[:at] + good[at:at + 9] + good[at:])
            run.write(name, bad[kind])
            words = ["a.obj", "out.obj", "-l", name] if name == "t.json" else [name, "out" + name[1:], "-l", "l.json"]
            run.ffd("deform", *words, "--force", "-q", code=(OK, IO, INVALID, EMBEDDING, UNSUPPORTED, LIMIT))


@case
def a_file_for_newer_readers_is_described_but_not_deformed(run):
    asset, data = gltf_json(CUBE_CORNERS)
    asset["asset"]["minVersion"] = "2.1"
    run.write("m.glb", glb(asset, data))
    run.write("l.json", lattice())
    run.ffd("deform", "m.glb", "out.glb", "-l", "l.json", code=UNSUPPORTED,
            err="m.glb:/asset/minVersion: the file needs glTF 2.1, but only 2.0 is supported")
    run.ffd("info", "m.glb")


@case
def numbers_of_old_windows_programs_are_named(run):
    """Though # begins a comment elsewhere: z would be 1, or missing."""
    for word in ("1.#QNAN", "-1.#IND", "1.#INF00", "1.#SNAN"):
        for axis, places in (("y", f"0 {word} 0"), ("z", f"0 0 {word}")):
            for name, text, line in (("n.obj", f"v {places}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1),
                                     ("n.off", f"OFF\n3 1 0\n{places}\n1 0 0\n0 1 0\n3 0 1 2\n", 3)):
                run.write(name, text)
                run.ffd("info", name, code=INVALID, err=f'{name}:{line}: coordinate {axis} of a vertex is not a number: "{word}"')
    run.write("n.obj", "v 0 0 1.#why\nv 1 0 0.# INF\nv 0 1 0#IND\nf 1 2 3# 1.#INF\n")
    equal(run.ffd("info", "n.obj", "--json").json["vertices"], 3)


main()
