#!/usr/bin/env python3
"""Seconds that another library takes to displace points by a cubic lattice of 8^3, a line a run; exit 77: not there.

    points.py SciPy|VTK POINTS RUNS
"""

import sys
import time


def scipy(points):
    """The tensor B-spline of ndimage, one coordinate after another."""
    import numpy
    from scipy import ndimage
    draw = numpy.random.default_rng(7)
    coefficients, places = draw.random((3, 8, 8, 8)), 7 * draw.random((3, points))

    def run():
        for axis in coefficients:
            ndimage.map_coordinates(axis, places, order=3, prefilter=False, mode="nearest")
    return run


def vtk(points):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersHybrid import vtkBSplineTransform
    import numpy
    draw = numpy.random.default_rng(7)
    image, source, target, transform = vtkImageData(), vtkPoints(), vtkPoints(), vtkBSplineTransform()
    image.SetDimensions(8, 8, 8)
    image.GetPointData().SetScalars(numpy_to_vtk(draw.random((512, 3)), deep=True))
    source.SetData(numpy_to_vtk(7 * draw.random((points, 3)), deep=True))
    transform.SetCoefficientData(image)

    def run():
        target.Reset()
        transform.TransformPoints(source, target)
    return run


def main():
    try:
        run = {"SciPy": scipy, "VTK": vtk}[sys.argv[1]](int(sys.argv[2]))
    except ImportError:
        sys.exit(77)
    for _ in range(int(sys.argv[3])):
        start = time.perf_counter()
        run()
        print(time.perf_counter() - start)


main()
