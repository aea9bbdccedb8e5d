#!/usr/bin/env python3
"""Morph targets, skins, rigs and colliders that went wrong in silence (house-*, wild3-*, artist-*). Each case runs the program
on the files of its folder, or on files that it makes, and says what is right.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_characters.py wild3_04_collider_node
"""

import json
import os
import shutil

from gltf_build import Scene
from gltf_reader import Gltf
from harness import INVALID, NO, case, check, equal, lattice, main, near, obj_vertices
from messages import anything, counts, entry, one_line

HERE = os.path.dirname(os.path.abspath(__file__))


def use(run, name):
    shutil.copytree(os.path.join(HERE, name), run.folder, dirs_exist_ok=True)


def primitives(run, name):
    """Of mesh 0: positions, and offsets of each target."""
    gltf = Gltf(run.path(name))
    for primitive in gltf.asset["meshes"][0]["primitives"]:
        yield (gltf.decoded(primitive["attributes"]["POSITION"]),
               [gltf.decoded(target["POSITION"]) for target in primitive.get("targets", [])])


# Morph targets

@case
def house_01_gate_lost_in_conversion(run):
    """The gate holds whatever is written. A sheet, shown 0.01 above its base, of which the lattice moves the middle: outside of
    it the displacement fades."""
    made = Scene(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
    wide, high = 81, 21
    points = [[-2 + i / 20, -0.5 + j / 20, 0.0] for j in range(high) for i in range(wide)]
    corners = [k for j in range(high - 1) for i in range(wide - 1)
               for k in (wide * j + i, wide * j + i + 1, wide * (j + 1) + i, wide * j + i + 1, wide * (j + 1) + i + 1, wide * (j + 1) + i)]
    primitive = {"attributes": {"POSITION": made.add(points, bounds=True)},
                 "indices": made.add([[k] for k in corners], 5125, "SCALAR"),
                 "targets": [{"POSITION": made.add([[0.0, 0.0, 0.01]] * len(points), bounds=True)}]}
    made.asset["meshes"] = [{"weights": [1.0], "primitives": [primitive]}]
    run.write("m.glb", made.glb())
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"by": [0.6, 0, 0]}]))
    options = ("-l", "l.json", "--outside", "extend", "--falloff", "0.3", "--fail-on", "folds")
    checked = entry(run, "check", "m.glb", *options, code=NO)
    # At x = 1.15 the displacement of 0.6 falls from 1 to 0 within 0.3; the steepest slope of that step is 15/8.
    near([[checked["det"]["outside"]]], [[1 - 1.875 * 0.6 / 0.3]], 1e-6)
    for name in ("o.glb", "o.gltf", "o.obj", "o.ply", "o.off", "o.stl"):
        job = entry(run, "deform", "m.glb", name, *options, code=NO)
        one_line(run.ffd("deform", "m.glb", name, *options, code=NO, err=anything), r"det F falls to -2\.75", "--fail-on folds")
        check(not run.exists(name), name, "is written")
        equal(job["det"], checked["det"], name)


@case
def wild3_05_as_morph_unequal_targets(run):
    """The new target is the second one of both primitives, and shows nothing yet."""
    use(run, "wild3-05-as-morph-unequal-targets")
    job = entry(run, "deform", "face.gltf", "out.gltf", "-l", "twist.json", "--as-morph", "turned")
    equal([(f["pointer"], f["count"]) for f in job["flaws"]], [("/meshes/0/primitives/1", 1)])
    mesh = Gltf(run.path("out.gltf")).asset["meshes"][0]
    equal([len(p["targets"]) for p in mesh["primitives"]], [2, 2])
    equal(mesh["weights"], [0.5, 0])
    (_, face), (hair, offsets) = primitives(run, "out.gltf")
    near(face[0], [[0, 0.1, 0]] * 24, 1e-7)
    near(offsets[0], [[0, 0, 0]] * 24, 0)
    # The same lattice moves the mesh itself by the offsets of the new targets.
    run.ffd("deform", "face.gltf", "moved.gltf", "-l", "twist.json", err=anything)
    for (before, targets), (after, _) in zip(primitives(run, "out.gltf"), primitives(run, "moved.gltf"), strict=True):
        near([[a + b for a, b in zip(p, m)] for p, m in zip(before, targets[1])], [list(p) for p in after], 3e-7)
    check(max(abs(x) for m in offsets[1] for x in m) > 0.5, "the hair does not turn")
    run.ffd("deform", "face.gltf", "no.gltf", "-l", "twist.json", "--strict", code=INVALID)
    equal(len(hair), 24)


@case
def wild3_06_target_names_of_primitives(run):
    use(run, "wild3-06-target-names-of-primitives")
    done = run.ffd("deform", "head.gltf", "out.gltf", "-l", "twist.json", "--as-morph", "blink", err=anything)
    one_line(done, "replaced")
    mesh = Gltf(run.path("out.gltf")).asset["meshes"][0]
    equal([mesh["primitives"][0]["extras"]["targetNames"], mesh.get("extras")], [["smile", "blink"], None])
    (_, (smile, blink)), = primitives(run, "out.gltf")
    (_, (smile_before, blink_before)), = primitives(run, "head.gltf")
    equal([list(smile), list(blink) == list(blink_before)], [list(smile_before), False])
    run.ffd("deform", "head.gltf", "clip.gltf", "--morph", "turned=twist.json", "--clip", "hop: 0, 1 smile=1 turned=1", err=anything)
    clip = Gltf(run.path("clip.gltf"))
    equal(clip.asset["meshes"][0]["extras"]["targetNames"], ["smile", "blink", "turned"])
    equal([x for row in clip.decoded(clip.asset["animations"][0]["samplers"][0]["output"]) for x in row], [0, 0, 0, 1, 0, 1])


@case
def wild3_20_stale_weights_channel(run):
    """The animation did nothing and does nothing."""
    use(run, "wild3-20-stale-weights-channel")
    done = run.ffd("deform", "m.gltf", "out.gltf", "-l", "twist.json", "--as-morph", "turned", err=anything)
    one_line(done, "/animations/0/channels/0")
    gltf = Gltf(run.path("out.gltf"))
    animation = gltf.asset["animations"][0]
    equal([list(row) for row in gltf.decoded(animation["samplers"][animation["channels"][0]["sampler"]]["output"])], [[0], [0]])
    # Whatever else needs the animation goes on without such a channel: of no target, and of two for one target.
    asset = json.loads(run.text("m.gltf"))
    accessors, (animation,) = asset["accessors"], asset["animations"]
    accessors += [{**accessors[1], "count": 2}, {**accessors[0], "bufferView": 1, "count": 4}]
    del accessors[4]["min"], accessors[4]["max"], accessors[5]["min"], accessors[5]["max"]
    animation["samplers"].append({"input": 0, "output": 4})
    animation["channels"].append({"sampler": 1, "target": {"node": 0, "path": "translation"}})
    run.write("none.gltf", asset)
    asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 1}]
    animation["samplers"][0]["output"] = 5
    run.write("wide.gltf", asset)
    for name in ("none.gltf", "wide.gltf"):
        for out in ("v.png", "v.html"):
            one_line(run.ffd("view", name, "-o", out, "--animation", "a", "--force", err=anything), "not played: 1 channel that drives no")
        equal(run.ffd("deform", name, "o.gltf", "-l", "twist.json", "--rig", "follow", "--force", err=anything).err, [])
        equal(len(Gltf(run.path("o.gltf")).asset["animations"][0]["channels"]), 2, "the channel stays")


# Skins, joints, colliders

@case
def artist_02_only_follow_leaves_sword(run):
    """The sword is not selected and stays; the joint that it hangs on goes from 2 to 3."""
    use(run, "artist-02-only-follow-leaves-sword")
    job = entry(run, "deform", "arm.glb", "o.glb", "-l", "wide.json", "--rig", "follow", "--only", "node:arm")
    one_line(run.ffd("deform", "arm.glb", "o.glb", "-l", "wide.json", "--rig", "follow", "--only", "node:arm", "--force", err=anything),
         "1 node", "--only", "up to 1 from", "sword on hand")
    equal([job["rig"]["unselected"], job["rig"]["unselected_by"]], [1, 1])
    nodes = Gltf(run.path("o.glb")).asset["nodes"]
    parents = {child: i for i, node in enumerate(nodes) for child in node.get("children", [])}

    def x(n):
        return nodes[n].get("translation", [0, 0, 0])[0] + (x(parents[n]) if n in parents else 0)

    near([x(n) for n, node in enumerate(nodes)], [0, 0, 0, 1.5, 3, 2], 1e-6)
    whole = entry(run, "deform", "arm.glb", "o.glb", "-l", "wide.json", "--rig", "follow")
    check("unselected" not in whole["rig"], whole["rig"])


@case
def wild3_04_collider_node(run):
    """Crate and collider stay one mesh."""
    use(run, "wild3-04-collider-node")
    job = entry(run, "deform", "crate.gltf", "out.gltf", "-l", "twist.json", err=[])
    equal(job["behind"], [])
    asset = Gltf(run.path("out.gltf")).asset
    equal([[node["mesh"] for node in asset["nodes"]], len(asset["meshes"])], [[0, 0], 1])
    (before, _), = primitives(run, "crate.gltf")
    (after, _), = primitives(run, "out.gltf")
    check(max(abs(a - b) for p, q in zip(before, after) for a, b in zip(p, q)) > 0.1, "nothing moves")


@case
def wild3_17_message_without_subject(run):
    use(run, "wild3-17-message-without-subject")
    done = run.ffd("deform", "prop.gltf", "out.gltf", "-l", "twist.json", err=anything)
    equal(done.err, [one_line(done, "^prop.gltf: 1 joint of a skin that is not used lies up to 0\\.155", r"\(arm\)")])


@case
def wild3_18_skin_without_joints(run):
    """Deformed as the same file without the skin."""
    use(run, "wild3-18-skin-without-joints")
    job = entry(run, "deform", "prop.gltf", "out.gltf", "-l", "twist.json")
    counts(job, vertices=24, moved=24, outside=0)
    equal([f["pointer"] for f in job["flaws"]], ["/meshes/0/primitives/0"])
    run.ffd("deform", "prop.gltf", "no.gltf", "-l", "twist.json", "--strict", code=INVALID)
    plain = json.loads(run.text("prop.gltf"))
    del plain["nodes"][0]["skin"], plain["skins"]
    run.write("plain.gltf", plain)
    run.ffd("deform", "plain.gltf", "expected.gltf", "-l", "twist.json", err=anything)
    equal(*[[list(p) for p, _ in primitives(run, name)] for name in ("out.gltf", "expected.gltf")])


@case
def wild3_21_draco_weights(run):
    """Each sum is 1 within the validator's 2e-7 a weight."""
    use(run, "wild3-21-draco-weights")
    run.ffd("deform", "arm.glb", "out.glb", "-l", "twist.json", err=anything)
    gltf = Gltf(run.path("out.glb"))
    attributes = gltf.asset["meshes"][0]["primitives"][0]["attributes"]
    rows = gltf.decoded(attributes["WEIGHTS_0"])
    equal(len(rows), 64)
    near([[sum(row)] for row in rows], [[1]] * 64, 2e-7)
    for joints, weights in zip(gltf.stored(attributes["JOINTS_0"]), rows):
        equal([j for j, w in zip(joints, weights) if w == 0 and j != 0], [], "a joint without a weight")


# Moves

@case
def artist_06_nothing_moved_no_word(run):
    """A pull in coordinates of another place: one line for each command, also in a batch and a page."""
    use(run, "artist-06-nothing-moved-no-word")
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    why = ("no vertex moves", "pull.json", "moves no control point", r"-1 -1 0 to 3 1 0")
    for arguments in (["deform", "face.obj", "o.obj"], ["view", "face.obj", "-o", "o.html"], ["view", "face.obj", "-o", "o.png"]):
        one_line(run.ffd(*arguments, "-l", "pull.json", "--force", err=anything), *why)
    equal(run.read("o.obj"), run.read("face.obj"))
    run.write("m.jsonl", json.dumps({"in": "face.obj", "lattice": "pull.json", "out": "b.obj"}) + "\n")
    one_line(run.ffd("batch", "m.jsonl", err=anything), *why)


@case
def artist_04_taller_foot_rises(run):
    """The sample lattice does what its page says, with its own margin and with another."""
    use(run, "artist-04-taller-foot-rises")
    with open(os.path.join(HERE, "..", "..", "data", "lattices", "taller.json"), encoding="utf-8") as file:
        taller = json.load(file)
    rest = run.ffd("info", "cube.obj", "--json", err=anything).json["bounds"]
    for margin in (taller["rest"]["margin"], 0.25):
        taller["rest"]["margin"] = margin
        run.write("taller.json", json.dumps(taller))
        bounds = entry(run, "check", "cube.obj", "-l", "taller.json")["bounds"]["after"]
        near(bounds["min"], rest["min"], 1e-15, "the foot")
        near(bounds["max"], [x if c != 1 else rest["min"][1] + 1.4 * (x - rest["min"][1]) for c, x in enumerate(rest["max"])], 1e-14)


@case
def artist_08_mirror_beside_the_model(run):
    """A sword at x = 3 puts the middle of the box beside the model: one line tells the plane. With the plane both ears move."""
    use(run, "artist-08-mirror-beside-the-model")
    one_line(run.ffd("deform", "face.obj", "o.obj", "-l", "ears.json", err=anything), '"mirror": "x" in ears.json', "the plane x = 1,")
    with open(run.path("ears.json"), encoding="utf-8") as file:
        ears = json.load(file)
    ears["moves"][0]["mirror"] = {"axis": "x", "at": 0}
    run.write("plane.json", json.dumps(ears))
    run.ffd("deform", "face.obj", "p.obj", "-l", "plane.json")
    rest, moved = obj_vertices(run.text("face.obj")), obj_vertices(run.text("p.obj"))
    found = []
    for x in (0.9, -0.9):
        ear = min(range(len(rest)), key=lambda k: abs(rest[k][0] - x) + abs(rest[k][1] - 0.5))
        found.append(moved[ear][2] - rest[ear][2])
    check(min(found) > 0.25, found)
    near(found[:1], found[1:], 0.01, "the layers are not those of the plane")


@case
def artist_15_names_of_animations(run):
    """What view --animation and --clip ask for."""
    use(run, "artist-15-names-of-animations")
    told = run.ffd("info", "arm.glb", "--json").json
    equal((told["animations"], told["joints"], told["contents"]["animations"]),
          ([{"name": "bend", "seconds": 1.0}], ["shoulder", "elbow", "hand"], 1))
    text = run.ffd("info", "arm.glb", data=True).text
    check("\nanimations\n  bend " in text and " shoulder, elbow, hand\n" in text, text)


main()
