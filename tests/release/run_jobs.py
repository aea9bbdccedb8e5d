#!/usr/bin/env python3
"""Runs the job list (jobs.txt) with a program, whatever it was built for: each job has the same exit code, messages and files
everywhere, which the sum before its command stands for.

    run_jobs.py [--every N] [--without WORD[,WORD]] [--write] PROGRAM [ARGUMENT...]

PROGRAM with its arguments is what a command is put behind: "ffd", "node cli.mjs", "qemu-aarch64 -L ROOT ffd". --every: every
N-th job, and those that make what it reads. --without: no jobs whose first word, or one of whose options, is WORD. --write: writes
the sums anew. The commands run one after the other in a folder of its own, which has models, lattices and inputs.
"""

import argparse
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
LIST = os.path.join(HERE, "jobs.txt")
SECONDS = 120


def read_list():
    """[sum, command] of each job"""
    with open(LIST, encoding="utf-8") as file:
        return [line.rstrip("\n").split(" ", 1) for line in file if line.strip() and not line.startswith("#")]


def words(command):
    return shlex.split(command)


def chosen(jobs, every, without):
    """The indices of the jobs to run: every n-th, and before them those that made a file which they name, or have copied what
    belongs to the same model."""
    allowed = [i for i, (_, command) in enumerate(jobs) if not without & set(words(command))]
    wanted = set(allowed[::every])
    for i in sorted(allowed, reverse=True):
        if i in wanted:
            read = {word for word in words(jobs[i][1]) if not word.startswith("-") and "/" not in word}
            models = {word for word in words(jobs[i][1]) if word.startswith("models/")}
            for model in models:
                wanted.add(next((k for k in allowed if jobs[k][1].startswith(f"deform {model} ")), i))
            for other in allowed:
                if other < i and read & makes(jobs[other][1]):
                    wanted.add(other)
    return sorted(wanted)


def makes(command):
    """The names of files without a folder that a command mentions, and not only reads."""
    given = words(command)
    outputs = {word for before, word in zip(given, given[1:]) if before in ("-o", "--report", "--status")}
    if given[0] == "deform" and len(given) > 2:
        outputs.add(given[2])
    return outputs


def snapshot(folder):
    """Name -> hash of each file that jobs may have made"""
    found = {}
    for base, folders, names in os.walk(folder):
        if base == folder:
            folders[:] = [name for name in folders if name not in ("models", "lattices", "inputs")]
        for name in names:
            path = os.path.join(base, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def remove_copies(folder, files, jobs):
    """Removes what no command of the list names, nor a file with the same stem: copies of materials and images, which the next job
    copies again, whichever jobs ran before it. Returns the other files."""
    named = {stem(word) for _, command in jobs for word in words(command) if "/" not in word}
    for name in [name for name in files if stem(name) not in named]:
        os.remove(os.path.join(folder, name))
        del files[name]
    return files


def stem(path):
    return os.path.basename(path).split(".")[0]


def without_version(text, version):
    """version: "0.3.0", or with the commit behind it, which some outputs leave out"""
    return text.replace(version, b"VERSION").replace(version.split()[0], b"VERSION")


def run(program, command, folder, version, before):
    """The sum of what a command does, and what it did as text."""
    done = subprocess.run([*program, *words(command)], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, timeout=SECONDS,
                          check=False)
    after = snapshot(folder)
    # What differs from one version, or one run, to the next.
    told = [without_version(re.sub(rb"\b\d+\.\d+ s\b", b"N s", text), version) for text in (done.stdout, done.stderr)]
    digest = hashlib.sha256()
    for part in (str(done.returncode).encode(), *told):
        digest.update(b"%d:" % len(part) + part)
    changed = sorted(name for name in after if before.get(name) != after[name])
    for name in changed:
        content = without_version(after[name], version) if not name.endswith(".journal") else b""
        digest.update(name.encode() + hashlib.sha256(content).digest())
    return digest.hexdigest()[:16], after, f"exit {done.returncode}, files: {' '.join(changed) or 'none'}; " + \
        told[1].decode(errors="replace").strip()[:300]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--without", default="")
    parser.add_argument("--other-order", action="store_true",
                        help="the machine's byte order is another one, which arrays have too: those are made, but not compared")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("program", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    # The commands run in another folder.
    program = [os.path.abspath(word) if os.path.exists(word) else word for word in options.program]
    jobs = read_list()
    indices = chosen(jobs, options.every, set(filter(None, options.without.split(","))))
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, path in (("models", "data/models"), ("lattices", "data/lattices"), ("inputs", "tests/release/inputs")):
            shutil.copytree(os.path.join(ROOT, path), os.path.join(folder, name))
        first = subprocess.run([*program, "--version"], capture_output=True, check=True, cwd=folder).stdout
        version = first.split(b"\n")[0].removeprefix(b"ffd ")
        files = {}
        for i in indices:
            wanted, command = jobs[i]
            found, files, did = run(program, command, folder, version, files)
            files = remove_copies(folder, files, jobs)
            if options.verbose:
                print(f"{found} {command}\n    {did}")
            if options.write:
                jobs[i][0] = found
            elif found != wanted and not (options.other_order and ".npy" in did):
                failed += 1
                print(f"{command}\n    {did}")
    if options.write:
        with open(LIST, "w", encoding="utf-8") as file:
            file.writelines(f"{found} {command}\n" for found, command in jobs)
    print(f"{len(indices)} jobs, {failed} with other results")
    sys.exit(failed > 0)


main()
