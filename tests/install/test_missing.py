#!/usr/bin/env python3
"""Where libraries are missing and cannot be fetched, one line of the build names all of them, and how they are had.

    test_missing.py CC CXX
"""

import os
import re
import subprocess
import sys
import tempfile

import stage

# By what libraries are looked for; meshoptimizer is looked for by the compiler.
FINDERS = ("pkg-config", "pkgconf", "cmake")
NAMES = ("xxHash", "nlohmann JSON", "OpenMesh", "Draco", "tinygltf", "libpng", "libjpeg")


def main():
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        source = stage.copy_source(os.path.join(folder, "source"))
        finders = os.path.join(folder, "finders")
        os.mkdir(finders)
        for name in FINDERS:
            with open(os.path.join(finders, name), "w", encoding="ascii") as file:
                file.write("#!/bin/sh\nexit 1\n")
            os.chmod(file.name, 0o755)
        environment = dict(os.environ, PATH=finders + os.pathsep + os.environ["PATH"], CC=sys.argv[1], CXX=sys.argv[2])
        done = subprocess.run(["meson", "setup", "--wrap-mode=nodownload", "-Dtests=disabled", os.path.join(folder, "build"), source],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, env=environment, check=False)
    errors = re.findall(r"^.*ERROR: .*$", done.stdout, re.M)
    if done.returncode == 0 or len(errors) != 1:
        findings.append(f"exit {done.returncode}: {errors}, and not one line")
    findings += [f"not named: {name}" for name in (*NAMES, "sh .ci/setup", "README.md") if name not in "".join(errors)]
    stage.finish(len(NAMES), "libraries", findings)


main()
