#!/usr/bin/env python3
"""Threads and workers are as many as the process may use: by its affinity and the limits of its cgroups.

A library that is loaded before all others (tests/support/machine_trap.c) shows the program a machine with any number of
processors and the cgroups that a case lays out, and counts its threads."""

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

    start(run, [job(i) for i in range(8)])
    lay_out(run)
    equal([workers(n) for n in (1, 3, 4)], [(1, []), (3, []), (4, [])], "by affinity")
    lay_out(run, files={"a/cpu.max": "150000 100000"})
    equal(workers(4), (2, []), "by quota")
    equal(workers(4, "-j", "3"), (3, []), "what the user says")


main()
