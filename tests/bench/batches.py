"""Many jobs in one invocation beside a command each, one after the other, in jobs a second."""

import json
import os
import shutil
import tempfile

import lattices
import meshes
import programs

# A mesh of about 1,000 vertices.
SMALL = 32


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


def by_commands(bench, jobs):
    return len(jobs) / sum(programs.measure(bench.deform(source, lattice, target=target))[0]
                           for source, lattice, target in jobs)


def rates(bench, out, ways):
    """What each way of doing its jobs reaches, in turns; the folder of outputs is empty before each.

    What was written stays until the benchmark ends: ext4 takes long to make files in the seconds after as many were
    removed, for it does not give their inodes away again and looks for others.
    """
    reached, kept = [[] for _ in ways], tempfile.mkdtemp(dir=bench.folder)
    for run in range(bench.runs):
        for number, ((way, jobs), values) in enumerate(zip(ways, reached)):
            os.mkdir(out)
            values.append(way(bench, jobs))
            os.rename(out, os.path.join(kept, f"{run}-{number}"))
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
    """One mesh with many lattices of one rest volume: what sharing mesh and u,v,w brings."""
    side, count, out = 8 * bench.side // 25, few(bench), bench.path("outputs")
    source = bench.mesh("sweep.glb", meshes.write_glb, side)
    bench.table.title(f"Sweep of {count} lattices over {side * side:,} vertices (GLB)")
    for name in bench.lattices:
        jobs = [(source, lattices.write_kind(bench.path(f"sweep-{k}.json"), name,
                                             [{"at": [1, 1, 1], "by": [0.001 * k, 0, 0]}]),
                 os.path.join(out, f"{k}.glb")) for k in range(count)]
        alone, together = rates(bench, out, [(by_commands, jobs), (by_batch, jobs)])
        row = bench.table.add(f"{name}: a command each", alone, "jobs/s")
        bench.table.add(f"{name}: batch", together, "jobs/s", row)
