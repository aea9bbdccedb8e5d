/* gltf_users.h - finds the users of accessors and bufferViews. */
#ifndef FFD_IO_GLTF_READ_GLTF_USERS_H
#define FFD_IO_GLTF_READ_GLTF_USERS_H

#include "io/gltf/read/gltf_document.h"

/* Sets used[a] for each accessor a that is used by anything but a deformed attribute, a skin or an animation:
   other attributes, indices, extensions. An accessor that an extension of a mesh names does not count if it
   is one of the mesh's own attributes: the extension then follows the attribute. */
void ffd_gltf_mark_other_users(const gltf_document *document, bool *used);

/* Sets used[a] for the accessors of one animation. */
void ffd_gltf_mark_animation(const gltf_document *document, uint32_t animation, bool *used);

/* Sets used[a] for the accessors of skins and animations, except those animations (NULL: none). */
void ffd_gltf_mark_rig_users(const gltf_document *document, const gltf_values *but, bool *used);

/* Sets used[v] for each bufferView v that is named by anything but an accessor: an image, data compressed by
   Draco, a property table. */
void ffd_gltf_mark_other_views(const gltf_document *document, bool *used);

/* Counts the users of each accessor; 2 means two or more. `but`: animations that do not count, or NULL. The
   caller frees the array. NULL: memory ran out. */
unsigned char *ffd_gltf_count_users(const gltf_document *document, const gltf_values *but);

#endif
