#!/usr/bin/env python3
"""The crafted files of tests/cli/broken_gltf_cases.py before the Khronos glTF validator: each has the code that
it was made for, and where ffd deforms it, the output has no error that the file did not have.

    broken_gltf.py FFD TABLE      TABLE: what the validator says of every file is written there

FFD_NODE names the folder whose node_modules holds gltf-validator."""

import json
import os
import subprocess
import sys
import tempfile

from validate import answers, find_packages

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "cli"))
LATTICE = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [-2] * 3, "max": [2] * 3}},
           "moves": [{"at": [1, "all", "all"], "by": [0.25, 0.5, 0]}]}


def places(answer):
    """The errors of an answer; those of the container without the byte at which they are."""
    return {(code, "" if place.startswith("@") else place) for code, place in answer["errors"]}


def judge(code, before, after):
    """'' or what is wrong."""
    if "failed" in before:
        # It gives up where the container or the JSON cannot be read at all.
        return "" if after is None else f"the validator gave up: {before['failed']}"
    if code not in before["codes"]:
        return f"the file has not this code, but {' '.join(before['codes'])}"
    if after is None:
        return ""
    if code == "VALUE_MULTIPLE_OF":
        return ""  # the validator reads elements with such a stride from other bytes
    new = places(after) - places(before)
    return f"new errors: {sorted(new)}" if new else ""


def main():
    ffd, table = sys.argv[1:]
    node_folder = find_packages("gltf-validator")
    os.environ.setdefault("FFD", ffd)
    from broken_gltf_cases import CASES

    rows, runs = [], []
    with tempfile.TemporaryDirectory() as folder:
        lattice = os.path.join(folder, "l.json")
        with open(lattice, "w", encoding="utf-8") as file:
            json.dump(LATTICE, file)
        with open(os.path.join(folder, "short.bin"), "wb") as file:
            file.write(bytes(64))
        for number, (code, _, what, ending, make) in enumerate(CASES):
            source, target = (os.path.join(folder, f"{side}{number}{ending}") for side in "ab")
            with open(source, "wb") as file:
                file.write(make())
            done = subprocess.run([ffd, "deform", source, target, "-q", "-l", lattice], check=False, timeout=120,
                                  capture_output=True)
            runs.append((code, what, source, target if done.returncode == 0 else None))
        said = [json.loads(line) for line in answers(node_folder, [path for run in runs for path in run[2:] if path])]
        found = {answer["path"]: answer for answer in said}
        for code, what, source, target in runs:
            wrong = judge(code, found[source], found[target] if target else None)
            rows.append((code, what, "deformed" if target else "refused", " ".join(found[source].get("codes", [])), wrong))
    with open(table, "w", encoding="utf-8") as file:
        file.writelines("\t".join(row) + "\n" for row in [("code", "file", "ffd", "codes", "wrong"), *rows])
    failed = [row for row in rows if row[-1]]
    for row in failed:
        print(f"{row[0]} ({row[1]}, {row[2]}): {row[-1]}")
    print(f"{len(rows)} files, {len(failed)} failed; {table}")
    sys.exit(1 if failed or not rows else 0)


main()
