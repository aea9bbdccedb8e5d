"""What the tests of ffd batch have in common: manifests, the summary, reports."""

import json
import os
import re
import subprocess

from harness import CUBE, FFD, NO, OK, SANITIZED, case, check, equal, lattice, main  # noqa: F401 (handed on)

SUMMARY = re.compile(r"(\d+) jobs? in [\d.]+ s: (\d+) (done|to do), (\d+) up to date, (\d+) failed(.*)$")
# What stands before a message of a job: its line, and the values that it sets.
PLACE = re.compile(r"[\w./ -]+\.(?:jsonl|csv):\d+: (?:\w+=[^:]*: )?")
PROGRESS = re.compile(r"\d+ (?:jobs?|pictures?), \d+ failed, [\d.]+/s(, .* left)?$")  # a line every ten seconds
MOVE = [{"by": [0.5, 0.25, 0.125]}]


def job(number=0, **members):
    """A manifest's job on a.obj and l.json."""
    return {"in": "a.obj", "lattice": "l.json", "out": f"o{number}.obj", **members}


def lines_of(jobs):
    return "".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in jobs)


def start(run, jobs=()):
    """A mesh, a lattice, a cache of the run's own for journals, and the manifest m.jsonl."""
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=MOVE))
    run.write("m.jsonl", lines_of(jobs))


def batch(run, *arguments, done=0, kept=0, failed=(), more=None, code=None, **options):
    """Runs ffd batch and checks the summary and the lines before it: one for each failure, matched by the patterns
    in failed, in any order, with or without its place. more: what the summary must end with."""
    def matches(pattern, line):
        return re.search(pattern, line) or re.search(pattern, PLACE.sub("", line, count=1))

    def judge(said):
        check(said, "there is no summary")
        summary = SUMMARY.match(said[-1])
        check(summary, "no summary:", said)
        counts = [int(summary[i]) for i in (1, 2, 4, 5)]
        equal(counts, [done + kept + len(failed), done, kept, len(failed)], f"jobs, done, up to date, failed of {said}")
        rest = [line for line in said[:-1] if not SUMMARY.match(line) and not PROGRESS.match(line)]
        # Patterns that match many lines come last.
        if any(name.endswith((".jsonl", ".csv")) for name in arguments[:2]):
            equal([line for line in rest if not PLACE.match(line)], [], "lines that do not name their job")
        for pattern in sorted(failed, key=lambda pattern: sum(bool(matches(pattern, line)) for line in rest)):
            found = [line for line in rest if matches(pattern, line)]
            check(found, pattern, "is in none of", rest)
            rest.remove(found[0])
        equal(rest, [], "lines that say something else")
        check(not more or summary[6].endswith(more), summary[6], "is not", more)

    if code is None:
        code = NO if failed else OK
    return run.ffd("batch", *arguments, code=code, err=judge, **options)


def report(run, name="r.json"):
    """The jobs of a report, which must be valid."""
    content = json.loads(run.read(name))
    equal((content["format"], content["version"]), ("ffd-report", 1), name)
    for entry in content["jobs"]:
        check((entry["status"] == "failed") == (entry["error"] is not None) == (entry["exit"] != 0), name, entry)
    return content["jobs"]


def names(run):
    """The files of the folder without the journals' cache."""
    return [name for name in run.names() if name != "cache"]


def statuses(run, name="r.json"):
    return [entry["status"] for entry in report(run, name)]


def traced(run, calls, *arguments):
    """Runs ffd under strace and returns what it logs, or None where it may not trace."""
    if SANITIZED:
        return None  # leaks cannot be looked for then
    log = run.path("strace.log")
    done = subprocess.run(["strace", "-f", "-o", log, "-e", "trace=" + calls, FFD, *arguments],
                          cwd=run.folder, capture_output=True, check=False)
    if not os.path.exists(log) or "PTRACE" in done.stderr.decode():
        return None
    equal(done.returncode, 0, done.stderr.decode())
    with open(log, encoding="utf-8", errors="replace") as file:
        return file.read()


def opened(log, name):
    """How often a file was opened."""
    return sum(f'"{name}"' in line and "= -1" not in line for line in log.splitlines() if "open" in line)
