#!/usr/bin/env python3
"""`meson dist` makes a tarball from which ffd is built and runs; it holds every file of the project and no other.

    test_dist.py
"""

import glob
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile

import stage


def main():
    stage.need("git", "meson")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        # A repository of its own: `meson dist` takes what is committed, and a test shall see what is there.
        copy = stage.copy_source(os.path.join(folder, "ffd"))
        names = sorted(os.path.relpath(os.path.join(base, name), copy)
                       for base, _, files in os.walk(copy) for name in files)
        git = ["git", "-C", copy, "-c", "user.name=test", "-c", "user.email=test@localhost"]
        stage.run([*git, "init", "--quiet"])
        stage.run([*git, "add", "--all", "--force"])
        stage.run([*git, "commit", "--quiet", "--message", "all"])
        build = os.path.join(folder, "build")
        # What is looked at is whether it builds and runs, not how fast.
        options = ["--buildtype=debug", "-Dtests=disabled"]
        stage.run(["meson", "setup", *options, build, copy])
        stage.run(["meson", "dist", "-C", build, "--no-tests", "--formats", "gztar"])
        (tarball,) = glob.glob(os.path.join(build, "meson-dist", "*.tar.gz"))
        with tarfile.open(tarball) as archive:
            top = os.path.basename(tarball).removesuffix(".tar.gz")
            packed = sorted(os.path.relpath(member.name, top) for member in archive if not member.isdir())
            archive.extractall(folder)
        findings += [f"not in the tarball: {name}" for name in sorted(set(names) - set(packed))]
        findings += [f"in the tarball, and not expected: {name}" for name in sorted(set(packed) - set(names))]
        shutil.rmtree(copy)
        shutil.rmtree(build)
        source = os.path.join(folder, top)
        stage.run(["meson", "setup", *options, build, source])
        stage.run(["ninja", "-C", build, "src/cli/ffd"])
        ffd = os.path.join(build, "src/cli/ffd")
        version = stage.run([ffd, "--version"]).strip()
        if top != version.replace(" ", "-"):
            findings.append(f"{top} holds {version}")
        stage.run([ffd, "deform", "data/models/vase.obj", os.path.join(folder, "vase.obj"), "-l",
                   "data/lattices/bend.json"], cwd=source)
        if subprocess.run([ffd, "compare", "data/models/vase.obj", os.path.join(folder, "vase.obj")], cwd=source,
                          stdout=subprocess.DEVNULL, check=False).returncode != 1:
            findings.append("the vase was not deformed")
    stage.finish(len(names), "packed files", findings)


main()
