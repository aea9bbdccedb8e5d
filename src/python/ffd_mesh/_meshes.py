"""Meshes of trimesh, meshio and pyvista, none of which is imported here."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._lattice import Lattice


def _library_of(mesh: Any) -> str:
    """The package that defines the mesh's class or one of its base classes; "" if it is none of the three."""
    for kind in type(mesh).__mro__:
        package = kind.__module__.partition(".")[0]
        if package in ("trimesh", "meshio", "pyvista"):
            return package
    return ""


def deform_mesh(mesh: Any, lattice: Lattice, Q: Any = None, *, offsets: Any = None, weights: Any = None, normals: bool = True,
                **embed: Any) -> Any:
    """Returns a copy of a mesh with deformed points, and with its stored normals deformed too. The mesh is not changed.

    mesh: trimesh.Trimesh or PointCloud, meshio.Mesh, pyvista.PolyData or another pyvista data set with points
    Q, offsets, weights: as in `Lattice.moved`; without them the lattice's own deformed control points are used
    normals: False: keep stored normals (meshio, pyvista), or let trimesh recompute them
    embed: options of `Lattice.embed`: outside, falloff, snap, threads, isa, progress
    Raises TypeError for other kinds of meshes, and `Error`.
    """
    lattice = lattice.moved(Q, offsets=offsets, weights=weights)
    package = _library_of(mesh)
    if package == "trimesh" and hasattr(mesh, "vertices"):
        return _deform_trimesh(mesh, lattice, normals, embed)
    if package == "meshio":
        return _deform_meshio(mesh, lattice, normals, embed)
    if package == "pyvista" and hasattr(type(mesh), "points") and hasattr(mesh, "point_data"):
        return _deform_pyvista(mesh, lattice, normals, embed)
    raise TypeError(f"{type(mesh).__module__}.{type(mesh).__qualname__} is no mesh with points of trimesh, meshio or pyvista")


def _deformed(lattice: Lattice, points: Any, normals: Any, embed: dict[str, Any]) -> tuple[np.ndarray, Any]:
    points = np.asarray(points)
    if lattice.needs_points:
        lattice = lattice.fit(points)
    found = lattice.deform(lattice.embed(points, **embed), normals=normals)
    return (found, None) if normals is None else (found.points, found.normals)


def _deform_trimesh(mesh: Any, lattice: Lattice, normals: bool, embed: dict[str, Any]) -> Any:
    # Only normals that came with the mesh are cached here; trimesh computes others from the faces when asked.
    stored = normals and "vertex_normals" in getattr(mesh, "_cache", ())
    found, carried = _deformed(lattice, mesh.vertices, np.array(mesh.vertex_normals) if stored else None, embed)
    copy = mesh.copy()
    copy.vertices = found
    if stored:
        copy.vertex_normals = carried
    return copy


def _deform_meshio(mesh: Any, lattice: Lattice, normals: bool, embed: dict[str, Any]) -> Any:
    names = [name for name, data in mesh.point_data.items()
             if normals and name.lower() == "normals" and np.shape(data) == np.shape(mesh.points)]
    name = names[0] if names else None
    found, carried = _deformed(lattice, mesh.points, mesh.point_data[name] if names else None, embed)
    copy = mesh.copy()
    copy.points = found
    if names:
        copy.point_data[name] = carried
    return copy


def _deform_pyvista(mesh: Any, lattice: Lattice, normals: bool, embed: dict[str, Any]) -> Any:
    name = mesh.point_data.active_normals_name if normals else None
    found, carried = _deformed(lattice, mesh.points, np.array(mesh.point_data[name]) if name else None, embed)
    copy = mesh.copy(deep=True)
    copy.points = found
    if name:
        copy.point_data[name] = carried
        copy.point_data.active_normals_name = name
    return copy
