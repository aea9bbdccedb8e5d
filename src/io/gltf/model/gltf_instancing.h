/* gltf_instancing.h - nodes with EXT_mesh_gpu_instancing. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_INSTANCING_H
#define FFD_IO_GLTF_MODEL_GLTF_INSTANCING_H

#include "io/gltf/read/gltf_document.h"

/* Finds these nodes and deselects their parts; call it after ffd_gltf_make_parts. Errors: FFD_E_INVALID,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_find_instanced_nodes(gltf_document *document, ffd_error *error);

/* Returns the instancing of a node; NULL if it has none. */
gltf_instanced_node *ffd_gltf_instanced_node(const gltf_document *document, size_t node);

#endif
