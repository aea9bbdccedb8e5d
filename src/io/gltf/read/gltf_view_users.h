/* gltf_view_users.h - who uses a bufferView beside accessors. */
#ifndef FFD_IO_GLTF_READ_GLTF_VIEW_USERS_H
#define FFD_IO_GLTF_READ_GLTF_VIEW_USERS_H

#include "io/gltf/read/gltf_document.h"

/* Sets used[v] for each bufferView v that is named by anything but an accessor: an image, data compressed by
   Draco, a property table. */
void ffd_gltf_mark_other_views(const gltf_document *document, bool *used);

#endif
