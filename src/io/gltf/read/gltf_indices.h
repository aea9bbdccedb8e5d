/* gltf_indices.h - checks the indices of primitives. */
#ifndef FFD_IO_GLTF_READ_GLTF_INDICES_H
#define FFD_IO_GLTF_READ_GLTF_INDICES_H

#include "io/gltf/read/gltf_document.h"

/* Notes indices that are not less than the primitive's number of vertices as a flaw; those that begin a strip
   anew are unrolled (gltf_restart.h). Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_indices(gltf_document *document, ffd_error *error);

#endif
