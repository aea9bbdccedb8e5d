"""What other packages make of the same lattices and points: splinepy (evaluation), SimpleITK and VTK (displacements of uniform
cubic lattices), MeshLib (Bernstein lattices of a box). Run by `sh tests/run.sh --suite peers`; their wheels are peers.txt.

With the argument "speed": each beside ffd_mesh on 10^6 points and 8^3 control points, by as many processors as the process may use.
"""

import os
import statistics
import sys
import time
import unittest

import ffd_mesh as ffd
import numpy as np
import SimpleITK as sitk
import splinepy
from meshlib import mrmeshnumpy, mrmeshpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersHybrid import vtkBSplineTransform


def uniform(random, size, degree=3):
    """A lattice of uniform knots whose volume is the unit cube, and displacements of its control points."""
    axes = [(np.arange(n) - (degree - 1) / 2) / (n - degree) for n in size]
    lattice = ffd.Lattice.from_points(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1), degree, knots="uniform")
    return lattice, 0.1 * random.standard_normal((*size, 3))


def by_splinepy(lattice, weights, uvw, threads=1):
    """A function that evaluates the volume at rest. Theirs have u fastest."""
    points = lattice.rest.transpose(2, 1, 0, 3).reshape(-1, 3)
    made = {"degrees": list(lattice.degree), "knot_vectors": [list(knots) for knots in lattice.knots], "control_points": points}
    spline = splinepy.BSpline(**made) if weights is None else \
        splinepy.NURBS(**made, weights=weights.transpose(2, 1, 0).reshape(-1, 1))
    return lambda: spline.evaluate(uvw, nthreads=threads)


def simpleitk_transform(offsets):
    """The transform of the unit cube that the coefficients of a uniform cubic lattice make."""
    transform = sitk.BSplineTransform(3, 3)
    transform.SetTransformDomainOrigin((0.0, 0.0, 0.0))
    transform.SetTransformDomainPhysicalDimensions((1.0, 1.0, 1.0))
    transform.SetTransformDomainMeshSize([n - 3 for n in offsets.shape[:3]])
    transform.SetParameters(offsets.transpose(3, 2, 1, 0).ravel().tolist())
    return transform


def vtk_transform(offsets):
    """The same of VTK; the arrays that it looks at are returned with it."""
    size, image = offsets.shape[:3], vtkImageData()
    steps = [1 / (n - 3) for n in size]
    image.SetDimensions(*size)
    image.SetSpacing(*steps)
    image.SetOrigin(*(-step for step in steps))
    numbers = np.ascontiguousarray(offsets.transpose(2, 1, 0, 3)).reshape(-1, 3)
    image.GetPointData().SetScalars(numpy_to_vtk(numbers))
    transform = vtkBSplineTransform()
    transform.SetCoefficientData(image)
    transform.Update()
    return transform, (image, numbers)


def by_vtk(offsets, points):
    transform, kept = vtk_transform(offsets)
    there, back = vtkPoints(), vtkPoints()
    there.SetDataTypeToDouble()
    back.SetDataTypeToDouble()
    there.SetData(numpy_to_vtk(points))

    def run():
        assert kept
        back.Reset()
        transform.TransformPoints(there, back)
        return vtk_to_numpy(back.GetData())
    return run


def by_meshlib(points, moved):
    """Their control points are those of a box, moved; they compute in float32."""
    n = moved.shape[0]
    cloud = mrmeshnumpy.pointCloudFromPoints(points)
    deformer = mrmeshpy.FreeFormDeformer(cloud.points, cloud.validPoints)
    deformer.init(mrmeshpy.Vector3i(n, n, n), mrmeshpy.Box3f(mrmeshpy.Vector3f(0, 0, 0), mrmeshpy.Vector3f(1, 1, 1)))
    for i, j, k in np.ndindex(n, n, n):
        deformer.setRefGridPointPosition(mrmeshpy.Vector3i(i, j, k), mrmeshpy.Vector3f(*map(float, moved[i, j, k])))
    return deformer.apply, lambda: mrmeshnumpy.toNumpyArray(cloud.points)


class Agreement(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng([int(os.environ.get("FFD_SEED", "1")), 37])

    def agrees(self, ours, theirs, within):
        worst = float(np.abs(np.asarray(ours, np.float64) - theirs).max())
        print(f"{self.id().split('.')[-1]}: {worst:.2g}", file=sys.stderr)
        self.assertLess(worst, within)

    def test_splinepy_evaluates_the_same(self):
        for knots in ("clamped", "uniform"):
            for rational in (False, True):
                grid = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in (5, 6, 4)), indexing="ij"), axis=-1)
                grid += 0.05 * self.random.standard_normal(grid.shape)
                weights = self.random.uniform(0.5, 2, grid.shape[:3]) if rational else None
                lattice = ffd.Lattice.from_points(grid, 3, knots=knots, weights=weights)
                low, high = (np.array([knots[index] for knots in lattice.knots]) for index in (3, -4))
                uvw = low + (high - low) * self.random.uniform(0, 1, (2000, 3))
                self.agrees(lattice.evaluate(uvw, volume="rest"), by_splinepy(lattice, weights, uvw)(), 1e-12)

    def test_simpleitk_moves_points_the_same(self):
        lattice, offsets = uniform(self.random, (7, 6, 8))
        points, transform = self.random.uniform(0.001, 0.999, (2000, 3)), simpleitk_transform(offsets)
        theirs = np.array([transform.TransformPoint(point) for point in points.tolist()])
        self.agrees(lattice.deform(lattice.embed(points), offsets=offsets), theirs, 1e-12)

    def test_vtk_moves_points_the_same(self):
        lattice, offsets = uniform(self.random, (7, 6, 8))
        points = self.random.uniform(0.001, 0.999, (2000, 3))
        self.agrees(lattice.deform(lattice.embed(points), offsets=offsets), by_vtk(offsets, points)(), 1e-12)

    def test_meshlib_moves_points_the_same_in_its_precision(self):
        for size in (2, 4, 8):
            lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=size, degree=size - 1)
            moved = lattice.rest + 0.1 * self.random.standard_normal(lattice.rest.shape)
            points = self.random.uniform(0, 1, (2000, 3)).astype(np.float32)
            apply, result = by_meshlib(points, moved)
            apply()
            self.agrees(lattice.deform(lattice.embed(points), moved), result(), 5e-6)


def speed():
    """Milliseconds, median of five: one line each."""
    threads, random = len(os.sched_getaffinity(0)), np.random.default_rng(3)
    side = np.linspace(0.005, 0.995, 100)
    points = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    lattice, offsets = uniform(random, (8, 8, 8))
    embedding, out = lattice.embed(points), np.empty_like(points)
    uvw = points * [knots[-4] - knots[3] for knots in lattice.knots] + [knots[3] for knots in lattice.knots]
    field = sitk.TransformToDisplacementFieldFilter()
    field.SetSize([100] * 3)
    field.SetOutputOrigin([0.005] * 3)
    field.SetOutputSpacing([0.99 / 99] * 3)
    field.SetNumberOfThreads(threads)
    transform = simpleitk_transform(offsets)
    bernstein = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=8, degree=7)
    apply, _ = by_meshlib(points.astype(np.float32), bernstein.rest + offsets)
    single = bernstein.embed(points.astype(np.float32))
    for name, function in (("ffd_mesh, embed and deform", lambda: lattice.deform(lattice.embed(points, threads=threads), offsets=offsets, threads=threads)),
                           ("ffd_mesh, deform again", lambda: lattice.deform(embedding, offsets=offsets, out=out, threads=threads)),
                           ("ffd_mesh, evaluate", lambda: lattice.evaluate(uvw, threads=threads)),
                           ("ffd_mesh, degree 7, float32", lambda: bernstein.deform(single, offsets=offsets, threads=threads)),
                           ("SimpleITK, displacement field", lambda: field.Execute(transform)),
                           ("VTK, TransformPoints", by_vtk(offsets, points)),
                           ("splinepy, evaluate", by_splinepy(lattice, None, uvw, threads)),
                           ("MeshLib, apply, degree 7, float32", apply)):
        taken = []
        for _ in range(5):
            start = time.perf_counter()
            function()
            taken.append(1e3 * (time.perf_counter() - start))
        print(f"{threads} processors, {name}: {statistics.median(taken):.1f} ms ({min(taken):.1f} to {max(taken):.1f})", flush=True)


if __name__ == "__main__":
    speed()
