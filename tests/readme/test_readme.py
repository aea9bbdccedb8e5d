#!/usr/bin/env python3
"""Runs every command of README.md.

    test_readme.py tutorial FFD SOURCE     the tutorial, in a copy of data/, with the program FFD

The build and the C example are run by tests/install/test_packages.py, in the source that a release is packed into.
Blocks are fenced: ```sh (commands of the tutorial), ```sh build (those of the build), ```json NAME, ```csv NAME, ```ninja NAME,
```make NAME and ```c NAME (files). ```sh package and ```sh library are run by tests of tests/install,
```sh slurm, parallel and snakemake by those of tests/cluster.
Commands that stand indented are compared with a list: a new one must find its test here."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

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


def run(script, folder, environment):
    result = subprocess.run(["sh", "-eu", "-c", script], cwd=folder, env=environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=1500)
    if result.returncode != 0:
        sys.exit(f"{script}\nended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def check_indented(text):
    names = {name for language, name, content in blocks(text) if language == "sh"}
    if names - {"", "build", "package", "library", "slurm", "parallel", "snakemake"}:
        sys.exit(f"README.md has blocks of commands that no test runs: {names}")
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    found = [line.strip() for line in outside.splitlines() if re.match(r"^    (sh|cc|ffd|meson|python3) ", line)]
    for line in found:
        command = re.split(r"\s{2,}", line)[0]
        if command not in INDENTED:
            sys.exit(f"README.md has a command that no test runs: {command}")
    return len(found)


def tutorial(text, ffd, source):
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        data = os.path.join(folder, "data")
        shutil.copytree(os.path.join(source, "data"), data)
        tools = os.path.join(folder, "bin")
        os.mkdir(tools)
        os.symlink(os.path.abspath(ffd), os.path.join(tools, "ffd"))
        environment = dict(os.environ, PATH=tools + os.pathsep + os.environ["PATH"])
        for language, name, content in blocks(text):
            if language in ("json", "csv", "ninja", "make"):
                with open(os.path.join(data, name), "w", encoding="utf-8") as file:
                    file.write(content)
            elif language == "sh" and not name:
                run(content, data, environment)
                count += len(content.strip().splitlines())
    return count


def main():
    source = os.path.abspath(sys.argv[-1])
    with open(os.path.join(source, "README.md"), encoding="utf-8") as file:
        text = file.read()
    count = check_indented(text) + tutorial(text, sys.argv[2], source)
    if count == 0:
        sys.exit("README.md has no command")
    print(f"{count} commands of README.md run")


if __name__ == "__main__":
    main()
