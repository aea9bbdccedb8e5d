#!/usr/bin/env python3
"""Vertices outside the lattice: kept, moved with the nearest point of its boundary (--outside extend) and less so
the farther they are (--falloff), or refused; and what is said of them."""
import math

from harness import (CUBE, EMBEDDING, case, check, equal, glb, glb_positions, glb_split, gltf_json, gltf_vectors,
                     lattice, main, near, obj_of, obj_vertices)
from messages import anything
from vectors import cross, unit

SHIFT = [{"by": [0, 0.5, -8]}]
BEND = [{"twist": {"axis": "z", "degrees": 50}}, {"at": [3, 3, 3], "by": [0.5, 0.25, 1]}]
BENT = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]
SCATTERED = [[3 * math.sin(k * i) for k in (1, 2.5, 4.1)] for i in range(1, 301)]


def bent(**members):
    return lattice(size=(3, 3, 3), rest={"points": BENT}, **members)


def deformed(run, points, *options, lattices=("l.json",)):
    run.write("p.obj", obj_of(points))
    chosen = [word for name in lattices for word in ("-l", name)]
    run.ffd("deform", "p.obj", "q.obj", *chosen, "--force", "-q", *options)
    return obj_vertices(run.text("q.obj"))


def outside_by(p, low=-2, high=2):
    """The distance from the box."""
    return math.sqrt(sum(max(low - x, x - high, 0) ** 2 for x in p))


def fade(distance, falloff):
    s = min(distance / falloff, 1)
    return 1 - s ** 3 * (10 - 15 * s + 6 * s * s)


def moved(p, weight):
    return [p[0], p[1] + 0.5 * weight, p[2] - 8 * weight]


@case
def kept_moved_or_faded(run):
    run.write("l.json", lattice(moves=SHIFT))
    inside = [outside_by(p) == 0 for p in SCATTERED]
    check(20 < sum(inside) < 200, "both kinds")
    near(deformed(run, SCATTERED), [moved(p, here) for p, here in zip(SCATTERED, inside)], 1e-14)
    near(deformed(run, SCATTERED, "--outside", "keep"), [moved(p, here) for p, here in zip(SCATTERED, inside)], 1e-14)
    near(deformed(run, SCATTERED, "--outside", "extend"), [moved(p, 1) for p in SCATTERED], 1e-14)
    for falloff in (0.5, 2.0, 1e9):
        near(deformed(run, SCATTERED, "--outside", "extend", "--falloff", repr(falloff)),
             [moved(p, fade(outside_by(p), falloff)) for p in SCATTERED], 1e-13)


@case
def a_mesh_beside_the_lattice_is_told_where_both_are(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("k.json", lattice(low=(3, -2, -2), high=(4, 2, 2), moves=SHIFT))
    run.write("m.obj", obj_of([[5, 6, 7], [6, 8, 9.5]]))
    mesh = "the mesh from 5 6 7 to 6 8 9.5"
    one = f"; the lattice lies from -2 -2 -2 to 2 2 2, {mesh}"
    run.ffd("deform", "m.obj", "o.obj", "-l", "l.json", err="m.obj: 2 of 2 vertices are not inside: 2 outside (left where they are)" + one)
    run.ffd("embed", "m.obj", "-l", "l.json", "-o", "e.npy", err="m.obj: 2 of 2 vertices are not inside: 2 outside (no u,v,w)" + one)
    run.ffd("check", "m.obj", "-l", "l.json", "--outside", "error", code=EMBEDDING, err=
            "m.obj: 2 of 2 vertices are outside the lattice, the first is vertex 0 (counted from 0)" + one)
    run.ffd("deform", "m.obj", "p.obj", "-l", "l.json", "-l", "k.json", "--blocks",
            err=f"m.obj: 2 of 2 vertices are not inside: 2 outside (left where they are); the lattices lie from -2 -2 -2 to 4 2 2, {mesh}")
    run.write("m.obj", obj_of([[5, 6, 7], [0, 0, 0]]))
    run.ffd("deform", "m.obj", "q.obj", "-l", "l.json", err="m.obj: 1 of 2 vertices is not inside: 1 outside (left where it is)")


@case
def the_displacement_of_the_nearest_point(run):
    """A box: the nearest point is the clipped one, which deform takes anywhere as a vertex of its own."""
    run.write("l.json", lattice(moves=BEND))
    clipped = [[min(max(x, -2), 2) for x in p] for p in SCATTERED]
    border = [[b - a for a, b in zip(p, q)] for p, q in zip(clipped, deformed(run, clipped))]
    for options, weight in (((), lambda p: 1), (("--falloff", "3"), lambda p: fade(outside_by(p), 3))):
        expected = [[x + weight(p) * d for x, d in zip(p, delta)] for p, delta in zip(SCATTERED, border)]
        found = deformed(run, SCATTERED, "--outside", "extend", *options)
        for p, q, e in zip(SCATTERED, found, expected):
            if outside_by(p) > 0:
                near(q, e, 1e-13)


@case
def what_does_not_move_keeps_its_text(run):
    """Beyond the falloff, beside an unmoved part of the border, and in coordinates that the border keeps."""
    run.write("l.json", lattice(size=(8, 8, 8), moves=[{"at": [-1, -1, -1], "by": [0, 0, 1]}]))
    lines = ["v 3.000 3.0e0 3", "v -3.000 3.0e0 3", "v +3.0 0.1 .5", "v 30.00 3.0e1 30"]
    run.write("a.obj", "\n".join(lines) + "\n")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--outside", "extend", "-q")
    equal(run.text("b.obj").splitlines(), ["v 3.000 3.0e0 4", *lines[1:3], "v 30.00 3.0e1 31"])
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--outside", "extend", "--falloff", "10", "-q")
    found = run.text("c.obj").splitlines()
    equal(found[1:], lines[1:])
    near(obj_vertices(found[0]), [[3, 3, 3 + fade(math.sqrt(3), 10)]], 1e-14)
    run.write("still.json", lattice())
    run.ffd("deform", "a.obj", "d.obj", "-l", "still.json", "--outside", "extend", "-q")
    equal(run.read("d.obj"), run.read("a.obj"))


@case
def no_step_at_the_border(run):
    for name, content, on_border in (("l.json", lattice(moves=BEND), (2, 0.3, 0.7)), ("l.json", bent(moves=BEND[:1]), (0.3, -0.4, 2))):
        run.write(name, content)
        axis = on_border.index(2)
        sides = [[x + (d if a == axis else 0) for a, x in enumerate(on_border)] for d in (-1e-9, 1e-9)]
        inner, outer = [[b - a for a, b in zip(p, q)] for p, q in zip(sides, deformed(run, sides, "--outside", "extend"))]
        near(inner, outer, 1e-8)
        check(max(map(abs, inner)) > 0.1, "it moves", inner)
        near(deformed(run, sides, "--outside", "extend", "--falloff", "1")[1], [x + d for x, d in zip(sides[1], outer)], 1e-12)
        equal(deformed(run, sides)[1], sides[1], "kept")


def cofactor(f):
    return [cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])]


@case
def normals_outside_follow_the_extended_displacement(run):
    """Those of vertices outside follow the difference quotients of the displacement there."""
    step, n = 1e-5, unit([1, 2, -0.5])
    places = [[3, 0.2, 0.7], [2.5, 3, 0.4], [0.1, -0.3, 2.8], [3, 3, 3.5], [-0.4, -2.9, 1.1]]
    around = [[x + side * step * (a == c) for a, x in enumerate(p)] for p in places for c in range(3) for side in (1, -1)]
    mesh = obj_of(places) + "vn %r %r %r\n" % tuple(n) + "f" + "".join(f" {i + 1}//1" for i in range(len(places))) + "\n"
    run.write("n.obj", mesh)
    for content in (lattice(moves=BEND), bent(moves=BEND[:1])):
        run.write("l.json", content)
        for options in (["--outside", "extend"], ["--outside", "extend", "--falloff", "2.5"]):
            neighbours = deformed(run, around, *options)
            run.ffd("deform", "n.obj", "m.obj", "-l", "l.json", "--force", "-q", *options)
            lines = run.text("m.obj").splitlines()
            found = [[float(x) for x in line.split()[1:]] for line in lines if line.startswith("vn ")]
            corners = next(line.split()[1:] for line in lines if line.startswith("f "))
            for i, corner in enumerate(corners):
                ahead = neighbours[6 * i:6 * i + 6]
                columns = [[(a - b) / (2 * step) for a, b in zip(ahead[2 * c], ahead[2 * c + 1])] for c in range(3)]
                f = [[columns[c][r] for c in range(3)] for r in range(3)]
                expected = unit([sum(row[c] * n[c] for c in range(3)) for row in cofactor(f)])
                near(found[int(corner.split("//")[1]) - 1], expected, 1e-8, f"{options}, {places[i]}")
            check(len(found) > 1, "several normals")
    run.ffd("deform", "n.obj", "m.obj", "-l", "l.json", "--force", "-q")
    equal(run.read("m.obj"), run.read("n.obj"))


@case
def the_second_lattice_extends_from_where_the_first_brought_points(run):
    """The second takes the points where the first, extended, has brought them."""
    run.write("l.json", lattice(moves=BEND))
    run.write("k.json", bent(moves=BEND[:1]))
    for options in (("--outside", "extend"), ("--outside", "extend", "--falloff", "3")):
        first = deformed(run, SCATTERED, *options)
        expected = deformed(run, first, *options, lattices=("k.json",))
        near(deformed(run, SCATTERED, *options, lattices=("l.json", "k.json")), expected, 1e-12)


@case
def the_second_lattice_round_the_mesh(run):
    """A box that is placed by the mesh is placed by what the extension made of it."""
    run.write("l.json", lattice(moves=SHIFT))
    run.write("k.json", lattice(rest={"box": "mesh", "margin": 0}, moves=[{"at": [0, 0, 0], "by": [1, 1, 1]}]))
    points = [[0.0, 0.0, 0.0], [5.0, 5.0, 5.0]]
    found = deformed(run, points, "--outside", "extend", lattices=("l.json", "k.json"))
    near(found, [[1, 1.5, -7], [5, 5.5, -3]], 1e-14)


@case
def what_is_said(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.obj", CUBE + "v 3 0 0\nv 5 0 0\nv 0 -2.5 0\np 9 10 11\n")
    start = "a.obj: 3 of 11 vertices are not inside: 3 outside "
    for options, told in (((), "(left where they are)"),
                          (("extend",), "(moved with the nearest boundary point)"),
                          (("extend", "--falloff", "9"), "(moved with the nearest boundary point)"),
                          (("extend", "--falloff", "2"),
                           "(2 moved with the nearest boundary point, 1 left where it is beyond the falloff)"),
                          (("extend", "--falloff", "0.25"), "(left where they are beyond the falloff)")):
        choice = ("--outside", *options) if options else ()
        run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", *choice, err=start + told)
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--outside", "error", code=EMBEDDING,
            err="a.obj: 3 of 11 vertices are outside the lattice, the first is vertex 8 (counted from 0)")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy", err=start + "(no u,v,w)")
    run.write("a.obj", CUBE)
    run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", "--outside", "extend", err=[])


@case
def what_is_said_where_the_border_does_not_move(run):
    """A vertex is counted as moved where the nearest point of the border moves. Two have theirs on the face x = 2."""
    run.write("a.obj", CUBE + "v 3 0 0\nv 5 0 0\nv 0 -2.5 0\np 9 10 11\n")
    start = "a.obj: 3 of 11 vertices are not inside: 3 outside "
    for at, options, told in ((1, (), "(left where they are, as the nearest boundary point is)"),
                              (-1, (), "(2 moved with the nearest boundary point, 1 left where it is, as the nearest boundary point is)"),
                              (-1, ("--falloff", "2"), "(1 moved with the nearest boundary point, 1 left where it is, as the nearest"
                               " boundary point is, 1 left where it is beyond the falloff)")):
        run.write("l.json", lattice(moves=[{"at": [at, [1, 2], [1, 2]], "by": [0, 0, 1]}]))
        done = run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", "--outside", "extend", "-v", *options, err=anything)
        check(start + told in done.err, done.err)
        moved = sum(p != q for p, q in zip(obj_vertices(run.text("a.obj")), obj_vertices(run.text("b.obj"))))
        check(any(f"{moved} of 11 vertices moved" in line for line in done.err), moved, done.err)


@case
def a_volume_that_is_less_than_its_control_points(run):
    """src/maths.md 4.4: open knots over given points cover only the middle."""
    points = [[x, y, 2 * z] for z in range(-2, 3) for y in range(-2, 3) for x in range(-2, 3)]
    run.write("a.obj", CUBE + "v 1.5 0 0\np 9\n")
    start = "a.obj: 1 of 9 vertices is not inside: 1 outside (left where it is)"
    covers = ("; l.json covers only x -1 to 1, y -1 to 1, z -2 to 2, less than its control points reach: "
              '"clamped" knots or a rest "box" cover all')
    for knots in (["uniform"] * 3, ["open"] * 3, [[0, 1, 2, 3, 4, 5, 6, 7, 8]] * 3):
        run.write("l.json", lattice(size=(5, 5, 5), knots=knots, rest={"points": points}))
        run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", err=start + covers)
        run.ffd("embed", "a.obj", "-o", "e.npy", "--force", "-l", "l.json",
                err=start.replace("left where it is", "no u,v,w") + covers)
    run.write("l.json", lattice(size=(5, 5, 5), low=(-1, -1, -1), high=(1, 1, 1), knots=["open"] * 3))
    run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", err=start)
    run.write("l.json", lattice(size=(5, 5, 5), rest={"points": [[x / 2, y / 2, z / 2] for x, y, z in points]}))
    run.ffd("deform", "a.obj", "b.obj", "--force", "-l", "l.json", err=start)


@case
def counts_in_the_report(run):
    run.write("l.json", lattice(moves=SHIFT))
    run.write("a.obj", CUBE + "v 3 0 0\nv 5 0 0\np 9 10\n")
    for options, count in (((), 8), (("--outside", "extend"), 10), (("--outside", "extend", "--falloff", "2"), 9)):
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "-q", "--report", "-", *options)
        job = done.json["jobs"][0]
        equal([job[name] for name in ("vertices", "inside", "outside", "moved")], [10, 8, 2, count])


@case
def extending_is_in_scene_space(run):
    """Scene space: the nearest point and the falloff are of where the nodes show the mesh."""
    run.write("l.json", lattice(moves=SHIFT))
    points = [[0.5, 0, 0], [1.25, 0, 0], [0, 0, -2], [3, 3, 3]]
    normal = unit([1, 0, 1])
    run.write("a.glb", glb(*gltf_json(points[:3], nodes=[{"mesh": 0, "scale": [2, 2, 2]}], normals=[normal] * 3)))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--outside", "extend", "--falloff", "4", "-q")
    weights = [fade(outside_by([2 * x for x in p]), 4) for p in points[:3]]
    near(glb_positions(run.read("b.glb")), [[[x / 2 for x in moved([2 * x for x in p], w)] for p, w in zip(points, weights)]], 1e-6)
    found = gltf_vectors(*glb_split(run.read("b.glb")), 1)
    near(found[0], normal, 1e-7)
    # p = (2.5, 0, 0): F = I + delta (w', 0, 0); cof(F) n = (n_x - w' delta . n, n_y, n_z).
    slope = -30 * 0.125 ** 2 * 0.875 ** 2 / 4
    near(found[1], unit([normal[0] - slope * -8 * normal[2], 0, normal[2]]), 1e-6)


@case
def embeddings_are_extended_too(run):
    run.write("p.obj", obj_of(SCATTERED))
    for content in (lattice(moves=BEND), bent(moves=BEND[:1])):
        run.write("l.json", content)
        run.ffd("embed", "p.obj", "-l", "l.json", "-o", "e.npy", "-q", "--force")
        for options in (("--outside", "extend"), ("--outside", "extend", "--falloff", "2")):
            searched = deformed(run, SCATTERED, *options), run.read("q.obj")
            equal((deformed(run, SCATTERED, *options, "--embedding", "e.npy"), run.read("q.obj")), searched)


@case
def threads_change_nothing(run):
    many = [[x * 1.03 for x in p] for k in range(12) for p in [[y + k / 50 for y in q] for q in SCATTERED]]
    for content in (lattice(moves=BEND), bent(moves=BEND[:1])):
        run.write("l.json", content)
        for options in (("--outside", "extend"), ("--outside", "extend", "--falloff", "2")):
            outputs = set()
            for threads in ("1", "2", "5"):
                deformed(run, many, *options, "-j", threads)
                outputs.add(run.read("q.obj"))
            equal(len(outputs), 1)


main()
