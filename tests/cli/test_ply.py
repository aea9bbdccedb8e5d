#!/usr/bin/env python3
"""PLY files, with a reader of their own here: what deform changes in them, what the other commands say of them,
and what is refused."""
import json
import re
import struct

from harness import (CUBE, INVALID, IO, LIMIT, MODELS, NO, UNSUPPORTED, carried, case, check, equal, float32, lattice, main, models,
                     near, obj_of, threaded_case)
from messages import anything

BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]
CODES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d",
         "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f",
         "float64": "d"}
ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}

POINTS = [[0.1, 0.2, 0.3], [-1.5, 0.25, 1.75], [0.0, 0.0, 0.0], [1.0 / 3, -2.0 / 3, 1e-3], [5.0, 5.0, 5.0]]
NORMALS = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]
FACES = [[0, 1, 2], [0, 2, 3, 1]]


def elements(real, normals=True):
    """Elements of a file with more in it than a mesh: (name, properties, rows); a list is its count's type, its
    items' type and its name."""
    vertex = [("uchar", "red"), (real, "z"), (real, "x"), ("uchar", "ushort", "rings"), (real, "y")]
    vertex += [(real, "nx"), (real, "ny"), (real, "nz")] if normals else []
    rows = [[i, p[2], p[0], [7] * i, p[1], *(n if normals else [])]
            for i, (p, n) in enumerate(zip(POINTS, NORMALS))]
    return [("camera", [("short", "view")], [[-2], [2570]]), ("vertex", vertex, rows),
            ("face", [("uchar", "int", "vertex_indices"), ("float", "quality")], [[f, 0.5] for f in FACES])]


def number(code, value):
    """value's shortest text, as the type holds it."""
    if code != "f":
        return repr(value)
    value = float32(value)
    return next(t for t in (f"{value:.{n}g}" for n in range(1, 10)) if struct.pack("f", float(t)) == struct.pack("f", value))


def write_ply(parts, encoding, end="\n"):
    order = ENCODINGS[encoding]
    lines = ["ply", f"format {encoding} 1.0", "comment of a test"]
    body = b""
    for name, properties, rows in parts:
        lines.append(f"element {name} {len(rows)}")
        lines += ["property " + ("list " if len(p) == 3 else "") + " ".join(p) for p in properties]
        for row in rows:
            values = []
            for p, value in zip(properties, row):
                code = CODES[p[-2]]
                if len(p) == 3:
                    values += [(CODES[p[0]], len(value))] + [(code, v) for v in value]
                else:
                    values.append((code, value))
            if order:
                body += b"".join(struct.pack(order + code, value) for code, value in values)
            else:
                body += (" ".join(number(code, value) for code, value in values) + end).encode()
    return end.join(lines + ["end_header", ""]).encode() + body


def read_ply(data):
    """{element: rows}, each row {property: number or list}."""
    end = b"\r\n" if data.startswith(b"ply\r\n") else data[3:4]
    header, body = data.split(b"end_header" + end, 1)
    parts, order = [], None
    for line in header.decode().split(end.decode()):
        words = line.split()
        if words[:1] == ["format"]:
            order = ENCODINGS[words[1]]
        elif words[:1] == ["element"]:
            parts.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            parts[-1][2].append(words[1:])
    words, at = iter(body.split()), 0

    def take(kind):
        nonlocal at
        code = CODES[kind]
        if not order:
            return float(next(words)) if code in "fd" else int(next(words))
        value, = struct.unpack_from(order + code, body, at)
        at += struct.calcsize(order + code)
        return value

    found = {}
    for name, count, properties in parts:
        rows = found[name] = []
        for _ in range(count):
            rows.append({p[-1]: [take(p[2]) for _ in range(take(p[1]))] if p[0] == "list" else take(p[0])
                         for p in properties})
    return found


def vectors(data, names=("x", "y", "z")):
    return [[row[name] for name in names] for row in read_ply(data)["vertex"]]


OUTSIDE = {"lines": 1}  # one of POINTS is outside of the lattice, which is said


@case
def doubles_are_those_of_obj(run):
    """The same positions as text or bytes get the same bits, whatever the format and the encoding."""
    run.write("l.json", lattice(moves=BUMP))
    expected = carried(run, POINTS, "l.json", **OUTSIDE)
    check(expected[0] != POINTS[0], "the lattice moves")
    for encoding in ENCODINGS:
        run.write("p.ply", write_ply(elements("double"), encoding))
        run.ffd("deform", "p.ply", f"{encoding}.ply", "-l", "l.json", **OUTSIDE)
        equal(vectors(run.read(f"{encoding}.ply")), expected, encoding)


@case
def floats_are_rounded_once(run):
    run.write("l.json", lattice(moves=BUMP))
    start = [[float32(x) for x in p] for p in POINTS]
    expected = [[float32(x) for x in p] for p in carried(run, start, "l.json", **OUTSIDE)]
    for encoding in ENCODINGS:
        run.write("p.ply", write_ply(elements("float32"), encoding))
        run.ffd("deform", "p.ply", f"{encoding}.ply", "-l", "l.json", **OUTSIDE)
        found = vectors(run.read(f"{encoding}.ply"))
        equal([[float32(x) for x in p] for p in found], expected, encoding)
    for word in (w for line in run.text("ascii.ply").split("end_header\n")[1].split("\n")[2:7] for w in line.split()):
        check(word == number("f", float(word)) or float(word).is_integer(), f"{word} is longer than needed")


@case
def only_what_moved_changes(run):
    """In any encoding, with any line ends: other bytes stay, and so do those of the vertex outside."""
    run.write("l.json", lattice(moves=BUMP))
    for encoding in ENCODINGS:
        for end in ("\n", "\r\n", "\r"):
            before = write_ply(elements("double"), encoding, end)
            run.write("p.ply", before)
            run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", "--force", **OUTSIDE)
            after = run.read("q.ply")
            old, new = read_ply(before), read_ply(after)
            equal(after.split(b"end_header")[0], before.split(b"end_header")[0], "the header")
            for name in old:
                for row, (a, b) in enumerate(zip(old[name], new[name])):
                    changed = {key for key in a if a[key] != b[key]}
                    allowed = {"x", "y", "z", "nx", "ny", "nz"} if name == "vertex" and row < 4 else set()
                    check(changed <= allowed, f"{encoding}: {name} {row}: {changed} changed")
            check(old != new, "something moves")
            equal(write_ply([(n, p, [[new[n][i][q[-1]] for q in p] for i in range(len(r))])
                             for n, p, r in elements("double")], encoding, end), after, "and no other byte")


@case
def texts_that_need_not_change_stay(run):
    text = ("ply\r\nformat   ascii 1.0\t\r\n element vertex 2\r\nproperty float z\r\ncomment  a  b \r\nproperty float32 x\r\n"
            "property double y\r\nproperty uchar red\r\nobj_info what\r\nelement odd 1\r\nproperty list uchar char bits\r\n"
            "end_header\r\n +.50\t-1.50 1e0  007 \r\n\r\n5.000 5 5.0e0 1\r\n0\r\nthe rest")
    run.write("l.json", lattice(moves=[{"by": [0.25, 0, 0]}]))
    run.write("t.ply", text)
    run.ffd("deform", "t.ply", "u.ply", "-l", "l.json",
            err=["t.ply: 8 bytes stand behind the rows that the header states: they stay as they are",
                 "t.ply: 1 of 2 vertices is not inside: 1 outside (left where it is)"])
    equal(run.text("u.ply"), text.replace("-1.50", "-1.25"))


@case
def where_nothing_moves_every_byte_stays(run):
    run.write("l.json", lattice())
    for real in ("float", "float64"):
        for encoding in ENCODINGS:
            run.write("p.ply", write_ply(elements(real), encoding))
            run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", "--force", **OUTSIDE)
            equal(run.read("q.ply"), run.read("p.ply"), encoding)


@case
def normals_of_ply_follow_those_of_obj(run):
    """They follow as those of an OBJ do; --normals keep leaves their bytes."""
    run.write("l.json", lattice(moves=BUMP))
    run.write("p.obj", obj_of(POINTS) + "".join("vn %r %r %r\n" % tuple(n) for n in NORMALS)
              + "f 1//1 2//2 3//3\nf 3//3 4//4 5//5\n")
    run.ffd("deform", "p.obj", "q.obj", "-l", "l.json", **OUTSIDE)
    expected = [[float(x) for x in line.split()[1:]] for line in run.text("q.obj").splitlines() if line.startswith("vn ")]
    check(expected[0] != NORMALS[0], "the normals turn")
    for encoding in ENCODINGS:
        run.write("p.ply", write_ply(elements("double"), encoding))
        run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", "--force", **OUTSIDE)
        equal(vectors(run.read("q.ply"), ("nx", "ny", "nz")), expected, encoding)
        run.ffd("deform", "p.ply", "k.ply", "-l", "l.json", "--normals", "keep", "--force", **OUTSIDE)
        equal(vectors(run.read("k.ply"), ("nx", "ny", "nz")), NORMALS, encoding)
        equal(vectors(run.read("k.ply")), vectors(run.read("q.ply")), encoding)


@case
def coordinates_of_whole_numbers_are_not_deformed(run):
    """Coordinates or normals that are no floating point numbers are read, and not deformed."""
    run.write("l.json", lattice(moves=BUMP))
    head = "ply\nformat ascii 1.0\nelement vertex 1\n"
    xyz = "property float x\nproperty float y\nproperty float z\n"
    run.write("p.ply", head + xyz.replace("float y", "short y") + "end_header\n1 1 1\n")
    run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", code=UNSUPPORTED,
            err="p.ply:3: y of the vertices is of type short: only float and double can be deformed")
    equal(run.ffd("info", "p.ply", "--json").json["bounds"], {"min": [1, 1, 1], "max": [1, 1, 1]})
    run.write("n.ply", head + xyz + "property char nx\nproperty char ny\nproperty char nz\nend_header\n1 1 1 0 0 127\n")
    run.ffd("deform", "n.ply", "q.ply", "-l", "l.json", code=UNSUPPORTED,
            err="n.ply:3: nx ny nz are not all float or double: such normals can only be kept")
    run.ffd("deform", "n.ply", "q.ply", "-l", "l.json", "--normals", "keep")
    check(run.text("q.ply").endswith(" 0 0 127\n"), run.text("q.ply"))


@case
def streams_and_places(run):
    run.write("l.json", lattice(moves=BUMP))
    data = write_ply(elements("float"), "binary_big_endian")
    run.write("p.ply", data)
    run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", **OUTSIDE)
    done = run.ffd("deform", "-", "-", "-l", "l.json", "--input-format", "ply", "--output-format", "ply", stdin=data, **OUTSIDE)
    equal(done.out, run.read("q.ply"), "through the streams")
    run.write("p.PLY", data)
    run.ffd("deform", "p.PLY", "--in-place", "-l", "l.json", **OUTSIDE)
    equal(run.read("p.PLY"), run.read("q.ply"), "in place")


@case
def too_large_for_the_file(run):
    """A float's largest number is not a double's."""
    run.write("l.json", lattice(moves=[{"by": [1e39, 0, 0]}]))
    for real, code in (("float", INVALID), ("double", 0)):
        run.write("p.ply", write_ply([("vertex", [(real, a) for a in "xyz"], [[0.0, 0.0, 0.0]])], "binary_little_endian"))
        run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", code=code)
    near(vectors(run.read("q.ply")), [[1e39, 0, 0]], 1e30)


@case
def other_commands_take_a_ply_as_any_mesh(run):
    """embed, lattice new and check take a PLY as any mesh."""
    run.write("p.ply", write_ply(elements("double"), "binary_little_endian"))
    run.write("p.obj", obj_of(POINTS) + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in FACES))
    run.write("l.json", lattice(moves=BUMP))
    for name in ("p.ply", "p.obj"):
        run.ffd("embed", name, "-l", "l.json", "-o", name + ".npy", "--status", name + ".s.npy", **OUTSIDE)
        run.ffd("lattice", "new", name, "-o", name + ".json")
        run.ffd("check", name, "-l", "l.json", "--report", name + ".report", "--report-stable", **OUTSIDE)
    equal(run.read("p.ply.npy")[:128 + 120], run.read("p.obj.npy")[:128 + 120], "u,v,w")
    equal(run.read("p.ply.s.npy")[:133], run.read("p.obj.s.npy")[:133], "statuses")
    equal(run.read("p.ply.json"), run.read("p.obj.json"), "the lattice")
    equal(run.text("p.ply.report").replace(".ply", ".obj"), run.text("p.obj.report"), "the report")


def face_parts(real, normals, first="vertex"):
    """Triangles and a quad on sides of a cube, with normals of the faces before and behind their corners."""
    corners = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
    faces = [[0, 2, 3, 1], [4, 5, 7], [0, 1, 5, 4], [1, 3, 7], [2, 2, 2]]
    parts = [("vertex", [(real, a) for a in "xyz"], corners),
             ("face", [(real, "nz"), ("uchar", "int", "vertex_indices"), (real, "nx"), ("uchar", "red"), (real, "ny")],
              [[n[2], f, n[0], 7, n[1]] for f, n in zip(faces, normals)])]
    return parts if first == "vertex" else parts[::-1]


FACE_NORMALS = [[0.0, 0.0, -1.0], [0.0, 0.0, -2.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]


@case
def face_normals_are_those_of_the_moved_corners(run):
    """They are those of the moved corners, on their side; zeros, faces without area and all other bytes stay."""
    wide = {"low": (-10, -10, -10), "high": (10, 10, 10)}
    run.write("turn.json", lattice(**wide, moves=[{"rotate": {"axis": "x", "degrees": 90, "about": [0, 0, 0]}}]))
    run.write("still.json", lattice(**wide))
    expected = [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], FACE_NORMALS[2], FACE_NORMALS[3], FACE_NORMALS[4]]
    for encoding in ENCODINGS:
        for real in ("float", "double"):
            for first in ("vertex", "face"):
                before = write_ply(face_parts(real, FACE_NORMALS, first), encoding)
                run.write("p.ply", before)
                run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--force", err=[])
                moved = read_ply(run.read("q.ply"))
                near([[f["nx"], f["ny"], f["nz"]] for f in moved["face"]], expected, 1e-7 if real == "float" else 1e-15)
                equal([(f["vertex_indices"], f["red"]) for f in moved["face"]],
                      [(f["vertex_indices"], f["red"]) for f in read_ply(before)["face"]])
                near([[v["x"], v["y"], v["z"]] for v in moved["vertex"]],
                     [[v["x"], -v["z"], v["y"]] for v in read_ply(before)["vertex"]], 1e-6)
                run.ffd("deform", "p.ply", "k.ply", "-l", "turn.json", "--normals", "keep", "--force", err=[])
                kept = read_ply(run.read("k.ply"))
                equal((kept["face"], kept["vertex"]), (read_ply(before)["face"], moved["vertex"]), "--normals keep")
                run.ffd("deform", "p.ply", "s.ply", "-l", "still.json", "--force", err=[])
                equal(run.read("s.ply"), before, "no vertex moves")
    # Whole numbers cannot hold them, which is said.
    whole = face_parts("float", FACE_NORMALS)
    whole[1][1][0] = ("char", "nz")
    whole[1][2][:] = [[-1, f, 0.0, 7, 0.0] for _, f, *_ in whole[1][2]]
    run.write("p.ply", write_ply(whole, "ascii"))
    run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--force",
            err="p.ply: nx ny nz of the faces are not all float or double: they stay")
    run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--normals", "keep", "--force", err=[])
    equal(read_ply(run.read("q.ply"))["face"], read_ply(run.read("p.ply"))["face"])


@case
def normals_that_no_command_turns_are_named(run):
    """Those of other elements, under other names and in lists; and tangents."""
    wide = {"low": (-10, -10, -10), "high": (10, 10, 10)}
    run.write("turn.json", lattice(**wide, moves=[{"rotate": {"axis": "x", "degrees": 90, "about": [0, 0, 0]}}]))
    corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    up = [0.0, 0.0, 1.0]

    def names(*three):
        return [("float", name) for name in three]

    def parts(vertex=(), face=(), edge=()):
        return [("vertex", names("x", "y", "z", *vertex), [c + up * (len(vertex) // 3) for c in corners]),
                ("face", [("uchar", "int", "vertex_indices"), *face], [[[0, 1, 2], *([up] if len(face) == 1 else up[:len(face)])]]),
                ("edge", [("int", "vertex1"), ("int", "vertex2"), *names(*edge)], [[0, 1, *up[:len(edge)]]])]

    turned = ("nx", "ny", "nz")
    other = ("normal_x", "normal_y", "normal_z")
    for made, named in ((parts(edge=turned), "nx ny nz of edge"),
                        (parts(face=[("uchar", "float", "normal")]), "normal of face"),
                        (parts(other, names(*other)), "normal_x normal_y normal_z of vertex, normal_x normal_y normal_z of face"),
                        (parts((*turned, "tx", "ty", "tz"), names(*turned)), "tx ty tz of vertex"),
                        (parts(turned, names(*turned)), None),
                        (parts(("tx", "ty", "s")), None)):
        run.write("p.ply", write_ply(made, "ascii"))
        run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--force",
                err=f"p.ply: these normals and tangents stay as they are: {named}" if named else [])
        run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--force", "--normals", "keep", err=[])
    # Normals of faces are computed anew, beside vertices without any.
    run.write("p.ply", write_ply(parts(face=names(*turned)), "ascii"))
    run.ffd("deform", "p.ply", "q.ply", "-l", "turn.json", "--force", "--normals", "recompute", err=[])
    face = read_ply(run.read("q.ply"))["face"][0]
    near([face[a] for a in turned], [0, -1, 0], 1e-7)


@case
def facts_of_ply_files_are_right(run):
    for encoding in ENCODINGS:
        run.write("p.ply", write_ply(elements("double"), encoding, "\r\n") + b"\n\nmore")
        found = run.ffd("info", "p.ply", "--json", err=re.compile("4 bytes stand behind the rows")).json
        equal([found[key] for key in ("mesh_format", "vertices", "normals", "not_finite")], ["PLY", 5, 5, 0])
        contents = found["contents"]
        equal([contents[key] for key in ("encoding", "line_endings", "faces", "triangles", "quads", "lines", "triangle_strips")],
              [encoding.replace("_", " "), "CRLF", 2, 1, 1, 0, 0])
        equal(contents["bytes_behind"], 4 if encoding == "ascii" else 6)
        equal(contents["elements"][2], {"name": "face", "count": 2,
                                        "properties": ["list uchar int vertex_indices", "float quality"]})
        equal(found["topology"]["faces"], 2)
        check("binary" in run.ffd("info", "p.ply", err=anything).text or encoding == "ascii", "the text")


def strip_triangles(strip):
    """The triangles of a strip: every second one is turned round, -1 begins anew, and what has no area only joins."""
    found, begun = [], []
    for v in strip:
        begun = [] if v == -1 else begun + [v]
        if len(begun) >= 3 and len(set(begun[-3:])) == 3:
            a, b, c = begun[-3:]
            found.append([a, b, c] if len(begun) % 2 else [b, a, c])
    return found


@case
def triangle_strips_are_faces(run):
    """They are faces: for topology, figures, tears, selections of the border and conversions."""
    wide = {"low": (-10, -10, -10), "high": (10, 10, 10)}
    run.write("l.json", lattice(**wide, moves=[{"twist": {"axis": "y", "degrees": 40}}]))
    strips = [[0, 1, 2, 3, -1, 4, 5, 6, 7, -1, -1, 0], [0, 2, 4, 6, 6, 1, 1, 5, 3, 7], [1, 0], []]
    corners = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
    vertex = ("vertex", [("double", a) for a in "xyz"], corners)
    face = ("face", [("uchar", "int", "vertex_indices")], [[[0, 1, 5, 4]]])
    triangles = [t for strip in strips for t in strip_triangles(strip)]
    equal(len(triangles), 8)
    as_faces = ("face", [("uchar", "int", "vertex_indices")], face[2] + [[t] for t in triangles])
    as_strips = ("tristrips", [("uchar", "flags"), ("int", "int", "vertex_indices")], [[9, strip] for strip in strips])
    for encoding in ENCODINGS:
        run.write("p.ply", write_ply([vertex, as_strips, face], encoding))
        run.write("f.ply", write_ply([vertex, as_faces], encoding))
        described = [run.ffd("info", name, "--json").json for name in ("p.ply", "f.ply")]
        equal(described[0]["topology"], described[1]["topology"])
        equal(described[0]["contents"]["triangle_strips"], len(strips))
        for name in ("p", "f"):
            run.ffd("deform", f"{name}.ply", f"{name}o.ply", "-l", "l.json", "--force", err=[])
            run.ffd("check", f"{name}.ply", "-l", "l.json", "--report", f"{name}.json", err=[])
            run.ffd("deform", f"{name}.ply", f"{name}o.obj", "-l", "l.json", "--force", err=[])
        equal(run.read("po.obj"), run.read("fo.obj"), "a conversion")
        figures = [json.loads(run.text(name))["jobs"][0] for name in ("p.json", "f.json")]
        equal(*([job[key] for key in ("flipped_faces", "tear", "edges", "det")] for job in figures))
        equal(read_ply(run.read("po.ply"))["tristrips"], read_ply(run.read("p.ply"))["tristrips"])
    # Torn edges, and what no face uses.
    run.write("half.json", lattice(low=(-1, -1, -1), high=(0.5, 2, 2), moves=[{"by": [0, 0, 0.25]}]))
    run.write("u.ply", write_ply([("vertex", vertex[1], corners + [[50.0, 0.0, 0.0]]), as_strips], "ascii"))
    run.ffd("deform", "u.ply", "o.ply", "-l", "half.json", "--report", "u.json", err=lambda lines: None)
    job = json.loads(run.text("u.json"))["jobs"][0]
    check(job["tear"]["edges"] > 0 and job["unused"] == 1, job)


@case
def ply_files_are_the_same_in_every_encoding(run):
    for encoding in ENCODINGS:
        run.write(f"{encoding}.ply", write_ply(elements("double"), encoding))
    for a in ENCODINGS:
        for b in ENCODINGS:
            run.ffd("compare", f"{a}.ply", f"{b}.ply", out="")
    moved = elements("double")
    moved[1][2][1][2] += 0.25
    run.write("m.ply", write_ply(moved, "binary_big_endian"))
    run.ffd("compare", "ascii.ply", "m.ply", code=NO,
            out="ascii.ply and m.ply differ: vertex 1 counted from 0: x differs by 0.25\n")
    run.ffd("compare", "ascii.ply", "m.ply", "--tolerance", "0.25", out="")
    turned = elements("double")
    turned[1][2][1][5] = 0.5
    run.write("t.ply", write_ply(turned, "ascii"))
    run.ffd("compare", "ascii.ply", "t.ply", "--tolerance", "9", code=NO,
            out="ascii.ply and t.ply differ: vertex 1 counted from 0 (line 22): x of the normal differs by 0.5\n")
    run.write("a.obj", CUBE)
    run.ffd("compare", "ascii.ply", "a.obj", code=NO)


@case
def a_text_of_a_float_is_the_nearest_float(run):
    """A text of a float stands for the nearest float, of normals and other numbers too: the forms of a file are one
    mesh. Floats that differ are shown as short as they can be told apart."""
    vertex = [("float", name) for name in ("x", "y", "z", "nx", "ny", "nz", "quality")]
    row = [0.1, 1.0 / 3, -2.0 / 3, -0.8821082, 0.123456789, 0.7, 0.3]
    for encoding in ENCODINGS:
        run.write(f"{encoding}.ply", write_ply([("vertex", vertex, [row])], encoding))
    run.write("long.ply", run.read("ascii.ply").replace(b"-0.8821082 ", b"-0.88210820000000001 "))
    check(run.read("long.ply") != run.read("ascii.ply"), "the text is another")
    forms = [*ENCODINGS, "long"]
    for a in forms:
        for b in forms:
            run.ffd("compare", f"{a}.ply", f"{b}.ply", out="")
    row[3] = -0.8821081519126892  # the next float
    run.write("n.ply", write_ply([("vertex", vertex, [row])], "binary_big_endian"))
    run.ffd("compare", "binary_little_endian.ply", "n.ply", code=NO,
            out="binary_little_endian.ply and n.ply differ: vertex 0 counted from 0: x of the normal differs by 5.960464477539063e-08\n")


@case
def vertices_that_are_not_finite(run):
    """As scans have them: they keep their text, also a number that is too large for a float."""
    run.write("l.json", lattice(moves=[{"by": [0.25, 0, 0]}]))
    head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    for word in ("nan", "inf", "1e39"):
        run.write("p.ply", head + f"0 0 {word}\n1 1 1\n")
        run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", "--force",
                err="p.ply: 1 of 2 vertices is not inside: 1 invalid (not finite; left where it is)")
        equal(run.text("q.ply"), head + f"0 0 {word}\n1.25 1 1\n")


@case
def broken_ply_files_are_refused(run):
    run.write("l.json", lattice(moves=BUMP))
    head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    face = "element face 1\nproperty list uchar int vertex_indices\n"
    binary = head.replace("ascii", "binary_little_endian")
    for content, code, says in (
            ("", INVALID, "p.ply:1: is not a PLY file: the first line is not \"ply\""),
            (CUBE, INVALID, "p.ply:1: is not a PLY file: the first line is not \"ply\"; it seems to be an OBJ file"),
            (head, INVALID, "p.ply:6: the header has no end: \"end_header\" is missing"),
            (head + "comment " + 100000 * "x", INVALID, "p.ply:7: the header has no end: \"end_header\" is missing"),
            (head + "end_header\n0.00 0.00 0.00\n1 1\n", INVALID,
             "p.ply:9: row 1 (counted from 0) of element vertex: the line ends before z"),
            (head + "end_header\n0 0 0\n1 1 1 1\n", INVALID,
             "p.ply:9: row 1 (counted from 0) of element vertex: the line goes on after its last value: \"1\""),
            (head + "end_header\n0 0 zero\n1 1 1\n", INVALID,
             "p.ply:8: z of vertex 0 (counted from 0) is not a number: \"zero\""),
            (head.replace("vertex 2", "vertex 2147483648") + "end_header\n0 0 0\n", INVALID,
             "p.ply:3: element vertex: 2147483648 rows of 6 bytes or more do not fit in the 6 bytes after the header"),
            (binary.replace("vertex 2", "vertex 4611686018427387904") + "end_header\n", INVALID,
             "p.ply:3: element vertex: 4611686018427387904 rows of 12 bytes or more do not fit in the 0 bytes after the header"),
            (head.replace("vertex 2", "vertex 99999999999999999999"), INVALID,
             "p.ply:3: \"99999999999999999999\" is not a count of element vertex"),
            (head.replace("float z", "half z"), INVALID,
             "p.ply:6: \"half\" is not a PLY type (char, uchar, short, ushort, int, uint, float, double)"),
            (head.replace("float z", "float x"), INVALID,
             "p.ply:6: a second property x of element vertex: the first is on line 4"),
            (head.replace("property float z\n", "") + "end_header\n0 0\n1 1\n", INVALID,
             "p.ply:3: element vertex has no property z that is one number"),
            (head.replace(" 1.0", " 1.1"), UNSUPPORTED, "p.ply:2: version 1.1 of the format is not supported: only 1.0 is"),
            (head + face + "end_header\n0 0 0\n1 1 1\n255 0\n", INVALID,
             "p.ply:12: row 0 (counted from 0) of element face: the line ends before vertex_indices"),
            (head + "".join(f"property int p{i}\n" for i in range(5000)), LIMIT,
             "p.ply:4100: more than 4096 elements or properties")):
        run.write("p.ply", content)
        run.ffd("deform", "p.ply", "q.ply", "-l", "l.json", code=code, err=says)
        check(not run.exists("q.ply"), "an output of a failure")
    run.write("p.ply", head + face + "end_header\n0 0 0\n1 1 1\n3 0 1 2\n")
    for command in (["info", "p.ply"], ["check", "p.ply", "-l", "l.json"], ["deform", "p.ply", "q.ply", "-l", "l.json"]):
        run.ffd(*command, code=INVALID, err="p.ply:12: face 0: there is no vertex 2, only 2 (both counted from 0)")
    # The same of binary ones, of which most are read in a loop of their own.
    for order, count_type, kind in (("<", "uchar", "int"), (">", "uchar", "uint"), ("<", "char", "int"), ("<", "ushort", "int")):
        name = {"<": "little", ">": "big"}[order]
        start = (binary.replace("little", name) + face.replace("face 1", "face 2").replace("uchar", count_type).replace(" int ", f" {kind} ")
                 + "end_header\n").encode() + bytes(24)
        codes = [order + CODES[count_type], order + CODES[kind]]
        good = struct.pack(codes[0], 3) + struct.pack(order + "3" + codes[1][1], 0, 1, 0)
        for corner in (2, 255, 2 ** 31 - 1, *((-1, -2 ** 31) if kind == "int" else (2 ** 31, 2 ** 32 - 1))):
            run.write("p.ply", start + good + struct.pack(codes[0], 1) + struct.pack(codes[1], corner))
            run.ffd("info", "p.ply", code=INVALID, err=f"p.ply: face 1: there is no vertex {corner}, only 2 (both counted from 0)")
        run.write("p.ply", start + good + struct.pack(codes[0], 2) + struct.pack(codes[1], 0) + b"\0\0\0")
        run.ffd("info", "p.ply", code=INVALID, err="p.ply: row 1 (counted from 0) of element face: the file ends before or in vertex_indices")
        if count_type == "char":
            run.write("p.ply", start + good + b"\xff" + bytes(4 * 255))
            run.ffd("info", "p.ply", code=INVALID, err="p.ply: row 1 (counted from 0) of element face: not the count of list vertex_indices: \"-1\"")
        run.write("p.ply", start + good + good)
        run.ffd("info", "p.ply")
    run.folder_of("d.ply")
    run.ffd("deform", "d.ply", "r.ply", "-l", "l.json", code=IO)


def words_of(data):
    """Numbers, and what is between them, of an ascii file after its header; b"" of others."""
    header, body = data.split(b"end_header", 1)
    return re.split(rb"(\s+)", body) if b"format ascii" in re.sub(rb"[ \t]+", b" ", header) else []


@threaded_case
def sample_models_are_copied_and_deformed(run):
    """An empty move copies each sample; a real one takes each vertex where the lattice takes its position, rounded
    to the file's precision, and changes nothing but positions and normals."""
    found = models(".ply")
    for out, moves in (("still.json", []), ("moved.json", [{"at": [[2, 3], [2, 3], [2, 3]], "by": [0.125, 0, 0.25]}])):
        run.write(out, lattice(rest={"box": "mesh"}, moves=moves, units="box"))
    for name, path, before in found:
        run.ffd("deform", path, "q.ply", "-l", "still.json", "--force")
        equal(run.read("q.ply"), before, name)
        run.ffd("deform", path, "q.ply", "-l", "moved.json", "--force")
        after = run.read("q.ply")
        old, new = read_ply(before), read_ply(after)
        start = [[float32(x) for x in p] for p in vectors(before)]
        expected = [[float32(x) for x in p] for p in carried(run, start, "moved.json")]
        equal([[float32(x) for x in p] for p in vectors(after)], expected, name)
        check(expected != start, name, "does not move")
        for element in old:
            equal(len(new[element]), len(old[element]), name)
            for a, b in zip(old[element], new[element]):
                changed = {key for key in a if a[key] != b[key]}
                check(changed <= {"x", "z", "nx", "ny", "nz"} and (not changed or element == "vertex"), name, str(changed))
        equal(after[:before.index(b"end_header")], before[:before.index(b"end_header")], name)
        for a, b in zip(words_of(before), words_of(after), strict=True):
            check(a == b or float(a) != float(b), f"{name}: {a} became {b}")
        for command in (["info", path], ["compare", path, path], ["check", path, "-l", "moved.json"],
                        ["lattice", "new", path, "-o", "new.json", "--force"],
                        ["embed", path, "-l", "still.json", "-o", "e.npy", "--force"]):
            run.ffd(*command)
    check(not MODELS or len(found) >= 9, f"{len(found)} models")


main()
