#!/usr/bin/env python3
"""Prints the build targets that the tests of some suites need, and what is installed.

    targets.py BUILD-FOLDER [SUITE...]      without a suite: nothing, which is everything for ninja
"""

import json
import os
import sys


def read(build, name):
    with open(os.path.join(build, "meson-info", f"intro-{name}.json"), encoding="utf-8") as file:
        return json.load(file)


def main():
    build, suites = os.path.realpath(sys.argv[1]), set(sys.argv[2:])
    if not suites:
        return
    # "project:suite"
    needed = {target for test in read(build, "tests")
              if suites & {suite.split(":")[-1] for suite in test["suite"]} for target in test["depends"]}
    if not needed:
        sys.exit(f"targets.py: no test in {' '.join(sorted(suites))}")
    for target in read(build, "targets"):
        if target["id"] in needed or target["installed"]:
            print(*(os.path.relpath(name, build) for name in target["filename"]))


main()
