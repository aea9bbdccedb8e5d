#!/usr/bin/env python3
"""A batch of very many jobs takes no more memory than one of some, but for 19 bytes of a job's output and 24 of its entry
in the report, and no more time for each: a dry run of them all from a pipe, and a real run of some with the report and
the journal.

    test_million.py FFD [JOBS REAL-JOBS]       default: as few as show a leak of four bytes a job, or a time for each
                                               that grows by half a nanosecond with each job before it"""

import concurrent.futures
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import threading
import time

FFD = os.path.abspath(sys.argv[1])
os.environ["FFD"] = FFD
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from harness import CUBE, check, equal, lattice  # noqa: E402

FEW, FEW_REAL = 5000, 2000
MANY, REAL = map(int, sys.argv[2:4]) if len(sys.argv) > 2 else (150000, 8000)
SECONDS = 800
# Bytes that the larger batch may take more: what one run takes more than the next is no more than 0.4 MB. A real job
# may leave 100 bytes of a part of its path.
MORE, MORE_REAL = 5e5, 6e5
WAITING = 256 * 1000  # of jobs that wait in a resumed run: the figures of the run before
TRIALS = 3  # a leak is there each time, other work on the machine is not
# Of the first process, for what it knows of a job that has ended: an entry of 16 bytes, and up to 3.5 for the slots of the
# table's recent ones, old and new where it grows.
EACH, EACH_REAL = 19, 19 + 24


def feed(pipe, jobs):
    with pipe:
        for i in range(jobs):
            pipe.write(line(i))


def line(i):
    return b'{"in": "a.obj", "lattice": "l.json", "out": "out/%d.obj"}\n' % i


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
    """If standard error is not a terminal there is a line every ten seconds, and one at the end."""
    lines = said.decode().splitlines()
    check(lines and re.fullmatch(rf"ffd: {jobs} jobs in .*, 0 failed", lines[-1]), "the last line:", lines[-1:])
    check(all(re.fullmatch(r"ffd: \d+ jobs, 0 failed, [\d.]+/s", line) for line in lines[:-1]), lines[:-1])
    check(seconds / 10 - 2 < len(lines) - 1 <= seconds / 10, len(lines) - 1, "lines in", seconds, "seconds")


def run(folder, jobs, *arguments, count=None):
    """Runs a batch, and returns the peaks of its first process and of the largest of its workers, and the seconds of
    the processor that it took."""
    begun, used = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    said = open(os.path.join(folder, "..", os.path.basename(folder) + ".said"), "w+b")
    process = subprocess.Popen([FFD, "batch", "-", *arguments], cwd=folder, stdin=subprocess.PIPE,
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
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    return most, largest, now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime


def compare(what, few, measure, more, known):
    """Measures the larger batch until it takes no more than it may, and returns what it took."""
    for _ in range(TRIALS):
        many = measure()
        print(f"{what}: {few[0] / 1e6:.2f} and {many[0] / 1e6:.2f} MB; workers {few[1] / 1e6:.2f} and {many[1] / 1e6:.2f} MB", flush=True)
        if many[0] < few[0] + more + known and many[1] < few[1] + more:
            break
    check(few[0] > 0 and many[0] < few[0] + more + known and many[1] < few[1] + more, f"{what}: more jobs take more memory")
    return many


def lines_come(folder):
    """Of a batch whose jobs come slowly: if standard error is not a terminal, a line after ten seconds."""
    begun = time.monotonic()
    path = os.path.join(folder, "..", "slow.said")
    with open(path, "w+b") as said, subprocess.Popen(
            [FFD, "batch", "-", "-j", "1", "--dry-run", "--force"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
            stderr=said, bufsize=0, env={**os.environ, "XDG_CACHE_HOME": os.path.join(folder, "cache")}) as process:
        jobs = 0
        with process.stdin:
            while os.path.getsize(path) == 0 and time.monotonic() < begun + 60:
                process.stdin.write(line(jobs))
                jobs += 1
                time.sleep(0.05)
        equal(process.wait(), 0)
        seconds = time.monotonic() - begun
        said.seek(0)
        content = said.read()
    os.remove(path)
    check(content.count(b"\n") >= 2, "no line while it ran, only:", content)
    check_lines(content, jobs, seconds)


def main():
    with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
        with open(os.path.join(folder, "a.obj"), "w", encoding="ascii") as file:
            file.write(CUBE)
        with open(os.path.join(folder, "l.json"), "w", encoding="ascii") as file:
            json.dump(lattice(moves=[{"by": [1, 0, 0]}]), file)
        os.mkdir(os.path.join(folder, "out"))
        # One worker: of several, jobs that end before an earlier one wait to be told, more or fewer of them.
        few = run(folder, FEW, "--dry-run", "-j1", count=FEW)
        many = compare("dry runs", few, lambda: run(folder, MANY, "--dry-run", "-j1", count=MANY), MORE, EACH * MANY)
        print(f"microseconds of a job: {few[2] / FEW * 1e6:.1f} and {many[2] / MANY * 1e6:.1f}", flush=True)
        check(many[2] / MANY < 2 * few[2] / FEW, "each of more jobs takes longer")
        equal(sorted(os.listdir(folder)), ["a.obj", "l.json", "out"], "a dry run wrote")
        with concurrent.futures.ThreadPoolExecutor() as pool:
            lines = pool.submit(lines_come, folder)
            few = run(folder, FEW_REAL, "-j2", "--force", "--report", "r.json")
            compare("runs", few, lambda: run(folder, REAL, "-j2", "--force", "--report", "r.json"), MORE_REAL, EACH_REAL * REAL)
            lines.result()
        equal(len(os.listdir(os.path.join(folder, "out"))), REAL)
        compare("resumed runs", few, lambda: run(folder, REAL, "-j2", "--resume", "--report", "r.json"), MORE_REAL + WAITING,
                EACH_REAL * REAL)
        with open(os.path.join(folder, "r.json"), encoding="utf-8") as file:
            equal([job["status"] for job in json.load(file)["jobs"]], ["skipped"] * REAL)
    print("4 cases, 0 failed")


main()
