/* gltf_morph_weights.h - extends animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPH_WEIGHTS_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPH_WEIGHTS_H

#include "io/gltf/edit/gltf_edit.h"

/* Adds a weight 0 for each further target to all animations of the weights of meshes and of their nodes,
   except animations that others replace. */
void ffd_gltf_extend_weights(gltf_edit *edit);

#endif
