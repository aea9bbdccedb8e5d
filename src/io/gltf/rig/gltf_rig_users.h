/* gltf_rig_users.h - which accessors skins and animations need as they were, although they follow. */
#ifndef FFD_IO_GLTF_RIG_GLTF_RIG_USERS_H
#define FFD_IO_GLTF_RIG_GLTF_RIG_USERS_H

#include "io/gltf/document/gltf_document.h"

/* Sets used[a] for each accessor a whose original content a skin or an animation has in the output. */
void ffd_gltf_mark_rig_originals(const gltf_document *document, bool *used);

#endif
