/* topology.h - figures of a polygon mesh, with OpenMesh's half-edges (C++ behind a C interface). Declares
   openmesh_load.c too: in a program that loads modules it has this function. */
#ifndef FFD_IO_OPENMESH_TOPOLOGY_H
#define FFD_IO_OPENMESH_TOPOLOGY_H

#include "mesh/mesh.h"

/* An edge is a pair of different vertices that are neighbours in a face. A face that passes it twice uses it
   twice. */
typedef struct mesh_topology {
    size_t vertices, faces, edges; /* vertices: without those that repeat the position of another */
    size_t isolated_vertices;      /* in no face that counts */
    size_t degenerate_faces;       /* with fewer than 3 distinct corners; they count in no other figure */
    size_t components;             /* of vertices connected by edges; isolated vertices do not count */
    size_t boundary_edges;         /* used once */
    /* Sets of boundary edges connected by vertices; holes that touch count as one. */
    size_t boundary_loops;
    size_t non_manifold_edges;    /* used more than twice, or twice in the same direction */
    size_t non_manifold_vertices; /* with several fans of faces, or at an edge that is used more than twice */
    long long euler;              /* V - E + F, with the vertices in faces only */
    double area;                  /* the sum of the faces' areas; that of a polygon by Newell's vector */
} mesh_topology;

#ifdef __cplusplus
extern "C" {
#endif

/* Computes the figures. faces stays unchanged, and vertices keep their numbers in the file: a face that
   OpenMesh cannot join to the others gets copies of its vertices with the same source number. Throws no
   exception, prints nothing. Errors: FFD_E_MEMORY, FFD_E_LIMIT, FFD_E_UNSUPPORTED (no library),
   FFD_E_ARGUMENT (a corner is not a vertex number). */
ffd_status ffd_topology_compute(const mesh_faces *faces, mesh_topology *topology, ffd_error *error);
#ifdef __cplusplus
}
#endif

#endif
