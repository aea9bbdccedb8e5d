/* gltf_rounding.h - how exactly an accessor holds its numbers. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_ROUNDING_H
#define FFD_IO_GLTF_DECODE_GLTF_ROUNDING_H

#include "io/gltf/document/gltf_document.h"

/* Returns the rounding of a readable accessor of vectors: of float32, of integers, of what Draco or a filter
   of meshopt has quantized. */
mesh_rounding ffd_gltf_rounding(const gltf_document *document, size_t accessor);

#endif
