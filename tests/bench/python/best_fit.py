"""A fit beside MeshLib's FreeFormBestFit, of as many control points, to the same pairs.

    best_fit.py PAIRS SIDE...     a line of each: seconds, and how far it is from the truth on the body and off it, root of the mean square

The body is a bumpy sphere; what is off it lies up to a twentieth of its radius outside, as clothes do, and is not fitted.
MeshLib's control points reach everywhere (Bernstein polynomials of the whole box), and its matrix is dense.
"""

import sys
import time


try:
    import ffd_mesh as ffd
    import numpy as np
    from meshlib import mrmeshnumpy, mrmeshpy
except ImportError:
    sys.exit(77)  # as programs that are skipped


def bumpy_sphere(directions, factor):
    return directions * factor * (1 + 0.2 * np.sin(5 * directions[:, :1]) * np.cos(4 * directions[:, 1:2]))


def moved(x):
    return x + 0.13 * np.stack([np.sin(2 * x[:, 1]), np.cos(2 * x[:, 2]), np.sin(x[:, 0] * x[:, 1])], axis=1)


def by_ffd(source, target, side):
    fit = ffd.fit(source, target, size=side, threads=1)
    return lambda points: fit.lattice.deform(fit.lattice.embed(points))


def by_meshlib(source, target, side):
    low, high = source.min(axis=0), source.max(axis=0)
    margin, size = 0.05 * (high - low), mrmeshpy.Vector3i(side, side, side)
    low, high = low - margin, high + margin
    solver = mrmeshpy.FreeFormBestFit(mrmeshpy.Box3d(mrmeshpy.Vector3d(*low), mrmeshpy.Vector3d(*high)), size)
    for x, y in zip(source.tolist(), target.tolist()):
        solver.addPair(mrmeshpy.Vector3d(*x), mrmeshpy.Vector3d(*y), 1.0)
    grid = solver.findBestDeformationReferenceGrid()

    def deform(points):
        cloud = mrmeshnumpy.pointCloudFromPoints(points)
        deformer = mrmeshpy.FreeFormDeformer(cloud.points, cloud.validPoints)
        deformer.init(size, mrmeshpy.Box3f(mrmeshpy.Vector3f(*low), mrmeshpy.Vector3f(*high)))
        deformer.setAllRefGridPositions(grid)
        deformer.apply()
        return mrmeshnumpy.toNumpyArray(cloud.points)
    return deform


def distance(a, b):
    return float(np.sqrt(np.mean(np.sum((a - b) ** 2, axis=1))))


def main():
    count, *sides = map(int, sys.argv[1:])
    random = np.random.default_rng(5)
    directions = random.standard_normal((2 * count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    body = bumpy_sphere(directions[:count], 1.0)
    off = bumpy_sphere(directions[count:], 1 + 0.05 * random.random((count, 1)))
    target = moved(body)
    for side in sides:
        for name, fit in (("ffd_mesh.fit", by_ffd), ("MeshLib, FreeFormBestFit", by_meshlib)):
            start = time.perf_counter()
            deform = fit(body, target, side)
            seconds = time.perf_counter() - start
            print(f"{side}^3, {count} pairs, {name}: {seconds:.6f} {distance(deform(body), target):.6g} {distance(deform(off), moved(off)):.6g}", flush=True)


main()
