"""Weights of points, as the library takes them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from . import _arrays as arrays
from ._library import Run, lib
from ._values import triangles_of


class Weighted(NamedTuple):
    """Weights of points (N,), and their slopes (N, 3); None: there are none."""

    weights: np.ndarray | None = None
    slopes: np.ndarray | None = None

    @property
    def addresses(self) -> tuple[int | None, int | None]:
        """Where both are, for the library."""
        weights, slopes = (None if array is None else arrays.address(array) for array in self)
        return weights, slopes


def weighted(run: Run, points: np.ndarray, weight: Any, triangles: Any, wanted: bool, directions: bool) -> Weighted:
    """Checks weights of points, and finds their slopes where gradients take them.

    wanted: gradients are; directions: normals or tangents are, which need the slopes
    """
    if weight is None:
        if triangles is not None:
            raise ValueError("triangles= is for weight=")
        return Weighted()
    count = len(points)
    weights = arrays.doubles(weight, "weight", (count,))
    if triangles is None and directions:
        raise ValueError("normals and tangents need triangles= with weight=: without the slope of the weight they are wrong by degrees")
    if triangles is None or not wanted:
        return Weighted(weights)
    faces, slopes = triangles_of(triangles, count), np.empty((count, 3))
    run(lib.ffd_weight_slopes, arrays.span(points), arrays.address(weights), arrays.address(faces), len(faces),
        arrays.address(slopes))
    return Weighted(weights, slopes)
