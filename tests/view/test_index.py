#!/usr/bin/env python3
"""The page of ffd batch --view in Chromium, opened as a file: pictures load, columns sort by mouse and by keyboard, names
are text, a phone has no row wider than itself, and nothing is asked of a network.

    test_index.py FFD

FFD_NODE names the folder whose node_modules holds playwright-core. FFD_SCREENSHOTS names a folder for pictures to be
looked at.
"""

import json
import os
import subprocess
import sys
import tempfile

from browser import find_browser, run_script

CUBE = "".join(f"v {x} {y} {z}\n" for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) + "".join(
    f"f {face}\n" for face in ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"))


def write(path, content):
    with open(path, "w", encoding="utf-8") as file:
        file.write(content if isinstance(content, str) else json.dumps(content))


def lattice(low, high):
    return {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [low] * 3, "max": high}},
            "moves": [{"by": [0, 0, {"$": "LIFT"}]}]}


def prepare(folder, ffd):
    """Lifts that are not in order; a torn one; a folded one; one that fails; names that would be markup."""
    write(os.path.join(folder, "a.obj"), CUBE)
    write(os.path.join(folder, "l.json"), lattice(-2, [2, 2, 2]))
    write(os.path.join(folder, "torn.json"), lattice(-9, [0.5, 9, 9]))
    fold = lattice(-2, [2, 2, 2])
    fold["moves"] = [{"at": [1, 1, 1], "by": [30, 30, 30]}]
    write(os.path.join(folder, "fold.json"), fold)
    jobs = [("l", 0.5, "o/x10.obj"), ("l", 1.5, "o/x9.obj"), ("torn", 0.25, "o/torn.obj"), ("fold", None, "o/fold.obj"),
            ("gone", None, "o/gone.obj"), ("l", 1, "o/<img src=x onerror=alert(1)>\"'&#?%41 ü\u202e.obj")]
    os.mkdir(os.path.join(folder, "o"))
    write(os.path.join(folder, "m.jsonl"), "".join(
        json.dumps({"in": "a.obj", "lattice": name + ".json", "out": out, **({"set": {"LIFT": lift}} if lift else {})}) + "\n"
        for name, lift, out in jobs))
    done = subprocess.run([ffd, "batch", "m.jsonl", "--view", "v", "--quiet"], cwd=folder, check=False, capture_output=True,
                          env={**os.environ, "XDG_CACHE_HOME": os.path.join(folder, "cache")}, timeout=60)
    if done.returncode != 1:
        sys.exit(f"ffd batch: exit {done.returncode}: {done.stderr.decode()}")


def main():
    ffd = os.path.abspath(sys.argv[1])
    found = find_browser()
    with tempfile.TemporaryDirectory() as folder:
        prepare(folder, ffd)
        code = run_script("index.mjs", found, os.path.join(folder, "v"), folder, 100)
    sys.exit(code)


main()
