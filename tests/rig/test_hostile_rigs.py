#!/usr/bin/env python3
"""--rig follow and rigs that are made to be hard: each ends with a clear message and its exit code, or with a file that
shows what the slow evaluator finds; in time and memory that grow as the file does."""

import math
import os
import resource
import struct

from cases import BENT, WAVED, text, volume
from follow import CLOSE, deformed, moves_as, poses
from harness import INVALID, LIMIT, OK, SANITIZED, case, check, equal, main
from made import FLOAT, SHORT, Arm, cubic, posed, turns
from matrices import to_numbers
from pose import largest_difference, size_of
from rule import Deformation, Following
from messages import anything, one_line

SLOW = 20 if SANITIZED else 1
NAN, LARGE = float("nan"), 3e38
MANY = (25_000, 100_000) if os.environ.get("FFD_LARGE") else (5_000, 20_000)  # joints


def finite(rig):
    for pose in poses(rig, 3):
        for points in rig.vertices(*pose).values():
            check(all(math.isfinite(x) for p in points for x in p), f"at {pose} all is finite")


def follows(run, arm, deformation=BENT, close=CLOSE, **options):
    before, after, job = deformed(run, arm, deformation, **options)
    expected = Following(before, deformation)
    moves_as(expected.rig, after, close)
    return before, after, job


@case
def inverse_binds_and_keys_that_are_sparse(run):
    """Accessors whose values stand apart, also with nothing below them."""
    arm = posed(Arm(animated=False))
    rows = [list(q) for q in turns((0, 0, 1), [0, 40, 95, -20])]
    output = arm.channel("shoulder", "rotation", rows)
    indices = arm.view(struct.pack("<HH", 1, 3))
    values = arm.view(struct.pack("<8f", *turns((0, 1, 0), [70])[0], *turns((1, 0, 0), [20])[0]))
    sparse = {"count": 2, "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}}
    arm.asset["accessors"][output]["sparse"] = sparse
    moves = arm.channel("axle", "translation", [[0, 0, 0]] * 4)
    values = arm.view(struct.pack("<6f", 0.4, 0.2, 0.1, 0.7, 0, 0))
    arm.asset["accessors"][moves] = {"componentType": FLOAT, "type": "VEC3", "count": 4,
                                     "sparse": {**sparse, "values": {"bufferView": values}}}
    binds = arm.asset["skins"][0]["inverseBindMatrices"]
    last = arm.view(struct.pack("<16f", *to_numbers(arm.binds[2])))
    where = arm.view(b"\2\0")
    arm.asset["accessors"][binds]["sparse"] = {"count": 1, "indices": {"bufferView": where, "componentType": 5123},
                                               "values": {"bufferView": last}}
    for deformation in (BENT, WAVED):
        follows(run, arm, deformation)


@case
def one_node_in_two_skins_and_twice_in_one(run):
    arm = posed(Arm())
    joints = arm.asset["skins"][0]["joints"]
    joints.append(joints[0])
    arm.asset["skins"][0]["inverseBindMatrices"] = arm.matrices([*arm.binds, arm.binds[0]])
    arm.asset["skins"].append({"joints": [joints[2], joints[0], joints[1]]})  # and one without inverse binds
    arm.node("second", "car", mesh=0, skin=1)
    _, after, job = follows(run, arm)
    equal(job["rig"]["joints"], 3)
    equal("inverseBindMatrices" in after.asset["skins"][1], True, "it needs some now")


@case
def skins_and_keys_in_one_accessor(run):
    """Two skins read the same inverse binds, two animations the same values, and one accessor is keys and offsets."""
    arm = posed(Arm())
    arm.asset["skins"].append({**arm.asset["skins"][0], "joints": arm.asset["skins"][0]["joints"][::-1]})
    arm.node("second", "root", mesh=0, skin=1)
    points = arm.asset["meshes"][1]["primitives"][0]["attributes"]["POSITION"]
    times = arm.times([0.1 * i for i in range(12)])
    arm.asset["animations"][0]["samplers"].append({"input": times, "output": points})
    arm.target("lamp", "translation", len(arm.asset["animations"][0]["samplers"]) - 1)
    follows(run, arm)


@case
def quantized_and_sparse_keys_of_one_sampler(run):
    arm = posed(Arm(animated=False))
    output = arm.channel("shoulder", "rotation", cubic(turns((0, 0, 1), [0, 40, 95, -20])), "CUBICSPLINE", component=SHORT)
    for name in ("elbow", "axle"):
        arm.target(name, "rotation", 0)
    at = arm.view(struct.pack("<H", 4))
    value = arm.view(struct.pack("<4h", *(round(32767 * x) for x in turns((0, 1, 0), [50])[0])))
    arm.asset["accessors"][output]["sparse"] = {"count": 1, "indices": {"bufferView": at, "componentType": 5123},
                                                "values": {"bufferView": value}}
    follows(run, arm)


@case
def joints_that_the_scene_does_not_show(run):
    """They follow with their skin."""
    arm = posed(Arm())
    arm["root"]["children"].remove(arm.names["shoulder"])
    arm["shoulder"]["translation"] = [0.3, -0.2, 0.5]
    follows(run, arm)


@case
def mirrored_and_flat_nodes(run):
    arm = posed(Arm(scale=[-1, 1, 1]))
    follows(run, arm)
    for flat in ([1, 0, 1], [0, 0, 0], [1e-30, 1e-30, 1e-30]):
        for name in ("elbow", "shoulder", "root"):
            arm = Arm()
            arm[name]["scale"] = flat
            _, after, _ = deformed(run, arm, BENT, code=(OK, INVALID, LIMIT))
            finite(after)


@case
def folded_deformations_turn_nothing_there(run):
    """Where det F <= 0 a node goes along and is not turned."""
    mirrored = Deformation(volume(lambda p: [-2 * p[0], 0, 0]))
    before, after, _ = deformed(run, Arm(), mirrored)
    expected = Following(before, mirrored)
    equal([n.get("rotation") for n in after.asset["nodes"]], [n.get("rotation") for n in before.asset["nodes"]])
    off = largest_difference(expected.rig.vertices(), after.vertices())
    check(off <= CLOSE * size_of(before.vertices()), f"off by {off}")


def broken(change):
    arm = Arm()
    change(arm)
    return arm


def cycle(arm):
    arm["hand"]["children"] = [arm.names["shoulder"]]


def two_parents(arm):
    arm["car"]["children"].append(arm.names["elbow"])


def short_binds(arm):
    arm.asset["skins"][0]["inverseBindMatrices"] = arm.matrices(arm.binds[:2])


def binds_of_vectors(arm):
    arm.asset["skins"][0]["inverseBindMatrices"] = arm.add([[0.0, 0.0, 0.0]] * 3)


def sampler(**members):
    def change(arm):
        arm.asset["animations"][0]["samplers"][0] |= {key: make(arm) for key, make in members.items()}
    return change


def no_rotation(arm):
    arm["elbow"]["rotation"] = [0, 0, 0, 0]


def animated_matrix(arm):
    del arm["axle"]["translation"], arm["axle"]["rotation"]
    arm["axle"]["matrix"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.4, 0.1, -0.2, 1]


def far_binds(arm):
    arm.asset["skins"][0]["inverseBindMatrices"] = arm.add([[LARGE] * 15 + [1.0]] * 3, shape="MAT4")


def wrong_target(arm):
    arm.asset["animations"][0]["channels"][0]["target"]["node"] = 999


def unknown_path(arm):
    arm.asset["animations"][0]["channels"][0]["target"]["path"] = "colour"


BROKEN = {
    "a cycle": cycle, "two parents": two_parents, "too few inverse binds": short_binds, "inverse binds of vectors": binds_of_vectors,
    "keys without values": sampler(output=lambda arm: arm.add([[0, 0, 0, 1.0]], shape="VEC4")),
    "values of another shape": sampler(output=lambda arm: arm.add([[0, 0, 0.0]] * 4)),
    "times that fall": sampler(input=lambda arm: arm.add([[0.0], [2.0], [1.0], [3.0]], shape="SCALAR")),
    "times that are no numbers": sampler(input=lambda arm: arm.add([[0.0], [NAN], [1.0], [3.0]], shape="SCALAR")),
    "values that are no numbers": sampler(output=lambda arm: arm.add([[NAN] * 4] * 4, shape="VEC4")),
    "values that are huge": sampler(output=lambda arm: arm.add([[LARGE] * 4] * 4, shape="VEC4")),
    "an unknown interpolation": sampler(interpolation=lambda arm: "BOUNCE"),
    "an accessor that is not there": sampler(output=lambda arm: 10 ** 6),
    "a rotation that is none": no_rotation, "an animated matrix": animated_matrix, "huge inverse binds": far_binds,
    "a node that is not there": wrong_target, "an unknown path": unknown_path,
    "no keys": sampler(input=lambda arm: arm.add([], shape="SCALAR"), output=lambda arm: arm.add([], shape="VEC4")),
}


@case
def broken_rigs_have_a_clear_end(run):
    """An exit code of what is not valid, with one line that names the file; or a file that is whole."""
    run.write("l.json", text(BENT.volumes[0]))
    for name, change in BROKEN.items():
        run.write("a.glb", broken(change).glb())
        plain = run.ffd("deform", "a.glb", "k.glb", "-l", "l.json", "--force", "-q", code=(OK, INVALID), err=anything)
        done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--rig", "follow", "--force", code=(OK, INVALID, LIMIT), err=anything)
        print(f"{name}: exit {plain.code} with keep, {done.code}: {' | '.join(done.err)}")
        equal(run.exists("b.glb"), done.code == OK, name)
        if done.code != OK:
            equal(len(done.err), 1, name)
            check("a.glb" in done.err[0], done.err[0])
            check(plain.code == OK or plain.err == done.err, f"{name}: {plain.err} with keep")
        run.remove("b.glb")


def many(joints, deep, keys=2):
    """A skin of so many joints, in a chain or side by side, each with a channel, all with one sampler: no two of these may
    share its values any longer where the deformation turns each joint otherwise."""
    arm = Arm(animated=False)
    first = len(arm.asset["nodes"])
    nodes = [{"rotation": [0, 0, 0.1, 0.99498743710662], "translation": [1e-3 if deep else 3 * i / joints, 0, 0]}
             for i in range(joints)]
    if deep:
        for i in range(joints - 1):
            nodes[i]["children"] = [first + i + 1]
    arm.asset["nodes"] += nodes
    arm["root"]["children"] += [first] if deep else range(first, first + joints)
    arm.asset["skins"][0] = {"joints": list(range(first, first + joints))}
    times = arm.times([0.1 * i for i in range(keys)])
    output = arm.add([turns((0, 0, 1), [i])[0] for i in range(keys)], shape="VEC4")
    arm.asset["animations"] = [{"samplers": [{"input": times, "output": output}], "channels": [
        {"sampler": 0, "target": {"node": first + i, "path": "rotation"}} for i in range(joints)]}]
    return arm


def seconds(run, *words, **expected):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = run.ffd(*words, env=dict(os.environ), err=anything, **expected)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done


@case
def many_joints_take_time_as_the_file_does(run):
    """Four times as many take four times as long, with room for noise."""
    run.write("l.json", text(BENT.volumes[0]))
    for deep in (False, True):
        taken = []
        for joints in MANY:
            run.write("a.glb", many(joints, deep).glb())
            time, done = seconds(run, "deform", "a.glb", "b.glb", "-l", "l.json", "--rig", "follow", "--force")
            taken.append(time)
            print(f"{joints} joints, {'a chain' if deep else 'side by side'}: {time:.2f} s; {done.err[:3]}")
        check(taken[1] <= 8 * taken[0] + 0.2 * SLOW and taken[1] <= SLOW * (4e-5 * MANY[1] + 0.2), f"{taken} s")


@case
def keys_of_one_sampler_that_become_those_of_many_are_limited(run):
    """A megabyte would become gigabytes: ten thousand channels, each of which wants ten thousand keys of its own."""
    run.write("l.json", text(BENT.volumes[0]))
    run.write("a.glb", many(10_000, False, keys=10_000).glb())
    time, done = seconds(run, "deform", "a.glb", "b.glb", "-l", "l.json", "--rig", "follow", code=LIMIT)
    check(time < SLOW * 3 and not run.exists("b.glb"), f"{time} s; {done.err}")
    one_line(done, "a.glb")


@case
def what_is_not_a_rig_is_no_matter(run):
    """Files without a scene, with an empty animation, with a skin that no mesh has."""
    for change in (lambda asset: (asset.pop("scene"), asset.pop("scenes")),
                   lambda asset: asset["animations"].append({"channels": [], "samplers": []}),
                   lambda asset: asset["skins"].append({"joints": [1]})):
        arm = Arm()
        change(arm.asset)
        _, after, _ = deformed(run, arm, BENT, code=(OK, INVALID))
        if run.exists("b.glb"):
            finite(after)
            run.remove("b.glb")


main()
