#!/usr/bin/env python3
"""ffd jacobian: the derivative of positions by control points and by placeholders, as arrays that NumPy, SciPy and Matrix
Market read; compared with exact fractions, with differences of the program, and with itself."""
import ast
import io
import json
import struct
import zipfile

from harness import INVALID, IO, LIMIT, USAGE, case, check, equal, lattice, main, near
from messages import anything, one_line

KINDS = {"<f8": "d", "<i4": "i", "<i8": "q"}


def array(data):
    """Shape and numbers of an .npy."""
    equal(data[:8], b"\x93NUMPY\x01\x00", "magic")
    size, = struct.unpack("<H", data[8:10])
    head, body = ast.literal_eval(data[10:10 + size].decode()), data[10 + size:]
    check(not head["fortran_order"] and (10 + size) % 64 == 0, head)
    if head["descr"] == "|S3":
        return head["shape"], body
    kind = KINDS[head["descr"]]
    return head["shape"], list(struct.unpack(f"<{len(body) // struct.calcsize(kind)}{kind}", body))


def npy(shape, numbers):
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + struct.pack(f"<{len(numbers)}d", *numbers)


def matrix(run, name):
    """Rows of {column: number}, and the number of columns, of an .npz."""
    archive = zipfile.ZipFile(io.BytesIO(run.read(name)))
    equal(archive.testzip(), None, "checksums")
    equal(archive.namelist(), ["indices.npy", "indptr.npy", "format.npy", "shape.npy", "data.npy"], "members")
    check(all(member.compress_type == zipfile.ZIP_STORED for member in archive.infolist()), "stored")
    indices, starts, data = (array(archive.read(f"{part}.npy"))[1] for part in ("indices", "indptr", "data"))
    equal(array(archive.read("format.npy"))[1], b"csr", "format")
    rows, columns = array(archive.read("shape.npy"))[1]
    equal(len(starts), rows + 1, "rows")
    equal(starts[-1], len(data), "numbers")
    found = []
    for first, last in zip(starts, starts[1:]):
        check(indices[first:last] == sorted(set(indices[first:last])) and 0 not in data[first:last], "a row in order")
        found.append(dict(zip(indices[first:last], data[first:last])))
    return found, columns


def ply(points):
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
            "property double z\nend_header\n").encode()
    return head + b"".join(struct.pack("<3d", *point) for point in points)


BOX = lattice(size=(4, 4, 4), low=(0, 0, 0), high=(1, 1, 1))
POINTS = [(0.3, 0.4, 0.5), (0.9, 0.1, 0.7), (1.5, 0.5, 0.5), (0, 0, 0), (1.05, 0.5, 0.5)]


def bernstein(t):
    return [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t ** 2 * (1 - t), t ** 3]


def expected(point):
    """By control point of one cubic Bezier cell."""
    u, v, w = (bernstein(t) for t in point)
    row = {i + 4 * (j + 4 * k): u[i] * v[j] * w[k] for k in range(4) for j in range(4) for i in range(4)}
    return {column: value for column, value in row.items() if value}


def compare(found, wanted, tolerance, what):
    for column in set(found) | set(wanted):
        near([found.get(column, 0)], [wanted.get(column, 0)], tolerance, f"{what}, column {column}")


@case
def rows_are_the_bernstein_polynomials(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", BOX)
    done = run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", "--check", err=anything)
    check("5: 3 follow, 2 have empty rows" in done.text and "agree within" in done.text, done.text)
    rows, columns = matrix(run, "j.npz")
    equal((len(rows), columns), (5, 64), "shape")
    for point, row in zip(POINTS, rows):
        compare(row, expected(point) if max(point) <= 1 else {}, 1e-15, point)


@case
def vertices_that_are_not_inside_are_told(run):
    """As by `embed`: outside, and where a volume that turns back on itself has two u,v,w for a vertex."""
    run.write("p.ply", ply(POINTS))
    run.write("l.json", BOX)
    one_line(run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", err=anything), "2 of 5 vertices are not inside: 2 outside")
    back = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 2, 0.5)]
    run.write("t.ply", ply([[0.7, 0.5, 0.5], [0.8, 0.5, 0.4], [0.3, 0.2, 0.5]]))
    run.write("t.json", {"format": "ffd-lattice", "version": 1, "size": [3, 2, 2], "rest": {"points": back}})
    one_line(run.ffd("jacobian", "t.ply", "-l", "t.json", "-o", "t.npz", err=anything), "2 of 3 vertices are not inside: 2 multiple")


@case
def a_point_outside_has_the_borders_row(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", BOX)
    run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", "--outside", "extend", "--falloff", "0.2", "--check", err=anything)
    rows, _ = matrix(run, "j.npz")
    s = 0.25  # of the falloff
    fade = 1 - 10 * s ** 3 + 15 * s ** 4 - 6 * s ** 5
    equal(rows[2], {}, "beyond the falloff")
    compare(rows[4], {column: fade * value for column, value in expected((1, 0.5, 0.5)).items()}, 1e-14, "within it")


@case
def matrix_market_has_the_same_numbers(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", BOX)
    for components in ((), ("--components",)):
        run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", "--force", *components, err=anything)
        run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.mtx", "--force", *components, err=anything)
        rows, columns = matrix(run, "j.npz")
        lines = run.text("j.mtx").splitlines()
        equal(lines[0], "%%MatrixMarket matrix coordinate real general", "banner")
        equal(lines[2].split(), [str(len(rows)), str(columns), str(sum(map(len, rows)))], "sizes")
        entries = [(int(row) - 1, int(column) - 1, float(value)) for row, column, value in map(str.split, lines[3:])]
        equal(entries, [(i, column, row[column]) for i, row in enumerate(rows) for column in sorted(row)], "entries")


@case
def components_are_one_block_a_coordinate(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", BOX)
    run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", err=anything)
    run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "c.npz", "--components", err=anything)
    plain, columns = matrix(run, "j.npz")
    blocks, wide = matrix(run, "c.npz")
    equal((len(blocks), wide), (3 * len(plain), 3 * columns), "shape")
    for i, row in enumerate(plain):
        for a in range(3):
            equal(blocks[3 * i + a], {3 * column + a: value for column, value in row.items()}, f"vertex {i}")


DESIGN = {**BOX, "moves": [{"twist": {"axis": "z", "degrees": {"$": "A"}}}, {"at": [3, "all", "all"], "by": {"$": "S"}},
                           {"scale": {"factor": [1, {"$": "-A", "times": 0.01}, 1], "about": [0, 0, 0]}}]}
SET = ("--set", "A=30", "--set", "S=[0.1, 0.2, 0]")


def moved(run, name, values):
    settings = [word for key, value in values.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    run.ffd("deform", "p.ply", "o.ply", "-l", name, "--force", *settings, err=anything)
    data = run.read("o.ply")
    return list(struct.unpack(f"<{3 * len(POINTS)}d", data[data.index(b"end_header\n") + 11:]))


@case
def parameters_are_what_differences_say(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", DESIGN)
    done = run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npy", "--wrt", "parameters", "--check", *SET, err=anything)
    check("15 x 4" in done.text, done.text)
    equal(run.text("j.columns.txt").splitlines(), ["A", "S[0]", "S[1]", "S[2]"], "names")
    shape, numbers = array(run.read("j.npy"))
    equal(shape, (5, 3, 4), "shape")
    values = {"A": 30, "S": [0.1, 0.2, 0]}
    for column in range(4):
        h, sides = 1e-4, []
        for sign in (1, -1):
            changed = json.loads(json.dumps(values))
            if column == 0:
                changed["A"] += sign * h
            else:
                changed["S"][column - 1] += sign * h
            sides.append(moved(run, "l.json", changed))
        near([numbers[4 * i + column] for i in range(15)], [(a - b) / (2 * h) for a, b in zip(*sides)], 1e-9, f"column {column}")
    run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npz", "--wrt", "parameters", *SET, "--force", err=anything)
    rows, _ = matrix(run, "j.npz")
    equal([row.get(column, 0) for row in rows for column in range(4)], numbers, "sparse and dense")


@case
def products_are_those_of_the_matrix(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", DESIGN)
    forward = [((7 * i) % 11 - 5) / 4 for i in range(3 * 64)]
    back = [((5 * i) % 13 - 6) / 4 for i in range(15)]
    run.write("v.npy", npy((64, 3), forward))
    run.write("g.npy", npy((5, 3), back))
    run.write("t.npy", npy((4,), forward[:4]))
    for options, kind in (((), "plain"), (("--components",), "components"), (("--wrt", "parameters"), "parameters")):
        common = ("-l", "l.json", *SET, *options, "--force")
        run.ffd("jacobian", "p.ply", "-o", "j.npz", *common, err=anything)
        rows, columns = matrix(run, "j.npz")
        run.ffd("jacobian", "p.ply", "-o", "x.npy", "--times", "t.npy" if kind == "parameters" else "v.npy", *common, err=anything)
        run.ffd("jacobian", "p.ply", "-o", "q.npy", "--transposed", "g.npy", *common, err=anything)
        if kind == "plain":
            rows = [{3 * column + a: value for column, value in row.items()} for row in rows for a in range(3)]
            columns *= 3
        near(array(run.read("x.npy"))[1], [sum(value * forward[column] for column, value in row.items()) for row in rows], 1e-14, kind)
        wanted = [0] * columns
        for i, row in enumerate(rows):
            for column, value in row.items():
                wanted[column] += value * back[i]
        near(array(run.read("q.npy"))[1], wanted, 1e-13, f"{kind}, transposed")
        equal(array(run.read("q.npy"))[0], (4,) if kind == "parameters" else (64, 3), kind)


@case
def earlier_lattices_are_seen_through_the_later_ones(run):
    run.write("p.ply", ply(POINTS[:2]))
    run.write("a.json", {**BOX, "moves": [{"at": [2, 2, 2], "by": {"$": "S"}}]})
    run.write("b.json", {**lattice(size=(4, 4, 4), low=(-2, -2, -2), high=(3, 3, 3)), "moves": [{"twist": {"axis": "z", "degrees": {"$": "A"}}}]})
    both = ("-l", "a.json", "-l", "b.json", *SET, "--force", "--check")
    for options in (("--of", "0"), ("--of", "1"), (), ("--wrt", "parameters")):
        run.ffd("jacobian", "p.ply", "-o", "j.npz", *both, *options, err=anything)
        rows, columns = matrix(run, "j.npz")
        last = options in ((), ("--of", "1"))
        equal(len(rows), 2 if last else 6, options)
        equal(columns, 64 if last else 4 if "--wrt" in options else 192, options)


@case
def threads_and_instructions_change_no_byte(run):
    run.write("p.ply", ply([((i * 37) % 101 / 100, (i * 53) % 97 / 96, (i * 71) % 89 / 88) for i in range(3000)]))
    run.write("l.json", DESIGN)
    made = set()
    for threads, isa in ((1, "scalar"), (3, "auto"), (2, "sse2")):
        run.ffd("jacobian", "p.ply", "-l", "l.json", *SET, "-o", "j.npz", "--force", "-j", str(threads), "--isa", isa, err=anything,
                code=(0, USAGE))
        made.add(run.read("j.npz"))
    equal(len(made), 1, "archives")


@case
def long_names_are_told_apart(run):
    run.write("p.ply", ply(POINTS))
    names = ["A" * 300 + end for end in "xy"]
    run.write("l.json", {**BOX, "moves": [{"by": [{"$": names[0]}, {"$": names[1]}, 0]}]})
    run.ffd("jacobian", "p.ply", "-l", "l.json", "-o", "j.npy", "--wrt", "parameters", "--check",
            *(word for name in names for word in ("--set", name + "=1")), err=anything)
    equal(run.text("j.columns.txt").splitlines(), names, "names")
    shape, numbers = array(run.read("j.npy"))
    equal(shape, (5, 3, 2), "shape")
    near(numbers[:6], [1, 0, 0, 1, 0, 0], 1e-12, "the first vertex")


@case
def memory_has_a_limit(run):
    """Control points times placeholders: a file of some kilobytes could ask for any amount."""
    names = [f"P{i}" for i in range(300)]
    run.write("q.ply", ply(POINTS))
    run.write("many.json", {**BOX, "size": [40, 40, 40], "moves": [{"by": [{"$": name}, 0, 0]} for name in names]})
    done = run.ffd("jacobian", "q.ply", "-l", "many.json", "-o", "m.npz", "--wrt", "parameters",
                   *(word for name in names for word in ("--set", name + "=0")), code=LIMIT, err=anything)
    check("--memory" in done.err[-1], done.err)
    check(not run.exists("m.npz"), run.names())


@case
def what_cannot_be_is_refused(run):
    run.write("p.ply", ply(POINTS))
    run.write("l.json", DESIGN)
    run.write("text.json", {**BOX, "moves": [{"rotate": {"axis": {"$": "A"}, "degrees": 3}}]})
    run.write("none.json", BOX)
    run.write("short.npy", npy((63, 3), [0] * 189))
    run.write("bad.npy", b"no array")
    base = ("jacobian", "p.ply", "-l", "l.json", *SET)
    for more, code, word in (
            (("-o", "j.txt"), USAGE, ".npz"), (("-o", "j.npy"), USAGE, "sparse"), (("-o", "-"), USAGE, "stream"),
            (("-o", "j.npz", "--of", "1"), USAGE, "lattice 1"), (("-o", "j.npz", "--of", "-1"), USAGE, "--of"),
            (("-o", "j.npz", "--of", "0", "--wrt", "parameters"), USAGE, "--of"),
            (("-o", "j.npz", "--times", "short.npy"), USAGE, ".npy"), (("-o", "j.npy", "--times", "short.npy"), INVALID, "(63, 3)"),
            (("-o", "j.npy", "--transposed", "bad.npy"), INVALID, "NumPy"),
            (("-o", "j.npy", "--times", "short.npy", "--transposed", "bad.npy"), USAGE, "one at a time")):
        done = run.ffd(*base, *more, code=code, err=anything)
        check(any(word in line for line in done.err), more, done.err)
    done = run.ffd("jacobian", "p.ply", "-l", "text.json", "--set", "A=x", "--wrt", "parameters", "-o", "j.npz", code=INVALID, err=anything)
    check("/moves/0/rotate/axis" in done.err[-1] and "derivative" in done.err[-1], done.err)
    done = run.ffd("jacobian", "p.ply", "-l", "none.json", "--wrt", "parameters", "-o", "j.npz", code=INVALID, err=anything)
    check("placeholder" in done.err[-1], done.err)
    run.write("j.npz", "mine")
    run.ffd(*base, "-o", "j.npz", code=IO, err=anything)
    equal(run.read("j.npz"), b"mine", "what was there")
    # What is read is not replaced, whatever may be.
    before = run.read("short.npy")
    for option in ("--times", "--transposed"):
        done = run.ffd(*base, "-o", "./short.npy", option, "short.npy", "--force", code=IO, err=anything)
        check("./short.npy: is an input of this command" in done.err[-1], done.err)
    run.write("p.npz", ply(POINTS))
    run.ffd("jacobian", "p.npz", "--input-format", "ply", "-l", "l.json", *SET, "-o", "p.npz", "--force", code=IO, err=anything)
    equal((run.read("short.npy"), run.read("p.npz")), (before, ply(POINTS)))
    check(not any(name.startswith(".") for name in run.names()), run.names())


if __name__ == "__main__":
    main()
