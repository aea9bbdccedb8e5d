/* half_edges.h - what OpenMesh's half-edges cost. */
#ifndef FFD_IO_OPENMESH_HALF_EDGES_H
#define FFD_IO_OPENMESH_HALF_EDGES_H

#include "mesh/mesh.h"

/* Bytes of memory that the half-edges of these faces need about at most, with what topology.h or normals.h
   finds by them. */
uint64_t ffd_half_edge_bytes(const mesh_faces *faces);

#endif
