/* gltf_shapes.h - the morph targets of the parts. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SHAPES_H
#define FFD_IO_GLTF_SCENE_GLTF_SHAPES_H

#include "io/gltf/document/gltf_document.h"

/* Makes document->shapes, with the weights that the nodes or meshes show them with, and targets; to be called
   after ffd_gltf_make_parts. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_shapes(gltf_document *document, ffd_error *error);

/* Whether a value is a default weight: a number that a float32 holds. Others count as 0. */
bool ffd_gltf_weight(const gltf_document *document, uint32_t value, double *weight);

#endif
