#!/usr/bin/env python3
"""Cells of volume meshes: which a deformation inverts, beside determinants in fractions and scaled Jacobians computed here, in each format;
gates, warnings, and kinds of which nothing is known."""
import json
import math
import re
from fractions import Fraction

import foam_files as foam
import volume_files as volume
from harness import CUBE, NO, OK, USAGE, case, check, equal, float32, lattice, main, near
from messages import anything, entry, one_line

TETRA, VOXEL, HEXAHEDRON, WEDGE, PYRAMID, TETRA10, LAGRANGE_TETRA = 10, 11, 12, 13, 14, 24, 71
# x' = x + 2 u (1 - u) 0.9 of the box [0, 1]^3 turns round at 7/9: what lies beyond is mirrored.
FOLD = lattice(size=(3, 2, 2), low=(0, 0, 0), high=(1, 1, 1), degree=[2, 1, 1], moves=[{"at": [1, "all", "all"], "by": [0.9, 0, 0]}])
STAYS = lattice(size=(2, 2, 2), low=(0, 0, 0), high=(1, 1, 1))
INVERTED = re.compile("cells? (is|are) inverted by the deformation")


def written(points, cells, kind="double"):
    """A VTK file of cells: (kind, points)."""
    made = volume.Vtk(False, "UNSTRUCTURED_GRID").line(f"POINTS {len(points)} {kind}").numbers("d", volume.flat(points))
    made.line(f"CELLS {len(cells)} {sum(len(c) + 1 for _, c in cells)}").numbers("i", volume.flat([len(c), *c] for _, c in cells))
    return made.line(f"CELL_TYPES {len(cells)}").numbers("i", [k for k, _ in cells]).data


def grid(n):
    """Points of a grid on [0, 1]^3, and six tetrahedra in each of its boxes."""
    points = [[x / n, y / n, z / n] for z in range(n + 1) for y in range(n + 1) for x in range(n + 1)]
    cells = []
    for z in range(n):
        for y in range(n):
            for x in range(n):
                at = [x + i + (n + 1) * (y + j + (n + 1) * (z + k)) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
                cells += [(TETRA, [at[0], at[a], at[b], at[7]]) for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))]
    return points, cells


def determinant(points, cell):
    a, b, c = ([Fraction(x) - Fraction(y) for x, y in zip(points[cell[i]], points[cell[0]])] for i in (1, 2, 3))
    return sum(a[i] * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i in range(3))


def scaled(points, cell):
    """The scaled Jacobian of a tetrahedron."""
    edge = [[math.dist(points[a], points[b]) for b in cell] for a in cell]
    largest = max(math.prod(edge[i][k] for k in range(4) if k != i) for i in range(4))
    return math.sqrt(2) * float(determinant(points, cell)) / largest


def judged(run, name, lattice_name="l.json", *options):
    """The cells of the report of check; None: it has none."""
    return entry(run, "check", name, "-l", lattice_name, *options).get("cells")


def reported(run, name, lattice_name="l.json", *options, inverts=False):
    """The same, which are those of deform; whether deform warns of cells."""
    found = judged(run, name, lattice_name, "--report-stable", *options)
    run.ffd("deform", name, "o." + name.split(".")[1], "--force", "-l", lattice_name, "--report", "r.json", "--report-stable", *options,
            err=lambda said: equal(sum(bool(INVERTED.search(line)) for line in said), int(inverts), f"{name}: {said}"))
    equal(json.loads(run.read("r.json"))["jobs"][0].get("cells"), found, "check and deform")
    return found


@case
def tetrahedra_are_counted_by_exact_determinants(run):
    points, cells = grid(4)
    run.write("l.json", FOLD)
    run.write("m.vtk", written(points, cells))
    found = reported(run, "m.vtk", inverts=True)
    after = volume.vtk_vectors(run.read("o.vtk"), b"POINTS", "d", len(points))[0]
    inverted = [determinant(after, cell) <= 0 for _, cell in cells]
    quality = [scaled(after, cell) for _, cell in cells]
    check(0 < sum(inverted) < len(cells), sum(inverted))
    equal({key: found[key] for key in ("count", "inverted", "by_deformation", "unknown")},
          {"count": len(cells), "inverted": {"before": 0, "after": sum(inverted)}, "by_deformation": sum(inverted), "unknown": 0})
    near([found["scaled_jacobian"]["after"]], [min(quality)], 1e-12)
    near([found["scaled_jacobian"]["before"]], [min(scaled(points, cell) for _, cell in cells)], 1e-12)
    near([quality[found["worst"]]], [min(quality)], 1e-12)


@case
def a_file_that_numbers_its_cells_the_other_way_round_is_judged(run):
    points, cells = grid(3)
    turned = [(kind, [cell[1], cell[0], *cell[2:]]) for kind, cell in cells]
    run.write("l.json", FOLD)
    run.write("m.vtk", written(points, cells))
    run.write("t.vtk", written(points, turned))
    right = reported(run, "m.vtk", inverts=True)
    found = reported(run, "t.vtk", inverts=True)
    equal(found["by_deformation"], right["by_deformation"])
    equal(found["inverted"], {"before": len(cells), "after": len(cells) - right["by_deformation"]})


@case
def a_cell_that_rounding_flattens_is_inverted(run):
    """Its height is 2^-30 at z = 0, and nothing in the floats at z = 1."""
    points = [[0.25, 0.25, 0.0], [0.75, 0.25, 0.0], [0.25, 0.75, 0.0], [0.25, 0.25, 2.0 ** -30]]
    run.write("l.json", lattice(low=(0, 0, -1), high=(1, 1, 1), moves=[{"by": [0, 0, 1]}]))
    run.write("d.vtk", written(points, [(TETRA, [0, 1, 2, 3])]))
    run.write("f.vtk", written(points, [(TETRA, [0, 1, 2, 3])], "float"))
    equal(reported(run, "d.vtk")["inverted"], {"before": 0, "after": 0}, "doubles")
    found = judged(run, "f.vtk")
    equal(float32(1 + 2.0 ** -30), 1.0)
    equal((found["inverted"], found["by_deformation"], found["scaled_jacobian"]["after"]), ({"before": 0, "after": 1}, 1, 0), "floats")


@case
def every_format_lends_its_cells(run):
    """The hexahedron and the pyramid of each file; the quadrilateral is no cell of three dimensions."""
    run.write("l.json", lattice(moves=[{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]))
    files = {"m.vtk": volume.vtk(kind="double"), "b.vtk": volume.vtk(is_binary=True, kind="double"),
             "5.vtk": volume.vtk(kind="double", offsets=True), "m.su2": volume.su2(), "2.msh": volume.msh2(),
             "2b.msh": volume.msh2(is_binary=True), "4.msh": volume.msh4(), "4b.msh": volume.msh4(is_binary=True)}
    files |= {f"{i}.vtu": volume.vtu(encoding=encoding, code="d") for i, encoding in enumerate(volume.ENCODINGS)}
    found = {}
    for name, data in files.items():
        run.write(name, data)
        found[name] = judged(run, name)
    equal([name for name, cells in found.items() if cells != found["m.vtk"]], [])
    equal({key: found["m.vtk"][key] for key in ("count", "inverted", "by_deformation", "unknown")},
          {"count": 2, "inverted": {"before": 0, "after": 0}, "by_deformation": 0, "unknown": 0})
    for name, data, count in (("g.vtk", volume.vtk_grid(kind="double"), 12), ("g.vts", volume.vts(code="d"), 12)):
        run.write(name, data)
        equal(judged(run, name)["count"], count, name)


@case
def meshes_without_volume_cells_have_no_figures_and_no_gates(run):
    run.write("l.json", lattice())
    files = {"a.obj": CUBE, "p.vtk": volume.vtk_polygons(kind="double"), "f.su2": volume.su2_flat()}
    for name, data in files.items():
        run.write(name, data)
        check("cells" not in run.ffd("check", name, "-l", "l.json").text, name)
        equal(judged(run, name), None, name)
        for gate, word in (("inverted", "inverted"), ("inverted=3", "inverted"), ("quality=0.1", "quality")):
            for command in (["check", name], ["deform", name, "o." + name.split(".")[1]]):
                run.ffd(*command, "-l", "l.json", "--fail-on", gate, code=USAGE,
                        err=f"{name}: has no volume cells, which --fail-on {word} judges")


@case
def gates_of_cells(run):
    points, cells = grid(3)
    run.write("l.json", FOLD)
    run.write("s.json", STAYS)
    run.write("m.vtk", written(points, cells))
    found = judged(run, "m.vtk")
    count, least = found["by_deformation"], found["scaled_jacobian"]["after"]
    line = f"{count} of {len(cells)} cells are inverted by the deformation (--fail-on inverted)"
    for gate, code, words in (("inverted", NO, line), ("inverted=0", NO, line), (f"inverted={count - 1}", NO, line), (f"inverted={count}", OK, None),
                              (f"inverted={count},inverted=1", NO, line), (f"quality={least!r}", OK, None), ("quality=-1", OK, None),
                              ("quality=0.25", NO, f"the scaled Jacobian of cell {found['worst']} is {least:g}, below 0.25 (--fail-on quality)"),
                              ("quality=-1,quality=0", NO, "below 0 (--fail-on quality)")):
        run.remove("o.vtk")
        run.ffd("check", "m.vtk", "-l", "l.json", "--fail-on", gate, code=code, err=words and re.compile(re.escape(words)))
        run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", "--fail-on", gate, "-q", code=code, err=words and re.compile(re.escape(words)))
        equal(run.exists("o.vtk"), code == OK, gate)
    run.ffd("check", "m.vtk", "-l", "s.json", "--fail-on", "inverted,quality=0.5")
    for gate, words in (("quality", "the gate quality needs a scaled Jacobian: quality=MIN"), ("quality=2", '"2" is not a scaled Jacobian of the gate quality'),
                        ("inverted=-1", '"-1" is not a number of the gate inverted'), ("inverted=0.5", '"0.5" is not a number of the gate inverted')):
        run.ffd("check", "m.vtk", "-l", "l.json", "--fail-on", gate, code=USAGE, err=f"--fail-on: {words}")


@case
def a_cell_that_could_not_be_decided_fails_the_gates(run):
    """A tetrahedron of 10 points whose middle of an edge is pulled through the others; a cubic one, of which nothing is known."""
    corners = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]]
    middles = [[(a + b) / 2 for a, b in zip(corners[i], corners[k])] for i, k in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
    run.write("s.json", STAYS)
    run.write("m.vtk", written(corners + middles, [(TETRA10, list(range(10)))]))
    equal(reported(run, "m.vtk", "s.json")["unknown"], 0)
    middles[0] = [0.45, 0.0, 0.0]
    run.write("m.vtk", written(corners + middles, [(TETRA10, list(range(10)))]))
    found = reported(run, "m.vtk", "s.json")
    equal((found["unknown"], found["inverted"], found["by_deformation"]), (1, {"before": 0, "after": 0}, 0))
    run.ffd("check", "m.vtk", "-l", "s.json", "--fail-on", "inverted,quality=-1", code=NO,
            err="m.vtk: whether 1 of 1 cell is inverted could not be decided (--fail-on inverted); "
                "1 cell could not be decided (--fail-on quality)")
    run.ffd("check", "m.vtk", "-l", "s.json", "--fail-on", "inverted=1")
    run.write("h.vtk", written(corners + middles * 3, [(LAGRANGE_TETRA, list(range(20)))]))
    line = "h.vtk: 1 cell is of kinds whose Jacobian is not known here (of higher order) and counts as unknown"
    run.ffd("check", "h.vtk", "-l", "s.json", err=line)
    found = judged(run, "h.vtk", "s.json")
    equal((found["unknown"], found["scaled_jacobian"], found["worst"]), (1, {"before": None, "after": None}, None))


@case
def polyhedra_have_no_scaled_jacobian(run):
    run.write("m.vtk", volume.vtk_polyhedra())
    run.write("s.json", lattice())
    run.write("l.json", lattice(moves=[{"scale": {"factor": [1, 1, -1], "about": [0, 0, 0]}}]))
    found = reported(run, "m.vtk", "s.json")
    equal(found, {"count": 2, "inverted": {"before": 0, "after": 0}, "by_deformation": 0, "unknown": 0,
                  "scaled_jacobian": {"before": None, "after": None}, "worst": None})
    run.ffd("check", "m.vtk", "-l", "s.json", "--fail-on", "inverted")
    run.ffd("check", "m.vtk", "-l", "s.json", "--fail-on", "quality=0", code=NO, err="m.vtk: no cell has a scaled Jacobian (--fail-on quality)")
    run.ffd("check", "m.vtk", "-l", "l.json", "--fail-on", "inverted", code=NO,
            err="m.vtk: 2 of 2 cells are inverted by the deformation (--fail-on inverted)")


@case
def cells_of_openfoam_are_between_its_faces(run):
    """A hexahedron and a pyramid, as polyhedra; without owner and neighbour there are none."""
    run.folder_of("o")
    run.write("s.json", lattice())
    run.write("l.json", lattice(moves=[{"scale": {"factor": [1, 1, -1], "about": [0, 0, 0]}}]))
    for is_binary in (False, True):
        files = foam.Foam(is_binary).files()
        for name in files:
            run.write(f"m/{name}", files[name])
        equal(judged(run, "m/points", "s.json"), {"count": 2, "inverted": {"before": 0, "after": 0}, "by_deformation": 0, "unknown": 0,
                                                  "scaled_jacobian": {"before": None, "after": None}, "worst": None})
        equal(judged(run, "m/points")["by_deformation"], 2)
        run.ffd("deform", "m/points", "o/points", "-l", "l.json", "--fail-on", "inverted=1", code=NO,
                err="m/points: 2 of 2 cells are inverted by the deformation (--fail-on inverted)")
        run.write("p/points", files["points"])
        run.ffd("check", "p/points", "-l", "l.json", "--fail-on", "inverted", code=USAGE, err=anything)


@case
def every_kind_is_judged_as_vtk_numbers_it(run):
    """All are right-handed; a mirror turns all over."""
    run.write("m.vtk", volume.vtk_kinds())
    run.write("s.json", STAYS)
    run.write("l.json", lattice(low=(-2, -2, -2), high=(60, 2, 2), moves=[{"scale": {"factor": [1, 1, -1], "about": [0, 0, 0]}}]))
    found = judged(run, "m.vtk", "s.json")
    equal((found["count"], found["inverted"], found["unknown"], found["by_deformation"]), (15, {"before": 0, "after": 0}, 0, 0))
    found = judged(run, "m.vtk")
    equal((found["inverted"], found["unknown"], found["by_deformation"]), ({"before": 0, "after": 15}, 0, 15))


@case
def faces_of_polyhedra_that_contradict_each_other_are_turned_as_they_lie_at_rest(run):
    """A box of which half the faces look inwards, in the second half of the lattice of FOLD."""
    points = [[0.85 + 0.1 * x, 0.2 + 0.3 * y, 0.2 + 0.3 * z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    outwards = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
    run.write("s.json", STAYS)
    run.write("l.json", FOLD)
    for turned in ([], [0, 3, 4], [0, 1, 2, 3, 4, 5]):
        faces = [face[::-1] if i in turned else face for i, face in enumerate(outwards)]
        words = [len(faces), *(word for face in faces for word in [len(face), *face])]
        made = volume.Vtk(False, "UNSTRUCTURED_GRID").line("POINTS 8 double").numbers("d", volume.flat(points))
        run.write("m.vtk", made.line(f"CELLS 1 {len(words) + 1}").numbers("i", [len(words), *words]).line("CELL_TYPES 1").numbers("i", [42]).data)
        still, moved = judged(run, "m.vtk", "s.json"), judged(run, "m.vtk")
        equal((still["by_deformation"], still["unknown"], moved["by_deformation"], moved["unknown"]), (0, 0, 1, 0), turned)
        equal(still["inverted"]["before"], int(len(turned) == 6), f"{turned}: all look inwards")


@case
def cells_of_gmsh_of_second_order_are_known(run):
    """A pyramid of 14 nodes in Gmsh's order."""
    corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 1.0]]
    edges = ((0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4))
    points = corners + [[(a + b) / 2 for a, b in zip(corners[i], corners[k])] for i, k in edges] + [[0.5, 0.5, 0.0]]
    made = volume.Msh("2.2", False).text(f"$Nodes\n{len(points)}\n")
    for number, point in enumerate(points):
        made.put("", number + 1, *point)
    made.text("$EndNodes\n$Elements\n1\n").put("", 1, 14, 2, 0, 1, *range(1, 15)).text("$EndElements\n")
    run.write("m.msh", made.data)
    run.write("s.json", lattice())
    found = reported(run, "m.msh", "s.json")
    equal((found["unknown"], found["inverted"]), (0, {"before": 0, "after": 0}))
    # The edges of the four tetrahedra at the base are longest at the apex, sqrt(1.5) each. Above 1 it falls again.
    near([found["scaled_jacobian"]["before"]], [2 - 2 / 1.5 ** 1.5], 1e-12)


@case
def a_deformation_that_inverts_cells_says_so_in_one_line(run):
    points = [[0.0, 0.0, 0.0], [0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.25], [1.0, 0.0, 0.0], [0.875, 0.0, 0.0], [0.875, 0.25, 0.0], [0.875, 0.0, 0.25]]
    cells = [(9, [0, 1, 2, 3]), (TETRA, [0, 1, 2, 3]), (TETRA, [5, 4, 6, 7])]
    run.write("l.json", FOLD)
    run.write("m.vtk", written(points, cells))
    done = run.ffd("deform", "m.vtk", "o.vtk", "-l", "l.json", err=anything)
    found = judged(run, "m.vtk")
    equal((found["by_deformation"], found["worst"]), (1, 2), "the quadrilateral is cell 0")
    equal(one_line(done, "cells is"), f"m.vtk: 1 of 2 cells is inverted by the deformation; the worst is cell 2, whose scaled Jacobian is "
                                      f"{found['scaled_jacobian']['after']:g} (see --fail-on inverted)")
    shown = run.ffd("check", "m.vtk", "-l", "l.json").text
    check("\n  cells          2: 1 inverted by the deformation (inverted: 0, deformed 1)\n" in shown, shown)
    check(f"scaled Jacobian at least {found['scaled_jacobian']['before']:g}, deformed {found['scaled_jacobian']['after']:g}, of cell 2\n" in shown, shown)


@case
def threads_and_only_change_nothing(run):
    points, cells = grid(12)
    run.write("l.json", FOLD)
    run.write("m.vtu", volume_of_tetrahedra(points, cells))
    one = reported(run, "m.vtu", "l.json", "--threads", "1", inverts=True)
    equal(reported(run, "m.vtu", "l.json", "--threads", "4", inverts=True), one)
    equal(one["count"], 6 * 12 ** 3)


def volume_of_tetrahedra(points, cells):
    made = volume.Xml("UnstructuredGrid", "raw zlib", block=4096)
    made.text(f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}"><Points>').array("Points", "d", volume.flat(points), 3)
    made.text("</Points><Cells>").array("connectivity", "q", volume.flat(c for _, c in cells))
    made.array("offsets", "q", [4 * (i + 1) for i in range(len(cells))]).array("types", "B", [k for k, _ in cells])
    return made.text("</Cells></Piece>").finished()


main()
