/* gltf_materials.h - the materials of a file: base colours, their textures, and where they are not drawn. */
#ifndef FFD_IO_GLTF_GLTF_MATERIALS_H
#define FFD_IO_GLTF_GLTF_MATERIALS_H

#include "mesh/mesh.h"

/* mesh_format's list_materials. A value that glTF does not allow counts as one that is not there. */
mesh_list_materials_function ffd_gltf_list_materials;

#endif
