/* gltf_names.h - names what shows a vertex. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_NAMES_H
#define FFD_IO_GLTF_MODEL_GLTF_NAMES_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's name_part: the node, or the mesh if the node has no name. */
mesh_name_part_function ffd_gltf_name_part;

#endif
