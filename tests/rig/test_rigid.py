#!/usr/bin/env python3
"""--rigid and --uniform: parts that move as one piece, beside NumPy's SVD (Kabsch 1976, Umeyama 1991); wheels that stay round as
their animations turn them, and the warning of those that do not."""

import json
import math
import os
import subprocess
import sys

try:
    import numpy
except ImportError:
    if sys.executable != "/usr/bin/python3" and subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True, check=False).returncode == 0:
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
    print("SKIP: NumPy: no interpreter here has it (.ci/setup test)")
    sys.exit(77)

from follow import poses
from gltf_build import Scene
from harness import CUBE, NO, OK, USAGE, case, check, equal, gltf_vectors, glb_split, lattice, main, obj_vertices, threaded_case
from made import Arm, turns
from messages import anything, entry, no_line, one_line
from pose import Rig

# Bends, twists and stretches what is within 6 of the origin, all of it.
WILD = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(4, 4, 4), moves=[
    {"at": [i, j, k], "by": [0.3 * j * k - 0.5 * i, 0.4 * i * i - 0.2 * k, 0.3 * i * j]}
    for i in range(4) for j in range(4) for k in range(4)])
LONG = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"scale": {"factor": [1.6, 1, 1]}}])


def nearest(x, y, uniform=False):
    """Where the least squares motion takes x, the rotation in degrees, and the scale."""
    x, y = numpy.array(x, float), numpy.array(y, float)
    a, b = x - x.mean(0), y - y.mean(0)
    u, s, vt = numpy.linalg.svd(b.T @ a)
    if s[0] < 1e-12:
        turn = numpy.eye(3)
    elif s[1] < 1e-7 * s[0]:
        turn = least(vt[0], u[:, 0])
    else:
        turn = u @ numpy.diag([1, 1, numpy.linalg.det(u @ vt)]) @ vt
    scale = numpy.sum(turn * (b.T @ a)) / numpy.sum(a * a) if uniform else 1
    angle = math.degrees(math.acos(max(-1, min(1, (numpy.trace(turn) - 1) / 2))))
    return scale * a @ turn.T + y.mean(0), angle, scale


def least(a, b):
    """The least rotation that takes a unit vector to another one."""
    axis, cosine = numpy.cross(a, b), a @ b
    k = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return numpy.eye(3) + k + k @ k / (1 + cosine)


def is_near(found, wanted, tolerance, what):
    off = numpy.abs(numpy.array(found) - numpy.array(wanted)).max()
    check(off <= tolerance, f"{what}: off by {off:.3g}")


def box(low, high, first=1, steps=3):
    """The vertices and quads of a box's grid of points, as lines of an OBJ."""
    points = [[low[a] + (high[a] - low[a]) * t / (steps - 1) for a, t in enumerate((i, j, k))]
              for i in range(steps) for j in range(steps) for k in range(steps)]
    at = lambda i, j, k: first + (i * steps + j) * steps + k
    faces = [[at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k)]
             for i in range(steps - 1) for j in range(steps - 1) for k in (0, steps - 1)]
    faces += [[at(i, j, k), at(i, j + 1, k), at(i, j + 1, k + 1), at(i, j, k + 1)]
              for j in range(steps - 1) for k in range(steps - 1) for i in (0, steps - 1)]
    faces += [[at(i, j, k), at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j, k)]
              for i in range(steps - 1) for k in range(steps - 1) for j in (0, steps - 1)]
    return points, faces


def parts_obj():
    """Two boxes of each kind of name, 27 vertices each but for the inner ones, which no face uses."""
    text, ranges, first = "", {}, 1
    for n, (name, head) in enumerate((("body", "o body\ng default\n"), ("door", "o door\ng door\n"), ("rim", "usemtl rubber\ng rim\no rim\n"))):
        points, faces = box((-3 + 2 * n, -1, -0.5), (-2 + 2 * n, 1, 1.5 + n), first)
        text += "".join("v %r %r %r\n" % tuple(p) for p in points) + head + "".join("f %d %d %d %d\n" % tuple(f) for f in faces)
        ranges[name] = sorted({i - 1 for f in faces for i in f})
        first += len(points)
    return text, ranges


def moved(run, *options, mesh="a.obj", grid=WILD, **more):
    run.write("l.json", grid)
    run.write("a.obj", parts_obj()[0])
    job = entry(run, "deform", mesh, "b.obj", "-l", "l.json", *options, **more)
    return numpy.array(obj_vertices(run.text("b.obj"))), job


def part(job, number=0):
    return job["rigid"][number]


@case
def every_name_of_an_obj_moves_as_the_svd_says(run):
    text, ranges = parts_obj()
    before, free = numpy.array(obj_vertices(text)), moved(run)[0]
    for selector, name in (("group:door", "door"), ("object:door", "door"), ("material:rubber", "rim"), ("object:body", "body")):
        for option in ("--rigid", "--uniform"):
            found, job = moved(run, option, selector)
            own = ranges[name]
            wanted, angle, scale = nearest(before[own], free[own], option == "--uniform")
            is_near(found[own], wanted, 1e-12, f"{option} {selector}")
            others = [i for i in range(len(before)) if i not in own]
            equal(found[others].tolist(), free[others].tolist(), "what is not named")
            equal((part(job)["part"], part(job)["pieces"]), (selector, 1))
            is_near(part(job)["rotation"], angle, 1e-6, "the rotation")
            is_near(part(job)["scale"], scale, 1e-12, "the scale")
            is_near(part(job)["distance"], numpy.linalg.norm(wanted - free[own], axis=1).max(), 1e-12, "the distance")


@case
def each_component_moves_by_itself(run):
    """Of what --only leaves and no other selector names; what no face uses moves freely."""
    text, ranges = parts_obj()
    before, free = numpy.array(obj_vertices(text)), moved(run)[0]
    found, job = moved(run, "--uniform", "component", "--rigid", "group:door")
    equal([(p["part"], p["pieces"]) for p in job["rigid"]], [("group:door", 1), ("component", 2)])
    for name, own in ranges.items():
        is_near(found[own], nearest(before[own], free[own], name != "door")[0], 1e-12, name)
    unused = [i for i in range(len(before)) if not any(i in own for own in ranges.values())]
    equal(found[unused].tolist(), free[unused].tolist(), "what no face uses")
    found, job = moved(run, "--rigid", "component", "--only", "group:door")
    equal((part(job)["pieces"], part(job)["part"]), (1, "component"))
    is_near(found[ranges["door"]], nearest(before[ranges["door"]], free[ranges["door"]])[0], 1e-12, "the door")
    equal(found[ranges["body"]].tolist(), before[ranges["body"]].tolist(), "what --only leaves out")


@case
def lines_and_equal_positions_join(run):
    run.write("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 0\nv 2 1 1\nv 4 4 4\nv 4 4 5\nv 5 4 4\nv -3 0 0\nf 1 2 3\nl 4 5\nf 6 7 8\np 9\n")
    free = moved(run, mesh="c.obj")[0]
    found, job = moved(run, "--rigid", "component", mesh="c.obj")
    before = numpy.array(obj_vertices(run.text("c.obj")))
    equal(part(job)["pieces"], 3)
    for own in ([0, 1, 2, 3, 4], [5, 6, 7], [8]):
        is_near(found[own], nearest(before[own], free[own])[0], 1e-12, str(own))


@case
def a_line_a_point_and_a_mirror_image(run):
    quarter = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"rotate": {"axis": "z", "degrees": 90, "about": [0, 0, 0]}}])
    run.write("c.obj", "v 1 0 0\nv 2 0 0\nv 4 0 0\nv 0 0 3\nl 1 2 3\np 4\n")
    found, job = moved(run, "--rigid", "component", mesh="c.obj", grid=quarter)
    is_near(found, [[0, 1, 0], [0, 2, 0], [0, 4, 0], [0, 0, 3]], 1e-14, "a line and a point")
    is_near(part(job)["rotation"], 90, 1e-9, "the rotation")
    for mesh, wanted in (("v 1 0 0\nv 2 0 0\nv 4 0.5 0\nv 1 1 1\nf 1 2 3\nf 2 3 4\n", None), ("v 1 0.5 2\np 1\n", [[-1, 0.5, 2]])):
        run.write("c.obj", mesh)
        mirror = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}])
        free, before = moved(run, mesh="c.obj", grid=mirror)[0], numpy.array(obj_vertices(mesh))
        found, job = moved(run, "--rigid", "component", mesh="c.obj", grid=mirror)
        is_near(found, nearest(before, free)[0] if wanted is None else wanted, 1e-12, "mirrored")


@case
def what_a_part_cannot_be_is_refused(run):
    moved(run)
    for options, words in ((["--rigid", "group:door", "--uniform", "object:door"], ["group:door", "object:door", "vertex 27"]),
                           (["--rigid", "group:doors"], ["doors", "nearest", "door"]),
                           (["--uniform", "joint:x"], ["joint", "OBJ"]),
                           (["--rigid", "door"], ["KIND:NAME"]), (["--rigid", "gruop:door"], ["nearest: group"]),
                           (["--rigid", "component", "--uniform", "component"], ["component", "twice"]),
                           (["--rigid", "group:door", "--rigid", "group:door"], ["vertex 27"])):
        done = run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", *options, code=USAGE)
        one_line(done, *words)
        check(not run.exists("c.obj"), "nothing is written")
    one_line(run.ffd("deform", "a.obj", "c.glb", "--morph", "a=l.json", "--rigid", "group:door", code=USAGE), "--rigid", "--morph")
    many = [word for n in range(65) for word in ("--rigid", f"group:g{n}")]
    one_line(run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", *many, code=USAGE), "65", "64")
    run.ffd("check", "a.obj", "-l", "l.json", "--only", "group:door", "--rigid", "group:rim", err=lambda said: check("has no vertices" in said[0]))


@case
def parts_that_were_joined_come_apart_with_a_word(run):
    """Two quads with vertices of their own at a common edge."""
    text = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng a\nf 1 2 3 4\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\ng b\nf 5 6 7 8\n")
    run.write("c.obj", text)
    found, job = moved(run, "--rigid", "group:b", mesh="c.obj", grid=LONG)
    apart = max(numpy.linalg.norm(found[i] - found[j]) for i, j in ((1, 4), (2, 7)))
    equal(job["tear"]["edges"], 2)
    is_near(job["tear"]["largest"], apart, 1e-12, "the step")
    one_line(run.ffd("deform", "c.obj", "d.obj", "-l", "l.json", "--rigid", "group:b", err=anything), "rigid part", "torn")
    run.ffd("deform", "c.obj", "e.obj", "-l", "l.json", "--rigid", "group:b", "--fail-on", "tear", code=NO, lines=1)
    equal(moved(run, mesh="c.obj", grid=LONG)[1]["tear"]["edges"], 0)


@case
def what_does_not_move_keeps_its_bytes(run):
    run.write("s.json", lattice(low=(-6, -6, -6), high=(6, 6, 6)))
    run.write("a.obj", parts_obj()[0])
    run.ffd("deform", "a.obj", "b.obj", "-l", "s.json", "--uniform", "component", err=anything)
    equal(run.read("b.obj"), run.read("a.obj"))


@threaded_case
def threads_and_instructions_never_change_a_byte(run):
    steps = 48
    text = "".join("v %r %r %r\n" % (i / 10, math.sin(j / 5), k * 2 - 1) for k in range(2) for i in range(steps) for j in range(steps))
    text += "".join("f %d %d %d\n" % (v + 1, v + 2, v + steps + 1) for k in range(2) for i in range(steps - 1) for j in range(steps - 1)
                    for v in [(k * steps + i) * steps + j])
    run.write("a.obj", text)
    run.write("l.json", WILD)
    results = set()
    for options in (["--threads", "1", "--isa", "scalar"], ["--threads", "4"], ["--threads", "2", "--isa", "sse2"]):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--uniform", "component", "--force", *options, err=anything)
        results.add(run.read("b.obj"))
    equal(len(results), 1)


def wheel(sides=12, radius=0.5):
    return [[radius * math.cos(2 * math.pi * s / sides), radius * math.sin(2 * math.pi * s / sides), z] for z in (-0.1, 0.1) for s in range(sides)]


def wheel_faces(sides=12):
    return [[i] for s in range(sides) for a, b in [(s, (s + 1) % sides)] for i in (a, b, a + sides, b, b + sides, a + sides)]


def car(pointer=False, skinned=False, pivot=False, still=False, lift=0.0, second=False, none=0):
    """A body, and a wheel that an animation turns, perhaps as a joint of a skin or below a pivot."""
    scene = Scene(scene=0, scenes=[{"nodes": [0]}], nodes=[{"name": "car", "children": [1, 2]}, {"name": "body", "mesh": 0},
                                                           {"name": "wheel", "translation": [1.5, 0.5, 0.6 + lift]}],
                  meshes=[{"name": "shell", "primitives": [{"material": 0}]}, {"name": "disc", "primitives": [{"material": 1}]}],
                  materials=[{"name": "paint"}, {"name": "rubber"}])
    body, wheel_mesh = (mesh["primitives"][0] for mesh in scene.asset["meshes"])
    corners = [[x, y, z] for z in (-0.5, 0.5) for y in (0.2, 1.4) for x in (-2.0, 2.0)]
    body["attributes"] = {"POSITION": scene.add(corners, bounds=True)}
    body["indices"] = scene.add([[i] for i in (0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7)], 5123, "SCALAR")
    points = wheel()
    rest = [[1.5 + x, 0.5 + y, 0.6 + z] for x, y, z in points] if skinned else points
    wheel_mesh["attributes"] = {"POSITION": scene.add(rest, bounds=True), "NORMAL": scene.add([[0.0, 0.0, math.copysign(1.0, z)] for _, _, z in points])}
    wheel_mesh["indices"] = scene.add(wheel_faces(), 5123, "SCALAR")
    turned, nodes = 2, scene.asset["nodes"]
    if skinned:
        nodes[0]["children"].append(3)
        nodes.append({"name": "tyre", "mesh": 1, "skin": 0})
        wheel_mesh["attributes"]["JOINTS_0"] = scene.add([[1 if second else 0, 0, 0, 0]] * len(points), 5121, "VEC4")
        wheel_mesh["attributes"]["WEIGHTS_0"] = scene.add([[float(v >= none), 0, 0, 0] for v in range(len(points))], shape="VEC4")
        bind = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1.5, -0.5, -0.6, 1]
        still_bind = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        scene.asset["skins"] = [{"joints": [0, 2] if second else [2], "inverseBindMatrices": scene.add([still_bind, bind] if second else [bind], shape="MAT4")}]
    elif pivot:
        nodes[2]["children"] = [3]
        nodes.append({"name": "disc", "mesh": 1})
    else:
        nodes[2]["mesh"] = 1
    times = scene.add([[t / 4] for t in range(5)], shape="SCALAR", bounds=True)
    angles = [0, 0, 0, 0, 0] if still else [0, 90, 180, 270, 360]
    output = scene.add(turns((0, 0, 1), angles), shape="VEC4")
    target = {"node": turned, "path": "rotation"}
    if pointer:
        target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": f"/nodes/{turned}/rotation"}}}
        scene.asset["extensionsUsed"] = ["KHR_animation_pointer"]
    scene.asset["animations"] = [{"name": "roll", "samplers": [{"input": times, "output": output}], "channels": [{"sampler": 0, "target": target}]}]
    return scene


def rolled(run, scene, *options, grid=LONG, **more):
    run.write("a.glb", scene.glb())
    run.write("l.json", grid)
    done = run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force", *options, **{"err": anything, **more})
    return Rig(run.path("a.glb")), Rig(run.path("b.glb")), done


def tyre_of(rig, number, *pose):
    return numpy.array([p for (node, _), points in rig.vertices(*pose).items() if node == number for p in points])


def stays_round(before, after, node, scale, what):
    """At 20 times all distances of the wheel's points from each other are those of the first wheel, times the scale."""
    far = lambda p: numpy.linalg.norm(p[:, None] - p[None], axis=2)
    for pose in poses(before):
        is_near(far(tyre_of(after, node, *pose)), scale * far(tyre_of(before, node, *pose)), 3e-6, f"{what} at {pose}")
        middle = tyre_of(after, node, *pose).mean(0)
        is_near(middle, tyre_of(after, node).mean(0), 3e-6, f"the hub of {what} at {pose}")


CARS = {"a node": ({}, 2, "node:wheel"), "a mesh": ({}, 2, "mesh:disc"), "a material": ({}, 2, "material:rubber"),
        "below a pivot": ({"pivot": True}, 3, "node:wheel"), "a mesh below a pivot": ({"pivot": True}, 3, "mesh:disc"),
        "of a skin": ({"skinned": True}, 3, "joint:wheel"), "of a second joint": ({"skinned": True, "second": True}, 3, "joint:wheel"), "the mesh of a skin": ({"skinned": True}, 3, "mesh:disc"),
        "by a pointer": ({"pointer": True}, 2, "component")}


@case
def a_wheel_that_rolls_stays_round(run):
    for name, (how, node, selector) in CARS.items():
        for grid in (LONG, WILD):
            for option in ("--rigid", "--uniform"):
                before, after, done = rolled(run, car(**how), "--rig", "follow", option, selector, "--report", "r.json", grid=grid)
                found = part(json.loads(run.read("r.json"))["jobs"][0])
                equal(found["pieces"], 3 if selector == "component" else 1)
                scale = found["scale"] if selector != "component" else None
                if scale is None:  # that of the component which is farthest from 1 may be the body's
                    scale = numpy.linalg.norm(numpy.ptp(tyre_of(after, node), axis=0)) / numpy.linalg.norm(numpy.ptp(tyre_of(before, node), axis=0))
                    scale = 1 if option == "--rigid" else None
                if scale:
                    stays_round(before, after, node, scale, f"{name}, {option}")
                no_line(done, "wobble")
                if option == "--rigid" and "second" not in how:
                    mesh = before.nodes[node].mesh
                    accessor = before.asset["meshes"][mesh]["primitives"][0]["attributes"]
                    for stream in ("POSITION", "NORMAL"):
                        equal(after.file.stored(after.asset["meshes"][mesh]["primitives"][0]["attributes"][stream]),
                              before.file.stored(accessor[stream]), f"{stream} of {name} keep their bits")


@case
def vertices_of_a_gltf_move_as_the_svd_says(run):
    for rig in ("keep", "follow"):
        for name, (how, node, selector) in CARS.items():
            for option in ("--rigid", "--uniform"):
                before, free, _ = rolled(run, car(**how), "--rig", rig, grid=WILD)
                x, y = tyre_of(before, node), tyre_of(free, node)
                after = rolled(run, car(**how), "--rig", rig, option, selector, grid=WILD)[1]
                is_near(tyre_of(after, node), nearest(x, y, option == "--uniform")[0], 2e-6, f"{name}, {rig}, {option}")


@case
def a_joint_has_what_follows_it_by_more_than_half(run):
    arm = Arm(normals=True)
    before, free, _ = rolled(run, arm, grid=WILD)
    after = rolled(run, arm, "--rigid", "joint:hand", grid=WILD)[1]
    shape = before.shapes[arm.names["skin"], 0]
    own = [i for i, influences in enumerate(shape.influences) if sum(w for j, w in influences if j == 2) > 0.5]
    x, y, z = (tyre_of(rig, arm.names["skin"]) for rig in (before, free, after))
    check(0 < len(own) < len(x))
    wanted = y.copy()
    wanted[own] = nearest(x[own], y[own])[0]
    is_near(z, wanted, 4e-6, "an arm with a rigid hand")


@case
def a_vertex_without_weights_follows_its_first_joint(run):
    found = []
    for none in (0, 3):
        run.write("a.glb", car(skinned=True, none=none).glb())
        run.write("l.json", WILD)
        run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", "--rigid", "joint:wheel", "--force", err=anything)
        found.append(obj_vertices(run.text("b.obj")))
    is_near(found[1], found[0], 1e-12, "the tyre")


@case
def normals_and_tangents_turn(run):
    arm = Arm(normals=True)
    turn = lattice(low=(-9, -9, -9), high=(9, 9, 9), size=(2, 2, 2),
                   moves=[{"rotate": {"axis": "x", "degrees": 30, "about": [0, 0, 0]}}, {"scale": {"factor": [1, 2, 1]}}])
    before, after, _ = rolled(run, arm, "--rigid", "node:wheel", grid=turn)
    node = arm.names["wheel"]
    old, new = before.shapes[node, 0], after.shapes[node, 0]
    shift = lambda rig: numpy.array(rig.positions) - numpy.array(rig.positions).mean(0)
    u, _, vt = numpy.linalg.svd(shift(new).T @ shift(old))
    rotation = u @ vt
    is_near(numpy.array(new.normals), numpy.array(old.normals) @ rotation.T, 1e-6, "normals")
    is_near(numpy.array(new.tangents)[:, :3], numpy.array(old.tangents)[:, :3] @ rotation.T, 1e-6, "tangents")
    equal([t[3] for t in new.tangents], [t[3] for t in old.tangents], "handedness")


@case
def wheels_that_will_wobble_are_named(run):
    for name, (how, _, _) in CARS.items():
        for options in ([], ["--rig", "follow"], ["--as-morph", "long"]):
            one_line(rolled(run, car(**how), *options)[2], "node:wheel", r"\(1\.6 to 1\)", "wobble", "--rigid")
    one_line(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "node:wheel", r"\(1\.6 to 1\)")
    no_line(rolled(run, car(still=True))[2], "wobble")
    even = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"scale": {"factor": 1.6}}])
    no_line(rolled(run, car(), grid=even)[2], "wobble")
    nearly = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"scale": {"factor": [1.049, 1, 1]}}])
    no_line(rolled(run, car(), grid=nearly)[2], "wobble")
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=lambda said: check(not any("wobble" in line for line in said), said))


@case
def a_wheel_below_a_wheel_is_told_by_its_own_vertices(run):
    """Each vertex counts for the nearest node above it that turns: the outer one has the body."""
    scene = car(lift=0.3)
    nodes, animation = scene.asset["nodes"], scene.asset["animations"][0]
    animation["channels"].append({"sampler": 0, "target": {"node": 0, "path": "rotation"}})
    grown = lattice(low=(0.9, -0.1, 0.65), high=(2.1, 1.1, 6), size=(2, 2, 2), moves=[{"scale": {"factor": [1.3, 1, 1]}}])
    one_line(rolled(run, scene, grid=grown)[2], "node:wheel", "1.3 to 1", "wobble")
    no_line(rolled(run, scene, "--rigid", "node:wheel", grid=grown)[2], "wobble")
    one_line(rolled(run, scene)[2], "node:car", "so will 1 more", "wobble")
    one_line(rolled(run, scene, "--rigid", "mesh:disc")[2], "node:car", r"1\.6 to 1\), and")


@case
def morph_targets_of_a_part_turn_with_it(run):
    arm = Arm(morphs=True)
    before, free, _ = rolled(run, arm, grid=WILD)
    after = rolled(run, arm, "--rigid", "node:skin", grid=WILD)[1]
    old, new = (rig.shapes[arm.names["skin"], 0] for rig in (before, after))
    shift = lambda points: numpy.array(points) - numpy.array(points).mean(0)
    u, s, vt = numpy.linalg.svd(shift(new.positions).T @ shift(old.positions))
    rotation = u @ numpy.diag([1, 1, numpy.linalg.det(u @ vt)]) @ vt
    for target, turned in zip(old.targets, new.targets):
        is_near(turned, numpy.array(target) @ rotation.T, 2e-6, "a target")


@case
def a_morph_target_that_turns_a_part_is_said(run):
    quarter = lattice(low=(-6, -6, -6), high=(6, 6, 6), size=(2, 2, 2), moves=[{"rotate": {"axis": "z", "degrees": 90}}])
    before, after, done = rolled(run, car(), "--as-morph", "turned", "--rigid", "node:wheel", grid=quarter)
    one_line(done, "node:wheel", "90 degrees", "halfway", "0.707")
    shape = after.shapes[2, 0]
    x, y = numpy.array(shape.positions), numpy.array(shape.positions) + numpy.array(shape.targets[0])
    is_near(nearest(x, y)[0], y, 1e-6, "the target in full")


@case
def batches_take_it_in_manifests_and_for_all_jobs(run):
    text, ranges = parts_obj()
    before, free = numpy.array(obj_vertices(text)), moved(run)[0]
    wanted, _ = moved(run, "--rigid", "group:door")
    both, _ = moved(run, "--rigid", "group:door", "--uniform", "object:body")
    run.write("m.jsonl", "".join(json.dumps(job) + "\n" for job in (
        {"in": "a.obj", "lattice": "l.json", "out": "o1.obj"},
        {"in": "a.obj", "lattice": "l.json", "out": "o2.obj", "options": {"rigid": "group:door"}},
        {"in": "a.obj", "lattice": "l.json", "out": "o3.obj", "options": {"rigid": ["group:door"], "uniform": "object:body"}})))
    run.ffd("batch", "m.jsonl", "--report", "r.json", err=anything)
    jobs = json.loads(run.read("r.json"))["jobs"]
    equal(["rigid" in job for job in jobs], [False, True, True])
    for name, points in (("o1.obj", free), ("o2.obj", wanted), ("o3.obj", both)):
        equal(obj_vertices(run.text(name)), points.tolist(), name)
    run.ffd("batch", "m.jsonl", "--resume", "--report", "s.json", err=anything)
    equal([job["status"] for job in json.loads(run.read("s.json"))["jobs"]], ["skipped"] * 3)
    equal([job.get("rigid") for job in json.loads(run.read("s.json"))["jobs"]], [job.get("rigid") for job in jobs])
    run.ffd("batch", "--in", "a.obj", "-l", "l.json", "--out-dir", "o", "--rigid", "group:door", err=anything)
    equal(obj_vertices(run.text("o/a.obj")), wanted.tolist())


@case
def a_check_tells_the_figures_and_a_view_draws_them(run):
    _, job = moved(run, "--rigid", "group:door", "--uniform", "material:rubber")
    told = run.ffd("check", "a.obj", "-l", "l.json", "--rigid", "group:door", "--uniform", "material:rubber", code=(OK, NO), err=anything).text
    for found in job["rigid"]:
        check(f"{found['part']}, turned by {found['rotation']:.6g} degrees" in told, told)
    run.ffd("view", "a.obj", "-l", "l.json", "-o", "a.png", err=anything)
    run.ffd("view", "a.obj", "-l", "l.json", "--rigid", "group:door", "-o", "b.png", err=anything)
    check(run.read("a.png") != run.read("b.png"), "the picture shows the rigid door")


main()
