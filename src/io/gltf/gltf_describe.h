/* gltf_describe.h - what `ffd info` reports of a glTF file. */
#ifndef FFD_IO_GLTF_GLTF_DESCRIBE_H
#define FFD_IO_GLTF_GLTF_DESCRIBE_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's describe. */
mesh_describe_function ffd_gltf_describe;

#endif
