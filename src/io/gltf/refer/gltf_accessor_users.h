/* gltf_accessor_users.h - who uses an accessor. */
#ifndef FFD_IO_GLTF_REFER_GLTF_ACCESSOR_USERS_H
#define FFD_IO_GLTF_REFER_GLTF_ACCESSOR_USERS_H

#include "io/gltf/document/gltf_document.h"

/* Sets used[a] for each accessor a that something other than a deformed attribute, a skin and an animation
   uses: other attributes, indices, extensions. An extension of a mesh that names an accessor of the mesh's
   own attributes follows these. */
void ffd_gltf_mark_other_users(const gltf_document *document, bool *used);

/* Sets it for those that an animation uses. */
void ffd_gltf_mark_animation(const gltf_document *document, uint32_t animation, bool *used);

/* Sets it for those that skins and animations use, but for one animation (JSON_NONE: none). */
void ffd_gltf_mark_rig_users(const gltf_document *document, uint32_t but, bool *used);

#endif
