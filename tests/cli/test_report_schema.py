#!/usr/bin/env python3
"""The published schema of reports: it refuses what is none. (Whether it takes every report that the program writes, the
harness checks in all tests.)"""
import copy
import json

from harness import CUBE, EMBEDDING, NO, case, check, equal, lattice, main
from report_schema import faults


def reports(run):
    """One of deform, with a failure and without times, and one of check that has all figures."""
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.write("fold.json", lattice(moves=[{"at": ["all", "all", 3], "by": [0, 0, -9]}]))
    run.write("small.json", lattice(low=(0, 0, 0), high=(1, 1, 1)))
    run.folder_of("o")
    run.ffd("deform", "a.obj", "missing.obj", "--out-dir", "o", "-l", "l.json", "--report", "d.json", "--report-stable", code=NO,
            lines=1)
    run.ffd("check", "a.obj", "-l", "fold.json", "--report", "c.json", err=[])
    run.ffd("check", "a.obj", "-l", "small.json", "--outside", "error", "--report", "e.json", code=EMBEDDING)
    return [json.loads(run.read(name)) for name in ("d.json", "c.json", "e.json")]


def paths(value, path=()):
    """The places of all members in a report."""
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield (*path, key)
        yield from paths(inner, (*path, key))


def changed(report, path, change):
    copied = copy.deepcopy(report)
    holder = copied
    for key in path[:-1]:
        holder = holder[key]
    change(holder, path[-1])
    return json.dumps(copied)


def put(value):
    def change(holder, key):
        holder[key] = value
    return change


def remove(holder, key):
    del holder[key]


@case
def the_reports_are_of_all_kinds(run):
    entries = [entry for report in reports(run) for entry in report["jobs"]]
    equal([entry["status"] for entry in entries], ["ok", "failed", "ok", "failed"])
    equal(entries[2]["folds"]["verdict"], "some")
    check(entries[2]["edges"] and entries[2]["folds"]["witness"] and "seconds" in entries[2], "a report with all members")
    check("seconds" not in entries[0], "a report without times")


@case
def a_member_less_or_more_or_of_another_kind_is_refused(run):
    tried = 0
    for report in reports(run):
        equal(faults(json.dumps(report)), [])
        for path in paths(report):
            if isinstance(path[-1], str):
                if path[-1] != "seconds":
                    check(faults(changed(report, path, remove)), f"{path}: may be missing")
                check(faults(changed(report, (*path[:-1], path[-1] + "x"), put(0))), f"{path}: may have another beside it")
            elif path[0] == "jobs" and len(path) > 2 and "outputs" not in path:
                check(faults(changed(report, path, remove)), f"{path}: an array may be shorter")
            for wrong in (True, {"x": 1}, [[]]):
                check(faults(changed(report, path, put(wrong))), f"{path}: may be {wrong}")
            tried += 1
    check(tried > 100, f"only {tried} members")


@case
def values_out_of_range_are_refused(run):
    report = reports(run)[0]
    for path, wrong in ((("format",), "ffd-lattice"), (("version",), 2), (("version",), "1"), (("jobs", 0, "status"), "done"),
                        (("jobs", 0, "exit"), 1), (("jobs", 0, "exit"), None), (("jobs", 0, "error"), "but it says ok"),
                        (("jobs", 1, "exit"), 0), (("jobs", 1, "exit"), 8), (("jobs", 1, "error"), None),
                        (("jobs", 1, "error"), "two\nlines"), (("jobs", 0, "vertices"), -1), (("jobs", 0, "vertices"), 1.5),
                        (("jobs", 0, "input"), None), (("jobs", 0, "folds", "verdict"), "maybe"),
                        (("jobs", 0, "bounds", "before", "min"), [1, 2]), (("jobs", 0, "bounds", "before", "max"), None),
                        (("jobs", 0, "displacement", "max"), -1), (("jobs",), {})):
        check(faults(changed(report, path, put(wrong))), f"{path}: may be {wrong!r}")
    equal(faults(changed(report, ("jobs", 0, "status"), put("skipped"))), [], "a skipped job")
    equal(faults(changed(report, ("jobs", 0, "line"), put(3))), [], "a line of a manifest")
    equal(faults(changed(report, ("jobs", 1, "input"), put(None))), [], "a line that names no mesh")


@case
def what_is_no_json_is_refused(run):
    text = json.dumps(reports(run)[0])
    for wrong in (text[:-1], text.replace('"version": 1', '"version": NaN'), "", text + "]", "[]", "3"):
        check(faults(wrong), f"{wrong[:60]!r} passes")


main()
