"""Single jobs, whole processes: time and memory of `ffd deform` beside `dd` on the same file, and what they hang on."""

import math
import os
import shutil
import statistics

import lattices
import meshes
import programs
from table import Row

SIZES = (4, 8, 16, 32, 64)


def vertices(side):
    return f"{side * side:,} vertices"


def start(bench):
    """What a process costs that has next to nothing to do, beside a program that does nothing."""
    source = bench.mesh("small.obj", meshes.write_points, 100)
    nothing = bench.built("nothing")
    jobs = {"a C++ program that does nothing": (nothing and programs.Command([nothing]), ""),
            "ffd --version": (programs.Command([bench.ffd, "--version"]), "< 5 ms"),
            "100 vertices, box": (bench.deform(source, bench.lattices["box"]), "< 8 ms"),
            "100 vertices, warped": (bench.deform(source, bench.lattices["warped"]), "< 8 ms")}
    jobs = {name: (command, bar) for name, (command, bar) in jobs.items() if command}
    bench.table.title("Start")
    samples = programs.in_turns([command for command, _ in jobs.values()], 6 * bench.runs + 1)
    least = None
    for (name, (_, bar)), sample in zip(jobs.items(), samples):
        row = bench.table.add(name, [1000 * seconds for seconds in sample.seconds], "ms", least, bar)
        least = least or (row if nothing else None)


def beside_copy(bench, source, bars):
    """Time and memory with each kind of lattice beside a plain copy."""
    size = Row("the file", [os.path.getsize(source) / 1e6], "MB")
    bench.table.title(f"{os.path.splitext(source)[1]}, {vertices(bench.side)} with normals, {size.median:.1f} MB")
    copy = bench.copy(source)
    programs.measure(copy)  # the file is in the page cache from here on
    for name, lattice in bench.lattices.items():
        deformed, copied = programs.in_turns([bench.deform(source, lattice), copy], bench.runs)
        plain = bench.table.add(f"{name}: dd bs=64M", copied.seconds, "s")
        bench.table.add(f"{name}: ffd deform", deformed.seconds, "s", plain, bars.get(name, ""))
        bench.table.add(f"{name}: peak memory", deformed.megabytes, "MB", size, "<= 1.5")


def glb(bench):
    beside_copy(bench, bench.glb(), {"box": "<= 2 (1.5)", "warped": "<= 10"})


def obj(bench):
    beside_copy(bench, bench.obj(), {"box": "<= 3 (2)"})


def sizes(bench):
    """What the number of control points costs, box lattices of 4^3 to 64^3: the whole process, and a vertex, which is
    what it takes longer than with 100 vertices."""
    small = bench.mesh("small.obj", meshes.write_points, 100)
    paths = [lattices.write_box(bench.path(f"box{size}.json"), size) for size in SIZES]
    whole, starts = (programs.in_turns([bench.deform(source, path) for path in paths], bench.runs)
                     for source in (bench.glb(), small))
    bench.table.title("Lattice size (GLB, box)")
    process = vertex = None
    for size, sample, begun in zip(SIZES, whole, starts):
        beginning = statistics.median(begun.seconds)
        costs = [1e9 * (seconds - beginning) / bench.side ** 2 for seconds in sample.seconds]
        row = bench.table.add(f"{size}^3: whole process", sample.seconds, "s", process)
        cost = bench.table.add(f"{size}^3: a vertex", costs, "ns", vertex, "<= 1.5" if vertex else "")
        process, vertex = process or row, vertex or cost


def attributes(bench):
    """What normals and tangents cost beside positions, whole process, one thread."""
    source = bench.mesh("tangents.glb", meshes.write_glb_with_tangents, bench.side)
    bench.table.title("Normals and tangents (GLB, one thread, whole process)")
    for name, lattice in bench.lattices.items():
        kept, carried = programs.in_turns([bench.deform(source, lattice, "--normals", normals, threads=1)
                                           for normals in ("keep", "transform")], bench.runs)
        positions = bench.table.add(f"{name}: positions", kept.seconds, "s")
        bench.table.add(f"{name}: with normals and tangents", carried.seconds, "s", positions, "<= 2.5")


def threads(bench):
    """What a second thread brings to four times as many vertices, and how fast a plain copy is; and without a file to
    write, which has one writer at a time, beside what the machine has for two processes that share nothing."""
    side = 2 * bench.side
    source = bench.mesh("four.glb", meshes.write_glb, side)
    bench.table.title(f"Threads (GLB, {vertices(side)})")

    def measure(*commands):
        return [[command.at_once * side * side / 1e6 / seconds for seconds in sample.seconds]
                for command, sample in zip(commands, programs.in_turns(commands, bench.runs))]

    def add(name, one, two):
        row = bench.table.add(f"{name}: 1 thread", one, "M/s")
        bench.table.add(f"{name}: 2 threads", two, "M/s", row, ">= 1.8")
        return row

    for name, lattice in bench.lattices.items():
        one, two, copied = measure(*(bench.deform(source, lattice, threads=count) for count in (1, 2)),
                                   bench.copy(source))
        bench.table.add(f"{name}: dd bs=64M", copied, "M/s")
        add(name, one, two)
    for name, lattice in bench.lattices.items():
        single, double = (bench.deform(source, lattice, "--output-format", "glb", target="-", threads=count)
                          for count in (1, 2))
        one, two, apart = measure(single, double, single._replace(at_once=2))
        row = add(f"{name}, to /dev/null", one, two)
        bench.table.add(f"{name}, to /dev/null: 2 processes at once", apart, "M/s", row)


def inversion(bench):
    """Certified inversions a second and thread: by what a warped lattice takes longer than a box, all else being equal.
    Its search structure counts; normals are kept, for those too would cost more in the warped one."""
    side = 2 * bench.side
    source = bench.mesh("four.glb", meshes.write_glb, side)
    bench.table.title(f"Inversion (GLB, {vertices(side)}, one thread, --normals keep)")
    box, warped = programs.in_turns([bench.deform(source, lattice, "--normals", "keep", threads=1)
                                     for lattice in bench.lattices.values()], bench.runs)
    bench.table.add("box", box.seconds, "s")
    bench.table.add("warped", warped.seconds, "s")
    longer = [slow - fast for slow, fast in zip(warped.seconds, box.seconds)]
    bench.table.add("certified vertices", [side * side / 1e6 / seconds if seconds > 0 else math.inf
                                           for seconds in longer], "M/s", bar=">= 1 M/s (2)")


def large(bench):
    """Time and memory of a file of many gigabytes, once."""
    bench.table.title(f"Large OBJ, {bench.large:g} GB, --normals keep")
    # The file, its result, and positions that are put aside (README.md, Limits).
    needed, free = 2.5 * bench.large, shutil.disk_usage(bench.folder).free / 1e9
    if free < needed:
        bench.table.say(f"  too little room in {bench.folder}: {free:.1f} GB of {needed:.1f} GB (see --folder)")
        return
    source = bench.mesh("large.obj", meshes.write_large_obj, bench.side, bench.large * 1e9)
    sample, = programs.in_turns([bench.deform(source, bench.lattices["box"], "--normals", "keep")], 1)
    size = Row("the file", [os.path.getsize(source) / 1e6], "MB")
    bench.table.add("box: ffd deform", sample.seconds, "s")
    bench.table.add("box: peak memory (bar: for 10 GB)", sample.megabytes, "MB", size, "< 1000 MB")
    os.remove(source)
