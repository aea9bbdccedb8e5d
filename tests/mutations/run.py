#!/usr/bin/env python3
"""Plants faults in src, one at a time, and tells which test catches each. It takes a while and is no part of CI.

    run.py --check CHECKOUT                                     does every mutation apply, exactly once?
    run.py CHECKOUT BUILD RESULTS [--only NAME]... [-j N]       runs them, appends to RESULTS (JSON, one a line)
    run.py --table BEFORE AFTER                                 a Markdown table of two results

CHECKOUT is a clone made for this: its sources are changed, and put back at the end of every mutation. BUILD is a build
folder of it, made once by `meson setup -Dwerror=true -Dtests=enabled -Dbuildtype=debugoptimized` and built once by
ninja: later only what a test says that it needs is. FFD_MODELS and FFD_NODE are those of tests/run.sh. A second run
goes on where the first one stopped: what RESULTS says to be caught is done.

The mutations are in mutations.py. Each is a piece of text that is found once in all of src, whatever file it is in and
however it is laid out, so the same table serves commits whose files have other names. Each names the tests that should
catch it, quick ones first: only what these need is built, they are run one by one, and the first that fails has caught
it. Such a test must pass without any mutation too, which is looked at once a test. A mutation that does not compile, or
that no test catches, is an error: exit status 1.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import time

from mutations import MUTATIONS

SUFFIXES = (".c", ".cpp", ".h", ".py")
SHOWN = 300  # characters of what a failing test says


class Source:
    """A file of src, with its text without blanks and where each character of that is in the file."""

    def __init__(self, root, path):
        self.path = path
        self.full = os.path.join(root, path)
        with open(self.full, encoding="utf-8") as file:
            self.text = file.read()
        self.places = [i for i, c in enumerate(self.text) if not c.isspace()]
        self.packed = "".join(self.text[i] for i in self.places)

    def finds(self, packed):
        at = self.packed.find(packed)
        while at >= 0:
            yield self.places[at], self.places[at + len(packed) - 1] + 1
            at = self.packed.find(packed, at + 1)

    def write(self, text):
        with open(self.full, "w", encoding="utf-8") as file:
            file.write(text)


def read_sources(checkout):
    paths = [os.path.relpath(os.path.join(folder, name), checkout)
             for folder, _, names in os.walk(os.path.join(checkout, "src")) for name in names
             if name.endswith(SUFFIXES)]
    return [Source(checkout, path) for path in sorted(paths)]


def pack(text):
    return "".join(text.split())


def locate(mutation, sources):
    """Returns (source, begin, end, replacement) of the first edit that fits once, or how often each of them fits."""
    counts = []
    for find, replace in mutation.edits:
        found = [(source, *place) for source in sources for place in source.finds(pack(find))]
        if len(found) == 1:
            return (*found[0], replace)
        counts.append(len(found))
    return counts


def check(checkout):
    sources = read_sources(checkout)
    failed = 0
    folders = {}
    names = set()
    for mutation in MUTATIONS:
        place = locate(mutation, sources)
        if mutation.name in names:
            print(f"{mutation.name}: a second mutation of this name")
            failed += 1
        names.add(mutation.name)
        if isinstance(place, list):
            print(f"{mutation.name}: its text is found {' and '.join(map(str, place))} times, not once")
            failed += 1
            continue
        source, begin, end, replace = place
        if pack(source.text[begin:end]) == pack(replace):
            print(f"{mutation.name}: changes nothing")
            failed += 1
        folder = os.path.dirname(source.path)
        folders[folder] = folders.get(folder, 0) + 1
        print(f"{mutation.name:32} {source.path}:{source.text.count(chr(10), 0, begin) + 1}")
    for folder, count in sorted(folders.items()):
        print(f"{count:4} {folder}")
    print(f"{len(MUTATIONS)} mutations, {failed} do not apply")
    return failed == 0


def introspect(build, what):
    run = subprocess.run(["meson", "introspect", build, "--" + what], capture_output=True, text=True, check=True)
    return json.loads(run.stdout)


class Builder:
    """Builds what tests need, and runs them, in a build folder."""

    def __init__(self, build, jobs):
        self.build = os.path.abspath(build)
        self.jobs = jobs
        subprocess.run(["ninja", "-C", self.build, "build.ninja"], stdout=subprocess.DEVNULL, check=True)
        self.tests = {test["name"]: test for test in introspect(build, "tests")}
        self.targets = {target["id"]: target["filename"] for target in introspect(build, "targets")}

    def tests_of(self, mutation):
        """The names of the mutation's tests that this commit has: "old name|new name" is either."""
        names = [name for entry in mutation.tests for name in entry.split("|") if name in self.tests]
        if not names:
            sys.exit(f"{mutation.name}: none of its tests is there: {', '.join(mutation.tests)}")
        return names

    def make(self, name):
        files = [os.path.relpath(file, self.build) for target in self.tests[name]["depends"]
                 for file in self.targets[target]]
        run = subprocess.run(["ninja", "-C", self.build, "-j", str(self.jobs), *files], capture_output=True, text=True,
                             check=False)
        return run.returncode == 0, run.stdout + run.stderr

    def run(self, name):
        """Whether the test passes, and what it says."""
        subprocess.run(["meson", "test", "-C", self.build, "--no-rebuild", "--logbase", "mutation", name],
                       capture_output=True, text=True, check=False)
        with open(os.path.join(self.build, "meson-logs", "mutation.json"), encoding="utf-8", errors="replace") as log:
            results = [json.loads(line) for line in log if line.strip()]
        if len(results) != 1 or results[0]["name"].rpartition(" / ")[2] != name:
            sys.exit(f"{name}: meson ran {len(results)} tests")
        return results[0]["result"] in ("OK", "SKIP"), results[0].get("stdout", "") + results[0].get("stderr", "")


def first_failure(said):
    """The first line that tells of a failure, of all that a test says."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    for mark in ("[  ERROR   ]", "FAILED", "FAIL", "Error", "rror:", "differ", "not "):
        for line in lines:
            if mark in line:
                return line[:SHOWN]
    return lines[-1][:SHOWN] if lines else ""


def find_catcher(builder, mutation):
    """Returns the test that catches the mutation that is in the sources, "BUILD" or None, and what it says."""
    for name in builder.tests_of(mutation):
        made, said = builder.make(name)
        if not made:
            errors = [line for line in said.splitlines() if "rror:" in line or "undefined reference" in line]
            return "BUILD", errors[0][:SHOWN] if errors else said[-SHOWN:]
        passed, said = builder.run(name)
        if not passed:
            return name, first_failure(said)
    return None, ""


def run_one(builder, checkout, mutation, sound):
    """sound: the tests that are known to pass without a mutation."""
    place = locate(mutation, read_sources(checkout))
    if isinstance(place, list):
        sys.exit(f"{mutation.name}: its text is found {place} times")
    source, begin, end, replace = place
    start = time.monotonic()
    try:
        source.write(source.text[:begin] + replace + source.text[end:])
        caught, said = find_catcher(builder, mutation)
    finally:
        source.write(source.text)
    seconds = time.monotonic() - start
    if caught and caught not in sound and caught != "BUILD":
        if not builder.make(caught)[0] or not builder.run(caught)[0]:
            sys.exit(f"{caught} fails without any mutation")
        sound.add(caught)
    return {"name": mutation.name, "kind": mutation.kind, "folder": os.path.dirname(source.path), "path": source.path,
            "caught": caught, "said": said, "seconds": round(seconds, 1)}


def read_results(path):
    """By name, of those of the table; of a mutation that ran several times the last."""
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        results = [json.loads(line) for line in file if line.strip()]
    names = {mutation.name for mutation in MUTATIONS}
    return {result["name"]: result for result in results if result["name"] in names}


def is_caught(result):
    return result["caught"] not in (None, "BUILD")


def run_all(arguments):
    checkout, build, path = arguments.paths
    changed = subprocess.run(["git", "-C", checkout, "status", "--porcelain", "-uno"], capture_output=True, text=True,
                             check=True).stdout
    if changed:
        sys.exit(f"{checkout} has changes: it must be a clone made for this\n{changed}")
    if not check(checkout):
        return False
    results = read_results(path)
    sound = {result["caught"] for result in results.values()}
    builder = Builder(build, arguments.j)
    todo = [m for m in MUTATIONS if not (m.name in results and is_caught(results[m.name]))
            and (not arguments.only or m.name in arguments.only)]
    todo.sort(key=lambda mutation: mutation.name in results)  # what nothing has caught again at the end
    for mutation in todo:
        builder.tests_of(mutation)
    for mutation in todo:
        result = run_one(builder, checkout, mutation, sound)
        results[mutation.name] = result
        with open(path, "a", encoding="utf-8") as file:
            file.write(json.dumps(result) + "\n")
        print(f"{result['seconds']:7.1f} s  {mutation.name}: {result['caught'] or 'NOT CAUGHT'}  {result['said']}",
              flush=True)
    bad = [result["name"] for result in results.values() if not is_caught(result)]
    print(f"{len(results)} mutations, {len(results) - len(bad)} caught" + (f"; not: {', '.join(bad)}" if bad else ""))
    return not bad


def print_table(before, after):
    results = [read_results(path) for path in (before, after)]
    print("| mutation | folder | kind | before caught by | after caught by |")
    print("| --- | --- | --- | --- | --- |")
    for mutation in MUTATIONS:
        rows = [result.get(mutation.name) for result in results]
        row = rows[1] or rows[0]
        if not row:
            continue
        caught = [(r["caught"] or "nothing") if r else "not run" for r in rows]
        cells = (mutation.name, row["folder"].removeprefix("src/"), mutation.kind, *caught)
        print(f"| {' | '.join(cells)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="only look whether every mutation applies")
    parser.add_argument("--table", action="store_true", help="print a table of two results")
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("-j", type=int, default=1, metavar="N", help="jobs of the build")
    parser.add_argument("paths", nargs="+")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # what is changed is put back
    wanted = 1 if arguments.check else 2 if arguments.table else 3
    if len(arguments.paths) != wanted:
        parser.error(f"{wanted} paths are needed")
    if arguments.table:
        print_table(*arguments.paths)
        return 0
    return 0 if (check(arguments.paths[0]) if arguments.check else run_all(arguments)) else 1


if __name__ == "__main__":
    sys.exit(main())
