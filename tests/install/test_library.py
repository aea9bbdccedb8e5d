#!/usr/bin/env python3
"""The examples of data/examples are built and run as their readers would do it, against an installed copy of the
library, and what they put out is what the program ffd makes of the same points and meshes.

    test_library.py BUILD-FOLDER
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

import stage

DATA = os.path.join(stage.ROOT, "data")


def points_of(obj):
    with open(obj, encoding="ascii") as file:
        return [[float(x) for x in line.split()[1:4]] for line in file if line.startswith("v ")]


def rows(text):
    return [[float(x) for x in line.split()] for line in text.splitlines()]


def deformed(mesh, lattice, environment, folder):
    """Where ffd carries the vertices of an OBJ: their numbers are written in full."""
    output = os.path.join(folder, "expected.obj")
    stage.run(["ffd", "deform", mesh, output, "-l", lattice, "--force"], env=environment)
    return points_of(output)


def equal(findings, found, expected, what):
    if len(found) != len(expected) or not expected:
        findings.append(f"{what}: {len(found)} points instead of {len(expected)}")
    elif found != expected:
        i = next(i for i, pair in enumerate(zip(found, expected)) if pair[0] != pair[1])
        findings.append(f"{what}: point {i} is {found[i]} instead of {expected[i]}")


def write_points(path, points):
    with open(path, "w", encoding="ascii") as file:
        file.writelines("%r %r %r\n" % tuple(point) for point in points)


def c_example(folder, environment, findings):
    work = shutil.copytree(os.path.join(DATA, "examples/c"), os.path.join(folder, "c"))
    mesh = os.path.join(DATA, "models/vase.obj")
    write_points(os.path.join(work, "points"), points_of(mesh))
    stage.run("make", cwd=work, env=environment)
    for name in ("twist.json", "local.json", "wave.json"):
        lattice = os.path.join(DATA, "lattices", name)
        output = stage.run(f"./deform_points '{lattice}' <points", cwd=work, env=environment)
        equal(findings, rows(output), deformed(mesh, lattice, environment, folder), f"C, {name}")
    missing = subprocess.run(["./deform_points", "missing.json"], cwd=work, env=environment, text=True,
                             input="0 0 0\n", capture_output=True, check=False)
    if missing.returncode != 3 or not missing.stderr.startswith("deform_points: missing.json: "):
        findings.append(f"C: exit {missing.returncode} without a lattice, {missing.stderr!r}")


def cpp_example(folder, environment, findings):
    work = shutil.copytree(os.path.join(DATA, "examples/cpp"), os.path.join(folder, "cpp"))
    stage.run("meson setup build && ninja -C build && mkdir out", cwd=work, env=environment)
    meshes = [os.path.join(DATA, "models", name) for name in ("spot.obj", "character.glb")]
    lattice = os.path.join(DATA, "lattices/bulge.json")
    stage.run(["build/deform_files", lattice, "out", *meshes], cwd=work, env=environment)
    for mesh in meshes:
        other = os.path.join(folder, os.path.basename(mesh))
        stage.run(["ffd", "deform", mesh, other, "-l", lattice], env=environment)
        with open(other, "rb") as first, open(os.path.join(work, "out", os.path.basename(mesh)), "rb") as second:
            if first.read() != second.read():
                findings.append(f"C++: {mesh} came out otherwise than from ffd")
    with open(os.path.join(work, "out/report.json"), encoding="utf-8") as file:
        jobs = json.load(file)["jobs"]
    if [(job["status"], job["folds"]["verdict"]) for job in jobs] != [("ok", "none")] * 2:
        findings.append(f"C++: the report says {jobs}")
    # A lattice that turns the volume inside out: the gate closes, nothing is written.
    folding = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh"},
               "moves": [{"scale": {"factor": [-1, 1, 1]}}]}
    with open(os.path.join(work, "folding.json"), "w", encoding="ascii") as file:
        json.dump(folding, file)
    os.mkdir(os.path.join(work, "none"))
    code = subprocess.run(["build/deform_files", "folding.json", "none", meshes[0]], cwd=work, env=environment,
                          capture_output=True, check=False).returncode
    if code != 1 or os.listdir(os.path.join(work, "none")) != ["report.json"]:
        findings.append(f"C++: exit {code} of a folding lattice, which left {os.listdir(os.path.join(work, 'none'))}")


def python_example(folder, environment, findings):
    work = shutil.copytree(os.path.join(DATA, "examples/python"), os.path.join(folder, "python"))
    mesh = os.path.join(DATA, "models/vase.obj")
    points = points_of(mesh)
    write_points(os.path.join(work, "points"), points)
    stage.run(["python3", "twist_frames.py", "points", "60", "3"], cwd=work, env=environment)
    box = {"min": [min(c) for c in zip(*points)], "max": [max(c) for c in zip(*points)]}
    for frame in (1, 2, 3):
        lattice = os.path.join(work, "twist.json")
        with open(lattice, "w", encoding="ascii") as file:
            json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": box},
                       "moves": [{"twist": {"axis": "y", "degrees": 20.0 * frame}}]}, file)
        with open(os.path.join(work, f"frame-{frame}.txt"), encoding="ascii") as file:
            equal(findings, rows(file.read()), deformed(mesh, lattice, environment, folder), f"Python, frame {frame}")


def main():
    stage.need("pkg-config", "make")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        installed = stage.Stage(sys.argv[1], os.path.join(folder, "root"))
        environment = installed.environment()
        examples = (c_example, cpp_example, python_example)
        for example in examples:
            example(folder, environment, findings)
    stage.finish(len(examples), "examples", findings)


main()
