"""What fits are for, on the sample models: a garment carried to another body, a deformation replayed on a level of detail, a
face pulled by handles. FFD_PICTURES names a folder for pictures of the results, to be looked at.
"""

import json
import math
import os
import random
import re
import shutil
import sys

from author import offsets_of
from harness import MODELS, UNSUPPORTED, case, check, equal, lattice, main, near, obj_vertices

if not MODELS:
    sys.exit(77)
SAMPLES = os.path.join(MODELS, "obj", "odedstein")


def read(*names):
    """The vertices and the faces of a sample model."""
    with open(os.path.join(SAMPLES, *names), encoding="ascii") as file:
        text = file.read()
    return obj_vertices(text), [[int(corner.split("/")[0]) - 1 for corner in line.split()[1:]] for line in text.splitlines() if line.startswith("f ")]


def obj(vertices, faces):
    return "".join("v %r %r %r\n" % tuple(v) for v in vertices) + "".join("f " + " ".join(str(c + 1) for c in face) + "\n" for face in faces)


def normals_of(vertices, faces):
    sums = [[0.0] * 3 for _ in vertices]
    for face in faces:
        a, b, c = (vertices[i] for i in face[:3])
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        for i in face:
            sums[i] = [s + n for s, n in zip(sums[i], normal)]
    return [[s / (math.hypot(*n) or 1) for s in n] for n in sums]


def picture(run, name, *arguments):
    """Draws it, into FFD_PICTURES if that is set."""
    run.ffd("view", *arguments, "-o", name + ".png", "--size", "500x500", "--color", "plain", "--force", "-q")
    check(run.read(name + ".png").startswith(b"\x89PNG"), name)
    if os.environ.get("FFD_PICTURES"):
        shutil.copy(run.path(name + ".png"), os.environ["FFD_PICTURES"])


def fit(run, *arguments):
    """The lattice, the report's figures and what is said."""
    done = run.ffd("fit", *arguments, "-o", "fitted.json", "--force", "--report", "r.json", err=lambda lines: None)
    return json.loads(run.text("fitted.json")), json.loads(run.text("r.json"))["jobs"][0]["fit"], done.err


def check_folds(run, told, said):
    """The lattice folds as the report says, and whoever reads only the lines knows."""
    run.ffd("check", "body.obj", "-l", "fitted.json", "--report", "c.json", "-q")
    found = json.loads(run.text("c.json"))["jobs"][0]["folds"]
    equal(told["folds"]["verdict"], found["verdict"])
    equal(any("folds" in line and "no folds" not in line for line in said), found["verdict"] != "none", said)


def deformed(run, source, *lattices):
    run.ffd("deform", source, "moved.obj", *[word for name in lattices for word in ("-l", name)], "--force", err=lambda lines: None)
    return obj_vertices(run.text("moved.obj"))


def write_two_lattices(run):
    """They twist a body of 1.72 along y, and make it fatter round the waist."""
    run.write("a.json", lattice((6, 6, 6), (-1, -0.1, -0.3), (1, 1.85, 0.3), [{"twist": {"axis": "y", "degrees": 25}}]))
    run.write("b.json", lattice((4, 6, 4), (-1.2, -0.1, -0.6), (1.2, 1.85, 0.6), [{"at": ["all", [2, 3], "all"], "scale": {"factor": [1.05, 1, 1.1]}}]))


@case
def a_garment_on_another_body(run):
    """The faces of the torso, 1 % of the height outside, on that body deformed by two lattices and noise: the gap stays within 20 %."""
    body, faces = read("human", "human_neutral.obj")
    height = max(v[1] for v in body) - min(v[1] for v in body)
    middles = [[sum(body[i][a] for i in face) / 3 for a in range(3)] for face in faces]
    torso = [face for face, (x, y, _) in zip(faces, middles) if abs(x) < 0.2 and 0.95 < y < 1.42]
    worn = sorted({i for face in torso for i in face})
    number, normals = {i: n for n, i in enumerate(worn)}, normals_of(body, faces)
    garment = [[p + 0.01 * height * n for p, n in zip(body[i], normals[i])] for i in worn]
    run.write("body.obj", obj(body, faces))
    run.write("shirt.obj", obj(garment, [[number[i] for i in face] for face in torso]))
    write_two_lattices(run)
    moved, noise = deformed(run, "body.obj", "a.json", "b.json"), random.Random(1)
    run.write("other.obj", obj([[x + noise.gauss(0, 0.0005 * height) for x in v] for v in moved], faces))
    _, told, said = fit(run, "body.obj", "other.obj", "--cover", "shirt.obj", "--size", "12")
    carried = deformed(run, "shirt.obj", "fitted.json")
    gaps = [math.dist(place, moved[i]) / (0.01 * height) for place, i in zip(carried, worn)]
    check(0.8 < min(gaps) and max(gaps) < 1.2, min(gaps), max(gaps))
    check(len(worn) > 500 and told["folds"]["verdict"] == "none", len(worn), told)
    check_folds(run, told, said)
    shirt = [[number[i] + len(body) for i in face] for face in torso]
    run.write("before.obj", obj(body + garment, faces + shirt))
    run.write("dressed.obj", obj(obj_vertices(run.text("other.obj")) + carried, faces + shirt))
    picture(run, "garment", "before.obj", "dressed.obj", "--frames", "2", "--camera", "0.4,0.2,1")


def clustered(vertices, faces, cell):
    """A level of detail: the vertices of each cell of a grid become their mean."""
    cells, sums = {}, []
    of = []
    for v in vertices:
        n = cells.setdefault(tuple(math.floor(x / cell) for x in v), len(cells))
        if n == len(sums):
            sums.append([0.0] * 4)
        sums[n] = [s + x for s, x in zip(sums[n], (*v, 1))]
        of.append(n)
    kept = {tuple(sorted(mapped)): mapped for face in faces if len(set(mapped := [of[i] for i in face])) == 3}
    return [[s / n for s in xyz] for *xyz, n in sums], list(kept.values())


@case
def a_deformation_replayed_on_a_level_of_detail(run):
    """What another program did to the fine mesh is done to a coarse one: near what that program would have done to it."""
    fine, faces = read("human", "human_neutral.obj")
    coarse, left = clustered(fine, faces, 0.04)
    check(500 < len(coarse) < len(fine) / 4, len(coarse))
    run.write("body.obj", obj(fine, faces))
    run.write("lod.obj", obj(coarse, left))
    write_two_lattices(run)
    run.write("after.obj", obj(deformed(run, "body.obj", "a.json", "b.json"), faces))
    truth, diagonal = deformed(run, "lod.obj", "a.json", "b.json"), 2.4
    last = math.inf
    for size, within in (("6", 5e-3), ("10", 5e-4), ("14", 2e-4)):
        _, told, said = fit(run, "body.obj", "after.obj", "--size", size)
        worst = max(math.dist(a, b) for a, b in zip(deformed(run, "lod.obj", "fitted.json"), truth))
        check(worst < within * diagonal and worst < last, size, worst)
        last = worst
        check_folds(run, told, said)
    picture(run, "lod", "lod.obj", "moved.obj", "--frames", "2", "--camera", "0.4,0.2,1")


@case
def instances_are_refused(run):
    """Those of a glTF's extension have no vertices in the scene; in the mesh's own space they are no matter."""
    path = os.path.join(MODELS, "gltf", "khronos", "SimpleInstancing", "glTF-Binary", "SimpleInstancing.glb")
    run.ffd("fit", path, path, "-o", "o.json", code=UNSUPPORTED, err=re.compile("EXT_mesh_gpu_instancing is not supported where the lattice reaches the instances"))
    check(not run.exists("o.json"))
    run.ffd("fit", path, path, "-o", "o.json", "--space", "mesh", err=re.compile("^fit: "))


HANDLES = ((0, 1.58, 0.15), (0.07, 1.6, 0.08), (-0.07, 1.6, 0.08), (0, 1.5, 0.12), (0, 1.7, 0.05))  # nose, cheeks, chin, brow


@case
def a_face_pulled_by_handles(run):
    """Five vertices reach their places. What no control point of theirs reaches keeps its bits."""
    body, faces = read("human", "human_neutral.obj")
    run.write("body.obj", obj(body, faces))
    picked = [min(range(len(body)), key=lambda i, at=at: math.dist(body[i], at)) for at in HANDLES]
    equal(len(set(picked)), 5)
    pulls = ((0, 0, 0.02), (0.01, 0, 0), (-0.01, 0, 0), (0, -0.01, 0.01), (0, 0.01, 0))
    for strength in (1, 4):  # the second one folds
        targets = [[x + strength * d for x, d in zip(body[i], pull)] for i, pull in zip(picked, pulls)]
        run.write("pairs.csv", "vertex,x,y,z,weight\n" + "".join("%d,%r,%r,%r,exact\n" % (i, *target) for i, target in zip(picked, targets)))
        found, told, said = fit(run, "body.obj", "--pairs", "pairs.csv", "--handles", "--size", "24,16,6", "--knots", "clamped")
        check_folds(run, told, said)
        equal(told["folds"]["verdict"] != "none", strength == 4, told)
        moved = deformed(run, "body.obj", "fitted.json")
        near([moved[i] for i in picked], targets, 1e-12)
        still = [any(offset) for offset in offsets_of(found)].count(False)
        check(told["points_without_data"] == still > 0, told["points_without_data"], still)
        if strength == 1:
            picture(run, "handles", "body.obj", "moved.obj", "--frames", "2", "--camera", "0.6,0.2,1")
            check_bits(run, found, body, moved)


def check_bits(run, found, body, moved):
    """The basis functions at a vertex, by the spans of clamped knots: it keeps its bits where all 64 control points do."""
    low, high = found["rest"]["box"]["min"], found["rest"]["box"]["max"]
    offsets, (nu, nv, nw) = offsets_of(found), found["size"]
    kept = 0
    for before, after in zip(body, moved):
        spans = [min(int((x - a) / (b - a) * (n - 3)), n - 4) for x, a, b, n in zip(before, low, high, (nu, nv, nw))]
        seen = [offsets[(k * nv + j) * nu + i] for k in range(spans[2], spans[2] + 4) for j in range(spans[1], spans[1] + 4)
                for i in range(spans[0], spans[0] + 4)]
        if not any(map(any, seen)):
            equal(after, before)
            kept += 1
    check(kept > len(body) / 4, kept)


main()
