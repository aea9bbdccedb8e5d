/* gltf_rig_nodes.h - computes the transforms of nodes that follow the deformation. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_NODES_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_NODES_H

#include "io/gltf/edit/gltf_rig.h"

/* Fills the rig's world, motions and nodes, and `became` of the moves (one per place). Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_nodes(const gltf_document *document, const mesh_places *places,
                                 mesh_place_move *moves, gltf_rig *rig, mesh_following *following,
                                 ffd_error *error);

#endif
