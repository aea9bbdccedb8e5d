/* gltf_faces.h - what primitives draw: triangles, lines, points, and their vertices. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_FACES_H
#define FFD_IO_GLTF_MODEL_GLTF_FACES_H

#include "io/gltf/read/gltf_document.h"

/* Adds what a primitive draws for one use to the counts. */
void ffd_gltf_count_drawing(const gltf_document *document, const gltf_primitive *primitive, size_t *triangles,
                            size_t *lines, size_t *points);

/* Returns the number of triangles that a primitive draws for one use. */
size_t ffd_gltf_count_triangles(const gltf_document *document, const gltf_primitive *primitive);

/* Lists the vertices (0, 1, ..) that a primitive with positions draws, in order. The caller frees corners,
   which is NULL after a failure. Errors: FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
ffd_status ffd_gltf_read_corners(const gltf_document *document, const gltf_primitive *primitive,
                                 uint32_t **corners, size_t *count, ffd_error *error);

/* Returns the largest count of ffd_gltf_read_corners over all primitives. */
uint64_t ffd_gltf_most_corners(const gltf_document *document);

#endif
