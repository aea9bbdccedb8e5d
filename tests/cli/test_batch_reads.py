#!/usr/bin/env python3
"""ffd batch: no job reads what another one writes, whichever comes first, in every mode and with any number of workers."""

import itertools
import json
import os
import shutil

from batches import MOVE, batch, case, check, equal, job, lines_of, main, report, start
from harness import CUBE, CUBE_CORNERS, INVALID, NO, PNG, gltf_json, lattice

MODES = ([], ["-j1"], ["-j", "4"], ["--resume"], ["--force"], ["--if-changed"])


def written(line, role, name, other):
    return rf'^m\.jsonl:{line}: {role} "{name}" is written by the job of line {other} too$'


def begin(run):
    """A cube; a glTF with a buffer, an image and a file of an extension; an OBJ with a material library; a lattice with a box round two of them."""
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="g.bin")
    run.write("g.gltf", {**asset, "images": [{"uri": "g.png"}], "extensions": {"EXT_structural_metadata": {"schemaUri": "g.schema"}}})
    run.write("g.schema", "{}")
    run.write("g.bin", data)
    run.write("g.png", PNG)
    run.write("k.obj", "mtllib k.mtl\n" + CUBE)
    run.write("k.mtl", "newmtl a\n")
    run.write("box.json", lattice(moves=MOVE, rest={"box": {"meshes": ["a.obj", "g.gltf"]}, "margin": 0.1}))
    return {name: run.read(name) for name in run.names() if name not in ("cache", "m.jsonl", "r.json")}


def judge(run, kept, jobs, clashes, *arguments):
    """Of the jobs those of the clashes fail, in a dry run too; inputs are as they were, but for outputs of others."""
    run.write("m.jsonl", lines_of(jobs))
    done = len(jobs) - len(clashes)
    batch(run, "m.jsonl", "--dry-run", "--force", done=done, failed=clashes, data=True)
    batch(run, "m.jsonl", "--force", "--report", "r.json", *arguments, done=done, failed=clashes)
    equal([entry["exit"] for entry in report(run) if entry["status"] == "failed"], [INVALID] * len(clashes))
    outputs = {one.get("out", one["in"]) for one in jobs}
    equal({name: run.read(name) for name in kept if name not in outputs}, {name: kept[name] for name in kept if name not in outputs})


@case
def siege3_09_a_job_that_reads_the_output_of_another_fails(run):
    """The result is that of the first job alone, in either order of the lines, whether or not the file is there already."""
    first, second = job(**{"out": "once.obj"}), job(**{"in": "once.obj", "out": "twice.obj"})
    start(run)
    run.ffd("deform", "a.obj", "single.obj", "-l", "l.json")
    for order, old, arguments in itertools.product((0, 1), (False, True), MODES):
        run.write("m.jsonl", lines_of([second, first] if order else [first, second]))
        for name in ("once.obj", "twice.obj"):
            if run.exists(name):
                run.remove(name)
        shutil.rmtree(run.path("cache"), ignore_errors=True)
        if old:
            run.write("once.obj", CUBE)
        told = [written(1 if order else 2, "the mesh", r"once\.obj", 2 if order else 1)]
        stays = old and not {"--force", "--if-changed", "--resume"} & set(arguments)
        failed = told + ([r"once\.obj: exists already"] if stays else [])
        batch(run, "m.jsonl", *arguments, done=0 if stays else 1, failed=failed)
        equal(run.exists("twice.obj"), False)
        if not stays:
            equal(run.read("once.obj"), run.read("single.obj"), f"{arguments}")
    # From a stream later lines are not known: the later one of the two fails.
    for jobs, told in (([first, second], 'standard input:2: the mesh "once.obj" is written by the job of line 1 too'),
                       ([second, first], 'standard input:2: "once.obj" is read by the job of line 1')):
        run.write("once.obj", CUBE)
        for workers in "14":
            run.ffd("batch", "-", "--force", "-j", workers, "-q", stdin=lines_of(jobs).encode(), code=NO,
                    err=lambda said, told=told: equal(said[0], told))


@case
def every_file_that_is_read_counts(run):
    """Lattices, embeddings, buffers, images, files of extensions, material libraries, the meshes of a box and their buffers."""
    kept = begin(run)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    as_obj = {"output-format": "obj"}
    others = "the buffer, image, library or other file"
    box = "the mesh of a box, or its buffer,"
    for reader, output, role in ((job(9, **{"in": "k.obj", "lattice": "l.json"}), "l.json", "the lattice"),
                                 (job(9, options={"embedding": "e.npy"}), "e.npy", "the embedding"),
                                 (job(9, **{"in": "g.gltf", "out": "n.gltf"}), "g.bin", others),
                                 (job(9, **{"in": "g.gltf", "out": "n.gltf"}), "g.png", others),
                                 (job(9, **{"in": "g.gltf", "out": "n.gltf"}), "g.schema", others),
                                 (job(9, **{"in": "k.obj"}), "k.mtl", others),
                                 (job(9, **{"in": "k.obj", "lattice": "box.json"}), "a.obj", box),
                                 (job(9, **{"in": "k.obj", "lattice": "box.json"}), "g.bin", box)):
        writer = {"in": "other.obj", "lattice": "other.json", "out": output, "options": as_obj}
        for order in (0, 1):
            for name, content in kept.items():
                run.write(name, content)
            run.write("other.obj", CUBE)
            run.write("other.json", kept["l.json"])
            line = 1 if order else 2
            judge(run, kept, [reader, writer] if order else [writer, reader],
                  [written(line, role, output.replace(".", r"\."), 3 - line)], "-j", "2")


@case
def one_file_has_many_names_here_too(run):
    start(run)
    run.folder_of("sub")
    os.symlink("sub", run.path("link"))
    os.symlink("a.obj", run.path("alias.obj"))
    run.write("sub/b.obj", CUBE)
    judge(run, {}, [job(**{"in": "sub/b.obj", "out": "./a.obj"}), job(1), job(2, **{"in": "alias.obj"}), job(3, **{"in": "sub/../a.obj"}),
                    job(4, **{"in": "link/b.obj"})],
          [written(2, "the mesh", r"a\.obj", 1), written(3, "the mesh", r"alias\.obj", 1), written(4, "the mesh", r"sub/\.\./a\.obj", 1)])


@case
def a_link_to_an_output_to_come_is_that_output(run):
    """With one worker it leads to the first job's output when the second one begins, with two perhaps to nothing."""
    for workers in "12":
        start(run)
        run.remove("o1.obj")
        if not os.path.islink(run.path("early.obj")):
            os.symlink("o1.obj", run.path("early.obj"))
        run.write("m.jsonl", lines_of([job(1), job(2, **{"in": "early.obj"}), job(3, out="early.obj")]))
        batch(run, "m.jsonl", "--force", "-j", workers, done=1,
              failed=[written(2, "the mesh", r"early\.obj", 1), r'^m\.jsonl:3: "early\.obj" is written by the job of line 1 too$'])


@case
def a_job_in_place_reads_its_own_file_and_no_other_one_does(run):
    """A mesh in place may stand in the box of its own lattice. One that is in the box of another job stops that job."""
    kept = begin(run)
    in_place = {"options": {"in-place": True}}
    judge(run, kept, [{"in": "a.obj", "lattice": "box.json", **in_place}, job(5, **{"in": "k.obj"})], [])
    for workers in "14":
        kept = begin(run)
        judge(run, kept, [{"in": "a.obj", "lattice": "l.json", **in_place}, job(1, **{"in": "k.obj", "lattice": "box.json"}), job(2)],
              [written(2, "the mesh of a box, or its buffer,", r"a\.obj", 1), written(3, "the mesh", r"a\.obj", 1)], "-j", workers)
        equal(run.read("g.gltf"), kept["g.gltf"])


@case
def siege3_05_boxes_go_round_the_meshes_as_they_were(run):
    """Two meshes in place, with a box round both: both jobs fail, with any number of workers. --shared-box does both."""
    start(run)
    run.write("kit.json", lattice(moves=MOVE, rest={"box": {"meshes": ["a.obj", "b.obj"]}, "margin": 0.1}))
    run.write("round.json", lattice(moves=MOVE, rest={"box": "mesh", "margin": 0.1}))
    run.write("b.obj", CUBE.replace("v 1", "v 1.5"))
    kept = {name: run.read(name) for name in ("a.obj", "b.obj")}
    jobs = [{"in": name, "lattice": "kit.json", "options": {"in-place": True}} for name in kept]
    told = [written(1, "the mesh of a box, or its buffer,", r"b\.obj", 2), written(2, "the mesh of a box, or its buffer,", r"a\.obj", 1)]
    for workers in "124":
        judge(run, {}, jobs, told, "-j", workers)
        equal({name: run.read(name) for name in kept}, kept)
    run.folder_of("apart")
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "apart", "-l", "kit.json")
    run.write("m.jsonl", lines_of([{**one, "lattice": "round.json"} for one in jobs]))
    batch(run, "m.jsonl", "--shared-box", "-j2", done=2)
    equal({name: run.read(name) for name in kept}, {name: run.read("apart/" + name) for name in kept})


@case
def a_shard_knows_its_own_jobs_only(run):
    start(run, [job(**{"out": "once.obj"}), job(1), job(2, **{"in": "once.obj"}), job(3, **{"in": "once.obj"})])
    run.write("once.obj", CUBE)
    batch(run, "m.jsonl", "--shard", "0/2", "--force", done=1, failed=[written(3, "the mesh", r"once\.obj", 1)])
    batch(run, "m.jsonl", "--shard", "1/2", "--force", done=2)


@case
def what_fails_by_itself_stops_no_other_job(run):
    """A job whose output is its own mesh, and which is not in place, writes nothing."""
    start(run, [job(**{"out": "a.obj"}), job(1), job(2)])
    batch(run, "m.jsonl", "--force", done=2, failed=[r"a\.obj: is the input \(--in-place overwrites it\)"])


def model(run, name, buffer, **more):
    asset, data = gltf_json(CUBE_CORNERS, uri=buffer)
    run.write(name, {**asset, **more})
    run.write(os.path.join(os.path.dirname(name), buffer), data)


def buffers_of(run, *names):
    return [json.loads(run.read(name))["buffers"][0]["uri"] for name in names]


@case
def models_that_share_a_buffer_are_moved_once_each(run):
    """In place, in either order and with any number of workers; a model that is no job stays as it was."""
    run.folder_of("alone")
    start(run)
    for order, workers in itertools.product(((0, 1), (1, 0)), "124"):
        for name in run.names():
            if name.endswith((".bin", ".gltf")):
                run.remove(name)
        for name in "ab":
            model(run, name + ".gltf", "s.bin", extras=name)
        model(run, "n.gltf", "s.bin")
        at_rest = run.read("s.bin")
        run.write("m.jsonl", lines_of([{"in": "ab"[i] + ".gltf", "lattice": "l.json", "options": {"in-place": True}} for i in order]))
        run.ffd("batch", "m.jsonl", "-j", workers, "-q")
        equal((buffers_of(run, "a.gltf", "b.gltf", "n.gltf"), run.read("s.bin")), (["a.bin", "b.bin", "s.bin"], at_rest))
        model(run, "alone/a.gltf", "s.bin")
        run.ffd("deform", "alone/a.gltf", "--in-place", "-l", "l.json")
        equal([run.read(name) for name in ("a.bin", "b.bin")], [run.read("alone/" + buffers_of(run, "alone/a.gltf")[0])] * 2)


@case
def a_job_that_can_never_write_claims_no_file(run):
    """OUT without a mesh's ending fails by itself: a job that reads a file of that name goes on, in either order, and so does one that writes it."""
    begin(run)
    wrong = {"in": "a.obj", "out": "l.json", "lattice": "box.json"}
    told = r'^m\.jsonl:{}: l\.json: the ending "\.json" is not that of a mesh format'
    kept = run.read("l.json")
    for order, arguments in itertools.product((0, 1), MODES):
        shutil.rmtree(run.path("cache"), ignore_errors=True)
        if run.exists("fine.obj"):
            run.remove("fine.obj")
        jobs = [wrong, job(out="fine.obj")]
        run.write("m.jsonl", lines_of(jobs[::-1] if order else jobs))
        batch(run, "m.jsonl", *arguments, done=1, failed=[told.format(1 + order)])
        check(run.exists("fine.obj"), arguments)
        equal(run.read("l.json"), kept)
    run.write("m.jsonl", lines_of([{**wrong, "out": "x.txt"}, job(out="x.txt", options={"output-format": "obj"})]))
    batch(run, "m.jsonl", done=1, failed=[r'^m\.jsonl:1: x\.txt: the ending "\.txt" is not that of a mesh format'])


@case
def no_buffer_of_another_model_is_written_over(run):
    """The name of an output's buffer is passed over, with a warning; the look at the folder is made whatever else is known."""
    told = "is a file of n.gltf too, and stays: x-1.bin is written in place of it"
    for mesh in ("a.obj", "g.gltf", "g.glb"):
        for first in ([], [job(0)], [job(i) for i in range(40)]):  # by then the lattice is known
            begin(run)
            run.ffd("deform", "g.gltf", "g.glb", "-l", "l.json", "--force")
            model(run, "n.gltf", "x.bin")
            at_rest = run.read("x.bin")
            jobs = lines_of(first + [job(**{"in": mesh, "out": "x.gltf"})])
            for stream in (False, True):
                for name in ("x.gltf", "x-1.bin"):
                    if run.exists(name):
                        run.remove(name)
                run.write("m.jsonl", jobs)
                run.ffd("batch", "-" if stream else "m.jsonl", "--force", "-j", "1", stdin=jobs.encode() if stream else None,
                        err=lambda said: check(sum(told in line for line in said) == 1, said))
                equal((buffers_of(run, "x.gltf"), run.read("x.bin")), (["x-1.bin"], at_rest))


main()
