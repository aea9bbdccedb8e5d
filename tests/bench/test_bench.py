#!/usr/bin/env python3
"""The benchmark runs, on next to nothing, and has something to say of each subject.

    test_bench.py FFD
"""

import csv
import os
import platform
import stat
import subprocess
import sys
import tempfile

BENCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bench.py")
# What begins a title, and rows that must be below it.
SUBJECTS = {
    "Start": ["a C program that does nothing", "ffd --version", "100 vertices, box", "100 vertices, warped",
              "100 vertices, box, GLB"],
    "Static program": ["in.glb, box: dynamic", "in.glb, warped: static", "in.obj, box: static", "small.obj, box: static"],
    ".glb, 1,600 vertices": ["box: dd bs=64M", "box: ffd deform", "box: peak memory", "warped: ffd deform"],
    "Lattice size": ["4^3: a vertex", "64^3: whole process"],
    "Blocks": ["8 blocks: a vertex", "1000 blocks: 100 vertices", "1000 blocks: a vertex"],
    ".obj, 1,600 vertices": ["box: ffd deform", "warped: peak memory"],
    "Others on the same OBJ": ["ffd deform, box", "OpenMesh: read", "OpenMesh: read, write",
                               "Blender: read, lattice modifier, write"],
    "Normals and tangents": ["box: with normals and tangents"],
    "Weights": ["positions: plain", "positions: weighted", "normals too: weighted"],
    "Threads (GLB, 6,400 vertices)": ["box: dd bs=64M", "warped: 2 threads", "box, to /dev/null: 2 threads",
                                      "warped, to /dev/null: 2 processes at once"],
    "Inversion": ["certified vertices"],
    "Torn edges": [".glb: all inside", ".glb: 5 % outside", ".obj: 5 % outside, peak memory", ".ply, ascii: 5 % outside",
                   ".ply, binary: 5 % outside", ".off: 5 % outside"],
    "Smooth joins": [".glb, 5 % outside: --seam", ".glb, warped, some outside: --seam", ".obj, all inside: --seam",
                     ".ply, binary, 5 % outside: --seam"],
    "Gaussian splats": ["box: vertices with normals", "box: Gaussian splats", "warped: Gaussian splats, peak memory"],
    "Lattices of 6^3": ["convert", "refine, a knot inserted", "set, half the edit, peak memory"],
    "Formats of lattices of 6^3": ["JSON to JSON", "JSON to .npy", ".vtk, binary, to JSON", ".vts, zlib, to JSON",
                                   "grid.vts to .vts: memory beyond the file"],
    "An animation by 6^3": ["deform --morph, 4 targets", "animate, 121 samples", "animate, 121 samples, peak memory"],
    "Fits": ["6^3, 1,000 pairs", "8^3, 1,000 pairs: peak memory", "8^3: S given", "8^3: S chosen"],
    "Displacement": ["copy", "kernel alone, box, scalar", "8^3 box, scalar", "64^3 general, scalar, with gradient"],
    "Finding u,v,w": ["smooth warp 8x8x8, degree 3"],
    "Arrays in memory": ["float32: kernels", "float32: one call", "float64, gradients: one call", "u,v,w: one call",
                         "float64: a point a call"],
    "Picture of 1600x900": ["copy of its bytes, new memory", "copy of its bytes, the same memory", "3200 triangles"],
    "Pages and pictures with textures": ["page, all vertices: grey", "page, all vertices: textured", "page: textured", "picture: grey",
                                         "picture: textured"],
    "Batch of 20 meshes": ["obj, box: batch", "glb, warped: a command each"],
    "Sweep of 2 lattices": ["box: a command each", "box: batch", "warped: batch"],
    "Array of 1,000 variants": ["box: rows", "warped: a mesh file each"],
    "Table of 200 rows": ["obj: files of that size made", "obj: batch", "glb: batch"],
    "Large OBJ": ["box: peak memory (bar: for 10 GB)"],
}
if platform.machine() == "x86_64":
    SUBJECTS["Fits"] += ["registers, sse2", "factor, 6^3, sse2, 1 thread", "factor, 8^3, sse2, 2 threads"]
    SUBJECTS["Displacement"] += ["multiplications alone, sse2", "kernel alone, general, sse2, with gradient"]
# Peers that need not be there: a row, or a line that says so.
MAY_MISS = ["tinyobjloader", "assimp", "SciPy", "VTK", "ffd_mesh", "MeshLib", "The page of ffd edit"]
# Takes the arguments after -- as Blender hands them to its script.
STUB = '#!/bin/sh\nwhile [ "$1" != -- ]; do shift; done\ncp "$2" "$3"\n'


def run(ffd, *arguments):
    command = [sys.executable, BENCH, "--ffd", ffd, "--side", "40", "--runs", "1", "--jobs", "20", *arguments]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)


def check(condition, what, said):
    if not condition:
        sys.exit(f"{what}; the benchmark said:\n{said}")


def write_stub(path, script):
    with open(path, "w", encoding="ascii") as file:
        file.write(script)
    os.chmod(path, stat.S_IRWXU)
    return path


def check_all(ffd, folder):
    work, saved = os.path.join(folder, "work"), os.path.join(folder, "table.csv")
    blender = write_stub(os.path.join(folder, "blender"), STUB)
    os.mkdir(work)
    done = run(ffd, "--blender", blender, "--static", ffd, "--large", "0.001", "--folder", work, "--csv", saved)
    check(done.returncode == 0, f"exit {done.returncode}", done.stdout)
    with open(saved, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for title, wanted in SUBJECTS.items():
        there = {row["what"] for row in rows if row["subject"].startswith(title)}
        check(there.issuperset(wanted), f"{title}: no row {set(wanted) - there}", done.stdout)
    for row in rows:
        check(float(row["least"]) <= float(row["median"]) <= float(row["greatest"]), f"{row}", done.stdout)
        check(f"\n  {row['what']} " in done.stdout, f"{row} is not printed", done.stdout)
    for peer in MAY_MISS:
        check(any(peer in line for line in done.stdout.splitlines()), f"nothing of {peer}", done.stdout)
    check(not os.listdir(work), f"left behind: {os.listdir(work)}", done.stdout)
    return len(rows)


def check_part(ffd):
    done = run(ffd, "--only", "start")
    check(done.returncode == 0 and "100 vertices, box" in done.stdout, "--only start", done.stdout)
    check("Threads" not in done.stdout, "--only start, and more", done.stdout)


def check_failures(ffd, folder):
    """A program that fails, or is not there, ends the benchmark; too large a file is not begun."""
    failing = write_stub(os.path.join(folder, "failing"), "#!/bin/sh\necho no lattice >&2\nexit 1\n")
    done = run(ffd, "--only", "peers", "--blender", failing)
    check(done.returncode != 0 and "no lattice" in done.stdout, "a peer that fails", done.stdout)
    done = run(ffd, "--blender", os.path.join(folder, "none"))
    check(done.returncode == 2 and "none: no such program" in done.stdout, "no Blender", done.stdout)
    done = run(ffd, "--only", "start", "--large", "1e9")
    check(done.returncode == 0 and "too little disk space" in done.stdout, "too large a file", done.stdout)


def main():
    ffd = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        count = check_all(ffd, folder)
        check_failures(ffd, folder)
    check_part(ffd)
    print(f"{count} rows")


main()
