#!/usr/bin/env python3
"""The examples of data/examples are built and run as data/tutorial.md says, against an installed copy of the library, and
what they put out is what the program ffd makes of the same points and meshes.

    test_library.py BUILD-FOLDER
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

import stage


class Place:
    """A copy of data/, in a folder of its own, and the installed ffd."""

    def __init__(self, folder, installed):
        self.folder, self.environment = folder, installed.environment()
        shutil.copytree(os.path.join(stage.ROOT, "data"), self.path("data"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, command):
        return stage.run(command, cwd=self.folder, env=self.environment)

    def fails(self, command, given=""):
        """Exit code and stderr."""
        done = subprocess.run(command, cwd=self.folder, env=self.environment, input=given, text=True,
                              capture_output=True, check=False)
        return done.returncode, done.stderr

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def rows(self, name):
        return [[float(x) for x in line.split()] for line in self.read(name).splitlines()]

    def write_json(self, name, content):
        with open(self.path(name), "w", encoding="ascii") as file:
            json.dump(content, file)

    def deformed(self, mesh, lattice):
        """What ffd makes of a mesh."""
        output = "expected" + os.path.splitext(mesh)[1]
        self.run(["ffd", "deform", mesh, output, "-l", lattice, "--force"])
        return self.read(output)


VASE = "data/models/vase.obj"


def points_of(obj):
    """ffd writes the coordinates of an OBJ in full."""
    return [[float(x) for x in line.split()[1:4]] for line in obj.splitlines() if line.startswith(b"v ")]


def equal(findings, found, expected, what):
    if len(found) != len(expected) or not expected:
        findings.append(f"{what}: {len(found)} points instead of {len(expected)}")
    elif found != expected:
        i = next(i for i, pair in enumerate(zip(found, expected)) if pair[0] != pair[1])
        findings.append(f"{what}: point {i} is {found[i]} instead of {expected[i]}")


def check_c(place, findings):
    equal(findings, place.rows("moved.txt"), points_of(place.deformed(VASE, "data/lattices/twist.json")), "C")
    for name in ("local.json", "wave.json"):
        lattice = f"data/lattices/{name}"
        place.run(f"data/examples/c/deform_points {lattice} <points.txt >moved.txt")
        equal(findings, place.rows("moved.txt"), points_of(place.deformed(VASE, lattice)), f"C, {name}")
    code, said = place.fails(["data/examples/c/deform_points", "missing.json"], "0 0 0\n")
    if code != 3 or not said.startswith("deform_points: missing.json: "):
        findings.append(f"C: exit {code} without a lattice: {said!r}")


def check_points_alone(place, findings):
    """A program of points.h alone, linked statically, needs no C++ library and none that reads files of others."""
    archive = os.path.join(place.environment["LD_LIBRARY_PATH"], "libffd.a")
    place.run(f"cc -std=c11 -o points_alone data/examples/c/deform_points.c $(pkg-config --cflags ffd) {archive} -lm -lpthread")
    needed = place.run("ldd points_alone")
    for library in ("libstdc++", "libOpenMesh", "libdraco", "libpng", "libjpeg", "libwebp", "libz."):
        if library in needed:
            findings.append(f"a program of points.h alone needs {library}")
    place.run("./points_alone data/lattices/wave.json <points.txt >alone.txt")
    equal(findings, place.rows("alone.txt"), place.rows("moved.txt"), "points alone")


CMAKE = """cmake_minimum_required(VERSION 3.16)
project(example C)
find_package(ffd @VERSION@ REQUIRED)
add_executable(by_cmake data/examples/c/deform_points.c)
target_link_libraries(by_cmake ffd::ffd m)
add_executable(by_cmake_static data/examples/c/deform_points.c)
target_link_libraries(by_cmake_static ffd::ffd_static)
"""


def check_cmake(place, findings):
    """A project of CMake finds the library by its package config, and the static one."""
    if not shutil.which("cmake"):
        return
    with open(place.path("CMakeLists.txt"), "w", encoding="ascii") as file:
        file.write(CMAKE.replace("@VERSION@", stage.VERSION))
    libraries = place.environment["LD_LIBRARY_PATH"]
    place.run(f"cmake -S . -B build-cmake -DCMAKE_PREFIX_PATH={libraries}/cmake && cmake --build build-cmake")
    place.run("build-cmake/by_cmake data/lattices/wave.json <points.txt >by_cmake.txt")
    equal(findings, place.rows("by_cmake.txt"), place.rows("moved.txt"), "CMake")
    place.run("build-cmake/by_cmake_static data/lattices/wave.json <points.txt >by_cmake_static.txt")
    equal(findings, place.rows("by_cmake_static.txt"), place.rows("moved.txt"), "CMake, the static library")
    if "libffd" in place.run("ldd build-cmake/by_cmake_static"):
        findings.append("CMake: ffd::ffd_static is the shared library")


def check_cpp(place, findings):
    for name in ("spot.obj", "character.glb"):
        if place.read(f"out/{name}") != place.deformed(f"data/models/{name}", "data/lattices/bulge.json"):
            findings.append(f"C++: {name} came out otherwise than from ffd")
    jobs = json.loads(place.read("out/report.json"))["jobs"]
    if [(job["status"], job["folds"]["verdict"]) for job in jobs] != [("ok", "none")] * 2:
        findings.append(f"C++: the report says {jobs}")
    # A lattice that turns the volume inside out: the gate closes, nothing but the report is written.
    place.write_json("folding.json", {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4],
                                      "rest": {"box": "mesh"}, "moves": [{"scale": {"factor": [-1, 1, 1]}}]})
    os.mkdir(place.path("none"))
    code, said = place.fails(["build-cpp/deform_files", "folding.json", "none", VASE])
    if code != 1 or VASE not in said or os.listdir(place.path("none")) != ["report.json"]:
        findings.append(f"C++: exit {code} of a folding lattice, {os.listdir(place.path('none'))}: {said!r}")


def check_python(place, findings):
    columns = list(zip(*place.rows("points.txt")))
    box = {"min": [min(column) for column in columns], "max": [max(column) for column in columns]}
    for frame in (1, 2, 3):
        place.write_json("twist.json", {"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": box},
                                        "moves": [{"twist": {"axis": "y", "degrees": 20.0 * frame}}]})
        equal(findings, place.rows(f"frame-{frame}.txt"), points_of(place.deformed(VASE, "twist.json")),
              f"Python, frame {frame}")


def main():
    stage.need("pkg-config", "make", "meson")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        place = Place(folder, stage.Stage(sys.argv[1], os.path.join(folder, "root")))
        place.run(stage.readme("library"))
        checks = (check_c, check_points_alone, check_cmake, check_cpp, check_python)
        for check in checks:
            check(place, findings)
    stage.finish(len(checks), "examples", findings)


main()
