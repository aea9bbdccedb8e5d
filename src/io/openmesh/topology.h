/* topology.h - figures of a polygon mesh by OpenMesh's half-edges (C++ behind this C interface). Declares
   openmesh_load.c too, which a program that loads them has instead. */
#ifndef FFD_IO_OPENMESH_TOPOLOGY_H
#define FFD_IO_OPENMESH_TOPOLOGY_H

#include "mesh/mesh.h"

/* An edge is a pair of different vertices that are neighbours in a face; a face that passes
   it twice uses it twice. */
typedef struct mesh_topology {
    size_t vertices, faces, edges; /* vertices: without those that repeat another's position */
    size_t isolated_vertices;      /* in no face that counts */
    size_t degenerate_faces;       /* fewer than 3 distinct corners: in no other figure */
    size_t components;             /* of vertices connected by edges; isolated vertices are none */
    size_t boundary_edges;         /* used once */
    size_t boundary_loops;     /* sets of boundary edges connected by vertices (holes that touch are one) */
    size_t non_manifold_edges; /* used more than twice, or twice in the same direction */
    size_t non_manifold_vertices; /* with several fans of faces, or at an edge used more than twice */
    long long euler;              /* V - E + F over vertices in faces */
    double area;                  /* sum of the faces' areas, polygons by Newell's vector */
} mesh_topology;

#ifdef __cplusplus
extern "C" {
#endif

/* Computes the figures. faces is not changed; vertex numbers stay those of the file: a face that OpenMesh
   cannot join gets copies of its vertices with the same source number. No exception leaves, nothing is
   printed. Errors: FFD_E_MEMORY, FFD_E_LIMIT, FFD_E_UNSUPPORTED (no library), FFD_E_ARGUMENT (a corner is not
   the number of a vertex). */
ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error);
#ifdef __cplusplus
}
#endif

#endif
