/* half_edges.h - the memory of OpenMesh's half-edges. */
#ifndef FFD_IO_OPENMESH_HALF_EDGES_H
#define FFD_IO_OPENMESH_HALF_EDGES_H

#include "mesh/mesh.h"

/* Returns about the maximum number of bytes for the half-edges of these faces, including what topology.h or
   normals.h computes from them. */
uint64_t ffd_half_edge_bytes(const mesh_faces *faces);

#endif
