#!/usr/bin/env python3
"""Sums up a `meson test` run from its testlog.json: prints what failed, with its output, and the counts.

    summary.py TESTLOG.json       last line: PASSED FAILED SKIPPED

A test that skips itself prints "SKIP: WHAT: why", with what this machine lacks. Where it lacks nothing of that name the test has
failed. So has a run without tests.
"""

import glob
import json
import os
import shutil
import subprocess
import sys

LINES = 40
WHEELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".build-test", "wheels")
BPY = os.environ.get("FFD_BLENDER_WHEELS") or os.path.join(WHEELS, "..", "blender")
MOUNT_EXT4 = ["unshare", "-m", "sh", "-ec", """
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
truncate -s 1M "$folder/image"
PATH=$PATH:/usr/sbin:/sbin
mkfs.ext4 -q -O ^has_journal "$folder/image"
mkdir "$folder/disk"
mount -o loop "$folder/image" "$folder/disk"
umount "$folder/disk"
"""]


def tail(text):
    lines = text.rstrip().splitlines()
    if len(lines) > LINES:
        lines = [f"... ({len(lines) - LINES} lines more in the log)"] + lines[-LINES:]
    return "".join(f"    {line}\n" for line in lines)


def succeeds(*words):
    return subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0


def is_debian_12():
    with open("/etc/os-release", encoding="utf-8") as file:
        return "VERSION_CODENAME=bookworm\n" in file.readlines()


def has_bpy():
    """Whether its wheels are here, and for this Python."""
    return bool(glob.glob(os.path.join(BPY, "bpy-*.whl"))) and sys.version_info[:2] == (3, 11)


# What a machine may lack.
LACKS = {
    "models": lambda: not os.environ.get("FFD_MODELS"),
    "mounts": lambda: not succeeds(*MOUNT_EXT4),
    "Debian 12": lambda: not is_debian_12(),
    "wine": lambda: not shutil.which("wine64") and not shutil.which("wine64", path="/usr/lib/wine"),
    "wheels": lambda: not is_debian_12() or not os.path.exists(WHEELS),
    "torch": lambda: not any(succeeds(python, "-c", "import torch, numpy") for python in (sys.executable, "/usr/bin/python3")),
    "NumPy": lambda: not any(succeeds(python, "-c", "import numpy") for python in (sys.executable, "/usr/bin/python3")),
    "blender": lambda: not os.path.exists("/usr/bin/blender") and not has_bpy(),
    "bpy": lambda: not has_bpy(),
}


def reason(test):
    """Why a skipped test says that it was, and whether that is so."""
    for line in test.get("stdout", "").splitlines():
        if line.startswith("SKIP: "):
            what, _, why = line[len("SKIP: "):].partition(": ")
            return f"{what}: {why}", what in LACKS and LACKS[what]()
    return "no reason given", False


def main():
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    try:
        with open(sys.argv[1], encoding="utf-8", errors="replace") as file:
            tests = [json.loads(line) for line in file if line.strip()]
    except OSError:
        tests = []
    for test in tests:
        result = test["result"]
        if result in ("OK", "EXPECTEDFAIL"):
            counts["passed"] += 1
            continue
        why, lacks = reason(test) if result == "SKIP" else (result.lower(), False)
        if lacks:
            counts["skipped"] += 1
            print(f"  skipped: {test['name']}: {why}")
        else:
            counts["failed"] += 1
            if result == "SKIP":
                why = f"skipped, and nothing of that is missing here: {why}"
            print(f"  FAILED: {test['name']} ({why}, exit {test.get('returncode')}, {test['duration']:.1f} s)")
            print(tail(test.get("stdout", "")) + tail(test.get("stderr", "")), end="")
    if not tests:
        counts["failed"] = 1
        print("  FAILED: no test ran")
    print(*counts.values())


main()
