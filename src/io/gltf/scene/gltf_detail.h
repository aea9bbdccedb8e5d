/* gltf_detail.h - levels of detail (MSFT_lod): the nodes that are shown in place of a node at a distance. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_DETAIL_H
#define FFD_IO_GLTF_SCENE_GLTF_DETAIL_H

#include "io/gltf/document/gltf_document.h"

/* Returns the first element of the node's list of coarser levels; JSON_NONE if it has none. Go on with
   ffd_json_span_after. */
uint32_t ffd_gltf_first_detail(const gltf_document *document, size_t node);

/* Returns the number of nodes with a mesh that are shown only in place of others at a distance. */
size_t ffd_gltf_count_stand_ins(const gltf_document *document);

#endif
