"""A mesh of pyvista, squeezed at its waist, with its normals. Needs ffd_mesh and pyvista."""

import ffd_mesh as ffd
import pyvista

mesh = pyvista.Cylinder(direction=(0, 0, 1), radius=0.5, height=2.0, resolution=60).triangulate().subdivide(2)
mesh = mesh.compute_normals(split_vertices=True)
lattice = ffd.Lattice.around(mesh.points, size=(4, 4, 7))
Q = lattice.rest.copy()
Q[:, :, 3, :2] *= 0.5
squeezed = ffd.deform_mesh(mesh, lattice, Q)
print(f"volume {mesh.volume:.3f} to {squeezed.volume:.3f}")
