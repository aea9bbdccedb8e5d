#!/usr/bin/env python3
"""The papers (src/maths.md, data/schema/*.md) and what cites them: every section that is cited exists, the functions that a
paper names are in the folder that it names, links lead somewhere, and the papers of JSON formats name every member of
the format's schema."""

import json
import os
import re

import tree

MATHS, LATTICE, FORMATS = "src/maths.md", "data/schema/lattice.md", "data/schema/formats.md"
PAPERS = (MATHS, LATTICE, FORMATS)
SCHEMAS = {"data/schema/ffd-lattice.schema.json": LATTICE, "data/schema/ffd-report.schema.json": FORMATS}
TEXT = (".c", ".cpp", ".h", ".md", ".mjs", ".js", ".py", ".sh", ".build")

# A citation may go on in the next line of a comment.
BREAK = r"(?:\s*\n\s*(?:\*\s|//\s?|#\s?)?\s*|\s+)"
NUMBER = r"\d+(?:\.\d+)?"
CITATION = re.compile("(" + "|".join(map(re.escape, PAPERS)) + f")`?(?:{BREAK}({NUMBER})(?:{BREAK}(?:to|and){BREAK}({NUMBER}))?)?")
# What came with no source.
FORMER = re.compile(r"(?<!src/)\bmaths(?:\.md)?\s+\d|\binterface(?:\.md)?\s+\d|\binterface\.md\b")


def sections(paper):
    return set(re.findall(rf"^#+ ({NUMBER})\.? ", tree.read(paper), re.M))


def citations(paths):
    """What is wrong with them, and how many there are."""
    numbers = {paper: sections(paper) for paper in PAPERS}
    findings, count = [f"{paper} has no numbered sections" for paper in PAPERS if not numbers[paper]], 0
    for path in paths:
        if not path.endswith(TEXT) or path.startswith("subprojects/") or os.path.basename(path) == os.path.basename(__file__):
            continue
        text = tree.read(path)
        findings += [f"{path}: cites '{match.group()}'" for match in FORMER.finditer(text)]
        for match in CITATION.finditer(text):
            count += 1
            findings += [f"{path}: cites {match[1]} {number}, which is not there" for number in match.groups()[1:]
                         if number and number not in numbers[match[1]]]
    for paper in PAPERS:
        inner = re.findall(rf"\b[Ss]ections? ({NUMBER})|\(({NUMBER})\)", tree.read(paper))
        findings += [f"{paper}: its section {number} is not there" for pair in inner for number in pair
                     if number and number not in numbers[paper]]
    return findings, count


def functions(paths):
    """`src/embed`: `one`, `another`: each is in a file below that folder."""
    words = {}
    for path in paths:
        if path.startswith("src/") and path.endswith((".c", ".cpp", ".h")):
            words.setdefault(path.split("/")[1], set()).update(re.findall(r"\w+", tree.read(path)))
    findings, count = [], 0
    for match in re.finditer(r"`src/(\w+)`: (`\w+`(?:,\s+`\w+`)*)", tree.read(MATHS)):
        for name in re.findall(r"\w+", match[2]):
            count += 1
            if name not in words.get(match[1], ()):
                findings.append(f"{MATHS}: {name} is not in src/{match[1]}")
    everything = set().union(*words.values())
    for paper in PAPERS:
        findings += [f"{paper}: there is no {name}" for name in re.findall(r"`(ffd_\w+)`", tree.read(paper)) if name not in everything]
    return findings, count


def anchor(heading):
    """As GitHub makes it of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def links(paths):
    """Relative links of Markdown lead to a file, and to a heading of it."""
    pages = {path: tree.read(path) for path in paths if path.endswith(".md") and not path.startswith("subprojects/")}
    anchors = {path: {anchor(heading) for heading in re.findall(r"^#+ (.*)$", text, re.M)} for path, text in pages.items()}
    findings, count = [], 0
    for path, text in pages.items():
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            name, _, heading = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
            if file not in paths and not any(other.startswith(file + "/") for other in paths):
                findings.append(f"{path}: there is no {target}")
            elif heading and heading not in anchors.get(file, ()):
                findings.append(f"{path}: there is no heading {target}")
    return findings, count


def members(schema):
    """The names of all members that a schema knows."""
    for key, value in schema.items() if isinstance(schema, dict) else enumerate(schema) if isinstance(schema, list) else ():
        if key == "properties":
            yield from value
        yield from members(value)


def formats():
    findings, count = [], 0
    for schema, paper in SCHEMAS.items():
        text = re.sub(r"^```.*$", "", tree.read(paper), flags=re.M)
        named = set(re.findall(r"[\w$]+", " ".join(re.findall(r"`[^`]+`|\"[^\"]+\"", text))))
        for name in sorted(set(members(json.loads(tree.read(schema))))):
            count += 1
            if name not in named:
                findings.append(f"{paper} does not speak of \"{name}\" of {schema}")
    return findings, count


def main():
    paths = tree.files()
    findings, checked = [], 0
    for found, count in (citations(paths), functions(paths), links(set(paths)), formats()):
        findings += found if count else [*found, "nothing to check"]
        checked += count
    tree.finish(checked, "citations, functions, links and members", findings)


main()
