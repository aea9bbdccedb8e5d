/* gltf_format.h - the format glTF (.gltf and .glb), for the table of formats. */
#ifndef FFD_IO_GLTF_GLTF_FORMAT_H
#define FFD_IO_GLTF_GLTF_FORMAT_H

#include "mesh/mesh.h"

extern const mesh_format ffd_gltf_format;

#endif
