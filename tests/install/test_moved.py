#!/usr/bin/env python3
"""An installation works wherever it is moved to: the program and programs of the library find the modules, also without /proc,
and after the program's file was deleted or replaced while it runs. In a folder whose path is longer than the system takes they
say so.

    test_moved.py BUILD-FOLDER NO-PROC      NO-PROC: a library to preload (tests/support/no_proc.c)
"""

import os
import shutil
import subprocess
import sys
import tempfile

import stage

GLTF = '{"asset": {"version": "2.0"}}'
PROGRAM = r"""
#include <ffd/job.h>
#include <stdio.h>
#include <unistd.h>

int main(int count, char **arguments)
{
    ffd_info_desc desc;
    ffd_error error;
    char *text = NULL, said[2048];
    ffd_info_desc_init(&desc, sizeof desc);
    desc.file.path = arguments[1];
    if (count != 2 || chdir("/") != 0)
        return 2;
    if (ffd_info_run(&desc, &text, &error) == FFD_OK)
        return 0;
    ffd_error_format(&error, said, sizeof said);
    puts(said);
    return 1;
}
"""


class Place:
    """An installation in a folder that it was not configured for."""

    def __init__(self, folder, installed):
        self.folder = folder
        self.prefix = os.path.join(folder, "moved")
        self.options = installed.options
        shutil.copytree(installed.root + installed.options["prefix"], self.prefix, symlinks=True)
        self.mesh = os.path.join(folder, "a.gltf")
        with open(self.mesh, "w", encoding="ascii") as file:
            file.write(GLTF)

    def path(self, option, *more):
        return os.path.join(self.prefix, self.options[option], *more)


def said(command, expected=0, **more):
    """What is wrong with a run, or nothing."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **more)
    if done.returncode != expected:
        yield f"{' '.join(command)[:200]}: exit {done.returncode}: {done.stdout[:1000]}{done.stderr[:1000]}"


def check_program(place, no_proc):
    program = place.path("bindir", "ffd")
    yield from said([program, "info", place.mesh])
    without = dict(os.environ, LD_PRELOAD=no_proc)
    linked = os.path.join(place.folder, "linked")
    os.symlink(program, linked)
    for words, folder in (([program], place.folder), ([os.path.join("moved", place.options["bindir"], "ffd")], place.folder),
                          (["./ffd"], os.path.dirname(program)), ([linked], place.folder)):
        yield from said([*words, "info", place.mesh], env=without, cwd=folder)
    # Workers are this program too.
    with open(os.path.join(place.folder, "l.json"), "w", encoding="ascii") as file:
        file.write('{"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}')
    with open(os.path.join(place.folder, "jobs.jsonl"), "w", encoding="ascii") as file:
        file.write('{"in": "a.gltf", "lattice": "l.json", "out": "out.gltf"}\n')
    yield from said([program, "batch", "jobs.jsonl", "-q"], env=without, cwd=place.folder)
    if not os.path.exists(os.path.join(place.folder, "out.gltf")):
        yield "ffd batch without /proc wrote nothing"


def check_deleted(place):
    """The program waits for its input while its file goes."""
    program = place.path("bindir", "ffd")
    for what in ("deleted", "replaced"):
        running = subprocess.Popen([program, "deform", "-", "-", "--input-format", "gltf", "--output-format", "gltf", "-l", os.path.join(place.folder, "l.json")],
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        # It is the program: Popen returns after exec.
        with open(program, "rb") as file:
            content = file.read()
        os.remove(program)
        if what == "replaced":
            with open(program, "wb") as file:
                file.write(content)
        output, errors = running.communicate(GLTF.encode())
        if running.returncode != 0 or b"asset" not in output:
            yield f"the program's file {what} while it runs: exit {running.returncode}: {errors.decode()}"
        with open(program, "wb") as file:
            file.write(content)
        os.chmod(program, 0o755)


def check_long_path(place):
    """The path of the folder is longer than any that the system takes: the program says so."""
    part = "f" * 250

    def enter():
        os.chdir(place.folder)
        for _ in range(17):
            os.mkdir(part)
            os.chdir(part)
        shutil.copy(place.path("bindir", "ffd"), "ffd")
    done = subprocess.run(["./ffd", "info", place.mesh], capture_output=True, text=True, check=False, preexec_fn=enter, timeout=60)
    if done.returncode != 6 or not done.stderr.endswith("; the folder of ffd is not known, or its path is too long\n"):
        yield f"in a folder with a long path: exit {done.returncode}: {done.stderr}"


def check_library(place, no_proc):
    """A program that goes to another folder before it loads anything."""
    source, program = os.path.join(place.folder, "host.c"), os.path.join(place.folder, "host")
    with open(source, "w", encoding="ascii") as file:
        file.write(PROGRAM)
    libraries = place.path("libdir")
    stage.run(f"cc '{source}' -o '{program}' $(pkg-config --cflags --libs ffd)",
              env=dict(os.environ, PKG_CONFIG_PATH=os.path.join(libraries, "pkgconfig")))
    for more in ({}, {"LD_PRELOAD": no_proc}):
        yield from said([program, place.mesh], env=dict(os.environ, LD_LIBRARY_PATH=libraries, **more))


def main():
    stage.need("pkg-config")
    build, no_proc = map(os.path.abspath, sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        folder = os.path.realpath(folder)
        installed = stage.Stage(build, os.path.join(folder, "root"))
        place = Place(folder, installed)
        shutil.rmtree(installed.root)
        findings = [*check_program(place, no_proc), *check_deleted(place), *check_long_path(place), *check_library(place, no_proc)]
    stage.finish(4, "kinds of places", findings)


main()
