/* meshopt_simplify.h - simplifies meshes with the meshoptimizer library. Implemented in meshopt_simplify.cpp
   or, for a program that loads the module, in meshopt_load.c. */
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
    const float *positions; /* 3 for each vertex, finite */
    size_t vertex_count;
    const uint32_t *indices; /* 3 for each triangle, each below vertex_count */
    size_t index_count;
} meshopt_mesh;

/* Simplifies a mesh to about `target` indices, with a subset of its vertices. result: room for index_count
   indices, of which *count are set. Open borders keep their vertices. is_rough: reaches the target even if
   the surface consists of many pieces. Errors, without a file name: FFD_E_UNSUPPORTED (the library is
   missing), FFD_E_MEMORY. */
ffd_status ffd_meshopt_simplify(const meshopt_mesh *mesh, size_t target, bool is_rough, uint32_t *result,
                                size_t *count, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
