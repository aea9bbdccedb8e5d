#!/usr/bin/env python3
"""ffd batch and signals: running jobs get less than half a second to finish, no others are begun; no half file, a whole report."""

import os
import shutil
import signal
import subprocess
import time

from batches import batch, case, check, equal, job, main, report, start, statuses
from harness import CUBE, FFD, NO, SANITIZED, SECONDS, wait_until

JOBS = 200 if SANITIZED else 1000


def interrupted(run, number, made, *arguments, times=1):
    """Begins a batch, sends it a signal when so many outputs are there; returns its exit code and what it said."""
    process = subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", *arguments], cwd=run.folder, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True)
    wait_until(lambda: len(os.listdir(run.path("out"))) >= made or process.poll() is not None, "outputs do not come")
    check(process.poll() is None, "it ended before the signal came")
    for _ in range(times):
        process.send_signal(number)
        time.sleep(0.002)
    said = process.communicate(timeout=SECONDS)[1].decode()
    for line in said.splitlines():
        check(line.startswith("ffd: "), "not a message:", said)
    # Workers hold stderr, so that none is left when it is at its end.
    try:
        os.killpg(process.pid, 0)
        left = True
    except ProcessLookupError:
        left = False
    check(not left, "processes are left")
    return process.returncode, said


def begin(run):
    start(run, [job(i, **{"in": ["a.obj", "b.obj"][i // 10 % 2]}, out=f"out/{i}.obj") for i in range(JOBS)])
    run.write("b.obj", CUBE * 200)
    run.folder_of("out")
    for mesh in "ab":
        run.ffd("deform", mesh + ".obj", f"single-{mesh}.obj", "-l", "l.json")
    return [run.read(f"single-{mesh}.obj") for mesh in "ab"]


def judge(run, singles, code, number):
    """What a batch owes that was ended by a signal."""
    check(code in (NO, -number, 128 + number), f"exit {code} after signal {number}")
    run.check_no_leftovers()
    entries = report(run)
    lines = [e["line"] for e in entries]
    equal(lines, sorted(set(lines)), "lines of the report")
    made = {e["output"] for e in entries if e["status"] == "ok"}
    check(0 < len(made) < JOBS, len(made), "of", JOBS, "jobs were done")
    equal(sorted(os.listdir(run.path("out"))), sorted(name[len("out/"):] for name in made), "outputs and ok in the report")
    for name in made:
        equal(run.read(name) == singles[int(name[4:-4]) // 10 % 2], True, f"{name} is that of a single run")
    return entries


@case
def sigint_finishes_the_running_jobs(run):
    singles = begin(run)
    code, said = interrupted(run, signal.SIGINT, 20, "--report", "r.json")
    entries = judge(run, singles, code, signal.SIGINT)
    equal([e for e in entries if e["status"] == "failed"], [], "failed jobs")
    check("jobs in" in said or "job in" in said, "no summary:", said)
    # And can be gone on with.
    made = len(entries)
    batch(run, "m.jsonl", "--resume", "-j2", "--report", "r.json", done=JOBS - made, kept=made)
    equal(statuses(run).count("skipped"), made)


@case
def sigterm_stops_at_once(run):
    singles = begin(run)
    code, _ = interrupted(run, signal.SIGTERM, 20, "--report", "r.json")
    entries = judge(run, singles, code, signal.SIGTERM)
    check(len(entries) < JOBS, "all jobs are in the report")
    done = sum(e["status"] == "ok" for e in entries)
    batch(run, "m.jsonl", "--resume", "-j2", done=JOBS - done, kept=done)


@case
def no_signal_waits_for_a_long_job(run):
    for number in (signal.SIGINT, signal.SIGTERM):
        a_long_job(run, number)


def a_long_job(run, number):
    shutil.rmtree(run.path("out"), ignore_errors=True)
    start(run, [job(i, out=f"out/{i}.obj", **{"in": "large.obj" if i == 1 else "a.obj"}) for i in range(4)])
    run.write("large.obj", CUBE * 250000)
    run.folder_of("out")
    code, _ = interrupted(run, number, 1, "--report", "r.json")
    check(code in (NO, -number, 128 + number), f"exit {code}")
    run.check_no_leftovers()
    report(run)
    check("1.obj" not in os.listdir(run.path("out")), "the long job was waited for")


@case
def sigint_twice_does_not_wait(run):
    singles = begin(run)
    code, _ = interrupted(run, signal.SIGINT, 20, "--report", "r.json", times=2)
    judge(run, singles, code, signal.SIGINT)


@case
def a_terminal_s_interrupt_reaches_the_workers_too(run):
    """Control-C is sent to all processes of the terminal, and the running jobs are finished still."""
    singles = begin(run)
    process = subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", "--report", "r.json"], cwd=run.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    wait_until(lambda: len(os.listdir(run.path("out"))) >= 20 or process.poll() is not None, "outputs do not come")
    os.killpg(process.pid, signal.SIGINT)
    said = process.communicate(timeout=SECONDS)[1].decode()
    entries = judge(run, singles, process.returncode, signal.SIGINT)
    equal([e["error"] for e in entries if e["status"] == "failed"], [], said)


main()
