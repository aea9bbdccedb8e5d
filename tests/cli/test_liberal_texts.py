#!/usr/bin/env python3
"""OBJ, PLY, OFF and STL that are not valid but have a plain meaning are read, with a warning, and refused with --strict;
files that are no mesh are refused, with what they seem to be; meshes without vertices are said."""

import gzip
import re
import struct

from harness import CUBE, INVALID, NO, case, check, equal, lattice, main
from messages import anything, entry

LOOSE = "blanks follow the backslash at the end of the line: it goes on in the next"
COLOUR = 'a line "color", which STL does not have, is kept as it is'
WORDS = '"endsolid" is written as two words'
CTRL_Z = "a Ctrl-Z, the end mark of old texts, ends the file"
MARK = 'a byte order mark is before "ply"'
UNKNOWN = '"{}" is no statement of OBJ: it is left as it is'
FACET = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet\n"
PLY = ("ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {a}\n" for a in "xyz")
       + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n")
OFF = "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"
# A file, what is said, the line of the first and how many there are.
FLAWS = [("m.obj", "v 0 0 \\ \n0\nv 1 \\\t \r\n0 0\nv 1 1 0 # \\ \nf 1 2 \\ \r3 \\ ", LOOSE, 1, 4),
         ("m.obj", OBJ.replace("f", "usemtl a\\ \nf") + "vn 0 0 1\nf 1//-1 2//-1 \\ \n3//-1", LOOSE, 7, 1),
         ("m.obj", OBJ + "\x1a", CTRL_Z, 0, 1), ("m.obj", OBJ[:-1] + "\x1a \r\n\x1a", CTRL_Z, 0, 1),
         ("m.obj", "vn 0 0 1\n" + OBJ[:-1].replace("1 2 3", "1//-1 2//-1 3//-1") + "\x1a", CTRL_Z, 0, 1),
         ("m.obj", "# a\n<<<<<<< HEAD\n" + OBJ + "=======\n" + OBJ + ">>>>>>> b\n", UNKNOWN.format("<<<<<<<"), 2, 3),
         ("m.obj", OBJ + "hello there\n", UNKNOWN.format("hello"), 5, 1),
         # A block that was never written, and a NUL character in a word.
         ("m.obj", OBJ + "\0\0\0\n", UNKNOWN.format("\u2400" * 3), 5, 1), ("m.obj", OBJ + "a\0b c\n", UNKNOWN.format("a\u2400b"), 5, 1),
         ("m.obj", "#\n" * 100000 + OBJ + "#\n" * 100000 + "V 1 2 3\nVN 1\n", UNKNOWN.format("V"), 200005, 2),
         ("m.stl", "solid a\ncolor 1 0 0\n COLOR .5 .5 .5 1\n" + FACET + "color 0 0 1\n" + FACET + "endsolid", COLOUR, 2, 3),
         ("m.stl", f"solid\n{FACET}End Solid a\nsolid b\n{FACET}end solid facet\n", WORDS, 3, 2),
         ("m.stl", f"solid\n{FACET}endsolid\x1a", CTRL_Z, 0, 1), ("m.stl", f"solid\n{FACET}endsolid a\r\n\x1a\r\n", CTRL_Z, 0, 1),
         ("m.ply", PLY + "\x1a", CTRL_Z, 0, 1), ("m.ply", PLY[:-1] + "\x1a", CTRL_Z, 0, 1), ("m.ply", "\ufeff" + PLY, MARK, 1, 1),
         ("m.off", OFF + "\x1a", CTRL_Z, 0, 1), ("m.off", OFF[:-1] + "\x1a\x1a\n", CTRL_Z, 0, 1)]


def start(run):
    run.write("l.json", lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [0.25, 0, 0]}]))
    run.write("turn.json", lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"twist": {"axis": "x", "degrees": 40}}]))
    run.write("still.json", lattice(low=(-10, -10, -10), high=(10, 10, 10)))


@case
def flaws_of_texts_are_said_and_change_nothing_else(run):
    """Said, reported, refused with --strict; vertices move as in the plain file, and nothing else changes."""
    start(run)
    for name, text, said, line, count in FLAWS:
        run.write(name, text.encode())
        out = "o" + name[1:]
        job = entry(run, "deform", name, out, "-l", "l.json")
        place = {"line": line} if line else {}
        equal(job["flaws"], [{"message": said, **place, "count": count}], text)
        equal((job["vertices"], job["moved"]), (job["vertices"], job["vertices"]), text)
        told = f"{name}: " + (f"line {line}: " if line else "") + said + (f" (the first of {count} such)" if count > 1 else "")
        for words in (("deform", name, out, "-l", "still.json", "--force"), ("check", name, "-l", "l.json"), ("info", name),
                      ("embed", name, "-l", "l.json", "-o", "e.npy", "--force")):
            equal(run.ffd(*words, err=anything).err[0], told, words)
            run.ffd(*words, "--strict", code=INVALID, err=f"{name}:{line}: {said}" if line else f"{name}: {said}")
        equal(run.read(out), text.encode(), "what does not move keeps its bytes")
        run.ffd("compare", name, out, err=anything)
        # What was written is read again, with new normals too.
        run.ffd("deform", name, "t" + name[1:], "-l", "turn.json", "--force", err=anything)
        run.ffd("compare", name, "t" + name[1:], "--tolerance", "99", code=(0, NO), err=anything)
        run.ffd("deform", name, "c.glb", "-l", "l.json", "--force", err=anything)


@case
def statements_that_are_known_are_not_mentioned(run):
    """Those of the specification and of its older versions, and what common programs add."""
    start(run)
    known = ("vp mg cstype deg bmat step parm trim hole scrv sp end con s bevel c_interp d_interp lod usemap maplib shadow_obj"
             " trace_obj ctech stech call csh bsp bzp cdc cdp res vc vw t").split()
    run.write("m.obj", OBJ + "".join(f"{word} 1\n" for word in known))
    run.ffd("deform", "m.obj", "o.obj", "-l", "l.json", "--strict", err=[])


@case
def a_name_may_end_with_a_backslash(run):
    """Where names are expected, a backslash before blanks belongs to the name."""
    start(run)
    run.write("m.obj", CUBE + "usemtl a\\ \nv 5 5 5\ng b \\ \nv 6 6 6\n")
    run.ffd("deform", "m.obj", "o.obj", "-l", "l.json", err=[])
    equal(run.ffd("info", "m.obj", "--json").json["vertices"], 10)


JUNK = [(b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 5\n", "a Git LFS pointer: the file itself is not there"),
        (b"<!DOCTYPE html>\n<html>\no no\n</html>\n", "an HTML page"), (b"\n <HTML lang=en>\n", "an HTML page"),
        (b"<?xml version='1.0'?>\n", "an XML file"), (gzip.compress(CUBE.encode() * 100), "a gzip file"),
        (b"PK\3\4" + bytes(100), "a ZIP archive"), (b"\x89PNG\r\n\x1a\ng \n" + bytes(100), "a PNG image"),
        (b"newmtl a\nKd 1 1 1\n", "an MTL file"), (OBJ.encode("utf-16"), "UTF-16 text")]
MESHES = {".obj": (OBJ.encode(), "an OBJ file"), ".ply": (PLY.encode(), "a PLY file"), ".off": (OFF.encode(), "an OFF file"),
          ".stl": (f"solid\n{FACET}endsolid\n".encode(), "an STL file"), ".gltf": (b'{"asset": {}}', "JSON text"),
          ".glb": (struct.pack("<4s2I", b"glTF", 2, 12) + b"\ng \n" * 20, "a GLB file")}
BINARY_STL = struct.pack("<80sI", b"made by hand", 2) + bytes(100)


@case
def a_gltf_that_is_called_glb_is_named(run):
    for text in ('{"asset": {"version": "2.0"}}', "\ufeff\n {}"):
        run.write("m.glb", text)
        run.ffd("info", "m.glb", code=INVALID, err="m.glb: is a glTF file in JSON, not a GLB file: its name must end in .gltf")


@case
def junk_is_refused(run):
    """In every format, saying what it seems to be; and a mesh of another format than its name says."""
    start(run)
    for ending, own in MESHES.items():
        others = [mesh for other, mesh in MESHES.items() if other != ending and {ending, other} != {".gltf", ".glb"}]
        for content, kind in JUNK + others:
            run.write("m" + ending, content)
            done = run.ffd("deform", "m" + ending, "o" + ending, "-l", "l.json", "--fail-on", "outside", code=INVALID)
            check(done.err[0].startswith("m" + ending) and (done.err[0].endswith("; it seems to be " + kind) or
                  (ending, kind, done.err[0]) == (".gltf", "UTF-16 text", "m.gltf:1: is text in UTF-16: it must be UTF-8")), done.err)
            check(not run.exists("o" + ending), "an output of junk")
        if ending != ".stl":
            run.write("m" + ending, BINARY_STL)
            run.ffd("info", "m" + ending, code=INVALID, err=re.compile("; it seems to be a binary STL file$"))
        run.write("m" + ending, own[0][:-4])
        done = run.ffd("info", "m" + ending, code=(0, INVALID), err=anything)
        check(not any("seems" in line for line in done.err), "its own format", done.err)
        for content in (b"", b"\n", b"\xef\xbb\xbf", b"# a comment\n\n", b"just words\nand more\n"):
            run.write("m" + ending, content)
            run.ffd("deform", "m" + ending, "o" + ending, "-l", "l.json", code=INVALID)
            run.ffd("deform", "-", "o" + ending, "-l", "l.json", "--input-format", ending[1:], stdin=content, code=INVALID)
    run.write("m.obj", b"")
    run.ffd("deform", "m.obj", "o.glb", "-l", "l.json", code=INVALID, err="m.obj:1: the file has no content")


@case
def what_stands_in_for_a_lattice_or_the_jobs_is_named(run):
    """In one line, however many lines it has."""
    run.write("a.obj", OBJ)
    for content, kind in JUNK[:3]:
        for name in ("l.json", "m.jsonl", "m.csv"):
            run.write(name, content)
        for words, name in ((("deform", "a.obj", "o.obj", "-l", "l.json"), "l.json"), (("info", "l.json"), "l.json"),
                            (("batch", "m.jsonl"), "m.jsonl"), (("batch", "--csv", "m.csv"), "m.csv")):
            done = run.ffd(*words, code=INVALID)
            check(done.err[0].startswith(name) and done.err[0].endswith("it seems to be " + kind), done.err)
    run.write("l.json", "<?")
    run.ffd("info", "l.json", code=INVALID, err=lambda lines: "seems" not in lines[0])


@case
def a_mesh_without_vertices_is_warned_of(run):
    """A warning, and a violated gate."""
    start(run)
    for name, text in (("m.obj", "mtllib a.mtl\n"), ("m.obj", "s off\n"), ("m.off", "OFF\n0 0 0\n"), ("m.stl", "solid\nendsolid\n"),
                       ("m.stl", bytes(84)), ("m.ply", PLY.split("0 0 0\n")[0].replace("x 3", "x 0").replace("face 1", "face 0")),
                       ("m.gltf", '{"asset": {"version": "2.0"}}')):
        run.write(name, text)
        said = f"{name}: there are no vertices"
        done = run.ffd("deform", name, "o" + name[1:], "-l", "l.json", "--force", err=anything)
        equal([line for line in done.err if "no vertices" in line], [said + " to deform"])
        equal(run.read("o" + name[1:]), run.read(name))
        done = run.ffd("check", name, "-l", "l.json", "--fail-on", "outside", code=NO, err=anything)
        check(done.err[-1] == f"{name}: there are no vertices (--fail-on outside)", done.err)
        done = run.ffd("embed", name, "-l", "l.json", "-o", "e.npy", "--force", err=anything)
        equal([line for line in done.err if "no vertices" in line], [said])


@case
def rows_behind_those_that_are_stated(run):
    """A PLY with a third vertex where two are stated: a line says it, --strict refuses it, and it stays. An OFF with a second
    face; with a fourth vertex, which is taken for the face."""
    header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    said = "6 bytes stand behind the rows that the header states: they stay as they are"
    run.write("a.ply", header + "0 0 0\n1 0 0\n7 7 7\n")
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.ffd("deform", "a.ply", "o.ply", "-l", "l.json", "--outside", "extend", err=re.compile(re.escape(said[2:])))
    check(run.text("o.ply").endswith("7 7 7\n"), run.text("o.ply"))
    run.ffd("info", "a.ply", "--strict", code=INVALID, err=re.compile("behind the rows"))
    run.write("b.ply", header + "0 0 0\n1 0 0\n \n\n")
    run.ffd("info", "b.ply", "--strict")
    header, face = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n"
    for rows, line in ((face + face, 7), ("0 0 5\n" + face, 7), (face + "# a comment\n\n" + face, 9)):
        run.write("a.off", header + rows)
        said = f"a.off: line {line}: 8 bytes stand behind the faces that the header states: they stay as they are"
        run.ffd("deform", "a.off", "o.off", "-l", "l.json", "--outside", "extend", "--force", err=said)
        check(run.text("o.off").endswith(rows), run.text("o.off"))
        run.ffd("info", "a.off", "--strict", code=INVALID, err=re.compile("behind the faces"))
    for rows in (face, face + "\n \n# a comment\n", face[:-1]):
        run.write("b.off", header + rows)
        run.ffd("info", "b.off", "--strict")


main()
