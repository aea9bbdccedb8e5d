/* gltf_visibility.h - which nodes KHR_node_visibility hides. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_VISIBILITY_H
#define FFD_IO_GLTF_SCENE_GLTF_VISIBILITY_H

#include "io/gltf/document/gltf_document.h"

/* Fills document->hidden: a node that is not visible hides all nodes below it. parents, order: of all nodes,
   order has parents first. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_find_hidden(gltf_document *document, const size_t *parents, const size_t *order,
                                ffd_error *error);

#endif
