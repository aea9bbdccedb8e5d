#!/usr/bin/env python3
"""Numbers that are too coarse for what is asked: steps of quantized positions, and layers whose extent is rounding."""

import json

from broken_gltf_cases import CORNERS, Model
from gltf_asset import SHORT
from harness import CUBE, case, equal, main, near
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
