#!/usr/bin/env python3
"""What --rig follow writes is valid in the eyes of the Khronos validator and moves the same in three.js as in the slow
evaluator, at five times of each animation.

FFD_NODE names the folder whose node_modules holds three and gltf-validator.
"""

import math
import os
import sys

import validate
import viewer
from cases import ARMS, BENT, LARGER, RIGID, affine, text
from follow import deformed
from harness import case, check, equal, main
from matrices import apply
from pose import Rig
from rule import Deformation
from messages import anything
from shown import difference, poses_of

CLOSE = 2e-6  # of the size: three.js keeps keys, weights and inverse binds in single precision
MODELS = ["gltf/khronos/Fox/glTF-Binary/Fox.glb", "gltf/khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb", "gltf/kenney/character.glb",
          "gltf/derived/Knight_quantized.glb"]


@case
def rigs_that_follow_are_valid_and_move_the_same_in_a_viewer(run):
    made = []
    for name, make in ARMS.items():
        for number, deformation in enumerate((BENT, Deformation(affine(RIGID)))):
            if number == 1 and name not in ("plain", "uneven"):
                continue
            before, after = f"a{len(made)}.glb", f"b{len(made)}.glb"
            deformed(run, make(), deformation, out=after)
            os.rename(run.path("a.glb"), run.path(before))
            made.append((name, run.path(before), run.path(after)))
    for name in MODELS if os.environ.get("FFD_MODELS") else []:
        path, after = os.path.join(os.environ["FFD_MODELS"], *name.split("/")), f"b{len(made)}.glb"
        run.write("m.json", {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh", "margin": 0.05},
                             "moves": [{"twist": {"axis": "y", "degrees": 50}}, {"at": ["all", -1, "all"], "scale": {"factor": 1.3}}]})
        run.ffd("deform", path, after, "-l", "m.json", "--rig", "follow", err=anything)
        made.append((name, path, run.path(after)))
    found = validate.validate(os.environ["FFD_NODE"], [path for _, *pair in made for path in pair])
    for name, before, after in made:
        equal(validate.judge(found[before], found[after]), "", name)
    moves_the_same([(name, after) for name, _, after in made if name != "pointers"])


def moves_the_same(files):
    rigs = [Rig(path) for _, path in files]
    steps = [1 + sum(len(shape.positions) for shape in rig.shapes.values()) // 300 for rig in rigs]
    jobs = [(path, poses_of(rig), step) for (_, path), rig, step in zip(files, rigs, steps)]
    for (name, _), rig, job, answer in zip(files, rigs, jobs, viewer.shown(jobs), strict=True):
        off = difference(rig, job[1], job[2], answer)
        check(off <= CLOSE, f"{name}: off by {off:.3g} of the size in three.js")


@case
def compressed_rigs_move_as_one(run):
    """Only three.js can read what meshopt has made of keys: before and after, at three times of each animation."""
    if not os.environ.get("FFD_MODELS"):
        return
    path = os.path.join(os.environ["FFD_MODELS"], "gltf", "derived", "Fox_meshopt.glb")
    run.write("l.json", text(affine(LARGER, low=(-400, -400, -400), high=(400, 400, 400), size=(2, 2, 2), degree=(1, 1, 1))))
    run.ffd("deform", path, "b.glb", "-l", "l.json", "--rig", "follow", err=anything)
    poses = [(None, 0)] + [(a, t) for a in range(3) for t in (0.1, 0.4, 0.7)]
    before, after = ([p for pose in answer for mesh in pose for p in mesh]
                     for answer in viewer.shown([(path, poses, 5), (run.path("b.glb"), poses, 5)]))
    size = math.dist(*([edge(c) for c in zip(*after)] for edge in (min, max)))
    off = max(math.dist(apply(LARGER, p), q) for p, q in zip(before, after, strict=True)) / size
    check(off <= CLOSE, f"off by {off:.3g} of the size")


reason = viewer.missing()
if reason:
    print(f"SKIP: {reason}")
    sys.exit(validate.SKIPPED)
main()
