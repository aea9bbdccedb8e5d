/* gltf_morph_text.h - a further morph target of zeros, in the text of a file. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H
#define FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H

#include "io/gltf/document/gltf_document.h"

/* Finds the morph target of a mesh that has the name of the document's further one, by extras.targetNames;
   GLTF_NONE: there is none. */
size_t ffd_gltf_find_target(const gltf_document *document, size_t mesh);

/* The place that the further target has among those of a primitive: named is what ffd_gltf_find_target found
   for its mesh. */
static inline size_t ffd_gltf_target_place(const gltf_primitive *primitive, size_t named)
{
    return named < primitive->target_count ? named : primitive->target_count;
}

/* Makes the file with a further target of zeros, for each mesh that is marked, for the deformed attributes of
   its primitives. named: of each mesh, its target of the name; the further one replaces it, and keeps its
   weights. Where there is none it is the last one, with its name, its weight 0 and the animations of weights.
   *made is the caller's. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const bool *meshes, const size_t *named,
                               const mesh_log *log, file_input *made, ffd_error *error);

#endif
