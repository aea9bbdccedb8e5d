#include "mesh/meshopt/meshopt_simplify.h"
#include <meshoptimizer.h>

/* The error limit: none, because the number of triangles is the criterion. */
#define FARTHEST 1e6f
#define STRIDE (3 * sizeof(float))

/* The library allocates with `operator new`, which throws. The rough way is the header's C++ function: its
   arguments are the same in all versions, those of the C function changed in 0.25. */
extern "C" ffd_status ffd_meshopt_simplify(const meshopt_mesh *mesh, size_t target, bool is_rough,
                                           uint32_t *result, size_t *count, ffd_error *error)
{
    try {
        *count = is_rough ? meshopt_simplifySloppy(result, mesh->indices, mesh->index_count, mesh->positions,
                                                   mesh->vertex_count, STRIDE, target, FARTHEST, nullptr)
                          : meshopt_simplify(result, mesh->indices, mesh->index_count, mesh->positions,
                                             mesh->vertex_count, STRIDE, target, FARTHEST,
                                             meshopt_SimplifyLockBorder, nullptr);
        return FFD_OK;
    } catch (...) {
        return ffd_fail_memory(error);
    }
}
