/* normals.h - normals from the faces of a polygon mesh, with OpenMesh's half-edges (C++ behind a C
   interface). Declares openmesh_load.c too: in a program that loads modules it has this function. */
#ifndef FFD_IO_OPENMESH_NORMALS_H
#define FFD_IO_OPENMESH_NORMALS_H

#include "mesh/mesh.h"

/* The number of a corner without a group. */
#define NORMALS_NONE UINT32_MAX

#ifdef __cplusplus
extern "C" {
#endif

/* Computes for each group of corners the direction of a sum over its corners: (area of the face) * (interior
   angle at the corner) * (unit normal of the face, by the order of its corners). If all these unit normals
   are equal, the direction has exactly their bits. Areas are relative to the square of a power of two that
   is not less than the mesh's largest coordinate. Faces are added in order. Corners of faces without an area
   contribute nothing, nor do corners that repeat the previous vertex.

     positions   3 doubles per vertex, used in place of those in faces
     groups      per corner of faces: a number less than group_count, or NORMALS_NONE
     mirrored    per vertex, nonzero if the faces there are shown from their other side: the vertex's corners
                 then count with the opposite sign; NULL: none
     directions  3 doubles per group, zeroed by the caller; become a unit vector, or 0 0 0 if nothing is
                 added or the terms cancel

   Throws no exception, prints nothing. Errors: FFD_E_MEMORY, FFD_E_LIMIT, FFD_E_UNSUPPORTED (no library),
   FFD_E_ARGUMENT (a corner is not a vertex number). */
ffd_status ffd_normals_of_groups(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                                 size_t group_count, const uint8_t *mirrored, double *directions,
                                 ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
