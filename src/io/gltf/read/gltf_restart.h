/* gltf_restart.h - strips, fans and lines that begin anew at an index (KHR_mesh_primitive_restart). */
#ifndef FFD_IO_GLTF_READ_GLTF_RESTART_H
#define FFD_IO_GLTF_READ_GLTF_RESTART_H

#include "io/gltf/read/gltf_document.h"

/* Whether the largest number that the type of a primitive's indices can hold begins a new strip, fan, line or
   loop. */
bool ffd_gltf_restarts(const gltf_document *document, const gltf_primitive *primitive);

/* Lists what such a primitive draws, triangle by triangle or line by line, in primitive->drawn, and changes
   its mode to that. Returns the largest of the other indices in *largest. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_unroll(gltf_document *document, gltf_primitive *primitive, uint32_t *largest,
                           ffd_error *error);

/* Returns the number of vertices that a primitive with indices draws, counting repetitions. */
size_t ffd_gltf_drawn_count(const gltf_document *document, const gltf_primitive *primitive);

/* Reads vertices [first, first + count) of those. Returns the largest; 0 if count is 0. */
uint32_t ffd_gltf_read_drawn(const gltf_document *document, const gltf_primitive *primitive, size_t first,
                             size_t count, uint32_t *vertices);

#endif
