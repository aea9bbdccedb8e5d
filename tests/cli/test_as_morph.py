#!/usr/bin/env python3
"""ffd deform --as-morph: the base stays, and the deformation is a further morph target."""

import json
import re
import struct

from gltf_build import SHEAR, SHIFT, Scene, vectors
from gltf_reader import Gltf
from harness import (CUBE, INVALID, LIMIT, NO, USAGE, case, check, equal, glb_split, gltf_vectors, lattice, main, near)

POINTS = [[1.0, 2.0, 0.0], [2.0, -4.0, 1.0]]
NORMALS = [[0.6000000238418579, 0.800000011920929, 0.0]] * 2


def plain(**members):
    scene = Scene(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], **members)
    attributes = {"POSITION": scene.add(POINTS, bounds=True), "NORMAL": scene.add(NORMALS),
                  "TANGENT": scene.add([[0.8, -0.6, 0.0, -1.0]] * 2, shape="VEC4")}
    scene.asset["meshes"] = [{"primitives": [{"attributes": attributes, "mode": 0}]}]
    return scene


def run_morphed(run, scene, *options, box=SHEAR, name="bent", **expected):
    run.write("in.glb", scene.glb())
    run.write("l.json", box)
    return run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", "--as-morph", name, *options, **expected)


def morphed(run, scene, *options, **expected):
    run_morphed(run, scene, *options, **expected)
    return run.read("out.glb")


def stored(asset, data, number):
    """An accessor with its bytes."""
    accessor = asset["accessors"][number]
    view = asset["bufferViews"][accessor["bufferView"]]
    return accessor, data[view.get("byteOffset", 0):view.get("byteOffset", 0) + view["byteLength"]]


def sheared(p):
    return [0.05 * p[0] * p[1], 0, 0]


def floats(asset, data, accessor):
    accessor = asset["accessors"][accessor]
    view = asset["bufferViews"][accessor["bufferView"]]
    return list(struct.unpack_from(f"<{accessor['count']}f", data, view.get("byteOffset", 0)
                                   + accessor.get("byteOffset", 0)))


@case
def the_target_is_the_difference(run):
    scene = plain()
    asset, data = glb_split(morphed(run, scene))
    deformed = None
    run.ffd("deform", "in.glb", "moved.glb", "-l", "l.json")
    deformed = run.read("moved.glb")
    mesh = asset["meshes"][0]
    target = mesh["primitives"][0]["targets"][0]
    equal(list(target), ["POSITION", "NORMAL", "TANGENT"])
    equal((mesh["weights"], mesh["extras"]), ([0], {"targetNames": ["bent"]}))
    old, old_data = glb_split(run.read("in.glb"))
    equal(data[:len(old_data)], old_data)
    equal(asset["accessors"][:3], old["accessors"])
    near(gltf_vectors(asset, data, target["POSITION"]), [sheared(p) for p in POINTS], 1e-6)
    near(gltf_vectors(asset, data, target["NORMAL"]),
         [[b - a for a, b in zip(n, m)] for n, m in zip(NORMALS, vectors(deformed, 1))], 1e-6)
    bounds = asset["accessors"][target["POSITION"]]
    found = gltf_vectors(asset, data, target["POSITION"])
    equal((bounds["min"], bounds["max"]), ([min(v[a] for v in found) for a in range(3)],
                                          [max(v[a] for v in found) for a in range(3)]))
    check(bounds["componentType"] == 5126, bounds)
    for number in target.values():
        check("bufferView" in asset["accessors"][number], "zeros were left")
    equal(len(asset["accessors"]), 6)
    keep = glb_split(morphed(run, scene, "--normals", "keep"))[0]
    equal(list(keep["meshes"][0]["primitives"][0]["targets"][0]), ["POSITION"])


@case
def a_zero_shape_has_its_target_too(run):
    """A zero shape has its target too, in every mesh: shapes made by one pipeline have the same names."""
    scene = plain()
    scene.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]})
    scene.asset["nodes"].append({"mesh": 1, "name": "second"})
    scene.asset["scenes"][0]["nodes"].append(1)
    run.write("in.glb", scene.glb())
    run.write("l.json", lattice(low=(50, 50, 50), high=(60, 60, 60), moves=[{"by": [1, 0, 0]}]))
    run.write("still.json", lattice(low=(-9, -9, -9), high=(9, 9, 9)))
    for name, lines in (("l.json", 2), ("still.json", 1)):
        done = run.ffd("deform", "in.glb", "out.glb", "-l", name, "--as-morph", "x", "--force", lines=lines)
        equal(done.err[-1], "in.glb: no vertex moves: all offsets of the morph target are 0")
        asset, data = glb_split(run.read("out.glb"))
        old, old_data = glb_split(run.read("in.glb"))
        equal((asset["accessors"][:3], data), (old["accessors"], old_data), "the base")
        for mesh in asset["meshes"]:
            equal((mesh["weights"], mesh["extras"]), ([0], {"targetNames": ["x"]}))
            for number in mesh["primitives"][0]["targets"][0].values():
                zeros = asset["accessors"][number]
                equal((zeros["count"], zeros["type"], "bufferView" in zeros), (2, "VEC3", False), "no bytes: all zeros")
    run.ffd("deform", "in.glb", "part.glb", "-l", "still.json", "--as-morph", "x", "--only", "node:second", lines=1)
    equal(["weights" in mesh for mesh in glb_split(run.read("part.glb"))[0]["meshes"]], [False, True], "what --only selects")


@case
def a_target_of_the_name_is_replaced(run):
    """Its place, its weights and the animations of them stay, and so does every other target. What no longer moves gets
    zeros: an old shape under the name would be wrong."""
    scene = plain()
    far = scene.add([[90.0, 0.0, 0.0]], bounds=True)
    scene.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": far}, "mode": 0}]})
    scene.asset["nodes"].append({"mesh": 1})
    scene.asset["scenes"][0]["nodes"].append(1)
    for mesh, count in zip(scene.asset["meshes"], (2, 1)):
        mesh["primitives"][0]["targets"] = [{"POSITION": scene.add([[float(t), 7.0, 0.0]] * count, bounds=True)} for t in range(3)]
        mesh.update(weights=[0.25, 0.5, 0.75], extras={"targetNames": ["a", "bent", "c"]})
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    scene.asset["animations"] = [{
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        "samplers": [{"input": times, "output": scene.add([[float(v)] for v in range(6)], shape="SCALAR")}]}]
    told = [f"in.glb: mesh {m} has a morph target \"bent\" already: it is replaced" for m in range(2)]
    done = run_morphed(run, scene, lines=3)
    equal([line for line in done.err if "already" in line], told)
    asset, data = glb_split(run.read("out.glb"))
    old, old_data = glb_split(run.read("in.glb"))
    equal(asset["animations"], old["animations"])
    equal(len(data), len(old_data) + 2 * 24, "offsets of normals and tangents are new, and nothing else")
    replaced = [mesh["primitives"][0]["targets"][1]["POSITION"] for mesh in old["meshes"]]
    for number in range(len(old["accessors"])):
        if number not in replaced:
            equal(stored(asset, data, number), stored(old, old_data, number), f"accessor {number}")
    for m, mesh in enumerate(asset["meshes"]):
        equal((mesh["weights"], mesh["extras"]), ([0.25, 0.5, 0.75], {"targetNames": ["a", "bent", "c"]}))
        targets, were = mesh["primitives"][0]["targets"], old["meshes"][m]["primitives"][0]["targets"]
        equal([targets[0], targets[2], len(targets)], [were[0], were[2], 3])
    bent = asset["meshes"][0]["primitives"][0]["targets"][1]
    near(gltf_vectors(asset, data, bent["POSITION"]), [sheared(p) for p in POINTS], 1e-6)
    equal(list(bent), ["POSITION", "NORMAL", "TANGENT"])
    zeros = asset["accessors"][asset["meshes"][1]["primitives"][0]["targets"][1]["POSITION"]]
    equal((zeros["min"], zeros["max"], zeros["count"]), ([0, 0, 0], [0, 0, 0], 1))
    equal(gltf_vectors(asset, data, asset["meshes"][1]["primitives"][0]["targets"][1]["POSITION"]), [[0, 0, 0]])
    # The same once more changes nothing; other moves leave a file of the same size.
    first = run.read("out.glb")
    run.ffd("deform", "out.glb", "again.glb", "-l", "l.json", "--as-morph", "bent", "-q")
    equal(run.read("again.glb"), first)
    run.write("other.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [0, 0.5, 0]}]))
    run.ffd("deform", "out.glb", "--in-place", "-l", "other.json", "--as-morph", "bent", "-q")
    asset, data = glb_split(run.read("out.glb"))
    equal((len(asset["accessors"]), len(data)), (len(glb_split(first)[0]["accessors"]), len(glb_split(first)[1])))
    near(gltf_vectors(asset, data, asset["meshes"][0]["primitives"][0]["targets"][1]["POSITION"]), [[0, 0.5, 0]] * 2, 1e-7)


@case
def padding_of_the_json_does_not_add_up(run):
    run.write("out.glb", plain().glb())
    run.write("l.json", SHEAR)
    for count in range(1, 9):
        run.ffd("deform", "out.glb", "--in-place", "-l", "l.json", "--as-morph", "n" * count)
        content = run.read("out.glb")
        text = content[20:20 + struct.unpack_from("<I", content, 12)[0]]
        check(len(text) - len(text.rstrip(b" ")) <= 3, f"{count} targets: {text[-20:]}")
    wide = text + b" " * 8
    run.write("wide.glb", content[:8] + struct.pack("<2I", len(content) + 8, len(wide)) + content[16:20] + wide + content[20 + len(text):])
    run.ffd("deform", "wide.glb", "--in-place", "-l", "l.json")
    content = run.read("wide.glb")
    text = content[20:20 + struct.unpack_from("<I", content, 12)[0]]
    check(len(text) - len(text.rstrip(b" ")) <= 3, f"without a target: {text[-20:]}")


@case
def a_replaced_target_shares_its_offsets_with_nothing(run):
    """Offsets that another target or a node that is not selected shows stay as they are."""
    scene = plain()
    shared = scene.add([[5.0, 5.0, 5.0]] * 2, bounds=True)
    scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": shared} for _ in range(2)]
    scene.asset["meshes"][0].update(extras={"targetNames": ["a", "bent"]}, weights=[0, 1])
    asset, data = glb_split(morphed(run, scene, lines=1))
    targets = asset["meshes"][0]["primitives"][0]["targets"]
    equal((targets[0]["POSITION"], gltf_vectors(asset, data, shared)), (shared, [[5, 5, 5]] * 2))
    near(gltf_vectors(asset, data, targets[1]["POSITION"]), [sheared(p) for p in POINTS], 1e-6)
    # Two nodes show the mesh, and one is deformed: the other keeps its shape.
    scene = plain()
    own = scene.add([[5.0, 5.0, 5.0]] * 2, bounds=True)
    scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": own}]
    scene.asset["meshes"][0].update(extras={"targetNames": ["bent"]})
    scene.asset["nodes"] = [{"mesh": 0, "name": "one"}, {"mesh": 0, "name": "two"}]
    scene.asset["scenes"][0]["nodes"] = [0, 1]
    asset, data = glb_split(morphed(run, scene, "--only", "node:two", lines=1))
    found = [asset["meshes"][node["mesh"]]["primitives"][0]["targets"][0]["POSITION"] for node in asset["nodes"]]
    equal((found[0], gltf_vectors(asset, data, own)), (own, [[5, 5, 5]] * 2))
    near(gltf_vectors(asset, data, found[1]), [sheared(p) for p in POINTS], 1e-6)
    # So it does where its offsets are sparse, or those of another target.
    places, values = scene.view(b"\1\0\0\0"), scene.view(struct.pack("<3f", 5, 5, 5))
    scene.asset["accessors"][own] = {
        "componentType": 5126, "count": 2, "type": "VEC3", "min": [0, 0, 0], "max": [5, 5, 5], "sparse": {
            "count": 1, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values}}}
    for names in (["bent"], ["bent", "other"]):
        scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": own} for _ in names]
        scene.asset["meshes"][0].update(extras={"targetNames": names})
        asset, data = glb_split(morphed(run, scene, "--only", "node:two", lines=1))
        targets = [asset["meshes"][node["mesh"]]["primitives"][0]["targets"] for node in asset["nodes"]]
        equal([target["POSITION"] for target in targets[0]], [own for _ in names])
        near(gltf_vectors(asset, data, targets[1][0]["POSITION"]), [sheared(p) for p in POINTS], 1e-6)
        equal([target["POSITION"] for target in targets[1][1:]], [own for _ in names[1:]])
        check("sparse" in asset["accessors"][own], asset["accessors"][own])
    # What is stored in whole numbers cannot stay beside floats, which is said.
    scene.asset["accessors"][own] |= {"componentType": 5122, "normalized": True}
    for key in ("sparse", "min", "max"):
        del scene.asset["accessors"][own][key]
    done = run_morphed(run, scene, "--only", "node:two", err=lambda said: None)
    equal([line for line in done.err if "already" in line],
          ['in.glb: mesh 0 has a morph target "bent" already: it is replaced, and nodes that are not selected lose its offsets, too'])


@case
def other_targets_and_their_names_stay(run):
    def scene_with(targets, **members):
        scene = plain()
        for primitive in scene.asset["meshes"][0]["primitives"]:
            primitive["targets"] = [{"POSITION": scene.add([[float(t), 0.0, 0.0]] * 2, bounds=True)}
                                    for t in range(targets)]
        scene.asset["meshes"][0].update(members)
        return scene

    def mesh(scene, **expected):
        asset, data = glb_split(morphed(run, scene, **expected))
        for t, target in enumerate(asset["meshes"][0]["primitives"][0]["targets"][:-1]):
            equal(gltf_vectors(asset, data, target["POSITION"]), [[t, 0, 0]] * 2)
        last = asset["meshes"][0]["primitives"][0]["targets"][-1]
        near(gltf_vectors(asset, data, last["POSITION"]), [sheared(p) for p in POINTS], 1e-6)
        return asset["meshes"][0]

    found = mesh(scene_with(2, weights=[0.5, 1], extras={"targetNames": ["a", "b"], "more": [1.50]}))
    equal((found["weights"], found["extras"]), ([0.5, 1, 0], {"targetNames": ["a", "b", "bent"], "more": [1.5]}))
    found = mesh(scene_with(2))
    equal((found["weights"], found["extras"]), ([0, 0, 0], {"targetNames": ["target_0", "target_1", "bent"]}))
    found = mesh(scene_with(2, extras={"targetNames": ["a"]}))
    equal(found["extras"], {"targetNames": ["a", "target_1", "bent"]})
    # No two get one name, where the new one or another is called as those without a name are.
    found = mesh(scene_with(2), name="target_1")
    equal(found["extras"], {"targetNames": ["target_0", "target_1_1", "target_1"]})
    found = mesh(scene_with(2, extras={"targetNames": ["target_1"]}))
    equal(found["extras"], {"targetNames": ["target_1", "target_1_1", "bent"]})
    found = mesh(scene_with(1, extras={"targetNames": ["a", "left over", "c"]}))
    equal(found["extras"], {"targetNames": ["a", "bent", "c"]})
    found = mesh(scene_with(1, extras={}, weights=[]), err=re.compile("the default weights are"))
    equal((found["weights"], found["extras"]), ([0], {"targetNames": ["target_0", "bent"]}))
    found = mesh(scene_with(0, extras=[1]), err="in.glb: mesh 0: its extras cannot hold the name of the morph target")
    equal(found["extras"], [1])
    # A name beyond the targets is that of none.
    found = mesh(scene_with(1, extras={"targetNames": ["a", "bent"]}))
    equal(found["extras"], {"targetNames": ["a", "bent"]})
    found = json.loads(json.dumps(glb_split(morphed(run, plain(), name='b"\\\u00e4'))[0]))["meshes"][0]
    equal(found["extras"]["targetNames"], ['b"\\\u00e4'])


def unequal(counts, names=None):
    """A mesh of primitives with so many targets, target t of which moves all by t along y; weights of 0.5."""
    scene = plain()
    attributes = scene.asset["meshes"][0]["primitives"][0]["attributes"]
    scene.asset["meshes"][0]["primitives"] = [
        {"attributes": {"POSITION": attributes["POSITION"] if p == 0 else scene.add(POINTS, bounds=True)}, "mode": 0,
         **({"targets": [{"POSITION": scene.add([[0.0, float(t + 1), 0.0]] * 2, bounds=True)} for t in range(count)]} if count else {})}
        for p, count in enumerate(counts)]
    scene.asset["meshes"][0]["weights"] = [0.5] * max(counts)
    if names:
        scene.asset["meshes"][0]["extras"] = {"targetNames": names}
    return scene


def offsets_of(run, name, mesh=0):
    """Of each primitive, of each target, how far the first vertex moves."""
    gltf = Gltf(run.path(name))
    return [[list(gltf.decoded(target["POSITION"])[0]) for target in primitive.get("targets", [])]
            for primitive in gltf.asset["meshes"][mesh]["primitives"]]


@case
def a_new_target_has_one_number_in_all_primitives(run):
    """Also where they have not as many targets: targets of zeros fill the gaps, and the new one has the weight 0."""
    told_of = re.compile("has (0 morph targets|1 morph target), but another one of its mesh has [12]")
    for counts in ([1, 0], [0, 2], [1, 2, 2], [2, 1, 0]):
        most = max(counts)
        old = [[[0, t + 1, 0] if t < count else [0, 0, 0] for t in range(most)] for count in counts]
        morphed(run, unequal(counts), err=told_of, box=SHIFT)
        equal(offsets_of(run, "out.glb"), [targets + [[1, 0, 0]] for targets in old], str(counts))
        equal(Gltf(run.path("out.glb")).asset["meshes"][0]["weights"], [0.5] * most + [0], str(counts))
        run.ffd("deform", "in.glb", "out.glb", "--force", "--morph", "one=l.json", "--morph", "two=l.json", err=told_of)
        equal(offsets_of(run, "out.glb"), [targets + [[1, 0, 0]] * 2 for targets in old], f"two targets, {counts}")
        # What is filled is not deformed by the next run, and the file is sound now.
        run.ffd("deform", "out.glb", "again.glb", "--force", "-l", "l.json", "--as-morph", "three")
        equal(offsets_of(run, "again.glb"), [targets + [[1, 0, 0]] * 3 for targets in old], f"again, {counts}")
    # A target that only some primitives have is replaced in all.
    morphed(run, unequal([2, 1], names=["a", "b"]), name="b", box=SHIFT, err=lambda said: None)
    equal(offsets_of(run, "out.glb"), [[[0, 1, 0], [1, 0, 0]]] * 2)
    equal(Gltf(run.path("out.glb")).asset["meshes"][0]["weights"], [0.5, 0.5])


@case
def primitives_with_fewer_targets_than_others_are_a_flaw(run):
    run.write("in.glb", unequal([1, 0, 2]).glb())
    run.write("l.json", SHIFT)
    run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", "--report", "r.json", err=re.compile("has 1 morph target, but another"))
    equal([(flaw["pointer"], flaw["count"]) for flaw in json.loads(run.text("r.json"))["jobs"][0]["flaws"]],
          [("/meshes/0/primitives/0", 2)])
    run.ffd("deform", "in.glb", "strict.glb", "-l", "l.json", "--strict", code=INVALID, lines=1)


@case
def gaps_beyond_the_memory_are_refused(run):
    scene = plain()
    primitive = scene.asset["meshes"][0]["primitives"][0]
    scene.asset["meshes"][0]["primitives"] = [{**primitive, "targets": [{}] * 3000}] + [dict(primitive) for _ in range(3000)]
    done = run_morphed(run, scene, code=LIMIT, err=lambda said: None)
    check("memory" in done.err[-1], done.err)


@case
def names_that_stand_in_primitives_are_names(run):
    """Older exporters write them there. A name at the mesh comes first, target by target."""
    for at_mesh, at_primitives, name, place, mesh_after, primitives_after in (
            (None, [["smile", "blink"]], "blink", 1, None, [["smile", "blink"]]),
            (None, [["smile", "blink"]], "new", 2, ["smile", "blink", "new"], [["smile", "blink", "new"]]),
            (None, [None, ["smile", "blink"]], "smile", 0, None, [None, ["smile", "blink"]]),
            (None, [["smile"]], "new", 2, ["smile", "target_1", "new"], [["smile", "target_1", "new"]]),
            (None, [["smile", "blink", "more", "yet"]], "more", 2, ["smile", "blink", "more"], [["smile", "blink", "more", "yet"]]),
            (["a", "b"], [["smile", "blink"]], "blink", 2, ["a", "b", "blink"], [["smile", "blink", "blink"]]),
            (["a"], [["smile", "blink"]], "blink", 1, ["a"], [["smile", "blink"]]),
            (["a"], [["smile", "blink"]], "new", 2, ["a", "blink", "new"], [["smile", "blink", "new"]]),
            (["a", 7], [["smile", "blink"], ["x", "y"]], "y", 2, ["a", 7, "y"], [["smile", "blink", "y"], ["x", "y", "y"]]),
            (None, [[1, "blink"], ["x", "y"]], "x", 0, None, [[1, "blink"], ["x", "y"]])):
        scene = unequal([2] * len(at_primitives), at_mesh)
        for primitive, names in zip(scene.asset["meshes"][0]["primitives"], at_primitives, strict=True):
            if names:
                primitive["extras"] = {"targetNames": names}
        morphed(run, scene, name=name, box=SHIFT, err=lambda said: None)
        mesh = Gltf(run.path("out.glb")).asset["meshes"][0]
        what = f"{at_mesh} {at_primitives} {name}"
        equal(mesh.get("extras", {}).get("targetNames"), mesh_after, what)
        equal([p.get("extras", {}).get("targetNames") for p in mesh["primitives"]], primitives_after, what)
        for targets in offsets_of(run, "out.glb"):
            equal([offset == [1, 0, 0] for offset in targets].index(True), place, what)


@case
def of_targets_of_one_name_the_first_is_replaced(run):
    """And a line tells how many there are."""
    for names, line in ((["a", "smile", "smile"], 'mesh 0 has 2 morph targets "smile" already: the first is replaced'),
                        (["a", "smile", "b"], 'mesh 0 has a morph target "smile" already: it is replaced')):
        morphed(run, unequal([3], names), name="smile", box=SHIFT, err=f"in.glb: {line}")
        equal([offset == [1, 0, 0] for offset in offsets_of(run, "out.glb")[0]], [False, True, False])


@case
def a_clip_finds_names_that_stand_in_primitives(run):
    scene = unequal([2])
    scene.asset["meshes"][0]["primitives"][0]["extras"] = {"targetNames": ["smile", "blink"]}
    run.write("in.glb", scene.glb())
    run.write("l.json", SHIFT)
    run.ffd("deform", "in.glb", "out.glb", "--morph", "new=l.json", "--clip", "hop: 0, 1 blink=0.25 new=1")
    asset, data = glb_split(run.read("out.glb"))
    equal(floats(asset, data, asset["animations"][0]["samplers"][0]["output"]), [0.5, 0, 0, 0.5, 0.25, 1])
    done = run.ffd("deform", "in.glb", "no.glb", "--morph", "new=l.json", "--clip", "hop: 0, 1 blunk=1", code=USAGE, lines=1)
    check('nearest: "blink"' in done.err[0], done.err)


def animated(scene, channels):
    """Adds an animation of two keys; of each channel its target, the values of its output, and its interpolation."""
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    samplers, made = [], []
    for target, values, *interpolation in channels:
        if values is not None:
            samplers.append({"input": times, "output": scene.add([[float(v)] for v in values], shape="SCALAR"),
                             **({"interpolation": interpolation[0]} if interpolation else {})})
        made.append({"sampler": len(samplers) - 1, "target": target if isinstance(target, dict) else {
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": target}}}})
    scene.asset["animations"] = [{"channels": made, "samplers": samplers}]


OF_NODE = {"node": 0, "path": "weights"}


@case
def stale_weights_of_an_animation_do_not_drive_the_new_target(run):
    """As many values as there were targets once. Viewers take rows of values, one for each key."""
    for count, channels, expected in (
            (0, [(OF_NODE, [0, 1])], [[0, 0]]), (0, [(OF_NODE, [1, 2, 3, 4])], [[0, 0]]),
            (0, [("/meshes/0/weights", [0, 1])], [[0, 0]]), (0, [("/nodes/0/weights", [0, 1])], [[0, 0]]),
            (0, [("/meshes/0/weights/0", [0, 1])], [[0, 0]]), (1, [("/nodes/0/weights/1", [0, 1])], [[0, 0]]),
            (1, [(OF_NODE, [1, 2, 3, 4])], [[1, 0, 3, 0]]), (2, [(OF_NODE, [1, 2])], [[1, 0, 0, 2, 0, 0]]),
            (1, [(OF_NODE, list(range(12)), "CUBICSPLINE")], [[0, 0, 2, 0, 4, 0, 6, 0, 8, 0, 10, 0]]),
            (0, [(OF_NODE, list(range(6)), "CUBICSPLINE")], [[0] * 6]),
            (1, [("/meshes/0/weights/0", [0, 1]), ("/meshes/0/weights/1", None)], [[0, 1], [0, 0]]),
            (1, [({"node": 0, "path": "translation"}, [0, 1]), (OF_NODE, [1, 2, 3, 4])], [[0, 1], [1, 0, 3, 0]])):
        scene = unequal([count])
        animated(scene, channels)
        done = run_morphed(run, scene, box=SHIFT, err=lambda said: None)
        stale = [line for line in done.err if "and does not drive the new one: /animations/0/channels/" in line]
        equal(len(stale), 1, f"{count} {channels}: {done.err}")
        gltf = Gltf(run.path("out.glb"))
        animation = gltf.asset["animations"][0]
        equal([[x[0] for x in gltf.decoded(animation["samplers"][channel["sampler"]]["output"])] for channel in animation["channels"]],
              expected, f"{count} {channels}")


@case
def meshes_that_share_a_sampler_get_outputs_of_their_own(run):
    """One has a target and the other none; a third one does not change, and keeps what it had."""
    scene = unequal([1])
    scene.asset["meshes"] += [{"primitives": [{"attributes": {"POSITION": scene.add(POINTS, bounds=True)}, "mode": 0}]},
                              {"primitives": [{"attributes": {"POSITION": scene.add([[90.0, 0, 0]], bounds=True)}, "mode": 0,
                                               "targets": [{}]}]}]
    scene.asset["nodes"] += [{"mesh": 1}, {"mesh": 2}]
    scene.asset["scenes"][0]["nodes"] += [1, 2]
    animated(scene, [(OF_NODE, [0.25, 0.5]), ({"node": 1, "path": "weights"}, None), ({"node": 2, "path": "weights"}, None)])
    run_morphed(run, scene, box=SHIFT, err=lambda said: None)
    gltf = Gltf(run.path("out.glb"))
    animation = gltf.asset["animations"][0]
    equal([[x[0] for x in gltf.decoded(animation["samplers"][channel["sampler"]]["output"])] for channel in animation["channels"]],
          [[0.25, 0, 0.5, 0], [0, 0], [0.25, 0.5]])


@case
def weights_that_are_no_rows_do_not_drive_the_new_target(run):
    """Values that are no row for each key, too few or too many: those of the targets stay in their places, and what is
    missing becomes 0."""
    for count, values, expected in ((2, [1, 2, 3], [1, 2, 0, 3, 0, 0]), (2, [1], [1, 0, 0]), (1, [1, 2, 3], [1, 0, 2, 0]),
                                    (2, [1, 2, 3, 4, 5], [1, 2, 0, 3, 4, 0]), (0, [1, 2, 3], [0, 0])):
        scene = unequal([count])
        animated(scene, [(OF_NODE, values)])
        done = run_morphed(run, scene, box=SHIFT, err=lambda said: None)
        equal(len([line for line in done.err if "/animations/0/channels/0" in line]), 1, done.err)
        gltf = Gltf(run.path("out.glb"))
        equal([x[0] for x in gltf.decoded(gltf.asset["animations"][0]["samplers"][0]["output"])], expected)


@case
def a_weight_that_no_target_had_is_not_that_of_the_new_one(run):
    """Of a mesh or a node that has more weights than targets: the new target is not shown."""
    for holder in ("mesh", "node"):
        for weights, expected in (([0.25, 1], [0.25, 0]), ([0.25, 1, 1], [0.25, 0, 1]), ([0.25], [0.25, 0])):
            scene = plain()
            scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": scene.add(POINTS, bounds=True)}]
            scene.asset["meshes" if holder == "mesh" else "nodes"][0]["weights"] = weights
            morphed(run, scene, lines=1 if len(weights) > 1 else 0)
            asset, _ = glb_split(run.read("out.glb"))
            equal(asset["meshes" if holder == "mesh" else "nodes"][0]["weights"], expected, f"{holder} {weights}")


@case
def check_judges_what_deform_does(run):
    """Other targets stay: one that leaves the lattice fails no gate, and bounds are those of the base."""
    scene = plain()
    mesh = scene.asset["meshes"][0]
    mesh["primitives"][0]["targets"] = [{"POSITION": scene.add([[50.0, 0.0, 0.0]] * 2, bounds=True)}]
    mesh["weights"] = [1]
    morphed(run, scene, "--fail-on", "outside", "--report", "d.json", "--report-stable")
    run.ffd("check", "in.glb", "-l", "l.json", "--as-morph", "bent", "--fail-on", "outside", "--report", "c.json", "--report-stable")
    found = [json.loads(run.text(name))["jobs"][0] for name in ("d.json", "c.json")]
    for member in ("morph_targets", "bounds", "outside", "displacement"):
        equal(found[1][member], found[0][member], member)
    equal(found[0]["morph_targets"], {"outside": 0, "shown_outside": 0, "invalid": 0})
    run.ffd("check", "in.glb", "-l", "l.json", "--fail-on", "outside", code=NO, err=re.compile("morph targets move"))


@case
def every_primitive_of_a_mesh_and_only_meshes_that_move(run):
    scene = plain()
    far = scene.add([[90.0, 0.0, 0.0]], bounds=True)
    scene.asset["meshes"][0]["primitives"].append({"attributes": {"POSITION": far}, "mode": 0})
    scene.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": far}, "mode": 0}]})
    scene.asset["nodes"].append({"mesh": 1})
    scene.asset["scenes"][0]["nodes"].append(1)
    asset, _ = glb_split(morphed(run, scene, lines=1))
    first, second = asset["meshes"][0]["primitives"]
    equal((len(first["targets"]), len(second["targets"])), (1, 1))
    zeros = asset["accessors"][second["targets"][0]["POSITION"]]
    equal((zeros["count"], zeros["min"], zeros["max"]), (1, [0, 0, 0], [0, 0, 0]))
    equal(asset["meshes"][1], scene.asset["meshes"][1])


@case
def nodes_that_see_it_otherwise(run):
    scene = plain()
    scene.asset["nodes"] += [{"mesh": 0, "translation": [4, 0, 0], "weights": []}, {"mesh": 0, "translation": [90, 0, 0]},
                             {"mesh": 0}]
    scene.asset["scenes"][0]["nodes"] += [1, 2]
    asset, data = glb_split(morphed(run, scene, lines=2))
    places = []
    for n in range(4):
        mesh = asset["meshes"][asset["nodes"][n]["mesh"]]
        target = mesh["primitives"][0]["targets"][0]["POSITION"]
        equal((mesh["weights"], mesh["extras"]["targetNames"]), ([0], ["bent"]))
        moved = "bufferView" in asset["accessors"][target]
        places.append(gltf_vectors(asset, data, target) if moved else [[0, 0, 0]] * 2)
    near(places, [[sheared(p) for p in POINTS], [sheared([p[0] + 4, p[1]]) for p in POINTS], [[0, 0, 0]] * 2,
                  [[0, 0, 0]] * 2], 1e-6)
    equal(asset["nodes"][1]["weights"], [0])
    check("weights" not in asset["nodes"][0], asset["nodes"])


@case
def animations_of_weights_go_on(run):
    scene = plain()
    primitive = scene.asset["meshes"][0]["primitives"][0]
    primitive["targets"] = [{"POSITION": scene.add([[0.0] * 3] * 2, bounds=True)} for _ in range(2)]
    scene.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": scene.add([[90.0, 0.0, 0.0]], bounds=True)},
                                                  "mode": 0, "targets": [{}, {}]}]})
    scene.asset["nodes"].append({"mesh": 1})
    scene.asset["scenes"][0]["nodes"].append(1)
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    linear = scene.add([[v] for v in (1.0, 2.0, 3.0, 4.0)], shape="SCALAR")
    cubic = scene.add([[float(v)] for v in range(12)], shape="SCALAR")
    bytes_ = scene.add([[0], [255], [51], [0]], 5121, "SCALAR", normalized=True)

    def channel(sampler, node):
        return {"sampler": sampler, "target": {"node": node, "path": "weights"}}

    scene.asset["animations"] = [{
        "channels": [channel(0, 0), channel(1, 0), channel(2, 0), channel(2, 1)],
        "samplers": [{"input": times, "output": linear}, {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"},
                     {"input": times, "output": bytes_, "extras": 7}]}]
    asset, data = glb_split(morphed(run, scene, lines=1))
    animation = asset["animations"][0]
    equal([c["sampler"] for c in animation["channels"]], [0, 1, 3, 2])
    outputs = [floats(asset, data, s["output"]) for s in (animation["samplers"][i] for i in (0, 1, 3))]
    equal(outputs[0], [1, 2, 0, 3, 4, 0])
    equal(outputs[1], [0, 1, 0, 2, 3, 0, 4, 5, 0, 6, 7, 0, 8, 9, 0, 10, 11, 0])
    near(outputs[2], [0, 1, 0, 0.2, 0, 0], 1e-6)
    equal(animation["samplers"][2], scene.asset["animations"][0]["samplers"][2])
    equal(animation["samplers"][3]["extras"], 7)
    equal(animation["samplers"][3]["input"], times)
    # The same in a .gltf with a data URI, and one without buffers of its own kind.
    check(len(asset["buffers"]) == 1, asset["buffers"])


@case
def pointers_to_all_weights_go_on(run):
    """KHR_animation_pointer: rows of all weights get one for the new target; a single weight does not."""
    scene = plain()
    scene.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": scene.add([[0.0] * 3] * 2, bounds=True)}
                                                            for _ in range(2)]
    times = scene.add([[0.0], [1.0]], shape="SCALAR", min=[0], max=[1])
    rows = scene.add([[v] for v in (1.0, 2.0, 3.0, 4.0)], shape="SCALAR")
    pointers = ["/meshes/0/weights", "/nodes/0/weights", "/meshes/0/weights/1"]
    scene.asset["animations"] = [{
        "channels": [{"sampler": i, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": p}}}}
                     for i, p in enumerate(pointers)],
        "samplers": [{"input": times, "output": rows}, {"input": times, "output": rows}, {"input": times, "output": times}]}]
    asset, data = glb_split(morphed(run, scene))
    animation = asset["animations"][0]
    equal(animation["channels"], scene.asset["animations"][0]["channels"])
    equal([floats(asset, data, s["output"]) for s in animation["samplers"]], [[1, 2, 0, 3, 4, 0]] * 2 + [[0, 1]])


@case
def what_cannot_have_one(run):
    run.write("cube.obj", CUBE)
    run.write("l.json", SHIFT)
    run.write("in.glb", plain().glb())
    run.ffd("deform", "cube.obj", "out.obj", "-l", "l.json", "--as-morph", "x", code=USAGE,
            err="out.obj: cannot hold a morph target: only .gltf and .glb can (--as-morph)")
    run.ffd("deform", "in.glb", "out.obj", "-l", "l.json", "--as-morph", "x", code=USAGE, lines=1)
    run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", "--as-morph", "", code=USAGE, lines=1)
    for name in ("out.obj", "out.glb"):
        check(not run.exists(name), name)


@case
def conversions_have_one_too(run):
    """The base is the mesh as the input has it; base and target together are the deformed mesh."""
    # Two corners at different positions share a normal, so that in the target it becomes two.
    obj = ("o one\nv 1 2 0\nv 2 -4 1\nv 0 1 1\nvn 0.6 0.8 0\nf 1//1 2//1 3//1\n"
           "o two\nv 90 0 0\nv 91 0 0\nv 90 1 0\nf 4 5 6\n")
    points = [[1, 2, 0], [2, -4, 1], [0, 1, 1]]
    run.write("in.obj", obj)
    run.write("l.json", SHEAR)
    run.ffd("deform", "in.obj", "moved.glb", "-l", "l.json", lines=1)
    moved, moved_data = glb_split(run.read("moved.glb"))
    for name in ("out.glb", "out.gltf"):
        run.ffd("deform", "in.obj", name, "-l", "l.json", "--as-morph", "bent", lines=1)
    asset, data = glb_split(run.read("out.glb"))
    equal(run.read("out.bin"), data)
    equal(json.loads(run.text("out.gltf"))["meshes"], asset["meshes"])
    one, two = asset["meshes"]
    equal((one["weights"], one["extras"]), ([0], {"targetNames": ["bent"]}))
    equal(sorted(two), ["name", "primitives"])
    check("targets" not in two["primitives"][0], two)
    base, target = one["primitives"][0]["attributes"], one["primitives"][0]["targets"][0]
    equal(gltf_vectors(asset, data, base["POSITION"]), [[float(x) for x in p] for p in points])
    near(gltf_vectors(asset, data, base["NORMAL"]), [[0.6, 0.8, 0]] * 3, 1e-7)
    offsets = gltf_vectors(asset, data, target["POSITION"])
    near(offsets, [sheared(p) for p in points], 1e-7)
    turned = gltf_vectors(moved, moved_data, moved["meshes"][0]["primitives"][0]["attributes"]["NORMAL"])
    near([[a + b for a, b in zip(n, m)] for n, m in zip(gltf_vectors(asset, data, base["NORMAL"]),
                                                        gltf_vectors(asset, data, target["NORMAL"]))], turned, 1e-6)
    check(turned[0] != turned[1], turned)
    bounds = asset["accessors"][target["POSITION"]]
    equal((bounds["min"], bounds["max"]), ([min(v[a] for v in offsets) for a in range(3)],
                                          [max(v[a] for v in offsets) for a in range(3)]))
    # The file goes on as any other, from other formats too; where nothing moves every mesh has a target of zeros.
    run.ffd("deform", "out.glb", "more.glb", "-l", "l.json", "--as-morph", "more", lines=1)
    equal(glb_split(run.read("more.glb"))[0]["meshes"][0]["extras"], {"targetNames": ["bent", "more"]})
    for source in ("a.stl", "a.ply", "a.off"):
        run.write("still.json", lattice(moves=[]))
        run.ffd("deform", "in.obj", source, "-l", "still.json", "-q")
        run.ffd("deform", source, f"{source}.glb", "-l", "l.json", "--as-morph", "bent", "-q")
        asset, data = glb_split(run.read(f"{source}.glb"))
        target = asset["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
        near(gltf_vectors(asset, data, target)[:3], [sheared(p) for p in points], 1e-7)
    run.ffd("deform", "in.obj", "only.glb", "-l", "l.json", "--as-morph", "bent", "--only", "object:two", lines=2)
    asset, data = glb_split(run.read("only.glb"))
    for mesh in asset["meshes"]:
        equal((mesh["weights"], mesh["extras"]), ([0], {"targetNames": ["bent"]}))
        equal(gltf_vectors(asset, data, mesh["primitives"][0]["targets"][0]["POSITION"]), [[0, 0, 0]] * 3)
    run.ffd("deform", "in.obj", "still.glb", "-l", "still.json", lines=1)
    whole, whole_data = glb_split(run.read("still.glb"))
    equal([gltf_vectors(asset, data, m["primitives"][0]["attributes"]["POSITION"]) for m in asset["meshes"]],
          [gltf_vectors(whole, whole_data, m["primitives"][0]["attributes"]["POSITION"]) for m in whole["meshes"]], "the base")


@case
def numbers_of_a_conversion_fit(run):
    run.write("in.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 1 0\nf 1 2 3\n")
    run.write("l.json", lattice(low=(-4e38, -1, -1), high=(4e38, 2, 1),
                                moves=[{"rotate": {"axis": "z", "degrees": 180, "about": [0, 0, 0]}}]))
    run.ffd("deform", "in.obj", "moved.glb", "-l", "l.json", "-q")
    run.ffd("deform", "in.obj", "out.glb", "-l", "l.json", "--as-morph", "x", code=INVALID, lines=1)
    check(not run.exists("out.glb"), run.names())


@case
def in_place_and_mesh_space_and_selection(run):
    scene = plain()
    run.write("in.glb", scene.glb())
    run.write("l.json", SHEAR)
    run.ffd("deform", "in.glb", "a.glb", "-l", "l.json", "--as-morph", "bent")
    run.ffd("deform", "in.glb", "--in-place", "-l", "l.json", "--as-morph", "bent")
    equal(run.read("in.glb"), run.read("a.glb"))
    # Once more: a second target, and the first stays.
    run.ffd("deform", "in.glb", "--in-place", "-l", "l.json", "--as-morph", "again")
    asset, data = glb_split(run.read("in.glb"))
    equal(asset["meshes"][0]["extras"]["targetNames"], ["bent", "again"])
    first, second = asset["meshes"][0]["primitives"][0]["targets"]
    equal(gltf_vectors(asset, data, first["POSITION"]), gltf_vectors(asset, data, second["POSITION"]))
    scene.asset["nodes"] = [{"mesh": 0, "name": "one", "translation": [4, 0, 0]}, {"mesh": 0, "name": "two"}]
    scene.asset["scenes"][0]["nodes"] = [0, 1]
    asset, data = glb_split(morphed(run, scene, "--space", "mesh"))
    near(gltf_vectors(asset, data, asset["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]),
         [sheared(p) for p in POINTS], 1e-6)
    asset, data = glb_split(morphed(run, scene, "--only", "node:two"))
    moved = []
    for n in range(2):
        target = asset["meshes"][asset["nodes"][n]["mesh"]]["primitives"][0]["targets"][0]["POSITION"]
        moved.append("bufferView" in asset["accessors"][target])
    equal(moved, [False, True])


main()
