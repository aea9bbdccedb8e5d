"""Many jobs in one invocation beside a command each, one after the other, in jobs a second."""

import json
import os
import shutil
import sys
import tempfile
import time

import lattices
import meshes
import programs

# Meshes of about 1,000 vertices, and of 1,849.
SMALL = 32
VARIANT = 43


def few(bench):
    """How many jobs are done by a command of its own each, and how many lattices make a sweep."""
    return max(1, bench.jobs // 10)


def write_manifest(path, jobs):
    with open(path, "w", encoding="ascii") as file:
        for source, lattice, target in jobs:
            file.write(json.dumps({"in": source, "lattice": lattice, "out": target}) + "\n")


def by_batch(bench, jobs):
    manifest = bench.path("jobs.jsonl")
    write_manifest(manifest, jobs)
    command = [bench.ffd, "batch", manifest, "--quiet", "--journal", bench.path("journal"),
               *(["-j", str(bench.threads)] if bench.threads else [])]
    return len(jobs) / programs.measure(programs.Command(command))[0]


def by_many(bench, jobs):
    """All meshes in one command, which deforms them one after the other with one lattice."""
    sources, (lattice, *_), targets = zip(*jobs)
    command = [bench.ffd, "deform", *sources, "--out-dir", os.path.dirname(targets[0]), "-l", lattice, "--quiet",
               *(["--threads", str(bench.threads)] if bench.threads else [])]
    return len(jobs) / programs.measure(programs.Command(command))[0]


def table_command(bench, jobs, has_outputs):
    """A batch with a row for each job, which gives values to the placeholders of one lattice."""
    table, lattice = bench.path("rows.csv"), jobs[0][1]
    with open(table, "w", encoding="ascii") as file:
        file.write("in,out,X,Z\n" if has_outputs else "in,X,Z\n")
        file.writelines(f"{source},{target + ',' if has_outputs else ''}{k / 1e5},{k / 2e5}\n"
                        for k, (source, _, target) in enumerate(jobs))
    return [bench.ffd, "batch", "--csv", table, "-l", lattice, "--quiet", "--journal", bench.path("journal"),
            *(["-j", str(bench.threads)] if bench.threads else [])]


def by_table(bench, jobs):
    return len(jobs) / programs.measure(programs.Command(table_command(bench, jobs, True)))[0]


def by_positions(bench, jobs):
    """A row each of one array, in place of files."""
    command = table_command(bench, jobs, False)
    return len(jobs) / programs.measure(programs.Command([*command, "--positions", bench.path("all.npy"), "--force"]))[0]


def by_writing(bench, jobs):
    """As many bytes as the array has, written by one process, row by row."""
    row, path = bytes(VARIANT ** 2 * 12), bench.path("written")
    begin = time.perf_counter()
    with open(path, "wb", buffering=0) as file:
        for _ in jobs:
            file.write(row)
    seconds = time.perf_counter() - begin
    os.remove(path)
    return len(jobs) / seconds


def by_creating(bench, jobs):
    """Files with the bytes of the mesh, made by as many processes as the batch has workers."""
    with open(jobs[0][0], "rb") as file:
        content = file.read()
    processes = bench.threads or os.cpu_count()
    begin = time.perf_counter()
    children = [start_creating([target for _, _, target in jobs[k::processes]], content) for k in range(processes)]
    codes = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children]
    if any(codes):
        sys.exit("could not make files")
    return len(jobs) / (time.perf_counter() - begin)


def start_creating(paths, content):
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        for path in paths:
            with open(path, "xb", buffering=0) as file:
                file.write(content)
        code = 0
    finally:
        os._exit(code)


def by_commands(bench, jobs):
    return len(jobs) / sum(programs.measure(bench.deform(source, lattice, target=target))[0]
                           for source, lattice, target in jobs)


def rates(bench, out, ways):
    """What each way of doing its jobs reaches, in turns; the folder of outputs is empty before each.

    What was written stays until the benchmark ends: ext4 takes long to make files in the seconds after as many were
    removed, for it does not give their inodes away again and looks for others. Its bytes go: where too many wait for the
    disk, whoever writes next waits too.
    """
    reached, kept = [[] for _ in ways], tempfile.mkdtemp(dir=bench.folder)
    for run in range(bench.runs):
        for number, ((way, jobs), values) in enumerate(zip(ways, reached)):
            os.mkdir(out)
            values.append(way(bench, jobs))
            aside = os.path.join(kept, f"{run}-{number}")
            os.rename(out, aside)
            for name in os.listdir(aside):
                os.truncate(os.path.join(aside, name), 0)
    return reached


def small_meshes(bench, ending, write):
    """Different files, as many as there are jobs, of the same bytes."""
    folder = bench.path("meshes-" + ending)
    os.mkdir(folder)
    paths = [os.path.join(folder, f"{k}.{ending}") for k in range(bench.jobs)]
    meshes.make(paths[0], write, SMALL)
    for path in paths[1:]:
        shutil.copyfile(paths[0], path)
    return paths


def batch(bench):
    """Meshes of about 1,000 vertices: different ones; and one with as many outputs, which is read and embedded once."""
    out = bench.path("outputs")
    bench.table.title(f"Batch of {bench.jobs:,} meshes of {SMALL ** 2:,} vertices")
    for ending, write in (("obj", meshes.write_obj), ("glb", meshes.write_glb)):
        sources = small_meshes(bench, ending, write)
        targets = [os.path.join(out, os.path.basename(source)) for source in sources]
        for name, lattice in bench.lattices.items():
            different = [(source, lattice, target) for source, target in zip(sources, targets)]
            shared = [(sources[0], lattice, target) for target in targets]
            alone, following, many, one = rates(bench, out, [(by_commands, different[:few(bench)]), (by_many, different),
                                                             (by_batch, different), (by_batch, shared)])
            row = bench.table.add(f"{ending}, {name}: a command each", alone, "meshes/s")
            bench.table.add(f"{ending}, {name}: ffd deform IN...", following, "meshes/s", row)
            bench.table.add(f"{ending}, {name}: batch", many, "meshes/s", row, ">= 1000 /s")
            bench.table.add(f"{ending}, {name}: batch, outputs of one mesh", one, "meshes/s", row)


def sweep(bench):
    """One mesh with many lattices of one rest volume: what sharing mesh and u,v,w brings; and a table of placeholders on a
    small mesh, beside how fast the machine makes as many files."""
    large_sweep(bench)
    rows(bench)


def large_sweep(bench):
    side, count, out = 8 * bench.side // 25, few(bench), bench.path("outputs")
    source = bench.mesh("sweep.glb", meshes.write_glb, side)
    bench.table.title(f"Sweep of {count} lattices of 4^3 over {side * side:,} vertices (GLB)")
    for name in bench.lattices:
        size = 4 if name == "box" else lattices.SIZE
        jobs = [(source, lattices.write_kind(bench.path(f"sweep-{k}.json"), name,
                                             [{"at": [1, 1, 1], "by": [0.001 * k, 0, 0]}], size),
                 os.path.join(out, f"{k}.glb")) for k in range(count)]
        alone, together, made = rates(bench, out, [(by_commands, jobs), (by_batch, jobs), (by_creating, jobs)])
        row = bench.table.add(f"{name}: a command each", alone, "jobs/s")
        bench.table.add(f"{name}: batch", together, "jobs/s", row, ">= 8" if name == "box" else "")
        bench.table.add(f"{name}: files of that size made", made, "files/s", row)


def rows(bench):
    count, out = 10 * bench.jobs, bench.path("outputs")
    bench.table.title(f"Table of {count:,} rows on {SMALL ** 2:,} vertices")
    for ending, write in (("obj", meshes.write_obj), ("glb", meshes.write_glb)):
        source = bench.mesh("rows." + ending, write, SMALL)
        lattice = lattices.write(bench.path("rows.json"), 4, lattices.RESTS["box"],
                                 [lattices.TWIST, {"at": [1, 1, 1], "by": [{"$": "X"}, 0, {"$": "Z"}]}])
        jobs = [(source, lattice, os.path.join(out, f"{k}.{ending}")) for k in range(count)]
        made, done = rates(bench, out, [(by_creating, jobs), (by_table, jobs)])
        row = bench.table.add(f"{ending}: files of that size made", made, "files/s")
        bench.table.add(f"{ending}: batch", done, "jobs/s", row, ">= 2000 /s or 1")


def positions(bench):
    """Variants of one mesh as rows of an array, beside as many bytes written, and beside a mesh file each (of a tenth)."""
    count, out = 50 * bench.jobs, bench.path("outputs")
    bench.table.title(f"Array of {count:,} variants of {VARIANT ** 2:,} vertices")
    source = bench.mesh("variants.obj", meshes.write_obj, VARIANT)
    for name in bench.lattices:
        lattice = lattices.write_kind(bench.path("variants.json"), name,
                                      [lattices.TWIST, {"at": [1, 1, 1], "by": [{"$": "X"}, 0, {"$": "Z"}]}])
        jobs = [(source, lattice, os.path.join(out, f"{k}.obj")) for k in range(count)]
        written, files, done = rates(bench, out, [(by_writing, jobs), (by_table, jobs[:count // 10]), (by_positions, jobs)])
        row = bench.table.add(f"{name}: as many bytes written", written, "rows/s")
        bench.table.add(f"{name}: a mesh file each", files, "jobs/s", row)
        bench.table.add(f"{name}: rows", done, "jobs/s", row, ">= 2000 /s")
