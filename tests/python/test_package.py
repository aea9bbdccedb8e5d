#!/usr/bin/env python3
"""Builds the Python package as a wheel, installs it in a fresh environment, and runs the cases (case_*.py) there.

    test_package.py SOURCE BUILD-FOLDER CC CXX [--peers | --torch] [CASE...]       CASE: as unittest names it, "case_results.Bits"

--peers: instead peers.py, with the wheels of peers.txt too, which are in .build-test/peers (FFD_PEERS names another folder); its
cases, and the speeds with one processor and with two.

--torch: instead case_torch.py, in a Python of the machine that has torch and numpy, to which the content of the wheel is lent. Skipped
where there is none.

All that it installs are the wheels of requirements.txt, which .ci/setup has fetched to .build-test/wheels (FFD_WHEELS names
another folder): no index is asked. Without them, or with another Python than they are for, it is skipped. Those of others.txt are
installed too where they have been fetched: cases that need pyvista are skipped without it.
"""

import filecmp
import glob
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
SKIPPED = 77


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def run(*command, **more):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL,
                          check=False, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\nended with {done.returncode}:\n{done.stdout[-20000:]}")
    return done.stdout


def make_environment(folder, lists):
    """A fresh environment that has the pinned wheels of lists, each with its folder; returns its Python."""
    run(sys.executable, "-m", "venv", folder)
    python = os.path.join(folder, "bin", "python")
    pip = [python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-compile", "--disable-pip-version-check"]
    for name, wheels in lists.items():
        tried = subprocess.run([*pip, "--require-hashes", "--find-links", wheels, "-r", os.path.join(HERE, name)],
                               capture_output=True, text=True, check=False)
        if tried.returncode != 0 and "No matching distribution" in tried.stderr:
            skip(f"wheels: the pinned ones are not for Python {sys.version.split()[0]} here")
        if tried.returncode != 0:
            sys.exit(tried.stderr)
    return python, pip


def flags(build):
    """The compilers' flags of a build folder, as variables: what was compiled there need not be compiled again."""
    with open(os.path.join(build, "meson-info", "intro-buildoptions.json"), encoding="utf-8") as file:
        options = {option["name"]: option["value"] for option in json.load(file)}
    return {"CFLAGS": shlex.join(options["c_args"]), "CXXFLAGS": shlex.join(options["cpp_args"])}


def build_wheel(python, source, build, folder, compilers, name):
    """The wheel, and the folder of what it was compiled to, which stays by this name beside the build folder for the next time."""
    kept = os.path.join(os.path.dirname(os.path.abspath(build)), name)
    environment = dict(os.environ, PATH=os.path.dirname(python) + os.pathsep + os.environ["PATH"], CC=compilers[0], CXX=compilers[1],
                       **flags(build))
    if os.path.isdir(kept):  # the environment that it was set up with is gone
        shutil.rmtree(kept)
    run(python, "-m", "pip", "wheel", "--no-index", "--no-build-isolation", "--no-deps", "--disable-pip-version-check",
        f"--config-settings=build-dir={kept}", "-w", folder, source, env=environment)
    (wheel,) = glob.glob(os.path.join(folder, "*.whl"))
    return wheel, kept


def check_program(python, kept, folder):
    """A build with the package has a program too, which needs nothing of the package: also where both were moved."""
    root, moved = os.path.join(folder, "root"), os.path.join(folder, "moved")
    run(os.path.join(os.path.dirname(python), "meson"), "install", "-C", kept, "--destdir", root)
    os.rename(root, moved)
    (program,) = glob.glob(os.path.join(moved, "**", "bin", "ffd"), recursive=True)
    for package in glob.glob(os.path.join(moved, "**", "ffd_mesh"), recursive=True):
        shutil.rmtree(package)
    mesh = os.path.join(folder, "empty.gltf")
    with open(mesh, "w", encoding="ascii") as file:
        file.write('{"asset": {"version": "2.0"}}')
    run(program, "info", mesh)
    shutil.rmtree(moved)


def folder_of(source, variable, name):
    """The folder of wheels that .ci/setup fetches, or that the variable names."""
    return os.environ.get(variable) or os.path.join(source, ".build-test", name)


def is_fetched(wheels, name):
    """Whether a folder has all wheels of a list, as it is now."""
    kept = os.path.join(wheels, name)
    return os.path.exists(kept) and filecmp.cmp(kept, os.path.join(HERE, name), shallow=False)


def fetched(source, variable, name):
    """The folder of wheels that .ci/setup has fetched, or that the variable names."""
    wheels = folder_of(source, variable, name)
    if not glob.glob(os.path.join(wheels, "*.whl")):
        skip(f"wheels: none in {wheels}: .ci/setup could not fetch them")
    return wheels


def run_cases(python, chosen, folder, environment):
    """The exit code of the cases."""
    durations = ["--durations=5"] if sys.version_info >= (3, 12) else []
    return subprocess.run([python, "-m", "unittest", *(chosen or ["discover", "-s", HERE, "-p", "case_*.py"]), *durations],
                          cwd=folder, env=environment, stdin=subprocess.DEVNULL, check=False).returncode


def run_peers(python, chosen, folder, environment):
    """The same of the peers, and how fast they are."""
    code = run_cases(python, chosen or ["peers"], folder, environment)
    if code == 0 and not chosen:
        for processors in ("0", "0,1"):
            print(run("taskset", "-c", processors, python, os.path.join(HERE, "peers.py"), cwd=folder, env=environment), end="")
    return code


def find_torch():
    """A Python of this machine that has torch."""
    for python in (sys.executable, "/usr/bin/python3"):
        if os.path.exists(python) and subprocess.run([python, "-c", "import torch, numpy"], capture_output=True, check=False).returncode == 0:
            return python
    return skip("torch: no Python of this machine has it (Debian: python3-torch)")


def run_torch(python, wheel, folder, environment, chosen):
    """The exit code of the cases of torch."""
    package = os.path.join(folder, "package")
    with zipfile.ZipFile(wheel) as file:
        file.extractall(package)
    environment = environment | {"PYTHONPATH": os.pathsep.join((environment["PYTHONPATH"], package))}
    return run_cases(python, chosen or ["case_torch"], folder, environment)


def main():
    source, build, cc, cxx, *chosen = sys.argv[1:]
    peers, beside_torch = chosen[:1] == ["--peers"], chosen[:1] == ["--torch"]
    chosen = chosen[1:] if peers or beside_torch else chosen
    other = find_torch() if beside_torch else None
    lists = {"requirements.txt": fetched(source, "FFD_WHEELS", "wheels")}
    others = folder_of(source, "FFD_OTHERS", "others")
    if not peers and not beside_torch and is_fetched(others, "others.txt"):
        lists["others.txt"] = others
    if peers:
        lists["peers.txt"] = fetched(source, "FFD_PEERS", "peers")
    with tempfile.TemporaryDirectory() as folder:
        python, pip = make_environment(os.path.join(folder, "venv"), lists)
        wheel, kept = build_wheel(python, source, build, os.path.join(folder, "dist"), (cc, cxx),
                                  ".build-python-torch" if beside_torch else ".build-python")
        if "-cp311-abi3-" not in wheel:
            sys.exit(f"{os.path.basename(wheel)} is not for every CPython from 3.11 on")
        run(*pip, wheel)
        if not peers and not beside_torch and not chosen:
            check_program(python, kept, folder)
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        environment |= {"FFD_SOURCE": source, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": HERE, "TMPDIR": folder}
        if beside_torch:
            code = run_torch(other, wheel, folder, environment, chosen)
        else:
            code = (run_peers if peers else run_cases)(python, chosen, folder, environment)
    sys.exit(1 if code else 0)


if __name__ == "__main__":
    main()
