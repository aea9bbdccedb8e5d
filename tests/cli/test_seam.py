#!/usr/bin/env python3
"""Edges across the seam of a full turn that is not closed: torn where its moved faces part."""
import math

from harness import case, equal, lattice, main, near, npy, obj_of, obj_vertices
from messages import anything, counts, entry, one_line


def ring(control):
    """The rest points of a ring about z: radius 1 and 2, 5 rays by `control`, height 0 and 1."""
    rays = control + [control[0]]
    return [[r * x, r * y, h] for h in (0.0, 1.0) for x, y in rays for r in (1.0, 2.0)]


DIAMOND = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]


def turn(moves, weights=None):
    """A full turn about z with a seam at y = 0, x from 1 to 2. weights: of each control point, or None."""
    shape = {"size": (2, 5, 2), "degree": [1, 1, 1], "rest": {"points": ring(DIAMOND)}, "moves": moves}
    return lattice(**shape, **({"weights": weights} if weights else {}))


def lift(by, *, radius="all"):
    """Of the last face alone."""
    return [{"at": [radius, 4, "all"], "by": by}]


def polygons(points, *faces):
    return obj_of(points) + "".join(
        "f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)


def band(angles, radius=1.75):
    """Squares round the diamond of this radius, of height 1/2: angles in quarters."""
    points = []
    for z in (0.25, 0.75):
        for angle in angles:
            corner, part = int(angle) % 4, angle % 1
            (x0, y0), (x1, y1) = DIAMOND[corner], DIAMOND[(corner + 1) % 4]
            points.append([radius * (x0 + part * (x1 - x0)), radius * (y0 + part * (y1 - y0)), z])
    n = len(angles)
    return polygons(points, *[[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)])


def seam_tear(run, edges, largest, *options, tolerance=1e-9):
    found = entry(run, "check", "a.obj", "-l", "l.json", *options)
    equal(found["tear"]["edges"], edges, "torn edges")
    near([found["tear"]["largest"]], [largest], tolerance, "the largest step")
    return found


@case
def edges_that_cross_the_seam(run):
    """Of a band round the axis two edges lead across, whether a vertex is on the seam or not; those at the other side of
    the axis do not. The step is how far the faces part where the edge passes them, at y = 0."""
    for angles in ([0.125 + n / 4 for n in range(16)], [n / 4 for n in range(16)], [0.25, 1.5, 2.5, 3.75]):
        x = 1.75 * (1 - angles[0])
        run.write("a.obj", band(angles))
        run.write("l.json", turn(lift([0, 0, 2], radius=1)))
        seam_tear(run, 2, 2 * (x - 1), tolerance=1e-5)
        run.write("l.json", turn(lift([0, 0, 2])))
        seam_tear(run, 2, 2)
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=anything)
        one_line(done, "seam", r"\b2\b")
        run.write("l.json", turn([{"by": [0, 0, 2]}]))
        seam_tear(run, 0, 0)


@case
def edges_from_one_end_that_cross_the_seam_at_other_places(run):
    """At x = 1.05 and at 1.4."""
    run.write("a.obj", polygons([[0.9, 0.2, 0.5], [1.6, 0.2, 0.5], [1.2, -0.2, 0.5]], [0, 1, 2]))
    run.write("l.json", turn(lift([0, 0, 2], radius=1)))
    seam_tear(run, 2, 0.8, tolerance=1e-5)


@case
def edges_along_the_seam(run):
    """Both ends are on it: both go with the first face. Those from there into the last quarter are torn, those into the
    first are not."""
    run.write("a.obj", polygons([[1.25, 0, 0.5], [1.75, 0, 0.5], [1.0, 0.5, 0.5], [1.0, -0.5, 0.5]], [0, 1, 2], [1, 0, 3]))
    run.write("l.json", turn(lift([0, 0, 2])))
    seam_tear(run, 2, 2)


@case
def ends_that_the_rounding_puts_on_either_side_of_the_seam(run):
    """An edge along the seam, one end of which is a bit beyond it: it goes with the last face."""
    run.write("a.obj", polygons([[1.25, 0, 0.5], [1.75, -1e-10, 0.5], [1.0, 0.5, 0.5]], [0, 1, 2]))
    run.write("l.json", turn(lift([0, 0, 2])))
    seam_tear(run, 2, 2)


@case
def vertices_outside_that_follow_the_border(run):
    """With extend those beyond the outer radius are torn as the border is, and with a falloff by what is left there. The
    corner 2 0 is nearest to all that is ahead of it, and goes with the first face: the larger step is where the edge at
    x = 2.25 leaves that, at y = -0.25."""
    run.write("a.obj", polygons([[2.25, 0.75, 0.5], [2.25, -0.75, 0.5], [2.5, 0.75, 0.5]], [0, 1, 2]))
    run.write("l.json", turn(lift([0, 0, 2])))
    seam_tear(run, 2, 2, "--outside", "extend")
    part = math.hypot(0.25, 0.25) / 1.5
    fade = 1 - part ** 3 * (10 - 15 * part + 6 * part * part)
    seam_tear(run, 2, 2 * fade, "--outside", "extend", "--falloff", "1.5", tolerance=1e-5)


@case
def two_seams_of_one_lattice(run):
    """A torus that is closed in neither direction: a square round the place where both seams meet. Two of its edges pass
    the one, two the other."""
    points = [[(3 + r * c) * x, (3 + r * c) * y, r * s] for r in (0.25, 0.5) for x, y in DIAMOND + DIAMOND[:1]
              for c, s in DIAMOND + DIAMOND[:1]]
    run.write("a.obj", polygons([[3.125, y, z] for y, z in ((-0.125, -0.125), (0.125, -0.125), (0.125, 0.125), (-0.125, 0.125))],
                                [0, 1, 2, 3]))
    first, second = {"at": [4, "all", "all"], "by": [0, 0, 1]}, {"at": ["all", 4, "all"], "by": [0, 0.5, 0]}
    for moves, edges, largest in (([first], 2, 1), ([second], 2, 0.5), ([first, second], 4, 1)):
        run.write("l.json", lattice(size=(5, 5, 2), degree=[1, 1, 1], rest={"points": points}, moves=moves))
        counts(seam_tear(run, edges, largest), inside=4)


@case
def a_seam_of_a_block(run):
    """The band is in the first or in the second of two blocks."""
    run.write("a.obj", band([0.125 + n / 4 for n in range(16)]))
    run.write("l.json", turn(lift([0, 0, 2])))
    run.write("m.json", lattice(low=(5, 5, 5), high=(6, 6, 6), moves=[{"by": [0, 0, 1]}]))
    for order in (("l.json", "m.json"), ("m.json", "l.json")):
        found = entry(run, "check", "a.obj", "-l", order[0], "-l", order[1], "--blocks")["tear"]
        equal(found["edges"], 2)
        near([found["largest"]], [2], 1e-9)


@case
def a_seam_behind_another_lattice(run):
    """The first lifts the band into the full turn."""
    run.write("a.obj", band([0.125 + n / 4 for n in range(16)]).replace(" 0.25\n", " -9.75\n").replace(" 0.75\n", " -9.25\n"))
    run.write("l.json", lattice(low=(-5, -5, -11), high=(5, 5, -9), moves=[{"by": [0, 0, 10]}]))
    run.write("m.json", turn(lift([0, 0, 2])))
    found = entry(run, "check", "a.obj", "-l", "l.json", "-l", "m.json")["tear"]
    equal(found["edges"], 2)
    near([found["largest"]], [2], 1e-9)


@case
def faces_whose_weights_differ_are_one(run):
    """Weights that vary along all directions: on the two faces a point has other u and w. It is one root, the least
    u,v,w, whatever the moves; edges across are torn by how far the faces part there."""
    weights = [1 + (7 * i + 4 * j + 5 * k) % 6 for k in range(2) for j in range(5) for i in range(2)]
    points = [[1 + n / 8, 0.0, 1 / 3] for n in range(1, 8)]
    run.write("a.obj", polygons(points + [[1.0, 0.5, 0.5], [1.0, -0.5, 0.5]], *[[n, n + 1, 7] for n in range(6)],
                                *[[n + 1, n, 8] for n in range(6)]))

    def at(face, x, z):
        """u, w on a face: degree 1, so that h0 (1 - u) : h1 u is as the parts of the distance, bilinear in u and w."""
        h = [[weights[i + 2 * face + 10 * k] for i in range(2)] for k in range(2)]
        u, w = 0.5, 0.5
        for _ in range(200):
            # For the other one fixed, each is where the two weights' lever balances.
            near_end, far_end = ((1 - w) * h[0][i] + w * h[1][i] for i in range(2))
            u = (x - 1) * near_end / ((x - 1) * near_end + (2 - x) * far_end)
            low, high = ((1 - u) * h[k][0] + u * h[k][1] for k in range(2))
            w = z * low / (z * low + (1 - z) * high)
        return u, w

    run.write("l.json", turn([{"by": [0, 0, 1]}], weights))
    found = seam_tear(run, 0, 0)
    counts(found, vertices=9, inside=9, multiple=0)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "u.npy", "--status", "s.npy")
    equal(npy(run.read("s.npy"))[2], [0] * 9)
    faces = []
    for found, (x, _, z) in zip(npy(run.read("u.npy"))[2], points):
        (u, w), (u_last, w_last) = at(0, x, z), at(4, x, z)
        faces.append(u > u_last)
        near(found, [u_last, 1, w_last] if u > u_last else [u, 0, w], 1e-9)
    equal(set(faces), {False, True}, "some go with the first face, some with the last")
    # Torn: those along the seam from one to the other, and those to the side whose face a vertex does not go with.
    edges = sum(a != b for a, b in zip(faces, faces[1:])) + len(faces)
    run.write("l.json", turn(lift([0, 0, 2]), weights))
    counts(seam_tear(run, edges, 2), inside=9, multiple=0)


@case
def the_two_faces_of_an_unclosed_seam_are_one(run):
    """A full turn, clamped: its first and last faces coincide. What lies there has one u,v,w, the least; where the moved
    faces part, edges across are torn."""
    for weights in (None, [1.0, 2.0, 3.0, 2.0, 4.0]):  # of each ray
        unclosed_seam(run, weights)


def unclosed_seam(run, weights):
    shape = {"size": (2, 5, 2), "degree": [1, 1, 1], "rest": {"points": ring(DIAMOND)}}
    if weights:
        shape["weights"] = [h for _ in range(2) for h in weights for _ in range(2)]
    # Around the seam at y = 0: x = 1.5 on it, one neighbour on each side.
    run.write("a.obj", "v 1.5 0 0.5\nv 1 0.5 0.5\nv 1 -0.5 0.5\nf 1 2 3\n")
    run.write("l.json", lattice(moves=[{"by": [0, 0, 1]}], **shape))
    found = entry(run, "check", "a.obj", "-l", "l.json")
    counts(found, inside=3, multiple=0)
    equal(found["tear"]["edges"], 0)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "u.npy", "--status", "s.npy", "--force")
    equal(npy(run.read("s.npy"))[2], [0, 0, 0])
    near(npy(run.read("u.npy"))[2][0], [0.5, 0, 0.5], 1e-12)
    # The last face goes its own way: u,v,w stay what they are, and the edge to the neighbour at its side is torn.
    run.write("l.json", lattice(moves=[{"at": ["all", 4, "all"], "by": [0, 0, 1]}], **shape))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "v.npy", "--force")
    equal(run.read("v.npy"), run.read("u.npy"), "an embedding depends on the rest lattice alone")
    found = entry(run, "deform", "a.obj", "b.obj", "-l", "l.json")
    counts(found, inside=3, multiple=0)
    equal(found["tear"]["edges"], 2)
    near([found["tear"]["largest"]], [1], 1e-12)
    equal(obj_vertices(run.text("b.obj"))[0], [1.5, 0, 0.5])


main()
