#!/usr/bin/env python3
"""ffd batch: many lattices over one mesh are done by all workers, each of which reads the mesh and looks for u,v,w once,
and every output and figure is that of a run of its own."""

import json
import os
import re
import signal
import subprocess
import time

from batches import batch, case, check, equal, job, lines_of, main, report, start
from harness import CUBE, FFD, NO, OK, PNG, SECONDS, glb, gltf_json, lattice
from neighbours import write_meshes

COUNTS = re.compile(r"(\d+) workers?: meshes read (\d+) times?, u,v,w looked for (\d+) times?$")
WORKERS, JOBS = 3, 5


def write_sweep(run, rest):
    """Lattices of one rest volume with other moves, some of them none. Returns their names."""
    names = [f"s{k}.json" for k in range(JOBS)]
    for k, name in enumerate(names):
        run.write(name, lattice(moves=[{"twist": {"axis": "z", "degrees": 9 * k}}, {"at": [1, 2, 1], "by": [0.1 * k, 0, 0]}], **rest))
    return names


def counts(run, *arguments, code=OK):
    """Runs a batch and returns how many workers there were, and how often they read meshes and looked for u,v,w."""
    found = []
    run.ffd("batch", *arguments, "-v", code=code, err=lambda said: found.extend(m for m in map(COUNTS.search, said) if m))
    equal(len(found), 1, "lines that tell what was read")
    return [int(number) for number in found[0].groups()]


def alone(run, mesh, name, target, *options):
    """The report's entry of a command of its own."""
    run.ffd("deform", mesh, "single/" + target, "-l", name, *options, "--report", "s.json", "--report-stable",
            code=(OK, NO), err=lambda said: None)
    entry = report(run, "s.json")[0]
    entry["output"], entry["outputs"] = target, [name.replace("single/", "", 1) for name in entry["outputs"]]
    return entry


@case
def every_worker_reads_and_searches_once(run):
    start(run)
    run.folder_of("single")
    names = write_sweep(run, {"low": (-0.5, -2, -2)})  # some of the vertices are outside
    for mesh in write_meshes(run):
        stem, ending = os.path.splitext(mesh)
        targets = [f"{stem}{k}{ending}" for k in range(JOBS)]
        run.write("m.jsonl", lines_of([{"in": mesh, "lattice": name, "out": target} for name, target in zip(names, targets)]))
        equal(counts(run, "m.jsonl", "-j", str(WORKERS), "--report", "r.json", "--report-stable"), [WORKERS] * 3, mesh)
        for name, target, entry in zip(names, targets, report(run)):
            del entry["line"], entry["set"]
            equal(entry, alone(run, mesh, name, target), f"report of {mesh} with {name}")
        # What was hashed while it was written is what is there.
        equal(counts(run, "m.jsonl", "-j", str(WORKERS), "--resume")[1:], [0, 0], mesh + " again")
    for name in run.names("single"):
        equal(run.read(name) == run.read("single/" + name), True, f"{name} is that of a single run")
    check(len(run.names("single")) > 7 * JOBS, "too few outputs")


@case
def a_table_of_placeholders(run):
    """The lattice is another one for each row, and its rest volume is not."""
    start(run)
    run.folder_of("single")
    for ending, mesh in (("obj", "m.obj"), ("glb", "m.glb")):
        write_meshes(run)
        run.write("p.json", lattice(moves=[{"at": [1, 2, 1], "by": [{"$": "X"}, 0, {"$": "X"}]}]))
        run.write("t.csv", "in,out,X\n" + "".join(f"{mesh},x{i}.{ending},{i / 8}\n" for i in range(40)))
        equal(counts(run, "--csv", "t.csv", "-l", "p.json", "-j", "2"), [2] * 3, mesh)
        for i in range(0, 40, 5):
            alone(run, mesh, "p.json", f"x{i}.{ending}", "--set", f"X={i / 8}")
            equal(run.read(f"x{i}.{ending}") == run.read(f"single/x{i}.{ending}"), True, f"x{i}.{ending}")


@case
def a_worker_keeps_to_its_mesh(run):
    """Where there is a mesh for each worker, none changes to the other's before its own is done."""
    start(run, [job(i, **{"in": ["a.obj", "b.obj"][i // 2 % 2]}) for i in range(60)])
    run.write("b.obj", CUBE.replace("v 1 1 1", "v 1 1 1.5"))
    workers, reads, searches = counts(run, "m.jsonl", "-j", "2")
    check(workers == 2 and 2 <= reads == searches <= 3, workers, reads, searches)
    # One job for each of two workers, however many there might be.
    run.write("m.jsonl", lines_of([job(i) for i in range(2)]))
    equal(counts(run, "m.jsonl", "-j", "5", "--force"), [2] * 3)


@case
def a_large_mesh_is_left_to_one_worker(run):
    """A GLB of another version fails at once, whatever its size; a hole takes no space."""
    start(run, [job(i, **{"in": "x.glb", "out": f"x{i}.glb"}) for i in range(6)])
    run.write("x.glb", b"glTF\x01\0\0\0")
    for size, workers in (((1 << 28) + 1, 1), (1 << 28, 2)):
        os.truncate(run.path("x.glb"), size)
        equal(counts(run, "m.jsonl", "-j", "2", code=NO), [workers, 0, 0], f"{size} bytes")


class Stream:
    """A batch that gets its jobs one after the other."""

    def __init__(self, run, *arguments):
        self.run = run
        self.process = subprocess.Popen([FFD, "batch", "-", "-j", "2", *arguments], cwd=run.folder, stdin=subprocess.PIPE,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)

    def do(self, one):
        """Has a job done."""
        self.process.stdin.write((json.dumps(one) + "\n").encode())
        self.process.stdin.flush()
        limit = time.monotonic() + SECONDS
        while not self.run.exists(one["out"]):
            if self.process.poll() is not None or time.monotonic() > limit:
                os.killpg(self.process.pid, signal.SIGKILL)
                raise AssertionError(f"{one['out']} does not come: {self.process.communicate()[1].decode()}")
            time.sleep(0.001)

    def end(self):
        said = self.process.communicate(timeout=SECONDS)[1].decode()
        equal(self.process.returncode, OK, said)
        return said.splitlines()


def replace(run, name, content):
    run.write("new", content)
    os.replace(run.path("new"), run.path(name))


def judge_change(run, mesh, changed, content, *options):
    """Does two jobs, changes a file of their mesh, and does three more: the first of these says so."""
    stem, ending = os.path.splitext(mesh)
    stream = Stream(run, *options)
    jobs = [{"in": mesh, "lattice": "l.json", "out": f"{stem}-{i}{ending}"} for i in range(5)]
    for i, one in enumerate(jobs):
        if i == 2:
            replace(run, changed, content)
        stream.do(one)
    said = [line for line in stream.end() if "has changed" in line]
    equal(len(said), 1, f"lines of {said}")
    check(re.search(rf": {re.escape(mesh)}: has changed while the run reads it", said[0]), said)
    return [run.read(name) for name in (one["out"] for one in jobs)]


@case
def a_mesh_that_changes_meanwhile_is_said(run):
    start(run)
    write_meshes(run)
    for options in ((), ("--quiet", "--force")):
        run.write("c.obj", CUBE)
        for i in range(5):
            if run.exists(f"c-{i}.obj"):
                run.remove(f"c-{i}.obj")
        old, again, new, *more = judge_change(run, "c.obj", "c.obj", CUBE.replace("v 1 1 1", "v 1 1 1.5"), *options)
        check(old == again != new and more == [new] * 2, "outputs are not those of the two states")
    data = run.read("m.bin")
    judge_change(run, "m.gltf", "m.bin", bytes(reversed(data[:12])) + data[12:])


@case
def an_output_that_names_an_image(run):
    """Its own bytes are not all that it is."""
    start(run, [{"in": "i.glb", "lattice": "l.json", "out": f"x{i}.glb"} for i in range(3)])
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    asset["images"] = [{"uri": "t.png"}]
    run.write("i.glb", glb(asset, data))
    run.write("t.png", PNG + b"one")
    batch(run, "m.jsonl", "-j", "2", done=3)
    batch(run, "m.jsonl", "-j", "2", "--resume", kept=3)
    run.write("t.png", PNG + b"two")
    batch(run, "m.jsonl", "-j", "2", "--resume", done=3)


@case
def a_mesh_that_stays_is_not_told(run):
    start(run, [job(i) for i in range(20)] + [job(20 + i, options={"as-morph": "x"}, **{"in": "m.glb", "out": f"g{i}.glb"}) for i in range(4)])
    write_meshes(run)
    batch(run, "m.jsonl", "-j", "3", done=24)


main()
