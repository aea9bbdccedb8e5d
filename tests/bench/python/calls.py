#!/usr/bin/env python3
"""What the Python package adds to the C calls that it makes, one thread, box lattice of 8^3, and what geomdl takes to evaluate;
exit 77: ffd_mesh is not installed.

    calls.py RUNS POINTS

Millions of points a second of processor time, median (least to greatest), a line each, in turns: the C call with all that it needs laid out
before, and the call of Python that makes it. Arrays for results are there already, but for "new array".
"""

import ctypes
import statistics
import sys
import time

try:
    import ffd_mesh as ffd
    import numpy as np
    from ffd_mesh import _arrays, _library
    from ffd_mesh._library import Owned, Run, lib
except ImportError:
    sys.exit(77)


def seconds(function):
    start = time.process_time()
    function()
    return time.process_time() - start


def say(name, points, taken):
    speeds = sorted(points / 1e6 / s for s in taken)
    print(f"{name}: {statistics.median(speeds):.3f} ({speeds[0]:.3f} to {speeds[-1]:.3f})", flush=True)


def compared(what, points, runs, c_call, python_call):
    """Runs both in turns, once more than is counted."""
    taken = [(seconds(c_call), seconds(python_call)) for _ in range(runs + 1)][1:]
    say(f"{what}: C", points, [pair[0] for pair in taken])
    say(f"{what}: Python", points, [pair[1] for pair in taken])


def deforming(what, lattice, array, runs, new):
    embedding, Q = lattice.embed(array, threads=1), lattice.rest.copy()
    Q += np.random.default_rng(8).uniform(-0.1, 0.1, Q.shape)
    moved, run, out = lattice.moved(Q), Run(1, "auto", None), np.empty_like(array)
    spans = _arrays.span(array), _arrays.span(out)
    compared(what, len(array), runs,
             lambda: run(lib.ffd_embedding_deform, embedding._pointer, moved._pointer, *spans, None),
             lambda: lattice.deform(embedding, Q, out=None if new else out, threads=1))


def embedding(what, lattice, array, runs):
    desc, run = _library.filled("ffd_embedding_desc"), Run(1, "auto", None)
    desc.lattice, desc.points = lattice._pointer, _arrays.span(array)

    def c_call():
        owned = Owned(lib.ffd_embedding_destroy)
        run(lib.ffd_embedding_create, ctypes.byref(desc), last=(ctypes.byref(owned.pointer),))
    compared(what, len(array), runs, c_call, lambda: lattice.embed(array, threads=1))


def geomdl(lattice, points, runs):
    try:
        from geomdl import BSpline
    except ImportError:
        print("geomdl: not installed")
        return
    volume = BSpline.Volume()
    volume.degree = lattice.degree
    volume.set_ctrlpts(np.ascontiguousarray(lattice.rest.transpose(2, 0, 1, 3)).reshape(-1, 3).tolist(), *lattice.size)
    volume.knotvector = [list(knots) for knots in lattice.knots]
    uvw = np.random.default_rng(9).random((max(1, points // 1000), 3))
    say("evaluation: ffd_mesh", len(uvw), [seconds(lambda: lattice.evaluate(uvw, threads=1)) for _ in range(runs)])
    say("evaluation: geomdl", len(uvw), [seconds(lambda: volume.evaluate_list(uvw.tolist())) for _ in range(runs)])


def main():
    runs, points = map(int, sys.argv[1:])
    lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=8, degree=3)
    array = np.random.default_rng(7).random((points, 3))
    for kind in (np.float32, np.float64):
        numbers = array.astype(kind)
        deforming(f"{np.dtype(kind)}: deform", lattice, numbers, runs, False)
    deforming("float32, new array: deform", lattice, array.astype(np.float32), runs, True)
    embedding("float32: embed", lattice, array.astype(np.float32), runs)
    geomdl(lattice, points, runs)


main()
