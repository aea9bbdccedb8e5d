"""Meshes of other packages, deformed with what they store."""

from __future__ import annotations

import io
from typing import Any, Literal, Unpack, overload

import numpy as np

from . import _arrays as arrays
from . import _library as library
from ._cells import Surface, joined, surface
from ._description import Memory, described
from ._directions import turned_normals
from ._lattice import Lattice
from ._library import Progress, Run, lib
from ._mesh_parts import Part, copied
from ._plane import PlaneLattice
from ._result import Result, finish, run
from ._stored import Stored, are_normals, lengths_of, stale, triples, turned_cell_normals, vectors_of
from ._types import ControlPoints, Grid, PointOptions, Rows, names

_OWN = ("offsets", "weights", "normals", "with_result", "progress")


@overload
def deform_mesh(mesh: Any, lattice: Lattice | PlaneLattice, Q: ControlPoints | Grid | None = None, *,
                offsets: ControlPoints | Grid | None = None, weights: Grid | Rows | None = None, normals: bool = True, with_result: Literal[False] = False, progress: Progress | None = None,
                **embed: Unpack[PointOptions]) -> Any: ...


@overload
def deform_mesh(mesh: Any, lattice: Lattice | PlaneLattice, Q: ControlPoints | Grid | None = None, *,
                offsets: ControlPoints | Grid | None = None, weights: Grid | Rows | None = None, normals: bool = True, with_result: Literal[True], progress: Progress | None = None,
                **embed: Unpack[PointOptions]) -> tuple[Any, Result]: ...


def deform_mesh(mesh: Any, lattice: Lattice | PlaneLattice, Q: ControlPoints | Grid | None = None, *,
                offsets: ControlPoints | Grid | None = None, weights: Grid | Rows | None = None, normals: bool = True, with_result: bool = False, progress: Progress | None = None,
                **embed: Unpack[PointOptions]) -> Any:
    """Returns a copy of a mesh with deformed points. Stored normals turn with it. The mesh is not changed.

    mesh: trimesh.Trimesh or PointCloud, meshio.Mesh with points (N, 3), a data set of pyvista. An ImageData or RectilinearGrid comes
      back as a StructuredGrid. A MultiBlock is deformed block by block, as one mesh
    lattice: that of a plane is for meshes at z = 0
    Q, offsets, weights: as in `moved` of the lattice; without them its own deformed control points are used. A lattice whose box is
      "mesh" goes round the points
    normals: False: stored normals stay as they were, with a warning (trimesh computes its own anew)
    with_result: True: return (mesh, result), with a `Result` that has moved, counts["outside"], tear.edges, flipped_faces, warnings
      and the other figures of a job with quality=True
    progress: called from time to time with the fraction done, 0 to 1; returning False cancels
    embed: options of `Lattice.embed`: outside, falloff, snap, threads, isa

    All arrays of normals turn, of points and of cells: what the mesh says are normals, what "normals" is in the name of, and nx, ny, nz.
    Those that are no unit vectors keep their lengths, with a warning. An array that does not have three floats for each point or cell is
    removed with a warning. A warning names other arrays that depend on the shape, and stay: of three components, and with names as
    "tangents", "Area" or "curvature".
    Warnings are in the log "ffd_mesh" and in result.warnings: what the program would warn of, and that nothing moved.
    Raises TypeError for other kinds of meshes, ValueError for points of another shape, and `Error`. Threads may call it at the same time.
    """
    if not isinstance(lattice, (Lattice, PlaneLattice)):
        raise TypeError(f"lattice must be a Lattice, not {type(lattice).__name__}")
    if "snap" in embed:
        embed["snap"] = library.real(embed["snap"], "snap")
    copy, parts = copied(mesh)
    points = [arrays.vectors(part.points, "points") for part in parts]
    whole = np.concatenate(points) if len(points) > 1 else points[0] if points else np.empty((0, 3))
    if isinstance(lattice, Lattice) and lattice.needs_points:
        lattice = lattice.fit(whole)
    move: Any = lattice.moved  # of either: what it takes depends on the lattice
    moved = move(Q, offsets=offsets, weights=weights)
    solid: Lattice = moved.solid if isinstance(moved, PlaneLattice) else moved
    found, result = _deformed(solid, whole, parts, with_result, progress, embed)
    _carry(solid, parts, points, found, normals, result, embed)
    return (copy, result) if with_result else copy


def _deformed(lattice: Lattice, points: np.ndarray, parts: list[Part], quality: bool, progress: Progress | None,
              embed: PointOptions) -> tuple[np.ndarray, Result]:
    """The deformed points, (N, 3) float64, and the result of the program's job on this mesh."""
    starts = np.cumsum([0] + [len(part.points) for part in parts])
    seen = surface(joined([part.cells() for part in parts], list(starts)))
    memory = Memory(_ply(points, seen), "the mesh", None)
    taken: list[Any] = []
    count = sum(map(len, seen.faces))

    def reword(line: str) -> str:
        """Counts no edge as a face."""
        return line.replace(f" of {count + len(seen.edges)} face", f" of {count} face") if line.endswith("turned over") else line
    with described(memory, lattice, embed, names(PointOptions), reword, _OWN) as (desc, warnings), library.progress_into(desc, progress):
        desc.quality, desc.input.format = quality, library.value_of("ffd_format", "ply", "format")
        desc.input.memory = 2**62  # the mesh is in memory already, and no file that may lie about its size
        library.positions_into(desc, taken)
        raw, raised = run(lib.ffd_deform_run, desc)
    result = finish(raw, raised, warnings)
    if result.faces is not None:
        result.faces = count
    if seen.unknown:
        _warn(result, f"edges and faces of cells of the kinds {', '.join(map(str, seen.unknown))} of VTK are not looked at")
    if len(points) and not result.moved:
        _warn(result, "no point moves" + ("" if lattice.offsets.any() else ": no control point of the lattice does"))
    return np.frombuffer(taken[-1], np.float64).reshape(-1, 3) if len(points) else np.empty((0, 3)), result


def _warn(result: Result, line: str) -> None:
    library.LOG.warning("%s", line)
    result.warnings.append(line)


def _ply(points: np.ndarray, seen: Surface) -> bytes:
    """A PLY of a mesh. Its edges are faces of two corners, along which torn edges count; what is alone has an edge, and so is in use."""
    kind = {"float32": "float", "float64": "double"}[points.dtype.name]
    head = "".join(f"property {kind} {axis}\n" for axis in "xyz")
    count, parts = sum(map(len, seen.faces)) + len(seen.edges), []
    for faces in (*seen.faces, seen.edges):
        rows = np.empty(len(faces), [("count", "<u4"), ("points", "<i4", (faces.shape[1],))])
        rows["count"], rows["points"] = faces.shape[1], faces
        parts.append(rows.tobytes())
    stream = io.BytesIO()
    stream.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{head}"
                 f"element face {count}\nproperty list uint int vertex_indices\n"
                 f"element edge {len(seen.alone)}\nproperty int vertex1\nproperty int vertex2\nend_header\n".encode())
    for part in (points.astype(points.dtype.newbyteorder("<")).tobytes(), *parts, seen.alone.astype("<i4").repeat(2).tobytes()):
        stream.write(part)
    return stream.getvalue()


def _carry(lattice: Lattice, parts: list[Part], points: list[np.ndarray], found: np.ndarray, normals: bool, result: Result,
           embed: PointOptions) -> None:
    """Sets the points of the parts, and what they store."""
    at, removed, stays = 0, [], []
    for part, before in zip(parts, points):
        after = found[at:at + len(before)].astype(before.dtype)
        at += len(before)
        stored = part.arrays()
        moves = bool(result.moved) and not np.array_equal(before, after, equal_nan=True)
        turning = triples(stored) if normals else []
        turned = _turned(part, lattice, before, after, turning, result, embed) if moves and turning else []
        part.move(after)
        for group, value in turned if moves else ((group, _unchanged(group)) for group in turning):
            _put(part, group, value)
            removed += [array for array in group if value is None]
        carried = {(array.where, array.name) for group in turning for array in group}
        left = [array for array in stored if moves and part.leaves(array) and (array.where, array.name) not in carried]
        stays += [array for array in left if stale(array) or are_normals(array)]
    _name(result, "removed, because they cannot turn: ", removed)
    _name(result, "kept as they were, though the mesh has moved: ", stays)


def _name(result: Result, what: str, several: list[Stored]) -> None:
    """Warns of arrays."""
    listed = sorted({f"{array.name!r} of the {array.where}" for array in several})
    if listed:
        _warn(result, what + ", ".join(listed))


def _unchanged(group: list[Stored]) -> np.ndarray:
    """The numbers of a group, of which nothing moves."""
    return group[0].value if len(group) == 1 else np.stack([array.value for array in group], axis=-1)


def _put(part: Part, group: list[Stored], value: np.ndarray | None) -> None:
    for column, array in enumerate(group):
        part.put(array, value if value is None or len(group) == 1 else np.ascontiguousarray(value[:, column]))


def _turned(part: Part, lattice: Lattice, before: np.ndarray, after: np.ndarray, groups: list[list[Stored]], result: Result,
            embed: PointOptions) -> list[tuple[list[Stored], np.ndarray | None]]:
    """Normals after the deformation; None: they cannot turn."""
    cells, step = part.cells(), Run(embed.get("threads", 0), embed.get("isa", "auto"), None)
    gradients: Any = lattice.deform(lattice.embed(before, **embed), gradients=True).gradients
    found: list[tuple[list[Stored], np.ndarray | None]] = []
    for group in groups:
        where = group[0].where
        value = None if where == "mesh" else vectors_of(group, len(before) if where == "points" else len(cells.kinds))
        lengths = None if value is None else lengths_of(value)
        turned = value if value is None or lengths is None else value / lengths[:, None]
        if turned is not None and where == "points":
            turned, collapsed = turned_normals(step, gradients, turned)
            if collapsed:
                result.warnings.append(f"{collapsed} normals have no direction any more, and keep theirs")
        elif turned is not None:
            turned = turned_cell_normals(cells, before, after, gradients, turned)
        if turned is not None and lengths is not None:
            turned *= lengths[:, None]
            _name(result, "turned, though they are no unit vectors, with their lengths: ", group)
        found.append((group, None if turned is None or value is None else turned.astype(value.dtype)))
    return found
