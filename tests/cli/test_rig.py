#!/usr/bin/env python3
"""--rig: with follow, nodes, skins and animations go along with the deformation, and the default pose is the same; with
keep, what lags is said. Poses come from an evaluator of the tests' own (posed.py)."""

import json
import math
import re
import struct

from gltf_build import Scene
from harness import INVALID, LIMIT, USAGE, case, check, equal, lattice, main, near
from posed import Posed, point
from messages import anything, entry, lines_with, no_line, one_line

TIMES = [0, 0.125, 0.25, 0.4, 0.5, 0.75, 0.9, 1.0]


def quaternion(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.sin(half) * x for x in axis] + [math.cos(half)]


def arm(bare=False):
    """Two bones along y below a group: upper at (0, 1, 0), lower at (0, 3, 0), hand (a socket) at (0, 5, 0); a skin over
    both, and a plate without a skin at the hand. Every part of it is animated."""
    made = Scene(scene=0, scenes=[{"nodes": [0]}])
    made.asset["nodes"] = [
        {"name": "root", "children": [1, 5]},
        {"name": "upper", "translation": [0, 1, 0], "children": [2]},
        {"name": "lower", "translation": [0, 2, 0], "children": [3, 4]},
        {"name": "hand", "translation": [0, 2, 0]},
        {"name": "plate", "mesh": 1, "translation": [0.5, 1, 0], "rotation": quaternion([0, 1, 0], 30)},
        {"name": "skinned", "mesh": 0, "skin": 0}]
    column = [[x, y / 2, z] for y in range(2, 11) for x, z in ((-0.25, 0), (0.25, 0), (0, 0.25))]
    weights = [[1 - f, f, 0.0, 0.0] for f in (min(1, max(0, y - 2.5)) for _, y, _ in column)]
    attributes = {"POSITION": made.add(column, bounds=True), "NORMAL": made.add([[0, 0, 1]] * len(column)),
                  "JOINTS_0": made.add([[0, 1, 0, 0]] * len(column), 5121, "VEC4"), "WEIGHTS_0": made.add(weights, shape="VEC4")}
    made.asset["meshes"] = [{"primitives": [{"attributes": attributes}]},
                            {"primitives": [{"attributes": {"POSITION": made.add([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0.1]], bounds=True),
                                                            "NORMAL": made.add([[0, 0, 1]] * 3)}}]}]
    binds = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, 0, 1] for y in (-1, -3)]
    made.asset["skins"] = [{"joints": [1, 2]} | ({} if bare else {"inverseBindMatrices": made.add(binds, shape="MAT4")})]
    times = made.add([[0.0], [0.5], [1.0]], shape="SCALAR", bounds=True)
    turns = [quaternion([0, 0, 1], a) for a in (0, 50, -20)]
    shifts = [[0, 2, 0], [0.25, 2.5, 0.5], [0, 2, -0.25]]
    cubic = [[0, 0, 0], [0.5, 1, 0], [0.1, 0, 0], [0, 0.25, 0], [0.25, 1.5, 0.25], [0, 0.5, 0], [0, 0, 0.5], [0.5, 1, 0.5], [0, 0, 0]]
    samplers = [{"input": times, "output": made.add(turns, shape="VEC4")},
                {"input": times, "output": made.add(shifts, bounds=True), "interpolation": "LINEAR"},
                {"input": times, "output": made.add(cubic), "interpolation": "CUBICSPLINE"},
                {"input": times, "output": made.add([[1, 1, 1], [1, 2, 1], [1, 1, 1]]), "interpolation": "STEP"}]
    made.asset["animations"] = [{"name": "wave", "samplers": samplers, "channels": [
        {"sampler": s, "target": {"node": n, "path": path}} for s, n, path in
        ((0, 1, "rotation"), (0, 2, "rotation"), (1, 2, "translation"), (2, 4, "translation"), (3, 4, "scale"),
                           (2, 1, "translation"))]}]
    return made


def box(moves, **members):
    return lattice(low=(-8, -8, -8), high=(8, 8, 8), moves=moves, **members)


RIGID = [{"rotate": {"axis": "z", "degrees": 90, "about": [1, 0, 0]}}, {"by": [0.5, -1, 2]}]


def rigid(p):
    """RIGID: (x, y) about (1, 0) to (-y, x)."""
    return [1 - p[1] + 0.5, p[0] - 1 - 1, p[2] + 2]


def deform(run, made, moves, *options, out="f.glb", **members):
    run.write("a.glb", made.glb() if isinstance(made, Scene) else made)
    run.write("l.json", moves if isinstance(moves, dict) else box(moves, **members))
    done = run.ffd("deform", "a.glb", out, "-l", "l.json", "--force", *options, err=anything)
    return done, Posed(run.read(out))


def farthest(a, b):
    return max(abs(x - y) for key in a for p, q in zip(a[key], b[key], strict=True) for x, y in zip(p, q))


def both(run, made, moves, *options, tolerance=4e-7, **members):
    """Deformed with keep and with follow: the default pose is the same."""
    _, keep = deform(run, made, moves, "--rig", "keep", *options, out="k.glb", **members)
    done, follow = deform(run, made, moves, "--rig", "follow", *options, **members)
    size = max(abs(x) for rows in keep.vertices().values() for p in rows for x in p)
    distance = farthest(keep.vertices(), follow.vertices())
    check(distance <= tolerance * size, f"the default poses differ by {distance} of {size}")
    return done, keep, follow


def moves_as(before, after, expected, tolerance=1e-5, animation=0):
    for time in TIMES:
        wanted = {key: [expected(p) for p in rows] for key, rows in before.vertices(animation, time).items()}
        found = after.vertices(animation, time)
        distance = farthest(wanted, found)
        check(distance <= tolerance, f"at {time} the animation is off by {distance}")


BEND = [{"bend": {"axis": "y", "toward": [1, 0, 0], "degrees": 60}}]


@case
def a_rigid_motion_of_everything_moves_every_pose(run):
    for made in (arm(), arm(bare=True)):
        _, _, follow = both(run, made, RIGID)
        moves_as(Posed(run.read("a.glb")), follow, rigid)
        equal([n for n, (a, b) in enumerate(zip(follow.nodes, made.asset["nodes"])) if a != b], [1],
              "one node is written otherwise, and those below it follow")


@case
def far_from_the_origin_rounding_is_no_lag(run):
    """The joints follow to the digits that doubles have there: none is said to stay."""
    run.write("a.glb", arm().glb())
    run.write("l.json", box([{"rotate": {"axis": [0.6, 0, 0.8], "degrees": 33}}, {"by": [3000, 100, -200]}]))
    done = run.ffd("deform", "a.glb", "f.glb", "-l", "l.json", "--rig", "follow", "--report", "r.json", err=anything)
    no_line(done, "stay")
    behind = json.loads(run.text("r.json"))["jobs"][0]["behind"]
    equal([of for of in behind if of["kind"] == "joint"], [])


@case
def a_scale_of_everything_scales_every_pose(run):
    _, _, follow = both(run, arm(), [{"scale": {"factor": 2, "about": [0, 0, 0]}}])
    moves_as(Posed(run.read("a.glb")), follow, lambda p: [2 * x for x in p])


@case
def bends_keep_the_default_pose_and_a_joint_where_the_mesh_is(run):
    for moves in (BEND, [{"twist": {"axis": "y", "degrees": 100}}], [{"taper": {"axis": "y", "factor": 0.5}}],
                  [{"scale": {"factor": [1, 1.5, 1], "about": [0, 0, 0]}}]):
        _, _, follow = both(run, arm(), moves)
        run.write("p.obj", "v 0 1 0\nv 0 3 0\nv 0 5 0\nv 0.5 4 0\n")
        run.ffd("deform", "p.obj", "q.obj", "-l", "l.json", "--force", err=anything)
        wanted = [[float(x) for x in line.split()[1:4]] for line in run.text("q.obj").splitlines()]
        worlds = follow.worlds()
        near([[worlds[n][r][3] for r in range(3)] for n in (1, 2, 3, 4)], wanted, 1e-12, "the joints")


@case
def normals_of_a_turned_node_stay_with_the_mesh(run):
    def shown(posed):
        """Of the plate: the normals in the scene."""
        m = posed.worlds()[4]
        primitive = posed.asset["meshes"][posed.nodes[4]["mesh"]]["primitives"][0]
        return [point([row[:3] + [0] for row in m[:3]] + [m[3]], n) for n in posed.read(primitive["attributes"]["NORMAL"])]

    for options in ((), ("--normals", "recompute")):
        made = arm()
        made.asset["meshes"][1]["primitives"][0]["mode"] = 4
        _, keep, follow = both(run, made, BEND, *options)
        near(shown(follow), shown(keep), 1e-6, str(options))
        check(follow.read(follow.asset["meshes"][1]["primitives"][0]["attributes"]["NORMAL"])
              != keep.read(keep.asset["meshes"][1]["primitives"][0]["attributes"]["NORMAL"]), "the node has turned")


@case
def morph_targets_of_a_node_that_turns(run):
    made = arm()
    offsets = [[0.25, 0, 0.125], [0, 0, 0], [0, -0.25, 0.25]]
    made.asset["meshes"][1]["primitives"][0]["targets"] = [{"POSITION": made.add(offsets, bounds=True)}]
    _, keep, follow = both(run, made, BEND)
    for posed in (keep, follow):
        primitive = posed.asset["meshes"][1]["primitives"][0]
        base, target = map(posed.read, (primitive["attributes"]["POSITION"], primitive["targets"][0]["POSITION"]))
        world = posed.worlds()[4]
        posed.shown = [point(world, [a + b for a, b in zip(p, m)]) for p, m in zip(base, target)]
        posed.still = target[1]
    near(follow.shown, keep.shown, 1e-6, "the target in full")
    equal(follow.still, [0, 0, 0], "an offset of zeros")


@case
def nothing_moves_and_no_byte_changes(run):
    for made in (arm(), arm(bare=True)):
        deform(run, made, [], "--rig", "follow")
        equal(run.read("f.glb"), run.read("a.glb"))
        # The lattice is elsewhere.
        far = lattice(low=(50, 50, 50), high=(60, 60, 60), moves=[{"by": [1, 0, 0]}])
        deform(run, made, far, "--rig", "follow")
        equal(run.read("f.glb"), run.read("a.glb"))


@case
def equal_bytes_for_any_threads_and_kernels(run):
    found = set()
    for options in (("-j", "1"), ("-j", "3"), ("--isa", "scalar")):
        deform(run, arm(), BEND, "--rig", "follow", *options)
        found.add(run.read("f.glb"))
    equal(len(found), 1)
    done, _ = deform(run, arm(), BEND, "--rig", "follow", "-v")
    one_line(done, "4 nodes follow the deformation, and with them 1 skin and 1 animation")


@case
def a_default_pose_that_is_not_the_bind_pose(run):
    made = arm()
    made.asset["nodes"][1]["rotation"] = quaternion([0, 0, 1], 40)
    made.asset["nodes"][2]["rotation"] = quaternion([1, 0, 0], -35)
    _, _, follow = both(run, made, RIGID)
    moves_as(Posed(run.read("a.glb")), follow, rigid)
    _, _, follow = both(run, made, [{"scale": {"factor": 2, "about": [0, 0, 0]}}])
    moves_as(Posed(run.read("a.glb")), follow, lambda p: [2 * x for x in p])
    both(run, made, BEND)


@case
def samplers_and_outputs_that_channels_share_are_copied(run):
    """Both joints turn by one sampler; below the bend each wants another output."""
    _, _, follow = both(run, arm(), BEND)
    old, new = Posed(run.read("a.glb")), follow
    animation = new.asset["animations"][0]
    outputs = [animation["samplers"][channel["sampler"]]["output"] for channel in animation["channels"]]
    check(outputs[0] != outputs[1], "the joints turn differently")
    equal(animation["samplers"][animation["channels"][4]["sampler"]]["output"],
          old.asset["animations"][0]["samplers"][3]["output"], "a scale stays")
    for index in set(outputs):
        accessor = new.asset["accessors"][index]
        for key, edge in (("min", min), ("max", max)):
            if key in accessor:
                near(accessor[key], [edge(column) for column in zip(*new.read(index))], 1e-9, key)


@case
def inverse_binds_that_skins_share_are_copied(run):
    """A second skin, with the joints the other way round, over the same matrices."""
    made = arm()
    made.asset["skins"].append({"joints": [2, 1], "inverseBindMatrices": made.asset["skins"][0]["inverseBindMatrices"]})
    made.asset["nodes"] += [{"name": "second", "mesh": 0, "skin": 1}]
    made.asset["nodes"][0]["children"].append(6)
    _, _, follow = both(run, made, BEND)
    accessors = [skin["inverseBindMatrices"] for skin in follow.asset["skins"]]
    check(accessors[0] != accessors[1], "one accessor serves both")
    same = arm()
    same.asset["skins"].append(dict(same.asset["skins"][0]))
    same.asset["nodes"] += [{"name": "second", "mesh": 0, "skin": 1}]
    same.asset["nodes"][0]["children"].append(6)
    _, _, follow = both(run, same, BEND)
    equal(*[skin["inverseBindMatrices"] for skin in follow.asset["skins"]], "equal results are one accessor")


@case
def quantized_and_sparse_outputs(run):
    made = arm()
    turns = [[round(32767 * x) for x in quaternion([0, 0, 1], a)] for a in (0, 50, -20)]
    samplers = made.asset["animations"][0]["samplers"]
    samplers[0]["output"] = made.add(turns, 5122, "VEC4", normalized=True)
    places = made.view(bytes([1]))
    values = made.view(struct.pack("<3f", 0.25, 2.5, 0.5))
    made.asset["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values}}})
    samplers[1]["output"] = len(made.asset["accessors"]) - 1
    _, _, follow = both(run, made, RIGID)
    moves_as(Posed(run.read("a.glb")), follow, rigid, 1e-4)
    _, _, follow = both(run, made, BEND)
    found = follow.asset["animations"][0]
    for channel in found["channels"][:3]:
        accessor = follow.asset["accessors"][found["samplers"][channel["sampler"]]["output"]]
        check(accessor["componentType"] == 5126 and not accessor.get("normalized") and "sparse" not in accessor, str(accessor))


@case
def pointers_to_transforms_are_followed(run):
    plain, pointed = arm(), arm()
    for channel in pointed.asset["animations"][0]["channels"]:
        target = channel["target"]
        channel["target"] = {"path": "pointer", "extensions": {"KHR_animation_pointer": {
            "pointer": f"/nodes/{target['node']}/{target['path']}"}}}
    pointed.asset["extensionsUsed"] = ["KHR_animation_pointer"]
    _, _, follow = both(run, pointed, BEND)
    _, other = deform(run, plain, BEND, "--rig", "follow", out="p.glb")
    for time in TIMES:
        near([farthest(follow.vertices(0, time), other.vertices(0, time))], [0], 1e-12, str(time))


@case
def a_matrix_stays_a_matrix(run):
    made = arm()
    made.asset["nodes"][4] = {"name": "plate", "mesh": 1, "matrix": [0, 1, 0, 0, -2, 0, 0, 0, 0, 0, 1, 0, 0.5, 1, 0, 1]}
    del made.asset["animations"][0]["channels"][3:]
    _, _, follow = both(run, made, BEND)
    check("matrix" in follow.nodes[4] and "translation" not in follow.nodes[4] and "rotation" not in follow.nodes[4], "")
    _, _, follow = both(run, made, RIGID)
    moves_as(Posed(run.read("a.glb")), follow, rigid)


@case
def uneven_scales_turn_with_their_parents(run):
    """The upper arm is scaled along x, and turns otherwise than the lower one, which would be sheared."""
    made = arm()
    made.asset["nodes"][1]["scale"] = [2, 1, 1]
    done, _, follow = both(run, made, BEND)
    one_line(done, r"nodes? turns? as (its|their)", "scaled unevenly")
    job = entry(run, "deform", "a.glb", "f.glb", "-l", "l.json", "--rig", "follow")
    check(job["rig"]["sheared"] >= 1, str(job["rig"]))
    # A group of uneven scale turns with all: nothing below it is sheared.
    grouped = arm()
    grouped.asset["nodes"][0] |= {"scale": [1, 1.5, 1], "rotation": quaternion([0, 0.6, 0.8], 30)}
    done, _, follow = both(run, grouped, RIGID)
    moves_as(Posed(run.read("a.glb")), follow, rigid)
    no_line(done, "scaled unevenly")
    equal(follow.nodes[5], grouped.asset["nodes"][5], "a mesh with a skin is seen elsewhere")


@case
def a_node_without_an_inverse_stays(run):
    made = arm()
    made.asset["nodes"][3]["scale"] = [0, 0, 0]
    done, _, follow = both(run, made, BEND)
    one_line(done, r"\b1 node does not follow", "no inverse")
    equal(follow.nodes[3], made.asset["nodes"][3])


@case
def cameras_and_lights_go_along(run):
    made = arm()
    made.asset["nodes"][3] |= {"camera": 0}
    made.asset["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
    done, _, follow = both(run, made, RIGID)
    no_line(done, "stays? where")
    m = follow.worlds()[3]
    near([[m[r][c] for c in range(4)] for r in range(3)], [[0, -1, 0, -3.5], [1, 0, 0, -2], [0, 0, 1, 2]], 1e-9)


@case
def only_moves_the_nodes_of_what_it_selects(run):
    made = arm()
    made.asset["nodes"] += [{"name": "car", "children": [7]}, {"name": "wheel", "mesh": 1, "translation": [-2, 0, 0]}]
    made.asset["scenes"][0]["nodes"].append(6)
    _, _, follow = both(run, made, BEND, "--only", "node:skinned")
    changed = [follow.nodes[n].get("name") for n in range(len(follow.nodes)) if follow.nodes[n] != made.asset["nodes"][n]]
    equal(sorted(changed), ["hand", "lower", "plate", "upper"], "joints move, the plate below stays in its place")
    before = Posed(run.read("a.glb"))
    for key in ((4, 0), (7, 0)):
        near(follow.vertices()[key], before.vertices()[key], 1e-6, "what is not selected")
    _, _, follow = both(run, made, BEND, "--only", "node:wheel")
    equal([node["name"] for node, old in zip(follow.nodes, made.asset["nodes"]) if node != old], ["wheel"])


@case
def what_hangs_on_a_selected_joint_and_is_not_selected_is_told(run):
    """A plate on a joint, one on a group below another, and one of the joint itself; and what is not left behind is not told."""
    move = [{"by": [0, 3, 4]}]
    left = "nodes? that --only does not select"
    made = arm()
    done, follow = deform(run, made, move, "--rig", "follow", "--only", "node:skinned", "--report", "r.json")
    one_line(done, "1 node that --only does not select stays where it is, up to 5 from where the node that it hangs on would carry it: "
         "plate on lower$")
    rig = json.loads(run.text("r.json"))["jobs"][0]["rig"]
    equal([rig["unselected"], rig["unselected_by"]], [1, 5])
    made.asset["nodes"] += [{"name": "group", "translation": [0, 1, 0], "children": [7]}, {"name": "ring", "mesh": 1}]
    made.asset["nodes"][3]["children"] = [6]
    made.asset["nodes"][2]["mesh"] = 1
    done, _ = deform(run, made, move, "--rig", "follow", "--only", "node:skinned")
    one_line(done, "3 nodes that --only does not select stay where they are, up to 5 from where the nodes that they hang on")
    for options in (("--only", "node:root", "--only", "node:skinned"), ("--only", "node:upper"), ()):
        done, _ = deform(run, made, move, "--rig", "follow", *options)
        no_line(done, left)
    done, _ = deform(run, made, move, "--only", "node:skinned")
    no_line(done, left)
    # A plate that turns with nothing moved is left behind, too: the hand turns about itself.
    made = arm()
    made.asset["nodes"][4] = {"name": "plate", "mesh": 1}
    turn = [{"rotate": {"axis": "z", "degrees": 90, "about": [0, 3, 0]}}]
    done, _ = deform(run, made, turn, "--rig", "follow", "--only", "node:skinned")
    one_line(done, "stays where it is, though the node that it hangs on would turn it: plate on lower$")


@case
def a_skinned_mesh_that_is_not_selected_is_told_where_its_joints_move(run):
    """A glove on the joints of the arm; not a rock on joints far away, nor what is weighted to none that moves."""
    move = [{"by": [0, 3, 4]}]
    left = "skinned mesh(es)? that --only does not select"

    def dressed(weights=None):
        made = arm()
        made.asset["skins"].append({"joints": [7, 7]})
        made.asset["nodes"] += [{"name": "glove", "mesh": 2, "skin": 0}, {"name": "far", "translation": [900, 0, 0]},
                                {"name": "rock", "mesh": 0, "skin": 1}]
        made.asset["nodes"][0]["children"] += [6, 7, 8]
        attributes = made.asset["meshes"][0]["primitives"][0]["attributes"]
        weights = {"WEIGHTS_0": made.add(weights, shape="VEC4")} if weights else {}
        made.asset["meshes"].append({"primitives": [{"attributes": {**attributes, **weights}}]})
        return made
    done, follow = deform(run, dressed(), move, "--rig", "follow", "--only", "node:skinned", "--report", "r.json")
    one_line(done, "1 skinned mesh that --only does not select stays where it is, though joints that it hangs on move, by up to 5: glove$")
    rig = json.loads(run.text("r.json"))["jobs"][0]["rig"]
    equal([rig["unselected"], rig["unselected_by"]], [2, 5], "the plate and the glove")
    before = Posed(run.read("a.glb"))
    near(follow.vertices()[6, 0], before.vertices()[6, 0], 1e-5)
    for options in (("--only", "node:skinned", "--only", "node:glove"), ()):
        no_line(deform(run, dressed(), move, "--rig", "follow", *options)[0], left)
    no_line(deform(run, dressed(), move, "--rig", "keep", "--only", "node:skinned")[0], left)
    # The lower joint moves alone, as it turns about the upper one.
    turn = [{"rotate": {"axis": "z", "degrees": 90, "about": [0, 1, 0]}}]
    for weights, is_logged in (([[1.0, 0, 0, 0]] * 27, False), ([[0.5, 0.5, 0, 0]] * 27, True)):
        done, _ = deform(run, dressed(weights), turn, "--rig", "follow", "--only", "node:skinned")
        (one_line if is_logged else no_line)(done, left)


@case
def a_mesh_at_a_joint_that_is_not_selected_stays_where_it_is(run):
    """Its node goes along as a joint: the vertices and their morph targets are brought back."""
    made = arm()
    made.asset["nodes"][2]["mesh"] = 1
    made.asset["meshes"][1]["primitives"][0]["targets"] = [{"POSITION": made.add([[0.5, 0, 0], [0, 0, 0], [0, 0.25, 0]], bounds=True)}]
    _, keep, follow = both(run, made, BEND, "--only", "node:skinned")
    before = Posed(run.read("a.glb"))
    check(follow.nodes[2] != before.nodes[2], "a joint follows")
    near(follow.vertices()[2, 0], before.vertices()[2, 0], 1e-6)
    for posed in (before, follow):
        primitive = posed.asset["meshes"][posed.nodes[2]["mesh"]]["primitives"][0]
        rows = zip(*map(posed.read, (primitive["attributes"]["POSITION"], primitive["targets"][0]["POSITION"])))
        posed.shown = [point(posed.worlds()[2], [a + b for a, b in zip(p, m)]) for p, m in rows]
    near(follow.shown, before.shown, 1e-6, "the target in full")


@case
def what_another_scene_shows_of_the_joints_stays(run):
    """By a skin of its own, which has the same inverse bind matrices or none, and by the same skin; a skin that is broken
    stays as it is."""
    for other in ({"joints": [2, 1], "inverseBindMatrices": 6}, {"joints": [2]}, None):
        made = arm()
        equal(made.asset["skins"][0]["inverseBindMatrices"], 6)
        made.asset["nodes"].append({"name": "other", "mesh": 0 if other is None or len(other) > 1 else 2, "skin": 1 if other else 0})
        made.asset["scenes"].append({"nodes": [0, 6]})
        made.asset["skins"] += [other] if other else []
        attributes = made.asset["meshes"][0]["primitives"][0]["attributes"]
        made.asset["meshes"].append({"primitives": [{"attributes": attributes | {"JOINTS_0": made.add([[0] * 4] * 27, 5121, "VEC4")}}]})
        _, _, follow = both(run, made, BEND)
        near(follow.vertices()[6, 0], Posed(run.read("a.glb")).vertices()[6, 0], 1e-6, f"what {other} shows")
    made.asset["skins"].append({"joints": [1, 2], "inverseBindMatrices": made.add([[1.0] * 16], shape="MAT4")})
    made.asset["nodes"][6]["skin"] = 1
    both(run, arm(), BEND)
    _, broken = deform(run, made, BEND, "--rig", "follow")
    equal(broken.asset["skins"][1], made.asset["skins"][1])


@case
def normals_at_a_joint_that_are_not_selected_stay_as_they_are(run):
    def shown(posed):
        m = posed.worlds()[2]
        primitive = posed.asset["meshes"][posed.nodes[2]["mesh"]]["primitives"][0]
        return [[sum(row[k] * n[k] for k in range(3)) for row in m[:3]] for n in posed.read(primitive["attributes"]["NORMAL"])]

    made = arm()
    made.asset["nodes"][2]["mesh"] = 1
    for options in ((), ("--normals", "recompute")):
        _, follow = deform(run, made, BEND, "--rig", "follow", "--only", "node:skinned", *options)
        near(shown(follow), shown(Posed(run.read("a.glb"))), 1e-6, str(options))


def splats_at_a_joint(scale_type=5126):
    """The lower bone shows two Gaussian splats, which are long in one direction and have colours of degree 1."""
    made = arm()
    splatting = "KHR_gaussian_splatting"
    turns = [quaternion([0.6, 0, 0.8], 40), quaternion([0, 0.6, -0.8], 110)]
    attributes = {"POSITION": made.add([[0.25, 0, 0], [0, 0.5, 0.25]], bounds=True)}
    attributes |= {f"{splatting}:{name}": made.add(rows, component, shape) for name, rows, component, shape in (
        ("ROTATION", turns, 5126, "VEC4"), ("SCALE", [[1, 2, 4], [4, 1, 1]], scale_type, "VEC3"), ("OPACITY", [[0.5]] * 2, 5126, "SCALAR"),
        *((f"SH_DEGREE_1_COEF_{i}", [[0.5 - i, 0.25, 0.125 * i], [i, 1, -0.5]], 5126, "VEC3") for i in range(3)),
        ("SH_DEGREE_0_COEF_0", [[0.1, 0.2, 0.3]] * 2, 5126, "VEC3"))}
    made.asset["meshes"].append({"primitives": [{"attributes": attributes, "mode": 0, "extensions": {
        splatting: {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}}}]})
    made.asset["nodes"][2]["mesh"] = 2
    made.asset["extensionsUsed"] = [splatting]
    return made


def seen_splats(posed):
    """Of the lower bone, in the scene: the covariances, and the directions in which each channel is brightest (degree 1 is
    -y, z, -x)."""
    world = [row[:3] for row in posed.worlds()[2][:3]]
    attributes = posed.asset["meshes"][posed.nodes[2]["mesh"]]["primitives"][0]["attributes"]
    read = {name.split(":")[-1]: posed.read(number) for name, number in attributes.items()}
    seen = []
    for i, (x, y, z, w) in enumerate(read["ROTATION"]):
        own = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
               [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
               [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
        half = [[sum(world[r][k] * own[k][c] for k in range(3)) * read["SCALE"][i][c] for c in range(3)] for r in range(3)]
        seen += [[sum(a * b for a, b in zip(half[r], half[c])) for c in range(3)] for r in range(3)]
        for k in range(3):
            c = [read[f"SH_DEGREE_1_COEF_{n}"][i][k] for n in range(3)]
            seen.append([row[0] * -c[2] + row[1] * -c[0] + row[2] * c[1] for row in world])
    return seen


@case
def splats_at_a_joint_that_are_not_selected_stay_as_they_are(run):
    """They are brought back from where the joint turns them, as their centres are, and are none that follow."""
    made = splats_at_a_joint()
    _, follow = deform(run, made, BEND, "--rig", "follow", "--only", "node:skinned", "--report", "r.json")
    before = Posed(run.read("a.glb"))
    check(follow.nodes[2] != before.nodes[2], "the joint turns")
    near(follow.vertices()[2, 0], before.vertices()[2, 0], 1e-6)
    near(seen_splats(follow), seen_splats(before), 1e-5, "their ellipsoids and colours")
    job = json.loads(run.text("r.json"))["jobs"][0]
    equal(["splats" in job, [b["kind"] for b in job["behind"]], "unscaled" in job["rig"]], [False, [], False])
    both(run, made, BEND, "--only", "node:skinned")


@case
def splats_that_cannot_be_brought_back_are_said(run):
    made = splats_at_a_joint(5125)  # scales that the extension does not allow
    done, follow = deform(run, made, BEND, "--rig", "follow", "--only", "node:skinned", "--report", "r.json")
    near(follow.vertices()[2, 0], Posed(run.read("a.glb")).vertices()[2, 0], 1e-6)
    one_line(done, r"\b2 Gaussian splats that are not selected turn with their nodes", "lower")
    equal(json.loads(run.text("r.json"))["jobs"][0]["rig"]["unscaled"], 1)
    # Where the joint only moves away, they are right as they are.
    done, _ = deform(run, made, [{"by": [1, 0, 0]}], "--rig", "follow", "--only", "node:skinned")
    no_line(done, "Gaussian")


@case
def a_mesh_that_is_selected_in_part_keeps_its_node(run):
    made = arm()
    made.asset["materials"] = [{"name": "red"}, {"name": "blue"}]
    primitives = made.asset["meshes"][1]["primitives"]
    primitives[0]["material"] = 0
    primitives.append({"attributes": {"POSITION": made.add([[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0.1]], bounds=True)}, "material": 1})
    done, _, follow = both(run, made, BEND, "--only", "material:red")
    equal(follow.nodes, made.asset["nodes"])
    one_line(done, "1 node stays where it is", "--only", "part of its mesh")


@case
def keep_says_how_far_joints_lag(run):
    made = arm()
    for rig in ((), ("--rig", "keep")):
        done, keep = deform(run, made, [{"by": [0, 0, 0.5]}], *rig)
        one_line(done, "the joints of 1 skin", "1 animated pivot", "1 socket", r"lie up to 0\.5 off the deformed mesh", "--rig")
        equal(keep.nodes, made.asset["nodes"])
        equal(keep.asset["animations"], made.asset["animations"])
    for command in (["deform", "a.glb", "k.glb"], ["check", "a.glb"]):
        equal(entry(run, *command, "-l", "l.json")["rig"],
              {"joints": 2, "moved": 0, "largest_lag": 0.5, "worst": "upper", "sheared": 0})
        found = entry(run, *command, "-l", "l.json", "--rig", "follow")["rig"]
        check(found["moved"] >= 1, str(found))
        equal({**found, "moved": 0}, {"joints": 2, "moved": 0, "largest_lag": 0, "worst": None, "sheared": 0})
    told_of = run.ffd("check", "a.glb", "-l", "l.json", err=anything).out
    check(re.search(r"2 joints, the largest lag is 0\.5 \(upper\)", str(told_of)), str(told_of))
    # Too little to be worth a line.
    no_line(deform(run, made, [{"by": [0, 0, 0.001]}])[0], "--rig")
    no_line(deform(run, made, [{"by": [0, 0, 0.5]}], "--rig", "follow")[0], "off the deformed mesh|stays? where")


@case
def what_cannot_follow_is_a_usage_error(run):
    run.write("a.glb", arm().glb())
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    run.write("l.json", box(BEND))
    for arguments in (["a.glb", "b.glb", "--as-morph", "x"], ["a.glb", "b.glb", "--space", "mesh"], ["a.glb", "b.obj"],
                      ["a.obj", "b.obj"], ["a.obj", "b.glb"]):
        run.ffd("deform", *arguments, "-l", "l.json", "--rig", "follow", code=USAGE, err=anything)
    run.ffd("check", "a.obj", "-l", "l.json", "--rig", "follow", code=USAGE, err=anything)
    run.write("jobs.jsonl", json.dumps({"in": "a.glb", "lattice": "l.json", "out": "o.glb", "options": {"rig": "follow"}}) + "\n")
    run.ffd("batch", "jobs.jsonl", err=anything)
    deform(run, arm(), BEND, "--rig", "follow")
    equal(run.read("o.glb"), run.read("f.glb"), "a job of a batch")


def with_tail(extensions):
    """The arm with three groups, the last one a leaf, below the upper bone at (0.5, 2, 0), (0.5, 3, 0), (0.5, 4, 0), and a
    free group at (-0.5, 3, 0) with a leaf above it."""
    made = arm()
    made.asset["nodes"] += [{"name": "tail", "translation": [0.5, 1, 0], "children": [7]},
                            {"name": "tail_end", "translation": [0, 1, 0], "children": [8]},
                            {"name": "tail_tip", "translation": [0, 1, 0]},
                            {"name": "head", "translation": [-0.5, 3, 0], "children": [10]}, {"translation": [0, 1, 0]}]
    made.asset["nodes"][1]["children"].append(6)
    made.asset["nodes"][0]["children"].append(9)
    made.asset |= {"extensions": extensions, "extensionsUsed": list(extensions)}
    return made


VRM = {"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": {"hips": {"node": 0}, "head": {"node": 9}}},
                    "lookAt": {"offsetFromHeadBone": [0, 0.06, 0]}},
       "VRMC_springBone": {"specVersion": "1.0", "colliders": [{"node": 3, "shape": {"sphere": {"offset": [0, 0, 0], "radius": 0.1}}}],
                           "springs": [{"joints": [{"node": n, "hitRadius": 0.02} for n in (6, 7, 8)], "colliderGroups": []}]}}
OLD_VRM = {"VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 0}, {"bone": "head", "node": 9}]},
                   "firstPerson": {"firstPersonBone": -1, "firstPersonBoneOffset": {"x": 0, "y": 0.06, "z": 0}},
                   "secondaryAnimation": {"boneGroups": [{"hitRadius": 0.02, "bones": [6]}],
                                          "colliderGroups": [{"node": 3, "colliders": [{"radius": 0.1}]}]}}}


@case
def bones_and_springs_of_vrm_go_along(run):
    """Their nodes are groups, which keep their matrices where nothing animates them. What has a length is said."""
    for extensions in (VRM, OLD_VRM):
        done, _, follow = both(run, with_tail(extensions), BEND)
        run.write("p.obj", "v 0.5 2 0\nv 0.5 3 0\nv 0.5 4 0\nv -0.5 3 0\n")
        run.ffd("deform", "p.obj", "q.obj", "-l", "l.json", "--force", err=anything)
        wanted = [[float(x) for x in line.split()[1:4]] for line in run.text("q.obj").splitlines()]
        worlds = follow.worlds()
        near([[worlds[n][r][3] for r in range(3)] for n in (6, 7, 8, 9)], wanted, 1e-12, "the bones")
        one_line(done, r"\b3 spring bones\b", "radii", "tail, tail_end, tail_tip$")
        one_line(done, r"\b1 physics shape\b", "hand$")
        one_line(done, "eyes", "head$")
        equal(len(lines_with(done, r"rotations? now", "VRM 0")), extensions is OLD_VRM)
        equal(follow.asset["extensions"], extensions)
        job = entry(run, "deform", "a.glb", "f.glb", "-l", "l.json", "--rig", "follow")["rig"]
        equal(job["unscaled"], 5, str(job))
        keep = entry(run, "deform", "a.glb", "f.glb", "-l", "l.json")
        equal([kind["count"] for kind in keep["behind"] if kind["kind"] == "pivot"], [6], "the tail's three, hips, head and plate")
        equal(["unscaled" in keep["rig"], deform(run, with_tail(extensions), [], "--rig", "follow")[0].err], [False, []])


@case
def rotations_of_nodes_that_stay_are_said(run):
    """A hat that --only selects in part stays where it is, by a rotation against that of what it is below."""
    made = Scene(scene=0, scenes=[{"nodes": [0]}], materials=[{"name": "a"}, {"name": "b"}],
                 nodes=[{"name": "hips", "mesh": 0, "children": [1]}, {"name": "hat", "translation": [0, 1, 0], "mesh": 1}])
    attributes = {"POSITION": made.add([[-0.5, 0, 0], [0.5, 0, 0], [0, 1, 0]], bounds=True)}
    made.asset["meshes"] = [{"primitives": [{"attributes": attributes, "material": m} for m in materials]} for materials in ([0], [0, 1])]
    made.asset |= {"extensions": {"VRM": {}}, "extensionsUsed": ["VRM"]}
    done, follow = deform(run, made, BEND, "--rig", "follow", "--only", "material:a")
    check("rotation" in follow.nodes[1], follow.nodes)
    one_line(done, "2 nodes have rotations now", "hips, hat$")
    one_line(done, "1 node stays where it is")


@case
def constraints_of_vrm_are_kept_or_said(run):
    """Turns that are copied are copied still; a node that aims is said, where it or what it is below has moved."""
    for kind, said in (("aim", 1), ("roll", 0), ("rotation", 0)):
        made = with_tail({"VRMC_vrm": {}})
        made.asset["nodes"][6]["extensions"] = {"VRMC_node_constraint": {"constraint": {kind: {"source": 3}}}}
        done, follow = deform(run, made, BEND, "--rig", "follow")
        equal(len(lines_with(done, "1 node aims at another", "VRMC_node_constraint", "tail$")), said, kind)
        equal(follow.nodes[6]["extensions"], made.asset["nodes"][6]["extensions"])
        check(follow.nodes[6]["rotation"] != [0, 0, 0, 1], "it turns")


@case
def springs_that_go_round_in_a_circle_end(run):
    """Roots that are below each other, numbers of no node, and what is no list."""
    odd = {"VRM": {"secondaryAnimation": {"boneGroups": [{"bones": [7, 6, 6, -1, 99, "a", None]}, {"bones": {}}, 5]},
                   "humanoid": {"humanBones": [{"bone": 3, "node": 9}, {}, 7]}, "firstPerson": {"firstPersonBone": "a", "firstPersonBoneOffset": 0}},
           "VRMC_vrm": {"humanoid": {"humanBones": [1, 2]}, "lookAt": 3}, "VRMC_springBone": {"springs": [{"joints": [3, {"node": 1e99}]}, []]}}
    done, _ = deform(run, with_tail(odd), BEND, "--rig", "follow")
    one_line(done, r"\b3 spring bones\b")
    no_line(done, "eyes")


def vrm(**members):
    return {"VRMC_vrm": {"specVersion": "1.0", **members}}


def springs(**members):
    return {"VRMC_springBone": {"specVersion": "1.0", **members}}


@case
def numbers_of_no_node_in_vrm_are_flaws(run):
    """Each is said with its place and number, is in the report, and is refused with --strict. What else the file has of VRM
    counts as it does without."""
    said = "VRM should name one of the 11 nodes here{}: it is ignored"
    for root, where, number in (
            (vrm(humanoid={"humanBones": {"hips": {"node": 0}, "head": {"node": 99}}}), "VRMC_vrm/humanoid/humanBones/head/node", ", not 99"),
            (vrm(humanoid={"humanBones": {"head": {}}}), "VRMC_vrm/humanoid/humanBones/head", ""),
            (springs(springs=[{"joints": [{"node": 6}, {"node": -1}]}]), "VRMC_springBone/springs/0/joints/1/node", ", not -1"),
            (springs(springs=[{"joints": [{"node": 1.5}]}]), "VRMC_springBone/springs/0/joints/0/node", ", not 1.5"),
            (springs(springs=[{"joints": [6]}]), "VRMC_springBone/springs/0/joints/0", ""),
            (springs(springs=[{"joints": [], "center": 11}]), "VRMC_springBone/springs/0/center", ", not 11"),
            (springs(colliders=[{"node": 1e99}]), "VRMC_springBone/colliders/0/node", ", not 1e+99"),
            ({"VRM": {"humanoid": {"humanBones": [{"bone": "head", "node": -1}]}}}, "VRM/humanoid/humanBones/0/node", ", not -1"),
            ({"VRM": {"firstPerson": {"firstPersonBone": 12}}}, "VRM/firstPerson/firstPersonBone", ", not 12"),
            ({"VRM": {"secondaryAnimation": {"boneGroups": [{"bones": [6, "a"]}]}}}, "VRM/secondaryAnimation/boneGroups/0/bones/1", ""),
            ({"VRM": {"secondaryAnimation": {"boneGroups": [{"center": 11}]}}}, "VRM/secondaryAnimation/boneGroups/0/center", ", not 11"),
            ({"VRM": {"secondaryAnimation": {"colliderGroups": [{"node": None}]}}},
             "VRM/secondaryAnimation/colliderGroups/0/node", "")):
        run.write("a.glb", with_tail(root).glb())
        run.write("l.json", box(BEND))
        message, pointer = said.format(number), "/extensions/" + where
        done = run.ffd("check", "a.glb", "-l", "l.json", "--report", "r.json", err=anything)
        equal([line for line in done.err if "VRM" in line], [f"a.glb: {pointer}: {message}"])
        equal(json.loads(run.text("r.json"))["jobs"][0]["flaws"], [{"message": message, "pointer": pointer, "count": 1}])
        run.ffd("check", "a.glb", "-l", "l.json", "--strict", code=INVALID, err=f"a.glb:{pointer}: {message}")
    # VRM 0.x has -1 for none, and several are one line.
    fine = {"VRM": {"firstPerson": {"firstPersonBone": -1}, "secondaryAnimation": {"boneGroups": [{"center": -1, "bones": [6]}]}}}
    equal(deform(run, with_tail(fine), [], "--strict")[0].err, [])
    made = with_tail({"VRMC_vrm": {}})
    made.asset["nodes"][6]["extensions"] = {"VRMC_node_constraint": {"constraint": {"roll": {"source": 20}, "aim": {}}}}
    one_line(deform(run, made, [])[0], "/nodes/6/extensions/VRMC_node_constraint/constraint/roll/source: " + said.format(", not 20")
         + r" \(the first of 2 such\)$")


@case
def pointers_that_are_not_followed_and_shapes_are_said(run):
    made = arm()
    pointer = lambda where: {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": where}}}
    made.asset["animations"][0]["channels"] += [{"sampler": 3, "target": pointer(where)} for where in
                                                ("/nodes/1/matrix", "/nodes/0/matrix", "/materials/0/alphaCutoff")]
    shape = {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"shape": 0}}}}
    made.asset["nodes"][3]["extensions"] = shape
    made.asset |= {"extensions": {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": 1}}]}},
                   "extensionsUsed": ["KHR_implicit_shapes", "KHR_physics_rigid_bodies", "KHR_animation_pointer"]}
    done, follow = deform(run, made, BEND, "--rig", "follow")
    one_line(done, "1 channel of KHR_animation_pointer drives a node that has moved")
    one_line(done, "1 physics shape goes with its node", "hand$")
    equal(follow.nodes[3]["extensions"], shape)
    one_line(deform(run, made, BEND)[0], "1 physics shape stays where it is")


@case
def a_broken_animation_stops_only_who_needs_it(run):
    made = arm()
    made.asset["accessors"][made.asset["animations"][0]["samplers"][0]["input"]]["count"] = 2
    deform(run, made, BEND)
    run.ffd("deform", "a.glb", "f.glb", "-l", "l.json", "--rig", "follow", "--force", code=INVALID, err=anything)
    deform(run, made, [], "--rig", "follow")


@case
def keys_that_become_those_of_many_channels_are_limited(run):
    """One sampler of 20,000 keys for 2,000 nodes, each of which the bend turns otherwise."""
    made = arm()
    first = len(made.asset["nodes"])
    for i in range(2000):
        made.asset["nodes"].append({"translation": [0.001 * i, 0.002 * i, 0]})
    made.asset["nodes"][0]["children"] += range(first, first + 2000)
    times = made.add([[float(i)] for i in range(20000)], shape="SCALAR", bounds=True)
    made.asset["animations"] = [{"samplers": [{"input": times, "output": made.add([[0, 0, 0, 1]] * 20000, shape="VEC4")}],
                                 "channels": [{"sampler": 0, "target": {"node": first + i, "path": "rotation"}} for i in range(2000)]}]
    run.write("a.glb", made.glb())
    run.write("l.json", box(BEND))
    run.ffd("deform", "a.glb", "f.glb", "-l", "l.json", "--rig", "follow", code=LIMIT, err=anything)


main()
