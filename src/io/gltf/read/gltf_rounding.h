/* gltf_rounding.h - the precision of an accessor's numbers. */
#ifndef FFD_IO_GLTF_READ_GLTF_ROUNDING_H
#define FFD_IO_GLTF_READ_GLTF_ROUNDING_H

#include "io/gltf/read/gltf_document.h"

/* Returns the rounding of a readable accessor of vectors: that of float32 or integers, or the quantization
   step of Draco or of a meshopt filter. */
mesh_rounding ffd_gltf_rounding(const gltf_document *document, size_t accessor);

#endif
