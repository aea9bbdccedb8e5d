#!/usr/bin/env python3
"""What a glTF scene shows is what is deformed: skins."""

import json
import re
import struct

from harness import (INVALID, OK, case, check, equal, glb, glb_split, gltf_vectors, lattice, main, near)

CODES = {5121: "B", 5123: "H", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
# Everything within 10 of the origin by 1 along x; the volume is an affine map.
SHIFT = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}])
# x' = x + 0.05 x y: what a point gets depends on where it is.
SHEAR = lattice(size=(2, 2, 2), low=(-10, -10, -10), high=(10, 10, 10),
                moves=[{"at": [i, j, "all"], "by": [0.05 * x * y, 0, 0]}
                       for i, x in enumerate((-10, 10)) for j, y in enumerate((-10, 10))])


class Scene:
    """Puts a GLB together."""

    def __init__(self, **members):
        self.data = b""
        self.asset = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], **members}

    def add(self, rows, component=5126, shape="VEC3", bounds=False, **members):
        """A new accessor; its number."""
        accessor = {"componentType": component, "type": shape, "count": len(rows), **members}
        if bounds:
            rows = [[struct.unpack("<f", struct.pack("<f", x))[0] for x in row] for row in rows]
            accessor.update({name: [edge(row[a] for row in rows) for a in range(3)]
                             for name, edge in (("min", min), ("max", max))})
        data = b"".join(struct.pack(f"<{WIDTHS[shape]}{CODES[component]}", *row) for row in rows)
        self.data += b"\0" * (-len(self.data) % 4)
        self.asset["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        self.asset["accessors"].append({"bufferView": len(self.asset["bufferViews"]) - 1, **accessor})
        return len(self.asset["accessors"]) - 1

    def glb(self):
        self.asset["buffers"] = [{"byteLength": len(self.data)}]
        return glb(self.asset, self.data)


def column_major(linear, offset):
    return [linear[r][c] for c in range(3) for r in (0, 1, 2)][:3] + [0.0] + \
        [linear[r][1] for r in range(3)] + [0.0] + [linear[r][2] for r in range(3)] + [0.0] + list(offset) + [1.0]


TURN = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]  # 90 degrees about z
HALF_TURN = {"rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}


def vectors(file, accessor):
    return gltf_vectors(*glb_split(file), accessor)


def skinned(joints, weights, points=None, normals=None, bind=None, weight_type=5126, joint_type=5121, nodes=None,
            **members):
    """Points under a node that is far away, moved by two joints: 1 turned by 90 degrees and 2 at (0, 2, 0)."""
    scene = Scene(nodes=nodes or [{"mesh": 0, "skin": 0, "translation": [500, 0, 0]}, HALF_TURN,
                                  {"translation": [0, 2, 0], "children": []}],
                  skins=[{"joints": [1, 2]}], scenes=[{"nodes": [0, 1, 2]}], **members)
    points = points or [[1.0, 0.0, 0.0]] * len(joints)
    attributes = {"POSITION": scene.add(points, bounds=True)}
    if normals:
        attributes["NORMAL"] = scene.add(normals)
    attributes["JOINTS_0"] = scene.add(joints, joint_type, "VEC4")
    scaled = {"normalized": True} if weight_type != 5126 else {}
    attributes["WEIGHTS_0"] = scene.add(weights, weight_type, "VEC4", **scaled)
    if bind:
        scene.asset["skins"][0]["inverseBindMatrices"] = scene.add(bind, shape="MAT4")
    scene.asset["meshes"] = [{"primitives": [{"attributes": attributes, "mode": 0}]}]
    return scene


def deformed(run, scene, *options, name="in.glb", **expected):
    """The output's bytes."""
    run.write(name, scene.glb())
    run.ffd("deform", name, "out.glb", "--force", "-l", run.write("l.json", options[0]), *options[1:], **expected)
    return run.read("out.glb")


@case
def a_vertex_stands_where_its_joints_put_it(run):
    # By joint 0 (1,0,0) is at (0,1,0) and x of the scene is -y of the mesh; by joint 1 at (1,2,0).
    scene = skinned([[0, 1, 0, 0]] * 3, [[1, 0, 0, 0], [0, 1, 0, 0], [0.5, 0.5, 0, 0]])
    near(vectors(deformed(run, scene, SHIFT), 0), [[1, -1, 0], [2, 0, 0], [2, -1, 0]], 1e-6)
    # The places are (0,1,0), (1,2,0) and (0.5,1.5,0).
    half = 0.05 * 0.5 * 1.5
    near(vectors(deformed(run, scene, SHEAR), 0), [[1, 0, 0], [1.1, 0, 0], [1 + half, -half, 0]], 1e-6)


@case
def joints_outside_the_scene_and_below_others_count(run):
    nodes = [{"mesh": 0, "skin": 0}, {"children": [2], **HALF_TURN}, {"translation": [0, 2, 0]}]
    scene = skinned([[0, 1, 0, 0]] * 2, [[1, 0, 0, 0], [0, 1, 0, 0]], nodes=nodes)
    scene.asset["scenes"] = [{"nodes": [0]}]
    # (1,0,0) by joint 1: at (1,2,0) below the turned one: (-2,1,0).
    near(vectors(deformed(run, scene, SHEAR), 0), [[1, 0, 0], [1, 0.1, 0]], 1e-6)


@case
def inverse_bind_matrices_and_integer_weights(run):
    identity = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
    bind = [column_major([[2.0, 0, 0], [0, 2.0, 0], [0, 0, 2.0]], [0, 0, 0]), column_major(identity, [0, -2, 0])]
    for weight_type, one in ((5121, 255), (5123, 65535)):
        for joint_type in (5121, 5123):
            scene = skinned([[0, 0, 0, 0], [1, 0, 0, 0]], [[one, 0, 0, 0]] * 2, bind=bind, weight_type=weight_type,
                            joint_type=joint_type)
            near(vectors(deformed(run, scene, SHIFT), 0), [[1, -0.5, 0], [2, 0, 0]], 1e-6)


@case
def weights_are_divided_by_their_sum(run):
    scene = skinned([[0, 1, 0, 0]] * 2, [[0.5, 0.25, 0, 0], [2, 2, 0, 0]])
    third = 1 / 3
    # x' of the scene by 1: the matrix is 2/3 of the turn and 1/3 of the other.
    linear = [[third, -2 * third], [2 * third, third]]
    det = linear[0][0] ** 2 + linear[1][0] ** 2
    near(vectors(deformed(run, scene, SHIFT), 0),
         [[1 + linear[1][1] / det, -linear[1][0] / det, 0], [2, -1, 0]], 1e-6)


@case
def a_vertex_without_an_inverse_stays_and_is_counted(run):
    # Half a turn one way and half the other: nothing is left of x and y. And no weight at all.
    nodes = [{"mesh": 0, "skin": 0}, {"rotation": [0, 0, 1, 0]}, {}]
    scene = skinned([[0, 1, 0, 0]] * 3, [[0.5, 0.5, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0]], nodes=nodes,
                    normals=[[1, 0, 0]] * 3)
    run.write("in.glb", scene.glb())
    done = run.ffd("deform", "in.glb", "out.glb", "-l", run.write("l.json", SHEAR | {"moves": [
        {"rotate": {"axis": "z", "degrees": 10}}]}), "--report", "r.json", lines=1)
    equal(done.err, ["in.glb: 2 vertices stay: their node's or skin's matrix has no inverse"])
    out = run.read("out.glb")
    equal(vectors(out, 0)[:2], [[1, 0, 0]] * 2)
    equal(vectors(out, 1)[:2], [[1, 0, 0]] * 2)
    near(vectors(out, 1)[2], [0.98480775, 0.17364818, 0], 1e-6)
    equal(json.loads(run.text("r.json"))["jobs"][0]["moved"], 1)


@case
def normals_go_there_and_back(run):
    # The scene is stretched along its x; joint 0 turns the mesh's y onto -x.
    stretch = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"scale": {"factor": [2, 1, 1]}}])
    diagonal = [0.6, 0.8, 0.0]
    scene = skinned([[0, 0, 0, 0], [1, 0, 0, 0]], [[1, 0, 0, 0]] * 2, normals=[diagonal] * 2)
    length = [(0.6 ** 2 + 0.4 ** 2) ** 0.5, (0.3 ** 2 + 0.8 ** 2) ** 0.5]
    near(vectors(deformed(run, scene, stretch), 1),
         [[0.6 / length[0], 0.4 / length[0], 0], [0.3 / length[1], 0.8 / length[1], 0]], 1e-6)


@case
def the_order_of_the_joints_changes_no_bit(run):
    weights = [[0.1, 0.7, 0.2, 0], [0.2, 0.1, 0.7, 0]]
    scene = skinned([[0, 1, 2, 0], [2, 0, 1, 0]], weights, points=[[0.3, 0.7, 0.9]] * 2)
    scene.asset["nodes"].append({"rotation": [0.5, 0.5, 0.5, 0.5], "translation": [0.3, 0.1, 0.7]})
    scene.asset["skins"][0]["joints"].append(3)
    first, second = vectors(deformed(run, scene, SHEAR), 0)
    equal(first, second)
    check(first != [0.3, 0.7, 0.9], "nothing moved")


@case
def two_skins_of_one_mesh_need_a_copy(run):
    scene = skinned([[0, 0, 0, 0]], [[1, 0, 0, 0]])
    scene.asset["nodes"] += [{"mesh": 0, "skin": 1}, {"mesh": 0}, {"mesh": 0, "skin": 0, "scale": [3, 3, 3]}]
    scene.asset["skins"].append({"joints": [2]})
    scene.asset["scenes"][0]["nodes"] += [3, 4, 5]
    out = deformed(run, scene, SHEAR)
    asset, data = glb_split(out)
    places = [gltf_vectors(asset, data, asset["meshes"][asset["nodes"][n]["mesh"]]["primitives"][0]["attributes"]
                           ["POSITION"])[0] for n in (0, 3, 4, 5)]
    near(places, [[1, 0, 0], [1.1, 0, 0], [1, 0, 0], [1, 0, 0]], 1e-6)
    equal(len(asset["meshes"]), 2)


@case
def a_second_set_of_joints(run):
    scene = skinned([[0, 0, 0, 0]], [[0.5, 0, 0, 0]])
    attributes = scene.asset["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_1"] = scene.add([[1, 0, 0, 0]], 5121, "VEC4")
    attributes["WEIGHTS_1"] = scene.add([[0.5, 0, 0, 0]], 5126, "VEC4")
    near(vectors(deformed(run, scene, SHIFT), 0), [[2, -1, 0]], 1e-6)


@case
def one_position_accessor_with_other_joints_in_each_primitive(run):
    scene = skinned([[0, 0, 0, 0]], [[1, 0, 0, 0]])
    primitives = scene.asset["meshes"][0]["primitives"]
    primitives.append({"attributes": dict(primitives[0]["attributes"]), "mode": 0})
    primitives[1]["attributes"]["JOINTS_0"] = scene.add([[1, 0, 0, 0]], 5121, "VEC4")
    asset, data = glb_split(deformed(run, scene, SHIFT))
    near([gltf_vectors(asset, data, p["attributes"]["POSITION"])[0] for p in asset["meshes"][0]["primitives"]],
         [[1, -1, 0], [2, 0, 0]], 1e-6)


@case
def mesh_space_and_boxes_of_the_mesh(run):
    scene = skinned([[0, 0, 0, 0], [1, 0, 0, 0]], [[1, 0, 0, 0]] * 2, points=[[1.0, 0, 0], [3.0, 1.0, 1.0]])
    near(vectors(deformed(run, scene, SHIFT, "--space", "mesh"), 0), [[2, 0, 0], [4, 1, 1]], 1e-6)
    run.write("in.glb", scene.glb())
    run.ffd("lattice", "new", "in.glb", "-o", "box.json", "--margin", "0", "--size", "2,2,2")
    box = json.loads(run.text("box.json"))["rest"]["box"]
    near([box["min"], box["max"]], [[0, 1, 0], [3, 3, 1]], 1e-6)
    # An embedding of the posed vertices, and a job that reuses it.
    run.write("l.json", SHEAR)
    run.ffd("embed", "in.glb", "-l", "l.json", "-o", "e.npy")
    run.ffd("deform", "in.glb", "a.glb", "-l", "l.json")
    run.ffd("deform", "in.glb", "b.glb", "-l", "l.json", "--embedding", "e.npy")
    equal(run.read("a.glb"), run.read("b.glb"))
    scene.asset["nodes"][1] = {}
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "c.glb", "-l", "l.json", "--embedding", "e.npy", code=INVALID,
            err=re.compile("was made for another mesh"))


@case
def broken_skins_are_refused(run):
    weights = [[1, 0, 0, 0]]

    def refused(scene, message):
        run.write("in.glb", scene.glb())
        run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", code=INVALID, err=re.compile(message))
        check(not run.exists("out.glb"), "an output")
        run.ffd("deform", "in.glb", "mesh.glb", "--force", "-l", "l.json", "--space", "mesh", code=(OK, INVALID))

    run.write("l.json", SHIFT)
    refused(skinned([[0, 2, 0, 0]], weights), "names joint 2, but the skin has only 2")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["skins"][0]["joints"] = [1, 3]
    refused(scene, "/skins/0/joints/1: there is no node 3, only 3")
    del scene.asset["skins"][0]["joints"]
    refused(scene, "/skins/0: \"joints\" is missing")
    scene = skinned([[0, 0, 0, 0]], weights)
    for missing in ("WEIGHTS_0", "JOINTS_0"):
        del scene.asset["meshes"][0]["primitives"][0]["attributes"][missing]
        refused(scene, missing + " is missing" if missing == "WEIGHTS_0" else "it has no JOINTS_0 and WEIGHTS_0")
    refused(skinned([[0, 0, 0, 0]], weights, joint_type=5126), "JOINTS_0 is no VEC4 of unsigned bytes or shorts")
    scene = skinned([[0, 0, 0, 0]], [[255, 0, 0, 0]], weight_type=5121)
    del scene.asset["accessors"][2]["normalized"]
    refused(scene, "WEIGHTS_0 is no VEC4 of floats")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["accessors"][1]["type"] = "VEC3"
    refused(scene, "JOINTS_0 is no VEC4")
    scene = skinned([[0, 0, 0, 0]], weights, bind=[[1.0] + [0.0] * 14 + [1.0]])
    refused(scene, "has 1 matrices for 2 joints")
    scene.asset["skins"][0]["inverseBindMatrices"] = 77
    refused(scene, "there is no accessor 77")
    scene.asset["skins"][0]["inverseBindMatrices"] = 0
    refused(scene, "accessor 0 is no MAT4 of floats")
    for bad, message in ((float("nan"), "inverse bind matrix 1 is not finite"), (3.0, "the last row of")):
        rows = [[1.0 if i % 5 == 0 else 0.0 for i in range(16)] for _ in range(2)]
        rows[1][0 if bad != bad else 15] = bad
        refused(skinned([[0, 0, 0, 0]], weights, bind=rows), message)
    refused(skinned([[0, 0, 0, 0]], [[float("nan"), 0, 0, 0]]), "vertex 0 .* not finite")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["nodes"][1] = {"scale": [1e300, 1, 1], "children": [2]}
    scene.asset["nodes"][2]["scale"] = [1e300, 1, 1]
    scene.asset["scenes"] = [{"nodes": [0]}]
    refused(scene, "/nodes/2: the joint's place is not finite")


main()
