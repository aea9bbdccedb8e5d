#!/usr/bin/env python3
"""Where only the static library is built, a C program that runs jobs links by what pkg-config and CMake say, and ffd.pc requires
only libraries that are linked. find_package(ffd VERSION) gives the answers that CMake's own version file would.

    test_static.py BUILD-FOLDER

What the build installs gets the files of another configuration: nothing is compiled for it.
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import stage

PROGRAM = r"""
#include <ffd/job.h>
#include <stdio.h>

int main(int count, char **arguments)
{
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    const ffd_lattice_source lattice = {.path = arguments[2]};
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = arguments[1];
    desc.lattices = &lattice;
    desc.lattice_count = 1;
    desc.output = arguments[3];
    desc.normals = FFD_NORMALS_RECOMPUTE;
    desc.force = true;
    if (count == 4 && ffd_deform_run(&desc, &result, &error) == FFD_OK)
        return 0;
    puts(error.message);
    return 1;
}
"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project(example C)
find_package(ffd @VERSION@ EXACT REQUIRED)
add_executable(by_cmake main.c)
target_link_libraries(by_cmake ffd::ffd)
add_executable(by_cmake_static main.c)
target_link_libraries(by_cmake_static ffd::ffd_static)
"""
MESH, LATTICE = (os.path.join(stage.ROOT, "data", name) for name in ("models/knight.glb", "lattices/twist.json"))
# Requests of find_package: V is the minor version, P the one before, N the next, W is V with a zero too many.
REQUESTS = ["", "0", "00", "0.0", "P", "P.9", "V", "V.0", "V.00", "V.0.0", "V.0.1", "V.1", "N", "V0", "0V", "00V", "W", "W.0", "W...N", "V...W", "1", "1.0", "1.V", "2",
            "V EXACT", "V.0 EXACT", "V.0.0 EXACT", "P...V", "P...N", "V...V", "V...V.5", "V.0...V.0", "V...N", "V...<N", "V...<N.0",
            "V...<V.1", "V...<N.1", "V...<9", "V.1...N", "V.1...<N", "V...9", "0...9", "0...<N"]
COMPARISON = """cmake_minimum_required(VERSION 3.19)
include(CMakePackageConfigHelpers)
set(CMAKE_SIZEOF_VOID_P @SIZE@)
write_basic_package_version_file(theirs/ffdConfigVersion.cmake VERSION @VERSION@ COMPATIBILITY SameMinorVersion)
set(CMAKE_SIZEOF_VOID_P @OTHER-SIZE@)
function(ask folder request)
  separate_arguments(words UNIX_COMMAND "${request}")
  find_package(ffd ${words} QUIET NO_DEFAULT_PATH PATHS ${CMAKE_CURRENT_LIST_DIR}/${folder})
  message(STATUS "${folder}: '${request}' ${ffd_FOUND} ${ffd_VERSION} ${ffd_CONSIDERED_VERSIONS}")
endfunction()
"""


class Place:
    """A copy of what a build installs, as another configuration would install it: with the static library alone."""

    def __init__(self, folder, build):
        installed = stage.Stage(build, os.path.join(folder, "root"))
        self.folder, self.libraries = folder, installed.path("libdir")
        self.other = os.path.join(folder, "build")
        folders = [f"-D{name}={installed.options[name]}" for name in ("prefix", "libdir", "includedir")]
        stage.run(["meson", "setup", "-Ddefault_library=static", "-Dtests=disabled", *folders, self.other, stage.ROOT])
        for path in glob.glob(os.path.join(self.libraries, "libffd.so*")):
            os.remove(path)
        self.described = os.path.join(self.other, "data", "packaging")
        for name, target in (("ffd.pc", "pkgconfig"), ("ffdConfig.cmake", "cmake/ffd"), ("ffdConfigVersion.cmake", "cmake/ffd")):
            shutil.copy(os.path.join(self.described, name), os.path.join(self.libraries, target))
        self.environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(self.libraries, "pkgconfig"))
        self.write("main.c", PROGRAM)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(content)

    def run(self, command):
        return stage.run(command, cwd=self.folder, env=self.environment)


def runs(place, program):
    place.run(f"{program} {MESH} {LATTICE} out.glb")
    if "libffd" in place.run(f"ldd {program}"):
        yield f"{program} needs a shared library of ffd"


def check_pkg_config(place):
    place.run("cc -std=c11 main.c $(pkg-config --cflags --libs ffd) -o main")
    yield from runs(place, "./main")
    if place.run("pkg-config --modversion ffd").strip() != stage.VERSION:
        yield "ffd.pc is of another version than the headers"
    for name in re.findall(r"nlohmann\S*|tinygltf|libxxhash", place.run("pkg-config --print-requires --print-requires-private ffd")):
        yield f"ffd.pc requires {name}, of which only headers are used"


def check_cmake(place):
    place.write("CMakeLists.txt", CMAKE.replace("@VERSION@", stage.VERSION))
    place.run(f"cmake -S . -B build-cmake -DCMAKE_PREFIX_PATH={place.libraries}/cmake && cmake --build build-cmake")
    yield from runs(place, "build-cmake/by_cmake")
    yield from runs(place, "build-cmake/by_cmake_static")


def requests():
    major, minor, _ = map(int, stage.VERSION.split("."))
    names = {"P": f"{major}.{minor - 1}", "V": f"{major}.{minor}", "N": f"{major}.{minor + 1}", "W": f"{major}.0{minor}"}
    return [re.sub("[PVNW]", lambda match: names[match[0]], request) for request in REQUESTS]


def answers(place, size, other):
    """Of CMake: folder and request -> what it found."""
    script = COMPARISON.replace("@VERSION@", stage.VERSION).replace("@SIZE@", str(size)).replace("@OTHER-SIZE@", str(other))
    for folder in ("ours", "theirs"):
        place.write(f"{folder}/ffdConfig.cmake", "")
        script += "".join(f'ask({folder} "{request}")\n' for request in requests())
    shutil.copy(os.path.join(place.described, "ffdConfigVersion.cmake"), place.path("ours"))
    place.write("compare.cmake", script)
    return dict(re.findall(r"-- (\w+: '.*?') (.*)", place.run("cmake -P compare.cmake")))


def check_versions(place):
    size = int(re.search(r"EQUAL (\d+)\)", stage.run(["cat", os.path.join(place.described, "ffdConfigVersion.cmake")]))[1])
    for other in (size, 12 - size):
        found = answers(place, size, other)
        for request in requests():
            ours, theirs = (found[f"{folder}: '{request}'"] for folder in ("ours", "theirs"))
            if ours.split()[:2] != theirs.split()[:2]:
                yield f"find_package(ffd {request}), pointers of {other} bytes: {ours}, but by CMake's file {theirs}"
    minor = stage.VERSION.rpartition(".")[0]
    if not found[f"ours: '{minor}'"].startswith("0 ") or not answers(place, size, size)[f"ours: '{minor}'"].startswith("1 "):
        yield f"find_package(ffd {minor}) does not depend on the size of pointers"


def main():
    stage.need("pkg-config", "meson", "ldd", "cc")
    with tempfile.TemporaryDirectory() as folder:
        place = Place(folder, sys.argv[1])
        findings = [*check_pkg_config(place)]
        if shutil.which("cmake"):
            findings += [*check_cmake(place), *check_versions(place)]
    stage.finish(1 + len(REQUESTS), "requests", findings)


main()
