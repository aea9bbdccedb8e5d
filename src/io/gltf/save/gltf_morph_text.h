/* gltf_morph_text.h - a further morph target of zeros, in the text of a file. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_MORPH_TEXT_H
#define FFD_IO_GLTF_SAVE_GLTF_MORPH_TEXT_H

#include "io/gltf/document/gltf_document.h"

/* Makes the file with a further target of zeros, for each mesh that is marked, for the deformed
   attributes of its primitives; with its name, its weight 0 and the animations of weights. The target
   of a primitive is its last one. *made is the caller's. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_add_target(const gltf_document *document, const bool *meshes, const mesh_log *log,
                               file_input *made, ffd_error *error);

#endif
