/* tinygltf_module.h - the functions of the tinygltf module. tinygltf_module.c is part of the module; a
   program that loads the module has tinygltf_load.c instead. */
#ifndef FFD_IO_GLTF_READ_TINYGLTF_MODULE_H
#define FFD_IO_GLTF_READ_TINYGLTF_MODULE_H

#include "base/system/module.h"
#include "io/gltf/read/gltf_model.h"
#include <ffd/version.h>

#define TINYGLTF_IDENTITY                                                                                    \
    {                                                                                                        \
        "ffd-tinygltf.so", FFD_VERSION, 4                                                                    \
    }

typedef struct tinygltf_module {
    module_head head;
    ffd_status (*parse_model)(const char *text, size_t size, const char *name, gltf_model *model,
                              ffd_error *error);
} tinygltf_module;

#endif
