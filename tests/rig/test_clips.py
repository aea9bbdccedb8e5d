#!/usr/bin/env python3
"""A clip of --morph and --clip, played: at twenty times the slow evaluator and three.js show what plain deformations by each
lattice, added with the clip's weights, give.

FFD_NODE names the folder whose node_modules holds three; without it only the evaluator is asked.
"""

import math

import viewer
from cases import BENT, WAVED, text
from harness import case, check, equal, main
from made import Arm, posed
from pose import Rig, size_of
from messages import anything
from shown import difference

CLOSE = 1e-6  # of the size
CLIP = [(0.0, {"squash": 1}), (0.2, {"stretch": 1, "squash": 0.5}), (0.5, {}), (0.75, {"stretch": -0.25})]
LATTICES = {"squash": BENT, "stretch": WAVED}


def words(clip):
    return "hop: " + ", ".join(" ".join([repr(time), *(f"{name}={weight}" for name, weight in weights.items())])
                               for time, weights in clip)


def weight_at(clip, name, time):
    """LINEAR; a name that a time does not have is 0."""
    times = [t for t, _ in clip]
    if time >= times[-1]:
        return clip[-1][1].get(name, 0)
    k = max(i for i, t in enumerate(times) if t <= time) if time >= times[0] else 0
    s = max(0.0, (time - times[k]) / (times[k + 1] - times[k]))
    a, b = (clip[i][1].get(name, 0) for i in (k, k + 1))
    return a + s * (b - a)


def times_of(clip, count=20):
    return [clip[0][0] + (clip[-1][0] - clip[0][0]) * i / (count - 1) for i in range(count)]


def made(run, asset, *options):
    """The file with the clip, the file before, and the file deformed by each lattice."""
    run.write("a.glb", asset.glb())
    chosen = []
    for name, deformation in LATTICES.items():
        run.write(f"{name}.json", text(deformation.volumes[0]))
        run.ffd("deform", "a.glb", f"{name}.glb", "-l", f"{name}.json", "--force", err=anything)
        chosen += ["--morph", f"{name}={name}.json"]
    run.ffd("deform", "a.glb", "b.glb", *chosen, "--clip", words(CLIP), *options, "--force", err=anything)
    return Rig(run.path("b.glb")), Rig(run.path("a.glb")), {name: Rig(run.path(f"{name}.glb")) for name in LATTICES}


def animation_of(rig, name):
    return [animation.get("name") for animation in rig.asset["animations"]].index(name)


def wanted(before, targets, time):
    """Base and plain deformations, added up."""
    base, weights = before.vertices(), {name: weight_at(CLIP, name, time) for name in targets}
    shapes = {name: rig.vertices() for name, rig in targets.items()}
    return {key: [tuple(x + sum(w * (shapes[name][key][i][a] - x) for name, w in weights.items()) for a, x in enumerate(p))
                  for i, p in enumerate(points)] for key, points in base.items()}


def plays(rig, before, targets, path):
    clip = animation_of(rig, "hop")
    size = size_of(before.vertices())
    for time in times_of(CLIP):
        found, right = rig.vertices(clip, time), wanted(before, targets, time)
        off = max(math.dist(p, q) for key in right for p, q in zip(right[key], found[key], strict=True)) / size
        check(off <= 3 * CLOSE, f"at {time} a vertex is off by {off:.3g} of the size")
    if viewer.missing():
        print("three.js is not asked:", viewer.missing())
        return
    poses = [(clip, time) for time in times_of(CLIP)]
    off = difference(rig, poses, 1, viewer.shown([(path, poses, 1)])[0])
    check(off <= CLOSE, f"three.js: off by {off:.3g} of the size")


@case
def a_clip_of_two_shapes_shows_their_sum(run):
    """Of a mesh under nodes that are turned and scaled, and of a skin in a pose."""
    for arm in (Arm(animated=False), posed(plain_in_a_turned_root())):
        rig, before, targets = made(run, arm)
        plays(rig, before, targets, run.path("b.glb"))
        equal(rig.vertices(), before.vertices(), "at rest it is what it was")


def plain_in_a_turned_root():
    return Arm(animated=False, rotation=[0.6, 0, 0, 0.8], scale=[1.2, 1.2, 1.2])


@case
def targets_that_were_there_keep_their_weights(run):
    """With default weights of the mesh: the clip shows them too."""
    arm = Arm(animated=False, morphs=True)
    arm.asset["meshes"][0]["weights"] = [0.3, 0.0]
    rig, before, _ = made(run, arm)
    clip = animation_of(rig, "hop")
    key = next(key for key in rig.shapes if rig.nodes[key[0]].name == "skin")
    equal(len(rig.shapes[key].targets), 4, "targets")
    off = max(map(math.dist, rig.vertices(clip, 0.5)[key], before.vertices()[key]))
    check(off < 1e-6, f"where all weights of the clip are 0 the shape is off by {off:.3g}")


main()
