/* gltf_rig_said.h - log lines on what follows the deformation together with nodes, and what does not. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_SAID_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_SAID_H

#include "io/gltf/edit/gltf_rig.h"

/* Logs what follows (-v), and warns of what does not, with one line per kind and the first names: physics
   shapes, spring bones and look-at offsets of VRM, rest rotations of VRM 0.x, constraints that aim, channels
   with unsupported pointers. Sets following->unscaled, and adds to following->unselected. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_rig(const gltf_document *document, const mesh_places *places, const gltf_rig *rig,
                                const mesh_log *log, mesh_following *following, ffd_error *error);

#endif
