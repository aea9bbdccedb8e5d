"""What the Python package adds to the C calls that it makes (python/calls.py), where it is installed."""

import os
import shutil
import subprocess
import sys

from kernels import NOT_INSTALLED, values_of

CALLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "python", "calls.py")
# What a name ends with -> the bar for its ratio to the row before it that has none.
BARS = {": Python": ">= 0.91", ": geomdl": "", ": ffd_mesh.pygem": ">= 20"}


def lines_of(bench):
    """What calls.py says with the Python of --python, the one that runs this, or the system's."""
    # A second thread of NumPy's products would turn round beside what is measured.
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    for python in filter(None, (bench.python, sys.executable, shutil.which("python3", path=os.defpath))):
        done = subprocess.run([python, CALLS, str(bench.runs), str(bench.side ** 2)], stdout=subprocess.PIPE, text=True, check=False, env=environment)
        if done.returncode != NOT_INSTALLED:
            done.check_returncode()
            return done.stdout.splitlines()
    return []


def calls(bench):
    """Each call of Python beside that of C; evaluation beside geomdl's; PyGeM's class beside its formula in numpy."""
    bench.table.title("Python, one thread, box 8^3, degree 3")
    first, lines = None, lines_of(bench)
    for line in lines:
        name, found = line.rpartition(": ")[0], values_of(line)
        bars = [bar for end, bar in BARS.items() if name.endswith(end)]
        if not found:
            bench.table.say(f"  {line}")
        elif not bars:
            first = bench.table.add(name, found[0], "M/s")
        else:
            bench.table.add(name, found[0], "M/s", first, bars[0])
    if not lines:
        bench.table.say("  ffd_mesh: not installed (--python PATH)")
