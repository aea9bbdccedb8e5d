#!/usr/bin/env python3
"""What machines and clusters give a process, and what once went past it (ops-*). The inputs are made here.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_ops.py ops_05_threads_and_workers_follow_affinity
"""

import json
import os
import subprocess

from harness import FFD, case, equal, lattice, main


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


main()
