#!/usr/bin/env python3
"""Where extensions of a glTF name meshes and accessors by their numbers, these follow what is copied, or it is said."""

import json

from gltf_build import SHEAR, SHIFT, Scene, vectors
from harness import LIMIT, case, check, equal, glb_split, main
from messages import anything, no_line, one_line

PAIR = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]


def scene_of(meshes, nodes, **members):
    return Scene(meshes=meshes, nodes=nodes, scenes=[{"nodes": list(range(len(nodes)))}], **members)


def points(scene, **members):
    return {"attributes": {"POSITION": scene.add(PAIR, bounds=True)}, "mode": 0, **members}


def instances(count=3, **members):
    """Nodes of one mesh, of which each but the first sees another result."""
    scene = scene_of([], [{"mesh": 0, "translation": [0, n * 8 / count, 0]} for n in range(count)], **members)
    scene.asset["meshes"] = [{"primitives": [points(scene)]}]
    return scene


def deformed(run, scene, lattice=SHEAR, *options, **expected):
    run.write("in.glb", scene.glb())
    run.write("l.json", lattice)
    done = run.ffd("deform", "in.glb", "out.glb", "--force", "-l", "l.json", *options, **{"err": anything, **expected})
    return done, glb_split(run.read("out.glb"))[0]


def pointer(text):
    return {"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": text}}}}


@case
def a_node_that_gets_a_copy_collides_with_it(run):
    scene = instances()
    for n, node in enumerate(scene.asset["nodes"]):
        node["extensions"] = {"KHR_physics_rigid_bodies": {kind: {"geometry": {"mesh": 0, "convexHull": True}}
                                                           for kind in ("collider", "trigger")}}
    done, asset = deformed(run, scene)
    no_line(done, "does not follow|do not follow")
    for n, node in enumerate(asset["nodes"]):
        body = node["extensions"]["KHR_physics_rigid_bodies"]
        equal([node["mesh"], body["collider"]["geometry"], body["trigger"]["geometry"]],
              [n, {"mesh": n, "convexHull": True}, {"mesh": n, "convexHull": True}])


@case
def what_is_of_one_mesh_is_repeated_for_its_copies(run):
    """Channels with the same sampler, and what VRM has for a mesh; what is of another mesh is not."""
    scene = instances()
    scene.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": scene.add([[90.0, 0.0, 0.0]])}, "mode": 0}]})
    scene.asset["extensions"] = {"VRM": {
        "firstPerson": {"meshAnnotations": [{"mesh": 0, "firstPersonFlag": "Auto"}, {"mesh": 1}]},
        "blendShapeMaster": {"blendShapeGroups": [{"binds": [{"mesh": 1, "index": 2}, {"mesh": 0, "index": 1, "weight": 5}]}]}}}
    times = scene.add([[0.0], [1.0]], shape="SCALAR")
    channels = [pointer("/meshes/0/weights"), pointer("/meshes/1/weights"), pointer("/meshes/00"), pointer("/meshes/0x/weights"),
                pointer("/nodes/0/translation"), pointer("/meshes/0/extras/a\"~1b")]
    scene.asset["animations"] = [{"channels": channels, "samplers": [{"input": times, "output": times}]}]
    done, asset = deformed(run, scene)
    no_line(done, "does not follow|do not follow")
    vrm = asset["extensions"]["VRM"]
    equal(vrm["firstPerson"]["meshAnnotations"], [{"mesh": m, "firstPersonFlag": "Auto"} for m in (0, 2, 3)] + [{"mesh": 1}])
    equal(vrm["blendShapeMaster"]["blendShapeGroups"][0]["binds"],
          [{"mesh": 1, "index": 2}] + [{"mesh": m, "index": 1, "weight": 5} for m in (0, 2, 3)])
    equal(asset["animations"][0]["channels"],
          [pointer(f"/meshes/{m}/weights") for m in (0, 2, 3)] + channels[1:5]
          + [pointer(f"/meshes/{m}/extras/a\"~1b") for m in (0, 2, 3)])
    equal(asset["animations"][0]["samplers"], scene.asset["animations"][0]["samplers"])
    done, _ = deformed(run, scene, SHEAR, "-v")
    one_line(done, "8 elements that name meshes are repeated for copies of these, as /animations/0/channels/0 is")
    # Without copies nothing changes.
    equal(deformed(run, scene, SHIFT)[1]["extensions"], scene.asset["extensions"])


@case
def many_channels_of_many_copies_are_refused(run):
    """Half a megabyte would become half a gigabyte: each of 4000 channels has 1000 copies."""
    scene = instances(1000)
    times = scene.add([[0.0], [1.0]], shape="SCALAR")
    scene.asset["animations"] = [{"channels": [pointer("/meshes/0/weights")] * 4000, "samplers": [{"input": times, "output": times}]}]
    run.write("in.glb", scene.glb())
    run.write("l.json", SHEAR)
    run.ffd("deform", "in.glb", "out.glb", "-l", "l.json", code=LIMIT, lines=1)
    check(not run.exists("out.glb"), "an output")


@case
def what_cannot_follow_is_said(run):
    """A shape of a list, a collider of a node without a mesh, a pointer in a graph: with number and three names."""
    scene = instances()
    body = {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"mesh": 0}}}}
    scene.asset["nodes"].append({"translation": [500, 0, 0], "extensions": body})
    scene.asset["scenes"][0]["nodes"].append(3)
    scene.asset["extensions"] = {
        "OMI_physics_shape": {"shapes": [{"type": "convex", "convex": {"mesh": 0}}, {"type": "trimesh", "trimesh": {"mesh": 0}},
                                         {"type": "convex", "convex": {"mesh": 7}}]},
        "KHR_interactivity": {"graphs": [{"nodes": [{"configuration": {"pointer": {"value": ["/meshes/0/weights/0"]}}}]}]}}
    done, asset = deformed(run, scene, SHEAR, "--report", "r.json")
    equal(json.loads(run.read("r.json"))["jobs"][0]["indices_left"], 4)
    one_line(done, "4 indices in extensions do not follow the deformed meshes: ",
         "/extensions/OMI_physics_shape/shapes/0/convex/mesh", "and 1 more")
    equal(asset["extensions"], scene.asset["extensions"])
    equal(asset["nodes"][3], scene.asset["nodes"][3])
    no_line(deformed(run, scene, SHIFT, "--report", "r.json")[0], "does not follow|do not follow")
    check("indices_left" not in json.loads(run.read("r.json"))["jobs"][0], "the report says so too")


def manifold(position):
    return {"EXT_mesh_manifold": {"manifoldPrimitive": {"mode": 4, "indices": 0, "attributes": {"POSITION": position}}}}


@case
def a_manifold_has_the_positions_of_its_mesh(run):
    """Also where the mesh itself gets an accessor: its own was sparse."""
    scene = instances(1)
    indices, values = scene.view(b"\1\0"), scene.view(bytes(12))
    scene.asset["accessors"][0]["sparse"] = {"count": 1, "indices": {"bufferView": indices, "componentType": 5123},
                                             "values": {"bufferView": values}}
    scene.asset["accessors"][0] |= {"min": [0, 0, 0], "max": [0, 0, 0]}
    scene.asset["meshes"][0]["extensions"] = manifold(0)
    done, asset = deformed(run, scene, SHIFT)
    equal(asset["meshes"][0]["primitives"][0]["attributes"]["POSITION"], 1)
    equal(asset["meshes"][0]["extensions"], manifold(1))
    no_line(done, "does not follow|do not follow")


@case
def one_with_positions_of_its_own_is_said(run):
    scene = instances(2)
    own = scene.add(PAIR, bounds=True)
    scene.asset["meshes"][0]["extensions"] = manifold(own)
    done, asset = deformed(run, scene)
    equal([mesh["extensions"] for mesh in asset["meshes"]], [manifold(own)] * 2)
    one_line(done, "1 index in an extension does not follow the deformed mesh: "
         "/meshes/0/extensions/EXT_mesh_manifold/manifoldPrimitive/attributes/POSITION")


@case
def normals_of_silhouettes_are_said_to_stay(run):
    scene = instances(1)
    normals = scene.add(PAIR)
    scene.asset["meshes"][0]["primitives"][0]["extensions"] = {
        "EXT_mesh_primitive_edge_visibility": {"visibility": normals, "silhouetteNormals": normals}}
    done, asset = deformed(run, scene, SHIFT)
    equal(asset["meshes"], scene.asset["meshes"])
    one_line(done, "1 index in an extension does not follow the deformed mesh: "
         "/meshes/0/primitives/0/extensions/EXT_mesh_primitive_edge_visibility/silhouetteNormals$")


@case
def what_an_extension_holds_of_another_mesh_keeps_its_content(run):
    """The positions of mesh 0 are not overwritten where the manifold of mesh 1 has them too."""
    scene = scene_of([], [{"mesh": 0}, {"mesh": 1, "translation": [500, 0, 0]}])
    scene.asset["meshes"] = [{"primitives": [points(scene)]}, {"primitives": [points(scene)], "extensions": manifold(0)}]
    _, asset = deformed(run, scene, SHIFT)
    file = run.read("out.glb")
    equal(asset["meshes"][1], scene.asset["meshes"][1])
    equal([vectors(file, a) for a in (0, asset["meshes"][0]["primitives"][0]["attributes"]["POSITION"])],
          [PAIR, [[x + 1, y, z] for x, y, z in PAIR]])


main()
