#!/usr/bin/env python3
"""Threads and workers are as many as the process may use: by its affinity and the limits of its cgroups.

A library that is loaded before all others (tests/support/machine_trap.c) shows the program a machine with any number of
processors and the cgroups that a case lays out, and counts its threads."""

import json
import os
import re
import sys

from batches import SUMMARY, job, lines_of, start
from harness import case, check, equal, lattice, main

TRAP = os.path.abspath(sys.argv.pop(1))
COUNTS = re.compile(r"(\d+) workers?: meshes read")
VERSION_2 = "30 24 0:26 / {folder}/cg rw - cgroup2 cgroup2 rw\n"
VERSION_1 = ("31 24 0:27 / {folder}/cg/cpu rw - cgroup cgroup rw,cpu\n"
             "32 24 0:28 /pod {folder}/cg/memory rw - cgroup cgroup rw,memory\n")


def lay_out(run, cgroup="0::/a\n", mountinfo=VERSION_2, files=()):
    """What /proc/self says, and the files of cgroups."""
    run.write("self/cgroup", cgroup)
    run.write("self/mountinfo", mountinfo.format(folder=run.folder))
    for name, text in dict(files).items():
        run.write("cg/" + name, text + "\n")


def seen(run, processors, *arguments):
    """Runs ffd on a machine of so many processors. Returns how many threads it has started, and its lines on stderr."""
    run.remove("threads")
    said = []
    env = {**os.environ, "LD_PRELOAD": TRAP, "FFD_TRAP_PROCESSORS": str(processors), "FFD_TRAP_SELF": run.path("self"),
           "FFD_TRAP_LOG": run.path("threads"), "MALLOC_PERTURB_": "0"}
    run.ffd(*arguments, "--force", err=said.extend, env=env)
    return (len(run.read("threads")) if run.exists("threads") else 0), said


def write_grid(run, n=160):
    run.write("grid.obj", "".join(f"v {i} {j} {i * j % 7}\n" for i in range(n) for j in range(n))
              + "".join(f"f {a} {a + 1} {a + n + 1} {a + n}\n" for i in range(n - 1) for a in range(i * n + 1, i * n + n)))
    run.write("l.json", lattice(low=(-1, -1, -1), high=(n, n, 7), moves=[{"by": [0.5, 0.25, 0.125]}]))


@case
def threads_are_as_many_as_affinity_and_quota_allow(run):
    write_grid(run)
    work = ["deform", "grid.obj", "out.obj", "-l", "l.json"]

    def started(processors, *more):
        threads, said = seen(run, processors, *work, *more)
        equal(said, [])
        return threads

    lay_out(run)
    by_number = [None, *(started(9, "--threads", str(n)) for n in range(1, 5))]
    check(0 == by_number[1] < by_number[2] < by_number[3] < by_number[4], by_number)
    equal([started(n) for n in range(1, 5)], by_number[1:], "by affinity")
    for cgroup, mountinfo, files, allowed in (
            ("0::/a\n", VERSION_2, {"a/cpu.max": "max 100000"}, 4),
            ("0::/a\n", VERSION_2, {"a/cpu.max": "200001 100000"}, 3),
            ("0::/a\n", VERSION_2, {"a/cpu.max": "max 100000", "cpu.max": "150000 100000"}, 2),
            ("0::/a\n", VERSION_2, {"a/cpu.max": "1000 100000", "cpu.max": "150000 100000"}, 1),
            ("0::/a\n", VERSION_2, {"a/cpu.max": "much 100000", "cpu.max": "-1"}, 4),
            ("0::/elsewhere\n", VERSION_2, {"cpu.max": "200000 100000"}, 2),
            ("2:cpu:/b\n0::/a\n", VERSION_1, {"cpu/b/cpu.cfs_quota_us": "90000", "cpu/b/cpu.cfs_period_us": "50000"}, 2)):
        lay_out(run, cgroup, mountinfo, files)
        equal(started(4), by_number[allowed], f"{allowed} threads of {files}")
    equal(started(1), 0, "more quota than affinity")
    equal(started(4, "-j", "3"), by_number[3], "what the user says")


@case
def workers_are_as_many_as_the_process_may_use(run):
    def workers(processors, *more):
        said = seen(run, processors, "batch", "m.jsonl", "-v", *more)[1]
        counts = [COUNTS.match(line) for line in said]
        others = [line for line in said if not COUNTS.match(line) and not SUMMARY.match(line)]
        return int(next(filter(None, counts))[1]), others

    def short(jobs, megabytes, name="a.obj", needed=100):
        return [f"m.jsonl: {jobs} job{'s' * (jobs > 1)} at a time on 4 processors: the cgroup allows {megabytes} MB of memory, "
                f"and {name} may take {needed} MB (--memory); -j sets the number"]

    start(run, [job(i) for i in range(8)])
    lay_out(run)
    equal([workers(n) for n in (1, 3, 4)], [(1, []), (3, []), (4, [])], "by affinity")
    lay_out(run, files={"a/cpu.max": "150000 100000"})
    equal(workers(4), (2, []), "by quota")
    equal(workers(4, "-j", "3"), (3, []), "what the user says")
    # A job on a mesh and a lattice of no size may take 100 MB.
    lay_out(run, files={"a/cpu.max": "max 100000", "a/memory.max": "max", "memory.max": "410000000"})
    equal(workers(4), (4, []), "memory for all")
    lay_out(run, files={"memory.max": "350000000"})
    equal(workers(4), (3, short(3, 350)))
    equal(workers(4, "--memory", "60M"), (3, short(3, 350)), "a budget is no less than its default")
    equal(workers(4, "--memory", "170M"), (2, short(2, 350, needed=170)))
    equal(seen(run, 4, "batch", "m.jsonl", "-q")[1], [])
    equal(workers(4, "-j", "4"), (4, []), "what the user says")
    equal(workers(2), (2, []), "memory for all")
    lay_out(run, files={"a/memory.max": "1"})
    equal(workers(4), (1, short(1, 0)), "one job always runs")
    lay_out(run, "4:memory:/pod/a\n", VERSION_1, {"memory/memory.limit_in_bytes": "250000000"})
    equal(workers(4), (2, short(2, 250)), "version 1")
    equal(workers(4, "--view", "v"), (1, short(1, 250, needed=400)), "pictures")


@case
def a_job_that_needs_more_memory_waits_for_the_others(run):
    """Sizes of files count too, and the job's own --memory."""
    start(run)
    run.write("big.obj", "v 0 0 0\n" + "# 456789012345678\n" * 500000)  # 9 MB
    run.write("big.json", json.dumps(lattice(moves=[{"by": [1, 0, 0]}])) + " " * 3000000)
    lay_out(run, files={"a/memory.max": "1050000000"})

    def shortage(*jobs):
        run.write("m.jsonl", lines_of(jobs))
        said = seen(run, 4, "batch", "m.jsonl")[1]
        check(re.match(rf"{len(jobs)} jobs in .* {len(jobs)} done", said[-1]), said)
        return re.match(r"m\.jsonl: (\d) jobs? at a time on 4 .* 1050 MB of memory, and (.*) may take (\d+) MB", said[0]).groups()
    small, large = {"memory": "101M"}, {"memory": "1G"}
    equal(shortage(job(0, options=small), job(1, options=small), job(2, options=large), job(3)), ("2", "a.obj", "1000"))
    equal(shortage(job(0, options=large), *(job(i) for i in range(1, 4))), ("1", "a.obj", "100"))
    big = {"in": "big.obj", "lattice": "big.json"}  # 100 MB and 20 times 9 and 3
    equal(shortage(*(job(i, **big) for i in range(4))), ("3", "big.obj", "340"))


@case
def a_large_job_has_the_memory_of_idle_workers(run):
    """Two small jobs run, then a large one alone, then four small ones: the second worker has ended, three new ones begin."""
    small, large = {"memory": "101M"}, {"memory": "1G"}
    start(run, [job(i, options=large if i == 2 else small) for i in range(7)])
    lay_out(run, files={"a/memory.max": "1050000000"})
    said = seen(run, 4, "batch", "m.jsonl", "-v")[1]
    equal([match[1] for match in map(COUNTS.match, said) if match], ["5"], said)


@case
def a_job_that_runs_alone_has_all_threads(run):
    write_grid(run)
    run.write("m.jsonl", lines_of(job(i, **{"in": "grid.obj"}) for i in range(4)))
    lay_out(run, files={"a/memory.max": "200000000"})
    alone = seen(run, 4, "batch", "m.jsonl")[0]
    equal(seen(run, 4, "batch", "m.jsonl", "-j", "1")[0], alone, "threads that were started")
    check(alone > 0, "no thread was started")


main()
