#!/usr/bin/env python3
"""ffd batch --view of jobs on one mesh: one frame and one scale of colours, so that the pictures can be compared; and what jobs
say themselves of how they are drawn, and their pages."""

import json
import os
import re
import shutil
import signal
import subprocess

from batches import PLACE, PROGRESS, SUMMARY, batch, case, check, equal, job, lattice, lines_of, main, report, start
from harness import CUBE, FFD, INVALID, NO, OK, SANITIZED, SECONDS, USAGE, wait_until
from png import read_png
from urllib.parse import unquote

SIZE = ["--size", "320x180"]
BY = lattice(moves=[{"by": [{"$": "BY"}, 0, 0]}])
FOLD = [{"at": [1, 1, 1], "by": [30, 30, 30]}]
FAR = re.compile(r"1 of (\d+) pictures is not in the common frame, but has its own: (\S+) \(line (\d+)\) lies ([\d.]+) diagonals")
# So many that a signal comes before the last one is drawn.
JOBS = 16 if SANITIZED else 32


def sweep(run, values, **more):
    """A job for each value of the displacement."""
    start(run, [job(i, set={"BY": value}, **more) for i, value in enumerate(values)])
    run.write("l.json", BY)


def view(run, *arguments, name="m.jsonl", says=(), **options):
    """Runs the batch and checks the counts. says: patterns of lines beside those of jobs."""
    counts = [options.pop(count, 0) for count in ("done", "kept", "failed")]

    def judge(said):
        summary = SUMMARY.match(said[-1])
        check(summary, "no summary:", said)
        equal([int(summary[i]) for i in (2, 4, 5)], counts, f"done, up to date, failed of {said}")
        others = [line for line in said[:-1] if not PLACE.match(line) and not PROGRESS.match(line)]
        equal([bool(re.search(pattern, line)) for pattern, line in zip(says, others)], [True] * len(says), f"lines {others}")
        equal(len(others), len(says), f"lines {others}")
    return run.ffd("batch", name, "--view", "v", *SIZE, *arguments, err=judge, **{"code": NO if counts[2] else OK, **options})


def picture(run, number, folder="v"):
    return read_png(run.read(f"{folder}/o{number}.obj.png"))


def alone(run, value, *options):
    """The picture that `ffd view` makes of a job."""
    run.ffd("view", "a.obj", "-l", "l.json", "--set", f"BY={value}", "-o", "alone.png", "--force", *SIZE, *options, err=lambda said: None)
    return run.read("alone.png")


def left(rows):
    """The panel of the mesh before, without the caption and the legend."""
    return [row[:len(row) // 2 - 1] for row in rows[18:len(rows) * 2 // 3]]


def legend(rows):
    return rows[len(rows) * 5 // 6:]


@case
def the_mesh_before_is_the_same_in_all_rows(run):
    sweep(run, [0.25, 3, 0, -2])
    view(run, done=4)
    pictures = [picture(run, i) for i in range(4)]
    for i in range(1, 4):
        check(left(pictures[i]) == left(pictures[0]), f"the mesh before of job {i} is not that of job 0")
        check(legend(pictures[i]) == legend(pictures[0]), f"the scale of job {i} is not that of job 0")
        check(pictures[i] != pictures[0], f"the pictures of jobs {i} and 0 are equal")
    # Without the others each has a frame of its own, in which the mesh before has another size.
    for i, value in enumerate((0.25, 3)):
        run.write("m.jsonl", lines_of([job(i, set={"BY": value})]))
        view(run, "--force", done=1)
        equal(run.read(f"v/o{i}.obj.png") == alone(run, value), True, "the picture of one job, and of view")
        check(left(picture(run, i)) != left(pictures[0]), "a frame that is not the job's own")


@case
def every_colour_mode_and_every_row_of_pictures_has_one_frame(run):
    """Marks in the legend of one row leave room in the others."""
    start(run, [job(0), job(1, lattice="fold.json"), job(2, lattice="grow.json")])
    run.write("fold.json", lattice(moves=FOLD))
    run.write("grow.json", lattice(moves=[{"scale": {"factor": [1.5, 2, 2]}}]))
    for options in (["--color", "det"], ["--color", "status"], ["--color", "plain"], ["--frames", "3"], ["--camera", "top", "--up", "z"],
                    ["--no-cage"]):
        view(run, "--force", *options, done=3)
        first, *others = [picture(run, i) for i in range(3)]
        wide = len(first[0]) // 6 if "--frames" in options else 0
        for rows in others:
            equal([row[:wide or None] for row in left(rows)] == [row[:wide or None] for row in left(first)], True, options)
    # The end of the scale is the largest displacement of all: yellow, where a row moves so far as a whole.
    sweep(run, [1, 4, 0])
    view(run, "--force", done=3)
    yellow = [sum(r > 150 and g > 120 and b < 60 for row in picture(run, i)[18:120] for r, g, b in row) for i in range(3)]
    check(yellow[1] > 200 and yellow[0] == yellow[2] == 0, yellow)


@case
def a_row_that_flies_away_has_a_frame_of_its_own(run):
    sweep(run, [0.5, 1000, 1])
    view(run, "--report", "r.json", done=3, says=[FAR.pattern])
    equal([e.get("own_frame") for e in report(run)], [None, "far", None])
    equal([bool(re.search("o1.obj<.*in a frame of its own: it lies far away", row)) for row in run.text("v/index.html").split("<tr>")[2:]],
          [False, True, False])
    check(left(picture(run, 0)) == left(picture(run, 2)), "the others do not share a frame")
    equal(run.read("v/o1.obj.png") == alone(run, 1000), True, "its own picture")
    near = run.read("v/o0.obj.png"), run.read("v/o2.obj.png")
    # As if it were not there.
    sweep(run, [0.5, 1, 1])
    view(run, "--force", done=3)
    equal((run.read("v/o0.obj.png"), run.read("v/o2.obj.png")) == near, True, "the frame of the others")
    # The diagonal is that of the cube, 3.46: ten of it are 34.6 from its side.
    for by, is_far in ((34.5, False), (34.8, True)):
        sweep(run, [0.5, by])
        view(run, "--force", "--report", "r.json", done=2, says=[FAR.pattern] if is_far else [])
        equal(report(run)[1].get("own_frame"), "far" if is_far else None, by)
    # A single job leaves no frame, and quiet runs no line.
    sweep(run, [1000])
    view(run, "--force", "--report", "r.json", done=1)
    equal("own_frame" in report(run)[0], False)
    sweep(run, [1000, 1])
    run.ffd("batch", "m.jsonl", "--view", "v", *SIZE, "--force", "--quiet", err=[])
    # Of many some names are told.
    sweep(run, [0, *[1000] * 7])
    view(run, "--force", done=8, says=[r"7 of 8 pictures are not .* o4\.obj \(line 5\) lies 289 diagonals of the mesh away and 3 more$"])


@case
def a_job_with_other_options_has_a_frame_of_its_own(run):
    sweep(run, [0.5, 1, 2])
    jobs = [job(i, set={"BY": value}) for i, value in enumerate((0.5, 1, 2))]
    jobs[1]["options"] = {"view": {"camera": "front", "color": "det", "no-cage": True}}
    run.write("m.jsonl", lines_of(jobs))
    view(run, "--report", "r.json", done=3, says=[r'1 of 3 pictures .*: o1.obj \(line 2\) has other options of "view"$'])
    equal([e.get("own_frame") for e in report(run)], [None, "options", None])
    equal(run.read("v/o1.obj.png") == alone(run, 1, "--camera", "front", "--color", "det", "--no-cage"), True)
    check(left(picture(run, 0)) == left(picture(run, 2)), "the others do not share a frame")
    # Options that say what the batch says are no others; and those of most jobs are the common ones.
    view(run, "--force", "--camera", "front", "--color", "det", "--no-cage", done=3)
    jobs[2]["options"] = jobs[1]["options"]
    run.write("m.jsonl", lines_of(jobs))
    view(run, "--force", done=3, says=[r"1 of 3 pictures .*: o0.obj \(line 1\)"])
    check(left(picture(run, 1)) == left(picture(run, 2)), "the two do not share a frame")


@case
def each_option_of_a_job_is_that_of_view(run):
    start(run)
    run.write("l.json", BY)
    for mine, options in (({"camera": [1, 0.5, -2]}, ["--camera", "1,0.5,-2"]), ({"camera": "-1,0,2e-1"}, ["--camera=-1,0,0.2"]),
                          ({"camera": "left", "up": "z"}, ["--camera", "left", "--up", "z"]), ({"up": "x"}, ["--up", "x"]),
                          ({"frames": 3, "size": [80, 90]}, ["--frames", "3", "--size", "80x90"]),
                          ({"size": "100x90", "frames": "2"}, ["--frames", "2", "--size", "100x90"]),
                          ({"no-cage": True, "color": "plain"}, ["--no-cage", "--color", "plain"]), ({"no-cage": False}, [])):
        run.write("m.jsonl", lines_of([job(0, set={"BY": 1}, options={"view": mine})]))
        view(run, "--force", done=1)
        equal(run.read("v/o0.obj.png") == alone(run, 1, *options), True, mine)
    # A side that the batch names turns with the axis of the job.
    run.write("m.jsonl", lines_of([job(0, set={"BY": 1}, options={"view": {"up": "z"}})]))
    view(run, "--force", "--camera", "front", done=1)
    equal(run.read("v/o0.obj.png") == alone(run, 1, "--camera", "front", "--up", "z"), True)
    run.write("m.jsonl", lines_of([job(0, set={"BY": 1}, options={"view": {"up": "y"}})]))
    view(run, "--force", "--camera", "left", "--up", "z", done=1)
    equal(run.read("v/o0.obj.png") == alone(run, 1, "--camera", "left"), True)
    view(run, "--force", "--camera", "1,2,3", "--up", "z", done=1)
    equal(run.read("v/o0.obj.png") == alone(run, 1, "--camera", "1,2,3"), True)
    # It changes nothing of the output, nor of a run without pictures.
    run.ffd("batch", "m.jsonl", "--resume", err=lambda said: None)
    run.write("m.jsonl", lines_of([job(0, set={"BY": 1}, options={"view": {"up": "y"}})]))
    batch(run, "m.jsonl", "--resume", kept=1)


@case
def wrong_options_of_a_job_are_told(run):
    for mine, why in (({"camra": "front"}, r'"view": unknown key "camra" \(the nearest known one is "camera"\)'),
                      ({"full": True}, r'"view": unknown key "full" \(known ones are "size", "frames"'),
                      ({"camera": "frnt"}, r'"view": camera: unknown "frnt" \(the nearest known one is "front"\)'),
                      ({"camera": [0, 0, 0]}, "camera"), ({"camera": [1, 2]}, "camera"), ({"camera": [1, 2, "x"]}, "camera"),
                      ({"camera": [1, 2, 1e999]}, None), ({"up": "w"}, "up"), ({"color": 3}, "color"), ({"size": "15x90"}, "size"),
                      ({"size": [90]}, "size"), ({"frames": 1}, "frames"), ({"frames": 65}, "frames"), ({"frames": 2.5}, "frames"),
                      ({"no-cage": "yes"}, "no-cage"), ({"camera": {}}, "camera"), ({"camera": None}, "camera"), ("front", '"view" is not an object'),
                      (True, '"view" is not an object')):
        start(run, [job(0, options={"view": mine}), job(1)])
        for more in ([], ["--view", "v"]):
            batch(run, "m.jsonl", *more, "--force", done=1, failed=[rf"^m\.jsonl:1: .*{why}" if why else "^m.jsonl:1: "])
    start(run, [job(0, options={"camera": "front"}), job(1, options={"veiw": {}}), job(2, options={"pages": True})])
    batch(run, "m.jsonl", failed=['"camera" is an option of "view": {"view": {"camera": ..}}', r"unknown option veiw \(nearest: view\)",
                                  '"pages" is not an option of a job'])


@case
def each_mesh_has_its_frame(run):
    """One that a single job has is drawn as alone; names that lead to one file are one mesh."""
    start(run, [job(0, set={"BY": 0.5}), job(1, set={"BY": 3}, **{"in": "b.obj"}), job(2, set={"BY": 2}, **{"in": "./a.obj"})])
    run.write("l.json", BY)
    run.write("b.obj", CUBE)
    view(run, done=3)
    check(left(picture(run, 0)) == left(picture(run, 2)), "one mesh does not share a frame")
    equal(run.read("v/o1.obj.png") == alone(run, 3), True)
    # A table has its rows' frame, a pattern none.
    run.write("t.csv", "BY\n0.5\n2\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "l.json", "--out-dir", "o", "--view", "t", *SIZE, err=lambda said: None)
    check(run.read("t/a-1.obj.png") == run.read("v/o0.obj.png") and run.read("t/a-2.obj.png") == run.read("v/o2.obj.png"), "of a table")
    run.ffd("batch", "--in", "[ab].obj", "-l", "l.json", "--set", "BY=3", "--out-dir", "p", "--view", "p", *SIZE, err=lambda said: None)
    check(run.read("p/a.obj.png") == run.read("p/b.obj.png") == alone(run, 3), "of a pattern")


@case
def a_shard_has_its_own_frame(run):
    sweep(run, [0.5, 3, 1])
    for shard in range(2):
        view(run, "--shard", f"{shard}/2", done=2 - shard)
    equal(run.read("v/o1.obj.png") == alone(run, 3), True, "a shard of one job")
    first = run.read("v/o0.obj.png")
    sweep(run, [0.5, 1])
    view(run, "--force", done=2)
    equal(run.read("v/o0.obj.png") == first, True, "the shard's own frame")


@case
def workers_and_streams_change_no_picture(run):
    sweep(run, [0.5, 3, 1, 2])
    view(run, "-j", "1", "--report", "r.json", done=4)
    before = [run.read(f"v/o{i}.obj.png") for i in range(4)], [e["displacement"]["max"] for e in report(run)]
    view(run, "-j", "4", "--force", "--report", "r.json", done=4)
    equal(([run.read(f"v/o{i}.obj.png") for i in range(4)], [e["displacement"]["max"] for e in report(run)]) == before, True)
    text = run.read("m.jsonl")
    shutil.rmtree(run.path("v"))
    view(run, "--force", name="-", stdin=text, done=4)
    equal([run.read(f"v/o{i}.obj.png") for i in range(4)] == before[0], True, "of a stream")
    # Rows of an array, without meshes.
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json", "set": {"BY": by}} for by in (0.5, 3, 1, 2)]))
    view(run, "--positions", "all.npy", "--force", done=4)
    equal([run.read(f"v/row-{i}.png") for i in range(4)] == before[0], True, "of rows")


@case
def resume_draws_what_has_another_frame(run):
    sweep(run, [0.5, 1])
    view(run, "--resume", done=2)
    view(run, "--resume", kept=2)

    def times():
        return [os.stat(run.path(f"v/o{i}.obj.png")).st_mtime_ns for i in range(2)]
    meshes = [os.stat(run.path(f"o{i}.obj")).st_mtime_ns for i in range(2)]
    # A third row within the frame, then one that widens it.
    before = times()
    sweep(run, [0.5, 1, 0.75])
    view(run, "--resume", done=1, kept=2)
    equal(times(), before, "pictures whose frame is as it was")
    sweep(run, [0.5, 1, 2])
    run.ffd("batch", "m.jsonl", "--view", "v", *SIZE, "--resume", "--dry-run", err=lambda said: None,
            out="up to date: a.obj -> o0.obj\nup to date: a.obj -> o1.obj\nto do: a.obj -> o2.obj\n")
    view(run, "--resume", "--report", "r.json", done=3)
    check(all(a != b for a, b in zip(times(), before)), "pictures with the old frame")
    check(left(picture(run, 0)) == left(picture(run, 1)) == left(picture(run, 2)), "frames")
    equal([(e["status"], e["vertices"], e["displacement"]["max"]) for e in report(run)], [("ok", 8, 0.5), ("ok", 8, 1.0), ("ok", 8, 2.0)])
    equal([os.stat(run.path(f"o{i}.obj")).st_mtime_ns for i in range(2)], meshes, "meshes that were there")
    view(run, "--resume", kept=3)
    # Other options.
    view(run, "--resume", "--camera", "front", done=3)
    view(run, "--resume", "--camera", "front", kept=3)
    # A picture that somebody has changed; a run without a journal knows none.
    run.write("v/o1.obj.png", run.read("v/o0.obj.png"))
    view(run, "--resume", "--camera", "front", done=1, kept=2)
    check(run.read("v/o1.obj.png") != run.read("v/o0.obj.png"), "the picture of another job")
    # A row that is dropped: the frame is smaller again.
    sweep(run, [0.5, 1])
    view(run, "--resume", done=2)


@case
def a_picture_without_a_known_frame_is_measured_again(run):
    """A pattern's jobs have no common frame: the journal does not tell how far their pictures reach."""
    start(run, [])
    run.write("far.json", lattice(moves=[{"by": [4, 0, 0]}]))
    run.write("near.json", lattice(moves=[{"by": [0.5, 0, 0]}]))
    run.write("two.csv", "out,lattice\na.obj,far.json\nb.obj,near.json\n")

    def draw(*jobs, out="o"):
        run.ffd("batch", "--in", "a.obj", *jobs, "--out-dir", out, "--view", "v" + out, "--journal", out + ".journal", *SIZE,
                err=lambda said: None)
    draw("-l", "far.json")
    draw("--csv", "two.csv", "--resume")
    draw("--csv", "two.csv", out="p")
    for name in ("a", "b"):
        equal(run.read(f"vo/{name}.obj.png") == run.read(f"vp/{name}.obj.png"), True, f"the picture of {name}")


def streamed(run, *arguments):
    """A batch whose manifest comes bit by bit: the last job has not ended before it is closed."""
    process = subprocess.Popen([FFD, "batch", "-", "--view", "v", *SIZE, *arguments], cwd=run.folder, stdin=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    process.stdin.write(run.read("m.jsonl"))
    process.stdin.flush()
    wait_until(lambda: run.exists("o0.obj") and run.exists("o1.obj"), "the first jobs do not end")
    return process


def ended(process):
    said = process.communicate(timeout=SECONDS)[1].decode().splitlines()
    return process.returncode, said


@case
def pictures_are_drawn_when_the_last_job_has_ended(run):
    sweep(run, [0.5, 1])
    process = streamed(run, "--report", "r.jsonl")
    equal([name for name in os.listdir(run.path("v")) if name.endswith(".png")], [], "pictures before the last job")
    process.stdin.write(lines_of([job(2, set={"BY": 4})]).encode())
    equal(ended(process)[0], OK)
    check(left(picture(run, 0)) == left(picture(run, 1)) == left(picture(run, 2)), "frames")


@case
def what_changes_before_it_is_drawn_fails_its_job(run):
    """Its picture would show what was not made."""
    sweep(run, [0.5, 1])
    run.write("m.json", BY)
    run.write("m.jsonl", lines_of([job(0, set={"BY": 0.5}, lattice="m.json"), job(1, set={"BY": 1})]))
    process = streamed(run, "--report", "r.json")
    run.write("m.json", lattice(moves=[{"by": [{"$": "BY"}, 1, 0]}]))
    code, said = ended(process)
    equal(code, NO, said)
    check(any("standard input:1: BY=0.5: v/o0.obj.png: not drawn: the mesh or a lattice has changed since the job has ended" in line
              for line in said), said)
    first, second = report(run)
    equal((first["status"], first["exit"], first["outputs"], "picture" in first), ("failed", INVALID, [], False))
    equal((second["status"], second["picture"], second["outputs"]), ("ok", "v/o1.obj.png", ["o1.obj", "v/o1.obj.png"]))
    check(not run.exists("v/o0.obj.png"), "a picture of what was not made")


@case
def a_picture_that_cannot_be_drawn_fails_its_job(run):
    for stops in (False, True):
        sweep(run, [0.5, 1])
        shutil.rmtree(run.path("v"), ignore_errors=True)
        process = streamed(run, "-j1", "--report", "r.json", "--force", *(["--stop"] if stops else []))
        run.folder_of("v/o0.obj.png/x")
        code, said = ended(process)
        equal(code, NO, said)
        check(any(re.search("standard input:1: BY=0.5: v/o0.obj.png", line) for line in said), said)
        equal([(e["status"], "picture" in e) for e in report(run)], [("failed", False), ("ok", not stops)], said)
        check(said[-1].endswith("the other pictures were not drawn (--stop)") == stops, said)
        run.remove("o0.obj")
        run.remove("o1.obj")


@case
def a_job_that_fails_stops_jobs_not_pictures(run):
    """Also one that a gate refuses, which has its picture."""
    start(run, [job(0), job(1, lattice="fold.json", options={"fail-on": "folds"}), job(2)])
    run.write("fold.json", lattice(moves=FOLD))
    run.ffd("batch", "m.jsonl", "--view", "v", *SIZE, "--stop", "-j1", "--report", "r.json", code=NO, err=lambda said: None)
    equal([(e["status"], e["picture"], e["outputs"]) for e in report(run)],
          [("ok", "v/o0.obj.png", ["o0.obj", "v/o0.obj.png"]), ("failed", "v/o1.obj.png", ["v/o1.obj.png"])])
    check(left(picture(run, 0)) == left(picture(run, 1)), "a refused job does not share the frame")


@case
def a_signal_leaves_jobs_that_are_done(run):
    """While pictures are drawn, which a resumed run then draws without making the meshes again."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        sweep(run, [i / JOBS for i in range(JOBS)])
        process = subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", "--view", "v", "--report", "r.json"], cwd=run.folder,
                                   stderr=subprocess.PIPE, start_new_session=True)
        # Of two workers the one with the second job may be done first; the fifth begins when three have ended.
        wait_until(lambda: run.exists("v/o4.obj.png") or process.poll() is not None, "pictures do not come")
        check(process.poll() is None, "it ended before the signal came")
        os.killpg(process.pid, number)
        process.communicate(timeout=SECONDS)
        check(all(run.exists(f"o{i}.obj") for i in range(JOBS)), "a mesh is missing")
        if number == signal.SIGTERM:
            run.check_no_leftovers()
            entries = report(run)
            equal(len(entries), JOBS)
            check(2 <= sum("picture" in e for e in entries) < JOBS, "pictures")
            equal(all(e["status"] == "ok" for e in entries if "picture" in e), True)
            check(sum(e["status"] == "failed" for e in entries) <= 2, "jobs without pictures have failed")
        meshes = [os.stat(run.path(f"o{i}.obj")).st_mtime_ns for i in range(JOBS)]
        run.ffd("batch", "m.jsonl", "--view", "v", "--resume", "--report", "r.json", err=lambda said: None)
        equal([os.stat(run.path(f"o{i}.obj")).st_mtime_ns for i in range(JOBS)], meshes, "meshes that were there")
        equal([e["picture"] for e in report(run)], [f"v/o{i}.obj.png" for i in range(JOBS)])
        for folder in ("v", "cache"):
            shutil.rmtree(run.path(folder))
        for i in range(JOBS):
            run.remove(f"o{i}.obj")


@case
def pages_stand_beside_pictures(run):
    sweep(run, [0.5, 3])
    run.ffd("batch", "m.jsonl", "--pages", code=USAGE, err=re.compile("--pages needs --view"))
    jobs = [job(0, set={"BY": 0.5}), {**job(1, set={"BY": 3}), "out": "d/o 1.obj"}]
    run.write("m.jsonl", lines_of(jobs))
    view(run, "--pages", "--report", "r.json", "--depfile", "d.d", done=2)
    pages = ["v/o0.obj.html", "v/d/o 1.obj.html"]
    equal([e["page"] for e in report(run)], pages)
    equal([e["outputs"] for e in report(run)], [["o0.obj", "v/o0.obj.png", pages[0]], ["d/o 1.obj", "v/d/o 1.obj.png", pages[1]]])
    run.ffd("view", "a.obj", "-l", "l.json", "--set", "BY=0.5", "-o", "p.html")
    equal(run.read(pages[0]) == run.read("p.html"), True, "the page of view")
    text = run.text("v/index.html")
    equal([unquote(link) for link in re.findall(r'<a href="([^"]+)">page</a>', text)], ["o0.obj.html", "d/o 1.obj.html"])
    equal(text.count("<img "), 2)
    check("v/o0.obj.html" in run.text("d.d"), run.text("d.d"))
    # They exist, and are those of the run.
    run.remove("v/o0.obj.png")
    run.remove("o0.obj")
    batch(run, "m.jsonl", "--view", "v2", "--pages", done=1, failed=["d/o 1.obj: exists already"])
    run.remove("o0.obj")
    os.makedirs(run.path("w"))
    run.write("w/o0.obj.html", "mine")
    batch(run, "m.jsonl", "--view", "w", "--pages", failed=["^w/o0.obj.html: exists already", "d/o 1.obj: exists already"])
    equal(run.text("w/o0.obj.html"), "mine")
    start(run, [job(0), {**job(), "out": "index", "options": {"output-format": "obj"}}])
    batch(run, "m.jsonl", "--view", "x", "--pages", done=1, failed=["x/index.html.*of this run"])
    # A resumed run makes them, and knows them.
    start(run, [job(0), job(1)])
    batch(run, "m.jsonl", "--view", "y", "--force", done=2)
    batch(run, "m.jsonl", "--view", "y", "--pages", "--resume", done=2)
    batch(run, "m.jsonl", "--view", "y", "--pages", "--resume", kept=2)
    check('href="o1.obj.html">page' in run.text("y/index.html"), "a page that was there")
    run.remove("y/o1.obj.html")
    batch(run, "m.jsonl", "--view", "y", "--pages", "--resume", done=1, kept=1)
    # Of a pattern, and of rows.
    run.ffd("batch", "--in", "a.obj", "-l", "l.json", "--out-dir", "p", "--view", "p", "--pages", err=lambda said: None)
    check(run.exists("p/a.obj.html"), "the page of a pattern")
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json"}]))
    batch(run, "m.jsonl", "--positions", "all.npy", "--view", "z", "--pages", done=1)
    check(run.exists("z/row-0.html"), "the page of a row")


@case
def reports_are_those_of_runs_without_pictures(run):
    """But for the pictures, in every form."""
    sweep(run, [0.5, 1])
    for name in ("r.json", "r.jsonl"):
        run.ffd("batch", "m.jsonl", "--report", name, "--report-stable", "--force", err=lambda said: None)
        plain = run.text(name)
        view(run, "--report", name, "--report-stable", "--force", done=2)
        shown = re.sub(r'\s*"picture": "[^"]*",', "", re.sub(r',\s*"v/o\d.obj.png"', "", run.text(name)))
        equal(re.sub(r"\s+", "", shown), re.sub(r"\s+", "", plain), name)
    equal([json.loads(line)["line"] for line in run.text("r.jsonl").splitlines()], [1, 2])


main()
