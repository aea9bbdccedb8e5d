#!/usr/bin/env python3
"""OFF and STL files, with readers of their own here: what deform changes in them, what the other commands say of
them, and what is refused."""
import math
import os
import re
import struct

from harness import (INVALID, IO, MODELS, NO, UNSUPPORTED, carried, case, check, equal, float32, lattice, main, models, near,
                     threaded_case)
from vectors import cross, minus

BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]
POINTS = [[0.1, 0.2, 0.3], [-1.5, 0.25, 1.75], [0.0, 0.0, 0.0], [1.0 / 3, -2.0 / 3, 1e-3], [5.0, 5.0, 5.0]]
NORMALS = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]
FACES = [[0, 1, 2], [0, 2, 3, 1]]
OUTSIDE = {"lines": 1}  # one of POINTS is outside of the lattice, which is said


def row(numbers):
    return " ".join(repr(x) for x in numbers)


def off(points=POINTS, keyword="OFF", behind="", faces=FACES, end="\n"):
    lines = [keyword, f"{len(points)} {len(faces)} 0", "# vertices", ""]
    lines += [row(p) + (" " + row(n) if "N" in keyword else "") + behind for p, n in zip(points, NORMALS)]
    lines += [f"{len(f)}  " + " ".join(map(str, f)) + " 0.5 0.25 1" for f in faces]
    return end.join(lines + [""])


def off_numbers(text, first, last):
    """Columns of the lines of vertices."""
    lines = [line.split("#")[0].split() for line in re.split("\r\n|\r|\n", text)]
    lines = [words for words in lines if words]
    count = int(lines[1][0])
    return [[float(x) for x in words[first:last]] for words in lines[2:2 + count]]


def obj_of(points, normals=False):
    return ("".join("v %r %r %r\n" % tuple(p) for p in points)
            + ("".join("vn %r %r %r\n" % tuple(n) for n in NORMALS) if normals else "")
            + "".join("f " + " ".join(f"{i + 1}//{i + 1}" if normals else str(i + 1) for i in f) + "\n" for f in FACES)
            + ("p 5\nf 5//5 5//5 5//5\n" if normals else ""))


def words(data):
    return re.split(rb"(\s+)", data)


def same_but_numbers(name, before, after):
    """Words that differ are numbers that differ; all that is between the words is the same."""
    changed = 0
    for a, b in zip(words(before), words(after), strict=True):
        check(a == b or float(a) != float(b), f"{name}: {a} became {b}")
        changed += a != b
    return changed


@case
def off_positions_are_those_of_obj(run):
    """The same positions get the same bits; every other byte stays, in any dialect."""
    run.write("l.json", lattice(moves=BUMP))
    expected = carried(run, POINTS, "l.json", **OUTSIDE)
    check(expected[0] != POINTS[0], "the lattice moves")
    for end in ("\n", "\r\n", "\r"):
        for keyword, behind in (("OFF", ""), ("OFF", " 255 128 0"), ("COFF", " 1 0 0.5 1"), ("STOFF", " 0.5 0.25"),
                                ("STCNOFF", " 255 0 0 255 0.5 0.25")):
            before = off(keyword=keyword, behind=behind, end=end)
            run.write("p.off", before)
            run.ffd("deform", "p.off", "q.off", "-l", "l.json", "--normals", "keep", "--force", **OUTSIDE)
            after = run.read("q.off").decode()
            equal(off_numbers(after, 0, 3), expected, keyword)
            equal(after, off(expected, keyword, behind, end=end), "every other byte")


@case
def off_texts_that_need_not_change_stay(run):
    text = ("\n# a file\nCOFF # with comments\r\n 2 1   0 # counts\r\n\r\n +.50\t-1.50 1e0  007 0 0 1# first\r"
            "5.000 5 5.0e0 1 1 1 1\n  3 0 1 00  2# face\n\n\n# the end")
    run.write("l.json", lattice(moves=[{"by": [0, 0.25, 0]}]))
    run.write("t.off", text)
    run.ffd("deform", "t.off", "u.off", "-l", "l.json",
            err=["t.off: 1 of 2 vertices is not inside: 1 outside (left where it is)",
                 "t.off: 1 vertex stays; the largest step to a neighbour is 0.25 (see --outside extend, --falloff, a larger "
                 "lattice)"])
    equal(run.read("u.off").decode(), text.replace("-1.50", "-1.25"))
    run.write("still.json", lattice())
    run.ffd("deform", "t.off", "v.off", "-l", "still.json", **OUTSIDE)
    equal(run.read("v.off").decode(), text)


@case
def off_words_in_a_row(run):
    run.write("l.json", lattice(moves=[{"by": [0, 0.25, 0]}]))
    run.write("t.off", "OFF 3 1 0 0 0.0 0  1 0 0\t0 1 0 3 0 1 2 9")
    run.ffd("deform", "t.off", "u.off", "-l", "l.json")
    equal(run.text("u.off"), "OFF 3 1 0 0 0.25 0  1 0.25 0\t0 1.25 0 3 0 1 2 9")


@case
def normals_of_off_follow_those_of_obj(run):
    """They follow as those of an OBJ do; --normals keep leaves their bytes."""
    run.write("l.json", lattice(moves=BUMP))
    run.write("p.obj", obj_of(POINTS, True))
    run.ffd("deform", "p.obj", "q.obj", "-l", "l.json", **OUTSIDE)
    expected = [[float(x) for x in line.split()[1:]] for line in run.text("q.obj").splitlines() if line.startswith("vn ")]
    check(expected[0] != NORMALS[0], "the normals turn")
    for keyword, behind in (("NOFF", ""), ("CNOFF", " 9 9 9 9")):
        run.write("p.off", off(keyword=keyword, behind=behind))
        run.ffd("deform", "p.off", "q.off", "-l", "l.json", "--force", **OUTSIDE)
        equal(off_numbers(run.text("q.off"), 3, 6), expected, keyword)
        run.ffd("deform", "p.off", "k.off", "-l", "l.json", "--normals", "keep", "--force", **OUTSIDE)
        equal(off_numbers(run.text("k.off"), 3, 6), NORMALS, keyword)
        equal(off_numbers(run.text("k.off"), 0, 3), off_numbers(run.text("q.off"), 0, 3), keyword)


def streams(run, name, data, **options):
    """Through pipes, in place and under a capital name the same bytes come out."""
    ending = name.split(".")[1]
    run.write("l.json", lattice(moves=BUMP))
    run.write(name, data)
    run.ffd("deform", name, "out." + ending, "-l", "l.json", "--force", **options)
    done = run.ffd("deform", "-", "-", "-l", "l.json", "--input-format", ending, "--output-format", ending,
                   stdin=run.read(name), **options)
    equal(done.out, run.read("out." + ending), "through the streams")
    check(done.out != run.read(name), "the lattice moves")
    capital = "P." + ending.upper()
    run.write(capital, data)
    run.ffd("deform", capital, "--in-place", "-l", "l.json", **options)
    equal(run.read(capital), run.read("out." + ending), "in place")
    for threads in ("1", "3"):
        run.ffd("deform", name, "t." + ending, "-l", "l.json", "--threads", threads, "--force", **options)
        equal(run.read("t." + ending), done.out, "with threads")


@case
def off_files_go_through_streams(run):
    streams(run, "p.off", off(keyword="NOFF"), **OUTSIDE)


def as_obj(run, name, ending, points, **options):
    """embed, lattice new and check see a mesh as they see an OBJ with the same vertices and faces."""
    run.write("l.json", lattice(moves=BUMP))
    for path in (name + "." + ending, name + ".obj"):
        run.ffd("embed", path, "-l", "l.json", "-o", path + ".npy", "--status", path + ".s.npy", **options)
        run.ffd("lattice", "new", path, "-o", path + ".json")
        run.ffd("check", path, "-l", "l.json", "--report", path + ".report", "--report-stable", **options)
    mine, other = name + "." + ending, name + ".obj"
    equal(run.read(mine + ".npy")[:128 + 24 * points], run.read(other + ".npy")[:128 + 24 * points], "u,v,w")
    equal(run.read(mine + ".s.npy")[:128 + points], run.read(other + ".s.npy")[:128 + points], "statuses")
    equal(run.read(mine + ".json"), run.read(other + ".json"), "the lattice")
    equal(run.text(mine + ".report").replace("." + ending, ".obj"), run.text(other + ".report"), "the report")


@case
def off_embedding_and_lattice(run):
    run.write("p.off", off())
    run.write("p.obj", obj_of(POINTS))
    as_obj(run, "p", "off", len(POINTS), **OUTSIDE)
    run.ffd("deform", "p.off", "e.off", "-l", "l.json", "--embedding", "p.off.npy", **OUTSIDE)
    run.ffd("deform", "p.off", "f.off", "-l", "l.json", **OUTSIDE)
    equal(run.read("e.off"), run.read("f.off"), "with the embedding")


@case
def facts_of_off_files_are_right(run):
    run.write("p.off", off(keyword="CNOFF", behind=" 255 0 0 255", end="\r\n") + "\r\n\r\nmore")
    found = run.ffd("info", "p.off", "--json", err="p.off: line 14: 4 bytes stand behind the faces that the header states: "
                                                   "they stay as they are").json
    equal([found[key] for key in ("mesh_format", "vertices", "normals", "not_finite")], ["OFF", 5, 5, 0])
    equal(found["contents"], {"keyword": "CNOFF", "vertices": 5, "vertices_with_color": 5, "normals": 5, "texcoords": 0,
                              "faces": 2, "faces_with_color": 2, "triangles": 1, "quads": 1, "ngons": 0, "lines": 0,
                              "points": 0, "bytes_behind": 4, "line_endings": "CRLF"})
    equal([found["topology"][key] for key in ("faces", "isolated_vertices")], [2, 1])
    run.write("n.off", "1 0 0\n1 2 3\n")
    equal(run.ffd("info", "n.off", "--json").json["contents"]["keyword"], None)


@case
def off_files_are_the_same_by_their_numbers(run):
    run.write("a.off", off())
    run.write("b.off", off(end="\r\n").replace("0.1 0.2", "1e-1  .2") + "# more\n")
    run.ffd("compare", "a.off", "b.off", out="")
    run.write("m.off", off([[0.1, 0.45, 0.3]] + POINTS[1:]))
    run.ffd("compare", "a.off", "m.off", code=NO,
            out="a.off and m.off differ: vertex 0 counted from 0 (line 5): y differs by 0.25\n")
    run.ffd("compare", "a.off", "m.off", "--tolerance", "0.25", out="")
    run.write("c.off", off().replace("0.5 0.25 1", "0.5 0.25 0"))
    run.ffd("compare", "a.off", "c.off", "--tolerance", "9", code=NO)


def refused(run, ending, content, code, says):
    run.write("p" + ending, content)
    run.ffd("deform", "p" + ending, "q" + ending, "-l", "l.json", code=code, err=says)
    check(not run.exists("q" + ending), "an output of a failure")


@case
def broken_off_files_are_refused(run):
    run.write("l.json", lattice())
    for content, code, says in (
            (b"", INVALID, "p.off:1: the file has no content"),
            ("OFF BINARY\n" + "\0" * 100, UNSUPPORTED, "p.off:1: the binary form of OFF is not supported: \"BINARY\""),
            ("4OFF\n1 0 0\n0 0 0 1\n", UNSUPPORTED,
             "p.off:1: vertices with more or less than three coordinates are not supported: \"4OFF\""),
            ("OFF\n2147483648 1 0\n0 0 0\n", INVALID,
             "p.off:2: 2147483648 vertices and 1 face are stated, more than the 7 bytes that follow can hold"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", INVALID,
             "p.off:6: there is no vertex 3, only 3 (counted from 0)"),
            ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", INVALID, "p.off:4: a vertex needs 3 numbers, found 2"),
            ("# " + "x" * 100000, INVALID, "p.off:1: the file has no content")):
        refused(run, ".off", content, code, says)
    run.folder_of("d.off")
    run.ffd("deform", "d.off", "r.off", "-l", "l.json", code=IO)


def write_model_lattices(run):
    for out, moves in (("still.json", []), ("moved.json", [{"at": [[2, 3], [2, 3], [2, 3]], "by": [0.125, 0, 0.25]}])):
        run.write(out, lattice(rest={"box": "mesh"}, moves=moves, units="box"))


def still_then_moved(run, name, path, before):
    """A lattice that moves nothing copies the file; the output of the other."""
    out = "q" + os.path.splitext(path)[1].lower()
    run.ffd("deform", path, out, "-l", "still.json", "--force")
    equal(run.read(out), before, name)
    run.ffd("deform", path, out, "-l", "moved.json", "--force")
    return run.read(out)


def other_commands(run, path):
    for command in (["info", path], ["compare", path, path], ["check", path, "-l", "moved.json"],
                    ["lattice", "new", path, "-o", "new.json", "--force"],
                    ["embed", path, "-l", "still.json", "-o", "e.npy", "--force"]):
        run.ffd(*command)


@threaded_case
def sample_models_of_off_are_copied_and_deformed(run):
    """An empty move copies each sample; a real one takes each vertex where the lattice takes its position, and
    changes nothing else."""
    found = models(".off")
    write_model_lattices(run)
    for name, path, before in found:
        after = still_then_moved(run, name, path, before)
        start, end = off_numbers(before.decode(), 0, 3), off_numbers(after.decode(), 0, 3)
        equal(end, carried(run, start, "moved.json"), name)
        check(end != start and all(a[1] == b[1] for a, b in zip(start, end)), name, "moves along x and z")
        equal(same_but_numbers(name, before, after),
              sum(a != b for p, q in zip(start, end) for a, b in zip(p, q)), f"{name}: words that changed")
        other_commands(run, path)
    check(not MODELS or len(found) >= 7, f"{len(found)} models")


# STL

def cube_facets():
    """Two triangles a side of the unit cube, at places whose coordinates are no short floats."""
    corners = [[x * 0.7 + 0.1, y * 0.7 - 0.1, z * 0.7 + 0.05] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return [[corners[q[i]] for i in triangle] for q in quads for triangle in ((0, 1, 2), (0, 2, 3))]


def cross_normal(facet):
    a, b, c = facet
    n = cross(minus(b, a), minus(c, a))
    length = math.hypot(*n)
    return [x / length for x in n]


def binary_stl(facets, normals, header=b"a test", attributes=None):
    data = header.ljust(80, b"\0") + struct.pack("<I", len(facets))
    for i, (facet, normal) in enumerate(zip(facets, normals)):
        data += struct.pack("<12f", *normal, *(x for p in facet for x in p))
        data += struct.pack("<H", attributes[i] if attributes else 0)
    return data


def text_stl(facets, normals, name="a test", end="\n"):
    lines = [f"solid {name}"]
    for facet, normal in zip(facets, normals):
        lines += [f"  facet normal {row(normal)}", "    outer loop", *(f"      vertex   {row(p)}" for p in facet),
                  "    endloop", "  endfacet"]
    return end.join(lines + [f"endsolid {name}", ""])


def read_stl(data):
    """Facets and normals."""
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        values = [struct.unpack_from("<12f", data, 84 + 50 * i) for i in range(count)]
    else:
        number = rb"\s+(\S+)\s+(\S+)\s+(\S+)"
        found = re.findall(rb"(?i)normal" + number + rb"\s+outer\s+loop" + (rb"\s+vertex" + number) * 3, data)
        values = [[float(x) for x in facet] for facet in found]
    return ([[list(v[i:i + 3]) for i in (3, 6, 9)] for v in values], [list(v[:3]) for v in values])


def flat(facets):
    return [p for facet in facets for p in facet]


def rounded(points):
    return [[float32(x) for x in p] for p in points]


@case
def stl_texts_get_the_numbers_of_obj(run):
    """Positions get the bits that those of an OBJ do; normals are those of the corners as written; all else stays."""
    run.write("l.json", lattice(moves=BUMP))
    facets = cube_facets()
    normals = [cross_normal(f) for f in facets]
    expected = carried(run, flat(facets), "l.json")
    for end in ("\n", "\r\n", "\r"):
        before = text_stl(facets, normals, "the name  of it", end).replace("vertex   0.8", "VERTEX +.8e0")
        run.write("t.stl", before)
        run.ffd("deform", "t.stl", "u.stl", "-l", "l.json", "--force")
        after = run.read("u.stl")
        moved, turned = read_stl(after)
        equal(flat(moved), expected, "positions")
        check(flat(moved) != flat(facets) and turned != normals, "the lattice moves")
        near(turned, [cross_normal(f) for f in moved], 1e-15, "normals")
        check(same_but_numbers("t.stl", before.encode(), after) > 30, "words that changed")
        run.ffd("deform", "t.stl", "k.stl", "-l", "l.json", "--normals", "keep", "--force")
        equal(read_stl(run.read("k.stl")), (moved, normals), "--normals keep")


@case
def binary_stl_files_get_rounded_numbers(run):
    run.write("l.json", lattice(moves=BUMP))
    facets = [rounded(f) for f in cube_facets()]
    normals = rounded([cross_normal(f) for f in facets])
    attributes = [0x8000 + 7 * i for i in range(len(facets))]
    expected = rounded(carried(run, flat(facets), "l.json"))
    for header in (b"a test", b"solid of a binary file", b"solid" + b"x" * 75):
        before = binary_stl(facets, normals, header, attributes)
        run.write("b.stl", before)
        run.ffd("deform", "b.stl", "c.stl", "-l", "l.json", "--force")
        after = run.read("c.stl")
        moved, turned = read_stl(after)
        equal(flat(moved), expected, "positions")
        near(turned, [cross_normal(f) for f in moved], 1e-7, "normals")
        equal(after, binary_stl(moved, turned, header, attributes), "every other byte")
        check(turned != normals, "the normals turn")


@case
def stl_equal_positions_stay_equal(run):
    """Corners that met meet still, in the same file and in another."""
    run.write("l.json", lattice(moves=BUMP))
    facets = [rounded(f) for f in cube_facets()]
    normals = [cross_normal(f) for f in facets]
    places = {}
    for order in (facets, facets[::-1], [f[1:] + f[:1] for f in facets]):
        run.write("b.stl", binary_stl(order, normals))
        run.ffd("deform", "b.stl", "c.stl", "-l", "l.json", "--force", "--threads", "2")
        for old, new in zip(flat(order), flat(read_stl(run.read("c.stl"))[0])):
            equal(struct.pack("<3f", *new), places.setdefault(tuple(old), struct.pack("<3f", *new)), str(old))
    equal(len(places), 8, "corners of the cube")
    equal(run.ffd("info", "c.stl", "--json").json["topology"]["vertices"], 8, "corners that topology joins")


@case
def stl_normals_that_stay(run):
    """Facets that do not move, have no area or no normal keep theirs."""
    run.write("l.json", lattice(moves=[{"by": [0.25, 0, 0]}]))
    facets = [[[3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 1.0]], [[0.0, 0.0, 0.0]] * 3, cube_facets()[0],
              [[0.5, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, 0.0, 1.0]]]
    normals = [[0.0, 0.0, 2.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0], [-3.0, 0.0, 1.0]]
    run.write("t.stl", text_stl(facets, normals))
    run.ffd("deform", "t.stl", "u.stl", "-l", "l.json",
            err="t.stl: 3 of 12 vertices are not inside: 3 outside (left where they are)")
    moved, turned = read_stl(run.read("u.stl"))
    equal(moved[0], facets[0])
    near([p[0] - q[0] for p, q in zip(flat(moved[1:]), flat(facets[1:]))], [0.25] * 9, 1e-14)
    equal(turned, normals[:3] + [[-1.0, 0.0, 0.0]], "the last points against the order of its corners, as before")


@case
def every_solid_of_an_stl_text_is_deformed(run):
    text = ("SOLID first\r\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1.0 0 0 vertex 0 1 0 endloop endfacet\r\n"
            "endsolid first\r\n\r\nsolid\nendsolid\nsolid second facet normal 0 0 1\nOUTER LOOP\nVertex 0\n0\t1e0 vertex 1 0 1\n"
            "vertex 0 1 1\nENDLOOP\nENDFACET\nendsolid")
    run.write("s.stl", text)
    run.write("l.json", lattice(moves=[{"by": [0, 0, 0.5]}]))
    run.ffd("deform", "s.stl", "u.stl", "-l", "l.json")
    equal(run.read("u.stl").decode(), re.sub(r"(?i)(vertex\s+\S+\s+\S+\s+)(\S+)", lambda m: m[1] + {"0": "0.5"}.get(m[2], "1.5"), text))
    found = run.ffd("info", "s.stl", "--json").json
    equal(found["contents"], {"encoding": "ascii", "facets": 2, "degenerate_facets": 0, "names": ["first", "", "second"],
                              "solids": 3, "line_endings": "mixed"})
    equal([found["topology"][key] for key in ("vertices", "faces", "isolated_vertices", "components")], [6, 2, 0, 2])


@case
def stl_files_go_through_streams(run):
    facets = cube_facets()
    normals = [cross_normal(f) for f in facets]
    streams(run, "p.stl", text_stl(facets, normals))
    streams(run, "b.stl", binary_stl(facets, normals))


@case
def stl_embedding_and_lattice(run):
    facets = cube_facets()
    run.write("p.stl", text_stl(facets, [cross_normal(f) for f in facets]))
    points = flat(facets)
    run.write("p.obj", "".join("v %r %r %r\n" % tuple(p) for p in points)
              + "".join("f " + " ".join(str(1 + points.index(p)) for p in f) + "\n" for f in facets))
    as_obj(run, "p", "stl", 3 * len(facets))


@case
def stl_files_are_the_same_by_their_numbers(run):
    facets = [rounded(f) for f in cube_facets()]
    normals = rounded([cross_normal(f) for f in facets])
    moved = [[list(p) for p in f] for f in facets]
    moved[2][1][0] += 0.25
    run.write("t.stl", text_stl(facets, normals))
    run.write("b.stl", binary_stl(facets, normals))
    run.write("m.stl", text_stl(moved, normals))
    run.ffd("compare", "t.stl", "b.stl", out="")
    run.ffd("compare", "t.stl", "m.stl", code=NO,
            out="t.stl and m.stl differ: facet 2 counted from 0 (line 16), corner 1: x differs by 0.25\n")
    run.ffd("compare", "b.stl", "m.stl", "--tolerance", "0.25", out="")
    run.write("n.stl", text_stl(facets, normals[::-1]))
    run.ffd("compare", "b.stl", "n.stl", "--tolerance", "9", code=NO)


@case
def vertices_that_are_not_finite(run):
    """They keep their bits, and so do the normals of their faces; all others move."""
    run.write("l.json", lattice(moves=[{"by": [0, 0, 0.25]}]))
    kept = r"1 of \d vertices is not inside: 1 invalid \(not finite; left where it is\)"

    def deform(ending, content):
        run.write("p" + ending, content)
        run.ffd("deform", "p" + ending, "q" + ending, "-l", "l.json", "--force", err=re.compile(kept))
        return run.read("q" + ending)

    for text in ("OFF\n2 0 0\n0 0 0\n0 nan 0\n", "OFF\n2 0 0\n0 0 0\n1e999 0 0\n"):
        equal(deform(".off", text).decode(), text.replace("\n0 0 0\n", "\n0 0 0.25\n"))
    # A quiet NaN with a payload, behind the header and the face's normal.
    data = bytearray(binary_stl([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], [[0, 0, 1]]))
    data[108:112] = b"\x34\x12\xc0\x7f"
    moved = bytearray(data)
    for at in (104, 116, 128):
        moved[at:at + 4] = struct.pack("<f", 0.25)
    moved[112 + 4:112 + 8] = data[112 + 4:112 + 8]
    equal(bytes(deform(".stl", bytes(data))), bytes(moved))
    text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf vertex 1 0 0 vertex 0 1 0\nendloop\nendfacet\nendsolid"
    equal(deform(".stl", text).decode(), text.replace("1 0 0", "1 0 0.25").replace("0 1 0", "0 1 0.25"))


@case
def a_nul_byte_makes_no_text_binary(run):
    """A text STL whose size is not that of the count that its bytes would state is read as a text, which a NUL byte spoils."""
    run.write("l.json", lattice())
    good = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    for at, says in ((1, '1: expected solid, found "s\u2400lid"'), (9, '2: expected facet or endsolid, found "f\u2400cet"'),
                     (15, '2: expected normal, found "n\u2400rmal"'), (21, '2: expected a number of the normal, found "\u2400"'),
                     (46, '4: expected a coordinate, found "0\u24000"'), (56, '5: expected vertex, found "verte\u2400"')):
        for ends in ("\n", "\r", "\r\n"):
            text = good[:at] + "\0" + good[at + 1:]
            refused(run, ".stl", text.replace("\n", ends), INVALID, "p.stl:" + says)
    # A binary file that was cut stays one, whatever its header says.
    data = bytearray(binary_stl([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]] * 2, [[0, 0, 1]] * 2))[:-1]
    for header in (b"solid a\n", b"solid facet normal", b"solid " * 13):
        data[:80] = header.ljust(80)
        refused(run, ".stl", bytes(data), INVALID, "p.stl: 2 facets are stated, which take 184 bytes: the file has 183")
    # The other texts name such a byte too.
    refused(run, ".off", "OFF\n3 1 0\n0 0 0\n1 0\0 0\n0 1 0\n3 0 1 2\n", INVALID, 'p.off:4: coordinate y of a vertex is not a number: "0\u2400"')
    refused(run, ".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\0\n", INVALID, 'p.off:6: a corner is not a whole number: "2\u2400"')
    refused(run, ".ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0\0 0\n", INVALID,
            'p.ply:8: y of vertex 0 (counted from 0) is not a number: "0\u2400"')
    # In a name it is nothing but a byte, which stays, with a warning.
    for text, line in ((good.replace(" a\nf", " a\0\nf"), 1), (good.replace("d a\n", "d \0\n"), 1), (good.replace("endsolid a", "endsolid \0"), 9)):
        run.write("p.stl", text)
        done = run.ffd("deform", "p.stl", "q.stl", "-l", "l.json", "--force", err=lambda said: None)
        check(re.match(f"p.stl: line {line}: the name of a solid, .*\u2400.*, holds a NUL character", done.err[0]), done.err)
        equal(run.text("q.stl"), text)
        run.ffd("deform", "p.stl", "q.stl", "-l", "l.json", "--force", "--strict", code=INVALID, err=lambda said: None)


@case
def broken_stl_files_are_refused(run):
    run.write("l.json", lattice())
    good = binary_stl([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], [[0, 0, 1]])
    for content, says in (
            (b"", "p.stl: is not an STL file: it neither begins with \"solid\" nor has, with 0 bytes, the 84 of a binary "
                  "file's header"),
            (good[:-1], "p.stl: 1 facet is stated, which takes 134 bytes: the file has 133"),
            (good[:80] + b"\xff" * 4 + good[84:],
             "p.stl: 4294967295 facets are stated, which take 214748364834 bytes: the file has 134"),
            ("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0 vertex 1 0",
             "p.stl:4: the file ends where a coordinate is expected"),
            ("solid a\n" + "x" * 100000 + "\n",
             "p.stl:2: expected facet or endsolid, found \"" + "x" * 40 + "\"")):
        refused(run, ".stl", content, INVALID, says)
    run.folder_of("d.stl")
    run.ffd("deform", "d.stl", "r.stl", "-l", "l.json", code=IO)
    run.write("far.json", lattice(moves=[{"by": [1e39, 0, 0]}]))
    run.write("p.stl", good)
    run.ffd("deform", "p.stl", "q.stl", "-l", "far.json", code=INVALID)
    run.write("p.stl", text_stl([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], [[0, 0, 1]]))
    run.ffd("deform", "p.stl", "q.stl", "-l", "far.json", err=re.compile("^p.stl: doubles cannot hold: the precision of coordinates that far"))


@threaded_case
def sample_models_of_stl_are_copied_and_deformed(run):
    found = models(".stl")
    write_model_lattices(run)
    for name, path, before in found:
        after = still_then_moved(run, name, path, before)
        (start, old), (end, new) = read_stl(before), read_stl(after)
        check(len(start) > 0 and start != end, name, "moves")
        is_binary = not before.lstrip().startswith(b"solid")
        expected = carried(run, flat(start), "moved.json")
        equal(flat(end), rounded(expected) if is_binary else expected, name)
        for was, now, normal, renewed in zip(start, end, old, new):
            if was == now or renewed == normal:
                equal(renewed, normal, name)
            else:
                sign = 1 if sum(a * b for a, b in zip(cross_normal(was), normal)) >= 0 else -1
                near([sign * x for x in renewed], cross_normal(now), 1e-6, name)
        if is_binary:
            equal(after[:84], before[:84], name)
            for i in range(len(start)):
                equal(after[84 + 50 * i + 48:84 + 50 * i + 50], before[84 + 50 * i + 48:84 + 50 * i + 50], name)
        else:
            same_but_numbers(name, before, after)
        other_commands(run, path)
    check(not MODELS or len(found) >= 7, f"{len(found)} models")


main()
