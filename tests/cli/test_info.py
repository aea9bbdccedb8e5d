#!/usr/bin/env python3
"""ffd info: what is in a mesh or lattice file, as text and as JSON."""
import os

from harness import (CUBE, CUBE_CORNERS, INVALID, IO, MODELS, OK, SANITIZED, UNSUPPORTED, USAGE, case, check, equal, glb, gltf_json, lattice,
                     main, near)
from messages import anything


def facts(run, name, *arguments, **options):
    return run.ffd("info", name, "--json", *arguments, **options).json


@case
def facts_of_a_mesh_are_right(run):
    run.write("a.obj", CUBE + "v 9 0 0\n")
    found = facts(run, "a.obj")
    equal([found[key] for key in ("format", "version", "file", "kind", "mesh_format", "vertices")],
          ["ffd-info", 1, "a.obj", "mesh", "OBJ", 9])
    equal(found["bounds"], {"min": [-1, -1, -1], "max": [9, 1, 1]})
    topology = found["topology"]
    equal([topology[key] for key in ("faces", "edges", "components", "boundary_loops", "non_manifold_edges",
                                     "isolated_vertices", "euler", "area")], [6, 12, 1, 0, 0, 1, 2, 24])


@case
def the_topology_of_known_surfaces_is_right(run):
    for name, text, expected in (
            ("triangle", "v 0 0 0\nv 3 0 0\nv 0 4 0\nf 1 2 3\n", (1, 1, 1, 0, 6)),
            ("two apart", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n", (2, 2, 2, 0, 1)),
            ("three at an edge", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n", (3, 1, None, 1, 1.5)),
            ("no faces", "v 0 0 0\n", (0, 0, 0, 0, 0))):
        run.write("t.obj", text)
        found = facts(run, "t.obj")["topology"]
        loops = found["boundary_loops"] if expected[2] is not None else None
        equal((found["faces"], found["components"], loops, found["non_manifold_edges"]), expected[:4], name)
        near([found["area"]], [expected[4]], 1e-12, name)


@case
def bounds_of_gltf_are_those_of_the_scene(run):
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS, nodes=[{"mesh": 0, "translation": [10, 0, 0]}])))
    found = facts(run, "a.glb")
    equal([found["kind"], found["vertices"], found["bounds"]],
          ["mesh", 8, {"min": [9, -1, -1], "max": [11, 1, 1]}], "the scene's bounds")
    check(found["mesh_format"].lower().startswith("gl"), found["mesh_format"])


@case
def facts_of_a_lattice_are_right(run):
    run.write("l.json", lattice(size=(5, 4, 3), degree=[3, 2, 2], knots=["clamped", "open", "uniform"],
                                moves=[{"at": [0, 0, 0], "by": [0, 3, 4]}]))
    found = facts(run, "l.json")
    equal([found[key] for key in ("format", "kind", "size", "degree", "knots", "control_points", "moved", "largest_move",
                                  "rational")],
          ["ffd-info", "lattice", [5, 4, 3], [3, 2, 2], ["clamped", "open", "uniform"], 60, 1, 5, False])
    equal(found["domain"], {"u": [0, 1], "v": [0, 1], "w": [0.4, 0.6]})


@case
def a_lattice_round_a_mesh_to_come(run):
    run.write("l.json", lattice(rest={"box": "mesh"}, moves=[{"by": [1, 0, 0]}]))
    equal(facts(run, "l.json")["size"], [4, 4, 4])
    check("mesh" in run.ffd("info", "l.json").text, "the text")


@case
def text_says_what_json_says(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice())
    for name in ("a.obj", "l.json"):
        text = run.ffd("info", name).text
        check(text.endswith("\n") and len(text.splitlines()) > 5, text)
        for key, value in facts(run, name).items():
            if isinstance(value, int) and not isinstance(value, bool) and key != "version":
                check(any(line.split()[-1] == str(value) for line in text.splitlines()), f"{name}: {key} {value}")


@case
def quiet_and_verbose_print_the_data(run):
    run.write("a.obj", CUBE)
    text = run.ffd("info", "a.obj").text
    equal(run.ffd("info", "a.obj", "-q").text, text)
    equal(run.ffd("info", "a.obj", "-v").text, text)


@case
def streams_and_formats(run):
    run.write("a.obj", CUBE)
    run.write("strange.name", CUBE)
    equal(facts(run, "-", "--input-format", "obj", stdin=CUBE.encode())["vertices"], 8)
    equal(facts(run, "strange.name", "--input-format", "obj")["vertices"], 8)
    run.ffd("info", "-", stdin=CUBE.encode(), code=USAGE)


@case
def what_is_no_mesh_and_no_lattice_is_refused(run):
    run.write("bad.obj", "v 1\n")
    run.write("bad.json", "{")
    run.write("not.json", {"format": "other"})
    run.write("bad.glb", b"glTF")
    run.folder_of("d.json")
    for name, code in (("none.obj", IO), ("none.json", IO), ("d.json", IO), ("bad.obj", INVALID), ("bad.json", INVALID),
                       ("not.json", INVALID), ("bad.glb", INVALID), ("x.txt", USAGE)):
        for arguments in ([], ["--json"]):
            done = run.ffd("info", name, *arguments, code=code)
            check(done.err[0].startswith(name), done.err[0])


# Positions outside of their min and max; lines that are no statements, one of them a NUL byte.
FLAWED = {"ZeroLengthBufferView.gltf", "cubeQuantized.glb", "groups_smoothing_materials.obj", "zbrush_vertex_color_0_obj.obj"}


@case
def every_sample_model_is_described_or_refused_with_a_reason(run):
    """Described, or refused with a reason; never anything else."""
    refused = 0
    paths = sorted(os.path.join(folder, name) for folder, _, names in os.walk(MODELS or "") for name in names
                   if name.lower().endswith((".obj", ".gltf", ".glb")))
    chosen = paths[::4 if SANITIZED else 1]
    for path in chosen:
        done = run.ffd("info", path, "--json", code=(OK, INVALID, UNSUPPORTED), err=anything)
        check(done.code != OK or not done.err or os.path.basename(path) in FLAWED, f"{path}: {done.err}")
        refused += done.code != OK
        check(done.code != OK or done.json["kind"] == "mesh" and done.json["vertices"] >= 0, path)
    check(MODELS is None or len(paths) > 100 and refused < len(chosen) / 4, f"{len(paths)} models, {refused} refused")


main()
