/* gltf_materials.h - the materials of a file: base colours, their textures, and where surfaces are cut
   out. */
#ifndef FFD_IO_GLTF_GLTF_MATERIALS_H
#define FFD_IO_GLTF_GLTF_MATERIALS_H

#include "mesh/mesh.h"

/* mesh_format's list_materials. A value that glTF does not allow counts as absent. */
mesh_list_materials_function ffd_gltf_list_materials;

#endif
