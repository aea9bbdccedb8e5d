#!/usr/bin/env python3
"""ffd batch and its streams: manifests that come bit by bit, a terminal, pipes that break, full devices."""

import json
import os
import re
import signal
import subprocess
import time

from batches import batch, case, check, equal, job, lines_of, main, start
from harness import FFD, INVALID, IO, NO, OK, SANITIZED, SECONDS, on_terminal


def wait_for(run, name):
    limit = time.monotonic() + 15
    while not run.exists(name) and time.monotonic() < limit:
        time.sleep(0.002)
    return run.exists(name)


@case
def a_manifest_is_streamed(run):
    """A job is done while the lines after it have not been written yet."""
    start(run)
    process = subprocess.Popen([FFD, "batch", "-", "-j", "2"], cwd=run.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    for i in range(5):
        line = (json.dumps(job(i)) + "\n").encode()
        process.stdin.write(line[:20])
        process.stdin.flush()
        process.stdin.write(line[20:])
        process.stdin.flush()
        if not wait_for(run, f"o{i}.obj"):
            process.kill()
            process.communicate()
            raise AssertionError(f"o{i}.obj does not come")
    process.stdin.write(json.dumps(job(5)).encode())  # without a line's end
    said = process.communicate(timeout=SECONDS)[1].decode()
    equal(process.returncode, OK, said)
    check(said.startswith("ffd: 6 jobs in "), said)
    check(run.exists("o5.obj"), "the last line was not done")


@case
def a_line_without_an_end_ends_the_run(run):
    """Of a manifest and of a table, on standard input and in a file."""
    start(run)
    endless = b"x" * ((1 << 26) + (1 << 21))
    run.write("m.jsonl", lines_of([job(0)]).encode() + endless)
    run.write("t.csv", b"H\n" + endless)
    run.ffd("batch", "-", stdin=b"\n" + endless, code=INVALID, err=ends_with("standard input:2: the line does not end within 67108864 bytes"))
    run.ffd("batch", "m.jsonl", code=INVALID, err=ends_with("m.jsonl:2: the line does not end within 67108864 bytes"))
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "l.json", "--out-dir", ".", code=INVALID,
            err=ends_with("t.csv:2: the line does not end within 67108864 bytes"))


def ends_with(line):
    """What is said, after the figures of a run that has begun."""
    return lambda said: equal(said[-1], line)


@case
def folders_pipes_and_devices_are_refused_as_other_inputs_are(run):
    start(run)
    os.mkfifo(run.path("pipe"))
    for name, what in (("pipe", "is a pipe, not a file (- reads standard input)"), (".", "is a folder"),
                       ("/dev/zero", "is a device, not a file (- reads standard input)")):
        run.ffd("batch", name, code=IO, err=f"{name}: {what}")
        run.ffd("batch", "--csv", name, "--in", "a.obj", "-l", "l.json", "--out-dir", ".", code=IO, err=f"{name}: {what}")
    run.ffd("batch", "none.jsonl", code=IO, err="none.jsonl: cannot be opened: No such file or directory")
    run.ffd("batch", "/dev/null", err=lambda said: None)


@case
def an_interrupt_while_waiting_for_lines(run):
    start(run)
    process = subprocess.Popen([FFD, "batch", "-", "--report", "r.json"], cwd=run.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdin.write(lines_of([job(0)]).encode())
    process.stdin.flush()
    wait_for(run, "o0.obj")
    process.send_signal(signal.SIGINT)
    try:
        process.wait(timeout=20)
    finally:
        process.kill()
        process.communicate()
    equal([entry["output"] for entry in json.loads(run.read("r.json"))["jobs"]], ["o0.obj"])


@case
def a_terminal_has_a_bar(run):
    count = 1500  # more than are read ahead: there is something left
    while True:  # until there are enough jobs for a run that shows several bars
        start(run, [job(i) for i in range(count)])
        begun = time.monotonic()
        shown = on_terminal(run, "batch", "m.jsonl", "-j", "2", "--force")
        if time.monotonic() - begun > 0.4:
            break
        count *= 2
    check(re.search(r"\[#*\.*\] \d+ jobs, 0 failed, \d+/s, .* left", shown), "no bar:", shown[:300])
    check(shown.split("\r")[-2].endswith("failed") or shown.rstrip().endswith("0 failed"), "the summary is not the last:", shown[-300:])
    few = count // (20 if SANITIZED else 3)  # still several times as long as a bar waits for
    run.write("m.jsonl", lines_of([job(i) for i in range(few)]))
    quiet = on_terminal(run, "batch", "m.jsonl", "-j", "2", "-q", "--force")
    equal(quiet, "", "--quiet on a terminal")
    # None if the output is not a terminal.
    done = batch(run, "m.jsonl", "--force", done=few)
    check(not any("\r" in line or "[#" in line for line in done.err), done.err)


@case
def a_pipe_that_breaks(run):
    start(run, [job(i) for i in range(20000)])
    process = subprocess.Popen([FFD, "batch", "m.jsonl", "--dry-run"], cwd=run.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    equal(process.stdout.readline(), b"to do: a.obj -> o0.obj\n")
    process.stdout.close()
    said = process.stderr.read().decode()
    process.stderr.close()
    check(process.wait() not in (OK, -signal.SIGSEGV, -signal.SIGABRT), process.returncode)
    equal(said, "", "a broken pipe is not reported")


@case
def a_full_stream_ends_a_batch_with_exit_3(run):
    start(run, [job(i) for i in range(3)])
    with open("/dev/full", "wb") as full:
        for arguments in (["--dry-run"], ["--report", "-"]):
            done = run.ffd("batch", "m.jsonl", "--force", *arguments, code=IO, stdout=full, err=lambda said: None)
            check(any(line.startswith("standard output: ") for line in done.err), arguments, done.err)


@case
def two_at_once(run):
    """Two batches of the same jobs at the same time leave whole files, whichever comes first."""
    start(run, [job(i) for i in range(100)])
    for options in (["--force"], ["--resume"]):
        both = [subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", *options], cwd=run.folder, stderr=subprocess.PIPE) for _ in range(2)]
        for process in both:
            said = process.communicate(timeout=SECONDS)[1].decode()
            failed = [line for line in said.splitlines() if not re.match(r"ffd: m\.jsonl:\d+: o\d+\.obj: is being written|ffd: 100 jobs", line)]
            equal(failed, [], "failures but those of files that the other one writes just now")
            check(process.returncode in (OK, NO), process.returncode, said)
        run.ffd("deform", "a.obj", "single.obj", "-l", "l.json", "--force")
        for i in range(100):
            equal(run.read(f"o{i}.obj"), run.read("single.obj"), f"o{i}.obj")
        run.check_no_leftovers()
    run.ffd("batch", "m.jsonl", "--resume", "-q")
    batch(run, "m.jsonl", "--resume", kept=100)


main()
