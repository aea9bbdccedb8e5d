#!/usr/bin/env python3
"""ffd view: the page has the mesh before and after, the lattice, the figures of check and what went wrong; exit codes are
those of check, and a page is complete or absent."""
import base64
import json
import os
import re
import struct

from bspline import BoxVolume
from gltf_build import Scene
from harness import (CUBE, CUBE_CORNERS, EMBEDDING, INVALID, IO, NO, SANITIZED, UNSUPPORTED, USAGE, case, check, equal, glb,
                     glb_split, gltf_json, lattice, main, near)
from page import read_page
from png import read_png
from png_make import make_png
from messages import anything

SHIFT = [{"by": [1, 0, 0]}]
TWIST = [{"twist": {"axis": "z", "degrees": 50}}]


def start(run, moves=TWIST, mesh=CUBE, **members):
    run.write("a.obj", mesh)
    run.write("l.json", lattice(moves=moves, **members))
    return ["a.obj", "-l", "l.json"]


def view(run, *arguments, name="p.html", **options):
    """Views and returns the page, which replaces the last one."""
    run.ffd("view", *arguments, "-o", name, "--force", **options)
    return read_page(run, name)


def same_places(found, expected, what):
    """Pages have positions in 16 bits."""
    near(found, expected, 1e-4 * (1 + max(abs(x) for p in expected for x in p)), what)


def report(run, *arguments, code=0, **options):
    """What check reports."""
    run.ffd("check", *arguments, "--report", "r.json", "--report-stable", code=code, **options)
    return json.loads(run.text("r.json"))


@case
def a_deformation_is_shown_with_its_lattice_and_its_figures(run):
    work = start(run)
    page = view(run, *work)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json")
    deformed = [[float(x) for x in line.split()[1:4]] for line in run.text("b.obj").splitlines() if line.startswith("v ")]
    same_places(page.before, CUBE_CORNERS, "before")
    same_places(page.after, deformed, "after")
    equal(len(page.triangles), 12, "triangles of six squares")
    equal(page.report, report(run, *work), "the report")
    equal([page.scene["name"], page.scene.get("output")], ["a.obj", None], "names")
    equal(page.statuses, [0] * 8, "statuses")
    info = json.loads(run.ffd("info", "l.json", "--json").text)
    rest, moved = page.cage(0)
    equal([len(rest), page.scene["cages"][0]["size"], page.scene["cages"][0]["closed"]], [64, [4, 4, 4], [False] * 3], info)
    near([rest[0], rest[-1]], [[-2] * 3, [2] * 3], 1e-12, "the corners of the cage")
    near([moved[0]], [rest[0]], 1e-12, "the end of a twist stays")
    check(abs(moved[-1][0] - rest[-1][0]) > 0.5, "the other one turns")
    equal([page.scene["tears"], page.scene["witness"], page.flipped], [[], None, None], "nothing went wrong")


def copied_meshes(**members):
    """Two nodes with one mesh, of which one gets a copy behind the mesh of a third; animations with one of its weights."""
    made = Scene(scene=0, scenes=[{"nodes": [0, 1, 2]}], nodes=[
        {"mesh": 0}, {"mesh": 0, "translation": [0.5, 0, 0.75]}, {"mesh": 1, "translation": [-1, 0.5, 0]}], **members)
    triangles = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 0.5, 0], [0, 0, 1], [0.5, 0, 0]]]
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(rows, bounds=True)}, "indices": made.add(
        [[0], [1], [2]], 5121, "SCALAR"), "targets": [{"POSITION": made.add([[0, 0.25, 0.5]] * len(rows), bounds=True)}]}]}
                            for rows in triangles]
    keys = made.add([[0.0], [1.0]], shape="SCALAR", bounds=True)
    ways = made.add([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    made.asset["animations"] = [{"name": "go", "samplers": [{"input": keys, "output": keys}, {"input": keys, "output": ways}],
                                 "channels": [{"sampler": 0, "target": {"node": 1, "path": "weights"}},
                                              {"sampler": 1, "target": {"node": 2, "path": "translation"}}]}]
    return made.glb()


@case
def a_file_whose_meshes_were_copied_has_its_vertices_behind_others(run):
    """They go with the nodes that show them, at rest and in every pose."""
    run.write("a.glb", copied_meshes())
    run.write("l.json", lattice(moves=TWIST))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", err=anything)
    equal([node["mesh"] for node in glb_split(run.read("b.glb"))[0]["nodes"]], [0, 2, 1], "the copy")
    pages = [view(run, "a.glb", *other, err=anything) for other in (["b.glb"], ["-l", "l.json"])]
    same_places(pages[0].after, pages[1].after, "files and the deformation in memory")
    size = ["--size", "80x80", "--frames", "3", "--color", "plain", "--camera", "iso", "--animation", "go"]
    drawn = []
    for other in (["b.glb"], ["-l", "l.json"]):
        run.ffd("view", "a.glb", *other, *size, "-o", "p.png", "--force", err=anything)
        drawn.append(read_png(run.read("p.png")))
    check(drawn[0] == drawn[1], "the poses of files and of the deformation in memory")


@case
def the_same_job_makes_the_same_page(run):
    work = start(run)
    view(run, *work)
    first = run.read("p.html")
    view(run, *work, "--threads", "3", "--isa", "scalar")
    check(run.read("p.html") == first, "the bytes of the page")


@case
def det_f_is_that_of_the_volume(run):
    """A stretch by 1.5 along x: det F is 1.5 everywhere, and 1 outside."""
    start(run, [{"scale": {"factor": [1.5, 1, 1], "about": [0, 0, 0]}}])
    near(view(run, "a.obj", "-l", "l.json").dets, [1.5] * 8, 1e-6, "det F")
    run.write("far.obj", CUBE.replace("v 1 1 1\n", "v 1 1 9\n"))
    page = view(run, "far.obj", "-l", "l.json", lines=1)
    equal(page.statuses, [0] * 7 + [1], "one is outside")
    near(page.dets, [1.5] * 7 + [1], 1e-6, "det F")
    equal(view(run, "far.obj", "-l", "l.json", "--outside", "extend", lines=1).statuses, [0] * 7 + [1], "extended")


@case
def a_mesh_and_its_deformation_as_files(run):
    """The lattice is drawn, and deforms nothing."""
    work = start(run, SHIFT)
    run.write("b.obj", CUBE.replace("v 1 1 1\n", "v 1 1 3\n"))
    page = view(run, "a.obj", "b.obj", "-l", "l.json")
    expected = CUBE_CORNERS[:7] + [[1, 1, 3]]
    same_places(page.after, expected, "after")
    near([page.scene["displacementMax"]], [2], 1e-12, "the largest displacement")
    equal([page.scene["name"], page.scene["output"], page.report], ["a.obj", "b.obj", None], "names and report")
    equal([page.statuses, page.dets], [None, None], "there is no deformation to speak of")
    rest, moved = page.cage(0)
    near([moved[5][0] - rest[5][0]], [1], 1e-12, "the cage")
    equal(view(run, "a.obj", "b.obj").scene["cages"], [], "without a lattice")
    equal(work[0], "a.obj")


@case
def files_have_no_status_and_no_det_f(run):
    """Their colours are then by displacement, which is said."""
    start(run)
    run.write("b.obj", CUBE.replace("v 1 1 1\n", "v 1 1 3\n"))
    for color, what in (("det", "det F"), ("status", "status")):
        said = f"a.obj: coloured by displacement: without a deformation there is no {what}"
        view(run, "a.obj", "b.obj", "--color", color, err=said)
        same = picture(run, "a.obj", "b.obj", "--color", color, "--size", "100x60", err=said)
        check(same == picture(run, "a.obj", "b.obj", "--size", "100x60"), "the picture by displacement")
    view(run, "a.obj", "-l", "l.json", "--color", "det", lines=0)


@case
def files_say_which_settings_of_a_deformation_do_nothing(run):
    work = start(run)
    page = view(run, "a.obj", *work)
    said = "a.obj: not used, since files are shown as they are: {} (a deformation needs -l, and no OUT-MESH)"
    for settings, names in ((["--rig", "follow"], "--rig"), (["--normals", "keep", "--outside", "extend"], "--outside, --normals"),
                            (["--blocks", "--snap", "1", "--as-morph", "m"],
                             "--snap, --blocks, --as-morph")):
        equal(view(run, "a.obj", *work, *settings, err=said.format(names)).scene, page.scene, "the page")
    view(run, "a.obj", "--set", "a=1", err=said.format("--set"))


@case
def a_lattice_round_the_mesh_is_drawn_round_the_mesh_at_rest(run):
    start(run, SHIFT, rest={"box": "mesh", "margin": 0})
    run.write("b.obj", re.sub(r"v 1 ", "v 7 ", CUBE))
    rest, _ = view(run, "a.obj", "b.obj", "-l", "l.json").cage(0)
    near([rest[0], rest[-1]], [[-1] * 3, [1] * 3], 1e-12, "corners of the cage")


@case
def a_mesh_alone(run):
    start(run)
    page = view(run, "a.obj")
    same_places(page.before, CUBE_CORNERS, "before")
    same_places(page.after, CUBE_CORNERS, "after")
    equal([page.report, page.scene["cages"], page.scene["displacementMax"]], [None, [], 0], "nothing else")


@case
def meshes_of_other_sizes_are_not_one_mesh(run):
    start(run)
    run.write("b.obj", CUBE + "v 0 0 0\n")
    run.ffd("view", "a.obj", "b.obj", "-o", "p.html", code=INVALID,
            err="b.obj: has 9 vertices, and a.obj has 8: they are not one mesh before and after")
    check(not run.exists("p.html"), "a page")


@case
def a_violated_gate_still_has_its_page(run):
    """That is when one needs it. The page's report says what was violated."""
    work = start(run, [{"at": [1, 1, 1], "by": [30, 30, 30]}])
    for gate, says in (("folds", "folds"), ("edges=1e-9", "edge"), ("folds,tear", "folds")):
        run.remove("p.html")
        run.ffd("check", *work, "--fail-on", gate, code=NO, lines=1)
        run.ffd("view", *work, "--fail-on", gate, "-o", "p.html", "--report", "r.json", "--report-stable", code=NO,
                err=re.compile(says))
        page = read_page(run, "p.html")
        equal([page.report["jobs"][0]["status"], page.report["jobs"][0]["exit"]], ["failed", 1], gate)
        told = json.loads(run.text("r.json"))
        equal([told["jobs"][0].pop("picture"), told["jobs"][0]["outputs"].pop()], ["p.html"] * 2, "what was written")
        equal(page.report, told, "the report on its own")
    equal(len(page.before), 8, "the mesh is there")


@case
def what_cannot_be_deformed_has_no_page(run):
    work = start(run)
    run.write("bad.obj", "v 1 2 x\n")
    run.write("bad.json", "{")
    run.write("half.json", lattice(high=(2, 2, 0), moves=SHIFT))
    for arguments, code in ((["none.obj", "-l", "l.json"], IO), (["bad.obj", "-l", "l.json"], INVALID),
                            (["bad.obj"], INVALID), (["a.obj", "bad.obj"], INVALID), (["a.obj", "none.obj"], IO),
                            (["a.obj", "-l", "bad.json"], INVALID), (["a.obj", "a.obj", "-l", "bad.json"], INVALID),
                            ([*work, "--outside", "error"], None),
                            (["a.obj", "-l", "half.json", "--outside", "error"], EMBEDDING)):
        if code is not None:
            run.ffd("view", *arguments, "-o", "p.html", code=code)
            check(not run.exists("p.html"), f"{arguments}: a page")
    run.ffd("view", *work, "-o", "none/p.html", code=IO)


@case
def an_existing_page_needs_force(run):
    work = start(run)
    run.write("p.html", "old")
    run.ffd("view", *work, "-o", "p.html", code=IO, err=re.compile("p.html.*--force"))
    equal(run.text("p.html"), "old")
    view(run, *work)
    # Nothing that is read is written, under whatever name.
    run.write("m.html", CUBE)
    run.write("l.html", lattice(moves=SHIFT))
    for arguments in (["m.html", "--input-format", "obj", "-l", "l.json"], ["a.obj", "-l", "l.html"],
                      ["a.obj", "m.html", "--input-format", "obj"], ["a.obj", "a.obj", "-l", "l.html"]):
        output = "m.html" if "m.html" in arguments else "l.html"
        run.ffd("view", *arguments, "-o", "./" + output, "--force", code=IO, err=f"./{output}: is an input of this command")


@case
def mistakes_are_refused_before_any_work(run):
    work = start(run)
    run.write("b.obj", CUBE)
    for arguments, says in (
            (["-o", "p.html"], "needs IN"), (work, "no output is given"),
            (["a.obj", "b.obj", "a.obj", "-o", "p.html"], "one OUT-MESH"),
            ([*work, "-o", "p.pdf"], "is not that of a page"), ([*work, "-o", "-"], "is not that of a page"),
            ([*work, "-o", "p.html", "--camera", "behind"], "--camera"), ([*work, "-o", "p.html", "--camera", "0,0,0"], "--camera"),
            ([*work, "-o", "p.html", "--camera", "1,2"], "--camera"), ([*work, "-o", "p.html", "--camera", "1,2,3,4"], "--camera"),
            ([*work, "-o", "p.html", "--color", "heat"], "--color"),
            ([*work, "-o", "p.html", "--size", "100x100"], "--size is for pictures"),
            (["a.obj", "b.obj", "-o", "p.html", "--frames", "5"], "--frames is for pictures"),
            ([*work, "-o", "p.png", "--full"], "--full is for pages"),
            (["a.obj", "-o", "p.html", "--fail-on", "folds"], "--fail-on"),
            (["a.obj", "b.obj", "-l", "l.json", "-o", "p.html", "--fail-on", "folds"], "--fail-on"),
            (["a.obj", "-o", "p.html", "--report", "r.json"], "--report"),
            (["a.obj", "b.obj", "-l", "l.json", "-o", "p.html", "--embedding", "e.npy"], "--embedding"),
            (["-", "-", "--input-format", "obj", "-o", "p.html"], "only once"),
            ([*work, "-o", "p.png", "--report", "p.png", "--force"], "the report would replace the picture"),
            ([*work, "-o", "./p.html", "--report", "p.html"], "the report would replace the picture or page"),
            ([*work, "-o", "p.png", "--report", "./a.obj"], "the report would replace a mesh"),
            ([*work, "-o", "p.html", "--falloff", "1"], "--falloff"), (["a.xyz", "-o", "p.html"], "a.xyz")):
        run.ffd("view", *arguments, code=USAGE, err=re.compile(re.escape(says)))
    equal(run.names(), ["a.obj", "b.obj", "l.json"], "the folder")


@case
def whatever_points_upwards_stands_upright(run):
    """The same body with y, z and x upwards gives the same picture, from every side."""
    body = [(x * 0.5, y + 0.25 * x, z * (1 + y / 4)) for x in (0, 1) for y in (0, 3) for z in (0, 2)]
    faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
    for name, turn in (("y", lambda x, y, z: (x, y, z)), ("z", lambda x, y, z: (x, -z, y)), ("x", lambda x, y, z: (y, -x, z))):
        run.write(name + ".obj", "".join("v {} {} {}\n".format(*turn(*point)) for point in body) + faces)
    for side in ("front", "back", "left", "right", "top", "bottom", "iso"):
        look = ["--camera", side, "--size", "120x100"]
        upright = picture(run, "y.obj", *look)
        for up in ("z", "x"):
            check(picture(run, up + ".obj", *look, "--up", up) == upright, side, up)
    # Numbers are in the axes of the mesh.
    check(picture(run, "y.obj", "--camera", "1,2,3", "--size", "120x100") ==
          picture(run, "z.obj", "--camera", "1,-3,2", "--up", "z", "--size", "120x100"), "a direction")
    run.ffd("view", "y.obj", "-o", "q.png", "--up", "w", code=USAGE, err=re.compile("--up"))


@case
def the_cage_can_be_left_out(run):
    work = start(run)
    for more in ([], ["--frames", "3"]):
        check(count(picture(run, *work, *more, "--size", "300x200"), is_blue) > 100, "with its cage")
        equal(count(picture(run, *work, *more, "--size", "300x200", "--no-cage", "--color", "plain"), is_blue), 0, "without")
    equal([len(view(run, *work, *more).scene["cages"]) for more in ([], ["--no-cage"])], [1, 0], "of a page")


@case
def how_a_page_opens(run):
    work = start(run)
    equal(view(run, *work).scene["view"], {"color": "auto", "camera": [0, 0, 0], "up": "y"}, "by default")
    for name, camera in (("front", [0, 0, 1]), ("back", [0, 0, -1]), ("left", [-1, 0, 0]), ("right", [1, 0, 0]),
                         ("top", [0, 1, 0]), ("bottom", [0, -1, 0]), ("iso", [0, 0, 0]), ("-1,0.5,2", [-1, 0.5, 2])):
        equal(view(run, *work, f"--camera={name}").scene["view"]["camera"], camera, name)
    for up, front in (("z", [0, -1, 0]), ("x", [0, 0, 1])):
        shown = view(run, *work, "--camera", "front", "--up", up).scene["view"]
        equal([shown["camera"], shown["up"]], [front, up], up)
    for color in ("displacement", "status", "det", "plain"):
        equal(view(run, *work, "--color", color).scene["view"]["color"], color)
    view(run, *work, "--in-place", "--if-changed", "--depfile", "d", "--resources", "copy", name="p.HTM")
    check(not run.exists("d"), "a depfile")


@case
def every_format_is_shown_alike(run):
    """Corners that a file repeats are vertices of their own, but for STL, which has no others."""
    start(run)
    expected = sorted(view(run, "a.obj", "-l", "l.json").after)
    run.write("still.json", lattice())
    for ending in ("ply", "off", "stl", "glb", "gltf"):
        name = "b." + ending
        run.ffd("deform", "a.obj", name, "-l", "still.json", err=lambda said: None)
        page = view(run, name, "-l", "l.json")
        equal([len(page.triangles), len(page.before)], [12, 8], ending)
        same_places(sorted([round(x, 3) for x in p] for p in page.after), [[round(x, 3) for x in p] for p in expected], ending)
    run.write("c.vrm", run.read("b.glb"))
    equal(len(view(run, "c.vrm", "-l", "l.json").before), 8, "vrm")
    page = view(run, "b.stl", "-l", "l.json")
    corners = [struct.unpack_from("<3f", run.read("b.stl"), 84 + 50 * (n // 3) + 12 + 12 * (n % 3)) for n in page.numbers]
    same_places(page.before, [list(p) for p in corners], "each vertex has the number of its first corner")


@case
def standard_input_is_shown(run):
    start(run)
    page = view(run, "-", "--input-format", "obj", "-l", "l.json", stdin=CUBE.encode())
    equal([page.scene["name"], len(page.before)], ["standard input", 8])
    equal(len(view(run, "a.obj", "-", "--input-format", "obj", stdin=CUBE.encode()).after), 8, "the second mesh")


def strip(columns):
    """Squares of side 1 along x, as OBJ."""
    wide = columns + 1
    return ("".join(f"v {x} {y} 0\n" for y in range(2) for x in range(wide))
            + "".join(f"f {k} {k + 1} {k + 1 + wide} {k + wide}\n" for k in range(1, wide)))


@case
def torn_edges_are_listed(run):
    """The lattice ends at x = 1.5: of the vertices 0 1 2 3 and 4 5 6 7 two of each row move by a quarter, so that the two
    edges along x tear, with the end that stays first."""
    start(run, [{"by": [0, 0, 0.25]}], strip(3), rest={"box": {"min": [-10, -10, -10], "max": [1.5, 10, 10]}})
    page = view(run, "a.obj", "-l", "l.json", lines=1)
    equal(sorted(ends for ends, _ in page.tears()), [(2, 1), (6, 5)], "torn edges")
    near([step for _, step in page.tears()], [0.25] * 2, 1e-12, "their steps")
    equal([page.scene["tearEdges"], page.report["jobs"][0]["tear"]["edges"]], [2, 2], "how many")
    equal(page.statuses, [0, 0, 1, 1] * 2, "statuses")
    for ending in ("stl", "glb"):
        run.write("still.json", lattice(low=(-9, -9, -9), high=(9, 9, 9)))
        run.ffd("deform", "a.obj", "b." + ending, "-l", "still.json", "--force", err=lambda said: None)
        page = view(run, "b." + ending, "-l", "l.json", lines=1)
        at = {number: place for number, place in zip(page.numbers, page.before)}
        same_places([[at[a][0], at[b][0]] for (a, b), _ in page.tears()], [[2, 1]] * 3, ending + ", with the diagonal")


@case
def flipped_faces_and_a_fold_are_marked(run):
    """A mirror image in x: det F is -1, so that every face shows its other side, and the volume folds everywhere."""
    start(run, [{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}])
    page = view(run, "a.obj", "-l", "l.json")
    equal([page.flipped, page.scene["flippedFaces"]], [[1] * 12, 6], "six squares of two triangles")
    near(page.dets, [-1] * 8, 1e-6, "det F")
    witness = page.scene["witness"]
    check(witness["det"] < 0, witness)
    near(witness["after"], [-witness["before"][0], *witness["before"][1:]], 1e-9, "where the witness goes")
    equal([witness["cage"], witness["before"]], [0, page.report["jobs"][0]["folds"]["witness"]["rest"]])


@case
def one_square_of_a_row_is_flipped(run):
    """Its plane's vertices at x = 2 go to where x is 0.5, behind those at x = 1: the middle square turns over in u."""
    def moved(p):
        return [0, 0, 0]
    check(BoxVolume((0, 0, 0), (1, 1, 1), moved), "the evaluator is there")
    points = [[x, y, z] for z in (-1, 1) for y in (-1, 2) for x in (0, 1, 0.5, 3)]
    start(run, [], strip(3), size=[4, 2, 2], degree=[1, 1, 1],
          rest={"box": {"min": [0, -1, -1], "max": [3, 2, 1]}}, deformed={"points": points})
    page = view(run, "a.obj", "-l", "l.json")
    equal(page.scene["flippedFaces"], page.report["jobs"][0]["flipped_faces"], "as check counts them")
    flipped = {tuple(sorted(t)) for t, is_flipped in zip(page.triangles, page.flipped or [0] * 99) if is_flipped}
    check(all(set(t) <= {1, 2, 5, 6} for t in flipped), flipped)


HOSTILE = "</script><img src=x onerror=alert(1)>"


@case
def names_are_text(run):
    run.write("l.json", lattice(moves=SHIFT))
    name = "<b>& \" ' </script>.obj".replace("/", "%")
    run.write(name, CUBE.replace("f 1", f"g {HOSTILE.replace(' ', '_')}\nf 1", 1).replace("f 5", "g \u202eabc\x01" + "x" * 100000 + "\nf 5", 1))
    page = view(run, name, "-l", "l.json")
    content = run.read("p.html")
    check(b"<img" not in content and "\u202e".encode() not in content and len(content) < 200000, "the page has it as text")
    equal(page.names()[0], HOSTILE.replace(" ", "_"))
    equal(page.scene["name"], name)
    equal(page.report["jobs"][0]["input"], name)


def asset_with(nodes, **members):
    """A glTF of a square of two triangles and of two points, meshes 0 and 1."""
    square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    asset, data = gltf_json(square, nodes=nodes, normals=[[0.0, 0.0, 1.0]] * 6)
    asset["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]})
    asset.update(members)
    return asset, data


@case
def materials_divide_a_mesh_and_hidden_nodes_are_not_shown(run):
    nodes = [{"mesh": 0, "name": "hidden", "extensions": {"KHR_node_visibility": {"visible": False}}},
             {"mesh": 0, "name": "seen", "translation": [3, 0, 0]}]
    run.write("a.glb", glb(*asset_with(nodes, extensionsUsed=["KHR_node_visibility"])))
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=SHIFT))
    page = view(run, "a.glb", "-l", "l.json", err=lambda said: None)
    equal([page.names(), page.numbers, page.statuses], [["seen"], list(range(6, 12)), [0] * 6], "what is seen")
    near([min(p[0] for p in page.before), min(p[0] for p in page.after)], [3, 4], 1e-3, "where it stands")


@case
def what_cannot_be_shown_is_said(run):
    """Instances beyond the lattice's reach, and primitives that draw nothing known: the rest is shown."""
    asset, data = asset_with([{"mesh": 0}, {"mesh": 1, "translation": [500, 0, 0], "extensions":
                                            {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}],
                             extensionsUsed=["EXT_mesh_gpu_instancing"])
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=SHIFT))
    left = "a.glb: not shown: the GPU instances of 1 node"
    page = view(run, "a.glb", "-l", "l.json", err=left)
    equal([len(page.triangles), page.numbers], [2, list(range(6))], "the square")
    view(run, "a.glb", err=left)
    del asset["nodes"][1]["translation"]
    run.write("b.glb", glb(asset, data))
    run.ffd("view", "b.glb", "-l", "l.json", "-o", "q.html", code=UNSUPPORTED)
    asset, data = asset_with([{"mesh": 0}, {"mesh": 1}])
    asset["meshes"][1]["primitives"][0]["mode"] = 77
    run.write("a.glb", glb(asset, data))
    for arguments in (["a.glb", "-l", "l.json"], ["a.glb"]):
        equal(len(view(run, *arguments, lines=1).triangles), 2, "the square")
    run.remove("p.html")
    run.ffd("view", "a.glb", "-l", "l.json", "--fail-on", "tear", "-o", "p.html", code=NO, lines=1)
    equal(len(read_page(run, "p.html").triangles), 2, "a gate that cannot be judged has its page")


@case
def default_weights_of_morph_targets_are_shown(run):
    """The target lifts the square by 2, of which half is shown: before and after are of that shape."""
    asset, data = asset_with([{"mesh": 0}])
    lift = len(data)
    data += struct.pack("<18f", *[0, 0, 2.0] * 6)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": lift, "byteLength": 72})
    asset["accessors"].append({"bufferView": len(asset["bufferViews"]) - 1, "componentType": 5126, "count": 6, "type": "VEC3",
                               "min": [0, 0, 2], "max": [0, 0, 2]})
    asset["buffers"][0]["byteLength"] = len(data)
    asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": len(asset["accessors"]) - 1}]
    asset["meshes"][0]["weights"] = [0.5]
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=SHIFT))
    page = view(run, "a.glb", "-l", "l.json")
    same_places(page.before, [[*p[:2], 1] for p in page.before], "lifted by 1")
    same_places(page.after, [[p[0] + 1, p[1], 1] for p in page.before], "and moved by 1 along x")
    page = view(run, "a.glb", "a.glb")
    same_places(page.after, page.before, "two files")
    run.ffd("check", "a.glb", "-l", "l.json", "--picture", "q.html")
    page = read_page(run, "q.html")
    equal(page.report, report(run, "a.glb", "-l", "l.json"), "a check looks at what is shown")
    same_places(page.before, [[*p[:2], 1] for p in page.before], "and so does its picture")


@case
def several_lattices_are_all_drawn(run):
    start(run, SHIFT)
    run.write("ring.json", {"format": "ffd-lattice", "version": 1, "size": [3, 6, 3], "degree": [2, 2, 2],
                            "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 5], "height": 9,
                                                  "angle": [0, 360]}}, "moves": []})
    page = view(run, "a.obj", "-l", "l.json", "-l", "ring.json")
    equal([(cage["name"], cage["size"], cage["closed"]) for cage in page.scene["cages"]],
          [("l.json", [4, 4, 4], [False] * 3), ("ring.json", [3, 6, 3], [False, True, False])])
    equal(len(page.cage(1)[0]), 54, "control points")
    view(run, "a.obj", "-l", "l.json", "-l", "ring.json", "--blocks", err=lambda said: None)


@case
def only_a_part_is_deformed_and_all_is_shown(run):
    two = CUBE.replace("f 1", "g one\nf 1", 1) + "".join("v %g %g %g\n" % (x + 3, y, z) for x, y, z in CUBE_CORNERS) + "g two\nf 9 11 12 10\n"
    start(run, SHIFT, two, rest={"box": "mesh"})
    page = view(run, "a.obj", "-l", "l.json", "--only", "group:two", lines=None, err=lambda said: None)
    equal([page.names(), len(page.before)], [["one", "two"], 12])
    moved = [a != b for a, b in zip(page.before, page.after)]
    equal(moved, [False] * 8 + [True] * 4, "what moves")


@case
def large_meshes_are_simplified_unless_all_is_wanted(run):
    side = 450
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {side * side}\nproperty float x\nproperty float y\nproperty float z\nelement face {(side - 1) ** 2}\nproperty list uchar int vertex_indices\nend_header\n"
    points = b"".join(struct.pack("<3f", x / side, y / side, 0) for y in range(side) for x in range(side))
    faces = b"".join(struct.pack("<B4i", 4, n, n + 1, n + side + 1, n + side)
                     for y in range(side - 1) for n in range(y * side, y * side + side - 1))
    run.write("a.ply", head.encode() + points + faces)
    run.write("l.json", lattice(moves=SHIFT))
    page = view(run, "a.ply", "-l", "l.json", err=re.compile("vertices are drawn: the mesh is simplified"))
    check(len(page.before) <= 200000 and page.scene["verticesAll"] == side * side, page.scene["vertices"])
    near([page.report["jobs"][0]["vertices"]], [side * side], 0, "the figures are of all")
    if not SANITIZED:  # what smaller meshes take
        equal(len(view(run, "a.ply", "-l", "l.json", "--full").before), side * side, "all")


def picture(run, *arguments, name="p.png", **options):
    """Views and returns the rows of pixels."""
    run.ffd("view", *arguments, "-o", name, "--force", **options)
    return read_png(run.read(name))


def halves(rows):
    middle = len(rows[0]) // 2
    return [row[:middle] for row in rows], [row[middle + 2:] for row in rows]


def count(rows, is_wanted):
    return sum(is_wanted(*pixel) for row in rows for pixel in row)


def is_red(r, g, b):
    return r > 1.6 * max(g, b)


def is_blue(r, g, b):
    return b > 1.4 * max(r, g)


def is_magenta(r, g, b):
    return r > 1.6 * g and b > 1.6 * g


def is_green(r, g, b):
    return g > 1.6 * max(r, b)


def is_grey(r, g, b):
    """As a mesh without colours is. The background is lighter, and the line of the ground is bluer."""
    return max(r, g, b) - min(r, g, b) < 12 and r < 185


def is_striped(r, g, b):
    """The orange of flipped faces; between its stripes they are nearly black."""
    return r > 3 * b and 1.3 * g < r < 3.2 * g and r > 120


def content_of(run, work):
    run.ffd("view", *work, "-o", "whole.png")
    return run.read("whole.png")


@case
def pictures_have_the_size_that_is_asked_for(run):
    work = start(run)
    equal(struct.unpack_from(">II", content_of(run, work), 16), (1600, 900), "by default")
    for options, width, height in ((["--size", "300x200"], 300, 200), (["--size", "16x16"], 16, 16),
                                   (["--size", "100x80", "--frames", "3"], 300, 80)):
        rows = picture(run, *work, *options)
        equal([len(rows[0]), len(rows)], [width, height], str(options))
    for option, values in (("--size", ("300", "300x", "15x900", "900x32768", "x", "300x200x3", "-3x4", "1e3x100")),
                           ("--frames", ("0", "1", "65", "x", "2.5"))):
        for value in values:
            run.ffd("view", *work, "-o", "q.png", f"{option}={value}", code=USAGE, err=re.compile(option))
    run.ffd("view", *work, "-o", "q.png", "--frames", "64", code=USAGE, err=re.compile("102400 x 900 pixels"))
    run.ffd("view", *work, "-o", "q.png", "--size", "30000x30000", code=USAGE, err=re.compile("is not possible"))
    check(not run.exists("q.png"), "a picture")


@case
def pictures_are_the_same_for_any_threads(run):
    work = start(run)
    view_all = [*work, "--size", "320x200", "-o", "p.png", "--force"]
    run.ffd("view", *view_all, "--threads", "1")
    first = run.read("p.png")
    for options in (["--threads", "2"], ["--threads", "7"], ["--isa", "scalar"]):
        run.ffd("view", *view_all, *options)
        check(run.read("p.png") == first, str(options))


@case
def before_is_left_of_after_with_the_cage(run):
    start(run, [{"by": [0, 0, 2]}])
    before, after = halves(picture(run, "a.obj", "-l", "l.json", "--camera", "top", "--size", "400x200"))
    for rows in (before, after):
        check(count(rows, is_blue) > 100, "the lattice's lines")
    # All moves by the largest displacement, whose colour is yellow; before is as the mesh is.
    is_yellow = lambda r, g, b: r > 1.6 * b and g > 1.6 * b
    check(count(before[:150], is_yellow) == 0, "nothing has moved before")
    check(count(after[:150], is_yellow) > 1000, "what moved is coloured")
    check(count([row[60:340] for row in picture(run, "a.obj", "-l", "l.json", "--size", "400x200")][160:], is_yellow) > 10, "the scale")
    # Seen from the top it goes down in the picture, towards +z.
    mean = [sum(y for y, row in enumerate(rows[20:150]) for p in row if found(*p)) / count(rows[20:150], found)
            for rows, found in ((before, lambda r, g, b: is_grey(r, g, b)), (after, is_yellow))]
    check(mean[1] > mean[0] + 10, mean)


@case
def lattices_of_too_many_points_are_left_out_of_pictures_and_said(run):
    """60 x 60 x 60 points took the picture's memory: exit 7 of what check and a page can do. The limit is 50 x 50 x 50."""
    work = start(run, SHIFT, size=[51, 50, 50])
    for more in ([],) if SANITIZED else ([], ["--frames", "4"]):
        rows = picture(run, *work, *more, "--size", "200x120",
                       err="a.obj: the picture: 1 of 1 lattice is not drawn: more than 125000 control points")
        equal(count(halves(rows[:80])[0], is_blue) if not more else 0, 0, "nothing of the cage")
    start(run, SHIFT, size=[20, 20, 20])
    check(count(halves(picture(run, *work, "--size", "200x120", lines=0)[:80])[0], is_blue) > 50, "a smaller one is drawn")


@case
def far_control_points_leave_the_mesh_its_size(run):
    """One of them 1000 away, which moves nothing, made a speck of the cube. The picture is three times as high as the cube at
    rest, since the lattice reaches that far below it, and its sides are two of the cube's largest extent away at most."""
    degree_1 = {"size": [5, 2, 2], "degree": [1, 1, 1]}
    work = start(run, [{"at": [4, 1, 1], "by": [0, 1000, 0]}], **degree_1)
    rows = picture(run, *work, "--camera", "front", "--color", "plain", "--size", "400x300",
                   err=["a.obj: no vertex moves, though l.json moves 1 control point (the mesh lies from -1 -1 -1 to 1 1 1)",
                        "a.obj: the picture: 1 of 20 control points is beyond its sides, so that the mesh is not too small"])
    before, after = halves(rows[30:])
    high = sum(is_grey(*row[90]) for row in before)
    check(60 < high < 90, f"the cube is {high} pixels high")
    check(count(after[:20], lambda r, g, b: b > 1.2 * r) > 10, "the cage leaves the picture at its top")
    picture(run, *start(run, [{"at": [4, 1, 1], "by": [0, 3, 0]}], **degree_1), lines=1)


@case
def a_row_takes_the_memory_of_one_picture(run):
    """Each of 64 pictures had its own places of all vertices at a time: exit 7 of what one picture can do."""
    run.write("grid.obj", "".join(f"v {x} {y} 0\n" for y in range(120) for x in range(120)) +
              "".join(f"f {i} {i + 1} {i + 121} {i + 120}\n" for i in range(1, 119 * 120) if i % 120))
    start(run)
    rows = picture(run, "grid.obj", "-l", "l.json", "--size", "32x32", "--frames", "64", lines=1)
    equal([len(rows), len(rows[0])], [32, 2048], "a row")


@case
def a_mesh_alone_is_one_picture(run):
    start(run)
    rows = picture(run, "a.obj", "--camera", "front", "--size", "300x200")
    check(is_grey(*rows[100][150]), f"the cube is in the middle: {rows[100][150]}")


@case
def what_went_wrong_is_marked_in_pictures(run):
    start(run, [{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}])
    before, after = halves(picture(run, "a.obj", "-l", "l.json", "--size", "400x200"))
    check(count(before[:150], is_striped) == 0 and count(after[:150], is_striped) > 1000, "flipped faces")
    start(run, [{"by": [0, 0, 0.25]}], strip(3), rest={"box": {"min": [-2, -2, -2], "max": [1.5, 3, 3]}})
    before, after = halves(picture(run, "a.obj", "a.obj", "--size", "400x200"))
    equal(count(after, is_red), 0, "nothing is torn")
    before, after = halves(picture(run, "a.obj", "-l", "l.json", "--size", "400x300", "--camera", "front", lines=1))
    check(count(before[:250], is_red) == 0 and count(after[:250], is_red) > 5, "torn edges")


@case
def torn_edges_that_are_not_marked_are_counted(run):
    """Those with the largest steps are kept: 5,000 of the 2,602 and 2,601 between two rows of vertices, one of which moves."""
    start(run, [{"by": [0, 0, 0.25]}], "".join(f"v {x} {y} 0\n" for x in range(2602) for y in (0, 1)) +
          "".join(f"f {i} {i + 2} {i + 3}\nf {i} {i + 3} {i + 1}\n" for i in range(1, 5202, 2)),
          rest={"box": {"min": [-1, 0.5, -1], "max": [2602, 2, 1]}})
    for name, what in (("p.png", "picture"), ("p.html", "page")):
        said = []
        run.ffd("view", "a.obj", "-l", "l.json", "-o", name, err=said.extend)
        equal(said[1:], [f"a.obj: the {what}: 5000 of 5203 torn edges are marked, those with the largest steps"])
    check("5000 of 5203 torn edges" in read_page(run, "p.html").scene["notices"][0], "the page's notice")


@case
def only_what_is_flipped_is_marked(run):
    """The half of the volume beyond x = 1 is laid back over the other one; a square in each, the flipped one above."""
    points = [[x, y, z] for z in (-1, 1) for y in (0, 1) for x in (0, 1, 0)]
    corners = [(0.2, 0), (0.8, 0), (0.8, 0.4), (0.2, 0.4), (1.2, 0.6), (1.8, 0.6), (1.8, 1), (1.2, 1)]
    start(run, [], "".join(f"v {x} {y} 0\n" for x, y in corners) + "f 5 6 7 8\nf 1 2 3 4\n", size=[3, 2, 2],
          degree=[1, 1, 1], rest={"box": {"min": [0, 0, -1], "max": [2, 1, 1]}}, deformed={"points": points})
    equal(view(run, "a.obj", "-l", "l.json").flipped, [1, 1, 0, 0])
    _, after = halves(picture(run, "a.obj", "-l", "l.json", "--size", "400x200", "--camera", "front"))
    # Left of the fold's witness. What has not moved is dark violet.
    marked, still = ([y for y, row in enumerate(after[:150]) for p in row[:90] if found(*p)]
                     for found in (is_striped, lambda r, g, b: is_magenta(r, g, b) and r < 90))
    check(len(marked) > 500 and len(still) > 1000 and max(marked) < min(still), "the upper square alone")


@case
def statuses_and_det_f_colour_pictures(run):
    start(run, [{"scale": {"factor": [2, 1, 1], "about": [0, 0, 0]}}])
    run.write("far.obj", CUBE.replace("v 1 1 1\n", "v 1 1 9\n"))
    for color, found in (("status", lambda r, g, b: b > 1.3 * g > 1.3 * r), ("det", is_red)):
        rows = halves(picture(run, "a.obj", "-l", "l.json", "--color", color, "--size", "400x200", "--camera", "front"))
        check(count([row[90:110] for row in rows[1][85:100]], found) > 100, color)
    picture(run, "far.obj", "-l", "l.json", "--color", "status", lines=1)


@case
def a_violated_gate_still_has_its_picture(run):
    work = start(run, [{"at": [1, 1, 1], "by": [30, 30, 30]}])
    run.ffd("view", *work, "--fail-on", "folds", "-o", "p.png", "--size", "64x64", code=NO, lines=1)
    equal(len(read_png(run.read("p.png"))), 64)
    run.ffd("view", *work, "-o", "p.png", code=IO, err=re.compile("--force"))


@case
def a_check_draws_from_where_it_is_told(run):
    work = start(run)
    look = ["--camera", "bottom", "--up", "z", "--no-cage"]
    run.ffd("check", *work, "--picture", "c.png", *look, err=lambda said: None)
    run.ffd("view", *work, "-o", "v.png", *look)
    check(run.read("c.png") == run.read("v.png"), "the picture of view")
    for option in (["--camera", "front"], ["--up", "y"], ["--no-cage"]):
        run.ffd("check", *work, *option, code=USAGE, err=re.compile(f"{option[0]} needs --picture"))


@case
def a_check_has_its_picture(run):
    """Its figures and what it prints are those of a check without one, and the report names it."""
    work = start(run)
    plain, told = run.ffd("check", *work).text, report(run, *work)
    run.ffd("check", *work, "--picture", "p.png", "--report", "p.json", "--report-stable", out=plain)
    equal(struct.unpack_from(">II", run.read("p.png"), 16), (1600, 900), "the picture")
    found = json.loads(run.text("p.json"))
    equal([found["jobs"][0].pop("picture"), found["jobs"][0]["outputs"].pop()], ["p.png"] * 2, "the report's picture")
    equal(found, told, "the figures")
    run.ffd("check", *work, "--picture", "p.png", code=IO, err=re.compile("p.png.*--force"))
    run.ffd("check", *work, "--picture", "p.png", "--force", "-q", out="")
    run.ffd("check", *work, "--picture", "p.html", out=plain)
    equal(read_page(run, "p.html").report, told, "the page's report")
    run.write("b.obj", CUBE)
    run.ffd("check", "a.obj", "b.obj", "-l", "l.json", "--picture", "q.png", code=USAGE, err=re.compile("--picture is of one mesh"))
    for name in ("q.png", "./q.png"):
        run.ffd("check", *work, "--picture", "q.png", "--report", name, code=USAGE,
                err=re.compile("the report would replace the picture"))
    check(not run.exists("q.png"), "a report under the picture's name")
    run.ffd("check", *work, "--picture", "q.txt", code=USAGE, err=re.compile("is not that of a page or a picture"))
    start(run, [{"at": [1, 1, 1], "by": [30, 30, 30]}])
    run.ffd("check", *work, "--picture", "q.png", "--fail-on", "folds", code=NO, lines=1)
    check(run.exists("q.png"), "the picture of what a gate refuses")


def textured(run, png, colour="1 1 1", name="t.png"):
    """A square in z = 0 with a texture, as OBJ."""
    run.write("t.png", png)
    run.write("m.mtl", f"newmtl m\nKd {colour}\nmap_Kd {name}\n")
    run.write("t.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n")


@case
def what_a_mesh_names_is_not_overwritten(run):
    """With --force its own texture was replaced by the picture of it."""
    textured(run, make_png([[(255, 0, 0)]]))
    start(run)
    run.write("b.bin.html", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
    run.write("t.gltf", json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "images": [{"uri": "t.png"}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0] * 3, "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "b.bin.html"}],
        "extensions": {"X_media": {"posterUri": "poster.html"}}}))
    run.write("poster.html", "<p>")
    for work, output in ((["t.obj", "-l", "l.json"], "t.png"), (["t.obj"], "./t.png"), (["t.gltf", "-l", "l.json"], "t.png"),
                         (["a.obj", "t.gltf"], "t.png"), (["t.gltf"], "b.bin.html")):
        content = run.read(output)
        run.ffd("view", *work, "-o", output, "--force", code=IO, lines=1,
                err=re.compile(re.escape(f"{output}: is an input of this command")))
        equal(run.read(output), content, "the file that it names")
    run.ffd("view", "t.gltf", "-o", "poster.html", "--force", code=IO, err="poster.html: is named by an input of this command")
    equal(run.text("poster.html"), "<p>")
    run.ffd("check", "t.obj", "-l", "l.json", "--picture", "t.png", "--force", code=IO, lines=1)


def images_of(run, name="p.html"):
    """(type, bytes) of the images in a page."""
    html = run.text(name)
    return [(kind, base64.b64decode(re.search(rf'id="data-image-{i}">([^<]*)<', html)[1]))
            for i, kind in enumerate(read_page(run, name).scene["images"])]


@case
def a_page_holds_the_textures_of_its_model(run):
    png = make_png([[(220, 20, 20)] * 8 + [(20, 200, 20)] * 8] * 16)
    textured(run, png)
    equal(view(run, "t.obj").scene["materials"][0]["base"], {"image": 0, "wrap": ["repeat", "repeat"]})
    equal(images_of(run), [("image/png", png)], "the file as it is")
    # What is no image stays out, and its material says so.
    textured(run, b"no image")
    scene = view(run, "t.obj", err=re.compile("1 image of a material cannot be shown")).scene
    check(scene["images"] == [] and scene["materials"][0]["lost"] and "base" not in scene["materials"][0], scene)


@case
def large_textures_are_made_smaller(run):
    """Noise, which no format packs: 27 MB."""
    noise = os.urandom(3 * 3000)
    png = make_png([list(zip(*[iter(bytes(x ^ y % 256 for x in noise))] * 3)) for y in range(3000)], level=0)
    textured(run, png)
    view(run, "t.obj", err=re.compile(r"the page: 1 of 1 textures are smaller than in the model: \d\.\d in place of 27\.\d MB"))
    (kind, content), = images_of(run)
    check(kind == "image/jpeg" and content[:3] == b"\xff\xd8\xff" and len(content) < 24 << 20, kind, len(content))
    view(run, "t.obj", "--full")
    equal(images_of(run), [("image/png", png)], "the file as it is")


@case
def a_page_keeps_folders_to_itself(run):
    os.mkdir(run.path("secret"))
    start(run)
    for name in ("a.obj", "l.json"):
        run.write("secret/" + name, run.read(name))
    place = run.path("secret")
    page = view(run, place + "/a.obj", "-l", place + "/l.json")
    equal([page.scene["name"], page.scene["cages"][0]["name"]], ["a.obj", "l.json"])
    check("<title>a.obj" in run.text("p.html") and "secret" not in run.text("p.html"), "the folder is in the page")


@case
def textures_are_drawn_and_broken_ones_are_grey(run):
    """Left half red, right half green; the upper row is the image's first."""
    textured(run, make_png([[(220, 20, 20)] * 8 + [(20, 200, 20)] * 8] * 16))
    look = ["t.obj", "--camera", "front", "--size", "200x200"]
    rows = picture(run, *look)
    check(is_red(*rows[100][70]) and is_green(*rows[100][130]), rows[100][70], rows[100][130])
    textured(run, make_png([[(220, 20, 20)] * 16] * 8 + [[(20, 200, 20)] * 16] * 8))
    rows = picture(run, *look)
    check(is_red(*rows[70][100]) and is_green(*rows[130][100]), rows[70][100], rows[130][100])
    whole = make_png([[(220, 20, 20)] * 64] * 64)
    bomb = whole[:16] + struct.pack(">II", 30000, 30000) + whole[24:]
    for broken in (whole[:60], bomb, whole[:40] + b"x" * 20 + whole[60:]):
        textured(run, broken)
        rows = picture(run, *look, err=re.compile("t.obj: grey in the picture: 1 image"))
        check(is_grey(*rows[100][100]), rows[100][100])
    # An image that is a colour here and an opacity there is one.
    run.write("t.png", whole[:60])
    run.write("two.mtl", "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_d t.png\n")
    run.write("two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n"
              "usemtl a\nf 1/1 2/1 3/2\nusemtl b\nf 1/1 3/2 4/1\n")
    picture(run, "two.obj", *look[1:], err=re.compile("two.obj: grey in the picture: 1 image, as t.png"))
    # Whatever the colour that the image would be multiplied by.
    for name in ("none.png", "../t.png", "m.mtl"):
        textured(run, whole, "1 0 0", name)
        rows = picture(run, *look, err=re.compile("1 image of a material cannot be shown"))
        check(is_grey(*rows[100][100]), name, rows[100][100])


@case
def textures_are_the_same_for_any_threads(run):
    """Four images, of which one is broken. Where not all of them fit at once: test_memory.py."""
    for i, side in enumerate((50, 90, 140, 150)):
        png = make_png([[(60 * i, 255 - x, 20) for x in range(side)]] * side)
        run.write(f"{i}.png", png[:100] if i == 1 else png)
    run.write("m.mtl", "".join(f"newmtl m{i}\nmap_Kd {i}.png\n" for i in range(4)))
    run.write("t.obj", "mtllib m.mtl\nvt 0 0\nvt 1 0\nvt 1 1\n"
              + "".join(f"v {i} 0 0\nv {i + 1} 0 0\nv {i} 1 0\nusemtl m{i}\nf -3/1 -2/2 -1/3\n" for i in range(4)))
    pictures = set()
    for threads in ("1", "2", "4"):
        run.ffd("view", "t.obj", "-o", "p.png", "--force", "--size", "200x100", "--threads", threads,
                err=re.compile(r"t\.obj: grey in the picture: 1 image, as 1\.png: the PNG image is broken"))
        pictures.add(run.read("p.png"))
    equal(len(pictures), 1, "pictures of 1, 2 and 4 threads")


@case
def colours_of_vertices_are_drawn(run):
    run.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3 4\n")
    check(is_red(*picture(run, "a.obj", "--camera", "front", "--size", "100x100")[50][50]), "red")


@case
def what_nothing_uses_takes_no_room(run):
    start(run)
    run.write("far.obj", CUBE + "v 1e6 1e6 1e6\n")
    look = ["--camera", "front", "--size", "100x100"]
    check(picture(run, "far.obj", *look) == picture(run, "a.obj", *look), "the same picture")


@case
def lines_and_points_are_drawn(run):
    for content in ("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 1 1 0\np 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 1 1 0\n"):
        run.write("a.obj", content)
        rows = picture(run, "a.obj", "--camera", "front", "--size", "200x200")
        check(count(rows, lambda r, g, b: r < 190) >= 3, content)


@case
def what_is_not_finite_is_not_drawn_and_said(run):
    """One triangle of two, in a page and in a picture; no noise of it where nothing is lost."""
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 1 0\nf 1 2 3\nf 2 4 3\n")
    page = view(run, "a.obj", err="a.obj: the page: 1 vertex is not finite, and 1 triangle there is not drawn")
    equal([len(page.triangles), page.scene["notFinite"]], [1, 1], "the page")
    rows = picture(run, "a.obj", "--camera", "front", "--size", "100x100",
                   err="a.obj: the picture: 1 triangle is not drawn where a vertex is not finite")
    check(count(rows, lambda r, g, b: r < 200) > 500, "the other triangle")
    run.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 1 0\nf 1 2 3\n")
    picture(run, "b.obj", "--size", "100x100", lines=0)


@case
def an_empty_mesh_is_a_page(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.off", "OFF\n0 0 0\n")
    equal(len(view(run, "a.off", "-l", "l.json", err=lambda said: None).before), 0)
    equal(len(view(run, "a.off", err=lambda said: None).before), 0)
    run.write("b.obj", "v 0 0 0\nv 1 nan 0\n")
    equal(view(run, "b.obj", "-l", "l.json", err=lambda said: None).scene["notFinite"], 1)
    for name in ("a.off", "b.obj"):
        picture(run, name, "-l", "l.json", "--size", "64x64", err=lambda said: None)
        picture(run, name, "--size", "64x64", err=lambda said: None)


main()
