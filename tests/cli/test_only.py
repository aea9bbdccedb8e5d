#!/usr/bin/env python3
"""--only: what a selector names is deformed and counted, all else keeps every byte."""
import json
import os
import re
import struct
import subprocess

from harness import (MODELS, NO, SANITIZED, UNSUPPORTED, USAGE, case, check, equal, glb, glb_split, gltf_json, gltf_vectors, lattice,
                     main, near, obj_vertices)

SHIFT = [{"by": [0.5, -0.25, 1]}]
TWIST = [{"twist": {"axis": "z", "degrees": 40}}, {"at": [3, 3, 3], "by": [0.5, 0.25, 1]}]

# Two quads and a triangle that share vertices; a line, a point, a vertex that nothing uses.
SHEET = """mtllib none.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 0
v 2 1 0
v -1 -1 0
v -1 1 0.5
v 1.5 1.5 1.5
v 0.25 -1.5 1
f 1 4 8
g left both
o First Thing
usemtl red
f 1 2 3 4
g right both
usemtl dark blue # 2
f 2 5 6 3
g
l 1 7
o Last
p 9
"""
VERTICES = obj_vertices(SHEET)


def moved(text):
    """The numbers of the vertices (from 1) that SHIFT has brought to where it should."""
    found = []
    for i, (p, q) in enumerate(zip(VERTICES, obj_vertices(text))):
        if p != q:
            near(q, [a + b for a, b in zip(p, SHIFT[0]["by"])], 1e-15)
            found.append(i + 1)
    return found


def only(*selectors):
    return [word for selector in selectors for word in ("--only", selector)]


def deform(run, file, *selectors, out=None, options=()):
    name = out or "out." + file.split(".")[-1]
    run.ffd("deform", file, name, "-l", "l.json", "--force", "-q", *only(*selectors), *options)
    return run.read(name)


@case
def groups_objects_and_materials_of_obj(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.obj", SHEET)
    for selectors, expected in [(["group:left"], [1, 2, 3, 4]),
                                (["group:right"], [2, 3, 5, 6]),
                                (["group:both"], [1, 2, 3, 4, 5, 6]),
                                (["group:default"], [1, 4, 7, 8, 9]),
                                (["object:First Thing"], [1, 2, 3, 4, 5, 6, 7]),
                                (["object:Last"], [9]),
                                (["material:red"], [1, 2, 3, 4]),
                                (["material:dark blue # 2"], [1, 2, 3, 5, 6, 7, 9]),
                                (["material:red", "object:Last"], [1, 2, 3, 4, 9])]:
        text = deform(run, "a.obj", *selectors).decode()
        equal(moved(text), expected, selectors)
        for before, after in zip(SHEET.splitlines(), text.splitlines()):
            check(before == after or before.startswith("v "), before, after)


@case
def control_vertices_of_free_form_geometry_are_selected(run):
    """With their group, object and material, as those of faces are; numbers that count back do so from their place."""
    run.write("l.json", lattice(moves=SHIFT))
    vertices = [line for line in SHEET.splitlines() if line.startswith("v ")]
    run.write("a.obj", "\n".join(vertices) + "\ng left\no Thing\nusemtl red\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2/1 3//1 -7/2/2\nend\n"
              "g right\no Other\nusemtl blue\ncurv 0 1 5 \\\n 6\nf 5 6 7\n")
    for selectors, expected in ((["group:left"], [1, 2, 3, 4]), (["object:Thing"], [1, 2, 3, 4]), (["material:red"], [1, 2, 3, 4]),
                                (["group:right"], [5, 6, 7]), (["group:left", "material:blue"], [1, 2, 3, 4, 5, 6, 7])):
        equal(moved(deform(run, "a.obj", *selectors).decode()), expected, selectors)
    listed = run.ffd("info", "a.obj", "--parts", err=lambda said: None).text
    check(re.search("group:left +4 vertices, 0 faces", listed) and re.search("group:right +3 vertices, 1 face,", listed), listed)


@case
def names_are_read_in_every_dialect_of_obj(run):
    """Names go on behind a continuation, end with CR, and come before or after what they name."""
    run.write("l.json", lattice(moves=SHIFT))
    text = SHEET.replace("g left both", "g left \\\n  both").replace("\n", "\r")
    run.write("a.obj", text)
    near(obj_vertices(deform(run, "a.obj", "group:both").decode().replace("\r", "\n")),
         obj_vertices(deform(run, "a.obj", "group:left", "group:right").decode().replace("\r", "\n")), 0)


@case
def a_normal_is_split_where_the_selection_ends(run):
    run.write("l.json", lattice(moves=TWIST))
    faces = "vn 0 0 1\nvn 1 0 0\n%sg a\nf 1//1 2//1 3//1 4//1\ng b\nf 2//1 5//1 6//1 3//1\nf 1//2 4//2 8//2\n"
    vertices = "".join(line + "\n" for line in SHEET.splitlines() if line.startswith("v "))
    run.write("a.obj", vertices + faces % "")
    before = (vertices + faces % "").splitlines()
    after = deform(run, "a.obj", "group:a").decode().splitlines()
    check("vn 0 0 1" in after and "vn 1 0 0" in after, "normals of b stay")
    added = after[after.index("vn 1 0 0") + 1:after.index("g a")]
    equal(len(added), 4, "each corner of a has a normal of its own")
    equal(after[after.index("g a") + 1], "f 1//3 2//4 3//5 4//6", "the corners of a")
    equal(after[after.index("g b"):], before[before.index("g b"):], "the faces of b")
    # The same values as without a selection.
    run.ffd("deform", "a.obj", "all.obj", "-l", "l.json", "-q")
    everywhere = run.text("all.obj").splitlines()
    check(all(line in everywhere for line in added), "the values", added)


def two_triangles():
    """One POSITION accessor, three meshes: A draws its first triangle in red and its second in blue, B the
    first in blue, C all of it by an accessor of its own for normals. Nodes: 0 root (1, 2), 1 A, 2 B (3), 3 C,
    4 A."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5], [0, -1, 0.25], [-1, 0.5, 1]]
    normals = [[0, 0, 1]] * 6
    asset, data = gltf_json(points, normals=normals)
    start = len(data)
    data += struct.pack("<6H", 0, 1, 2, 3, 4, 1)
    asset["bufferViews"] += [{"buffer": 0, "byteOffset": start, "byteLength": 12}]
    asset["accessors"] += [{"bufferView": 2, "byteOffset": offset, "componentType": 5123, "count": 3, "type": "SCALAR"}
                           for offset in (0, 6)]
    asset["buffers"][0]["byteLength"] = len(data)
    both = {"POSITION": 0, "NORMAL": 1}
    first = {"attributes": both, "indices": 2, "material": 0}
    asset["meshes"] = [
        {"name": "A", "primitives": [first, {"attributes": both, "indices": 3, "material": 1}]},
        {"name": "B", "primitives": [{"attributes": both, "indices": 2, "material": 1}]},
        {"name": "C\u00e9\"", "primitives": [{"attributes": {"POSITION": 0}, "indices": 2}]}]
    asset["materials"] = [{"name": "red"}, {"name": "blue"}, {"name": "blue"}]
    asset["nodes"] = [{"name": "root", "children": [1, 2]}, {"name": "one", "mesh": 0},
                      {"name": "two", "mesh": 1, "children": [3]}, {"name": "three", "mesh": 2},
                      {"name": "one", "mesh": 0, "translation": [0, 0, 0.25]}]
    asset["scenes"] = [{"nodes": [0, 4]}]
    return points, asset, data


# The triangles of the scene by node, mesh's primitive, and what they draw.
TRIANGLES = [(1, 0, [0, 1, 2]), (1, 1, [3, 4, 1]), (2, 0, [0, 1, 2]), (3, 0, [0, 1, 2]), (4, 0, [0, 1, 2]),
             (4, 1, [3, 4, 1])]


def shown(file):
    """The corners of each of TRIANGLES, in the mesh's space."""
    asset, data = glb_split(file)
    found = []
    for node, p, corners in TRIANGLES:
        primitive = asset["meshes"][asset["nodes"][node]["mesh"]]["primitives"][p]
        points = gltf_vectors(asset, data, primitive["attributes"]["POSITION"])
        found.append([points[c] for c in corners])
    return found


def write_triangles(run, *options):
    """The asset, what it shows, and what it shows when all of it is deformed."""
    _, asset, data = two_triangles()
    run.write("l.json", lattice(moves=TWIST))
    run.write("a.glb", glb(asset, data))
    return asset, shown(run.read("a.glb")), shown(deform(run, "a.glb", options=options))


@case
def nodes_meshes_and_materials_of_gltf(run):
    asset, before, every = write_triangles(run)
    check(all(a != b for a, b in zip(before, every)), "all move")
    for selectors, expected in [(["node:root"], [0, 1, 2, 3]), (["node:two"], [2, 3]), (["node:three"], [3]),
                                (["node:one"], [0, 1, 4, 5]), (["mesh:A"], [0, 1, 4, 5]), (["mesh:B"], [2]),
                                (["mesh:C\u00e9\""], [3]), (["material:red"], [0, 4]), (["material:blue"], [1, 2, 5]),
                                (["material:red", "node:three"], [0, 3, 4])]:
        file = deform(run, "a.glb", *selectors)
        near(shown(file), [every[i] if i in expected else before[i] for i in range(6)], 0, selectors)
        after, _ = glb_split(file)
        equal(after["nodes"][0], asset["nodes"][0], "a node without a mesh")
        run.ffd("compare", "a.glb", "out.glb", code=1)


@case
def what_is_not_selected_keeps_its_bytes(run):
    """One mesh of two, with accessors of their own: nothing of the other changes, nor is anything added."""
    points, asset, data = two_triangles()
    extra = b"".join(struct.pack("<3f", *p) for p in points)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(extra)})
    asset["accessors"].append({**asset["accessors"][0], "bufferView": 3})
    asset["meshes"][1]["primitives"][0]["attributes"] = {"POSITION": 4}
    data += extra
    asset["buffers"][0]["byteLength"] = len(data)
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=TWIST))
    after, changed = glb_split(deform(run, "a.glb", "mesh:B"))
    for name in ("min", "max"):
        after["accessors"][4][name] = asset["accessors"][4][name]
    equal(after, asset, "the JSON")
    equal(changed[:len(data) - len(extra)], data[:-len(extra)], "the other bytes")
    check(changed[len(data) - len(extra):len(data)] != extra, "the mesh's own")


@case
def mesh_space_takes_nodes_for_their_meshes(run):
    _, before, every = write_triangles(run, "--space", "mesh")
    after = shown(deform(run, "a.glb", "node:two", options=["--space", "mesh"]))
    near(after, [every[i] if i in (2, 3) else before[i] for i in range(6)], 0)


@case
def counts_bounds_and_gates_are_of_the_selection(run):
    run.write("l.json", lattice(moves=SHIFT, low=[-0.5, -2, -2], high=[2, 2, 2]))
    run.write("a.obj", SHEET)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "-q", *only("group:left"), "--report", "r.json",
            "--fail-on", "outside", "--outside", "error")
    job = json.loads(run.text("r.json"))["jobs"][0]
    equal([job[key] for key in ("vertices", "inside", "outside", "moved", "flipped_faces")], [4, 4, 0, 4, 0])
    for when, bounds in (("before", [[0, 0, 0], [1, 1, 0]]), ("after", [[0.5, -0.25, 1], [1.5, 0.75, 1]])):
        near([job["bounds"][when]["min"], job["bounds"][when]["max"]], bounds, 1e-15, when)
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "-q", "--fail-on", "outside", code=1, lines=1)
    check(not run.exists("c.obj"), "refused")
    done = run.ffd("check", "a.obj", "-l", "l.json", *only("group:left"))
    check("  vertices       4: 4 inside" in done.text, done.text)
    check("  flipped faces  0 of 1\n" in done.text and "  edges          4," in done.text, done.text)


@case
def invalid_vertices_outside_the_selection_do_not_matter(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.obj", SHEET.replace("v 0.25 -1.5 1", "v nan 0 0") + "g lone\np 10\n")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--fail-on", "invalid", code=NO, lines=1)
    after = deform(run, "a.obj", "group:left").decode().replace("v nan 0 0", "v 0.25 -1.5 1").replace("g lone\np 10\n", "")
    equal(moved(after), [1, 2, 3, 4])


@case
def the_box_of_a_lattice_is_that_of_the_selection(run):
    """With margin 0 the box is that of the left face in x and y, and the far corner moves by all of the move."""
    run.write("a.obj", SHEET)
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "degree": [1, 1, 1],
                         "rest": {"box": "mesh", "margin": 0}, "moves": [{"at": [-1, -1, "all"], "by": [1, 2, 0]}]})
    after = obj_vertices(deform(run, "a.obj", "group:left").decode())
    near(after[:4], [[0, 0, 0], [1, 0, 0], [2, 3, 0], [0, 1, 0]], 1e-15)
    near(after[4:], VERTICES[4:], 0)


@case
def an_embedding_serves_any_selection(run):
    run.write("l.json", lattice(moves=TWIST))
    run.write("a.obj", SHEET)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    expected = deform(run, "a.obj", "group:right")
    equal(deform(run, "a.obj", "group:right", options=["--embedding", "e.npy"]), expected, "by the embedding")
    check(expected != deform(run, "a.obj"), "less than all")


@case
def what_cannot_be_selected(run):
    _, asset, data = two_triangles()
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.glb", glb(asset, data))
    run.write("a.obj", SHEET)
    run.write("bare.obj", "v 0 0 0\n")
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                       "property float z\nend_header\n0 0 0\n")
    for file, selector, text in [
            ("a.obj", "left", '--only: "left" is not KIND:NAME (node, mesh, material, group or object)'),
            ("a.obj", "grup:left", '--only: unknown kind "grup" (nearest: group)'),
            ("a.obj", "group:", '--only: "group:" has no name after the colon'),
            ("a.obj", ":left", '--only: unknown kind "", not node, mesh, material, group or object'),
            ("a.obj", "group:lefd", 'a.obj: --only: no group is called "lefd" (nearest: "left")'),
            ("a.obj", "material:dark", 'a.obj: --only: no material is called "dark" (nearest: "red")'),
            ("a.obj", "object:first thing", 'a.obj: --only: no object is called "first thing" (nearest: "First Thing")'),
            ("a.obj", "mesh:left", "a.obj: --only mesh: a file of format OBJ has only material, group and object"),
            ("bare.obj", "group:left", 'bare.obj: --only: no group has a name here, so none is called "left"'),
            ("bare.obj", "group:default", 'bare.obj: --only: no group has a name here, so none is called "default"'),
            ("a.glb", "node:too", 'a.glb: --only: no node is called "too" (nearest: "two")'),
            ("a.glb", "mesh:Ce", 'a.glb: --only: no mesh is called "Ce" (nearest: "A")'),
            ("a.glb", "material:Red", 'a.glb: --only: no material is called "Red" (nearest: "red")'),
            ("a.glb", "group:root", "a.glb: --only group: a file of format glTF has only node, mesh and material"),
            ("a.ply", "group:x", "a.ply: --only group: a file of format PLY is one part without names")]:
        for command in (["deform", file, "out." + file[-3:]], ["check", file]):
            run.ffd(*command, "-l", "l.json", "--only", selector, code=USAGE, err=text)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--only", "group:left", code=USAGE)


@case
def a_selection_without_vertices(run):
    """A name that is there, but draws nothing: nothing moves, and it is said."""
    points, asset, data = two_triangles()
    asset["nodes"].append({"name": "camera"})
    asset["scenes"][0]["nodes"].append(5)
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=SHIFT))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--only", "node:camera",
            err="a.glb: --only selects no vertices")
    equal(run.read("b.glb"), run.read("a.glb"))


def named_models():
    """Small GLB models whose meshes all have names, and these."""
    for folder, _, names in sorted(os.walk(MODELS)):
        for name in sorted(names):
            path = os.path.join(folder, name)
            if not name.endswith(".glb") or os.path.getsize(path) > 400000:
                continue
            with open(path, "rb") as file:
                asset = glb_split(file.read())[0]
            meshes = [mesh.get("name") for mesh in asset.get("meshes", [])]
            if meshes and all(meshes):
                yield path, sorted(set(meshes))


@case
def all_of_a_model_by_its_names(run):
    """Every mesh selected gives what no selection gives, but for vertices that nothing draws; the first mesh
    alone leaves a file that differs from the input and from the whole, and reads as one."""
    if not MODELS:
        return
    equals = parts = 0
    for path, meshes in list(named_models())[::4 if SANITIZED else 1]:
        run.write("l.json", lattice(moves=TWIST, rest={"box": "mesh"}))

        options = ["-l", "l.json", "--force", "-q"]
        if run.ffd("deform", path, "all.glb", *options, "--report", "r.json", code=(0, UNSUPPORTED), stderr=subprocess.DEVNULL).code:
            continue
        every = only(*["mesh:" + name for name in meshes])
        run.ffd("deform", path, "each.glb", *options, *every, "--report", "s.json")
        counts = [json.loads(run.text(name))["jobs"][0]["vertices"] for name in ("r.json", "s.json")]
        check(counts[1] <= counts[0], path, counts)
        if counts[0] == counts[1]:
            equals += 1
            equal(run.read("each.glb"), run.read("all.glb"), path)
        if len(meshes) > 1:
            parts += 1
            run.ffd("deform", path, "one.glb", *options, *only("mesh:" + meshes[0]))
            run.ffd("compare", path, "one.glb", code=(0, 1))
    check(equals >= (1 if SANITIZED else 5) and parts >= (1 if SANITIZED else 3), equals, parts, "models")


if __name__ == "__main__":
    main()
