#!/usr/bin/env python3
"""One version: that of include/ffd/version.h. Its three numbers, the changelogs, ffd.pc and the file of CMake say it; the soname, the
folder of the modules, the versions of symbols and the names of the Debian packages say what of it programs were linked with.

    test_version.py BUILD-FOLDER ABI
"""

import json
import os
import re
import sys

import tree

HEADER = "include/ffd/version.h"
DEBIAN = "data/packaging/debian/"


def only(pattern, text):
    """The first match, or what says that there is none."""
    match = re.search(pattern, text, re.M)
    return match[1] if match else "nothing"


def statements(version, abi, build):
    """(file, what it says, what it should say)"""
    header = tree.read(HEADER)
    yield HEADER, ".".join(only(rf"^#define FFD_VERSION_{part} (\d+)$", header) for part in ("MAJOR", "MINOR", "PATCH")), version
    yield "CHANGELOG.md", only(r"^## \[(.*?)\] - \d{4}-\d\d-\d\d$", tree.read("CHANGELOG.md")), version
    yield DEBIAN + "changelog", only(r"\Affd \((.*)-\d+\) ", tree.read(DEBIAN + "changelog")), version
    with open(os.path.join(build, "meson-info", "intro-projectinfo.json"), encoding="utf-8") as file:
        yield "meson.build", json.load(file)["version"], version
    for name, pattern in (("ffd.pc", r"^Version: (.*)$"), ("ffdConfigVersion.cmake", r'^set\(PACKAGE_VERSION "(.*)"\)$')):
        with open(os.path.join(build, "data", "packaging", name), encoding="utf-8") as file:
            yield name, only(pattern, file.read()), version
    yield "src/meson.build", abi, only(r"^(0\.\d+|\d+)\.", version)
    yield "src/libffd.map", only(r"^FFD_(.*) \{$", tree.read("src/libffd.map")), abi
    library = f"libffd{abi}"
    yield DEBIAN + "control", only(r"^Package: (libffd\d.*)$", tree.read(DEBIAN + "control")), library
    for path in (path for path in tree.files() if re.match(DEBIAN + r"libffd\d.*\.install$", path)):
        yield path, os.path.basename(path), f"{library}.install"
        yield path, only(r"^usr/lib/\*/ffd-(.*)$", tree.read(path)), abi
    for path in ("README.md", "data/promises.md", "data/reference.md", DEBIAN + "control"):
        for name in sorted(set(re.findall(r"\blibffd(\d[\d.]*\d)\b", tree.read(path)))):
            yield path, f"libffd{name}", library
    for path in ("README.md", "data/python.md", "data/blender/README.md"):
        for name in sorted(set(re.findall(r"\bffd(?:_mesh|-mesh|_lattice|_|-|\d[\d.]*\d_)?[-_]?(\d+\.\d+\.\d+)\b", tree.read(path)))):
            yield path, name, version


def main():
    version = only(r'^#define FFD_VERSION "(\d+\.\d+\.\d+)"$', tree.read(HEADER))
    found = list(statements(version, sys.argv[2], sys.argv[1]))
    findings = [f"{path}: says {said}, and not {right}" for path, said, right in found if said != right]
    if not re.search(r'^dynamic = \[.*"version".*\]$', tree.read("pyproject.toml"), re.M):
        findings.append("pyproject.toml: has a version of its own")
    tree.finish(len(found) + 1, "statements", findings)


main()
