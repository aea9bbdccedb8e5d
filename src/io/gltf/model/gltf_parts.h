/* gltf_parts.h - the parts, one per POSITION accessor and node, and their morph targets: gltf_parts.c,
 * gltf_shapes.c. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_PARTS_H
#define FFD_IO_GLTF_MODEL_GLTF_PARTS_H

#include "io/gltf/read/gltf_document.h"

/* Makes document->parts and instances from the scene. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_parts(gltf_document *document, ffd_error *error);

/* Makes document->shapes, with the default weights of their nodes or meshes, and document->targets; call it
   after ffd_gltf_make_parts. Call it again when the model has got further targets: earlier results of
   targets, and what splats change, are lost. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_shapes(gltf_document *document, ffd_error *error);

/* Returns the array of default weights of a node or mesh; JSON_NONE if it has none, or it is not an array. */
uint32_t ffd_gltf_weights_of(const gltf_document *document, uint32_t object);
/* Returns the first default weight of a node (GLTF_NONE: none), or else of its mesh; JSON_NONE: none. */
uint32_t ffd_gltf_first_weight(const gltf_document *document, size_t mesh, size_t node);

/* Reads a default weight. Returns false if the value is not a number in the range of float32: it then counts
   as 0. */
bool ffd_gltf_weight(const gltf_document *document, uint32_t value, double *weight);

/* Reads values [first, first + count) of a part's attribute, `components` numbers each, contiguous.
   MESH_SHOWN: the weighted offsets of the morph targets are added, and directions then have unit length;
   MESH_STORED: the values are the file's. */
void ffd_gltf_read_shown(const gltf_document *document, size_t part, gltf_semantic semantic, mesh_state state,
                         size_t first, size_t count, size_t components, double *values);

/* Adds the offsets of an attribute that no deformation changes, by the weights that a primitive is shown with
   under a node (GLTF_NONE: none): those of the first `count` vertices, `components` numbers each, which begin
   every `stride` values. values NULL: adds nothing. Returns whether any target with a weight has the
   attribute. */
bool ffd_gltf_add_shapes(const gltf_document *document, const gltf_primitive *primitive, size_t node,
                         const char *name, size_t count, size_t components, size_t stride, double *values);

#endif
