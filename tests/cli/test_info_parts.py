#!/usr/bin/env python3
"""ffd info --parts: every name that --only takes, with bounds and counts; --set of info and embed; where the layers of
a lattice stand."""
import math
import re

from gltf_build import Scene
from harness import INVALID, USAGE, case, check, equal, lattice, main, near, npy
from messages import anything

SHEET = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 5
v 2 1 5
o First Thing
g left both
usemtl red
f 1 2 3 4
g right both
usemtl dark blue
f 2 5 6
f 2 6 3
"""
# selector: vertices, faces, bounds
SHEET_PARTS = {
    "object:First Thing": (6, 3, [0, 0, 0], [2, 1, 5]),
    "group:left": (4, 1, [0, 0, 0], [1, 1, 0]),
    "group:right": (4, 2, [1, 0, 0], [2, 1, 5]),
    "group:both": (6, 3, [0, 0, 0], [2, 1, 5]),
    "material:red": (4, 1, [0, 0, 0], [1, 1, 0]),
    "material:dark blue": (4, 2, [1, 0, 0], [2, 1, 5]),
}


def selector(part):
    """That of an object: a text as KIND:NAME, or a kind and a name."""
    if {"kind", "name"} <= set(part):
        return f"{part['kind']}:{part['name']}"
    return next((x for x in part.values() if isinstance(x, str) and re.match("(node|mesh|material|group|object):", x)), None)


def parts_of(value, found=None):
    """Every object of the JSON that has a selector, bounds and counts of vertices and faces, by the selector."""
    found = {} if found is None else found
    if isinstance(value, dict):
        if {"vertices", "faces", "bounds"} <= set(value) and selector(value):
            found[selector(value)] = (value["vertices"], value["faces"], value["bounds"]["min"], value["bounds"]["max"])
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            parts_of(item, found)
    return found


@case
def parts_of_an_obj(run):
    run.write("a.obj", SHEET)
    equal(parts_of(run.ffd("info", "a.obj", "--parts", "--json").json), SHEET_PARTS)
    text = run.ffd("info", "a.obj", "--parts").text
    for name in SHEET_PARTS:
        check(name in text, f"{name} is not in the text")
    equal(parts_of(run.ffd("info", "a.obj", "--json").json), {}, "without the option")


@case
def one_long_name_widens_no_other_line(run):
    """Of a file of 100 kB the text had 20 MB, of one of 5 MB hundreds of gigabytes."""
    long, names = "x" * 100000, [f"y{i}" for i in range(200)]
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "".join(f"g {name}\nf 1 2 3\n" for name in [long, *names, "z" * 80]))
    lines = run.ffd("info", "a.obj", "--parts").text.splitlines()
    told = [line.split(None, 1) for line in lines if "3 vertices, 1 face" in line]
    check(f"group:{long}  3 vertices, 1 face, from 0 0 0 to 1 1 0" in [line.strip() for line in lines], "the long name")
    equal(sorted(name for name, _ in told), sorted(f"group:{name}" for name in [long, *names, "z" * 80]))
    equal({line.index("3 vertices") for line in lines if "3 vertices, 1 face" in line and long not in line}, {2 + 6 + 80 + 2}, "the column")


@case
def every_name_is_one_that_only_takes(run):
    run.write("a.obj", SHEET)
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [1, 0, 0]}]))
    found = parts_of(run.ffd("info", "a.obj", "--parts", "--json").json)
    equal(set(found), set(SHEET_PARTS))
    for name, (vertices, *_) in found.items():
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--only", name, "--force", err=anything)
        moved = sum(a != b for a, b in zip(run.text("a.obj").splitlines(), run.text("b.obj").splitlines()))
        equal(moved, vertices, name)


@case
def parts_of_a_scene(run):
    """Nodes with what is below them, where the scene shows it; meshes and materials by all nodes that show them."""
    made = Scene(nodes=[{"name": "car", "translation": [10, 0, 0], "children": [1, 2]}, {"name": "body", "mesh": 0},
                        {"name": "wheel", "mesh": 1, "translation": [0, 5, 0]}], scene=0, scenes=[{"nodes": [0]}],
                 materials=[{"name": "paint"}, {"name": "rubber"}])
    points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
    made.asset["meshes"] = [{"name": name, "primitives": [{"attributes": {"POSITION": made.add(points, bounds=True)}, "material": m}]}
                            for m, name in enumerate(("hull", "tyre"))]
    run.write("a.glb", made.glb())
    hull, tyre = (3, 1, [10, 0, 0], [11, 1, 1]), (3, 1, [10, 5, 0], [11, 6, 1])
    equal(parts_of(run.ffd("info", "a.glb", "--parts", "--json").json), {
        "node:car": (6, 2, [10, 0, 0], [11, 6, 1]), "node:body": hull, "node:wheel": tyre, "mesh:hull": hull, "mesh:tyre": tyre,
        "material:paint": hull, "material:rubber": tyre})


@case
def a_file_without_parts(run):
    run.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    equal(parts_of(run.ffd("info", "a.off", "--parts", "--json").json), {})
    run.ffd("info", "a.off", "--parts")


@case
def what_has_no_group_is_in_default(run):
    """The OBJ specification's name of the group that no `g` has begun: --only takes it."""
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    equal(parts_of(run.ffd("info", "a.obj", "--parts", "--json").json), {"group:default": (3, 1, [0, 0, 0], [1, 1, 0])})
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--only", "group:default")
    equal(run.text("b.obj"), "v 1 0 0\nv 2 0 0\nv 1 1 0\nf 1 2 3\n")


@case
def parts_without_a_name_are_told_apart(run):
    """By kind and number, where others of the kind have names and they draw something."""
    points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]]
    made = Scene(nodes=[{"mesh": 0}, {"mesh": 0, "translation": [0, 5, 0]}, {"name": "twin", "mesh": 1}, {"name": "twin", "mesh": 1,
                 "translation": [0, 0, 9]}, {"name": "eye"}, {}], scene=0, scenes=[{"nodes": [0, 1, 2, 3, 4, 5]}])
    position = made.add(points, bounds=True)
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}}]} for _ in range(2)]
    run.write("a.glb", made.glb())
    found = run.ffd("info", "a.glb", "--parts", "--json").json
    named = {part["selector"]: part for part in found["named_parts"]}
    equal(sorted(named), ["node:eye", "node:twin"])
    equal([named["node:eye"][key] for key in ("vertices", "faces", "bounds")], [0, 0, None])
    equal([named["node:twin"][key] for key in ("vertices", "faces", "bounds")], [6, 2, {"min": [0, 0, 0], "max": [1, 1, 10]}])
    # No mesh and no material has a name, and node 5 draws nothing.
    equal([(part["kind"], part["number"], part["vertices"], part["bounds"]) for part in found["unnamed_parts"]],
          [("node", 0, 3, {"min": [0, 0, 0], "max": [1, 1, 1]}), ("node", 1, 3, {"min": [0, 5, 0], "max": [1, 6, 1]})])
    text = run.ffd("info", "a.glb", "--parts").text
    lines = [line.split() for line in text.splitlines()]
    for line in ("node:twin 6 vertices, 2 faces, from 0 0 0 to 1 1 10", "node:eye 0 vertices, 0 faces",
                 "node 1 3 vertices, 1 face, from 0 5 0 to 1 6 1"):
        check(line.split() in lines, text)


@case
def elements_without_an_object_beside_some_with_one(run):
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 7\nl 1 4\no a\nf 1 2 3\no\np 2\no a\nf 1 2 4\no none\n")
    found = run.ffd("info", "a.obj", "--parts", "--json").json
    equal([(part["selector"], part["vertices"], part["faces"]) for part in found["named_parts"]],
          [("object:a", 4, 2), ("object:none", 0, 0), ("group:default", 4, 2)])
    equal([(part["kind"], part["number"], part["vertices"], part["faces"], part["bounds"]) for part in found["unnamed_parts"]],
          [("object", 0, 3, 0, {"min": [0, 0, 0], "max": [1, 0, 7]})])


@case
def what_has_no_parts_or_no_placeholders(run):
    run.write("a.obj", SHEET)
    run.write("l.json", lattice())
    run.ffd("info", "l.json", "--parts", code=USAGE, err=re.compile("l.json: .*parts"))
    run.ffd("info", "a.obj", "--set", "A=1", code=USAGE, err=re.compile("a.obj: .*placeholders"))


HIGH = [{"by": [0, {"$": "H"}, 0]}]


@case
def set_of_info(run):
    run.write("l.json", lattice(moves=HIGH))
    found = run.ffd("info", "l.json", "--json", "--set", "H=0.75").json
    equal([found["moved"], found["largest_move"]], [64, 0.75])
    run.ffd("info", "l.json", "--set", "K=1", "--set", "H=1", code=INVALID, err=re.compile('"K"'))
    run.ffd("info", "l.json", "--set", "H", code=USAGE, err=re.compile("NAME=VALUE"))


@case
def info_says_which_placeholders_are_open(run):
    """What does not depend on moves is known; a value counts where all have one."""
    moves = [{"by": [{"$": "X"}, {"$": "Y"}, {"$": "X"}]}, {"twist": {"axis": "z", "degrees": {"$": "\u00c4 1"}}}]
    run.write("l.json", lattice(moves=moves))
    found = run.ffd("info", "l.json", "--json").json
    equal(found["open_placeholders"], ["X", "Y", "\u00c4 1"])
    equal([found[key] for key in ("deformed_bounds", "moved", "largest_move", "weights_moved")], [None] * 4)
    equal([found["rest_bounds"], found["inversion"]], [{"min": [-2] * 3, "max": [2] * 3}, "affine"])
    check("open placeholders  X, Y, \u00c4 1" in run.ffd("info", "l.json").text, "the text")
    equal(run.ffd("info", "l.json", "--json", "--set", "Y=1").json["open_placeholders"], ["X", "\u00c4 1"])
    run.ffd("info", "l.json", "--set", "K=1", code=INVALID, err=re.compile('"K"'))
    whole = run.ffd("info", "l.json", "--json", "--set", "X=1", "--set", "Y=2", "--set", "\u00c4 1=0").json
    equal([whole["moved"], "open_placeholders" in whole], [64, False])
    run.write("m.json", lattice(rest={"box": "mesh"}, moves=moves))
    found = run.ffd("info", "m.json", "--json").json
    equal([len(found["open_placeholders"]), found["moves"], found["moved"]], [3, None, None])


@case
def embed_needs_no_moves_and_no_values(run):
    run.write("a.obj", "v 0 0 0\nv 1 0.5 -1\n")
    content = lattice()
    del content["moves"]
    run.write("none.json", content)
    for name, moves, options in (("none.json", None, []), ("open.json", HIGH, []), ("open.json", HIGH, ["--set", "H=2"]),
                                 ("still.json", [], [])):
        if moves is not None:
            run.write(name, lattice(moves=moves))
        run.ffd("embed", "a.obj", "-l", name, "-o", "e.npy", "--force", *options)
        near(npy(run.read("e.npy"))[2], [[0.5, 0.5, 0.5], [0.75, 0.625, 0.25]], 1e-15, name)
    run.write("l.json", lattice(moves=[{"by": [0, 2, 0]}]))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--embedding", "e.npy")
    equal(run.text("b.obj"), "v 0 2 0\nv 1 2.5 -1\n", "an embedding is of the rest lattice")


@case
def layers_of_a_lattice_as_json(run):
    """A box along axes of its own, fractions of a box to come, rings of a cylinder, and none of given points."""
    run.write("l.json", lattice(size=(2, 3, 4), degree=[1, 2, 3], knots=["clamped", "open", "uniform"], rest={"box": {
        "min": [0, 0, 10], "max": [1, 2, 16], "axes": [[0, 1, 0], [0, 0, 1], [1, 0, 0]]}}))
    found = run.ffd("info", "l.json", "--json").json
    near([found["layers"][axis] for axis in "uvw"], [[0, 1], [-1, 1, 3], [4, 10, 16, 22]], 1e-12)
    equal(found["layers_beyond_the_box"], {"u": 0, "v": 2, "w": 2})
    check("beyond the box" in found["note"], found)
    run.write("l.json", lattice(size=(2, 3, 5000), rest={"box": "mesh"}, moves=[{"by": [1, 0, 0]}]))
    found = run.ffd("info", "l.json", "--json").json
    equal([found.get("layers"), found["layer_fractions"]], [None, {"u": [0, 1], "v": [0, 0.5, 1], "w": None}])
    check("note" not in found and "layers_beyond_the_box" not in found, found)
    run.write("l.json", lattice(size=(2, 4, 3), degree=[1, 1, 2], rest={"cylinder": {
        "center": [5, 5, 5], "axis": "y", "zero": "z", "radius": [0, 2], "height": 8, "angle": [-45, 45]}}))
    found = run.ffd("info", "l.json", "--json").json["layers"]
    # Chords of 30 degrees at the least radius 2.
    near([found[axis] for axis in "uvw"], [[0, 2 / math.cos(math.radians(15))], [-45, -15, 15, 45], [-4, 0, 4]], 1e-9)
    run.write("l.json", lattice(size=(2, 2, 2), rest={"points": [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]}))
    equal(run.ffd("info", "l.json", "--json").json["layers"], None)


@case
def the_box_of_a_lattice(run):
    """With open knots control points stand beyond it; of meshes that a file names it is round these, with the margin."""
    axes = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]
    run.write("l.json", lattice(knots=["open"] * 3, rest={"box": {"min": [0, 1, 2], "max": [3, 5, 7], "axes": axes}}))
    found = run.ffd("info", "l.json", "--json").json
    equal([found["box"], found["axes"]], [{"min": [0, 1, 2], "max": [3, 5, 7]}, axes])
    run.write("kit/a.obj", "v 0 0 0\nv 2 1 1\nl 1 2\n")
    run.write("kit/b.obj", "v 1 1 1\nv 4 2 1\nl 1 2\n")
    content = lattice(size=(2, 3, 2), rest={"box": {"meshes": ["a.obj", "b.obj"]}, "margin": [0.5, 0, 1]}, moves=[{"by": [0, 7, 0]}])
    run.write("kit/l.json", content)
    found = run.ffd("info", "kit/l.json", "--json").json
    equal([found[key] for key in ("rest", "meshes", "margin")], ["meshes", ["kit/a.obj", "kit/b.obj"], [0.5, 0, 1]])
    equal([found["box"], found["rest_bounds"], found["deformed_bounds"]],
          [{"min": [-2, 0, -1], "max": [6, 2, 2]}] * 2 + [{"min": [-2, 7, -1], "max": [6, 9, 2]}])
    equal([found["layers"], found.get("layer_fractions")], [{"u": [-2, 6], "v": [0, 1, 2], "w": [-1, 2]}, None])
    text = run.ffd("info", "kit/l.json").text
    check("kit/a.obj, kit/b.obj" in text and "0.5 0 1" in text, text)
    run.remove("kit/b.obj")
    found = run.ffd("info", "kit/l.json", "--json").json
    equal([found["box"], found["rest_bounds"], found["layer_fractions"]["v"]], [None, None, [0, 0.5, 1]])
    check("kit/b.obj" in found["box_unknown"], found)
    run.write("m.json", lattice(rest={"box": "mesh", "margin": 0.25}))
    found = run.ffd("info", "m.json", "--json").json
    equal([found["margin"], found["box"], "meshes" in found], [[0.25] * 3, None, False])


def numbers_of(text):
    return [float(x) for x in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", text)]


@case
def info_prints_where_the_layers_stand(run):
    """Greville places of clamped knots; open knots stand evenly, and reach beyond the box."""
    run.write("l.json", lattice(size=(5, 3, 4), low=(0, 10, -3), high=(8, 12, 3), degree=[3, 2, 3]))
    numbers = numbers_of(run.ffd("info", "l.json").text)
    for row in ([0, 4 / 3, 4, 20 / 3, 8], [10, 11, 12], [-3, -1, 1, 3]):
        places = [i for i in range(len(numbers)) if len(numbers) - i >= len(row)
                  and all(abs(a - b) < 1e-4 for a, b in zip(numbers[i:], row))]
        check(places, f"{row} stands nowhere in a row")
    check("beyond" not in run.ffd("info", "l.json").text, "all points of clamped knots are in the box")
    run.write("l.json", lattice(size=(5, 4, 4), low=(0, 0, 0), high=(2, 1, 1), knots=["open", "clamped", "clamped"]))
    text = run.ffd("info", "l.json").text
    numbers = numbers_of(text)
    check(any(all(abs(a - b) < 1e-4 for a, b in zip(numbers[i:], [-1, 0, 1, 2, 3])) for i in range(len(numbers) - 4)), text)
    check("beyond the box" in " ".join(text.split()), text)


main()
