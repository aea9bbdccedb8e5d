/* meshopt_simplify.h - a mesh with fewer triangles, by the meshoptimizer library. Declares
   meshopt_simplify.cpp and meshopt_load.c, of which a program has one. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_SIMPLIFY_H
#define FFD_MESH_MESHOPT_MESHOPT_SIMPLIFY_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct meshopt_mesh {
    const float *positions; /* 3 a vertex, finite */
    size_t vertex_count;
    const uint32_t *indices; /* 3 a triangle, each below vertex_count */
    size_t index_count;
} meshopt_mesh;

/* Chooses triangles of the mesh's own vertices, about target indices of them, into result (index_count), and
   sets *count. Open borders keep their vertices. is_rough: gets to the target even where the surface is cut
   up. Errors, without a file's name: FFD_E_UNSUPPORTED (the library is not there), FFD_E_MEMORY. */
ffd_status ffd_meshopt_simplify(const meshopt_mesh *mesh, size_t target, bool is_rough, uint32_t *result,
                                size_t *count, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
