"""Cells of meshes, numbered as VTK numbers them: their outer faces and edges, and the areas of faces as vectors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# Kind of VTK -> its corners, around.
_AROUND: dict[int, tuple[int, ...]] = {
    5: (0, 1, 2), 8: (0, 1, 3, 2), 9: (0, 1, 2, 3), 22: (0, 3, 1, 4, 2, 5), 23: (0, 4, 1, 5, 2, 6, 3, 7), 28: (0, 4, 1, 5, 2, 6, 3, 7)}
_POLYGON, _STRIP, _POLYLINE = 7, 6, 4
_LINES: dict[int, tuple[tuple[int, int], ...]] = {3: ((0, 1),), 21: ((0, 2), (2, 1))}
_POINTS = (0, 1, 2)  # nothing, a vertex, several: no edges
# Volume -> the faces of its corners, seen from outside or all from inside.
_TETRA = ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1))
_HEXAHEDRON = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
_WEDGE = ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0))
_PYRAMID = ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))
_VOXEL = tuple(tuple({2: 3, 3: 2, 6: 7, 7: 6}.get(corner, corner) for corner in face) for face in _HEXAHEDRON)


def _with_middles(faces: tuple[tuple[int, ...], ...], edges: tuple[tuple[int, int], ...], corners: int) -> tuple[tuple[int, ...], ...]:
    """The faces of a quadratic volume, which has a point in the middle of each edge after its corners."""
    middle = {frozenset(edge): corners + number for number, edge in enumerate(edges)}
    return tuple(tuple(point for corner, following in zip(face, face[1:] + face[:1]) for point in (corner, middle[frozenset((corner, following))]))
                 for face in faces)


_BASE4 = ((0, 1), (1, 2), (2, 3), (3, 0))
_VOLUMES: dict[int, tuple[tuple[int, ...], ...]] = {
    10: _TETRA, 11: _VOXEL, 12: _HEXAHEDRON, 13: _WEDGE, 14: _PYRAMID,
    24: _with_middles(_TETRA, ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)), 4),
    25: _with_middles(_HEXAHEDRON, (*_BASE4, (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)), 8),
    26: _with_middles(_WEDGE, ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)), 6),
    27: _with_middles(_PYRAMID, (*_BASE4, (0, 4), (1, 4), (2, 4), (3, 4)), 5)}
_VOLUMES[29] = _VOLUMES[25]


class Cells(NamedTuple):
    """Cells: cell c has the points connectivity[offsets[c]:offsets[c + 1]], and is of VTK's kind kinds[c]."""

    connectivity: np.ndarray
    offsets: np.ndarray
    kinds: np.ndarray


class Surface(NamedTuple):
    """What is seen of cells, and the edges inside.

    faces: arrays (F, k) of points, around, one for each k
    edges: (E, 2), of lines and inside of volumes
    alone: points of cells that are in none of these
    unknown: numbers of VTK's kinds whose faces are not known here
    """

    faces: list[np.ndarray]
    edges: np.ndarray
    alone: np.ndarray
    unknown: list[int]


def rows(points: np.ndarray, kind: int) -> Cells:
    """Cells of one kind, (C, k)."""
    count, corners = points.shape
    return Cells(points.reshape(-1).astype(np.int64), np.arange(count + 1) * corners, np.full(count, kind, np.uint8))


def joined(several: list[Cells], first: list[int]) -> Cells:
    """Cells of several meshes, whose points begin at first."""
    if not several:
        return rows(np.empty((0, 3), np.int64), 5)
    starts = np.cumsum([0] + [len(cells.connectivity) for cells in several])
    return Cells(np.concatenate([cells.connectivity + at for cells, at in zip(several, first)]),
                 np.concatenate([[0], *(cells.offsets[1:] + at for cells, at in zip(several, starts))]),
                 np.concatenate([cells.kinds for cells in several]))


def _groups(cells: Cells) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """The cells by kind and number of points: the kind, which cells, and their points (C, k)."""
    sizes = np.diff(cells.offsets)
    if len(sizes) and (sizes == sizes[0]).all() and (cells.kinds == cells.kinds[0]).all():
        return [(int(cells.kinds[0]), np.arange(len(sizes)), cells.connectivity.reshape(len(sizes), -1))]
    found = []
    for kind in np.unique(cells.kinds):
        of_kind = np.flatnonzero(cells.kinds == kind)
        for size in np.unique(sizes[of_kind]):
            which = of_kind[sizes[of_kind] == size]
            found.append((int(kind), which, cells.connectivity[cells.offsets[which][:, None] + np.arange(size)]))
    return found


def _around(kind: int, points: np.ndarray) -> np.ndarray | None:
    """The points of faces (C, k), around; None: they are not faces."""
    if kind == _POLYGON and points.shape[1] > 2:
        return points
    return points[:, _AROUND[kind]] if kind in _AROUND else None


def _lines(kind: int, points: np.ndarray) -> np.ndarray | None:
    """The edges (E, 2) of lines; None: they are none."""
    if kind == _POLYLINE:
        return np.stack([points[:, :-1], points[:, 1:]], axis=-1).reshape(-1, 2)
    return np.concatenate([points[:, line] for line in _LINES[kind]]) if kind in _LINES else None


def _strips(points: np.ndarray) -> np.ndarray:
    """The triangles of strips."""
    found = [points[:, [i, i + 1, i + 2] if i % 2 == 0 else [i + 1, i, i + 2]] for i in range(points.shape[1] - 2)]
    return np.concatenate(found) if found else np.empty((0, 3), np.int64)


def _edges_of(faces: np.ndarray) -> np.ndarray:
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2)


def _each_once(edges: np.ndarray) -> np.ndarray:
    """Edges (E, 2), each once, in whatever direction it is there."""
    width = int(edges.max(initial=0)) + 1  # far below 2**31: a PLY has no more points
    a, b = edges[:, 0], edges[:, 1]
    keys = np.sort(np.minimum(a, b) * width + np.maximum(a, b))  # faster than numpy.unique, which hashes them
    keys = keys[np.diff(keys, prepend=-1) != 0]
    return np.stack([keys // width, keys % width], axis=-1)


def _runs(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An order of rows in which equal ones follow each other, and which of them, in that order, are the first of their kind."""
    width = int(rows.max(initial=0)) + 1
    # Pairs of columns as one number: fewer keys to sort by.
    keys = [rows[:, c] if c + 1 == rows.shape[1] else rows[:, c] * width + rows[:, c + 1] for c in range(0, rows.shape[1], 2)]
    order = np.lexsort(keys)
    first = np.ones(len(rows), bool)
    first[1:] = np.logical_or.reduce([key[order[1:]] != key[order[:-1]] for key in keys])
    return order, first


def _outer(faces: list[np.ndarray]) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """The faces of volumes that no two of them share, and the edges of all others."""
    outer, edges = [], []
    for size in sorted({face.shape[1] for face in faces}):
        of_size = np.concatenate([face for face in faces if face.shape[1] == size])
        order, first = _runs(np.sort(of_size, axis=1))
        last = np.append(first[1:], True)[:len(first)]
        outer.append(of_size[order[first & last]])
        edges.append(_edges_of(of_size[order[first & ~last]]))
    return outer, edges


def surface(cells: Cells) -> Surface:
    """What is seen of cells, and the edges inside."""
    faces, inner, edges, unknown = [], [], [np.empty((0, 2), np.int64)], []
    for kind, _, points in _groups(cells):
        around, lines = _around(kind, points), _lines(kind, points)
        if around is not None:
            faces.append(around)
        elif lines is not None:
            edges.append(lines)
        elif kind == _STRIP:
            faces.append(_strips(points))
        elif kind in _VOLUMES:
            inner += [points[:, face] for face in _VOLUMES[kind]]
        elif kind not in _POINTS:
            unknown.append(kind)
    outer, inside = _outer(inner)
    joint, faces = _each_once(np.concatenate(edges + inside)), [face for face in faces + outer if len(face)]
    alone = np.zeros(int(cells.connectivity.max(initial=-1)) + 1, bool)
    alone[cells.connectivity] = True
    for seen in (joint, *faces):
        alone[seen] = False
    return Surface(faces, joint, np.flatnonzero(alone), sorted(set(unknown)))


def areas(cells: Cells, points: np.ndarray) -> np.ndarray:
    """The areas of faces as vectors along their normals, (C, 3) float64; 0 of other cells."""
    found = np.zeros((len(cells.kinds), 3))
    for kind, which, corners in _groups(cells):
        around = _around(kind, corners)
        if around is None:
            continue
        first = points[around[:, 0]].astype(np.float64)
        for i in range(1, around.shape[1] - 1):
            found[which] += np.cross(points[around[:, i]] - first, points[around[:, i + 1]] - first) / 2
    return found


def means(cells: Cells, values: np.ndarray) -> np.ndarray:
    """The mean of values (N, ...) of points over the points of each cell, (C, ...)."""
    sizes = np.diff(cells.offsets)
    of = np.repeat(np.arange(len(sizes)), sizes)
    flat = values.reshape(len(values), -1)
    columns = [np.bincount(of, flat[cells.connectivity, column], len(sizes)) for column in range(flat.shape[1])]
    return (np.stack(columns, axis=-1) / np.maximum(sizes, 1)[:, None]).reshape(len(sizes), *values.shape[1:])
