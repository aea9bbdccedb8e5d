#!/usr/bin/env python3
"""ffd view --morph NAME=LATTICE, and the sliders of pages: what is shown, what is refused, what a page leaves out. Where
vertices are when sliders move is in tests/view/test_morph.py."""

import json

from gltf_arm import face
from gltf_build import Scene
from harness import CUBE, NO, USAGE, case, check, equal, glb, lattice, main, near
from page import read_page

TWIST = [{"twist": {"axis": "z", "degrees": 50}}]
LIFT = [{"by": [0, 0, 0.5]}]
GROW = [{"scale": {"factor": [2, 1, 1], "about": [0, 0, 0]}}]
AFAR = {"box": {"min": [50, 50, 50], "max": [60, 60, 60]}}


def start(run):
    run.write("a.obj", CUBE)
    run.write("twist.json", lattice(moves=TWIST))
    run.write("lift.json", lattice(moves=LIFT))
    run.write("grow.json", lattice(moves=GROW))


def view(run, *arguments, **options):
    run.ffd("view", *arguments, "-o", "p.html", "--force", **options)
    return read_page(run, "p.html")


def sliders(page):
    return [(slider["name"], slider["weight"]) for slider in page.scene["sliders"]]


def added(page, lattices):
    """The places before and the displacements of the lattices by themselves."""
    return [[x + sum(one[v][a] - page.before[v][a] for one in lattices) for a, x in enumerate(p)] for v, p in enumerate(page.before)]


@case
def a_target_is_shown_in_full(run):
    """One target: as -l shows its lattice, in pages and pictures of any format. Several add up."""
    start(run)
    alone = view(run, "a.obj", "-l", "twist.json")
    equal([sliders(alone), alone.scene["sameTargets"]], [[], False], "a mesh without targets")
    page = view(run, "a.obj", "--morph", "turn=twist.json")
    equal([page.before, page.after, page.statuses, page.dets], [alone.before, alone.after, alone.statuses, alone.dets], "one target")
    equal(sliders(page), [("turn", 1)], "its slider")
    equal([cage["name"] for cage in page.scene["cages"]], ["twist.json"], "its lattice")
    run.ffd("view", "a.obj", "--morph", "turn=twist.json", "-o", "m.png", "--size", "200x120")
    run.ffd("view", "a.obj", "-l", "twist.json", "-o", "l.png", "--size", "200x120")
    check(run.read("m.png") == run.read("l.png"), "the picture of a target is that of its lattice")
    lifted = view(run, "a.obj", "-l", "lift.json")
    both = view(run, "a.obj", "--morph", "turn=twist.json", "--morph", "up=lift.json")
    near(both.after, added(both, [alone.after, lifted.after]), 4e-4, "two targets")
    equal(sliders(both), [("turn", 1), ("up", 1)], "two sliders")
    wide = view(run, "a.obj", "--morph", "wide=grow.json", "--morph", "wider=grow.json")
    near(wide.dets, [3] * 8, 1e-6, "det F of both: 1 + 1 + 1")


@case
def figures_are_those_of_deform(run):
    """The report has the worst of the targets, as that of deform; statuses those of several lattices."""
    start(run)
    run.write("far.json", {**lattice(moves=LIFT), "rest": AFAR})
    words = ["--morph", "turn=twist.json", "--morph", "none=far.json"]
    page = view(run, "a.obj", *words, "--report", "v.json", "--report-stable", lines=1)
    run.ffd("deform", "a.obj", "b.glb", *words, "--report", "d.json", "--report-stable", lines=3)
    ours, theirs = (json.loads(run.text(name))["jobs"][0] for name in ("v.json", "d.json"))
    equal([ours[key] for key in ("vertices", "outside", "moved", "displacement")],
          [theirs[key] for key in ("vertices", "outside", "moved", "displacement")], "figures")
    equal(page.statuses, [0] * 8, "inside of one of them")
    equal(sliders(page), [("turn", 1)], "a target that moves nothing has no slider")


@case
def a_refused_target_is_drawn(run):
    """Also the targets after it."""
    start(run)
    run.write("far.json", {**lattice(moves=LIFT), "rest": AFAR})
    page = view(run, "a.obj", "--morph", "a=far.json", "--morph", "b=lift.json", "--fail-on", "outside", code=NO, lines=1)
    near(page.after, [[x, y, z + 0.5] for x, y, z in page.before], 4e-4, "the second target")


@case
def what_does_not_go_together_is_refused(run):
    start(run)
    for words, says in ((["--morph", "a=twist.json", "-l", "lift.json"], "-l cannot be used with --morph"),
                        (["b.obj", "--morph", "a=twist.json"], "--morph makes targets of IN"),
                        (["--morph", "a=twist.json", "--as-morph", "b"], "--as-morph"),
                        (["--morph", "a=twist.json", "--blocks"], "--blocks"),
                        (["--morph", "a=twist.json", "--rig", "follow"], "--rig follow"),
                        (["--morph", "=twist.json"], "is not NAME=LATTICE")):
        run.ffd("view", "a.obj", *words, "-o", "p.html", code=USAGE, lines=1, err=lambda said, says=says: check(says in said[0], said))
    run.ffd("check", "a.obj", "--morph", "a=twist.json", code=USAGE, lines=1)


@case
def targets_of_a_name_and_weight_have_one_slider(run):
    """A mesh that two nodes show, and one without names."""
    asset = face(("up", "wide"), [[0.25, 0], [0]])
    asset["nodes"].append({"mesh": 1})
    del asset["meshes"][1]["extras"]
    asset["scenes"][0]["nodes"].append(len(asset["nodes"]) - 1)
    run.write("a.gltf", asset)
    page = view(run, "a.gltf")
    equal(sliders(page), [("up", 0.25), ("wide", 0), ("target 0", 0)], "sliders")
    equal([[slider, count] for slider, count, *_ in page.scene["targets"][0]], [[0, 5], [1, 8], [2, 1], [2, 1]], "targets, with what they move")
    equal(page.scene["sameTargets"], True, "the shape before is that after")
    (vertex,) = {row[0] for row in page.rows("data-target-vertex", "I", 1)[13:14]}
    step, offset = page.scene["targets"][0][2][2], page.rows("data-target-offset", "h", 3)[13]
    near([step * x for x in offset], [-0.96 * 2, 0.28 * 2, 0.5], 1e-4, f"of vertex {vertex}, turned and scaled by its node")


@case
def a_page_leaves_sliders_out_above_a_limit(run):
    """A million offsets; --full has all. The targets share one accessor."""
    count, targets = 25000, 41
    scene = Scene(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}])
    places = scene.add([[float(i % 50), float(i // 50), 0.0] for i in range(count)], bounds=True)
    up = [scene.add([[0.0, 0.0, float(t + 1)]] * count, bounds=True) for t in range(2)]
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": places}, "mode": 0,
                                              "targets": [{"POSITION": up[t % 2]} for t in range(targets)]}],
                              "extras": {"targetNames": [f"t{t}" for t in range(targets)]}}]
    run.write("a.glb", scene.glb())
    said = "1 of 41 morph targets have no slider: more than 1000000 offsets (see {})"
    page = view(run, "a.glb", err="a.glb: the page: " + said.format("--full"))
    equal([len(page.scene["sliders"]), page.scene["notices"]], [40, [said.format("--full")]], "sliders and the notice")
    equal(len(view(run, "a.glb", "--full", lines=0).scene["sliders"]), 41, "with --full")


main()
