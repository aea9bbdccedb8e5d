/* openmesh_module.h - the functions of the OpenMesh module. openmesh_module.c is part of the module; a
   program that loads the module has openmesh_load.c instead. */
#ifndef FFD_IO_OPENMESH_OPENMESH_MODULE_H
#define FFD_IO_OPENMESH_OPENMESH_MODULE_H

#include "base/system/module.h"
#include "io/openmesh/normals.h"
#include "io/openmesh/topology.h"
#include <ffd/version.h>

#define OPENMESH_IDENTITY                                                                                    \
    {                                                                                                        \
        "ffd-openmesh.so", FFD_VERSION, 3                                                                    \
    }

typedef struct openmesh_module {
    module_head head;
    ffd_status (*topology)(const mesh_faces *faces, mesh_topology *topology, ffd_error *error);
    ffd_status (*normals)(const mesh_faces *faces, const double *positions, const uint32_t *groups,
                          size_t group_count, const uint8_t *mirrored, double *directions, ffd_error *error);
} openmesh_module;

#endif
