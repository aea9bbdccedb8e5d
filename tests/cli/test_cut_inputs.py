#!/usr/bin/env python3
"""An input that becomes shorter while it is read: one line, exit 3, nothing is left, and other jobs go on.

A library that is loaded before all others (tests/support/cut_trap.c) makes a file shorter once it is mapped."""

import json
import os
import shutil
import sys

from harness import IO, NO, case, check, equal, gltf_json, lattice, main

TRAP = os.path.abspath(sys.argv.pop(1))
POINTS = 60000
POSITIONS = [[n % 97 / 97, n % 89 / 89, n % 83 / 83] for n in range(POINTS)]
TOLD = "became shorter while it was read"
# To nothing, within the first pages, in the middle, within the last page.
SIZES = (0, 5000, 200000, -1)


def start(run):
    run.write("l.json", lattice(moves=[{"by": [0.1, 0.2, 0.3]}]))
    run.write("a.obj", "".join("v %.6f %.6f %.6f\n" % tuple(p) for p in POSITIONS)
              + "".join(f"f {n} {n + 1} {n + 2}\n" for n in range(1, POINTS - 1, 5)))
    for ending in ("ply", "off", "stl", "glb"):
        run.ffd("deform", "a.obj", f"a.{ending}", "-l", "l.json", "-q")
    asset, data = gltf_json(POSITIONS, uri="cut.bin")
    run.write("a.gltf", asset)
    run.write("whole.bin", data)


def cut(run, name, *arguments, original, size=5000, code=IO, err=None):
    """A run whose input `name`, a copy of original, becomes shorter."""
    shutil.copy(run.path(original), run.path(name))
    if size < 0:
        size += os.path.getsize(run.path(name))
    env = {**os.environ, "LD_PRELOAD": TRAP, "FFD_CUT": str(size), "MALLOC_PERTURB_": "0"}
    done = run.ffd(*arguments, code=code, err=err, env=env)
    equal(os.path.getsize(run.path(name)), size, "the trap was not sprung")
    run.remove(name)
    return done


@case
def every_format_at_every_place(run):
    start(run)
    before = run.names()
    for ending in ("obj", "ply", "off", "stl", "glb"):
        for size in SIZES:
            cut(run, f"cut.{ending}", "deform", f"cut.{ending}", f"b.{ending}", "-l", "l.json", original=f"a.{ending}", size=size,
                err=f"cut.{ending}: {TOLD}")
    for size in SIZES:
        cut(run, "cut.bin", "deform", "a.gltf", "b.gltf", "-l", "l.json", original="whole.bin", size=size,
            err=f"{run.path('cut.bin')}: {TOLD}")
    equal(run.names(), before)


@case
def a_file_cut_while_it_is_read_is_exit_3_in_every_command(run):
    start(run)
    told = f"cut.obj: {TOLD}"
    run.write("k.json", lattice(keys=[{"time": n, "moves": [{"by": [0.1 * n, 0.2, 0.3]}]} for n in range(2)]))
    before = run.names()
    for arguments in (["check", "cut.obj", "-l", "l.json"], ["info", "cut.obj"], ["info", "cut.obj", "--json"],
                      ["compare", "a.obj", "cut.obj"], ["compare", "cut.obj", "a.obj"],
                      ["embed", "cut.obj", "-l", "l.json", "-o", "u.npy", "--status", "s.npy"],
                      ["lattice", "new", "cut.obj", "-o", "n.json"],
                      ["deform", "cut.obj", "b.glb", "-l", "l.json", "--report", "r.json", "-j", "4"],
                      ["animate", "cut.obj", "b.glb", "-l", "k.json", "--report", "r.json"],
                      ["deform", "cut.obj", "--in-place", "-l", "l.json"]):
        cut(run, "cut.obj", *arguments, original="a.obj", err=told)
        if "--report" in arguments:
            entry, = json.loads(run.read("r.json"))["jobs"]
            equal((entry["exit"], entry["error"]), (IO, told))
            run.remove("r.json")
    equal(run.names(), before)


@case
def large_lattices_and_reports(run):
    start(run)
    file = lattice(size=(20, 20, 20), moves=[{"by": [0.1, 0, 0]}])
    file["comment"] = "x" * 400000
    run.write("large.json", file)
    cut(run, "cut.json", "deform", "a.obj", "b.obj", "-l", "cut.json", original="large.json", err=f"cut.json: {TOLD}")
    cut(run, "cut.json", "info", "cut.json", original="large.json", err=f"cut.json: {TOLD}")
    for words in (["refine", "cut.json", "--size", "30"], ["set", "cut.json", "--strength", "2"], ["set", "l.json", "--deformed", "cut.json"],
                  ["convert", "cut.json"]):
        cut(run, "cut.json", "lattice", *words, "-o", "n.json", original="large.json", err=f"cut.json: {TOLD}")
    run.ffd("lattice", "convert", "large.json", "-o", "large.csv")
    for words in (["convert", "cut.csv"], ["set", "large.json", "--deformed", "cut.csv"]):
        cut(run, "cut.csv", "lattice", *words, "-o", "n.json", original="large.csv", err=f"cut.csv: {TOLD}")
    check(not run.exists("n.json"), "a lattice of half a lattice")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "one.json")
    job = json.loads(run.read("one.json"))["jobs"][0]
    run.write("many.json", json.dumps({"format": "ffd-report", "version": 1, "jobs": [job] * 400}))
    cut(run, "cut.json", "report", "merge", "cut.json", "-o", "m.json", original="many.json", err=f"cut.json: {TOLD}")
    check(not run.exists("m.json"), "a report of half a report")


@case
def other_meshes_go_on(run):
    """Several IN, and the jobs of a batch, whose workers live on."""
    start(run)
    run.folder_of("o")
    cut(run, "cut.obj", "deform", "cut.obj", "a.obj", "--out-dir", "o", "-l", "l.json", original="a.obj", code=NO,
        err=f"cut.obj: {TOLD}")
    equal(run.names("o"), ["a.obj"])
    run.remove("o/a.obj")
    # The batch itself looks for what a job copies, unless nothing is: the worker is to come upon the cut.
    run.write("jobs.jsonl", "".join(json.dumps({"in": name, "lattice": "l.json", "out": "o/" + name,
                                                "options": {"resources": "reference"}}) + "\n" for name in ("cut.obj", "a.obj")))
    for more in ([], ["--resume"]):
        cut(run, "cut.obj", "batch", "jobs.jsonl", "-j", "1", "--journal", "J", "--report", "r.json", "--force", *more, original="a.obj",
            code=NO, err=lambda said: equal(said[:-1], [f"jobs.jsonl:1: cut.obj: {TOLD}"], str(said)))
        equal([(job["exit"], job["error"]) for job in json.loads(run.read("r.json"))["jobs"]],
              [(IO, f"cut.obj: {TOLD}"), (0, None)])
        equal(run.names("o"), ["a.obj"])


main()
