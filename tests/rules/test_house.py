#!/usr/bin/env python3
"""What lets a newcomer find the way: an opening comment that says what a file is; in src also a
comment above every function that an internal header declares, and which sources define these functions. A function of
src or tests has at most 80 lines, an example of the library at most 60."""

import ast
import collections
import os
import re

import tree

MOST_LINES_OF_EXAMPLES = 60
MOST_LINES_OF_FUNCTIONS = 80
COMMENT = re.compile(r"/\*.*?\*/", re.S)
# A declaration at the start of a line, up to its semicolon: "void ffd_free(void *block);".
PROTOTYPE = re.compile(r"^(?!typedef\b|static\b|extern\b|return\b)[a-z][\w \*]*?\b(\w+)\([^;{}]*\)[^;{}]*;", re.M)
# A definition: the same with a body.
DEFINITION = re.compile(
    r'^(?!typedef\b|static\b|return\b)(?:extern "C" )?[a-z][\w \*]*?\b(\w+)\([^;{}]*\)\s*\{', re.M)


def unit(path):
    """What a source and its header have in common, also one that is for Windows."""
    return os.path.splitext(path)[0].removesuffix("_windows")


def opening(path, headers):
    """What is wrong with the file's opening comment. A source whose header has one needs none."""
    text = tree.read(path)
    name = os.path.basename(path)
    wanted = f"/* {name} - "
    if path.endswith(".h") or unit(path) + ".h" not in headers:
        if not text.startswith(wanted):
            yield f"{path}: begins without '{wanted}...': a line that says what it is"


# How the sources under tests open: a sentence at least.
OPENINGS = {
    (".c", ".cpp", ".h"): re.compile(r"/\* \w[^\n]{15}"),
    (".py",): re.compile(r'(?:#![^\n]*\n)?"""[\w`-][^\n]{15}'),
    (".sh",): re.compile(r"#![^\n]*\n# \w[^\n]{15}"),
    (".mjs",): re.compile(r"// \w[^\n]{15}"),
}


def test_opening(path):
    """What is wrong with the opening comment of a source under tests."""
    for endings, pattern in OPENINGS.items():
        if path.endswith(endings) and not pattern.match(tree.read(path)):
            yield f"{path}: begins without a comment that says what it checks"


def definers(path, defined):
    """Sources that define functions of a header and are neither named like it nor in its opening comment."""
    text = tree.read(path)
    first = COMMENT.match(text)
    for match in PROTOTYPE.finditer(COMMENT.sub("", text)):
        for source in defined.get(match.group(1), ()):
            name = os.path.basename(source)
            if unit(source) != unit(path) and name not in (first or [""])[0]:
                yield f"{path}: declares {match.group(1)}, but its opening comment does not name {name}"


def definitions(paths):
    """The sources that define each external function."""
    found = collections.defaultdict(set)
    for path in paths:
        for match in DEFINITION.finditer(COMMENT.sub("", tree.read(path))):
            found[match.group(1)].add(path)
    return found


def prototypes(path):
    """Functions without a comment: only an empty line, a directive or other code is above them."""
    if path == "src/base/windows/posix.h":  # what POSIX says of them
        return
    text = tree.read(path)
    # Comments are blanked, but for their ends, so that no declaration is found inside of one.
    plain = COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group(0)[:-2]) + "*/", text)
    for match in PROTOTYPE.finditer(plain):
        above = plain[:match.start()].rstrip(" ").removesuffix("\n")
        if not above.endswith("*/"):
            yield f"{path}: no comment above {match.group(1)}"


def functions_of_c(text):
    """The first line of each function, and how many lines it has. clang-format begins lines with the brackets of its body."""
    lines = text.splitlines()
    first, opened = 0, None
    for number, line in enumerate(lines):
        if line == "{" and re.search(r"\)[ \w]*$", lines[number - 1]):  # else of a class
            opened = first
        elif line.startswith("}"):
            if opened is not None:
                yield lines[opened], number - opened + 1
            first, opened = number + 1, None
        elif not line or line.endswith((";", "*/")) or line.startswith("#"):
            first = number + 1


def functions_of_python(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            yield f"def {node.name}", node.end_lineno - node.lineno + 1


def long_functions(paths):
    for path in paths:
        functions = functions_of_python if path.endswith(".py") else functions_of_c
        for name, lines in functions(tree.read(path)):
            if lines > MOST_LINES_OF_FUNCTIONS:
                yield f"{path}: {name}: {lines} lines, more than {MOST_LINES_OF_FUNCTIONS}"


def long_examples(paths):
    """The programs of data/examples that are longer than data/README.md says."""
    for path in paths:
        lines = len(tree.read(path).splitlines())
        if lines > MOST_LINES_OF_EXAMPLES:
            yield f"{path}: {lines} lines, more than {MOST_LINES_OF_EXAMPLES}"


def main():
    files = tree.files()
    paths = [path for path in files if path.startswith("src/") and path.endswith((".c", ".cpp", ".h"))]
    tests = [path for path in files if path.startswith("tests/") and path.endswith(sum(OPENINGS, ()))]
    headers = {path for path in paths if path.endswith(".h")}
    findings = []
    defined = definitions(path for path in paths if path not in headers)
    for path in paths:
        findings += opening(path, headers)
        if path in headers:
            findings += [*prototypes(path), *sorted(set(definers(path, defined)))]
    for path in tests:
        findings += test_opening(path)
    examples = [path for path in files if path.startswith("data/examples/") and path.endswith((".c", ".cpp", ".py"))]
    findings += long_examples(examples)
    sources = [path for path in files if path.startswith(("src/", "tests/")) and path.endswith((".c", ".cpp", ".h", ".py"))]
    findings += long_functions(sources)
    findings += [f"{what}: no sources found" for what, found in (("tests", tests), ("data/examples", examples)) if not found]
    tree.finish(len(paths) + len(tests) + len(examples), "files", findings)


main()
