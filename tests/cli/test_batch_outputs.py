#!/usr/bin/env python3
"""ffd batch: no two jobs of a run write one file. The later one fails before it works, and names both lines."""

import json
import os
import re
import shutil

from batches import batch, case, check, equal, job, lines_of, main, report, start
from harness import CUBE, INVALID, PNG, USAGE, gltf_json

MODES = ([], ["--force"], ["-j1", "--force"], ["-j", "4", "--force"], ["--resume"], ["--resume"], ["--force", "--stop", "-j1"])


def judge(run, clashes, jobs, *arguments):
    """Of so many jobs those of the clashes (line, file, the other line) fail, in a dry run too."""
    failed = [rf'^m\.jsonl:{line}: ".*{file}" is written by the job of line {other} too$' for line, file, other in clashes]
    done = jobs - len(clashes)
    before = run.names()
    run.ffd("batch", "m.jsonl", "--dry-run", "--force", code=1, err=lambda said: equal(len(said), len(clashes) + 1, said))
    equal(run.names(), before, "a dry run writes nothing")
    batch(run, "m.jsonl", "--force", "--report", "r.json", *arguments, done=done, failed=failed)
    equal([(e["line"], e["exit"]) for e in report(run) if e["status"] == "failed"], [(line, INVALID) for line, _, _ in clashes])


@case
def the_later_job_fails_in_every_mode(run):
    start(run, [job(0), job(0, **{"in": "b.obj"}), job(1)])
    run.write("b.obj", CUBE.replace("v 1", "v 1.5"))
    run.ffd("deform", "a.obj", "single.obj", "-l", "l.json")
    told = [r'^m\.jsonl:2: "o0\.obj" is written by the job of line 1 too$']
    for arguments in MODES:
        stops = "--stop" in arguments
        kept = 2 if "--resume" in arguments else 0
        batch(run, "m.jsonl", *arguments, kept=kept, done=(1 if stops else 2) - kept, failed=told, more="(--stop)" if stops else None)
        equal(run.read("o0.obj"), run.read("single.obj"), f"{arguments}: the output of the first job")
    batch(run, "m.jsonl", "--dry-run", "--force", done=2, failed=told, out="to do: a.obj -> o0.obj\nto do: a.obj -> o1.obj\n")
    batch(run, "m.jsonl", "--dry-run", "--resume", kept=2, failed=told, out="up to date: a.obj -> o0.obj\nup to date: a.obj -> o1.obj\n")
    batch(run, "-", "--force", done=2, failed=['^standard input:2: "o0.obj" is written by the job of line 1 too$'], stdin=run.read("m.jsonl"))


@case
def one_file_has_many_names(run):
    run.folder_of("sub")
    os.symlink("sub", run.path("link"))
    os.symlink("o9.obj", run.path("other.obj"))
    run.write("o9.obj", "there")
    names = ["o0.obj", "./o0.obj", "sub/../o0.obj", run.path("o0.obj"), "sub/o1.obj", "link/o1.obj", "o9.obj", "other.obj", "o8.obj"]
    start(run, [{**job(), "out": name} for name in names])
    judge(run, [(2, "o0.obj", 1), (3, "o0.obj", 1), (4, "o0.obj", 1), (6, "o1.obj", 5), (8, "other.obj", 7)], len(names))
    # A name that is another file as soon as it is written is none of these.
    run.write("m.jsonl", lines_of([{**job(), "out": name} for name in ("h1.obj", "h2.obj")]))
    run.write("h1.obj", CUBE)
    os.link(run.path("h1.obj"), run.path("h2.obj"))
    batch(run, "m.jsonl", "--force", done=2)


def model(run, name, buffers):
    """A glTF of so many meshes, each with a buffer of its own: files, and a data URI that is none."""
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    asset["buffers"] = [{"byteLength": len(data), "uri": f"{name}{i}.bin", "name": "uri", "extras": {"uri": "x.bin"}} for i in range(buffers)]
    view, accessor = asset["bufferViews"][0], asset["accessors"][0]
    asset["bufferViews"] = [{**view, "buffer": i} for i in range(buffers)]
    asset["accessors"] = [{**accessor, "bufferView": i} for i in range(buffers)]
    asset["meshes"] = [{"primitives": [{"attributes": {"POSITION": i}, "mode": 0}]} for i in range(buffers)]
    asset["nodes"] = [{"mesh": i} for i in range(buffers)]
    asset["scenes"], asset["scene"] = [{"nodes": list(range(buffers))}], 0
    for i in range(buffers):
        run.write(f"{name}{i}.bin", data)
    run.write(name + ".gltf", asset)


@case
def buffers_are_outputs_too(run):
    start(run)
    for count in (1, 2, 3):
        model(run, "abc"[count - 1], count)
    run.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

    def jobs(*pairs):
        for name in run.names():
            if name[0] in "xyz":
                run.remove(name)
        run.write("m.jsonl", lines_of([{**job(), "in": mesh, "out": out} for mesh, out in pairs]))
        return len(pairs)

    judge(run, [(2, "x-1.bin", 1)], jobs(("b.gltf", "x.gltf"), ("a.gltf", "x-1.gltf")))
    judge(run, [(2, "x-1.bin", 1)], jobs(("a.gltf", "x-1.gltf"), ("b.gltf", "x.gltf")))
    judge(run, [(3, "x-2.bin", 1)], jobs(("c.gltf", "x.gltf"), ("a.gltf", "y-2.gltf"), ("t.obj", "x-2.gltf")))
    judge(run, [(2, "y.gltf", 1)], jobs(("t.obj", "y.gltf"), ("a.gltf", "./y.gltf")))
    # One buffer each: what numbered outputs look like.
    equal(jobs(("a.gltf", "z.gltf"), ("a.gltf", "z-1.gltf"), ("t.obj", "z-2.gltf"), ("b.gltf", "z-2.glb"), ("a.obj", "z-1.obj"),
               ("b.gltf", "z-3.gltf")), 6)
    batch(run, "m.jsonl", "--force", done=6)
    # The format counts, whose ending the output gets.
    run.write("m.jsonl", lines_of([{**job(), "in": "b.gltf", "out": "w.gltf"},
                                   {**job(), "in": "a.gltf", "out": "w-1.glb", "options": {"output-format": "gltf"}}]))
    batch(run, "m.jsonl", "--force", done=1, failed=[r'^m\.jsonl:2: ".*w-1.bin" is written by the job of line 1 too$'])


@case
def outputs_get_the_ending_of_their_format(run):
    """Of --output-format or the option of a job; names without the ending of a mesh format stay."""
    start(run)
    model(run, "a", 1)
    run.folder_of("in")
    run.folder_of("o")
    for name in ("a.obj", "b.c.obj"):
        run.write("in/" + name, CUBE)

    def outputs(*arguments, count=2):
        run.ffd("batch", *arguments, "--force", "-q", "--report", "r.json")
        equal(len(report(run)), count)
        return [entry["output"] for entry in report(run)]

    for to, names in (("ply", ["o/a.ply", "o/b.c.ply"]), (".STL", ["o/a.stl", "o/b.c.stl"]), ("off", ["o/a.off", "o/b.c.off"])):
        equal(outputs("--in", "in/*.obj", "-l", "l.json", "--out-dir", "o", "--output-format", to), names)
        equal([json.loads(run.ffd("info", name, "--json", err=lambda said: None).text)["mesh_format"] for name in names],
              [to.strip(".").upper()] * 2)
    run.write("t.csv", "in\nin/a.obj\nin/b.c.obj\nin/a.obj\n")
    equal(outputs("--csv", "t.csv", "-l", "l.json", "--out-dir", "o", "--output-format", "ply", count=3),
          ["o/a-1.ply", "o/b.c.ply", "o/a-3.ply"])
    run.write("m.jsonl", lines_of([{**job(), "out": name, "options": {"output-format": to}} for name, to in (
        ("o/1.obj", "ply"), ("o/2.PLY", "ply"), ("o/3.dat", "ply"), ("o/4", "ply"), ("o/5.ply", "stl"), ("o/6.obj", False))]))
    equal(outputs("m.jsonl", "--output-format", "off", count=6), ["o/1.ply", "o/2.PLY", "o/3.dat", "o/4", "o/5.stl", "o/6.obj"])
    equal(run.names("o")[:6], ["1.ply", "2.PLY", "3.dat", "4", "5.stl", "6.obj"])
    # Names that become equal.
    shutil.copy(run.path("in/a.obj"), run.path("in/a.OBJ"))
    run.ffd("batch", "--in", "in/*", "-l", "l.json", "--out-dir", "o", "--output-format", "glb", code=USAGE,
            err='in/a.OBJ and in/a.obj would both be written as "a.glb"')
    run.write("m.jsonl", lines_of([{**job(), "out": "o/7.obj"}, {**job(), "out": "o/7.stl"}]))
    batch(run, "m.jsonl", "--output-format", "ply", done=1, failed=[r'^m\.jsonl:2: "o/7\.ply" is written by the job of line 1 too$'])


@case
def copies_are_outputs_too(run):
    """Of two files that would be copied to one place the later job's is refused, unless they have the same bytes."""
    start(run)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="g.bin")
    asset["images"] = [{"uri": "t%2Epng"}]
    left = {**asset, "images": [{"uri": "none.png"}, {"uri": "notes.txt"}]}
    for folder, shade in (("in", "a"), ("in2", "b"), ("same", "a")):
        run.write(f"{folder}/m.obj", "mtllib m.mtl\n" + CUBE)
        run.write(f"{folder}/m.mtl", f"newmtl {shade}\nmap_Kd x.png\n")
        run.write(f"{folder}/x.png", PNG + b"x")
        run.write(f"{folder}/g.gltf", asset)
        run.write(f"{folder}/g.bin", data)
        run.write(f"{folder}/t.png", PNG + shade.encode())
        run.write(f"{folder}/n.gltf", left)
        run.write(f"{folder}/notes.txt", folder)

    def jobs(*triples, **options):
        for folder in ("out", "out2"):
            shutil.rmtree(run.path(folder), ignore_errors=True)
            run.folder_of(folder)
        run.write("m.jsonl", lines_of([{**job(), "in": mesh, "out": out, "options": options} for mesh, out in triples]))
        return len(triples)

    judge(run, [(2, "out/m.mtl", 1)], jobs(("in/m.obj", "out/1.obj"), ("in2/m.obj", "out/2.obj"), ("in2/m.obj", "out2/3.obj")), "-j2")
    equal(run.names("out"), ["1.obj", "m.mtl", "x.png"])
    judge(run, [(2, "out/t.png", 1)], jobs(("in/g.gltf", "out/1.gltf"), ("in2/g.gltf", "out/2.gltf")), "-j2")
    count = jobs(("in/m.obj", "out/1.obj"), ("in/m.obj", "out/2.obj"), ("same/m.obj", "out/3.obj"), ("same/g.gltf", "out/4.gltf"),
                 ("in/g.gltf", "out/5.gltf"), ("in2/m.obj", "in2/6.obj"))
    batch(run, "m.jsonl", "-j2", done=count)
    jobs(("in/g.gltf", "out/1.gltf"), ("in2/g.gltf", "out/2.gltf"), resources="reference")
    batch(run, "m.jsonl", done=2)
    # What is not copied is no output.
    jobs(("in/n.gltf", "out/1.gltf"), ("in2/n.gltf", "out/2.gltf"))
    run.ffd("batch", "m.jsonl", err=lambda said: check(any("was not copied" in line for line in said), said))


@case
def in_place_twice(run):
    start(run, [{"in": name, "lattice": "l.json", "options": {"in-place": True}} for name in ("p.obj", "./p.obj")])
    run.write("p.obj", CUBE)
    run.ffd("deform", "a.obj", "single.obj", "-l", "l.json")
    batch(run, "m.jsonl", done=1, failed=[r'^m\.jsonl:2: "\./p\.obj" is written by the job of line 1 too$'])
    equal(run.read("p.obj"), run.read("single.obj"))


@case
def files_of_the_run_itself(run):
    start(run, [{**job(), "out": name} for name in ("r.obj", "./d.obj", "j.obj", "o.obj")])
    told = [rf'^m\.jsonl:{i}: "{name}" is the manifest, the table, the report, the depfile, the journal, the index or the array of this run$'
            for i, name in enumerate((r"r\.obj", r"\./d\.obj", r"j\.obj"), 1)]
    batch(run, "m.jsonl", "--force", "--report", "r.obj", "--depfile", "d.obj", "--journal", "j.obj", done=1, failed=told)
    equal([e["status"] for e in report(run, "r.obj")], ["failed"] * 3 + ["ok"])


@case
def files_of_the_run_are_different_files(run):
    """Before any file is made, whatever the pair is, and whether or not its folder is there."""
    start(run, [job(0)])
    before = run.names()
    for arguments, why in (("--positions A.npy --journal A.npy", "A.npy: the journal and the array of --positions have the same name"),
                           ("--positions A.npy --journal ./A.json", "the journal and the list of the rows of --positions have"),
                           ("--positions A.npy --report A.json", "the report and the list of the rows"),
                           ("--view V --journal V/index.html", "the journal and the index of --view have the same name"),
                           ("--view V --report ./V/index.html", "the report and the index of --view have the same name"),
                           ("--view V --shard 1/2 --depfile V/index-1-of-2.html", "the depfile and the index of --view have"),
                           ("--report R.json --journal R.json", "the report and the journal have the same name"),
                           ("--depfile R.d --journal ./R.d", "the depfile and the journal have the same name"),
                           ("--report x.json --depfile x.json", "the report and the depfile have the same name"),
                           ("--report - --depfile -", "the report and the depfile cannot both go to standard output"),
                           ("--journal m.jsonl", "the journal would replace the manifest"),
                           ("--report ./m.jsonl", "the report would replace the manifest"),
                           ("--depfile m.jsonl", "the depfile would replace the manifest")):
        run.ffd("batch", "m.jsonl", "--force", *arguments.split(), code=USAGE, err=re.compile(re.escape(why)), lines=1)
        equal(run.names(), before, arguments)
    run.write("t.csv", "in,out\na.obj,o.obj\n")
    run.ffd("batch", "--csv", "t.csv", "-l", "l.json", "--journal", "l.json", code=USAGE, err=re.compile("the journal would replace a lattice"))
    run.ffd("batch", "--csv", "t.csv", "-l", "l.json", "--report", "t.csv", code=USAGE, err=re.compile("the report would replace the table"))
    batch(run, "m.jsonl", "--view", "V", "--journal", "V/j", "--report", "V/r.json", "--depfile", "V/d", done=1)


@case
def no_job_replaces_what_the_jobs_come_from(run):
    """A manifest and a table, under other names too; in a dry run and with the report of another name."""
    own = 'is the manifest, the table, the report, the depfile, the journal, the index or the array of this run$'
    start(run)
    force = {"options": {"output-format": "obj", "force": True}}
    jobs = [job(1, **force), job(2, out="m.jsonl", **force), job(3, out="link", **force)]
    os.symlink("m.jsonl", run.path("link"))
    told = [rf'^m\.jsonl:2: "m\.jsonl" {own}', rf'^m\.jsonl:3: "link" {own}']
    run.write("m.jsonl", lines_of(jobs))
    batch(run, "m.jsonl", "--dry-run", done=1, failed=told, data=True)
    batch(run, "m.jsonl", "-j", "2", done=1, failed=told)
    equal(run.text("m.jsonl"), lines_of(jobs))
    table = "in,lattice,out\na.obj,l.json,o.obj\na.obj,l.json,./t.csv\n"
    run.write("t.csv", table)
    batch(run, "--csv", "t.csv", "--output-format", "obj", "--force", done=1, failed=[rf'^t\.csv:3: "\./t\.csv" {own}'])
    equal(run.text("t.csv"), table)


@case
def tables_and_patterns(run):
    start(run)
    run.write("t.csv", "in,lattice,out\na.obj,l.json,o.obj\na.obj,l.json,p.obj\na.obj,l.json,./o.obj\n")
    batch(run, "--csv", "t.csv", done=2, failed=[r'^t\.csv:4: "\./o\.obj" is written by the job of line 2 too$'])
    model(run, "b", 2)
    for name in ("x.gltf", "x-1.gltf"):
        run.write("in/" + name, run.text("b.gltf"))
    for i in range(2):
        run.write(f"in/b{i}.bin", run.read(f"b{i}.bin"))
    run.folder_of("out")
    done = run.ffd("batch", "--in", "in/*.gltf", "-l", "l.json", "--out-dir", "out", code=1, err=lambda said: None)
    check(done.err[0].endswith('is written by job 1 too') and "in/x" in done.err[0], done.err)


@case
def the_first_of_many_outputs_is_still_known(run):
    """More than the table holds at first; the last is the first again."""
    count = 600
    start(run, [job(i) for i in range(count)] + [job(0), job(count - 1)])
    batch(run, "m.jsonl", "--dry-run", done=count, failed=[rf"^m\.jsonl:{count + 1}: .*line 1 too$", rf"^m\.jsonl:{count + 2}: .*line {count} too$"],
          out="".join(f"to do: a.obj -> o{i}.obj\n" for i in range(count)))


main()
