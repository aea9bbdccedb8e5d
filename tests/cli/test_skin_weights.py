#!/usr/bin/env python3
"""Skin weights that do not sum to 1 are divided by their sum, and a vertex without any follows its first joint."""
from gltf_build import SHEAR, Scene
from harness import INVALID, case, equal, glb_split, gltf_vectors, lattice, main, near, obj_vertices
from messages import anything, entry, no_line, one_line

STILL = lattice(low=(-10, -10, -10), high=(10, 10, 10))
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
    one_line(done, r"\b3\b", "weights", r"\bsum\b")
    job = entry(run, "check", "a.glb", "-l", "l.json")["skin_weights"]
    equal([job["off"], job["none"]], [3, 0])
    near([job["farthest"]], [3], 1e-6)


@case
def joints_beyond_the_skin_without_a_weight_are_plain(run):
    """They have no say; one with a weight is refused, and so is the first one of a vertex that no joint moves."""
    _, expected = skinned(run, [[1, 0, 0, 0]] * 4, BOTH)
    done, found = skinned(run, [[1, 0, 0, 0]] * 4, [[0, 255, 2, 255]] * 4)
    equal(found, expected)
    flaw = "names joint 255 without a weight, but the skin has only 2"
    equal([line for line in done.err if "joint" in line], [f"a.glb: /accessors/1: {flaw}"])
    run.ffd("deform", "a.glb", "c.glb", "-l", "l.json", "--strict", code=INVALID, err=f"a.glb:/accessors/1: {flaw}")
    for weights, joints in (([0.5, 0, 0.5, 0], [0, 1, 2, 0]), ([0, 0, 0, 0], [7, 0, 0, 0])):
        made = Scene(nodes=[{"mesh": 0, "skin": 0}, {}, {}], scene=0, scenes=[{"nodes": [0, 1, 2]}], skins=[{"joints": [1, 2]}])
        made.asset["meshes"] = [{"primitives": [{"mode": 0, "attributes": {
            "POSITION": made.add(POINTS, bounds=True), "JOINTS_0": made.add([joints] * 4, component=5121, shape="VEC4"),
            "WEIGHTS_0": made.add([weights] * 4, shape="VEC4")}}]}]
        run.write("a.glb", made.glb())
        run.ffd("deform", "a.glb", "c.glb", "-l", "l.json", code=INVALID,
                err=f"a.glb:/accessors/1: names joint {max(joints)}, but the skin has only 2")
        equal(run.ffd("info", "a.glb", "--json").json["positions_unknown"],
              f"/accessors/1: names joint {max(joints)}, but the skin has only 2")


@case
def every_command_says_what_weights_are_not(run):
    """In one line a kind, in "flaws", and with --strict exit 4; the words are those of what happens."""
    one, inf = [1, 0, 0, 0], float("inf")
    for weights, kinds in (([0.995, 0, 0, 0], ["vertex 1 sum to 0.995"]), ([2e-6 + 1, 0, 0, 0], ["not 1: they are divided"]),
                           ([1.5, -0.5, 0, 0], ["vertex 1 has a negative weight, -0.5"]),
                           ([1, -1, 0, 0], ["negative weight, -1", "vertex 1 sum to 0, not 1: it follows its first joint"]),
                           ([inf, 1, 0, 0], ["weights of vertex 1 are not finite: it has no place"])):
        done, _ = skinned(run, [one, weights, one, one], BOTH)
        words = [("deform", "a.glb", "c.glb", "-l", "l.json"), ("info", "a.glb"), ("check", "a.glb", "-l", "l.json"),
                 ("lattice", "new", "a.glb", "-o", "n.json"), ("view", "a.glb", "-o", "v.html")]
        for command in words:
            done = run.ffd(*command, *([] if command[0] in ("info", "check") else ["--force"]), err=anything, data=True)
            equal(len([line for line in done.err if "weight" in line]), len(kinds), f"{command}: {done.err}")
            for kind in kinds:
                one_line(done, "a.glb: /accessors/2: ", kind)
        equal(len(entry(run, "deform", "a.glb", "c.glb", "-l", "l.json")["flaws"]), len(kinds))
        for command in words[:2]:
            done = run.ffd(*command, "--strict", *(["--force"] if command[0] == "deform" else []), code=INVALID, err=anything)
            one_line(done, "a.glb:/accessors/2: ", kinds[0])
    # Rounding is none.
    done, _ = skinned(run, [one, [1 / 3, 2 / 3, 0, 0], [0.1, 0.9, 0, 0], one], BOTH, "--strict")
    no_line(done, "weights")


@case
def figures_are_those_of_finite_weights(run):
    skinned(run, [[float("inf"), 1, 0, 0], [0.5, 0, 0, 0], [1, -1, 0, 0], [1, 0, 0, 0]], BOTH)
    job = entry(run, "check", "a.glb", "-l", "l.json")
    equal(job["skin_weights"], {"off": 1, "farthest": 0.5, "none": 1})
    equal(job["invalid"], 1)


def parts(run, sets, *options, node=None, code=0):
    """A primitive for each set of attributes, below a node at x = 3 with a skin whose joint is at x = -4; the vertices after."""
    made = Scene(nodes=[{"mesh": 0, "skin": 0, "translation": [3, 0, 0]}, {"name": "b", "translation": [-4, 0, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1]}], skins=[{"joints": [1]}])
    of = {"JOINTS": lambda: made.add([[0, 0, 0, 0]] * 4, component=5121, shape="VEC4"),
          "WEIGHTS": lambda: made.add([[1.0, 0, 0, 0]] * 4, shape="VEC4")}
    made.asset["meshes"] = [{"primitives": [{"mode": 0, "attributes": {
        "POSITION": made.add(POINTS, bounds=True), **{name: of[name[:-2]]() for name in names}}} for names in sets]}]
    made.asset["nodes"][0] |= node or {}
    run.write("a.glb", made.glb())
    run.write("l.json", SHEAR)
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", *options, code=code, err=anything)
    if code:
        return None
    asset, data = glb_split(run.read("b.glb"))
    return [gltf_vectors(asset, data, p["attributes"]["POSITION"]) for p in asset["meshes"][0]["primitives"]]


WHOLE, PLAIN = ("JOINTS_0", "WEIGHTS_0"), ()


@case
def a_primitive_without_joints_is_placed_by_its_node(run):
    """As viewers show it, though the node has a skin; beside one that the skin moves, which its joint places."""
    for sets, shifts, flaws in (([PLAIN], [3], 1), ([WHOLE, PLAIN], [-4, 3], 1), ([PLAIN, WHOLE, PLAIN], [3, -4, 3], 1),
                                ([("JOINTS_0",)], [3], 1), ([("WEIGHTS_0",), WHOLE], [3, -4], 1), ([WHOLE], [-4], 0)):
        found = parts(run, sets)
        near(found, [sheared([shift] * 4) for shift in shifts], 1e-6, str(sets))
        job = entry(run, "deform", "a.glb", "b.glb", "-l", "l.json")
        equal(len(job.get("flaws", [])), flaws, str(sets))
        run.ffd("deform", "a.glb", "strict.glb", "--force", "-l", "l.json", "--strict", code=INVALID if flaws else 0, err=anything)
        done = run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", "--force", err=anything)
        equal(len([line for line in done.err if "without the skin" in line]), flaws, str(sets))
        near(sorted(obj_vertices(run.text("b.obj"))), sorted(
            [x + 0.05 * (x + shift) * y + shift, y, z] for shift in shifts for x, y, z in POINTS), 1e-5, str(sets))


@case
def a_last_set_with_joints_or_weights_only_is_ignored(run):
    for more in (("JOINTS_1",), ("WEIGHTS_1",), ("JOINTS_1", "WEIGHTS_2")):
        near(parts(run, [WHOLE + more]), [sheared([-4] * 4)], 1e-6, str(more))
        flaws = entry(run, "deform", "a.glb", "b.glb", "-l", "l.json")["flaws"]
        equal([flaws[0]["pointer"], flaws[0]["message"].split()[0]], [f"/meshes/0/primitives/0/attributes/{more[0]}", more[0]])
    # One before a whole set means nothing plain.
    equal(parts(run, [WHOLE + ("JOINTS_1", "JOINTS_2", "WEIGHTS_2")], code=INVALID), None)


@case
def a_node_that_places_a_primitive_follows(run):
    """--rig follow moves the node of a primitive that its skin does not move, and the default pose is that of keep."""
    for sets in ([PLAIN], [WHOLE, PLAIN]):
        for node in ({}, {"name": "body", "rotation": [0, 0, 0.6, 0.8]}):
            kept = parts(run, sets, node=node)
            shown = []
            for rig in ("keep", "follow"):
                parts(run, sets, "--rig", rig, node=node)
                run.write("still.json", STILL)
                run.ffd("deform", "b.glb", "c.obj", "-l", "still.json", "--force", err=anything)
                shown.append(obj_vertices(run.text("c.obj")))
                placed = [glb_split(run.read(name))[0]["nodes"][0] for name in ("a.glb", "b.glb")]
                equal(placed[0] == placed[1], rig == "keep", f"{sets} {node} {rig}")
            near(shown[1], shown[0], 1e-5, f"{sets} {node}")
            equal(len(kept), len(sets))


@case
def a_vertex_without_weights_follows_its_first_joint(run):
    done, found = skinned(run, [[0, 0, 0, 0], [0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]],
                          [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 1, 1]])
    near(found, sheared([3, -4, 3, -4]), 1e-6)
    no_line(done, r"\bstay\b", "matrix")
    one_line(done, r"\b3\b", "weights", "first joint")
    equal(entry(run, "check", "a.glb", "-l", "l.json")["skin_weights"], {"off": 0, "farthest": 0, "none": 3})


@case
def weights_that_sum_to_one_are_not_mentioned(run):
    done, _ = skinned(run, [[0.5, 0.5, 0, 0], [0.1, 0.9, 0, 0], [1, 0, 0, 0], [1 / 3, 2 / 3, 0, 0]], BOTH, "-v")
    no_line(done, "weights")
    equal("skin_weights" in entry(run, "check", "a.glb", "-l", "l.json"), False)


main()
