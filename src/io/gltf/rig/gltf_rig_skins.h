/* gltf_rig_skins.h - inverse bind matrices for joints that have moved, and what carries vertices back by the
   nodes and skins that show them. */
#ifndef FFD_IO_GLTF_RIG_GLTF_RIG_SKINS_H
#define FFD_IO_GLTF_RIG_GLTF_RIG_SKINS_H

#include "io/gltf/rig/gltf_rig.h"

/* After ffd_gltf_follow_nodes: fills the rig's skin_contents and sets the parts to be carried. Errors:
   FFD_E_INVALID (a matrix that floats cannot hold), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_skins(gltf_document *document, const mesh_places *places,
                                 const mesh_place_move *moves, gltf_rig *rig, ffd_error *error);

#endif
