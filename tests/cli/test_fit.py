#!/usr/bin/env python3
"""ffd fit: the lattice that carries points where they are wanted. authoring/fit-*.json and handle-*.json hold right answers, solved
with 40 digits."""

import itertools
import json
import math
import os
import random
import re
import signal
import struct
import subprocess
import time

from author import array, broken, offsets_of, reference_cases
from harness import (EMBEDDING, FFD, INVALID, IO, LIMIT, NO, OK, SANITIZED, SECONDS, UNSUPPORTED, USAGE, case, carried, check, equal, lattice, main, near, on_terminal, repetitions)

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")

SIDES = 12  # of the sphere


def sphere():
    """Vertices and quads of a sphere, with poles of many vertices each."""
    vertices = []
    for i in range(SIDES + 1):
        for j in range(2 * SIDES):
            t, p = math.pi * i / SIDES, math.pi * j / SIDES
            vertices.append((math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)))
    faces = []
    for i in range(SIDES):
        for j in range(2 * SIDES):
            a, b = 2 * SIDES * i + j, 2 * SIDES * i + (j + 1) % (2 * SIDES)
            faces.append((a, b, b + 2 * SIDES, a + 2 * SIDES))
    return vertices, faces


VERTICES, FACES = sphere()


def obj(vertices, faces=FACES):
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join(
        "f " + " ".join(str(c + 1) for c in face) + "\n" for face in faces)


def bent(x, y, z):
    return x * 1.25 + 0.25 * z * z, y + 0.125 * x, z + 0.125 * math.sin(2 * x)


def write_meshes(run):
    run.write("a.obj", obj(VERTICES))
    run.write("b.obj", obj([bent(*p) for p in VERTICES]))


def pairs(rows, header="px,py,pz,x,y,z,weight"):
    return header + "\n" + "".join(",".join(x if isinstance(x, str) else repr(x) for x in row) + "\n" for row in rows)


def fit(run, *arguments, target="o.json", code=OK, **more):
    """Runs it quietly, and returns the lattice and the member `fit` of the report."""
    run.remove(target)
    run.ffd("fit", *arguments, "-o", target, "-q", "--report", "report.json", code=code, **more)
    report = json.loads(run.text("report.json"))["jobs"][0]
    equal(report["exit"], code)
    return json.loads(run.text(target)) if code == OK else None, report["fit"]


def refused(run, *arguments, code, says, target="refused.json"):
    """One line, and nothing is written."""
    run.ffd("fit", *arguments, "-o", target, code=code, err=re.compile(says))
    check(not run.exists(target), f"{arguments}: {target} is there")


@case
def the_reference_cases(run):
    names = 0
    for name, of in itertools.chain(reference_cases("fit"), reference_cases("handle")):
        names += 1
        expect = of["expect"]
        run.write("base.json", of["base"])
        run.write("pairs.csv", pairs(b + a + [w] for b, a, w in zip(of["before"], of["after"], of["weight"])))
        handles = ["--handles"] if "--handles" in of["command"] else []
        found, told = fit(run, "--pairs", "pairs.csv", *handles, "-l", "base.json", "--smooth", str(of["smooth"]))
        near(offsets_of(found), expect["offsets"], expect["tolerance"], name)
        near(told["affine"], expect["affine"], 1e-13, name)
        near([told["residual"]["max"], told["residual"]["rms"]], [expect["residual"]["max"], expect["residual"]["rms"]], 1e-12, name)
        exact = of["weight"].count("exact")
        equal([told["exact"], told["residual_exact"] is None, told["smooth_chosen_by"]], [exact, exact == 0, "given"], name)
        check(exact == 0 or told["residual_exact"] <= expect["exact_residual"], name, told)
    equal(names, 5)


@case
def a_mesh_carried_onto_another(run):
    write_meshes(run)
    run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", err=re.compile(
        r"^fit: 312 pairs, residual rms \S+ max \S+ \(vertex \d+\), smooth 0\.01 \(gcv\), no folds$"))
    found, told = fit(run, "a.obj", "b.obj")
    equal([found["size"], found["degree"], found["knots"], found["moves"]], [[6, 6, 6], [3, 3, 3], ["open"] * 3, []])
    equal([told[k] for k in ("pairs", "used", "outside", "multiple", "singular", "exact", "dependent", "downweighted", "residual_exact")],
          [312, 312, 0, 0, 0, 0, 0, None, None])
    equal(told["smooth_chosen_by"], "gcv")
    check(told["gcv"] > 0 and told["folds"]["verdict"] == "none" and told["flops"] > 0, told)
    moved = carried(run, VERTICES, "o.json")
    off = [math.dist(p, bent(*q)) for p, q in zip(moved, VERTICES)]
    check(max(off) < 2e-3, max(off))
    near([told["residual"]["max"], told["residual"]["rms"]], [max(off), math.sqrt(sum(d * d for d in off) / len(off))], 1e-12)
    near([off[told["residual"]["worst"]], sorted(off)[math.ceil(0.95 * len(off)) - 1]], [max(off), told["residual"]["p95"]], 1e-12)
    near([told["largest_offset"]], [max(math.hypot(*d) for d in offsets_of(found))], 1e-15)


@case
def all_threads_and_instructions_give_the_same(run):
    write_meshes(run)
    texts = set()
    for options in (["-j1"], ["-j2"], ["-j3", "--isa", "scalar"], ["-j1", "--isa", "scalar"]):
        run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", "--force", "-q", "--size", "9", "--robust", *options)
        texts.add(run.text("o.json"))
    equal(len(texts), 1)


@case
def arrays_and_streams(run):
    write_meshes(run)
    targets = [c for p in VERTICES for c in bent(*p)]
    run.write("b.npy", array(targets, "(312, 3)"))
    from_mesh, _ = fit(run, "a.obj", "b.obj", "--smooth", "0.1")
    from_array, _ = fit(run, "a.obj", "b.npy", "--smooth", "0.1")
    equal(from_array, from_mesh)
    written = run.ffd("fit", "-", "b.npy", "--input-format", "obj", "--smooth", "0.1", "-o", "-", "-q", stdin=obj(VERTICES).encode())
    equal(written.json, from_mesh)
    table = pairs([["100", "0.0", "0.0", "2.0", "exact"]], "vertex,x,y,z,weight").encode()
    written = run.ffd("fit", "a.obj", "--pairs", "-", "--handles", "-o", "-", "-q", stdin=table)
    check(any(any(d) for d in offsets_of(written.json)))


@case
def places_of_no_mesh(run):
    """BEFORE as an array has no faces: all weigh the same."""
    write_meshes(run)
    run.write("a.npy", array([c for p in VERTICES for c in p], "(312, 3)"))
    run.write("b.npy", array([c for p in VERTICES for c in bent(*p)], "(312, 3)"))
    run.write("w.npy", array([1.0 + i % 3 for i in range(312)], "(312,)"))
    run.write("t.csv", pairs([["100", "0.0", "0.0", "2.0"], ["7", "1.0", "0.0", "0.0"]], "vertex,x,y,z"))
    for after in (["b.npy"], ["b.obj"], ["b.npy", "--weights", "w.npy"], ["--pairs", "t.csv", "--handles"]):
        uniform = [] if "w.npy" in after or "t.csv" in after else ["--weights", "uniform"]
        of_mesh, told = fit(run, "a.obj", *after, *uniform, "--smooth", "0.1")
        equal(fit(run, "a.npy", *after, "--smooth", "0.1"), (of_mesh, told), after)
    for option in (["--only", "object:x"], ["--space", "mesh"]):
        refused(run, "a.npy", "b.npy", *option, code=USAGE, says=f"{option[0]}.*a.npy|{option[0]}.*an array")
    run.ffd("fit", "a.npy", "b.npy", "-o", "a.npy", "--force", code=IO, err="a.npy: is an input of this command")
    refused(run, "b.npy", "fewer.npy", code=IO, says="fewer.npy")
    run.write("none.npy", array([], "(0, 3)"))
    refused(run, "none.npy", "none.npy", code=INVALID, says="^none.npy: there are no places$")
    run.write("wide.npy", array([0.0] * 8, "(2, 4)"))
    refused(run, "wide.npy", "b.npy", code=INVALID, says=r"^wide.npy: has the shape \(2, 4\), but places need \(N, 3\)$")
    run.write("nan.npy", array([math.nan] * 3, "(1, 3)"))
    refused(run, "nan.npy", "b.npy", code=INVALID, says="^nan.npy: vertex 0 has a coordinate that is not finite$")


@case
def what_exists_is_kept(run):
    write_meshes(run)
    run.write("o.json", "mine")
    run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", code=IO, err=re.compile("exists already"))
    equal(run.text("o.json"), "mine")
    run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", "--force", "-q")
    check(json.loads(run.text("o.json"))["deformed"])
    for name in ("a.obj", "b.obj"):
        run.ffd("fit", "a.obj", "b.obj", "-o", name, "--force", code=IO, err=f"{name}: is an input of this command")
    run.write("p.csv", pairs([["0", "1", "1", "1"]], "vertex,x,y,z"))
    run.ffd("fit", "a.obj", "--pairs", "p.csv", "-o", "p.csv", "--force", code=IO, err="p.csv: is an input of this command")
    run.ffd("fit", "a.obj", "b.obj", "-l", "o.json", "-o", "o.json", "--force", code=IO, err="o.json: is an input of this command")
    equal(run.text("a.obj"), obj(VERTICES))


@case
def it_goes_on_from_a_base(run):
    """What the base does stays: a second fit of what is left changes little, and its rest keeps its bits."""
    write_meshes(run)
    first, before = fit(run, "a.obj", "b.obj", "--smooth", "1", target="first.json")
    second, after = fit(run, "a.obj", "b.obj", "-l", "first.json", "--smooth", "1e-4", target="second.json")
    equal([second["rest"], second["knots"]], [first["rest"], first["knots"]])
    check(after["residual"]["rms"] < 0.2 * before["residual"]["rms"], before, after)
    run.write("move.json", lattice(size=(4, 4, 4), degree=(3, 3, 3), low=(-2, -2, -2), high=(2, 2, 2),
                                   moves=[{"by": [{"$": "BY"}, 0, 0]}], parameters={"BY": {"default": 0}}))
    run.write("moved.obj", obj([(x + 0.5, y, z) for x, y, z in VERTICES]))
    found, told = fit(run, "a.obj", "moved.obj", "-l", "move.json", "--set", "BY=0.5")
    check(told["residual"]["max"] < 1e-14 and max(abs(c) for c in told["affine"][0]) < 1e-14, told)
    near(offsets_of(found), [[0.5, 0, 0]] * 64, 1e-13)
    refused(run, "a.obj", "moved.obj", "-l", "move.json", "--set", "NO=1", code=INVALID, says="placeholder")
    run.write("round.json", {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh"}, "moves": []})
    found, _ = fit(run, "a.obj", "b.obj", "-l", "round.json")
    equal(found["rest"]["box"]["max"], [max(p[c] for p in VERTICES) for c in range(3)])
    run.write("far.obj", obj([(3 * x, y, z) for x, y, z in VERTICES]))
    found, _ = fit(run, "a.obj", "b.obj", "-l", "round.json", "--cover", "far.obj")
    equal(found["rest"]["box"]["max"][0], 3)
    refused(run, "a.obj", "b.obj", "-l", "first.json", "--cover", "far.obj", code=USAGE, says="--cover cannot be used")


@case
def the_box(run):
    write_meshes(run)
    found, _ = fit(run, "a.obj", "b.obj", "--size", "4,5,6", "--degree", "2", "--knots", "clamped", "--margin", "0.25")
    equal([found["size"], found["degree"], found["knots"]], [[4, 5, 6], [2, 2, 2], ["clamped"] * 3])
    equal([found["rest"]["box"][end] for end in ("min", "max")], [[-1.5] * 3, [1.5] * 3])
    run.write("shirt.obj", obj([(2 * x, y, z) for x, y, z in VERTICES]))
    found, _ = fit(run, "a.obj", "b.obj", "--cover", "shirt.obj", "--margin", "0", "--knots", "clamped")
    equal(found["rest"]["box"]["max"], [2, 1, 1])
    run.write("p.csv", pairs([[-1, 0, 0, -1, 0, 0], [1, 0, 0, 1, 0, 0.5], [0, 3, 0, 0, 3, 0]], "px,py,pz,x,y,z"))
    found, told = fit(run, "--pairs", "p.csv", "--margin", "0", "--knots", "clamped")
    equal([told["used"], found["rest"]["box"]["min"][:2], found["rest"]["box"]["max"][:2]], [3, [-1, 0], [1, 3]])


@case
def weights_of_vertices(run):
    """A third of the areas round a vertex, all alike, or those of a file. The poles have no area: they are not used by default."""
    write_meshes(run)
    by_area, told = fit(run, "a.obj", "b.obj", "--smooth", "1")
    uniform, _ = fit(run, "a.obj", "b.obj", "--smooth", "1", "--weights", "uniform")
    check(offsets_of(by_area) != offsets_of(uniform))
    areas = [0.0] * len(VERTICES)
    for face in FACES:
        p = [VERTICES[c] for c in face]
        total = [0.0, 0.0, 0.0]
        for i in (1, 2):
            a, b = [[p[j][c] - p[0][c] for c in range(3)] for j in (i, i + 1)]
            total = [total[0] + a[1] * b[2] - a[2] * b[1], total[1] + a[2] * b[0] - a[0] * b[2], total[2] + a[0] * b[1] - a[1] * b[0]]
        for c in face:
            areas[c] += math.hypot(*total) / 6
    run.write("w.npy", array(areas, "(312,)"))
    from_file, again = fit(run, "a.obj", "b.obj", "--smooth", "1", "--weights", "w.npy")
    near(offsets_of(from_file), offsets_of(by_area), 1e-12)
    equal(again["used"], told["used"])
    run.write("w.npy", array([1.0] * 312, "(312,)"))
    from_file, _ = fit(run, "a.obj", "b.obj", "--smooth", "1", "--weights", "w.npy")
    equal(from_file, uniform)
    run.write("w.npy", array([1.0] * 100 + [0.0] * 212, "(312,)"))
    _, told = fit(run, "a.obj", "b.obj", "--weights", "w.npy")
    equal([told["pairs"], told["used"]], [312, 100])
    points = obj(VERTICES, [])
    run.write("points.obj", points)
    without_faces, _ = fit(run, "points.obj", "b.obj", "--smooth", "1")
    equal(offsets_of(without_faces), offsets_of(uniform))
    for values, says in (([1.0] * 311 + [-1.0], "weight of vertex 311 is -1"), ([1.0] * 311 + [math.nan], "vertex 311"),
                         ([0.0] * 312, "no vertex has a weight above 0")):
        run.write("w.npy", array(values, "(312,)"))
        refused(run, "a.obj", "b.obj", "--weights", "w.npy", code=INVALID, says=says)
    run.write("w.npy", array([1.0] * 311, "(311,)"))
    refused(run, "a.obj", "b.obj", "--weights", "w.npy", code=INVALID, says="w.npy")


@case
def vertices_without_faces(run):
    """They count for nothing by area, which is said."""
    write_meshes(run)
    for name in ("a.obj", "b.obj"):
        run.write(name, run.text(name) + "v 0 0 0\nv 0.1 0 0\np 313 314\n")
    said = run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", err=lambda lines: None).err
    check(said[0].startswith("a.obj: 2 of 314 vertices have no area round them") and "--weights uniform" in said[0], said)
    said = run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", "--force", "--weights", "uniform", err=lambda lines: None).err
    equal(len(said), 1, said)


@case
def rows_that_nearly_meet(run):
    """A slope between two exact places tells them apart, and is taken for one that the rows do not tell."""
    run.write("l.json", lattice())
    for apart in (1e-10, 1e-11, 1e-13):
        run.write("p.csv", pairs([[0.1, 0.2, 0.3, 0.2, 0.2, 0.3, "exact"], [0.5, 0.5, 0.5, 0.6, 0.5, 0.5, "exact"], [-0.3, 0.1, 0, -0.3, 0.2, 0, "exact"],
                                  [0.1 + apart, 0.2, 0.3, 0.2, 0.201, 0.3, "exact"]]))
        for words in ([], ["--smooth", "1"], ["--smooth", "0"], ["--handles"]):
            refused(run, "--pairs", "p.csv", "-l", "l.json", *words, code=NO, says="^p.csv: the exact rows 1 and 4 contradict each other by ")
    run.write("p.csv", pairs([[0, 0.1, 0.2, 0.1, 0.1, 0.2, "exact"]]))
    refused(run, "--pairs", "p.csv", "-l", "l.json", "--symmetric", "u", code=NO, says="the exact row 1 contradicts its mirror image by 0.2$")


@case
def only_ratios_of_weights_count(run):
    """Weights whose sums or squares are no numbers; and an S that leaves the pairs no digits."""
    places = [[random.Random(n).uniform(-1, 1) for n in range(3 * i, 3 * i + 3)] for i in range(40)]
    found = []
    for weight in ("1", "1e308", "1e-320", "0.25"):
        run.write("p.csv", pairs([[x, y, z, x + y * y, y, z - 0.2 * x * x, weight] for x, y, z in places]))
        found.append(offsets_of(fit(run, "--pairs", "p.csv", "--size", "4")[0]))
    near(found[1], found[0], 1e-9)
    near(found[2], found[0], 1e-2)  # such numbers have few digits
    equal(found[3], found[0])
    _, told = fit(run, "--pairs", "p.csv", "--smooth", "1e16")
    _, stiff = fit(run, "--pairs", "p.csv", "--smooth", "1e9")
    check(abs(told["residual"]["rms"] - stiff["residual"]["rms"]) < 1e-6, told, stiff)


@case
def what_is_wrong_with_the_base(run):
    """The message names it, not the pairs."""
    write_meshes(run)
    flat = [[i, j, 0] for _ in range(2) for j in range(2) for i in range(2)]
    base = {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2]}
    box = {"rest": {"box": {"min": [-2] * 3, "max": [2] * 3}}}
    for name, more, words, code, says in (
            ("flat", {"rest": {"points": flat}}, [], INVALID, "the rest lattice has no volume"),
            ("leans", {"rest": {"points": [[4 * i - 2, 4 * j - 2, 4 * k - 2 + i * j] for k in range(2) for j in range(2) for i in range(2)]}},
             ["--symmetric", "u"], INVALID, ""),
            ("weighs", {"weights": [1, 2] * 4, "deformed": {"weights": [2, 1] * 4}, **box}, [], UNSUPPORTED, "its weights move")):
        run.write(f"{name}.json", json.dumps({**base, **more}))
        refused(run, "a.obj", "b.obj", "-l", f"{name}.json", *words, code=code, says=f"^{name}.json: {says}")


@case
def a_long_fit(run):
    """A bar on a terminal; Ctrl-C ends it at once, and nothing is written."""
    write_meshes(run)
    size = 18
    while "left" not in (shown := on_terminal(run, "fit", "a.obj", "b.obj", "-o", "o.json", "--size", str(size), "--force")):
        size += 3
    check(re.search(r"\[#*\.*\] fit: \d+ %, \d+:\d\d left", shown), shown[:300])
    check(re.search(r"\r +\rffd: fit: 312 pairs[^\r]*\r\n$", shown), "the bar is not cleared:", shown[-300:])
    equal(on_terminal(run, "fit", "a.obj", "b.obj", "-o", "o.json", "--size", "18", "--force", "-q"), "", "--quiet on a terminal")
    process = subprocess.Popen([FFD, "fit", "a.obj", "b.obj", "-o", "never.json", "--size", "30", "--smooth", "1"], cwd=run.folder, stderr=subprocess.PIPE)
    try:
        time.sleep(0.3)
        check(process.poll() is None, "it has ended")
        begun = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=SECONDS)
        check(time.monotonic() - begun < (10 if SANITIZED else 1), "it goes on after Ctrl-C")
        equal(process.returncode, -signal.SIGINT)
    finally:
        process.kill()
    check(not any("never" in name for name in run.names(".")), run.names("."))


@case
def corners_of_facets_share_the_weight(run):
    """STL lists a vertex for each corner: the fit is that of the mesh with shared vertices."""
    vertices = [(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0), (0, 0, 1), (2, 0, 1), (0, 1, 1), (2, 1, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]

    def stl(at):
        return b"\0" * 80 + struct.pack("<I", len(faces)) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in at(*vertices[c])), 0) for face in faces)

    def place(x, y, z):
        return x + 0.125 * y * z, y + 0.25 * x, z
    run.write("a.stl", stl(lambda *p: p))
    run.write("b.stl", stl(place))
    run.write("a.obj", obj(vertices, faces))
    run.write("b.obj", obj([place(*p) for p in vertices], faces))
    of_corners, told = fit(run, "a.stl", "b.stl", "--smooth", "10", "--size", "4")
    shared, _ = fit(run, "a.obj", "b.obj", "--smooth", "10", "--size", "4")
    equal([told["pairs"], told["used"], told["spread"]["positions"]], [36, 36, 0])
    near(offsets_of(of_corners), offsets_of(shared), 1e-12)


@case
def one_position_with_several_targets(run):
    run.write("p.csv", pairs([[0, 0, 0, 0, 0, 1, 3], [0, 0, 0, 0, 0, -3, 1], [1, 1, 1, 1, 1, 1, 1], [0, 1, 0, 0, 1, 0, 1]]))
    _, told = fit(run, "--pairs", "p.csv")
    equal(told["spread"], {"positions": 1, "largest": 3})


@case
def symmetric_to_the_bit(run):
    write_meshes(run)
    found, told = fit(run, "a.obj", "b.obj", "--symmetric", "v", "--smooth", "0.01")
    equal(told["pairs"], 312)
    offsets, (n, m, o) = offsets_of(found), found["size"]
    for i, j, k in itertools.product(range(n), range(m), range(o)):
        a, b = offsets[i + n * (j + m * k)], offsets[i + n * (m - 1 - j + m * k)]
        equal([a[0], a[1] + b[1], a[2]], [b[0], 0, b[2]], (i, j, k))
    both = [(p, bent(*p)) for p in VERTICES]
    both += [((x, -y, z), (a, -b, c)) for (x, y, z), (a, b, c) in both]
    run.write("both.csv", pairs([[*p, *q] for p, q in both], "px,py,pz,x,y,z"))
    found, told = fit(run, "a.obj", "b.obj", "--symmetric", "v", "--smooth", "0.01", "--weights", "uniform", target="symmetric.json")
    run.write("base.json", {k: v for k, v in found.items() if k != "deformed"})
    given, _ = fit(run, "--pairs", "both.csv", "-l", "base.json", "--smooth", "0.01")
    near(offsets_of(found), offsets_of(given), 1e-10)
    run.write("p.csv", pairs([[0.5, 0.25, 0, 0.5, 0.5, 0, "exact"], [0.25, 0, 0.25, 0.25, 0, 0.5, "exact"], [0, 0.5, 0, 0, 0.5, 0, 1]]))
    _, told = fit(run, "--pairs", "p.csv", "-l", "base.json", "--symmetric", "v", "--smooth", "0.01")
    equal([told["pairs"], told["used"], told["exact"], told["dependent"]], [3, 3, 2, 0])
    check(told["residual_exact"] < 1e-14, told)
    run.write("uneven.json", {"format": "ffd-lattice", "version": 1, "size": [5, 4, 4], "degree": [3, 3, 3],
                              "knots": [[0, 0, 0, 0, 0.25, 1, 1, 1, 1], "clamped", "clamped"],
                              "rest": {"box": {"min": [-2, -2, -2], "max": [2, 2, 2]}}, "moves": []})
    refused(run, "a.obj", "b.obj", "-l", "uneven.json", "--symmetric", "u", code=INVALID, says="knots along u are not symmetric")


@case
def outliers(run):
    run.write("a.obj", obj(VERTICES))
    targets = [bent(*p) for p in VERTICES]
    targets[100] = (9, 9, 9)
    run.write("b.obj", obj(targets))
    _, plain = fit(run, "a.obj", "b.obj")
    _, robust = fit(run, "a.obj", "b.obj", "--robust")
    check(robust["downweighted"] >= 1 and robust["residual"]["worst"] == 100, robust)
    check(robust["residual"]["p95"] < 0.1 * plain["residual"]["p95"], plain, robust)


@case
def near_enough(run):
    write_meshes(run)
    _, told = fit(run, "a.obj", "b.obj", "--within", "1e-2")
    check(told["residual"]["max"] <= 1e-2 and told["smooth_chosen_by"] == "within", told)
    _, smoother = fit(run, "a.obj", "b.obj", "--smooth", repr(told["smooth"] * math.sqrt(10)))
    check(smoother["residual"]["max"] > 1e-2, smoother)
    diagonal = math.sqrt(12)
    _, relative = fit(run, "a.obj", "b.obj", "--within", f"{1e-2 / diagonal!r}r")
    equal(relative["smooth"], told["smooth"])
    refused(run, "a.obj", "b.obj", "--within", "1e-12", code=NO, says=r"a.obj: no smoothing brings all pairs within 1e-12: the best is ")


@case
def folds(run):
    write_meshes(run)
    run.write("mirror.obj", obj([(-2 * x, y, z) for x, y, z in VERTICES]))
    run.ffd("fit", "a.obj", "mirror.obj", "-o", "o.json", err=lambda lines: equal(
        [lines[0], lines[1].endswith("smooth 100 (folds), folds")], ["a.obj: the lattice that is found folds", True]))
    refused(run, "a.obj", "mirror.obj", "--fail-on", "folds", code=NO, says=r"the lattice that is found folds \(--fail-on folds\)")
    run.ffd("fit", "a.obj", "mirror.obj", "-o", "gate.json", "--fail-on", "folds", "--report", "report.json", code=NO, lines=1)
    told = json.loads(run.text("report.json"))["jobs"][0]
    equal([told["exit"], told["fit"]["folds"]["verdict"], told["outputs"]], [1, "some", []])
    refused(run, "a.obj", "b.obj", "--fail-on", "tear", code=USAGE, says="folds only")


@case
def exact_rows(run):
    write_meshes(run)
    run.write("p.csv", pairs([["0", 0, 0, 2, ""], ["100", 1, 1, 1, "exact"], ["0", 0, 0, 1.5, 1], ["100", 1, 1, 1, "EXACT"]], "vertex,x,y,z,weight"))
    found, told = fit(run, "a.obj", "--pairs", "p.csv")
    equal([told[k] for k in ("pairs", "used", "exact", "dependent")], [4, 4, 2, 1])
    check(told["residual_exact"] < 1e-14, told)
    near(carried(run, [VERTICES[100]], "o.json"), [[1, 1, 1]], 1e-14)
    run.write("p.csv", pairs([["7", 0, 0, 0, "1"], ["100", 1, 1, 1, "exact"], ["30", 0, 0, 0, "1"], ["100", 1, 1, 1.012, "exact"]], "vertex,x,y,z,weight"))
    refused(run, "a.obj", "--pairs", "p.csv", code=NO, says=r"^p.csv: the exact rows 2 and 4 contradict each other by 0\.012$")
    run.write("base.json", lattice(size=(4, 4, 4), degree=(3, 3, 3), low=(-2, -2, -2), high=(2, 2, 2)))
    run.write("p.csv", pairs([[0, 0, 0, 0, 0, 0, 1], [9, 0, 0, 9, 0, 0, "exact"]]))
    refused(run, "--pairs", "p.csv", "-l", "base.json", code=EMBEDDING, says="p.csv: the exact pair 2 is not inside the lattice: outside")
    run.write("p.csv", pairs([[9, 0, 0, 9, 0, 0, 1], [0, 0, 0, 0, 0, 0, "exact"], [0, 0, 0, 1, 0, 0, "exact"]]))
    refused(run, "--pairs", "p.csv", "-l", "base.json", code=NO, says="p.csv: the exact rows 2 and 3 contradict each other by 1$")
    run.write("p.csv", pairs([[9, 0, 0, 9, 0, 0, 1]]))
    refused(run, "--pairs", "p.csv", "-l", "base.json", code=EMBEDDING, says="none of 1 pairs is inside")
    run.write("p.csv", pairs([[0, 0, 0, 0, 0.5, 0, 1], [9, 0, 0, 9, 0, 0, 1]]))
    run.ffd("fit", "--pairs", "p.csv", "-l", "base.json", "-o", "part.json", "--report", "report.json", err=lambda lines: check(
        lines[0].startswith("p.csv: 1 of 2 pairs are not used: 1 outside the lattice") and len(lines) == 2, lines))
    told = json.loads(run.text("report.json"))["jobs"][0]["fit"]
    equal([told["pairs"], told["used"], told["outside"]], [2, 1, 1])
    run.write("many.csv", pairs([[0, 0, i / 4096, 0, 0, i / 4096, "exact"] for i in range(4097)]))
    refused(run, "--pairs", "many.csv", "-l", "base.json", code=LIMIT, says="4097 exact pairs are more than 4096")


@case
def handles(run):
    """Control points that see no handle keep their bits."""
    run.write("base.json", lattice(size=(9, 9, 9), degree=(3, 3, 3), low=(-2, -2, -2), high=(2, 2, 2)))
    run.write("p.csv", pairs([[-1, -1, -1, -1, -1, -1.5, "exact"]]))
    found, told = fit(run, "--pairs", "p.csv", "--handles", "-l", "base.json")
    equal([told["smooth"], told["smooth_chosen_by"], told["affine"], told["points_without_data"]], [0, "default", [[0, 0, 0]] * 4, 729 - 64])
    equal(sum(any(d) for d in offsets_of(found)), 64)
    near(carried(run, [(-1, -1, -1)], "o.json"), [[-1, -1, -1.5]], 1e-14)
    exact = told["largest_offset"]  # R y / R.R at the largest R; of a pair with a weight R y / (R.R + 1/n)
    run.write("p.csv", pairs([[-1, -1, -1, -1, -1, -1.5, 1]]))
    _, told = fit(run, "--pairs", "p.csv", "--handles", "-l", "base.json")
    more = exact / told["largest_offset"] - 1
    near([told["residual"]["max"]], [0.5 * more / (1 + more)], 1e-12)
    check(more > 1e-4, more)


@case
def only_a_part(run):
    names = "o one\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))) + "f 1 2 3\nf 1 2 4\n"
    names += "o two\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in ((0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0.5))) + "f 5 6 7\n"
    run.write("a.obj", names)
    run.write("b.obj", names.replace("v 1 0 0", "v 1 0 0.5"))
    found, told = fit(run, "a.obj", "b.obj", "--only", "object:one", "--margin", "0", "--knots", "clamped")
    equal([told["pairs"], told["used"], found["rest"]["box"]["max"]], [7, 4, [1, 1, 1]])
    said = run.ffd("fit", "a.obj", "b.obj", "-o", "said.json", "--only", "object:one", err=lambda lines: None).err
    equal(len(said), 1, said)
    refused(run, "a.obj", "b.obj", "--only", "object:three", code=USAGE, says="three")


@case
def counts_and_numbers(run):
    write_meshes(run)
    run.write("fewer.obj", obj(VERTICES[:-1], []))
    refused(run, "a.obj", "fewer.obj", code=INVALID, says="^fewer.obj: has 311 vertices, but a.obj has 312$")
    run.write("b.npy", array([0.0] * 930, "(310, 3)"))
    refused(run, "a.obj", "b.npy", code=INVALID, says="^b.npy: has 310 vertices, but a.obj has 312$")
    run.write("b.npy", array([0.0] * 936, "(936,)"))
    refused(run, "a.obj", "b.npy", code=INVALID, says=r"^b.npy: has the shape \(936,\), but places need \(N, 3\)$")
    run.write("b.npy", array([0.0] * 933 + [math.nan] * 3, "(312, 3)"))
    refused(run, "a.obj", "b.npy", code=INVALID, says="^b.npy: vertex 311 has a coordinate that is not finite$")
    run.write("b.npy", array([0.0] * 936, "(312, 3)")[:-1])
    refused(run, "a.obj", "b.npy", code=INVALID, says="^b.npy")
    run.write("nan.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\nnan 0 0\n")
    refused(run, "nan.ply", "nan.ply", code=INVALID, says="nan.ply: vertex 0 has a coordinate that is not finite")
    run.write("none.off", "OFF\n0 0 0\n")
    refused(run, "none.off", "none.off", code=INVALID, says="none.off: there are no vertices")
    refused(run, "a.obj", "missing.obj", code=IO, says="missing.obj")
    refused(run, "a.obj", "b.obj", "--size", "67108864,2,2", code=LIMIT, says="67108864 by 2 by 2 has more than 67108864 control points")
    refused(run, "a.obj", "b.obj", "--size", "39", code=LIMIT, says="at most --size 38,38,38 of equal sides fits")
    refused(run, "a.obj", "b.obj", "--size", "20", "--smooth", "0", "--timeout", "0.01", code=LIMIT, says="took longer than 0.01 seconds")


@case
def memory_grows_with_the_files(run):
    """700,000 places take more than 100 MB, but a long table may."""
    run.write("base.json", lattice(size=(4, 4, 4), degree=(3, 3, 3), low=(-2, -2, -2), high=(2, 2, 2)))
    run.write("p.csv", "px,py,pz,x,y,z\n" + "0.5,0.25,0,0.5,0.25,0.5\n-1,0.25,1,-1,0.25,1.5\n" * 350000)
    _, told = fit(run, "--pairs", "p.csv", "-l", "base.json", "--smooth", "1")
    equal(told["used"], 700000)


@case
def few_pairs(run):
    """Planar, collinear and single places, and a great many at one."""
    for places in ([(x, y, 0.5) for x in (0, 1, 2) for y in (0, 1, 2)], [(x, 0.5 * x, 0) for x in range(5)], [(1, 2, 3)],
                   [(0, 0, 0)] * 2000 + [(1, 1, 1)]):
        run.write("p.csv", pairs([[x, y, z, x + 0.25, y, z - 0.125 * x] for x, y, z in places], "px,py,pz,x,y,z"))
        _, told = fit(run, "--pairs", "p.csv")
        check(told["residual"]["max"] < 1e-12 and told["folds"]["verdict"] == "none", places[:3], told)
    run.write("w.npy", array([0.0] * 2, "(2,)"))
    run.write("a.NPY", array([0.0, 1.0, 2.0] * 2, "(2, 3)"))
    refused(run, "a.NPY", "a.NPY", "--weights", "w.npy", code=INVALID, says="^a.NPY: no vertex has a weight above 0$")
    refused(run, "a.NPY", "a.NPY", "--space", "scene", code=USAGE, says="--space is for a mesh")
    count = repetitions(100000)  # all at one place, and wanted at two
    run.write("a.npy", array([0.0, 1.0, 2.0] * count, f"({count}, 3)"))
    run.write("b.npy", array([0.0, 1.0, 2.0, 0.5, 1.0, 2.0] * (count // 2), f"({count}, 3)"))
    _, told = fit(run, "a.npy", "b.npy")
    equal(told["spread"], {"positions": 1, "largest": 0.25})
    check(abs(told["residual"]["rms"] - 0.25) < 1e-12, told)


@case
def broken_tables(run):
    write_meshes(run)
    for text, says in (
            ("", "p.csv:1: there is no header"),
            ("vertex,x,y,z\n", "p.csv:1: there are no rows below the header"),
            ("vertex,x,y\n0,0,0\n", "p.csv:1: there is no column z"),
            ("x,y,z\n0,0,0\n", "p.csv:1: there are no sources"),
            ("px,py,x,y,z\n0,0,0,0,0\n", "p.csv:1: there are no sources"),
            ("vertex,px,x,y,z\n0,0,0,0,0\n", "p.csv:1: there are both vertices and places"),
            ("vertex,x,y,z,color\n0,0,0,0,0\n", 'p.csv:1: there is no column "color"'),
            ("vertex,x,y,z,x\n0,0,0,0,0\n", "p.csv:1: the column x is there twice"),
            ("vertex,x,y,z\n0,0,0,0\n312,0,0,0\n", "p.csv:3: there is no vertex 312: a.obj has 312"),
            ("vertex,x,y,z\n-1,0,0,0\n", 'p.csv:2: "-1" is not the number of a vertex'),
            ("vertex,x,y,z\n1.5,0,0,0\n", 'p.csv:2: "1.5" is not the number of a vertex'),
            ("vertex,x,y,z\n99999999999999999999999,0,0,0\n", 'p.csv:2: "99999999999999999999999" is not the number'),
            ("vertex,x,y,z\n0,0,0,a\n", 'p.csv:2: "a" is not a number, in column z'),
            ("vertex,x,y,z\n0,0,0,nan\n", 'p.csv:2: "nan" is not a number'),
            ("vertex,x,y,z\n0,0,0,inf\n", 'p.csv:2: "inf" is not a number'),
            ("vertex,x,y,z\n0,0,0,1e999\n", 'p.csv:2: "1e999" is not a number'),
            ("vertex,x,y,z\n0,0,,0\n", 'p.csv:2: "" is not a number, in column y'),
            ("vertex,x,y,z\n0,0,0\n", "p.csv:2: has 3 cells, but the header has 4"),
            ("vertex,x,y,z,weight\n0,0,0,0,0\n", 'p.csv:2: the weight "0" is neither a positive number nor exact'),
            ("vertex,x,y,z,weight\n0,0,0,0,-1\n", 'p.csv:2: the weight "-1"'),
            ("vertex,x,y,z,weight\n0,0,0,0,about\n", 'p.csv:2: the weight "about"'),
            ('vertex,x,y,z\n\n0,"0\n",0,0\n', 'p.csv:3: "0?" is not a number'),
            ('vertex,x,y,z\n0,"0,0,0\n', "p.csv:2: a quote is not closed"),
            ('vertex,x,y,z\n0,0"0,0,0\n', "p.csv:2: a quote is not closed, or stands inside a cell"),
            (b"vertex,x,y,z\n0,0,0,\xff\n", "p.csv:2: the text is not UTF-8"),
            (b"vertex,x,y,z\n0,0,\x000,0\n", "p.csv:2: the text is not UTF-8, or has a NUL character"),
            ("\ufeffvertex,x,y,z\r\n0,0,0,b\r\n", 'p.csv:2: "b" is not a number')):
        run.write("p.csv", text)
        refused(run, "a.obj", "--pairs", "p.csv", code=INVALID, says="^" + re.escape(says))


@case
def tables_as_programs_write_them(run):
    write_meshes(run)
    run.write("p.csv", "vertex,x,y,z,weight\n3,1,2,3,exact\n7,0,0.5,0,\n")
    plain, _ = fit(run, "a.obj", "--pairs", "p.csv")
    for text in ("\ufeff\"vertex\",\"x\",\"y\",\"z\",\"weight\"\r\n\"3\",\"1\",\"2\",\"3\",\"exact\"\r\n\r\n\"7\",\"0\",\"0.5\",\"0\",\"\"",
                 "Z,Y,X,Weight,Vertex\n3,2,1,Exact,3\n0.0,5e-1,-0.0,1,7\n",
                 "vertex , x , y , z , weight\n3, 1, 2, 3, exact\n7, 0, .5, 0, 1.0\n"):
        run.write("p.csv", text)
        equal(fit(run, "a.obj", "--pairs", "p.csv")[0], plain, text)


@case
def hostile_tables(run):
    """Cut and changed tables: a lattice, or one line."""
    write_meshes(run)
    good = pairs([[str(i), *bent(*VERTICES[i]), "exact" if i % 3 == 0 else 1] for i in range(30, 60)], "vertex,x,y,z,weight").encode()
    for _ in range(repetitions(60)):
        run.write("p.csv", broken(good, RANDOM, b'",;\n\r\0\xff-e.9x'))
        run.ffd("fit", "a.obj", "--pairs", "p.csv", "-o", "o.json", "--force", "-q", "--size", "4", "--smooth", "1",
                code=(OK, NO, INVALID), err=lambda lines: check(len(lines) <= 1, lines))


@case
def what_does_not_go_together(run):
    write_meshes(run)
    run.write("p.csv", pairs([["0", 0, 0, 0]], "vertex,x,y,z"))
    run.write("l.json", lattice(size=(4, 4, 4), degree=(3, 3, 3), low=(-2, -2, -2), high=(2, 2, 2)))
    for arguments, says in (
            (["a.obj"], "needs BEFORE and AFTER, or --pairs FILE.csv"),
            (["a.obj", "b.obj", "b.obj"], "needs BEFORE and AFTER"),
            (["a.obj", "b.obj", "--pairs", "p.csv"], "--pairs has the targets"),
            (["a.obj", "b.obj", "--handles"], "--handles needs --pairs"),
            (["a.obj", "--pairs", "p.csv", "--weights", "area"], "--weights is for BEFORE and AFTER"),
            (["a.obj", "--pairs", "p.csv", "--handles", "--robust"], "--robust does not go with --handles"),
            (["--pairs", "p.csv", "--only", "object:a"], "--only needs BEFORE"),
            (["--pairs", "p.csv"], "names vertices, but no mesh is given"),
            (["a.obj", "b.obj", "--smooth", "1", "--within", "1"], "--smooth and --within cannot be used together"),
            (["a.obj", "b.obj", "--within", "1", "--smooth", "auto"], "--smooth and --within cannot be used together"),
            (["a.obj", "b.obj", "--smooth", "-1"], "neither auto nor a number of at least 0"),
            (["a.obj", "b.obj", "--smooth", "nan"], "neither auto nor a number of at least 0"),
            (["a.obj", "b.obj", "--within", "x"], "--within"),
            (["a.obj", "b.obj", "--weights", "x"], "neither area, uniform nor a file that ends in .npy"),
            (["a.obj", "b.obj", "--symmetric", "x"], "--symmetric"),
            (["a.obj", "b.obj", "--symmetric", "u", "--symmetric", "v"], "--symmetric is given twice"),
            (["a.obj", "b.obj", "-l", "l.json", "--size", "4"], "-l has its own size"),
            (["a.obj", "b.obj", "-l", "l.json", "--axes", "principal"], "-l has its own size"),
            (["a.obj", "b.obj", "-l", "l.json", "-l", "l.json"], "starts from one lattice"),
            (["a.obj", "b.obj", "--set", "A=1"], "--set and --time need -l"),
            (["a.obj", "b.obj", "--time", "1"], "--set and --time need -l"),
            (["a.obj", "b.obj", "-l", "l.json", "--time", "1"], "keys"),
            (["a.obj", "b.txt"], "txt"),
            (["-", "-", "--input-format", "obj"], "standard input can be read only once"),
            (["a.obj", "b.obj", "--cover", "-"], "--cover names a file, not standard input"),
            (["a.obj", "b.obj", "--report-stable"], "--report-stable needs --report"),
            (["a.obj", "b.obj", "--report", "a.obj"], "the report would replace a file of the job")):
        refused(run, *arguments, code=USAGE, says=re.escape(says))
    run.write("p.csv", pairs([["0", 0, 0, 2, "exact"]], "vertex,x,y,z,weight"))
    refused(run, "a.obj", "--pairs", "p.csv", "--robust", code=USAGE, says="--robust needs pairs that are not exact")
    refused(run, "a.obj", "b.obj", code=USAGE, says="a lattice file is JSON", target="o.npy")
    run.ffd("fit", "a.obj", "b.obj", code=USAGE, err=re.compile("no output is given"))
    equal(run.text("a.obj"), obj(VERTICES))


@case
def the_report(run):
    write_meshes(run)
    run.ffd("fit", "a.obj", "b.obj", "-o", "o.json", "-q", "--report", "r.json", "--report-stable")
    told = json.loads(run.text("r.json"))["jobs"][0]
    equal([told["input"], told["output"], told["outputs"], told["status"], told["error"], "seconds" in told],
          ["a.obj", "o.json", ["o.json"], "ok", None, False])
    run.ffd("fit", "a.obj", "missing.obj", "-o", "n.json", "-q", "--report", "r.json", code=IO)
    told = json.loads(run.text("r.json"))["jobs"][0]
    equal([told["fit"], told["exit"], told["outputs"]], [None, 3, []])


main()
