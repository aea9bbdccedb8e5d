/* gltf_drawing.h - what primitives draw: their modes and indices, and what to do where these are not
   valid. */
#ifndef FFD_IO_GLTF_READ_GLTF_DRAWING_H
#define FFD_IO_GLTF_READ_GLTF_DRAWING_H

#include "io/gltf/read/gltf_document.h"

/* Reads the mode and the indices of every primitive from the JSON that tinygltf does not get. Errors:
   FFD_E_INVALID. */
ffd_status ffd_gltf_read_drawings(gltf_document *document, ffd_error *error);

/* Notes a flaw of a primitive's mode or indices at a JSON value. The primitive then draws nothing
   (document->base.unknown_drawings counts it), and its vertices are still deformed. Errors: FFD_E_INVALID, if
   flaws are refused, or if the primitive is compressed by Draco, whose indices would have to be written
   anew. */
ffd_status ffd_gltf_drop_drawing(gltf_document *document, size_t mesh, size_t primitive, uint32_t value,
                                 ffd_error *error, const char *format, ...) FFD_PRINTF(6, 7);

#endif
