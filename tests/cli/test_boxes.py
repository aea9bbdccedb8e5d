#!/usr/bin/env python3
"""Boxes round several meshes or parts of them: what they go round, and what does not widen them."""
import json
import re

from batches import batch, lines_of, start
from gltf_build import Scene
from harness import INVALID, NO, USAGE, case, check, equal, lattice, main, near, obj_vertices
from messages import anything, lines_with, one_line

BODY = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3 4\n"
DOOR = "v 1 0 0\nv 3 0 0\nv 3 1 1\nv 1 1 0\nf 1 2 3 4\n"
ROUND_BOTH = [[0, 0, 0], [3, 1, 1]]
BEND = [{"bend": {"axis": "x", "toward": [0, 0, 1], "degrees": 60}}]


def parts(run):
    run.write("body.obj", BODY)
    run.write("door.obj", DOOR)


def sides(file):
    box = file["rest"]["box"]
    return [box["min"], box["max"]]


def new(run, *arguments, **options):
    """The file that lattice new makes."""
    options.setdefault("err", anything)
    run.ffd("lattice", "new", *arguments, "-o", "n.json", "--force", **options)
    return json.loads(run.read("n.json"))


def spelled_out(run, name="spelled.json", low=(-0.15, -0.05, -0.05), high=(3.15, 1.05, 1.05), moves=None):
    """The box round both parts with a margin of 0.05, in numbers."""
    return run.write(name, lattice(low=low, high=high, moves=moves or BEND))


def alone(run, mesh, file="spelled.json", *options):
    run.ffd("deform", mesh, "alone.obj", "-l", file, "--force", *options, err=anything)
    return obj_vertices(run.text("alone.obj"))


@case
def a_new_lattice_round_several_meshes(run):
    parts(run)
    near(sides(new(run, "body.obj", "door.obj", "--margin", "0")), ROUND_BOTH, 1e-15)
    near(sides(new(run, "door.obj", "body.obj")), [[-0.15, -0.05, -0.05], [3.15, 1.05, 1.05]], 1e-14)
    for options in (["--shape", "cylinder", "--axis", "x"], ["--axes", "principal", "--margin", "0"]):
        new(run, "body.obj", "door.obj", *options)
        run.ffd("check", "body.obj", "door.obj", "-l", "n.json", "--outside", "error")


@case
def a_new_lattice_has_no_moves_yet(run):
    parts(run)
    for options in ([], ["--shape", "cylinder"], ["--axes", "principal"]):
        equal(new(run, "body.obj", *options).get("moves"), [], str(options))


@case
def a_new_lattice_round_a_part(run):
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 5 5 5\nv 6 5 5\nv 6 6 6\ng left\nf 1 2 3\ng right\nf 4 5 6\n")
    near(sides(new(run, "a.obj", "--margin", "0", "--only", "group:right")), [[5, 5, 5], [6, 6, 6]], 1e-15)
    near(sides(new(run, "a.obj", "--margin", "0", "--only", "group:right", "--only", "group:left")), [[0, 0, 0], [6, 6, 6]], 1e-15)
    run.ffd("lattice", "new", "a.obj", "-o", "m.json", "--only", "group:middle", code=USAGE, err=re.compile("middle"))


@case
def a_margin_for_each_direction(run):
    parts(run)
    near(sides(new(run, "door.obj", "--margin", "0.5,0,2")), [[0, 0, -2], [4, 1, 3]], 1e-15)
    run.write("l.json", lattice(rest={"box": "mesh", "margin": [0.5, 0, 2]}, moves=BEND))
    spelled_out(run, low=(0, 0, -2), high=(4, 1, 3))
    near(alone(run, "door.obj", "l.json"), alone(run, "door.obj"), 1e-13)
    run.ffd("lattice", "new", "door.obj", "-o", "m.json", "--margin", "0.5,0,0", "--shape", "cylinder", "--axis", "x", code=USAGE,
            err=re.compile("--margin.*box.*cylinder has one margin"))
    run.ffd("lattice", "new", "door.obj", "-o", "m.json", "--margin", "0.5,0,2", "--axes", "principal")
    for margin in ("1,2", "1,2,3,4", "1,,2", "x,0,0"):
        run.ffd("lattice", "new", "door.obj", "-o", "m.json", "--margin", margin, code=USAGE)
    for margin in ([1, 2], [1, 2, 3, 4], [1, 2, "x"], []):
        run.write("bad.json", lattice(rest={"box": "mesh", "margin": margin}))
        run.ffd("check", "door.obj", "-l", "bad.json", code=INVALID)


@case
def the_help_has_the_margin(run):
    text = run.ffd("lattice", "new", "--help").text
    line = next(line for line in text.splitlines() if line.strip().startswith("--margin"))
    check("0.05" in line and "x,y,z" in line.lower(), line)
    check("MESH..." in text, "several meshes in the usage")


@case
def a_box_round_the_meshes_that_a_file_names(run):
    """Paths are relative to the lattice file, and may lead out of its folder."""
    run.write("kit/body.obj", BODY)
    run.write("kit/door.obj", DOOR)
    file = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "moves": BEND,
            "rest": {"box": {"meshes": ["../kit/body.obj", "../kit/door.obj"]}, "margin": 0.05}}
    run.write("lattices/l.json", file)
    spelled_out(run)
    for mesh in ("kit/body.obj", "kit/door.obj"):
        near(alone(run, mesh, "lattices/l.json"), alone(run, mesh), 1e-13, mesh)
    run.ffd("deform", "kit/body.obj", "b.obj", "-l", "lattices/l.json", "--depfile", "b.d", "--force", err=anything)
    equal(run.text("b.d").split(), ["b.obj:", "kit/body.obj", "lattices/l.json", "lattices/../kit/body.obj", "lattices/../kit/door.obj"])
    file["rest"]["box"]["meshes"].append("../kit/none.obj")
    run.write("lattices/l.json", file)
    run.ffd("deform", "kit/body.obj", "c.obj", "-l", "lattices/l.json", code=3, err=re.compile("none.obj"))
    for meshes in ([], "kit/body.obj", [3]):
        run.write("bad.json", {**file, "rest": {"box": {"meshes": meshes}}})
        run.ffd("deform", "kit/body.obj", "c.obj", "-l", "bad.json", code=INVALID)


@case
def flaws_of_a_mesh_that_a_file_names(run):
    """They are said, by every command and every job that uses the box; --strict refuses them."""
    start(run)
    parts(run)
    run.write("door.obj", DOOR + "\x1a")
    run.write("l.json", lattice(rest={"box": {"meshes": ["body.obj", "door.obj"]}, "margin": 0.05}))
    said = "door.obj: a Ctrl-Z, the end mark of old texts, ends the file"
    for words in (["deform", "body.obj", "o.obj"], ["check", "body.obj"], ["embed", "body.obj", "-o", "e.npy"]):
        one_line(run.ffd(*words, "-l", "l.json", err=anything), f"^body.obj: {said}")
        run.ffd(*words, "-l", "l.json", "--strict", "--force", code=INVALID, err=said)
    run.write("m.jsonl", lines_of([{"in": "body.obj", "lattice": "l.json", "out": f"{n}.obj"} for n in range(3)]))
    equal(len(lines_with(run.ffd("batch", "m.jsonl", err=anything), said)), 3)


@case
def what_the_box_goes_round_enters_an_embedding(run):
    parts(run)
    run.write("l.json", lattice(rest={"box": {"meshes": ["body.obj", "door.obj"]}, "margin": 0.05}, moves=BEND))
    run.ffd("embed", "body.obj", "-l", "l.json", "-o", "e.npy", err=anything)
    run.ffd("deform", "body.obj", "one.obj", "-l", "l.json", err=anything)
    run.ffd("deform", "body.obj", "two.obj", "-l", "l.json", "--embedding", "e.npy", err=anything)
    equal(run.read("two.obj"), run.read("one.obj"))
    run.write("door.obj", DOOR.replace("v 3 0 0", "v 4 0 0"))
    run.ffd("deform", "body.obj", "three.obj", "-l", "l.json", "--embedding", "e.npy", code=INVALID)


@case
def what_the_box_goes_round_enters_a_fingerprint(run):
    start(run)
    parts(run)
    run.write("l.json", lattice(rest={"box": {"meshes": ["body.obj", "door.obj"]}, "margin": 0.05}, moves=BEND))
    run.write("m.jsonl", lines_of([{"in": "body.obj", "lattice": "l.json", "out": "o.obj"}]))
    batch(run, "m.jsonl", "--resume", done=1)
    batch(run, "m.jsonl", "--resume", kept=1)
    run.write("door.obj", DOOR.replace("v 3 0 0", "v 4 0 0"))
    batch(run, "m.jsonl", "--resume", done=1)


def mesh_box(run):
    start(run)
    parts(run)
    run.write("l.json", lattice(rest={"box": "mesh", "margin": 0.05}, moves=BEND))
    run.folder_of("o")


@case
def a_shared_box_goes_round_all_inputs(run):
    mesh_box(run)
    spelled_out(run)
    expected = {mesh: alone(run, mesh) for mesh in ("body.obj", "door.obj")}
    run.ffd("deform", "body.obj", "door.obj", "--out-dir", "o", "-l", "l.json", "--shared-box", err=[])
    for mesh, vertices in expected.items():
        near(obj_vertices(run.text("o/" + mesh)), vertices, 1e-13, mesh)
    run.ffd("check", "body.obj", "door.obj", "-l", "l.json", "--shared-box", "--outside", "error")
    run.ffd("deform", "body.obj", "door.obj", "--in-place", "-l", "l.json", "--shared-box", err=[])
    for mesh in expected:
        equal(run.read(mesh), run.read("o/" + mesh), "the box is taken before the first file is written")


@case
def without_it_one_line_warns(run):
    mesh_box(run)
    done = run.ffd("deform", "body.obj", "door.obj", "--out-dir", "o", "-l", "l.json", err=anything)
    one_line(done, r"\bbox\b", "--shared-box")
    equal(lines_with(run.ffd("deform", "body.obj", "one.obj", "-l", "l.json"), "--shared-box"), [], "a single input")
    # So does a batch of several meshes, however its jobs are given; not one of several rows of a mesh.
    jobs = [{"in": mesh, "lattice": "l.json", "out": f"o/{i}{mesh}"} for i, mesh in enumerate(("body.obj", "door.obj", "body.obj"))]
    run.write("m.jsonl", lines_of(jobs))
    run.write("m.csv", "in,lattice,out\n" + "".join("{in},{lattice},{out}\n".format(**one) for one in jobs))
    for name, words in (("m.jsonl", ["m.jsonl"]), ("m.csv", ["--csv", "m.csv"]),
                        ("*[yr].obj", ["--in", "*[yr].obj", "--lattice", "l.json", "--out-dir", "o"])):
        done = run.ffd("batch", *words, "--force", err=anything)
        one_line(done, f"{name}: ".replace("*", r"\*").replace("[", r"\["), "each of 2 meshes by itself", "--shared-box")
    run.write("m.jsonl", lines_of(jobs[::2]))
    batch(run, "m.jsonl", "--force", done=2)


@case
def meshes_that_are_not_read_have_no_box(run):
    """Neither a missing one nor a broken one: of two meshes that are read it is said that there are two, of one nothing."""
    mesh_box(run)
    run.write("broken.obj", "v 0 0 x\n")
    bad = ("gone.obj", "broken.obj")
    for good in (["body.obj"], ["body.obj", "door.obj"]):
        jobs = [{"in": mesh, "lattice": "l.json", "out": f"o/{mesh}"} for mesh in (*bad, *good)]
        run.write("m.jsonl", lines_of(jobs))
        run.write("m.csv", "in,lattice,out\n" + "".join("{in},{lattice},{out}\n".format(**one) for one in jobs))
        for words in (["deform", *bad, *good, "--out-dir", "o", "-l", "l.json", "--force"], ["check", *bad, *good, "-l", "l.json"],
                      ["batch", "m.jsonl", "--force"], ["batch", "--csv", "m.csv", "--force"]):
            done = run.ffd(*words, code=NO, err=anything, data=True)
            equal(len(lines_with(done, "cannot be opened")), 1, words)
            equal(len(lines_with(done, "broken.obj")), 1, words)
            equal([re.search("each of (the )?2 meshes by itself", line) is not None for line in lines_with(done, "--shared-box")],
                  [True] * (len(good) - 1), words)


@case
def a_shared_box_of_a_manifest_is_of_all_shards(run):
    mesh_box(run)
    run.write("m.jsonl", lines_of([{"in": mesh, "lattice": "l.json", "out": "o/" + mesh} for mesh in ("body.obj", "door.obj")]))
    batch(run, "m.jsonl", "--shared-box", done=2)
    whole = {mesh: run.read("o/" + mesh) for mesh in ("body.obj", "door.obj")}
    spelled_out(run)
    near(obj_vertices(whole["body.obj"].decode()), alone(run, "body.obj"), 1e-13)
    for mesh in whole:
        run.remove("o/" + mesh)
    for shard in ("0/2", "1/2"):
        batch(run, "m.jsonl", "--shared-box", "--resume", "--shard", shard, done=1)
    equal({mesh: run.read("o/" + mesh) for mesh in whole}, whole)
    # Another part outgrows the box: what was up to date is no longer.
    batch(run, "m.jsonl", "--shared-box", "--resume", kept=2)
    run.write("door.obj", DOOR.replace("v 3 0 0", "v 4 0 0"))
    batch(run, "m.jsonl", "--shared-box", "--resume", done=2)


@case
def standard_input_has_no_shared_box(run):
    mesh_box(run)
    run.ffd("deform", "-", "o.obj", "-l", "l.json", "--shared-box", "--input-format", "obj", stdin=BODY.encode(), code=USAGE,
            err=re.compile("standard input|--shared-box(?!.*nearest)"))


@case
def a_vertex_that_nothing_uses_widens_no_box_and_fails_no_gate(run):
    """Faces, lines, points and free-form geometry use vertices; where there is none of them all count."""
    unused = "v 900 900 900\n"
    for name, text in (("face", "f 1 2 3\n"), ("line", "l 1 2 3\n"), ("points", "p 1 2 3\n"), ("curve", "cstype bezier\ndeg 2\ncurv 0 4 1 2 3\nparm u 0 4\nend\n"),
                       ("surface", "surf 0 4 0 4 -4//1 2/3/4 \\\n  3/1\nend\n"), ("patch", "bzp 1 2 3\n"), ("cardinal curve", "cdc 1 2 3\n"),
                       # A control vertex that is not there, and points of the parameter space, use nothing.
                       ("curve and more", "vp 1\ncurv 0 1 1 2 3 9\ncurv2 4\nsp 4\nscrv 4 4 4\n")):
        run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\n" + unused + text)
        near(sides(new(run, "a.obj", "--margin", "0")), [[0, 0, 0], [1, 1, 1]], 1e-15, name)
        run.write("l.json", lattice(moves=[{"by": [0, 0, 1]}]))
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--fail-on", "outside,tear", err=anything)
        equal(run.text("b.obj").splitlines()[3], unused.strip(), "it stays")
        run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 9 9 9\n" + unused + text)
        run.ffd("check", "a.obj", "-l", "l.json", "--fail-on", "outside", code=NO, err=anything)
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\n" + unused)
    near(sides(new(run, "a.obj", "--margin", "0")), [[0, 0, 0], [900, 900, 900]], 1e-12)
    run.ffd("check", "a.obj", "-l", "l.json", "--fail-on", "outside", code=NO, err=anything)


@case
def a_hidden_node_widens_no_box_and_fails_no_gate(run):
    """And what is below it is hidden too."""
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    for nodes in ([{"mesh": 0}, {"mesh": 1, **hidden}], [{"mesh": 0}, {**hidden, "children": [2]}, {"mesh": 1}]):
        scene = Scene(nodes=nodes, scenes=[{"nodes": [0, 1]}], scene=0, extensionsUsed=["KHR_node_visibility"])
        meshes = []
        for z in (0.0, 50.0):
            points = scene.add([[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z + 1]], bounds=True)
            meshes.append({"primitives": [{"attributes": {"POSITION": points}}]})
        scene.asset["meshes"] = meshes
        run.write("a.glb", scene.glb())
        near(sides(new(run, "a.glb", "--margin", "0")), [[0, 0, 0], [1, 1, 1]], 1e-15)
        equal(run.ffd("info", "a.glb", "--json", err=anything).json["bounds"], {"min": [0, 0, 0], "max": [1, 1, 1]})
        run.write("l.json", lattice(moves=[{"by": [0, 0, 1]}]))
        run.ffd("check", "a.glb", "-l", "l.json", "--fail-on", "outside,tear", err=anything)
        run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", "--force", err=anything)
        near(obj_vertices(run.text("b.obj")), [[0, 0, 1], [1, 0, 1], [1, 1, 2]], 1e-12)


@case
def unused_vertices_of_other_formats(run):
    far = [900, 900, 900]
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
    rows = "0 0 0\n1 0 0\n1 1 1\n900 900 900\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    edges = "element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    run.write("face.ply", head + faces + rows + "3 0 1 2\n")
    run.write("edge.ply", head + edges + rows + "0 1\n1 2\n")
    run.write("cloud.ply", head + "end_header\n" + rows)
    run.write("face.off", "OFF\n4 1 0\n" + rows + "3 0 1 2\n")
    run.write("line.off", "OFF\n4 2 0\n" + rows + "2 0 1\n1 2\n")
    for indexed in (True, False):
        scene = Scene(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], scene=0)
        points = scene.add([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [900.0] * 3], bounds=True)
        primitive = {"attributes": {"POSITION": points}, "mode": 0 if not indexed else 4}
        if indexed:
            primitive["indices"] = scene.add([[0], [1], [2]], component=5125, shape="SCALAR")
        scene.asset["meshes"] = [{"primitives": [primitive]}]
        run.write(f"{'face' if indexed else 'cloud'}.glb", scene.glb())
    for mesh in ("face.ply", "edge.ply", "face.off", "line.off", "face.glb"):
        near(sides(new(run, mesh, "--margin", "0")), [[0, 0, 0], [1, 1, 1]], 1e-15, mesh)
    for mesh in ("cloud.ply", "cloud.glb"):
        near(sides(new(run, mesh, "--margin", "0")), [[0, 0, 0], far], 1e-12, mesh)


@case
def what_is_not_finite_counts_whatever_shows_it(run):
    """An organized scan's vertex without a measurement, which no face uses, and one of a hidden node."""
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    rows = ["0 0 0\n", "1 0 0\n", "1 1 1\n", "nan nan nan\n"]
    run.write("a.ply", head + faces + "".join(rows) + "3 0 1 2\n")
    run.write("a.off", "OFF\n4 1 0\n" + "".join(rows) + "3 0 1 2\n")
    run.write("a.obj", "".join("v " + row for row in rows) + "f 1 2 3\n")
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 1], [float("nan")] * 3]
    scene = Scene(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], scene=0)
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add(points)},
                                              "indices": scene.add([[0], [1], [2]], component=5125, shape="SCALAR")}]}]
    run.write("a.glb", scene.glb())
    scene = Scene(nodes=[{"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": False}}}, {"mesh": 1}],
                  scenes=[{"nodes": [0, 1]}], scene=0, extensionsUsed=["KHR_node_visibility"])
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add(some)}}]} for some in ([points[3]] * 3, points[:3])]
    run.write("hidden.glb", scene.glb())
    run.write("l.json", lattice(moves=[{"by": [0, 0, 1]}]))
    for mesh, invalid in (("a.ply", 1), ("a.off", 1), ("a.obj", 1), ("a.glb", 1), ("hidden.glb", 3)):
        for command in (["check", mesh], ["deform", mesh, "b" + mesh[-4:], "--force"]):
            done = run.ffd(*command, "-l", "l.json", "--report", "r.json", err=anything)
            one_line(done, "not inside", f"{invalid} invalid", "not finite")
            equal([json.loads(run.read("r.json"))["jobs"][0][key] for key in ("inside", "invalid", "unused", "hidden")],
                  [3, invalid, 0, 0], mesh)
            gate = run.ffd(*command, "-l", "l.json", "--fail-on", "invalid", code=NO, data=True, err=anything)
            check("not finite (--fail-on invalid)" in gate.err[0], gate.err)
    check("v nan nan nan" in run.text("b.obj"), "it keeps its bits")


@case
def what_nothing_shows_is_counted_apart(run):
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 9 9 9\nv 0.5 0.5 0.5\nv 7 0 0\nf 1 2 3\np 6\n")
    run.write("l.json", lattice(moves=[{"by": [0, 0, 1]}]))
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "r.json", err=anything)
    one_line(done, r"\b1 of 6\b", "1 outside")
    one_line(done, r"\b1\b", "no face, line or point")
    job = json.loads(run.read("r.json"))["jobs"][0]
    equal([job[key] for key in ("vertices", "inside", "outside", "unused", "hidden", "moved")], [6, 4, 1, 1, 0, 4])
    near(obj_vertices(run.text("b.obj"))[4], [0.5, 0.5, 1.5], 1e-15)


@case
def a_selection_of_hidden_nodes_only_has_their_box(run):
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    scene = Scene(nodes=[{"mesh": 0, "name": "shown"}, {"mesh": 0, "name": "spare", "translation": [0, 0, 50], **hidden}],
                  scenes=[{"nodes": [0, 1]}], scene=0, extensionsUsed=["KHR_node_visibility"],
                  extensionsRequired=["KHR_node_visibility"])
    points = scene.add([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]], bounds=True)
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": points}}]}]
    run.write("a.glb", scene.glb())
    near(sides(new(run, "a.glb", "--margin", "0")), [[0, 0, 0], [1, 1, 1]], 1e-15)
    near(sides(new(run, "a.glb", "--margin", "0", "--only", "node:spare")), [[0, 0, 50], [1, 1, 51]], 1e-12)
    run.write("l.json", lattice(rest={"box": "mesh"}, moves=[{"by": [0, 0, 1]}]))
    for options, counted in ((["--only", "node:spare"], [3, 3, 0]), ([], [6, 3, 3])):
        run.ffd("check", "a.glb", "-l", "l.json", *options, "--fail-on", "outside", "--report", "r.json", err=anything)
        job = json.loads(run.read("r.json"))["jobs"][0]
        equal([job[key] for key in ("vertices", "inside", "hidden")], counted)


@case
def a_lattice_from_a_stream_names_no_meshes(run):
    parts(run)
    text = json.dumps(lattice(rest={"box": {"meshes": ["body.obj"]}}))
    for command in (["deform", "body.obj", "o.obj", "-l", "-"], ["embed", "body.obj", "-l", "-", "-o", "e.npy"]):
        run.ffd(*command, stdin=text.encode(), code=USAGE, err=re.compile("standard input"))


@case
def a_depfile_of_a_batch_has_one_rule_for_the_shared_box(run):
    mesh_box(run)
    run.write("m.jsonl", lines_of([{"in": mesh, "lattice": "l.json", "out": "o/" + mesh} for mesh in ("body.obj", "door.obj")]))
    batch(run, "m.jsonl", "--shared-box", "--depfile", "d", done=2)
    rules = [line.split(": ") for line in run.text("d").splitlines()]
    equal([left.split() for left, _ in rules], [["o/body.obj"], ["o/door.obj"], ["o/body.obj", "o/door.obj"]])
    equal(sorted(rules[2][1].split()), ["body.obj", "door.obj"])


@case
def a_depfile_of_a_batch_lists_a_file_once(run):
    """A mesh of a job is also one that the box of its lattice goes round."""
    parts(run)
    run.folder_of("o")
    run.write("l.json", lattice(rest={"box": {"meshes": ["body.obj", "door.obj"]}}, moves=BEND))
    run.write("m.jsonl", lines_of([{"in": mesh, "lattice": "l.json", "out": "o/" + mesh} for mesh in ("body.obj", "door.obj")]))
    batch(run, "m.jsonl", "--depfile", "d", done=2)
    rules = dict(line.split(": ") for line in run.text("d").splitlines())
    for mesh in ("body.obj", "door.obj"):
        equal(sorted(rules["o/" + mesh].split()), ["body.obj", "door.obj", "l.json"], mesh)


@case
def jobs_of_a_manifest_that_share_no_stream(run):
    mesh_box(run)
    job = lines_of([{"in": "body.obj", "lattice": "l.json", "out": "o/body.obj"}])
    run.ffd("batch", "-", "--shared-box", stdin=job.encode(), code=USAGE, err=re.compile("--shared-box"))
    run.write("m.jsonl", lines_of([{"in": "body.obj", "lattice": "l.json", "out": "o/b.obj", "options": {"shared-box": True}}]))
    run.ffd("batch", "m.jsonl", code=NO, err=anything)


@case
def a_mesh_that_cannot_be_read_is_left_out_of_the_box(run):
    mesh_box(run)
    run.write("bad.obj", "v 1 2\n")
    run.ffd("deform", "body.obj", "bad.obj", "door.obj", "--out-dir", "o", "-l", "l.json", "--shared-box", code=NO, err=anything)
    spelled_out(run)
    near(obj_vertices(run.text("o/body.obj")), alone(run, "body.obj"), 1e-13)
    whole = run.read("o/door.obj")
    run.write("m.jsonl", lines_of([{"in": mesh, "lattice": "l.json", "out": "o/" + mesh} for mesh in ("body.obj", "bad.obj", "door.obj")]))
    batch(run, "m.jsonl", "--shared-box", "--force", done=2, failed=["bad.obj"])
    equal(run.read("o/door.obj"), whole)


main()
