#!/usr/bin/env python3
"""A crafted glTF file for each code of the Khronos validator's list that concerns what is read (broken_gltf_cases.py):
the exit code of its row, one line that names the file and the place, and nothing written; or, where the meaning is plain,
a warning, and the exit code of what is not valid with --strict.

    test_broken_gltf_cases.py [TABLE]     TABLE: the outcomes are written there"""

import json
import sys

from broken_gltf_cases import CASES, FORMAL, PLAIN, SHORT, Model
from harness import INVALID, OK, case, check, equal, lattice, main

TABLE = sys.argv.pop() if len(sys.argv) > 1 and sys.argv[1].endswith(".tsv") else None


def start(run):
    run.write("l.json", lattice(moves=[{"at": [1, "all", "all"], "by": [0.25, 0.5, 0]}]))
    run.write("short.bin", b"\0" * 64)


def judge_flaws(run, name, output, kind):
    """What is plain is said, and reported, and refused with --strict, in the same words; what is formal only
    refused; nothing else is either."""
    is_plain = kind == PLAIN
    words = ("deform", name, output, "-l", "l.json", "--force")
    said = run.ffd(*words, "--report", "r.json", err=lambda lines: None).err
    flaws = json.loads(run.text("r.json"))["jobs"][0].get("flaws", [])
    said_of = [f"{f['pointer']}: {f['message']}" if "pointer" in f else f["message"] for f in flaws]
    expected = [f"{name}: {text}" for text, f in zip(said_of, flaws) if f["count"] == 1]
    equal([line for line in said if line in expected], expected, name)
    equal(len(flaws), int(is_plain), f"{name}: flaws {flaws}")
    for strict in (("info", name), words):
        done = run.ffd(*strict, "--strict", "-q", code=INVALID if kind in (PLAIN, FORMAL) else OK, data=True)
        if is_plain:
            # Each file is one line of JSON; a GLB file has no lines.
            line = "" if name.endswith(".glb") and "pointer" in flaws[0] else " " if name.endswith(".glb") else "1: "
            equal(done.err, [f"{name}:{line}{said_of[0]}"])
        elif kind == FORMAL:
            check(len(done.err) == 1 and done.err[0].startswith(name + ":"), done.err)


@case
def codes_of_the_khronos_validator(run):
    start(run)
    rows, wrong = [], []
    for code, expected, what, ending, make in CASES:
        name, output = "m" + ending, "o" + ending
        run.write(name, make())
        outcomes = []
        for words in (("deform", name, output, "-l", "l.json", "-q"), ("info", name, "-q")):
            done = run.ffd(*words, code=tuple(range(8)), data=True)
            outcomes.append((done.code, " ".join(done.err)))
        (deformed, why), (described, _) = outcomes
        kind = expected
        expected = OK if kind in (PLAIN, FORMAL) else expected
        rows.append((code, what, str(deformed), str(described), why))
        if deformed != expected:
            wrong.append(f"{code} ({what}): exit {deformed}, expected {expected}; {why}")
        if deformed and not why.startswith(name + ":"):
            wrong.append(f"{code} ({what}): the message names no file: {why}")
        if described not in (OK, deformed):
            wrong.append(f"{code} ({what}): exit {described} of info, {deformed} of deform")
        if deformed == OK:
            judge_flaws(run, name, output, kind)
            run.ffd("compare", name, output, "--tolerance", "2", "-q", code=(0, 1))
        check(run.exists(output) == (deformed == OK), f"{code} ({what}): output {run.names()}")
        run.remove(output)
    if TABLE:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.writelines("\t".join(row) + "\n" for row in [("code", "file", "deform", "info", "message"), *rows])
    check(not wrong, f"{len(wrong)} of {len(rows)} files:\n" + "\n".join(wrong))


@case
def what_is_in_extras_and_unknown_extensions_is_theirs(run):
    """Neither their arrays of nothing nor what is called extensions in extras is an error of glTF."""
    start(run)
    model = Model().set("extensionsUsed", ["ACME_x"]).set("nodes/0/extensions", {"ACME_x": {"list": []}})
    run.write("m.glb", model.set("nodes/0/extras", {"extensions": {"ACME_z": {}}, "list": []}).glb())
    run.ffd("deform", "m.glb", "o.glb", "-l", "l.json", "--strict")


@case
def what_gltf_allows_is_not_refused(run):
    """Changes of colours and texture coordinates have a sign; arrays of no name of glTF are of any length."""
    start(run)
    model = Model().set("comments", []).set("nodes/0/words", [])
    model.primitive["attributes"].update(COLOR_0=model.add([(0.5, 0.5, 0.5)] * 8), TEXCOORD_0=model.add([(0, 0)] * 8, "VEC2"))
    model.morph(COLOR_0=model.add([(-9, 0, 0, 0)] * 8, "VEC4", SHORT, normalized=True),
                TEXCOORD_0=model.add([(-9, 9)] * 8, "VEC2", SHORT, normalized=True))
    run.write("m.glb", model.glb())
    run.ffd("deform", "m.glb", "o.glb", "-l", "l.json", "--strict")


main()
