#!/usr/bin/env python3
"""ffd batch: what jobs that run at once, or come slowly, or end early do to each other: nothing."""

import filecmp
import json
import os
import random
import shutil
import signal
import subprocess
import time

from batches import batch, case, check, equal, job, lines_of, main, report, start, statuses
from harness import CUBE, FFD, INVALID, NO, OK, PNG, SANITIZED, SECONDS, gltf_json, wait_until

SLOW = CUBE * 60000  # some 0.3 s and more where a cube takes a thousandth of it
POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
FEW = 8  # jobs that two workers may have been given ahead


def write_gltf(run, name, images):
    """A .gltf of three points that names these images, which need not be there."""
    asset, data = gltf_json(POINTS, uri=os.path.basename(name) + ".bin")
    asset["images"] = [{"uri": uri} for uri in images]
    run.write(name, asset)
    run.write(name + ".bin", data)


def begin(run, *arguments, **options):
    """A batch that goes on while the test does, in a session of its own."""
    return subprocess.Popen([FFD, "batch", *arguments], cwd=run.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                            start_new_session=True, **options)


def ended(process, seconds=SECONDS):
    """What a batch said; a failure where it does not end in time."""
    try:
        said = process.communicate(timeout=seconds)[1].decode()
    except subprocess.TimeoutExpired as late:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise AssertionError(f"it has not ended within {seconds} s") from late
    return said


@case
def images_that_jobs_share(run):
    start(run)
    images = {f"t{i}.png": PNG + random.Random(i).randbytes(200000) for i in range(4)}
    for name, content in images.items():
        run.write("gs/" + name, content)
    meshes = [f"m{i}.gltf" for i in range(8)]
    for name in meshes:
        write_gltf(run, "gs/" + name, images)
    for i in range(4):
        folder = run.folder_of(f"gso{i}")
        batch(run, "--in", "gs/*.gltf", "-l", "l.json", "--out-dir", folder, "-j", "4", done=len(meshes))
        for name, content in images.items():
            equal(run.read(f"{folder}/{name}") == content, True, f"{folder}/{name} is the image")
        check(set(meshes) <= set(run.names(folder)), run.names(folder))


@case
def stop_while_a_job_before_still_runs(run):
    """A failure stops the batch when it comes, and not when the jobs before it in the manifest have ended too."""
    start(run, [job(0, **{"in": "slow.obj"}), job(1, **{"in": "none.obj"}), *[job(i) for i in range(2, 202)]])
    run.write("slow.obj", SLOW)
    run.ffd("batch", "m.jsonl", "-j", "2", "--stop", "--report", "r.json", code=NO, err=lambda said: None)
    entries = report(run)
    check(len(entries) <= FEW, len(entries), "jobs were begun")
    equal([e["line"] for e in entries], list(range(1, len(entries) + 1)), "lines of the report")
    equal(statuses(run), ["ok", "failed"] + ["ok"] * (len(entries) - 2))
    equal([run.exists(f"o{i}.obj") for i in range(202)], [i != 1 and i < len(entries) for i in range(202)], "outputs")


@case
def the_journal_does_not_wait_for_a_slow_job(run):
    start(run, [job(0, **{"in": "slow.obj"}), *[job(i) for i in range(1, 400)]])
    run.write("slow.obj", SLOW * 4)
    process = begin(run, "m.jsonl", "-j", "2")
    try:
        wait_until(lambda: run.exists("o60.obj") or process.poll() is not None, "o60.obj does not come")
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    check(not run.exists("o0.obj"), "the slow job was not slow enough to judge")
    for name in run.names():
        if "ffd-tmp" in name:
            run.remove(name)  # SIGKILL leaves no time to clean up
    made = sum(run.exists(f"o{i}.obj") for i in range(400))
    check(made >= 50, made, "outputs")
    run.ffd("batch", "m.jsonl", "--resume", "--dry-run", "-q", "--report", "r.json", code=(OK, NO), err=lambda said: None)
    kept = statuses(run).count("skipped")
    check(made - FEW <= kept <= made, kept, "jobs of", made, "are known as done")


def half_a_line(run, *arguments, head=b"", line=None, done="o0.obj"):
    """A batch whose manifest pauses within a line, when what came before it has been done."""
    process = begin(run, *arguments, "-j", "2", stdin=subprocess.PIPE)
    process.stdin.write(head + line)
    process.stdin.flush()
    wait_until(lambda: run.exists(done) or process.poll() is not None, done + " does not come")
    time.sleep(0.03)
    check(process.poll() is None, "it has ended while its manifest was open")
    return process


MANIFESTS = [
    (["-"], lines_of([job(0)]).encode(), (json.dumps(job(2)) + "\n").encode()),
    (["-", "--shard", "1/2"], lines_of([job(1), job(0)]).encode() + lines_of([job(1)]).encode(), (json.dumps(job(2)) + "\n").encode()),
    (["--csv", "-"], b"in,lattice,out\na.obj,l.json,o0.obj\n", b'"a.obj","l.json","o2.obj"\n'),
]


@case
def a_line_that_comes_in_halves(run):
    start(run)
    for arguments, head, line in MANIFESTS:
        process = half_a_line(run, *arguments, head=head, line=line[:12])
        process.stdin.write(line[12:])
        process.stdin.flush()
        wait_until(lambda: run.exists("o2.obj"), f"{arguments}: o2.obj does not come")
        said = ended(process)
        equal(process.returncode, OK, said)
        check(said.startswith("ffd: 2 jobs in "), said)
        equal(run.read("o2.obj"), run.read("o0.obj"))
        check(not run.exists("o1.obj"), "a job of another shard was done")
        run.remove("o0.obj")
        run.remove("o2.obj")


@case
def signals_within_a_line(run):
    """A batch that waits for the rest of a line can be ended. The half line is not a job."""
    start(run)
    for arguments, head, line in MANIFESTS:
        for number in (signal.SIGTERM, signal.SIGINT):
            process = half_a_line(run, *arguments, "--report", "r.json", head=head, line=line[:12])
            process.send_signal(number)
            try:
                process.wait(2)
            except subprocess.TimeoutExpired:
                pass
            late = process.poll() is None
            if late:
                os.killpg(process.pid, signal.SIGKILL)
            said = process.communicate()[1].decode()
            check(not late, f"{arguments}: it has not ended within 2 s of {number.name}; {said}")
            check(process.returncode in (OK, NO, -number, 128 + number), process.returncode, said)
            equal([(e["output"], e["status"]) for e in report(run)], [("o0.obj", "ok")], f"{arguments}, {number.name}: {said}")
            run.remove("o0.obj")


def instances(count):
    """A .gltf of `count` instances of a mesh of 1000 points."""
    source = random.Random(3)
    return gltf_json([[source.random() for _ in range(3)] for _ in range(1000)], [{"mesh": 0} for _ in range(count)], "inst.bin")


def as_alone(run, count, names):
    """A job that has enough memory by itself has it in a batch, where what it reads is kept for the next one."""
    start(run)
    asset, data = instances(count)
    run.write("inst.gltf", asset)
    run.write("inst.bin", data)
    run.write("n.jsonl", lines_of([{"in": "inst.gltf", "lattice": "l.json", "out": name} for name in names]))
    run.ffd("deform", "inst.gltf", "single.obj", "-l", "l.json")
    batch(run, "n.jsonl", "-j1", done=len(names))
    for name in names:
        check(filecmp.cmp(run.path(name), run.path("single.obj"), shallow=False), name, "is not that of a single run")


@case
def what_is_shared_makes_no_job_too_large(run):
    as_alone(run, 900, ["x.obj", "y.obj"])


@case
def what_is_shared_makes_no_larger_job_too_large(run):
    if not SANITIZED:  # the same code as above
        as_alone(run, 1300, ["x.obj"])


@case
def an_image_that_was_missing(run):
    start(run, [{"in": "in/m.gltf", "lattice": "l.json", "out": "out/m.gltf"}])
    write_gltf(run, "in/m.gltf", ["t.png"])
    run.folder_of("out")
    anything = {"code": OK, "err": lambda said: None}
    run.ffd("batch", "m.jsonl", "--resume", **anything)
    check(not run.exists("out/t.png"), "an image from nowhere")
    run.write("in/t.png", PNG + b"one")
    for expected in ("ok", "skipped"):
        run.ffd("batch", "m.jsonl", "--resume", "--report", "r.json", **anything)
        equal(statuses(run), [expected])
        equal(run.read("out/t.png"), PNG + b"one")
    # A changed one is not up to date, and the copy of the old one is not replaced.
    run.write("in/t.png", PNG + b"two")
    batch(run, "m.jsonl", "--resume", failed=["^out/t.png: "])
    run.remove("out/t.png")
    batch(run, "m.jsonl", "--resume", done=1)
    equal(run.read("out/t.png"), PNG + b"two")


def rules(run, name):
    """A depfile's rules, with nothing escaped in them."""
    return {line.split(": ")[0]: sorted(line.split(": ")[1].split()) for line in run.text(name).splitlines()}


@case
def images_in_a_depfile(run):
    start(run)
    write_gltf(run, "in/m.gltf", ["t.png", "u.png"])
    write_gltf(run, "in/n.gltf", ["u.png", "missing.png"])
    for name in "tu":
        run.write(f"in/{name}.png", PNG + name.encode() * 100)
    jobs = [("in/m.gltf", "out/m.gltf", {}), ("in/n.gltf", "out/n.gltf", {}), ("in/m.gltf", "out/again.gltf", {}), ("in/m.gltf", "out/m.obj", {}),
            ("in/m.gltf", "out/r.gltf", {"resources": "reference"}), ("in/m.gltf", "out/m.glb", {})]
    run.folder_of("out")
    run.write("m.jsonl", lines_of([{"in": mesh, "lattice": "l.json", "out": out, "options": options} for mesh, out, options in jobs]))
    anything = {"err": lambda said: None, "code": OK}
    run.ffd("batch", "m.jsonl", "-j", "2", "--depfile", "b.d", **anything)
    single = {}
    for mesh, out, options in jobs:
        run.ffd("deform", mesh, out, "-l", "l.json", "--force", "--depfile", "s.d",
                *[x for name, value in options.items() for x in ("--" + name, value)], **anything)
        single.update(rules(run, "s.d"))
    check("in/t.png" in next(inputs for outputs, inputs in single.items() if outputs.startswith("out/m.gltf ")), single)
    equal(rules(run, "b.d"), single)


@case
def a_job_that_is_ended_while_it_writes(run):
    """It leaves nothing, or all where the time was up when all was there; no temporary file, no folder of its own."""
    start(run, [{"in": "in/m.gltf", "lattice": "l.json", "out": "out/m.gltf"}])
    write_gltf(run, "in/m.gltf", ["tex/t.png"])
    run.write("in/tex/t.png", PNG)
    os.truncate(run.path("in/tex/t.png"), 30 * 10 ** 6)
    ended_early = 0
    for timeout in ("0.002", "0.006", "0.008", "0.01", "0.012", "0.015", "0.02", "0.03", "0.05"):
        run.folder_of("out")
        done = run.ffd("batch", "m.jsonl", "--timeout", timeout, code=(OK, NO), err=lambda said: None)
        left = {os.path.relpath(os.path.join(folder, name), run.path("out")) for folder, folders, files in os.walk(run.path("out"))
                for name in folders + files}
        check(done.code == OK or "took longer than " in done.err[0], done.err)
        check(not left and done.code == NO or {"m.gltf", "tex", "tex/t.png"} < left and len(left) == 4, f"left after {timeout} s: {left}")
        if left:
            equal(os.path.getsize(run.path("out/tex/t.png")), 30 * 10 ** 6, f"the image's size after {timeout} s")
        ended_early += not left
        shutil.rmtree(run.path("out"))
    check(ended_early, "no job was ended")


def judge_open_quote(run, lines):
    """Whatever follows a quote that is never closed is one bad row, and none of its lines is a job."""
    start(run)
    run.write("t.csv", 'in,lattice,out\n"a.obj,l.json,o0.obj\n' + lines)
    for name in ("t.csv", "-"):
        with open(run.path("t.csv"), "rb") as table:
            process = begin(run, "--csv", name, stdin=table)
        said = ended(process, 3)
        check(process.returncode in (NO, INVALID), process.returncode, said[:1000])
        check(len(said.splitlines()) <= 2 and ":2: " in said, said[:1000])
    check(not run.exists("o0.obj") and not run.exists("o1.obj"), "a bad table was taken")


@case
def a_quote_that_is_never_closed(run):
    """Each line is looked at once, and not once more for each line behind it."""
    judge_open_quote(run, "a,b\n" * 200000)


@case
def a_quote_over_more_than_a_line_may_have(run):
    judge_open_quote(run, "a.obj,l.json,o1.obj\n" * 200000)


@case
def a_terminal_s_interrupt_at_the_start(run):
    """Workers that have hardly begun are not ended by it: a job of theirs would be told as crashed."""
    start(run, [job(i, out=f"out/{i}.obj") for i in range(500)])
    run.folder_of("out")
    for i in range(5 if SANITIZED else 14):
        process = begin(run, "m.jsonl", "-j", "4", "--force", "--report", "r.json")
        time.sleep(0.002 + i % 7 * 0.001)
        begun = time.monotonic()
        os.killpg(process.pid, signal.SIGINT)
        said = ended(process)
        seconds = time.monotonic() - begun
        check("crashed" not in said and "Interrupt" not in said, said)
        check(process.returncode in (OK, NO, -signal.SIGINT, 128 + signal.SIGINT), process.returncode, said)
        run.check_no_leftovers()
        if run.exists("r.json"):
            # A job that goes on is stopped 0.4 s after the signal, and no sooner: a machine that is busy may take that long.
            errors = [e["error"] for e in report(run) if e["status"] == "failed"]
            equal(errors if seconds < 0.4 else [error for error in errors if not error.endswith("was stopped before it ended")], [], said)
            run.remove("r.json")


@case
def names_that_are_none(run):
    bad = [(name, value) for name in ("", "=", "normals=keep", "=keep", "a=b", "normals=", "force=") for value in (True, False, "keep", 1)]
    start(run, [job(0)] + [job(99, options={name: value}) for name, value in bad] + [job(1)])
    batch(run, "m.jsonl", "--report", "r.json", done=2, failed=[rf"^m\.jsonl:{i}: " for i in range(2, 2 + len(bad))])
    equal([e["exit"] for e in report(run)], [OK] + [INVALID] * len(bad) + [OK])
    check(not run.exists("o99.obj"), "a bad job wrote")
    for header in (b"in,lattice,out,\xff", b"in,lattice,out,H\xc3", b'\xfe,in,lattice,out', b'in,lattice,out,"\xed\xa0\x80"'):
        run.write("t.csv", header + b"\na.obj,l.json,o99.obj,1\n")
        said = run.ffd("batch", "--csv", "t.csv", code=INVALID).err[0]
        check(said.startswith("t.csv:1: "), header, said)
    check(not run.exists("o99.obj"), "a bad table wrote")


main()
