/* extent.h - the area of a mesh, and its enclosed volume. */
#ifndef FFD_JOB_MEASURE_EXTENT_H
#define FFD_JOB_MEASURE_EXTENT_H

#include "mesh/mesh.h"

typedef struct mesh_extent {
    double area;   /* of all faces; NaN if a vertex of one is not finite */
    double volume; /* by the divergence theorem, negative if faces are inside out. NaN likewise, and if the
                      mesh is not closed or has no faces */
} mesh_extent;

/* Measures the faces of visible nodes. What is too large for a double is infinite. The area of a polygon that
   is not flat is that of its largest projection, and its volume is bounded by its fan of triangles.

   A mesh is closed if each edge is used equally often in both directions. Vertices at one position are one,
   because formats repeat vertices for other normals or texture coordinates; a mesh that is closed by its
   indices is also closed by its positions. The test sums hashes of directed edges, opposite directions with
   opposite signs: the sum of an open mesh is 0 with a probability of 2^-64.

     document   of the vertices, to find hidden nodes; NULL: nothing is hidden
     xyz        3 doubles a vertex; if the first is NaN, the position in faces is taken */
void ffd_extent_measure(const mesh_document *document, const mesh_faces *faces, const double *xyz,
                        mesh_extent *extent);

#endif
