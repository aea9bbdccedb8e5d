/* gltf_drawing.h - what primitives draw: their modes and indices, and those of them that are not valid. */
#ifndef FFD_IO_GLTF_DECODE_GLTF_DRAWING_H
#define FFD_IO_GLTF_DECODE_GLTF_DRAWING_H

#include "io/gltf/document/gltf_document.h"

/* Takes the mode and the indices of every primitive from the JSON: tinygltf was not shown them. Errors:
   FFD_E_INVALID. */
ffd_status ffd_gltf_read_drawings(gltf_document *document, ffd_error *error);

/* Notes what is wrong with the mode or the indices of a primitive, at a value: it then draws nothing that is
   known (document->base.unknown_drawings counts it), and its vertices are deformed all the same. Errors:
   FFD_E_INVALID, if flaws are refused, or the primitive is compressed by Draco, so that its indices would
   have to be written anew. */
ffd_status ffd_gltf_drop_drawing(gltf_document *document, size_t mesh, size_t primitive, uint32_t value,
                                 ffd_error *error, const char *format, ...) FFD_PRINTF(6, 7);

#endif
