#!/usr/bin/env python3
"""ffd lattice new: a lattice file round a mesh, which deform then takes."""
import json
import math
import re

from harness import (CUBE, CUBE_CORNERS, INVALID, IO, LIMIT, USAGE, case, check, equal, glb, gltf_json, main, near,
                     npy, obj_of, obj_vertices)


def new(run, *arguments, mesh="a.obj", **options):
    if not run.exists(mesh):
        run.write(mesh, CUBE)
    run.ffd("lattice", "new", mesh, "-o", "n.json", "--force", *arguments, **options)
    return json.loads(run.read("n.json"))


def box(content):
    return content["rest"]["box"]


@case
def the_defaults_are_those_of_the_interface(run):
    content = new(run)
    equal([content["format"], content["version"], content["size"]], ["ffd-lattice", 1, [4, 4, 4]])
    equal(content.get("degree", [3, 3, 3]), [3, 3, 3])
    equal(content.get("knots", ["clamped"] * 3), ["clamped"] * 3)
    near([box(content)["min"], box(content)["max"]], [[-1.1] * 3, [1.1] * 3], 1e-15)
    equal(box(content).get("spacing", "greville"), "greville")
    equal(content["moves"], [], "a place for moves")


@case
def the_new_lattice_holds_its_mesh_and_moves_nothing(run):
    for arguments in ([], ["--margin", "0"], ["--knots", "open,uniform,clamped", "--size", "5,6,7"], ["--spacing", "uniform"],
                      ["--shape", "cylinder"], ["--shape", "cylinder", "--axis", "x"], ["--axes", "principal"],
                      ["--shape", "cylinder", "--axis", "1,2,3", "--size", "3,6,4", "--degree", "1,2,3"]):
        new(run, *arguments)
        run.ffd("embed", "a.obj", "-l", "n.json", "-o", "e.npy", "--status", "s.npy", "--force")
        equal(npy(run.read("s.npy"))[2], [0] * 8, str(arguments))
        run.ffd("deform", "a.obj", "b.obj", "-l", "n.json", "--outside", "error", "--force")
        equal(run.text("b.obj"), CUBE, str(arguments))


@case
def options_come_out_as_they_went_in(run):
    content = new(run, "--size", "5,6,7", "--degree", "1,2,5", "--knots", "clamped,open,uniform", "--margin", "0.25")
    equal([content["size"], content["degree"], content["knots"]], [[5, 6, 7], [1, 2, 5], ["clamped", "open", "uniform"]])
    near(box(content)["max"], [1.5] * 3, 1e-15)
    equal(box(new(run, "--spacing=uniform"))["spacing"], "uniform")
    content = new(run, "--size", "2,3,9")
    equal(content["degree"], [1, 2, 3], "the degree where there are fewer points")
    equal(new(run, "--knots", "unclamped,unclamped,unclamped")["knots"], ["open"] * 3)


@case
def margins_are_fractions_of_each_side(run):
    run.write("a.obj", "v 0 0 0\nv 10 20 1\n")
    content = new(run, "--margin", "0.1")
    near([box(content)["min"], box(content)["max"]], [[-1, -2, -0.1], [11, 22, 1.1]], 1e-13)


@case
def cylinders_go_round_the_mesh(run):
    for axis, direction in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1]), ("0,0,-2", [0, 0, -1])):
        content = new(run, "--shape", "cylinder", "--axis", axis, "--margin", "0")
        cylinder = content["rest"]["cylinder"]
        length = math.sqrt(sum(x * x for x in cylinder["axis"]))
        near([x / length for x in cylinder["axis"]], direction, 1e-15)
        near(cylinder["center"], [0, 0, 0], 1e-15)
        near([cylinder["height"]], [2], 1e-12)
        check(cylinder["radius"][1] >= math.sqrt(2), cylinder["radius"])
        equal(content["knots"][1], "closed")


@case
def principal_axes_are_those_of_the_points(run):
    c, s = math.cos(0.5), math.sin(0.5)
    points = [[c * x - s * y, s * x + c * y, z] for x in (-5, -2, 2, 5) for y in (-1, 1) for z in (-0.25, 0.25)]
    run.write("a.obj", obj_of(points))
    content = new(run, "--axes", "principal", "--margin", "0")
    sides = sorted(b - a for a, b in zip(box(content)["min"], box(content)["max"]))
    near(sides, [0.5, 2, 10], 1e-9)
    run.ffd("embed", "a.obj", "-l", "n.json", "-o", "e.npy", "--status", "s.npy")
    equal(set(npy(run.read("s.npy"))[2]), {0})


@case
def the_scene_of_a_gltf(run):
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS, nodes=[{"mesh": 0, "translation": [10, 0, 0]}])))
    content = new(run, "--margin", "0", mesh="a.glb")
    near([box(content)["min"], box(content)["max"]], [[9, -1, -1], [11, 1, 1]], 1e-12)


@case
def flat_and_single_points_get_a_volume(run):
    for text in ("v 1 2 3\n", "v 0 0 0\nv 1 0 0\n", "v 0 0 5\nv 1 0 5\nv 0 1 5\n", "v 1e9 1e9 1e9\n"):
        run.write("a.obj", text)
        for arguments in ([], ["--margin", "0"], ["--shape", "cylinder"], ["--axes", "principal"]):
            new(run, *arguments)
            content = json.loads(run.read("n.json"))
            content["moves"] = [{"by": [0.5, 0, 0]}]
            run.write("m.json", content)
            # A point on a cylinder's axis is singular, with a warning, and moves all the same.
            run.ffd("deform", "a.obj", "b.obj", "-l", "m.json", "--outside", "error", "--force", "-q")
            near(obj_vertices(run.text("b.obj")), [[p[0] + 0.5, *p[1:]] for p in obj_vertices(text)], 1e-6)


@case
def combinations_that_make_no_sense(run):
    run.write("a.obj", CUBE)
    for arguments in (["--axis", "x"], ["--shape", "box", "--axis", "x"], ["--shape", "cylinder", "--axes", "principal"],
                      ["--size", "3,4,4", "--degree", "3,3,3"], ["--knots", "closed,clamped,clamped"],
                      ["--spacing", "uniform", "--knots", "open,open,open"], ["--shape", "cylinder", "--spacing", "uniform"]):
        run.ffd("lattice", "new", "a.obj", "-o", "n.json", *arguments, code=USAGE)
    check(not run.exists("n.json"), "a file was written")


@case
def too_many_points(run):
    run.write("a.obj", CUBE)
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--size", "1000000,1000000,1000000", code=LIMIT)
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--size", "200000000,4,4", code=LIMIT, err=re.compile("more than 67108864 control points"))
    # The Bezier pieces of degree 14 take 1,800 bytes a knot.
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--size", "50000,2,2", "--degree", "14,1,1", code=LIMIT, err=re.compile("needs .* MB of memory"))


@case
def meshes_without_points(run):
    for text, code in (("# nothing\n", INVALID), ("v nan 0 0\n", INVALID), ("v 0 0\n", INVALID)):
        run.write("a.obj", text)
        done = run.ffd("lattice", "new", "a.obj", "-o", "n.json", code=code)
        check(done.err[0].startswith("a.obj"), done.err[0])


@case
def outputs_of_lattice_new_are_not_replaced_without_force(run):
    run.write("a.obj", CUBE)
    run.ffd("lattice", "new", "a.obj", "-o", "n.json")
    first = run.text("n.json")
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", code=IO, err="n.json: exists already (--force overwrites it)")
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--force", "--margin", "1")
    check(run.text("n.json") != first, "--force")
    run.ffd("lattice", "new", "a.obj", "-o", "-", out=first)
    run.ffd("lattice", "new", "-", "-o", "-", "--input-format", "obj", stdin=CUBE.encode(), out=first)
    run.ffd("lattice", "new", "-", "-o", "-", stdin=CUBE.encode(), code=USAGE)
    run.ffd("lattice", "new", "a.obj", "-o", "none/n.json", code=IO)
    run.ffd("lattice", "new", "none.obj", "-o", "m.json", code=IO)
    check(not run.exists("m.json"), "a file was written")


main()
