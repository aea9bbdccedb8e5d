#!/usr/bin/env python3
"""ffd deform and ffd check with many meshes: what they have in common is found once, and each output is that of a
run of its own."""

import json
import os

from batches import case, check, equal, main, opened, report, traced
from harness import CUBE, CUBE_CORNERS, INVALID, OK, USAGE, gltf_json, lattice
from neighbours import COMBINATIONS, LATTICES, words, write_meshes

ANY = {"code": tuple(range(8)), "err": lambda said: None}


def start(run):
    """Returns the names of the meshes."""
    for name, content in LATTICES.items():
        run.write(name, content)
    return write_meshes(run)


def lattice_words(grids):
    return [word for grid in grids for word in ("-l", grid)]


@case
def many_meshes_give_what_each_gives_alone(run):
    meshes = start(run)
    failures = 0
    for i, (grids, options) in enumerate(COMBINATIONS):
        many, single = run.folder_of(f"many{i}"), run.folder_of(f"single{i}")
        said = [*lattice_words(grids), *words(options), "--report-stable"]
        run.ffd("deform", *meshes, "--out-dir", many, *said, "--report", "m.json", **ANY)
        entries = report(run, "m.json")
        equal([entry["input"] for entry in entries], meshes)
        for mesh, entry in zip(meshes, entries):
            done = run.ffd("deform", mesh, f"{single}/{mesh}", *said, "--report", "s.json", **ANY)
            alone = report(run, "s.json")[0]
            alone["output"] = entry["output"]
            alone["outputs"] = [name.replace(single, many, 1) for name in alone["outputs"]]
            equal(entry, alone, f"report of {mesh} with {grids} {options}")
            failures += done.code != OK
        equal(run.names(many), run.names(single))
        for name in run.names(many):
            equal(run.read(f"{many}/{name}") == run.read(f"{single}/{name}"), True, f"{name} with {grids} {options}")
    check(0 < failures < len(meshes) * len(COMBINATIONS) / 2, failures, "jobs failed")


@case
def many_checks_say_what_each_says_alone(run):
    meshes = start(run)
    for grids in (["curved.json"], ["half.json", "twist.json"], ["round.json"]):
        many = run.ffd("check", *meshes, *lattice_words(grids), **ANY)
        alone = [run.ffd("check", mesh, *lattice_words(grids), **ANY) for mesh in meshes]
        equal(many.text, "".join(one.text for one in alone))
        equal([line for line in many.err if "--shared-box" not in line], [line for one in alone for line in one.err])
        equal(len([line for line in many.err if "--shared-box" in line]), int(grids == ["round.json"]), "a box for each mesh")


def copies(run, count):
    for i in range(count):
        run.write(f"in/{i}.obj", CUBE)
    return [f"in/{i}.obj" for i in range(count)]


@case
def outputs_of_many_meshes_get_the_ending_of_their_format(run):
    run.write("l.json", LATTICES["curved.json"])
    run.folder_of("out")
    for name in ("a.obj", "b.c.OBJ", "d"):
        run.write(name, CUBE)
    formats = ["--input-format", "obj", "-l", "l.json", "-q"]
    run.ffd("deform", "a.obj", "b.c.OBJ", "d", "--out-dir", "out", "--output-format", "PLY", *formats)
    equal(run.names("out"), ["a.ply", "b.c.ply", "d.ply"])
    run.ffd("deform", "a.obj", "--out-dir", "out", "--output-format", ".vrm", *formats)
    equal(run.names("out"), ["a.ply", "a.vrm", "b.c.ply", "d.ply"])
    run.write("a.stl", CUBE)
    run.ffd("deform", "a.obj", "a.stl", "--out-dir", "out", "--output-format", "off", *formats, code=USAGE,
            err='a.obj and a.stl would both be written as "a.off"')
    equal(run.names("out"), ["a.ply", "a.vrm", "b.c.ply", "d.ply"])
    for out, to, told in (("o.obj", "glb", "o.obj is written as GLB, although its ending says OBJ"),
                          ("o.gltf", "glb", "o.gltf is written as GLB, although its ending says glTF"), ("o.dat", "glb", None),
                          ("o.vrm", "glb", None)):
        run.ffd("deform", "a.obj", out, "--output-format", to, *formats[:-1],
                err=lambda said, told=told: equal([line for line in said if "ending" in line], [f"a.obj: {told}"] if told else []))


@case
def no_mesh_reads_what_another_one_writes(run):
    """The box of a lattice, buffers and lattices: the order of the names would count. Nothing is done."""
    run.write("l.json", LATTICES["curved.json"])
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE)
    run.write("box.json", {**json.loads(json.dumps(LATTICES["curved.json"])), "rest": {"box": {"meshes": ["a.obj", "b.obj"]}}})
    asset, data = gltf_json(CUBE_CORNERS, uri="m.ply")
    run.write("m.gltf", asset)
    run.write("m.ply", data)
    asset["buffers"][0]["uri"] = "n.bin"
    run.write("n.gltf", {**asset, "extensions": {"X_scan": {"cloud": {"uri": "m.ply"}}}})
    run.write("n.bin", data)
    run.write("l.off", LATTICES["curved.json"])
    run.folder_of("new")
    run.write("new/l.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    run.write("new/m.ply", CUBE)
    os.symlink("../b.obj", run.path("new/b.obj"))
    before = {name: run.read(name) for name in run.names() if name != "new"}
    for words_, told in (
            (["b.obj", "a.obj", "--in-place", "-l", "box.json"],
             "b.obj: reads a.obj (for the box of box.json), which this run writes as the output of a.obj: their order would count"),
            (["a.obj", "new/b.obj", "--in-place", "-l", "box.json"],
             "new/b.obj: reads a.obj (for the box of box.json), which this run writes as the output of a.obj: their order would count"),
            (["m.gltf", "new/m.ply", "--out-dir", ".", "-l", "l.json", "--force", "--input-format", "gltf"],
             "m.gltf: reads m.ply, which this run writes as the output of new/m.ply: their order would count"),
            (["n.gltf", "new/m.ply", "--out-dir", ".", "-l", "l.json", "--force", "--input-format", "gltf"],
             "n.gltf: names m.ply, which this run writes as the output of new/m.ply"),
            (["a.obj", "new/l.off", "--out-dir", ".", "-l", "l.off", "--force"],
             "a.obj: reads l.off, which this run writes as the output of new/l.off: their order would count")):
        run.ffd("deform", *words_, code=INVALID, err=told)
    equal({name: run.read(name) for name in run.names() if name != "new"}, before)
    # Each may read its own file; and all, where what they write is elsewhere.
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "new", "-l", "box.json", "--output-format", "off")
    run.ffd("deform", "a.obj", "--in-place", "-l", "box.json")


@case
def a_lattice_is_read_once(run):
    run.write("l.json", LATTICES["curved.json"])
    run.folder_of("out")
    log = traced(run, "open,openat,openat2", "deform", *copies(run, 20), "--out-dir", "out", "-l", "l.json", "--outside",
                 "extend")
    if log is not None:
        equal(opened(log, "l.json"), 1, "how often the lattice was opened")


@case
def each_mesh_takes_the_same_number_of_calls(run):
    """None is compared with all that were written before."""
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    calls = []
    for count in (10, 20, 40):
        out = run.folder_of(f"out{count}")
        log = traced(run, "%file", "deform", *copies(run, count), "--out-dir", out, "-l", "l.json")
        if log is None:
            return  # strace is not allowed to run
        # Not those for the limits of the machine, which are looked at once a second.
        calls.append(sum(".obj" in line or os.path.basename(out) in line for line in log.splitlines()))
    check(10 < calls[2] - calls[1] <= 2 * (calls[1] - calls[0]) + 5, "calls of the system for 10, 20, 40 meshes:", calls)


main()
