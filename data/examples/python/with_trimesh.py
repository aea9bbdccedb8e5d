"""A mesh of trimesh, bulged. Needs ffd_mesh and trimesh."""

import ffd_mesh as ffd
import trimesh

mesh = trimesh.creation.icosphere(subdivisions=4)
lattice = ffd.Lattice.around(mesh.vertices, size=5)
Q = lattice.rest.copy()
Q[1:4, 1:4, 1:4] *= 1.3  # the inner control points, away from the centre
bulged = ffd.deform_mesh(mesh, lattice, Q)
print(f"volume {mesh.volume:.3f} to {bulged.volume:.3f}, watertight: {bulged.is_watertight}")
