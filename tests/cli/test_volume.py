#!/usr/bin/env python3
"""Volume meshes: VTK's legacy files and those in XML, SU2, Gmsh, with readers of their own here: what deform changes in them, what the other
commands say of them, and what is refused."""
import base64
import json
import re
import struct

import volume_files as volume
from messages import anything
from harness import (INVALID, LIMIT, NO, UNSUPPORTED, USAGE, carried, case, check, equal, float32, lattice, main, near)

BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]
STAYS = re.compile("stays? as (it is|they are)")


def words(data):
    return re.split(rb"(%[^\r\n]*|\s+)", data)


def same_but_numbers(name, before, after):
    """Words that differ are numbers that differ; all that is between the words is the same."""
    changed = 0
    for a, b in zip(words(before), words(after), strict=True):
        check(a == b or float(a) != float(b), f"{name}: {a} became {b}")
        changed += a != b
    return changed


def deformed(run, name, data, *options, **expected):
    """The bytes of a mesh after BUMP; the warning of what stays is expected."""
    run.write("l.json", lattice(moves=BUMP))
    run.write("still.json", lattice())
    run.write(name, data)
    ending = "." + name.rsplit(".", 1)[1]
    run.ffd("deform", name, "still" + ending, "-l", "still.json", "--force")
    equal(run.read("still" + ending), data, f"{name}: nothing moves")
    run.ffd("deform", name, "out" + ending, "-l", "l.json", "--force", *options, **expected)
    run.ffd("compare", name, "out" + ending, code=NO)
    run.ffd("compare", "out" + ending, "out" + ending)
    return run.read("out" + ending)


def rounded(points, kind):
    return [[float32(x) for x in p] for p in points] if kind == "float" else points


@case
def points_of_vtk_get_the_bits_of_an_obj(run):
    """Each kind of data, in text and in binary, of both versions; every other byte stays."""
    run.write("l.json", lattice(moves=BUMP))
    for make, extra in ((volume.vtk, {}), (volume.vtk, {"offsets": True}), (volume.vtk_polygons, {}),
                        (volume.vtk_polygons, {"offsets": True}), (volume.vtk_grid, {})):
        points = volume.grid_points((4, 3, 3)) if make is volume.vtk_grid else volume.POINTS
        lines = {"lines": 1} if make is volume.vtk else {}
        for kind in ("float", "double"):
            expected = rounded(carried(run, rounded(points, kind), "l.json"), kind)
            check(expected != rounded(points, kind), "the lattice moves")
            for is_binary in (False, True):
                name = f"{make.__name__} {extra} {kind} {is_binary}"
                before = make(is_binary=is_binary, kind=kind, **extra)
                after = deformed(run, "m.vtk", before, "--normals", "keep", **lines)
                found, first, last = volume.vtk_vectors(after, b"POINTS", volume.CODES[kind], len(points))
                equal(rounded(found, kind), expected, name)
                if is_binary:
                    equal(after[:first] + after[last:], before[:first] + before[last:], f"{name}: the rest")
                else:
                    check(same_but_numbers(name, before, after) > 9, "numbers change")


@case
def texts_of_floats_are_the_shortest(run):
    before = volume.vtk_polygons(kind="float")
    after = deformed(run, "m.vtk", before)
    found, _, _ = volume.vtk_vectors(after, b"POINTS", "f", len(volume.POINTS))
    for word in after.split(b"float\n")[1].split()[:3 * len(volume.POINTS)]:
        digits = len(word.strip(b"-").replace(b".", b"").strip(b"0"))
        shorter = [f"{float(word):.{n}g}" for n in range(1, digits)]
        check(not any(float32(float(text)) == float32(float(word)) for text in shorter), word)
    check(found != volume.POINTS, "it moves")


@case
def normals_of_vtk_follow_those_of_obj(run):
    run.write("l.json", lattice(moves=BUMP))
    run.write("p.obj", "".join("v %r %r %r\n" % tuple(p) for p in volume.POINTS)
              + "".join("vn %r %r %r\n" % tuple(n) for n in volume.NORMALS)
              + "".join(f"f {i}//{i} {i}//{i} {i}//{i}\n" for i in range(1, len(volume.POINTS) + 1)))
    run.ffd("deform", "p.obj", "q.obj", "-l", "l.json")
    expected = [[float(x) for x in line.split()[1:]] for line in run.text("q.obj").splitlines() if line.startswith("vn ")]
    check(expected != volume.NORMALS, "they turn")
    for is_binary in (False, True):
        before = volume.vtk(is_binary=is_binary, kind="double")
        after = deformed(run, "m.vtk", before, err='m.vtk: this array of three components stays as it is: "velocity"')
        equal(volume.vtk_vectors(after, b"NORMALS", "d", len(volume.POINTS))[0], expected)
        equal(volume.vtk_vectors(after, b"VECTORS", "d", len(volume.POINTS))[0], volume.NORMALS, "others stay")
        after = deformed(run, "m.vtk", before, "--normals", "keep", lines=1)
        equal(volume.vtk_vectors(after, b"NORMALS", "d", len(volume.POINTS))[0], volume.NORMALS, "kept")


@case
def weights_are_arrays_of_the_points(run):
    run.write("l.json", lattice(moves=BUMP))
    whole = carried(run, volume.POINTS, "l.json")
    expected = [[a + w * (b - a) for a, b in zip(p, q)] for p, q, w in zip(volume.POINTS, whole, volume.WEIGHTS)]
    for is_binary in (False, True):
        run.write("m.vtk", volume.vtk(is_binary=is_binary, kind="double"))
        run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", "--force", "-q", "--weight", "property:w")
        near(volume.vtk_vectors(run.read("o.vtk"), b"POINTS", "d", len(volume.POINTS))[0], expected, 1e-15)
        run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", "--force", "-q", "--weight", "property:tags")
        found = volume.vtk_vectors(run.read("o.vtk"), b"POINTS", "d", len(volume.POINTS))[0]
        equal(found, [(whole, volume.POINTS)[i % 2][i] for i in range(len(found))], "bytes from 0 to 255")
    run.ffd("deform", "m.vtk", "n.vtk", "-l", "l.json", "--weight", "property:x", code=INVALID,
            err='m.vtk: the points have no array "x" (--weight)')
    run.ffd("deform", "m.vtk", "n.vtk", "-l", "l.json", "--weight", "property:velocity", code=INVALID,
            err=re.compile('the array "velocity" has 3 components of double'))


@case
def points_of_su2_get_the_bits_of_an_obj(run):
    run.write("l.json", lattice(moves=BUMP))
    expected = carried(run, volume.POINTS, "l.json")
    for end in ("\n", "\r\n"):
        before = volume.su2(end=end)
        after = deformed(run, "m.su2", before)
        equal(volume.su2_points(after, 3), expected)
        check(same_but_numbers("su2", before, after) > 9, "numbers change")
    deformed(run, "m.su2", volume.su2(boxes=1), err="m.su2: the FFD boxes of the file stay as they are")


@case
def a_flat_mesh_stays_flat(run):
    run.write("l.json", lattice(moves=BUMP))
    points = [[*p, 0.0] for p in volume.SU2_FLAT]
    expected = [p[:2] for p in carried(run, points, "l.json")]
    after = deformed(run, "m.su2", volume.su2_flat(),
                     err="m.su2: the mesh has two dimensions: displacements along z are left out, of 5 vertices")
    equal(volume.su2_points(after, 2), expected)
    equal(after, volume.su2_flat(expected), "every other byte")
    run.write("l.json", lattice(moves=[{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, 0]}]))
    run.ffd("deform", "m.su2", "o.su2", "-l", "l.json")


def same_outside(name, before, after):
    """All arrays but the points and normals are the same, and so is what stands between them."""
    a, b = volume.xml_arrays(before), volume.xml_arrays(after)
    equal(list(a), list(b), name)
    for array, parts in a.items():
        for (values, _), (others, _) in zip(parts, b[array], strict=True):
            check(array in ("Points", "n &amp; n") or values == others, f"{name}: {array} changed")
    bare = [re.sub(rb'(RangeM..|offset)="[^"]*"|>[^<]*</DataArray>', b"", data.split(b"<AppendedData")[0])
            for data in (before, after)]
    equal(bare[0], bare[1], f"{name}: the tags")


@case
def points_of_vtk_in_xml_get_the_bits_of_an_obj(run):
    """In each encoding, byte order, and width of headers."""
    run.write("l.json", lattice(moves=BUMP))
    for make in (volume.vtu, volume.vtp, volume.vts):
        points = volume.grid_points((4, 3, 3)) if make is volume.vts else volume.POINTS
        lines = {} if make is volume.vts else {"lines": 1}
        for code, kind in (("f", "float"), ("d", "double")):
            expected = rounded(carried(run, rounded(points, kind), "l.json"), kind)
            for i, encoding in enumerate(volume.ENCODINGS):
                options = {"order": "<>"[i % 2], "word": "IQ"[i // 2 % 2]}
                name = f"{make.__name__} {code} {encoding} {options}"
                before = make(encoding=encoding, code=code, **options)
                after = deformed(run, "m." + make.__name__, before, "--normals", "keep", **lines)
                equal(rounded(volume.xml_points(after), kind), expected, name)
                same_outside(name, before, after)
                if encoding == "ascii":
                    continue
                if "zlib" not in encoding:
                    check(len(before) - 60 < len(after) < len(before) + 60, f"{name}: the size of data stays")
                (_, tag), = volume.xml_arrays(after)["Points"]
                lengths = [sum(x * x for x in p)**0.5 for p in expected]
                near([float(tag["RangeMin"]), float(tag["RangeMax"])], [min(lengths), max(lengths)], 1e-6, name)


@case
def pieces_and_normals_of_vtk_in_xml(run):
    run.write("l.json", lattice(moves=BUMP))
    run.write("m.vtk", volume.vtk(kind="double"))
    run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", "-q")
    count = len(volume.POINTS)
    points, normals = (volume.vtk_vectors(run.read("o.vtk"), word, "d", count)[0] for word in (b"POINTS", b"NORMALS"))
    for encoding in volume.ENCODINGS:
        before = volume.vtu(volume.POINTS * 2, encoding, "d", pieces=2)
        after = deformed(run, "m.vtu", before, err='m.vtu: this array of three components stays as it is: "velocity"')
        equal(volume.xml_points(after), points * 2, encoding)
        equal(volume.xml_points(after, "n &amp; n"), normals * 2, encoding)
        same_outside(encoding, before, after)
        run.ffd("deform", "m.vtu", "w.vtu", "-l", "l.json", "-q", "--force", "--weight", "property:tags")
        equal(volume.xml_points(run.read("w.vtu"))[1::2], (volume.POINTS * 2)[1::2], "weights of 0")
        equal(volume.xml_points(run.read("w.vtu"))[::2], (points * 2)[::2], "weights of 1")
    equal(run.ffd("info", "m.vtu", "--json").json["topology"]["components"], 2, "pieces number their points anew")


@case
def blocks_that_do_not_change_stay(run):
    """Of data that are compressed in blocks: only those with points that move are compressed anew."""
    run.write("l.json", lattice(low=(-3, -3, -3), high=(0.3, 3, 3), moves=[{"at": [[0, 1], "all", "all"], "by": [0.5, 0, 0]}]))
    points = sorted(volume.grid_points((40, 4, 4)))
    before = volume.vts(points, "raw zlib", "d", size=(40, 4, 4), block=1024)
    run.write("m.vts", before)
    run.ffd("deform", "m.vts", "o.vts", "-l", "l.json", "-q")
    after = run.read("o.vts")
    check(before != after, "some move")
    tail = before[before.index(b"_"):].index(b"\n</AppendedData>")
    equal(after[after.index(b"\n</AppendedData>") - tail // 2:], before[before.index(b"\n</AppendedData>") - tail // 2:], "the end")


@case
def points_of_gmsh_get_the_bits_of_an_obj(run):
    """Of both versions, in text and in binary of both byte orders."""
    run.write("l.json", lattice(moves=BUMP))
    expected = carried(run, volume.POINTS, "l.json")
    for make, words in ((volume.msh2, "Q"), (volume.msh4, "QI")):
        for is_binary, order in ((False, "<"), (True, "<"), (True, ">")):
            for word in words:
                options = {"is_binary": is_binary, "order": order, **({"word": word} if len(words) > 1 else {})}
                before = make(**options)
                after = deformed(run, "m.msh", before)
                found, rest = volume.msh_points(after, order, word)
                equal(found, expected, f"{make.__name__} {options}")
                equal(rest, volume.msh_points(before, order, word)[1], "every other byte")
                equal(after, make(expected, **options))
    for make in (volume.msh2, volume.msh4):
        for is_binary, order in ((False, "<"), (True, "<"), (True, ">")):
            before = make(is_binary=is_binary, order=order, parameters=True)
            after = deformed(run, "m.msh", before,
                             err="m.msh: the nodes have parameters on curves and surfaces, which stay as they are")
            equal(after, make(expected, is_binary, order, parameters=True))


@case
def groups_of_gmsh_are_physical_ones(run):
    run.write("l.json", lattice(moves=BUMP))
    whole = carried(run, volume.POINTS, "l.json")
    for data in (volume.msh2(), volume.msh2(is_binary=True), volume.msh4(), volume.msh4(is_binary=True, order=">")):
        order = ">" if b"$MeshFormat\n4.1 1" in data else "<"
        run.write("m.msh", data)
        for group, last in (("the wall", 4), ("inside", 8)):
            run.ffd("deform", "m.msh", "o.msh", "-l", "l.json", "--force", "-q", "--only", "group:" + group)
            equal(volume.msh_points(run.read("o.msh"), order)[0], whole[:last] + volume.POINTS[last:], group)
        contents = run.ffd("info", "m.msh", "--json").json["contents"]
        equal([contents[key] for key in ("cells", "volumes", "faces", "groups")], [3, 2, 1, 2])
        equal(run.ffd("info", "m.msh", "--json").json["topology"]["faces"], 9)
        run.ffd("deform", "m.msh", "n.msh", "-l", "l.json", "--only", "group:the", code=USAGE)
    run.write("m.msh", volume.msh2(tags=list(range(100, 0, -10))))
    run.ffd("deform", "m.msh", "o.msh", "-l", "l.json", "--force", "-q", "--only", "group:the wall")
    equal(volume.msh_points(run.read("o.msh"))[0], whole[:4] + volume.POINTS[4:], "tags in any order")


@case
def groups_are_markers_and_zones(run):
    run.write("l.json", lattice(moves=BUMP))
    whole = carried(run, volume.POINTS, "l.json")
    run.write("m.su2", volume.su2())
    for group, members in (("wall", {0, 1, 2, 3}), ("far", {4, 5, 6, 8})):
        run.ffd("deform", "m.su2", "o.su2", "-l", "l.json", "--force", "-q", "--only", "group:" + group)
        equal(volume.su2_points(run.read("o.su2"), 3), [(volume.POINTS, whole)[i in members][i] for i in range(10)], group)
    run.ffd("deform", "m.su2", "n.su2", "-l", "l.json", "--only", "group:wal", code=USAGE, err=re.compile("wall"))
    named = {name["selector"]: name["vertices"] for name in run.ffd("info", "m.su2", "--json", "--parts").json["named_parts"]}
    equal(named, {"group:wall": 4, "group:far": 4})
    run.write("z.su2", volume.su2_zones())
    run.ffd("deform", "z.su2", "o.su2", "-l", "l.json", "--force", "-q", "--only", "group:zone 2")
    before, after = (data.split(b"IZONE= 2") for data in (run.read("z.su2"), run.read("o.su2")))
    equal(after[0], before[0])
    check(after[1] != before[1], "the second zone moves")
    equal(run.ffd("info", "z.su2", "--json").json["topology"]["components"], 2, "zones number their points anew")


@case
def commands_see_the_outer_faces(run):
    """What an OBJ of the outer faces has: topology, u,v,w, a lattice round it, figures of check."""
    run.write("l.json", lattice(moves=BUMP))
    run.write("m.obj", "".join("v %r %r %r\n" % tuple(p) for p in volume.POINTS)
              + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in volume.OUTER))
    expected = run.ffd("info", "m.obj", "--json").json
    for name, data in (("m.vtk", volume.vtk(is_binary=True, kind="double")), ("m.su2", volume.su2()),
                       ("m.vtu", volume.vtu(encoding="raw zlib", code="d")), ("m.msh", volume.msh4(is_binary=True))):
        run.write(name, data)
        found = run.ffd("info", name, "--json").json
        equal({**found["topology"], "area": 0}, {**expected["topology"], "area": 0}, name)
        near([found["topology"]["area"]], [expected["topology"]["area"]], 1e-12)
        equal(found["bounds"], expected["bounds"])
        equal(found["contents"]["cells"], 2 if name == "m.su2" else 3)
        equal(found["contents"]["volumes"], 2)
        for path in (name, "m.obj"):
            run.ffd("embed", path, "-l", "l.json", "-o", path + ".npy", "--force")
            run.ffd("check", path, "-l", "l.json", "--report", path + ".report", "--report-stable", data=True)
        equal(run.read(name + ".npy")[:128 + 240], run.read("m.obj.npy")[:128 + 240], "u,v,w")
        mine, other = (run.read(path + ".report") for path in (name, "m.obj"))
        for member in (b'"area"', b'"volume"', b'"flipped_faces"', b'"vertices"'):
            equal(line_of(mine, member), line_of(other, member), name)
        run.ffd("lattice", "new", name, "-o", name + ".json")
        run.ffd("view", name, "-l", "l.json", "-o", name + ".png", data=True)
        run.ffd("view", name, "-l", "l.json", "-o", name + ".html", data=True)
    run.ffd("fit", "m.su2", "m.su2", "-o", "f.json", lines=1)


def line_of(report, member):
    return [re.sub(rb"(\d\.\d{10})\d+", rb"\1", line) for line in report.splitlines() if member in line]


@case
def sides_that_cells_share_are_inside(run):
    """A box of 3 by 2 by 2 hexahedra has only its outer quads; its inner points are no loose ones."""
    run.write("g.vtk", volume.vtk_grid())
    topology = run.ffd("info", "g.vtk", "--json").json["topology"]
    equal([topology[key] for key in ("faces", "boundary_edges", "euler", "isolated_vertices")], [32, 0, 2, 0])
    run.write("g.vtk", volume.vtk_grid(size=(4, 1, 3)))
    equal(run.ffd("info", "g.vtk", "--json").json["topology"]["faces"], 6, "a grid of quads")
    for name, data in (("p.vtk", volume.vtk_polyhedra()), ("p.vtu", volume.vtu_polyhedra(False)), ("q.vtu", volume.vtu_polyhedra(True))):
        run.write(name, data)
        topology = run.ffd("info", name, "--json").json["topology"]
        equal([topology[key] for key in ("faces", "boundary_edges", "euler")], [6, 0, 2], name + ": two polyhedra with one side in common")


@case
def every_kind_of_cell_has_its_sides(run):
    """Alone, each is closed: the sides of a ball, whose normals all look outwards."""
    ring = lambda n, z: [[round(x, 3), round(y, 3), z] for x, y in  # noqa: E731
                         [((1, 0), (0, 1), (-1, 0), (0, -1))[i] if n == 4 else (i, i * (n - i)) for i in range(n)]]
    shapes = {10: (3, True), 14: (4, True), 13: (3, False), 12: (4, False), 15: (5, False), 16: (6, False)}
    for number, (base, is_pointed) in shapes.items():
        points = ring(base, 0) + ([[0, 0, 1]] if is_pointed else ring(base, 1))
        text = (f"# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} float\n"
                + "".join("%g %g %g\n" % tuple(p) for p in points) + f"CELLS 1 {len(points) + 1}\n{len(points)} "
                + " ".join(map(str, range(len(points)))) + f"\nCELL_TYPES 1\n{number}\n")
        run.write("k.vtk", text)
        topology = run.ffd("info", "k.vtk", "--json").json["topology"]
        equal([topology[key] for key in ("faces", "boundary_edges", "non_manifold_edges", "euler")],
              [base + 1 + (not is_pointed), 0, 0, 2], f"kind {number}")


@case
def voxels_and_pixels_go_crosswise(run):
    """Their points are in rows, not round their faces: a box of 1 x 2 x 3 as one voxel, and its shell of pixels."""
    points = "".join(f"{x} {2 * y} {3 * z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1))
    pixels = ["0 2 1 3", "4 5 6 7", "0 1 4 5", "2 6 3 7", "0 4 2 6", "1 3 5 7"]
    run.write("l.json", lattice(moves=[]))
    for cells, kinds in ((["0 1 2 3 4 5 6 7"], "11"), (pixels, "8")):
        rows = [f"{len(cell.split())} {cell}\n" for cell in cells]
        run.write("k.vtk", f"# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n{points}"
                           f"CELLS {len(rows)} {sum(len(row.split()) for row in rows)}\n{''.join(rows)}CELL_TYPES {len(rows)}\n{(kinds + chr(10)) * len(rows)}")
        entry = run.ffd("check", "k.vtk", "-l", "l.json", "--report", "-", "-q").json["jobs"][0]
        equal([entry["volume"]["before"], entry["area"]["before"]], [6, 22], f"kind {kinds}")


@case
def meshes_of_volumes_keep_their_format(run):
    run.write("l.json", lattice(moves=BUMP))
    run.write("m.vtk", volume.vtk())
    run.write("m.su2", volume.su2())
    run.write("m.obj", "v 0 0 0\n")
    for a, b, name, other in (("m.vtk", "n.obj", "VTK", "OBJ"), ("m.su2", "n.vtk", "SU2", "VTK"), ("m.obj", "n.su2", "OBJ", "SU2"),
                              ("m.vtk", "n.vtu", "VTK", "VTU"), ("m.vtk", "n.msh", "VTK", "Gmsh")):
        run.ffd("deform", a, b, "-l", "l.json", code=UNSUPPORTED,
                err=f"{a}: {name} cannot become {other}: meshes of volumes keep their format (meshio converts them)")
    run.write("k.json", lattice(keys=[{"time": 0, "moves": []}, {"time": 1, "moves": BUMP}]))
    run.ffd("animate", "m.vtk", "n.glb", "-l", "k.json", code=USAGE,
            err="m.vtk: a mesh of volumes keeps its format, which has no animations")


@case
def streams_and_in_place(run):
    """Through pipes, in place and under a capital name the same bytes come out; so in a batch and with threads."""
    run.write("l.json", lattice(moves=BUMP))
    for name, data in (("m.vtk", volume.vtk(is_binary=True)), ("m.su2", volume.su2()), ("m.vts", volume.vts()),
                       ("m.vtp", volume.vtp(encoding="base64 zlib")), ("m.vtu", volume.vtu(encoding="raw")),
                       ("m.msh", volume.msh4(is_binary=True))):
        ending = name.split(".")[1]
        run.write(name, data)
        run.ffd("deform", name, "out." + ending, "-l", "l.json", "-q")
        expected = run.read("out." + ending)
        done = run.ffd("deform", "-", "-", "-l", "l.json", "-q", "--input-format", ending, "--output-format", ending, stdin=data)
        equal(done.out, expected, "through the streams")
        run.write("P." + ending.upper(), data)
        run.ffd("deform", "P." + ending.upper(), "--in-place", "-l", "l.json", "-q")
        equal(run.read("P." + ending.upper()), expected, "in place")
        run.write("jobs.jsonl", '{"in": "%s", "lattice": "l.json", "out": "b.%s"}\n' % (name, ending))
        run.ffd("batch", "jobs.jsonl", "-q")
        equal(run.read("b." + ending), expected, "in a batch")
        run.ffd("deform", name, "t." + ending, "-l", "l.json", "-q", "--threads", "3")
        equal(run.read("t." + ending), expected, "with threads")


@case
def what_differs_is_told(run):
    run.write("a.vtk", volume.vtk(kind="double"))
    moved = [[x + (i == 3) * 0.5 for x in p] for i, p in enumerate(volume.POINTS)]
    run.write("b.vtk", volume.vtk(moved, kind="double"))
    done = run.ffd("compare", "a.vtk", "b.vtk", code=NO)
    check("point 3 counted from 0: x differs by 0.5" in done.text, done.text)
    run.ffd("compare", "a.vtk", "b.vtk", "--tolerance", "1")
    for change, said in ((("5 4 5 6 7 8", "5 5 4 6 7 8"), "cell 1 counted from 0 differs"), (("0.25 0.0", "0.75 0.0"), "other bytes"),
                         (("0.5 0.25 1.75", "0.5  0.25 1.75"), None)):
        text = volume.vtk(kind="double").decode()
        text = re.sub(r"\s+".join(re.escape(w) for w in change[0].split()), change[1], text)
        check(text != volume.vtk(kind="double").decode(), change)
        run.write("c.vtk", text)
        done = run.ffd("compare", "a.vtk", "c.vtk", code=NO if said else 0)
        check(not said or said in done.text, done.text)
    run.write("b.vtk", volume.vtk(is_binary=True, kind="double"))
    check("one is ascii, the other binary" in run.ffd("compare", "a.vtk", "b.vtk", code=NO).text, "encodings")


HEAD = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"
BROKEN_VTK = [
    ("solid x\n", INVALID, 'does not begin with "# vtk DataFile Version"; it seems to be an STL file'),
    ("# vtk DataFile Version 3.0\nt\nASCI\n", INVALID, '"ASCI" is not ASCII or BINARY'),
    ("# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\n", UNSUPPORTED, "the data are a RECTILINEAR_GRID"),
    (HEAD, INVALID, "has no POINTS"),
    (HEAD + "POINTS 1 int\n0 0 0\n", UNSUPPORTED, "the points are of the type int"),
    (HEAD + "POINTS x float\n", INVALID, ':5: "x" is not the number of points'),
    (HEAD + "POINTS 99999999999999 float\n0 0 0\n", INVALID, "more than the file can hold"),
    (HEAD + "POINTS 20 float\n0 0 0\n", INVALID, "the file ends too early: 7 bytes are left for 20 points"),
    (HEAD + "POINTS 2 float\n0 0 0 1 1\n\n\n\n", INVALID, "the file ends after 1 of 2 points"),
    (HEAD + "POINTS 1 float\n0 0 z\n", INVALID, ':6: point 0 (counted from 0) has "z", which is not a number'),
    (HEAD + "POINTS 1 float\n0 0 0\nPOINTS 1 float\n0 0 0\n", INVALID, "there are POINTS twice"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\n", INVALID, "a line has the point 1, but there are only 1"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 2\n1 0\nCELL_TYPES 1\n3\n", INVALID, "a line has 1 points, not 2"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 2\n1 0\nCELL_TYPES 1\n99\n", UNSUPPORTED, "cells of the type 99 are not supported"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 2\n1 -1\nCELL_TYPES 1\n1\n", INVALID, '"-1" is not a point'),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 2\n1 0\n", INVALID, "there are 1 cells, but 0 CELL_TYPES"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 3\n1 0 0\nCELL_TYPES 1\n1\n", INVALID, "1 more numbers than the cells"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 2\n9 0\nCELL_TYPES 1\n1\n", INVALID, "more points than their list"),
    (HEAD + "POINTS 1 float\n0 0 0\nCELLS 1 6\n5 1 9 0 0 0\nCELL_TYPES 1\n42\n", INVALID, "the faces of a polyhedron"),
    (HEAD + "POINTS 1 float\n0 0 0\nPOINT_DATA 2\n", INVALID, "POINT_DATA are of 2 points, but there are 1"),
    (HEAD + "POINTS 1 float\n0 0 0\nPOINT_DATA 1\nNORMALS n float\n0 0\n", INVALID, "the file ends"),
    (HEAD + "POINTS 1 float\n0 0 0\nPOINT_DATA 1\nSCALARS a utf8\n", UNSUPPORTED, 'arrays of the type "utf8"'),
    (HEAD + "POINTS 1 float\n0 0 0\n7\n", INVALID, '"7" is not a keyword'),
    (HEAD.replace("UN", "") + "DIMENSIONS 2 1 1\nPOINTS 1 float\n0 0 0\n", INVALID, "the dimensions are 2 by 1 by 1"),
    (HEAD.replace("UN", "") + "POINTS 1 float\n0 0 0\n", INVALID, "has no DIMENSIONS"),
    (HEAD.replace("3.0", "5.1") + "POINTS 1 float\n0 0 0\nCELLS 2 1\nOFFSETS vtktypeint64\n1 1\nCONNECTIVITY vtktypeint64\n0\n"
     "CELL_TYPES 1\n1\n", INVALID, "the first offset of the cells is 1, not 0"),
    (HEAD.replace("3.0", "5.1") + "POINTS 1 float\n0 0 0\nCELLS 3 1\nOFFSETS vtktypeint64\n0 1 0\nCONNECTIVITY vtktypeint64\n0\n"
     "CELL_TYPES 2\n1 1\n", INVALID, "the offset 0 of a cell is below the one before it, 1"),
]
def xml(body, grid="UnstructuredGrid", head='byte_order="LittleEndian"'):
    return f'<VTKFile type="{grid}" {head}>\n<{grid}>\n{body}</{grid}></VTKFile>\n'


def piece(points='format="ascii">0 0 0', cells="", count=1, number=0):
    return (f'<Piece NumberOfPoints="{count}" NumberOfCells="{number}"><Points>'
            f'<DataArray type="Float32" NumberOfComponents="3" {points}</DataArray></Points>{cells}</Piece>')


def cells(points="0", offsets="1", kinds="1"):
    return "<Cells>" + "".join(f'<DataArray type="Int32" Name="{name}" format="ascii">{values}</DataArray>'
                               for name, values in (("connectivity", points), ("offsets", offsets), ("types", kinds))) + "</Cells>"


def listed(cells="4 8", faces="0 1 2 3 0 4 5 6", ends="3 6 9 12 15 18 21", corner="0"):
    """Polyhedra with a list of faces, broken."""
    text = volume.vtu_polyhedra(True).decode()
    for name, values in (("polyhedron_offsets", cells), ("polyhedron_to_faces", faces), ("face_offsets", ends)):
        text = re.sub(rf'(Name="{name}" format="ascii">)[^<]*', rf"\g<1>{values}", text)
    return re.sub(r'(Name="face_connectivity" format="ascii">)0', rf"\g<1>{corner}", text)


ZLIB = 'byte_order="LittleEndian" compressor="vtkZLibDataCompressor"'


def base64_of(*numbers):
    return base64.b64encode(struct.pack(f"<{len(numbers)}I", *numbers)).decode()


BROKEN_VTU = [
    ("OFF\n", INVALID, "does not begin with a tag of XML; it seems to be an OFF file"),
    ("<svg/>", INVALID, "does not begin with <VTKFile>"),
    (xml("", "ImageData"), UNSUPPORTED, 'is a "ImageData" of VTK; of this ending is a UnstructuredGrid'),
    (xml("", head='compressor="vtkLZ4DataCompressor"'), UNSUPPORTED, "is compressed by vtkLZ4DataCompressor"),
    (xml(""), INVALID, "has no Piece"),
    ('<?xml version="1.0"?>' + xml(""), INVALID, "m.vtu: has no Piece"),
    (xml(piece())[:-11], INVALID, "ends before </VTKFile>"),
    (xml("<!-- ") , INVALID, "a comment or an instruction does not end"),
    (xml('<Piece NumberOfPoints="-1">'), INVALID, ':3: NumberOfPoints is "-1", not a whole number'),
    (xml('<Piece NumberOfPoints="1"/>'), INVALID, ":3: a piece has no array of its points"),
    (xml(piece(count=99999999)), INVALID, "a piece has 99999999 points, more than the file can hold"),
    (xml(piece(count=2)), INVALID, "2 points"),
    (xml(piece('format="ascii">0 0 x')), INVALID, 'has "x", which is not a number'),
    (xml(piece('format="odd">0 0 0')), UNSUPPORTED, 'an array has the format "odd"'),
    (xml(piece().replace("Float32", "Int32")), UNSUPPORTED, "the points are not Float32 or Float64"),
    (xml(piece().replace('"3"', '"2"')), INVALID, "the points have 2 components, not 3"),
    (xml(piece('format="binary">' + base64_of(12, 0, 0))), INVALID, "the file ends within the data of an array, or they are not base64"),
    (xml(piece('format="binary">' + base64_of(8, 0, 0))), INVALID, "an array has 8 bytes, not 12"),
    (xml(piece('format="binary">****')), INVALID, "the file ends within the data of an array"),
    (xml(piece('format="appended" offset="0">')), INVALID, "at the offset 0 of the appended data, which are missing"),
    (xml(piece('format="appended" offset="900">')).replace("</VTKFile>", '<AppendedData encoding="raw">_</AppendedData></VTKFile>'),
     INVALID, "at the offset 900 of the appended data, which end before"),
    (xml(piece('format="appended" offset="0">')).replace("</VTKFile>", '<AppendedData encoding="hex">_</AppendedData></VTKFile>'),
     INVALID, 'the appended data have the encoding "hex"'),
    (xml(piece('format="binary">' + base64_of(2**31, 1, 1)), head=ZLIB), INVALID, "states 2147483648 compressed blocks"),
    (xml(piece('format="binary">' + base64_of(1, 12, 0, 8) + base64_of(0, 0)), head=ZLIB), INVALID, "compressed data are broken"),
    (xml(piece('format="binary">' + base64_of(1, 2**31, 0, 8) + base64_of(0, 0)), head=ZLIB), INVALID, "2147483648 bytes, not 12"),
    (xml(piece(number=1)), INVALID, "a piece has 1 cells, but not their connectivity, offsets and types"),
    (xml(piece(cells=cells("1"), number=1)), INVALID, "a cell has the point 1, but its piece has only 1"),
    (xml(piece(cells=cells("-1"), number=1)), INVALID, "a cell has a point below 0"),
    (xml(piece(cells=cells("0", "2"), number=1)), INVALID, "an array of cells has 1 numbers, not 2"),
    (xml(piece(cells=cells("0 0", "2 1", "1 1"), number=2)), INVALID, "the offset 2 of cell 0 is not between 0 and 1"),
    (xml(piece(cells=cells("0", "1", "3"), number=1)), INVALID, "a line has 1 points, not 2"),
    (xml(piece(cells=cells("0", "1", "x"), number=1)), INVALID, '"x" is not a whole number'),
    (xml(piece(cells=cells("0", "1", "42"), number=1)), INVALID,
     "polyhedron 0 has neither faces and faceoffsets nor face_connectivity, face_offsets, polyhedron_to_faces and polyhedron_offsets"),
    (xml(piece(cells=cells("0", "1", "99"), number=1)), UNSUPPORTED, "cells of the type 99 are not supported"),
    (listed(faces="0 1 2 3 0 4 5 7"), INVALID, "polyhedron 1 has a face that is not there"),
    (listed("-1 8"), INVALID, "the faces of polyhedron 0 are not there"),
    (listed("4 9"), INVALID, "the faces of polyhedron 1 are not there"),
    (listed("4 4"), INVALID, "the faces of polyhedron 1 are not there"),
    (listed("4 15", "0 1 2 3" + " 0" * 11), INVALID, "polyhedron 1 has a face that two others have"),
    (listed(ends="3 6 9 12 15 18 22"), INVALID, "the points of face 6 are not there"),
    (listed(ends="3 2 9 12 15 18 21"), INVALID, "the points of face 1 are not there"),
    (listed(corner="5"), INVALID, "a cell has the point 5, but its piece has only 5"),
]


def msh(nodes="$Nodes\n1\n1 0 0 0\n$EndNodes\n", rest="", head="2.2 0 8"):
    return f"$MeshFormat\n{head}\n$EndMeshFormat\n{nodes}{rest}"


def elements(line, count=1):
    return f"$Elements\n{count}\n{line}\n$EndElements\n"


NEW = "$Nodes\n1 1 1 1\n0 1 0 1\n1\n0 0 0\n$EndNodes\n"
# The first node is on an entity of nine dimensions.
PARAMETRIC = re.sub(rb"(?s)(?<=\$ParametricNodes\n10\n)(.{28}).{4}", lambda found: found[1] + struct.pack("<i", 9),
                    volume.msh2(is_binary=True, parameters=True), count=1)
BROKEN_MSH = [
    ("", INVALID, "has no $Nodes"),
    ("OFF\n", INVALID, ':1: "OFF" is in the place of the beginning of a section, such as $Nodes; it seems to be an OFF file'),
    ("$Nodes\n", INVALID, ":1: the first section is not $MeshFormat"),
    ("$MeshFormat\n", INVALID, "the file ends where a version is expected"),
    (PARAMETRIC, INVALID, "the dimension of an entity is 9"),
    (msh(head="1 0 8"), UNSUPPORTED, 'the version "1" is not supported: only 2.2 and 4.1 are'),
    (msh(head="4 0 8"), UNSUPPORTED, 'the version "4" is not supported'),
    (msh(head="2.2 0 2"), UNSUPPORTED, "numbers of 2 bytes are not supported"),
    ("$MeshFormat\n2.2 1 8\nabcd", INVALID, "the number behind the format is not 1 in either byte order"),
    (msh(""), INVALID, "has no $Nodes"),
    (msh("$Comments\n"), INVALID, ":5: the section $Comments has no $EndComments"),
    (msh("$Nodes\nx\n"), INVALID, ':5: "x" is not the number of nodes'),
    (msh("$Nodes\n999999\n"), INVALID, "the number of nodes is 999999, more than the file can hold"),
    (msh("$Nodes\n2\n1 0 0 0\n$EndNodes\n"), INVALID, ":7: point 1 (counted from 0) needs 3 numbers"),
    (msh("$Nodes\n2\n1 0 0 0\n$EndNodes\n$Comments\na b c d e f\n"), INVALID, ":7: point 1 (counted from 0) needs 3 numbers"),
    (msh("$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n"), INVALID, "the node 1 is there twice"),
    (msh("$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n"), INVALID, ':7: "2" is in the place of the end of the section $Nodes'),
    (msh("$Nodes\n1\n-1 0 0 0\n$EndNodes\n"), INVALID, '"-1" is not the number of a node'),
    (msh(rest="$Nodes\n1\n1 0 0 0\n$EndNodes\n"), INVALID, "there are nodes twice"),
    (msh("", elements("1 15 2 0 1 1")), INVALID, "the elements are there before the nodes"),
    (msh(rest=elements("1 15 2 0 1 2")), INVALID, ":10: an element has the node 2, which is not there"),
    (msh(rest=elements("1 999 2 0 1 1")), UNSUPPORTED, ":10: elements of the type 999 are not supported"),
    (msh(rest=elements("1 15 2 0 1 1", 2)), INVALID, "is not the number of an element"),
    (msh(rest="$PhysicalNames\n1\n2 1 wall\n$EndPhysicalNames\n"), INVALID, "a physical group has no name in quotes"),
    (msh(NEW.replace("0 1 0 1", "4 1 0 1"), head="4.1 0 8"), INVALID, "the dimension of an entity is 4"),
    (msh(NEW.replace("1 1 1 1", "0 1 1 1"), head="4.1 0 8"), INVALID, "1 nodes are stated, but the entities have 0"),
    (msh(NEW.replace("0 1 0 1", "0 1 0 2"), head="4.1 0 8"), INVALID, "the entities have more nodes than the 1 that are stated"),
    (msh(NEW, "$Elements\n1 1 1 1\n0 1 15 2\n1 1\n2 1\n$EndElements\n", "4.1 0 8"), INVALID, "more elements than are stated"),
    (msh(NEW, "$Elements\n0 1 1 1\n$EndElements\n", "4.1 0 8"), INVALID, "1 elements that are stated are not there"),
]
BROKEN_SU2 = [
    ("", INVALID, "has no NDIME="),
    ("v 0 0 0\n", INVALID, ":1: a line KEY= VALUE is expected here; it seems to be an OBJ file"),
    ("NDIME= 4\n", INVALID, ":1: NDIME is 4, not 2 or 3"),
    ("NDIME= 3\n", INVALID, "has no NPOIN="),
    ("NDIME= 3\nNPOIN= x\n", INVALID, ':2: NPOIN is not a whole number: "x"'),
    ("NDIME= 3\nNPOIN= 3\n0 0 0\n", INVALID, ":2: NPOIN states 3 lines, but only 1 follow"),
    ("NDIME= 3\nNPOIN= 18446744073709551615\n0 0 0\n", INVALID, "NPOIN states"),
    ("NDIME= 3\nNPOIN= 1\n0 0 % z\n", INVALID, ":3: point 0 (counted from 0) needs 3 numbers"),
    ("NDIME= 3\nNPOIN= 1\n0 0 y\n", INVALID, ':3: point 0 (counted from 0) has "y"'),
    ("NDIME= 3\nNPOIN= 1\n0 0 0\n1 1 1\n", INVALID, ":4: a line KEY= VALUE is expected here"),
    ("NDIME= 3\nNELEM= 1\n10 0 0 0 1\nNPOIN= 1\n0 0 0\n", INVALID, ":3: an element has the point 1, but there are only 1"),
    ("NDIME= 3\nNELEM= 1\n10 0 0\nNPOIN= 1\n0 0 0\n", INVALID, ':3: a point of an element is not a whole number: ""'),
    ("NDIME= 3\nNELEM= 1\n77 0 0\nNPOIN= 1\n0 0 0\n", UNSUPPORTED, ":3: elements of the type 77 are not supported"),
    ("NDIME= 3\nNPOIN= 1\n0 0 0\nMARKER_ELEMS= 1\n1 0\n", INVALID, ":4: MARKER_ELEMS are there before MARKER_TAG"),
    ("NDIME= 3\nNPOIN= 1\n0 0 0\nNPOIN= 1\n0 0 0\n", INVALID, ":5: there are points twice in a zone"),
    ("NDIME= 3\nNDIME= 2\n", UNSUPPORTED, ":2: zones of two and of three dimensions"),
]


def box_of(n):
    """A VTK grid of n points a direction, at whole numbers."""
    points = [[float(x), float(y), float(z)] for z in range(n) for y in range(n) for x in range(n)]
    return volume.vtk_grid(points, kind="double", size=(n, n, n))


@case
def edges_inside_are_torn_and_held(run):
    """A lattice round the eight innermost of 6^3 points cuts 24 edges, none of which is on an outer face."""
    run.write("m.vtk", box_of(6))
    run.write("l.json", lattice(size=(8, 8, 8), low=(1.5, 1.5, 1.5), high=(3.5, 3.5, 3.5), moves=[{"by": [0.3, 0, 0]}]))
    for name in ("check", "deform"):
        out = ["o.vtk"] if name == "deform" else []
        run.ffd(name, "m.vtk", *out, "-l", "l.json", "--fail-on", "tear", "--report", "r.json", "--force", code=NO, err=re.compile("208 vertices stay"))
        equal([json.loads(run.read("r.json"))["jobs"][0]["tear"][key] for key in ("edges", "largest")], [24, 0.3])
    run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", "--seam", "C1", "--fail-on", "tear", "--force",
            err=lambda said: check("the mesh cuts 6 faces, held at C1: u- u+ v- v+ w- w+" in said[0], said))


@case
def cells_join_the_points_of_a_component(run):
    """Those inside, and those between the corners of quadratic cells."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(6, 6, 6), moves=[{"bend": {"axis": "x", "toward": "y", "degrees": 40}}]))
    run.write("m.vtk", box_of(5))
    tetra = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]
    run.write("q.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n" + volume.rows(tetra)
              + "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n")
    for name, data in (("p.vtk", volume.vtk_polyhedra()), ("m.vtk", None), ("q.vtk", None)):
        if data:
            run.write(name, data)
        run.ffd("deform", name, "o.vtk", "-l", "l.json", "--rigid", "component", "--report", "r.json", "--force", "-q")
        equal([part["pieces"] for part in json.loads(run.read("r.json"))["jobs"][0]["rigid"]], [1], name)


@case
def fits_count_the_points_inside(run):
    run.write("m.vtk", box_of(6))
    run.write("l.json", lattice(size=(8, 8, 8), low=(1.5, 1.5, 1.5), high=(3.5, 3.5, 3.5), moves=[{"by": [0.3, 0, 0]}]))
    run.ffd("deform", "m.vtk", "n.vtk", "-l", "l.json", "-q")
    run.ffd("fit", "m.vtk", "n.vtk", "--size", "4,4,4", "--within", "0.01", "-o", "f.json", code=NO, err=re.compile("no smoothing brings all pairs within 0.01"))


@case
def what_other_programs_write(run):
    """A first piece without points and of another type; a marker between processors; a grid of nothing with large numbers."""
    run.write("l.json", lattice(moves=BUMP))
    made = volume.vtu(code="d").decode()
    empty = ('<Piece NumberOfPoints="0" NumberOfCells="0"><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii"/></Points>'
             "</Piece>\n<Piece")
    deformed(run, "m.vtu", made.replace("<Piece", empty, 1).encode(), err=anything)
    after = deformed(run, "m.su2", volume.su2().replace(b"MARKER_ELEMS= 1\n", b"MARKER_ELEMS= 1\nSEND_RECV= 1\n", 1))
    equal(volume.su2_points(after, 3), carried(run, volume.POINTS, "l.json"))
    run.write("m.vts", '<VTKFile type="StructuredGrid" byte_order="LittleEndian"><StructuredGrid WholeExtent="0 -1 0 99999999 0 99999999">'
                       '<Piece Extent="0 -1 0 99999999 0 99999999"><Points><DataArray type="Float32" NumberOfComponents="3" format="ascii"/>'
                       "</Points></Piece></StructuredGrid></VTKFile>")
    equal(run.ffd("info", "m.vts", "--json").json["contents"]["cells"], 0)
    shared = 'type="Float32" NumberOfComponents="3" format="appended" offset="0"'
    run.write("s.vtu", '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="0">'
                       f'<PointData><DataArray Name="same" {shared}/></PointData><Points><DataArray {shared}/></Points></Piece></UnstructuredGrid>'
                       '<AppendedData encoding="base64">_' + base64.b64encode(struct.pack("<I3f", 12, 0.5, 0.5, 0.5)).decode() + "</AppendedData></VTKFile>")
    run.ffd("deform", "s.vtu", "o.vtu", "-l", "l.json", code=UNSUPPORTED, err="s.vtu: several arrays share data that would change")


@case
def memory_for_groups_is_bounded(run):
    """An entity of many groups with many elements: 260 KB that ask for 1.6 GB."""
    many = 20000
    groups = " ".join(str(i + 1) for i in range(many))
    points = "".join(f"{i + 1} 1\n" for i in range(many))
    run.write("m.msh", f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 0 0\n1 0 0 0 {many} {groups}\n$EndEntities\n"
                       f"$Nodes\n1 1 1 1\n0 1 0 1\n1\n0 0 0\n$EndNodes\n$Elements\n1 {many} 1 {many}\n0 1 15 {many}\n{points}$EndElements\n")
    run.ffd("info", "m.msh", code=LIMIT, err=re.compile(r"m.msh: needs more than the \d+ MB of memory allowed"))


@case
def broken_files_are_refused(run):
    run.write("l.json", lattice(moves=BUMP))
    for name, broken in (("m.vtk", BROKEN_VTK), ("m.su2", BROKEN_SU2), ("m.vtu", BROKEN_VTU), ("m.msh", BROKEN_MSH)):
        for text, code, said in broken:
            run.write(name, text)
            done = run.ffd("deform", name, "n." + name[2:], "-l", "l.json", code=code)
            check(said in done.err[0] and ("XML file" not in done.err[0] or name != "m.vtu"), f"{text!r}: {done.err[0]!r} lacks {said!r}")
            run.ffd("info", name, code=code)


main()
