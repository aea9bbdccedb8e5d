#!/usr/bin/env python3
"""The installed man page is right in the eyes of man and mandoc, and says what --help says: every command, every
usage line, every option with its value and words, every example, and every exit code.

    test_man.py BUILD-FOLDER
"""

import os
import re
import subprocess
import sys
import tempfile

import stage

# Far apart from how the page was made: what a reader sees, on a line as wide as it takes.
WIDE = dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="400", MANROFFSEQ="")


def warnings(page):
    """What the formatters complain of."""
    said = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page], env=WIDE, text=True,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    linted = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, check=False)
    return [line for done in (said.stderr, linted.stdout) for line in done.splitlines()] + [
        f"exit {done.returncode} of {done.args[0]}" for done in (said, linted) if done.returncode != 0]


def squeezed(text):
    return " ".join(text.split())


def pieces(text):
    """What of a command's help must be in the page."""
    usage, rest = text.split("\nOptions:\n")
    options, examples = rest.split("\nExamples:\n")
    for line in usage.splitlines():
        yield line.removeprefix("usage:")
    for line in options.splitlines():
        match = re.fullmatch(r"  (?:    |(-\w), )(--\S+)( \S+)? +(.*)", line)
        yield f"{match[1] + ', ' if match[1] else ''}{match[2]}{match[3] or ''} {match[4]}"
    yield from examples.splitlines()


def main():
    stage.need("man", "mandoc")
    findings, checked = [], 0
    with tempfile.TemporaryDirectory() as folder:
        installed = stage.Stage(sys.argv[1], folder)
        page = installed.path("mandir", "man1/ffd.1")
        findings += warnings(page)
        shown = stage.run(["man", "--nj", "--nh", "-l", page], env=WIDE)
        # Where a terminal cannot say it otherwise a bold letter is printed twice.
        shown = squeezed(re.sub(r".\x08", "", shown))
        texts = stage.commands(installed.path("bindir", "ffd"))
        version = stage.run([installed.path("bindir", "ffd"), "--version"]).strip().split(" (")[0]
    for name, text in texts.items():
        for piece in pieces(text) if name else [version]:
            checked += 1
            if squeezed(piece) not in shown:
                findings.append(f"ffd {name}: not in the man page: {piece}")
    codes = re.search(r"EXIT STATUS (.*) SEE ALSO", shown)[1]
    for code in range(8):
        checked += 1
        if not re.search(rf"(^| ){code} [A-Z]", codes):
            findings.append(f"the man page does not tell of exit {code}")
    stage.finish(checked, "pieces of the man page", findings)


main()
