#!/usr/bin/env python3
"""What `meson install` puts down is enough for other programs: a C and a C++ program are compiled against it
with nothing but pkg-config's answer, with the shared and with the static library, and run. Where only the shared library is
wanted, the answer needs no other library's development files.

    test_install.py BUILD-FOLDER
"""

import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import tree

ABI = re.search(r'^#define FFD_VERSION "(.*)\.\d+"$', tree.read("include/ffd/version.h"), re.M)[1]

PROGRAM = r"""
#include <ffd/ffd.h>
#include <stdio.h>
#include <string.h>

static const char text[] = "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4],"
                           "\"rest\": {\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}},"
                           "\"moves\": [{\"by\": [1, 2, 3]}]}";

int main(void)
{
    ffd_lattice *lattice = NULL;
    ffd_locator *locator = NULL;
    ffd_location location;
    ffd_error error;
    double point[3] = {0.25, 0.5, 0.75}, delta[3], gradient[9];
    if (strcmp(ffd_version(), FFD_VERSION) != 0 ||
        ffd_lattice_parse(text, sizeof text - 1, "text", &lattice, &error) != FFD_OK ||
        ffd_locator_create(lattice, &locator, &error) != FFD_OK ||
        ffd_locator_locate(locator, point, 1, NULL, &location, sizeof location, &error) != FFD_OK)
        return 1;
    if (location.status != FFD_VERTEX_INSIDE || !ffd_displacement(lattice, location.uvw, delta, gradient))
        return 2;
    printf("%g %g %g\n", delta[0], delta[1], delta[2]);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    return 0;
}
"""


def run(command, **more):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        print(" ".join(command))
        print(done.stdout + done.stderr)
        sys.exit(f"exit {done.returncode} from the command above")
    return done.stdout


def installed(stage, pattern):
    found = glob.glob(os.path.join(stage, "**", pattern), recursive=True)
    if not found:
        sys.exit(f"not installed: {pattern}")
    return sorted(found)[0]


def shared_alone(folder):
    """What is wrong with what a build of only the shared library would install, into folders outside of the prefix; it is set up,
    and not compiled."""
    build = os.path.join(folder, "shared")
    run(["meson", "setup", "-Ddefault_library=shared", "-Dtests=disabled", "-Dprefix=/p", "-Dbindir=/q/programs/bin", "-Dlibdir=/q/lib",
         build, tree.ROOT])
    paths = json.loads(run(["meson", "introspect", "--installed", build])).values()
    names = {os.path.basename(path) for path in paths}
    if "libffd.so" not in names or "libffd.a" in names:
        yield "default_library=shared installs other libraries than the shared one"
    found = os.path.join(build, "data", "packaging")
    environment = dict(os.environ, PKG_CONFIG_PATH="", PKG_CONFIG_LIBDIR=found)
    asked = subprocess.run(["pkg-config", "--cflags", "--libs", "ffd"], env=environment, capture_output=True, text=True, check=False)
    if asked.returncode or "-lffd" not in asked.stdout:
        yield f"pkg-config, where only the shared library is: {asked.stdout}{asked.stderr}"
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        if not re.search(r'FFD_MODULE_FOLDERS=\W+\.\./\.\./lib/ffd-[\d.]+\\?",', file.read()):
            yield "the program does not look for modules from its own folder to theirs"
    for line in ("prefix=${pcfiledir}/../../../p", "includedir=${pcfiledir}/../../../p/include", "libdir=${pcfiledir}/.."):
        with open(os.path.join(found, "ffd.pc"), encoding="utf-8") as file:
            if line not in file.read().splitlines():
                yield f"ffd.pc lacks {line}"


def main():
    build = sys.argv[1]
    for tool in ("meson", "pkg-config", "gcc", "g++"):
        if not shutil.which(tool):
            tree.skip(f"{tool} is not there")
    checked = 0
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        findings += shared_alone(folder)
        stage = os.path.join(folder, "stage")
        run(["meson", "install", "-C", build, "--no-rebuild", "--destdir", stage])
        options = {option["name"]: option["value"]
                   for option in json.loads(run(["meson", "introspect", "--buildoptions", build]))}
        pc = installed(stage, "ffd.pc")
        libraries = os.path.dirname(installed(stage, "libffd.a"))
        installed(stage, f"libffd.so.{ABI}")
        for header in (path for path in tree.files() if path.startswith("include/ffd/")):
            checked += 1
            if not os.path.isfile(stage + options["prefix"] + "/" + header):
                findings.append(f"not installed: {header}")
        environment = dict(os.environ, PKG_CONFIG_PATH=os.path.dirname(pc), LD_LIBRARY_PATH=libraries)
        program = installed(stage, "bin/ffd")
        if not run([program, "--version"], env=environment).strip():
            findings.append("the installed ffd says no version")
        for compiler, standard, name in (("gcc", "c11", "user.c"), ("g++", "c++17", "user.cpp")):
            source = os.path.join(folder, name)
            with open(source, "w", encoding="ascii") as file:
                file.write(PROGRAM)
            for kind in ("shared", "static"):
                ask = ["pkg-config", "--cflags", "--libs", "ffd"] + (["--static"] if kind == "static" else [])
                flags = run(ask, env=environment).split()
                if kind == "static":
                    flags = ["-l:libffd.a" if flag == "-lffd" else flag for flag in flags]
                target = os.path.join(folder, f"{name}-{kind}")
                run([compiler, f"-std={standard}", "-Wall", "-Wextra", "-Wpedantic", "-Werror", source, "-o", target,
                     *flags])
                said = run([target], env=environment).strip()
                checked += 1
                if said != "1 2 3":
                    findings.append(f"{name} with the {kind} library says '{said}' instead of '1 2 3'")
                needs = run(["ldd", target], env=environment)
                if ("libffd.so" in needs) != (kind == "shared"):
                    findings.append(f"{name}: linked with the wrong library for '{kind}'")
    tree.finish(checked, "installed things", findings)


main()
