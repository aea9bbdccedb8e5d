#!/usr/bin/env python3
"""What a build of `ffd` gives, a line for each job: its exit code, a hash of the files that it writes, and one of its report and
what it says.

    hashes.py --ffd PATH [--models DIR] [--every N] OUT.txt

For changes that may change nothing: made once with the build before and once with the one after, `diff` names the jobs that
differ. The jobs are every model (those of data/models, and of DIR) with every lattice of data/lattices, from its format to each
other one, with each option that changes results, and everything else that is made of it: reports, embeddings, derivatives,
positions, pages, pictures. Nothing in it depends on the folder, the time or the machine.
"""

import argparse
import concurrent.futures
import hashlib
import os
import shutil
import subprocess
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FORMATS = ("obj", "gltf", "glb", "ply", "off", "stl")
LARGEST = 30_000_000  # bytes of a model
# Small enough for a matrix of derivatives, and for pictures of every model.
SMALL = 1_000_000
REPORT = ("--report", "report.json", "--report-stable")
OPTIONS = (("--outside", "extend"), ("--outside", "extend", "--falloff", "0.5"), ("--snap", "1e-3r"), ("--normals", "recompute"),
           ("--normals", "keep"), ("--space", "mesh"), ("--rig", "follow"), ("--as-morph", "bent"), ("--strict",),
           ("--resources", "reference"), ("--fail-on", "folds,outside,multiple,singular,invalid,tear,flipped,edges=4"))


def models(folders):
    """Name and path of each, without what belongs to another file."""
    found = []
    for number, folder in enumerate(folders):
        for parent, _, names in os.walk(folder):
            found += [(f"{number}/{os.path.relpath(os.path.join(parent, name), folder)}", os.path.join(parent, name)) for name in names
                      if name.lower().rpartition(".")[2] in (*FORMATS, "vrm")]
    return sorted((name, path) for name, path in found if os.path.getsize(path) <= LARGEST)


def jobs(model, lattices, size):
    """Words of each job of a model, which lies in the folder `models`; outputs go to the folder `out`."""
    source, ending = "models/" + model, model.rpartition(".")[2]
    out, first = "out/" + os.path.basename(model), lattices[0]
    yield "info", source, "--json", "--parts"
    yield "deform", source, out, "-l", first, *REPORT
    for lattice in lattices[1:]:
        yield "deform", source, out, "-l", lattice
    yield "deform", source, out, "-l", first, "-l", lattices[1], *REPORT
    yield "deform", source, out, "--blocks", "-l", first, "-l", lattices[1], *REPORT
    for target in FORMATS:
        if target != ending:
            yield "deform", source, "out/to." + target, "-l", first, *REPORT
    for option in OPTIONS:
        yield "deform", source, out, "-l", first, *option, *REPORT
    for lattice in lattices:
        yield "check", source, "-l", lattice, *REPORT
    yield "embed", source, "-l", first, "-o", "out/e.npy", "--status", "out/s.npy"
    yield "lattice", "new", source, "--size", "4,4,4", "-o", "out/l.json"
    if size > SMALL:
        return
    yield "jacobian", source, "-l", first, "-o", "out/j.npz"
    yield "compare", source, source
    yield "view", source, "-l", first, "-o", "out/v.html"
    yield "view", source, "-l", first, "-o", "out/v.png", "--size", "200x150"


def digest(folder, done):
    """The exit code, a hash of the files, and one of the report and all that was said."""
    files, words = hashlib.sha256(), hashlib.sha256(done.stdout + b"\0" + done.stderr)
    for parent, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = os.path.join(parent, name)
            found = words if name == "report.json" else files
            found.update(os.path.relpath(path, folder).encode() + b"\0")
            with open(path, "rb") as file:
                found.update(file.read())
    return f"{done.returncode} {files.hexdigest()[:20]} {words.hexdigest()[:20]}"


def hashes(ffd, model, path, lattices):
    """A line for each job of a model."""
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(os.path.join(folder, "models", os.path.dirname(os.path.dirname(model))), exist_ok=True)
        # The whole folder, for a model may name others.
        os.symlink(os.path.dirname(path), os.path.join(folder, "models", os.path.dirname(model)))
        os.symlink(os.path.join(ROOT, "data", "lattices"), os.path.join(folder, "lattices"))
        made = os.path.join(folder, "out")
        for words in jobs(model, lattices, os.path.getsize(path)):
            shutil.rmtree(made, ignore_errors=True)
            os.makedirs(made)
            if os.path.exists(os.path.join(folder, "report.json")):
                os.remove(os.path.join(folder, "report.json"))
            done = subprocess.run([ffd, *words, *(["-j1"] if words[0] in ("deform", "check", "view") else [])], cwd=folder,
                                  capture_output=True, check=False)
            if os.path.exists(os.path.join(folder, "report.json")):
                os.replace(os.path.join(folder, "report.json"), os.path.join(made, "report.json"))
            lines.append(f"{digest(made, done)} {' '.join(words)}\n")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ffd", required=True, type=os.path.abspath)
    parser.add_argument("--models", type=os.path.abspath, help="more models")
    parser.add_argument("--every", type=int, default=1, help="every Nth model only")
    parser.add_argument("output")
    arguments = parser.parse_args()
    folders = [os.path.join(ROOT, "data", "models"), *([arguments.models] if arguments.models else [])]
    lattices = sorted("lattices/" + name for name in os.listdir(os.path.join(ROOT, "data", "lattices")) if name.endswith(".json"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool, open(arguments.output, "w", encoding="utf-8") as output:
        for lines in pool.map(lambda model: hashes(arguments.ffd, *model, lattices), models(folders)[:: arguments.every]):
            output.writelines(lines)


if __name__ == "__main__":
    main()
