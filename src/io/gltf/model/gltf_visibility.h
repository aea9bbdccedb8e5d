/* gltf_visibility.h - finds the nodes that KHR_node_visibility hides. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_VISIBILITY_H
#define FFD_IO_GLTF_MODEL_GLTF_VISIBILITY_H

#include "io/gltf/read/gltf_document.h"

/* Fills document->hidden: an invisible node hides all its descendants. parents: per node; order: all nodes,
   parents before children. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_hidden(gltf_document *document, const size_t *parents, const size_t *order,
                                ffd_error *error);

#endif
