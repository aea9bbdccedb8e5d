/* gltf_drawing.h - what primitives draw: their modes and indices, also where strips, fans and lines begin
   anew at an index (KHR_mesh_primitive_restart), and what to do where these are not valid. */
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
ffd_status ffd_gltf_drop_drawing(gltf_document *document, gltf_primitive *primitive, uint32_t value,
                                 ffd_error *error, const char *format, ...) FFD_PRINTF(5, 6);

/* Returns the number of vertices that a primitive with indices draws, counting repetitions. */
size_t ffd_gltf_drawn_count(const gltf_document *document, const gltf_primitive *primitive);

/* Reads vertices [first, first + count) of those. Returns the largest; 0 if count is 0. */
uint32_t ffd_gltf_read_drawn(const gltf_document *document, const gltf_primitive *primitive, size_t first,
                             size_t count, uint32_t *vertices);

/* Notes indices that are not less than the primitive's number of vertices as a flaw; those that begin a strip
   anew are unrolled (gltf_restart.h). Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_check_indices(gltf_document *document, ffd_error *error);

#endif
