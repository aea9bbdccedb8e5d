/* gltf_morph_text.h - a further morph target of zeros, in the text of a file. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H
#define FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H

#include "io/gltf/document/gltf_document.h"

/* Returns the list of the names of a mesh's targets; JSON_NONE if there is none. */
uint32_t ffd_gltf_target_names(const gltf_document *document, size_t mesh);

/* Finds the morph target of a mesh that has a name, by extras.targetNames; GLTF_NONE: there is none. */
size_t ffd_gltf_find_target(const gltf_document *document, size_t mesh, const char *name);

/* The place that the further target has among those of a primitive: named is what ffd_gltf_find_target found
   for its mesh. */
static inline size_t ffd_gltf_target_place(const gltf_primitive *primitive, size_t named)
{
    return named < primitive->target_count ? named : primitive->target_count;
}

/* A further target of a file. */
typedef struct morph_request {
    const gltf_document *source; /* whose results it has; the file may have got other targets since */
    const gltf_morph *morph;     /* of source */
    const bool *meshes;          /* those that get it */
    const size_t *named; /* of each mesh, its target of the name, which it replaces; GLTF_NONE: none */
    const mesh_log *log;
} morph_request;

/* Makes the file with a further target of zeros, for the deformed attributes of the meshes' primitives. One
   that is replaced keeps its weights. Else the further one is the last one, with its name, its weight 0 and
   the animations of weights. *made is the caller's. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const morph_request *request, file_input *made,
                               ffd_error *error);

#endif
