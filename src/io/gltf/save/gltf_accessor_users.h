/* gltf_accessor_users.h - who uses an accessor. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_ACCESSOR_USERS_H
#define FFD_IO_GLTF_SAVE_GLTF_ACCESSOR_USERS_H

#include "io/gltf/document/gltf_document.h"

/* Sets used[a] for each accessor a that something other than a deformed attribute uses: animations,
   skins, instancing, other attributes, indices. */
void ffd_gltf_mark_other_users(const gltf_document *document, bool *used);

#endif
