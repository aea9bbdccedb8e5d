#!/usr/bin/env python3
"""Pages of ffd edit, opened as files in a browser: the calls of globalThis.ffdPage against formulas of our own, what the page shows
against what ffd deform makes of the text that it saves, figures against the report, unsaved changes, errors of the command, and
mouse, keys and names of controls.

    test_edit.py [firefox | large] [CASE ...]

Without a word: all cases in Chromium but that of a large mesh. FFD_NODE names the folder whose node_modules holds playwright-core.
FFD_SCREENSHOTS names a folder for pictures to be looked at.
"""

import atexit
import base64
import contextlib
import json
import math
import os
import re
import shutil
import struct
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path += [os.path.join(HERE, "..", "cli"), os.path.join(HERE, "..", "rig")]
# Neighbours of this folder:
from browser import Screen, find_browser  # noqa: E402
from bspline import BoxVolume  # noqa: E402
from edit_page import (Browser, centroid, edited, moved, plane_of, reflected, rows, same_offsets, scaled,  # noqa: E402
                       soft_weights, turned, wait_for)
from gltf_arm import arm, face  # noqa: E402
from harness import IO, USAGE, case, check, equal, main, near, npy, obj_vertices  # noqa: E402
from pose import Rig  # noqa: E402

KIND = sys.argv.pop(1) if sys.argv[1:2] in (["firefox"], ["large"]) else "chromium"
MODELS = os.path.join(HERE, "..", "..", "data", "models")
CLOSE = 2e-6  # of the mesh's diagonal


def case_of(kind):
    return case if kind == KIND else lambda function: function


HOME = tempfile.TemporaryDirectory(prefix="ffd-edit-home-")
BROWSER = Browser(find_browser(*(("firefox-esr", "firefox") if KIND == "firefox" else ())), HOME.name)
if KIND == "firefox":
    SCREEN = contextlib.ExitStack()
    SCREEN.enter_context(Screen())
    atexit.register(SCREEN.close)


# Meshes.

RADII, RINGS, SIDES = (1.0, 0.9, 1.1), 10, 14


def ball_points(center=(0, 0, 0)):
    """An ellipsoid: rings from south to north, and its two poles."""
    angles = [(math.pi * ring / RINGS, 2 * math.pi * side / SIDES) for ring in range(1, RINGS) for side in range(SIDES)]
    places = [(0, 0, -1)] + [(math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), -math.cos(a)) for a, b in angles] + [(0, 0, 1)]
    return [[c + r * x for c, r, x in zip(center, RADII, place)] for place in places]


def ball_faces():
    """Triangles and quadrangles of vertices from 0, rings from south to north."""
    def at(ring, side):
        return 1 + ring * SIDES + side % SIDES
    last = 1 + (RINGS - 1) * SIDES
    return ([[0, at(0, s + 1), at(0, s)] for s in range(SIDES)]
            + [[at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)] for r in range(RINGS - 2) for s in range(SIDES)]
            + [[at(RINGS - 2, s), at(RINGS - 2, s + 1), last] for s in range(SIDES)])


def ball(center=(0, 0, 0)):
    """As OBJ, its faces in the groups south and north."""
    faces = ["f " + " ".join(str(i + 1) for i in face) for face in ball_faces()]
    half = len(faces) // 2
    return "\n".join(["v %r %r %r" % tuple(p) for p in ball_points(center)] + ["g south"] + faces[:half] + ["g north"] + faces[half:] + [""])


def ball_gltf():
    """The ball under two nodes, one turned and smaller, so that a deformed file needs copies."""
    points = ball_points()
    triangles = [[f[0], f[i], f[i + 1]] for f in ball_faces() for i in range(1, len(f) - 1)]
    data = b"".join(struct.pack("<3f", *p) for p in points)
    indices = b"".join(struct.pack("<3H", *f) for f in triangles)
    low, high = ([struct.unpack("<f", struct.pack("<f", edge(c)))[0] for c in zip(*points)] for edge in (min, max))
    uri = "data:application/octet-stream;base64," + base64.b64encode(data + indices).decode()
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "name": "plain"},
                      {"mesh": 0, "name": "turned", "translation": [0.3, 0.2, -0.1], "rotation": [0, 0, 0.6, 0.8], "scale": [0.5, 0.75, 0.5]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": low, "max": high},
                          {"bufferView": 1, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}, {"buffer": 0, "byteOffset": len(data), "byteLength": len(indices)}],
            "buffers": [{"byteLength": len(data + indices), "uri": uri}]}


# Lattices. The box holds the ball and is symmetric about x = 0, and about nothing else.

LOW, HIGH = (-1.3, -1.2, -1.25), (1.3, 1.35, 1.2)
SIZE, DEGREE = (5, 4, 3), (3, 2, 1)
DIAGONAL = math.dist(LOW, HIGH)


def lattice(size=SIZE, low=LOW, high=HIGH, rest=None, **members):
    return {"format": "ffd-lattice", "version": 1, "size": list(size), "rest": rest or {"box": {"min": list(low), "max": list(high)}}, **members}


def rest_of(size=SIZE, degree=DEGREE):
    return BoxVolume(LOW, HIGH, lambda p: [0.0, 0.0, 0.0], size, degree).points


def wave(count, most):
    """Numbers between -most and most that differ."""
    return [most * math.sin(1.7 * i * i + 0.3 * i) for i in range(count)]


def index(i, j, k, size=SIZE):
    return i + size[0] * (j + size[1] * k)


def saved(page):
    """The text that Save writes, as JSON."""
    return json.loads(page.lattice())


def saved_offsets(content, rest=None):
    deformed = content.get("deformed", {})
    if "points" in deformed:
        return [[a - b for a, b in zip(*both)] for both in zip(deformed["points"], rest)]
    return deformed.get("offsets")


def edit(run, mesh, *words, **options):
    """Makes a page; warnings are allowed."""
    run.ffd("edit", mesh, *words, "-o", "page.html", "--force", err=lambda lines: None, **options)
    return run.path("page.html")


def quiet(run, *words, **options):
    return run.ffd(*words, "--force", "-q", **options)


@contextlib.contextmanager
def edited_ball(run, content=None, profile=None):
    run.write("ball.obj", ball())
    run.write("cage.json", content or lattice(degree=list(DEGREE)))
    with BROWSER.open(edit(run, "ball.obj", "-l", "cage.json"), profile) as page:
        yield page


# The calls. Each case has a page of its own, of the ball in the box.

@case_of("chromium")
def nothing_is_moved_at_first(run):
    with edited_ball(run) as page:
        equal(list(page.offsets()), [0.0] * 180, "offsets")
        equal(page.selection(), [], "the selection")
        equal(page.vertices().typecode + page.positions().typecode, "If", "Uint32Array and Float32Array")
        equal(list(page.vertices()), list(range(len(ball_points()))), "vertices")
        near(rows(page.positions()), ball_points(), 1e-6, "positions")
        figures = page.figures()
        equal(sorted(figures), ["flipped", "minDet", "moved", "torn"], "figures")
        equal([figures["flipped"], figures["torn"], figures["moved"]], [0, 0, 0], "figures")
        near([figures["minDet"]], [1], 1e-6, "det F at rest")
        for call in ("undo", "redo"):
            page.answer(call)
            equal(list(page.offsets()), [0.0] * 180, call)


@case_of("chromium")
def points_are_selected_added_and_removed(run):
    with edited_ball(run) as page:
        for indices, way, expected in (([7, 3], "set", [3, 7]), ([9, 3], "add", [3, 7, 9]), ([7, 8], "remove", [3, 9]),
                                       ([59], "set", [59]), ([], "add", [59]), ([], "set", [])):
            page.select(indices, way)
            equal(sorted(page.selection()), expected, f"after {way} {indices}")
        page.move([1, 0, 0])
        equal(set(page.offsets()), {0.0}, "a move without selected points")


@case_of("chromium")
def selected_points_move_turn_and_scale(run):
    """By one tool after the other, from where the one before has left them."""
    rest, offsets = rest_of(), [[0.0] * 3] * 60
    selected = [index(1, 1, 1), index(2, 1, 1), index(3, 2, 0), index(4, 3, 2)]
    with edited_ball(run) as page:
        page.select(selected, "set")
        steps = [("move", ([0.1, -0.2, 0.3],), lambda about: moved([0.1, -0.2, 0.3])),
                 ("rotate", ("z", 30), lambda about: turned("z", 30, about)),
                 ("rotate", ("x", -100, [0.1, 0.2, 0.3]), lambda about: turned("x", -100, [0.1, 0.2, 0.3])),
                 ("rotate", ([1, -2, 0.5], 45), lambda about: turned([1, -2, 0.5], 45, about)),
                 ("scale", (1.5,), lambda about: scaled(1.5, about)),
                 ("scale", ([2, 0.5, -1], [0.5, 0, 0]), lambda about: scaled([2, 0.5, -1], [0.5, 0, 0])),
                 ("rotate", ("y", 90), lambda about: turned("y", 90, about)),
                 ("scale", ([1, 1, 3],), lambda about: scaled([1, 1, 3], about))]
        for name, words, action in steps:
            getattr(page, name)(*words)
            offsets = edited(rest, offsets, selected, action(centroid(rest, offsets, selected)))
            same_offsets(page.offsets(), offsets, DIAGONAL, f"{name} {words}")
        near(sorted(page.selection()), sorted(selected), 0, "the selection stays")


@case_of("chromium")
def neighbours_follow_softly(run):
    """By the distance at rest to the nearest selected point, wherever the points have moved since."""
    rest, offsets = rest_of(), [[0.0] * 3] * 60
    with edited_ball(run) as page:
        for selected, radius, by in (([index(2, 1, 1)], 1.4, [0, 0.3, 0.1]), ([index(0, 0, 0), index(4, 3, 2)], 2.0, [-0.4, 0.1, 0]),
                                     ([index(1, 1, 0)], 0.01, [0.2, 0, 0]), ([index(3, 2, 1)], 10.0, [0, 0, 0.1]),
                                     ([index(3, 1, 1), index(2, 2, 2)], None, [0.1, 0.1, 0.1])):
            page.soft(radius)
            page.select(selected, "set")
            page.move(by)
            offsets = edited(rest, offsets, selected, moved(by), radius)
            same_offsets(page.offsets(), offsets, DIAGONAL, f"{selected} within {radius}")
        touched = sum(0 < w < 1 for w in soft_weights(rest, [rest[index(2, 1, 1)]], 1.4))
        check(touched > 5, f"the radius reaches {touched} neighbours")


@case_of("chromium")
def soft_scales_and_turns_go_part_of_the_way(run):
    """p + weight (action(p) - p), as a weight in a lattice file acts; a turn by default about the selected points alone."""
    rest, offsets, selected = rest_of(), [[0.0] * 3] * 60, [index(1, 1, 1), index(2, 2, 1)]
    with edited_ball(run) as page:
        page.select(selected, "set")
        page.soft(1.4)
        page.scale([1.5, 0.8, 2])
        offsets = edited(rest, offsets, selected, scaled([1.5, 0.8, 2], centroid(rest, offsets, selected)), 1.4)
        same_offsets(page.offsets(), offsets, DIAGONAL, "a soft scale")
        page.rotate("y", 50)
        offsets = edited(rest, offsets, selected, turned("y", 50, centroid(rest, offsets, selected)), 1.4)
        same_offsets(page.offsets(), offsets, DIAGONAL, "a soft turn")


@case_of("chromium")
def the_mirror_image_moves_too(run):
    """Points on one side of the plane, also softly, as far as their neighbours stay on that side; one step of undo."""
    rest, offsets = rest_of(), [[0.0] * 3] * 60
    # The layers of v stand unevenly in y: a plane that has the images of the second in the third.
    ys = sorted({p[1] for p in rest})
    middle = {"point": [5, (ys[1] + ys[2]) / 2, -7], "normal": [0, -3, 0]}
    steps = [("move", ([0.2, 0.1, -0.1],), moved([0.2, 0.1, -0.1]), [index(3, 1, 1), index(4, 2, 0)], None, {"axis": "x", "at": 0}),
             ("rotate", ("z", 25, [0.5, 0.1, 0]), turned("z", 25, [0.5, 0.1, 0]), [index(4, 1, 1)], None, {"axis": "x", "at": 0}),
             ("scale", ([1.4, 0.7, 1], [0.9, 0, 0]), scaled([1.4, 0.7, 1], [0.9, 0, 0]), [index(0, 3, 2)], None, {"axis": "x", "at": 0}),
             ("move", ([0.1, 0.2, 0],), moved([0.1, 0.2, 0]), [index(4, 1, 1)], 0.9, {"axis": "x", "at": 0}),
             ("move", ([0, 0.15, 0.1],), moved([0, 0.15, 0.1]), [index(0, 1, 1), index(3, 1, 0)], None, middle)]
    with edited_ball(run) as page:
        for name, words, action, selected, radius, mirror in steps:
            page.mirror(mirror)
            page.soft(radius)
            page.select(selected, "set")
            before = page.offsets().tobytes()
            getattr(page, name)(*words)
            offsets = edited(rest, offsets, selected, action, radius, mirror)
            same_offsets(page.offsets(), offsets, DIAGONAL, f"{name} {selected} across {mirror}")
            check(sum(map(any, offsets)) > len(selected), "there is an image")
            page.undo()
            equal(page.offsets().tobytes() == before, True, f"{name} {selected} is one step")
            page.redo()
        page.mirror(None)
        page.soft(None)
        page.select([index(4, 0, 0)], "set")
        page.move([1, 0, 0])
        same_offsets(page.offsets(), edited(rest, offsets, [index(4, 0, 0)], moved([1, 0, 0])), DIAGONAL, "without a mirror")


@case_of("chromium")
def a_mirrored_edit_is_symmetric(run):
    """Also where both images reach a point, or where one is on the plane: how far it then moves is not judged."""
    rest = rest_of()
    plane = plane_of({"axis": "x", "at": 0})
    images = [min(range(60), key=lambda j, p=reflected(p, plane): math.dist(rest[j], p)) for p in rest]
    with edited_ball(run) as page:
        page.mirror({"axis": "x", "at": 0})
        page.soft(2)
        for selected, by in (([index(2, 1, 1)], [0, 0.2, 0.1]), ([index(3, 1, 1)], [0.1, 0.2, 0])):
            page.select(selected, "set")
            page.move(by)
            offsets = rows(page.offsets())
            for i, j in enumerate(images):
                near(offsets[j], [-offsets[i][0], *offsets[i][1:]], 1e-9, f"points {i} and {j} after {selected}")
            check(offsets[selected[0]][1] > 0.19, "the selected point moves")


@case_of("chromium")
def steps_are_taken_back_to_the_bit(run):
    with edited_ball(run, lattice(degree=list(DEGREE), deformed={"offsets": rows(wave(180, 0.1))})) as page:
        states = [page.state()]
        steps = [lambda: page.move([0.1, 1 / 3, 1e-17]), lambda: page.rotate([1, 1, 0], 33), lambda: page.scale(1.1), page.reset]
        for step in steps:
            page.select([7, 21, 22], "set")
            page.soft(0.8)
            step()
            states.append(page.state())
            check(states[-1] != states[-2], "a step changes something")
        # What is no step is not taken back, and does not come between steps.
        page.soft(None)
        page.select([1], "set")
        for before in reversed(states[:-1]):
            page.undo()
            equal(page.state() == before, True, "undo, to the bit")
        for after in states[1:]:
            page.redo()
            equal(page.state() == after, True, "redo, to the bit")
        page.undo()
        page.select([5], "set")
        page.move([0, 0, 0.5])
        last = page.state()
        page.answer("redo")
        equal(page.state() == last, True, "redo after a new step changes nothing")


@case_of("chromium")
def points_go_back_to_rest(run):
    """The selected ones, or all; to exactly 0, in one step."""
    start = rows(wave(180, 0.1))
    with edited_ball(run, lattice(degree=list(DEGREE), deformed={"offsets": start})) as page:
        same_offsets(page.offsets(), start, 1e-6, "the file's offsets")
        page.select([3, 50], "set")
        page.reset()
        equal(rows(page.offsets()), [[0, 0, 0] if i in (3, 50) else d for i, d in enumerate(start)], "the selected ones")
        page.select([], "set")
        page.reset()
        equal(set(page.offsets()), {0.0}, "all")
        near(rows(page.positions()), ball_points(), 1e-6, "positions")
        page.undo()
        page.undo()
        equal(rows(page.offsets()), start, "two steps")


@case_of("chromium")
def strength_scales_the_whole_edit(run):
    """Offsets times s, deformed weights (1 - s) h + s q, as shown and as saved. No step."""
    h, q = [1 + abs(x) for x in wave(60, 1)], [1 + abs(x) for x in wave(60, 0.5)]
    start = rows(wave(180, 0.1))
    with edited_ball(run, lattice(degree=list(DEGREE), weights=h, deformed={"offsets": start, "weights": q})) as page:
        page.select([22], "set")
        page.move([0, 0.3, 0])
        full = page.state()
        expected = rows(page.offsets())
        for s in (0.5, 2, 0, 1.25):
            page.strength(s)
            same_offsets(page.offsets(), [[s * x for x in d] for d in expected], 1e-3, f"strength {s}")
            content = saved(page)
            weights = content.get("deformed", {}).get("weights") or content.get("weights")
            near(weights, [(1 - s) * a + s * b for a, b in zip(h, q)], 1e-12, f"weights of strength {s}")
            judge(run, page, "ball.obj")
        page.strength(1)
        equal(page.state() == full, True, "strength 1 again, to the bit")
        page.strength(0.5)
        page.undo()
        same_offsets(page.offsets(), [[0.5 * x for x in d] for d in start], 1e-3, "undo leaves the strength")


BROKEN = {
    "no JSON": "{\"format\": ", "nothing": "", "another value": "null", "a number": "3",
    "another format": json.dumps({**lattice(degree=list(DEGREE)), "format": "ffd-report"}),
    "a later version": json.dumps({**lattice(degree=list(DEGREE)), "version": 2}),
    "no size": json.dumps({key: value for key, value in lattice().items() if key != "size"}),
    "too few offsets": json.dumps(lattice(degree=list(DEGREE), deformed={"offsets": [[0, 0, 0]] * 59})),
    "an offset of two": json.dumps(lattice(degree=list(DEGREE), deformed={"offsets": [[0, 0, 0]] * 59 + [[0, 0]]})),
    "a text for a number": json.dumps(lattice(degree=list(DEGREE), deformed={"offsets": [[0, 0, 0]] * 59 + [[0, 0, "1"]]})),
    "no finite number": json.dumps(lattice(degree=list(DEGREE), deformed={"offsets": [[9, 9, 9]] * 60})).replace("9", "1e999", 1),
    "a weight of 0": json.dumps(lattice(degree=list(DEGREE), deformed={"weights": [1] * 59 + [0]})),
    "points and offsets": json.dumps(lattice(degree=list(DEGREE), deformed={"offsets": [[0, 0, 0]] * 60, "points": [[0, 0, 0]] * 60})),
    "an unknown key": json.dumps(lattice(degree=list(DEGREE), deformd={"offsets": [[0, 0, 0]] * 60})),
}


@case_of("chromium")
def a_saved_text_is_loaded_and_a_broken_one_refused(run):
    with edited_ball(run) as page:
        page.select([21, 22], "set")
        page.soft(1)
        page.move([0.1, 0.2, 1 / 3])
        page.rotate("x", 10)
        text, state = page.lattice(), page.state()
        for what, broken in BROKEN.items():
            check(page.refuses("load", broken), f"load takes {what}")
            equal(page.state() == state, True, f"after {what}")
            equal(sorted(page.selection()), [21, 22], f"the selection after {what}")
        page.undo()
        check(page.state() != state, "the steps are still there")
        page.select([], "set")
        page.reset()
        page.load(text)
        equal(page.state() == state, True, "what was saved, to the bit")
    with edited_ball(run) as page:
        page.load(text)
        equal(page.offsets().tobytes() == state[0], True, "in another page")


# What is saved against what is shown. A shape is a mesh, lattices of which the last is edited, and options.

class Shape:
    """words: options of edit, and of deform with what is saved. own: of edit alone. pick: the control points that are moved. then: a
    further check, before they are."""

    def __init__(self, mesh="ball.obj", *lattices, words=(), own=(), pick=None, then=lambda run, page, content: None):
        self.mesh, self.lattices, self.words, self.own, self.pick, self.then = mesh, lattices, list(words), list(own), pick, then


def write_mesh(run, name):
    made = {"ball.obj": ball, "far.obj": lambda: ball((1000, -500, 200)), "two.gltf": ball_gltf, "arm.gltf": arm,
            "face.gltf": lambda: face(("up", "wide"), [[0.25, 0.5], [0.75]])}
    if name in made:
        return run.write(name, made[name]())
    shutil.copy(os.path.join(MODELS, name), run.path(name))
    return name


def truth(run, mesh, lattices, words):
    """The positions that the program makes, in the order of embed: of OBJ those of deform, of glTF those of batch --positions, which
    are in the scene. With morph targets the ones that the output shows by its default weights."""
    given = [word for name in lattices for word in ("-l", name)]
    if mesh.endswith(".obj"):
        quiet(run, "deform", mesh, "out.obj", *given, *words)
        return obj_vertices(run.text("out.obj"))
    if mesh == "face.gltf":
        quiet(run, "deform", mesh, "out.gltf", *given, *words)
        return [list(p) for points in Rig(run.path("out.gltf")).vertices().values() for p in points]
    run.write("job.jsonl", json.dumps({"in": mesh, "lattice": list(lattices)}) + "\n")
    quiet(run, "batch", "job.jsonl", *words, "--positions", "all.npy", "--dtype", "f8")
    return rows(npy(run.read("all.npy"))[2])


def float_step(x):
    """The distance of numbers of single precision at x."""
    return 2.0 ** (math.frexp(x)[1] - 24) if x else 0.0


DIAGONALS = {}


def diagonal(run, mesh):
    """Of the mesh's bounds at rest."""
    if mesh not in DIAGONALS:
        bounds = run.ffd("info", mesh, "--json", err=lambda lines: None).json["bounds"]
        DIAGONALS[mesh] = math.dist(bounds["min"], bounds["max"])
    return DIAGONALS[mesh]


def same_positions(page, expected, size, what):
    """Of the vertices shown, to CLOSE of a size and the rounding to single precision. Returns whether these are all."""
    vertices, found = list(page.vertices()), rows(page.positions())
    equal(len(found), len(vertices), f"{what}: vertices and positions")
    check(vertices == sorted(set(vertices)) and vertices[-1] < len(expected), f"{what}: the order of vertices")
    for p, vertex in zip(found, vertices):
        for x, y in zip(p, expected[vertex]):
            check(abs(x - y) <= CLOSE * size + float_step(y), f"{what}: vertex {vertex} is at {p} instead of {expected[vertex]}")
    return len(vertices) == len(expected)


def judge(run, page, mesh, before=(), words=()):
    """The text that the page saves makes what the page shows, and the figures are the report's. Returns the text as JSON.

    words: options of deform and of edit."""
    run.write("saved.json", page.lattice())
    content = saved(page)
    lattices = [*before, "saved.json"]
    whole = same_positions(page, truth(run, mesh, lattices, words), diagonal(run, mesh), "what is saved")
    given = [word for name in lattices for word in ("-l", name)]
    report = quiet(run, "check", mesh, *given, *words, "--report", "-").json["jobs"][0]
    figures = page.figures()
    if whole:
        equal({key: figures[key] for key in ("flipped", "torn", "moved")},
              {"flipped": report["flipped_faces"], "torn": report["tear"]["edges"], "moved": report["moved"]}, "figures")
    return content


def shape_case(run, shape):
    write_mesh(run, shape.mesh)
    for name, content in shape.lattices:
        run.write(name, content)
    before = [name for name, _ in shape.lattices[:-1]]
    given = [word for name, _ in shape.lattices for word in ("-l", name)]
    with BROWSER.open(edit(run, shape.mesh, *given, *shape.own, *shape.words)) as page:
        content = judge(run, page, shape.mesh, before, shape.words)
        shape.then(run, page, content)
        count = len(page.offsets()) // 3
        pick = shape.pick or range(0, count, 3)
        page.select(list(pick), "set")
        size = math.dist(*([edge(c) for c in zip(*rows(page.positions()))] for edge in (min, max)))
        page.move([0.03 * size, -0.05 * size, 0.02 * size])
        page.rotate("z", 8)
        page.scale([1.05, 0.9, 1.1])
        content = judge(run, page, shape.mesh, before, shape.words)
        if "offsets" in content.get("deformed", {}):
            equal(rows(page.offsets()), saved_offsets(content), "offsets() are the numbers of the text")
        page.strength(0.6)
        judge(run, page, shape.mesh, before, shape.words)


def is_new(run, page, content):
    """Without -l the lattice is that of lattice new."""
    equal(content["size"], [4, 4, 4], "the size")
    page.select([21, 42], "set")
    page.move([0.1, 0.2, 0.3])
    run.ffd("lattice", "new", "ball.obj", "-o", "new.json", "--force", "-q")
    fresh = json.loads(run.text("new.json"))
    run.write("new.json", {**fresh, "deformed": {"offsets": rows(page.offsets())}})
    same_positions(page, truth(run, "ball.obj", ["new.json"], []), diagonal(run, "ball.obj"), "lattice new")


def is_by_options(run, page, content):
    words = ["--size", "5,4,3", "--degree", "3,2,1", "--knots", "clamped,open,clamped", "--margin", "0.2"]
    equal([content["size"], content["degree"]], [[5, 4, 3], [3, 2, 1]], "size and degree")
    page.select([21, 33], "set")
    page.move([0.1, 0.2, 0.3])
    run.ffd("lattice", "new", "ball.obj", *words, "-o", "new.json", "--force", "-q")
    run.write("new.json", {**json.loads(run.text("new.json")), "deformed": {"offsets": rows(page.offsets())}})
    same_positions(page, truth(run, "ball.obj", ["new.json"], []), diagonal(run, "ball.obj"), "lattice new")


def keeps_words(run, page, content):
    equal([content.get("name"), content.get("comment")], ["Käfig </script> \u202e", "first\nsecond"], "name and comment")


def is_baked(run, page, content):
    """The two moves are in the offsets, and in no text twice."""
    check(not content.get("moves"), f"moves are saved: {content.get('moves')}")
    rest = rest_of((4, 4, 4), (3, 3, 3))
    expected = [[0.0, 0.1, 0.2] if i % 4 == 3 else [0.0, 0.0, 0.0] for i in range(64)]
    expected = edited(rest, expected, [63], moved([0.5, 0, 0]))
    same_offsets(page.offsets(), expected, DIAGONAL, "moves")


def is_still(run, page, content):
    """Keys at 1.5 of 1 to 2: the middle. What is saved is a lattice without keys."""
    check("keys" not in content, "keys are saved")
    same_offsets(page.offsets(), [[0.0, 0.15, 0.0] if i == 21 else [0.0] * 3 for i in range(64)], DIAGONAL, "the still")


def ring_of(r0, angle, **members):
    rest = {"cylinder": {"center": [0, 0, 0], "axis": "z", "radius": [r0, 1.4], "height": 2.6, "angle": angle}}
    return lattice([3, 7, 4], rest=rest, degree=[2, 3, 3], **members)


BENT = [[x + 0.15 * y * z, y + 0.1 * x * x, z + 0.1 * x * y] for x, y, z in rest_of((4, 4, 4), (3, 3, 3))]
WEIGHTS = [1 + 0.6 * math.sin(2.3 * i) for i in range(64)]
KEYS = [{"time": t, "moves": [{"at": [1, 1, 1], "by": [0, y, 0]}]} for t, y in ((1, 0), (2, 0.3))]
MOVES = [{"at": [3, "all", "all"], "by": [0, 0.1, {"$": "LIFT"}]}, {"at": [-1, -1, -1], "by": [0.5, 0, 0]}]
HALF = {"low": (-2, -2, -2), "high": (0.35, 2, 2)}
FIRST = ("first.json", lattice((4, 4, 4), (-1.5, -1.5, -1.5), (1.5, 1.5, 1.5), deformed={"offsets": rows(wave(192, 0.15))}))
WIDE = ("wide.json", lattice((4, 4, 4), (-3, -3, -3), (3, 3, 3)))

SHAPES = {
    "a_new_lattice_of_4_4_4": Shape(then=is_new),
    "a_new_lattice_by_options": Shape(own=["--size", "5,4,3", "--degree", "3,2,1", "--knots", "clamped,open,clamped", "--margin", "0.2"],
                                      then=is_by_options),
    "names_and_comments": Shape("ball.obj", ("l.json", lattice(name="Käfig </script> \u202e", comment="first\nsecond")), then=keeps_words),
    "clamped_knots": Shape("ball.obj", ("l.json", lattice((6, 4, 5), degree=[3, 3, 2], deformed={"offsets": rows(wave(360, 0.1))}))),
    "open_knots": Shape("ball.obj", ("l.json", lattice((5, 6, 4), knots=["open"] * 3))),
    "uniform_knots": Shape("ball.obj", ("l.json", lattice((5, 6, 7), knots=["uniform"] * 3))),
    "knots_of_any_range": Shape("ball.obj", ("l.json", lattice((5, 4, 4), knots=[[-3, -3, -2, -1, 5, 7, 7, 8, 11], "clamped", "open"]))),
    "evenly_spaced_points": Shape("ball.obj", ("l.json", lattice((6, 5, 4), rest={"box": {"min": LOW, "max": HIGH, "spacing": "uniform"}}))),
    "a_turned_box": Shape("ball.obj", ("l.json", lattice((4, 4, 4), rest={
        "box": {"min": [-1.6] * 3, "max": [1.6] * 3, "axes": [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]}}))),
    "bent_points": Shape("ball.obj", ("l.json", lattice((4, 4, 4), rest={"points": BENT}))),
    "a_closed_cylinder": Shape("ball.obj", ("l.json", ring_of(0, [0, 360])), pick=range(2, 84, 6)),
    "part_of_a_ring": Shape("ball.obj", ("l.json", ring_of(0.2, [30, 280]))),
    "weights": Shape("ball.obj", ("l.json", lattice((4, 4, 4), weights=WEIGHTS))),
    "deformed_weights": Shape("ball.obj", ("l.json", lattice((4, 4, 4), weights=WEIGHTS, deformed={
        "weights": WEIGHTS[::-1], "offsets": rows(wave(192, 0.05))}))),
    "weights_that_begin_deformed": Shape("ball.obj", ("l.json", lattice((4, 4, 4), deformed={"weights": WEIGHTS}))),
    "deformed_points": Shape("ball.obj", ("l.json", lattice((4, 4, 4), deformed={"points": BENT}))),
    **{f"degree_{d}": Shape("ball.obj", ("l.json", lattice((d + 1, d + 2, d + 3), degree=[d] * 3))) for d in range(1, 6)},
    "degree_14": Shape("ball.obj", ("l.json", lattice((15, 3, 4), degree=[14, 2, 3]))),
    "moves_are_baked": Shape("ball.obj", ("l.json", lattice((4, 4, 4), moves=MOVES)), own=["--set", "LIFT=0.2"], then=is_baked),
    "a_still_of_keys": Shape("ball.obj", ("l.json", lattice((4, 4, 4), keys=KEYS)), own=["--time", "1.5"], then=is_still),
    "the_last_of_two": Shape("ball.obj", FIRST, ("l.json", lattice((4, 5, 4)))),
    "outside_stays": Shape("ball.obj", ("l.json", lattice((4, 4, 4), **HALF))),
    "outside_follows": Shape("ball.obj", ("l.json", lattice((4, 4, 4), **HALF)), words=["--outside", "extend"]),
    "outside_fades": Shape("ball.obj", ("l.json", lattice((4, 4, 4), **HALF)), words=["--outside", "extend", "--falloff", "0.5"]),
    "snapped_vertices": Shape("ball.obj", ("l.json", lattice((4, 4, 4), **HALF)), words=["--snap", "0.2"]),
    "only_a_group": Shape("ball.obj", ("l.json", lattice((4, 4, 4))), words=["--only", "group:north"]),
    "far_from_the_origin": Shape("far.obj"),
    "nodes_that_share_a_mesh": Shape("two.gltf", ("l.json", lattice((4, 4, 4)))),
    "the_space_of_the_mesh": Shape("two.gltf", ("l.json", lattice((4, 4, 4))), words=["--space", "mesh"]),
    "only_a_node": Shape("two.gltf", ("l.json", lattice((4, 4, 4))), words=["--only", "node:turned"]),
    "a_skin": Shape("arm.gltf", WIDE),
    "a_real_skin": Shape("knight.glb"),
    "morph_targets_at_their_weights": Shape("face.gltf", WIDE),
}


def add_shape(name, shape):
    def shown_as_saved(run):
        shape_case(run, shape)
    shown_as_saved.__name__ = name
    case_of("chromium")(shown_as_saved)


for each_name, each_shape in SHAPES.items():
    add_shape(each_name, each_shape)


@case_of("large")
def a_large_mesh_is_shown_in_part(run):
    """Beyond the 200,000 vertices of view: those that are shown are where deform has them; with --full all are shown."""
    side = 460
    grid = ["v %r %r %r" % (i / side, j / side, 0.1 * math.sin(9 * i / side) * math.cos(7 * j / side)) for j in range(side) for i in range(side)]
    cells = [f"f {a} {a + 1} {a + side + 1} {a + side}" for j in range(side - 1) for a in range(j * side + 1, (j + 1) * side)]
    run.write("grid.obj", "\n".join(grid + cells + [""]))
    for words, expected in (((), False), (("--full",), True)):
        with BROWSER.open(edit(run, "grid.obj", *words)) as page:
            page.select([21, 22], "set")
            page.move([0.1, 0.1, 0.4])
            run.write("saved.json", page.lattice())
            whole = same_positions(page, truth(run, "grid.obj", ["saved.json"], []), diagonal(run, "grid.obj"), f"a large mesh {words}")
            equal(whole, expected, f"{words}: all vertices are shown")


# Figures.

def least_det(content, offsets):
    """det F by the definition, at the ball's vertices; 1 at those outside of the box, which stay."""
    box, degree = content["rest"]["box"], content.get("degree", [3, 3, 3])
    volume = BoxVolume(box["min"], box["max"], lambda p: [0, 0, 0], content["size"], degree)
    volume.offsets = offsets
    dets = []
    for p in ball_points():
        m = volume.gradient(p)
        dets.append(m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8])
                    + m[2] * (m[4] * m[9] - m[5] * m[8]) if volume.holds(p) else 1.0)
    return min(dets)


FOLDING = {
    "a_fold": (lattice((4, 4, 4)), [21, 22], [[0, 0, 14], [0, 0, -12]]),
    "a_tear": (lattice((3, 3, 3), degree=[2, 2, 2], **HALF), [14, 23], [[0.3, 0.2, 0]]),
    "a_squeeze": (lattice(degree=list(DEGREE)), [index(i, j, 1) for i in range(5) for j in range(4)], [[0, 0, 0.9]]),
    "a_fold_and_a_tear": (lattice((4, 4, 4), **HALF), [21, 22, 23, 43], [[-9, 0.4, 0.1]]),
}


@case_of("chromium")
def figures_are_those_of_the_report(run):
    """flipped, torn and moved as the program counts them; minDet is the least det F at the vertices by our own formula. They follow
    every step, also back."""
    for name, (content, selected, ways) in FOLDING.items():
        with edited_ball(run, content) as page:
            for by in ways:
                page.select(selected, "set")
                page.move(by)
                judge(run, page, "ball.obj")
                figures = page.figures()
                expected = least_det(content, rows(page.offsets()))
                near([figures["minDet"]], [expected], 1e-5 * max(1, abs(expected)), f"{name}: minDet")
                if "fold" in name:
                    check(by != ways[0] or (figures["flipped"] > 0 and figures["minDet"] < 0), f"{name} folds: {figures}")
                if "tear" in name:
                    check(figures["torn"] > 0, f"{name} tears: {figures}")
            for _ in ways:
                page.undo()
            figures = page.figures()
            equal([figures["flipped"], figures["torn"], figures["moved"]], [0, 0, 0], f"{name} taken back")
            near([figures["minDet"]], [1], 1e-6, f"{name} taken back")


# Unsaved changes.

OFFER = "unsaved|restore"


def offers(page):
    return bool(re.search(OFFER, page.do("text"), re.I)) and page.do("has", pattern=OFFER)


@case_of("chromium")
def unsaved_changes_are_offered_and_restored(run):
    with edited_ball(run, profile="one") as page:
        check(not offers(page), "a page that nothing was done in offers changes")
        page.select([21], "set")
        page.move([0.1, 0.2, 1 / 3])
        page.rotate("y", 10, [0, 0, 0])
        offsets = page.offsets().tobytes()
        time.sleep(1.5)
    run.write("far.obj", ball((9, 0, 0)))
    run.ffd("edit", "far.obj", "-o", "other.html", err=lambda lines: None)
    with BROWSER.open(run.path("other.html"), "one") as page:
        check(not offers(page), "the page of another mesh offers them")
    with BROWSER.open(run.path("page.html"), "two") as page:
        check(not offers(page), "another profile has them")
    with BROWSER.open(run.path("page.html"), "one") as page:
        wait_for(lambda: offers(page), "changes are offered with the word unsaved or restore")
        page.do("click", pattern="restore" if page.do("has", pattern="restore") else OFFER)
        wait_for(lambda: page.offsets().tobytes() == offsets, "the changes are restored, to the bit")
        wait_for(lambda: not offers(page), "the offer goes away")


# Errors of the command.

@case_of("chromium")
def wrong_words_are_refused(run):
    run.write("ball.obj", ball())
    run.write("l.json", lattice())
    for words in (["-l", "l.json", "--size", "4,4,4", "-o", "a.html"], ["-l", "l.json", "-o", "a.htm"], ["-l", "l.json", "-o", "a.png"],
                  ["-o", "a"], [], ["-o", "a.html", "--outside", "away"], ["-o", "a.html", "--up", "w"], ["-o", "a.html", "--size", "4,4"],
                  ["-o", "a.html", "--camera", "front"], ["-o", "a.html", "--time", "1"]):
        run.ffd("edit", "ball.obj", *words, code=USAGE)
        equal(run.names(), ["ball.obj", "l.json"], f"files after {words}")
    run.ffd("edit", "gone.obj", "-o", "a.html", code=IO)
    run.write("broken.json", {**lattice(), "moved": []})
    run.ffd("edit", "ball.obj", "-l", "broken.json", "-o", "a.html", code=4)
    check(not run.exists("a.html"), "a page of a failure")


@case_of("chromium")
def a_page_that_exists_stays(run):
    """Without --force, and where the run fails."""
    run.write("ball.obj", ball())
    run.write("a.html", "kept")
    run.ffd("edit", "ball.obj", "-o", "a.html", code=IO)
    run.ffd("edit", "gone.obj", "-o", "a.html", "--force", code=IO)
    equal(run.text("a.html"), "kept", "the page")
    equal(run.names(), ["a.html", "ball.obj"], "files")
    run.ffd("edit", "ball.obj", "-o", "a.html", "--force", err=lambda lines: None)
    check(run.text("a.html").lstrip().lower().startswith("<!doctype html"), "the page is replaced")
    first = run.read("a.html")
    run.ffd("edit", "ball.obj", "-o", "b.html", err=lambda lines: None)
    equal(run.read("b.html") == first, True, "the same page again, byte for byte")


# By hand. What follows knows the page only by names of controls, by keys and by what people try first: adapt it here.

SAVE, UNDO, REDO = r"^save\b", r"^undo\b", r"^redo\b"
UNDO_KEYS, REDO_KEYS = "Control+z", ("Control+y", "Control+Shift+Z")
# A tool (its name), and keys that are held while the pointer draws a box. The first way that selects several points counts.
BOXES = ((None, ["Shift"]), (None, []), (None, ["Control"]), (None, ["Alt"]), (r"box|select", []))


@contextlib.contextmanager
def page_by_hand(run):
    run.write("ball.obj", ball())
    with BROWSER.open(edit(run, "ball.obj"), width=1000, height=720) as page:
        yield page


def find_point(page):
    """Clicks here and there, from the canvas's middle outwards, until one control point is selected. Returns place and index."""
    x, y, width, height = page.do("canvas")
    for step in range(600):
        far, angle = 0.45 * min(width, height) * math.sqrt(step / 600), 2.399963 * step
        place = [x + width / 2 + far * math.cos(angle), y + height / 2 + far * math.sin(angle)]
        page.do("drag", places=[place, place], keys=[])
        selected = page.selection()
        if len(selected) == 1:
            return place, selected[0]
    check(False, "no click selects a control point")
    return None


@case_of("chromium")
def a_pointer_drags_a_point(run):
    with page_by_hand(run) as page:
        place, point = find_point(page)
        equal(set(page.offsets()), {0.0}, "clicks move nothing")
        page.soft(None)
        page.do("drag", places=[place, [place[0] + 50, place[1] - 30]], keys=[])
        wait_for(lambda: any(page.offsets()), "the drag moves something")
        offsets = rows(page.offsets())
        equal([i for i, d in enumerate(offsets) if any(d)], [point], "the points that have moved")
        judge(run, page, "ball.obj")
        after = page.offsets().tobytes()
        page.do("click", pattern=UNDO)
        wait_for(lambda: not any(page.offsets()), "the button Undo takes the drag back in one step")
        page.do("click", pattern=REDO)
        wait_for(lambda: page.offsets().tobytes() == after, "the button Redo")


@case_of("chromium")
def a_finger_drags_a_point(run):
    with page_by_hand(run) as page:
        place, point = find_point(page)
        page.soft(None)
        page.select([], "set")
        beside = [place[0] + 10, place[1] + 8]  # a finger is not so exact as a mouse
        page.do("fingers", paths=[[beside, [beside[0] + 25, beside[1] - 15], [beside[0] + 50, beside[1] - 30]]])
        wait_for(lambda: any(page.offsets()), "the finger moves something")
        equal([i for i, d in enumerate(rows(page.offsets())) if any(d)], [point], "the points that have moved")
        judge(run, page, "ball.obj")
        offsets = page.offsets().tobytes()
        x, y, width, height = page.do("canvas")
        middle = [x + width / 2, y + height / 2]
        apart = [[[middle[0] + side * far, middle[1]] for far in (40, 80, 120)] for side in (-1, 1)]
        page.do("fingers", paths=apart)
        page.do("click", pattern=UNDO)
        wait_for(lambda: not any(page.offsets()), "two fingers move the camera, and make no step to undo")
        page.do("click", pattern=REDO)
        wait_for(lambda: page.offsets().tobytes() == offsets, "the edit again")


@case_of("chromium")
def a_box_selects_points(run):
    with page_by_hand(run) as page:
        x, y, width, height = page.do("canvas")
        corners = [[x + 0.08 * width, y + 0.08 * height], [x + 0.92 * width, y + 0.92 * height]]
        for tool, keys in BOXES:
            page.select([], "set")
            if tool and page.do("has", pattern=tool):
                page.do("click", pattern=tool)
            page.do("drag", places=corners, keys=keys)
            if len(page.selection()) > 1:
                break
        check(len(page.selection()) > 1, "no box selects points")
        equal(set(page.offsets()), {0.0}, "a box moves nothing")


@case_of("chromium")
def keys_take_steps_back(run):
    with page_by_hand(run) as page:
        page.select([21], "set")
        page.move([0.1, 0, 0])
        after = page.offsets().tobytes()
        page.do("press", keys=UNDO_KEYS)
        wait_for(lambda: not any(page.offsets()), f"{UNDO_KEYS} takes a step back")
        for keys in REDO_KEYS:
            page.do("press", keys=keys)
            if any(page.offsets()):
                break
        equal(page.offsets().tobytes() == after, True, f"{REDO_KEYS} do it again")


@case_of("chromium")
def save_gives_a_lattice_file(run):
    """The text of ffdPage.lattice(), under a name that ends with .json."""
    with page_by_hand(run) as page:
        page.select([21, 22], "set")
        page.move([0.1, 0.2, 0.3])
        file = page.do("download", pattern=SAVE)
        check(file["name"].endswith(".json"), f"the file is called {file['name']}")
        equal(file["text"], page.lattice(), "the file")
        judge(run, page, "ball.obj")


@case_of("firefox")
def firefox_moves_a_point(run):
    rest = rest_of()
    with edited_ball(run) as page:
        page.select([21], "set")
        page.soft(1)
        page.move([0.1, 0.2, 0.3])
        same_offsets(page.offsets(), edited(rest, [[0.0] * 3] * 60, [21], moved([0.1, 0.2, 0.3]), 1), DIAGONAL, "a soft move")
        judge(run, page, "ball.obj")
        page.undo()
        equal(set(page.offsets()), {0.0}, "undo")
    with page_by_hand(run) as page:
        place, point = find_point(page)
        page.do("drag", places=[place, [place[0] + 50, place[1] - 30]], keys=[])
        wait_for(lambda: any(rows(page.offsets())[point]), "the drag moves the point")


main()
