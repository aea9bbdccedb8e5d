#!/usr/bin/env python3
"""ffd batch --resume: an output is left alone only where it is what its job would make, judged by content."""

import os
import subprocess
import time

from batches import MOVE, batch, case, check, equal, job, lattice, lines_of, main, start, statuses
from harness import CUBE, FFD, PNG, SECONDS, gltf_json

ALL = ["o0.obj", "o1.obj", "o2.obj"]


def resume(run, made, *arguments, name="m.jsonl", of=3, **options):
    """A run with --resume that makes the outputs of these jobs again and no others."""
    before = {i: os.stat(run.path(f"o{i}.obj")).st_ino for i in range(of) if run.exists(f"o{i}.obj")}
    batch(run, name, "--resume", "--report", "r.json", *arguments, done=len(made), kept=of - len(made), **options)
    equal(statuses(run), ["ok" if i in made else "skipped" for i in range(of)])
    kept = [i for i in before if i not in made]
    equal({i: os.stat(run.path(f"o{i}.obj")).st_ino for i in kept}, {i: before[i] for i in kept}, "files that were to stay")


def three(run):
    start(run, [job(0), job(1, lattice=["l.json", "k.json"]), job(2, **{"in": "b.obj"})])
    run.write("b.obj", CUBE + "# b\n")
    run.write("k.json", lattice(moves=MOVE * 2))
    batch(run, "m.jsonl", "--resume", done=3)


@case
def what_has_not_changed_is_not_done_again(run):
    three(run)
    resume(run, [])
    resume(run, [], "-j1")
    for name in (*ALL, "a.obj", "b.obj", "l.json", "k.json", "m.jsonl"):
        os.utime(run.path(name), (10 ** 9, 10 ** 9))
    resume(run, [])
    for name in ("a.obj", "l.json", "o0.obj"):  # the same content in another file
        content = run.read(name)
        run.remove(name)
        run.write(name, content)
    resume(run, [])


def changed(run, name, time_too):
    """Changes a digit of a file; without time_too its time and size stay."""
    before = os.stat(run.path(name))
    content = run.read(name)
    where = max(content.rfind(b"1"), content.rfind(b"5"))
    run.write(name, content[:where] + b"2" + content[where + 1:])
    if not time_too:
        os.utime(run.path(name), ns=(before.st_atime_ns, before.st_mtime_ns))


@case
def a_changed_file(run):
    three(run)
    for name, made in (("a.obj", [0, 1]), ("b.obj", [2]), ("l.json", [0, 1, 2]), ("k.json", [1]), ("o1.obj", [1])):
        for time_too in (True, False):
            if name == "b.obj":
                run.write(name, run.text(name) + "v 1 1 1\n")
            else:
                changed(run, name, time_too)
            resume(run, made)
            resume(run, [])
    single = []
    for mesh, grids in (("a.obj", ["l.json"]), ("a.obj", ["l.json", "k.json"]), ("b.obj", ["l.json"])):
        run.ffd("deform", mesh, "s.obj", "--force", *[x for grid in grids for x in ("-l", grid)])
        single.append(run.read("s.obj"))
    equal([run.read(name) for name in ALL], single)


@case
def a_changed_or_missing_output(run):
    three(run)
    content = [run.read(name) for name in ALL]
    run.remove("o1.obj")
    resume(run, [1])
    run.write("o0.obj", content[0] + b"\n")
    run.write("o2.obj", b"")
    resume(run, [0, 2])
    run.write("o0.obj", content[2])
    resume(run, [0])
    equal([run.read(name) for name in ALL], content)


@case
def a_changed_job(run):
    three(run)
    jobs = [job(0), job(1, lattice=["l.json", "k.json"]), job(2, **{"in": "b.obj"})]
    run.write("m.jsonl", lines_of([jobs[0], job(1, lattice=["k.json", "l.json"]), jobs[2]]))
    resume(run, [1])
    run.write("m.jsonl", lines_of([jobs[0], job(1, lattice=["k.json", "l.json"]), {**jobs[2], "options": {"outside": "extend"}}]))
    resume(run, [2])
    resume(run, [0, 1], "--outside", "extend")
    resume(run, [0, 1])
    # What never changes a byte of an output makes nothing again; nor does what no more than writes a default out.
    for options in (["--threads", "1"], ["--isa", "scalar"], ["-j", "3"], ["--timeout", "100"]):
        resume(run, [], *options)
    # Other jobs, in another order, round the same ones.
    run.write("m.jsonl", lines_of([jobs[2], job(3), jobs[0]]))
    batch(run, "m.jsonl", "--resume", "--report", "r.json", done=2, kept=1)
    equal(statuses(run), ["ok", "ok", "skipped"])


@case
def a_changed_buffer(run):
    start(run)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="in.bin")
    run.write("in.gltf", asset)
    run.write("in.bin", data)
    run.write("m.jsonl", lines_of([{"in": "in.gltf", "lattice": "l.json", "out": "out.gltf"}]))
    batch(run, "m.jsonl", "--resume", done=1)
    batch(run, "m.jsonl", "--resume", kept=1)
    run.write("in.bin", data[:11] + bytes([data[11] ^ 0x80]) + data[12:])
    batch(run, "m.jsonl", "--resume", done=1)
    batch(run, "m.jsonl", "--resume", kept=1)
    # The output's own buffer belongs to it.
    buffer = run.read("out.bin")
    run.write("out.bin", buffer[:-1] + b"x")
    batch(run, "m.jsonl", "--resume", done=1)
    equal(run.read("out.bin"), buffer)
    run.remove("out.bin")
    batch(run, "m.jsonl", "--resume", done=1)
    equal(run.read("out.bin"), buffer)
    batch(run, "m.jsonl", "--resume", kept=1)


@case
def a_copied_image(run):
    start(run)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="in.bin")
    asset["images"] = [{"uri": "t.png"}]
    run.write("in/in.gltf", asset)
    run.write("in/in.bin", data)
    run.write("in/t.png", PNG + b"one")
    run.folder_of("out")
    run.write("m.jsonl", lines_of([{"in": "in/in.gltf", "lattice": "l.json", "out": "out/out.gltf"}]))
    batch(run, "m.jsonl", "--resume", done=1)
    batch(run, "m.jsonl", "--resume", kept=1)
    run.remove("out/t.png")
    batch(run, "m.jsonl", "--resume", done=1)
    equal(run.read("out/t.png"), PNG + b"one")


@case
def a_journal_that_is_lost_or_broken_changes_no_output(run):
    three(run)
    files = [os.path.join(w, n) for w, _, names in os.walk(run.path("cache")) for n in names]
    check(files, "there is no journal in XDG_CACHE_HOME")
    content = [run.read(name) for name in ALL]
    for damage in (None, b"", b"nonsense"):
        for name in files:
            if damage is None:
                os.unlink(name)
            else:
                with open(name, "rb") as file:
                    whole = file.read()
                with open(name, "wb") as file:
                    file.write(whole[:len(whole) // 2] if damage else b"")
        batch(run, "m.jsonl", "--resume", "--report", "r.json", **({"done": 3} if "ok" in resumed(run) else {"kept": 3}))
        equal([run.read(name) for name in ALL], content)
        resume(run, [])


def resumed(run):
    """What becomes of the jobs, found by a dry run."""
    run.ffd("batch", "m.jsonl", "--resume", "--dry-run", "-q", "--report", "d.json", err=[])
    return statuses(run, "d.json")


@case
def a_new_journal_removes_those_of_long_ago(run):
    start(run, [job(0)])
    batch(run, "m.jsonl", done=1)
    (used,) = os.listdir(run.path("cache/ffd"))

    def age(name, days):
        path = os.path.join(run.path("cache/ffd"), name)
        if not os.path.exists(path):
            with open(path, "wb"):
                pass
        os.utime(path, (time.time() - days * 86400,) * 2)

    age(used, 400)
    age("batch-of-another", 181)
    age("batch-of-a-third", 179)
    age("copy-of-long-ago", 400)
    # A run that finds its own removes nothing, and has used it today.
    batch(run, "m.jsonl", "--resume", kept=1)
    equal(sorted(os.listdir(run.path("cache/ffd"))), sorted([used, "batch-of-another", "batch-of-a-third", "copy-of-long-ago"]))
    run.write("n.jsonl", lines_of([job(1)]))
    batch(run, "n.jsonl", done=1)
    left = set(os.listdir(run.path("cache/ffd")))
    check(left > {used, "batch-of-a-third", "copy-of-long-ago"} and "batch-of-another" not in left and len(left) == 4, left)
    batch(run, "m.jsonl", "--resume", kept=1)


@case
def a_journal_of_ones_own(run):
    start(run, [job(i) for i in range(3)])
    batch(run, "m.jsonl", "--resume", "--journal", "j", done=3)
    check(run.exists("j") and not run.exists("cache"), run.names())
    resume(run, [], "--journal", "j")
    # A file that is none is neither used nor replaced.
    text = run.text("a.obj")
    said = run.ffd("batch", "m.jsonl", "--resume", "--journal", "a.obj", code=(3, 4)).err[0]
    check(said.startswith("a.obj: "), said)
    equal(run.text("a.obj"), text)


@case
def failed_jobs_are_tried_again(run):
    start(run, [job(0), job(1, **{"in": "b.obj"}), job(2)])
    batch(run, "m.jsonl", "--resume", done=2, failed=["^b.obj"])
    batch(run, "m.jsonl", "--resume", kept=2, failed=["^b.obj"])
    run.write("b.obj", CUBE)
    resume(run, [1])
    # One that was made once and now fails leaves what it made.
    content = run.read("o1.obj")
    run.write("b.obj", "v 1\n")
    batch(run, "m.jsonl", "--resume", kept=2, failed=["^b.obj"])
    equal(run.read("o1.obj"), content)


@case
def outputs_of_others(run):
    """An output that --resume has no record of is not its own: it is made again, as the whole is."""
    start(run, [job(0), job(1)])
    run.write("o0.obj", "of someone else")
    batch(run, "m.jsonl", "--resume", done=2)
    equal(run.read("o0.obj"), run.read("o1.obj"))


@case
def an_interrupted_run_without_resume(run):
    """What a first run has made need not be made again, though it was not begun with --resume."""
    start(run, [job(i) for i in range(3)])
    batch(run, "m.jsonl", done=3)
    resume(run, [])


@case
def in_place_and_resume_exclude_each_other(run):
    """An input that its own job has replaced must not be deformed a second time: --resume and this exclude each other."""
    start(run, [{"in": "p.obj", "lattice": "l.json", "options": {"in-place": True}}, job(1)])
    run.write("p.obj", CUBE)
    batch(run, "m.jsonl", done=2)
    once = run.read("p.obj")
    batch(run, "m.jsonl", "--resume", kept=1, failed=["in-place.*--resume"])
    equal(run.read("p.obj"), once)


@case
def shards_and_patterns(run):
    start(run, [job(i) for i in range(6)])
    batch(run, "m.jsonl", "--resume", "--shard", "0/2", done=3)
    batch(run, "m.jsonl", "--resume", "--shard", "1/2", done=3)
    for i in range(2):
        batch(run, "m.jsonl", "--resume", "--shard", f"{i}/2", kept=3)
    run.folder_of("out")
    arguments = ["--in", "[ab].obj", "-l", "l.json", "--out-dir", "out", "--resume"]
    run.write("b.obj", CUBE)
    batch(run, *arguments, done=2)
    run.write("b.obj", CUBE + "v 1 1 1\n")
    batch(run, *arguments, done=1, kept=1)


@case
def a_dry_run_tells(run):
    three(run)
    changed(run, "k.json", True)
    batch(run, "m.jsonl", "--resume", "--dry-run", "--report", "r.json", done=1, kept=2,
          out="up to date: a.obj -> o0.obj\nto do: a.obj -> o1.obj\nup to date: b.obj -> o2.obj\n")
    resume(run, [1])


@case
def a_dry_run_leaves_a_journal_of_another_version(run):
    """Also where workers look in it for the notes of copies."""
    start(run)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="in.bin")
    asset["images"] = [{"uri": "t.png"}]
    for name, content in (("in.gltf", asset), ("in.bin", data), ("t.png", PNG + b"one")):
        run.write("in/" + name, content)
    run.write("m.jsonl", lines_of([{"in": "in/in.gltf", "lattice": "l.json", "out": "out/out.gltf"}]))
    batch(run, "m.jsonl", "--journal", "j", done=1)
    written = run.read("j")
    check(written.startswith(b"ffd-journal "), written[:20])
    run.write("j", b"ffd-journal 1\n\0\0" + written[16:])
    run.write("in/t.png", PNG + b"another one")
    before = run.read("j")
    for words in (["--force", "--resources", "refresh"], ["--resume"]):
        run.ffd("batch", "m.jsonl", "--journal", "j", "--dry-run", *words, code=(0, 1), err=lambda said: None)
        check(run.read("j") == before, words, "the journal has changed")


@case
def a_folder_for_journals_that_cannot_be_had(run):
    """No journal only costs time."""
    start(run, [job(0)])
    run.write("file", "")
    os.environ["XDG_CACHE_HOME"] = run.path("file")
    done = run.ffd("batch", "m.jsonl", "--resume", err=lambda said: None)
    check(any("file" in line for line in done.err), "nobody is told:", done.err)
    check(run.exists("o0.obj"), "nothing was made")
    # The reason is that of the folder, not that it is not there.
    options = run.unprivileged()
    if options:
        os.mkdir(run.path("others"), 0o555)
        os.environ["XDG_CACHE_HOME"] = run.path("others")
        done = run.ffd("batch", "m.jsonl", "--resume", code=(0, 1), err=lambda said: None, **options)
        check(any("others/ffd: the folder cannot be made: Permission denied" in line for line in done.err), done.err)


@case
def a_journal_moves_with_its_manifest(run):
    """Names in it are relative to the manifest's folder: the whole may be moved, copied or mounted elsewhere."""
    start(run)
    for name in ("a.obj", "l.json"):
        run.write("one/in/" + name, run.read(name))
    lines = lines_of([{"in": "../in/a.obj", "lattice": "../in/l.json", "out": "../out/o.obj"}, {"in": "../in/a.obj", "lattice": "../in/l.json"}])
    run.write("one/jobs/m.jsonl", lines)
    words = ("--resume", "--view", "{}/v", "--positions", "{}/all.npy", "--journal", "{}/j")
    batch(run, "one/jobs/m.jsonl", *[word.format("one") for word in words], done=2)
    run.folder_of("far/away")
    os.rename(run.path("one"), run.path("far/away/two"))
    batch(run, "far/away/two/jobs/m.jsonl", *[word.format("far/away/two") for word in words], kept=2)
    os.symlink("far/away/two", run.path("link"))
    batch(run, "link/jobs/m.jsonl", *[word.format("link") for word in words], kept=2)
    # Another manifest beside it sees the same outputs; one elsewhere does not.
    run.write("far/away/two/other/m.jsonl", lines.replace("../in", "../in"))
    batch(run, "far/away/two/other/m.jsonl", *[word.format("far/away/two") for word in words], kept=2)
    run.write("far/away/two/m.jsonl", lines.replace("../", ""))
    batch(run, "far/away/two/m.jsonl", *[word.format("far/away/two") for word in words], done=2)


@case
def a_folder_that_was_removed(run):
    """Jobs that come from no file have their journal by the current folder, which may be gone."""
    start(run)
    for words in ("done", "up to date"):
        run.folder_of("gone")
        done = subprocess.run(["sh", "-c", 'cd gone && rmdir ../gone && exec "$@"', "sh", FFD, "batch", "--in", run.path("a*.obj"),
                               "-l", run.path("l.json"), "--out-dir", run.path("out"), "--resume"],
                              cwd=run.folder, capture_output=True, text=True, timeout=SECONDS, check=False)
        equal((done.returncode, f"1 {words}" in done.stderr), (0, True), done.stderr)


main()
