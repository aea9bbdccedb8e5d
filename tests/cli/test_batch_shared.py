#!/usr/bin/env python3
"""ffd batch: neighbours share a mesh, and yet each output is that of a run of its own, in every format."""

import re
import subprocess
import time

from batches import MOVE, SANITIZED, batch, case, check, equal, job, lattice, lines_of, main, opened, report, start, traced
from harness import CUBE, FFD, OK, SECONDS
from neighbours import COMBINATIONS, LATTICES, words, write_meshes


@case
def a_batch_gives_what_single_runs_give(run):
    start(run)
    for name, content in LATTICES.items():
        run.write(name, content)
    jobs = []
    for mesh in write_meshes(run):
        for i, (grids, options) in enumerate(COMBINATIONS):
            jobs.append({"in": mesh, "lattice": grids, "out": f"out/{mesh[0]}{i}{mesh[1:]}", "options": options})
        jobs.append({"in": mesh, "lattice": "twist.json", "out": f"out/{mesh.replace('.', '-')}.obj"})  # another format
    jobs.append({"in": "m.glb", "lattice": "twist.json", "out": "out/morph.glb", "options": {"as-morph": "bent"}})
    for folder in ("out", "single", "single/out"):
        run.folder_of(folder)
    run.write("m.jsonl", lines_of(jobs))
    anything = {"code": (0, 1), "err": lambda said: None}
    run.ffd("batch", "m.jsonl", "-j", "2", "--report", "r.json", "--report-stable", **anything)
    entries = report(run)
    equal([e["line"] for e in entries], list(range(1, len(jobs) + 1)))
    failures = 0
    for one, entry in zip(jobs, entries):
        done = run.ffd("deform", one["in"], "single/" + one["out"], *[x for grid in ([one["lattice"]] if isinstance(one["lattice"], str)
                       else one["lattice"]) for x in ("-l", grid)], *words(one.get("options", {})), "--report", "s.json",
                       "--report-stable", code=tuple(range(8)), err=lambda said: None)
        alone = report(run, "s.json")[0]
        alone["output"], alone["outputs"] = one["out"], [name.replace("single/", "", 1) for name in alone["outputs"]]
        if alone["error"]:
            alone["error"] = alone["error"].replace("single/", "")
        del entry["line"], entry["set"]
        equal(entry, alone, f"report of {one}")
        failures += done.code != OK
    check(0 < failures < len(jobs) / 2, failures, "of", len(jobs), "jobs failed")
    equal(run.names("out"), run.names("single/out"))
    for name in run.names("out"):
        equal(run.read("out/" + name) == run.read("single/out/" + name), True, f"{name} is that of a single run")


@case
def a_mesh_is_read_once(run):
    start(run, [job(i, lattice=["twist.json", "bend.json", "half.json"][i % 3]) for i in range(60)] + [
        job(60 + i, **{"in": "m.gltf", "out": f"g{i}.gltf"}) for i in range(10)])
    for name, content in LATTICES.items():
        run.write(name, content)
    write_meshes(run)
    log = traced(run, "open,openat,openat2", "batch", "m.jsonl", "-j1")
    if log is None:
        return  # strace is not allowed to run
    # Once to be read, once to be known again by --resume, and a .gltf twice for the names of its buffers, in and out.
    counts = {name: opened(log, name) for name in ("a.obj", "m.gltf", "m.bin")}
    check(all(count <= most for count, most in zip(counts.values(), (2, 4, 2))), "how often meshes were opened:", counts)
    # By each worker, however the jobs are dealt out.
    log = traced(run, "open,openat,openat2", "batch", "m.jsonl", "-j", "3", "--force")
    check(opened(log, "a.obj") <= 3 * 2 and opened(log, "m.gltf") <= 3 * 4, "opened by every job")
    # Another mesh between them: read again, or not, but never mistaken for it.
    run.write("m.jsonl", lines_of([job(i, **{"in": ["a.obj", "b.obj"][i % 2]}) for i in range(6)]))
    run.write("b.obj", CUBE.replace("v 1 1 1", "v 1 1 1.5"))
    batch(run, "m.jsonl", "-j1", "--force", done=6)
    for i in range(6):
        run.ffd("deform", ["a.obj", "b.obj"][i % 2], "s.obj", "-l", "l.json", "--force")
        equal(run.read(f"o{i}.obj"), run.read("s.obj"), f"o{i}.obj")


@case
def a_mesh_that_another_program_writes_meanwhile(run):
    """What is shared is not what was there before."""
    start(run)
    run.write("b.obj", CUBE)
    process = subprocess.Popen([FFD, "batch", "-", "-j1"], cwd=run.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)

    def feed(name, before):
        run.write("kept.obj", before)
        run.write("b.obj", before)
        process.stdin.write(lines_of([{"in": "b.obj", "lattice": "l.json", "out": name}]).encode())
        process.stdin.flush()
        limit = time.monotonic() + SECONDS
        while not run.exists(name) and time.monotonic() < limit:
            time.sleep(0.002)
        run.ffd("deform", "kept.obj", "single.obj", "-l", "l.json", "--force")
        equal(run.read(name), run.read("single.obj"), name)

    feed("c.obj", CUBE)
    feed("d.obj", CUBE.replace("v 1 1 1", "v 1 1 1.5"))
    said = process.communicate(timeout=SECONDS)[1].decode()
    equal(process.returncode, OK, said)
    check("standard input:2: b.obj: has changed" in said, said)


@case
def workers_are_reused(run):
    start(run, [job(i, **{"in": f"in{i % 7}.obj"}) for i in range(50)])
    for i in range(7):
        run.write(f"in{i}.obj", CUBE)
    log = traced(run, "execve", "batch", "m.jsonl", "-j", "2")
    if log is not None:
        started = sum("execve(" in line and "= -1" not in line for line in log.splitlines())
        check(started <= 3, started, "programs were started for 50 jobs by 2 workers")


@case
def equal_volumes_that_are_known_otherwise(run):
    """As a box or by its points, with weights of 1 or with none: u,v,w may differ in the last bits, so none of it is
    taken from a neighbour."""
    low, high, moves = (0.1, 0.2, 0.3), (1.3, 1.7, 2.9), [{"at": [[1, 3], 2, [1, 3]], "by": [0.1, 0.2, 0.05]}]
    start(run)
    along = [[a + (b - a) * g for g in (0, 0.5 / 3, 0.5, 2.5 / 3, 1)] for a, b in zip(low, high)]
    points = [[x, y, z] for z in along[2] for y in along[1] for x in along[0]]
    kinds = {"box": {}, "points": {"rest": {"points": points}}, "weights": {"rest": {"points": points}, "weights": [1] * 125}}
    for name, members in kinds.items():
        run.write(name + ".json", lattice((5, 5, 5), low, high, moves, **members))
    run.write("a.obj", "".join(f"v {low[0] + 0.0123 * i} {low[1] + 0.0149 * i} {high[2] - 0.0259 * i}\n" for i in range(90)))
    run.ffd("embed", "a.obj", "-l", "box.json", "-o", "box.npy")
    alone = {}
    for name in kinds:
        run.ffd("deform", "a.obj", "x.obj", "-l", name + ".json", "--embedding", "box.npy", "--force")  # it is the same volume
        run.ffd("deform", "a.obj", "x.obj", "-l", name + ".json", "--force")
        alone[name] = run.read("x.obj")
    check(alone["box"] != alone["points"], "nothing to be mistaken")
    order = [*kinds, *reversed(kinds)]
    run.write("m.jsonl", lines_of([job(i, lattice=name + ".json") for i, name in enumerate(order)]))
    batch(run, "m.jsonl", "-j1", done=len(order))
    for i, name in enumerate(order):
        equal(run.read(f"o{i}.obj") == alone[name], True, f"{name}, job {i}")


def peak(run, jobs, *arguments):
    """The most memory that the first process of a batch had, in bytes."""
    with open(run.path("many.jsonl"), "w", encoding="utf-8") as file:
        for i in range(jobs):
            file.write('{"in": "a.obj", "lattice": "l.json", "out": "out/%d.obj"}\n' % i)
    process = subprocess.Popen([FFD, "batch", "many.jsonl", "-q", *arguments], cwd=run.folder, stdout=subprocess.DEVNULL)
    most = 0
    while process.poll() is None:
        with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
            found = re.search(r"VmHWM:\s*(\d+) kB", file.read())
        most = int(found[1]) * 1024 if found else most
        time.sleep(0.002)
    equal(process.returncode, OK)
    return most


@case
def memory_does_not_grow_with_the_jobs(run):
    if SANITIZED:
        return  # its memory is not the program's
    start(run)
    run.folder_of("out")
    # One worker: of several, jobs that end before an earlier one wait to be told, more or fewer of them.
    few = peak(run, 5000, "--dry-run", "-j1")
    many = peak(run, 40000, "--dry-run", "-j1")
    # 4,096 jobs are kept as they were read. 16 bytes for each job more, a sixteenth of that, and what two runs alike differ by.
    check(few > 0 and many < few + 35000 * 17 + 400e3, f"5,000 jobs took {few / 1e6:.2f} MB, 40,000 took {many / 1e6:.2f} MB")


main()
