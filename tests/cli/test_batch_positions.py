#!/usr/bin/env python3
"""ffd batch --positions: a row of one array for each job, NaN until it is done, and a report that says what is in it."""

import math
import os
import re
import shutil
import signal
import struct
import subprocess
import time

from batches import FFD, batch, case, check, equal, job, lattice, lines_of, main, names, report, start
from gltf_build import Scene
from harness import CUBE, CUBE_CORNERS, INVALID, IO, NO, SANITIZED, SECONDS, USAGE, float32, near, npy, obj_vertices, wait_until
from report_schema import faults

ROWS = 6
MOVES = [{"twist": {"axis": "z", "degrees": {"$": "A"}}}, {"by": [{"$": "X"}, 0.1, 0]}]
NAN = "row"  # a row without positions


def sweep(run, rows=ROWS, **columns):
    """A table t.csv of so many rows for a.obj and the lattice s.json, whose cells are other in each."""
    start(run)
    run.write("s.json", lattice(moves=MOVES))
    cells = {"A": lambda i: 7.3 * i, "X": lambda i: i / 7, **columns}
    run.write("t.csv", ",".join(cells) + "\n" + "".join(",".join(str(f(i)) for f in cells.values()) + "\n" for i in range(rows)))


def table(*more):
    return ("--csv", "t.csv", "--in", "a.obj", "-l", "s.json", *more)


def array(run, name="all.npy"):
    """The dtype and the rows of an array: lists of vertices, or NAN."""
    descr, shape, values = npy(run.read(name))
    check(len(shape) == 3 and shape[2] == 3, shape)
    length = 3 * shape[1]
    rows = [values[i * length:(i + 1) * length] for i in range(shape[0])]
    found = []
    for row in rows:
        lost = sum(map(math.isnan, row))
        check(lost in (0, length), f"a row with {lost} of {length} numbers NaN")
        found.append(NAN if lost else [row[i:i + 3] for i in range(0, length, 3)])
    return descr, found


def single(run, i):
    """What deform makes of row i of a sweep."""
    run.ffd("deform", "a.obj", "single.obj", "-l", "s.json", "--set", f"A={7.3 * i}", "--set", f"X={i / 7}", "--force")
    return obj_vertices(run.text("single.obj"))


def entries(run, name="all.json"):
    equal(faults(run.text(name)), [], "the report beside the array against the schema")
    return report(run, name)


def as_floats(points):
    return [[float32(x) for x in p] for p in points]


@case
def rows_are_what_deform_writes(run):
    sweep(run)
    batch(run, *table("--positions", "all.npy", "--dtype", "f8"), done=ROWS)
    descr, rows = array(run)
    equal(descr, "<f8")
    expected = [single(run, i) for i in range(ROWS)]
    equal(rows, expected, "positions to the bit")
    equal(names(run), ["a.obj", "all.json", "all.npy", "l.json", "m.jsonl", "s.json", "single.obj", "t.csv"], "no meshes")
    equal([(e["line"], e["row"], e["positions"], e["input"], e["output"], e["status"]) for e in entries(run)],
          [(i + 2, i, "all.npy", "a.obj", None, "ok") for i in range(ROWS)])
    equal([e["set"] for e in entries(run)], [{"A": 7.3 * i, "X": i / 7} for i in range(ROWS)])
    equal([e["displacement"]["max"] > 0 for e in entries(run)], [True] * ROWS)
    batch(run, *table("--positions", "f4.npy"), done=ROWS)
    descr, rows = array(run, "f4.npy")
    equal((descr, rows), ("<f4", [as_floats(points) for points in expected]), "rounded once to float32")
    equal(len(run.read("f4.npy")), 128 + ROWS * 8 * 3 * 4, "the size of the file")
    # With a mesh beside the row, and with figures of quality, the row is the same.
    batch(run, *table("--positions", "more.npy", "--dtype", "f8", "--out-dir", ".", "--report", "r.json"), done=ROWS)
    equal(run.read("more.npy"), run.read("all.npy"))
    equal([obj_vertices(run.text(f"a-{i + 1}.obj")) for i in range(ROWS)], expected)
    equal([(e["row"], e["output"], e["flipped_faces"]) for e in report(run)], [(i, f"./a-{i + 1}.obj", 0) for i in range(ROWS)])
    equal([(e["row"], e["output"]) for e in entries(run, "more.json")], [(i, f"./a-{i + 1}.obj") for i in range(ROWS)])


@case
def rows_of_gltf_are_in_the_scene(run):
    """Two nodes of one mesh, one turned and scaled: as the conversion to OBJ places them, selected or not."""
    start(run)
    points = [[float(x), float(y), 0.25] for x in (0, 1) for y in (0, 1)]
    scene = Scene(scenes=[{"nodes": [0, 1]}], nodes=[
        {"mesh": 0, "name": "one"},
        {"mesh": 0, "name": "two", "translation": [1, 0, 0], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 1]}])
    scene.asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": scene.add(points, bounds=True)}, "mode": 0}]}]
    run.write("a.glb", scene.glb())
    for i, options in enumerate(([], ["--only", "node:two"])):
        run.ffd("deform", "a.glb", f"{i}.obj", "-l", "l.json", *options)
        run.write("m.jsonl", lines_of([{"in": "a.glb", "lattice": "l.json"}]))
        batch(run, "m.jsonl", "--positions", f"{i}.npy", "--dtype", "f8", *options, done=1)
        # The conversion goes through the file's float32 numbers, a row does not.
        near(array(run, f"{i}.npy")[1][0], obj_vertices(run.text(f"{i}.obj")), 1e-7, options)


@case
def nothing_is_said_of_joints_that_no_file_has(run):
    """Positions are those of --rig follow too."""
    start(run)
    shutil.copy(os.path.join(os.environ["FFD_DATA"], "models", "knight.glb"), run.path("a.glb"))
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"twist": {"axis": "y", "degrees": 50}}]))
    run.write("m.jsonl", lines_of([{"in": "a.glb", "lattice": "l.json"}, {"in": "a.glb", "lattice": "l.json", "options": {"rig": "follow"}}]))
    batch(run, "m.jsonl", "--positions", "all.npy", done=2)
    rows = array(run)[1]
    equal(rows[0], rows[1])
    said = []
    run.write("m.jsonl", lines_of([{"in": "a.glb", "lattice": "l.json", "out": "o.glb"}]))
    run.ffd("batch", "m.jsonl", "--positions", "out.npy", err=said.extend)
    check(any("--rig" in line for line in said), said)
    equal(array(run, "out.npy")[1], rows[:1])


@case
def rows_are_of_the_stored_shape(run):
    """Where the output shows a morph target, by its default weight, the row does not."""
    start(run)
    points = [[0.0, 0.0, 0.25], [1.0, 0.0, 0.25], [0.0, 1.0, 0.25]]
    scene = Scene(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}])
    primitive = {"attributes": {"POSITION": scene.add(points, bounds=True)},
                 "targets": [{"POSITION": scene.add([[0, 0, 0.5]] * 3, bounds=True)}]}
    scene.asset["meshes"] = [{"primitives": [primitive], "weights": [1]}]
    run.write("a.glb", scene.glb())
    run.write("m.jsonl", lines_of([{"in": "a.glb", "lattice": "l.json", "out": "o.obj"}, {"in": "a.glb", "lattice": "l.json"}]))
    run.ffd("batch", "m.jsonl", "--positions", "all.npy", "--dtype", "f8", "--report", "r.json", "--quiet")
    moved = [[x + 0.5, y + 0.25, z + 0.125] for x, y, z in points]
    equal(array(run)[1], [moved, moved])
    near(obj_vertices(run.text("o.obj")), [[x, y, z + 0.5] for x, y, z in moved], 1e-7)


@case
def a_job_that_fails_leaves_its_row(run):
    """A gate, a value of the wrong kind, a mesh that is missing, a crash of the disk: their rows are NaN, the others are whole."""
    start(run, [job(out="o0.obj"), {"in": "a.obj", "lattice": "fold.json", "options": {"fail-on": "folds"}},
                {"in": "gone.obj", "lattice": "l.json"}, "not JSON", {"in": "a.obj", "lattice": "l.json"},
                {"in": "a.obj", "lattice": "l.json", "out": "l.json/o.obj"}])
    run.write("fold.json", lattice(moves=[{"at": [1, 1, 1], "by": [30, 30, 30]}]))
    batch(run, "m.jsonl", "--positions", "all.npy", done=2, failed=["folds", "^gone.obj: ", "m.jsonl:4:", "^l.json/o.obj"])
    expected = as_floats([[x + 0.5, y + 0.25, z + 0.125] for x, y, z in CUBE_CORNERS])
    equal(array(run)[1], [expected, NAN, NAN, NAN, expected, NAN])
    equal([(e["row"], e["status"], e["output"]) for e in entries(run)],
          [(0, "ok", "o0.obj"), (1, "failed", None), (2, "failed", None), (3, "failed", None), (4, "ok", None),
           (5, "failed", "l.json/o.obj")])
    check(run.exists("o0.obj"), "the mesh of a job with out")


@case
def a_job_that_fails_clears_an_older_row(run):
    """A gate, a line, a mesh, a picture, in a run that goes on or that replaces rows; another run's row stays."""
    good = {"in": "a.obj", "lattice": "l.json"}
    start(run)
    run.write("fold.json", lattice(moves=[{"at": [1, 1, 1], "by": [30, 30, 30]}]))
    whole = as_floats([[x + 0.5, y + 0.25, z + 0.125] for x, y, z in CUBE_CORNERS])

    def make(jobs):
        run.write("m.jsonl", lines_of([good] * 4))
        batch(run, "m.jsonl", "--positions", "all.npy", "--force", done=4)
        run.write("m.jsonl", lines_of(jobs))

    bad = [good, {"in": "a.obj", "lattice": "fold.json", "options": {"fail-on": "folds"}}, "not JSON", {"in": "gone.obj", "lattice": "l.json"}]
    make(bad)
    batch(run, "m.jsonl", "--positions", "all.npy", "--resume", "--dry-run", kept=1, failed=["folds", "m.jsonl:3:", "^gone.obj: "],
          out="up to date: a.obj -> all.npy row 0\n")
    equal(array(run)[1], [whole] * 4, "a dry run")
    batch(run, "m.jsonl", "--positions", "all.npy", "--resume", kept=1, failed=["folds", "m.jsonl:3:", "^gone.obj: "])
    equal(array(run)[1], [whole, NAN, NAN, NAN])
    make(bad)
    batch(run, "m.jsonl", "--positions", "all.npy", "--shard", "1/2", failed=["row 1 is there already", "row 3 is there already"])
    batch(run, "m.jsonl", "--positions", "all.npy", "--shard", "0/2", failed=["row 0 is there already", "m.jsonl:3:"])
    equal(array(run)[1], [whole] * 4, "rows of another run")
    batch(run, "m.jsonl", "--positions", "all.npy", "--shard", "1/2", "--force", failed=["folds", "^gone.obj: "])
    equal(array(run)[1], [whole, NAN, whole, NAN])
    make([good] * 4)
    run.folder_of("v/row-1.png/mine")
    batch(run, "m.jsonl", "--positions", "all.npy", "--resume", "--view", "v", done=3, failed=["row-1.png: is a folder"])
    equal(array(run)[1], [whole, NAN, whole, whole])


@case
def an_array_stays_where_no_mesh_can_be_read(run):
    sweep(run)
    batch(run, *table("--positions", "all.npy"), done=ROWS)
    before = run.read("all.npy")
    run.remove("a.obj")
    done = run.ffd("batch", *table("--positions", "all.npy", "--force"), code=NO, err=lambda said: None)
    equal([line for line in done.err if "all.npy" in line], ["all.npy: stays as it is: no mesh could be read"])
    equal(run.read("all.npy"), before)


def has_child(number):
    """Whether a process has begun another one."""
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                if int(file.read().rpartition(")")[2].split()[1]) == number:
                    return True
        except OSError:  # it has ended
            pass
    return False


@case
def an_interrupt_while_vertices_are_counted_replaces_nothing(run):
    """A worker looks for a mesh that can be read, and so many are missing that the signal comes before the last."""
    start(run, [{"in": "gone.obj", "lattice": "l.json"}] * 200000)
    empty = '{"format": "ffd-report", "version": 1, "jobs": []}\n'
    run.write("all.npy", "mine")
    run.write("all.json", empty)
    process = subprocess.Popen([FFD, "batch", "m.jsonl", "--positions", "all.npy", "--force"], cwd=run.folder, stderr=subprocess.DEVNULL)
    wait_until(lambda: has_child(process.pid) or process.poll() is not None, "it has no worker")
    check(process.poll() is None, "it ended before the signal came")
    process.send_signal(signal.SIGINT)
    check(process.wait(timeout=SECONDS) in (NO, -signal.SIGINT, 128 + signal.SIGINT), process.returncode)
    equal([run.text("all.npy"), run.text("all.json")], ["mine", empty])


@case
def meshes_of_another_size_fail(run):
    """The first mesh that can be read says how many vertices a row has; nothing is written of one with others."""
    start(run, [{"in": "gone.obj", "lattice": "l.json"}, job(1), {"in": "b.obj", "lattice": "l.json", "out": "b2.obj"},
                {"in": "b.obj", "lattice": "l.json"}])
    run.write("b.obj", CUBE + "v 0 0 0\n")
    batch(run, "m.jsonl", "--positions", "all.npy", done=1,
          failed=["^gone.obj: ", *["^b.obj: has 9 vertices, but a row of all.npy is of 8, as many as the first mesh has"] * 2])
    equal([row == NAN for row in array(run)[1]], [True, False, True, True])
    check(not run.exists("b2.obj"), "a mesh without its row")
    # Where no mesh can be read, there is no array; each job says why.
    run.write("m.jsonl", lines_of([{"in": "gone.obj", "lattice": "l.json"}] * 2))
    batch(run, "m.jsonl", "--positions", "none.npy", failed=["^gone.obj: "] * 2)
    check(not run.exists("none.npy"), "an array of nothing")
    equal([e["row"] for e in entries(run, "none.json")], [0, 1])
    run.write("m.jsonl", "\n")
    run.ffd("batch", "m.jsonl", "--positions", "none.npy", err=lambda said: None)
    check(not run.exists("none.npy"), "an array of no jobs")


@case
def what_is_too_large_for_float32_fails(run):
    start(run, [{"in": "a.obj", "lattice": "l.json"}])
    run.write("l.json", lattice(moves=[{"by": [1e39, 0, 0]}]))
    fine = "m.jsonl:1: a.obj: doubles cannot hold: the precision of coordinates that far from the origin (off by up to 7.55579e+22, in a shape of 2)"
    done = run.ffd("batch", "m.jsonl", "--positions", "all.npy", code=NO, lines=3)
    equal(done.err[0], fine)
    check(re.match(r"m.jsonl:1: a.obj: the deformed position of vertex 0 is too large for the float32 numbers of all.npy \(--dtype f8\)", done.err[1]), done.err)
    equal(array(run)[1], [NAN])
    run.ffd("batch", "m.jsonl", "--positions", "wide.npy", "--dtype", "f8", err=lambda said: equal(said[:-1], [fine]))
    equal(array(run, "wide.npy")[1][0][0], [1e39, -1.0, -1.0])


@case
def an_array_that_exists_needs_force(run):
    sweep(run)
    batch(run, *table("--positions", "all.npy"), done=ROWS)
    before = run.read("all.npy")
    run.ffd("batch", *table("--positions", "all.npy"), code=IO, err=re.compile("^all.npy: exists already.*--force"))
    run.ffd("batch", *table("--positions", "all.npy", "--dry-run"), code=IO, err=re.compile("^all.npy: exists already"))
    for more in ([], ["--resume"], ["--shard", "0/2"], ["--shard", "0/2", "--force"]):
        run.ffd("batch", *table("--positions", "all.npy", "--dtype", "f8", *more), code=IO,
                err=re.compile(f"^all.npy: is there, and is not an array of {ROWS} x 8 x 3 float64 numbers"))
    equal(run.read("all.npy"), before)
    batch(run, *table("--positions", "all.npy", "--dtype", "f8", "--force"), done=ROWS)
    equal(array(run)[0], "<f8")
    run.write("other.npy", "mine")
    run.ffd("batch", *table("--positions", "other.npy", "--resume"), code=IO, err=re.compile("^other.npy: is there, and is not"))
    equal(run.text("other.npy"), "mine")
    # With --force it replaces its own kind.
    run.ffd("batch", *table("--positions", "other.npy", "--force"), code=IO, err="other.npy: exists and is not a NumPy array: it is not replaced")
    run.ffd("batch", *table("--positions", "other.npy", "--force", "--dry-run"), code=IO, err=re.compile("^other.npy: exists and is not"))
    equal(run.text("other.npy"), "mine")
    os.symlink("a.obj", run.path("link.npy"))
    run.ffd("batch", *table("--positions", "link.npy", "--force"), code=IO, err=re.compile("^link.npy: exists and is not a NumPy array"))
    equal(run.text("a.obj"), CUBE)


@case
def a_run_that_is_refused_leaves_the_array(run):
    """What stands beside the array, the report and the page are looked at before an array gets its name or is replaced."""
    sweep(run)
    batch(run, *table("--positions", "old.npy"), done=ROWS)
    before = [run.read("old.npy"), run.read("old.json")]
    for name in ("new.json", "r.json", "j.json"):
        run.write(name, "mine")
    run.write("v", "no folder")
    left = set(names(run))
    for arguments, why in ((("--positions", "new.npy"), "^new.json: exists and is not a report"),
                           (("--positions", "new2.npy", "--report", "r.json"), "^r.json: exists and is not a report"),
                           (("--positions", "new2.npy", "--report", "./new2.json"), "the report and the list of the rows of --positions have the same name"),
                           (("--positions", "new2.npy", "--journal", "j.json"), "^j.json: is not a journal"),
                           (("--positions", "new2.npy", "--view", "v"), "^v"),
                           (("--positions", "old.npy", "--report", "r.json", "--force"), "^r.json: exists and is not a report")):
        run.ffd("batch", *table(*arguments), code=(USAGE, IO, INVALID), err=re.compile(why))
        equal(set(names(run)), left, arguments)
        equal([run.read("old.npy"), run.read("old.json")], before, arguments)
    run.ffd("batch", *table("--positions", "new.npy", "--dry-run"), code=IO, err=re.compile("^new.json: exists and is not a report"))


@case
def an_array_that_is_made_is_left_when_interrupted(run):
    """Two gigabytes of NaN are not written to the end."""
    sweep(run, 9000)
    run.write("a.obj", "".join(f"v {i % 7} {i % 5} {i % 3}\n" for i in range(20000)))

    process = subprocess.Popen([FFD, "batch", *table("--positions", "all.npy")], cwd=run.folder, stderr=subprocess.PIPE)
    wait_until(lambda: run.exists(".all.npy.ffd-tmp") or process.poll() is not None, "it never got there")
    check(process.poll() is None, "it ended before the signal came")
    process.send_signal(signal.SIGINT)
    told = process.communicate(timeout=SECONDS)[1].decode()
    equal(process.returncode, NO, told)
    check("interrupted" in told, told)
    equal([name for name in names(run) if "npy" in name], [], "an array that was interrupted")


@case
def only_what_is_missing_is_made_again(run):
    sweep(run)
    batch(run, *table("--positions", "all.npy"), done=ROWS)
    before = run.read("all.npy")
    batch(run, *table("--positions", "all.npy", "--resume"), kept=ROWS)
    equal([(e["status"], e["row"], e["moved"]) for e in entries(run)], [("skipped", i, 8) for i in range(ROWS)])
    # A row that was lost, one that was changed, one whose cells are others now.
    size = 8 * 3 * 4
    broken = bytearray(before)
    broken[128 + size:128 + 2 * size] = struct.pack("<f", math.nan) * 24
    broken[128 + 3 * size + 50] ^= 1
    run.write("all.npy", bytes(broken))
    run.write("t.csv", run.text("t.csv").replace(f"{7.3 * 4},", "5,"))
    batch(run, *table("--positions", "all.npy", "--resume", "--dry-run"), done=3, kept=3)
    equal(run.read("all.npy"), bytes(broken), "a dry run")
    batch(run, *table("--positions", "all.npy", "--resume"), done=3, kept=3)
    after = run.read("all.npy")
    equal([after[128 + i * size:128 + (i + 1) * size] == before[128 + i * size:128 + (i + 1) * size] for i in range(ROWS)],
          [True] * 4 + [False, True])
    run.remove("all.npy")
    batch(run, *table("--positions", "all.npy", "--resume"), done=ROWS)
    equal(run.read("all.npy"), after)
    # A mesh beside the row that is gone, too.
    batch(run, *table("--positions", "m.npy", "--out-dir", "."), done=ROWS)
    run.remove("a-2.obj")
    batch(run, *table("--positions", "m.npy", "--out-dir", ".", "--resume"), done=1, kept=ROWS - 1)
    check(run.exists("a-2.obj"), "a mesh that was gone")


@case
def what_a_killed_run_has_done_stays(run):
    """The array has its size at once; killed by SIGKILL, each row is whole or NaN, and the next run makes the others."""
    count = 40 if SANITIZED else 400
    sweep(run, count)
    process = subprocess.Popen([FFD, "batch", *table("--positions", "all.npy", "-j", "2")], cwd=run.folder, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    limit, rows = time.monotonic() + SECONDS, [NAN]
    while sum(row != NAN for row in rows) < 5 and time.monotonic() < limit:
        check(process.poll() is None, "it ended before it was killed")
        if run.exists("all.npy"):
            equal(len(run.read("all.npy")), 128 + count * 96, "the size from the beginning")
            with open(run.path("all.npy"), "rb") as file:
                data = file.read()
            rows = [NAN if math.isnan(struct.unpack_from("<f", data, 128 + 96 * i)[0]) else 0 for i in range(count)]
    os.killpg(process.pid, signal.SIGKILL)
    process.wait(timeout=SECONDS)
    made = sum(row != NAN for row in array(run)[1])
    check(made >= 5, made)
    said = []
    run.ffd("batch", *table("--positions", "all.npy", "--resume"), err=said.extend)
    kept = int(re.search(r"(\d+) up to date, 0 failed", said[-1])[1])
    check(0 < kept <= made, f"{kept} of {made} rows were known")
    batch(run, *table("--positions", "whole.npy"), done=count)
    equal(run.read("all.npy"), run.read("whole.npy"))


@case
def shards_share_an_array(run):
    sweep(run)
    batch(run, *table("--positions", "whole.npy"), done=ROWS)
    shards = [subprocess.Popen([FFD, "batch", *table("--positions", "all.npy", "--shard", f"{i}/3")], cwd=run.folder,
                               stderr=subprocess.PIPE) for i in range(3)]
    for shard in shards:
        told = shard.communicate(timeout=SECONDS)[1].decode()
        equal(shard.returncode, 0, told)
    equal(run.read("all.npy"), run.read("whole.npy"))
    equal([e["row"] for e in entries(run, "all-1-of-3.json")], [1, 4])
    check(not run.exists("all.json"), "the report of all shards")
    run.ffd("report", "merge", "--interleave", *[f"all-{i}-of-3.json" for i in range(3)], "-o", "all.json")
    equal([e["row"] for e in entries(run)], list(range(ROWS)))
    # A row that is there is refused by itself, and replaced where that is wanted.
    batch(run, *table("--positions", "all.npy", "--shard", "1/3"), failed=[f"^all.npy: row {i} is there already" for i in (1, 4)])
    batch(run, *table("--positions", "all.npy", "--shard", "1/3", "--force"), done=2)
    equal(run.read("all.npy"), run.read("whole.npy"))


@case
def a_dry_run_names_rows_and_writes_nothing(run):
    start(run, [job(0), {"in": "a.obj", "lattice": "l.json"}, {"in": "gone.obj", "lattice": "l.json"}])
    before = names(run)
    batch(run, "m.jsonl", "--positions", "all.npy", "--dry-run", done=2, failed=["^gone.obj: "],
          out="to do: a.obj -> o0.obj, all.npy row 0\nto do: a.obj -> all.npy row 1\n")
    equal(names(run), before)
    # The first job shows what the real run would refuse: another number of vertices.
    run.write("b.obj", CUBE + "v 0 0 0\n")
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json"}]))
    batch(run, "m.jsonl", "--positions", "all.npy", done=1)
    run.write("m.jsonl", lines_of([{"in": "b.obj", "lattice": "l.json"}]))
    run.ffd("batch", "m.jsonl", "--positions", "all.npy", "--dry-run", "--resume", code=IO, err=re.compile("^all.npy: is there, and is not"))


@case
def rows_have_pictures(run):
    start(run, [job(0), {"in": "a.obj", "lattice": "l.json"}])
    run.ffd("batch", "m.jsonl", "--positions", "all.npy", "--view", "v", err=lambda said: None)
    equal(sorted(os.listdir(run.path("v"))), ["index.html", "o0.obj.png", "row-1.png"])
    equal(run.read("v/row-1.png"), run.read("v/o0.obj.png"), "pictures of one deformation")
    check("row-1.png" in run.text("v/index.html"), "the index has no picture of the row")


@case
def pictures_of_rows_that_are_there_stay(run):
    """With --resume a picture is drawn where it, or its row, is missing or another one."""
    rows = {i: f"v/row-{i}.png" for i in range(3)}
    view = ("m.jsonl", "--positions", "all.npy", "--view", "v", "--resume")
    start(run, [{"in": "a.obj", "lattice": "l.json"}, {"in": "a.obj", "lattice": "m.json"}, {"in": "a.obj", "lattice": "l.json"}])
    run.write("m.json", lattice(moves=[{"by": [0.125, 0.0625, 0.03125]}]))

    def drawn(**expected):
        before = {i: os.stat(run.path(name)).st_ino for i, name in rows.items() if run.exists(name)}
        batch(run, *view, **expected)
        return [i for i, name in rows.items() if os.stat(run.path(name)).st_ino != before.get(i)]

    equal(drawn(done=3), [0, 1, 2])
    equal(drawn(kept=3), [], "pictures that are there")
    equal([(e["status"], e.get("picture")) for e in entries(run)], [("skipped", name) for name in rows.values()])
    equal(run.text("v/index.html").count('src="row-'), 3)
    run.remove(rows[1])
    run.write(rows[2], run.read(rows[0])[:-1])
    batch(run, *view, "--dry-run", done=2, kept=1,
          out="up to date: a.obj -> all.npy row 0\nto do: a.obj -> all.npy row 1\nto do: a.obj -> all.npy row 2\n")
    array_before = run.read("all.npy")
    equal(drawn(done=2, kept=1), [1, 2], "one that is gone, one that was changed")
    equal((run.read("all.npy"), run.read(rows[2])), (array_before, run.read(rows[0])), "rows that were there, and what is drawn")
    # Without pictures a row is made of another lattice: its picture is an old one then. The others' frame stays.
    old = run.read(rows[1])
    run.write("m.json", lattice(moves=[{"by": [0.25, 0.125, 0.0625]}]))
    batch(run, "m.jsonl", "--positions", "all.npy", "--resume", done=1, kept=2)
    equal(drawn(done=1, kept=2), [1], "a picture of what the row was before")
    check(run.read(rows[1]) != old, "the picture is the old one")
    equal(drawn(kept=3), [])


@case
def an_embedding_is_no_file_of_the_run(run):
    """Neither of one job, which fails then, nor one that the run would replace, which is refused."""
    what = "is the manifest, the table, the report, the depfile, the journal, the index or the array of this run$"
    start(run)
    run.folder_of("v")
    job_of = {"in": "a.obj", "lattice": "l.json"}
    paths = ["r.json", "./new.json", "j", "v/../new.npy", "v/index.html"]
    run.write("m.jsonl", lines_of([job_of] + [{**job_of, "options": {"embedding": path}} for path in (*paths, "v/row-6.png", "v/row-0.png")]))
    batch(run, "m.jsonl", "--positions", "new.npy", "--report", "r.json", "--journal", "j", "--view", "v", done=1,
          failed=[rf'^m\.jsonl:{i}: the embedding "{re.escape(path)}" {what}' for i, path in enumerate(paths, 2)]
          + [r'^m\.jsonl:7: the embedding "v/row-6\.png" is written by the job of line 7 too$',
             r'^m\.jsonl:8: the embedding "v/row-0\.png" is written by the job of line 1 too$'])
    equal([row == NAN for row in array(run, "new.npy")[1]], [False] + [True] * 7)
    equal([e["exit"] for e in report(run)], [0] + [INVALID] * 7)
    # What is there is kept: the array is replaced before the first job, the index after the last one.
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "all.npy")
    os.symlink("all.npy", run.path("e.npy"))
    run.write("v/index.html", run.read("all.npy"))
    before = {name: run.read(name) for name in ("all.npy", "v/index.html", "r.json")}
    for path in ("all.npy", "e.npy", "v/index.html"):
        run.write("m.jsonl", lines_of([job(0), {**job_of, "options": {"embedding": path}}]))
        view = ("--view", "v") if path.startswith("v/") else ()
        for more in (view, (*view, "--dry-run"), (*view, "--resume")):
            run.ffd("batch", "m.jsonl", "--positions", "all.npy", "--report", "r.json", "--force", *more, code=INVALID,
                    err=re.compile(f'^m.jsonl:2: the embedding "{path}" {what}'))
            equal({name: run.read(name) for name in before}, before, f"{path} {more}")
    check(not run.exists("o0.obj"), "a job was done")
    # Another one serves as ever.
    run.write("m.jsonl", lines_of([{**job_of, "options": {"embedding": "e.npy"}}]))
    run.remove("v/index.html")
    batch(run, "m.jsonl", "--positions", "p.npy", "--view", "v", "--force", done=1)


@case
def what_has_no_row_is_refused(run):
    start(run, [job(0)])
    equal([e for e in ("--dtype", "--positions") if e not in run.ffd("batch", "--help").text], [], "the help")
    for arguments, why in ((table("--positions", "-"), "needs the name of a file"),
                           (table("--positions", "all.bin"), "ends in .npy"),
                           (table("--positions", "all.npy", "--in-place"), "--in-place"),
                           (table("--positions", "all.npy", "--embedding", "./all.npy"), "would replace the embedding"),
                           (table("--positions", "all.npy", "--depfile", "d"), "--depfile"),
                           (table("--dtype", "f8"), "--dtype needs --positions"),
                           (table("--positions", "all.npy", "--dtype", "f2"), "f2"),
                           (("--in", "a.obj", "--morph", "M=l.json", "--positions", "all.npy"), "--morph"),
                           (("-", "--positions", "all.npy"), "standard input")):
        run.ffd("batch", *arguments, code=USAGE, err=lambda said, why=why: check(why in said[0], said, why))
    run.write("m.jsonl", lines_of([{"in": "a.obj", "morph": {"M": "l.json"}, "out": "o.glb"}, job(1, out="all.npy"), job(2, out="all.json"),
                                   {"in": "a.obj", "lattice": "l.json", "options": {"in-place": True}},
                                   {"in": "a.obj", "lattice": "l.json", "options": {"as-morph": "M"}},
                                   {"in": "a.obj", "lattice": "l.json", "options": {"positions": "x.npy"}},
                                   {"in": "a.obj", "lattice": "l.json"}]))
    batch(run, "m.jsonl", "--positions", "all.npy", done=1,
          failed=['"morph" cannot be used with --positions', '"in-place" cannot be used with --positions', "--as-morph needs an output",
                  '"positions" is not an option of a job', "all.npy", "all.json"])
    equal([row == NAN for row in array(run)[1]], [True] * 6 + [False])
    os.mkfifo(run.path("pipe"))
    run.ffd("batch", "pipe", "--positions", "p.npy", code=USAGE, err=re.compile("--positions reads the jobs twice"))
    # Without --positions a job needs its output still.
    run.write("m.jsonl", lines_of([{"in": "a.obj", "lattice": "l.json"}]))
    batch(run, "m.jsonl", failed=['"out" is missing'])


main()
