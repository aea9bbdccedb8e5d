/* gltf_morph_text.h - adds a morph target of zeros to the JSON of a file. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H
#define FFD_IO_GLTF_MORPH_GLTF_MORPH_TEXT_H

#include "io/gltf/document/gltf_document.h"

/* Returns the list of the names of a mesh's targets; JSON_NONE: none. */
uint32_t ffd_gltf_target_names(const gltf_document *document, size_t mesh);

/* Finds the morph target of a mesh by its name in extras.targetNames; GLTF_NONE: none. */
size_t ffd_gltf_find_target(const gltf_document *document, size_t mesh, const char *name);

/* Returns the index of the further target in a primitive. named: the result of ffd_gltf_find_target for its
   mesh. */
static inline size_t ffd_gltf_target_place(const gltf_primitive *primitive, size_t named)
{
    return named < primitive->target_count ? named : primitive->target_count;
}

/* A request to add a target to a file. */
typedef struct morph_request {
    /* The document that has the target's results; the file may have further targets since. */
    const gltf_document *source;
    const gltf_morph *morph; /* one of source */
    const bool *meshes;      /* per mesh: whether it gets the target */
    const size_t *named;     /* per mesh: its target of the same name, which is replaced; GLTF_NONE: none */
    const mesh_log *log;
} morph_request;

/* Makes a file with a further target of zeros, for the deformed attributes of the meshes' primitives. A
   replaced target keeps its weights. A new one is added last, with its name, a weight 0, and a weight 0 in
   all animations of weights. The caller owns *made. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const morph_request *request, file_input *made,
                               ffd_error *error);

#endif
