#!/usr/bin/env python3
"""What the Python package adds to the C calls that it makes, one thread, box lattice of 8^3, what geomdl takes to evaluate, and
what PyGeM's class takes by PyGeM's formula in numpy; exit 77: ffd_mesh is not installed.

    calls.py RUNS POINTS

Millions of points a second of processor time, median (least to greatest), a line each, in turns: the C call with all that it needs laid out
before, and the call of Python that makes it. Arrays for results are there already, but for "new array".
"""

import ctypes
import math
import os
import statistics
import sys
import time

try:
    import ffd_mesh as ffd
    import numpy as np
    from ffd_mesh import _arrays, _library
    from ffd_mesh._library import Owned, Run, lib
    from ffd_mesh.pygem import FFD
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


def formula(box, points):
    """What PyGeM computes, the way it does: powers of all coordinates, and a few passes over the points for each control point."""
    sides = (box.rotation_matrix * box.box_length).T
    t = (points - box.box_origin) @ np.linalg.inv(sides)
    inside = np.all((t >= 0) & (t <= 1), axis=1)
    t = t[inside]
    basis = [[math.comb(n - 1, i) * (1 - t[:, a]) ** (n - 1 - i) * t[:, a] ** i for i in range(n)]
             for a, n in enumerate(box.n_control_points.tolist())]
    shift = np.zeros((3, len(t)))
    for j, y in enumerate(basis[1]):
        for k, z in enumerate(basis[2]):
            yz = y * z
            for i, x in enumerate(basis[0]):
                xyz = x * yz
                for row, mu in zip(shift, (box.array_mu_x, box.array_mu_y, box.array_mu_z)):
                    row += xyz * mu[i, j, k]
    out = points.copy()
    out[inside] = (t + shift.T) @ sides + box.box_origin
    return out


def pygem(points, runs):
    """One call of the class, with all that it needs."""
    random, box = np.random.default_rng(10), FFD([5, 5, 5])
    box.rot_angle, box.box_origin, box.box_length = np.array([20.0, -35, 50]), np.array([0.1, -0.2, 0.3]), np.array([1.5, 1.2, 0.8])
    for mu in (box.array_mu_x, box.array_mu_y, box.array_mu_z):
        mu[:] = random.uniform(-0.1, 0.1, mu.shape)
    t = random.uniform(0.001, 0.999, (points, 3))
    array = t * box.box_length @ box.rotation_matrix.T + box.box_origin
    assert np.abs(formula(box, array) - box(array)).max() < 1e-12
    taken = [(seconds(lambda: formula(box, array)), seconds(lambda: box(array))) for _ in range(runs)]
    say("PyGeM's class, 5^3, one call: numpy", points, [pair[0] for pair in taken])
    say("PyGeM's class, 5^3, one call: ffd_mesh.pygem", points, [pair[1] for pair in taken])


def main():
    runs, points = map(int, sys.argv[1:])
    # PyGeM's class has no number of threads. The library asks once how many processors it has.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=8, degree=3)
    array = np.random.default_rng(7).random((points, 3))
    for kind in (np.float32, np.float64):
        numbers = array.astype(kind)
        deforming(f"{np.dtype(kind)}: deform", lattice, numbers, runs, False)
    deforming("float32, new array: deform", lattice, array.astype(np.float32), runs, True)
    embedding("float32: embed", lattice, array.astype(np.float32), runs)
    geomdl(lattice, points, runs)
    pygem(points, runs)


main()
