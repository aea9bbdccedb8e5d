/* gltf_parts.h - makes the parts: one per POSITION accessor and node. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_PARTS_H
#define FFD_IO_GLTF_MODEL_GLTF_PARTS_H

#include "io/gltf/read/gltf_document.h"

/* Makes document->parts and instances from the scene. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_parts(gltf_document *document, ffd_error *error);

#endif
