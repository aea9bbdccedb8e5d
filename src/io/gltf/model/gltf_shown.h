/* gltf_shown.h - reads attributes with the default weights of the morph targets applied. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SHOWN_H
#define FFD_IO_GLTF_MODEL_GLTF_SHOWN_H

#include "io/gltf/read/gltf_document.h"

/* Reads values [first, first + count) of a part's attribute, `components` numbers each, contiguous. If
   document->base.shown is set, the weighted offsets of the morph targets are added, and directions then have
   unit length; otherwise the values are the file's. */
void ffd_gltf_read_shown(const gltf_document *document, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, size_t components, double *values);

/* Adds the offsets of an attribute that no deformation changes, by the weights that a primitive is shown with
   under a node (GLTF_NONE: none): those of the first `count` vertices, `components` numbers each, which begin
   every `stride` values. values NULL: adds nothing. Returns whether any target with a weight has the
   attribute; false if document->base.shown is not set. */
bool ffd_gltf_add_shapes(const gltf_document *document, size_t mesh, size_t primitive, size_t node,
                         const char *name, size_t count, size_t components, size_t stride, double *values);

#endif
