#!/usr/bin/env python3
"""Each mesh format of ffd_format stands in every list of formats: the endings, the words of settings, the messages, the
man page, the reference, the fuzz targets."""

import re

import tree

HEADER, ENDINGS, SETTINGS = "include/ffd/job.h", "src/io/formats.c", "src/job/input/settings.c"
MANUAL, REFERENCE = "src/cli/pages/ffd.1.in", "data/reference.md"
# Further endings of formats, and the format that has none: its file is called points.
OTHER_ENDINGS = {"vrm": "glb"}
WITHOUT_ENDING = {"foam"}


def quoted(text, begin, end):
    """The words in quotes between two marks."""
    text = text[text.index(begin):]
    return re.findall(r'"([^"]*)"', text[:text.index(end)])


def main():
    header = tree.read(HEADER)
    enum = re.search(r"typedef enum ffd_format \{(.*?)\} ffd_format;", header, re.S).group(1)
    formats = [name.lower() for name in re.findall(r"\bFFD_FORMAT_(\w+)", enum)]
    meshes = [name for name in formats if name != "auto"]
    named = quoted(header, "#define FFD_FORMAT_NAMES", "\n")[0]
    endings = set(meshes) | set(OTHER_ENDINGS)
    lists = {
        f"{HEADER}: FFD_FORMAT_NAMES": set(re.findall(r"\w+", named)) - {"or"},
        f"{ENDINGS}: the endings": {ending[1:] for ending in quoted(tree.read(ENDINGS), "known[] =", "}};")} | WITHOUT_ENDING,
        f"{MANUAL}: the endings": set(re.findall(r"^\.Pa \.(\w+)", tree.read(MANUAL), re.M)) | WITHOUT_ENDING,
    }
    findings = [f"{place}: {word} is {'missing' if word in endings else 'no format'}"
                for place, words in lists.items() for word in sorted(words ^ endings)]
    words = quoted(tree.read(SETTINGS), "format_words[] =", "NULL")
    if words != formats:
        findings.append(f"{SETTINGS}: format_words {words} are not the members of ffd_format in their order: {formats}")
    for name in meshes:
        if not re.search(rf"\b{name}\b", tree.read(REFERENCE), re.I):
            findings.append(f"{REFERENCE}: {name} is missing")
        if f"tests/fuzz/fuzz_{name}.c" not in tree.files():
            findings.append(f"tests/fuzz/fuzz_{name}.c: is missing")
    tree.finish(len(meshes), "formats", findings)


main()
