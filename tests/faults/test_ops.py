#!/usr/bin/env python3
"""What machines and clusters give a process, and what once went past it (ops-*). The inputs are made here.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_ops.py ops_05_threads_and_workers_follow_affinity
"""

import json
import os
import re
import shutil
import subprocess

from harness import FFD, IO, NO, case, check, equal, lattice, main

HERE = os.path.dirname(os.path.abspath(__file__))


def most_at_once(run, *arguments):
    """The most threads and child processes that a command has at one time, while it runs."""
    env = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}  # that starts a process at the end
    process = subprocess.Popen([FFD, *arguments], cwd=run.folder, stderr=subprocess.DEVNULL, env=env)
    threads = children = 0
    while process.poll() is None:
        try:
            threads = max(threads, len(os.listdir(f"/proc/{process.pid}/task")))
            with open(f"/proc/{process.pid}/task/{process.pid}/children", encoding="ascii") as file:
                children = max(children, len(file.read().split()))
        except OSError:
            pass  # it has just ended
    equal(process.returncode, 0, arguments)
    return threads, children


@case
def ops_05_threads_and_workers_follow_affinity(run):
    """On a machine with two processors or more, of which the process may use one: one thread, one worker."""
    n = 200
    run.write("grid.obj", "".join(f"v {i} {j} {i * j % 7}\n" for i in range(n) for j in range(n))
              + "".join(f"f {a} {a + 1} {a + n + 1} {a + n}\n" for i in range(n - 1) for a in range(i * n + 1, i * n + n)))
    run.write("l.json", lattice(rest={"box": "mesh", "margin": 0.05}, moves=[{"twist": {"axis": "z", "degrees": 30}}]))
    run.write("m.jsonl", "".join(json.dumps({"in": "grid.obj", "lattice": "l.json", "out": f"o{i}.obj"}) + "\n" for i in range(8)))
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(allowed)})
    try:
        equal(most_at_once(run, "deform", "grid.obj", "out.obj", "-l", "l.json"), (1, 0), "threads and workers of deform")
        equal(most_at_once(run, "batch", "m.jsonl"), (1, 1), "threads and workers of batch")
    finally:
        os.sched_setaffinity(0, allowed)


QUIET = {"err": lambda said: None}
NOTE = re.compile(r"ffd-copy 2\n[0-9a-f]{32}\n(.*)", re.S)


def notes(run):
    """Name -> the copy that it is of."""
    folder = run.path("cache/ffd")
    return {name: NOTE.fullmatch(run.read("cache/ffd/" + name).decode())[1] for name in os.listdir(folder) if name.startswith("copy-")}


def start_edits(run):
    """The mesh, with its texture, and the OBJ with its library; both made once by a batch."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    shutil.copytree(os.path.join(HERE, "ops-09-edited-texture-stops-the-build"), run.folder, dirs_exist_ok=True)
    run.write("jobs.jsonl", "".join(json.dumps({"in": name, "lattice": "twist.json", "out": f"out/{name}"}) + "\n" for name in ("box.gltf", "m.obj")))
    run.ffd("batch", "jobs.jsonl", "--resume", "--journal", "j", **QUIET)


def edit(run, by="x"):
    run.write("m.mtl", "newmtl a\nKd 0 1 0\n# " + by)
    run.write("wood.png", run.read("wood.png") + by.encode())


def check_copies(run):
    for name in ("m.mtl", "wood.png"):
        equal(run.read("out/" + name), run.read(name), name)


@case
def ops_09_notes_of_copies_that_are_gone_are_removed(run):
    """By the next new note, among those of the same two digits; those of copies that are there stay, whatever else changes."""
    start_edits(run)
    run.ffd("deform", "m.obj", "out/m.obj", "-l", "twist.json", "--resources", "refresh", "--force")
    kept = notes(run)
    equal(list(kept.values()), [os.path.realpath(run.path("out/m.mtl"))], "what is noted")
    for n in range(256):
        run.write(f"cache/ffd/copy-{n:02x}{'0' * 30}", f"ffd-copy 2\n{'0' * 32}\n" + run.path("gone.png"))
        run.write(f"cache/ffd/copy-{n:02x}{'1' * 30}", "another version" if n % 2 else "")
        run.write(f"cache/ffd/copy-{n:02x}.journal", "of somebody else")
    os.mkdir(run.path("new"))
    run.ffd("deform", "box.gltf", "new/box.gltf", "-l", "twist.json")
    (made,) = (name for name, copy in ((name, run.read("cache/ffd/" + name).decode()) for name in os.listdir(run.path("cache/ffd")))
               if copy.endswith("new/wood.png"))
    left = set(os.listdir(run.path("cache/ffd")))
    check(set(kept) <= left, "a note whose copy is there is removed")
    gone = {f"copy-{n:02x}{digit * 30}" for n in range(256) for digit in "01"} - left
    equal(gone, {f"{made[:7]}{digit * 30}" for digit in "01"}, "the notes that were removed")
    check(all(f"copy-{n:02x}.journal" in left for n in range(256)), "a file that is no note is removed")


@case
def ops_09_edited_textures_are_copied_anew(run):
    start_edits(run)
    edit(run)
    run.ffd("batch", "jobs.jsonl", "--resources", "refresh", "--resume", "--journal", "j", **QUIET)
    run.ffd("deform", "m.obj", "out/m.obj", "-l", "twist.json", "--resources", "refresh", "--force")
    run.ffd("deform", "box.gltf", "out/box.gltf", "-l", "twist.json", "--resources", "refresh", "--if-changed", "--depfile", "out/box.d")
    check_copies(run)
    # Each run has noted what it has made: deform in the folder of the default journals.
    edit(run, "y")
    for name in ("m.obj", "box.gltf"):
        run.ffd("deform", name, "out/" + name, "-l", "twist.json", "--resources", "refresh", "--force")
    check_copies(run)


@case
def without_refresh_a_message_names_it(run):
    start_edits(run)
    for name in ("m.obj", "box.gltf"):
        run.ffd("deform", name, "out/" + name, "-l", "twist.json", "--force")
    edit(run)
    for name, copy in (("m.obj", "m.mtl"), ("box.gltf", "wood.png")):
        run.ffd("deform", name, "out/" + name, "-l", "twist.json", "--force", code=IO,
                err=re.compile(f"^out/{re.escape(copy)}: is the copy of an earlier run.*--resources refresh"))
    said = run.ffd("batch", "jobs.jsonl", "--resume", "--journal", "j", code=NO, **QUIET).err
    equal(sum("--resources refresh" in line for line in said), 2, said)


@case
def copies_of_others_stay(run):
    """One that somebody has changed, that was there before, or of which nothing is noted."""
    start_edits(run)
    edit(run)
    run.write("out/wood.png", run.read("wood.png") + b"!")
    run.write("out/m.mtl", "newmtl b\n")
    before = {name: run.read("out/" + name) for name in run.names("out")}
    for words in (["--journal", "j", "--resume"], ["--journal", "j", "--force"], ["--journal", "new", "--force"], ["--dry-run", "--journal", "j", "--force"]):
        run.ffd("batch", "jobs.jsonl", "--resources", "refresh", *words, code=NO, data=True, **QUIET)
    for name in ("m.obj", "box.gltf"):
        run.ffd("deform", name, "out/" + name, "-l", "twist.json", "--resources", "refresh", "--force", code=IO)
    equal({name: run.read("out/" + name) for name in run.names("out")}, before)
    # A batch's journal is not that of deform.
    run.write("wood.png", run.read("wood.png")[:-1])
    run.write("out/wood.png", run.read("wood.png"))
    edit(run, "z")
    run.ffd("deform", "box.gltf", "out/box.gltf", "-l", "twist.json", "--resources", "refresh", "--force", code=IO)
    # Nowhere to keep notes: the copies are made all the same.
    os.environ["XDG_CACHE_HOME"] = "/dev/null/none"
    run.ffd("deform", "box.gltf", "n/../x.gltf", "-l", "twist.json", code=IO)
    run.ffd("deform", "box.gltf", "m.obj", "--out-dir", "fresh", "-l", "twist.json", **QUIET)
    equal(run.names("fresh"), ["box.bin", "box.gltf", "m.mtl", "m.obj", "wood.png"])


@case
def a_shared_texture_is_refreshed_once(run):
    """Several jobs copy it; a copy that is gone is made again, a read-only one replaced; a dry run writes nothing."""
    start_edits(run)
    jobs = [{"in": "box.gltf", "lattice": "twist.json", "out": f"out/box{i}.gltf"} for i in range(8)]
    run.write("jobs.jsonl", "".join(json.dumps(job) + "\n" for job in jobs))
    run.ffd("batch", "jobs.jsonl", "--journal", "j", "--resources", "refresh", **QUIET)
    for by in "ab":
        edit(run, by)
        os.chmod(run.path("out/wood.png"), 0o444)
        before = run.read("out/wood.png")
        run.ffd("batch", "jobs.jsonl", "--journal", "j", "--resources", "refresh", "--resume", "--dry-run", data=True, **QUIET)
        equal(run.read("out/wood.png"), before, "a dry run")
        run.ffd("batch", "jobs.jsonl", "--journal", "j", "--resources", "refresh", "--resume", "-j4", "--report", "r.json", **QUIET)
        equal(run.read("out/wood.png"), run.read("wood.png"))
        equal([entry["outputs"][-1] for entry in json.loads(run.text("r.json"))["jobs"]], ["out/wood.png"] * 8)
    run.remove("out/wood.png")
    run.ffd("batch", "jobs.jsonl", "--journal", "j", "--resources", "refresh", "--resume", **QUIET)
    check(run.exists("out/wood.png"), "a copy that is gone")


main()
