/* meshopt_module.h - the function table of the module with meshoptimizer. meshopt_module.c is part of the
   module, meshopt_load.c of the program that loads it. */
#ifndef FFD_MESH_MESHOPT_MESHOPT_MODULE_H
#define FFD_MESH_MESHOPT_MESHOPT_MODULE_H

#include "base/system/module.h"
#include "mesh/meshopt/meshopt_library.h"
#include "mesh/meshopt/meshopt_simplify.h"
#include <ffd/version.h>

#define MESHOPT_IDENTITY                                                                                     \
    {                                                                                                        \
        "ffd-meshopt.so", FFD_VERSION, 5                                                                     \
    }

typedef struct meshopt_module {
    module_head head;
    ffd_status (*decode)(const meshopt_view *view, unsigned char *bytes, ffd_error *error);
    ffd_status (*simplify)(const meshopt_mesh *mesh, size_t target, bool is_rough, uint32_t *result,
                           size_t *count, ffd_error *error);
} meshopt_module;

#endif
