"""What the Python package adds to the C calls that it makes (python/calls.py), and what variants of control points cost beside scipy
(python/variants.py), where it is installed."""

import os
import shutil
import subprocess
import sys

from kernels import NOT_INSTALLED, values_of

CALLS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "python", "calls.py")
# What a name ends with -> the bar for its ratio to the row before it that has none.
BARS = {": Python": ">= 0.91", ": geomdl": "", ": ffd_mesh.pygem": ">= 20"}


VARIANTS = os.path.join(os.path.dirname(CALLS), "variants.py")
# The same for variants.py: no slower than scipy, than 1.5 deforms, than twice its parts; torch beside scipy, too.
VARIANT_BARS = {" by torch": "", ": deform": ">= 1", " at once": ">= 1", ": evaluate": ">= 0.67", ": basis": ">= 0.5"}


def lines_of(bench, program, *arguments):
    """What a program says with the Python of --python, the one that runs this, or the system's."""
    # A second thread of NumPy's products would turn round beside what is measured.
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    for python in filter(None, (bench.python, sys.executable, shutil.which("python3", path=os.defpath))):
        done = subprocess.run([python, program, str(bench.runs), *arguments], stdout=subprocess.PIPE, text=True, check=False, env=environment)
        if done.returncode != NOT_INSTALLED:
            done.check_returncode()
            return done.stdout.splitlines()
    return []


def show(bench, lines, bars):
    """Each line beside the last one that no bar is for."""
    first = None
    for line in lines:
        name, found = line.rpartition(": ")[0], values_of(line)
        known = [bar for end, bar in bars.items() if name.endswith(end)]
        if not found:
            bench.table.say(f"  {line}")
        elif not known:
            first = bench.table.add(name, found[0], "M/s")
        else:
            bench.table.add(name, found[0], "M/s", first, known[0])
    if not lines:
        bench.table.say("  ffd_mesh: not installed (--python PATH)")


def calls(bench):
    """Each call of Python beside that of C; evaluation beside geomdl's; PyGeM's class beside its formula in numpy. Then variants
    beside scipy."""
    bench.table.title("Python, one thread, box 8^3, degree 3")
    show(bench, lines_of(bench, CALLS, str(bench.side ** 2)), BARS)
    is_small = bench.side < 256
    bench.table.title("Python, one thread, variants of control points, degree 3")
    cases = ("4,1000", "8,1000") if is_small else ("4,1000", "8,1000", "16,1000", "32,1000", "16,10000", "32,10000", "4,100000", "8,100000",
                                                   "32,100000")
    show(bench, lines_of(bench, VARIANTS, "8" if is_small else "40", *cases), VARIANT_BARS)
