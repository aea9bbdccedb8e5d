/* gltf_morph_text.h - adds a morph target of zeros to the JSON of a file. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPH_TEXT_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPH_TEXT_H

#include "io/gltf/read/gltf_document.h"

/* A request to add a target to a file. */
typedef struct morph_request {
    /* The document that has the target's results; the file may have further targets since. */
    const gltf_document *source;
    const gltf_morph *morph; /* one of source */
    const bool *meshes;      /* per mesh: whether it gets the target */
    /* Per mesh that gets it: the place of its target of the same name, which is replaced, or the number of
       its targets. */
    const size_t *places;
    const mesh_log *log;
} morph_request;

/* Makes a file with a further target of zeros, for the deformed attributes of the meshes' primitives. A
   replaced target keeps its weights. A new one is added last, with its name, a weight 0, and a weight 0 in
   all animations of weights. It has the same place in all primitives of a mesh: targets of zeros fill the
   gaps. The caller owns *made. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const morph_request *request, file_input *made,
                               ffd_error *error);

#endif
