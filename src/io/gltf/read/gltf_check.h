/* gltf_check.h - checks all that a file states before any of it is used. */
#ifndef FFD_IO_GLTF_READ_GLTF_CHECK_H
#define FFD_IO_GLTF_READ_GLTF_CHECK_H

#include "io/gltf/read/gltf_document.h"

/* Tolerance for the last row of a matrix: exporters' rows may have the rounding errors of floats. */
#define LAST_ROW_TOLERANCE 1e-5

/* Checks every index, offset, count and stride of the model, decodes compressed data, and fills
   document->layouts. Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_check(gltf_document *document, ffd_error *error);

#endif
