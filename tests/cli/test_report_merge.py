#!/usr/bin/env python3
"""ffd report merge: the entries of several reports, each with its bytes, in the order asked for."""
import json
import subprocess

from harness import CUBE, INVALID, IO, NO, OK, UNSUPPORTED, case, check, equal, lattice, main
from report_schema import faults

ENTRY = {"input": "a.obj", "output": None, "status": "ok", "exit": 0, "error": None}


def entry(**members):
    return {**ENTRY, **members}


def report(*entries):
    return {"format": "ffd-report", "version": 1, "jobs": list(entries)}


def inputs(text):
    return [job["input"] for job in json.loads(text)["jobs"]]


def numbered(run, *counts):
    """Files r0.json, r1.json, ... with this many entries each, named N.I."""
    names = [f"r{number}.json" for number in range(len(counts))]
    for number, count in enumerate(counts):
        run.write(names[number], report(*(entry(input=f"{number}.{i}") for i in range(count))))
    return names


@case
def what_the_program_writes_is_joined_to_the_byte(run):
    meshes = [f"{name}.obj" for name in "abcdefg"]
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    for i, name in enumerate(meshes):
        run.write(name, CUBE.replace("v 1", f"v 1.{i}"))

    def check_report(name, *chosen):
        run.ffd("check", *chosen, "-l", "l.json", "--report", name, "--report-stable", "-q")
        return name

    whole = run.read(check_report("all.json", *meshes))
    parts = [check_report("0.json", *meshes[:3]), check_report("1.json", *meshes[3:6]), check_report("2.json", meshes[6])]
    equal(run.ffd("report", "merge", *parts).out, whole, "parts in order")
    parts = [check_report(f"s{i}.json", *meshes[i::3]) for i in range(3)]
    equal(run.ffd("report", "merge", "--interleave", *parts).out, whole, "shards")
    equal(run.ffd("report", "merge", "all.json").out, whole, "a report alone")
    equal(faults(whole), [])


@case
def the_shards_of_a_batch_are_joined_to_the_report_of_one_run(run):
    """Also where jobs fail, and lines hold no job."""
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    lines = []
    for i in range(17):
        run.write(f"{i}.obj", CUBE)
        lines.append(json.dumps({"in": f"{i}.obj" if i % 5 else "missing.obj", "lattice": "l.json", "out": f"out/{i}.obj"}))
    lines[3:3] = ["", '{"in": ', "[]", "  ", "{}"]
    run.write("jobs.jsonl", "\n".join(lines))

    def batch(name, *arguments):
        run.ffd("batch", "jobs.jsonl", "--force", "--report", name, "--report-stable", *arguments, code=(OK, NO),
                stderr=subprocess.DEVNULL)
        return name

    run.folder_of("out")
    whole = run.read(batch("whole.json"))
    statuses = [job["status"] for job in json.loads(whole)["jobs"]]
    equal([statuses.count(status) for status in ("ok", "failed")], [13, 7])
    for count in (1, 3, 20):
        shards = [batch(f"{i}.json", "--shard", f"{i}/{count}") for i in range(count)]
        equal(run.ffd("report", "merge", "--interleave", *shards).out, whole, f"{count} shards")


@case
def the_order_is_that_of_the_arguments(run):
    a, b, c = numbered(run, 2, 0, 3)
    equal(inputs(run.ffd("report", "merge", a, b, c).out), ["0.0", "0.1", "2.0", "2.1", "2.2"])
    equal(inputs(run.ffd("report", "merge", c, a, a).out), ["2.0", "2.1", "2.2", "0.0", "0.1", "0.0", "0.1"])
    equal(inputs(run.ffd("report", "merge", "--interleave", c, a, a).out), ["2.0", "0.0", "0.0", "2.1", "0.1", "0.1", "2.2"])
    equal(run.ffd("report", "merge", b).out, run.ffd("report", "merge", b, b).out, "no jobs")
    equal(json.loads(run.ffd("report", "merge", b).out), report())


@case
def the_report_of_a_shard_that_was_cut_off_is_not_interleaved(run):
    """A run that was killed leaves a whole report of what had ended, which would put all entries in a wrong order."""
    names = numbered(run, 3, 2, 0, 3)
    for chosen, short in (((0, 2), 2), ((1, 0), 1), ((0, 1, 3), 1), ((2, 0), 2)):
        run.ffd("report", "merge", "--interleave", *(names[i] for i in chosen), "-o", "all.json", code=INVALID,
                err=f"{names[short]}: has too few entries for a shard of one run with the others: its run was cut off, or had "
                    "other jobs (without --interleave they can be joined)")
        check(not run.exists("all.json"))
    equal(len(inputs(run.ffd("report", "merge", names[2], names[0]).out)), 3)


@case
def entries_keep_their_bytes(run):
    odd = ('{"error" :null,"exit":0e0 ,\n"status":"\\u006fk", "output": "]}\\"{\\\\", "later": [1.50, {"a": []}, -0.0],\t'
           '"input":"\\ud83d\\ude00\u00e9"}')
    run.write("odd.json", '\ufeff {"jobs":[%s , %s\n],\n"version" : 1, "format":"ffd-report"}\n' % (odd, json.dumps(ENTRY)))
    out = run.ffd("report", "merge", "odd.json", "odd.json").text
    equal(out.count(odd), 2)
    equal(len(json.loads(out)["jobs"]), 4)
    equal(run.ffd("report", "merge", "-", stdin=out.encode()).text, out, "what was joined, from standard input")


@case
def where_it_goes(run):
    a, b = numbered(run, 1, 2)
    whole = run.ffd("report", "merge", a, b).out
    run.ffd("report", "merge", a, b, "-o", "all.json", out="")
    equal(run.read("all.json"), whole)
    run.ffd("report", "merge", a, "-o", "all.json", code=IO, err="all.json: exists already (--force overwrites it)")
    equal(run.read("all.json"), whole)
    run.ffd("report", "merge", a, b, "-o", a, "--force")
    equal(run.read(a), whole, "an input that is the output")
    run.ffd("report", "merge", a, "-o", "no/all.json", code=IO)


BROKEN = [
    ("", "all.json:1: not a report: '{' is expected, found the end"),
    ("[]", "all.json:1: not a report: '{' is expected, found '['"),
    ('{"format": "ffd-report", "version": 1, "jobs": []}'.encode("utf-16").decode("latin-1"), "all.json:1: is text in UTF-16: it must be UTF-8"),
    ("{}", "all.json:1: not a report: \"format\", \"version\" or \"jobs\" is expected, found '}'"),
    ("\0", "all.json:1: not a report: '{' is expected, found byte 0x00"),
    ('{"format": "ffd-lattice", "version": 1}', 'all.json:1: not a report: "format" must be "ffd-report", found "ffd-lattice"'),
    ('{"format": "ffd-report", "version": 1}', 'all.json: not a report: "format", "version" or "jobs" is missing'),
    ('{"jobs": [], "version": 1}', 'all.json: not a report: "format", "version" or "jobs" is missing'),
    ('{"version": 0}', "all.json:1: not a report: \"version\" must be 1, found '0'"),
    ('{"version": 10}', "all.json:1: not a report: ',' or '}' is expected, found '0'"),
    ('{"version": 1, "version": 1}', "all.json:1: not a report: a member is repeated, found \"version\""),
    ('{"version": 1, "more": 1}', 'all.json:1: not a report: "format", "version" or "jobs" is expected, found "more"'),
    ('{"jobs": {}}', "all.json:1: not a report: \"jobs\" must be an array, found '{'"),
    ('{"jobs": [', 'all.json:1: not a report: an entry of "jobs" is expected, found the end'),
    ('{"jobs": [3]}', "all.json:1: not a report: an entry of \"jobs\" is expected, found '3'"),
    ('{"jobs": [\n{"input": "\\', 'all.json:2: not a report: this entry has no end'),
    ('{"jobs": [\n{"a": [1}]\n}]}', "all.json:2: not valid JSON: ',' or ']' is expected, found '}' (column 9)"),
    ('{"jobs": [%s %s]}', "all.json:1: not a report: ',' or ']' is expected after an entry, found '{'"),
    ('{"jobs": [%s,]}', "all.json:1: not a report: an entry is expected after ',', found ']'"),
    ('{"jobs": [%s,\n\n{"input": "a",\n"input": "b"}]}', 'all.json:4: /jobs/1/input: not valid JSON: duplicate key "input" in an object (column 1)'),
    ('{"jobs": [%s, {"input": "\xff"}]}', "all.json:1: not valid JSON: a string is not valid UTF-8, found byte 0xff (column 100)"),
    ('{"jobs": [{}]}', 'all.json:1: /jobs/0: "input" is missing'),
]


@case
def broken_reports_are_refused(run):
    good, = numbered(run, 2)
    for text, message in BROKEN:
        run.write("all.json", text.replace("%s", json.dumps(ENTRY)).encode("latin-1"))
        for arguments in ([good, "all.json"], ["all.json", good, "-o", "out.json"], [good, "all.json", "-o", good, "--force"]):
            run.ffd("report", "merge", *arguments, code=INVALID, err=message)
        equal(run.names(), ["all.json", good], text)
    run.write("all.json", '{"format": "ffd-report", "version": 2, "tasks": []}')
    run.ffd("report", "merge", good, "all.json", code=UNSUPPORTED,
            err="all.json:1: this version of a report is newer than 1, the newest known here")
    run.ffd("report", "merge", good, "missing.json", code=IO)
    run.ffd("report", "merge", good, ".", code=IO)


@case
def entries_must_say_what_became_of_the_job(run):
    for key, wrong, must in (("input", 3, "a text or null"), ("output", 3, "a text or null"), ("status", "done", '"ok", "failed" or "skipped"'),
                             ("status", None, '"ok", "failed" or "skipped"'), ("exit", 8, "a whole number from 0 to 7"),
                             ("exit", -1, "a whole number from 0 to 7"), ("exit", 0.5, "a whole number from 0 to 7"),
                             ("exit", "0", "a whole number from 0 to 7"), ("error", [], "a text or null")):
        run.write("r.json", report(ENTRY, entry(**{key: wrong})))
        run.ffd("report", "merge", "r.json", code=INVALID, err=f"r.json:1: /jobs/1/{key}: must be {must}, not {json.dumps(wrong)}")
        less = entry()
        del less[key]
        run.write("r.json", report(less))
        run.ffd("report", "merge", "r.json", code=INVALID, err=f'r.json:1: /jobs/0: "{key}" is missing')


@case
def every_cut_is_refused(run):
    whole = json.dumps(report(entry(error='a "quoted\\" word', status="failed", exit=3), ENTRY), indent=2)
    for length in range(len(whole)):
        run.write("cut.json", whole[:length])
        run.ffd("report", "merge", "cut.json", code=INVALID)
    run.write("cut.json", whole)
    run.ffd("report", "merge", "cut.json")
    run.write("cut.json", whole + "x")
    run.ffd("report", "merge", "cut.json", code=INVALID)


main()
