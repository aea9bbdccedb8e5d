#!/usr/bin/env python3
"""ffd lattice convert: lattices as .csv and .npy, and back."""

import json
import os
import random
import re
import struct

from author import array, broken, offsets_of, rest_points
from harness import CUBE, INVALID, IO, USAGE, carried, case, check, equal, lattice, main, near, repetitions

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
PLACES = [[RANDOM.uniform(-1, 1) for _ in range(3)] for _ in range(30)]


def convert(run, source, target, *more, **options):
    run.ffd("lattice", "convert", source, "-o", target, "--force", *more, **options)
    return json.loads(run.text(target)) if target.endswith(".json") else None


def numbers_of(data):
    """(shape, values) of a float64 array in C order."""
    length = struct.unpack("<H", data[8:10])[0]
    head = data[10:10 + length].decode()
    check("'<f8'" in head and "'fortran_order': False" in head and (10 + length) % 64 == 0, head)
    shape = [int(n) for n in re.search(r"\(([^)]*)\)", head)[1].split(",")]
    return shape, list(struct.unpack(f"<{(len(data) - 10 - length) // 8}d", data[10 + length:]))


def random_lattice():
    size = [RANDOM.randint(4, 6) for _ in range(3)]
    count = size[0] * size[1] * size[2]
    degree = [RANDOM.randint(1, 3) for _ in range(3)]
    knots = [RANDOM.choice(["clamped", "open", "uniform", sorted(RANDOM.uniform(0, 1) for _ in range(n + d + 1))]) for n, d in zip(size, degree)]
    members = {"knots": knots, "degree": degree, "deformed": {"offsets": [[RANDOM.uniform(-0.1, 0.1) for _ in range(3)] for _ in range(count)]}}
    if RANDOM.random() < 0.5:
        members["weights"] = [RANDOM.uniform(0.5, 2) for _ in range(count)]
        if RANDOM.random() < 0.5:
            members["deformed"]["weights"] = [RANDOM.uniform(0.5, 2) for _ in range(count)]
    return lattice(size=size, **members)


def same(a, b):
    for member in ("size", "degree", "knots", "weights"):
        equal(a.get(member), b.get(member), member)
    equal([rest_points(a), offsets_of(a), a.get("deformed", {}).get("weights")], [rest_points(b), offsets_of(b), b.get("deformed", {}).get("weights")])


@case
def a_table_holds_all_of_a_lattice(run):
    for _ in range(repetitions(20)):
        run.write("a.json", random_lattice())
        convert(run, "a.json", "a.csv")
        back = convert(run, "a.csv", "b.json")
        # As points, which is what a table has; the box of a.json is the same to rounding only.
        near(*(carried(run, PLACES, name, err=lambda lines: True) for name in ("b.json", "a.json")), 1e-11)
        convert(run, "b.json", "b.csv")
        equal(run.read("b.csv"), run.read("a.csv"))
        same(convert(run, "b.csv", "c.json"), back)
        for part, moved in (("rest", 0), ("deformed", 1)):
            found = convert(run, "a.csv", "part.json", "--part", part)
            check("deformed" not in found, "nothing moves")
            near(rest_points(found), [[p + moved * d for p, d in zip(*both)] for both in zip(rest_points(back), offsets_of(back))], 1e-15 * 4)
            equal(found.get("weights"), moved and back.get("deformed", {}).get("weights") or back.get("weights"))
        # In any order, with other line ends, blanks and an end mark.
        lines = run.text("a.csv").splitlines()
        head = next(i for i, line in enumerate(lines) if line.startswith("i,"))
        rows = lines[head + 1:]
        RANDOM.shuffle(rows)
        run.write("d.csv", "\ufeff# a comment\r\n" + "\r\n".join(lines[:head] + ["", " i , J,k" + lines[head][5:]] + [f" {row.replace(',', ' ,')}\t" for row in rows]) + "\r\n\x1a")
        same(convert(run, "d.csv", "d.json"), back)


@case
def closed_directions_and_moves(run):
    cylinder = {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}
    run.write("a.json", lattice(size=(4, 6, 4), knots=["clamped", "closed", "clamped"], rest=cylinder, moves=[{"at": [1, 1, 1], "by": [0.1, 0, 0.05]}]))
    convert(run, "a.json", "a.csv")
    check("# closed 0 1 0" in run.text("a.csv"), run.text("a.csv")[:200])
    back = convert(run, "a.csv", "b.json")
    equal([back["knots"][1], sum(any(d) for d in offsets_of(back))], ["closed", 1])
    convert(run, "b.json", "b.csv")
    equal(run.read("b.csv"), run.read("a.csv"))
    # Uneven breakpoints of one period.
    text = re.sub("(?m)^# knots v.*$", "# knots v 0 0.1 0.3 0.4 0.6 0.7 1", run.text("a.csv"))
    run.write("c.csv", text)
    equal(convert(run, "c.csv", "c.json")["knots"][1], {"closed": [0, 0.1, 0.3, 0.4, 0.6, 0.7, 1]})
    # JSON with its moves as offsets, and the box that stays one.
    run.write("m.json", lattice(rest={"box": "mesh"}, moves=[{"at": [1, 1, 1], "by": [0.5, 0, {"$": "Z"}]}]))
    run.write("m.obj", CUBE)
    found = convert(run, "m.json", "o.json", "--mesh", "m.obj", "--set", "Z=0.25")
    equal([found["moves"], offsets_of(found)[21], found["rest"]["box"]["max"]], [[], [0.5, 0, 0.25], [1, 1, 1]])
    out = run.ffd("lattice", "convert", "-", "-o", "-", "--part", "rest", stdin=run.read("o.json"), data=True).out
    check(b"deformed" not in out, "nothing moves at rest")


@case
def arrays(run):
    for _ in range(repetitions(10)):
        content = random_lattice()
        content.pop("weights", None)
        content["deformed"].pop("weights", None)
        run.write("a.json", content)
        convert(run, "a.json", "a.csv")
        points = convert(run, "a.csv", "p.json")
        n = content["size"]
        usual = all(k == "clamped" and d == min(3, m - 1) for k, d, m in zip(content["knots"], content["degree"], n))
        said = {} if usual else {"lines": 1, "err": re.compile(r"a\.npy: an array holds positions alone, not the knots of")}
        for part, moved in (("rest", 0), ("deformed", 1)):
            convert(run, "a.json", "a.npy", "--part", part, **said)
            shape, values = numbers_of(run.read("a.npy"))
            equal(shape, n + [3])
            expected = [[p + moved * d for p, d in zip(*both)] for both in zip(rest_points(points), offsets_of(points))]
            found = [values[3 * ((i * n[1] + j) * n[2] + k):][:3] for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
            near(found, expected, 1e-15 * 4)
            back = convert(run, "a.npy", "b.json")
            equal([back["knots"], back["degree"], rest_points(back)], [["clamped"] * 3, [min(3, m - 1) for m in n], found])
            rows = [x for p in found for x in p]
            wide = [x for i in range(3) for k in range(n[2]) for j in range(n[1]) for x in [p[i] for p in found[(k * n[1] + j) * n[0]:][:n[0]]]]
            for data, more in ((array(rows, f"({len(found)}, 3)"), ["--size", ",".join(map(str, n))]),
                               (array(rows, f"({len(found)}, 3)", ">f8", version=2), ["--size", ",".join(map(str, n))]),
                               (array(wide, f"({n[0]}, {n[1]}, {n[2]}, 3)", fortran=True), [])):
                run.write("c.npy", data)
                equal(rest_points(convert(run, "c.npy", "c.json", *more)), found)
            run.write("c.npy", array(values, f"({n[0]}, {n[1]}, {n[2]}, 3)", "<f4"))
            single = struct.unpack(f"<{len(rows)}f", struct.pack(f"<{len(rows)}f", *rows))
            equal([x for p in rest_points(convert(run, "c.npy", "c.json", "--degree", "2")) for x in p], list(single))
            equal(json.loads(run.text("c.json"))["degree"], [2, 2, 2])


def write_tables(run, table, head):
    """Tables with a fault each. table: the lines of a right one; head: the index of its header."""
    def csv(name, lines):
        run.write(name, "\n".join(lines) + "\n")

    def changed(name, line, text):
        csv(name, table[:line] + ([text] if text is not None else []) + table[line + 1:])

    csv("empty.csv", [])
    csv("head.csv", table[:head + 1])
    changed("missing.csv", head + 3, None)
    changed("double.csv", head + 3, table[head + 2])
    changed("far.csv", head + 3, "60000000,60000000,60000000,0,0,0,0,0,0")
    changed("nan.csv", head + 1, "0,0,0,0,nan,0,0,0,0")
    changed("sign.csv", head + 1, "0,0,-1,0,0,0,0,0,0")
    changed("short.csv", head + 1, "0,0,0,0,0,0,0,0")
    changed("long.csv", head + 1, "0,0,0,0,0,0,0,0,0,0")
    changed("columns.csv", head, "i,j,k,x,y,z,dx,dz,dy")
    changed("semicolons.csv", head, "i;j;k;x;y;z;dx;dy;dz")
    changed("weight.csv", head, table[head] + ",weight")
    changed("knots.csv", 1, "# knots u 0 0 0 0 1 1 1")
    changed("order.csv", 1, "# knots u 0 0 0 0 1 1 1 0.5")
    changed("letter.csv", 1, "# knots x 0 0 0 0 1 1 1 1")
    changed("twice.csv", 2, table[1])
    changed("degree.csv", 0, "# degree 3 15 3")
    changed("zero.csv", 0, "# degree 3 0 3")
    changed("degrees.csv", 1, table[0])
    csv("closed.csv", ["# closed 0 0 0", "# closed 0 1 0"] + table)
    csv("few.csv", ["# degree 3 4 3"] + table[head:])
    csv("bare.csv", table[head:])
    csv("layer.csv", [table[head]] + [row for row in table[head + 1:] if row.split(",")[2] == "0"])


@case
def what_cannot_be_is_refused(run):
    run.write("a.json", lattice(deformed={"offsets": [[0.1, 0, 0]] * 64}))
    run.write("still.json", lattice(weights=[1.0] * 63 + [2.0], knots=["clamped", "open", "clamped"]))
    run.write("mesh.json", lattice(rest={"box": "mesh"}))
    run.write("a.obj", CUBE)
    convert(run, "a.json", "a.csv")
    table = run.text("a.csv").splitlines()
    head = table.index("i,j,k,x,y,z,dx,dy,dz")
    points = [float(i) for i in range(192)]

    write_tables(run, table, head)
    for name, data in (("flat.npy", array(points, "(192,)")), ("wide.npy", array(points, "(96, 2)")), ("n3.npy", array(points, "(64, 3)")),
                       ("early.npy", array(points[:-1], "(4, 4, 4, 3)")), ("late.npy", array(points, "(4, 4, 4, 3)", behind=b"\0")),
                       ("ints.npy", array(points, "(4, 4, 4, 3)").replace(b"<f8", b"<i8")), ("huge.npy", array([], "(4000000000, 4000000000, 4, 3)")),
                       ("many.npy", array([], "(1000, 1000, 1000, 3)")), ("inf.npy", array(points[:-1] + [float("inf")], "(4, 4, 4, 3)")),
                       ("layer.npy", array(points[:48], "(4, 4, 1, 3)")), ("zero.npy", array([], "(4, 4, 0, 3)")), ("none.npy", b"no array")):
        run.write(name, data)
    for source, target, more, code, what in (
            ("a.json", "o.npy", [], USAGE, r"o\.npy: holds one state of a lattice, and this one is deformed: choose rest or deformed \(--part\)"),
            ("still.json", "o.npy", ["--part", "both"], USAGE, "holds one state of a lattice, not both: choose"), ("a.json", "o.csv", ["--part", "x"], USAGE, "is not rest, deformed or both"),
            ("a.json", "o.txt", [], USAGE, r"o\.txt: has no ending of a lattice that is written: \.json, \.csv, "),
            ("a.ply", "o.csv", [], USAGE, r"a\.ply: has no ending of a lattice that is read"), ("a.json", "o", [], USAGE, "no ending"),
            ("a.json", "o.csv", ["--size", "4,4,4"], USAGE, r"a\.json: tells its size itself: --size is not for it"),
            ("a.json", "o.csv", ["--degree", "2"], USAGE, "tells its degree itself: --degree"), ("a.csv", "o.json", ["--degree", "2"], USAGE, "tells its degree in line 1"),
            ("a.csv", "o.json", ["--size", "4"], USAGE, "tells its size itself"), ("a.csv", "o.json", ["--set", "A=1"], USAGE, "has no placeholders: --set"),
            ("a.csv", "o.json", ["--mesh", "a.obj"], USAGE, "does not go round a mesh: --mesh"), ("a.json", "o.csv", ["--mesh", "a.obj"], USAGE, "--mesh cannot be used"),
            ("a.json", "o.csv", ["--size", "1,2,3"], USAGE, "one or three whole numbers of at least 2"), ("a.json", "o.csv", ["--degree", "15"], USAGE, "from 1 to 14"),
            ("a.json", "o.csv", ["--report", "r.json"], USAGE, "report"), ("gone.csv", "o.json", [], IO, "gone.csv"), ("a.csv", "a.csv", [], IO, "is an input"),
            ("mesh.json", "o.csv", [], INVALID, r"mesh\.json: .*needs positions \(--mesh\)"), ("mesh.json", "o.npy", [], INVALID, "needs positions"),
            ("empty.csv", "o.json", [], INVALID, r"empty\.csv:2: there is no header i,j,k,x,y,z"), ("head.csv", "o.json", [], INVALID, rf"head\.csv:{head + 2}: there are no control points"),
            ("missing.csv", "o.json", [], INVALID, r"missing\.csv:\d+: there are 63 control points, but the indices are those of 4 by 4 by 4"),
            ("double.csv", "o.json", [], INVALID, rf"double\.csv:{head + 4}: 1,0,0 is there twice, first in line {head + 3}"),
            ("far.csv", "o.json", [], INVALID, "there are 64 control points"), ("nan.csv", "o.json", [], INVALID, rf"nan\.csv:{head + 2}: \"nan\" is not a finite number"),
            ("sign.csv", "o.json", [], INVALID, "\"-1\" is not a whole number"), ("short.csv", "o.json", [], INVALID, "the row has 8 cells, but the header has 9"),
            ("long.csv", "o.json", [], INVALID, "is not a cell of the header's columns"), ("columns.csv", "o.json", [], INVALID, "\"dz\" is column 8 of the header"),
            ("semicolons.csv", "o.json", [], INVALID, "is column 1 of the header"), ("weight.csv", "o.json", [], INVALID, "the row has 9 cells, but the header has 10"),
            ("knots.csv", "o.json", [], INVALID, r"knots\.csv:2: there are 7 knots of u, but 4 control points of degree 3 need 8"),
            ("order.csv", "o.json", [], INVALID, "order.csv"), ("letter.csv", "o.json", [], INVALID, "followed by u, v or w"),
            ("degrees.csv", "o.json", [], INVALID, r"degrees\.csv:2: # degree is there twice, first in line 1"),
            ("closed.csv", "o.json", [], INVALID, r"closed\.csv:2: # closed is there twice, first in line 1"),
            ("few.csv", "o.json", [], INVALID, r"few\.csv:1: the degree 4 of v needs at least 5 control points, not 4"),
            ("bare.csv", "o.json", ["--degree", "3,3,5"], INVALID, r"bare\.csv: --degree 5 along w needs at least 6 control points, not 4"),
            ("n3.npy", "o.json", ["--size", "4", "--degree", "14"], INVALID, r"n3\.npy: --degree 14 along u needs at least 15 control points, not 4"),
            ("inf.npy", "o.json", ["--order", "auto"], INVALID, r"inf\.npy: point 63: z is inf, not a finite number"),
            ("zero.npy", "o.json", [], INVALID, r"zero\.npy: has 0 control points along w, which has no extent: write two at least"),
            ("twice.csv", "o.json", [], INVALID, "the knots of u are told twice, first in line 2"), ("degree.csv", "o.json", [], INVALID, "three whole numbers up to 14"),
            ("zero.csv", "o.json", [], INVALID, "the degree 0 of v is not 1 to 14"), ("layer.csv", "o.json", [], INVALID, "has 1 control point along w, which has no extent"),
            ("layer.npy", "o.json", [], INVALID, "has 1 control point along w"), ("flat.npy", "o.json", [], INVALID, r"has the shape \(192,\), not \(n, 3\) or"),
            ("wide.npy", "o.json", [], INVALID, r"has the shape \(96, 2\)"), ("n3.npy", "o.json", [], USAGE, r"has 64 points in a row: give .* \(--size\)"),
            ("n3.npy", "o.json", ["--size", "4,4,5"], INVALID, "has 64 points, but --size 4,4,5 needs another number"),
            ("early.npy", "o.json", [], INVALID, "has 1528 bytes of numbers, but the shape .* needs 1536"), ("late.npy", "o.json", [], INVALID, "has 1537 bytes"),
            ("ints.npy", "o.json", [], INVALID, "has numbers of type <i8"), ("huge.npy", "o.json", [], INVALID, "is not a NumPy array file"),
            ("many.npy", "o.json", [], 7, "more than 201326592 numbers"), ("inf.npy", "o.json", [], INVALID, r"inf\.npy: rest point 3,3,3: z is inf"),
            ("none.npy", "o.json", [], INVALID, "is not a NumPy array file")):
        run.ffd("lattice", "convert", source, "-o", target, *more, *(["--force"] if source == target else []), code=code, lines=1, err=re.compile(what))
        check(target == source or not run.exists(target), (source, target))
    run.ffd("lattice", "convert", "still.json", "-o", "s.npy", lines=1, err=re.compile(r"not the knots of v, weights: it is read as clamped uniform"))
    run.ffd("lattice", "convert", "a.json", "-o", "a.csv", code=IO, lines=1, err=re.compile("exists"))


@case
def an_order_that_the_points_tell(run):
    """Whatever direction is the fastest, and whichever way: u leads to +x, v to +y, w to +z."""
    for _ in range(repetitions(20)):
        size = RANDOM.sample(range(3, 8), 3)
        grid = {(i, j, k): [2.0 * i + RANDOM.uniform(-0.3, 0.3), 1.5 * j + RANDOM.uniform(-0.3, 0.3), 1.0 * k + RANDOM.uniform(-0.2, 0.2)]
                for k in range(size[2]) for j in range(size[1]) for i in range(size[0])}
        order = RANDOM.sample(range(3), 3)  # the directions of the file, the fastest first
        back = [RANDOM.random() < 0.5 for _ in range(3)]
        counts = [size[d] for d in order]
        rows, place = [], [0, 0, 0]
        for place[2] in range(counts[2]):
            for place[1] in range(counts[1]):
                for place[0] in range(counts[0]):
                    at = {d: size[d] - 1 - n if back[d] else n for d, n in zip(order, place)}
                    rows.append(grid[at[0], at[1], at[2]])
        flat = [x for p in rows for x in p]
        said = re.compile(r"a\.npy: {} x {} x {} control points along u, v, w".format(*size))
        run.write("a.npy", array(flat, f"({len(rows)}, 3)"))
        found = convert(run, "a.npy", "o.json", "--order", "auto", "--size", ",".join(map(str, RANDOM.sample(size, 3))), lines=1, err=said)
        expected = [grid[i, j, k] for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
        equal([found["size"], rest_points(found)], [size, expected], (order, back))
        # An array of four dimensions tells the counts, its last direction is the fastest.
        run.write("a.npy", array(flat, "({}, {}, {}, 3)".format(*counts[::-1])))
        found = convert(run, "a.npy", "o.json", "--order", "auto", lines=1, err=said)
        equal([found["size"], rest_points(found)], [size, expected], (order, back))
        found = convert(run, "a.npy", "o.json", "--order", "uvw")
        equal(found["size"], counts[::-1])
    # A grid that is turned by some 30 degrees: u is still what leads most to +x.
    run.write("a.json", lattice(size=(4, 5, 3), degree=(3, 3, 2)))
    run.ffd("lattice", "set", "a.json", "--rotate", "z,30", "--rotate", "x,-25", "-o", "t.json")
    convert(run, "t.json", "t.npy")
    equal(rest_points(convert(run, "t.npy", "o.json", "--order", "auto", lines=1, err=re.compile("4 x 5 x 3"))), rest_points(convert(run, "t.npy", "p.json")))
    random = [RANDOM.uniform(-1, 1) for _ in range(192)]
    run.write("a.npy", array(random, "(64, 3)"))
    for source, more, code, what in (
            ("a.npy", ["--size", "4", "--order", "auto"], INVALID, r"a\.npy: is not a grid of 4 x 4 x 4 points in any order: some of its cells are turned over"),
            ("a.npy", ["--size", "4", "--order", "wvu"], USAGE, "uvw, auto"), ("a.json", ["--order", "auto"], USAGE, r"a\.json: tells its order itself: --order is not"),
            ("t.csv", ["--order", "auto"], USAGE, r"t\.csv: tells its order itself")):
        convert(run, "t.json", "t.csv")
        run.ffd("lattice", "convert", source, "-o", "n.json", *more, code=code, lines=1, err=re.compile(what))
        check(not run.exists("n.json"), more)


@case
def other_commands_name_this_one(run):
    run.write("a.json", lattice())
    run.write("a.obj", CUBE)
    convert(run, "a.json", "a.csv")
    convert(run, "a.json", "a.npy")
    for name, what in (("a.csv", "a table"), ("a.npy", "an array")):
        for words in (["deform", "a.obj", "o.obj", "-l", name], ["lattice", "refine", name, "-o", "o.json", "--size", "9"]):
            run.ffd(*words, code=INVALID, err=f"{name}: is not JSON: of {what} `ffd lattice convert` makes a lattice file")
    run.write("json.csv", run.read("a.json"))
    run.ffd("deform", "a.obj", "o.obj", "-l", "json.csv")


@case
def broken_files(run):
    """Bytes changed, cut and doubled anywhere: a lattice, or one line and exit 4 or 7."""
    run.write("a.json", random_lattice())
    convert(run, "a.json", "a.csv")
    convert(run, "a.json", "a.npy", "--part", "rest", lines=None, err=lambda lines: True)
    for name in ("a.csv", "a.npy"):
        whole = run.read(name)
        for _ in range(repetitions(60)):
            run.write("b" + name[1:], broken(whole, RANDOM, b"\0\n,-#e9.\xff("))
            run.ffd("lattice", "convert", "b" + name[1:], "-o", "b.json", "--force", code=(0, INVALID, 7), lines=None, err=lambda lines: len(lines) <= 1)


main()
