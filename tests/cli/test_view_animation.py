#!/usr/bin/env python3
"""ffd view --animation: poses in pictures and animations on pages, before and after a deformation; and what is said of
animations that are not there, or broken."""
import json
import re

from gltf_arm import TURN, arm
from harness import CUBE, INVALID, USAGE, case, check, equal, lattice, main, near
from page import read_page
from png import read_png

SHIFT = [{"by": [0, 0, 1]}]
HOSTILE = "</script><img src=x onerror=alert(1)>\n\x1b[31m"


def start(run, moves=SHIFT, **options):
    run.write("a.gltf", json.dumps(arm(**options)))
    run.write("l.json", lattice(moves=moves))
    return ["a.gltf", "-l", "l.json"]


def picture(run, *arguments, **options):
    run.ffd("view", *arguments, "-o", "p.png", "--force", **options)
    return read_png(run.read("p.png"))


def is_mesh(r, g, b):
    """Neither the background nor the line of the ground, which are bluer."""
    return max(r, g, b) < 200 and b - r < 12


def extent(rows):
    """Columns and rows that the mesh covers in a panel: what is much darker than the background."""
    seen = [(x, y) for y, row in enumerate(rows) for x, pixel in enumerate(row) if is_mesh(*pixel)]
    check(seen, "nothing is drawn")
    return [max(p[a] for p in seen) - min(p[a] for p in seen) for a in range(2)]


def last(line):
    """The last line of what is said."""
    return lambda said: equal(said[-1], line, said)


def panels(rows, columns, lines, margin=30):
    """The panels of a picture, without their captions and borders."""
    width, height = len(rows[0]) // columns, len(rows) // lines
    return [[[row[c * width + 3:(c + 1) * width - 3] for row in rows[r * height + margin:(r + 1) * height - 3]]
             for c in range(columns)] for r in range(lines)]


@case
def poses_are_drawn_before_and_after(run):
    """A lattice that makes the arm twice as wide: the upper half is in all poses as long as ever."""
    work = start(run, [{"scale": {"factor": [1, 2, 1], "about": [0, 0, 0]}}])
    rows = picture(run, *work, "--animation", "turn", "--frames", "3", "--size", "200x260", "--camera", "front", "--color",
                   "plain", err=re.compile(r"stretched unevenly \(2 to 1\)"))
    equal([len(rows[0]), len(rows)], [600, 520], "three poses, twice")
    before, after = panels(rows, 3, 2)
    first, middle, last = [extent(panel) for panel in before]
    unit = first[0] / 2  # pixels of a length of 1
    near([first[1] / unit], [0.2], 0.06, "a flat arm")
    near([last[0] / unit, last[1] / unit], [1.1, 1.1], 0.06, "the lower half turned")
    near([middle[0] / unit], [1 + 0.5 ** 0.5 + 0.1 * 0.5 ** 0.5], 0.06, "half way")
    near([extent(after[0])[1] / unit], [0.4], 0.06, "wider after")
    near([extent(after[2])[0] / unit], [1.2], 0.06, "the lower half, turned, is as wide")


@case
def a_file_alone_has_one_row_of_five_poses(run):
    start(run)
    rows = picture(run, "a.gltf", "--animation", "lift", "--size", "100x120", "--camera", "front")
    equal([len(rows[0]), len(rows)], [500, 120], "five in a row")
    again = picture(run, "a.gltf", "--animation", "lift", "--size", "100x120", "--camera", "front", "--frames", "5", "--threads", "3")
    check(rows == again, "the number that is meant, by any threads")
    short = [extent(panel) for panel in panels(rows, 5, 1, 16)[0]]
    check(max(x for x, _ in short) - min(x for x, _ in short) <= 1, "lifting changes no size in a parallel projection", short)


@case
def without_an_animation_frames_mean_what_they_did(run):
    work = start(run)
    rows = picture(run, *work, "--frames", "3", "--size", "100x80", lines=1)
    equal([len(rows[0]), len(rows)], [300, 80], "from rest to deformed")


@case
def names_that_are_not_there_are_refused(run):
    work = start(run, names=("turn", HOSTILE))
    run.ffd("view", *work, "-o", "p.png", "--animation", "trun", code=USAGE, err=last(
        'a.gltf: --animation: none is called "trun" (nearest: "turn"; there are "turn", "</script><img src=x onerror=alert(1")'))
    check(not run.exists("p.png"), "a picture")
    run.ffd("view", *work, "-o", "p.html", "--animation", "x" * 5000 + "\n", code=USAGE,
            err=lambda said: check("none is called" in said[-1] and len(said[-1]) < 500, said))
    start(run, names=(None, "lift"))
    run.ffd("view", "a.gltf", "-o", "p.png", "--animation", "animation 1", code=USAGE, err=re.compile('nearest: "animation 0"'))
    run.ffd("view", "a.gltf", "-o", "p.png", "--animation", "animation 0", "--size", "60x60")
    run.write("a.obj", CUBE)
    run.ffd("view", "a.obj", "-o", "q.png", "--animation", "walk", code=USAGE, err=re.compile("there are no animations"))
    run.ffd("view", "a.gltf", "-o", "q.png", "--animation", "lift", "--space", "mesh", code=USAGE, err=re.compile("no animations"))
    run.ffd("view", "a.gltf", "-o", "q.png", "--animation", "lift", "--frames", "64", code=USAGE, err=re.compile("102400 x 900"))
    check(not run.exists("q.png"), "a picture")


@case
def of_two_of_one_name_the_first_is_shown(run):
    start(run, names=("turn", "turn"))
    page = read(run, "a.gltf", "--animation", "turn", err="a.gltf: --animation: 2 have this name, and the first is shown")
    equal(page.scene["rig"]["start"], 0, "the first")


def read(run, *arguments, **options):
    run.ffd("view", *arguments, "-o", "p.html", "--force", **options)
    return read_page(run, "p.html")


@case
def a_broken_animation_stops_only_who_wants_it(run):
    work = start(run, times=(2, 0))
    fault = "/animations/0/samplers/0/input: time 1 of accessor"
    run.ffd("view", "a.gltf", "-o", "p.png", "--animation", "turn", code=INVALID, err=re.compile(fault))
    run.ffd("deform", *work[:1], "b.gltf", *work[1:], lines=1)
    page = read(run, *work, err=lambda said: check(len(said) == 3 and f'the animation "turn" is left out: {fault}' in said[1], said))
    equal([a["name"] for a in page.scene["rig"]["animations"]], [], "both have these times")
    start(run, interpolation="BEZIER")
    run.ffd("view", "a.gltf", "-o", "p.png", "--animation", "turn", code=INVALID, err=re.compile("an interpolation is"))


@case
def pages_have_keys_and_what_vertices_follow(run):
    work = start(run, names=("turn", HOSTILE))
    page = read(run, *work, "--animation", "turn", lines=1)
    rig = page.scene["rig"]
    equal([a["name"] for a in rig["animations"]], ["turn", "</script><img src=x onerror=alert(1)>\\n\\u{1b}[31m"], "names")
    equal([rig["start"], rig["isShared"], rig["hasAfter"]], [0, True, True], "sides")
    equal(page.rows("data-rig-before-parent", "i", 2), [[-1, 1], [0, 1]], "two joints, one below the other")
    equal(page.column("data-rig-before-time", "f"), [0, 2], "times, once")
    near([page.column("data-rig-before-value", "f")], [[x for q in TURN for x in q] + [0, 0, 0, 0, 0, 3]], 1e-7, "values")
    equal(page.rows("data-rig-before-follow", "H", 8), [[0, 0, 0, 0, 65535, 0, 0, 0]] * 4 + [[1, 0, 0, 0, 65535, 0, 0, 0]] * 4, "bones")
    anchors = [page.rows(f"data-rig-{side}-anchor", "f", 3) for side in ("before", "after")]
    near(anchors[1], [[x, y, z + 1] for x, y, z in anchors[0]], 1e-6, "the anchors go with the lattice")
    plain = read(run, *work, lines=1)
    check("start" not in plain.scene["rig"], "no animation is chosen")
    run.write("a.obj", CUBE)
    check("rig" not in read(run, "a.obj").scene, "a mesh without a rig")


@case
def a_deformed_file_moves_as_it_says(run):
    """The output of a deformation has the animations of its input; another file may lack one."""
    work = start(run)
    run.ffd("deform", "a.gltf", "b.gltf", "-l", "l.json", lines=1)
    both = [*work[:1], "b.gltf", "--animation", "turn"]
    rows = picture(run, *both, "--size", "60x60", "--frames", "2", "--camera", "front", "--color", "plain")
    same = picture(run, *work, "--animation", "turn", "--size", "60x60", "--frames", "2", "--camera", "front", "--color", "plain", lines=1)
    check(rows == same, "files and the deformation in memory")
    page = read(run, *both)
    equal([page.scene["rig"]["isShared"], [a["channels"] for a in page.scene["rig"]["animations"]]],
          [False, [[[0, 1], [0, 1]], [[1, 1], [1, 1]]]], "a rig of its own")
    other = arm(names=("other", "lift"))
    run.write("b.gltf", json.dumps(other))
    page = read(run, *both, err="a.gltf: b.gltf lacks 1 of the animations: it stands still there")
    equal(page.scene["rig"]["animations"][0]["channels"][1], None, "no channels after")


@case
def a_rig_that_follows_moves_the_mesh_after(run):
    """As the file does that is written: a lattice that turns the arm by 40 degrees and makes it longer."""
    moves = [{"rotate": {"axis": "z", "degrees": 40, "about": [0, 0, 0]}}, {"scale": {"factor": [1.2] * 3, "about": [0, 0, 0]}}]
    work = start(run, moves)
    run.ffd("deform", "a.gltf", "b.gltf", "-l", "l.json", "--rig", "follow")
    shown = ["--animation", "turn", "--size", "160x160", "--frames", "3", "--camera", "front", "--color", "plain"]
    followed = picture(run, *work, *shown, "--rig", "follow")
    check(followed == picture(run, "a.gltf", "b.gltf", *shown), "the file and the deformation in memory")
    check(followed != picture(run, *work, *shown, err=lambda said: None), "a rig that stays")
    page = read(run, *work, "--rig", "follow")
    equal([page.scene["rig"]["isShared"], page.scene["rig"]["hasAfter"]], [False, True], "a rig of its own")
    other = read(run, "a.gltf", "b.gltf")
    for name, code, width in (("value", "f", 1), ("bind", "f", 12), ("node", "f", 12), ("anchor", "f", 3)):
        block = f"data-rig-after-{name}"
        near(page.rows(block, code, width), other.rows(block, code, width), 1e-6, block)


main()
