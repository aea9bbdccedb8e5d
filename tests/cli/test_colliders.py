#!/usr/bin/env python3
"""A node that is the shape of another one's collider or trigger (KHR_physics_rigid_bodies) goes along with that node: it
is where its body is, whatever its own transform, and nobody sees it."""
from gltf_build import SHEAR, SHIFT, Scene
from harness import case, check, equal, glb_split, gltf_vectors, lattice, main, near, obj_vertices
from posed import Posed, point
from messages import anything, entry, no_line, one_line

CUBE = [[float(x), float(y), float(z)] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
COARSE = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0, 1.0]]
NAME = "KHR_physics_rigid_bodies"


def body(mesh, *shapes, kind="collider", **members):
    """A node whose collider has a node as its shape, and, given two, a trigger with another one."""
    kinds = (kind,) if len(shapes) == 1 else ("collider", "trigger")
    return {"mesh": mesh, "extensions": {NAME: {k: {"geometry": {"node": shape, "convexHull": True}}
                                                for k, shape in zip(kinds, shapes)}}, **members}


def scene(nodes, roots, meshes=(CUBE, COARSE), **members):
    """Points as meshes; the scene lists the roots. roots: None: there is no scene."""
    made = Scene(nodes=nodes, extensionsUsed=[NAME], **members)
    if roots is not None:
        made.asset |= {"scene": 0, "scenes": [{"nodes": list(roots)}]}
    made.asset["meshes"] = [{"name": f"mesh_{i}", "primitives": [{"mode": 0, "attributes": {"POSITION": made.add(mesh, bounds=True)}}]}
                            for i, mesh in enumerate(meshes)]
    return made


def deformed(run, made, *options, moves=SHEAR, **expected):
    run.write("a.glb", made.glb())
    run.write("l.json", moves)
    done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", *options, **{"err": anything, **expected})
    return done, glb_split(run.read("b.glb"))


def positions(file, node):
    asset, data = file
    mesh = asset["meshes"][asset["nodes"][node]["mesh"]]
    return gltf_vectors(asset, data, mesh["primitives"][0]["attributes"]["POSITION"])


def sheared(vertices, x=0, y=0):
    """What SHEAR makes of vertices below a node at x,y."""
    return [[a + 0.05 * (a + x) * (b + y), b, c] for a, b, c in vertices]


@case
def a_shape_with_the_mesh_of_its_body_changes_with_it_in_place(run):
    """Listed before or behind it, and as a trigger."""
    at = {"translation": [2, 1, 0]}
    for nodes, roots in (([{"mesh": 0}, body(0, 0, **at)], [1]), ([body(0, 1, **at), {"mesh": 0}], [0]),
                         ([{"mesh": 0}, body(0, 0, kind="trigger", **at)], [1])):
        done, file = deformed(run, scene(nodes, roots, [CUBE]))
        equal(done.err, [])
        equal([len(file[0]["meshes"]), [node["mesh"] for node in file[0]["nodes"]]], [1, [0, 0]])
        near(positions(file, 0), sheared(CUBE, 2, 1), 1e-6)


@case
def another_mesh_is_deformed_where_the_body_is(run):
    """The shape's own transform, its parent and its scale do not count; nor does another scene that shows it."""
    nodes = [{"name": "room", "translation": [2, 0, 0], "children": [1]}, body(0, 3, 4, name="crate", translation=[1, 2, 0]),
             {"name": "store", "translation": [50, 0, 0], "children": [3]}, {"mesh": 1, "translation": [5, 5, 5], "scale": [9, 9, 9]},
             {"mesh": 2, "rotation": [0, 0, 1, 0]}]
    made = scene(nodes, [0], [CUBE, COARSE, CUBE])
    made.asset["scenes"].append({"nodes": [2]})
    done, file = deformed(run, made)
    equal(done.err, [])
    near(positions(file, 3), sheared(COARSE, 3, 2), 1e-6, "the collider")
    near(positions(file, 4), sheared(CUBE, 3, 2), 1e-6, "the trigger")


@case
def each_body_of_a_compound_has_its_shape(run):
    nodes = [{"name": "table", "extensions": {NAME: {"motion": {"mass": 1}}}, "children": [1, 2]},
             body(0, 3, translation=[1, 1, 0]), body(0, 4, translation=[4, 2, 0]), {"mesh": 1}, {"mesh": 2}]
    done, file = deformed(run, scene(nodes, [0], [CUBE, COARSE, COARSE]))
    no_line(done, "scene|collider")
    near(positions(file, 3), sheared(COARSE, 1, 1), 1e-6)
    near(positions(file, 4), sheared(COARSE, 4, 2), 1e-6)


@case
def a_shape_of_several_bodies_is_deformed_for_the_first(run):
    nodes = [body(0, 3, translation=[1, 2, 0]), body(0, 3, translation=[5, 2, 0]), body(0, 3, translation=[6, 2, 0]), {"mesh": 1}]
    done, file = deformed(run, scene(nodes, [0, 1, 2]))
    one_line(done, r"\b2 uses of nodes by colliders and triggers are at other places")
    near(positions(file, 3), sheared(COARSE, 1, 2), 1e-6)
    nodes[1]["translation"] = nodes[2]["translation"] = [1, 2, 0]
    no_line(deformed(run, scene(nodes, [0, 1, 2]))[0], "collider|scene")
    # One that the scene shows is deformed as it is shown: told where it is elsewhere.
    nodes = [body(0, 1, translation=[1, 2, 0]), {"mesh": 1, "translation": [5, 2, 0]}]
    done, file = deformed(run, scene(nodes, [0, 1]))
    one_line(done, r"\b1 use of a node by a collider or trigger is at another place")
    near(positions(file, 1), sheared(COARSE, 5, 2), 1e-6)
    del nodes[0]["translation"], nodes[1]["translation"]
    equal(deformed(run, scene(nodes, [0, 1]))[0].err, [])
    equal(deformed(run, scene([body(0, 0)], [0], [CUBE]))[0].err, [])


@case
def what_is_no_shape(run):
    """The collider of a shape, what is below a shape, and a number of no node."""
    nodes = [body(0, 1), body(1, 2, children=[3]), {"mesh": 2, "translation": [1, 0, 0]}, {"mesh": 3, "translation": [1, 0, 0]}]
    done, file = deformed(run, scene(nodes, [0], [CUBE, COARSE, COARSE, COARSE]))
    one_line(done, "2 nodes with a mesh are not in the displayed scene")
    for node, moves in ((1, True), (2, False), (3, False)):
        near(positions(file, node), sheared(COARSE) if moves else COARSE, 1e-6, str(node))
    for wrong in (9, -1, "a", 0.5, None):
        done, _ = deformed(run, scene([body(0, wrong)], [0], [CUBE]))
        one_line(done, f"ignored: /nodes/0/extensions/{NAME}/collider/geometry/node")


@case
def a_file_without_scenes_shows_all_roots(run):
    done, file = deformed(run, scene([body(0, 1), {"mesh": 1, "translation": [3, 1, 0]}], None))
    one_line(done, "at another place")
    near(positions(file, 1), sheared(COARSE, 3, 1), 1e-6)


@case
def a_level_of_detail_has_its_own_shape(run):
    nodes = [{"mesh": 0, "extensions": {"MSFT_lod": {"ids": [1]}}, "translation": [1, 0, 0]}, body(0, 2, translation=[3, 1, 0]), {"mesh": 1}]
    made = scene(nodes, [0], [CUBE, COARSE])
    made.asset["extensionsUsed"].append("MSFT_lod")
    done, file = deformed(run, made)
    no_line(done, "collider|scene")
    near(positions(file, 2), sheared(COARSE, 3, 1), 1e-6)


@case
def nobody_sees_a_shape(run):
    """No box, gate, conversion or count of bounds has it, though it is larger than its body."""
    large = [[0.0, 0.0, 0.0], [90.0, 0.0, 0.0], [0.0, 0.0, 90.0]]
    made = scene([body(0, 1), {"mesh": 1}], [0], [CUBE, large])
    done, file = deformed(run, made, "--fail-on", "outside")
    one_line(done, "2 vertices of hidden nodes are not inside")
    near(positions(file, 1), large, 1e-6)  # what is inside does not move: x or y is 0
    run.write("l.json", SHIFT)
    job = entry(run, "check", "a.glb", "-l", "l.json")
    equal([job["vertices"], job["hidden"], job["bounds"]["before"]["max"]], [11, 2, [1, 1, 1]])
    info = run.ffd("info", "a.glb", "--json").json
    equal(info["bounds"]["max"], [1, 1, 1])
    contents = info["contents"]
    equal([contents[f"nodes_with_mesh_{kind}"] for kind in ("not_shown", "of_coarser_detail", "of_colliders")], [0, 0, 1])
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything)
    equal(len(obj_vertices(run.text("b.obj"))), 8)


@case
def a_selected_body_takes_its_shape_along(run):
    nodes = [body(0, 1, name="crate"), {"mesh": 1, "name": "hull"}, {"mesh": 2, "name": "wall"}]
    made = scene(nodes, [0, 2], [CUBE, COARSE, COARSE])
    run.write("a.glb", made.glb())
    parts = {part["selector"]: part["vertices"] for part in run.ffd("info", "a.glb", "--parts", "--json").json["named_parts"]}
    for only, moving in (("node:crate", {0, 1}), ("mesh:mesh_0", {0, 1}), ("node:wall", {2}), ("node:hull", {1})):
        done, file = deformed(run, made, "--only", only)
        no_line(done, "collider|scene")
        for node, mesh in enumerate((CUBE, COARSE, COARSE)):
            near(positions(file, node), sheared(mesh) if node in moving else mesh, 1e-6, f"{only} {node}")
        equal(parts[only], sum(len((CUBE, COARSE, COARSE)[n]) for n in moving), only)


@case
def shapes_of_morphed_and_skinned_bodies(run):
    """The mesh changes in place, with its morph targets."""
    offsets = [[0.5, 0.25, 0.0]] * len(CUBE)
    made = scene([body(0, 1, translation=[1, 0, 0]), {"mesh": 0}], [0], [CUBE])
    made.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": made.add(offsets, bounds=True)}]
    made.asset["meshes"][0]["weights"] = [1]
    done, file = deformed(run, made)
    no_line(done, "copy|scene|collider")
    equal(len(file[0]["meshes"]), 1)
    near(positions(file, 0), sheared(CUBE, 1), 1e-6)
    made = scene([body(0, 1, skin=0), {"mesh": 0, "skin": 0}, {"name": "bone", "translation": [2, 1, 0]}], [0, 2], [CUBE])
    made.asset["skins"] = [{"joints": [2]}]
    made.asset["meshes"][0]["primitives"][0]["attributes"] |= {
        "JOINTS_0": made.add([[0, 0, 0, 0]] * 8, 5121, "VEC4"), "WEIGHTS_0": made.add([[1.0, 0.0, 0.0, 0.0]] * 8, shape="VEC4")}
    done, file = deformed(run, made)
    no_line(done, "copy|scene|collider")
    equal([len(file[0]["meshes"]), file[0]["nodes"][1]], [1, {"mesh": 0, "skin": 0}])
    near(positions(file, 0), sheared(CUBE, 2, 1), 1e-6)


@case
def shapes_follow_their_bodies(run):
    """With --rig follow a body turns and moves; the shape is at its new place, and shows the deformed positions there."""
    bent = lattice(size=(2, 3, 2), low=(-8, -8, -8), high=(8, 8, 8), moves=[
        {"rotate": {"axis": "z", "degrees": 50, "about": [0, 0, 0]}}, {"at": ["all", 2, "all"], "by": [2, 0, 1]}])
    nodes = [{"name": "arm", "translation": [1, 1, 0], "rotation": [0, 0, 0.6, 0.8], "scale": [2, 2, 2], "children": [1]},
             body(0, 3, translation=[0.5, 0.25, 0], name="crate"), {"name": "key", "camera": 0},
             {"mesh": 1, "translation": [7, 7, 7], "rotation": [1, 0, 0, 0]}]
    made = scene(nodes, [0, 2], cameras=[{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])
    times = made.add([[0.0], [1.0]], shape="SCALAR", bounds=True)
    turns = made.add([[0, 0, 0, 1], [0, 0, 0.6, 0.8]], shape="VEC4")
    made.asset["animations"] = [{"samplers": [{"input": times, "output": turns}], "channels": [
        {"sampler": 0, "target": {"node": n, "path": "rotation"}} for n in (0, 1)]}]
    found = {}
    for rig in ("keep", "follow"):
        done, _ = deformed(run, made, "--rig", rig, moves=bent)
        no_line(done, "collider|scene|unselected")
        file = Posed(run.read("b.glb"))
        place = file.worlds()[1]
        found[rig] = [point(place, p) for p in file.read(file.asset["meshes"][1]["primitives"][0]["attributes"]["POSITION"])]
        equal(file.nodes[3], made.asset["nodes"][3], "the shape's own transform")
        found[rig, "place"] = place
    near(found["follow"], found["keep"], 1e-5)
    check(found["follow", "place"] != found["keep", "place"], "the body follows")


main()
