/* gltf_rig_users.h - finds the accessors whose original content skins and animations still need, although
   they follow the deformation. */
#ifndef FFD_IO_GLTF_RIG_GLTF_RIG_USERS_H
#define FFD_IO_GLTF_RIG_GLTF_RIG_USERS_H

#include "io/gltf/document/gltf_document.h"

/* Sets used[a] for each accessor a whose original content a skin or an animation of the output uses. */
void ffd_gltf_mark_rig_originals(const gltf_document *document, bool *used);

#endif
