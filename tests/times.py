#!/usr/bin/env python3
"""Where the time of the tests goes: the seconds of every suite and the slowest tests, from the logs of meson test.

    times.py [-n COUNT] BUILD-FOLDER...     each folder is a column: before and after, say; COUNT slowest, default 20

A folder may be .build-test of tests/run.sh: then the builds in it are taken together, and a test of a stage other than
gcc has the stage's name before it. A test of several suites counts in the first of them. The seconds are those of each
test by itself; as two or more run at a time, the wall clock shows less.
"""

import argparse
import glob
import json
import os


def stage_of(path):
    """STAGE.json, or with --wrap STAGE-WRAPPER.json"""
    return os.path.basename(path)[: -len(".json")].split("-")[0]


def read(folder):
    """Seconds by (suite, test)."""
    logs = glob.glob(os.path.join(folder, "meson-logs", "*.json")) or \
        glob.glob(os.path.join(folder, "*", "meson-logs", "*.json"))
    seconds = {}
    for path in logs:
        stage = stage_of(path)
        prefix = "" if stage in ("gcc", "testlog") else stage + " "
        with open(path, encoding="utf-8", errors="replace") as file:
            for line in file:
                if not line.strip():
                    continue
                test = json.loads(line)
                suites, _, name = test["name"].rpartition(" / ")
                suite = suites.split(":")[-1].split("+")[0] or "none"
                key = (prefix + suite, prefix + name)
                seconds[key] = seconds.get(key, 0) + test["duration"]
    if not seconds:
        raise SystemExit(f"times.py: no logs of meson test in {folder}")
    return seconds


def print_rows(title, names, columns):
    width = max([len(title)] + [len(name) for name in names])
    print(title.ljust(width))
    for name in names:
        cells = "".join(f"{column[name]:10.1f}" if name in column else f"{'-':>10}" for column in columns)
        print(name.ljust(width) + cells)
    print("sum".ljust(width) + "".join(f"{sum(column.get(name, 0) for name in names):10.1f}" for column in columns))


def grouped(seconds, part):
    sums = {}
    for key, value in seconds.items():
        sums[key[part]] = sums.get(key[part], 0) + value
    return sums


def slowest_first(columns):
    names = set().union(*columns)
    return sorted(names, key=lambda name: -max(column.get(name, 0) for column in columns))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-n", type=int, default=20, metavar="COUNT")
    parser.add_argument("folder", nargs="+")
    arguments = parser.parse_args()
    columns = [read(folder) for folder in arguments.folder]
    suites, tests = ([grouped(column, part) for column in columns] for part in (0, 1))
    print_rows("suite, seconds", slowest_first(suites), suites)
    print()
    print_rows(f"{arguments.n} slowest tests, seconds", slowest_first(tests)[: arguments.n], tests)


main()
