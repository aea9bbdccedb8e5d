#!/usr/bin/env python3
"""What the sliders of a page's morph targets do, without a browser. A page of IN and its lattice with some weights shows what
a page of OUT shows that has these weights by default: OUT as `ffd deform` writes it, at rest and while an animation plays.

    test_morph.py FFD SCRIPTS
"""

import copy
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "cli"))
from gltf_arm import arm, face  # noqa: E402 (a neighbour of this folder)

SKIPPED = 77
# 16 bits of a box of about 6, and of offsets up to 2.
CLOSE = 3e-4
BOX = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [-4, -4, -4], "max": [6, 6, 6]}}}
BEND = {**BOX, "moves": [{"at": [2, "all", "all"], "by": [0, 2, 1]}, {"at": [1, 1, "all"], "by": [1, 0, -1]}]}
STRETCH = {**BOX, "moves": [{"scale": {"factor": [1, 2, 1.5], "about": [0, 0, 0]}}]}
UP, HOSTILE = NAMES = "up", "</script><img src=x onerror=alert(5)>\n\u202e"


def with_weights(asset, by_name):
    """The same file with other default weights."""
    changed = copy.deepcopy(asset)
    for mesh in changed["meshes"]:
        names = mesh["extras"]["targetNames"]
        own = mesh.get("weights", [0] * len(names))
        mesh["weights"] = [by_name.get(name, weight) for name, weight in zip(names, own)]
    return changed


class Checks:
    def __init__(self, ffd, scripts, folder):
        self.ffd, self.scripts, self.folder, self.failed = ffd, scripts, folder, []

    def write(self, name, content):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(content, file)

    def run(self, *words):
        subprocess.run([self.ffd, *words, "--force", "-q"], cwd=self.folder, check=True)

    def shown(self, weights, *words, animation="", share=0):
        """What a page shows with these weights by their shown names."""
        self.run("view", *words, "-o", "page.html")
        done = subprocess.run(["node", os.path.join(HERE, "morph.mjs"), self.scripts, os.path.join(self.folder, "page.html"),
                               json.dumps(weights), animation, str(share)], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    def say(self, holds, what):
        if not holds:
            self.failed.append(what)

    def near(self, found, there, what, close=CLOSE):
        self.say(found.keys() == there.keys(), f"{what}: other vertices")
        off = max(math.dist(found[v], there[v]) for v in found)
        self.say(off <= close, f"{what}: {off} off")


SHOWN_HOSTILE = HOSTILE.replace("\n", "\\n").replace("\u202e", "\\u{202e}")


def rests_and_poses(checks):
    """Base and targets go through the lattice as the program writes them."""
    for lattice, defaults in ((BEND, None), (STRETCH, [[0.25, 0.5], [0.25]])):
        asset = face(NAMES, defaults)
        checks.write("in.gltf", asset)
        checks.write("l.json", lattice)
        checks.run("deform", "in.gltf", "out.gltf", "-l", "l.json")
        with open(os.path.join(checks.folder, "out.gltf"), encoding="utf-8") as file:
            written = json.load(file)
        for weights in ({}, {UP: 1}, {UP: -0.5, HOSTILE: 0.75}):
            checks.write("before.gltf", with_weights(asset, weights))
            checks.write("after.gltf", with_weights(written, weights))
            named = {SHOWN_HOSTILE if name == HOSTILE else name: value for name, value in weights.items()}
            for animation, share in (("", 0), ("turn", 0.75), ("lift", 0.5)):
                what = f"{'bend' if lattice is BEND else 'stretch'}, {list(weights.values())}, {animation or 'at rest'}"
                pose = {"animation": animation, "share": share}
                page = checks.shown(named, "in.gltf", "-l", "l.json", **pose)
                checks.near(page["before"], checks.shown({}, "before.gltf", **pose)["before"], what + ", before")
                checks.near(page["after"], checks.shown({}, "after.gltf", **pose)["before"], what + ", after")
                pair = checks.shown(named, "in.gltf", "out.gltf", **pose)
                checks.near(page["after"], pair["after"], what + ", two files")
                first = 0.25 if defaults else 0
                there = [[UP, first, weights.get(UP, first)], [SHOWN_HOSTILE, 2 * first, weights.get(HOSTILE, 2 * first)]]
                checks.say(page["sliders"] == there, f"{what}: {page['sliders']}")


def rigs_follow(checks):
    """The nodes of OUT have moved too."""
    asset = face(NAMES)
    checks.write("in.gltf", asset)
    checks.write("l.json", STRETCH)
    checks.run("deform", "in.gltf", "out.gltf", "-l", "l.json", "--rig", "follow")
    page = checks.shown({UP: 0.5}, "in.gltf", "-l", "l.json", "--rig", "follow")
    checks.near(page["after"], checks.shown({UP: 0.5}, "out.gltf")["before"], "a rig that follows")


def new_targets(checks):
    """Targets of --morph are shown in full, beside those of the file, and replace what has their name."""
    asset = face(NAMES, [[0.25, 0.5], [0.25]])
    checks.write("in.gltf", asset)
    for name, lattice in (("bend.json", BEND), ("stretch.json", STRETCH)):
        checks.write(name, lattice)
    words = ["--morph", "bow=bend.json", "--morph", f"{UP}=stretch.json"]
    checks.run("deform", "in.gltf", "out.gltf", *words)
    with open(os.path.join(checks.folder, "out.gltf"), encoding="utf-8") as file:
        written = json.load(file)
    for bow, up, hostile in ((1, 1, 0.5), (0.25, 0, 0.5), (0.5, 1, -1)):
        checks.write("after.gltf", with_weights(written, {"bow": bow, UP: up, HOSTILE: hostile}))
        for animation, share in (("", 0), ("turn", 0.75)):
            pose = {"animation": animation, "share": share}
            # The slider of the file's own target of that name has another weight, and is for the shape before.
            page = checks.shown({"bow": bow, SHOWN_HOSTILE: hostile}, "in.gltf", *words, **pose)
            names = [name for name, *_ in page["sliders"]]
            checks.say(names == [UP, SHOWN_HOSTILE, "bow", UP], f"sliders of new targets: {names}")
            checks.say([weight for _, weight, _ in page["sliders"]] == [0.25, 0.5, 1, 1], f"weights: {page['sliders']}")
            if up == 1:
                checks.near(page["after"], checks.shown({}, "after.gltf", **pose)["before"], f"new targets {bow} {hostile} {animation}", 1e-3)
    checks.write("arm.gltf", arm())
    page = checks.shown({"bow": 0.5}, "arm.gltf", "--morph", "bow=bend.json", animation="lift", share=0.5)
    whole = checks.shown({}, "arm.gltf", "-l", "bend.json")
    rest = checks.shown({"bow": 0}, "arm.gltf", "--morph", "bow=bend.json")
    checks.near(rest["after"], rest["before"], "a target at 0")
    full = checks.shown({}, "arm.gltf", "--morph", "bow=bend.json")
    checks.near(full["after"], whole["after"], "a target in full is the deformed mesh")
    half = {v: [(a + b) / 2 + (1.5 if i == 2 else 0) for i, (a, b) in enumerate(zip(p, full["after"][v]))] for v, p in full["before"].items()}
    checks.near(page["after"], half, "half of a target, while the arm is lifted")


def normals_follow(checks):
    """Normals are those of the faces as the targets have moved them: a square of the arm's end, turned up."""
    asset = face(NAMES)
    checks.write("in.gltf", asset)
    page = checks.shown({}, "in.gltf", animation="lift", share=0)
    moved = checks.shown({UP: 1}, "in.gltf")
    checks.say(not page["isMorphed"] and moved["isMorphed"], "which shapes are morphed")
    flat = [n for _, n, _ in page["normals"][:8]]
    checks.say(all(abs(n[2] - 1) < 1e-3 for n in flat), f"normals at rest: {flat}")
    checks.say(any(abs(n[2]) < 0.99 for _, n, _ in moved["normals"][:8]), "normals of the moved arm")
    for vertex, before, after in moved["normals"]:
        checks.say(abs(math.hypot(*before) - 1) < 1e-3 and before == after, f"the normal of vertex {vertex}: {before}, {after}")


def main():
    ffd, scripts = [os.path.abspath(path) for path in sys.argv[1:]]
    if not shutil.which("node"):
        print("SKIP: node is not there")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        checks = Checks(ffd, scripts, folder)
        for part in (rests_and_poses, rigs_follow, new_targets, normals_follow):
            part(checks)
    print(*checks.failed, f"{len(checks.failed)} differences", sep="\n")
    sys.exit(1 if checks.failed else 0)


main()
