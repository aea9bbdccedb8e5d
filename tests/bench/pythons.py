"""What the Python package adds to the C calls that it makes (python/calls.py), where it is installed."""

import os
import shutil
import subprocess
import sys

from kernels import NOT_INSTALLED, values_of

CALLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "python", "calls.py")
BAR = ">= 0.91"


def lines_of(bench):
    """What calls.py says with the Python of --python, the one that runs this, or the system's."""
    for python in filter(None, (bench.python, sys.executable, shutil.which("python3", path=os.defpath))):
        done = subprocess.run([python, CALLS, str(bench.runs), str(bench.side ** 2)], stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != NOT_INSTALLED:
            done.check_returncode()
            return done.stdout.splitlines()
    return []


def calls(bench):
    """Each call of Python beside that of C; evaluation beside geomdl's."""
    bench.table.title("Python, one thread, box 8^3, degree 3")
    first, lines = None, lines_of(bench)
    for line in lines:
        name, found = line.rpartition(": ")[0], values_of(line)
        if not found:
            bench.table.say(f"  {line}")
        elif name.endswith((": C", ": ffd_mesh")):
            first = bench.table.add(name, found[0], "M/s")
        else:
            bench.table.add(name, found[0], "M/s", first, BAR if name.endswith(": Python") else "")
    if not lines:
        bench.table.say("  ffd_mesh: not installed (--python PATH)")
