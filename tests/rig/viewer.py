"""Runs three.js in node: where it shows the vertices of glTF files (three.mjs)."""

import json
import os
import shutil
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))


def missing():
    """Why there is no viewer; None where there is one."""
    if not shutil.which("node"):
        return "node is not there"
    if not os.path.isdir(os.path.join(os.environ.get("FFD_NODE", ""), "node_modules", "three")):
        return "three is not installed (tests/run.sh installs it)"
    return None


def shown(jobs):
    """Of each job (path, [(animation, time), ..], step) the answer of three.mjs."""
    lines = [json.dumps({"path": path, "poses": poses, "step": step}) for path, poses, step in jobs]
    done = subprocess.run(["node", os.path.join(HERE, "three.mjs"), os.environ["FFD_NODE"]], input="\n".join(lines),
                          capture_output=True, text=True, check=False, timeout=120)
    if done.returncode != 0:
        raise AssertionError(f"three.js did not show {[job[0] for job in jobs]}: {done.stderr.strip()[-2000:]}")
    return [json.loads(line) for line in done.stdout.splitlines()]
