/* gltf_morph_weights.h - extends animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPH_WEIGHTS_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPH_WEIGHTS_H

#include "io/gltf/edit/gltf_edit.h"

/* Adds a weight 0 for the further target to all animations of the weights of these meshes and their nodes. */
void ffd_gltf_extend_weights(gltf_edit *file, const bool *meshes);

#endif
