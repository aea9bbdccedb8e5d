#!/usr/bin/env python3
"""The shared library exports what include/ffd declares FFD_API, no more and no less.

    test_exports.py SHARED-LIBRARY
"""

import re
import shutil
import subprocess
import sys

import tree


def declared():
    names = set()
    for path in tree.files():
        if path.startswith("include/ffd/") and path != "include/ffd/export.h":
            text = re.sub(r"/\*.*?\*/", "", tree.read(path), flags=re.S)
            for match in re.finditer(r"\bFFD_API\b[^;(]*?\b(\w+)\s*\(", text):
                names.add(match.group(1))
    return names


def exported(library):
    if not shutil.which("nm"):
        tree.skip("nm is not there")
    run = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True)
    # A template instance or type information of the C++ library, as a weak symbol, is not part of our interface, but it
    # would be one more thing that a user's program can collide with: it counts.
    # The name of a symbol version is an absolute symbol.
    return {line.split()[-1].split("@")[0] for line in run.stdout.splitlines() if line.strip() and line.split()[-2] != "A"}


def main():
    offered, promised = exported(sys.argv[1]), declared()
    findings = [f"declared FFD_API but not exported: {name}" for name in sorted(promised - offered)]
    findings += [f"exported but not declared FFD_API: {name}" for name in sorted(offered - promised)]
    tree.finish(len(promised), "functions", findings)


main()
