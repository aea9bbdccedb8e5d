#!/usr/bin/env python3
"""Deforms every glTF model of FFD_MODELS and of data/models, and holds input and output against the Khronos
glTF validator: the output has no error that the input did not have. A model that needs what this build does
not have is refused with exit 6, one that is not valid may be with exit 4, and neither leaves a file; every other
end is a failure.

    validate.py FFD TABLE [--beside-corpus]     TABLE: the outcome of every model is written there

--beside-corpus: but what corpus/test_corpus.py has the validator judge too, models of FFD_MODELS by a lattice.

FFD_NODE names the folder whose node_modules holds gltf-validator.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile

from jobs import deform_all

SKIPPED = 77
HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(os.path.dirname(os.path.dirname(HERE)), "data")
LATTICES = ("twist", "local")
MORPHS = "morphs"  # both as morph targets, with an animation: of every MORPHS_EACH-th model
MORPHS_EACH = 5
INVALID = 4
UNSUPPORTED = 6


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def models(root, endings=(".gltf", ".glb")):
    for folder, folders, names in os.walk(root):
        folders.sort()
        for name in sorted(names):
            if name.lower().endswith(endings):
                yield os.path.relpath(os.path.join(folder, name), root)


def find_packages(*packages):
    """The folder whose node_modules holds the packages; without them there is no test."""
    node_folder = os.environ.get("FFD_NODE", "")
    if not shutil.which("node"):
        skip("node is not there")
    for package in packages:
        if not os.path.isdir(os.path.join(node_folder, "node_modules", package)):
            skip(f"{package} is not installed (tests/run.sh installs it)")
    return node_folder


def answers(node_folder, paths):
    """The lines that validate.mjs has for the files, in JSON."""
    done = subprocess.run(["node", os.path.join(HERE, "validate.mjs"), node_folder], input="\n".join(paths),
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"the validator did not run: {done.stderr.strip()}")
    return done.stdout.splitlines()


def validate(node_folder, paths):
    """path -> list of (code, pointer), or a string where the validator itself gave up."""
    return dict(answer(line) for line in answers(node_folder, paths))


def answer(line):
    """What validate.mjs says of one file: its path, and its errors."""
    said = json.loads(line)
    return said["path"], said.get("failed") or [tuple(error) for error in said["errors"]]


def model_roots():
    roots = [os.path.join(DATA, "models")]
    if os.environ.get("FFD_MODELS"):
        roots.append(os.environ["FFD_MODELS"])
    return roots


def job(lattice, source, target):
    """A job of a manifest; the target's folder is made."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    paths = {name: os.path.join(DATA, "lattices", name + ".json") for name in LATTICES}
    if lattice == MORPHS:
        return {"in": source, "out": target, "morph": paths, "clip": "hop: 0 twist=1, 0.5 local=0.5, 1"}
    return {"in": source, "out": target, "lattice": paths[lattice]}


def judge(before, after):
    """'' where after has no error that before did not have, else what is new."""
    if isinstance(after, str):
        return "" if isinstance(before, str) else f"validator gave up: {after}"
    if isinstance(before, str):
        return ""
    new = sorted(set(after) - set(before))
    return "" if not new else f"{len(new)} new errors, first {new[0][0]} at {new[0][1]}"


def main():
    ffd, table, *options = sys.argv[1:]
    by_lattice = model_roots()[:1] if options == ["--beside-corpus"] else model_roots()
    node_folder = find_packages("gltf-validator")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        chosen = [(model, lattice, os.path.join(root, model), os.path.join(folder, str(number), lattice, model))
                  for number, root in enumerate(by_lattice) for model in models(root) for lattice in LATTICES]
        for number, root in enumerate(model_roots()):
            chosen += [(model, MORPHS, os.path.join(root, model), os.path.join(folder, str(number), MORPHS, model))
                       for model in list(models(root))[::MORPHS_EACH]]
        ended = deform_all(ffd, folder, [job(lattice, source, target) for _, lattice, source, target in chosen])
        runs = [(*one, *end) for one, end in zip(chosen, ended)]
        paths = sorted({source for _, _, source, _, _, _ in runs} |
                       {target for _, _, _, target, code, _ in runs if code == 0})
        found = validate(node_folder, paths)
        # Wherever a temporary folder is named, the table would differ from run to run.
        for model, lattice, source, target, code, message in runs:
            message = message.replace(source, model).replace(target, model).replace("\n", " | ")
            if code == 0:
                new = judge(found[source], found[target])
                known = found[source] if isinstance(found[source], str) else f"{len(found[source])} of its own"
                outcome = ("FAILED", new) if new else ("valid", f"errors: {known}")
            elif code == UNSUPPORTED and message and not os.path.exists(target):
                outcome = ("refused", message)
            elif code == INVALID and found[source] and message and not os.path.exists(target):
                outcome = ("invalid", message)
            else:
                outcome = ("FAILED", f"exit {code}: {message}")
            rows.append((model, lattice, *outcome))

    with open(table, "w", encoding="utf-8") as file:
        file.writelines("\t".join(row) + "\n" for row in [("model", "lattice", "outcome", "why"), *rows])
    failed = [row for row in rows if row[2] == "FAILED"]
    for row in failed:
        print("\t".join(row))
    counts = {what: sum(row[2] == what for row in rows) for what in ("valid", "refused", "invalid", "FAILED")}
    print(f"{len(rows)} runs: {', '.join(f'{count} {what}' for what, count in counts.items())}; {table}")
    if not os.environ.get("FFD_MODELS"):
        if not failed:
            skip("models: FFD_MODELS is not set: only data/models was looked at")
    sys.exit(1 if failed or not counts["valid"] else 0)


if __name__ == "__main__":
    main()
