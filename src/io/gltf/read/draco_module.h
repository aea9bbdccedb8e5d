/* draco_module.h - the functions of the Draco module. draco_module.c is part of the module; a program that
   loads the module has draco_load.c instead. */
#ifndef FFD_IO_GLTF_READ_DRACO_MODULE_H
#define FFD_IO_GLTF_READ_DRACO_MODULE_H

#include "base/system/module.h"
#include "io/gltf/read/draco.h"
#include <ffd/version.h>

#define DRACO_IDENTITY                                                                                       \
    {                                                                                                        \
        "ffd-draco.so", FFD_VERSION, 3                                                                       \
    }

typedef struct draco_module {
    module_head head;
    ffd_status (*decode)(const unsigned char *bytes, size_t size, const draco_claim *claim,
                         const memory_budget *budget, draco_mesh **mesh, ffd_error *error);
    void (*free)(draco_mesh *mesh);
    size_t (*point_count)(const draco_mesh *mesh);
    size_t (*corner_count)(const draco_mesh *mesh);
    ffd_status (*attribute)(const draco_mesh *mesh, uint32_t id, int component, int components, size_t stride,
                            unsigned char *bytes, ffd_error *error);
    double (*step)(const draco_mesh *mesh, uint32_t id);
    ffd_status (*indices)(const draco_mesh *mesh, int component, unsigned char *bytes, ffd_error *error);
} draco_module;

#endif
