#!/usr/bin/env python3
"""The completions, as they are installed, in a real bash and a real zsh on a terminal: what they offer is inserted
into the line, and the line is run.

    test_completion.py BUILD-FOLDER
"""

import os
import pty
import re
import select
import subprocess
import sys
import tempfile
import time

import stage

SECONDS = 60
FORMATS = {"obj", "gltf", "glb", "vrm", "ply", "off", "stl", "vtk", "su2", "vtu", "vtp", "vts", "msh", "foam"}
MESHES = {"cow.obj", "ROBOT.GLB", "a vase.ply", "points", "folder/"}
# Typed -> what is offered for the last word; a folder's name may end in a slash or not.
CASES = [
    ("ffd lat", {"lattice"}),
    ("ffd lattice ", {"convert", "new", "refine", "set"}),
    ("ffd help lattice ", {"convert", "new", "refine", "set"}),
    ("ffd lattice refine be", {"bend.json"}),
    ("ffd lattice set bend.json --mirror ", {"u", "v", "w"}),
    ("ffd lattice set bend.json --add be", {"bend.json"}),
    ("ffd lattice refine bend.json --mesh cow", {"cow.obj"}),
    ("ffd report ", {"junit", "merge"}),
    ("ffd report merge be", {"bend.json"}),
    ("ffd deform ", MESHES),
    ("ffd deform cow", {"cow.obj"}),
    ("ffd deform folder/", {"folder/points"}),
    ("ffd deform po", {"points"}),
    ("ffd deform a\\ v", {"a vase.ply"}),
    ("ffd deform cow.obj out.obj -l ", {"bend.json", "folder/"}),
    ("ffd deform --lattice be", {"bend.json"}),
    ("ffd check cow.obj -l folder/", {"folder/twist.json"}),
    ("ffd deform --outside ", {"keep", "extend", "error"}),
    ("ffd deform --outside ex", {"extend"}),
    ("ffd deform --normals=re", {"--normals=recompute"}),
    ("ffd deform --isa avx", {"avx2", "avx512"}),
    ("ffd deform --out-dir ", {"folder/"}),
    ("ffd check --fail-on o", {"outside"}),
    ("ffd check --fail-on folds,o", {"folds,outside"}),
    ("ffd embed --status ", {"cow.npy", "folder/"}),
    ("ffd embed --input-format ", FORMATS),
    ("ffd info ", MESHES | {"bend.json"}),
    ("ffd lattice new --axis ", {"x", "y", "z"}),
    ("ffd lattice new --knots clamped,clamped,unc", {"clamped,clamped,unclamped"}),
    ("ffd lattice new cow.obj --sha", {"--shape"}),
]

# show prints the words of the line that was completed.
SHOW = "show() { printf '<%s>' \"$@\"; echo ' DONE'; }\n"
INSERT_ALL = "\x1bX"
START_OF_LINE = "\x01"
SETUP = {
    "bash": ["bash", "--norc", "--noprofile", "-i"],
    "zsh": ["zsh", "-f", "-i"],
}
PREPARE = {
    "bash": "set -o emacs; bind 'set completion-query-items 0'; bind '\"\\eX\": insert-completions'; "
            "source /usr/share/bash-completion/bash_completion\n" + SHOW,
    "zsh": "bindkey -e; unsetopt beep; autoload -Uz compinit; compinit -u -D; "
           "zle -C all-matches complete-word _generic; bindkey '^[X' all-matches; "
           "zstyle ':completion:all-matches::::' completer _all_matches _complete; "
           "zstyle ':completion:all-matches:*' insert true\n" + SHOW,
}


class Terminal:
    """A shell on a terminal of its own."""

    def __init__(self, shell, folder, environment):
        self.master, slave = pty.openpty()
        self.process = subprocess.Popen(SETUP[shell], cwd=folder, env=environment, stdin=slave, stdout=slave,
                                        stderr=slave, start_new_session=True)
        os.close(slave)
        self.send(PREPARE[shell] + "show ready\n")
        self.answer("ready")

    def send(self, text):
        os.write(self.master, text.encode())

    def answer(self, what):
        """What show printed next."""
        text = ""
        end = time.monotonic() + SECONDS
        while not re.search(r"> DONE\r?\n", text):
            if time.monotonic() > end or self.process.poll() is not None:
                sys.exit(f"no answer for {what!r}: {text[-2000:]!r}")
            if select.select([self.master], [], [], 1)[0]:
                text += os.read(self.master, 65536).decode("utf-8", "replace")
        return re.findall(r"<([^<>]*)>", re.findall(r"((?:<[^<>]*>)+) DONE\r?\n", text)[-1])

    def offered(self, typed):
        """What the shell puts in the place of the last word."""
        self.send(typed + INSERT_ALL + START_OF_LINE + "show \n")
        words = self.answer(typed)
        before = len(re.sub(r"\\ ", "_", typed).split(" ")) - 1
        return {word for word in words[before:] if word}

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.master)


def plain(names):
    return {name.rstrip("/") for name in names}


def check(shell, folder, environment, texts):
    """Returns the findings and how much was looked at."""
    terminal = Terminal(shell, folder, environment)
    firsts = {name.split()[0] for name in texts if name}
    cases = [("ffd ", firsts | {"help"}), ("ffd help ", firsts), *CASES]
    for name, text in texts.items():
        if name:
            # All options that the help tells of.
            cases.append((f"ffd {name} --", set(re.findall(r"^ +(?:-\w, )?(--[\w-]+)", text, re.M))))
    findings = []
    for typed, expected in cases:
        offered = plain(terminal.offered(typed))
        if typed == "ffd ":
            offered -= {"--help", "--version"}  # bash offers them at once, zsh behind a dash
        # zsh puts the sign between an option and its value.
        if typed.endswith("--") or "--sha" in typed:
            offered = {word.rstrip("=") for word in offered}
        if offered != plain(expected):
            findings.append(f"{shell}: {typed!r}: {sorted(offered)} instead of {sorted(plain(expected))}")
    terminal.close()
    return findings, len(cases)


def main():
    stage.need(*SETUP)
    findings, checked = [], 0
    with tempfile.TemporaryDirectory() as folder:
        folder = os.path.realpath(folder)
        installed = stage.Stage(sys.argv[1], os.path.join(folder, "root"))
        texts = stage.commands(installed.path("bindir", "ffd"))
        work = os.path.join(folder, "work")
        os.makedirs(os.path.join(work, "folder"))
        for name in ("cow.obj", "ROBOT.GLB", "a vase.ply", "bend.json", "cow.npy", "notes.txt", "mypoints", "points", "folder/points", "folder/twist.json"):
            with open(os.path.join(work, name), "w", encoding="ascii"):
                pass
        environment = {"PATH": installed.path("bindir") + ":/usr/bin:/bin", "HOME": folder, "TERM": "dumb",
                       "LANG": "C.UTF-8", "PS1": "$ ", "INPUTRC": "/dev/null", "COLUMNS": "200",
                       "XDG_DATA_DIRS": installed.path("datadir"),
                       "FPATH": installed.path("datadir", "zsh/site-functions") + ":" + stage.run(
                           ["zsh", "-f", "-c", "print -rn -- $FPATH"])}
        for shell in SETUP:
            found, count = check(shell, work, environment, texts)
            findings += found
            checked += count
    stage.finish(checked, "completions", findings)


main()
