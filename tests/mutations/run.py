#!/usr/bin/env python3
"""Plants faults in src, one at a time, and tells which test catches each. It takes a while and is no part of CI.

    run.py --check CHECKOUT                                     does every mutation apply, exactly once?
    run.py CHECKOUT BUILD RESULTS [--only NAME]... [-j N]       runs them, appends to RESULTS (JSON, one a line)
    run.py --table BEFORE AFTER                                 a Markdown table of two results

CHECKOUT is a clone made for this: its sources are changed, and put back at the end of every mutation. BUILD is a build
folder of it, made once by `meson setup -Dtests=enabled -Dbuildtype=debugoptimized` and built once by ninja: later only
what a test says that it needs is. Warnings are no errors there, as a mutation may leave a function unused. FFD_MODELS
and FFD_NODE are those of tests/run.sh. A second run goes on where the first one stopped: what RESULTS says to be caught
is done.

The mutations are in mutations.txt, each on a line (a line that begins with a blank goes on with the one before):

    NAME: TESTS: DEFINITION: PATTERN => REPLACEMENT

DEFINITION is the name of the function, the macro or the variable (a table) that is changed, in whatever file of src.
One that gets or loses a prefix (ffd_gltf_can_reuse, can_reuse) is found without a change here. DEFINITION@PART looks
only in files whose path contains PART; only same names in several files need it. PATTERN is the code to replace, found
once in the definition: source.py says what it may be. It is as short as possible, and spares what a refactoring changes
(names of local variables, structs that a member is in). REPLACEMENT is empty where code is left out. TESTS are names of
meson tests, separated by commas, that should catch the mutation, quick ones first: only what these need is built, they
are run one by one, and the first that fails has caught it. Such a test must pass without any mutation too, which is
looked at once a test. A mutation that does not compile, or that no test catches, is an error: exit status 1. One that
no test can catch, as it changes nothing that the program promises (a limit of effort, a read within the same page), is
none for the table.

What --check says of a mutation that does not apply asks for a decision. Either the fault moved: name the definition
and the code in which it can be made now. Or it died with its code: delete its line.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import time

import source

SHOWN = 300  # characters of what a failing test says
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mutations.txt")


def is_prefixed(name, other):
    """Is one the other with a prefix, as a function has that gets or loses its callers in other files?"""
    short, long = sorted((name, other), key=len)
    return "_" in short and long.endswith("_" + short)


class Mutation:
    def __init__(self, line):
        fields = line.split(": ", 3)
        if len(fields) < 4:
            raise ValueError(f"`{line}` is not of the form NAME: TESTS: DEFINITION: PATTERN => REPLACEMENT")
        self.name, tests, self.definition, change = fields
        self.tests = [test.strip() for test in tests.split(",")]
        self.change = source.Change(change)

    def find(self, definitions):
        """Returns (the definitions of that name, the places of the change in them)."""
        name, _, part = self.definition.partition("@")
        known = definitions.get(name) or [d for other in definitions if is_prefixed(name, other)
                                          for d in definitions[other]]
        known = [d for d in known if part in d.source.path] or known
        return known, [place for definition in known for place in self.change.find(definition)]

    def find_elsewhere(self, definitions):
        """Names the only definition that has the pattern, where that is no pattern of a few signs."""
        if all(len(word) < 6 for word in self.change.literal):
            return ""
        places = [place for known in definitions.values() for d in known for place in self.change.find(d)]
        return f"; {places[0].definition.name} has it ({places[0]})" if len(places) == 1 else ""

    def judge(self, definitions):
        """Returns (the place, None), or (None, why there is not exactly one)."""
        known, places = self.find(definitions)
        if not known:
            return None, f"{self.definition} is not defined any more{self.find_elsewhere(definitions)}"
        pattern = f"`{self.change.pattern}`"
        if not places:
            where = ", ".join(map(str, known))
            return None, f"{pattern} is not in {self.definition} ({where}){self.find_elsewhere(definitions)}"
        if len(places) > 1:
            return None, f"{pattern} is {len(places)} times in {self.definition} ({', '.join(map(str, places))})"
        return places[0], None


def read_table():
    lines = []
    with open(TABLE, encoding="utf-8") as file:
        for line in file:
            if line[0] == " ":
                lines[-1] += " " + line.strip()
            elif line[0] not in "#\n":
                lines.append(line.strip())
    try:
        return [Mutation(line) for line in lines]
    except ValueError as error:
        sys.exit(f"{TABLE}: {error}")


MUTATIONS = read_table()


def check(checkout):
    definitions = source.define_all(checkout)
    failures = []
    folders = {}
    names = set()
    seen = {}
    for mutation in MUTATIONS:
        place, problem = mutation.judge(definitions)
        if place:
            key = place.source.path, place.change()
            if key[1] == place.source.text:
                problem = "it changes nothing"
            problem = f"it is the same as {seen[key]}" if key in seen else problem
            seen[key] = mutation.name
            folder = os.path.dirname(place.source.path)
            folders[folder] = folders.get(folder, 0) + 1
            print(f"{mutation.name:32} {place}")
        if mutation.name in names:
            problem = "a second mutation of this name"
        names.add(mutation.name)
        if problem:
            failures.append(f"{mutation.name}: {problem}")
    for folder, count in sorted(folders.items()):
        print(f"{count:4} {folder}")
    for failure in failures:
        print(failure)
    print(f"{len(MUTATIONS)} mutations, {len(failures)} do not apply")
    return not failures


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
        unknown = [name for name in mutation.tests if name not in self.tests]
        if unknown:
            sys.exit(f"{mutation.name}: there is no test {', '.join(unknown)}")
        return mutation.tests

    def make(self, name):
        files = [os.path.relpath(file, self.build) for target in self.tests[name]["depends"]
                 for file in self.targets[target]]
        run = subprocess.run(["ninja", "-C", self.build, "-j", str(self.jobs), *files], capture_output=True, text=True,
                             check=False)
        return run.returncode == 0, run.stdout + run.stderr

    def run(self, name):
        """Returns what became of the test (OK, SKIP, FAIL, ...), and what it says."""
        subprocess.run(["meson", "test", "-C", self.build, "--no-rebuild", "--logbase", "mutation", name],
                       capture_output=True, text=True, check=False)
        with open(os.path.join(self.build, "meson-logs", "mutation.json"), encoding="utf-8", errors="replace") as log:
            results = [json.loads(line) for line in log if line.strip()]
        if len(results) != 1 or results[0]["name"].rpartition(" / ")[2] != name:
            sys.exit(f"{name}: meson ran {len(results)} tests")
        return results[0]["result"], results[0].get("stdout", "") + results[0].get("stderr", "")


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
    skipped = []
    for name in builder.tests_of(mutation):
        made, said = builder.make(name)
        if not made:
            errors = [line for line in said.splitlines() if "rror:" in line or "undefined reference" in line]
            return "BUILD", errors[0][:SHOWN] if errors else said[-SHOWN:]
        result, said = builder.run(name)
        if result == "SKIP":
            skipped.append(f"{name} is skipped")
        elif result != "OK":
            return name, first_failure(said)
    return None, ", ".join(skipped)


def run_one(builder, checkout, mutation, sound):
    """sound: the tests that are known to pass without a mutation."""
    place, problem = mutation.judge(source.define_all(checkout))
    if not place:
        sys.exit(f"{mutation.name}: {problem}")
    start = time.monotonic()
    try:
        place.source.write(place.change())
        caught, said = find_catcher(builder, mutation)
    finally:
        place.source.write(place.source.text)
    seconds = time.monotonic() - start
    if caught and caught not in sound and caught != "BUILD":
        if not builder.make(caught)[0] or builder.run(caught)[0] != "OK":
            sys.exit(f"{caught} fails without any mutation")
        sound.add(caught)
    return {"name": mutation.name, "path": place.source.path, "definition": mutation.definition, "caught": caught,
            "said": said, "seconds": round(seconds, 1)}


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
    print("| mutation | folder | definition | before caught by | after caught by |")
    print("| --- | --- | --- | --- | --- |")
    for mutation in MUTATIONS:
        rows = [result.get(mutation.name) for result in results]
        row = rows[1] or rows[0]
        if not row:
            continue
        caught = [(r["caught"] or "nothing") if r else "not run" for r in rows]
        cells = (mutation.name, os.path.dirname(row["path"]).removeprefix("src/"), row["definition"], *caught)
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
