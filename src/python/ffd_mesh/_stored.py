"""Arrays that meshes store for their points and cells: which are normals, and what else no longer fits once the mesh has moved."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np

from ._cells import Cells, areas, means

_NORMALS = {"normal", "normals"}
_PARTS = ("nx", "ny", "nz")
# Words in names of arrays that depend on where the points are.
_MEASURES = {"area", "areas", "volume", "volumes", "length", "lengths", "curvature", "curvatures", "quality", "tangent", "tangents",
             "bitangent", "bitangents", "binormal", "binormals"}
# Words in names of arrays that do not, though they have three numbers.
_FREE = {"color", "colors", "colour", "colours", "rgb", "uv", "tcoords", "texture"}


class Stored(NamedTuple):
    """An array of a mesh. where: "points", "cells" or "mesh", which it belongs to. is_normals: the mesh says so itself."""

    where: str
    name: str
    value: Any
    is_normals: bool = False


def _words(name: str) -> set[str]:
    """The words of a name such as "vertex_normals", "PointNormals" or "NORMALS"."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+", str(name))}


def are_normals(array: Stored) -> bool:
    """Whether these are normals, by what the mesh or their name says. Single numbers of points and cells are none."""
    return array.is_normals or bool(_words(array.name) & _NORMALS) and (array.where == "mesh" or np.ndim(array.value) == 2)


def triples(arrays: list[Stored]) -> list[list[Stored]]:
    """The arrays in groups that turn together: normals by themselves, and nx, ny, nz of one place."""
    found = [[array] for array in arrays if are_normals(array)]
    for where in ("points", "cells"):
        by_name = {str(array.name).lower(): array for array in arrays if array.where == where and np.ndim(array.value) == 1}
        if all(name in by_name for name in _PARTS):
            found.append([by_name[name] for name in _PARTS])
    return found


def vectors_of(group: list[Stored], count: int) -> np.ndarray | None:
    """Normals as (count, 3); None: they are not vectors of floats, one for each point or cell."""
    value = np.asarray(group[0].value) if len(group) == 1 else np.stack([np.asarray(array.value) for array in group], axis=-1)
    return value if value.dtype.kind == "f" and value.shape == (count, 3) else None


def lengths_of(vectors: np.ndarray) -> np.ndarray | None:
    """The lengths of vectors (N, 3), which are 1 for those without a direction; None: all are 1 within a hundredth."""
    lengths = np.sqrt((vectors.astype(np.float64) ** 2).sum(axis=1))
    lengths[~np.isfinite(lengths) | (lengths == 0)] = 1
    return lengths if (np.abs(lengths - 1) >= 0.01).any() else None


def stale(array: Stored) -> bool:
    """Whether an array other than normals may depend on the shape of the mesh."""
    words, value = _words(array.name), np.asarray(array.value)
    directed = value.ndim == 2 and value.shape[1] == 3 and value.dtype.kind == "f" and not words & _FREE
    return array.where != "mesh" and (directed or bool(words & (_MEASURES | _NORMALS)))


def turned_cell_normals(cells: Cells, before: np.ndarray, after: np.ndarray, gradients: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Turns unit normals (C, 3) of cells with the mesh. Threads may call it at the same time.

    before, after: its points (N, 3); gradients: of the displacement, (N, 3, 3)
    The part of a normal along that of its face goes to the deformed face's own, in the ratio of their areas; the rest, as all of a
    cell that is no face, turns by the cofactor matrix of the mean deformation gradient F of the cell's points. Where one affine map
    moves a cell both are the same. Cells that do not move keep their bits.
    """
    rest, moved = areas(cells, before), areas(cells, after)
    size = np.sqrt((rest**2).sum(axis=1))
    flat = size > 0
    unit = np.where(flat[:, None], rest / np.where(flat, size, 1)[:, None], 0)
    F = np.eye(3) + means(cells, gradients)
    along = (normals * unit).sum(axis=1)
    across = normals - along[:, None] * unit
    r = [F[:, row] for row in range(3)]
    cofactors = np.stack([np.cross(r[1], r[2]), np.cross(r[2], r[0]), np.cross(r[0], r[1])], axis=1)
    found = np.einsum("cij,cj->ci", cofactors, across) + (along / np.where(flat, size, 1))[:, None] * moved
    length = np.sqrt((found**2).sum(axis=1))
    still = means(cells, ((before != after).any(axis=1) | gradients.any(axis=(1, 2))).astype(np.float64)) == 0
    keeps = still | ~np.isfinite(length) | (length == 0)
    turned = found / np.where(keeps, 1, length)[:, None]
    return np.where(keeps[:, None], normals, turned).astype(normals.dtype)
