#!/usr/bin/env python3
"""--fail-on of deform and check: each gate both ways; what a violated one leaves, and says."""
import json
import re

from harness import (CUBE, CUBE_CORNERS, EMBEDDING, IO, NO, OK, case, check, equal, glb, gltf_json, lattice, main,
                     obj_of)

SHIFT = [{"by": [1, 0, 0]}]
MIRROR = [{"scale": {"factor": [-1, 1, 1], "about": [0, 0, 0]}}]
GATES = ("folds", "outside", "multiple", "singular")


def along_x(xs, degree, deformed=None, **members):
    """A lattice whose control points are at xs along x, and at 0 and 1 along y and z."""
    def points(row):
        return [[x, y, z] for z in (0, 1) for y in (0, 1) for x in row]

    content = {"format": "ffd-lattice", "version": 1, "size": [len(xs), 2, 2], "degree": [degree, 1, 1],
               "rest": {"points": points(xs)}, **members}
    if deformed:
        content["deformed"] = {"points": points(deformed)}
    return content


def vertices(*points):
    return obj_of(points)


# For each gate a mesh, a lattice that violates it and no other, and what is said.
# A volume along x that turns round at x = 2 (an edge, on which nothing is singular), and one that turns round at
# x = 2/3 smoothly: there J has no inverse.
EDGE, SMOOTH = along_x([0, 2, 1], 1, moves=SHIFT), along_x([0, 1, 0.5], 2, moves=SHIFT)
# x(u) = u^3 - u^2 + u/3 has the derivative (3u-1)^2/3, whose only zero is not a binary fraction: no fold, and no proof.
TOUCHING = along_x([0, 1 / 3, 2 / 3, 1], 3, deformed=[0, 1 / 9, -1 / 9, 1 / 3])
VIOLATIONS = {
    "folds": (CUBE, lattice(moves=MIRROR),
              r"the deformed volume folds in 1 of 1 cell, as at u,v,w = \S+ \S+ \S+ of bad.json, x,y,z = \S+ \S+ \S+"),
    "outside": (CUBE, lattice(high=(2, 2, 0), moves=SHIFT), "4 of 8 vertices are outside the lattice"),
    "multiple": (vertices([0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [1.25, 0.5, 0.25]), EDGE, "2 of 3 vertices have several u,v,w"),
    "singular": (vertices([0.25, 0.5, 0.5], [2 / 3, 0.5, 0.5], [0.3, 0.5, 0.25]), SMOOTH,
                 "1 of 3 vertices is where the lattice has no inverse"),
}
CLEAN = lattice(moves=SHIFT)


def start(run, mesh=CUBE, bad=None):
    run.write("a.obj", mesh)
    run.write("good.json", CLEAN)
    run.write("bad.json", bad or lattice())


def commands(mesh="a.obj"):
    return ["deform", mesh, "b.obj"], ["check", mesh]


def refused(run, command, *options, says, **expected):
    before = {name: run.read(name) for name in run.names()}
    done = run.ffd(*command, "-l", "bad.json", "--fail-on", *options, code=NO, lines=1, **expected)
    check(re.fullmatch("a.obj: " + says, done.err[0]), f"{done.err[0]!r} does not match {says!r}")
    equal({name: run.read(name) for name in run.names()}, before, f"{command} {options}: the folder")
    return done


@case
def each_gate_finds_its_own_violation(run):
    for gate, (mesh, bad, says) in VIOLATIONS.items():
        start(run, mesh, bad)
        for command in commands():
            refused(run, command, gate, says=rf"{says} \(--fail-on {gate}\)")


def warnings(command, violated):
    """Lines about statuses; and deform speaks of what it tears, turns inside out and turns over."""
    return int(violated != "folds") + {"outside": 1, "folds": 2}.get(violated, 0) * int(command[0] == "deform")


@case
def each_gate_asks_for_its_own_figure_only(run):
    """A gate asks for its own figure only: those that others would object to pass."""
    for gate in GATES:
        for other, (mesh, bad, _) in VIOLATIONS.items():
            # A rest volume that turns round is turned round when it is deformed, too.
            if gate == other or (gate == "folds" and other in ("multiple", "singular")):
                continue
            start(run, mesh, bad)
            for command in commands():
                run.ffd(*command, "-l", "bad.json", "--fail-on", gate, "--quiet", "--force")
                run.ffd(*command, "-l", "bad.json", "--fail-on", gate, "--force",
                        lines=warnings(command, other))
            check(run.exists("b.obj"), gate)


@case
def all_gates_let_a_good_mesh_pass(run):
    start(run)
    run.ffd("deform", "a.obj", "plain.obj", "-l", "good.json")
    run.ffd("deform", "a.obj", "b.obj", "-l", "good.json", "--fail-on", ",".join(GATES))
    equal(run.read("b.obj"), run.read("plain.obj"))
    run.ffd("check", "a.obj", "-l", "good.json", *(f"--fail-on={gate}" for gate in GATES), "--fail-on", "folds,folds")


@case
def without_gates_nothing_is_refused(run):
    for mesh, bad, _ in VIOLATIONS.values():
        start(run, mesh, bad)
        run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--force", "-q")
        run.ffd("check", "a.obj", "-l", "bad.json", "-q", out="")


@case
def several_gates_are_one_line(run):
    mesh = VIOLATIONS["multiple"][0] + vertices([9, 9, 9])
    start(run, mesh, VIOLATIONS["multiple"][1])
    says = (r"the deformed volume folds in 1 of 2 cells, .* \(--fail-on folds\); 1 of 4 vertices is outside the lattice "
            r"\(--fail-on outside\); 2 of 4 vertices have several u,v,w \(--fail-on multiple\)")
    for command in commands():
        refused(run, command, ",".join(GATES), says=says)
        refused(run, command, "multiple", "--fail-on", "outside,folds", says=says)


@case
def a_proof_that_ends_in_unknown(run):
    start(run, vertices([0.25, 0.5, 0.5]), TOUCHING)
    for command in commands():
        refused(run, command, "folds", says=r"the deformed volume is not proven to be free of folds in 1 of 1 cell "
                r"\(least det J \S+\) \(--fail-on folds\)")
    folds = run.ffd("check", "a.obj", "-l", "bad.json", "--report", "-").json["jobs"][0]["folds"]
    equal([folds["verdict"], folds["unknown_cells"], folds["folded_cells"], folds["witness"]], ["unknown", 1, 0, None])
    check(-1e-9 < folds["min_det"] <= 0, folds)
    check("unknown: 1 of 1 cell" in run.ffd("check", "a.obj", "-l", "bad.json").text, "the text")
    done = run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--report", "r.json", lines=1)
    check("not proven" in done.err[0], done.err)


@case
def a_fold_is_told_with_a_report_only(run):
    """The proof costs time: a plain deform does without, and tells of the vertices and faces that it turns."""
    start(run, *VIOLATIONS["folds"][:2])
    run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json",
            err=lambda said: check(len(said) == 2 and said[0] == "a.obj: the mesh turns inside out at 8 of 8 vertices: det F falls to -1, at vertex 0"
                                   and re.fullmatch("a.obj: (6 of 6|12 of 12) faces are turned over", said[1]), said))
    done = run.ffd("deform", "a.obj", "c.obj", "-l", "bad.json", "--report", "r.json", lines=1)
    check(re.match("a.obj: the deformed volume folds in 1 of 1 cell.*; (6 of 6|12 of 12) faces are turned over$", done.err[0]), done.err)
    run.ffd("deform", "a.obj", "d.obj", "-l", "bad.json", "--report", "r.json", "-q")
    equal(run.read("b.obj"), run.read("c.obj"))


@case
def the_report_of_a_violated_gate(run):
    start(run, *VIOLATIONS["outside"][:2])
    for command in commands():
        done = run.ffd(*command, "-l", "bad.json", "--fail-on", "outside,folds", "--report", "r.json", code=NO, lines=1)
        job = json.loads(run.read("r.json"))["jobs"][0]
        equal([job["status"], job["exit"], job["error"]], ["failed", NO, done.err[0]])
        equal([job["vertices"], job["inside"], job["outside"], job["moved"]], [8, 4, 4, 4])
        equal([job["folds"]["verdict"], job["flipped_faces"]], ["none", 0])
        equal(job["output"], "b.obj" if command[0] == "deform" else None)
        equal(run.names(), ["a.obj", "bad.json", "good.json", "r.json"])


@case
def the_report_of_kept_gates(run):
    """With all figures of a deformation; edges are measured by check only."""
    start(run)
    run.ffd("deform", "a.obj", "b.obj", "-l", "good.json", "--fail-on", "folds", "--report", "r.json")
    job = json.loads(run.read("r.json"))["jobs"][0]
    equal([job["folds"]["verdict"], job["flipped_faces"], job["edges"]], ["none", 0, None])


@case
def one_mesh_of_many(run):
    """A violated gate fails its mesh; the others are written, and the whole says no."""
    start(run, CUBE, lattice(high=(2, 2, 2), moves=SHIFT))
    run.write("z.glb", glb(*gltf_json(CUBE_CORNERS)))
    run.folder_of("out")
    says = "wide.obj: 8 of 8 vertices are outside the lattice (--fail-on outside)"
    run.write("wide.obj", vertices(*([3 * x for x in p] for p in CUBE_CORNERS)))
    run.ffd("deform", "a.obj", "wide.obj", "z.glb", "--out-dir", "out", "-l", "bad.json", "--fail-on", "outside",
            "--report", "r.json", code=NO, err=says)
    equal(run.names("out"), ["a.obj", "z.glb"])
    jobs = json.loads(run.read("r.json"))["jobs"]
    equal([(job["status"], job["exit"]) for job in jobs], [("ok", OK), ("failed", NO), ("ok", OK)])
    done = run.ffd("check", "a.obj", "wide.obj", "z.glb", "-l", "bad.json", "--fail-on", "outside", code=NO, err=says)
    equal([line for line in done.text.splitlines() if not line.startswith(" ")], ["a.obj", "wide.obj", "z.glb"])
    before = run.read("wide.obj")
    run.ffd("deform", "a.obj", "wide.obj", "--in-place", "-l", "bad.json", "--fail-on", "outside", code=NO, err=says)
    equal(run.read("wide.obj"), before)


@case
def an_existing_output_stays(run):
    start(run, *VIOLATIONS["outside"][:2])
    run.write("b.obj", "# mine\n")
    refused(run, ["deform", "a.obj", "b.obj", "--force"], "outside", says=".*")
    equal(run.read("b.obj"), b"# mine\n")
    refused(run, ["deform", "a.obj", "--in-place"], "outside", says=".*")


@case
def standard_output_gets_nothing(run):
    start(run, *VIOLATIONS["outside"][:2])
    refused(run, ["deform", "a.obj", "-", "--output-format", "obj"], "outside", says=".*", out="")


@case
def stronger_failures_come_first(run):
    start(run, *VIOLATIONS["outside"][:2])
    for command in commands():
        run.ffd(*command, "-l", "bad.json", "--fail-on", "outside", "--outside", "error", code=EMBEDDING)
        run.ffd(*command, "-l", "missing.json", "--fail-on", "outside", code=IO)
    equal(run.names(), ["a.obj", "bad.json", "good.json"])


@case
def extended_vertices_are_outside(run):
    """They move, but no u,v,w is known of them."""
    start(run, *VIOLATIONS["outside"][:2])
    run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--outside", "extend", lines=1)
    for command in (["deform", "a.obj", "c.obj", "--outside", "extend"], ["check", "a.obj", "--outside", "extend"]):
        refused(run, command, "outside", says=r"4 of 8 vertices are outside the lattice \(--fail-on outside\)")


@case
def any_lattice_of_several(run):
    """A vertex counts for a gate by each lattice, a volume that folds by itself."""
    start(run, vertices([0.5, 0.5, 0.5], [5 / 3, 0.5, 0.5]), EDGE)
    run.write("wide.json", lattice((2, 2, 2), (-5, -5, -5), (5, 5, 5)))
    run.write("smooth.json", along_x([0, 2.5, 1.25], 2))  # turns round at x = 5/3
    for command in commands():
        done = run.ffd(*command, "-l", "wide.json", "-l", "bad.json", "--fail-on", "multiple,folds", code=NO, lines=1)
        check("folds in 1 of 3 cells" in done.err[0] and " of bad.json, " in done.err[0], done.err)
        check("1 of 2 vertices has several u,v,w (--fail-on multiple)" in done.err[0], done.err)
        # The second vertex is singular in one lattice, and has two u,v,w in the other.
        for gate, says in (("multiple", "1 of 2 vertices has several"), ("singular", "1 of 2 vertices is where")):
            done = run.ffd(*command, "-l", "smooth.json", "-l", "bad.json", "--fail-on", gate, code=NO, lines=1)
            check(says in done.err[0], done.err)


main()
