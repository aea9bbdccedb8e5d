/* normals.h - normals from the faces of a polygon mesh by OpenMesh's half-edges (C++ behind C). Declares
   openmesh_load.c too, which a program that loads them has instead. */
#ifndef FFD_IO_OPENMESH_NORMALS_H
#define FFD_IO_OPENMESH_NORMALS_H

#include "mesh/mesh.h"

/* The number of a corner without a group. */
#define NORMALS_NONE UINT32_MAX

#ifdef __cplusplus
extern "C" {
#endif

/* For each group of corners the direction of the sum over its corners of (area of the face) (interior angle
   there) (unit normal of the face, by the order of its corners). Where all of these unit normals are equal,
   the direction is that one, to the bit. Areas are relative to the square of a power of two that brings the
   mesh's largest coordinate to 1 or less. Faces are added in their order. Corners of faces without an area
   add nothing, and neither does a corner that repeats the vertex before it.

     positions   3 doubles a vertex, in place of those of faces
     groups      one a corner of faces: a number below group_count, or NORMALS_NONE
     mirrored    one a vertex, not 0: the faces there are shown from their other side, so that its corners
                 count with the opposite sign; NULL: none
     directions  3 a group, cleared by the caller: a unit vector, or 0 0 0 where nothing is added or the terms
                 cancel out

   No exception leaves, nothing is printed. Errors: FFD_E_MEMORY, FFD_E_LIMIT, FFD_E_UNSUPPORTED (no library),
   FFD_E_ARGUMENT (a corner is not the number of a vertex). */
ffd_status ffd_normals_of_groups(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                                 size_t group_count, const uint8_t *mirrored, double *directions,
                                 ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
