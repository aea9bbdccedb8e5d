#!/usr/bin/env python3
"""--rig follow on rigs drawn at random, against the rule that was written apart from the program: every vertex and node in the
default pose and at some times of each animation. FFD_SEED=N begins with another rig, FFD_CASES=N takes more of them."""

import math
import os
import random

from drawn import Drawn, drawn_deformation
from follow import deformed, is_kept, moves_as
from harness import case, check, equal, main, repetitions
from pose import largest_difference, size_of
from rule import Following

SEED = int(os.environ.get("FFD_SEED") or random.SystemRandom().randrange(1 << 32))
CASES = int(os.environ.get("FFD_CASES") or repetitions(40))
CLOSE = 1e-5  # of the size: joints lie on each other by chance, and far away on long chains
NO_RIG = 4265319691  # neither joints, animated pivots nor sockets where the lattice is: only groups, which would be sheared
print(f"FFD_SEED={SEED}")


@case
def drawn_rigs_follow_the_rule(run):
    sheared = 0
    for seed in (NO_RIG, *range(SEED, SEED + CASES)):
        name, draw = f"FFD_SEED={seed}", random.Random(seed)
        rig, deformation = Drawn(draw, uneven=draw.random() < 0.3), drawn_deformation(draw)
        before, after, job = deformed(run, rig, deformation)
        expected = Following(before, deformation)
        moves_as(expected.rig, after, CLOSE, name, count=3)
        is_kept(before, after)
        equal(job.get("rig", {"sheared": 0})["sheared"], len(expected.sheared), f"{name}: sheared")
        sheared += bool(expected.sheared)
        _, kept, _ = deformed(run, rig, deformation, rig="keep", out="k.glb")
        off = largest_difference(kept.vertices(), after.vertices()) / size_of(kept.vertices())
        check(off <= CLOSE, f"{name}: the default pose differs by {off:.3g} from that of keep")
        off = largest_difference(kept.directions(), after.directions())
        check(off <= CLOSE, f"{name}: a normal or tangent differs by {off:.3g} from that of keep")
    print(f"{CASES} rigs, {sheared} of them with nodes that would be sheared")


@case
def what_is_not_selected_keeps_its_default_pose(run):
    """Of rigs of which one node is selected: as with keep, whoever shares its skin, hangs on its joints or is one."""
    for seed in range(SEED, SEED + CASES // 2):
        name, draw = f"FFD_SEED={seed}", random.Random(seed)
        rig, deformation = Drawn(draw, uneven=draw.random() < 0.3), drawn_deformation(draw)
        one = draw.choice([node["name"] for node in rig.asset["nodes"] if "mesh" in node])
        _, after, _ = deformed(run, rig, deformation, "--only", f"node:{one}")
        _, kept, _ = deformed(run, rig, deformation, "--only", f"node:{one}", rig="keep", out="k.glb")
        size, shown = size_of(kept.vertices()), after.vertices()
        for key, points in kept.vertices().items():
            off = max(map(math.dist, points, shown[key])) / size
            check(off <= CLOSE, f"{name}, --only node:{one}: {kept.nodes[key[0]].name} is off by {off:.3g}")


main()
