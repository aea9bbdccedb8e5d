#!/usr/bin/env python3
"""SIGINT and SIGTERM end every command within a second, whatever it is at, and leave nothing half written. In a batch
running jobs get a part of that second to finish: test_batch_signals.py."""

import json
import os
import random
import signal
import subprocess
import time

from harness import FFD, NO, SANITIZED, SECONDS, case, check, equal, lattice, main

LIMIT = 5 if SANITIZED else 1
MIDST = 0.3 if SANITIZED else 0.15  # seconds from the start of a command to the signal
POINTS = 40000000  # of a mesh that takes longer to read than the signal to come
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def start(run):
    """Large files that take no room on the disk, and lattices."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    head = (b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
              b"end_header\n" % POINTS)
    for name in ("big.ply", "other.ply"):
        run.write(name, head)
        os.truncate(run.path(name), len(head) + 12 * POINTS)
    run.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    run.write("l.json", lattice(moves=[{"twist": {"axis": "z", "degrees": 40}}]))
    bent = [[x + 0.1 * y * y, y - 0.05 * x * z, z] for z in (-2, 0, 2) for y in (-2, 0, 2) for x in (-2, 0, 2)]
    run.write("bent.json", lattice(size=(3, 3, 3), rest={"points": bent}, moves=[{"by": [1, 0, 0]}]))


def heed_all():
    """A shell that is not interactive has its background jobs ignore SIGINT, which they hand on."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def interrupted(run, number, *words):
    """Sends a command a signal in its midst; returns its exit code and how long it took to end."""
    process = subprocess.Popen([FFD, *words], cwd=run.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               preexec_fn=heed_all)
    time.sleep(MIDST)
    check(process.poll() is None, f"{words}: it ended before the signal came")
    begun = time.monotonic()
    process.send_signal(number)
    process.communicate(timeout=SECONDS)
    return process.returncode, time.monotonic() - begun


def ends(run, *words, out=(), codes=None):
    """Twice, since a machine that is busy may take its time."""
    for number in SIGNALS:
        for attempt in range(3):
            code, seconds = interrupted(run, number, *words)
            check(code in (codes or (-number,)), f"{words}: exit {code} after signal {number}")
            check(not any(run.exists(name) for name in out), f"{words}: {out} was written")
            run.check_no_leftovers()
            if run.exists("r.json"):
                json.loads(run.text("r.json"))  # a report is whole after any end but a kill
            if seconds < LIMIT:
                break
        else:
            check(False, f"{words}: took {seconds:.1f} s to end after signal {number}")


@case
def a_signal_ends_a_deformation_and_leaves_nothing(run):
    start(run)
    ends(run, "deform", "big.ply", "o.ply", "-l", "l.json", "--report", "r.json", out=["o.ply"])
    ends(run, "deform", "big.ply", "o.obj", "-l", "bent.json", out=["o.obj"])


@case
def a_signal_ends_a_view_and_leaves_nothing(run):
    start(run)
    ends(run, "view", "big.ply", "-l", "l.json", "-o", "p.html", out=["p.html"])
    ends(run, "view", "big.ply", "other.ply", "-o", "p.html", out=["p.html"])


@case
def a_signal_ends_an_embedding_and_leaves_nothing(run):
    start(run)
    ends(run, "embed", "big.ply", "-l", "bent.json", "-o", "e.npy", "--status", "s.npy", out=["e.npy", "s.npy"])


@case
def a_signal_ends_a_check(run):
    start(run)
    ends(run, "check", "big.ply", "-l", "l.json", "--report", "r.json")
    draw, n = random.Random(3), 30
    points = [[i + 0.4 * draw.random() for i in (i, j, k)] for k in range(n) for j in range(n) for i in range(n)]
    run.write("rough.json", lattice(size=(n, n, n), degree=[7, 7, 7], rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
                                    deformed={"points": points}))
    ends(run, "check", "a.obj", "-l", "rough.json", "-j", "1")


@case
def a_signal_ends_a_description_and_a_comparison(run):
    start(run)
    ends(run, "info", "big.ply")
    ends(run, "compare", "big.ply", "other.ply")
    ends(run, "lattice", "new", "big.ply", "-o", "n.json", out=["n.json"])


@case
def patterns_of_a_box_that_all_share(run):
    """Folders without an end: they are looked through while signals are watched for."""
    start(run)
    run.folder_of("deep")
    for n in range(20):
        os.symlink(".", run.path(f"deep/{n}"))
    ends(run, "batch", "--in", "deep" + "/*" * 12 + ".obj", "-l", "l.json", "--out-dir", ".", "--shared-box", codes=(NO,))


@case
def a_signal_ends_a_batch_and_leaves_nothing(run):
    start(run)
    run.write("m.jsonl", '{"in": "big.ply", "lattice": "bent.json", "out": "o.ply"}\n' * 3)
    for more in ([], ["--shared-box"], ["--report", "r.json", "--force"]):
        ends(run, "batch", "m.jsonl", *more, out=["o.ply"], codes=(NO,))
    # A journal that is as large as one may be.
    run.write("j", b"ffd-journal 2\n\0\0" + (1 << 26).to_bytes(8, "little") + bytes(40))
    os.truncate(run.path("j"), 64 + (96 << 26))
    ends(run, "batch", "m.jsonl", "--journal", "j", "--resume")
    equal(run.exists("o.ply"), False)


main()
