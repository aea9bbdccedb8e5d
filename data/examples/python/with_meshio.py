"""A mesh of meshio, with cells of any kind, sheared, and written to a file. Needs ffd_mesh and meshio."""

import ffd_mesh as ffd
import meshio
import numpy as np

corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
mesh = meshio.Mesh(corners, [("hexahedron", [[0, 4, 6, 2, 1, 5, 7, 3]])])
lattice = ffd.Lattice.around(mesh.points, size=2)
Q = lattice.rest.copy()
Q[:, :, 1, 0] += 0.5  # the upper control points, along x
sheared = ffd.deform_mesh(mesh, lattice, Q)
meshio.write("sheared.vtk", sheared)
print(f"points from {sheared.points.min(axis=0)} to {sheared.points.max(axis=0)}")
