/* gltf_compare.h - compares two glTF files: their JSON and the contents of their buffers. */
#ifndef FFD_IO_GLTF_GLTF_COMPARE_H
#define FFD_IO_GLTF_GLTF_COMPARE_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's compare. */
mesh_compare_function ffd_gltf_compare;

#endif
