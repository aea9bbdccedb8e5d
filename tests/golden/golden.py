#!/usr/bin/env python3
"""The sample meshes through the sample lattices, by the program, against what golden.json remembers: counts,
bounds, largest displacement, digest of the output.

    golden.py FFD [--train] [--keep FOLDER]      --train rewrites golden.json: review its diff
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(os.path.dirname(os.path.dirname(HERE)), "data")
MEMORY = os.path.join(HERE, "golden.json")

# Lattices that fit around any mesh are used on all; the others on the mesh that they were made for.
FITTING = [["twist"], ["taper"], ["bulge"], ["bend"], ["wave"], ["local"], ["taper", "bend"]]
MADE_FOR = {"column.obj": [["bend-cylinder"], ["corner"]], "knight.glb": [["taller"], ["fatter"], ["lean"]],
            "banner_red.glb": [["wind"]]}
# One more run each for these.
OPTIONS = {
    "character.glb": [["--space", "mesh"], ["--normals", "keep"]],
    "keg_decorated.obj": [["--normals", "keep"]],
}


def cases():
    for mesh in sorted(os.listdir(os.path.join(DATA, "models"))):
        if not mesh.endswith((".obj", ".glb", ".gltf")):
            continue
        for lattices in FITTING + MADE_FOR.get(mesh, []):
            yield mesh, lattices, []
        for options in OPTIONS.get(mesh, []):
            yield mesh, ["twist"], options


def run(ffd, folder, mesh, lattices, options):
    """What is to be remembered of one run, or (as a string) what went wrong."""
    source = os.path.join(DATA, "models", mesh)
    target = os.path.join(folder, "-".join(lattices + [option.strip("-") for option in options] + [mesh]))
    command = [ffd, "deform", source, target, "--quiet", "--report", "-", *options]
    for lattice in lattices:
        command += ["-l", os.path.join(DATA, "lattices", lattice + ".json")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f"exit {done.returncode}: {done.stderr.strip()}"
    job = json.loads(done.stdout)["jobs"][0]
    with open(target, "rb") as file:
        content = file.read()
    with open(source, "rb") as file:
        if file.read() == content:
            return "the output is the input"
    return {
        "counts": {key: job[key] for key in
                   ("vertices", "inside", "outside", "multiple", "singular", "invalid", "moved")},
        "bounds": job["bounds"],
        "displacement": job["displacement"]["max"],
        "bytes": len(content),
        "sha256": hashlib.sha256(content).hexdigest(),
    }


def differences(name, before, now):
    if isinstance(now, str):
        yield f"{name}: {now}"
    elif before is None:
        yield f"{name}: nothing is remembered of it (--train)"
    else:
        for key in sorted(before.keys() | now.keys()):
            if before.get(key) != now.get(key):
                yield f"{name}: {key} was {json.dumps(before.get(key))}, is {json.dumps(now.get(key))}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("ffd")
    parser.add_argument("--train", action="store_true")
    parser.add_argument("--keep", metavar="FOLDER")
    arguments = parser.parse_args()

    results = {}
    with tempfile.TemporaryDirectory() as folder:
        if arguments.keep:
            folder = arguments.keep
            os.makedirs(folder, exist_ok=True)
        for mesh, lattices, options in cases():
            name = " ".join([mesh, *lattices, *options])
            results[name] = run(arguments.ffd, folder, mesh, lattices, options)

    failed = [f"{name}: {result}" for name, result in results.items() if isinstance(result, str)]
    if arguments.train:
        for line in failed:
            print(line)
        if failed:
            sys.exit("nothing remembered: not every run succeeded")
        with open(MEMORY, "w", encoding="ascii") as file:
            file.write(json.dumps(results, indent=1, sort_keys=True) + "\n")
        print(f"{len(results)} runs remembered")
        return

    with open(MEMORY, encoding="ascii") as file:
        memory = json.load(file)
    found = [line for name in sorted(results) for line in differences(name, memory.get(name), results[name])]
    found += [f"{name}: remembered, but no longer run (--train)" for name in sorted(memory.keys() - results.keys())]
    for line in found:
        print(line)
    print(f"{len(results)} runs compared, {len(found)} differences")
    sys.exit(1 if found or not results else 0)


if __name__ == "__main__":
    main()
