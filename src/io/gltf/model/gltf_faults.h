/* gltf_faults.h - faults of what places no vertex by itself (those that a job warns of: gltf_functions.h). */
#ifndef FFD_IO_GLTF_MODEL_GLTF_FAULTS_H
#define FFD_IO_GLTF_MODEL_GLTF_FAULTS_H

#include "io/gltf/read/gltf_document.h"

/* Notes default weights that are not one finite number for each morph target, as flaws. Requires
   ffd_gltf_make_scene. Errors: FFD_E_INVALID (strict). */
ffd_status ffd_gltf_note_weights(gltf_document *d, ffd_error *error);

#endif
