#!/usr/bin/env python3
"""The flags with which Debian compiles the project's packages, without those of debug information; as a program, it prints
those of a C compiler in a line, or nothing where this is not Debian.

No one is going to debug what the tests build, and where it lies must not decide whether it is compiled again."""

import os
import re
import shutil
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def stripped(source):
    """What dpkg-buildflags is to leave out of the flags for a source, as variables of its environment."""
    names = f"-g -ffile-prefix-map={source}=."
    return {"DEB_CFLAGS_STRIP": names, "DEB_CXXFLAGS_STRIP": names}


def of(source):
    """The variables CFLAGS and so on for a source, as data/packaging/debian asks for them."""
    with open(os.path.join(ROOT, "data", "packaging", "debian", "rules"), encoding="utf-8") as file:
        options = dict(re.findall(r"^export (DEB_\w+) = (.*)$", file.read(), re.M))
    printed = subprocess.run(["dpkg-buildflags"], cwd=source, env={**os.environ, **stripped(source), **options},
                             stdout=subprocess.PIPE, text=True, check=True).stdout
    return dict(line.split("=", 1) for line in printed.splitlines())


if __name__ == "__main__" and shutil.which("dpkg-buildflags"):
    variables = of(ROOT)
    print(variables["CFLAGS"], variables["CPPFLAGS"])
