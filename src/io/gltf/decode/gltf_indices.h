/* gltf_indices.h - checks the indices of primitives. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_INDICES_H
#define FFD_IO_GLTF_DECODE_GLTF_INDICES_H

#include "io/gltf/document/gltf_document.h"

/* Refuses indices that are not less than the primitive's number of vertices. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_check_indices(gltf_document *document, ffd_error *error);

#endif
