#!/usr/bin/env python3
"""The gates of --fail-on with a value, and those for what is torn, flipped, invalid, or folds outside of the lattice."""
from harness import CUBE, NO, OK, USAGE, case, check, equal, lattice, main
from messages import anything

CORNERS = "".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1))
FACES = CUBE[CUBE.index("f "):]


def judged(run, gates, code, *options):
    """check and deform with gates: the exit code of both, and nothing written where one is violated."""
    for command in (["check", "a.obj"], ["deform", "a.obj", "b.obj"]):
        run.remove("b.obj")
        run.ffd(*command, "-l", "l.json", "--fail-on", gates, *options, code=code, err=anything)
        equal(run.exists("b.obj"), command[0] == "deform" and code == OK, f"{command[0]} {gates}: an output")


def quadratic(dx, dz):
    """The box [0,1]^3, of degree 2 along x, whose middle control points move: x' = u + 2u(1-u) dx, z' = z + 2u(1-u) dz."""
    return lattice(size=(3, 2, 2), low=(0, 0, 0), high=(1, 1, 1), degree=[2, 1, 1],
                   moves=[{"at": [1, "all", "all"], "by": [dx, 0, dz]}])


@case
def a_torn_edge_violates_the_gate_tear(run):
    """A square whose far side stays, one step of 1/4."""
    run.write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n")
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 2, 1), moves=[{"by": [0, 0, 0.25]}]))
    for gate, code in (("tear", NO), ("tear=0", NO), ("tear=0.249", NO), ("tear=0.25", OK), ("tear=1e3", OK),
                       ("tear,tear=1e3", NO), ("tear=1e3,tear", NO), ("tear=0.249,tear=1e3", NO)):
        judged(run, gate, code)
    judged(run, "tear", OK, "--outside", "extend")


@case
def a_flipped_face_violates_the_gate_flipped(run):
    """x' = 3u - 2u^2 turns round at 3/4: the cube's face at u = 1 shows its other side."""
    run.write("a.obj", CORNERS + FACES)
    run.write("l.json", quadratic(1, 0))
    for gate, code in (("flipped", NO), ("flipped=0", NO), ("flipped=1", OK), ("flipped=6", OK)):
        judged(run, gate, code)
    run.write("l.json", quadratic(0.1, 0))
    judged(run, "flipped", OK)


@case
def edges_far_from_the_true_surface_violate_the_gate_edges(run):
    """Edges along x bend to parabolas of height 1/8."""
    run.write("a.obj", CORNERS + FACES)
    run.write("l.json", quadratic(0, 0.25))
    for gate, code in (("edges=0.124", NO), ("edges=0", NO), ("edges=0.126", OK), ("edges=0.124,edges=1", NO)):
        judged(run, gate, code)


@case
def a_vertex_that_is_no_number_violates_the_gate_invalid(run):
    run.write("a.obj", CUBE + "v nan 0 0\nf 1 2 9\n")
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    judged(run, "outside", OK)
    judged(run, "invalid", NO)
    run.write("a.obj", CUBE)
    judged(run, "invalid", OK)


@case
def folds_outside_of_the_lattice(run):
    """The volume turns by 180 degrees about z. Beyond a side face only y is turned: det F is -1 there."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1),
                                moves=[{"rotate": {"axis": "z", "degrees": 180, "about": [0, 0, 0]}}]))
    run.write("a.obj", "v 0 0 0\nv 0.5 0 0\nv 3 0 0\nv 3 0.5 0\nf 1 2 3\nf 2 3 4\n")
    judged(run, "folds", OK)
    judged(run, "folds", NO, "--outside", "extend")
    # Beyond an edge of the box, where x and y are clipped, nothing turns.
    run.write("a.obj", "v 0 0 0\nv 0.5 0 0\nv 3 3 0\nf 1 2 3\n")
    judged(run, "folds", OK, "--outside", "extend")


@case
def one_violated_gate_among_others_is_enough(run):
    """A violated one among others that are kept."""
    run.write("a.obj", CORNERS + FACES)
    run.write("l.json", quadratic(0, 0.25))
    judged(run, "tear,flipped=2,edges=0.2,invalid,folds", OK)
    judged(run, "tear,flipped=2,edges=0.1,invalid,folds", NO)


@case
def values_that_make_no_sense(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice())
    for gate in ("tear=", "tear=x", "tear=-1", "tear=nan", "flipped=1.5", "flipped=-1", "flipped=", "edges", "edges=", "edges=-1",
                 "folds=1", "invalid=2", "outside=3"):
        done = run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--fail-on", gate, code=USAGE)
        check(gate.partition("=")[0] in done.err[0], gate, done.err)


main()
