/* gltf_extract.h - reads a glTF file into a mesh_model, for conversion to other formats. */
#ifndef FFD_IO_GLTF_GLTF_EXTRACT_H
#define FFD_IO_GLTF_GLTF_EXTRACT_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's model. */
mesh_model_function ffd_gltf_extract;

#endif
