#!/usr/bin/env python3
"""The slow evaluator of this folder (pose.py) and three.js show the same vertices of the sample models at five times of
their animations: two readings of the format that have nothing in common. The tests of rigs stand on the first.

FFD_NODE names the folder whose node_modules holds three.
"""

import os
import sys

import viewer
from pose import Rig
from shown import difference, poses_of

SKIPPED = 77
MODELS = ["gltf/kenney/character.glb", "gltf/khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb", "gltf/khronos/Fox/glTF/Fox.gltf",
          "gltf/khronos/InterpolationTest/glTF-Binary/InterpolationTest.glb", "gltf/khronos/SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
          "gltf/khronos/AnimatedMorphCube/glTF-Quantized/AnimatedMorphCube.gltf", "gltf/khronos/BoxAnimated/glTF/BoxAnimated.gltf",
          "gltf/assetgen/Positive/Animation_Skin/Animation_Skin_04.gltf", "gltf/assetgen/Positive/Instancing/Instancing_08.gltf",
          "gltf/derived/MorphPrimitivesTest_sparse.glb", "gltf/derived/Knight_quantized.glb"]
MOST = 300  # vertices looked at, of each model
CLOSE = 1e-6  # of the size: three.js keeps keys, weights and inverse binds in single precision


def main():
    reason = viewer.missing() or (None if os.environ.get("FFD_MODELS") else "models: FFD_MODELS is not set")
    if reason:
        print(f"SKIP: {reason}")
        sys.exit(SKIPPED)
    paths = [os.path.join(os.environ["FFD_MODELS"], *name.split("/")) for name in MODELS]
    rigs = [Rig(path) for path in paths]
    jobs = [(path, poses_of(rig), 1 + sum(len(shape.positions) for shape in rig.shapes.values()) // MOST)
            for path, rig in zip(paths, rigs)]
    failed = 0
    for name, rig, (_, poses, step), shown in zip(MODELS, rigs, jobs, viewer.shown(jobs), strict=True):
        worst = difference(rig, poses, step, shown)
        failed += worst > CLOSE
        print(f"{name}: {len(poses)} poses, every {step}. vertex, off by {worst:.2g} of the size{'' if worst <= CLOSE else '  FAILED'}")
    sys.exit(1 if failed else 0)


main()
