#!/usr/bin/env python3
"""Every model of FFD_MODELS through the program, in scene and in mesh space, and what came out judged by readers
and arithmetic that are not the program's:

  same      a lattice that moves nothing, or holds nothing of the model, gives the file, byte for byte
  only      a deformation changed only what it may: JSON value by value, buffers byte by byte, text line by line
  values    positions, normals, tangents, morph targets are those of the definitions (volume.mjs, expect.mjs)
  valid     the Khronos validator finds no error that the input did not have
  equal     equal positions under equal transforms stayed equal, in the model and across the models

    test_corpus.py FFD TABLE [--quick] [--only TEXT] [--keep FOLDER]

TABLE: the outcome of every model is written there. FFD_NODE names the folder whose node_modules holds the packages."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

import expected
import gltf_change
import text_change

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import validate  # noqa: E402 (a neighbour of this folder)

GLTF = (".gltf", ".glb")
ENDINGS = (*GLTF, ".obj", ".ply", ".off", ".stl")
PACKAGES = ("@gltf-transform/core", "@gltf-transform/extensions", "draco3dgltf", "meshoptimizer", "gltf-validator")
CHECKS = ("same", "only", "values", "valid", "equal")
UNMOVING = ("still", "beside")
LATTICES = ("twist", "bend", "part", "shared")
SECONDS = 120
SHOWN = 3


class Service:
    """A program of node's that answers each line with a line."""

    def __init__(self, *command):
        self.process = subprocess.Popen(["node", *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"{self.process.args} ended early")
        return answer

    def ask(self, **request):
        return json.loads(self.say(json.dumps(request)))

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Row:
    """The outcome of one model: for each check what is wrong; refusals; how much was judged."""

    def __init__(self, model):
        self.model = model
        self.wrong = {check: [] for check in CHECKS}
        self.refused = []
        self.values = 0
        self.skipped = 0
        self.worst = 0.0
        self.runs = 0
        self.own_errors = None

    def note(self, check, run, lines):
        lines = list(lines)
        more = [f"{run}: {len(lines) - SHOWN} more"] if len(lines) > SHOWN else []
        self.wrong[check] += [f"{run}: {line}" for line in lines[:SHOWN]] + more

    def cells(self):
        outcome = ["FAILED" if self.wrong[check] else "refused" if self.refused and not self.runs else "ok"
                   for check in CHECKS]
        errors = "" if self.own_errors is None else \
            self.own_errors if isinstance(self.own_errors, str) else str(len(self.own_errors))
        return [self.model, *outcome, errors, str(self.values), str(self.skipped), f"{self.worst:.2f}", "; ".join(self.refused)]

    def failures(self):
        return [f"{check}: {line}" for check in CHECKS for line in self.wrong[check]]


class Corpus:
    def __init__(self, ffd, root, folder, lattices, node_folder):
        self.ffd, self.root, self.folder, self.lattices = ffd, root, folder, lattices
        self.judge = Service(os.path.join(HERE, "judge.mjs"))
        self.validator = Service(os.path.join(os.path.dirname(HERE), "validate.mjs"), node_folder)

    def run(self, model, space, lattice, target):
        source = os.path.join(self.root, model)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        command = [self.ffd, "deform", source, target, "--quiet", "-l", os.path.join(self.folder, f"{lattice}.json"),
                   "--space", space]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS)
        return done.returncode, done.stderr.strip().replace(source, model)

    def model(self, model):
        row = Row(model)
        for space in ("scene", "mesh") if model.endswith(GLTF) else ("scene",):
            self.space(row, model, space)
        return row

    def errors(self, path):
        return validate.answer(self.validator.say(path))[1]

    def close(self):
        across = self.judge.ask(op="across")
        self.judge.close()
        self.validator.close()
        return across

    def open(self, model, space):
        source = os.path.join(self.root, model)
        if model.endswith(GLTF):
            return self.judge.ask(op="open", kind="gltf", file=source, name=model, space=space, folder=self.folder)
        points = os.path.join(self.folder, "before.json")
        with open(points, "w", encoding="ascii") as file:
            json.dump(text_change.read(source).points(), file)
        return self.judge.ask(op="open", kind="points", file=points, name=model, space=space, folder=self.folder)

    def space(self, row, model, space):
        refusal = expected.REFUSED.get(model) or (expected.REFUSED_IN_SCENE.get(model) if space == "scene" else None)
        opened = self.open(model, space) if model not in expected.REFUSED else self.any_lattices()
        if "problem" in opened:
            row.note("values", space, [opened["problem"]])
            return
        for lattice in (*UNMOVING, *self.lattices):
            name = f"{lattice} in {space} space"
            target = os.path.join(self.folder, "out", space, lattice, os.path.basename(model))
            shutil.rmtree(os.path.dirname(target), ignore_errors=True)
            code, message = self.run(model, space, lattice, target)
            if refusal and not (lattice == "beside" and model in expected.FINE_BESIDE):
                self.refusal(row, name, refusal, code, message, target)
            elif code != 0:
                row.note("same" if lattice in UNMOVING else "only", name, [f"exit {code}: {message}"])
                if lattice == "still":
                    break
            elif lattice in UNMOVING:
                row.note("same", name, self.not_same(model, target))
            else:
                self.deformed(row, name, model, lattice, target)

    def any_lattices(self):
        """For a model that is not to be read: lattices of whatever box."""
        points = os.path.join(self.folder, "before.json")
        with open(points, "w", encoding="ascii") as file:
            json.dump({"positions": [[0, 0, 0], [1, 1, 1]], "precision": "double", "corners": []}, file)
        return self.judge.ask(op="open", kind="points", file=points, name="", space="scene", folder=self.folder)

    def refusal(self, row, name, refusal, code, message, target):
        wanted, word, reason = refusal
        if code != wanted or word not in message or "\n" in message or os.path.exists(target):
            row.note("only", name, [f"exit {code} ({message}) where {wanted} was due: {reason}"])
        elif reason not in " ".join(row.refused):
            row.refused.append(f"exit {code}: {reason}")

    def not_same(self, model, target):
        source = os.path.join(self.root, model)
        if model.endswith(GLTF):
            return gltf_change.not_same(source, target)
        with open(source, "rb") as before, open(target, "rb") as after:
            return [] if before.read() == after.read() else ["the file differs"]

    def deformed(self, row, name, model, lattice, target):
        source = os.path.join(self.root, model)
        judged = target
        if model.endswith(GLTF):
            row.note("only", name, gltf_change.changes(source, target))
            row.own_errors = self.errors(source) if row.own_errors is None else row.own_errors
            new = validate.judge(row.own_errors, self.errors(target))
            row.note("valid", name, [new] if new else [])
        else:
            before, after = text_change.read(source), text_change.read(target)
            row.note("only", name, text_change.changes(before, after))
            judged = os.path.join(self.folder, "after.json")
            with open(judged, "w", encoding="ascii") as file:
                json.dump(after.points(), file)
        answer = self.judge.ask(op="judge", lattice=lattice, file=judged)
        if "problem" in answer:
            row.note("values", name, [answer["problem"]])
            return
        row.runs += 1
        row.values += sum(answer["count"].values())
        row.skipped += sum(answer["skipped"].values())
        row.worst = max(row.worst, answer["worst"])
        row.note("values", name, counted(answer))
        row.note("equal", name, counted(answer["groups"]))


def counted(answer):
    """The failures that are shown, and how many there are."""
    return [f"{answer['failed']} wrong, first {answer['failures'][0]}"] if answer["failed"] else []


def requirements():
    """The folders of the models and of the packages; without them there is nothing to run."""
    root = os.environ.get("FFD_MODELS", "")
    if not root:
        validate.skip("FFD_MODELS is not set")
    return root, validate.find_packages(*PACKAGES)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("ffd")
    parser.add_argument("table")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    root, node_folder = requirements()
    chosen = [model for model in validate.models(root, ENDINGS) if arguments.only in model]
    if arguments.quick:
        chosen = [model for model in chosen if model in expected.QUICK]

    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or temporary
        corpus = Corpus(arguments.ffd, root, folder, LATTICES[::2] if arguments.quick else LATTICES, node_folder)
        rows = [told(corpus.model(model)) for model in chosen]
        across = corpus.close()
    sys.exit(report(arguments.table, rows, across))


def told(row):
    """Says what is wrong with a model as soon as it is known."""
    if row.failures():
        print("\n    ".join([row.model, *row.failures()]), flush=True)
    return row


def report(table, rows, across):
    with open(table, "w", encoding="utf-8") as file:
        head = ["model", *CHECKS, "errors of its own", "values", "left to rounding", "worst error / allowed", "refused"]
        file.writelines("\t".join(cells) + "\n" for cells in [head, *(row.cells() for row in rows)])
    failed = [row for row in rows if row.failures()]
    for line in across["failures"]:
        print(f"across files: {line}")
    refused = sum(bool(row.refused) and not row.runs for row in rows)
    print(f"{len(rows)} models: {len(rows) - len(failed) - refused} ok, {refused} refused as expected, "
          f"{len(failed)} FAILED; {sum(row.values for row in rows)} values, "
          f"{across['compared']} equal positions across files, {across['failed']} of them apart; {table}")
    return 1 if failed or across["failed"] or not rows else 0


if __name__ == "__main__":
    main()
