/* gltf_shapes.h - the morph targets of the parts. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SHAPES_H
#define FFD_IO_GLTF_SCENE_GLTF_SHAPES_H

#include "io/gltf/document/gltf_document.h"

/* Makes document->shapes, with the weights that the nodes or meshes show them with, and targets; to be called
   after ffd_gltf_make_parts. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_shapes(gltf_document *document, ffd_error *error);

/* Returns the default weights that a node or mesh states; JSON_NONE where they are no array. */
uint32_t ffd_gltf_weights_of(const gltf_document *document, uint32_t object);
/* Returns the first of the default weights of a node (GLTF_NONE: none), or else of its mesh; JSON_NONE: none.
 */
uint32_t ffd_gltf_first_weight(const gltf_document *document, size_t mesh, size_t node);

/* Whether a value is a default weight: a number that a float32 holds. Others count as 0. */
bool ffd_gltf_weight(const gltf_document *document, uint32_t value, double *weight);

#endif
