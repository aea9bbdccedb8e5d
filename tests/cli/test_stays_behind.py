#!/usr/bin/env python3
"""What stays behind while a mesh moves is said without -v, a line a kind (joints, pivots and sockets share one), and only
what is in reach of the lattice; and what stands for a node at a distance (MSFT_lod) goes along."""
import json
import re

from gltf_build import SHEAR, Scene
from harness import UNSUPPORTED, case, check, equal, glb_split, gltf_vectors, lattice, main, near, obj_vertices
from messages import anything, entry, lines_with, no_line, one_line

QUAD = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
KINDS = ("socket", "camera", "light", "joint", "pivot", "physics")
SHIFT = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}])


def scene(nodes, **members):
    """A mesh under the first node, and further nodes in the scene."""
    made = Scene(nodes=[{"mesh": 0, "name": "body"}, *nodes], scene=0, **members)
    made.asset["scenes"] = [{"nodes": list(range(len(made.asset["nodes"])))}]
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]}]
    return made


def deformed(run, made, *options, box=None):
    run.write("a.glb", made.glb())
    run.write("l.json", box or SHIFT)
    return run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", *options, err=anything)


def at(name, x, **members):
    return {"name": name, "translation": [x, 0, 0], **members}


def only_kind(done, kind):
    for other in KINDS:
        if other != kind:
            no_line(done, rf"\b{other}s?\b", "stay")


CAMERA = {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}
LIGHTS = {"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}, "extensionsUsed": ["KHR_lights_punctual"]}
PHYSICS = {"extensions": {"KHR_implicit_shapes": {"shapes": [{"type": "sphere", "sphere": {"radius": 1}}]}},
           "extensionsUsed": ["KHR_implicit_shapes", "KHR_physics_rigid_bodies"]}
# How a node is of a kind, and what the asset needs for it.
NODES = {
    "socket": ({}, {}),
    "camera": ({"camera": 0}, {"cameras": [CAMERA]}),
    "light": ({"extensions": {"KHR_lights_punctual": {"light": 0}}}, LIGHTS),
    "physics": ({"extensions": {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"shape": 0}}}}}, PHYSICS),
}


@case
def a_line_a_kind_with_the_count_and_three_names(run):
    """Four in reach, and one that is not."""
    for kind, (members, asset) in NODES.items():
        names = [f"{kind}_{letter}" for letter in "abcd"]
        nodes = [at(name, i, **members) for i, name in enumerate(names)] + [at(f"{kind}_far", 50, **members)]
        done = deformed(run, scene(nodes, **asset))
        line = one_line(done, r"\b4\b", rf"\b{kind}s?\b|\b{kind} shapes?\b")
        equal([name in line for name in names], [True, kind != "socket", kind != "socket", False], line)
        check("far" not in line, line)
        only_kind(done, kind)


@case
def none_where_nothing_is_in_reach(run):
    for kind, (members, asset) in NODES.items():
        done = deformed(run, scene([at(f"{kind}_far", 50, **members)], **asset))
        equal(done.err, [], kind)


@case
def two_kinds_are_two_lines(run):
    done = deformed(run, scene([at("hand", 1), at("eye", 2, camera=0)], cameras=[CAMERA]))
    one_line(done, r"\b1\b", "socket", r"\bhand\b")
    one_line(done, r"\b1\b", "camera", r"\beye\b")
    equal(len(done.err), 2)


@case
def a_node_below_others_is_where_the_scene_has_it(run):
    made = scene([{"name": "arm", "translation": [45, 0, 0], "children": [2]}, at("hand", -44)])
    made.asset["scenes"] = [{"nodes": [0, 1]}]
    one_line(deformed(run, made), r"\b1\b", "socket", r"\bhand\b")
    made = scene([{"name": "arm", "translation": [45, 0, 0], "children": [2]}, at("hand", 1)])
    made.asset["scenes"] = [{"nodes": [0, 1]}]
    equal(deformed(run, made).err, [])


def animated(path, values, shape):
    made = Scene(nodes=[{"mesh": 0, "name": "wheel"}, {"name": "hub", "children": [0]}], scene=0, scenes=[{"nodes": [1]}])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]}]
    times = made.add([[0.0], [1.0]], shape="SCALAR", bounds=True)
    made.asset["animations"] = [{"channels": [{"sampler": 0, "target": {"node": 1, "path": path}}],
                                 "samplers": [{"input": times, "output": made.add(values, shape=shape)}]}]
    return made


@case
def a_pivot_that_is_animated(run):
    done = deformed(run, animated("rotation", [[0, 0, 0, 1], [0, 0, 1, 0]], "VEC4"))
    one_line(done, r"\b1\b", "pivot", r"\bhub\b")
    equal(len(done.err), 1)


@case
def what_is_animated_and_more_is_told_once(run):
    made = animated("rotation", [[0, 0, 0, 1], [0, 0, 1, 0]], "VEC4")
    made.asset |= {"cameras": [CAMERA]}
    made.asset["nodes"][1]["camera"] = 0
    done = deformed(run, made)
    one_line(done, "1 camera stays", "hub")
    equal(len(done.err), 1)


@case
def joints(run):
    made = scene([at("hip", 0, children=[2]), at("knee", 1)])
    made.asset["scenes"] = [{"nodes": [0, 1]}]
    primitive = made.asset["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {"JOINTS_0": made.add([[0, 1, 0, 0]] * 3, component=5121, shape="VEC4"),
                                "WEIGHTS_0": made.add([[1.0, 0.0, 0.0, 0.0]] * 3, shape="VEC4")}
    made.asset["skins"] = [{"joints": [1, 2]}]
    made.asset["nodes"][0]["skin"] = 0
    done = deformed(run, made)
    one_line(done, r"the joints of 1 skin lie up to 1 off", r"\bhip\b")
    only_kind(done, "joint")


def with_skin(run, used, nodes):
    """The body and joints "a" and "b"; a node shows the body with the skin of joint "a", if it is used."""
    made = scene(nodes)
    primitive = made.asset["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {"JOINTS_0": made.add([[0, 0, 0, 0]] * 3, component=5121, shape="VEC4"),
                                "WEIGHTS_0": made.add([[1.0, 0.0, 0.0, 0.0]] * 3, shape="VEC4")}
    made.asset["skins"] = [{"joints": [1]}, {"joints": [2]}]
    if used:
        made.asset["nodes"][0]["skin"] = 0
    return made


@case
def joints_of_skins_that_are_not_used_have_a_subject(run):
    """With and without a skin that is used; they count as joints in the report, and follow."""
    nodes = [at("a", 0), at("b", 1)]
    one_line(deformed(run, with_skin(run, False, nodes)), "2 joints of skins that are not used lie up to 1 off the deformed mesh")
    one_line(deformed(run, with_skin(run, True, nodes)), "the joints of 1 skin and 1 joint of a skin that is not used lie up to 1 off")
    one_line(deformed(run, with_skin(run, False, [at("a", 50), at("b", 1)])),
         "1 joint of a skin that is not used lies up to 1 off the deformed mesh", r"\(b\): see --rig$")
    equal(entry(run, "check", "a.glb", "-l", "l.json")["rig"]["joints"], 2)
    done = deformed(run, with_skin(run, False, nodes), "--rig", "follow")
    no_line(done, "off the deformed mesh")
    asset, _ = glb_split(run.read("b.glb"))
    equal([node["translation"] for node in asset["nodes"][1:]], [[1, 0, 0], [2, 0, 0]])


@case
def joints_lie_off_a_morph_target(run):
    """Of --as-morph, --morph and check; the report has it; a target that moves no joint says nothing."""
    made = with_skin(run, True, [at("a", 0), at("b", 50)])
    words = r"the joints of 1 skin lie up to 1 off the mesh that the morph target shows \(a\); animations will turn it about the old places$"
    run.write("far.json", lattice(low=(0.5, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}]))
    one_line(deformed(run, made, "--as-morph", "wide"), words)
    for command in (("check", "a.glb", "--as-morph", "w"), ("deform", "a.glb", "b.glb", "--as-morph", "w")):
        rig = entry(run, *command, "-l", "l.json")["rig"]
        equal([rig["joints"], rig["moved"], rig["largest_lag"], rig["worst"]], [2, 0, 1, "a"], str(command))
        equal(entry(run, *command, "-l", "far.json")["rig"]["largest_lag"], 0)
    done = run.ffd("deform", "a.glb", "c.glb", "--morph", "far=far.json", "--morph", "wide=l.json", "--report", "m.json", err=anything)
    one_line(done, 'a.glb: morph target "wide": ' + words)
    equal(json.loads(run.text("m.json"))["jobs"][0]["rig"]["largest_lag"], 1)


@case
def a_lattice_that_moves_nothing_says_nothing(run):
    still = lattice(low=(-10, -10, -10), high=(10, 10, 10))
    equal(deformed(run, scene([at("hand", 1), at("eye", 2, camera=0)], cameras=[CAMERA]), box=still).err, [])


@case
def the_report_has_count_and_names(run):
    made = scene([at(f"hand_{i}", i) for i in range(5)] + [at("eye", 2, camera=0)], cameras=[CAMERA])
    run.write("a.glb", made.glb())
    run.write("l.json", SHIFT)
    for command in (["deform", "a.glb", "b.glb"], ["check", "a.glb"]):
        equal(entry(run, *command, "-l", "l.json")["behind"],
              [{"kind": "socket", "count": 5, "names": ["hand_0", "hand_1", "hand_2"]},
               {"kind": "camera", "count": 1, "names": ["eye"]}], command[0])
    run.write("l.json", lattice(low=(-10, -10, -10), high=(10, 10, 10)))
    equal(entry(run, "check", "a.glb", "-l", "l.json")["behind"], [])


@case
def names_are_those_of_the_file_in_one_line(run):
    """None, an empty one, one of control characters, and one that is cut where a character ends."""
    long = "\u00e9" * 200
    eye = {"camera": 0}
    done = deformed(run, scene([{"translation": [1, 0, 0]} | eye, at("", 2, **eye), at("a\nb\x1b[31m\x7f", 3, **eye)], cameras=[CAMERA]))
    equal(done.err, ["a.glb: 3 cameras stay where they are, though the lattice moves the mesh there: node 1, node 2, a?b?[31m?"])
    done = deformed(run, scene([at(long, 1, **eye)], cameras=[CAMERA]))
    equal(done.err, ["a.glb: 1 camera stays where it is, though the lattice moves the mesh there: " + long[:39]])
    for name, shown in (("", "node 1"), ("a\nb", "a?b"), (long, long[:39]), ("\u0085a\u2029b\u2066\u2030", "??a???b???\u2030")):
        equal(deformed(run, scene([at(name, 1)])).err, [f"a.glb: 1 socket lies up to 1 off the deformed mesh ({shown}): see --rig"])


@case
def only_where_control_points_move(run):
    """The far half of the volume stays, and what is in it with it."""
    half = lattice(size=(9, 4, 4), low=(-10, -10, -10), high=(10, 10, 10), moves=[{"at": [[5, 8], "all", "all"], "by": [0, 1, 0]}])
    done = deformed(run, scene([at("near", 9), at("far", -9)]), box=half)
    equal(lines_with(done, "socket"), ["a.glb: 1 socket lies up to 1 off the deformed mesh (near): see --rig"])


@case
def nothing_where_no_vertex_moves(run):
    """The mesh is outside: what is in the volume is left behind by nothing."""
    box = lattice(low=(2, -1, -1), high=(9, 1, 1), moves=[{"by": [1, 0, 0]}])
    equal(lines_with(deformed(run, scene([at("hand", 3)]), box=box), "socket"), [])


@case
def what_extend_moves_is_in_reach(run):
    box = lattice(low=(-2, -2, -2), high=(2, 2, 2), moves=[{"by": [1, 0, 0]}])
    equal(deformed(run, scene([at("hand", 5)]), box=box).err, [])
    one_line(deformed(run, scene([at("hand", 5)]), "--outside", "extend", box=box), "1 socket", "hand")
    equal(deformed(run, scene([at("hand", 5)]), "--outside", "extend", "--falloff", "1", box=box).err, [])


@case
def the_second_lattice_counts_too(run):
    """The first carries the place into the second, which alone moves it on."""
    run.write("first.json", lattice(low=(-10, -10, -10), high=(10, 10, 10)))
    run.write("second.json", SHIFT)
    run.write("a.glb", scene([at("hand", 1)]).glb())
    one_line(run.ffd("deform", "a.glb", "b.glb", "-l", "first.json", "-l", "second.json", err=anything), "1 socket", "hand")


@case
def a_selection_looks_at_what_belongs_to_it(run):
    made = Scene(nodes=[{"name": "body", "mesh": 0, "children": [1]}, {"name": "hand"}, {"name": "car", "children": [3, 4]},
                        {"name": "door", "mesh": 1}, {"name": "seat"}], scene=0, scenes=[{"nodes": [0, 2]}])
    made.asset["meshes"] = [{"name": f"mesh_{i}", "primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]}
                            for i in range(2)]
    for only, name in (("node:body", "hand"), ("mesh:mesh_0", "hand"), ("node:car", "seat")):
        equal(deformed(run, made, "--only", only).err,
              [f"a.glb: 1 socket lies up to 1 off the deformed mesh ({name}): see --rig"], only)
    equal(deformed(run, made, "--only", "mesh:mesh_1").err, [])
    one_line(deformed(run, made), "2 sockets", "hand")


@case
def the_joints_of_what_is_selected(run):
    made = scene([at("hip", 0, children=[3]), at("other", 1), at("hand", 1), {"mesh": 1, "name": "rock"}])
    made.asset["scenes"] = [{"nodes": [0, 1, 2, 4]}]
    primitive = made.asset["meshes"][0]["primitives"][0]
    made.asset["meshes"].append({"primitives": [{"attributes": dict(primitive["attributes"])}]})
    primitive["attributes"] |= {"JOINTS_0": made.add([[0, 0, 0, 0]] * 3, component=5121, shape="VEC4"),
                                "WEIGHTS_0": made.add([[1.0, 0.0, 0.0, 0.0]] * 3, shape="VEC4")}
    made.asset["skins"] = [{"joints": [1]}]
    made.asset["nodes"][0]["skin"] = 0
    done = deformed(run, made, "--only", "node:body")
    one_line(done, "the joints of 1 skin and 1 socket lie", "hip")
    equal(entry(run, "deform", "a.glb", "b.glb", "-l", "l.json", "--only", "node:body")["behind"],
          [{"kind": "socket", "count": 1, "names": ["hand"]}, {"kind": "joint", "count": 1, "names": ["hip"]}])
    equal(lines_with(deformed(run, made, "--only", "node:rock"), "stays? where|deformed mesh"), [])


@case
def neither_as_a_morph_target_nor_in_mesh_space_nor_converted(run):
    made = scene([at("hand", 1)])
    equal(deformed(run, made, "--as-morph", "wide").err, [])
    equal(deformed(run, made, "--space", "mesh").err, [])
    equal(lines_with(run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything), "stays? where|deformed mesh"), [])


@case
def more_kinds_of_physics_and_pivots(run):
    """Shapes that are made of a mesh go with it."""
    shapes = {"KHR_implicit_shapes": {"shapes": [{}]}, "OMI_physics_shape": {"shapes": [{}]}}
    for extensions, expected in (({"KHR_physics_rigid_bodies": {"trigger": {"geometry": {"shape": 0}}}}, 1),
                                 ({"KHR_physics_rigid_bodies": {"collider": {"geometry": {"node": 0}}}}, 0),
                                 ({"OMI_physics_body": {"collider": {"shape": 0}}}, 1), ({"OMI_collider": {}}, 1)):
        made = scene([at("shell", 1, extensions=extensions)], extensions=shapes)
        equal(len(lines_with(deformed(run, made), "1 physics shape stays", "shell")), expected, str(extensions))
    # A shape that is a mesh shown just there changes with it; one of a mesh that is shown elsewhere, or nowhere, stays.
    for list_name, node, shape in (
            ("OMI_physics_shape", {"OMI_physics_body": {"collider": {"shape": 0}}}, {"type": "trimesh", "trimesh": {"mesh": 0}}),
            ("OMI_physics_shape", {"OMI_physics_body": {"trigger": {"shape": 0}}}, {"type": "convex", "convex": {"mesh": 0}}),
            ("OMI_collider", {"OMI_collider": {"collider": 0}}, {"type": "mesh", "mesh": 0})):
        root = {list_name: {"colliders" if list_name == "OMI_collider" else "shapes": [shape]}}
        for place, mesh, expected in (("own", 0, 0), ("same", 0, 0), ("other", 0, 1), ("own", 1, 1)):
            made = scene([at("same", 0), at("other", 1)], extensions=json.loads(json.dumps(root).replace('"mesh": 0', f'"mesh": {mesh}')))
            made.asset["meshes"] += made.asset["meshes"]
            made.asset["nodes"][("own", "same", "other").index(place)]["extensions"] = node
            equal(len(lines_with(deformed(run, made), "1 physics shape stays")), expected, f"{node} {place} {mesh}")
    for root in ({"VRMC_springBone": {"colliders": [{"node": 1}]}}, {"VRM": {"secondaryAnimation": {"colliderGroups": [{"node": 1}]}}}):
        one_line(deformed(run, scene([at("shell", 1)], extensions=root)), "1 physics shape stays", "shell")
    for path, expected in (("/nodes/1/rotation", 1), ("/nodes/1/weights", 0), ("/nodes/7/rotation", 0), ("/nodes//scale", 0), ("/nodes/-1/scale", 0), ("/meshes/1/scale", 0)):
        made = animated("rotation", [[0, 0, 0, 1], [0, 0, 1, 0]], "VEC4")
        made.asset["animations"][0]["channels"][0]["target"] = {
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": path}}}
        made.asset["extensionsUsed"] = ["KHR_animation_pointer"]
        equal(len(lines_with(deformed(run, made), "1 animated pivot lies", "hub")), expected, path)
    equal(deformed(run, animated("weights", [[0.0], [1.0]], "SCALAR")).err, [])


def splats(points):
    """Their rotations and scales are whole numbers, which cannot follow."""
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    rows = [" ".join(map(str, [*p, 0.1, 0.1, 0.1, 1, -1, -4, -4, 1, 0, 0, 0])) for p in points]
    return ("ply\nformat ascii 1.0\nelement vertex %d\n" % len(points) + "".join(f"property {'short' if name[0] in 'rs' else 'float'} {name}\n" for name in names)
            + "end_header\n" + "\n".join(rows) + "\n")


@case
def splats_in_reach(run):
    run.write("l.json", lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"rotate": {"axis": "z", "degrees": 90}}]))
    run.write("a.ply", splats([[1, 0, 0], [2, 0, 0], [99, 0, 0]]))
    done = run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", err=anything)
    one_line(done, r"\b2\b", "splat", "rotation", "scale")
    run.write("a.ply", splats([[99, 0, 0]]))
    equal(lines_with(run.ffd("deform", "a.ply", "b.ply", "-l", "l.json", "--force", err=anything), "splat"), [])


@case
def splats_that_are_only_translated(run):
    """Their rotations and scales are right as they are; not so where the translation fades."""
    run.write("a.ply", splats([[0.3, 0, 0], [12, 0, 0]]))
    box = {"low": (-10, -10, -10), "high": (10, 10, 10)}
    run.write("l.json", lattice(**box, moves=[{"by": [1, 0.1, 0]}]))
    run.write("k.json", lattice(**box, moves=[{"by": [1, 0, 0]}, {"at": [0, 0, 0], "by": [0, 0, 1e-3]}]))
    for lattices, options, said in ((["l.json"], [], 0), (["l.json", "l.json"], [], 0), (["l.json"], ["--outside", "extend"], 0),
                                    (["l.json"], ["--outside", "extend", "--falloff", "9"], 1), (["l.json", "k.json"], [], 1)):
        done = run.ffd("deform", "a.ply", "b.ply", *(f"-l{name}" for name in lattices), *options, "--force", err=anything)
        equal(len(lines_with(done, "splat", "rotation")), said, f"{lattices} {options}")
        check(run.read("a.ply") != run.read("b.ply"), "something moves")


@case
def splats_of_gltf(run):
    """Two of the three in each of two nodes; the third node is far away. Rotations of three numbers cannot follow."""
    made = Scene(nodes=[{"mesh": 0, "name": "rose"}, {"mesh": 0, "name": "thorn"}, {"mesh": 0, "name": "far", "translation": [90, 0, 0]}],
                 scene=0, scenes=[{"nodes": [0, 1, 2]}], extensionsUsed=["KHR_gaussian_splatting"],
                 extensionsRequired=["KHR_gaussian_splatting"])
    attributes = {"POSITION": made.add([[1, 0, 0], [2, 0, 0], [50, 0, 0]], bounds=True),
                  "KHR_gaussian_splatting:ROTATION": made.add([[0, 0, 0]] * 3),
                  "KHR_gaussian_splatting:SCALE": made.add([[-1, -4, -4]] * 3)}
    made.asset["meshes"] = [{"primitives": [{"attributes": attributes, "mode": 0,
                                             "extensions": {"KHR_gaussian_splatting": {"kernel": "ellipse"}}}]}]
    turn = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"rotate": {"axis": "z", "degrees": 5}}])
    done = deformed(run, made, box=turn)
    equal(one_line(done, "splat"), "a.glb: 4 Gaussian splats move, but their rotations and scales stay: rose, thorn")
    equal(entry(run, "check", "a.glb", "-l", "l.json")["behind"], [{"kind": "splat", "count": 4, "names": ["rose", "thorn"]}])
    del made.asset["meshes"][0]["primitives"][0]["extensions"]
    made.asset |= {"extensionsUsed": [], "extensionsRequired": []}
    equal(lines_with(deformed(run, made, box=turn), "splat"), [])
    made.asset |= {"extensionsUsed": ["X_y"], "extensionsRequired": ["X_y"]}
    run.write("a.glb", made.glb())
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", code=UNSUPPORTED)


def levels(nodes, roots=(0,), meshes=3, **members):
    """Nodes with levels of detail, a mesh for each, all with the same vertices."""
    made = Scene(nodes=nodes, extensionsUsed=["MSFT_lod"], **members)
    if roots is not None:
        made.asset |= {"scene": 0, "scenes": [{"nodes": list(roots)}]}
    made.asset["meshes"] = [{"name": f"mesh_{i}", "primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]}
                            for i in range(meshes)]
    return made


def lod(mesh, *ids, **members):
    return {"mesh": mesh, "name": f"tree_{mesh}", "extensions": {"MSFT_lod": {"ids": list(ids)}}, **members}


def moved_meshes(run):
    """Which meshes have moved."""
    asset, data = glb_split(run.read("b.glb"))
    return [list(map(list, gltf_vectors(asset, data, mesh["primitives"][0]["attributes"]["POSITION"]))) != QUAD
            for mesh in asset["meshes"]]


@case
def what_is_below_a_coarse_node_and_its_own_coarser_ones(run):
    """Also where the file has no scene, and where the coarse node is listed first."""
    nodes = [lod(0, 1), {"name": "group", "children": [2], "extensions": {"MSFT_lod": {"ids": [3]}}}, {"mesh": 1}, {"mesh": 2}]
    for roots in ((0,), None):
        equal(deformed(run, levels(nodes, roots)).err, [])
        equal(moved_meshes(run), [True, True, True], str(roots))
    equal(deformed(run, levels([{"mesh": 1}, lod(0, 0)], (1,), meshes=2)).err, [])
    equal(moved_meshes(run), [True, True])


@case
def coarse_nodes_below_a_group_that_is_not_shown(run):
    """The group's own transform does not count: a coarse node stands where the node is that it stands for."""
    nodes = [lod(0, 2), {"name": "store", "translation": [50, 0, 0], "children": [2, 3]}, {"mesh": 1}, {"mesh": 2}]
    done = deformed(run, levels(nodes))
    equal(done.err, ["a.glb: 1 node with a mesh is not in the displayed scene: left as it is"])
    equal(moved_meshes(run), [True, True, False])
    # And the group stands in for what is below it: it is shown at 50 then, with the other mesh.
    nodes[2]["extensions"] = {"MSFT_lod": {"ids": [1]}}
    one_line(deformed(run, levels(nodes)), "3 of 9 vertices are not inside")
    equal(moved_meshes(run), [True, True, False])


def ignored(*places):
    if len(places) == 1:
        return f"a.glb: 1 value is not what glTF allows there, and is ignored: {places[0]}"
    return f"a.glb: {len(places)} values are not what glTF allows there, and are ignored: " + ", ".join(places)


@case
def references_to_nothing_are_said(run):
    """Of another type, below 0, a fraction, beyond the end: said, and nothing is taken to be there."""
    physics = lambda value: {"KHR_physics_rigid_bodies": {"trigger": {"geometry": {"shape": value}}}}
    kinds = {"/camera": (lambda value: {"camera": value}, {"cameras": [CAMERA]}),
             "/extensions/KHR_lights_punctual/light": (lambda value: {"extensions": {"KHR_lights_punctual": {"light": value}}}, LIGHTS),
             "/extensions/KHR_physics_rigid_bodies/trigger/geometry/shape": (lambda value: {"extensions": physics(value)}, PHYSICS)}
    for where, (member, asset) in kinds.items():
        for value in ("x", -1, 0.5, 1, None, [0], {}, 1e300):
            nodes = [at("group", 1, children=[2], **member(value)), {"mesh": 0}]
            made = scene(nodes, **asset)
            made.asset["scenes"] = [{"nodes": [0, 1]}]
            equal(deformed(run, made).err, [ignored("/nodes/1" + where)], f"{where} {value}")
            made.asset["nodes"][1] |= member(0)
            equal(len(deformed(run, made).err), 1, where)
        # A file without the list.
        made.asset = {key: value for key, value in made.asset.items() if key not in asset}
        equal(deformed(run, made).err, [ignored("/nodes/1" + where)], where)


@case
def visibility_that_is_neither(run):
    for member, where in (({"visible": "no"}, "/visible"), ({"visible": 0}, "/visible"), (False, "")):
        made = scene([])
        made.asset["nodes"][0]["extensions"] = {"KHR_node_visibility": member}
        done = deformed(run, made)
        equal(done.err, [ignored("/nodes/0/extensions/KHR_node_visibility" + where)])
        equal(moved_meshes(run), [True])
        for command in (["check", "a.glb"], ["embed", "a.glb", "-o", "e.npy", "--force"]):
            run.ffd(*command, "-l", "l.json", err=done.err)


@case
def targets_of_animations_that_are_not_there(run):
    for target, where in (({"node": 9, "path": "rotation"}, "/node"), ({"node": "hub", "path": "scale"}, "/node"),
                          ({"node": 1, "path": 7}, "/path"), ({"node": 1}, ""),
                          ({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/7/rotation"}}},
                           "/extensions/KHR_animation_pointer/pointer")):
        made = animated("rotation", [[0, 0, 0, 1], [0, 0, 1, 0]], "VEC4")
        made.asset["animations"][0]["channels"][0]["target"] = target
        equal(deformed(run, made).err, [ignored("/animations/0/channels/0/target" + where)], str(target))


@case
def many_values_that_are_ignored_are_one_line(run):
    made = scene([{"mesh": 0, "camera": i} for i in range(5)])
    equal(deformed(run, made).err, ["a.glb: 5 values are not what glTF allows there, and are ignored: /nodes/1/camera, "
                                    "/nodes/2/camera, /nodes/3/camera and 2 more"])


@case
def lists_that_make_no_sense(run):
    """Numbers of no node, of the node itself, of each other, of a node that is shown, and no list at all."""
    place = "/nodes/0/extensions/MSFT_lod"
    for ids in ([9], [-1], ["a"], [0.5], [None], [1e300]):
        equal(deformed(run, levels([lod(0, *ids)], meshes=1)).err, [ignored(f"{place}/ids/0")], str(ids))
    for member, where in (({"ids": 0}, "/ids"), ({"ids": {"a": 0}}, "/ids"), ({}, ""), ([0], "")):
        node = {"mesh": 0, "extensions": {"MSFT_lod": member}}
        equal(deformed(run, levels([node], meshes=1)).err, [ignored(place + where)], str(member))
    equal(deformed(run, levels([lod(0, 0)], meshes=1)).err, [])
    equal(deformed(run, levels([lod(0, 1), lod(1, 0)], (0, 1), meshes=2)).err, [])
    equal(deformed(run, levels([lod(0, 1), lod(1, 0)], meshes=2)).err, [])
    equal(moved_meshes(run), [True, True])


@case
def a_selected_node_takes_its_coarser_ones_along(run):
    """And the list of what can be selected counts them."""
    nodes = [lod(0, 1, name="oak"), {"mesh": 1, "name": "oak_far"}, {"mesh": 2, "name": "elm"}]
    run.write("a.glb", levels(nodes, (0, 2)).glb())
    parts = {part["selector"]: part["vertices"] for part in run.ffd("info", "a.glb", "--parts", "--json").json["named_parts"]}
    for only, expected in (("node:oak", [True, True, False]), ("mesh:mesh_0", [True, True, False]),
                           ("node:elm", [False, False, True]), ("node:oak_far", [False, True, False])):
        equal(deformed(run, levels(nodes, (0, 2)), "--only", only).err, [], only)
        equal(moved_meshes(run), expected, only)
        equal(parts[only], 3 * sum(expected), only)


@case
def a_coarse_node_of_two_parents_is_deformed_for_the_first(run):
    made = levels([{"name": "a", "children": [2]}, {"name": "b", "translation": [0, 2, 0], "children": [3]}, lod(0, 4), lod(0, 4),
                   {"mesh": 1}], (0, 1), meshes=2)
    one_line(deformed(run, made), "1 use of a node by MSFT_lod is at another place than the first")
    del made.asset["nodes"][1]["translation"]  # below another parent, but at the same place
    no_line(deformed(run, made), "MSFT_lod")
    made.asset["nodes"][0]["children"] = [2, 3]
    made.asset["nodes"][1] = {"name": "b", "mesh": 1}
    no_line(deformed(run, made), "MSFT_lod")


@case
def a_conversion_shows_the_finest_level(run):
    run.write("a.glb", levels([lod(0, 1), {"mesh": 1, "translation": [5, 0, 0]}], meshes=2).glb())
    run.write("l.json", SHIFT)
    one_line(run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything), "hidden|not shown|displayed")
    equal(obj_vertices(run.text("b.obj")), [[x + 1, y, z] for x, y, z in QUAD])
    contents = run.ffd("info", "a.glb", "--json").json["contents"]
    equal([contents["nodes_with_mesh_not_shown"], contents["nodes_with_mesh_of_coarser_detail"]], [0, 1])


@case
def a_file_that_requires_levels_of_detail(run):
    made = levels([lod(0, 1), {"mesh": 1}], meshes=2, extensionsRequired=["MSFT_lod"])
    equal(deformed(run, made).err, [])
    equal(moved_meshes(run), [True, True])


@case
def coarse_nodes_are_deformed_as_under_the_parent(run):
    """x' = x + 0.05 x y. The fine node stands at 1 below a parent at 2; the coarse ones, in no scene, have transforms of
    their own, and stand below the same parent when they are shown."""
    made = Scene(nodes=[{"name": "park", "translation": [2, 1, 0], "children": [1]},
                        {"name": "tree", "mesh": 0, "translation": [1, 0, 0], "extensions": {"MSFT_lod": {"ids": [2, 3]}}},
                        {"name": "tree_1", "mesh": 1, "translation": [1, 2, 0]}, {"name": "tree_2", "mesh": 2}],
                 scene=0, scenes=[{"nodes": [0]}], extensionsUsed=["MSFT_lod"])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]} for _ in range(3)]
    for without in ((), ("scene", "scenes")):
        for key in without:
            del made.asset[key]
        done = deformed(run, made, box=SHEAR)
        no_line(done, "left as it is|not in the (displayed )?scene")
        asset, data = glb_split(run.read("b.glb"))
        for mesh, (tx, ty) in enumerate(((3, 1), (3, 3), (2, 1))):
            found = gltf_vectors(asset, data, asset["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"])
            near(found, [[x + 0.05 * (x + tx) * (y + ty), y, z] for x, y, z in QUAD], 1e-6, f"mesh {mesh} without {without}")


@case
def a_coarse_node_outside_fails_the_gate(run):
    made = Scene(nodes=[{"name": "tree", "mesh": 0, "extensions": {"MSFT_lod": {"ids": [1]}}},
                        {"name": "tree_1", "mesh": 1, "translation": [50, 0, 0]}],
                 scene=0, scenes=[{"nodes": [0]}], extensionsUsed=["MSFT_lod"])
    made.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": made.add(QUAD, bounds=True)}}]} for _ in range(2)]
    run.write("a.glb", made.glb())
    run.write("l.json", SHIFT)
    run.ffd("check", "a.glb", "-l", "l.json", "--fail-on", "outside", code=1, err=re.compile("outside"))


main()
