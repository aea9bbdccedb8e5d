/* gltf_mixed.h - finds triangles whose vertices have different marks. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_MIXED_H
#define FFD_IO_GLTF_MODEL_GLTF_MIXED_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's mixed_faces. */
mesh_mixed_faces_function ffd_gltf_mixed_faces;

#endif
