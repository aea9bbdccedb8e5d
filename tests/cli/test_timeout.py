#!/usr/bin/env python3
"""Jobs that take long: the warning of a slow lattice, and --timeout."""
import os
import random
import re
import subprocess
import time

from harness import FFD, LIMIT, NO, SANITIZED, SECONDS, USAGE, case, check, equal, lattice, main, wait_until
from messages import anything, entry, no_line, one_line

ENDED = r"took longer than 0\.2 seconds \(--timeout\)"


def slow(run, name="slow.json"):
    """A sheet 1e-12 thick whose control points are thrown about: a vertex of it takes some 25 ms. With
    sanitizers a smaller one is slow enough."""
    draw = random.Random(5)
    count, degree = (5, 3) if SANITIZED else (10, 7)
    points = [[i / (count - 1) + draw.uniform(-2, 2), j / (count - 1) + draw.uniform(-2, 2),
               0.5 + 1e-12 * (k / (count - 1) - 0.5 + draw.uniform(-2, 2))]
              for k in range(count) for j in range(count) for i in range(count)]
    run.write(name, lattice(size=[count] * 3, degree=[degree] * 3, rest={"points": points}, moves=[{"by": [0, 0, 0.1]}]))
    return name


def sheet(run, name, rows, columns):
    """A grid of rows x columns vertices in the middle of the slow lattice."""
    run.write(name, "".join(f"v {0.1 + 0.8 * i / rows} {0.1 + 0.8 * j / columns} 0.5\n" for i in range(rows) for j in range(columns))
              + "".join(f"f {a} {a + 1} {a + columns + 1} {a + columns}\n" for i in range(rows - 1)
                        for a in range(i * columns + 1, (i + 1) * columns)))
    return name


@case
def a_slow_lattice_is_told_once_with_the_time_that_all_vertices_take(run):
    slow(run)
    sheet(run, "a.obj", 2, 55)
    done = run.ffd("embed", "a.obj", "-l", "slow.json", "-o", "a.npy", err=anything)
    lines = [line for line in done.err if "folds at rest" in line]
    equal(len(lines), 1, f"lines of {done.err}")
    found = re.search(r"^a\.obj: the search for 100 vertices in the lattice slow\.json took ([\d.]+) seconds, because it folds at "
                      r"rest or has steep weights; all vertices may take about (\d+) seconds$", lines[0])
    check(found, lines[0])
    first, whole = map(float, found.groups())
    check(first >= 1, "a word about", first, "seconds")
    check(abs(whole - 1.1 * first) <= 0.5 + 0.01 * first, f"{whole} seconds, where 100 of 110 took {first}")


@case
def a_lattice_that_is_not_slow_is_not_told(run):
    run.write("l.json", lattice(rest={"points": [[i / 3, j / 3 + 0.1 * i, k / 3 + 0.05 * i * j] for k in range(4)
                                                 for j in range(4) for i in range(4)]}, moves=[{"by": [0, 0, 0.1]}]))
    sheet(run, "a.obj", 20, 20)
    no_line(run.ffd("deform", "a.obj", "out.obj", "-l", "l.json", err=anything), "vertices may take")


@case
def a_job_that_takes_longer_ends_and_writes_nothing(run):
    slow(run)
    sheet(run, "a.obj", 60, 60)
    run.write("old.obj", "v 1 2 3\n")
    run.write("old.npz", "old")
    for arguments in (["deform", "a.obj", "new.obj"], ["deform", "a.obj", "old.obj", "--force"], ["check", "a.obj"],
                      ["check", "a.obj", "--fail-on", "edges=1,tear"], ["deform", "a.obj", "new.obj", "-j1", "--outside", "extend"],
                      ["deform", "a.obj", "new.obj", "--blocks", "-l", "slow.json"], ["deform", "a.obj", "new.glb", "--as-morph", "m"],
                      ["jacobian", "a.obj", "-o", "new.npz"], ["jacobian", "a.obj", "-o", "old.npz", "--force"],
                      ["view", "a.obj", "-o", "new.html"]):
        begin = time.monotonic()
        run.ffd(*arguments, "-l", "slow.json", "--timeout", "0.2", code=LIMIT, err=re.compile(f"^a.obj: {ENDED}$"))
        # All of it would take 90 s and more.
        check(time.monotonic() - begin < 15, arguments, "took", time.monotonic() - begin)
    equal(run.names(), ["a.obj", "old.npz", "old.obj", "slow.json"])
    equal((run.text("old.obj"), run.text("old.npz")), ("v 1 2 3\n", "old"))


@case
def the_report_tells_of_a_job_that_took_longer(run):
    slow(run)
    sheet(run, "a.obj", 60, 60)
    job = entry(run, "check", "a.obj", "-l", "slow.json", "--timeout", "0.2", code=LIMIT)
    equal(job["exit"], LIMIT)
    check(re.search(ENDED, job["error"]["message"] if isinstance(job["error"], dict) else job["error"]), job)


@case
def each_of_several_meshes_has_the_time(run):
    slow(run)
    run.write("quick.obj", "v 0 0 10\nv 1 0 10\nv 0 1 10\nf 1 2 3\n")
    sheet(run, "slow.obj", 60, 60)
    run.folder_of("out")
    done = run.ffd("deform", "slow.obj", "quick.obj", "--out-dir", "out", "-l", "slow.json", "--timeout", "0.5", code=NO, err=anything)
    one_line(done, r"^slow\.obj: took longer than 0\.5 seconds")
    equal(run.names("out"), ["quick.obj"])


@case
def a_job_of_few_vertices_in_a_large_lattice_ends_too(run):
    """Reading the lattice and the proof of folds take the time, not the search."""
    draw = random.Random(1)
    points = [[i / 39 + draw.uniform(-0.1, 0.1), j / 39 + draw.uniform(-0.1, 0.1), k / 39 + draw.uniform(-0.1, 0.1)]
              for k in range(40) for j in range(40) for i in range(40)]
    run.write("l.json", lattice(size=[40] * 3, moves=[{"by": [0, 0, 0.1]}], deformed={"points": points}))
    sheet(run, "a.obj", 2, 2)
    run.ffd("check", "a.obj", "-l", "l.json", "--timeout", "0.2", code=LIMIT, err=re.compile(f"^a.obj: {ENDED}$"))


@case
def enough_time_changes_nothing(run):
    run.write("l.json", lattice(moves=[{"twist": {"axis": "z", "degrees": 20}}]))
    sheet(run, "a.obj", 40, 40)
    run.ffd("deform", "a.obj", "one.obj", "-l", "l.json")
    run.ffd("deform", "a.obj", "two.obj", "-l", "l.json", "--timeout", "1e4")
    equal(run.read("two.obj"), run.read("one.obj"))
    for name, more in (("one.npz", []), ("two.npz", ["--timeout", "1e4"])):
        run.ffd("jacobian", "a.obj", "-o", name, "-l", "l.json", *more, data=True)
    equal(run.read("two.npz"), run.read("one.npz"))


@case
def standard_input_that_does_not_end_is_not_waited_for(run):
    run.write("l.json", lattice(moves=[{"by": [0, 0, 0.1]}]))
    read, write = os.pipe()
    try:
        os.write(write, b"v 1 2 3\n")
        done = subprocess.run([FFD, "deform", "-", "out.obj", "--input-format", "obj", "-l", "l.json", "--timeout", "0.2"],
                              cwd=run.folder, stdin=read, capture_output=True, text=True, timeout=SECONDS, check=False)
    finally:
        os.close(read)
        os.close(write)
    equal(done.returncode, LIMIT, done.stderr)
    check(re.search(f"^ffd: .*{ENDED}\n$", done.stderr), done.stderr)
    equal(run.names(), ["l.json"])


@case
def a_pipe_to_which_nobody_writes_is_not_waited_for(run):
    """By a name of standard input, which is opened anew. One that somebody has written to, or writes to later, is read to its end."""
    run.write("l.json", lattice(moves=[{"by": [0, 0, 0.1]}]))
    os.mkfifo(run.path("pipe"))

    def write():
        with open(run.path("pipe"), "w", encoding="ascii") as pipe:
            pipe.write("v 1 2 3\n")
    for writes in ("never", "before", "later"):
        read = os.open(run.path("pipe"), os.O_RDONLY | os.O_NONBLOCK)
        if writes == "before":
            write()
        job = subprocess.Popen([FFD, "deform", "/dev/stdin", "out.obj", "--force", "--input-format", "obj", "-l", "l.json",
                                "--timeout", "0.2" if writes == "never" else "600"],
                               cwd=run.folder, stdin=read, stderr=subprocess.PIPE, text=True)
        try:
            os.close(read)
            if writes == "later":
                write()
            _, said = job.communicate(timeout=SECONDS)
        finally:
            job.kill()
        equal(job.returncode, LIMIT if writes == "never" else 0, said)
        check(writes != "never" or re.search(f"^ffd: .*{ENDED}\n$", said), said)
        check(writes == "never" or run.text("out.obj").startswith("v 1 2 "), writes)


@case
def standard_input_that_does_not_wait_is_waited_for(run):
    """A pipe whose descriptor does not block, as some programs hand it on, with a deadline and without."""
    def sleeps(process):
        with open(f"/proc/{process}/stat", encoding="ascii") as stat:
            return stat.read().rpartition(") ")[2].startswith("S")
    run.write("l.json", lattice(moves=[{"by": [0, 0, 0.1]}]))
    for more in ([], ["--timeout", "600"]):
        read, write = os.pipe()
        os.set_blocking(read, False)
        job = subprocess.Popen([FFD, "deform", "-", "out.obj", "--force", "--input-format", "obj", "-l", "l.json", *more],
                               cwd=run.folder, stdin=read, stderr=subprocess.PIPE, text=True)
        os.close(read)
        with open(write, "w", encoding="ascii") as pipe:
            wait_until(lambda: job.poll() is not None or sleeps(job.pid), "it neither waits nor ends")
            pipe.write("v 1 2 3\n")
        _, said = job.communicate(timeout=SECONDS)
        equal((job.returncode, run.exists("out.obj")), (0, True), said)


@case
def a_time_is_more_than_nothing(run):
    run.write("l.json", lattice())
    sheet(run, "a.obj", 2, 2)
    for command in (["deform", "a.obj", "out.obj"], ["check", "a.obj"], ["jacobian", "a.obj", "-o", "j.npz"]):
        for value in ("0", "-1", "nan", "x", ""):
            run.ffd(*command, "-l", "l.json", "--timeout", value, code=USAGE)
    run.ffd("embed", "a.obj", "-o", "u.npy", "-l", "l.json", "--timeout", "3", code=USAGE)


@case
def a_job_of_a_manifest_has_no_time_of_its_own(run):
    run.write("l.json", lattice())
    sheet(run, "a.obj", 2, 2)
    run.write("m.jsonl", '{"in": "a.obj", "out": "b.obj", "lattice": "l.json", "timeout": 3}\n')
    one_line(run.ffd("batch", "m.jsonl", code=NO, err=anything), r'^m\.jsonl:1: unknown key "timeout"')
    check(not run.exists("b.obj"), "b.obj")


main()
