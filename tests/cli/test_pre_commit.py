#!/usr/bin/env python3
"""The hooks of .pre-commit-hooks.yaml, run as pre-commit runs them: the words of `entry`, `args`, and the names of files that `files`
matches. FFD_DATA names data/."""

import os
import re
import shlex
import subprocess

from harness import CUBE, FFD, SECONDS, case, check, equal, glb, gltf_json, CUBE_CORNERS, lattice, main

HOOKS = os.path.join(os.environ["FFD_DATA"], "..", ".pre-commit-hooks.yaml")


def hooks():
    """{id: {key: text}}: the file is a list of entries with texts of one line, which need no other reader."""
    found = []
    with open(HOOKS, encoding="ascii") as file:
        for line in file:
            match = re.fullmatch(r"(- |  )(\w+): (.*)\n", line)
            check(match or line.startswith("#"), f"not a line of a hook: {line!r}")
            if match and match[1] == "- ":
                found.append({})
            if match:
                found[-1][match[2]] = match[3]
    return {hook["id"]: hook for hook in found}


def commit(run, hook, *names, args=()):
    """Returns the hook's exit code and what it says of these files."""
    matching = [name for name in names if re.search(hook["files"], name)]
    if not matching:
        return 0, ""
    files = [] if hook.get("pass_filenames") == "false" else matching
    path = os.path.dirname(FFD) + os.pathsep + os.environ["PATH"]
    done = subprocess.run([*shlex.split(hook["entry"]), *args, *files], cwd=run.folder, capture_output=True, text=True, check=False,
                          timeout=SECONDS, env={**os.environ, "PATH": path})
    return done.returncode, done.stdout + done.stderr


def write(run):
    run.write("good.obj", CUBE)
    run.write("with space.GLB", glb(*gltf_json(CUBE_CORNERS)))
    run.write("bad.obj", "v 1 2\n")
    run.write("notes.txt", "v 1 2\n")
    run.write("lattices/l.json", lattice(moves=[{"by": [0, 0, 1]}]))
    run.write("fold.lattice.json", lattice(moves=[{"at": [1, 1, 1], "by": [30, 30, 30]}]))
    run.write("lattices/bad.json", '{"format": "ffd-lattice"')
    run.write("package.json", "{}")


@case
def hooks_have_what_pre_commit_needs(run):
    found = hooks()
    equal(sorted(found), ["ffd-check", "ffd-lattices", "ffd-meshes"])
    for name, hook in found.items():
        equal({"id", "name", "description", "entry", "language", "files"} - set(hook), set(), name)
        equal(hook["language"], "system", name)


@case
def meshes_that_cannot_be_read_are_refused(run):
    write(run)
    hook = hooks()["ffd-meshes"]
    equal(commit(run, hook, "good.obj", "with space.GLB", "notes.txt"), (0, ""))
    code, said = commit(run, hook, "bad.obj", "good.obj")
    equal((code, said), (1, "ffd: bad.obj:1: a vertex needs 3 numbers, found 2\n"), "one that is not the last")


@case
def lattices_that_cannot_be_read_are_refused(run):
    write(run)
    hook = hooks()["ffd-lattices"]
    equal(commit(run, hook, "lattices/l.json", "fold.lattice.json", "package.json"), (0, ""))
    code, said = commit(run, hook, "lattices/bad.json", "lattices/l.json")
    equal((code, said.startswith("ffd: lattices/bad.json:1: ")), (1, True), said)


@case
def deformations_that_fold_are_refused(run):
    write(run)
    hook = hooks()["ffd-check"]
    equal(commit(run, hook, "package.json", args=["good.obj", "-l", "lattices/l.json"]), (0, ""))
    code, said = commit(run, hook, "good.obj", args=["good.obj", "-l", "fold.lattice.json"])
    equal((code, "folds" in said, said.count("\n")), (1, True, 1), said)


main()
