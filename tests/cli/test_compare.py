#!/usr/bin/env python3
"""ffd compare: 0 the same, 1 not (with the differences on stdout), other codes for failures."""
import itertools
import json
import math
import os
import random
import re
import struct

from harness import CUBE, CUBE_CORNERS, INVALID, IO, NO, OK, USAGE, case, check, equal, glb, gltf_json, main

SEED = int(os.environ.get("FFD_SEED") or random.SystemRandom().randrange(1 << 32))
print(f"seed {SEED} (FFD_SEED)")

KINDS = ["position", "normal", "tangent", "texcoord", "topology", "other"]


def no_constant(name):
    raise AssertionError(f"{name} is not JSON")


def result(run, a, b, *arguments, **options):
    """The JSON of a comparison, which must be one for any reader, and agree with itself."""
    done = run.ffd("compare", a, b, *arguments, "--json", code=(OK, NO), **options)
    found = json.loads(done.out.decode("utf-8"), parse_constant=no_constant)
    equal(list(found), ["format", "version", "a", "b", "equal", "complete", "tolerance", "normal_tolerance",
                        "positions_compared", "largest", "differences", "first", "worst"], "the members")
    equal((found["format"], found["version"]), ("ffd-comparison", 1))
    differences = found["differences"]
    equal(list(differences), ["total", *KINDS], "the kinds")
    equal(differences["total"], sum(differences[kind] for kind in KINDS), "the total")
    equal(found["equal"], differences["total"] == 0, "equal")
    equal(done.code, OK if found["equal"] else NO, "the exit code")
    check((found["first"] is None) == found["equal"], found)
    measured = [kind for kind in KINDS[:3] if differences[kind]]
    equal(found["worst"] and found["worst"]["kind"], measured[0] if measured else None, "the kind of the worst")
    return found


def differ(run, a, b, *arguments):
    """What is said on stdout, and the JSON's counts, which do not depend on the order of the files."""
    done = run.ffd("compare", a, b, *arguments, code=NO)
    lines = done.text.split("\n")
    found, turned = result(run, a, b, *arguments), result(run, b, a, *arguments)
    equal(lines.pop(), "", "the last line's end")
    equal(lines.pop(0), f"{a} and {b} differ: {found['first']['message']}", "the first line")
    total = found["differences"]["total"]
    if total > 1 and found["worst"]:
        equal(lines.pop(0), f"worst: {found['worst']['message']}", "the second line")
    if total > 1 or not found["complete"]:
        start = f"{'' if found['complete'] else 'at least '}{total} difference{'s' * (total > 1)}: "
        check(lines.pop(0).startswith(start), done.text, start)
    equal(lines, [], "more lines")
    for member in ("differences", "complete", "largest", "positions_compared"):
        equal(turned[member], found[member], f"{member}, the other way round")
    run.ffd("compare", b, a, *arguments, code=NO)
    return done.text


def counts(found):
    return {kind: found["differences"][kind] for kind in KINDS if found["differences"][kind]}


def same(run, a, b, *arguments):
    run.ffd("compare", a, b, *arguments, out="")
    run.ffd("compare", b, a, *arguments, out="")
    equal(result(run, a, b, *arguments)["equal"], True)


@case
def equal_files_are_the_same(run):
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE)
    same(run, "a.obj", "b.obj")
    same(run, "a.obj", "a.obj", "--tolerance", "0")


@case
def positions_beyond_the_tolerance_differ(run):
    run.write("a.obj", "v 0 0 0\nv 1 2 3\n")
    run.write("b.obj", "v 0 0 0\nv 1 2.25 3\n")
    text = differ(run, "a.obj", "b.obj")
    check("vertex 2" in text and "line 2" in text and "0.25" in text, text)
    differ(run, "a.obj", "b.obj", "--tolerance", "0.2499")
    same(run, "a.obj", "b.obj", "--tolerance", "0.25")
    same(run, "a.obj", "b.obj", "--tolerance=1e3")


@case
def numbers_are_compared_as_numbers(run):
    run.write("a.obj", "v 0.5 1 100\n")
    run.write("b.obj", "v .50 1.0e0 1E2\n")
    same(run, "a.obj", "b.obj")
    run.write("c.obj", "v 0.5 1.0000000000000002 100\n")
    differ(run, "a.obj", "c.obj")


@case
def all_else_of_obj(run):
    text = "mtllib m.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng part\nusemtl red\ns 1\nf 1/1/1 2/1/1 3/1/1\n"
    run.write("a.obj", text)
    for old, new in (("m.mtl", "n.mtl"), ("thing", "things"), ("vt 0 0", "vt 0 0.5"), ("vn 0 0 1", "vn 0 1 0"),
                     ("g part", "g other"), ("red", "blue"), ("s 1", "s 2"), ("f 1/1/1 2/1/1 3/1/1", "f 1/1/1 3/1/1 2/1/1"),
                     ("f 1/1/1", "f 1//1"), ("v 0 1 0\n", "v 0 1 0\nv 0 1 0\n"),
                     ("usemtl red\n", ""), ("s 1\n", "s 1\nl 1 2\n")):
        check(old in text, old)
        run.write("b.obj", text.replace(old, new, 1))
        differ(run, "a.obj", "b.obj", "--tolerance", "10")


@case
def positions_of_glb_files_differ_alike(run):
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    run.write("b.glb", glb(asset, data[:12] + struct.pack("<f", 0.875) + data[16:]))
    same(run, "a.glb", "a.glb")
    differ(run, "a.glb", "b.glb", "--tolerance", "0.124")
    check("0.125" in differ(run, "a.glb", "b.glb"), "the coordinate that differs")
    same(run, "a.glb", "b.glb", "--tolerance", "0.125")


@case
def all_else_of_gltf(run):
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    for change in ({"nodes": [{"mesh": 0, "name": "x"}]}, {"nodes": [{"mesh": 0, "translation": [1, 0, 0]}]},
                   {"extras": {"x": 1}}, {"materials": [{}]},
                   {"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}]}):
        run.write("b.glb", glb({**asset, **change}, data))
        differ(run, "a.glb", "b.glb", "--tolerance", "10")


@case
def a_gltf_and_a_glb_of_one_content_are_the_same(run):
    """A .gltf with a .bin and a .glb of the same content are the same mesh."""
    asset, data = gltf_json(CUBE_CORNERS)
    run.write("a.glb", glb(asset, data))
    run.write("b.gltf", gltf_json(CUBE_CORNERS, uri="b.bin")[0])
    run.write("b.bin", data)
    same(run, "b.gltf", "b.gltf")
    same(run, "b.gltf", "a.glb")
    run.write("c.gltf", gltf_json(CUBE_CORNERS, uri="c.bin")[0])
    run.write("c.bin", data[:12] + struct.pack("<f", 0.875) + data[16:])
    for name in ("a.glb", "b.gltf"):
        differ(run, name, "c.gltf", "--tolerance", "0.124")
        same(run, name, "c.gltf", "--tolerance", "0.125")


@case
def other_formats_differ(run):
    run.write("a.obj", CUBE)
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    differ(run, "a.obj", "a.glb")


@case
def what_cannot_be_read_cannot_be_compared(run):
    run.write("a.obj", CUBE)
    run.write("bad.obj", "v 1 2\n")
    run.folder_of("d.obj")
    for name, code in (("none.obj", IO), ("bad.obj", INVALID), ("d.obj", IO), ("x.txt", USAGE)):
        run.ffd("compare", "a.obj", name, code=code)
        run.ffd("compare", name, "a.obj", code=code)


@case
def streams_quiet_verbose(run):
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE.replace("1", "2"))
    run.ffd("compare", "-", "a.obj", "--input-format", "obj", stdin=CUBE.encode())
    done = run.ffd("compare", "b.obj", "-", "--input-format", "obj", stdin=CUBE.encode(), code=NO)
    check(done.text.startswith("b.obj and standard input differ: "), done.text)
    run.ffd("compare", "a.obj", "-", stdin=CUBE.encode(), code=USAGE)
    run.ffd("compare", "-", "-", "--input-format", "obj", stdin=CUBE.encode(), code=USAGE)
    run.ffd("compare", "a.obj", "b.obj", "-q", code=NO, out="")
    run.ffd("compare", "a.obj", "a.obj", "-v", err="8 positions compared, largest difference of a coordinate 0")


@case
def a_deformed_file_is_the_same_when_deformed_again(run):
    """As users do: a deformed file is the same as one deformed again, and not the same as its input."""
    run.write("a.obj", CUBE)
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                         "moves": [{"by": [0, 0, 0.5]}]})
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json")
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json")
    same(run, "b.obj", "c.obj")
    differ(run, "a.obj", "b.obj")
    same(run, "a.obj", "b.obj", "--tolerance", "0.5")


# Meshes of triangles in every form: three positions and (STL: one) three normals a facet.


def obj_file(positions, normals):
    lines = ["v %r %r %r" % tuple(p) for p in positions] + ["vn %r %r %r" % tuple(n) for n in normals]
    lines += ["f " + " ".join(f"{i}//{i}" for i in range(f + 1, f + 4)) for f in range(0, len(positions), 3)]
    return "\n".join(lines) + "\n"


def off_file(positions, normals):
    lines = [f"NOFF\n{len(positions)} {len(positions) // 3} 0"]
    lines += [" ".join(map(repr, [*p, *n])) for p, n in zip(positions, normals)]
    lines += [f"3 {f} {f + 1} {f + 2}" for f in range(0, len(positions), 3)]
    return "\n".join(lines) + "\n"


def ply_file(positions, normals, order=None):
    form = {None: "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {form} 1.0\nelement vertex {len(positions)}\n"
    head += "".join(f"property double {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    head += f"element face {len(positions) // 3}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [[*p, *n] for p, n in zip(positions, normals)]
    faces = [(f, f + 1, f + 2) for f in range(0, len(positions), 3)]
    if order:
        return (head.encode() + b"".join(struct.pack(order + "6d", *row) for row in rows)
                + b"".join(struct.pack(order + "B3i", 3, *face) for face in faces))
    return head + "".join(" ".join(map(repr, row)) + "\n" for row in rows) + "".join("3 %d %d %d\n" % f for f in faces)


def stl_file(positions, normals, binary):
    facets = [(normals[f], positions[f:f + 3]) for f in range(0, len(positions), 3)]
    if binary:
        return (bytes(80) + struct.pack("<I", len(facets))
                + b"".join(struct.pack("<12fH", *n, *itertools.chain(*c), 0) for n, c in facets))
    text = "".join("facet normal %r %r %r\nouter loop\n" % tuple(n) + "".join("vertex %r %r %r\n" % tuple(p) for p in c)
                   + "endloop\nendfacet\n" for n, c in facets)
    return f"solid a\n{text}endsolid a\n"


FORMS = {
    ".obj": obj_file, ".off": off_file, "a.ply": ply_file, "l.ply": lambda p, n: ply_file(p, n, "<"),
    "b.ply": lambda p, n: ply_file(p, n, ">"), "t.stl": lambda p, n: stl_file(p, n, False),
    "b.stl": lambda p, n: stl_file(p, n, True), ".glb": lambda p, n: glb(*gltf_json(p, normals=n)),
}


def number_in(message, kind):
    """The number, from 0, of the position or normal that a message names."""
    facet = re.search(r"facet (\d+) counted from 0(?: \(.*?\))?(?:, corner (\d))?:", message)
    if facet:
        return 3 * int(facet[1]) + int(facet[2] or 0)
    from_one = re.match(r"(vertex|normal) (\d+) \(line", message)
    if from_one:
        return int(from_one[2]) - 1
    return int(re.search(r"(?:vertex|element) (\d+)(?: counted from 0.*)?: ", message)[1])


def amounts(a, b):
    return [max(abs(x - y) for x, y in zip(p, q)) for p, q in zip(a, b)]


def expect(found, kind, number, amount):
    equal((found["kind"], number_in(found["message"], kind)), (kind, number), found["message"])
    equal(found["difference"], amount, found["message"])
    equal(abs(found["a"] - found["b"]), amount, found["message"])


def judge(found, form, moved, turned, tolerance, normal_tolerance):
    """Against a count of our own: all numbers are such that their differences are exact."""
    positions = [(i, x) for i, x in enumerate(moved) if x > tolerance]
    normals = [(i, x) for i, x in enumerate(turned) if x > normal_tolerance and (i % 3 == 0 or "stl" not in form)]
    expected = {"position": len(positions), "normal": len(normals)}
    equal(counts(found), {kind: n for kind, n in expected.items() if n}, form)
    equal((found["complete"], found["positions_compared"]), (True, len(moved)), form)
    equal(found["largest"]["position"], max(moved), form)
    together = sorted([(i, 0, x) for i, x in positions] + [(i + 2 * ("stl" in form), 1, x) for i, x in normals])
    by_file = "obj" in form or "glb" in form  # all positions stand before the normals
    if together:
        i, is_normal, x = min(together, key=lambda t: (t[1], t[0])) if by_file else together[0]
        expect(found["first"], KINDS[is_normal], i - 2 * (is_normal and "stl" in form), x)
        kind, worst = ("position", positions) if positions else ("normal", normals)
        i, x = max(worst, key=lambda t: (t[1], -t[0]))
        expect(found["worst"], kind, i, x)


def changed(draw, vectors, share, step):
    return [[x + step * draw.randrange(-9, 10) if draw.random() < 0.5 else x for x in v] if draw.random() < share else v
            for v in vectors]


@case
def counts_are_right(run):
    """Random changes of random meshes in all formats: how many differ, the first, the worst, and by how much."""
    draw = random.Random(SEED)
    for turn in range(12):
        size = 3 * draw.choice([1, 2, 7, 100])
        a = [[draw.randrange(-256, 256) / 64 for _ in range(3)] for _ in range(size)]
        n = [[draw.randrange(-64, 65) / 64 for _ in range(3)] for _ in range(size)]
        share = draw.choice([0, 0.1, 0.5, 1])
        b, m = changed(draw, a, share, 1 / 1024), changed(draw, n, draw.choice([0, share]), 1 / 512)
        tolerance, normal_tolerance = (draw.choice([0, 1, 2, 5, 8, 9]) * step for step in (1 / 1024, 1 / 512))
        for form, write in FORMS.items():
            names = [f"{side}{form}" for side in ("x", "y")]
            run.write(names[0], write(a, n))
            run.write(names[1], write(b, m))
            options = ["--tolerance", repr(tolerance), "--normal-tolerance", repr(normal_tolerance)]
            try:
                found = result(run, *names, *options)
                judge(found, form, amounts(a, b), amounts(n, m), tolerance, normal_tolerance)
                (same if found["equal"] else differ)(run, *names, *options)
            except AssertionError as error:
                raise AssertionError(f"seed {SEED}, turn {turn}, {form}: {error}") from error


@case
def a_relative_tolerance_is_a_part_of_the_diagonal(run):
    """At, just below and just above the border: a box of 3 x 4 x 12 has the diagonal 13, a quarter of which is
    3.25. What is no finite vertex does not count."""
    corners = "v 0 0 0\nv 3 4 12\nv 1 1 1\nv nan 1e9 0\nv inf 0 0\n"
    run.write("a.obj", corners)
    below, above = (repr(math.nextafter(0.25, to)) + "r" for to in (0, 1))
    for far, tolerance, is_same in ((4.25, "0.25r", True), (4.25, "2.5e-1r", True), (4.25, below, False),
                                    (4.25, above, True), (math.nextafter(4.25, 5), "0.25r", False),
                                    (math.nextafter(4.25, 0), "0.25r", True), (4.25, "0.25", False), (4.25, "3.25", True),
                                    (4.25, "0r", False), (1, "0r", True)):
        run.write("b.obj", corners.replace("v 1 1 1", f"v 1 {far!r} 1"))
        equal(result(run, "a.obj", "b.obj", "--tolerance", tolerance)["equal"], is_same, f"{far} within {tolerance}")
    equal(result(run, "a.obj", "b.obj", "--tolerance", "0.25r")["tolerance"], 3.25)
    equal(result(run, "a.obj", "b.obj", "--tolerance", "0.25")["tolerance"], 0.25)
    # The box is that of A alone.
    run.write("small.obj", "v 0 0 0\nv 0 0 1\n")
    run.write("large.obj", "v 0 0 0\nv 0 0 9\n")
    equal(result(run, "large.obj", "small.obj", "--tolerance", "0.9r")["equal"], True)
    equal(result(run, "small.obj", "large.obj", "--tolerance", "0.9r")["equal"], False)
    # No box, and one whose sides no number holds.
    run.write("none.obj", "o x\n")
    same(run, "none.obj", "none.obj", "--tolerance", "1r")
    run.write("huge.obj", "v -1e308 0 0\nv 1.7e308 0 0\nv 0 0 0\n")
    run.write("moved.obj", "v -1e308 0 0\nv 1.7e308 0 0\nv 1 0 0\n")
    equal(result(run, "huge.obj", "moved.obj", "--tolerance", "1r")["equal"], True)
    equal(result(run, "huge.obj", "moved.obj", "--tolerance", "0r")["equal"], False)


@case
def relative_in_the_scene(run):
    """The box and the distances are those of the scene: here a node makes all twice as large."""
    box = [[0, 0, 0], [3, 4, 12], [1, 1, 1]]
    moved = [[0, 0, 0], [3, 4, 12], [1, 4.25, 1]]
    for name, points in (("a.glb", box), ("b.glb", moved)):
        run.write(name, glb(*gltf_json(points, nodes=[{"mesh": 0, "scale": [2, 2, 2]}])))
    found = result(run, "a.glb", "b.glb", "--tolerance", "0.25r")
    equal((found["equal"], found["tolerance"], found["largest"]["position"]), (True, 6.5, 6.5))
    equal(result(run, "a.glb", "b.glb", "--tolerance", "0.2499r")["worst"]["difference"], 6.5)


@case
def normals_are_exact_unless_a_tolerance_is_given(run):
    """Exact, unless the tolerance is relative or one of their own is given."""
    a, n = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 1]] * 3
    for form, write in FORMS.items():
        run.write("a" + form, write(a, n))
        run.write("b" + form, write(a, [[0, 0, 1.0], [0, 0, 1.0], [0, 0, 1.0]]))
        run.write("c" + form, write(a, [[0, 0, 0.9375]] * 3))
        same(run, "a" + form, "b" + form)
        for options, is_same in (((), False), (("--tolerance", "9"), False), (("--normal-tolerance", "0.0625"), True),
                                 (("--normal-tolerance", "0.0624"), False), (("--tolerance", "0.0625r"), True),
                                 (("--tolerance", "0.0624r"), False),
                                 (("--tolerance", "1r", "--normal-tolerance", "0"), False)):
            found = result(run, "a" + form, "c" + form, *options)
            equal(found["equal"], is_same, f"{form} {options}")
            equal(found["largest"], {"position": 0, "normal": 0.0625}, form)
            if not is_same:
                equal(counts(found), {"normal": 1 if "stl" in form else 3}, form)


@case
def numbers_that_are_none(run):
    """NaN equals NaN only, an infinity itself, whatever the tolerance; the JSON stays valid."""
    cases = (("nan", "nan", True), ("nan", "0", False), ("inf", "inf", True), ("inf", "-inf", False), ("inf", "1", False),
             ("-0", "0", True))
    for x, y, is_same in cases:
        for name, value in (("a", x), ("b", y)):
            run.write(f"{name}.obj", f"v {value} 0 0\nv 0 0 0\nv 1 1 1\nvn 0 {value} 0\n")
            a = [[float(value), 0, 0], [0, 0, 0], [1, 1, 1]]
            run.write(f"{name}.ply", ply_file(a, a, "<"))
            run.write(f"{name}.stl", stl_file(a, a, True))
            asset, data = gltf_json([[0, 0, 0], [0, 0, 0], [1, 1, 1]], normals=a)
            run.write(f"{name}.glb", glb(asset, struct.pack("<f", float(value)) + data[4:]))
        for ending in (".obj", ".ply", ".stl", ".glb"):
            for tolerance in ("0", "1e300", "1r", "1.7e308r"):
                found = result(run, "a" + ending, "b" + ending, "--tolerance", tolerance, "--normal-tolerance", "9")
                equal(found["equal"], is_same, f"{x} and {y} {ending} {tolerance}")
                if not is_same:
                    equal(counts(found), {"position": 1, "normal": 1}, f"{x} and {y} {ending}")
                    equal((found["first"]["difference"], found["largest"]["position"]), (None, None), ending)


@case
def each_statement_of_obj_that_differs_counts_once(run):
    """Each statement that differs is counted once, by its kind."""
    text = ("mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl red\nf 1/1/1 2/1/1 3/1/1\n"
            "f 3 2 1\nl 1 2\n")
    run.write("a.obj", text)
    for changes, expected in (([("v 1 0 0", "v 2 3 4"), ("vt 0 0", "vt 5 5"), ("vt 1 0", "vt 1 1 1")],
                               {"position": 1, "texcoord": 2}),
                              ([("v 0 0 0 1 0 0", "v 9 0 0 0 1 1"), ("m.mtl", "n.mtl"), ("red", "blue")],
                               {"position": 1, "other": 3}),
                              ([("f 1/1/1 2/1/1 3/1/1", "f 2/2/1 1/1/1 3/1/1"), ("f 3 2 1", "f 3 2 1 2"), ("l 1 2", "l 1 3")],
                               {"topology": 3}),
                              ([("vn 0 0 1", "vn 1 0 0"), ("l 1 2\n", "l 1 2\nf 1 2 3\nv 1 1 1\ng x\n")],
                               {"normal": 1, "topology": 2, "other": 1})):
        other = text
        for old, new in changes:
            check(old in other, old)
            other = other.replace(old, new, 1)
        run.write("b.obj", other)
        found = result(run, "a.obj", "b.obj")
        equal((counts(found), found["complete"]), (expected, True), other)
        differ(run, "a.obj", "b.obj")


@case
def what_cannot_be_matched(run):
    """Other numbers of vertices or faces: said once, and that there may be more."""
    a, n = [[float(i), 0, 0] for i in range(6)], [[0, 0, 1.0]] * 6
    for form, write in FORMS.items():
        run.write("a" + form, write(a, n))
        run.write("b" + form, write(a[:3], n[:3]))
        found = result(run, "a" + form, "b" + form, "--tolerance", "9")
        check(found["differences"]["topology"] >= 1 and not found["complete"], form, found)
        differ(run, "a" + form, "b" + form, "--tolerance", "1r")
    run.write("a.obj", CUBE)
    run.write("none.off", "OFF\n0 0 0\n")
    equal(result(run, "a.obj", "none.off")["complete"], False)


@case
def each_face_that_differs_counts_once(run):
    """Each face that differs counts once, whatever it differs in, and those behind it are matched all the same."""
    shapes = [[0, 1, 2], [1, 2, 3], [2, 3, 4, 5], [0, 5, 4]]
    others = [[0, 2, 1], [1, 2, 3], [2, 3, 4], [0, 5, 4, 3, 2]]

    def ply(order, polygons):
        text = ply_file([[0.0] * 3] * 6, [[0.0] * 3] * 6, order)
        head, body = (text.encode() if isinstance(text, str) else text).split(b"end_header\n", 1)
        head = head.replace(b"element face 2", b"element face %d" % len(polygons)) + b"end_header\n"
        vertices = body[:6 * 48] if order else b"".join(body.splitlines(True)[:6])
        rows = [struct.pack(f"{order}B{len(f)}i", len(f), *f) if order else " ".join(map(str, [len(f), *f])).encode() + b"\n"
                for f in polygons]
        return head + vertices + b"".join(rows)

    forms = {
        ".obj": lambda polygons: "v 0 0 0\n" * 6 + "".join(f"f {' '.join(str(i + 1) for i in f)}\n" for f in polygons),
        ".off": lambda polygons: f"OFF\n6 {len(polygons)} 0\n" + "0 0 0\n" * 6
                                 + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in polygons),
        "free.off": lambda polygons: f"OFF 6 {len(polygons)} 0\n" + "0 0 0 " * 6
                                     + "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in polygons),
        "a.ply": lambda polygons: ply(None, polygons), "l.ply": lambda polygons: ply("<", polygons),
        "b.ply": lambda polygons: ply(">", polygons),
    }
    for form, write in forms.items():
        run.write("a" + form, write(shapes))
        run.write("b" + form, write(others))
        run.write("c" + form, write(shapes[:1] + others[1:3] + shapes[3:]))
        for other, expected in (("b", 3), ("c", 1)):
            found = result(run, "a" + form, other + form, "--tolerance", "9")
            equal((counts(found), found["complete"]), ({"topology": expected}, True), form)
            differ(run, "a" + form, other + form)


@case
def a_normal_is_never_worse_than_a_position(run):
    """A normal that differs more, and before, is not worse than a position."""
    a, n = [[0.0, 0, 0]] * 3, [[0.0, 0, 1]] * 3
    for form, write in FORMS.items():
        run.write("a" + form, write(a, n))
        run.write("b" + form, write([*a[:2], [0.0, 0.25, 0]], [[0.0, 8, 1], *n[1:]]))
        found = result(run, "a" + form, "b" + form)
        equal((counts(found), found["worst"]["difference"]), ({"position": 1, "normal": 1}, 0.25), form)
        equal(found["first"]["kind"], "normal" if form.endswith((".off", ".ply")) else "position", form)
        differ(run, "a" + form, "b" + form)


@case
def no_tolerance_lets_texture_coordinates_and_colours_pass(run):
    """No tolerance lets them pass. One difference a vertex."""
    ply = ("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n"
           "property float t\nproperty uchar red\nend_header\n0 0 0 0.5 0.5 7\n1 1 1 0 0 7\n")
    run.write("a.ply", ply)
    run.write("b.ply", ply.replace("0.5 0.5 7", "0.5 0.25 8"))
    equal(counts(result(run, "a.ply", "b.ply", "--tolerance", "9r")), {"texcoord": 1, "other": 1})
    run.write("a.off", "STOFF\n2 0 0\n0 0 0 0.5 0.5\n1 1 1 0 0\n")
    run.write("b.off", "STOFF\n2 0 0\n0 0 0 0.25 0.25\n1 1 1 0 0\n")
    equal(counts(result(run, "a.off", "b.off", "--tolerance", "9r")), {"texcoord": 1})


# glTF


def triangle(points, texcoords=((0, 0), (1, 0), (0, 1)), indices=(0, 1, 2), targets=(), tangents=(), nodes=None, padding=b""):
    """An asset of one triangle with all that is compared, each in a bufferView of its own, and the buffer."""
    asset = {"asset": {"version": "2.0"}, "scene": 0, "nodes": nodes or [{"mesh": 0}], "bufferViews": [], "accessors": []}
    asset["scenes"] = [{"nodes": list(range(len(asset["nodes"])))}]
    data = b""

    def add(kind, component, form, values, **more):
        nonlocal data
        raw = b"".join(struct.pack("<" + form, *v) for v in values) + padding
        asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)})
        data += raw + bytes(-len(raw) % 4)
        asset["accessors"].append({"bufferView": len(asset["bufferViews"]) - 1, "componentType": component,
                                   "count": len(values), "type": kind, **more})
        return len(asset["accessors"]) - 1

    def bounds(values):
        return {key: [edge(v[i] for v in values) for i in range(3)] for key, edge in (("min", min), ("max", max))}

    attributes = {"POSITION": add("VEC3", 5126, "3f", points, **bounds(points)),
                  "NORMAL": add("VEC3", 5126, "3f", [(0, 0, 1)] * len(points)),
                  "TEXCOORD_0": add("VEC2", 5126, "2f", texcoords)}
    if tangents:
        attributes["TANGENT"] = add("VEC4", 5126, "4f", tangents)
    primitive = {"attributes": attributes, "indices": add("SCALAR", 5123, "H", [(i,) for i in indices])}
    if targets:
        primitive["targets"] = [{"POSITION": add("VEC3", 5126, "3f", t, **bounds(t))} for t in targets]
    asset["meshes"] = [{"primitives": [primitive]}]
    asset["buffers"] = [{"byteLength": len(data)}]
    return asset, data


CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
MOVED = [(0, 0, 0), (1, 0.5, 0), (0, 1.5, 0)]


def compare_assets(run, a, b, *arguments):
    for name, asset in (("a.glb", a), ("b.glb", b)):
        run.write(name, glb(*asset))
    found = result(run, "a.glb", "b.glb", *arguments)
    (same if found["equal"] else differ)(run, "a.glb", "b.glb", *arguments)
    return found


@case
def vertices_of_gltf_count_one_by_one(run):
    """Vertices, texture coordinates, indices and tangents are counted one by one; positions under each node."""
    base = triangle(CORNERS)
    equal(counts(compare_assets(run, base, triangle(MOVED))), {"position": 2})
    found = compare_assets(run, base, triangle(MOVED, texcoords=((0, 0.5), (1, 0), (1, 1)), indices=(0, 2, 1)))
    equal(counts(found), {"position": 2, "texcoord": 2, "topology": 2})
    equal((found["first"]["message"], found["worst"]["difference"]), ("/accessors/0: vertex 1: y differs by 0.5", 0.5))
    equal(counts(compare_assets(run, base, triangle(MOVED, indices=(0, 2, 1)), "--tolerance", "0.5")), {"topology": 2})
    twice = [{"mesh": 0}, {"mesh": 0, "scale": [4, 4, 4]}]
    found = compare_assets(run, triangle(CORNERS, nodes=twice), triangle(MOVED, nodes=twice), "--tolerance", "0.5")
    equal((counts(found), found["worst"]["difference"], found["positions_compared"]), ({"position": 2}, 2, 6))
    tangents = [(1, 0, 0, 1)] * 3
    found = compare_assets(run, triangle(CORNERS, tangents=tangents),
                           triangle(CORNERS, tangents=[(1, 0, 0, 1), (1, 0.25, 0, 1), (1, 0, 0, -1)]),
                           "--normal-tolerance", "0.25")
    equal((counts(found), found["worst"]["difference"]), ({"tangent": 1}, 2))


@case
def morph_targets_of_gltf(run):
    """Offsets are lengths like positions: under a node that scales them too."""
    nodes = [{"mesh": 0, "scale": [2, 2, 2], "translation": [5, 6, 7]}]
    a, b = (triangle(CORNERS, targets=[CORNERS, offsets], nodes=nodes) for offsets in (CORNERS, MOVED))
    equal(counts(compare_assets(run, a, b)), {"position": 2})
    equal(counts(compare_assets(run, a, b, "--tolerance", "0.9999")), {"position": 2})
    equal(compare_assets(run, a, b, "--tolerance", "1")["equal"], True)


@case
def hidden_differences_of_gltf(run):
    """What a matrix without an inverse hides, or what it is too large to show, is a difference all the same."""
    tiny = [(0, 0, 0), (1, 0, 0), (0, 1, 1e-6)]
    for nodes in ([{"mesh": 0, "scale": [1, 1, 0]}], [{"mesh": 0, "translation": [1e30, 1e30, 1e30]}], [{}]):
        equal(counts(compare_assets(run, triangle(CORNERS, nodes=nodes), triangle(tiny, nodes=nodes))), {"position": 1}, str(nodes))
        equal(compare_assets(run, triangle(CORNERS, nodes=nodes), triangle(tiny, nodes=nodes), "--tolerance", "1e-5")["equal"], True)


@case
def differences_of_json_count_beside_those_of_buffers(run):
    """Differences of the JSON are counted beside those of the buffers, unless the latter cannot be matched."""
    def with_extras(asset, **members):
        return {**asset[0], **members}, asset[1]

    base, moved = triangle(CORNERS), triangle(MOVED)
    a = with_extras(base, extras={"a": 1, "b": [1, 2], "c": "x", "d": None}, materials=[{"name": "m"}])
    b = with_extras(moved, extras={"a": 2, "b": [1, 3], "c": "y", "e": True}, materials=[{"name": "n"}])
    found = compare_assets(run, a, b)
    equal((counts(found), found["complete"]), ({"position": 2, "other": 6}, True))
    equal(found["first"]["kind"], "other")
    check("/extras/a: 1 and 2" in found["first"]["message"], found["first"])
    fewer = triangle(CORNERS[:2], texcoords=((0, 0), (1, 0)), indices=(0, 1, 1))
    equal(compare_assets(run, base, fewer)["complete"], False)
    # Bounds count where the elements are the same.
    wrong = json.loads(json.dumps(base[0]))
    wrong["accessors"][0]["max"] = [1, 2, 0]
    equal(counts(compare_assets(run, base, (wrong, base[1]))), {"other": 1})
    # Bytes that no accessor shows: one difference a bufferView.
    equal(counts(compare_assets(run, triangle(CORNERS, padding=b"aaaa"), triangle(MOVED, padding=b"bbbb"))),
          {"position": 2, "other": 4})


def sparse_triangle(values, base=CORNERS):
    asset, data = triangle(base)
    start = len(data)
    data += struct.pack("<2H", 1, 2) + b"".join(struct.pack("<3f", *v) for v in values)
    asset["bufferViews"] += [{"buffer": 0, "byteOffset": start, "byteLength": 4},
                             {"buffer": 0, "byteOffset": start + 4, "byteLength": 24}]
    views = len(asset["bufferViews"])
    asset["accessors"][0]["sparse"] = {"count": 2, "indices": {"bufferView": views - 2, "componentType": 5123},
                                       "values": {"bufferView": views - 1}}
    asset["accessors"][0].update({"min": [0, 0, 0], "max": [9, 9, 9]})
    asset["buffers"] = [{"byteLength": len(data)}]
    return asset, data


@case
def sparse_positions_of_gltf(run):
    a, b = sparse_triangle([(3, 3, 3), (4, 4, 4)]), sparse_triangle([(3, 3, 3), (4, 4.5, 4)])
    equal(counts(compare_assets(run, a, b)), {"position": 1})
    equal(compare_assets(run, a, b, "--tolerance", "0.5")["equal"], True)
    # The byte that the sparse values cover belongs to no position, but to the file.
    equal(counts(compare_assets(run, a, sparse_triangle([(3, 3, 3), (4, 4, 4)], MOVED), "--tolerance", "9")), {"other": 1})


@case
def json_is_valid_whatever_files_are_called(run):
    """The JSON is valid whatever the files are called, and what is in them."""
    for name in ('quote".obj', "back\\slash.obj", "line\nbreak.obj", "tab\t.obj", "\u00fc\u4e2d.obj", "' .obj"):
        run.write(name, CUBE)
        equal(result(run, name, name)["a"], name)
    raw = os.fsdecode(b"\xff\xfe.obj")
    run.write(raw, CUBE)
    equal(result(run, raw, raw)["b"], "\ufffd\ufffd.obj")
    for word in (b'"', b"\\", b"\xff", b"\xc3\x28", b"\x01\x1f", "\u4e2d".encode() * 200):
        run.write("a.obj", b"g " + word + b"\n")
        run.write("b.obj", b"g x\n")
        equal(counts(result(run, "a.obj", "b.obj")), {"other": 1})


@case
def json_is_data_even_with_quiet(run):
    """Of streams too; also with -q, for it is data; nothing of a failure."""
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE.replace("1", "2"))
    found = result(run, "-", "a.obj", "--input-format", "obj", stdin=CUBE.encode())
    equal((found["a"], found["b"], found["equal"]), ("-", "a.obj", True))
    equal(result(run, "b.obj", "-", "--input-format", "obj", stdin=CUBE.encode())["equal"], False)
    equal(result(run, "a.obj", "b.obj", "-q"), result(run, "a.obj", "b.obj"))
    run.ffd("compare", "a.obj", "none.obj", "--json", code=IO, out="")


@case
def broken_files_are_compared_or_refused(run):
    """Files with random changes of their bytes: an answer or a refusal, never more."""
    draw = random.Random(SEED + 1)
    a, n = [[float(i), i * i / 8, 1.0] for i in range(6)], [[0, 0, 1.0]] * 6
    whole = {form: write(a, n) for form, write in FORMS.items()}
    whole["s.glb"] = glb(*sparse_triangle([(3, 3, 3), (4, 4, 4)]))
    whole["m.glb"] = glb(*triangle(CORNERS, targets=[CORNERS], tangents=[(1, 0, 0, 1)] * 3))
    for form, content in whole.items():
        content = content.encode() if isinstance(content, str) else content
        run.write("a" + form, content)
        for _ in range(25):
            other = bytearray(content)
            for _ in range(draw.choice([1, 1, 3])):
                other[draw.randrange(len(other))] = draw.choice([*b"0123456789-e. \n", 0, 255, draw.randrange(256)])
            run.write("b" + form, bytes(other[:draw.choice([len(other), len(other), draw.randrange(len(other))])]))
            for names in (("a" + form, "b" + form), ("b" + form, "a" + form)):
                done = run.ffd("compare", *names, "--json", "--tolerance", "1e-3r", "-q", code=(0, 1, 3, 4, 6, 7))
                if done.code <= NO:
                    json.loads(done.text, parse_constant=no_constant)


@case
def models_are_equal_to_themselves(run):
    """And differ from what a lattice makes of them, but for what it leaves."""
    run.write("l.json", {"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"},
                         "moves": [{"by": [0.25, 0, 0]}]})
    data = os.path.join(os.path.dirname(__file__), "../../data/models")
    for name in sorted(os.listdir(data)):
        stem, ending = os.path.splitext(name)
        if ending not in (".obj", ".glb", ".gltf", ".ply", ".off", ".stl"):
            continue
        path = os.path.join(data, name)
        same(run, path, path)
        moved = f"{stem}-moved{ending}"
        run.ffd("deform", path, moved, "-l", "l.json", "--normals", "keep", "-q")
        found = result(run, path, moved)
        equal((list(counts(found)), found["complete"]), (["position"], True), name)


@case
def folders_are_compared_mesh_by_mesh(run):
    run.write("A/x.obj", CUBE)
    run.write("A/sub/y.OBJ", CUBE)
    run.write("A/sub/notes.txt", "A")
    for name in ("B/x.obj", "B/sub/y.OBJ"):
        run.write(name, CUBE.replace("v -1 -1 -1", "v -1.0 -1 -1"))
    run.write("B/sub/notes.txt", "B")
    run.ffd("compare", "A", "B", "--recursive", out="")
    found = run.ffd("compare", "A/", "B", "--recursive", "--json").json
    equal([found["equal"], found["a"], found["b"], [(f["name"], f["equal"], f["error"]) for f in found["files"]], found["only_a"], found["only_b"]],
          [True, "A/", "B", [("sub/y.OBJ", True, None), ("x.obj", True, None)], [], []])
    run.write("B/x.obj", CUBE.replace("v -1 -1 -1", "v -1.25 -1 -1"))
    run.write("A/broken.obj", "v 1")
    run.write("B/broken.obj", CUBE)
    run.write("A/only.ply", "")
    run.write("B/sub/deep/only.off", "")
    os.symlink("..", run.path("B/sub/loop"))
    os.symlink("../B/x.obj", run.path("B/link.obj"))
    found = run.ffd("compare", "A", "B", "--recursive", "--json", code=NO).json
    equal((found["equal"], found["only_a"], found["only_b"]), (False, ["only.ply"], ["link.obj", "sub/deep/only.off"]))
    broken, moved, same = sorted(found["files"], key=lambda file: file["name"] != "broken.obj" and file["name"] != "x.obj")[:2] + [found["files"][1]]
    equal(broken, {"name": "broken.obj", "equal": False, "error": "A/broken.obj:1: a vertex needs 3 numbers, found 1"})
    equal((same["name"], same["equal"]), ("sub/y.OBJ", True))
    single = run.ffd("compare", "A/x.obj", "B/x.obj", "--json", code=NO).json
    equal(moved, {"name": "x.obj", "error": None, **{name: value for name, value in single.items() if name not in ("format", "version", "a", "b")}})
    done = run.ffd("compare", "A", "B", "--recursive", code=NO, err="A/broken.obj:1: a vertex needs 3 numbers, found 1")
    lines = done.text.splitlines()
    equal(lines[-1], "1 the same, 1 different, 1 only in A, 2 only in B, 1 not readable")
    equal([line.split(":")[0] for line in lines[:-1]], ["only in B", "only in A", "only in B", "x.obj"])
    run.ffd("compare", "A", "B", "--recursive", "-q", code=NO, err="A/broken.obj:1: a vertex needs 3 numbers, found 1", out="")
    run.remove("A/broken.obj")
    for name in ("A/only.ply", "B/broken.obj", "B/link.obj", "B/sub/deep/only.off"):
        run.remove(name)
    run.ffd("compare", "A", "B", "--recursive", "--tolerance", "0.25", out="")


@case
def folders_that_cannot_be_compared(run):
    run.write("A/x.obj", CUBE)
    run.write("E/notes.txt", "")
    run.ffd("compare", "A", "none", "--recursive", code=IO, err=re.compile("^none: cannot be read as a folder"))
    run.ffd("compare", "A/x.obj", "A", "--recursive", code=IO, err=re.compile("^A/x.obj: cannot be read as a folder"))
    for words in (["A"], ["A", "-"], ["-", "A"], ["A", "A", "--input-format", "obj"], ["A", "A", "A"]):
        run.ffd("compare", *words, "--recursive", code=USAGE)
    run.ffd("compare", "E", "E", "--recursive", err="E and E: neither has a mesh: nothing was compared")


main()
