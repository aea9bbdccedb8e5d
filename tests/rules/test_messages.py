#!/usr/bin/env python3
"""Messages of the library name settings by their members, in braces (src/base/spelling.h), and never as options of the
program: those are in src/cli alone. Each name is that of a member or of an argument in include/ffd, or of a batch."""

import re

import tree

# What only a batch is told; src/cli words it.
BATCH = {"csv", "csv_ignore", "dtype", "jobs", "journal", "resume", "shared_box", "stop", "view"}
TOKEN = re.compile(r"""/\*.*?\*/|//[^\n]*|'(?:\\.|[^'\\\n])+'|"(?:\\.|[^"\\\n])*\"""", re.S)
OPTION = re.compile(r"(?<![\w-])--[a-z]")
WORD = re.compile(r"--[a-z-]+='?")  # the beginning of a word of a command line: a job of a batch is one
MEMBER = re.compile(r"\{([a-z_.]+)(?:=[^{}]*)?\}")


def literals(text):
    for token in TOKEN.finditer(text):
        if token.group().startswith('"'):
            yield text.count("\n", 0, token.start()) + 1, token.group()[1:-1]


def main():
    headers = [path for path in tree.files() if path.startswith("include/ffd/")]
    known = BATCH | set(re.findall(r"\b\w+(?=[;,)\[])", "".join(
        re.sub(r"/\*.*?\*/", "", tree.read(path), flags=re.S) for path in headers)))
    checked, findings = 0, []
    for path in tree.files():
        if not path.startswith("src/") or path.startswith("src/cli/") or not path.endswith((".c", ".h", ".cpp")):
            continue
        for line, text in literals(tree.read(path)):
            if OPTION.search(text) and not WORD.fullmatch(text):
                findings.append(f"{path}:{line}: \"{text}\" has an option of the program")
            for name in MEMBER.findall(text):
                checked += 1
                if name.rpartition(".")[2] not in known:
                    findings.append(f"{path}:{line}: {{{name}}} is no member")
    tree.finish(checked, "members", findings)


main()
