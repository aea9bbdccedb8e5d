#!/usr/bin/env python3
"""Every C and C++ file is laid out as clang-format 14 lays it out by the project's .clang-format."""

import re
import shutil
import subprocess

import tree


def main():
    if not shutil.which("clang-format"):
        tree.skip("clang-format is not there")
    version = subprocess.run(["clang-format", "--version"], capture_output=True, text=True, check=True).stdout
    if not re.search(r"version 14\.", version):
        tree.skip(f"Debian 12: other versions lay out otherwise: {version.strip()}")
    paths = [path for path in tree.files()
             if path.endswith((".c", ".h", ".cpp")) and path.startswith(("data/", "src/", "include/", "tests/"))]
    run = subprocess.run(["clang-format", "--dry-run", "-Werror", *paths], cwd=tree.ROOT, capture_output=True,
                         text=True, check=False)
    findings = sorted({line.split(":")[0] + ": not formatted" for line in run.stderr.splitlines()
                       if "clang-format-violations" in line})
    if run.returncode != 0 and not findings:
        findings = [run.stderr]
    tree.finish(len(paths), "files", findings)


main()
