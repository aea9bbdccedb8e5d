"""Whether the cells of a volume mesh are inverted, and how well they are shaped."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Sequence, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from . import _arrays as arrays
from . import _library as library
from ._library import Progress, lib
from ._types import Doubles, Rows, Triangles


class Cells(NamedTuple):
    """What `cells` returns: an entry for each cell.

    inverted: (C,) bool, whether the Jacobian is 0 or below somewhere, for certain
    unknown: (C,) bool, whether that could not be decided; inverted is False then
    jacobian: (C,) float64, the least determinant that was looked at; NaN where a coordinate is not finite
    scaled_jacobian: (C,) float64, as the Verdict library defines it; NaN of polyhedra, prisms with five and six sides, and where a
      coordinate is not finite
    """

    inverted: NDArray[np.bool_]
    unknown: NDArray[np.bool_]
    jacobian: Doubles
    scaled_jacobian: Doubles


def _indices(value: Any, count: int) -> NDArray[np.uint32]:
    """Checks that value holds the indices of points. Returns them as the library takes them."""
    array = arrays.numbers(value, "cells")
    if array.size == 0:
        return np.empty(array.shape, np.uint32)
    if array.dtype.kind == "f":
        raise TypeError(f"cells must hold integers, not {array.dtype}")
    for bad in (int(array.min()), int(array.max())):
        if not 0 <= bad < count:
            raise ValueError(f"cells has the point {bad}, but there are {count} (counted from 0)")
    return np.ascontiguousarray(array, np.uint32)


def _faces(cells: Any, count: int) -> tuple[NDArray[np.uint32], NDArray[np.uint64]]:
    """The words of polyhedra, and where each cell begins."""
    words: list[NDArray[np.uint32]] = []
    offsets, at = [0], 0
    for cell in cells:
        faces = [_indices(face, count).reshape(-1) for face in cell]
        words.append(np.array([len(faces)], np.uint32))
        for face in faces:
            words += [np.array([len(face)], np.uint32), face]
        at += 1 + sum(1 + len(face) for face in faces)
        offsets.append(at)
    return np.concatenate(words) if words else np.empty(0, np.uint32), np.array(offsets, np.uint64)


def cells(points: Rows, cells: Triangles | Sequence[Sequence[Sequence[SupportsIndex]]], kind: str, *, threads: int = 0, progress: Progress | None = None) -> Cells:
    """Finds cells that are inverted, and how well they are shaped.

    points: (N, 3), any unit. cells: (C, n) indices of points, numbered as meshio numbers them. kind: meshio's name, such as "tetra",
      "hexahedron" or "wedge15". Of "polyhedron" (also with a number behind it) cells is a list of cells, each a list of faces, each
      the indices of its vertices, which go round counterclockwise, seen from outside.
    threads never changes a bit. progress(fraction) may return False to cancel.

    Tetrahedra are decided exactly; hexahedra by the Bezier coefficients of the Jacobian; wedges and pyramids by corners and Gauss
    points; quadratic cells by corners, middles and Gauss points, unknown where these disagree in sign; polyhedra by tetrahedra
    round their centre (ffd/cells.h). Raises ValueError for a kind that is not known.
    """
    pts = arrays.readable(arrays.vectors(points, "points"))
    desc = library.filled("ffd_cells_desc")
    desc.points = arrays.span(pts)
    desc.kind = library.encoded(kind, "kind")
    width = lib.ffd_cells_kind_points(desc.kind)
    if width < 0:
        raise ValueError(f"{kind!r} is not a kind of volume cells that is known here")
    if width == 0:
        words, offsets = _faces(cells, len(pts))
        desc.offsets, count = arrays.address(offsets), len(offsets) - 1
    else:
        words = _indices(cells, len(pts))
        words = words if words.size else words.reshape(-1, width)
        if words.ndim != 2 or words.shape[1] != width:
            raise ValueError(f"cells must have the shape (C, {width}), not {words.shape}")
        count = len(words)
    found = Cells(np.empty(count, np.bool_), np.empty(count, np.bool_), np.empty(count), np.empty(count))
    desc.cells, desc.count = arrays.address(words), count
    for name, array in found._asdict().items():
        setattr(desc, name, arrays.address(array))
    library.Run(threads, "auto", progress)(lib.ffd_cells_measure, ctypes.byref(desc))
    return found
