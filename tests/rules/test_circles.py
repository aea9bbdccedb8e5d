#!/usr/bin/env python3
"""No circles among the files of src, from what they include and from what they call.

    test_circles.py BUILD-FOLDER

Includes are read from the files: there a header and the source of its name are one unit. Calls are read from the
symbols of the library's and the program's objects (nm), between sources; a kernel that is compiled for several
instruction sets is one. Prints each circle with the calls or includes that close it.
"""

import collections
import os
import re
import subprocess
import sys

import tree

# Number text: each of the two ways asks the other for what it is not made for.
ALLOWED = [{"src/base/text/decimal", "src/base/text/decimal_kernel", "src/base/text/number_format"}]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.M)
SET = re.compile(r"_(scalar|sse2|avx2|avx512)$")


def unit(path):
    return os.path.splitext(path)[0]


def includes(paths):
    """(unit, unit) -> what is included."""
    edges = collections.defaultdict(set)
    for path in paths:
        for target in INCLUDE.findall(tree.read(path)):
            found = "src/" + target if "/" in target else os.path.join(os.path.dirname(path), target)
            if unit(found) != unit(path):
                edges[unit(path), unit(found)].add(f'#include "{target}"')
    return edges


def objects(build, paths):
    """Object file -> source. Meson names an object by its source's path below the folder of its target."""
    found = {}
    sources = {path[len("src/"):].replace("/", "_"): path for path in paths}
    for folder, _, names in os.walk(os.path.join(build, "src")):
        above = os.path.relpath(folder, os.path.join(build, "src")).split(os.sep)[:-1]
        for name in names:
            if name.endswith(".o"):
                flat = "_".join(above + [name[:-len(".o")]])
                if flat in sources:
                    found[os.path.join(folder, name)] = sources[flat]
    return found


def calls(build, paths):
    """(unit, unit) -> the functions and tables that the first uses of the second."""
    source_of = objects(build, paths)
    lines = subprocess.run(["nm", "-A", "-P", *source_of], capture_output=True, text=True, check=True).stdout
    defined, used = {}, collections.defaultdict(set)
    for line in lines.splitlines():
        name, symbol, kind = re.match(r"(.*): (\S+) (\S)", line).groups()
        here = unit(source_of[name])
        symbol = SET.sub("", symbol)
        if kind == "U":
            used[symbol].add(here)
        elif kind in "TDBR":
            defined[symbol] = here
    edges = collections.defaultdict(set)
    for symbol, users in used.items():
        for user in users:
            if symbol in defined and defined[symbol] != user:
                edges[user, defined[symbol]].add(symbol)
    return edges, set(map(unit, source_of.values()))


def components(edges):
    """Strongly connected components of more than one unit (Tarjan, Depth-first search and linear graph
    algorithms, 1972)."""
    after = collections.defaultdict(list)
    for a, b in sorted(edges):
        after[a].append(b)
    order, low, stack, found = {}, {}, [], []

    def visit(a):
        order[a] = low[a] = len(order)
        stack.append(a)
        for b in after[a]:
            if b not in order:
                visit(b)
            if b in stack:
                low[a] = min(low[a], low[b])
        if low[a] == order[a]:
            i = stack.index(a)
            found.append(set(stack[i:]))
            del stack[i:]

    sys.setrecursionlimit(10000)
    for a in list(after):
        if a not in order:
            visit(a)
    return [component for component in found if len(component) > 1]


def circles(edges, what):
    findings = []
    for component in components(edges):
        if not any(component <= allowed for allowed in ALLOWED):
            findings.append(f"a circle of {what}: {', '.join(sorted(component))}")
            findings += [f"    {a} -> {b}: {', '.join(sorted(names))}"
                         for (a, b), names in sorted(edges.items()) if a in component and b in component]
    return findings


def main():
    # src/python is in no build but that of the wheel, src/wasm in none but that of the package for npm, and what is for Windows and
    # macOS in their own.
    paths = [path for path in tree.files() if path.startswith("src/")
             and not path.startswith(("src/python/", "src/wasm/", "src/base/macos/", "src/base/windows/")) and not path.endswith("_windows.c")
             and path.endswith((".c", ".cpp", ".h"))]
    edges = includes(paths)
    called, seen = calls(sys.argv[1], paths)
    findings = [f"{path}: its object is not in the build" for path in paths
                if not path.endswith(".h") and unit(path) not in seen]
    findings += circles(edges, "includes") + circles(called, "calls")
    tree.finish(len(paths), "files", findings)


main()
