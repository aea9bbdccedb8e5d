#!/usr/bin/env python3
"""ffd batch: manifests, what is wrong in them, options, outputs like those of single runs, -j, --shard, --stop,
--dry-run, --quiet and the report."""

import json
import os
import re

from batches import MOVE, batch, case, check, equal, job, lattice, lines_of, main, names, report, start, statuses
from harness import CUBE, INVALID, IO, NO, OK, SANITIZED, USAGE


def expected(run, name="a.obj", *options, lattices=("l.json",)):
    """What a single run makes of a mesh."""
    out = "single." + name.rsplit(".", 1)[1]
    run.ffd("deform", name, out, *[x for l in lattices for x in ("-l", l)], "--force", *options, err=lambda said: None)
    return run.read(out)


@case
def every_job_of_a_manifest_is_done(run):
    start(run, [job(0), job(1, lattice=["l.json"]), job(2, lattice=["l.json", "l.json"])])
    batch(run, "m.jsonl", done=3, out="")
    equal(names(run), ["a.obj", "l.json", "m.jsonl", "o0.obj", "o1.obj", "o2.obj"])
    once, twice = expected(run), expected(run, lattices=["l.json", "l.json"])
    check(once != twice and once != run.read("a.obj"), "the lattice does nothing")
    equal([run.read(f"o{i}.obj") for i in range(3)], [once, once, twice])


@case
def names_are_relative_to_the_manifest(run):
    start(run)
    for folder in ("deep/in", "deep/out"):
        run.folder_of(folder)
    run.write("deep/in/a.obj", CUBE)
    run.write("deep/l 2.json", lattice(moves=MOVE))
    absolute = {"in": run.path("a.obj"), "lattice": run.path("l.json"), "out": run.path("deep/out/c.obj")}
    run.write("deep/m", lines_of([{"in": "in/a.obj", "lattice": "l 2.json", "out": "out/b.obj"}, absolute,
                                  {"in": "../a.obj", "lattice": "../l.json", "out": "../d.obj"}]))
    batch(run, "deep/m", done=3)
    equal([run.read(n) for n in ("deep/out/b.obj", "deep/out/c.obj", "d.obj")], [expected(run)] * 3)
    # Paths on standard input are relative to the folder that ffd runs in.
    batch(run, "-", done=1, stdin=lines_of([job(7)]).encode())
    batch(run, "/dev/stdin", "--force", done=1, stdin=lines_of([job(7)]).encode())
    equal(run.read("o7.obj"), expected(run))


def no_jobs(run, name, *words):
    """An end without failure that says that there was nothing to do."""
    def judge(said):
        equal(said[:-1], [f"{name}: has no jobs"])
        check(said[-1].startswith("0 jobs in "), said)
    run.ffd("batch", name, *words, err=judge)


@case
def a_text_without_jobs_is_said(run):
    start(run, [job(0)])
    run.write("blank.jsonl", "\r\n \n\t\r\r")
    no_jobs(run, "blank.jsonl")
    no_jobs(run, "blank.jsonl", "--dry-run", "--shard", "1/2")
    run.ffd("batch", "blank.jsonl", "--quiet", err=[])
    # A shard without a job of its own is none of these.
    batch(run, "m.jsonl", "--shard", "1/2")
    for zeros in (b"\0", b"\0" * 5000 + b"\n", b"\n\0\0\r\n" + lines_of([job(0)]).encode()):
        run.write("zeros.jsonl", zeros)
        run.ffd("batch", "zeros.jsonl", code=INVALID, err=re.compile(r"^zeros\.jsonl:[12]: NUL bytes, and no job before them$"))
    # Behind a job they are lines that are not valid.
    run.write("m.jsonl", lines_of([job(0)]).encode() + b"\0\0\n" + lines_of([job(1)]).encode())
    batch(run, "m.jsonl", done=2, failed=["not valid JSON"])


@case
def json_that_is_no_json_lines_is_one_error(run):
    """An array, a job over several lines, a table without --csv: nothing is done, whatever some of its lines are."""
    start(run)
    jobs = [job(i) for i in range(3)]
    for name, text, found in (("a.json", json.dumps(jobs), "is a JSON array"), ("b.json", "\ufeff\n [\n" + lines_of(jobs) + "]", "is a JSON array"),
                              ("c.json", json.dumps(jobs[0], indent=1), "is JSON over several lines"),
                              ("e.json", json.dumps(jobs[0]).replace(", ", ",\n", 1), "is JSON over several lines"),
                              ("f.json", json.dumps(lattice()), "is a lattice"), ("g.json", json.dumps(lattice(), indent=1), "is JSON over several lines"), ("d.json", "{\r\n\r\n}", "is JSON over several lines"),
                              ("e.csv", "in,lattice,out\na.obj,l.json,o.obj\n" * 9, r"is no JSON \(--csv reads a table\)")):
        run.write(name, text)
        run.ffd("batch", name, code=INVALID, err=re.compile(rf"^{name}:[12]: {found}: a manifest has one job a line \(JSON Lines\)$"))
        check(not run.exists(jobs[2]["out"]), name)
    # A file of another kind, which would have a message for each of its lines.
    for name, text, kind in (("m.obj", CUBE, "an OBJ file"), ("m.txt", "# a comment\n\n# and one more\n" + CUBE, "an OBJ file"),
                             ("m.jsonl", CUBE, "an OBJ file"), ("m.ply", "ply\nformat ascii 1.0\n", "a PLY file"),
                             ("m.bin", b"\x89PNG\r\n\x1a\n\n\n\n", "a PNG image"), ("m.off", "3 1 0\n", None)):
        run.write(name, text)
        run.ffd("batch", name, code=INVALID, err=f"{name}:1: is no object of JSON: a manifest has one job a line (JSON Lines)"
                + (f"; it seems to be {kind}" if kind else ""))
    run.folder_of("meshes/deep")
    for pattern in ("meshes", "meshes/"):
        run.ffd("batch", "--in", pattern, "-l", "l.json", "--out-dir", "out", code=IO,
                err=f"{pattern}: is a folder: name its meshes by a pattern, such as 'meshes/*.obj'")
    # One line that is broken is one job, and so is one behind others.
    run.write("m.csv", lines_of([jobs[0]]) + "[\n{\n" + lines_of([jobs[1]]))
    batch(run, "m.csv", done=2, failed=["not valid JSON"] * 2)


@case
def what_lines_may_look_like(run):
    start(run)
    lines = [json.dumps(job(i)) for i in range(4)]
    run.write("m.jsonl", b"\xef\xbb\xbf" + lines[0].encode() + b"\r\n\r\n \t\n" + lines[1].encode() + b"\n\n  "
              + lines[2].encode() + b" \t\r\n" + lines[3].encode())
    batch(run, "m.jsonl", "--report", "r.json", done=4)
    equal([(e["line"], e["output"]) for e in report(run)], [(1, "o0.obj"), (4, "o1.obj"), (6, "o2.obj"), (7, "o3.obj")])
    run.write("empty", "")
    no_jobs(run, "empty", "--report", "r.json")
    equal(report(run), [])
    run.write("a\u00e4 \u4e2d.obj", CUBE)
    batch(run, "-", done=1, stdin=lines_of([job(9, **{"in": "a\u00e4 \u4e2d.obj"})]).encode())
    batch(run, "-", done=1, stdin=(json.dumps(job(8, **{"in": "a\u00e4 \u4e2d.obj"}), ensure_ascii=False)).encode())
    equal(run.read("o8.obj"), run.read("o9.obj"))


# A line, and what its message must name.
BAD_LINES = [
    ("# a comment", "not valid JSON"), ("// a comment", "not valid JSON"), ('{"in": "a.obj",', "not valid JSON"),
    ('{"in": "a.obj", "lattice": "l.json", "out": "x.obj",}', "not valid JSON"), ("{'in': 'a.obj'}", "not valid JSON"),
    ('{"in": "a.obj", "lattice": "l.json", "out": "x.obj"} {}', "not valid JSON"), ("[" * 100000, "not valid JSON"),
    ('{"in": "a.obj", "in": "a.obj", "lattice": "l.json", "out": "x.obj"}', "duplicate"),
    (b'{"in": "a\xff.obj", "lattice": "l.json", "out": "x.obj"}', "not valid JSON"),
    (b'{"in": "a\\u0000.obj", "lattice": "l.json", "out": "x.obj"}', "not valid JSON"),
    (b'{"in": "a.obj", "lattice": "l.json", "out": "x.obj"}\0', "not valid JSON"),
    ("null", ""), ("3", ""), ("[]", "a job is an object"), ("{}", '"in" is missing'),
    ({"in": "a.obj", "out": "x.obj"}, '"lattice" is missing'), ({"in": "a.obj", "lattice": "l.json"}, '"out" is missing'),
    ({**job(2000), "in": 3}, '"in"'), ({**job(2001), "in": ["a.obj"]}, '"in"'), ({**job(2002), "in": ""}, '"in"'), ({**job(2003), "in": "-"}, '"in"'),
    ({**job(2004), "out": None}, '"out"'), ({**job(2005), "out": "-"}, '"out"'), ({**job(2006), "lattice": []}, '"lattice"'),
    ({**job(2007), "lattice": ["l.json", 4]}, '"lattice"'), ({**job(2008), "lattice": {}}, '"lattice"'),
    ({**job(2009), "option": {}}, r'"option" \(nearest: "options"\)'), ({**job(2010), "latice": "l.json"}, r'"latice" \(nearest: "lattice"\)'),
    ({**job(2011), "options": []}, '"options"'), ({**job(2012), "options": {"normal": "keep"}}, r"normal \(nearest: (--)?normals\)"),
    ({**job(2013), "options": {"normals": "kep"}}, '"kep"'), ({**job(2014), "options": {"normals": None}}, "normals"),
    ({**job(2015), "options": {"normals": {}}}, "normals"), ({**job(2016), "options": {"falloff": "x"}}, '"x"'),
    ({**job(2017), "options": {"force": "yes"}}, "force"), ({**job(2018), "options": {"threads": 0}}, "threads"),
    ({**job(2019), "options": {"report": "r.json"}}, '"report"'), ({**job(2020), "options": {"quiet": True}}, '"quiet"'),
    ({**job(2021), "options": {"jobs": 2}}, "jobs"), ({**job(2022), "options": {"resume": True}}, "resume"),
    ('{"in": "' + "a" * 3000000 + '"}', "more than"),
]


@case
def malformed_lines_are_refused_each_by_its_number(run):
    start(run, [])
    lines = []
    for i, (line, _) in enumerate(BAD_LINES):
        lines.append(line if isinstance(line, bytes) else line.encode() if isinstance(line, str) else json.dumps(line).encode())
        lines.append(json.dumps(job(1000 + i)).encode())
    run.write("m.jsonl", b"\n".join(lines) + b"\n")
    batch(run, "m.jsonl", "--report", "r.json", done=len(BAD_LINES),
          failed=[rf"^m\.jsonl:{2 * i + 1}: .*{told}" for i, (_, told) in enumerate(BAD_LINES)])
    entries = report(run)
    equal([e["line"] for e in entries], list(range(1, len(lines) + 1)), "lines of the report")
    equal([(e["status"], e["exit"]) for e in entries], [("failed", 4), ("ok", 0)] * len(BAD_LINES))
    for i, (_, told) in enumerate(BAD_LINES):
        check(entries[2 * i]["error"].startswith(f"m.jsonl:{2 * i + 1}: "), entries[2 * i]["error"])
    equal(sorted(n for n in run.names() if n.startswith("o")), sorted(f"o{1000 + i}.obj" for i in range(len(BAD_LINES))))
    check(not run.exists("x.obj"), "a malformed line's output is there")


@case
def messages_speak_of_what_the_user_wrote(run):
    start(run, ['{"in": "a\\u0000.obj", "lattice": "l.json", "out": "x.obj"}', job(1, options={"jobs": 2}),
                job(2, options={"timeout": 2})])
    done = run.ffd("batch", "m.jsonl", code=NO, err=lambda said: None)
    check("JSON_ALLOW_NUL" not in done.err[0], "the name of a library's flag:", done.err[0])
    for line in done.err[1:3]:
        check("not an option of a job" in line, "an option of the batch is said to be unknown:", line)
    start(run, [job(1, set={"Q": 1}), job(2, outt="x"), job(3, quite="x")])
    for more in ([], ["--dry-run"]):
        batch(run, "m.jsonl", *more, failed=[r'no lattice has the placeholder \{"\$": "Q"\} \(--set\)$', r'unknown key "outt" \(nearest: "out"\)$',
                                             r'unknown key "quite" \(known: in, out, lattice, morph, clip, options, set\)$'])


@case
def a_bad_job_harms_no_other(run):
    start(run)
    run.folder_of("folder.obj")
    run.write("broken.obj", "v 1 2\nf 1 2 3\n")
    run.write("broken.json", '{"format": "ffd-lattice"')
    run.write("half.json", lattice(high=(2, 2, 0), moves=MOVE))
    bad = [(job(100, **{"in": "none.obj"}), 3, "none.obj"), (job(101, **{"in": "broken.obj"}), 4, "broken.obj:1"),
           (job(102, lattice="none.json"), 3, "none.json"), (job(103, lattice="broken.json"), 4, "broken.json:1"),
           (job(104, out="x.xyz"), (2, 4), ""), (job(105, out="broken.obj/x.obj"), 3, "broken.obj/x.obj"), (job(106, out="a.obj"), (2, 3), "a.obj"),
           (job(107, **{"in": "folder.obj"}), 3, "folder.obj"), (job(108, lattice="half.json", options={"outside": "error"}), 5, "a.obj"),
           (job(109, lattice="half.json", options={"fail-on": "outside"}), 1, "a.obj"),
           (job(110, options={"only": "group:none"}), (2, 4), "")]
    jobs = []
    for i, (line, _, _) in enumerate(bad):
        jobs += [line, job(i)]
    run.write("m.jsonl", lines_of(jobs))
    before = run.read("a.obj")
    batch(run, "m.jsonl", "--report", "r.json", done=len(bad), failed=[f"^{told}" for _, _, told in bad])
    equal(run.read("a.obj"), before)
    single = expected(run)
    entries = report(run)
    for i, (line, code, told) in enumerate(bad):
        equal(run.read(f"o{i}.obj"), single, f"the job after {line}")
        equal((entries[2 * i]["status"], entries[2 * i + 1]["status"]), ("failed", "ok"))
        check(entries[2 * i]["exit"] in (code if isinstance(code, tuple) else (code,)), line, entries[2 * i])
        check(entries[2 * i]["error"].startswith(told), line, entries[2 * i]["error"])
    equal([name for name in run.names() if len(name) == len("o100.obj") and name[0] == "o"], [], "what failed jobs wrote")


@case
def options_of_the_batch_are_defaults_of_its_jobs(run):
    start(run)
    run.write("n.obj", CUBE + "vn 0 0 1\nvn 1 0 0\nf 1//1 2//2 3//1\n")
    run.write("l.json", lattice(moves=[{"twist": {"axis": "z", "degrees": 50}}], high=(2, 2, 0.5)))
    run.write("m.jsonl", lines_of([job(0, **{"in": "n.obj"}), job(1, **{"in": "n.obj"}, options={"normals": "keep"}),
                                   job(2, **{"in": "n.obj"}, options={"normals": "transform", "outside": "extend"}),
                                   job(3, **{"in": "n.obj"}, options={"outside": "extend", "falloff": 1.5})]))
    results = []
    for arguments in ([], ["--normals", "recompute"], ["--outside", "extend", "--normals", "keep"]):
        run.ffd("batch", "m.jsonl", *arguments, "--force", "-j", "2", err=lambda said: None)
        default = dict(zip(arguments[::2], arguments[1::2]))
        for i, own in enumerate(({}, {"--normals": "keep"}, {"--normals": "transform", "--outside": "extend"},
                                 {"--outside": "extend", "--falloff": "1.5"})):
            options = [x for pair in {**default, **own}.items() for x in pair]
            results.append(run.read(f"o{i}.obj"))
            equal(results[-1], expected(run, "n.obj", *options), f"batch {arguments}, job {own}")
    check(len(set(results)) >= 7, "the options do next to nothing")


@case
def force_and_in_place(run):
    start(run, [job(0), job(1)])
    run.write("o0.obj", "old")
    batch(run, "m.jsonl", done=1, failed=["^o0.obj: exists already"])
    equal(run.read("o0.obj"), b"old")
    batch(run, "m.jsonl", "--force", done=2)
    equal(run.read("o0.obj"), expected(run))
    run.write("m.jsonl", lines_of([job(0, options={"force": True}), job(1, options={"force": False})]))
    batch(run, "m.jsonl", done=1, failed=["^o1.obj: exists already"])
    single = expected(run)
    twice = expected(run, lattices=["l.json", "l.json"])
    for name in ("p.obj", "q.obj"):
        run.write(name, CUBE)
    run.write("m.jsonl", lines_of([{"in": name, "lattice": "l.json", "options": {"in-place": True}} for name in ("p.obj", "q.obj")]))
    batch(run, "m.jsonl", "-j1", "--report", "r.json", done=2)
    equal([(e["input"], e["output"]) for e in report(run)], [("p.obj", "p.obj"), ("q.obj", "q.obj")])
    equal([run.read("p.obj"), run.read("q.obj")], [single, single], "in place")
    run.write("m.jsonl", lines_of([{"in": "p.obj", "lattice": "l.json"}]))
    batch(run, "m.jsonl", "--in-place", done=1)
    equal(run.read("p.obj"), twice)
    # One cannot have both.
    run.write("m.jsonl", lines_of([{"in": "q.obj", "lattice": "l.json", "out": "z.obj", "options": {"in-place": True}}]))
    batch(run, "m.jsonl", failed=["z.obj|out"])
    equal((run.read("q.obj"), run.exists("z.obj")), (single, False))


@case
def folders_of_outputs_are_made(run):
    start(run, [job(0, out="x/y/o.obj"), job(1, out="x/z/o.obj"), job(2, out="w/o.obj", **{"in": "none.obj"}),
                job(3, out="v/o.obj", options={"fail-on": "outside"})])
    run.write("half.json", lattice(high=(2, 2, 0), moves=MOVE))
    run.ffd("batch", "m.jsonl", "--dry-run", code=NO, err=lambda said: None, data=True)
    equal(names(run), ["a.obj", "half.json", "l.json", "m.jsonl"], "a dry run makes none")
    run.write("m.jsonl", run.text("m.jsonl").replace('"l.json", "out": "v/', '"half.json", "out": "v/'))
    batch(run, "m.jsonl", "-j4", "--view", "p/q", "--positions", "n/m/all.npy", done=2, failed=["none.obj", "a.obj"])
    equal(names(run), ["a.obj", "half.json", "l.json", "m.jsonl", "n", "p", "x"], "jobs that fail leave none")
    equal([run.names(folder) for folder in ("x/y", "x/z", "n/m")], [["o.obj"], ["o.obj"], ["all.json", "all.npy"]])
    check(run.exists("p/q/index.html") and run.exists("p/q/x/y/o.obj.png"), run.names("p/q"))
    run.write("in/b.obj", CUBE)
    batch(run, "--in", "in/*.obj", "-l", "l.json", "--out-dir", "many/of", done=1)
    equal(run.names("many/of"), ["b.obj"])


@case
def folders_of_other_files_are_not_made(run):
    start(run, [job(0, out="x/o.obj")])
    for option in ("--report", "--depfile", "--journal"):
        run.ffd("batch", "m.jsonl", option, "none/f", code=IO)
        equal(names(run), ["a.obj", "l.json", "m.jsonl"], option)
    # What stands in the place of a folder is seen by a dry run.
    run.write("f", "a file")
    run.write("m.jsonl", lines_of([job(0, out="f/o.obj"), job(1, out="f/x/o.obj")]))
    run.ffd("batch", "m.jsonl", "--dry-run", code=NO, err=lambda said: check(len(said) == 3, said), data=True)
    run.ffd("batch", "--in", "a.obj", "-l", "l.json", "--positions", "f/all.npy", code=IO)
    run.ffd("batch", "--in", "a.obj", "-l", "l.json", "--positions", "f/all.npy", "--dry-run", code=IO)


@case
def a_pattern_instead_of_a_manifest(run):
    start(run)
    for name in ("in/b.obj", "in/c.obj", "in/c d.obj", "in/e.off", "other/b.obj"):
        run.write(name, CUBE)
    run.folder_of("out")
    batch(run, "--in", "in/*.obj", "-l", "l.json", "--out-dir", "out", "--report", "r.json", done=3)
    equal(run.names("out"), ["b.obj", "c d.obj", "c.obj"])
    equal([e["input"] for e in report(run)], ["in/b.obj", "in/c d.obj", "in/c.obj"])
    for name in run.names("out"):
        equal(run.read("out/" + name), expected(run), name)
    run.folder_of("out2")
    batch(run, "--in", "in/[bc].obj", "-l", "l.json", "-l", "l.json", "--out-dir", "out2", "--normals", "keep", done=2)
    equal(run.read("out2/c.obj"), expected(run, lattices=["l.json", "l.json"]))
    # Two of one name: nothing is begun.
    run.folder_of("out3")
    said = run.ffd("batch", "--in", "*/[bc].obj", "-l", "l.json", "--out-dir", "out3", code=USAGE).err[0]
    check("in/b.obj" in said and "other/b.obj" in said, said)
    equal(run.names("out3"), [])
    run.ffd("batch", "--in", "none*.obj", "-l", "l.json", "--out-dir", "out", code=IO)
    batch(run, "--in", "in/b.obj", "-l", "l.json", "--out-dir", "out", failed=["^out/b.obj: exists already"])


@case
def words_that_do_not_fit_are_refused(run):
    start(run, [job()])
    for arguments in ([], ["m.jsonl", "m.jsonl"], ["m.jsonl", "--in", "*.obj"], ["m.jsonl", "--csv", "t.csv"], ["--in", "*.obj"],
                      ["--in", "*.obj", "-l", "l.json"], ["--in", "*.obj", "--out-dir", "."],
                      ["m.jsonl", "--stop", "--keep-going"], ["m.jsonl", "-j", "0"], ["m.jsonl", "-j", "x"],
                      ["m.jsonl", "-j", "-1"], ["m.jsonl", "--timeout", "0"], ["m.jsonl", "--timeout", "-1"],
                      ["m.jsonl", "--timeout", "nan"], ["m.jsonl", "--timeout", "x"], ["m.jsonl", "--normals", "kep"],
                      *[["m.jsonl", "--shard", s] for s in ("", "1", "2/2", "0/0", "-1/2", "a/b", "0/1/2", "1.5/3", "0/2x", " 0/2",
                                                            "99999999999999999999/999999999999999999999")]):
        run.ffd("batch", *arguments, code=USAGE)
    said = run.ffd("batch", "m.jsonl", "--shrd", "0/2", code=USAGE).err[0]
    check("--shard" in said, said)
    equal(run.names(), ["a.obj", "l.json", "m.jsonl"])
    for name in ("none.jsonl", "."):
        said = run.ffd("batch", name, code=IO).err[0]
        check(said.startswith(name + ": "), said)


@case
def shards_share_all_jobs_out(run):
    start(run, [job(i) if i % 5 else "" for i in range(40)])
    whole = [i for i in range(40) if i % 5]
    for count in (1, 7) if SANITIZED else (1, 3, 7, 40):
        for name in run.names():
            if name.startswith("o"):
                run.remove(name)
        seen = []
        for i in range(count):
            mine = whole[i::count]
            batch(run, "m.jsonl", "--shard", f"{i}/{count}", "--report", "r.json", done=len(mine))
            equal([int(e["output"][1:-4]) for e in report(run)], mine, f"jobs of shard {i}/{count}")
            seen += mine
        equal(sorted(seen), whole)
        equal(sorted(n for n in run.names() if n.startswith("o")), sorted(f"o{i}.obj" for i in whole))
    # A malformed line belongs to one shard only.
    run.write("m.jsonl", lines_of([job(100), "bad", job(101)]))
    batch(run, "m.jsonl", "--shard", "0/2", done=2)
    batch(run, "m.jsonl", "--shard", "1/2", failed=["^m.jsonl:2: "])


@case
def shards_of_a_pattern(run):
    start(run)
    run.folder_of("out")
    names = [f"in/{c}.obj" for c in "abcde"]
    for name in names:
        run.write(name, CUBE)
    for i in range(2):
        batch(run, "--in", "in/*.obj", "-l", "l.json", "--out-dir", "out", "--shard", f"{i}/2", "--report", "r.json", done=3 - i)
        equal([e["input"] for e in report(run)], names[i::2])
    equal(run.names("out"), ["a.obj", "b.obj", "c.obj", "d.obj", "e.obj"])


@case
def stop_after_a_failure(run):
    jobs = [job(0), job(1), job(2, **{"in": "none.obj"}), *[job(i) for i in range(3, 300)], "bad", job(300, option=1)]
    start(run, jobs)
    batch(run, "m.jsonl", "-j1", "--stop", "--report", "r.json", done=2, failed=["^none.obj"], more="(--stop)")
    equal(statuses(run), ["ok", "ok", "failed"])
    equal(names(run), ["a.obj", "l.json", "m.jsonl", "o0.obj", "o1.obj", "r.json"])
    batch(run, "m.jsonl", "--keep-going", "--force", done=299, failed=["^none.obj", "m.jsonl:301", "m.jsonl:302"])
    # Lines that are read ahead are not begun either.
    run.write("m.jsonl", lines_of([job(400), job(401, **{"in": "none.obj"}), "bad", job(402), "bad", job(403, options={"normal": 1})]))
    batch(run, "m.jsonl", "-j1", "--stop", "--report", "r.json", done=1, failed=["^none.obj"])
    equal(statuses(run), ["ok", "failed"])
    run.write("m.jsonl", lines_of([job(500), "bad", job(501)]))
    batch(run, "m.jsonl", "-j1", "--stop", done=1, failed=["^m.jsonl:2"])
    check(not run.exists("o501.obj"), "a job after a malformed line was begun")
    # What is no job at the beginning, with any number of workers: they have nothing to do yet.
    for line in ("bad", {"in": "a.obj", "lattice": "l.json"}):
        for workers in ("1", "4"):
            run.write("m.jsonl", lines_of([line, *[job(i) for i in range(600, 606)]]))
            batch(run, "m.jsonl", "-j", workers, "--stop", "--report", "r.json", failed=["^m.jsonl:1"], more="(--stop)")
            check(not run.exists("o600.obj"), "a job after the first line was begun")


@case
def a_dry_run_writes_nothing(run):
    start(run, [job(0), job(1, **{"in": "none.obj"}), "bad", job(2, options={"normal": 1}), job(3), job(4, lattice="none.json")])
    before = run.names()
    failed = ["^none.obj: ", "^m.jsonl:3: ", "^m.jsonl:4: ", "^none.json: "]
    for arguments in ([], ["--resume"], ["--resume", "--journal", "j"]):
        batch(run, "m.jsonl", "--dry-run", *arguments, done=2, failed=failed,
              out="to do: a.obj -> o0.obj\nto do: a.obj -> o3.obj\n")
        equal(run.names(), before, f"--dry-run {arguments}")
    batch(run, "m.jsonl", "--dry-run", "--report", "r.json", done=2, failed=failed, out="to do: a.obj -> o0.obj\nto do: a.obj -> o3.obj\n")
    equal(len(report(run)), 6)
    # What a run would refuse is told.
    run.write("o0.obj", "old")
    done = run.ffd("batch", "m.jsonl", "--dry-run", code=NO, err=lambda said: None)
    check(any("o0.obj" in line and "exists" in line for line in done.err), done.err)
    batch(run, "-", "--dry-run", "-j", "3", done=2, stdin=lines_of([job(5), job(6)]).encode(),
          out="to do: a.obj -> o5.obj\nto do: a.obj -> o6.obj\n")


@case
def quiet_tells_of_failures_only(run):
    start(run, [job(0), job(1, **{"in": "none.obj"}), job(2)])
    run.write("l.json", lattice(high=(2, 2, 0), moves=MOVE))
    run.ffd("batch", "m.jsonl", "-q", code=NO, err=["m.jsonl:2: none.obj: cannot be opened: No such file or directory"])
    run.write("m.jsonl", lines_of([job(3)]))
    run.ffd("batch", "m.jsonl", "--quiet", err=[])


@case
def the_report_has_the_order_of_the_manifest(run):
    sizes = [2000, 1, 1, 500, 1, 1, 1, 900, 1, 1]
    for i, size in enumerate(sizes):
        run.write(f"in{i}.obj", CUBE * size)
    jobs = []
    for i in range(60):
        jobs.append("bad" if i % 11 == 7 else job(i, **{"in": f"in{i % 10}.obj" if i % 13 else "none.obj"}))
    start(run, jobs)
    texts = []
    for count in ("1", "4", "9"):
        run.ffd("batch", "m.jsonl", "-j", count, "--force", "-q", "--report", "r.json", "--report-stable", code=NO, err=lambda said: None)
        texts.append(run.read("r.json"))
    equal([e["line"] for e in report(run)], list(range(1, 61)))
    check("seconds" not in report(run)[0], "seconds in a stable report")
    equal(texts[1:], [texts[0]] * 2, "reports of -j 1, 4 and 9")
    out = run.ffd("batch", "m.jsonl", "-j3", "--force", "-q", "--report", "-", "--report-stable", code=NO, err=lambda said: None).out
    equal(out, texts[0], "--report -")
    run.ffd("batch", "m.jsonl", "-j3", "--force", "-q", "--report", "r.json", code=NO, err=lambda said: None)
    for entry, stable in zip(report(run), json.loads(texts[0])["jobs"]):
        check(set(entry.pop("seconds")) >= {"read", "embed", "deform", "write"}, "no seconds")
        equal(entry, stable)


@case
def reports_of_single_runs(run):
    start(run)
    run.write("half.json", lattice(high=(2, 2, 0), moves=MOVE, rest={"box": {"min": [-2, -2, -2], "max": [2, 2, 0]}}))
    run.write("m.jsonl", lines_of([job(0), job(1, lattice="half.json"), job(2, lattice=["l.json", "half.json"]),
                                   job(3, options={"normals": "recompute"}), job(4, **{"in": "none.obj"})]))
    run.ffd("batch", "m.jsonl", "-q", "--report", "r.json", "--report-stable", code=NO, err=lambda said: None)
    for i, arguments in enumerate((["-l", "l.json"], ["-l", "half.json"], ["-l", "l.json", "-l", "half.json"],
                                   ["-l", "l.json", "--normals", "recompute"], ["-l", "l.json"])):
        mesh = "none.obj" if i == 4 else "a.obj"
        run.ffd("deform", mesh, f"o{i}.obj", *arguments, "--force", "-q", "--report", "s.json", "--report-stable",
                code=IO if i == 4 else OK, err=lambda said: None)
        entry = report(run)[i]
        equal((entry.pop("line"), entry.pop("set")), (i + 1, {}))
        equal(entry, report(run, "s.json")[0], f"job {i}")


@case
def a_place_that_cannot_be_written_fails_its_own_job_only(run):
    start(run, [job(0), job(1, out="closed/x.obj")])
    run.folder_of("closed")
    os.chmod(run.path("closed"), 0o555)
    user = run.unprivileged()
    check(user, "there is no unprivileged user to run as")
    os.chmod(run.folder, 0o777)
    os.environ["XDG_CACHE_HOME"] = run.path("cache")
    batch(run, "m.jsonl", done=1, failed=["^closed/x.obj: "], **user)
    # A report or a journal that cannot be written is told before any work.
    for arguments in (["--report", "closed/r.json"], ["--report", "no/r.json"], ["--resume", "--journal", "closed/j"],
                      ["--resume", "--journal", "closed/no/j"]):
        run.ffd("batch", "m.jsonl", "--force", *arguments, code=IO, err=lambda said: check("closed" in said[-1] or "no/" in said[-1], said), **user)
    equal(run.names("closed"), [])


main()
