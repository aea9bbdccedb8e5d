#!/usr/bin/env python3
"""Every figure of every conversion is that of `ffd check`: whole reports, from each format to each other one, whatever is in the
file. Together the inputs give each member of a report something to say."""

import json
import math
import os
import struct

from gltf_build import Scene
from harness import CUBE_CORNERS, CUBE_FACES, case, check, equal, lattice, main
from messages import entry
from npy import npy

SCHEMA_FILE = "../../data/schema/ffd-report.schema.json"
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), SCHEMA_FILE), encoding="utf-8") as _file:
    MEMBERS = set(json.load(_file)["$defs"]["job"]["properties"])
WIDE, HIGH = 9, 7
GRID = [[i / 4, j / 4, math.sin(i * j) / 8] for j in range(HIGH) for i in range(WIDE)]
FACES = [[k, k + 1, k + WIDE + 1, k + WIDE] for k in range(WIDE * (HIGH - 1)) if k % WIDE < WIDE - 1]
TRIANGLES = [[f[0], f[k], f[k + 1]] for f in FACES for k in (1, 2)]
# These say nothing of the deformation, are of the file that is written, or (cells) of formats that are not converted.
NOT_FIGURES = {"line", "input", "output", "outputs", "positions", "row", "picture", "page", "own_frame", "set", "status", "exit", "error",
               "seconds", "indices_left", "bytes_left", "bounds_left", "morphs", "precision", "cells"}
GATES = ("--fail-on", "edges=1e9,flipped=1000000")


def figures(job):
    return {name: value for name, value in job.items() if name not in NOT_FIGURES}


def obj_file(run):
    """Groups, and a vertex that nothing uses."""
    run.write("in.obj", "".join("v %g %g %g\n" % tuple(p) for p in [*GRID, [0.5, 0.5, 9]])
              + "".join(("g half\n" if k == len(FACES) // 2 else "") + "f %d %d %d %d\n" % tuple(v + 1 for v in f)
                        for k, f in enumerate(FACES)))
    return "in.obj"


def ply_file(run):
    """Normals."""
    rows = GRID
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n" + "".join(
        f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    header += f"element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n"
    run.write("in.ply", header.encode() + b"".join(struct.pack("<6f", *p, 0, 0, 1) for p in rows)
              + b"".join(struct.pack("<B4i", 4, *f) for f in FACES))
    return "in.ply"


def unmeasured_file(run):
    """A vertex without a measurement that nothing uses."""
    run.write("in.ply", f"ply\nformat ascii 1.0\nelement vertex {len(GRID) + 1}\n" + "".join(f"property double {n}\n" for n in "xyz")
              + f"element face {len(TRIANGLES)}\nproperty list uchar int vertex_indices\nend_header\n"
              + "".join("%g %g %g\n" % tuple(p) for p in [*GRID, [math.nan, 0, 0]]) + "".join("3 %d %d %d\n" % tuple(f) for f in TRIANGLES))
    return "in.ply"


def off_file(run):
    run.write("in.off", f"OFF\n{len(GRID)} {len(FACES)} 0\n" + "".join("%g %g %g\n" % tuple(p) for p in GRID)
              + "".join("4 %d %d %d %d\n" % tuple(f) for f in FACES))
    return "in.off"


def stl_file(run):
    run.write("in.stl", bytes(80) + struct.pack("<I", len(TRIANGLES))
              + b"".join(struct.pack("<12fH", 0, 0, 0, *GRID[a], *GRID[b], *GRID[c], 0) for a, b, c in TRIANGLES))
    return "in.stl"


def sheet(made, **members):
    return {"attributes": {"POSITION": made.add(GRID, bounds=True), "NORMAL": made.add([[0.0, 0.0, 1.0]] * len(GRID))},
            "indices": made.add([[v] for t in TRIANGLES for v in t], 5123, "SCALAR"), **members}


def scene_file(run):
    """Two uses of a mesh, one of them out of the scene's middle; a hidden node; a node with a matrix that has no inverse."""
    made = Scene(nodes=[{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "translation": [0, 0, 0.4], "scale": [1, 0.5, 2]},
                        {"mesh": 0, "name": "c", "extensions": {"KHR_node_visibility": {"visible": False}}},
                        {"name": "flat", "mesh": 0, "scale": [1, 1, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1, 2, 3]}], extensionsUsed=["KHR_node_visibility"])
    made.asset["meshes"] = [{"primitives": [sheet(made)]}]
    run.write("in.glb", made.glb())
    return "in.glb"


def morph_file(run):
    """Default weights of two nodes, in primitives with unequal numbers of targets."""
    made = Scene(nodes=[{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "weights": [0, -1], "translation": [0, 0.25, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1]}])
    moves = [made.add([[0, k * math.cos(i) / 8, k / 4] for i in range(len(GRID))], bounds=True) for k in (1, 8)]
    made.asset["meshes"] = [{"weights": [0.5, 0.25], "primitives": [
        sheet(made, targets=[{"POSITION": moves[0]}, {"POSITION": moves[1]}]), sheet(made, targets=[{"POSITION": moves[1]}])]}]
    run.write("in.glb", made.glb())
    return "in.glb"


def skin_file(run):
    """Weights that do not sum to 1; a socket, a camera and joints that stay."""
    made = Scene(nodes=[{"mesh": 0, "skin": 0}, {"name": "hip", "children": [2]}, {"name": "knee", "translation": [0.5, 0, 0]},
                        {"name": "socket", "translation": [0.5, 0.5, 0]}, {"camera": 0, "translation": [1, 1, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1, 3, 4]}], skins=[{"joints": [1, 2]}],
                 cameras=[{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])
    primitive = sheet(made)
    primitive["attributes"] |= {"JOINTS_0": made.add([[0, 1, 0, 0]] * len(GRID), 5121, "VEC4"),
                                "WEIGHTS_0": made.add([[0.75, i / 100, 0.0, 0.0] for i in range(len(GRID))], shape="VEC4")}
    made.asset["meshes"] = [{"primitives": [primitive]}]
    run.write("in.glb", made.glb())
    return "in.glb"


def splat_file(run):
    """The same numbers as a PLY of Gaussian splats; half of their rotations are no numbers."""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(GRID)}\n" + "".join(f"property float {n}\n" for n in names)
    run.write("in.ply", (header + "end_header\n").encode() + b"".join(
        struct.pack("<14f", *p, 0.1, 0.1, 0.1, 1, -1, -4, -2, 1 if i % 2 else math.inf, 0, 0, 0) for i, p in enumerate(GRID)))
    return "in.ply"


def cube_file(run):
    run.write("in.obj", "".join("v %g %g %g\n" % tuple(p) for p in CUBE_CORNERS)
              + "".join("f %d %d %d %d\n" % tuple(f) for f in CUBE_FACES))
    return "in.obj"


FOLD = [{"at": [1, [1, 2], [1, 2]], "by": [3, 0.5, 0.25]}, {"twist": {"axis": "z", "degrees": 30}}]
# A volume that turns round at x = 0.5: J has no inverse there, and what lies before has two u,v,w.
TURNS_ROUND = {**lattice(size=(3, 2, 2), moves=[{"at": [1, 1, 1], "by": [0.5, 0, 0.5]}]), "degree": [2, 1, 1],
               "rest": {"points": [[x, y, z] for z in (-1, 1) for y in (0, 1) for x in (0, 1, 0)]}}
LATTICES = {"l.json": lattice(low=(0.25, 0.25, -1), high=(1.5, 2, 1), moves=FOLD), "turns.json": TURNS_ROUND,
            "next.json": lattice(low=(1.5, 0.25, -1), high=(3, 2, 1), moves=[{"by": [0, 0, 0.5]}])}
OPTIONS = (("-l", "l.json"), ("-l", "l.json", "--outside", "extend", "--falloff", "0.3"), ("-l", "turns.json", "--normals", "recompute"),
           ("-l", "l.json", "-l", "next.json", "--blocks", "--snap", "0.1", "--seam", "C0:w-", "--uniform", "component"))
# Weights of the vertices of obj_file, which differ from row to row.
WEIGHTS = [(37 * v % 16) / 15 for v in range(len(GRID) + 1)]
FORMATS = ("obj", "ply", "off", "stl", "glb")
# Of each file: what a conversion does not write, so that nothing of it moves or stays behind.
INPUTS = {obj_file: (), ply_file: (), unmeasured_file: (), off_file: (), stl_file: (), cube_file: (), scene_file: (), morph_file: (),
          skin_file: ("behind", "rig"), splat_file: ("splats",)}


def has_something_to_say(value):
    if isinstance(value, dict):
        return any(has_something_to_say(member) for member in value.values())
    return value not in (None, 0, [], "")


@case
def every_conversion_has_the_figures_of_check(run):
    for name, content in LATTICES.items():
        run.write(name, content)
    run.write("w.npy", npy(WEIGHTS))
    told = set()
    for made, lost in INPUTS.items():
        name = made(run)
        for options in (*OPTIONS, *[("-l", "l.json", "--weight", "w.npy")] * (made is obj_file)):
            checked = figures(entry(run, "check", name, *options))
            told |= {member for member, value in checked.items() if has_something_to_say(value)}
            for ending in FORMATS:
                # OBJ and OFF have no text for what is no number.
                if made is unmeasured_file and ending in ("obj", "off"):
                    continue
                found = figures(entry(run, "deform", name, "out." + ending, *options, *GATES))
                kept = [] if name.endswith(ending) else lost
                equal({member: found.get(member) for member in (*checked, *found) if member not in kept},
                      {member: checked.get(member) for member in (*checked, *found) if member not in kept},
                      f"{made.__name__} {options} {ending}")
    check(NOT_FIGURES < MEMBERS, "no member of a report", NOT_FIGURES - MEMBERS)
    equal(MEMBERS - NOT_FIGURES - told, set(), "members of which no file has anything to say")


main()
