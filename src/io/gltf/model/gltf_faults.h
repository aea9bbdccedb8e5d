/* gltf_faults.h - finds values that glTF does not allow but that viewers can do without. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_FAULTS_H
#define FFD_IO_GLTF_MODEL_GLTF_FAULTS_H

#include "io/gltf/read/gltf_document.h"

/* Warns of such values: default weights of morph targets; levels of detail, visibility, cameras, lights and
   physics shapes of nodes; targets of animations; the texture coordinates of textures. One line for the
   weights and one for the others, which --strict refuses. Errors: FFD_E_INVALID (strict), FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_faults(const mesh_document *document, const mesh_log *log, ffd_error *error);

#endif
