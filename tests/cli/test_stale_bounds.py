#!/usr/bin/env python3
"""Bounds that extensions and extras of a glTF hold stay as they are: where what they are of is deformed, a line names them and
the report has their number."""

import json

from gltf_build import SHIFT, Scene
from harness import case, check, equal, glb_split, lattice, main
from messages import anything, lines_with

PAIR = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]
FAR = [[500.0, 0.0, 0.0], [502.0, 1.0, 0.0]]
BOX = {"min": [0, 0, 0], "max": [2, 1, 0]}
NAMED = "named as bounds"


def two(**members):
    """A node with a node below it whose mesh is in reach of the lattice, and one beside it whose mesh is not."""
    made = Scene(nodes=[{"name": "Frame", "children": [1]}, {"mesh": 0, "name": "Near"}, {"mesh": 1, "name": "Far"}],
                 scene=0, scenes=[{"nodes": [0, 2]}], **members)
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(rows, bounds=True)}, "mode": 0}]}
                            for rows in (PAIR, FAR)]
    return made


def deformed(run, made, *options, moves=SHIFT, out="out.glb"):
    """The lines, the number in the report, and what is written."""
    run.write("in.glb", made.glb())
    run.write("l.json", moves)
    done = run.ffd("deform", "in.glb", out, "-l", "l.json", "--force", "--report", "r.json", *options, err=anything)
    return lines_with(done, NAMED), json.loads(run.read("r.json"))["jobs"][0].get("bounds_left")


def one(pointer):
    return [f"in.glb: 1 value in extensions and extras is {NAMED} and stays as it was before the deformation: {pointer}"]


@case
def bounds_of_what_is_deformed_are_said_to_stay(run):
    """Of a scene, a node, one above it, a mesh, a primitive and the file; with number and three names."""
    made = two(extras={"bbox_min": 0})
    made.asset["scenes"][0]["extensions"] = {"FB_geometry_metadata": {"vertexCount": 4, "sceneBounds": BOX}}
    made.asset["nodes"][0]["extras"] = {"deep": [{"localAABB": [0, 0, 0, 2, 1, 0]}]}
    made.asset["nodes"][1]["extensions"] = {"EXT_bounding_volume": {"sphere": [0, 0, 0, 3]}}
    made.asset["meshes"][0]["extras"] = {"BoundingSphere": {"bounds": 3}}
    made.asset["meshes"][0]["primitives"][0]["extras"] = {"bounds": [BOX]}
    said, count = deformed(run, made)
    equal([said, count], [[
        f"in.glb: 6 values in extensions and extras are {NAMED} and stay as they were before the deformation: "
        "/nodes/0/extras/deep/0/localAABB, /nodes/1/extensions/EXT_bounding_volume, "
        "/scenes/0/extensions/FB_geometry_metadata/sceneBounds and 3 more"], 6])
    asset = glb_split(run.read("out.glb"))[0]
    equal([asset["scenes"], asset["nodes"], asset["extras"], asset["meshes"][0]["extras"]],
          [made.asset["scenes"], made.asset["nodes"], made.asset["extras"], made.asset["meshes"][0]["extras"]])


@case
def bounds_of_what_stays_are_not_named(run):
    """Of another node and mesh, of materials, and values that hold no numbers or that glTF itself defines."""
    made = two(materials=[{"extras": {"bounds": BOX}}])
    made.asset["nodes"][2]["extras"] = {"bounds": BOX}
    made.asset["meshes"][1]["extras"] = {"bounds": BOX}
    made.asset["nodes"][1] |= {"bounds": BOX, "extras": {"hasBounds": True, "boundsOf": "mesh", "bound": 3}}
    equal(deformed(run, made), ([], None))
    made.asset["meshes"][0]["extras"] = {"bounds": BOX}
    equal(deformed(run, made), (one("/meshes/0/extras/bounds"), 1))
    still = {**SHIFT, "moves": [{"by": [0, 0, 0]}]}
    equal(deformed(run, made, moves=still), ([], None), "nothing moves")
    equal(deformed(run, made, out="out.obj"), ([], None), "an OBJ has no extras")


@case
def default_weights_decide_what_is_shown(run):
    """A new morph target does not show, one that replaces a target of weight 1 does; so does a target in reach of the lattice
    whose base is out of it."""
    made = two()
    made.asset["meshes"][0]["extras"] = {"bounds": BOX}
    equal(deformed(run, made, "--as-morph", "new"), ([], None))
    mesh = made.asset["meshes"][0]
    mesh["primitives"][0]["targets"] = [{"POSITION": made.add([[0.0, 0.0, 30.0]] * 2, bounds=True)}]
    mesh["extras"]["targetNames"] = ["old"]
    high = lattice(low=(-10, -10, 20), high=(10, 10, 40), moves=[{"by": [1, 0, 0]}])
    equal(deformed(run, made, moves=high), ([], None), "weight 0")
    mesh["weights"] = [1]
    equal(deformed(run, made, moves=high), (one("/meshes/0/extras/bounds"), 1), "weight 1")
    equal(deformed(run, made, "--as-morph", "new"), ([], None), "a new target")
    equal(deformed(run, made, "--as-morph", "old"), (one("/meshes/0/extras/bounds"), 1), "a target in place of another")
    times = made.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    walk = {"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            "samplers": [{"input": times, "output": made.add([[0.0] * 3] * 2)}], "extras": {"bounds": BOX}}
    made.asset["animations"] = [{"name": "walk", **walk}, {"name": "run", **walk}]
    run.write("in.glb", made.glb())
    done = run.ffd("deform", "in.glb", "out.glb", "--morph", "old=l.json", "--clip", "walk: 0, 1 old=1", "--force", err=anything)
    check("2 values" in lines_with(done, NAMED)[0] and lines_with(done, NAMED)[0].endswith("/animations/1/extras/bounds"),
          "an animation that a clip replaces has no bounds", done.err)


@case
def what_only_selects_decides(run):
    made = two()
    for n, m in ((1, 0), (2, 1)):
        made.asset["nodes"][n]["extras"] = made.asset["meshes"][m]["extras"] = {"bounds": BOX}
    wide = json.loads(json.dumps(SHIFT).replace("-10", "-1000").replace("10,", "1000,").replace("10]", "1000]"))
    equal(deformed(run, made, moves=wide)[1], 4)
    said, count = deformed(run, made, "--only", "node:Far", moves=wide)
    check(count == 2 and "/nodes/2/extras/bounds" in said[0] and "/meshes/1/extras/bounds" in said[0], said, count)


@case
def bounds_of_nodes_in_mesh_space(run):
    """A node shows what the mesh becomes, though the run knows meshes only."""
    made = two()
    for node in made.asset["nodes"]:
        node["extras"] = {"bounds": BOX}
    said, count = deformed(run, made, "--space", "mesh")
    check(count == 2 and "/nodes/0/extras/bounds, /nodes/1/extras/bounds" in said[0], said, count)


@case
def bounds_of_a_node_that_gets_a_copy(run):
    """The mesh keeps its content for the node that is out of reach; the other one shows a copy."""
    made = two()
    made.asset["nodes"][2] |= {"mesh": 0, "translation": [500, 0, 0]}
    for node in made.asset["nodes"][1:]:
        node["extras"] = {"bounds": BOX}
    equal(deformed(run, made), (one("/nodes/1/extras/bounds"), 1))


@case
def bounds_of_nodes_that_follow(run):
    """A socket without a mesh moves with --rig follow only."""
    made = two()
    made.asset["nodes"].append({"name": "Socket", "translation": [1, 1, 0], "extras": {"bounds": BOX}})
    made.asset["scenes"][0]["nodes"].append(3)
    equal(deformed(run, made), ([], None))
    equal(deformed(run, made, "--rig", "follow"), (one("/nodes/3/extras/bounds"), 1))


main()
