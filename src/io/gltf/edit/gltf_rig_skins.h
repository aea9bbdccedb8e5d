/* gltf_rig_skins.h - changes inverse bind matrices for joints that have moved, and sets the maps that carry
   vertices back, so that the moved nodes and skins show them in the right place. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_SKINS_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_SKINS_H

#include "io/gltf/edit/gltf_rig.h"

/* Fills the rig's skin_contents and sets the parts' carry; call it after ffd_gltf_follow_nodes. Errors:
   FFD_E_INVALID (a matrix that floats cannot hold), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_skins(gltf_document *document, const mesh_places *places,
                                 const mesh_place_move *moves, gltf_rig *rig, ffd_error *error);

#endif
