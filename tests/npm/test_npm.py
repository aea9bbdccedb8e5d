#!/usr/bin/env python3
"""The package for npm, as data/packaging/npm.sh has made it, unpacked below a folder node_modules.

    test_npm.py FFD ROOT api|command|jobs|transform|page|firefox|types|files

FFD_NPM names the package's file; without it these tests are skipped. FFD_NODE names the folder whose node_modules holds what a
test takes from npm.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "view"))
from browser import find_browser, skip  # noqa: E402 (a neighbour of this folder)

HERE = os.path.dirname(os.path.abspath(__file__))
# Bytes that the modules may have: the core, and the program as a server sends it (gzip).
MOST_CORE, MOST_PROGRAM = 700_000, 1_600_000


def need(name):
    """The folder of a package that the tests take from npm."""
    folder = os.path.join(os.environ.get("FFD_NODE", ""), "node_modules", *name.split("/"))
    if not os.path.isdir(folder):
        skip(f"{name} is not installed (tests/run.sh installs it)")
    return folder


def unpack(folder):
    """Unpacks the package as npm does."""
    modules = os.path.join(folder, "node_modules")
    with tarfile.open(os.environ["FFD_NPM"]) as archive:
        archive.extractall(modules, filter="data") if hasattr(tarfile, "data_filter") else archive.extractall(modules)
    package = os.path.join(modules, "ffd-mesh")
    os.rename(os.path.join(modules, "package"), package)
    return package


def lend(name, package):
    """Makes a package of the tests one that is found from ours."""
    place = os.path.join(os.path.dirname(package), *name.split("/"))
    os.makedirs(os.path.dirname(place), exist_ok=True)
    os.symlink(need(name), place)


def check_files(package, root):
    """What the package consists of, its sizes, and that nothing in it tells of the machine that made it."""
    with open(os.path.join(package, "package.json"), encoding="utf-8") as file:
        facts = json.load(file)
    version = subprocess.run(["sed", "-n", 's/^#define FFD_VERSION "\\(.*\\)"$/\\1/p', os.path.join(root, "include/ffd/version.h")],
                             capture_output=True, text=True, check=True).stdout.strip()
    assert facts["version"] == version and os.path.basename(os.environ["FFD_NPM"]) == f"ffd-mesh-{version}.tgz"
    assert "dependencies" not in facts
    names = [os.path.join(base, name) for base, _, files in os.walk(package) for name in files]
    targets = [facts["bin"]["ffd-mesh"], "examples/index.html", "dist/ffd-mesh.js", "LICENSE", "README.md"]
    targets += [path for entry in facts["exports"].values() if isinstance(entry, dict) for path in entry.values()]
    for target in targets:
        assert os.path.isfile(os.path.join(package, target)), target
    with open(os.path.join(package, "THIRD-PARTY.md"), encoding="utf-8") as file:
        rows = re.findall(r"\| `([\w-]+\.txt)` \| ([^|]+) \|$", file.read(), flags=re.M)
    inside = {name for name, places in rows if places == "all" or "npm" in places.split(", ")}
    assert len(inside) > 10 and inside == set(os.listdir(os.path.join(package, "licenses")))
    for name in names:
        with open(name, "rb") as file:
            content = file.read()
        assert root.encode() not in content and b"/usr/share/emscripten" not in content, name
    core = os.path.getsize(os.path.join(package, "dist/core.wasm"))
    program = len(subprocess.run(["gzip", "-9nc", os.path.join(package, "dist/program.wasm")], capture_output=True, check=True).stdout)
    print(f"core.wasm {core} bytes, program.wasm {program} bytes by gzip")
    assert core <= MOST_CORE and program <= MOST_PROGRAM


def run_types(package, folder):
    compiler = need("typescript")
    lend("@gltf-transform/core", package)
    lend("property-graph", package)
    shutil.copy(os.path.join(HERE, "types.ts"), os.path.join(folder, "types.mts"))
    return subprocess.run(["node", os.path.join(compiler, "bin", "tsc"), "--noEmit", "--strict", "--target", "es2022", "--lib", "esnext,dom",
                           "--module", "nodenext", "types.mts"], cwd=folder, check=False).returncode


def run_page(package, folder, ffd, root, names):
    node, browser = find_browser(*names)
    shutil.copytree(package, os.path.join(folder, "package"))
    shutil.copy(os.path.join(root, "data/models/spot.obj"), folder)
    shutil.copy(os.path.join(root, "data/lattices/twist.json"), os.path.join(folder, "lattice.json"))
    subprocess.run([ffd, "deform", "spot.obj", "spot-out.obj", "-l", "lattice.json", "-q"], cwd=folder, check=True)
    return subprocess.run(["node", os.path.join(HERE, "page.mjs"), node, browser, folder], check=False,
                          env={**os.environ, "HOME": folder}).returncode


def main():
    ffd, root, what = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
    if not os.environ.get("FFD_NPM"):
        skip("the package was not made (tests/run.sh --all makes it where emscripten is)")
    with tempfile.TemporaryDirectory() as folder:
        package = unpack(folder)
        if what == "files":
            check_files(package, root)
            code = 0
        elif what == "types":
            code = run_types(package, folder)
        elif what == "jobs":
            code = subprocess.run([sys.executable, os.path.join(HERE, "..", "release", "run_jobs.py"), "--every", "7", "--without", "batch",
                                   "node", os.path.join(package, "bin", "ffd-mesh.mjs")], check=False).returncode
        elif what in ("page", "firefox"):
            code = run_page(package, folder, ffd, root, ("firefox-esr",) if what == "firefox" else ())
        else:
            if what == "transform":
                lend("@gltf-transform/core", package)
            code = subprocess.run(["node", os.path.join(HERE, what + ".mjs"), package, ffd, root], check=False).returncode
    sys.exit(code)


main()
