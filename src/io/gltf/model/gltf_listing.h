/* gltf_listing.h - the names that `--only` takes. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_LISTING_H
#define FFD_IO_GLTF_MODEL_GLTF_LISTING_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's list_parts. */
mesh_list_parts_function ffd_gltf_list_parts;

#endif
