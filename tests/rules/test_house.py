#!/usr/bin/env python3
"""What lets a newcomer find the way in src: folders of at most 20 sources, an opening comment that says what a file
is, a comment above every function that an internal header declares."""

import collections
import os
import re

import tree

MOST_SOURCES = 20
COMMENT = re.compile(r"/\*.*?\*/", re.S)
# A declaration at the start of a line, up to its semicolon: "void ffd_free(void *block);".
PROTOTYPE = re.compile(r"^(?!typedef\b|static\b|extern\b|return\b)[a-z][\w \*]*?\b(\w+)\([^;{}]*\)[^;{}]*;", re.M)


def opening(path, headers):
    """What is wrong with the file's opening comment. A source whose header has one needs none."""
    text = tree.read(path)
    name = os.path.basename(path)
    wanted = f"/* {name} - "
    if path.endswith(".h") or os.path.splitext(path)[0] + ".h" not in headers:
        if not text.startswith(wanted):
            yield f"{path}: begins without '{wanted}...': a line that says what it is"


def prototypes(path):
    """Functions without a comment: nothing but an empty line, a directive or other code stands above them."""
    text = tree.read(path)
    # Comments are blanked, but for their ends, so that no declaration is found inside of one.
    plain = COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group(0)[:-2]) + "*/", text)
    for match in PROTOTYPE.finditer(plain):
        above = plain[:match.start()].rstrip(" ").removesuffix("\n")
        if not above.endswith("*/"):
            yield f"{path}: no comment above {match.group(1)}"


def main():
    paths = [path for path in tree.files() if path.startswith("src/") and path.endswith((".c", ".cpp", ".h"))]
    headers = {path for path in paths if path.endswith(".h")}
    findings = []
    sources = collections.Counter(os.path.dirname(path) for path in paths if not path.endswith(".h"))
    for folder, count in sorted(sources.items()):
        if count > MOST_SOURCES:
            findings.append(f"{folder}: {count} sources, more than {MOST_SOURCES}")
    for path in paths:
        findings += opening(path, headers)
        if path in headers:
            findings += prototypes(path)
    tree.finish(len(paths), "files", findings)


main()
