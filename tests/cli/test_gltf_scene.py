#!/usr/bin/env python3
"""What a glTF scene shows is what is deformed: skins, morph targets, instances, and which scene it is."""

import json
import random
import re
import struct

from gltf_build import SHEAR, SHIFT, Scene, vectors
from harness import (EMBEDDING, INVALID, NO, OK, UNSUPPORTED, announce, case, check, equal, float32, glb_split,
                     gltf_vectors, lattice, main, near, npy)

announce("off the deformed mesh")


def column_major(linear, offset):
    return [linear[r][c] for c in range(3) for r in (0, 1, 2)][:3] + [0.0] + \
        [linear[r][1] for r in range(3)] + [0.0] + [linear[r][2] for r in range(3)] + [0.0] + list(offset) + [1.0]


TURN = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]  # 90 degrees about z
HALF_TURN = {"rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]}


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
def inverse_bind_matrices_turn(run):
    # x of the scene is -y of the mesh by the matrix, and y by its transpose.
    turn = column_major([[0.0, -1.0, 0], [1.0, 0, 0], [0, 0, 1.0]], [0, 0, 0])
    scene = skinned([[1, 0, 0, 0]], [[1, 0, 0, 0]], bind=[turn, turn])
    near(vectors(deformed(run, scene, SHIFT), 0), [[1, -1, 0]], 1e-6)


@case
def weights_are_divided_by_their_sum(run):
    scene = skinned([[0, 1, 0, 0]] * 2, [[0.5, 0.25, 0, 0], [2, 2, 0, 0]])
    third = 1 / 3
    # x' of the scene by 1: the matrix is 2/3 of the turn and 1/3 of the other.
    linear = [[third, -2 * third], [2 * third, third]]
    det = linear[0][0] ** 2 + linear[1][0] ** 2
    near(vectors(deformed(run, scene, SHIFT, lines=1), 0),
         [[1 + linear[1][1] / det, -linear[1][0] / det, 0], [2, -1, 0]], 1e-6)


@case
def a_vertex_without_an_inverse_stays_and_is_counted(run):
    # Half a turn one way and half the other: nothing is left of x and y.
    nodes = [{"mesh": 0, "skin": 0}, {"rotation": [0, 0, 1, 0]}, {}]
    scene = skinned([[0, 1, 0, 0]] * 3, [[0.5, 0.5, 0, 0], [0.5, 0.5, 0, 0], [1, 0, 0, 0]], nodes=nodes,
                    normals=[[1, 0, 0]] * 3)
    run.write("in.glb", scene.glb())
    done = run.ffd("deform", "in.glb", "out.glb", "-l", run.write("l.json", SHEAR | {"moves": [
        {"rotate": {"axis": "z", "degrees": 10}}]}), "--report", "r.json", lines=1)
    equal(done.err, ["in.glb: 2 vertices do not move: the matrix of their node or skin has no inverse"])
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
    refused(skinned([[0, 2, 0, 0]], [[0.5, 0.5, 0, 0]]), "names joint 2, but the skin has only 2")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["skins"][0]["joints"] = [1, 3]
    refused(scene, "/skins/0/joints/1: there is no node 3, only 3")
    del scene.asset["skins"][0]["joints"]
    refused(scene, "/skins/0: \"joints\" is missing")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["meshes"][0]["primitives"][0]["attributes"]["JOINTS_1"] = 1
    scene.asset["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_1"] = scene.asset["meshes"][0]["primitives"][0]["attributes"].pop("WEIGHTS_0")
    refused(scene, "WEIGHTS_0 is missing")
    refused(skinned([[0, 0, 0, 0]], weights, joint_type=5126), "JOINTS_0 is not a VEC4 of unsigned bytes or shorts")
    scene = skinned([[0, 0, 0, 0]], [[255, 0, 0, 0]], weight_type=5121)
    del scene.asset["accessors"][2]["normalized"]
    refused(scene, "WEIGHTS_0 is not a VEC4 of floats")
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["accessors"][1]["type"] = "VEC3"
    refused(scene, "JOINTS_0 is not a VEC4")
    scene = skinned([[0, 0, 0, 0]], weights, bind=[[1.0] + [0.0] * 14 + [1.0]])
    refused(scene, "has 1 matrix for 2 joints")
    scene.asset["skins"][0]["inverseBindMatrices"] = 77
    refused(scene, "there is no accessor 77")
    scene.asset["skins"][0]["inverseBindMatrices"] = 0
    refused(scene, "accessor 0 is not a MAT4 of floats")
    for bad, message in ((float("nan"), "inverse bind matrix 1 is not finite"), (3.0, "the last row of")):
        rows = [[1.0 if i % 5 == 0 else 0.0 for i in range(16)] for _ in range(2)]
        rows[1][0 if bad != bad else 15] = bad
        refused(skinned([[0, 0, 0, 0]], weights, bind=rows), message)
    scene = skinned([[0, 0, 0, 0]], weights)
    scene.asset["nodes"][1] = {"scale": [1e300, 1, 1], "children": [2]}
    scene.asset["nodes"][2]["scale"] = [1e300, 1, 1]
    scene.asset["scenes"] = [{"nodes": [0]}]
    refused(scene, "/nodes/2: the joint's matrix is not finite")


def morphed(targets, points=None, **attributes):
    """A mesh of points with morph targets: each a dict of a semantic's rows or of the number of an accessor."""
    scene = Scene(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}])
    points = points or [[1.0, 2.0, 0.0], [2.0, -4.0, 1.0]]
    numbers = {"POSITION": scene.add(points, bounds=True)}
    for name, rows in attributes.items():
        numbers[name] = scene.add(rows, shape="VEC4" if name == "TANGENT" else "VEC3")
    scene.targets = [{name: rows if isinstance(rows, int) else scene.add(rows, bounds=name == "POSITION")
                      for name, rows in target.items()} for target in targets]
    scene.asset["meshes"] = [{"primitives": [{"attributes": numbers, "targets": scene.targets, "mode": 0}],
                              "weights": [0.5] * len(targets)}]
    return scene


def sheared(p):
    return [p[0] + 0.05 * p[0] * p[1], p[1], p[2]]


def offset(p, m):
    return [b - a for a, b in zip(sheared(p), sheared([a + b for a, b in zip(p, m)]))]


@case
def base_and_target_are_deformed_each_on_its_own(run):
    points, offsets = [[1.0, 2.0, 0.0], [2.0, -4.0, 1.0]], [[0.0, 3.0, 1.0], [-1.0, 0.5, 0.0]]
    scene = morphed([{"POSITION": offsets}], points)
    out = deformed(run, scene, SHEAR)
    asset, data = glb_split(out)
    near(gltf_vectors(asset, data, 0), [sheared(p) for p in points], 1e-6)
    expected = [offset(p, m) for p, m in zip(points, offsets)]
    found = gltf_vectors(asset, data, 1)
    near(found, expected, 1e-6)
    equal(asset["accessors"][1]["min"], [min(m[a] for m in found) for a in range(3)])
    equal(asset["accessors"][1]["max"], [max(m[a] for m in found) for a in range(3)])
    # Nothing else is another, whatever the weights.
    scene.asset["meshes"][0]["weights"] = [1.0]
    equal(glb_split(deformed(run, scene, SHEAR))[1], data)


@case
def offsets_that_stay_keep_their_bits(run):
    # -0 in all of them, 1e-30 beside a coordinate that changes, and a vertex that no control point moves.
    points = [[1.0, 2.0, 0.0], [1.0, 2.0, 0.5], [50.0, 0.0, 0.0]]
    offsets = [[-0.0, -0.0, -0.0], [-0.0, 3.0, 1e-30], [1.0, -0.0, 3e-40]]
    scene = morphed([{"POSITION": offsets, "NORMAL": [[-0.0] * 3] * 3}], points, NORMAL=[[0.0, 0.0, 1.0]] * 3)
    before = glb_split(scene.glb())
    after = glb_split(deformed(run, scene, SHEAR, lines=2))
    old, new = gltf_vectors(*before, 2), gltf_vectors(*after, 2)
    equal(repr(new[0]), repr(old[0]))
    equal(repr(new[2]), repr(old[2]))
    equal(repr(new[1][1:]), repr(old[1][1:]))
    near([new[1]], [[0.15, 3, 0]], 1e-6)
    # Normals along z are those of the shear everywhere.
    equal(repr(gltf_vectors(*after, 3)), repr(gltf_vectors(*before, 3)))


@case
def normals_and_tangents_of_targets(run):
    points, offsets = [[1.0, 2.0, 0.0]], [[0.0, 3.0, 0.0]]
    normal, turned = [0.6, 0.8, 0.0], [-0.6, -0.8, 1.0]

    def normal_at(p, n):
        # F = [[1 + y/20, x/20, 0], [0, 1, 0], [0, 0, 1]]; cof F.
        c = [n[0], (1 + 0.05 * p[1]) * n[1] - 0.05 * p[0] * n[0], (1 + 0.05 * p[1]) * n[2]]
        length = sum(x * x for x in c) ** 0.5
        return [x / length for x in c]

    def tangent_at(p, t, n):
        c = [(1 + 0.05 * p[1]) * t[0] + 0.05 * p[0] * t[1], t[1], t[2]]
        along = sum(a * b for a, b in zip(c, n))
        c = [a - along * b for a, b in zip(c, n)]
        length = sum(x * x for x in c) ** 0.5
        return [x / length for x in c]

    with_target = [1.0, 5.0, 0.0]
    base, after = normal_at(points[0], normal), normal_at(with_target, [0.0, 0.0, 1.0])
    plain = normal_at(points[0], [0.0, 0.0, 1.0])
    tangent = [0.8, -0.6, 0.0]
    t_base = tangent_at(points[0], tangent, base)
    t_after = tangent_at(with_target, tangent, after)
    t_still = tangent_at(points[0], [0.0, 0.0, 1.0], base)
    targets = [{"POSITION": offsets, "NORMAL": [turned], "TANGENT": [[0.0, 0.0, 0.0]]}, {"NORMAL": [turned]},
               {"TANGENT": [[-0.8, 0.6, 1.0]]}, {"POSITION": offsets}]
    scene = morphed(targets, points, NORMAL=[normal], TANGENT=[[*tangent, -1.0]])
    asset, data = glb_split(deformed(run, scene, SHEAR))

    def found(target, name):
        return gltf_vectors(asset, data, scene.targets[target][name])

    near(found(0, "POSITION"), [offset(points[0], offsets[0])], 1e-6)
    near(found(0, "NORMAL"), [[b - a for a, b in zip(base, after)]], 1e-6)
    near(found(0, "TANGENT"), [[b - a for a, b in zip(t_base, t_after)]], 1e-6)
    near(found(1, "NORMAL"), [[b - a for a, b in zip(base, plain)]], 1e-6)
    near(found(2, "TANGENT"), [[b - a for a, b in zip(t_base, t_still)]], 1e-6)
    near(found(3, "POSITION"), [offset(points[0], offsets[0])], 1e-6)
    keep = glb_split(deformed(run, scene, SHEAR, "--normals", "keep"))
    for target, name in ((0, "NORMAL"), (0, "TANGENT"), (1, "NORMAL")):
        number = scene.targets[target][name]
        equal(gltf_vectors(*keep, number), gltf_vectors(*glb_split(scene.glb()), number))


@case
def targets_under_a_node_without_inverse_stay(run):
    # A mesh that its node shows flat: base and targets stay in all they have.
    scene = morphed([{"POSITION": [[0.0, 3.0, 0.0]], "NORMAL": [[-0.6, -0.8, 1.0]], "TANGENT": [[0.0, 0.5, 0.0]]}],
                    [[1.0, 2.0, 0.0]], NORMAL=[[0.6, 0.8, 0.0]], TANGENT=[[0.8, -0.6, 0.0, -1.0]])
    scene.asset["nodes"][0]["scale"] = [1, 1, 0]
    equal(deformed(run, scene, SHEAR, lines=1), scene.glb())


@case
def offsets_that_are_shared(run):
    # One accessor of offsets for two targets of the same points (one result), and for other points (another).
    scene = morphed([{"POSITION": [[0.0, 3.0, 0.0]] * 2}, {}])
    scene.targets[1]["POSITION"] = shared = scene.targets[0]["POSITION"]
    other = scene.add([[4.0, 4.0, 4.0], [5.0, 5.0, 5.0]], bounds=True)
    scene.asset["meshes"][0]["primitives"].append({"attributes": {"POSITION": other}, "mode": 0,
                                                   "targets": [{"POSITION": shared}, {"POSITION": shared}]})
    out = deformed(run, scene, SHEAR)
    asset, data = glb_split(out)
    equal(len(asset["accessors"]), 4)
    first, second = [[t["POSITION"] for t in p["targets"]] for p in asset["meshes"][0]["primitives"]]
    equal((first, second), ([shared, shared], [3, 3]))
    near(gltf_vectors(asset, data, shared), [offset([1, 2, 0], [0, 3, 0]), offset([2, -4, 1], [0, 3, 0])], 1e-6)
    near(gltf_vectors(asset, data, 3), [offset([4, 4, 4], [0, 3, 0]), offset([5, 5, 5], [0, 3, 0])], 1e-6)
    # What is positions here and offsets there.
    scene = morphed([{"POSITION": 0}])
    asset, data = glb_split(deformed(run, scene, SHEAR))
    primitive = asset["meshes"][0]["primitives"][0]
    equal(sorted([primitive["attributes"]["POSITION"], primitive["targets"][0]["POSITION"]]), [0, 1])
    near(gltf_vectors(asset, data, primitive["targets"][0]["POSITION"]),
         [offset(p, p) for p in ([1, 2, 0], [2, -4, 1])], 1e-6)


@case
def a_mesh_under_two_nodes_and_its_targets(run):
    scene = morphed([{"POSITION": [[0.0, 3.0, 0.0]] * 2}])
    scene.asset["nodes"].append({"mesh": 0, "translation": [4, 0, 0]})
    scene.asset["scenes"][0]["nodes"].append(1)
    asset, data = glb_split(deformed(run, scene, SHEAR))
    for node, x in ((0, 0), (1, 4)):
        primitive = asset["meshes"][asset["nodes"][node]["mesh"]]["primitives"][0]
        near(gltf_vectors(asset, data, primitive["targets"][0]["POSITION"]),
             [offset([1 + x, 2, 0], [0, 3, 0]), offset([2 + x, -4, 1], [0, 3, 0])], 1e-6)


@case
def targets_under_a_skin(run):
    scene = skinned([[0, 0, 0, 0], [1, 0, 0, 0]], [[1, 0, 0, 0]] * 2)
    scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": scene.add([[0.0, 1.0, 2.0]] * 2)}]
    number = scene.asset["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
    out = glb_split(deformed(run, scene, SHEAR))
    # (1,0,0) and (1,1,2) stand at (0,1,0) and (-1,1,2); at (1,2,0) and (1,3,2).
    near(gltf_vectors(*out, number), [[0, 1 + 0.05, 2], [0.05, 1, 2]], 1e-6)


@case
def offsets_without_bytes_and_sparse_ones(run):
    points = [[1.0, 2.0, 0.0], [2.0, -4.0, 1.0]]
    scene = morphed([{"NORMAL": [[0.0] * 3] * 2, "POSITION": [[0.0, 3.0, 0.0], [0.0] * 3]}], points,
                    NORMAL=[[0.6, 0.8, 0.0]] * 2)
    normals, positions = scene.targets[0]["NORMAL"], scene.targets[0]["POSITION"]
    whole = glb_split(deformed(run, scene, SHEAR))
    accessors = scene.asset["accessors"]
    del accessors[normals]["bufferView"]
    values = accessors[positions].pop("bufferView")
    scene.data += struct.pack("<I", 0)
    scene.asset["bufferViews"].append({"buffer": 0, "byteOffset": len(scene.data) - 4, "byteLength": 1})
    accessors[positions]["sparse"] = {"count": 1, "values": {"bufferView": values}, "indices": {
        "bufferView": len(scene.asset["bufferViews"]) - 1, "componentType": 5121}}
    asset, data = glb_split(deformed(run, scene, SHEAR))
    target = asset["meshes"][0]["primitives"][0]["targets"][0]
    equal(gltf_vectors(asset, data, target["POSITION"]), gltf_vectors(*whole, positions))
    equal(gltf_vectors(asset, data, target["NORMAL"]), gltf_vectors(*whole, normals))
    check(gltf_vectors(*whole, normals)[0] != [0.0] * 3, "the first normal's offset stays")
    check("bufferView" not in asset["accessors"][normals], "the old accessor has changed")


@case
def inside_and_outside(run):
    # The target takes the first vertex out of the box, and the second into it.
    points, offsets = [[1.0, 1.0, 0.0], [20.0, 1.0, 0.0]], [[20.0, 0.0, 0.0], [-19.0, 0.0, 0.0]]
    scene = morphed([{"POSITION": offsets}], points)
    run.write("in.glb", scene.glb())
    run.write("l.json", SHIFT)
    done = run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", lines=2)
    check(done.err[1] == "in.glb: morph targets move 1 vertex outside the lattice (left where it is)", done.err)
    near(vectors(run.read("out.glb"), 1), [[19, 0, 0], [-18, 0, 0]], 1e-6)
    run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", "--outside", "extend", lines=2)
    near(vectors(run.read("out.glb"), 1), [[20, 0, 0], [-19, 0, 0]], 1e-6)
    scene = morphed([{"POSITION": offsets[:1] * 2}], points[:1] * 2)
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "no.glb", "-l", "l.json", "--outside", "error", code=EMBEDDING,
            err=re.compile("morph targets move vertices outside the lattice, the first is vertex 0"))
    run.ffd("check", "in.glb", "-l", "l.json", "--fail-on", "outside", code=NO, lines=1)


@case
def broken_targets_are_refused(run):
    run.write("l.json", SHIFT)

    def refused(scene, message):
        run.write("in.glb", scene.glb())
        run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", code=INVALID, err=re.compile(message))
        check(not run.exists("out.glb"), "an output")

    refused(morphed([{"POSITION": [[0.0] * 3] * 3}]), "/meshes/0/primitives/0/targets.*has 3 elements, .* has 2")
    refused(morphed([{}, {"POSITION": 9}]), "there is no accessor 9")
    scene = morphed([{}, {"POSITION": [[1.0, 1.0, 1.0], [float("inf"), 0.0, 0.0]]}])
    for bound in ("min", "max"):
        del scene.asset["accessors"][1][bound]
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "kept.glb", "-l", "l.json",
            err=lambda said: check(any("morph targets move 1 vertex to coordinates that are not finite" in line for line in said), said))
    equal(run.read("kept.glb")[-24:], run.read("in.glb")[-24:], "the offsets")
    run.ffd("deform", "in.glb", "kept.glb", "-l", "l.json", "--fail-on", "invalid", "--force", code=NO, lines=1)
    scene = morphed([{"TANGENT": 2}], NORMAL=[[0.0, 0.0, 1.0]] * 2, TANGENT=[[1.0, 0.0, 0.0, 1.0]] * 2)
    refused(scene, "/meshes/0/primitives/0/targets/0/TANGENT: its accessor is not a VEC3")
    huge = 3e38
    scene = morphed([{"POSITION": [[-huge, 0.0, 0.0]] * 2}], [[huge, 0.0, 0.0]] * 2)
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"by": [-1e38, 0, 0]}]))
    refused(scene, "too large for the file's numbers")


def instanced(translations, nodes=(), **attributes):
    """Node 0: one mesh of two points, at the places given and 2 beside them."""
    scene = Scene(nodes=[{"mesh": 0, "name": "many"}, *nodes], scenes=[{"nodes": list(range(1 + len(nodes)))}],
                  extensionsUsed=["EXT_mesh_gpu_instancing"])
    points = scene.add([[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]], bounds=True)
    scene.asset["meshes"] = [{"name": "pair", "primitives": [{"attributes": {"POSITION": points}, "mode": 0}]}]
    scene.attributes = {"TRANSLATION": scene.add(translations), **attributes}
    scene.asset["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": scene.attributes}}
    return scene


def refused_instances(run, scene, *options, box=SHIFT):
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "no.glb", "-l", run.write("l.json", box), *options, code=UNSUPPORTED,
            err=re.compile("/nodes/0/extensions/EXT_mesh_gpu_instancing: EXT_mesh_gpu_instancing is not supported "
                           "where the lattice reaches the instances"))
    check(not run.exists("no.glb"), "an output")


LEFT = "in.glb: 1 node with EXT_mesh_gpu_instancing is out of the lattice's reach: left as it is"


@case
def instances_in_the_lattice_are_refused(run):
    refused_instances(run, instanced([[0.0, 0.0, 0.0]]))
    refused_instances(run, instanced([[50.0, 0.0, 0.0], [11.0, 0.0, 0.0], [-11.5, 0.0, 0.0]]))
    refused_instances(run, instanced([[50.0, 0.0, 0.0]]), box=lattice(rest={"box": "mesh"}, moves=[{"by": [1, 0, 0]}]))
    refused_instances(run, instanced([[50.0, 0.0, 0.0]]), "--outside", "extend")
    refused_instances(run, instanced([[15.0, 0.0, 0.0]]), "--outside", "extend", "--falloff", "6")
    far = instanced([[11.0, 0.0, 0.0]])
    far.asset["nodes"][0]["scale"] = [0.5, 1, 1]
    refused_instances(run, far)
    far = instanced([[11.0, 0.0, 0.0]])
    far.attributes["SCALE"] = far.add([[-1.0, 1.0, 1.0]])
    refused_instances(run, far)
    far = instanced([[11.0, 0.0, 0.0]])
    far.attributes["ROTATION"] = far.add([[0, 0, 127, 0]], 5120, "VEC4", normalized=True)
    refused_instances(run, far)
    far = instanced([[50.0, 0.0, 0.0]])
    far.asset["nodes"][0]["skin"] = 0
    far.asset["skins"] = [{"joints": [0]}]
    joints, weights = far.add([[0, 0, 0, 0]] * 2, 5121, "VEC4"), far.add([[1.0, 0, 0, 0]] * 2, shape="VEC4")
    far.asset["meshes"][0]["primitives"][0]["attributes"] |= {"JOINTS_0": joints, "WEIGHTS_0": weights}
    refused_instances(run, far)
    far = instanced([[50.0, 0.0, 0.0]])
    far.asset["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {}
    refused_instances(run, far)
    run.ffd("lattice", "new", "in.glb", "-o", "new.json", code=UNSUPPORTED)
    run.ffd("check", "in.glb", "-l", "l.json", code=UNSUPPORTED)
    run.ffd("info", "in.glb", "--json")


@case
def instances_out_of_reach_are_left_alone(run):
    scene = instanced([[11.0, 0.0, 0.0], [-13.0, 0.0, 0.0]])
    run.write("in.glb", scene.glb())
    run.write("l.json", SHIFT)
    run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", err=["in.glb: there are no vertices to deform", LEFT])
    equal(run.read("out.glb"), run.read("in.glb"))
    run.ffd("deform", "in.glb", "out.obj", "-l", "l.json", code=UNSUPPORTED,
            err=["in.glb: there are no vertices to deform", "in.glb:/nodes/0: instances of EXT_mesh_gpu_instancing cannot be converted"])
    # The same mesh under nodes without instances: a copy of it.
    for nodes in ([{"mesh": 0}, {"mesh": 0, "translation": [100, 0, 0]}],):
        scene = instanced([[11.0, 0.0, 0.0]], nodes)
        run.write("in.glb", scene.glb())
        done = run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", "--report", "r.json", lines=2)
        check(LEFT in done.err, done.err)
        equal(done.announced, ["in.glb: 1 node gets a copy of its mesh, which is deformed differently under other nodes"])
        asset, data = glb_split(run.read("out.glb"))
        equal([node["mesh"] for node in asset["nodes"]], [0, 1, 0])
        near(gltf_vectors(asset, data, asset["meshes"][1]["primitives"][0]["attributes"]["POSITION"]),
             [[1, 0, 0], [3, 1, 0]], 1e-6)
        equal(gltf_vectors(asset, data, 0), [[0, 0, 0], [2, 1, 0]])
        job = json.loads(run.text("r.json"))["jobs"][0]
        equal((job["vertices"], job["moved"], job["outside"]), (4, 2, 2))
    # u,v,w of all that is shown.
    run.ffd("embed", "in.glb", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", lines=1)
    equal(npy(run.read("s.npy"))[2], [1, 1, 0, 0, 1, 1])
    run.ffd("deform", "in.glb", "again.glb", "-l", "l.json", "--embedding", "e.npy", lines=2)
    equal(run.read("again.glb"), run.read("out.glb"))


@case
def instances_and_selection(run):
    scene = instanced([[0.0, 0.0, 0.0]], [{"mesh": 0, "name": "one"}, {"mesh": 1, "name": "other"}])
    scene.asset["meshes"].append({"name": "single", "primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]})
    run.write("in.glb", scene.glb())
    run.write("l.json", SHIFT)
    for only, meshes in (("node:one", [0, 2, 1]), ("mesh:single", [0, 0, 1])):
        run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", "--only", only, lines=1)
        asset, _ = glb_split(run.read("out.glb"))
        equal([node["mesh"] for node in asset["nodes"]], meshes, only)
        check(run.read("out.glb") != run.read("in.glb"), "nothing is moved by", only)
    for only in ("node:many", "mesh:pair"):
        refused_instances(run, scene, "--only", only)


@case
def instances_in_mesh_space_and_broken_ones(run):
    scene = instanced([[0.0, 0.0, 0.0]])
    near(vectors(deformed(run, scene, SHIFT, "--space", "mesh"), 0), [[1, 0, 0], [3, 1, 0]], 1e-6)
    for attributes, message in (({"TRANSLATION": 9}, "is not the number of an accessor, of which there are 2"),
                                ({"ROTATION": 1}, "accessor 1 is not a VEC4"),
                                ({"TRANSLATION": 0, "SCALE": 1}, "accessor 1 has 1 element, another attribute has 2"),
                                ({"SCALE": "1"}, "is not the number")):
        scene.asset["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes
        run.write("in.glb", scene.glb())
        run.ffd("deform", "in.glb", "no.glb", "-l", "l.json", code=INVALID, err=re.compile(message))


@case
def the_scene_that_is_shown(run):
    def places(scene, **expected):
        run.write("in.glb", scene.glb())
        run.write("l.json", SHIFT)
        run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", **expected)
        asset, data = glb_split(run.read("out.glb"))
        return [gltf_vectors(asset, data, mesh["primitives"][0]["attributes"]["POSITION"])[0][0]
                for mesh in asset["meshes"]]

    def three_meshes(**members):
        scene = Scene(nodes=[{"mesh": 0}, {"mesh": 1, "children": [2]}, {"mesh": 2}], **members)
        scene.asset["meshes"] = [{"primitives": [{"attributes": {
            "POSITION": scene.add([[float(i), 0.0, 0.0]], bounds=True)}, "mode": 0}]} for i in range(3)]
        return scene

    one = "in.glb: 1 node with a mesh is not in the displayed scene: left as it is"
    two = "in.glb: 2 nodes with a mesh are not in the displayed scene: left as they are"
    near(places(three_meshes()), [1, 2, 3], 1e-6)
    near(places(three_meshes(scenes=[])), [1, 2, 3], 1e-6)
    near(places(three_meshes(scenes=[{"nodes": [1]}, {"nodes": [0]}]), err=one), [0, 2, 3], 1e-6)
    near(places(three_meshes(scenes=[{"nodes": [1]}, {"nodes": [0]}], scene=1), err=two), [1, 1, 2], 1e-6)
    near(places(three_meshes(scenes=[{}, {"nodes": [0, 1]}], scene=1)), [1, 2, 3], 1e-6)
    scene = three_meshes(scenes=[{"nodes": [0]}])
    scene.asset["nodes"] = [{"mesh": 0}]
    near(places(scene, err="in.glb: 2 meshes are not used by any node: left as they are"), [1, 1, 2], 1e-6)
    # All of them in mesh space.
    run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", "--space", "mesh")
    equal([v[0][0] for v in (vectors(run.read("out.glb"), i) for i in range(3))], [1, 2, 3])
    # A mesh that another scene shows too keeps its content there.
    scene = three_meshes(scenes=[{"nodes": [0]}, {"nodes": [1]}])
    scene.asset["nodes"][1]["mesh"] = 0
    near(places(scene, lines=2), [0, 1, 2, 1], 1e-6)
    # Nothing is shown: nothing changes.
    scene = three_meshes(scenes=[{}])
    places(scene, lines=2)
    equal(run.read("out.glb"), run.read("in.glb"))


# Symmetric about x = 0; in binary64 the two halves round differently.
BENT_ALIKE = lattice(size=(5, 4, 5), low=(-1.1, -1.1, -1.1), high=(1.1, 1.1, 1.1),
                     moves=[{"taper": {"axis": "y", "factor": 0.5}}, {"bend": {"axis": "y", "toward": [0, 0, 1], "degrees": 35}}])


def half(nodes, roots, **members):
    """Points of which some are on x = 0, and a target that moves them."""
    scene = Scene(nodes=nodes, scenes=[{"nodes": roots}])
    numbers = random.Random(11)
    points = [[numbers.choice([0, numbers.random()]), numbers.uniform(-1, 1), numbers.uniform(-1, 1)] for _ in range(500)]
    primitive = {"attributes": {"POSITION": scene.add(points, bounds=True)}, "mode": 0,
                 "targets": [{"POSITION": scene.add([[p[0] / 50, p[1] / 50, 0] for p in points], bounds=True)}]}
    scene.asset["meshes"] = [{"primitives": [primitive], **members}]
    return scene


PLAIN, MIRRORED = {"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]}


@case
def a_mirrored_half_keeps_its_mesh(run):
    """And the first node of the scene gives the bits, which it has alone too."""
    alone = {}
    for name, node in (("right", PLAIN), ("left", MIRRORED)):
        alone[name] = [vectors(deformed(run, half([node], [0]), BENT_ALIKE), i) for i in (0, 1)]
    check(alone["right"] != alone["left"], "the halves round alike: nothing is tried")
    for nodes, roots, first in (([PLAIN, MIRRORED], [0, 1], "right"), ([MIRRORED, PLAIN], [0, 1], "left"),
                                ([PLAIN, MIRRORED], [1, 0], "left"), ([{"children": [2, 1]}, PLAIN, MIRRORED], [0], "left")):
        out = deformed(run, half(nodes, roots), BENT_ALIKE)
        asset = glb_split(out)[0]
        equal([len(asset["meshes"]), asset["nodes"]], [1, nodes], first)
        equal([vectors(out, i) for i in (0, 1)], alone[first], f"{nodes}: the bits of the {first} half")


@case
def a_flat_mirrored_half_keeps_its_mesh(run):
    """Flat at 0 along an axis, or as a whole on x = 0: there the results are rounding alone, and differ in all their digits."""
    numbers = random.Random(5)
    taper, rotate = {"taper": {"axis": "y", "factor": 0.5}}, {"rotate": {"axis": "x", "degrees": 30}}
    twist = {"twist": {"axis": "y", "degrees": 360}}
    for flat in (0, 1, 2):
        points = [[0 if a == flat else numbers.choice([0, numbers.random()]) for a in range(3)] for _ in range(60)]
        for move, mirror, parent in ((taper, [-1, 1, 1], {}), (rotate, [-1, 1, 1], {}), (twist, [-1, 1, -1], {}),
                                     (twist, [-1, 1, -1], {"rotation": [0, 0.6, 0, 0.8]})):
            scene = Scene(nodes=[PLAIN, PLAIN | {"scale": mirror}, {"children": [0, 1]} | parent], scenes=[{"nodes": [2]}])
            scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add(points, bounds=True)}, "mode": 0}]}]
            out = deformed(run, scene, lattice(size=(6, 6, 6), low=(-2, -2, -2), high=(2, 2, 2), moves=[move]))
            equal(len(glb_split(out)[0]["meshes"]), 1, f"flat along {flat}: {move}, {parent}")
            if move == rotate:
                near([p[0] for p in vectors(out, 0)], [p[0] for p in points], 1e-7)


@case
def what_differs_by_more_gets_a_copy_as_before(run):
    """Of two mirrored pairs the second stands elsewhere: it shares one copy."""
    shift = {"translation": [0, 0.05, 0]}
    out = deformed(run, half([PLAIN, PLAIN | shift, MIRRORED | shift, MIRRORED], [3, 2, 1, 0]), BENT_ALIKE)
    asset = glb_split(out)[0]
    equal([len(asset["meshes"]), [node["mesh"] for node in asset["nodes"]]], [2, [0, 1, 1, 0]])
    alone = deformed(run, half([MIRRORED | shift], [0]), BENT_ALIKE)
    equal(vectors(out, asset["meshes"][1]["primitives"][0]["attributes"]["POSITION"]), vectors(alone, 0))


@case
def one_ulp_is_shared_and_two_are_not(run):
    """The second node stands a little higher, where the shear moves more."""
    def scene(heights):
        made = Scene(nodes=[{"mesh": 0, "translation": [0, y, 0]} for y in heights],
                     scenes=[{"nodes": list(range(len(heights)))}])
        made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add([[1, 1, 0]], bounds=True)}, "mode": 0}]}]
        return made

    ulp = 2.0 ** -23  # of 1.05
    first = vectors(deformed(run, scene([0]), SHEAR), 0)
    for ulps, meshes in ((1, 1), (2, 2)):
        height = ulps * ulp / 0.05
        equal(vectors(deformed(run, scene([height]), SHEAR), 0)[0][0] - first[0][0], ulps * ulp, "the nodes' own results")
        out = deformed(run, scene([0, height]), SHEAR)
        equal([len(glb_split(out)[0]["meshes"]), vectors(out, 0)], [meshes, first], f"{ulps} ulp apart")


@case
def each_coordinate_counts_by_its_own_ulp(run):
    """A mesh far along x, whose ulp is 1/16 there; that of z is next to nothing."""
    def scene(points, order):
        made = Scene(nodes=[{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 10]}], scenes=[{"nodes": order}])
        made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(points, bounds=True)}, "mode": 0}]}]
        return made

    def places(out):
        asset = glb_split(out)[0]
        return [vectors(out, asset["meshes"][node["mesh"]]["primitives"][0]["attributes"]["POSITION"])
                for node in asset["nodes"]]

    lifted = lattice(low=(999999, -10, 9), high=(1000002, 10, 11), moves=[{"by": [0, 0, 0.05]}])
    far = [[1000000.0, 0.0, 0.0], [1000001.0, 0.0, 0.0], [1000000.0, 1.0, 0.0]]
    float_005 = float32(0.05)
    sheared = lattice(low=(0, -10, -1), high=(2000, 10, 11), size=(2, 2, 2),
                      moves=[{"at": ["all", "all", 1], "by": [0, 2e-5, 0]}])
    near_zero = [[1000.0, 0.001, 0.0], [1001.0, 0.0, 0.0], [1000.0, 1.0, 0.0]]
    step = 2.0 ** -23  # an ulp of 1
    lifted_a_step = lattice(low=(0, 0, 10), high=(2, 2, 12), moves=[{"by": [0, 0, step]}])
    for order in ([0, 1], [1, 0]):
        found = places(deformed(run, scene([[1.0, 1.0, 1.0]], order), lifted_a_step, lines=1))
        equal(found, [[[1, 1, 1]], [[1, 1, 1 + step]]], f"{order}: what is outside keeps its bits")
        kept, moved = places(deformed(run, scene(far, order), lifted, lines=1))
        equal([kept, moved], [far, [[x, y, float_005] for x, y, _ in far]], f"{order}: one stays, one moves")
        low, high = places(deformed(run, scene(near_zero, order), sheared))
        near([low[0][1] - 0.001, high[0][1] - 0.001], [2e-5 / 12, 2e-5 * 11 / 12], 1e-9, f"{order}: both move")


@case
def a_mirrored_half_in_a_large_lattice_keeps_its_mesh(run):
    """Both halves under a node that is far away and turned; a lattice fifty times their size."""
    parent = {"children": [1, 2], "translation": [300, -20, 70], "rotation": [0, 0, 0.6, 0.8]}
    bent = lattice(size=(5, 4, 5), low=(200, -70, 20), high=(400, 30, 120),
                   moves=[{"at": [2, "all", "all"], "by": [0.5, 1, 3]}, {"twist": {"axis": "z", "degrees": 5}}])
    alike = lattice(size=(5, 4, 5), low=(-55, -55, -55), high=(55, 55, 55), moves=[{"taper": {"axis": "y", "factor": 0.5}}])
    out = deformed(run, half([PLAIN, MIRRORED], [0, 1]), alike)
    equal(len(glb_split(out)[0]["meshes"]), 1, "symmetric about x = 0")
    out = deformed(run, half([parent, PLAIN, MIRRORED], [0]), bent)
    equal(len(glb_split(out)[0]["meshes"]), 2, "not symmetric")
    moved = lattice(low=(200, -70, 20), high=(400, 30, 120), moves=[{"by": [0.1, 0.2, 0.3]}])
    out = deformed(run, half([parent, PLAIN, PLAIN | {"translation": [1, 1, 1]}], [0]), moved)
    equal(len(glb_split(out)[0]["meshes"]), 1, "moved alike at two places")


@case
def a_half_that_is_not_selected_keeps_its_bits(run):
    run.write("l.json", lattice(low=(-2, -2, -2), high=(2, 2, 2), moves=[{"by": [1e-8, 0, 0]}]))
    scene = half([PLAIN | {"name": "a"}, PLAIN | {"name": "b"}], [0, 1])
    run.write("in.glb", scene.glb())
    run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", "--only", "node:a", "--force")
    asset = glb_split(run.read("out.glb"))[0]
    kept = asset["meshes"][asset["nodes"][1]["mesh"]]["primitives"][0]["attributes"]["POSITION"]
    equal(vectors(run.read("out.glb"), kept), vectors(run.read("in.glb"), 0))


main()
