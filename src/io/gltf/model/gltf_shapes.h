/* gltf_shapes.h - the morph targets of the parts. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SHAPES_H
#define FFD_IO_GLTF_MODEL_GLTF_SHAPES_H

#include "io/gltf/read/gltf_document.h"

/* Makes document->shapes, with the default weights of their nodes or meshes, and document->targets; call it
   after ffd_gltf_make_parts. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_shapes(gltf_document *document, ffd_error *error);

/* Returns the array of default weights of a node or mesh; JSON_NONE if it has none, or it is not an array. */
uint32_t ffd_gltf_weights_of(const gltf_document *document, uint32_t object);
/* Returns the first default weight of a node (GLTF_NONE: none), or else of its mesh; JSON_NONE: none. */
uint32_t ffd_gltf_first_weight(const gltf_document *document, size_t mesh, size_t node);

/* Reads a default weight. Returns false if the value is not a number in the range of float32: it then counts
   as 0. */
bool ffd_gltf_weight(const gltf_document *document, uint32_t value, double *weight);

#endif
