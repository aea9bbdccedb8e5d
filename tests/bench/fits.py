"""Fits: how fast their matrices are factored (factor.c), what the program takes, and MeshLib's fit of as many control points
(python/best_fit.py)."""

import array
import math
import os
import random
import shutil
import subprocess
import sys

import programs
from kernels import NOT_INSTALLED, values_of
from programs import Command

BEST_FIT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "python", "best_fit.py")
DEGREE = 3
# What each pair takes beside its two places in the files: the program counts it for --memory.
PAIR_BYTES = 290


def write_places(path, count, is_moved):
    """Places on a bumpy sphere, or where they are moved, as .npy."""
    draw, values = random.Random(count), array.array("d")
    for _ in range(count):
        x = [draw.gauss(0, 1) for _ in range(3)]
        length = math.hypot(*x)
        x = [c / length * (1 + 0.2 * math.sin(5 * x[0] / length) * math.cos(4 * x[1] / length)) for c in x]
        if is_moved:
            x = [x[0] + 0.13 * math.sin(2 * x[1]), x[1] + 0.13 * math.cos(2 * x[2]), x[2] + 0.13 * math.sin(x[0] * x[1])]
        values.extend(x)
    head = f"{{'descr': '{'<' if sys.byteorder == 'little' else '>'}f8', 'fortran_order': False, 'shape': ({count}, 3), }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    with open(path, "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head.encode() + values.tobytes())


def factor(bench, sides):
    """A third of what registers alone do, and on two threads 1.7 times that."""
    path = bench.built("factor")
    if not path:
        bench.table.say(f"  factor: not built beside {bench.ffd}")
        return
    registers = None
    for line in subprocess.run([path, str(bench.runs), *map(str, sides)], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines():
        name, (values,) = line.rpartition(": ")[0], values_of(line)
        if name.startswith("registers"):
            registers = bench.table.add(name, values, "Gflop/s")
        else:
            bench.table.add(f"factor, {name}", values, "Gflop/s", registers, ">= 0.57" if "2 threads" in name else ">= 0.33")


def fit(bench, before, after, side, *options):
    output = bench.path("fitted.json")
    return Command([bench.ffd, "fit", before, after, "-o", output, "--size", str(side), "--quiet", *options], output)


def counted(side, pairs):
    """Megabytes: the band of a lattice of side^3, the files, and the pairs."""
    reach = DEGREE * (side * side + side + 1)
    return (8 * side**3 * min(reach, side**3) + (2 * 24 + PAIR_BYTES) * pairs) / 1e6


def of_pairs(bench, sides, pairs):
    before, after = (bench.mesh(f"{name}-{pairs}.npy", write_places, pairs, name == "after") for name in ("before", "after"))
    for side in sides:
        sample, = programs.in_turns([fit(bench, before, after, side, "--smooth", "0.01")], bench.runs)
        what = f"{side}^3, {pairs:,} pairs"
        bench.table.add(what, sample.seconds, "s")
        row = bench.table.add(f"{what}: counted", [counted(side, pairs)], "MB")
        bench.table.add(f"{what}: peak memory", sample.megabytes, "MB", row, "<= 1.3")
    return before, after


def choice(bench, side, before, after):
    """What it takes to choose S."""
    given, chosen = programs.in_turns([fit(bench, before, after, side, *options) for options in (("--smooth", "0.01"), ())], bench.runs)
    row = bench.table.add(f"{side}^3: S given", given.seconds, "s")
    bench.table.add(f"{side}^3: S chosen", chosen.seconds, "s", row, "<= 4")


def best_fit(bench, pairs, sides):
    """MeshLib's, with the Python of --python, the one that runs this, or the system's."""
    for python in filter(None, (bench.python, sys.executable, shutil.which("python3", path=os.defpath))):
        done = subprocess.run([python, BEST_FIT, str(pairs), *map(str, sides)], stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode == NOT_INSTALLED:
            continue
        done.check_returncode()
        rows = {}
        for line in done.stdout.splitlines():
            name, _, numbers = line.rpartition(": ")
            size = name.partition(",")[0]
            for what, unit, value in zip(("", ": misses the body by", ": misses what is off it by"), ("s", "", ""), numbers.split()):
                key = size + what
                row = bench.table.add(name + what, [float(value)], unit, rows.get(key))
                rows.setdefault(key, row)
        return
    bench.table.say("  MeshLib: not installed beside ffd_mesh (--python PATH)")


def fits(bench):
    is_small = bench.side < 1000
    sides = (6, 8) if is_small else (8, 16, 24, 32)
    bench.table.title("Fits of cubic lattices")
    factor(bench, sides)
    for pairs in ((1000,) if is_small else (1000000, 100000)):
        places = of_pairs(bench, sides, pairs)
    choice(bench, sides[1], *places)
    best_fit(bench, 10000, sides[:1] if is_small else (4, 6, 8))
