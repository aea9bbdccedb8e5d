"""What the library does in memory, by programs of its own (displacement.c, embedding.c), beside SciPy and VTK."""

import os
import re
import shutil
import subprocess
import sys

# Median, least and greatest of a measurement, as both programs print them.
SPREAD = re.compile(r"([\d.]+) \(([\d.]+) to ([\d.]+)\)")
BARS = {"sse2": ">= 15 M/s", "avx2": ">= 50 M/s", "avx512": ">= 100 M/s"}
LIMIT = "multiplications alone"
LIBRARIES = {"SciPy": "map_coordinates, cubic", "VTK": "vtkBSplineTransform"}
# The lattice of embedding.c that is most like the warped one of lattices.py.
WARPED = "smooth warp 8x8x8, degree 3"
NOT_INSTALLED = 77


def values_of(line):
    return [[float(least), float(median), float(greatest)] for median, least, greatest in SPREAD.findall(line)]


def lines_of(bench, name, points):
    """What a program of the build folder prints; nothing, but a line that says so, where it is not built."""
    path = bench.built(name)
    if not path:
        bench.table.say(f"  {name}: not built beside {bench.ffd}")
        return []
    command = [path, str(bench.runs), str(points)]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()


def instruction_sets(bench):
    """Adds the rows of displacement.c; returns that of a mesh in a box lattice with the widest instructions."""
    copy = widest = None
    section = ""
    limits = {}  # by instruction set, where they are known
    for line in lines_of(bench, "displacement", bench.side ** 2):
        name, found = line.split()[0], values_of(line)
        if not found:
            section = line.split(", millions")[0]
        elif name == "copy":
            copy = bench.table.add("copy", found[0], "M/s")
        elif section == LIMIT:
            limits[name] = bench.table.add(f"{section}, {name}", found[0], "M/s", copy)
        else:
            is_kernel = section.startswith("kernel")
            row = bench.table.add(f"{section}, {name}", found[0], "M/s", limits.get(name, copy) if is_kernel else copy,
                                  BARS.get(name, "") if is_kernel else "")
            bench.table.add(f"{section}, {name}, with gradient", found[1], "M/s", copy)
            widest = row if section == "8^3 box" else widest
    return widest


def seconds_of(library, points, runs):
    """What points.py says with the first Python that has the library, the one that runs this or the system's; else
    nothing."""
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "points.py")
    for python in filter(None, (sys.executable, shutil.which("python3", path=os.defpath))):
        done = subprocess.run([python, script, library, str(points), str(runs)], stdout=subprocess.PIPE, text=True,
                              check=False)
        if done.returncode != NOT_INSTALLED:
            done.check_returncode()
            return [float(word) for word in done.stdout.split()]
    return []


def displacement(bench):
    """Points displaced, with each instruction set: by the kernel alone, and with what a tile of a mesh costs beside it;
    and by other libraries, at places drawn at random."""
    bench.table.title("Displacement of points, one thread (bars: where the copy of as many floats reaches 450 M/s)")
    widest = instruction_sets(bench)
    points = 1000 * bench.side
    for name, does in LIBRARIES.items():
        seconds = seconds_of(name, points, bench.runs)
        if seconds:
            bench.table.add(f"8^3, {name}, {does}, places at random", [points / 1e6 / s for s in seconds], "M/s", widest)
        else:
            bench.table.say(f"  {name}: not installed")


def embedding(bench):
    """Counts and times of finding u,v,w on lattices of many kinds."""
    bench.table.title("Finding u,v,w, one thread, with the search structure made")
    lines = lines_of(bench, "embedding", max(1, bench.side ** 2 // 10))
    for line in lines:
        bench.table.say(f"  {line}")
        if line.startswith(WARPED):
            microseconds, = values_of(line)
    if lines:
        bench.table.add(WARPED, [1 / value for value in microseconds], "M/s", bar=">= 1 M/s (2)")


def arrays(bench):
    """The calls on arrays, each beside the kernels that it calls."""
    bench.table.title("Arrays in memory, one thread, box 8^3, degree 3")
    kernels = None
    for line in lines_of(bench, "arrays", bench.side ** 2):
        name, found = line.rpartition(": ")[0], values_of(line)[0]
        is_call = name.endswith("call")
        row = bench.table.add(name, found, "M/s", kernels if is_call else None,
                              ">= 0.87" if name.endswith("one call") and "u,v,w" not in name else "")
        kernels = kernels if is_call else row
