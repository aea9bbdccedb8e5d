#!/usr/bin/env python3
"""Numbers that are too coarse for what is asked: steps of quantized positions, and layers whose extent is rounding."""

import json
import struct

from broken_gltf_cases import CORNERS, Model
from gltf_asset import SHORT
from harness import CUBE, case, check, equal, main, near
from messages import anything, one_line


@case
def quantized_positions_that_are_too_coarse(run):
    """A cube of steps of 1 in a box of 3: a shift by 0.2 rounds to none, one by 0.7 to 1; 12 bits and more are silent."""
    model = Model()
    steps = [(round(3 * (x + 1) / 2), round(3 * (y + 1) / 2), round(3 * (z + 1) / 2)) for x, y, z in CORNERS]
    model.primitive["attributes"]["POSITION"] = model.add(steps, component=SHORT, bounds=True)
    model.asset["extensionsUsed"] = ["KHR_mesh_quantization"]
    run.write("q.glb", model.glb())
    moves = {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"}}
    run.write("l.json", json.dumps({**moves, "moves": [{"by": [0.2, 0, 0]}]}))
    done = run.ffd("deform", "q.glb", "o.glb", "-l", "l.json", "--report", "r.json", err=anything)
    equal(run.read("o.glb"), run.read("q.glb"))
    one_line(done, "no vertex moves in the output", "too coarse", r"0\.2")
    one_line(done, "rounded to the steps", r"off by up to 0\.2", r"shape of 3")
    near([json.loads(run.text("r.json"))["jobs"][0]["precision"][key] for key in ("error", "side")], [0.2, 3], 1e-12)
    run.write("l.json", json.dumps({**moves, "moves": [{"by": [0.7, 0, 0]}]}))
    done = run.ffd("deform", "q.glb", "o.glb", "-l", "l.json", "--force", err=anything)
    one_line(done, "rounded to the steps", r"off by up to 0\.3")
    fine = [tuple(30000 * c // 3 for c in step) for step in steps]
    model.primitive["attributes"]["POSITION"] = model.add(fine, component=SHORT, bounds=True)
    run.write("q.glb", model.glb())
    run.ffd("deform", "q.glb", "o.glb", "-l", "l.json", "--force", err=[])


@case
def floats_of_an_input_in_another_format(run):
    """Results are floats where the input has floats: what these cannot hold is said, whatever is written. With doubles
    and text it is said of a target of floats."""
    corners = [(x / 4, y / 4, z / 4) for x, y, z in CORNERS]
    for kind, code, is_lost in (("float", "f", ("obj", "ply", "off", "stl", "glb")), ("double", "d", ("stl",))):
        run.write("a.ply", (f"ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty {kind} x\nproperty {kind} y\n"
                            f"property {kind} z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n").encode()
                  + b"".join(struct.pack(f"<3{code}", *p) for p in corners) + b"".join(struct.pack("<B3i", 3, *face) for face in ((0, 1, 2), (3, 4, 5), (6, 7, 0))))
        run.write("l.json", json.dumps({"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                                        "moves": [{"by": [1e7 + 0.3, 0, 0]}]}))
        for ending in ("obj", "ply", "off", "stl", "glb"):
            done = run.ffd("deform", "a.ply", "o." + ending, "-l", "l.json", "--force", "--report", "r.json", err=anything)
            equal(any("the precision of coordinates that far from the origin" in line for line in done.err), ending in is_lost, (kind, ending))
            if kind == "float":
                precision = json.loads(run.text("r.json"))["jobs"][0]["precision"]
                check(precision["error"] > 0.1 and precision["side"] < 2, ending, precision)


@case
def quantized_positions_that_become_coarse_floats(run):
    """Beyond the range of their type positions are floats, on the same steps near the origin only."""
    model = Model()
    steps = [tuple(int(100 * c) for c in p) for p in CORNERS]
    view = model.view(b"".join(struct.pack("<4h", *p, 0) for p in steps), byteStride=8, target=34962)
    model.primitive["attributes"]["POSITION"] = model.view_accessor(view, steps, "VEC3", SHORT, True)
    model.asset["extensionsUsed"] = ["KHR_mesh_quantization"]
    run.write("q.glb", model.glb())
    for far, is_lost in ((1e5, False), (1e9, True)):  # whole steps
        run.write("l.json", json.dumps({"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                                        "moves": [{"by": [far + 16, 0, 0]}]}))
        done = run.ffd("deform", "q.glb", "o.glb", "-l", "l.json", "--force", "--report", "r.json", err=anything)
        equal(any("floats cannot hold: the precision" in line for line in done.err), is_lost, far)
        equal(json.loads(run.text("r.json"))["jobs"][0].get("precision") is not None, is_lost, far)


@case
def a_twist_along_the_normal_of_one_layer(run):
    """The coordinates of a layer of a turned box differ by rounding alone: it has no extent, and nothing turns."""
    axes = [[2 / 3, 2 / 3, 1 / 3], [-2 / 3, 1 / 3, 2 / 3], [1 / 3, -2 / 3, 2 / 3]]
    for action in ({"twist": {"axis": axes[2], "degrees": 60}}, {"taper": {"axis": axes[2], "factor": 3}},
                   {"bend": {"axis": axes[2], "toward": axes[0], "degrees": 60}}):
        run.write("l.json", json.dumps({
            "format": "ffd-lattice", "version": 1, "size": [4, 4, 3],
            "rest": {"box": {"min": [-7, -6, -5], "max": [1.1, 2.3, 3.7], "axes": axes}},
            "moves": [{"at": ["all", "all", "top"], **action}]}))
        run.write("a.obj", CUBE)
        done = run.ffd("deform", "a.obj", "o.obj", "-l", "l.json", "--force", err=anything)
        equal(run.read("o.obj"), run.read("a.obj"), str(action))
        one_line(done, "no vertex moves")


main()
