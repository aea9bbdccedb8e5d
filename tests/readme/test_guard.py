#!/usr/bin/env python3
"""The example projects of data/guard, each with the real tool: they pass, they pass when rounding alone differs, and
they fail, with the reason, when the deformation or the golden file is another.

    test_guard.py FFD SOURCE
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

LATTICE = "lattices/twist.json"
GOLDEN = "guard/banner.golden.glb"

# What is run in a copy of data/, once and then again and again; and what its report says of a difference.
TOOLS = {
    "meson": (["meson setup build-meson guard/meson"], "meson test -C build-meson --print-errorlogs"),
    "ctest": (["cmake -S guard/ctest -B build-ctest"], "ctest --test-dir build-ctest --output-on-failure"),
    "pytest": ([], "pytest -p no:cacheprovider guard/pytest"),
}


def run(command, folder, environment):
    done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, text=True, check=False, timeout=300,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def expect(passes, command, folder, environment, what):
    code, said = run(command, folder, environment)
    if (code == 0) != passes:
        sys.exit(f"{what}: {command} ended with {code}:\n{said}")
    if not passes and not re.search(r"vertex \d+: [xyz] differs by", said):
        sys.exit(f"{what}: {command} does not say what differs:\n{said}")


def guard(tool, data, environment):
    setup, test = TOOLS[tool]
    for command in setup:
        expect(True, command, data, environment, tool)
    with open(os.path.join(data, LATTICE), encoding="utf-8") as file:
        lattice = file.read()
    with open(os.path.join(data, GOLDEN), "rb") as file:
        golden = file.read()
    outputs = []
    for passes, degrees in ((True, "120"), (False, "121"), (True, "120.00001"), (False, "120.01"), (True, "120")):
        changed = lattice.replace('"degrees": 120', f'"degrees": {degrees}')
        if (changed == lattice) != (degrees == "120"):
            sys.exit(f"{LATTICE} has no 120 degrees any more")
        with open(os.path.join(data, LATTICE), "w", encoding="utf-8") as file:
            file.write(changed)
        expect(passes, test, data, environment, f"{tool}, {degrees} degrees")
        run(f"ffd deform models/banner_red.glb moved.glb -l {LATTICE} --force", data, environment)
        with open(os.path.join(data, "moved.glb"), "rb") as file:
            outputs.append(file.read())
    if outputs[0] != golden or outputs[2] == golden:
        sys.exit("120 degrees must give the golden file, and 120.00001 other bytes")
    shutil.copy(os.path.join(data, "models/banner_red.glb"), os.path.join(data, GOLDEN))
    expect(False, test, data, environment, f"{tool}, another golden file")
    return len(outputs) + 1


def main():
    ffd, source = map(os.path.abspath, sys.argv[1:])
    count = 0
    for tool in TOOLS:
        with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
            data, tools = os.path.join(folder, "data"), os.path.join(folder, "bin")
            shutil.copytree(os.path.join(source, "data"), data)
            os.mkdir(tools)
            os.symlink(ffd, os.path.join(tools, "ffd"))
            count += guard(tool, data, dict(os.environ, PATH=tools + os.pathsep + os.environ["PATH"]))
    print(f"{count} runs of {len(TOOLS)} tools as expected")


if __name__ == "__main__":
    main()
