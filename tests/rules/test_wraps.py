#!/usr/bin/env python3
"""The wraps of subprojects/ can be built from: each names where its sources are, for git and in Debian's archive, and compiles the
files whose functions the sources call, by the program's rules for numbers. Where the sources are (.ci/wraps), they are looked into."""

import os
import re

import tree

# Where meshoptimizer defines what a name begins with.
MESHOPTIMIZER = {"meshopt_simplify": "simplifier.cpp", "meshopt_decodeFilter": "vertexfilter.cpp", "meshopt_encodeFilter": "vertexfilter.cpp",
                 "meshopt_decodeVertex": "vertexcodec.cpp", "meshopt_encodeVertex": "vertexcodec.cpp",
                 "meshopt_decodeIndex": "indexcodec.cpp", "meshopt_encodeIndex": "indexcodec.cpp"}
KEYS = {"directory": r"[\w.-]+", "revision": r"\S+", "patch_directory": r"\w+", "# debian": r"pool/main/\S+\.orig\.tar\.(?:bz2|[gx]z)",
        "# debian_hash": r"[0-9a-f]{64}"}


def keys(wrap):
    return dict(re.findall(r"^(# \w+|\w+) = (.*)$", tree.read(wrap), re.M))


def of_wrap(wrap):
    found = keys(wrap)
    for key, pattern in KEYS.items():
        if not re.fullmatch(pattern, found.get(key, "")):
            yield f"{wrap}: {key} is '{found.get(key, '')}'"
    build = f"subprojects/packagefiles/{found.get('patch_directory')}/meson.build"
    text = tree.read(build)
    sources = re.findall(r"'(src/[\w/.]+\.(?:cc|cpp))'", text)
    if sources and "add_project_arguments('-ffp-contract=off', language: 'cpp')" not in text:
        yield f"{build}: fuses multiplications and additions"
    folder = os.path.join(tree.ROOT, "subprojects", found.get("directory", ""))
    if os.path.isdir(folder):
        yield from (f"{build}: {source} is not among the sources" for source in sources if not os.path.isfile(os.path.join(folder, source)))


def of_calls():
    """The functions of meshoptimizer that are called."""
    listed = tree.read("subprojects/packagefiles/meshoptimizer/meson.build")
    calls = set()
    for path in tree.files():
        if path.endswith((".c", ".cpp")) and path.startswith(("src/mesh/meshopt/", "tests/")):
            calls |= set(re.findall(r"\bmeshopt_(?:simplify|decode|encode)[A-Z]?\w*(?=\()", tree.read(path)))
    for call in sorted(calls):
        file = next((file for begin, file in MESHOPTIMIZER.items() if call.startswith(begin)), None)
        if file is None or f"'src/{file}'" not in listed:
            yield f"{call} is in {file}, which the wrap of meshoptimizer does not compile"
    if not calls:
        yield "no function of meshoptimizer is called"


def main():
    wraps = [path for path in tree.files() if path.startswith("subprojects/") and path.endswith(".wrap")]
    findings = [finding for wrap in wraps for finding in of_wrap(wrap)] + list(of_calls())
    tree.finish(len(wraps), "wraps", findings)


main()
