#!/usr/bin/env python3
"""The shared library exports what include/ffd declares FFD_API, no more and no less. A module exports its table; if it is bound to
the system's libraries, also what allocates memory (base/memory/process_allocator.h). No symbol is one that the loader makes the same
in the whole process, whoever has it (STB_GNU_UNIQUE).

    test_exports.py SHARED-LIBRARY MODULE...
"""

import os
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


ALLOCATION = re.compile(r"malloc|calloc|realloc|aligned_alloc|posix_memalign|free|_Z(n[wa]|d[la])\w+")


def exported(library):
    """Name -> nm's letter for its kind."""
    run = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True)
    # A template instance or type information of the C++ library, as a weak symbol, is not part of our interface, but it
    # would be one more thing that a user's program can collide with: it counts.
    # The name of a symbol version is an absolute symbol.
    lines = [line.split() for line in run.stdout.splitlines() if line.strip()]
    return {words[-1].split("@")[0]: words[-2] for words in lines if words[-2] != "A"}


def of_module(module):
    name, symbols = os.path.basename(module), exported(module)
    if "ffd_module" not in symbols:
        yield f"{name}: has no table"
    for symbol, kind in sorted(symbols.items()):
        if symbol != "ffd_module" and not ALLOCATION.fullmatch(symbol):
            yield f"{name}: exports {symbol}"
        if kind == "u":
            yield f"{name}: {symbol} is unique in the whole process"


def main():
    if not shutil.which("nm"):
        tree.skip("nm is not there")
    offered, promised = set(exported(sys.argv[1])), declared()
    findings = [f"declared FFD_API but not exported: {name}" for name in sorted(promised - offered)]
    findings += [f"exported but not declared FFD_API: {name}" for name in sorted(offered - promised)]
    for module in sys.argv[2:]:
        findings += of_module(module)
    tree.finish(len(promised) + len(sys.argv[2:]), "functions and modules", findings)


main()
