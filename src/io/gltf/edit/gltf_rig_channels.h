/* gltf_rig_channels.h - changes the animations of nodes that follow the deformation: the outputs of their
   channels. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_CHANNELS_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_CHANNELS_H

#include "io/gltf/edit/gltf_rig.h"

/* Fills the rig's animations and changes; call it after ffd_gltf_follow_nodes. Errors: those of loading the
   keys of an animation that changes, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_animations(gltf_document *document, gltf_rig *rig, ffd_error *error);

#endif
