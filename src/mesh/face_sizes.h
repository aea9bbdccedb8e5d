/* face_sizes.h - counts faces by their number of corners, for descriptions. */
#ifndef FFD_MESH_FACE_SIZES_H
#define FFD_MESH_FACE_SIZES_H

#include <stddef.h>

typedef struct face_sizes {
    size_t triangles, quads, ngons; /* faces with 3, 4 and more corners */
} face_sizes;

static inline void face_sizes_count(face_sizes *sizes, size_t corners)
{
    sizes->triangles += corners == 3;
    sizes->quads += corners == 4;
    sizes->ngons += corners > 4;
}

#endif
