/* extent.h - the area of a mesh, and the volume that it encloses. */
#ifndef FFD_JOB_JUDGE_EXTENT_H
#define FFD_JOB_JUDGE_EXTENT_H

#include "mesh/mesh.h"

typedef struct mesh_extent {
    double area;   /* of all faces; NaN where it is not a number that double holds */
    double volume; /* by the divergence theorem: negative where the faces show their backs outside. NaN where
                      the mesh is not closed, has no faces, or it is no such number */
} mesh_extent;

/* Measures the faces of nodes that are not hidden. Of a polygon that is not flat the area is that of its
   largest shadow, and the volume is bounded by its fan of triangles.

   A mesh is closed where each edge has as many faces that run along it one way as the other. What is at one
   position is one vertex, since formats list a vertex once more for other normals or texture coordinates: a
   mesh that is closed by the numbers of its vertices is closed by their positions too. Edges are summed up
   by their hashes, with opposite signs for opposite ways: that a mesh which is not closed sums up to 0 has a
   chance of 2^-64.

     document   whose vertices they are; NULL: nothing is hidden
     xyz        3 doubles a vertex; one whose first is NaN is where it is in faces */
void ffd_extent_measure(const mesh_document *document, const mesh_faces *faces, const double *xyz,
                        mesh_extent *extent);

#endif
