#!/usr/bin/env python3
"""A crafted glTF file for each code of the Khronos validator's list that concerns what is read (broken_gltf_cases.py):
the exit code of its row, one line that names the file and the place, and nothing written.

    test_broken_gltf_cases.py [TABLE]     TABLE: the outcomes are written there"""

import sys

from broken_gltf_cases import CASES
from harness import OK, case, check, lattice, main

TABLE = sys.argv.pop() if len(sys.argv) > 1 and sys.argv[1].endswith(".tsv") else None


def start(run):
    run.write("l.json", lattice(moves=[{"at": [1, "all", "all"], "by": [0.25, 0.5, 0]}]))
    run.write("short.bin", b"\0" * 64)


@case
def codes_of_the_khronos_validator(run):
    start(run)
    rows, wrong = [], []
    for code, expected, what, ending, make in CASES:
        name, output = "m" + ending, "o" + ending
        run.write(name, make())
        outcomes = []
        for words in (("deform", name, output, "-l", "l.json", "-q"), ("info", name)):
            done = run.ffd(*words, code=tuple(range(8)), data=True)
            outcomes.append((done.code, " ".join(done.err)))
        (deformed, why), (described, _) = outcomes
        rows.append((code, what, str(deformed), str(described), why))
        if deformed != expected:
            wrong.append(f"{code} ({what}): exit {deformed}, expected {expected}; {why}")
        if deformed and not why.startswith(name + ":"):
            wrong.append(f"{code} ({what}): the message names no file: {why}")
        if described not in (OK, deformed):
            wrong.append(f"{code} ({what}): exit {described} of info, {deformed} of deform")
        if deformed == OK:
            run.ffd("compare", name, output, "--tolerance", "2", code=(0, 1))
        check(run.exists(output) == (deformed == OK), f"{code} ({what}): output {run.names()}")
        run.remove(output)
    if TABLE:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.writelines("\t".join(row) + "\n" for row in [("code", "file", "deform", "info", "message"), *rows])
    check(not wrong, f"{len(wrong)} of {len(rows)} files:\n" + "\n".join(wrong))


main()
