#!/usr/bin/env python3
"""Skin weights that do not sum to 1 are divided by their sum, and a vertex without any follows its first joint."""
from gltf_build import SHEAR, Scene
from harness import case, equal, glb_split, gltf_vectors, main, near
from said import anything, entry, not_told, told

POINTS = [[0.0, 1.0, 0.0], [1.0, 2.0, 0.0], [1.0, -1.0, 1.0], [2.0, 1.0, 1.0]]


def skinned(run, weights, joints, *options):
    """Two joints, at x = 3 and x = -4. What is said, and the vertices after x' = x + 0.05 x y in the scene."""
    made = Scene(nodes=[{"mesh": 0, "skin": 0}, {"name": "a", "translation": [3, 0, 0]}, {"name": "b", "translation": [-4, 0, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1, 2]}], skins=[{"joints": [1, 2]}])
    made.asset["meshes"] = [{"primitives": [{"mode": 0, "attributes": {
        "POSITION": made.add(POINTS, bounds=True), "JOINTS_0": made.add(joints, component=5121, shape="VEC4"),
        "WEIGHTS_0": made.add(weights, shape="VEC4")}}]}]
    run.write("a.glb", made.glb())
    run.write("l.json", SHEAR)
    done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", *options, err=anything)
    return done, gltf_vectors(*glb_split(run.read("b.glb")), 0)


def sheared(shifts):
    return [[x + 0.05 * (x + shift) * y, y, z] for (x, y, z), shift in zip(POINTS, shifts)]


BOTH = [[0, 1, 0, 0]] * 4


@case
def weights_are_divided_by_their_sum(run):
    """Half and half, of sums 1, 0.4 and 4, stands in the middle; three quarters and one, of 0.4, where those of 1 would."""
    done, found = skinned(run, [[0.5, 0.5, 0, 0], [0.2, 0.2, 0, 0], [2, 2, 0, 0], [0.3, 0.1, 0, 0]], BOTH)
    near(found, sheared([-0.5, -0.5, -0.5, 1.25]), 1e-6)
    told(done, r"\b3\b", "weights", r"\bsum\b")
    job = entry(run, "check", "a.glb", "-l", "l.json")["skin_weights"]
    equal([job["off"], job["none"]], [3, 0])
    near([job["farthest"]], [3], 1e-6)


@case
def small_deviations_are_said_with_v_and_large_ones_always(run):
    _, found = skinned(run, [[0.995, 0, 0, 0], [1.005, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]], BOTH)
    near(found, sheared([3, 3, 3, -4]), 1e-6)
    done, _ = skinned(run, [[0.985, 0, 0, 0], [1.015, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]], BOTH)
    told(done, r"\b2\b", "weights", r"\bsum\b")
    done, _ = skinned(run, [[0.995, 0, 0, 0], [1.005, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]], BOTH, "-v")
    told(done, r"\b2\b", "weights", r"\bsum\b")


@case
def a_vertex_without_weights_follows_its_first_joint(run):
    done, found = skinned(run, [[0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]],
                          [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 1, 1]])
    near(found, sheared([3, -4, 3, -4]), 1e-6)
    not_told(done, r"\bstay\b", "matrix")
    told(done, r"\b3\b", "weights", "first joint")
    equal(entry(run, "check", "a.glb", "-l", "l.json")["skin_weights"], {"off": 0, "farthest": 0, "none": 3})


@case
def weights_that_sum_to_one_are_not_mentioned(run):
    done, _ = skinned(run, [[0.5, 0.5, 0, 0], [0.1, 0.9, 0, 0], [1, 0, 0, 0], [1 / 3, 2 / 3, 0, 0]], BOTH, "-v")
    not_told(done, "weights")
    equal("skin_weights" in entry(run, "check", "a.glb", "-l", "l.json"), False)


main()
