#!/usr/bin/env python3
"""Any object of a lattice file may have a "comment" and a "name"; and what is said of words that other programs use."""
import json

from harness import CUBE, INVALID, case, check, equal, lattice, main
from messages import anything
from schema import Schema

NOTE = {"comment": "made by hand, \u00e9 \"quoted\"", "name": "left cheek"}
LATTICES = {
    "box": lattice(deformed={}, moves=[
        {"at": [3, "all", "all"], "by": [0.1, 0, 0]}, {"scale": {"factor": 0.9}}, {"rotate": {"axis": "z", "degrees": 5}},
        {"twist": {"axis": "z", "degrees": 10}}, {"taper": {"axis": "z", "factor": 0.9}},
        {"bend": {"axis": "z", "toward": [1, 0, 0], "degrees": 10}}, {"within": {"min": [0, 0, 0], "max": [2, 2, 2]}, "to": [1, 1, 1]},
        {"falloff": {"axis": "x", "from": 0, "to": 1}, "pull": {"point": [2, 2, 2], "by": [0.1, 0, 0], "radius": 2}},
        {"falloff": {"center": [0, 0, 0], "radius": 3}, "mirror": "x", "by": [0, 0, 0.1]}]),
    "cylinder": lattice(size=(4, 6, 4), rest={"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 2], "height": 4}},
                        moves=[{"by": [0.5, 0, 0]}]),
    "knots": lattice(knots=[[0, 0, 0, 0, 1, 1, 1, 1], "clamped", "open"], moves=[{"by": [0.5, 0, 0]}]),
}


def objects(value, path=()):
    """The place of every object."""
    if isinstance(value, dict):
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from objects(item, (*path, key))


def with_note(value, path):
    copy = json.loads(json.dumps(value))
    place = copy
    for key in path:
        place = place[key]
    place.update(NOTE)
    return copy


@case
def comments_change_nothing(run):
    run.write("a.obj", CUBE)
    schema = Schema("ffd-lattice.schema.json")
    for kind, content in LATTICES.items():
        run.write("plain.json", content)
        run.ffd("deform", "a.obj", "plain.obj", "-l", "plain.json", "--force", err=anything)
        check(run.read("plain.obj") != run.read("a.obj"), kind)
        for path in objects(content):
            noted = with_note(content, path)
            run.write("noted.json", noted)
            run.ffd("deform", "a.obj", "noted.obj", "-l", "noted.json", "--force", err=anything)
            equal(run.read("noted.obj"), run.read("plain.obj"), f"{kind}: {path}")
            equal(schema.faults(json.dumps(noted).encode()), [], f"{kind}: {path} against the schema")


@case
def a_comment_is_a_text(run):
    run.write("a.obj", CUBE)
    for key in NOTE:
        run.write("l.json", {**lattice(), key: 3})
        done = run.ffd("check", "a.obj", "-l", "l.json", code=INVALID)
        check(f"/{key}" in done.err[0] and "unknown key" not in done.err[0], done.err)


@case
def an_embedding_does_not_mind_comments(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    run.write("l.json", {**lattice(moves=[{"by": [1, 0, 0]}]), **NOTE})
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--embedding", "e.npy")


@case
def words_of_other_programs_are_hinted_at(run):
    run.write("a.obj", CUBE)
    for move, wrong, right in (({"translate": [1, 0, 0]}, "translate", "by"), ({"rotation": {"axis": "z", "degrees": 10}}, "rotation", "rotate"),
                               ({"rotate": {"axis": "z", "angle": 10}}, "angle", "degrees"),
                               ({"twist": {"axis": "z", "angle": 10}}, "angle", "degrees"),
                               ({"bend": {"axis": "z", "toward": [1, 0, 0], "angle": 10}}, "angle", "degrees"),
                               ({"reflect": "x", "by": [1, 0, 0]}, "reflect", "mirror"), ({"grab": {}}, "grab", "pull"),
                               ({"select": "top", "by": [1, 0, 0]}, "select", "at"), ({"//": "up", "by": [1, 0, 0]}, "//", "comment"),
                               ({"fade": {}, "by": [1, 0, 0]}, "fade", "falloff"), ({"pull": {"center": [0, 0, 0]}}, "center", "point"),
                               ({"falloff": {"about": [0, 0, 0], "radius": 1}, "by": [1, 0, 0]}, "about", "center"),
                               ({"falloff": {"axis": "x", "start": 0, "end": 1}, "by": [1, 0, 0]}, "start", "from"),
                               ({"move": [1, 0, 0]}, "move", "by"), ({"offset": [1, 0, 0]}, "offset", "by"),
                               ({"twist": {"axis": "z", "deg": 10}}, "deg", "degrees"), ({"shear": [1, 0, 0]}, "shear", "matrix"),
                               ({"scale": {"factor": 2, "center": [0, 0, 0]}}, "center", "about")):
        run.write("l.json", lattice(moves=[move]))
        done = run.ffd("check", "a.obj", "-l", "l.json", code=INVALID)
        check(f'"{wrong}"' in done.err[0] and f'"{right}"' in done.err[0], done.err)
    # "angle" of a cylinder is a word of its own.
    run.write("l.json", lattice(size=(4, 4, 4), moves=[], rest={"cylinder": {
        "center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 2], "height": 4, "angle": [0, 90]}}))
    run.ffd("check", "a.obj", "-l", "l.json", err=anything)


@case
def keys_of_another_kind_of_box(run):
    """They are known there: the nearest known key would be no help."""
    run.write("a.obj", CUBE)
    for box, wrong, words in (({"meshes": ["a.obj"], "axes": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}, "axes", ("meshes", "along x, y, z")),
                              ({"meshes": ["a.obj"], "spacing": "uniform"}, "spacing", ("meshes", "Greville")),
                              ({"meshes": ["a.obj"], "min": [0, 0, 0]}, "min", ("meshes", "max")),
                              ({"meshes": ["a.obj"], "margin": 0.1}, "margin", ("beside",)),
                              ({"min": [0, 0, 0], "max": [1, 1, 1], "margin": 0.1}, "margin", ("round meshes",))):
        run.write("l.json", lattice(rest={"box": box}))
        done = run.ffd("check", "a.obj", "-l", "l.json", code=INVALID)
        check(done.err[0].startswith(f"l.json:1: /rest/box/{wrong}: ") and "unknown key" not in done.err[0]
              and all(word in done.err[0] for word in words), done.err)


main()
