#!/usr/bin/env python3
"""ffd batch: a job that crashes, hangs or runs out of memory ends alone, and the report says why. Argument: the
library whose traps it runs into (tests/support/open_trap.c)."""

import concurrent.futures
import math
import os
import subprocess
import sys
import time

from batches import batch, case, check, equal, job, lattice, lines_of, main, report, start, statuses
from harness import CUBE, FFD, NO, OK, SECONDS, Run, npy

TRAP = os.path.abspath(sys.argv.pop(1))
# Seconds for a job that never ends, and far more than the others need where a machine pauses.
TIMEOUT = "3"
# What the name of a mesh or of a lattice does, and what the reason of the failure must say.
TRAPS = {"abort": "crashed: .*Abort", "segv": "crashed: .*Segmentation", "kill": "Killed", "nomemory": "out of memory",
         "sleep": f"took longer than {TIMEOUT} seconds .*--timeout"}


def trapped(run, *arguments, **options):
    return batch(run, *arguments, env={**os.environ, "XDG_CACHE_HOME": run.path("cache"), "LD_PRELOAD": TRAP}, **options)


def start_trapped(run, folder=""):
    """Jobs that run into every trap, by a mesh and by a lattice, between good ones, with their outputs in a folder. Returns the
    reasons by line."""
    jobs, reasons = [job(0)], {}
    for i, (name, reason) in enumerate(TRAPS.items()):
        run.write(name + ".obj", CUBE)
        run.write(name + ".json", lattice())
        jobs += [job(100 + i, **{"in": name + ".obj"}), job(2 * i + 1), job(200 + i, lattice=name + ".json"), job(2 * i + 2)]
        reasons[4 * i + 2] = rf"^{name}\.obj: .*{reason}"
        reasons[4 * i + 4] = rf"^a\.obj: .*{reason}" if name != "nomemory" else "out of memory"
    if folder:
        run.folder_of(folder)
    start(run, [{**each, "out": os.path.join(folder, each["out"])} for each in jobs])
    return reasons


def run_trapped(run, arguments, folder):
    """A batch with every trap in a folder of its own, and, with a report, once more with --resume."""
    reasons = start_trapped(run, folder)
    run.ffd("deform", "a.obj", "single.obj", "-l", "l.json")
    for more in ([], ["--resume"])[:1 + ("--report" in arguments)]:
        trapped(run, "m.jsonl", "--timeout", TIMEOUT, "--force", *arguments, *more, failed=list(reasons.values()),
                **({"kept": 11} if more else {"done": 11}))
        equal(sorted(name for name in os.listdir(run.path(folder)) if name.startswith("o")), sorted(f"o{i}.obj" for i in range(11)))
        for i in range(11):
            equal(run.read(os.path.join(folder, f"o{i}.obj")), run.read("single.obj"), f"{arguments}: o{i}.obj")
        if "--report" in arguments:
            entries = report(run)
            equal([e["line"] for e in entries if e["status"] == "failed"], sorted(reasons))
            equal({e["exit"] for e in entries if e["status"] == "failed"}, {7})


@case
def jobs_that_end_a_worker_fail_alone(run):
    """The batches run at the same time: each waits for jobs that never end, and for nothing else. What goes into another
    folder takes material libraries along: the mesh is looked at before the job begins, by a worker too."""
    options = (["-j1"], ["-j", "2"], ["-j", "5"], ["-j3", "--report", "r.json"], ["-j2"])
    outputs = ("", "", "", "", "sub")
    folders = [Run(run.path(run.folder_of(f"batch{i}"))) for i in range(len(options))]
    with concurrent.futures.ThreadPoolExecutor(len(options)) as pool:
        for ended in [*map(pool.submit, [run_trapped] * len(options), folders, options, outputs)]:
            ended.result()


@case
def a_channel_that_fails_is_no_crash(run):
    """The first process cannot hear a worker: the job fails for this reason, and those after it go on."""
    start(run, [job(i) for i in range(3)])
    log = run.path("strace.log")
    done = subprocess.run(["strace", "-o", log, "-e", "inject=recvfrom:error=ENOMEM:when=1", FFD, "batch", "m.jsonl", "-j", "1"],
                          cwd=run.folder, capture_output=True, check=False, timeout=SECONDS)
    if not os.path.exists(log) or os.path.getsize(log) == 0 or b"PTRACE" in done.stderr:
        print("strace is not allowed to run")
        return
    said = done.stderr.decode().splitlines()
    equal(said[0], "ffd: m.jsonl:1: a.obj: the connection to the worker that did this job has failed: what it has made is not known")
    check(": 2 done, 0 up to date, 1 failed" in said[1] and done.returncode == NO, said, done.returncode)


@case
def a_crash_stops_with_stop(run):
    start_trapped(run)
    trapped(run, "m.jsonl", "-j1", "--stop", "--report", "r.json", done=1, failed=["^abort.obj: "], more="(--stop)")
    equal(statuses(run), ["ok", "failed"])


@case
def a_worker_that_crashes_leaves_no_row(run):
    """Of an array of positions: that of a run before goes, too."""
    good = {"in": "a.obj", "lattice": "l.json"}
    start(run, [good, good])
    batch(run, "m.jsonl", "--positions", "all.npy", done=2)
    run.write("abort.json", lattice())
    run.write("m.jsonl", lines_of([good, {**good, "lattice": "abort.json"}]))
    trapped(run, "m.jsonl", "--positions", "all.npy", "--resume", kept=1, failed=["crashed: .*Abort"])
    _, shape, values = npy(run.read("all.npy"))
    equal(shape, (2, 8, 3))
    equal([math.isnan(value) for value in values], [False] * 24 + [True] * 24)


@case
def a_mesh_that_takes_too_long_is_passed_over(run):
    """Where the vertices of a row are counted, before the first job: the next mesh says how many there are."""
    start(run, [{"in": "sleep.obj", "lattice": "l.json"}, {"in": "a.obj", "lattice": "l.json"}])
    run.write("sleep.obj", CUBE + "v 0 0 0\n")
    trapped(run, "m.jsonl", "--positions", "all.npy", "--timeout", TIMEOUT, "-j2", done=1, failed=[rf"^sleep\.obj: .*{TRAPS['sleep']}"])
    _, shape, values = npy(run.read("all.npy"))
    equal(shape, (2, 8, 3))
    equal([math.isnan(value) for value in values], [True] * 24 + [False] * 24)


@case
def nothing_of_a_worker_that_was_ended_stays(run):
    """The time is up while the worker reads or writes: the system ends it in the middle of a large file."""
    start(run, [job(0, **{"in": "large.obj"})])
    run.write("large.obj", CUBE * 100000)
    ended = 0
    for timeout in ("0.01", "0.02", "0.04", "0.08"):
        done = run.ffd("batch", "m.jsonl", "--timeout", timeout, code=(OK, NO), err=lambda said: None)
        check(done.code == OK or "took longer than " in done.err[0], done.err)
        equal([name for name in run.names() if "tmp" in name or name == "o0.obj"], [] if done.code == NO else ["o0.obj"])
        ended += done.code == NO
        if done.code == OK:
            run.remove("o0.obj")
    check(ended, "it was never too late")


@case
def time_is_counted_for_each_job(run):
    """Twenty jobs that take a tenth of the time allowed each."""
    start(run, [job(i, **{"in": "some.obj"}) for i in range(20)])
    run.write("some.obj", CUBE * 300)
    batch(run, "m.jsonl", "--timeout", "60", "-j1", done=20)
    begun = time.monotonic()
    batch(run, "m.jsonl", "--timeout", "100000", "--force", done=20)
    check(time.monotonic() - begun < 30, "a long timeout was waited for")


@case
def a_limit_on_addresses(run):
    """Out of memory by a limit of the system."""
    start(run, [job(0), job(1, **{"in": "large.obj"}), job(2)])
    run.write("large.obj", CUBE * 100000)
    limited = ["sh", "-c", 'ulimit -v 150000; exec "$0" batch m.jsonl -j1 --threads 1 --report r.json', FFD]
    done = subprocess.run(limited, cwd=run.folder, capture_output=True, check=False, timeout=60)
    equal(done.returncode, NO, done.stderr.decode())
    equal([(e["status"], e["exit"]) for e in report(run)], [("ok", 0), ("failed", 7), ("ok", 0)], done.stderr.decode())
    check("memory" in report(run)[1]["error"], report(run)[1]["error"])
    run.check_no_leftovers()


main()
