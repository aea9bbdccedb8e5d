"""Meshes of trimesh, meshio and pyvista as parts with points, cells and arrays. None of these packages is imported here."""

from __future__ import annotations

from typing import Any, Iterator, MutableMapping

import numpy as np

from ._cells import Cells, joined, rows
from ._stored import Stored

# meshio's name of a kind of cells -> VTK's number. Both number the points of these alike, but for a wedge's turn.
_KINDS = {"vertex": 1, "line": 3, "triangle": 5, "polygon": 7, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14,
          "line3": 21, "triangle6": 22, "quad8": 23, "tetra10": 24, "hexahedron20": 25, "wedge15": 26, "pyramid13": 27, "quad9": 28,
          "hexahedron27": 29}


class Part:
    """A mesh with points, of one of the packages, which is changed in place: a copy of the caller's."""

    def __init__(self, mesh: Any) -> None:
        self.mesh = mesh

    @property
    def points(self) -> Any:
        """Its points, (N, 3)."""
        return self.mesh.points

    def move(self, points: np.ndarray) -> None:
        """Sets its points."""
        self.mesh.points = points

    def cells(self) -> Cells:
        """Its cells."""
        raise NotImplementedError

    def arrays(self) -> list[Stored]:
        """What it stores for points, for cells, and for itself."""
        raise NotImplementedError

    def put(self, array: Stored, value: np.ndarray | None) -> None:
        """Replaces an array; None: removes it."""
        raise NotImplementedError

    def leaves(self, array: Stored) -> bool:
        """Whether an array that is not replaced stays as it was when the points are set."""
        return True


def _set(mapping: MutableMapping[str, Any], name: str, value: Any) -> None:
    if value is None:
        del mapping[name]
    else:
        mapping[name] = value


class TrimeshPart(Part):
    """A Trimesh or PointCloud of trimesh."""

    def __init__(self, mesh: Any, given: Any) -> None:
        """given: the mesh that it is a copy of. Only normals that came with it are cached; trimesh computes others when asked."""
        super().__init__(mesh)
        self._own = []
        if "vertex_normals" in getattr(given, "_cache", ()):
            self._own = [Stored("points", "vertex_normals", np.array(given.vertex_normals), True)]

    @property
    def points(self) -> Any:
        """Its points, (N, 3)."""
        return self.mesh.vertices

    def move(self, points: np.ndarray) -> None:
        """Sets its points."""
        self.mesh.vertices = points

    def cells(self) -> Cells:
        """Its cells."""
        return rows(np.asarray(getattr(self.mesh, "faces", np.empty((0, 3), np.int64))), 5)

    def _mappings(self) -> dict[str, MutableMapping[str, Any]]:
        return {"points": getattr(self.mesh, "vertex_attributes", {}), "cells": getattr(self.mesh, "face_attributes", {}),
                "mesh": self.mesh.metadata}

    def arrays(self) -> list[Stored]:
        """What it stores for points, for cells, and for itself."""
        return self._own + [Stored(where, name, value) for where, mapping in self._mappings().items() for name, value in mapping.items()
                            if isinstance(value, np.ndarray)]

    def leaves(self, array: Stored) -> bool:
        """Whether an array that is not replaced stays as it was when the points are set."""
        return not array.is_normals

    def put(self, array: Stored, value: np.ndarray | None) -> None:
        """Replaces an array; None: removes it."""
        if array.is_normals:
            if value is not None:
                self.mesh.vertex_normals = value
            return
        _set(self._mappings()[array.where], array.name, value)


class MeshioPart(Part):
    """A Mesh of meshio."""

    def cells(self) -> Cells:
        """Its cells."""
        return joined([_block(block) for block in self.mesh.cells], [0] * len(self.mesh.cells))

    def arrays(self) -> list[Stored]:
        """What it stores for points, for cells, and for itself."""
        mesh = self.mesh
        return [*(Stored("points", name, value) for name, value in mesh.point_data.items()),
                *(Stored("cells", name, _stacked(value)) for name, value in mesh.cell_data.items()),
                *(Stored("mesh", name, value) for name, value in mesh.field_data.items())]

    def put(self, array: Stored, value: np.ndarray | None) -> None:
        """Replaces an array; None: removes it."""
        if array.where == "cells" and value is not None:
            ends = np.cumsum([len(block.data) for block in self.mesh.cells])[:-1]
            self.mesh.cell_data[array.name] = np.split(value, ends)
            return
        _set({"points": self.mesh.point_data, "cells": self.mesh.cell_data, "mesh": self.mesh.field_data}[array.where], array.name, value)


def _stacked(blocks: Any) -> np.ndarray:
    """The array of all cells of meshio; an empty one where the blocks do not fit together."""
    values = [np.asarray(block) for block in blocks]
    fit = values and len({(value.shape[1:], value.dtype.kind) for value in values}) == 1
    return np.concatenate(values) if fit else np.empty(0)


def _block(block: Any) -> Cells:
    """The cells of a block of meshio."""
    data = block.data
    if isinstance(data, np.ndarray) and data.ndim == 2:
        name = "polygon" if block.type.startswith("polygon") else block.type
        return rows(data, _KINDS.get(name, 255))
    corners = [np.unique(np.concatenate([np.ravel(face) for face in cell])) if block.type.startswith("polyhedron") else np.ravel(cell)
               for cell in data]
    kind = 255 if block.type.startswith("polyhedron") else _KINDS["polygon"]
    return joined([rows(points.astype(np.int64)[None], kind) for points in corners], [0] * len(corners))


class PyvistaPart(Part):
    """A data set of pyvista with points that can be set."""

    def cells(self) -> Cells:
        """Its cells."""
        grid = self.mesh.cast_to_unstructured_grid()
        offsets = grid.cell_offsets if hasattr(grid, "cell_offsets") else grid.offset
        return Cells(np.asarray(grid.cell_connectivity, np.int64), np.asarray(offsets, np.int64), np.asarray(grid.celltypes))

    def _mappings(self) -> dict[str, Any]:
        return {"points": self.mesh.point_data, "cells": self.mesh.cell_data, "mesh": self.mesh.field_data}

    def arrays(self) -> list[Stored]:
        """What it stores for points, for cells, and for itself."""
        return [Stored(where, name, np.asarray(mapping[name]), where != "mesh" and name == mapping.active_normals_name)
                for where, mapping in self._mappings().items() for name in mapping.keys()]

    def put(self, array: Stored, value: np.ndarray | None) -> None:
        """Replaces an array; None: removes it."""
        mapping = self._mappings()[array.where]
        _set(mapping, array.name, value)
        if array.is_normals and value is not None:
            mapping.active_normals_name = array.name


def library_of(mesh: Any) -> str:
    """The package that defines the mesh's class or one of its base classes; "" if it is none of the three."""
    for kind in type(mesh).__mro__:
        package = kind.__module__.partition(".")[0]
        if package in ("trimesh", "meshio", "pyvista"):
            return package
    return ""


def _blocks(mesh: Any) -> Iterator[Any]:
    """The data sets of a MultiBlock of pyvista, at any depth."""
    for block in mesh:
        if hasattr(block, "point_data"):
            yield block
        elif block is not None:
            yield from _blocks(block)


def _is_blocks(mesh: Any) -> bool:
    return any(kind.__name__ == "MultiBlock" for kind in type(mesh).__mro__)


def _with_points(mesh: Any) -> Any:
    """A deep copy of a data set of pyvista, or of its blocks. Grids without points of their own become a StructuredGrid."""
    if _is_blocks(mesh):
        copy = mesh.copy(deep=True)
        for index, block in enumerate(mesh):
            if block is not None:
                copy.replace(index, _with_points(block))
        return copy
    kinds = {kind.__name__ for kind in type(mesh).__mro__}
    if kinds & {"ImageData", "RectilinearGrid"}:
        return mesh.cast_to_structured_grid().copy(deep=True)
    if not hasattr(type(mesh), "points") or not hasattr(mesh, "point_data"):
        raise _refused(mesh)
    return mesh.copy(deep=True)


def _refused(mesh: Any) -> TypeError:
    """The exception for what is not a mesh."""
    return TypeError(f"{type(mesh).__module__}.{type(mesh).__qualname__} is no mesh with points of trimesh, meshio or pyvista")


def copied(mesh: Any) -> tuple[Any, list[Part]]:
    """A copy of a mesh, and its parts, which change it. Raises TypeError for what is not a mesh, and ValueError for points in a plane."""
    package = library_of(mesh)
    if package == "trimesh" and hasattr(mesh, "vertices"):
        copy = mesh.copy()
        return copy, [TrimeshPart(copy, mesh)]
    if package == "meshio" and hasattr(mesh, "cells"):
        shape = np.shape(mesh.points)
        if len(shape) == 2 and shape[1] == 2:
            raise ValueError(f"points must have the shape (N, 3), not {shape}: a mesh in a plane needs a column of zeros for z")
        copy = mesh.copy()
        return copy, [MeshioPart(copy)]
    if package == "pyvista" and (_is_blocks(mesh) or hasattr(mesh, "point_data")):
        copy = _with_points(mesh)
        return copy, [PyvistaPart(block) for block in (_blocks(copy) if _is_blocks(copy) else [copy])]
    raise _refused(mesh)
