#!/usr/bin/env python3
"""Points moved by control points that a call gives, one set or many, beside scipy's product of the stored basis and the same numbers,
and torch's where it is installed; the basis and evaluations beside what they are made of; one thread. Exit 77: ffd_mesh or scipy is
not installed.

    variants.py RUNS VARIANTS SIDE,POINTS...     a line of each: median (least to greatest), millions a second of points, or of points and variants

Processor time, in turns, so that a busy machine slows down all alike; the first turn is not counted.
"""

import statistics
import sys
import time

try:
    import ffd_mesh as ffd
    import numpy as np
    import scipy.sparse
except ImportError:
    sys.exit(77)
try:
    import ffd_mesh.torch
    import torch
    torch.set_num_threads(1)
except ImportError:
    torch = None


def seconds(function):
    start = time.process_time()
    function()
    return time.process_time() - start


def in_turns(runs, work, functions):
    """Says how quick each of the functions is, by name."""
    taken = [[seconds(function) for function in functions.values()] for _ in range(runs + 1)][1:]
    for name, column in zip(functions, zip(*taken)):
        speeds = sorted(work / 1e6 / s for s in column)
        print(f"{name}: {statistics.median(speeds):.4f} ({speeds[0]:.4f} to {speeds[-1]:.4f})", flush=True)


def measure(side, count, variants, runs):
    random = np.random.default_rng(11)
    what, size = f"{side}^3, {count} points", (side, side, side)
    lattice, points = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=size), random.random((count, 3))
    embedding = lattice.embed(points)
    basis = lattice.basis(embedding)
    assert scipy.sparse.issparse(basis)
    D = random.normal(scale=0.05, size=(variants, *size, 3))
    flat, all_flat = D[0].reshape(-1, 3), np.ascontiguousarray(D.reshape(variants, -1, 3).transpose(1, 0, 2).reshape(side**3, 3 * variants))
    one, many = np.empty((count, 3)), np.empty((variants, count, 3))
    assert np.abs(lattice.deform(embedding, offsets=D[0]) - points - basis @ flat).max() < 1e-12
    in_turns(runs, count, {f"{what}: scipy, B @ D": lambda: basis @ flat,
                           f"{what}: deform": lambda: lattice.deform(embedding, offsets=D[0], out=one, threads=1)})
    products = {f"{what}: scipy, B @ {variants} D": lambda: basis @ all_flat,
                f"{what}: deform, {variants} at once": lambda: lattice.deform(embedding, offsets=D, out=many, threads=1)}
    if torch:
        by_torch, numbers = ffd.torch.basis(lattice, embedding), torch.from_numpy(all_flat)
        products[f"{what}: {variants} D by torch"] = lambda: by_torch @ numbers
    in_turns(max(2, runs // 2), count * variants, products)
    uvw, moved = embedding.uvw, lattice.moved(offsets=D[0])
    in_turns(runs, count, {f"{what}: deform, new array": lambda: moved.deform(embedding, threads=1),
                           f"{what}: evaluate": lambda: moved.evaluate(uvw, threads=1)})

    def parts():
        basis.copy()
        lattice.basis_times(embedding, D[0], threads=1)
    in_turns(runs, count, {f"{what}: copy of the basis, basis_times": parts, f"{what}: basis": lambda: lattice.basis(embedding, threads=1)})


def main():
    runs, variants = map(int, sys.argv[1:3])
    for case in sys.argv[3:]:
        side, count = map(int, case.split(","))
        measure(side, count, variants, runs)


main()
