#!/usr/bin/env python3
"""ffd deform --morph NAME=LATTICE ... --clip CLIP: several morph targets in one pass, and animations of their weights."""

import json
import os
import re
import struct

from animations import scalars, vectors
from batches import batch, lines_of, start
from gltf_build import SHEAR, SHIFT, Scene
from gltf_reader import Gltf
from harness import (CUBE, INVALID, NO, SANITIZED, USAGE, case, check, equal, float32, glb, glb_split,
                     lattice, main, near)
from messages import anything

POINTS = [[1.0, 2.0, 0.0], [2.0, -4.0, 1.0], [-3.0, 5.0, 2.0]]
NORMALS = [[0.6000000238418579, 0.800000011920929, 0.0]] * 3
FAR = [[90.0, 0.0, 0.0]]


def two_meshes(targets=0, far=FAR):
    """A mesh of three points, with targets "old-0" ..., and one of a point that SHEAR and SHIFT do not reach."""
    scene = Scene(nodes=[{"mesh": 0, "name": "near"}, {"mesh": 1, "name": "far"}], scenes=[{"nodes": [0, 1]}])
    attributes = {"POSITION": scene.add(POINTS, bounds=True), "NORMAL": scene.add(NORMALS)}
    scene.asset["meshes"] = [{"primitives": [{"attributes": attributes, "mode": 0}]},
                             {"primitives": [{"attributes": {"POSITION": scene.add(far, bounds=True)}, "mode": 0}]}]
    if targets:
        mesh = scene.asset["meshes"][0]
        mesh["primitives"][0]["targets"] = [{"POSITION": scene.add([[0.0, float(t), 0.0]] * 3, bounds=True)} for t in range(targets)]
        mesh.update(weights=[0.25 * (t + 1) for t in range(targets)], extras={"targetNames": [f"old-{t}" for t in range(targets)]})
    return scene


def write(run, scene=None):
    run.write("in.glb", (scene or two_meshes()).glb())
    run.write("shear.json", SHEAR)
    run.write("shift.json", SHIFT)


MORPHS = ("--morph", "squash=shear.json", "--morph", "stretch=shift.json")


def deformed(run, *options, morphs=MORPHS, **expected):
    expected.setdefault("err", lambda said: equal([line for line in said if " not inside" not in line], []))
    run.ffd("deform", "in.glb", "out.glb", "--force", *morphs, *options, **expected)
    return glb_split(run.read("out.glb"))


def offsets(asset, data, target):
    """The offsets of a target: attribute -> vectors."""
    return {name: vectors(asset, data, number) for name, number in target.items()}


def targets_of(asset, data):
    """Per node: name -> offsets of each primitive's target of that name."""
    nodes = []
    for node in asset["nodes"]:
        mesh = asset["meshes"][node["mesh"]]
        names = mesh.get("extras", {}).get("targetNames", [])
        nodes.append({name: [offsets(asset, data, primitive["targets"][t]) for primitive in mesh["primitives"]]
                      for t, name in enumerate(names)})
    return nodes


def clip_of(asset, data, name):
    """node -> (times, rows of weights, one for each of the mesh's targets) of the animation."""
    found, = [animation for animation in asset["animations"] if animation["name"] == name]
    rows = {}
    for channel in found["channels"]:
        equal(channel["target"]["path"], "weights")
        sampler = found["samplers"][channel["sampler"]]
        equal(sampler["interpolation"], "LINEAR")
        times = scalars(asset, data, sampler["input"])
        accessor = asset["accessors"][sampler["input"]]
        equal([accessor["min"], accessor["max"]], [[times[0]], [times[-1]]])
        values = scalars(asset, data, sampler["output"])
        node = channel["target"]["node"]
        count = len(asset["meshes"][asset["nodes"][node]["mesh"]]["primitives"][0]["targets"])
        equal(len(values), len(times) * count, "keys x targets")
        rows[node] = (times, [values[i:i + count] for i in range(0, len(values), count)])
    return rows


@case
def each_target_is_what_as_morph_writes(run):
    """To the bit, whatever is between the two: nodes that show a mesh differently, targets that are there already,
    other rest volumes, one that moves nothing, options."""
    scene = two_meshes(targets=1)
    scene.asset["nodes"].append({"mesh": 0, "translation": [4, 0, 0], "weights": [1]})
    scene.asset["scenes"][0]["nodes"].append(2)
    write(run, scene)
    run.write("still.json", lattice(low=(50, 50, 50), high=(60, 60, 60), moves=[{"by": [1, 0, 0]}]))
    run.write("bend.json", lattice(low=(-4, -5, -1), high=(7, 6, 3), moves=[{"bend": {"axis": "y", "toward": [1, 0, 0], "degrees": 40}}]))
    for options in ((), ("--outside", "extend"), ("--normals", "keep"), ("--space", "mesh"), ("--only", "node:near")):
        made = deformed(run, *options, morphs=(*MORPHS, "--morph", "bend=bend.json", "--morph", "still=still.json"),
                        err=lambda said: None)
        source = "in.glb"
        for name, file in (("squash", "shear.json"), ("stretch", "shift.json"), ("bend", "bend.json"), ("still", "still.json")):
            run.ffd("deform", source, f"{name}.glb", "--force", "-l", file, "--as-morph", name, "-q", *options)
            source = f"{name}.glb"
        one_by_one = glb_split(run.read(source))
        found, expected = targets_of(*made), targets_of(*one_by_one)
        if options[:1] == ("--only",):  # one by one, the mesh is copied for what is not selected before it has got the later ones
            equal((found[0], found[1]), (expected[0], {}), str(options))
            equal([row for name in list(found[2])[1:] for part in found[2][name] for rows in part.values() for row in rows], [[0, 0, 0]] * 24)
            continue
        equal(found, expected, str(options))
        for name in ("weights", "extras"):
            equal([mesh.get(name) for mesh in made[0]["meshes"]], [mesh.get(name) for mesh in one_by_one[0]["meshes"]], name)
        equal([node.get("weights") for node in made[0]["nodes"]], [node.get("weights") for node in one_by_one[0]["nodes"]])
    run.ffd("deform", "in.glb", "one.glb", "--morph", "squash=shear.json", "-q")
    run.ffd("deform", "in.glb", "as.glb", "--as-morph", "squash", "-l", "shear.json", "-q")
    equal(run.read("one.glb"), run.read("as.glb"))


@case
def the_base_and_all_else_stay(run):
    write(run)
    asset, data = deformed(run)
    old, old_data = glb_split(run.read("in.glb"))
    equal(data[:len(old_data)], old_data)
    equal(asset["accessors"][:len(old["accessors"])], old["accessors"])
    equal((asset["nodes"], asset["meshes"][1]), (old["nodes"], old["meshes"][1]), "what does not move")
    near_one = asset["meshes"][0]
    equal((near_one["weights"], near_one["extras"]), ([0, 0], {"targetNames": ["squash", "stretch"]}))
    found = targets_of(asset, data)[0]
    near(found["squash"][0]["POSITION"], [[0.05 * p[0] * p[1], 0, 0] for p in POINTS], 1e-6)
    near(found["stretch"][0]["POSITION"], [[1, 0, 0]] * 3, 1e-6)
    check("animations" not in asset, asset.get("animations"))


@case
def a_clip_has_a_channel_for_each_node_with_targets(run):
    """Each has as many weights a key as its mesh has targets: 0 where a key does not name a target, default weights for
    targets that the clip says nothing of."""
    scene = two_meshes(targets=2)
    scene.asset["nodes"] += [{"mesh": 0, "weights": [0.5, 0.125], "name": "own"}, {"mesh": 0, "name": "again"},
                             {"name": "empty"}]
    scene.asset["scenes"][0]["nodes"] += [2, 3, 4]
    write(run, scene)
    text = "hop: 0 squash=1, 0.2 stretch=1 squash=0.5 old-1=2, 0.5,2 squash=-1.5"
    asset, data = deformed(run, "--clip", text)
    times = [float32(t) for t in (0, 0.2, 0.5, 2)]
    rows = [[0.25, 0, 1, 0], [0.25, 2, 0.5, 1], [0.25, 0, 0, 0], [0.25, 0, -1.5, 0]]
    found = clip_of(asset, data, "hop")
    equal(sorted(found), [0, 2, 3])
    equal(found[0], (times, rows))
    equal(found[2], (times, [[0.5, *row[1:]] for row in rows]))
    equal(found[3], (times, rows))
    samplers = asset["animations"][0]["samplers"]
    equal((len(samplers), len({s["input"] for s in samplers})), (2, 1), "nodes share what is alike")
    # Meshes with other targets: the far one has one of its own, of which the clip tells as well.
    run.write("in.glb", glb_of_far_target())
    asset, data = deformed(run, "--clip", "c: 0, 1 twin=1 stretch=0.5")
    found = clip_of(asset, data, "c")
    equal({node: rows for node, (_, rows) in found.items()}, {0: [[0, 0], [0, 0.5]], 1: [[0], [1]]})
    asset, data = deformed(run, "--clip", "c: 0, 1 stretch=1")
    equal(sorted(clip_of(asset, data, "c")), [0], "a node of which it tells nothing has no channel")
    # Only new targets are of it from the start: one without a weight of its own stays at 0.
    equal(clip_of(*deformed(run, "--clip", "c: 0.5"), "c"), {0: ([0.5], [[0, 0]])})


def glb_of_far_target():
    scene = two_meshes()
    far = scene.asset["meshes"][1]
    far["primitives"][0]["targets"] = [{"POSITION": scene.add([[0.0, 1.0, 0.0]], bounds=True)}]
    far["extras"] = {"targetNames": ["twin"]}
    return scene.glb()


@case
def several_clips_and_one_of_the_same_name(run):
    scene = two_meshes()
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    moved = scene.add([[0.0] * 3] * 2)
    walk = {"name": "walk", "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            "samplers": [{"input": times, "output": moved}], "extras": {"more": 1.50}}
    scene.asset["animations"] = [{**walk, "name": "first"}, walk, {**walk, "name": "last"}]
    write(run, scene)
    asset, data = deformed(run, "--clip", "walk: 0, 1 squash=1", "--clip", "new: 1 stretch=2",
                           err=lambda said: equal([line for line in said if "inside" not in line],
                                                  ['in.glb: has an animation "walk" already: it is replaced']))
    old = glb_split(run.read("in.glb"))[0]["animations"]
    equal([animation["name"] for animation in asset["animations"]], ["first", "walk", "last", "new"])
    equal([asset["animations"][0], asset["animations"][2]], [old[0], old[2]])
    equal(clip_of(asset, data, "walk"), {0: ([0, 1], [[0, 0], [1, 0]])})
    equal(clip_of(asset, data, "new"), {0: ([1], [[0, 2]])})
    # Another run: targets and clip are replaced in their places, and their weights stay.
    asset["meshes"][0]["weights"] = [0.5, 0]
    # The times of "walk" are two floats, the weights four, which nothing else uses.
    said = run.ffd("deform", "out.glb", "again.glb", *MORPHS, "--clip", "walk: 3 stretch=1", err=anything).err
    check(any(line.endswith('"walk" already: it is replaced; 24 bytes that only it used stay in the file') for line in said), str(said))
    again, again_data = glb_split(run.read("again.glb"))
    equal([animation["name"] for animation in again["animations"]], ["first", "walk", "last", "new"])
    equal(again["meshes"][0]["extras"], {"targetNames": ["squash", "stretch"]})
    equal(clip_of(again, again_data, "walk"), {0: ([3], [[0, 1]])})
    equal(clip_of(again, again_data, "new"), {0: ([1], [[0, 2]])}, "other clips keep their rows")
    equal(targets_of(again, again_data), targets_of(asset, data))


@case
def other_animations_go_on(run):
    """Whatever the number of new targets, each gets one output in place of its old one: nothing is left of what only one
    of the targets would have got, nor of an animation that a clip replaces. All is in one bufferView."""
    scene = two_meshes(targets=1)
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    rows = scene.add([[0.25], [0.5]], shape="SCALAR")
    nod = {"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
           "samplers": [{"input": times, "interpolation": "LINEAR", "output": rows}]}
    scene.asset["animations"] = [{"name": "nod", **nod}, {"name": "hop", **nod}]
    write(run, scene)
    old = glb_split(run.read("in.glb"))[0]
    for clip, accessors in (((), 2), (("--clip", "new: 0, 1 squash=1"), 4), (("--clip", "hop: 0, 1 squash=1"), 3)):
        asset, data = deformed(run, *clip, err=lambda said: None)
        equal(clip_of(asset, data, "nod"), {0: ([0, 1], [[0.25, 0, 0], [0.5, 0, 0]])})
        scalar = [accessor for accessor in asset["accessors"][len(old["accessors"]):] if accessor["type"] == "SCALAR"]
        equal((len(scalar), len({accessor["bufferView"] for accessor in scalar})), (accessors, 1), str(clip))
        used = [s[end] for animation in asset["animations"] for s in animation["samplers"] for end in ("input", "output")]
        check({number for number, accessor in enumerate(asset["accessors"]) if accessor in scalar} <= set(used), asset["accessors"], used)
    equal(clip_of(asset, data, "hop"), {0: ([0, 1], [[0.25, 0, 0], [0.25, 1, 0]])})


@case
def channels_that_are_repeated_for_a_copy_of_the_mesh(run):
    """With the sampler that the channel has got: the one that it had drives something else, too."""
    scene = two_meshes(targets=1)
    scene.asset["nodes"] = [{"mesh": 0, "name": "near"}, {"mesh": 0, "translation": [4, 0, 0]}, {}]
    scene.asset["scenes"][0]["nodes"] = [0, 1, 2]
    del scene.asset["meshes"][1]
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    moves = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/materials/0/alphaCutoff"}}}
    weights = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/meshes/0/weights"}}}
    scene.asset["animations"] = [{"channels": [{"target": weights, "sampler": 0}, {"target": moves, "sampler": 0}],
                                  "samplers": [{"input": times, "output": scene.add([[0.25], [0.5]], shape="SCALAR")}]}]
    scene.asset["materials"] = [{}]
    write(run, scene)
    asset, data = deformed(run, morphs=MORPHS[:2], err=anything)
    equal(len(asset["meshes"]), 2)
    animation = asset["animations"][0]
    driven = {channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"]:
              scalars(asset, data, animation["samplers"][channel["sampler"]]["output"]) for channel in animation["channels"]}
    equal(driven, {"/meshes/0/weights": [0.25, 0, 0.5, 0], "/meshes/1/weights": [0.25, 0, 0.5, 0],
                   "/materials/0/alphaCutoff": [0.25, 0.5]})


@case
def a_file_without_buffers(run):
    """Its vertices are zeros, which need no bytes: those of the target and of the clip are in one BIN chunk or data URI."""
    zeros = {"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}
    asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "accessors": [zeros],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}]}
    run.write("shift.json", SHIFT)
    whole = glb(asset, b"")
    run.write("in.glb", whole[:8] + struct.pack("<I", len(whole) - 8) + whole[12:-8])
    run.write("empty.glb", whole)
    run.write("in.gltf", json.dumps(asset))
    for name in ("in.glb", "empty.glb", "in.gltf"):
        for out in ("out.glb", "out.gltf"):
            run.ffd("deform", name, out, "--force", "--morph", "up=shift.json", "--clip", "hop: 0, 2 up=1")
            run.ffd("info", out, "--strict")
            made = Gltf(run.path(out))
            equal(len(made.asset["buffers"]), 1, f"{name} {out}")
            target, = made.asset["meshes"][0]["primitives"][0]["targets"]
            equal([list(row) for row in made.decoded(target["POSITION"])], [[1, 0, 0]] * 3)
            sampler, = made.asset["animations"][0]["samplers"]
            equal([[x[0] for x in made.decoded(sampler[end])] for end in ("input", "output")], [[0, 2], [0, 1]])


def left(run, change, *options):
    """Replaces a target of two_meshes after a change of it: the lines about bytes that are left, and the number in the report."""
    scene = two_meshes(targets=2)
    mesh = scene.asset["meshes"][0]
    mesh["extras"]["targetNames"][0] = "squash"
    change(scene, mesh["primitives"][0]["targets"])
    write(run, scene)
    done = run.ffd("deform", "in.glb", "out.glb", "--force", "--morph", "squash=shear.json", "--report", "r.json", *options, err=anything)
    job = json.loads(run.text("r.json"))["jobs"][0]
    return [line for line in done.err if "stay in the file" in line], job.get("bytes_left")


def said(count):
    return [f'in.glb: {count} bytes that only the old morph target "squash" used stay in the file'], count


def whole(scene, targets):
    targets[0]["POSITION"] = scene.add([[1, 2, 3, 0]] * 3, 5122, "VEC4")
    scene.asset["accessors"][-1] |= {"type": "VEC3", "normalized": True}
    scene.asset["bufferViews"][-1]["byteStride"] = 8


def sparse(scene, targets):
    scene.asset["accessors"][targets[0]["POSITION"]] = {
        "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 0], "sparse": {
            "count": 1, "indices": {"bufferView": scene.view(b"\1\0\0\0"), "componentType": 5121},
            "values": {"bufferView": scene.view(struct.pack("<3f", 1, 0, 0))}}}


def again(scene, accessor, **change):
    scene.asset["accessors"].append({**scene.asset["accessors"][accessor], **change})
    return len(scene.asset["accessors"]) - 1


@case
def bytes_that_a_replaced_target_leaves_are_said(run):
    """Floats that nothing else uses are written over, and leave none. What cannot be is counted: whole numbers, sparse
    ones, of normals too; not what another target or an animation uses as well."""
    def shared(scene, targets):
        whole(scene, targets)
        targets[1]["POSITION"] = targets[0]["POSITION"]

    def normals(scene, targets):
        targets[0]["NORMAL"] = targets[1]["NORMAL"] = scene.add([[0.0, 0.0, 0.0]] * 3)
        targets[0]["TANGENT"] = scene.add([[0.0, 0.0, 0.0]] * 3)

    equal(left(run, lambda scene, targets: None), ([], None), "written over")
    equal(left(run, whole), said(18), "three elements of six bytes")
    equal(left(run, sparse), said(13), "a place and three floats")
    equal(left(run, shared), ([], None))
    equal(left(run, normals), said(36), "tangents, which the mesh has not")
    equal(left(run, normals, "--normals", "keep"), said(36))

    # With those of a clip that is replaced; a target is named once.
    write(run)
    deformed(run, "--clip", "walk: 0, 1 squash=1")
    run.write("in.glb", run.read("out.glb"))
    flat = lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"at": [3, 3, 3], "by": [0, 0, 0.5]}])
    run.write("shear.json", flat)
    done = run.ffd("deform", "in.glb", "out.glb", "--force", *MORPHS, "--clip", "walk: 0, 1, 2 squash=1", "--report", "r.json", err=anything)
    counted = [int(re.search(r"(\d+) bytes that only", line)[1]) for line in done.err if "stay in the file" in line]
    check(counted and counted[-1] == 24, str(done.err))
    equal(json.loads(run.text("r.json"))["jobs"][0]["bytes_left"], sum(counted))


@case
def bytes_that_accessors_share_are_counted_once(run):
    """Of two accessors that are replaced; bytes that an accessor which stays has too, or an image, are not counted."""
    def twice(scene, targets):
        whole(scene, targets)
        targets[0]["NORMAL"] = again(scene, targets[0]["POSITION"])

    def kept(scene, targets):
        whole(scene, targets)
        targets[1]["POSITION"] = again(scene, targets[0]["POSITION"])

    def partly_kept(scene, targets):
        view = scene.view(struct.pack("<16h", *range(16)))
        scene.asset["bufferViews"][view]["byteStride"] = 8
        scene.asset["accessors"].append({"bufferView": view, "componentType": 5122, "count": 3, "type": "VEC3", "normalized": True})
        targets[0]["POSITION"] = len(scene.asset["accessors"]) - 1
        targets[1]["POSITION"] = again(scene, targets[0]["POSITION"], byteOffset=8)

    def woven(offset):
        def change(scene, targets):
            whole(scene, targets)
            attributes = scene.asset["meshes"][0]["primitives"][0]["attributes"]
            attributes["_WOVEN"] = again(scene, targets[0]["POSITION"], type="SCALAR", byteOffset=offset)
        return change

    def of_an_image(scene, targets):
        whole(scene, targets)
        scene.asset["images"] = [{"bufferView": scene.asset["accessors"][targets[0]["POSITION"]]["bufferView"], "mimeType": "image/png"}]

    def sparse_twice(scene, targets):
        sparse(scene, targets)
        targets[0]["NORMAL"] = again(scene, targets[0]["POSITION"])

    equal(left(run, twice), said(18), "two accessors of the same bytes")
    equal(left(run, sparse_twice), said(13), "the same that is sparse")
    equal(left(run, kept), ([], None), "another accessor of the same bytes stays")
    equal(left(run, partly_kept), said(6), "another accessor has two of the elements")
    equal(left(run, woven(6)), said(18), "between the elements is another's")
    equal(left(run, woven(4)), said(12), "in each element is another's")
    equal(left(run, of_an_image), ([], None), "no accessor, but an image")


@case
def bytes_that_two_replaced_animations_share(run):
    """They are left once both are replaced."""
    write(run)
    asset, data = deformed(run, "--clip", "walk: 0, 1 squash=1", "--clip", "run: 0, 1 stretch=1")
    walk, other = asset["animations"]
    other["samplers"][0]["input"] = walk["samplers"][0]["input"]
    run.write("in.glb", glb(asset, data))
    done = run.ffd("deform", "in.glb", "out.glb", "--force", *MORPHS, "--clip", "walk: 0 squash=1", "--clip", "run: 0 squash=1", "--report", "r.json",
                   err=anything)
    equal([re.search(r'"(\w+)" already: it is replaced; (\d+) bytes', line).groups() for line in done.err if "stay in the file" in line],
          [("walk", "16"), ("run", "24")], "two rows of two weights, then also two times")
    equal(json.loads(run.text("r.json"))["jobs"][0]["bytes_left"], 40)


@case
def a_compressed_target_that_is_replaced(run):
    """Its view has compressed bytes, which are counted where nothing else has a part of the view, or the same bytes."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fuzz", "corpus", "glb", "meshopt"), "rb") as file:
        sample = file.read()
    run.write("l.json", lattice(low=(-99, -99, -99), high=(99, 99, 99), moves=[{"by": [1, 2, 3]}]))
    for view_of in ("bytes of its own", "the same bytes", "the same view"):
        asset, data = glb_split(sample)
        primitive = asset["meshes"][0]["primitives"][0]
        accessor = dict(asset["accessors"][primitive["attributes"]["POSITION"]])
        view = asset["bufferViews"][accessor["bufferView"]]
        (extension, packed), = view["extensions"].items()
        if view_of != "the same view":
            accessor["bufferView"] = len(asset["bufferViews"])
            asset["bufferViews"].append(view)
        if view_of == "bytes of its own":
            begin = packed.get("byteOffset", 0)
            data += b"\0" * (-len(data) % 4)
            asset["bufferViews"][-1] = {**view, "extensions": {extension: {**packed, "byteOffset": len(data)}}}
            data += data[begin:begin + packed["byteLength"]]
            asset["buffers"][packed["buffer"]]["byteLength"] = len(data)
        asset["accessors"].append(accessor)
        primitive["targets"] = [{"POSITION": len(asset["accessors"]) - 1}]
        asset["meshes"][0]["extras"] = {"targetNames": ["bent"]}
        run.write("in.glb", glb(asset, data))
        done = run.ffd("deform", "in.glb", "out.glb", "--force", "--morph", "bent=l.json", err=anything)
        equal([line for line in done.err if "stay in the file" in line],
              [f'in.glb: {packed["byteLength"]} bytes that only the old morph target "bent" used stay in the file'] if view_of == "bytes of its own" else [],
              view_of)


@case
def names_in_quotes(run):
    write(run)
    run.write("a=b.json", SHIFT)
    asset, data = deformed(run, "--clip", "'a clip: 1': 0 'it''s, = one'=1, 1 plain:x=0.5",
                           morphs=("--morph", "'it''s, = one'=shear.json", "--morph", "plain:x=a=b.json"))
    equal(asset["meshes"][0]["extras"]["targetNames"], ["it's, = one", "plain:x"])
    equal(clip_of(asset, data, "a clip: 1"), {0: ([0, 1], [[1, 0], [0, 0.5]])})


@case
def what_is_wrong_with_a_clip(run):
    """Each text is refused before anything is read, with what stands there."""
    write(run)
    for text, said in (
            ("", 'the value of --clip is empty|"" is where a name is missing'),
            ("hop", '"" is where ":" after the clip\'s name is missing'),
            (": 0", '":" is where a name is missing'),
            ("a b: 0", '"b:" is where ":" after the clip\'s name is missing'),
            ("'hop: 0", '"\'hop:" begins a name in quotes that has no end'),
            ("hop:", 'clip "hop": "" is not a time in seconds'),
            ("hop: squash=1", '"squash=1" is not a time in seconds'),
            ("hop: 0,", '"" is not a time in seconds'),
            ("hop: -1", '"-1" is a time before 0'),
            ("hop: nan", '"nan" is not a time in seconds'),
            ("hop: inf", '"inf" is not a time in seconds'),
            ("hop: 1e39", '"1e39" is not a time in seconds'),
            ("hop: 1, 1", '"1" is a time that is not later than the one before it'),
            ("hop: 1, 0.5 squash=1", '"0.5" is a time that is not later'),
            ("hop: 1, 1.00000001", "is a time that is not later than the one before it .as float32"),
            ("hop: 0s", '"0s" is not a time in seconds'),
            ("hop: 0 squash", '"squash" is not TARGET=WEIGHT'),
            ("hop: 0 squash=", 'clip "hop": "" is not a weight'),
            ("hop: 0 squash=one", '"one" is not a weight'),
            ("hop: 0 squash=1e39", '"1e39" is not a weight'),
            ("hop: 0 squash=nan", '"nan" is not a weight'),
            ("hop: 0 squash=1 squash=2", '"squash=2" is a second weight of that target at one time'),
            ("hop: 0 =1", '"=1" is where a name is missing'),
            ("hop: 0 'squash=1", '"\'squash=1" begins a name in quotes'),
            ("hop: 0 'squash'1", '"\'squash\'1" is not TARGET=WEIGHT')):
        run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--clip", text, code=USAGE, err=re.compile(said))
    run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--clip", b"hop: 0 \xff=1".decode("utf-8", "surrogateescape"), code=USAGE,
            err=re.compile("is not a name in UTF-8"))
    check(not run.exists("out.glb"), run.names())


@case
def targets_that_are_not_there(run):
    write(run, two_meshes(targets=2))
    run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--clip", "hop: 0 sqush=1", code=USAGE,
            err='in.glb: --clip: clip "hop": there is no morph target "sqush", neither in the file nor new (nearest: "squash")')
    run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--clip", "hop: 0 old_1=1", code=USAGE, err=re.compile('nearest: "old-[01]"'))
    run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--clip", "hop: 0", "--clip", "hop: 1", code=USAGE, err=re.compile('two clips are called "hop"'))
    run.write("c.obj", CUBE)
    run.ffd("deform", "c.obj", "out.glb", *MORPHS, "--clip", "hop: 0 old-1=1", code=USAGE, err=re.compile('no morph target "old-1"'))
    check(not run.exists("out.glb"), run.names())


@case
def what_does_not_go_together(run):
    write(run)
    for options, said in ((("-l", "shear.json"), "-l cannot be used with --morph: each --morph names its own lattice"),
                          (("--as-morph", "x"), "--as-morph cannot be used with --morph"),
                          (("--blocks",), "--blocks cannot be used with --morph"),
                          (("--rig", "follow"), "--rig follow moves the shape itself, which --morph leaves"),
                          (("--embedding", "e.npy"), "--embedding works with one lattice, but several --morph are given")):
        done = run.ffd("deform", "in.glb", "out.glb", *MORPHS, *options, code=USAGE)
        check(said in done.err[0], done.err)
    done = run.ffd("deform", "in.glb", "out.glb", "-l", "shear.json", "--clip", "hop: 0", code=USAGE)
    check("--clip needs --morph" in done.err[0], done.err)
    for value, said in (("squash", "is not NAME=LATTICE"), ("=shear.json", "is not NAME=LATTICE"), ("a b=shear.json", "is not NAME=LATTICE"),
                        ("'ab=shear.json", "is not NAME=LATTICE"), ("'ab'x=shear.json", "is not NAME=LATTICE"),
                        ("''=shear.json", "is not NAME=LATTICE"), ("x=", "names no lattice"), ("stretch=shear.json", "has the name of another morph target")):
        run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--morph", value, code=USAGE, err=re.compile(said))
    for name in ("out.obj", "out.ply", "out.stl", "out.off"):
        run.ffd("deform", "in.glb", name, *MORPHS, code=USAGE,
                err=f"{name}: cannot hold a morph target: only .gltf and .glb can (--morph)")
    run.ffd("check", "in.glb", *MORPHS, code=USAGE, err=re.compile("unknown option"))
    equal(run.names(), ["in.glb", "shear.json", "shift.json"])


@case
def a_conversion_gets_all_targets(run):
    """As --as-morph gives each, and the base; the clip tells of the meshes that have them."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"at": [3, 3, 3], "by": [0, 0.5, 0]}]))
    run.write("shift.json", SHIFT)
    run.write("m.obj", "o one\n" + CUBE + "o two\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 9 10 11\n")
    morphs = ("--morph", "corner=l.json", "--morph", "all=shift.json")
    for extra in ((), ("--normals", "recompute")):
        run.ffd("deform", "m.obj", "out.glb", "--force", *morphs, *extra, "--clip", "c: 0, 1 all=1, 2 corner=1", "-q")
        asset, data = glb_split(run.read("out.glb"))
        found = targets_of(asset, data)
        for name, file in (("corner", "l.json"), ("all", "shift.json")):
            run.ffd("deform", "m.obj", "one.glb", "--force", "-l", file, "--as-morph", name, "-q", *extra)
            one, one_data = glb_split(run.read("one.glb"))
            equal([targets.get(name) for targets in found], [targets.get(name) for targets in targets_of(one, one_data)], name)
            equal([vectors(asset, data, mesh["primitives"][0]["attributes"]["POSITION"]) for mesh in asset["meshes"]],
                  [vectors(one, one_data, mesh["primitives"][0]["attributes"]["POSITION"]) for mesh in one["meshes"]])
        equal([list(targets) for targets in found], [["corner", "all"], ["all"]])
        equal(clip_of(asset, data, "c"), {0: ([0, 1, 2], [[0, 0], [0, 1], [1, 0]]), 1: ([0, 1, 2], [[0], [1], [0]])})
    for name, options in (("out.gltf", ()), ("-", ("--output-format", "gltf"))):
        done = run.ffd("deform", "m.obj", name, *morphs, "--clip", "c: 0, 1 all=1", "-q", *options, data=True)
        text = json.loads(done.out if name == "-" else run.text(name))
        equal([(a["name"], len(a["channels"])) for a in text["animations"]], [("c", 2)])
    # Normals that corners share in one shape, and not in another.
    run.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 2//1 4//1 3//1\n")
    run.write("lean.json", lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=[{"bend": {"axis": "x", "toward": [0, 0, 1], "degrees": 70}}]))
    run.write("tip.json", lattice(size=(3, 3, 3), degree=[1, 1, 1], moves=[{"at": [2, 2, 2], "by": [0, 0.5, 0.3]}]))
    run.write("still.json", lattice(low=(50, 50, 50), high=(60, 60, 60), moves=[{"by": [1, 0, 0]}]))
    expected = {}
    for name in ("lean", "tip", "still"):
        run.ffd("deform", "n.obj", "one.glb", "--force", "-l", f"{name}.json", "--as-morph", name, "-q")
        expected[name] = normals_at_corners(*glb_split(run.read("one.glb")), name)
    check(len({n for _, n in expected["lean"].values()}) == 4, expected)
    for names in (("lean", "tip", "still"), ("still", "lean", "tip"), ("tip", "still", "lean")):
        run.ffd("deform", "n.obj", "n.glb", "--force", *(word for name in names for word in ("--morph", f"{name}={name}.json")), "-q")
        made = glb_split(run.read("n.glb"))
        equal({name: normals_at_corners(*made, name) for name in names}, expected, str(names))


def normals_at_corners(asset, data, name):
    """position -> the normal of the one mesh there, and its offset in the target."""
    attributes = asset["meshes"][0]["primitives"][0]["attributes"]
    offset, = targets_of(asset, data)[0][name]
    rows = zip(*(vectors(asset, data, attributes[key]) for key in ("POSITION", "NORMAL")), offset["NORMAL"])
    return {tuple(position): (tuple(normal), tuple(added)) for position, normal, added in rows}


@case
def figures_of_each_target(run):
    """The report has those of each, as -l alone has them, and the worst at the top."""
    write(run)
    run.write("fold.json", lattice(low=(-4, -5, -1), high=(1.5, 6, 3), moves=[{"at": [0, "all", "all"], "by": [30, 0, 0]}]))
    morphs = (*MORPHS, "--morph", "fold=fold.json")
    told = ["in.glb: morph target \"squash\": 1 of 4 vertices is not inside: 1 outside (left where it is)",
            "in.glb: morph target \"stretch\": 1 of 4 vertices is not inside: 1 outside (left where it is)"]
    deformed(run, "--report", "r.json", "--report-stable", morphs=morphs,
             err=lambda said: (equal(said[:2], told), equal([line for line in said if "fold" not in line], told)))
    entry, = json.loads(run.text("r.json"))["jobs"]
    equal([(m["name"], m["lattice"]) for m in entry["morphs"]], [("squash", "shear.json"), ("stretch", "shift.json"), ("fold", "fold.json")])
    for morph in entry["morphs"]:
        run.ffd("deform", "in.glb", "one.glb", "--force", "-l", morph["lattice"], "--as-morph", "x", "-q", "--report", "one.json", "--report-stable")
        one, = json.loads(run.text("one.json"))["jobs"]
        equal({key: one[key] for key in morph if key not in ("name", "lattice")}, {key: morph[key] for key in morph if key not in ("name", "lattice")})
    check(entry["morphs"][2]["folds"]["verdict"] == "some" and entry["morphs"][0]["folds"]["verdict"] == "none", entry["morphs"])
    equal((entry["folds"]["verdict"], entry["folds"]["witness"]["lattice"], entry["inside"], entry["vertices"]),
          ("some", 2, min(m["inside"] for m in entry["morphs"]), 4))
    for key in ("max", "rms"):
        equal(entry["displacement"][key], max(m["displacement"][key] for m in entry["morphs"]))
    equal(entry["det"]["min"], min(m["det"]["min"] for m in entry["morphs"]))
    equal([m["area"] for m in entry["morphs"]], 3 * [{"before": 0, "after": 0}], "points")
    equal(entry["area"], {"before": 0, "after": None}, "three shapes have no one area")
    equal(entry["bounds"]["after"]["max"][0], max(m["bounds"]["after"]["max"][0] for m in entry["morphs"]))
    # A gate says of which target it is; nothing is written.
    run.remove("out.glb")
    run.ffd("deform", "in.glb", "out.glb", *morphs, "--fail-on", "folds", "--report", "gate.json", code=NO,
            err=lambda said: check(said[-1].startswith("in.glb: morph target \"fold\": the deformed volume folds"), said))
    failed, = json.loads(run.text("gate.json"))["jobs"]
    equal(([m["name"] for m in failed["morphs"]], failed["folds"]["verdict"]), (["squash", "stretch", "fold"], "some"))
    run.ffd("deform", "in.glb", "out.glb", *MORPHS, "--outside", "error", code=5, err=re.compile('^in.glb: morph target "squash": 1 of 4'))
    run.ffd("deform", "in.glb", "out.glb", "--morph", "a=none.json", "--morph", "b=shear.json", code=3, err=re.compile("^none.json: "))
    check(not run.exists("out.glb"), run.names())


@case
def edges_of_the_worst_target(run):
    """A gate that looks at edges fills the report, also where it refuses none."""
    run.write("in.obj", CUBE)
    for name, by in (("low", 0.25), ("high", 0.5)):
        run.write(name + ".json", lattice(size=(3, 3, 3), moves=[{"at": [1, 1, 1], "by": [0, 0, by]}, {"at": ["all", 1, 2], "by": [0, 0, by]}]))
        run.ffd("deform", "in.obj", name + ".glb", "-l", name + ".json", "-q", "--fail-on", "edges=9", "--report", name)
    low, high = (json.loads(run.text(name))["jobs"][0]["edges"] for name in ("low", "high"))
    check(0 < low["deviation"]["max"] < high["deviation"]["max"], low, high)
    run.ffd("deform", "in.obj", "out.glb", "--morph", "a=high.json", "--morph", "b=low.json", "-q", "--fail-on", "edges=9", "--report", "r.json")
    equal(json.loads(run.text("r.json"))["jobs"][0]["edges"], high)
    run.ffd("deform", "in.obj", "out.glb", "--force", "--morph", "a=high.json", "-q", "--report", "r.json")
    equal(json.loads(run.text("r.json"))["jobs"][0]["edges"], None)


@case
def what_lattices_have_of_their_own(run):
    """A box round the mesh, which is the base whatever targets come before, and placeholders of one of them."""
    write(run)
    run.write("round.json", {**lattice(moves=[{"at": [1, 1, 1], "by": [0, {"$": "A"}, 0]}]), "rest": {"box": "mesh", "margin": 0.1}})
    run.ffd("deform", "in.glb", "out.glb", "--morph", "stretch=shift.json", "--morph", "round=round.json", "--set", "A=0.5", "-q")
    run.ffd("deform", "in.glb", "one.glb", "-l", "round.json", "--as-morph", "round", "--set", "A=0.5", "-q")
    found, expected = (targets_of(*glb_split(run.read(name))) for name in ("out.glb", "one.glb"))
    equal([node.get("round") for node in found], [node.get("round") for node in expected])
    run.ffd("deform", "in.glb", "no.glb", *MORPHS, "--set", "A=0.5", code=INVALID, err=re.compile('no lattice has the placeholder .* .--set.$'))
    # Several meshes, with one set of targets.
    run.write("b.glb", two_meshes(targets=1).glb())
    run.folder_of("o")
    run.ffd("deform", "in.glb", "b.glb", "--out-dir", "o", *MORPHS, "--report", "r.json", "-q")
    equal([[m["name"] for m in entry["morphs"]] for entry in json.loads(run.text("r.json"))["jobs"]], [["squash", "stretch"]] * 2)
    run.ffd("deform", "b.glb", "c.glb", *MORPHS, "-q")
    equal(run.read("o/b.glb"), run.read("c.glb"))


@case
def more_than_eight_are_said(run):
    write(run, two_meshes(targets=1))
    nine = [word for k in range(8) for word in ("--morph", f"m{k}=shift.json")]
    deformed(run, morphs=nine, err=lambda said: equal([line for line in said if "inside" not in line],
                                                      ["in.glb: 1 mesh has 9 morph targets: some viewers play only 8"]))
    equal(len(glb_split(run.read("out.glb"))[0]["meshes"][0]["primitives"][0]["targets"]), 9)
    deformed(run, morphs=nine[:14])
    write(run, two_meshes(targets=8, far=[[0.0, 0.0, 0.0]]))
    for options in (nine[:2], ("-l", "shift.json", "--as-morph", "x")):
        deformed(run, morphs=options, err="in.glb: 1 mesh has 9 morph targets: some viewers play only 8")


@case
def offsets_that_are_zeros_are_not_stored(run):
    """Where two thirds of them are: the rest, with 16-bit numbers up to 65,536 vertices, else with 32. --as-morph stores all."""
    cases = ((12, 4, 5123), (12, 5, None), (65536, 9, 5123), (65537, 9, 5125))
    for count, moved, code in cases[:2] + cases[3:] if SANITIZED else cases:
        points = [[0.5, 0.25, 0.0]] * moved + [[90.0, float(i % 7), 1.0] for i in range(count - moved)]
        points[0], points[-1] = points[-1], points[0]
        scene = Scene(nodes=[{"mesh": 0}, {"mesh": 0, "translation": [0, 2, 0]}], scenes=[{"nodes": [0, 1]}])
        attributes = {"POSITION": scene.add(points, bounds=True)}
        scene.asset["meshes"] = [{"primitives": [{"attributes": attributes, "mode": 0}]}]
        write(run, scene)
        asset, data = deformed(run, "--clip", "c: 0, 1 squash=1")
        run.ffd("deform", "in.glb", "a.glb", "--force", "-l", "shear.json", "--as-morph", "squash", "-q")
        run.ffd("deform", "a.glb", "b.glb", "--force", "-l", "shift.json", "--as-morph", "stretch", "-q")
        dense = glb_split(run.read("b.glb"))
        check(not any("sparse" in accessor for accessor in dense[0]["accessors"]), "--as-morph changes its bytes")
        equal(targets_of(asset, data), targets_of(*dense), f"{moved} of {count}")
        sparse = [accessor for accessor in asset["accessors"] if "sparse" in accessor]
        equal(len(sparse), 3 if code else 0, "two nodes see squash differently")
        for accessor in sparse:
            equal((accessor["sparse"]["indices"]["componentType"], accessor["sparse"]["count"], "bufferView" in accessor), (code, moved, False))
            for part in ("indices", "values"):
                view = asset["bufferViews"][accessor["sparse"][part]["bufferView"]]
                check("target" not in view and "byteStride" not in view, view)
        for options in (("--threads", "1"), ("--threads", "3", "--isa", "scalar")):
            run.ffd("deform", "in.glb", "again.glb", "--force", "-q", *MORPHS, "--clip", "c: 0, 1 squash=1", *options)
            check(run.read("again.glb") == run.read("out.glb"), options)
        # Such a target is replaced like any other.
        run.ffd("deform", "out.glb", "again.glb", "--force", "-q", "--morph", "squash=shift.json", "--morph", "stretch=shear.json")
        again = targets_of(*glb_split(run.read("again.glb")))
        equal([node["stretch"] for node in again], [node["squash"] for node in targets_of(*dense)])
        equal([node["squash"] for node in again], [node["stretch"] for node in targets_of(*dense)])


@case
def a_mesh_whose_extras_hold_no_names(run):
    """The clip knows the new targets by their places."""
    scene = two_meshes()
    scene.asset["meshes"][0]["extras"] = [1]
    write(run, scene)
    asset, data = deformed(run, "--clip", "c: 0, 1 stretch=1", err=lambda said: equal(
        [line for line in said if "inside" not in line],
        [f'in.glb: morph target "{name}": mesh 0: its extras cannot hold the name of the morph target' for name in ("squash", "stretch")]))
    equal(clip_of(asset, data, "c"), {0: ([0, 1], [[0, 0], [0, 1]])})


@case
def what_is_odd_in_the_file_is_said_once(run):
    scene = two_meshes(targets=1, far=[[0.0, 0.0, 0.0]])
    scene.asset["meshes"][0]["weights"] = []
    write(run, scene)
    deformed(run, err=re.compile("^in.glb: /meshes/0/weights: the default weights"))


@case
def in_place_and_in_a_folder_of_buffers(run):
    write(run)
    asset, data = glb_split(run.read("in.glb"))
    asset["buffers"][0]["uri"] = "m.bin"
    run.write("m.bin", data)
    run.write("m.gltf", asset)
    made = deformed(run, "--clip", "c: 0, 1 squash=1")
    run.ffd("deform", "m.gltf", "o.gltf", *MORPHS, "--clip", "c: 0, 1 squash=1", "-q")
    run.ffd("deform", "m.gltf", "--in-place", *MORPHS, "--clip", "c: 0, 1 squash=1", "-q")
    for name in ("o.gltf", "m.gltf"):
        text = json.loads(run.text(name))
        equal([a["name"] for a in text["animations"]], ["c"])
        equal(text["meshes"][0]["extras"], made[0]["meshes"][0]["extras"])


def jobs_with_morphs(run, *more):
    write(run, two_meshes(far=[[0.0, 0.0, 0.0]]))
    start(run)
    run.write("sub/shear.json", SHEAR)
    run.write("jobs.jsonl", lines_of([{"in": "in.glb", "out": "o0.glb", "morph": {"it's": "sub/shear.json", "stretch": "shift.json"},
                                       "clip": "hop: 0 stretch=1, 1"}, *more]))
    # SHEAR does not move the second mesh, which is at its origin.


@case
def in_a_batch(run):
    jobs_with_morphs(run, {"in": "in.glb", "out": "o1.glb", "morph": {"a b": "shift.json"}, "clip": ["x: 0", "y: 1 'a b'=1"],
                           "options": {"normals": "keep"}, "set": {}})
    batch(run, "jobs.jsonl", "--resume", "--report", "r.json", "--depfile", "d", done=2)
    asset, data = glb_split(run.read("o0.glb"))
    equal(asset["meshes"][0]["extras"], {"targetNames": ["it's", "stretch"]})
    equal(clip_of(asset, data, "hop"), {0: ([0, 1], [[0, 1], [0, 0]]), 1: ([0, 1], [[1], [0]])})
    equal([a["name"] for a in glb_split(run.read("o1.glb"))[0]["animations"]], ["x", "y"])
    check("sub/shear.json" in run.text("d") and "shift.json" in run.text("d"), run.text("d"))
    entries = json.loads(run.text("r.json"))["jobs"]
    equal([[m["name"] for m in entry["morphs"]] for entry in entries], [["it's", "stretch"], ["a b"]])
    # What each job is made of: the lattices, the names, the clip.
    batch(run, "jobs.jsonl", "--resume", "--report", "s.json", kept=2)
    equal([entry["morphs"] for entry in json.loads(run.text("s.json"))["jobs"]], [entry["morphs"] for entry in entries])
    run.write("sub/shear.json", SHIFT)
    batch(run, "jobs.jsonl", "--resume", done=1, kept=1)
    run.write("jobs.jsonl", run.text("jobs.jsonl").replace("y: 1", "y: 2"))
    batch(run, "jobs.jsonl", "--resume", done=1, kept=1)
    run.write("jobs.jsonl", run.text("jobs.jsonl").replace("it's", "its"))
    batch(run, "jobs.jsonl", "--resume", done=1, kept=1)
    equal(glb_split(run.read("o0.glb"))[0]["meshes"][0]["extras"], {"targetNames": ["its", "stretch"]})
    batch(run, "jobs.jsonl", "--dry-run", "--force", done=2)


@case
def on_the_line_of_a_batch(run):
    write(run, two_meshes(far=[[0.0, 0.0, 0.0]]))
    start(run)
    run.folder_of("o")
    batch(run, "--in", "*.glb", *MORPHS, "--clip", "hop: 0 stretch=1", "--out-dir", "o", done=1)
    asset, data = glb_split(run.read("o/in.glb"))
    equal((asset["meshes"][0]["extras"]["targetNames"], clip_of(asset, data, "hop")), (["squash", "stretch"], {0: ([0], [[0, 1]]), 1: ([0], [[1]])}))
    # A clip for all jobs, but for one that has its own.
    run.write("jobs.jsonl", lines_of([{"in": "in.glb", "out": f"p{k}.glb", "morph": {"m": "shear.json"}, **own}
                                      for k, own in enumerate(({}, {"clip": "own: 0"}, {"clip": []}))]))
    batch(run, "jobs.jsonl", "--clip", "all: 0", done=3)
    equal([a["name"] for k in range(3) for a in glb_split(run.read(f"p{k}.glb"))[0]["animations"]], ["all", "own", "all"])


@case
def jobs_that_are_refused(run):
    good = {"in": "in.glb", "out": "x.glb", "morph": {"a": "shear.json"}}
    jobs = [{**good, "lattice": "shear.json"}, {**good, "morph": {}}, {**good, "morph": "shear.json"},
                     {**good, "morph": {"a": 1}}, {**good, "clip": 1}, {**good, "morph": {"": "shear.json"}}, {**good, "morph": {"a": ""}},
                     {**good, "clip": "hop: 0 b=1"}, {**good, "clip": "hop 0"}, {**good, "options": {"morph": "a=b"}},
                     {**good, "options": {"as-morph": "x"}}, {"in": "in.glb", "out": "x.glb", "lattice": "shear.json", "clip": "c: 0"},
                     {**good, "out": "x.obj"}, {**good, "morphs": {}}]
    jobs_with_morphs(run, *({**job, "out": f"{k}{job['out']}"} for k, job in enumerate(jobs)))
    batch(run, "jobs.jsonl", done=1, failed=[
        '"lattice" and "morph" cannot be used together', '"morph" is an empty object', '"morph" is not an object',
        '"morph": "a" is not the name of a lattice file', '"clip" is not a text or a list of texts', '"morph" has a name that is empty', '"morph" is empty',
        'there is no morph target "b"', '"0" is where ":" after', '"morph" is not an option of a job', "--as-morph cannot be used with --morph",
        "--clip needs --morph", "cannot hold a morph target", 'unknown key "morphs" .nearest: "morph"'])
    run.write("view.jsonl", lines_of([good]))
    batch(run, "view.jsonl", "--view", "v", failed=['"morph" cannot be used with --view: a picture shows one deformation'])


main()
