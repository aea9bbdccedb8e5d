#!/usr/bin/env python3
"""Real characters, deformed with --rig follow, move as one under a motion of everything, and do not tear when they are bent:
at ten times of each animation 99 in 100 edges are stretched by less than 1.25 beyond what the animation does to the character
as it was. The same with --rig keep tears them, or the test would say nothing.

FFD_MODELS names the sample models.
"""

import math
import os
import random
import sys

from bspline import BoxVolume
from cases import LARGER, affine, text
from harness import case, check, main
from matrices import apply, origin
from pose import Rig, largest_difference, size_of
from messages import anything

MOST = 300  # edges looked at, of each character
TIMES = 10
LIMIT = 1.25


def larger(low, high):
    """1.4 times as tall, and broader above than below."""
    def move(p):
        up = (p[1] - low[1]) / (high[1] - low[1])
        return [0.3 * up * (p[0] - (low[0] + high[0]) / 2), 0.4 * (p[1] - low[1]), 0.2 * up * (p[2] - (low[2] + high[2]) / 2)]
    return move


def swung(low, high):
    """Bent sideways, and forwards at the ends."""
    def move(p):
        up, side = ((p[a] - low[a]) / (high[a] - low[a]) for a in (1, 0))
        return [0.25 * (high[1] - low[1]) * up * up, 0, 0.3 * (high[0] - low[0]) * (side - 0.5) ** 2]
    return move


SHAPES = {"larger": larger, "swung": swung}
FOX, FIGURE = "gltf/khronos/Fox/glTF-Binary/Fox.glb", "gltf/khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb"
KNIGHT = "gltf/kaykit-adv/Characters/gltf/Knight.glb"
OTHERS = ["gltf/kenney/character.glb", "gltf/khronos/SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
          "gltf/khronos/BoxAnimated/glTF/BoxAnimated.gltf", "gltf/khronos/InterpolationTest/glTF-Binary/InterpolationTest.glb",
          "gltf/assetgen/Positive/Animation_Skin/Animation_Skin_04.gltf",
          "gltf/khronos/AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb"]


def path_of(name):
    return os.path.join(os.environ["FFD_MODELS"], *name.split("/"))


def bounds(positions, margin=0.03):
    points = [p for some in positions.values() for p in some]
    low, high = ([edge(c) for c in zip(*points)] for edge in (min, max))
    add = [margin * (b - a) + 1e-3 * max(map(abs, low + high)) for a, b in zip(low, high)]
    return [a - d for a, d in zip(low, add)], [b + d for b, d in zip(high, add)]


def chosen_edges(rig):
    """Some edges, and the vertices that they need: (key, number of the one, number of the other), key -> vertices."""
    edges = [(key, a, b) for key, shape in rig.shapes.items() for a, b in shape.edges]
    edges = random.Random(1).sample(edges, min(MOST, len(edges)))
    needed = {key: sorted({i for k, a, b in edges if k == key for i in (a, b)}) for key in rig.shapes}
    place = {key: {v: i for i, v in enumerate(vertices)} for key, vertices in needed.items()}
    return [(key, place[key][a], place[key][b]) for key, a, b in edges], needed


def lengths(rig, edges, needed, pose=(None, 0.0)):
    positions = rig.vertices(*pose, needed)
    return [math.dist(positions[key][a], positions[key][b]) for key, a, b in edges]


def worst_stretch(before, after, step, known):
    """Of 99 in 100 edges the most by which one is stretched more than in the original, over all poses of every step-th
    animation; and where. known: pose -> lengths in the original."""
    edges, needed = chosen_edges(before)
    rest, new_rest = lengths(before, edges, needed), lengths(after, edges, needed)
    tiny = 1e-3 * sum(rest) / len(rest)
    worst = 0.0, None
    for animation in range(0, len(before.animations), step):
        for time in before.times(animation, TIMES):
            pose = animation, time
            old = known[pose] = known.get(pose) or lengths(before, edges, needed, pose)
            new = lengths(after, edges, needed, pose)
            ratios = sorted(n / nr / (o / r) for o, n, r, nr in zip(old, new, rest, new_rest) if min(o, n, r, nr) > tiny)
            worst = max(worst, (ratios[int(0.99 * (len(ratios) - 1))], pose))
    return worst


def holds_together(run, name, step_of_keep=1):
    """Prints the stretches; those with keep."""
    path, kept, known = path_of(name), [], {}
    before = Rig(path)
    low, high = bounds(before.vertices())
    for shape, make in SHAPES.items():
        run.write("l.json", text(BoxVolume(low, high, make(low, high))))
        for rig in ("follow", "keep"):
            run.ffd("deform", path, "b.glb", "-l", "l.json", "--rig", rig, "--force", err=anything)
            stretch, pose = worst_stretch(before, Rig(run.path("b.glb")), step_of_keep if rig == "keep" else 1, known)
            print(f"{os.path.basename(name)}, {shape}, {rig}: {stretch:.3f} at {pose}")
            kept += [stretch] if rig == "keep" else []
            check(rig == "keep" or stretch < LIMIT, f"{name}, {shape}: stretched by {stretch:.3f} at {pose}")
    return kept


@case
def characters_do_not_tear(run):
    check(max(holds_together(run, FOX) + holds_together(run, FIGURE)) > 2, "keep tears, or the test is blind")


@case
def a_character_of_many_animations_does_not_tear(run):
    check(max(holds_together(run, KNIGHT, 8)) > 1.5, "keep tears, or the test is blind")


def move_as_one(run, names):
    """Turned and made larger, at three times of each animation; of large models some vertices are looked at."""
    for name in names:
        path = path_of(name)
        before = Rig(path)
        low, high = bounds({**before.vertices(), "nodes": [origin(m) for m in before.worlds()]})
        run.write("l.json", text(affine(LARGER, low=low, high=high, size=(2, 2, 2), degree=(1, 1, 1))))
        run.ffd("deform", path, "b.glb", "-l", "l.json", "--rig", "follow", "--force", err=anything)
        after = Rig(run.path("b.glb"))
        chosen = {key: range(0, len(shape.positions), 1 + len(shape.positions) // 100) for key, shape in before.shapes.items()}
        worst = 0.0
        for pose in [(None, 0.0)] + [(a, t) for a in range(min(4, len(before.animations))) for t in before.times(a, 3)]:
            wanted = {key: [apply(LARGER, p) for p in points] for key, points in before.vertices(*pose, chosen).items()}
            worst = max(worst, largest_difference(wanted, after.vertices(*pose, chosen)) / size_of(wanted))
        print(f"{os.path.basename(name)}: off by {worst:.2g} of the size")
        check(worst < 1e-5, f"{name}: off by {worst:.3g}")


@case
def real_rigs_move_as_one(run):
    move_as_one(run, [FOX, FIGURE, *OTHERS])


@case
def large_rigs_move_as_one(run):
    move_as_one(run, [KNIGHT, "gltf/derived/Knight_quantized.glb"])


if not os.environ.get("FFD_MODELS"):
    print("SKIP: models: FFD_MODELS is not set")
    sys.exit(77)
if __name__ == "__main__":
    main()
