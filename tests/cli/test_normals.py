#!/usr/bin/env python3
"""--normals recompute: normals of the deformed faces, against a slow implementation of its own."""
import math
import os
import struct
import subprocess

from gltf_build import Scene
from gltf_reader import Gltf
from harness import (CUBE_CORNERS, CUBE_FACES, INVALID, MODELS, OK, case, check, equal, glb, glb_split, gltf_json, gltf_vectors,
                     lattice, main, near, obj_of, threaded_case)
from vectors import cross, dot, minus, unit

TWIST = [{"twist": {"axis": "z", "degrees": 70}}, {"at": [3, 3, 3], "by": [0.5, 0.25, 1]}]
EMPTY = [{"at": [0, 0, 0], "by": [0, 0, 0]}]


def area_vector(points):
    total = [0.0, 0.0, 0.0]
    for i in range(1, len(points) - 1):
        term = cross(minus(points[i], points[0]), minus(points[i + 1], points[0]))
        total = [t + 0.5 * x for t, x in zip(total, term)]
    return total


def corner_angle(points, i, normal):
    to, back = minus(points[(i + 1) % len(points)], points[i]), minus(points[i - 1], points[i])
    c = cross(to, back)
    angle = math.atan2(math.sqrt(dot(c, c)), dot(to, back))
    return 2 * math.pi - angle if dot(c, normal) < 0 else angle


def recomputed(faces, rest, deformed, values):
    """faces: lists of corners (vertex, normal or None). The new value of each normal; None: it keeps its own."""
    group_of, sums, touched = {}, {}, set()
    for face in faces:
        points = [deformed[v] for v, _ in face]
        vector = area_vector(points)
        moved = any(rest[v] != deformed[v] for v, _ in face)
        for i, (v, n) in enumerate(face):
            if n is None:
                continue
            key = (tuple(rest[v]), tuple(values[n]))
            group_of[n] = key
            if moved:
                touched.add(key)
            angle = corner_angle(points, i, vector)
            sums[key] = [s + angle * x for s, x in zip(sums.get(key, [0.0] * 3), vector)]
    return {n: unit(sums[key]) if key in touched else None for n, key in group_of.items()}


class Obj:
    """Vertices, normals, faces of corners (vertex, number of `vn`); plain files only."""

    def __init__(self, text):
        self.vertices, self.normals, self.faces = [], [], []
        for line in text.splitlines():
            words = line.split("#")[0].split()
            if words[:1] == ["v"]:
                self.vertices.append([float(x) for x in words[1:4]])
            elif words[:1] == ["vn"]:
                self.normals.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                self.faces.append([self.corner(word) for word in words[1:]])

    def corner(self, word):
        parts = word.split("/")
        v, n = int(parts[0]), int(parts[2]) if len(parts) > 2 and parts[2] else None
        return v - 1 if v > 0 else len(self.vertices) + v, None if n is None else n - 1 if n > 0 else len(self.normals) + n

    def keyed(self):
        """The faces with a normal number for each vertex and `vn`, and the values."""
        values, numbers = [], {}

        def number(v, n):
            if n is None:
                return None
            if (v, n) not in numbers:
                numbers[v, n] = len(values)
                values.append(self.normals[n])
            return numbers[v, n]

        return [[(v, number(v, n)) for v, n in face] for face in self.faces], values


def compare_obj(before, after, what):
    """How many corners were new, and how many as before."""
    equal(len(before.faces), len(after.faces), what)
    faces, values = before.keyed()
    expected = recomputed(faces, before.vertices, after.vertices, values)
    new = kept = 0
    for face, keyed, out in zip(before.faces, faces, after.faces):
        for (_, n), (_, k), (_, m) in zip(face, keyed, out):
            equal(n is None, m is None, what)
            if n is None:
                continue
            if expected[k] is None:
                equal(after.normals[m], before.normals[n], what)
                kept += 1
            else:
                near(after.normals[m], expected[k], 1e-9, f"{what}: {k}")
                new += 1
    return new, kept


def recompute(run, file, out, *options):
    run.ffd("deform", file, out, "-l", "l.json", "--normals", "recompute", "--force", "-q", *options)
    return run.read(out)


def hard_cube(normals=None):
    normals = normals or [unit(area_vector([CUBE_CORNERS[c - 1] for c in face])) for face in CUBE_FACES]
    return (obj_of(CUBE_CORNERS) + "".join("vn %r %r %r\n" % tuple(n) for n in normals)
            + "".join("f " + " ".join(f"{c}//{i + 1}" for c in face) + "\n" for i, face in enumerate(CUBE_FACES)))


def sphere(rows=12, columns=16):
    """Quads and, at the poles, triangles; one normal a vertex."""
    points = [[0.0, 0.0, 1.0]]
    for r in range(1, rows):
        for c in range(columns):
            a, b = math.pi * r / rows, 2 * math.pi * c / columns
            points.append([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])
    points.append([0.0, 0.0, -1.0])

    def at(r, c):
        return 0 if r == 0 else len(points) - 1 if r == rows else 1 + (r - 1) * columns + c % columns

    faces = []
    for r in range(rows):
        for c in range(columns):
            quad = [at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)]
            faces.append([v for i, v in enumerate(quad) if v != quad[i - 1]])
    return points, faces


def sphere_obj():
    points, faces = sphere()
    return (obj_of(points) + "".join("vn %r %r %r\n" % tuple(p) for p in points)
            + "".join("f " + " ".join(f"{v + 1}//{v + 1}" for v in face) + "\n" for face in faces))


@case
def hard_edges_stay_hard(run):
    """A moved cube has the normals it had, one a face; so has a twisted one, whose faces are no longer flat."""
    run.write("a.obj", hard_cube())
    run.write("l.json", lattice(moves=[{"by": [0.5, 0.25, -1]}]))
    equal(recompute(run, "a.obj", "b.obj").decode().splitlines()[8:], hard_cube().splitlines()[8:], "moved as a whole")
    run.write("l.json", lattice(moves=TWIST))
    after = Obj(recompute(run, "a.obj", "b.obj").decode())
    equal(compare_obj(Obj(hard_cube()), after, "twisted"), (24, 0))
    equal(len(after.normals), 6, "one a face")
    equal([[n for _, n in face] for face in after.faces], [[i] * 4 for i in range(6)], "the numbers stay")


@case
def kept_normals_are_checked(run):
    """`--normals keep` leaves them as they are, and refuses what is refused without it."""
    cube = hard_cube()
    run.write("l.json", lattice(moves=TWIST))
    for text, code in ((cube, OK), (cube.replace("vn ", "vn x ", 1), INVALID), (cube.replace("//1", "//9", 1), INVALID),
                       (cube.replace("//1", "//0", 1), INVALID), (cube.replace("//1", "//-7", 1), INVALID)):
        run.write("a.obj", text)
        keep = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--normals", "keep", "-q", code=code)
        other = run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--force", "-q", code=code)
        equal(keep.err, other.err, text)
        if code == OK:
            lines = run.read("b.obj").decode().splitlines()
            equal(lines[8:], cube.splitlines()[8:], "normals and faces")
            equal(lines[:8], run.read("c.obj").decode().splitlines()[:8], "positions")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--normals", "keep", code=INVALID)


@case
def a_sphere_stays_smooth(run):
    run.write("a.obj", sphere_obj())
    run.write("l.json", lattice(moves=[{"scale": {"factor": [2, 1, 0.5], "about": [0, 0, 0]}}]))
    after = Obj(recompute(run, "a.obj", "b.obj").decode())
    equal(compare_obj(Obj(sphere_obj()), after, "an ellipsoid")[1], 0)
    equal(len(after.normals), len(after.vertices), "no normal is split")
    for p, n in zip(after.vertices, after.normals):
        check(dot(n, unit([p[0] / 4, p[1], 4 * p[2]])) > 0.99, "the ellipsoid's own normal", p, n)


@case
def corners_that_shared_a_normal_share_one_again(run):
    """Split `vn` and split vertices of equal values are one normal; other values at the place are others."""
    points, faces = sphere(6, 8)
    text = ""
    for i, face in enumerate(faces):
        text += "".join("v %r %r %r\n" % tuple(points[v]) for v in face)
        text += "".join("vn %r %r %r\n" % tuple(points[v] if i % 5 else [0.0, 0.0, 1.0]) for v in face)
        text += "f " + " ".join(f"{k}//{k}" for k in range(-len(face), 0)) + "\n"
    run.write("a.obj", text)
    run.write("l.json", lattice(moves=TWIST))
    before, after = Obj(text), Obj(recompute(run, "a.obj", "b.obj").decode())
    compare_obj(before, after, "split")
    found = {}
    for face, out in zip(before.faces, after.faces):
        for (v, n), (_, m) in zip(face, out):
            found.setdefault((tuple(before.vertices[v]), tuple(before.normals[n])), set()).add(tuple(after.normals[m]))
    check(all(len(values) == 1 for values in found.values()), "the same bits again")


@case
def normals_of_polygons_are_weighed_by_their_angles(run):
    """Concave faces have angles beyond 180 degrees; corners at one place and repeated corners do no harm."""
    text = """v 0 0 0
v 2 0 0
v 2 2 0
v 1 0.5 0
v 0 2 0
v 1 1 1
v 2 0 0
vn 0 0 1
f 1//1 2//1 3//1 4//1 5//1
f 1//1 6//1 2//1
f 5//1 4//1 6//1
f 3//1 2//1 6//1
"""
    run.write("l.json", lattice(moves=TWIST))
    run.write("a.obj", text)
    equal(compare_obj(Obj(text), Obj(recompute(run, "a.obj", "b.obj").decode()), "concave"), (14, 0))
    plain = Obj(recompute(run, "a.obj", "b.obj").decode())
    for face in ("f 1//1 2//1 7//1 3//1 4//1 5//1", "f 1//1 1//1 2//1 3//1 4//1 5//1 5//1"):
        lines = text.splitlines()
        lines[8] = face
        run.write("a.obj", "\n".join(lines))
        doubled = Obj(recompute(run, "a.obj", "b.obj").decode())
        near(doubled.normals[doubled.faces[0][2][1]], plain.normals[plain.faces[0][1][1]], 1e-12, face)


def as_without_recompute(run, file, told=None):
    """The option changes nothing of the output; told: what is said about it."""
    _, ending = os.path.splitext(file)
    run.write("l.json", lattice(moves=TWIST))
    run.ffd("deform", file, "b" + ending, "-l", "l.json", "--normals", "recompute", err=f"{file}: {told}" if told else None)
    run.ffd("deform", file, "c" + ending, "-l", "l.json")
    equal(run.read("b" + ending), run.read("c" + ending))


@case
def what_has_no_face_follows_the_deformation(run):
    """A face that collapses, and a normal between faces that cancel out."""
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\nvn 0 0 1\nf 1//1 2//1 3//1\nf 3//1 2//1 1//1\nf 2//1 4//1 2//1\n"
    run.write("a.obj", text)
    as_without_recompute(run, "a.obj", "4 normals have no face with an area to be computed from: they follow the deformation")


@case
def where_nothing_moves_the_bits_stay(run):
    """Normals of no particular direction: those far from the moved points and those of an empty move stay."""
    text = hard_cube([[0.1 * i, 0.25, -7e-3] for i in range(6)])
    far = text + "\n".join("v %r 0 9" % x for x in (0, 1, 2)) + "\nv 0 1 9\nf 9//1 10//2 12//3\nf 10//1 11//1 12//1\n"
    run.write("a.obj", far)
    run.write("l.json", lattice(moves=EMPTY))
    equal(recompute(run, "a.obj", "b.obj"), far.encode())
    run.write("l.json", lattice(moves=TWIST))
    new, kept = compare_obj(Obj(far), Obj(recompute(run, "a.obj", "b.obj").decode()), "far")
    equal((new, kept), (24, 6))
    equal(recompute(run, "a.obj", "c.obj", "-j", "1"), run.read("b.obj"), "threads")


@case
def without_normals_there_is_nothing_to_recompute(run):
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    as_without_recompute(run, "a.obj", "has no normals to recompute")


@case
def facets_of_stl_are_renewed_anyway(run):
    run.write("a.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
              "endloop\nendfacet\nendsolid s\n")
    as_without_recompute(run, "a.stl")


@case
def faces_that_cannot_be_read(run):
    """With an index out of range normals follow the deformation, for want of faces; --strict refuses it."""
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], normals=[[0, 0, 1]] * 3)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 3})
    asset["accessors"].append({"bufferView": 2, "componentType": 5121, "count": 3, "type": "SCALAR"})
    asset["meshes"][0]["primitives"][0]["indices"] = 2
    asset["buffers"][0]["byteLength"] += 3
    run.write("a.glb", glb(asset, data + bytes([0, 1, 7])))
    run.write("l.json", lattice(moves=TWIST))
    for normals in ("transform", "recompute", "keep"):
        run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--normals", normals, "--strict", code=INVALID)
        check(not run.exists("b.glb"), "refused")
        run.ffd("deform", "a.glb", normals + ".glb", "-l", "l.json", "--normals", normals, "-q")
    equal(run.read("recompute.glb"), run.read("transform.glb"))
    check(run.read("keep.glb") != run.read("transform.glb"), "kept")


def ply(points, faces, normals):
    head = ("ply\nformat ascii 1.0\nelement vertex %d\n" % len(points)
            + "".join(f"property double {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
            + "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(faces))
    return (head + "".join(" ".join(map(repr, [*p, *n])) + "\n" for p, n in zip(points, normals))
            + "".join(" ".join(map(str, [len(f), *f])) + "\n" for f in faces))


@case
def other_formats_have_a_normal_a_vertex(run):
    points, faces = sphere()
    run.write("a.obj", sphere_obj())
    run.write("a.ply", ply(points, faces, points))
    run.write("a.off", "NOFF\n%d %d 0\n" % (len(points), len(faces)) + "".join(
        " ".join(map(repr, [*p, *p])) + "\n" for p in points) + "".join(" ".join(map(str, [len(f), *f])) + "\n" for f in faces))
    run.write("l.json", lattice(moves=TWIST))
    after = Obj(recompute(run, "a.obj", "b.obj").decode())
    for name, first in (("a.ply", 12), ("a.off", 2)):
        lines = recompute(run, name, "b" + name[1:]).decode().splitlines()[first:first + len(points)]
        values = [[float(x) for x in line.split()] for line in lines]
        near(values, [p + n for p, n in zip(after.vertices, after.normals)], 0, name)


def rotation(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.sin(half) * x for x in unit(axis)] + [math.cos(half)]


def rotate(q, v):
    u = q[:3]
    t = [2 * x for x in cross(u, v)]
    return [a + q[3] * b + c for a, b, c in zip(v, t, cross(u, t))]


@threaded_case
def gltf_is_computed_in_its_scene(run):
    """One mesh under three nodes, turned, stretched and mirrored: each normal is that of the scene's faces,
    brought back, and tangents are perpendicular to them."""
    points, quads = sphere()
    faces = [[f[0], f[i], f[i + 1]] for f in quads for i in range(1, len(f) - 1)]
    corners = [points[v] for f in faces for v in f]
    nodes = [{"mesh": 0, "scale": [0.5, 0.5, 0.5]},
             {"mesh": 0, "rotation": rotation([1, 2, 3], 50), "scale": [0.5, 1.25, 0.75], "translation": [0.25, 0, 0.5]},
             {"mesh": 0, "rotation": rotation([0, 1, 1], 20), "scale": [-0.5, 0.75, 1], "translation": [-0.25, 0, 0]}]
    asset, data = gltf_json(corners, nodes=nodes, normals=corners)
    before = gltf_vectors(asset, data, 0)
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=TWIST))
    after, changed = glb_split(recompute(run, "a.glb", "b.glb"))
    for node in after["nodes"]:
        attributes = after["meshes"][node["mesh"]]["primitives"][0]["attributes"]
        scale, q = node["scale"], node.get("rotation", [0, 0, 0, 1])
        mirrored = scale[0] * scale[1] * scale[2] < 0

        def place(p):
            return [a + b for a, b in zip(rotate(q, [s * x for s, x in zip(scale, p)]), node.get("translation", [0, 0, 0]))]

        def show(n):
            return unit(rotate(q, [x / s for s, x in zip(scale, n)]))

        rest = [place(p) for p in before]
        deformed = [place(p) for p in gltf_vectors(after, changed, attributes["POSITION"])]
        triangles = [[(i + k, i + k) for k in range(3)] for i in range(0, len(rest), 3)]
        expected = recomputed(triangles, rest, deformed, gltf_vectors(asset, data, 1))
        for i, n in enumerate(gltf_vectors(after, changed, attributes["NORMAL"])):
            near([dot(n, n)], [1], 1e-6)
            near(show(n), [-x for x in expected[i]] if mirrored else expected[i], 1e-5, f"{node} {i}")


@case
def morph_targets_add_what_the_deformation_makes_of_it(run):
    """The base's normals are those of its faces; the offsets are as with transform."""
    points, quads = sphere(6, 8)
    faces = [[f[0], f[i], f[i + 1]] for f in quads for i in range(1, len(f) - 1)]
    corners = [points[v] for f in faces for v in f]
    asset, data = gltf_json(corners, normals=corners)
    for factor in (0.25, -0.125):
        offsets = [[factor * p[1] * p[1], 0, factor * p[0]] if p[2] > 0 else [0, 0, 0] for p in corners]
        asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 12 * len(corners)})
        asset["accessors"].append({**asset["accessors"][0], "bufferView": len(asset["bufferViews"]) - 1,
                                   "min": [-1, 0, -1], "max": [1, 1, 1]})
        data += b"".join(struct.pack("<3f", *p) for p in offsets)
    asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 2, "NORMAL": 3}]
    asset["buffers"][0]["byteLength"] = len(data)
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=TWIST))
    run.ffd("deform", "a.glb", "t.glb", "-l", "l.json")
    transform, carried = glb_split(run.read("t.glb"))
    after, changed = glb_split(recompute(run, "a.glb", "b.glb"))
    for i in (0, 2, 3):
        equal(gltf_vectors(after, changed, i), gltf_vectors(transform, carried, i), f"accessor {i}")
        check(gltf_vectors(after, changed, i) != gltf_vectors(asset, data, i), i, "changes")
    triangles = [[(i + k, i + k) for k in range(3)] for i in range(0, len(corners), 3)]
    expected = recomputed(triangles, gltf_vectors(asset, data, 0), gltf_vectors(after, changed, 0),
                          gltf_vectors(asset, data, 1))
    near(gltf_vectors(after, changed, 1), [expected[i] for i in range(len(corners))], 1e-5)
    run.ffd("deform", "a.glb", "k.glb", "-l", "l.json", "--normals", "keep")
    equal(gltf_vectors(*glb_split(run.read("k.glb")), 3), gltf_vectors(asset, data, 3), "kept")


@case
def halves_that_meet_in_a_mirror_have_one_normal(run):
    """A mesh and its mirror image by a node: at the seam both have the normal of the whole."""
    points = [[0, 0, 0], [1, 0, 0.5], [0, 1, 0], [1, 1, 0.25]]
    normals = [[0, 0, 1], unit([-1, 0, 1]), [0, 0, 1], unit([-1, 0, 1])]
    asset, data = gltf_json(points, nodes=[{"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]}], normals=normals)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 6})
    asset["accessors"].append({"bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR"})
    asset["meshes"][0]["primitives"][0]["indices"] = 2
    data += bytes([0, 1, 2, 1, 3, 2])
    asset["buffers"][0]["byteLength"] = len(data)
    run.write("a.glb", glb(asset, data))
    run.write("l.json", lattice(moves=[{"bend": {"axis": "y", "toward": [0, 0, 1], "degrees": 60, "about": [0, 0, 0]}}]))
    after, changed = glb_split(recompute(run, "a.glb", "b.glb"))
    for node in after["nodes"]:
        attributes = after["meshes"][node["mesh"]]["primitives"][0]["attributes"]
        n = gltf_vectors(after, changed, attributes["NORMAL"])
        near([n[0][0], n[2][0]], [0, 0], 1e-7, "across the mirror's plane")
        check(n[0][2] > 0.5, "the side that is shown", n)


@case
def halves_under_turned_nodes_have_one_normal(run):
    """Two meshes that meet along y, one under a node that is turned by 90 degrees: their normals there show as one."""
    scene = Scene(nodes=[{"mesh": 0}, {"mesh": 1, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}],
                  scenes=[{"nodes": [0, 1]}], meshes=[])
    halves = [[[0, 0, 0], [1, 0, 0.5], [0, 1, 0], [1, 1, 0.25]], [[0, 0, 0], [0, 1, 0], [-1, 0, 0.75], [-1, 1, 0.5]]]
    for points, indices, turned in zip(halves, ([0, 1, 2, 1, 3, 2], [0, 1, 2, 1, 3, 2]), (False, True)):
        normals = [[0.6, 0, 0.8]] * 4
        if turned:
            points, normals = ([[y, -x, z] for x, y, z in vectors] for vectors in (points, normals))
        scene.asset["meshes"].append({"primitives": [{
            "attributes": {"POSITION": scene.add([list(map(float, p)) for p in points], bounds=True),
                           "NORMAL": scene.add(normals)},
            "indices": scene.add([[i] for i in indices], 5121, "SCALAR")}]})
    run.write("a.glb", scene.glb())
    run.write("l.json", lattice(moves=[{"bend": {"axis": "y", "toward": [0, 0, 1], "degrees": 60, "about": [0, 0, 0]}}]))
    after, changed = glb_split(recompute(run, "a.glb", "b.glb"))
    first, second = (gltf_vectors(after, changed, mesh["primitives"][0]["attributes"]["NORMAL"])
                     for mesh in after["meshes"])
    for i, j in ((0, 0), (2, 1)):
        near([-second[j][1], second[j][0], second[j][2]], first[i], 1e-6, "along the line where they meet")
        check(abs(first[i][0] - 0.6) > 0.1, "made anew", first)


@case
def a_selection_keeps_the_normals_of_the_rest(run):
    run.write("l.json", lattice(moves=TWIST))
    lines = sphere_obj().splitlines()
    faces = [i for i, line in enumerate(lines) if line.startswith("f ")]
    lines.insert(faces[len(faces) // 2], "g low")
    run.write("a.obj", "\n".join(lines) + "\n")
    text = recompute(run, "a.obj", "b.obj", "--only", "group:low").decode()
    before, after = Obj("\n".join(lines)), Obj(text)
    faces, values = before.keyed()
    expected = recomputed(faces, before.vertices, after.vertices, values)
    half = len(before.faces) // 2
    for i, (face, keyed, out) in enumerate(zip(before.faces, faces, after.faces)):
        for (_, n), (_, k), (_, m) in zip(face, keyed, out):
            if i < half:
                equal(after.normals[m], before.normals[n], "a corner that is not selected")
            else:
                near(after.normals[m], expected[k], 1e-9, "a selected corner")


def models(ending, limit):
    for folder, _, names in sorted(os.walk(MODELS)):
        for name in sorted(names):
            path = os.path.join(folder, name)
            if name.endswith(ending) and os.path.getsize(path) < limit:
                yield path


@threaded_case
def normals_of_obj_models_are_those_of_the_slow_implementation(run):
    """The models with normals: as the slow implementation says; an empty move leaves every byte."""
    if not MODELS:
        return
    checked = normals = 0
    for path in models(".obj", 200000):
        with open(path, "rb") as file:
            data = file.read()
        run.write("l.json", lattice(rest={"box": "mesh"}, moves=EMPTY))
        if run.ffd("deform", path, "a.obj", "-l", "l.json", "--normals", "recompute", "--force", "-q", code=(0, 4),
                   stderr=subprocess.DEVNULL).code:
            continue
        equal(run.read("a.obj"), data, path)
        if b"\nvn" not in data or b"\\\n" in data or b"\r" in data.replace(b"\r\n", b""):
            continue
        run.write("l.json", lattice(rest={"box": "mesh"}, moves=TWIST))
        after = Obj(recompute(run, path, "b.obj").decode("latin-1"))
        before = Obj(data.decode("latin-1"))
        if any(len({v for v, _ in face}) < len(face) for face in before.faces):
            continue
        checked += 1
        normals += compare_models(before, after, path)
    check(checked >= 30 and normals > 15000, checked, "models", normals, "normals")


def count_near(pairs, tolerance, path):
    """How many pairs of normals agree; one in a hundred may not."""
    good = sum(max(abs(x - y) for x, y in zip(a, b)) < tolerance for a, b in pairs)
    check(len(pairs) - good <= 0.01 * len(pairs), path, len(pairs) - good, "of", len(pairs))
    return good


def compare_models(before, after, path):
    """As compare_obj, but slivers and normals that nearly cancel out are let pass."""
    faces, values = before.keyed()
    expected = recomputed(faces, before.vertices, after.vertices, values)
    return count_near([(after.normals[m], expected[k]) for keyed, out in zip(faces, after.faces)
                       for (_, k), (_, m) in zip(keyed, out) if k is not None and expected[k] is not None], 1e-6, path)


def triangles_of(file, index):
    """Vertices of all triangles in mesh space (each accessor once), normals, and the faces' corners."""
    vertices, normals, faces = {}, {}, []
    points, values = [], []
    for mesh in file.asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            if primitive.get("mode", 4) != 4 or "POSITION" not in attributes:
                continue
            position, normal = attributes["POSITION"], attributes.get("NORMAL")
            if position not in vertices:
                vertices[position] = len(points)
                points += file.decoded(position)
            if normal is not None and (position, normal) not in normals:
                normals[position, normal] = len(values)
                values += file.decoded(normal)
            corners = index(primitive, len(file.decoded(position)))
            for i in range(0, len(corners) - 2, 3):
                faces.append([(vertices[position] + c, None if normal is None else normals[position, normal] + c)
                              for c in corners[i:i + 3]])
    return points, values, faces


def indices_of(file):
    def index(primitive, count):
        if "indices" not in primitive:
            return range(count)
        return [int(x[0]) for x in file.decoded(primitive["indices"])]
    return index


def compare_gltf(before, after, path):
    points, values, faces = triangles_of(before, indices_of(before))
    deformed, found, _ = triangles_of(after, indices_of(after))
    equal((len(deformed), len(found)), (len(points), len(values)), path)
    pairs = []
    for n, direction in recomputed(faces, points, deformed, values).items():
        if direction is None:
            equal(list(found[n]), list(values[n]), path)
        else:
            pairs.append((found[n], direction))
    return count_near(pairs, 1e-3, path)


def is_plain(asset):
    return all(accessor["componentType"] == 5126 or accessor["type"] == "SCALAR" for accessor in asset["accessors"]) \
        and not asset.get("extensionsRequired") and not any(
            "targets" in primitive for mesh in asset["meshes"] for primitive in mesh["primitives"])


@threaded_case
def normals_of_gltf_models_are_those_of_the_slow_implementation(run):
    """An empty move leaves every byte; a twist in mesh space gives what the slow implementation says of the
    output's own positions."""
    if not MODELS:
        return
    checked = normals = 0
    for path in models(".glb", 300000):
        run.write("l.json", lattice(rest={"box": "mesh"}, moves=EMPTY))
        command = ["-l", "l.json", "--normals", "recompute", "--memory", "1G", "--force", "-q"]
        if run.ffd("deform", path, "a.glb", *command, code=(0, 4, 6), stderr=subprocess.DEVNULL).code:
            continue
        with open(path, "rb") as file:
            equal(run.read("a.glb"), file.read(), path)
        before = Gltf(path)
        checked += 1
        if os.path.getsize(path) > 60000 or not is_plain(before.asset):
            continue
        run.write("l.json", lattice(rest={"box": "mesh"}, moves=TWIST))
        run.ffd("deform", path, "b.glb", *command, "--space", "mesh")
        normals += compare_gltf(before, Gltf(run.path("b.glb")), path)
    check(checked >= 20 and normals > 1500, checked, "models", normals, "normals")


if __name__ == "__main__":
    main()
