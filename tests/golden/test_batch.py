#!/usr/bin/env python3
"""Jobs of a batch that share meshes, lattices and u,v,w with their neighbours come out as if each were run by itself:
the same bytes, the same figures, the same failures.

    test_batch.py FFD SOURCE [SEED]
"""

import concurrent.futures
import glob
import itertools
import json
import os
import random
import subprocess
import sys
import tempfile

ENDINGS = (".obj", ".gltf", ".glb", ".ply", ".off", ".stl")
OPTIONS = [{}, {}, {"normals": "keep"}, {"normals": "recompute"}, {"outside": "extend"}, {"space": "mesh"},
           {"as-morph": "bent"}]
MODELS = 40
JOBS = 5  # on each
# A sanitizer makes a start of the program take ten times as long; other models come next time.
MODELS_SANITIZED = 10


def find_models(source, most):
    own = glob.glob(os.path.join(source, "data", "models", "*"))
    samples = glob.glob(os.path.join(os.environ.get("FFD_MODELS", "/nowhere"), "**", "*"), recursive=True)
    models = sorted(path for path in samples if path.lower().endswith(ENDINGS) and os.path.getsize(path) < 2e6)
    return sorted(path for path in own if path.endswith(ENDINGS)) + random.sample(models, min(most, len(models)))


def write_lattices(folder):
    """Three of one rest volume, in and out of which vertices may be, and one of another."""
    paths = []
    for k in range(4):
        lattice = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4 + k // 3],
                   "rest": {"box": "mesh", "margin": 0 if k == 3 else 0.1}, "units": "box",
                   "moves": [{"at": [k % 3, 1, 2], "by": [0.1, 0.05 * k, -0.07]},
                             {"at": [2, 2, 1], "by": [0.1 * k, 0.02, 0.03]}]}
        paths.append(os.path.join(folder, f"{k}.json"))
        with open(paths[-1], "w", encoding="ascii") as file:
            json.dump(lattice, file)
    return paths


def make_jobs(models, lattices):
    jobs = []
    for number, model in enumerate(models):
        for k in range(JOBS):
            chosen = [random.choice(lattices)] if random.random() < 0.8 else random.sample(lattices, 2)
            options = random.choice(OPTIONS)
            if "as-morph" in options and not model.endswith((".glb", ".gltf")):
                options = {}
            # A folder a model: two with material libraries of one name would be refused in one.
            jobs.append((model, f"{number}/{k}{os.path.splitext(model)[1]}", chosen, options))
    return jobs


def run_batch(ffd, folder, jobs):
    manifest, report = os.path.join(folder, "jobs.jsonl"), os.path.join(folder, "report.json")
    with open(manifest, "w", encoding="utf-8") as file:
        for model, out, lattices, options in jobs:
            file.write(json.dumps({"in": model, "out": "batch/" + out, "lattice": lattices, "options": options}) + "\n")
    command = [ffd, "batch", manifest, "-j", "2", "-q", "--report", report, "--report-stable", "--journal",
               os.path.join(folder, "journal")]
    subprocess.run(command, stderr=subprocess.PIPE, check=False, timeout=600)
    with open(report, encoding="utf-8") as file:
        return json.load(file)["jobs"]


def run_alone(ffd, folder, job):
    model, out, lattices, options = job
    command = [ffd, "deform", model, os.path.join(folder, "alone", out), "-q", "--threads", "1", "--report", "-",
               "--report-stable"]
    for lattice in lattices:
        command += ["-l", lattice]
    for name, value in options.items():
        command += ["--" + name, value]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, timeout=120)
    return json.loads(done.stdout)["jobs"][0]


def compare_folders(folder):
    """Also the buffers and images that are beside outputs."""
    names = {}
    for side in ("batch", "alone"):
        top = os.path.join(folder, side)
        names[side] = sorted(os.path.relpath(os.path.join(path, name), top)
                             for path, _, found in os.walk(top) for name in found)
    findings = [] if names["batch"] == names["alone"] else [f"other files: {set(names['batch']) ^ set(names['alone'])}"]
    for name in set(names["batch"]) & set(names["alone"]):
        with open(os.path.join(folder, "batch", name), "rb") as a, open(os.path.join(folder, "alone", name), "rb") as b:
            if a.read() != b.read():
                findings.append(f"{name}: other bytes")
    return findings, len(names["alone"])


def main():
    ffd, source = (os.path.abspath(path) for path in sys.argv[1:3])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(1 << 30)
    print(f"seed {seed}")
    random.seed(seed)
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        for side in ("batch", "alone"):
            os.mkdir(os.path.join(folder, side))
        with open(ffd, "rb") as program:
            most = MODELS_SANITIZED if b"__asan_init" in program.read() else MODELS
        jobs = make_jobs(find_models(source, most), write_lattices(folder))
        for side, (_, out, _, _) in itertools.product(("batch", "alone"), jobs):
            os.makedirs(os.path.join(folder, side, os.path.dirname(out)), exist_ok=True)
        entries = run_batch(ffd, folder, jobs)
        if len(entries) != len(jobs):
            findings.append(f"{len(entries)} entries of {len(jobs)} jobs")
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = list(pool.map(lambda job: run_alone(ffd, folder, job), jobs))
        for number, (job, entry, alone) in enumerate(zip(jobs, entries, runs)):
            if entry.pop("line") != number + 1 or entry.pop("output") != "batch/" + job[1]:
                findings.append(f"{job}: the entry of another job")
            alone.pop("output")
            alone["outputs"] = [name.replace(os.path.join(folder, "alone"), "batch") for name in alone["outputs"]]
            for side in (entry, alone):
                side["error"] = side["error"] and side["error"].replace(os.path.join(folder, "alone"), "batch")
                side["error"] = side["error"] and side["error"].replace(os.path.join(folder, "batch"), "batch")
            findings += [f"{job}: {key} is {entry.get(key)}, alone {alone[key]}" for key in alone
                         if entry.get(key) != alone[key]]
        done = sum(entry["status"] == "ok" for entry in entries)
        different, files = compare_folders(folder)
        findings += different
    for finding in findings:
        print(finding)
    print(f"{len(jobs)} jobs, {done} done, {files} files compared, {len(findings)} findings")
    sys.exit(1 if findings or done < len(jobs) / 2 else 0)


main()
