#!/usr/bin/env python3
"""ffd report junit: reports and comparisons of folders as build servers read them, by an XML parser."""

import json
import os
import xml.etree.ElementTree as xml

from batches import batch, case, check, equal, job, lattice, lines_of, main, start
from harness import CUBE, INVALID, IO, NO, USAGE

QUIET = {"err": lambda said: None}


def suites(run, name):
    """[(suite, its numbers of tests, failures, errors and skipped, [(case, class, outcome, message)])]."""
    root = xml.fromstring(run.read(name))
    equal(root.tag, "testsuites")
    found = []
    for suite in root:
        cases = []
        for each in suite:
            equal(each.tag, "testcase")
            outcome = each[0] if len(each) else None
            cases.append((each.get("name"), each.get("classname"), None if outcome is None else outcome.tag,
                          None if outcome is None else outcome.get("message")))
        found.append((suite.get("name"), [int(suite.get(what)) for what in ("tests", "failures", "errors", "skipped")], cases))
    sums = [sum(numbers[i] for _, numbers, _ in found) for i in range(4)]
    equal([int(root.get(what)) for what in ("tests", "failures", "errors", "skipped")], sums)
    for _, numbers, cases in found:
        outcomes = [outcome for _, _, outcome, _ in cases]
        equal(numbers, [len(cases), *(outcomes.count(kind) for kind in ("failure", "error", "skipped"))])
    return found


@case
def each_exit_code_has_its_outcome(run):
    start(run, [job(0), job(1), job(2, lattice="half.json", options={"fail-on": "outside"}), job(3, **{"in": "none.obj"}), "{"])
    run.write("half.json", lattice(high=(2, 2, 0)))
    batch(run, "m.jsonl", "--journal", "j", "--resume", done=2, failed=["outside", "none.obj", "m.jsonl:5"])
    run.remove("o1.obj")
    batch(run, "m.jsonl", "--journal", "j", "--resume", "--report", "r.jsonl", "--report-stable", done=1, kept=1, failed=["outside", "none.obj", "m.jsonl:5"])
    run.ffd("check", "a.obj", "-l", "l.json", "--report", "c.json", "-q")
    run.ffd("report", "junit", "r.jsonl", "c.json", "-o", "x.xml")
    first, second = suites(run, "x.xml")
    errors = {e["output"]: e["error"] for e in map(json.loads, run.text("r.jsonl").splitlines())}
    equal(first, ("r.jsonl", [5, 1, 2, 1], [("o0.obj", "a.obj", "skipped", None), ("o1.obj", "a.obj", None, None),
                                            ("o2.obj", "a.obj", "failure", errors["o2.obj"]), ("o3.obj", "none.obj", "error", errors["o3.obj"]),
                                            ("line 5", "no input", "error", errors[None])]))
    equal(second, ("c.json", [1, 0, 0, 0], [("a.obj", "a.obj", None, None)]))
    seconds = [float(each.get("time")) for each in xml.fromstring(run.read("x.xml")).iter("testcase") if each.get("time")]
    equal(len(seconds), 1)
    check(0 < seconds[0] < 60, seconds)
    equal(run.ffd("report", "junit", "r.jsonl", "c.json").out, run.read("x.xml"))


@case
def names_and_messages_are_escaped(run):
    """What XML cannot hold becomes U+FFFD; line breaks stay."""
    names = ["a<b>&\"'.obj", "tab\tline\nend.obj", "bell\x07\x1b\x7f.obj", "\ufffe\uffff \ud7ff\ue000\U0001f600.obj"]
    entries = [{"input": name, "output": None, "status": "failed", "exit": 3, "error": name.replace("\n", " ")} for name in names]
    run.write("r.json", {"format": "ffd-report", "version": 1, "jobs": entries})
    odd = b"r\xff<&.json"
    os.rename(run.path("r.json"), os.path.join(os.fsencode(run.folder), odd))
    run.ffd("report", "junit", os.fsdecode(odd), "-o", "x.xml")
    (suite, _, cases), = suites(run, "x.xml")
    equal(suite, "r\ufffd<&.json")
    shown = [names[0], names[1], "bell\ufffd\ufffd\x7f.obj", "\ufffd\ufffd \ud7ff\ue000\U0001f600.obj"]
    equal([(name, group) for name, group, _, _ in cases], [(name, name) for name in shown])
    equal([message for *_, message in cases], [name.replace("\n", " ") for name in shown])


@case
def comparisons_of_folders(run):
    for name in ("A/same.obj", "B/same.obj", "A/moved.obj", "A/bad.obj", "A/only.obj"):
        run.write(name, CUBE)
    run.write("B/moved.obj", CUBE.replace("v -1 -1 -1", "v -2 -1 -1"))
    run.write("B/bad.obj", "v 1")
    comparison = run.ffd("compare", "A", "B", "--recursive", "--json", code=NO, **QUIET)
    run.write("c.json", comparison.out)
    run.ffd("report", "junit", "c.json", "-o", "x.xml")
    equal(suites(run, "x.xml"), [("c.json", [4, 2, 1, 0], [
        ("bad.obj", "B", "error", comparison.json["files"][0]["error"]), ("moved.obj", "B", "failure", comparison.json["files"][1]["first"]["message"]),
        ("same.obj", "B", None, None), ("only.obj", "B", "failure", "only in a")])])
    run.ffd("report", "junit", "-", "-o", "y.xml", stdin=comparison.out)
    equal(suites(run, "y.xml")[0][0], "standard input")
    run.ffd("report", "junit", "/dev/null", "-o", "z.xml", code=INVALID, err="/dev/null:1: not a report: '{' is expected, found the end")


@case
def what_is_refused(run):
    run.write("r.json", {"format": "ffd-report", "version": 1, "jobs": []})
    run.write("no.json", "{}")
    run.write("cut.json", '{"format": "ffd-comparison", "version": 1, "files": [')
    run.ffd("report", "junit", code=USAGE)
    run.ffd("report", "junit", "-", "-", code=USAGE)
    run.ffd("report", "junit", "none.json", "-o", "x.xml", code=IO)
    run.ffd("report", "junit", "r.json", "no.json", "-o", "x.xml", code=INVALID)
    run.ffd("report", "junit", "cut.json", "-o", "x.xml", code=INVALID)
    run.ffd("report", "junit", "r.json", "-o", "none/x.xml", code=IO)
    check(not run.exists("x.xml"), "something was written")
    run.ffd("report", "junit", "r.json", "-o", "x.xml")
    equal(suites(run, "x.xml"), [("r.json", [0, 0, 0, 0], [])])
    run.ffd("report", "junit", "r.json", "-o", "x.xml", code=IO)
    run.ffd("report", "junit", "r.json", "-o", "x.xml", "--force")
    # What it reads is not lost, by whatever name.
    before = run.read("r.json")
    os.symlink("r.json", run.path("link.xml"))
    for output in ("r.json", "./r.json", "link.xml"):
        run.ffd("report", "junit", "r.json", "-o", output, "--force", code=IO, err=f"{output}: is an input of this command")
        equal(run.read("r.json"), before)


main()
