#!/usr/bin/env python3
"""Runs every command of README.md and of the pages that go on from it, and follows their links.

    test_readme.py tutorial FFD SOURCE     the commands, in a copy of data/, with the program FFD
    test_readme.py pictures FFD SOURCE     data/make_pictures.sh draws the pictures that are there
    test_readme.py links SOURCE            links lead to files and headings, and README.md is short

The build and the C example are run by tests/install/test_packages.py, in the source that a release is packed into.
Blocks are fenced: ```sh (commands of the tutorial), ```sh build (those of the build), ```json NAME, ```csv NAME, ```prm NAME, ```ninja NAME,
```make NAME and ```c NAME (files). ```sh package and ```sh library are run by tests of tests/install, ```sh python and ```python by tests/python,
```sh slurm, parallel and snakemake by those of tests/cluster, ```bat and ```powershell (data/windows.md) by tests/windows.
Commands that stand indented are compared with a list: a new one must find its test here."""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import zlib

# In the order in which a reader comes to them: a page may use the files of those before it.
PAGES = ("README.md", "data/tutorial.md", "data/promises.md", "data/reference.md")
LINKED = PAGES + ("CONTRIBUTING.md", "data/README.md", "data/python.md", "data/npm.md", "data/windows.md", "data/blender/README.md", "data/schema/formats.md", "data/schema/lattice.md", "src/README.md",
                  "tests/README.md")
MOST_WORDS = 2500

INDENTED = {
    "sh data/demo.sh": "tests/golden (demo)",
    "sh tests/run.sh": "this run",
    "cc example.c $(pkg-config --cflags --libs ffd)": "tests/install/test_packages.py",
}


def blocks(text):
    for match in re.finditer(r"^```(\S*) ?(\S*)\n(.*?)^```$", text, re.M | re.S):
        yield match.group(1), match.group(2), match.group(3)


def block(text, name):
    """The commands of ```sh NAME."""
    return next(content for language, other, content in blocks(text) if (language, other) == ("sh", name))


def read(source, page):
    with open(os.path.join(source, page), encoding="utf-8") as file:
        return file.read()


def pages(source):
    """The text of all pages whose commands are run."""
    return "\n".join(read(source, page) for page in PAGES)


def run(script, folder, environment):
    result = subprocess.run(["sh", "-eu", "-c", script], cwd=folder, env=environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1500)
    if result.returncode != 0:
        sys.exit(f"{script}\nended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def check_indented(text):
    names = {name for language, name, content in blocks(text) if language == "sh"}
    if names - {"", "build", "package", "library", "python", "slurm", "parallel", "snakemake"}:
        sys.exit(f"the pages have blocks of commands that no test runs: {names}")
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    found = [line.strip() for line in outside.splitlines() if re.match(r"^    (sh|cc|ffd|meson|python3) ", line)]
    for line in found:
        command = re.split(r"\s{2,}", line)[0]
        if command not in INDENTED:
            sys.exit(f"the pages have a command that no test runs: {command}")
    return len(found)


def write(path, content):
    """A file that a page shows; one of data/ that it shows is the one that is there."""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            if file.read() != content:
                sys.exit(f"{os.path.basename(path)} is not what the page shows")
    with open(path, "w", encoding="utf-8") as file:
        file.write(content)


def check_fits(text, output):
    """The lines of fits that the tutorial quotes were printed."""
    for line in re.findall(r"`(fit: [^`]*)`", text):
        if line not in output:
            sys.exit(f"no command of the pages prints {line}")


def tutorial(text, ffd, source):
    count, output = 0, ""
    with tempfile.TemporaryDirectory() as folder:
        data = os.path.join(folder, "data")
        shutil.copytree(os.path.join(source, "data"), data)
        tools = os.path.join(folder, "bin")
        os.mkdir(tools)
        os.symlink(os.path.abspath(ffd), os.path.join(tools, "ffd"))
        environment = dict(os.environ, PATH=tools + os.pathsep + os.environ["PATH"])
        for language, name, content in blocks(text):
            if language in ("json", "csv", "prm", "ninja", "make"):
                write(os.path.join(data, name), content)
            elif language == "sh" and not name:
                output += run(content, data, environment)
                count += len(content.strip().splitlines())
    check_fits(read(source, "data/tutorial.md"), output)
    return count


def unpacked(path):
    """A file's bytes; of a PNG the chunks, with the rows as zlib packed them: another zlib packs them otherwise."""
    with open(path, "rb") as file:
        data = file.read()
    if not path.endswith(".png"):
        return data
    head, rows, at = b"", b"", 8
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        kind, content = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        head, rows = (head, rows + content) if kind == b"IDAT" else (head + kind + content, rows)
        at += 12 + size
    return head, zlib.decompress(rows)


def pictures(ffd, source):
    """Draws them all anew; they are the same."""
    kept = os.path.join(source, "data", "pictures")
    with tempfile.TemporaryDirectory() as folder:
        run(f"sh {shlex.quote(os.path.join(source, 'data', 'make_pictures.sh'))} {shlex.quote(os.path.abspath(ffd))} .",
            folder, os.environ)
        if sorted(os.listdir(folder)) != sorted(os.listdir(kept)):
            sys.exit(f"data/pictures holds {sorted(os.listdir(kept))}, drawn are {sorted(os.listdir(folder))}")
        for name in os.listdir(folder):
            if unpacked(os.path.join(folder, name)) != unpacked(os.path.join(kept, name)):
                sys.exit(f"data/pictures/{name} is not what data/make_pictures.sh draws")
    shown = set(re.findall(r"\]\((?:data/)?pictures/([^)]*)\)", pages(source)))
    if shown != set(os.listdir(kept)):
        sys.exit(f"the pages show {sorted(shown)}, data/pictures holds {sorted(os.listdir(kept))}")
    large = [name for name in os.listdir(kept) if os.path.getsize(os.path.join(kept, name)) > 120_000]
    if large:
        sys.exit(f"more than 120 kB: {large}")
    return len(shown)


def words(source):
    """Those of README.md outside of its code blocks: what stands between blanks, of links and tables too. Not too many."""
    count = len(re.sub(r"^```.*?^```$", "", read(source, "README.md"), flags=re.M | re.S).split())
    if count > MOST_WORDS:
        sys.exit(f"README.md has {count} words outside of code blocks, more than {MOST_WORDS}")
    return count


def anchors(text):
    """The headings as GitHub's links name them."""
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    titles = re.findall(r"^#+ (.*)$", outside, re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def links(source):
    count = 0
    for page in LINKED:
        text = read(source, page)
        outside = re.sub(r"^```.*?^```$|`[^`\n]*`", "", text, flags=re.M | re.S)
        for link in re.findall(r"\]\(([^)\s]+)\)", outside):
            if re.match(r"https?://", link):
                continue
            path, _, anchor = link.partition("#")
            target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            if not os.path.exists(os.path.join(source, target)):
                sys.exit(f"{page}: no file {link}")
            if anchor and anchor not in anchors(read(source, target)):
                sys.exit(f"{page}: no heading {link}")
            count += 1
    return count


def main():
    source = os.path.abspath(sys.argv[-1])
    if sys.argv[1] == "links":
        print(f"{links(source)} links lead somewhere; README.md has {words(source)} words")
    elif sys.argv[1] == "pictures":
        print(f"{pictures(sys.argv[2], source)} pictures are what is drawn")
    else:
        text = pages(source)
        print(f"{check_indented(text) + tutorial(text, sys.argv[2], source)} commands of the pages run")


if __name__ == "__main__":
    main()
