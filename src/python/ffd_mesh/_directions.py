"""Normals and tangents that turn with deformed points."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from . import _arrays as arrays
from . import _library as library
from ._library import Run, lib
from ._values import Deformed


def turned_normals(run: Run, gradients: np.ndarray, normals: Any, what: str = "normals") -> tuple[np.ndarray, int]:
    """Turns normals (N, 3) of points by the gradients of the displacement there, (N, 3, 3). Returns unit vectors of the type of normals,
    and how many have no direction any more and keep theirs. what: how messages call them."""
    source = arrays.readable(arrays.vectors(normals, what, len(gradients)))
    result, collapsed = np.empty(source.shape, source.dtype), ctypes.c_size_t()
    if len(source):
        run(lib.ffd_normals_deform, arrays.address(gradients), arrays.span(source), arrays.span(result), ctypes.byref(collapsed))
    _tell(collapsed.value, what)
    return result, collapsed.value


def turned_tangents(run: Run, gradients: np.ndarray, tangents: Any, normals: np.ndarray | None) -> tuple[np.ndarray, int]:
    """The same of tangents, at right angles to the turned normals; None: there are none."""
    source = arrays.readable(arrays.vectors(tangents, "tangents", len(gradients)))
    result, collapsed = np.empty(source.shape, source.dtype), ctypes.c_size_t()
    across = arrays.span(np.empty((0, 3)) if normals is None else normals)
    if len(source):
        run(lib.ffd_tangents_deform, arrays.address(gradients), across, arrays.span(source), arrays.span(result), ctypes.byref(collapsed))
    _tell(collapsed.value, "tangents")
    return result, collapsed.value


def turned(run: Run, out: np.ndarray, gradients: np.ndarray, normals: Any, tangents: Any, wanted: bool) -> Deformed:
    """Transforms normals and tangents by the gradients of the displacement. out: the deformed points; wanted: gradients are, too."""
    total, across, along = 0, None, None
    if normals is not None:
        across, total = turned_normals(run, gradients, normals)
    if tangents is not None:
        along, more = turned_tangents(run, gradients, tangents, across)
        total += more
    return Deformed(out, across, along, gradients if wanted else None, total)


def _tell(collapsed: int, what: str) -> None:
    if collapsed:
        library.LOG.warning("%d %s have no direction any more, and keep theirs", collapsed, what)
