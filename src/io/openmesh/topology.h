/* topology.h - figures of a polygon mesh by OpenMesh's half-edges (C++ behind this C interface). */
#ifndef FFD_IO_OPENMESH_TOPOLOGY_H
#define FFD_IO_OPENMESH_TOPOLOGY_H

#include "mesh/mesh.h"

typedef struct mesh_topology {
    size_t vertices, faces, edges; /* edges: distinct pairs of neighbours in a face */
    size_t isolated_vertices;      /* in no face */
    size_t degenerate_faces;       /* fewer than 3 distinct corners: in no other figure */
    size_t components;             /* connected by edges; isolated vertices are none */
    size_t boundary_loops, boundary_edges;
    size_t non_manifold_edges;    /* in more than two faces, or in two that disagree on its direction */
    size_t non_manifold_vertices; /* whose faces do not form one fan */
    long long euler;              /* V - E + F over vertices in faces */
    double area;                  /* sum of the faces' areas, polygons by Newell's vector */
} mesh_topology;

/* Computes the figures. faces is not changed; vertex numbers stay those of the file: a face that OpenMesh
   cannot join gets copies of its vertices with the same source number. Errors: FFD_E_MEMORY, FFD_E_LIMIT. No
   exception leaves. */
#ifdef __cplusplus
extern "C" {
#endif
ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error);
#ifdef __cplusplus
}
#endif

#endif
