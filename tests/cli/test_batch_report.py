#!/usr/bin/env python3
"""ffd batch and its report: it grows as jobs end, what has ended stays when the run is killed, skipped jobs have the
figures of the run that made their outputs, and entries and messages say the line and what it sets."""

import json
import os
import signal
import struct
import subprocess

from batches import batch, case, check, equal, job, lattice, lines_of, main, report, start, statuses
from harness import CUBE, CUBE_CORNERS, FFD, IO, NO, OK, PNG, SANITIZED, SECONDS, wait_until

HEIGHT = [{"by": [0, {"$": "H"}, 0]}]


def entries(run, name):
    """Those of a report of JSON Lines."""
    return [json.loads(line) for line in run.text(name).splitlines()]


def running(run, *arguments):
    return subprocess.Popen([FFD, "batch", *arguments], cwd=run.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)


def line(number, **members):
    return (json.dumps(job(number, **members)) + "\n").encode()


@case
def what_has_ended_is_there(run):
    """While the run waits for more, and after it was killed; so was what a later job did while one before it runs."""
    def has(read, count):
        try:
            return len(read()) >= count
        except ValueError:  # systems may show a write that they are in the middle of
            return False

    start(run)
    run.write("long.obj", CUBE * 200000)
    for name, read in (("r.json", lambda: report(run)), ("r.jsonl", lambda: entries(run, "r.jsonl"))):
        process = running(run, "-", "-j", "2", "--force", "--report", name)
        wait_until(lambda: run.exists(name), "it does not come")
        equal(read(), [], "before the first job")
        for i in range(3):
            process.stdin.write(line(i))
            process.stdin.flush()
            wait_until(lambda: has(read, i + 1), "it does not come")
        process.stdin.write(line(7, **{"in": "long.obj"}) + line(8))
        process.stdin.flush()
        wait_until(lambda: has(read, 4), "it does not come")
        process.kill()
        process.communicate(timeout=SECONDS)
        equal([e["output"] for e in read()][:4], ["o0.obj", "o1.obj", "o2.obj", "o8.obj"], name)
        for leftover in run.names():
            if "ffd-tmp" in leftover:  # of the worker whose run was killed
                run.remove(leftover)
        # The next run replaces it.
        run.write("m.jsonl", line(5).decode())
        batch(run, "m.jsonl", "--force", "--report", name, done=1)
        equal([e["output"] for e in read()], ["o5.obj"])


@case
def a_report_is_whole_at_any_moment(run):
    """Killed at random moments it is JSON of jobs that have ended."""
    count = 400
    start(run, [job(i, out=f"out/{i}.obj") for i in range(count)])
    run.folder_of("out")
    for made in (1, 50, 200):
        process = running(run, "m.jsonl", "-j", "3", "--force", "--report", "r.json")
        wait_until(lambda: run.exists("r.json") and run.read("r.json").count(b'"status": "ok"') >= made or process.poll() is not None,
                   "it does not come")
        process.kill()
        process.communicate(timeout=SECONDS)
        try:
            jobs = report(run)
        except ValueError:  # the system may cut a write that it was in the middle of
            text = run.text("r.json")
            jobs = json.loads(text[:text.rfind("\n    },")] + "\n    }\n  ]\n}")["jobs"]
        check(len(jobs) >= made, len(jobs), "of", made)
        equal({e["status"] for e in jobs}, {"ok"})
        for entry in jobs:
            check(run.exists(entry["output"]), entry["output"])


@case
def the_order_of_json_lines(run):
    """As jobs end; with --report-stable as they stand in the manifest, whatever ends first."""
    start(run, [job(0, **{"in": "long.obj"}), "bad", *[job(i) for i in range(1, 30)]])
    run.write("long.obj", CUBE * (20000 if SANITIZED else 80000))  # longer than any start of a worker
    outputs = [None if i == 1 else f"o{max(i - 1, 0)}.obj" for i in range(31)]
    outputs[0] = "o0.obj"
    run.ffd("batch", "m.jsonl", "-j", "2", "--report", "r.jsonl", code=NO, err=lambda said: None)
    found = [e["output"] for e in entries(run, "r.jsonl")]
    equal(sorted(map(str, found)), sorted(map(str, outputs)))
    check(found[0] != "o0.obj", "the long job ended first")
    run.ffd("batch", "m.jsonl", "-j", "2", "--force", "--report", "s.jsonl", "--report-stable", code=NO, err=lambda said: None)
    equal([e["output"] for e in entries(run, "s.jsonl")], outputs)
    run.ffd("batch", "m.jsonl", "-j", "2", "--force", "--report", "s.json", "--report-stable", code=NO, err=lambda said: None)
    equal(report(run, "s.json"), entries(run, "s.jsonl"))
    # Merging takes and makes both.
    equal(json.loads(run.ffd("report", "merge", "s.jsonl").out)["jobs"], report(run, "s.json"))
    run.ffd("report", "merge", "s.json", "-o", "t.jsonl")
    equal(run.read("t.jsonl"), run.read("s.jsonl"))
    run.ffd("report", "merge", "s.jsonl", "s.json", "-o", "t.json")
    equal(report(run, "t.json"), report(run, "s.json") * 2)


@case
def broken_lines_are_refused(run):
    start(run, [job(0)])
    batch(run, "m.jsonl", "--report", "r.jsonl", done=1)
    whole = run.read("r.jsonl")
    for text, told in ((whole + b"x", "r.jsonl:2: "), (whole + b'{"input": 3}', "r.jsonl:2: "), (whole[:-3], "r.jsonl:1: "),
                       (b'{"format": "ffd-report", "version": 1, "jobs": []}', "r.jsonl:1: ")):
        run.write("r.jsonl", text)
        said = run.ffd("report", "merge", "r.jsonl", code=4).err[0]
        check(said.startswith(told), text, said)
    # Each kind replaces its own.
    for old, name in ((whole, "x.json"), (b'{"format": "ffd-report", "version": 1, "jobs": []}\n', "x.jsonl"), (b"{}\n", "x.jsonl"), (b"x", "x.jsonl")):
        run.write(name, old)
        run.ffd("batch", "m.jsonl", "--force", "--report", name, code=IO)
        equal(run.read(name), old)
    run.write("x.jsonl", whole)
    batch(run, "m.jsonl", "--force", "--report", "x.jsonl", done=1)


@case
def two_runs_with_one_report(run):
    start(run)
    process = running(run, "-", "--report", "r.json")
    wait_until(lambda: run.exists("r.json"), "it does not come")
    run.write("m.jsonl", lines_of([job(1)]))
    run.ffd("batch", "m.jsonl", "--report", "r.json", code=IO, err="r.json: is being written by another run")
    process.stdin.write(line(0))
    process.communicate(timeout=SECONDS)
    equal((process.returncode, statuses(run)), (OK, ["ok"]))
    batch(run, "m.jsonl", "--report", "r.json", done=1)


def figures(entry):
    return {name: value for name, value in entry.items() if name not in ("status", "seconds")}


@case
def skipped_jobs_have_their_figures(run):
    start(run, [job(i, lattice="p.json", set={"H": i / 8}, **({"in": "b.obj"} if i == 2 else {})) for i in range(4)])
    run.write("b.obj", CUBE + "v 9 9 9\nf 1 2 9\n")
    run.write("p.json", lattice(moves=HEIGHT))
    anything = {"err": lambda said: None}
    run.ffd("batch", "m.jsonl", "--resume", "--report", "r.json", **anything)
    made = report(run)
    check(made[2]["outside"] == 1 and made[2]["folds"] and made[3]["moved"] == 8 and made[3]["displacement"]["max"] == 0.375, made)
    run.ffd("batch", "m.jsonl", "--resume", "--report", "s.json", **anything)
    kept = report(run, "s.json")
    equal([e["status"] for e in kept], ["skipped"] * 4)
    equal([figures(e) for e in kept], [figures(e) for e in made])
    equal([e["seconds"] for e in kept], [e["seconds"] for e in made])
    run.ffd("batch", "m.jsonl", "--resume", "--report", "t.jsonl", "--report-stable", **anything)
    equal([figures(e) for e in entries(run, "t.jsonl")], [figures(e) for e in made])
    check("seconds" not in entries(run, "t.jsonl")[0], "times in a stable report")
    # A dry run and another manifest of the same jobs know them too; a job that is made again has its new ones.
    run.ffd("batch", "m.jsonl", "--resume", "--dry-run", "--report", "d.json", **anything)
    equal([figures(e) for e in report(run, "d.json")], [figures(e) for e in made])
    run.write("p.json", lattice(moves=[{"by": [0.5, {"$": "H"}, 0]}]))
    run.ffd("batch", "m.jsonl", "--resume", "--report", "r.json", **anything)
    run.ffd("batch", "m.jsonl", "--resume", "--report", "s.json", **anything)
    equal([figures(e) for e in report(run, "s.json")], [figures(e) for e in report(run)])
    check(report(run)[0]["displacement"]["max"] == 0.5, "the figures are old ones")


@case
def figures_that_a_dry_run_does_not_know(run):
    """The first job is done but for the writing; of the others there are none, and none is said to be 0."""
    start(run)
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json", "out": f"{n}.obj"} for n in range(4)]))
    run.ffd("batch", "m.jsonl", "--dry-run", "--report", "d.json", "-j", "1", err=lambda said: None)
    done, *planned = report(run, "d.json")
    check(done["vertices"] == 8 and "seconds" in done, done)
    equal([e["status"] for e in planned], ["ok"] * 3)
    for e in planned:
        equal({name for name, value in e.items() if value is not None}, {"line", "input", "output", "outputs", "set", "status", "exit"})
        check("seconds" not in e and set(done) - set(e) == {"seconds"}, e)


@case
def figures_of_a_run_without_a_report(run):
    """What was not looked for is null, and the rest is there."""
    start(run, [job(0)])
    batch(run, "m.jsonl", "--resume", done=1)
    batch(run, "m.jsonl", "--resume", "--report", "r.json", kept=1)
    entry = report(run)[0]
    equal([entry[name] for name in ("status", "vertices", "inside", "moved", "folds", "flipped_faces")], ["skipped", 8, 8, 8, None, 0])
    equal(entry["bounds"]["after"]["max"], [1.5, 1.25, 1.125])


@case
def damaged_figures_cost_the_job(run):
    """Its output is made again: figures are never wrong."""
    start(run, [job(i) for i in range(20)])
    batch(run, "m.jsonl", "--resume", "--journal", "j", "--report", "r.json", done=20)
    made = [figures(e) for e in report(run)]
    journal = bytearray(run.read("j"))
    where = journal.find(b'"vertices": 8')
    check(where > 0, "the journal has no figures")
    journal[where + len('"vertices": ')] = ord("9")
    run.write("j", bytes(journal))
    batch(run, "m.jsonl", "--resume", "--journal", "j", "--report", "r.json", done=1, kept=19)
    equal([figures(e) for e in report(run)], made)


@case
def entries_and_messages_say_what_was_set(run):
    start(run)
    run.write("p.json", lattice(high=(2, 2, 0), moves=[{"by": [0, {"$": "H"}, 0]}, {"twist": {"axis": {"$": "AXIS"}, "degrees": {"$": "D"}}}]))
    run.write("m.jsonl", lines_of([job(0, lattice="p.json", set={"H": 0.5, "AXIS": "x"}), job(1), job(2, lattice="p.json", set={"H": [1], "D": 2}),
                                   job(3, lattice="p.json", set={"H": 1e-3, "AXIS": "y: z", "D": 1}), job(4, option=1)]))
    done = run.ffd("batch", "m.jsonl", "-j1", "--set", "D=30", "--report", "r.json", code=NO, err=lambda said: None)
    equal([e["set"] for e in report(run)], [{"D": 30, "H": 0.5, "AXIS": "x"}, {"D": 30}, {"H": [1], "D": 2}, {"H": 0.001, "AXIS": "y: z", "D": 1}, {}])
    equal([e["line"] for e in report(run)], [1, 2, 3, 4, 5])
    starts = [["m.jsonl:1: D=30, H=0.5, AXIS=\"x\": a.obj: "], ["m.jsonl:2: D=30: l.json: "], ["m.jsonl:3: H=[1], D=2: p.json"],
              ["m.jsonl:4: H=0.001, AXIS=\"y: z\", D=1: p.json:1: /moves/1/twist/axis"], ["m.jsonl:5: unknown key"]]
    for begin in starts:
        check(any(said.startswith(begin[0]) for said in done.err), begin, "starts none of", done.err)
    check(all(said.startswith("m.jsonl:") for said in done.err[:-1]), done.err)
    # Long and strange values.
    run.write("m.jsonl", lines_of([job(9, lattice="p.json", set={"H": "a\nb\u00e4" * 100, "AXIS": "x", "D": 1})]))
    said = run.ffd("batch", "m.jsonl", code=NO, err=lambda said: None).err[0]
    check(said.startswith("m.jsonl:1: H=\"a") and len(said) < 700 and "...: " in said, said)
    # Lines of a pattern are nobody's.
    run.folder_of("out")
    run.ffd("batch", "--in", "a.obj", "-l", "p.json", "--out-dir", "out", "--set", "H=1", code=NO,
            err=lambda said: check(said[0].startswith("H=1: p.json:1: /moves/1/twist/"), said))


@case
def a_report_of_several_meshes_grows_too(run):
    """Of ffd deform and ffd check: killed in the second mesh, the first is there."""
    start(run)
    run.write("long.obj", CUBE * 300000)
    process = subprocess.Popen([FFD, "check", "a.obj", "long.obj", "-l", "l.json", "--report", "r.json"], cwd=run.folder,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(lambda: run.exists("r.json") and b'"a.obj"' in run.read("r.json"), "it does not come")
    process.send_signal(signal.SIGKILL)
    process.wait(timeout=SECONDS)
    equal([e["input"] for e in report(run)], ["a.obj"])
    # A link to a report stays one.
    os.symlink("r.json", run.path("link.json"))
    run.ffd("check", "a.obj", "-l", "l.json", "--report", "link.json")
    check(os.path.islink(run.path("link.json")), "the link was replaced")
    equal(len(report(run)), 1)
    os.chmod(run.path("r.json"), 0o440)
    run.ffd("check", "a.obj", "a.obj", "-l", "l.json", "--report", "r.json", err=lambda said: None)
    equal((len(report(run)), os.stat(run.path("r.json")).st_mode & 0o777), (2, 0o440))


def files_of(run):
    """All files with their times, but those of the run itself."""
    found = {os.path.relpath(os.path.join(folder, name), run.folder) for folder, _, names in os.walk(run.folder) for name in names}
    return {name for name in found if not name.startswith("cache/") and name not in ("r.json", "d", "v/index.html", "n/all.json")}


def asset_of(run):
    """A model with two buffers and an image below its folder, and an OBJ with a library and a map."""
    data = struct.pack("<24f", *[x for p in CUBE_CORNERS for x in p])
    views = [{"buffer": b, "byteLength": 96} for b in range(2)]
    accessors = [{"bufferView": b, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1] * 3, "max": [1] * 3} for b in range(2)]
    run.write("m/a.gltf", {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 1}],
                           "meshes": [{"primitives": [{"attributes": {"POSITION": b}, "mode": 0}]} for b in range(2)], "accessors": accessors,
                           "bufferViews": views, "buffers": [{"uri": f"b{b}.bin", "byteLength": 96} for b in range(2)],
                           "images": [{"uri": "t/wood.png"}, {"uri": "gone.png"}]})
    for b in range(2):
        run.write(f"m/b{b}.bin", data)
    run.write("m/t/wood.png", PNG)
    run.write("m/c.mtl", "newmtl a\nmap_Kd t/wood.png\n")
    run.write("m/c.obj", "mtllib c.mtl\n" + CUBE)


@case
def outputs_are_all_files_that_jobs_write(run):
    start(run)
    asset_of(run)
    mesh = {"in": "../m/a.gltf", "lattice": "../l.json"}
    run.write("j/m.jsonl", lines_of([{**mesh, "out": "../o/a.gltf"}, {**mesh, "out": "b/a.glb"}, {**mesh, "in": "../m/c.obj", "out": "../p/c.obj"},
                                     {**mesh, "in": "../m/c.obj", "out": "../p/c2.gltf"}, {**mesh, "in": "none.obj", "out": "x.obj"},
                                     {**mesh, "out": "../o/e.gltf"}, {**mesh, "out": "../q/e.gltf", "options": {"fail-on": "outside", "only": "mesh:none"}}]))
    expected = [["../o/a.gltf", "../o/a.bin", "../o/a-1.bin", "../o/t/wood.png"], ["b/a.glb"], ["../p/c.obj", "../p/c.mtl", "../p/t/wood.png"],
                ["../p/c2.gltf", "../p/c2.bin"], [], ["../o/e.gltf", "../o/e.bin", "../o/e-1.bin", "../o/t/wood.png"], []]
    before, quiet = files_of(run), {"err": lambda said: None}
    for words in (["--dry-run"], ["--depfile", "d", "-j3"], ["--resume"], ["--resume", "--dry-run"]):
        run.ffd("batch", "j/m.jsonl", *words, "--report", "r.json", code=NO, data=True, **quiet)
        found = [e["outputs"] for e in report(run)]
        # A dry run does not open the meshes of all jobs for what a selector names.
        equal(found[:6] + found[6:] * ("--dry-run" not in words), expected[:6] + expected[6:] * ("--dry-run" not in words), words)
        if "--depfile" in words:
            named = {os.path.normpath(os.path.join("j", name)) for names in expected for name in names}
            equal(files_of(run) - before, named)
    # What is up to date is a target too.
    run.write("j/m.jsonl", "".join(run.text("j/m.jsonl").splitlines(True)[:4]))
    run.ffd("batch", "j/m.jsonl", "--resume", "--depfile", "d", "--view", "v", **quiet)
    targets = [line.split(": ")[0].split(" ") for line in run.text("d").splitlines()]
    equal([[os.path.normpath(name) for name in names] for names in targets],
          [[os.path.normpath("j/" + name) for name in names] + [f"v/{os.path.normpath('j/' + names[0])[-len(names[0].lstrip('./')):]}.png"]
           for names in expected[:4]])


@case
def outputs_of_one_mesh(run):
    start(run)
    asset_of(run)
    quiet = {"err": lambda said: None}
    before = files_of(run)
    run.ffd("deform", "m/a.gltf", "m/c.obj", "--out-dir", "o", "-l", "l.json", "--report", "r.json", **quiet)
    equal([e["outputs"] for e in report(run)], [["o/a.gltf", "o/a.bin", "o/a-1.bin", "o/t/wood.png"], ["o/c.obj", "o/c.mtl", "o/t/wood.png"]])
    equal(files_of(run) - before, {name for e in report(run) for name in e["outputs"]})
    for words, outputs in ((["m/a.gltf", "./x.gltf", "--resources", "reference"], ["./x.gltf", "./x.bin", "./x-1.bin"]),
                           (["m/a.gltf", "-", "--output-format", "glb"], []), (["m/a.gltf", "--in-place"], ["m/a.gltf", "m/a.bin", "m/a-1.bin"])):
        run.ffd("deform", *words, "-l", "l.json", "--report", "r.json", **quiet)
        equal(report(run)[0]["outputs"], outputs, words)
    for words, outputs in (([], []), (["--picture", "p.png"], ["p.png"])):
        run.ffd("check", "m/c.obj", "-l", "l.json", *words, "--report", "r.json", "-q", **quiet)
        equal(report(run)[0]["outputs"], outputs, words)
    run.write("m.jsonl", lines_of([{"in": "m/c.obj", "lattice": "l.json"}, {"in": "m/c.obj", "lattice": "l.json", "out": "y/c.ply"}]))
    batch(run, "m.jsonl", "--positions", "n/all.npy", "--view", "v", "--report", "r.json", done=2)
    equal([e["outputs"] for e in report(run)], [["n/all.npy", "v/row-0.png"], ["y/c.ply", "n/all.npy", "v/y/c.ply.png"]])


main()
