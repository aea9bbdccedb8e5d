#!/usr/bin/env python3
"""The extension for Blender: it is built of a wheel of the package, the same bytes twice, installed in the module bpy, and checked there
(check_extension.py).

    test_extension.py SOURCE BUILD-FOLDER CC CXX       FFD_WHEEL=FILE.whl names a wheel that was built already
"""

import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

import programs

sys.path.insert(0, os.path.join(programs.ROOT, "tests", "python"))
import test_package as package  # pylint: disable=wrong-import-position

BUILD = os.path.join(programs.SCRIPTS, "build_extension.py")
MEMBERS = ["LICENSE", "LICENSE-MIT", "__init__.py", "apply_lattice.py", "blender_manifest.toml", "ffd_export.py", "ffd_import.py", "ffd_lattice_math.py"]


def fail(*shown):
    sys.exit("FAILED: " + " ".join(map(str, shown)))


def find_wheel(folder):
    """FFD_WHEEL, or one that is built here, named as the release names it: it runs on this machine, which is that of the test."""
    if os.environ.get("FFD_WHEEL"):
        return os.environ["FFD_WHEEL"]
    source, build, *compilers = sys.argv[1:5]
    python, _ = package.make_environment(os.path.join(folder, "tools"), {"requirements.txt": package.fetched(source, "FFD_WHEELS", "wheels")})
    beside = os.path.join(folder, "build")  # the folder of what is compiled is beside it, not that of the suite python
    os.makedirs(beside)
    os.symlink(os.path.join(os.path.abspath(build), "meson-info"), os.path.join(beside, "meson-info"))
    wheel, _ = package.build_wheel(python, source, beside, os.path.join(folder, "dist"), compilers, "wheel")
    named = re.sub(r"-(many)?linux\w*_x86_64\.whl$", "-manylinux_2_28_x86_64.whl", wheel)
    if named != wheel:
        os.rename(wheel, named)
    return named


def build(folder, wheel, *more, code=0):
    os.makedirs(folder, exist_ok=True)
    done = subprocess.run([sys.executable, BUILD, "--wheel", wheel, "--out", folder, *more], capture_output=True, text=True, check=False)
    if done.returncode != code or (code and (done.stderr.count("\n") != 1 or not done.stderr.startswith("build_extension: "))):
        fail("build_extension.py", wheel, *more, "ended with", done.returncode, done.stderr)
    return done.stdout.strip() or done.stderr


def check_build(folder, wheel):
    first = build(os.path.join(folder, "one"), wheel)
    other = os.path.join(folder, "two", os.path.basename(wheel))
    os.makedirs(os.path.dirname(other))
    shutil.copy(wheel, other)  # with another time
    second = build(os.path.join(folder, "two"), other)
    with open(first, "rb") as one, open(second, "rb") as two:
        if one.read() != two.read():
            fail("the same inputs give other bytes")
    with open(os.path.join(programs.ROOT, "include", "ffd", "version.h"), encoding="ascii") as file:
        version = re.search(r'FFD_VERSION "(.*)"', file.read())[1]
    if os.path.basename(first) != f"ffd_lattice-{version}.zip":
        fail(first)
    with zipfile.ZipFile(first) as archive:
        if archive.namelist() != sorted([*MEMBERS, f"wheels/{os.path.basename(wheel)}"]):
            fail(archive.namelist())
        manifest = archive.read("blender_manifest.toml").decode()
    if f'version = "{version}"' not in manifest or f'wheels = ["./wheels/{os.path.basename(wheel)}"]' not in manifest or "@" in manifest:
        fail(manifest)
    tagline = re.search('tagline = "(.*)"', manifest)[1]
    if len(tagline) > 64 or tagline.endswith("."):
        fail(tagline)
    for name, code, what in ((wheel, 1, "exists already"), (os.path.join(folder, "ffd_mesh-9.9.9-cp311-abi3-manylinux_2_28_x86_64.whl"), 1, f"is of version 9.9.9, not {version}"),
                             (os.path.join(folder, f"ffd_mesh-{version}-cp311-abi3-musllinux_1_2_x86_64.whl"), 1, "is not a wheel"),
                             (os.path.join(folder, f"ffd_mesh-{version}-cp311-abi3-manylinux_2_28_x86_64.whl"), 1, "cannot be read")):
        said = build(os.path.dirname(first), name, code=code)
        if what not in said:
            fail(said)
    build(os.path.dirname(first), wheel, "--force")
    return first


def main():
    with tempfile.TemporaryDirectory() as folder:
        blender = programs.wheel(os.path.join(folder, "venv"))
        if not blender:
            programs.skip("bpy", f"its wheels are not in {programs.WHEELS} (.ci/setup stages), or not for this Python")
        zipped = check_build(folder, find_wheel(folder))
        seed = os.environ.get("FFD_SEED") or str(random.randrange(1 << 30))
        print(f"seed {seed} (FFD_SEED)")
        place = os.path.join(folder, "run")
        os.makedirs(place)
        done = blender.run(place, os.path.join(programs.HERE, "check_extension.py"), arguments=[zipped, programs.SCRIPTS, seed])
        print(done.stdout[-5000:], done.stderr[-5000:], sep="\n")
        if done.returncode != 0 or "0 failed" not in done.stdout:
            fail("check_extension.py ended with", done.returncode)


main()
