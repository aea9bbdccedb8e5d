#!/usr/bin/env python3
"""OFF and STL files, with readers of their own here: what deform changes in them, what the other commands say of
them, and what is refused."""
import re

from harness import (CUBE, INVALID, IO, MODELS, NO, UNSUPPORTED, carried, case, check, equal, lattice, main, models)

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
    """Words that differ are numbers that differ; all that stands between the words is the same."""
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
            err="t.off: 1 of 2 vertices are not inside: 1 outside (left where they are)")
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
def off_normals(run):
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
    run.ffd("deform", name, "out." + ending, "-l", "l.json", **options)
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
def off_streams(run):
    streams(run, "p.off", off(keyword="NOFF"), **OUTSIDE)


def as_obj(run, name, ending, points, **options):
    """embed, lattice new and check see a mesh as they see an OBJ with the same vertices and faces."""
    run.write("l.json", lattice(moves=BUMP))
    for path in (name + "." + ending, name + ".obj"):
        run.ffd("embed", path, "-l", "l.json", "-o", path + ".npy", "--status", path + ".s", **options)
        run.ffd("lattice", "new", path, "-o", path + ".json")
        run.ffd("check", path, "-l", "l.json", "--report", path + ".report", "--report-stable", **options)
    mine, other = name + "." + ending, name + ".obj"
    equal(run.read(mine + ".npy")[:128 + 24 * points], run.read(other + ".npy")[:128 + 24 * points], "u,v,w")
    equal(run.read(mine + ".s")[:128 + points], run.read(other + ".s")[:128 + points], "statuses")
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
def off_info(run):
    run.write("p.off", off(keyword="CNOFF", behind=" 255 0 0 255", end="\r\n") + "\r\n\r\nmore")
    found = run.ffd("info", "p.off", "--json").json
    equal([found[key] for key in ("mesh_format", "vertices", "normals", "not_finite")], ["OFF", 5, 5, 0])
    equal(found["contents"], {"keyword": "CNOFF", "vertices": 5, "vertices_with_color": 5, "normals": 5, "texcoords": 0,
                              "faces": 2, "faces_with_color": 2, "triangles": 1, "quads": 1, "ngons": 0, "lines": 0,
                              "points": 0, "bytes_behind": 4, "line_endings": "CRLF"})
    equal([found["topology"][key] for key in ("faces", "isolated_vertices")], [2, 1])
    run.write("n.off", "1 0 0\n1 2 3\n")
    equal(run.ffd("info", "n.off", "--json").json["contents"]["keyword"], None)


@case
def off_compare(run):
    run.write("a.off", off())
    run.write("b.off", off(end="\r\n").replace("0.1 0.2", "1e-1  .2") + "# more\n")
    run.ffd("compare", "a.off", "b.off", out="")
    run.write("m.off", off([[0.1, 0.45, 0.3]] + POINTS[1:]))
    run.ffd("compare", "a.off", "m.off", code=NO,
            out="a.off and m.off differ: vertex 0 counted from 0 (line 5): y differs by 0.25\n")
    run.ffd("compare", "a.off", "m.off", "--tolerance", "0.25", out="")
    run.write("c.off", off().replace("0.5 0.25 1", "0.5 0.25 0"))
    run.ffd("compare", "a.off", "c.off", "--tolerance", "9", code=NO)


@case
def off_refused(run):
    run.write("l.json", lattice())
    for content, code, says in (
            (b"", INVALID, "p.off:1: the file has no content"),
            ("OFF\n1 0 0\n0 nan 0\n", INVALID, "p.off: vertex 0 (counted from 0) has a coordinate that is not finite"),
            ("OFF\n2 0 0\n0 0 0\n1e999 0 0\n", INVALID,
             "p.off: vertex 1 (counted from 0) has a coordinate that is not finite"),
            ("OFF BINARY\n" + "\0" * 100, UNSUPPORTED, "p.off:1: the binary form of OFF is not supported: \"BINARY\""),
            ("4OFF\n1 0 0\n0 0 0 1\n", UNSUPPORTED,
             "p.off:1: vertices of other than three coordinates are not supported: \"4OFF\""),
            ("OFF\n2147483648 1 0\n0 0 0\n", INVALID,
             "p.off:2: 2147483648 vertices and 1 faces are stated, more than the 7 bytes that follow can hold"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", INVALID,
             "p.off:6: vertex 3 is out of range: there are 3, counted from 0"),
            ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", INVALID, "p.off:4: a vertex needs 3 numbers, found 2"),
            ("# " + "x" * 100000, INVALID, "p.off:1: the file has no content")):
        run.write("p.off", content)
        run.ffd("deform", "p.off", "q.off", "-l", "l.json", code=code, err=says)
        check(not run.exists("q.off"), "an output of a failure")
    run.folder_of("d.off")
    run.ffd("deform", "d.off", "r.off", "-l", "l.json", code=IO)
    run.write("a.obj", CUBE)
    run.write("p.off", off())
    run.ffd("deform", "a.obj", "a.off", "-l", "l.json", code=UNSUPPORTED)
    run.ffd("deform", "p.off", "a.ply", "-l", "l.json", code=UNSUPPORTED)


def write_model_lattices(run):
    for out, moves in (("still.json", []), ("moved.json", [{"at": [[2, 3], [2, 3], [2, 3]], "by": [0.125, 0, 0.25]}])):
        run.write(out, lattice(rest={"box": "mesh"}, moves=moves, units="box"))


def other_commands(run, path):
    for command in (["info", path], ["compare", path, path], ["check", path, "-l", "moved.json"],
                    ["lattice", "new", path, "-o", "new.json", "--force"],
                    ["embed", path, "-l", "still.json", "-o", "e.npy", "--force"]):
        run.ffd(*command)


@case
def off_models(run):
    """An empty move copies each sample; a real one takes each vertex where the lattice takes its position, and
    changes nothing else."""
    found = models(".off")
    write_model_lattices(run)
    for name, path, before in found:
        run.ffd("deform", path, "q.off", "-l", "still.json", "--force")
        equal(run.read("q.off"), before, name)
        run.ffd("deform", path, "q.off", "-l", "moved.json", "--force")
        start, end = off_numbers(before.decode(), 0, 3), off_numbers(run.text("q.off"), 0, 3)
        equal(end, carried(run, start, "moved.json"), name)
        check(end != start and all(a[1] == b[1] for a, b in zip(start, end)), name, "moves along x and z")
        equal(same_but_numbers(name, before, run.read("q.off")),
              sum(a != b for p, q in zip(start, end) for a, b in zip(p, q)), f"{name}: words that changed")
        other_commands(run, path)
    check(not MODELS or len(found) >= 7, f"{len(found)} models")


main()
