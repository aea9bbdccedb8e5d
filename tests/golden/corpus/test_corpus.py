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
import collections
import dataclasses
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
import validate  # noqa: E402 (neighbours of this folder)
from jobs import SECONDS, deform_all  # noqa: E402

GLTF = (".gltf", ".glb")
ENDINGS = (*GLTF, ".obj", ".ply", ".off", ".stl")
PACKAGES = ("@gltf-transform/core", "@gltf-transform/extensions", "draco3dgltf", "meshoptimizer", "gltf-validator")
CHECKS = ("same", "only", "values", "valid", "equal")
UNMOVING = ("still", "beside")
LATTICES = ("twist", "bend", "part", "shared")
QUICK = ("twist", "part")
# In mesh space the field is the same, and only its place is another.
IN_MESH_SPACE = ("part", "shared")
# What is not valid is so by any lattice that moves all, or by one that moves some.
VALIDATED = ("twist", "part")
SHOWN = 3


class Service:
    """A program of node's that answers each line with a line. Lines may be sent before earlier ones are answered."""

    # So many lines, and what they are answered, go into pipes that nobody reads yet.
    MOST = 100

    def __init__(self, *command):
        self.process = subprocess.Popen(["node", "--max-semi-space-size=64", *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.waiting = collections.deque()

    def later(self, line, answered):
        """Sends a line; answered(answer) is called by settle, or before."""
        if len(self.waiting) >= self.MOST:
            self.settle()
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        self.waiting.append(answered)

    def settle(self):
        """Waits for all answers."""
        while self.waiting:
            answer = self.process.stdout.readline()
            if not answer:
                sys.exit(f"{self.process.args} ended early")
            self.waiting.popleft()(answer)

    def say(self, line):
        answers = []
        self.later(line, answers.append)
        self.settle()
        return answers[0]

    def ask(self, **request):
        return json.loads(self.say(json.dumps(request)))

    def close(self):
        self.process.stdin.close()
        self.process.wait()


@dataclasses.dataclass
class Job:
    """One run of the program: of a row's model, by a lattice in a space."""
    row: object
    space: str
    lattice: str
    target: str
    lattice_file: str
    name: str = dataclasses.field(init=False)
    code: int = 0
    message: str = ""

    def __post_init__(self):
        self.name = f"{self.lattice} in {self.space} space"


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
        self.asked = False  # the validator, for these

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
    # Models that are looked at together: their jobs are one batch.
    TOGETHER = 16
    # Of so many models one is deformed by a run of its own for each job.
    SINGLE = 8

    def __init__(self, ffd, root, folder, lattices, node_folder, keep=False):
        """lattices: of each space."""
        self.ffd, self.root, self.folder, self.lattices, self.keep = ffd, root, folder, lattices, keep
        self.judge = Service(os.path.join(HERE, "judge.mjs"))
        self.validator = Service(os.path.join(os.path.dirname(HERE), "validate.mjs"), node_folder)
        self.before = {}

    def rows(self, models):
        """The outcomes of the models, in their order."""
        for first in range(0, len(models), self.TOGETHER):
            yield from self.group(models[first:first + self.TOGETHER])

    def group(self, models):
        rows = [Row(model) for model in models]
        jobs = [[job for space in self.spaces(row.model) for job in self.jobs(row, space)] for row in rows]
        for own in jobs[::self.SINGLE]:
            for job in own:
                self.run(job)
        self.run_batch([job for number, own in enumerate(jobs) if number % self.SINGLE for job in own])
        for own in jobs:
            for job in own:
                self.look(job)
        self.settle()
        for row in rows:
            self.judge.ask(op="close", name=row.model)
        self.before = {}
        if not self.keep:
            shutil.rmtree(os.path.join(self.folder, "out"), ignore_errors=True)
        return rows

    def settle(self):
        """Waits for what is judged by others."""
        self.judge.settle()
        self.validator.settle()

    @staticmethod
    def spaces(model):
        return ("scene", "mesh") if model.endswith(GLTF) else ("scene",)

    def source(self, model):
        return os.path.join(self.root, model)

    def jobs(self, row, space):
        """Writes lattices for the model, and names what is to be done with them."""
        place = os.path.join(self.folder, "out", row.model, space)
        os.makedirs(place)
        opened = self.open(row.model, space, place)
        if "problem" in opened:
            row.note("values", space, [opened["problem"]])
            return
        for lattice in (*UNMOVING, *self.lattices[space]):
            target = os.path.join(place, lattice, os.path.basename(row.model))
            os.mkdir(os.path.dirname(target))
            yield Job(row, space, lattice, target, os.path.join(place, f"{lattice}.json"))

    def open(self, model, space, place):
        request = {"op": "open", "name": model, "space": space, "folder": place}
        if model in expected.REFUSED:
            # It is not to be read: lattices of whatever box.
            shape = text_change.Shape(text_change.DOUBLE)
            shape.positions = [[0, 0, 0], [1, 1, 1]]
            return self.judge.ask(kind="points", **request, **self.points(shape))
        if model.endswith(GLTF):
            return self.judge.ask(kind="gltf", file=self.source(model), **request)
        return self.judge.ask(kind="points", **request, **self.points(self.shape(model)))

    def shape(self, model):
        """A model that is text, or like text."""
        if model not in self.before:
            self.before[model] = text_change.read(self.source(model))
        return self.before[model]

    def gltf(self, model):
        if model not in self.before:
            self.before[model] = gltf_change.Gltf(self.source(model))
        return self.before[model]

    def points(self, shape, name=None):
        """What the judge is told of a shape; the numbers are in a file."""
        path = name or os.path.join(self.folder, "points")
        with open(path, "wb") as file:
            shape.points().tofile(file)
        return {"file": path, "count": len(shape.positions), "precision": shape.precision}

    def run(self, job):
        source = self.source(job.row.model)
        command = [self.ffd, "deform", source, job.target, "--quiet", "-l", job.lattice_file, "--space", job.space]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=SECONDS)
        self.ran(job, done.returncode, done.stderr.strip())

    def run_batch(self, jobs):
        ended = deform_all(self.ffd, self.folder, [
            {"in": self.source(job.row.model), "out": job.target, "lattice": job.lattice_file,
             "options": {"space": job.space}} for job in jobs])
        for job, (code, message) in zip(jobs, ended):
            self.ran(job, code, message)

    def ran(self, job, code, message):
        job.code, job.message = code, message.replace(self.source(job.row.model), job.row.model)

    def look(self, job):
        row, model = job.row, job.row.model
        refusal = expected.REFUSED.get(model) or (expected.REFUSED_IN_SCENE.get(model) if job.space == "scene" else None)
        if refusal and not (job.lattice == "beside" and model in expected.FINE_BESIDE):
            self.refusal(row, job, refusal)
        elif job.code != 0:
            row.note("same" if job.lattice in UNMOVING else "only", job.name, [f"exit {job.code}: {job.message}"])
        elif job.lattice in UNMOVING:
            row.note("same", job.name, self.not_same(model, job.target))
        else:
            self.deformed(row, job)

    def refusal(self, row, job, refusal):
        wanted, word, reason = refusal
        if job.code != wanted or word not in job.message or "\n" in job.message or os.path.exists(job.target):
            row.note("only", job.name, [f"exit {job.code} ({job.message}) where {wanted} was due: {reason}"])
        elif reason not in " ".join(row.refused):
            row.refused.append(f"exit {job.code}: {reason}")

    def not_same(self, model, target):
        if model.endswith(GLTF):
            return gltf_change.not_same(self.gltf(model), target)
        with open(self.source(model), "rb") as before, open(target, "rb") as after:
            return [] if before.read() == after.read() else ["the file differs"]

    def deformed(self, row, job):
        judged = {"file": job.target}
        if row.model.endswith(GLTF):
            # First, so that the others work while this one does.
            if job.lattice in VALIDATED:
                self.validate(row, job)
            self.ask_judge(row, job, judged)
            row.note("only", job.name, gltf_change.changes(self.gltf(row.model), job.target))
            return
        before = self.shape(row.model)
        after = text_change.read(job.target, before)
        judged = self.points(after, job.target + ".points")
        self.ask_judge(row, job, judged)
        row.note("only", job.name, text_change.changes(before, after))

    def ask_judge(self, row, job, judged):
        self.judge.later(json.dumps({"op": "judge", "name": row.model, "space": job.space, "lattice": job.lattice, **judged}),
                         lambda answer: self.judged(row, job, json.loads(answer)))

    @staticmethod
    def judged(row, job, answer):
        if "problem" in answer:
            row.note("values", job.name, [answer["problem"]])
            return
        row.runs += 1
        row.values += sum(answer["count"].values())
        row.skipped += sum(answer["skipped"].values())
        row.worst = max(row.worst, answer["worst"])
        row.note("values", job.name, counted(answer))
        row.note("equal", job.name, counted(answer["groups"]))

    def validate(self, row, job):
        def of_source(line):
            row.own_errors = validate.answer(line)[1]

        def of_target(line):
            new = validate.judge(row.own_errors, validate.answer(line)[1])
            row.note("valid", job.name, [new] if new else [])

        if not row.asked:
            row.asked = True
            self.validator.later(self.source(row.model), of_source)
        self.validator.later(job.target, of_target)

    def close(self):
        across = self.judge.ask(op="across")
        self.judge.close()
        self.validator.close()
        return across


def counted(answer):
    """The failures that are shown, and how many there are."""
    return [f"{answer['failed']} wrong, first {answer['failures'][0]}"] if answer["failed"] else []


def requirements():
    """The folders of the models and of the packages; without them there is nothing to run."""
    root = os.environ.get("FFD_MODELS", "")
    if not root:
        validate.skip("models: FFD_MODELS is not set")
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

    lattices = {"scene": QUICK, "mesh": QUICK} if arguments.quick else {"scene": LATTICES, "mesh": IN_MESH_SPACE}
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or temporary
        corpus = Corpus(arguments.ffd, root, folder, lattices, node_folder,
                        bool(arguments.keep))
        rows = [told(row) for row in corpus.rows(chosen)]
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
