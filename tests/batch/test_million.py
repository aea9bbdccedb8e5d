#!/usr/bin/env python3
"""A batch of a million jobs takes no more memory than one of a thousand: a dry run of them all from a pipe, and a
real run of some with the report and the journal.

    test_million.py FFD"""

import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time

FFD = os.path.abspath(sys.argv[1])
os.environ["FFD"] = FFD
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from harness import CUBE, check, equal, lattice  # noqa: E402

MILLION, THOUSAND, SOME = 1000000, 1000, 20000
SECONDS = 800
MORE = 1e6  # that the larger batch may take


def feed(pipe, jobs):
    with pipe:
        for i in range(jobs):
            pipe.write(b'{"in": "a.obj", "lattice": "l.json", "out": "out/%d.obj"}\n' % i)


def peak_of(pid):
    """The most memory that a process has had so far, in bytes; 0 where it has ended."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii") as file:
            found = re.search(r"VmHWM:\s*(\d+) kB", file.read())
    except OSError:
        found = None
    return int(found[1]) * 1024 if found else 0


def children(pid):
    try:
        with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
            return [int(word) for word in file.read().split()]
    except OSError:
        return []


def check_lines(said, jobs, seconds):
    """Where standard error is no terminal there is a line every ten seconds, and one at the end."""
    lines = said.decode().splitlines()
    check(lines and re.fullmatch(rf"ffd: {jobs} jobs in .*, 0 failed", lines[-1]), "the last line:", lines[-1:])
    check(all(re.fullmatch(r"ffd: \d+ jobs, 0 failed, [\d.]+/s", line) for line in lines[:-1]), lines[:-1])
    check(seconds / 10 - 2 < len(lines) - 1 <= seconds / 10, len(lines) - 1, "lines in", seconds, "seconds")


def run(folder, jobs, *arguments, count=None):
    """Runs a batch, and returns the peaks of its first process and of the largest of its workers."""
    begun = time.monotonic()
    said = open(os.path.join(folder, "..", os.path.basename(folder) + ".said"), "w+b")
    process = subprocess.Popen([FFD, "batch", "-", "-j", "2", *arguments], cwd=folder, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, stderr=said, env={**os.environ, "XDG_CACHE_HOME": os.path.join(folder, "cache")})
    feeder = threading.Thread(target=feed, args=(process.stdin, jobs))
    feeder.start()
    lines = [0]

    def read():
        for block in iter(lambda: process.stdout.read(1 << 20), b""):
            lines[0] += block.count(b"\n")

    reader = threading.Thread(target=read)
    reader.start()
    most = largest = 0
    while process.poll() is None:
        most = max(most, peak_of(process.pid))
        largest = max([largest] + [peak_of(child) for child in children(process.pid)])
        time.sleep(0.01)
    feeder.join(SECONDS)
    reader.join(SECONDS)
    seconds = time.monotonic() - begun
    equal(process.returncode, 0)
    with said:
        said.seek(0)
        check_lines(said.read(), jobs, seconds)
    os.remove(said.name)
    if count is not None:
        equal(lines[0], count, "lines of the dry run")
    return most, largest


def compare(what, few, many):
    print(f"{what}: {few[0] / 1e6:.1f} and {many[0] / 1e6:.1f} MB; workers {few[1] / 1e6:.1f} and {many[1] / 1e6:.1f} MB", flush=True)
    check(few[0] > 0 and many[0] < few[0] + MORE and many[1] < few[1] + 4 * MORE, f"{what}: more jobs take more memory")


def main():
    with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
        with open(os.path.join(folder, "a.obj"), "w", encoding="ascii") as file:
            file.write(CUBE)
        with open(os.path.join(folder, "l.json"), "w", encoding="ascii") as file:
            json.dump(lattice(moves=[{"by": [1, 0, 0]}]), file)
        os.mkdir(os.path.join(folder, "out"))
        compare("dry runs", run(folder, THOUSAND, "--dry-run", count=THOUSAND), run(folder, MILLION, "--dry-run", count=MILLION))
        equal(sorted(os.listdir(folder)), ["a.obj", "l.json", "out"], "a dry run wrote")
        few = run(folder, THOUSAND, "--force", "--report", "r.json")
        compare("runs", few, run(folder, SOME, "--force", "--report", "r.json"))
        equal(len(os.listdir(os.path.join(folder, "out"))), SOME)
        compare("resumed runs", few, run(folder, SOME, "--resume", "--report", "r.json"))
        with open(os.path.join(folder, "r.json"), encoding="utf-8") as file:
            equal([job["status"] for job in json.load(file)["jobs"]], ["skipped"] * SOME)
    print("3 cases, 0 failed")


main()
