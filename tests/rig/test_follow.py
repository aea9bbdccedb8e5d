#!/usr/bin/env python3
"""--rig follow: the animations of a deformed rig, at twenty times each, against closed forms and against the rule that was
written apart from the program (rule.py), by the slow evaluator (pose.py)."""

import math
import re

from bspline import BoxVolume
from cases import (ARMS, BENT, DOUBLE, EVEN, LARGER, QUARTER, RIGID, WAVED, affine, plain, posed_with_morphs, text,
                   text_at_rest, uneven, volume)
from follow import CLOSE, PARTS, carried, deformed, has_turned, is_kept, moves_as, moves_as_one, poses
from harness import USAGE, case, check, equal, float32, main
from made import Arm, posed
from matrices import apply, turn
from pose import largest_difference, size_of
from rule import Deformation, Following
from messages import anything, entry, no_line, one_line

QUANTIZED = 4e-5  # rotations in 16 bits are off by so much of length 1


def close_for(name):
    return QUANTIZED if name == "quantized" else CLOSE


@case
def an_arm_made_twice_as_large_or_turned_by_a_quarter_moves_so(run):
    for map_ in (DOUBLE, QUARTER, LARGER):
        before, after, job = deformed(run, plain(), Deformation(affine(map_)))
        moves_as_one(before, after, lambda p: apply(map_, p))
        is_kept(before, after)
        equal(job["rig"]["sheared"], 0)
        if map_ is QUARTER:
            has_turned(before, after, map_)


@case
def what_moves_rigidly_or_grows_evenly_moves_so_at_all_times(run):
    """Every kind of rig, the uneven one too: nothing of it is turned otherwise than its parent."""
    for name, make in ARMS.items():
        for map_ in (RIGID, DOUBLE):
            before, after, job = deformed(run, make(), Deformation(affine(map_)))
            moves_as_one(before, after, lambda p: apply(map_, p), close_for(name), name)
            is_kept(before, after)
            equal(job["rig"]["sheared"], 0, name)
        if map_ is RIGID:
            has_turned(before, after, map_)


@case
def bent_and_waved_rigs_follow_the_rule(run):
    for name, make in ARMS.items():
        for deformation in (BENT, WAVED):
            before, after, job = deformed(run, make(), deformation)
            expected = Following(before, deformation)
            moves_as(expected.rig, after, name=name)
            is_kept(before, after)
            equal(job["rig"]["sheared"], len(expected.sheared), name)
            check((name in EVEN) == (not expected.sheared), name)


@case
def the_default_pose_is_that_of_keep(run):
    """To two steps of a float32 as large as the largest coordinate, for each level of nodes."""
    for name, make in ARMS.items():
        before, followed, _ = deformed(run, make(), BENT)
        _, kept, _ = deformed(run, make(), BENT, rig="keep", out="c.glb")
        largest = max(abs(x) for points in kept.vertices().values() for p in points for x in p)
        step = math.ldexp(1.0, math.frexp(largest)[1] - 24)
        off = largest_difference(kept.vertices(), followed.vertices())
        check(off <= 2 * 5 * step, f"{name}: {off / step:.1f} steps")
        check(largest_difference(before.vertices(), kept.vertices()) > 0.1, "it is deformed")


@case
def nothing_changes_where_nothing_moves(run):
    """Not a byte, whatever the rig; neither under a lattice that moves what is elsewhere."""
    far = volume(lambda p: [1, 0, 0], (50, 50, 50), (60, 60, 60), (2, 2, 2), (1, 1, 1))
    run.write("l.json", text_at_rest(BENT.volumes[0]))
    run.write("m.json", text(far))
    for name, make in ARMS.items():
        run.write("a.glb", make().glb())
        for lattice in ("l.json", "m.json"):
            job = entry(run, "deform", "a.glb", "b.glb", "-l", lattice, "--rig", "follow")
            check(run.read("b.glb") == run.read("a.glb"), f"{name}: not a byte")
            equal([job["rig"][key] for key in ("moved", "sheared", "largest_lag")], [0, 0, 0])


@case
def normals_and_tangents_turn_with_the_rig(run):
    """By a rigid motion at all times; bent, in the default pose, as with keep."""
    arm = posed(Arm(normals=True, rotation=[0.6, 0, 0, 0.8], scale=[1.2, 1.2, 1.2]))
    before, after, _ = deformed(run, arm, Deformation(affine(RIGID)))
    for pose in poses(before, 5):
        wanted = {key: [turn(RIGID, n) for n in some] for key, some in before.directions(*pose).items()}
        check(largest_difference(wanted, after.directions(*pose)) < 1e-5, f"at {pose}")
    equal(len(wanted), 4, "both meshes have both")
    _, followed, _ = deformed(run, arm, BENT)
    _, kept, _ = deformed(run, arm, BENT, rig="keep", out="c.glb")
    check(largest_difference(kept.directions(), followed.directions()) < 1e-5, "bent")


@case
def threads_and_instruction_sets_change_no_byte(run):
    deformed(run, posed_with_morphs(), BENT)
    for options in (["--threads", "1"], ["--threads", "5"], ["--isa", "scalar"]):
        deformed(run, posed_with_morphs(), BENT, *options, out="c.glb")
        check(run.read("c.glb") == run.read("b.glb"), f"{options}")


@case
def keep_is_the_default_and_leaves_the_rig(run):
    for make in (plain, posed_with_morphs):
        before, after, job = deformed(run, make(), BENT, rig="keep")
        kept = run.read("b.glb")
        deformed(run, make(), BENT, rig=None)
        check(run.read("b.glb") == kept, "the default")
        equal([after.asset[key] for key in ("nodes", "skins", "animations")],
              [before.asset[key] for key in ("nodes", "skins", "animations")])
        equal(job["rig"]["moved"], 0)


def changed(before, after):
    """The names of nodes that are written otherwise."""
    return [a.get("name") for a, b in zip(before.asset["nodes"], after.asset["nodes"]) if any(a.get(k) != b.get(k) for k in PARTS)]


def is_joint_pivot_or_socket(rig, number):
    """Cameras and lights are none of these, animated or not."""
    node = rig.nodes[number]
    if {"camera", "extensions"} & set(node.members):
        return False
    return (any(number in skin.joints for skin in rig.skins)
            or any(channel.node == number and channel.path != "weights" for animation in rig.animations for channel in animation)
            or not (node.children or node.mesh is not None))


@case
def the_report_tells_what_became_of_the_rig(run):
    for make in (plain, uneven, posed_with_morphs):
        for deformation in (BENT, WAVED):
            before, after, followed = deformed(run, make(), deformation)
            expected = Following(before, deformation)
            _, _, kept = deformed(run, make(), deformation, rig="keep")
            lag = {n: d for n, d in expected.lag.items() if is_joint_pivot_or_socket(before, n)}
            worst = max(lag, key=lag.get)
            for job in (kept, followed):
                equal(job["rig"]["joints"], 3)
            check(abs(kept["rig"]["largest_lag"] - lag[worst]) < 1e-9, f"{kept['rig']} for {lag[worst]}")
            equal(kept["rig"]["worst"], before.nodes[worst].name)
            equal([kept["rig"]["moved"], kept["rig"]["sheared"]], [0, 0])
            equal(followed["rig"]["moved"], len(changed(before, after)))
            check(followed["rig"]["largest_lag"] < 1e-9, followed["rig"])
            equal(followed["rig"]["sheared"], len(expected.sheared))


@case
def without_a_rig_there_is_nothing_to_report(run):
    arm = Arm(animated=False)
    arm.asset |= {"skins": [], "scenes": [{"nodes": []}], "nodes": []}
    arm.names = {}
    arm.node("plain", None, mesh=1)
    _, after, job = deformed(run, arm, BENT, rig="keep")
    check("rig" not in job or job["rig"]["joints"] == 0, job)


@case
def nodes_outside_stay_and_what_hangs_on_them_keeps_its_place(run):
    """The volume ends between elbow and hand: those beyond stay where they are while their parents turn."""
    for make in (plain, posed_with_morphs):
        deformation = Deformation(BoxVolume((-3.1, -4.2, -3.3), (1.9, 3.9, 4.1), lambda p: [0, 0.3 * p[0], 0.4 * p[1]], (4, 4, 4)))
        before, after, _ = deformed(run, make(), deformation)
        expected = Following(before, deformation)
        check(0 < sum(d == 0 for d in expected.lag.values()) < len(expected.lag), "some stay, some do not")
        moves_as(expected.rig, after)


@case
def several_lattices_in_their_order_side_by_side_and_extended(run):
    first = BoxVolume((-9, -9, -9), (1.5, 9, 9), lambda p: [0, 0, 0.02 * (p[0] - 1.5) ** 2], (5, 4, 4))
    second = BoxVolume((1.5, -9, -9), (12, 9, 9), lambda p: [0, 0.05 * (p[0] - 1.5) ** 2, 0], (5, 4, 4))
    small = BoxVolume((-1, -1.5, -1), (3, 1.5, 1.7), lambda p: [0.1 * p[1], 0.3 * p[0], 0.2 * p[1] * p[0]], (4, 4, 4))
    for deformation in (Deformation(*WAVED.volumes, *BENT.volumes), Deformation(first, second, blocks=True),
                        Deformation(small, extend=True), Deformation(small, extend=True, falloff=4.0)):
        before, after, _ = deformed(run, posed(Arm()), deformation)
        moves_as(Following(before, deformation).rig, after, 5e-6)


@case
def only_what_is_selected_takes_its_nodes_along(run):
    before, after, job = deformed(run, plain(), BENT, "--only", "node:wheel")
    equal(changed(before, after), ["wheel"])
    equal(job.get("rig", {"moved": 1})["moved"], 1)
    shown = {key: before.vertices()[key] for key in before.shapes if before.nodes[key[0]].name == "wheel"}
    found = {key: after.vertices()[key] for key in shown}
    check(largest_difference(carried(BENT, shown), found) < 1e-5, "the wheel")
    for pose in poses(before, 3):
        for key, points in before.vertices(*pose).items():
            if key not in shown:
                equal(after.vertices(*pose)[key], points, "all else")
    before, after, _ = deformed(run, plain(), BENT, "--only", "node:skin")
    check({"shoulder", "elbow", "hand"} <= set(changed(before, after)), changed(before, after))
    check(not {"wheel", "axle"} & set(changed(before, after)), changed(before, after))


@case
def what_has_no_rig_to_follow_is_refused(run):
    run.write("a.glb", plain().glb())
    run.write("l.json", text(BENT.volumes[0]))
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for words in (["a.glb", "b.glb", "--space", "mesh"], ["a.glb", "b.glb", "--as-morph", "x"], ["a.obj", "b.obj"]):
        run.ffd("deform", *words, "-l", "l.json", "--rig", "follow", code=USAGE)
        check(not run.exists("b.glb") and not run.exists("b.obj"), "no output")
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--rig", "folow", code=USAGE, err=re.compile("follow"))


@case
def keep_says_how_far_joints_lag(run):
    """Once, with the number and the name; not under follow, not for less than a thousandth of the scene."""
    before, _, job = deformed(run, plain(), BENT, rig="keep")
    done = run.ffd("deform", "a.glb", "c.glb", "-l", "l0.json", "--force", err=anything)
    line = one_line(done, r"--rig\b")
    check(job["rig"]["worst"] in line and "1 skin" in line, line)
    number = float(re.search(r"up to ([0-9.e+-]+)", line).group(1))
    check(abs(number - job["rig"]["largest_lag"]) <= 0.05 * number, line)
    no_line(run.ffd("deform", "a.glb", "c.glb", "-l", "l0.json", "--force", "--rig", "follow", err=anything), r"--rig\b|lie up to")
    done = run.ffd("check", "a.glb", "-l", "l0.json", err=anything)
    one_line(done, r"--rig\b")
    check(f"({job['rig']['worst']})" in done.out.decode(), "check prints whose lag is the largest")
    size = size_of(before.vertices())
    for factor, says in ((0.5e-3, False), (3e-3, True)):
        small = affine((1, 0, 0, factor * size, 0, 1, 0, 0, 0, 0, 1, 0))
        run.write("s.json", text(small))
        done = run.ffd("deform", "a.glb", "c.glb", "-l", "s.json", "--force", err=anything)
        (one_line if says else no_line)(done, r"--rig\b")


@case
def keys_that_hold_the_rest_hold_it_exactly(run):
    _, after, _ = deformed(run, ARMS["constant"](), WAVED)
    for channel in after.animations[0]:
        rest = after.nodes[channel.node].parts[channel.path]
        equal({tuple(v) for v in channel.values}, {tuple(float32(x) for x in rest)}, after.nodes[channel.node].name)


@case
def what_stays_the_same_keeps_its_bytes(run):
    """Under a mere shift of everything no rotation and no key changes but those of roots; quantized keys stay quantized, and
    become floats where they change."""
    shift = (1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, -1.0)
    for make in (plain, ARMS["quantized"]):
        before, after, _ = deformed(run, make(), Deformation(affine(shift)))
        for channels, others in zip(before.animations, after.animations):
            for a, b in zip(channels, others):
                if a.path != "translation":
                    equal(b.accessors, a.accessors, f"{a.path} of {before.nodes[a.node].name}")
                    equal(b.values, a.values)
        equal([n.get("rotation") for n in after.asset["nodes"]], [n.get("rotation") for n in before.asset["nodes"]])
    before, after, _ = deformed(run, ARMS["quantized"](), BENT)
    for a, b in zip(before.animations[0], after.animations[0]):
        equal([before.asset["accessors"][a.accessors[1]]["componentType"], after.asset["accessors"][b.accessors[1]]["componentType"]],
              [5122, 5126])


@case
def a_node_of_scale_nothing_stays_with_all_below(run):
    arm = Arm()
    arm["car"]["scale"] = [0.0, 1.0, 1.0]
    before, after, _ = deformed(run, arm, BENT)
    check(not {"car", "axle", "wheel"} & set(changed(before, after)), changed(before, after))
    check({"shoulder", "elbow"} <= set(changed(before, after)), "the arm follows")
    arm = Arm()
    arm["elbow"]["scale"] = [0.0, 0.0, 0.0]
    before, after, _ = deformed(run, arm, BENT)
    check(not {"elbow", "hand", "socket"} & set(changed(before, after)), changed(before, after))
    check(all(math.isfinite(x) for points in after.vertices().values() for p in points for x in p), "finite")


main()
