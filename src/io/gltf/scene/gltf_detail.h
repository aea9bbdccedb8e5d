/* gltf_detail.h - levels of detail (MSFT_lod): nodes that replace a node at a distance. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_DETAIL_H
#define FFD_IO_GLTF_SCENE_GLTF_DETAIL_H

#include "io/gltf/document/gltf_document.h"

/* Returns the first element of a node's list of coarser levels; JSON_NONE if it has none. ffd_json_span_after
   returns the next one. */
uint32_t ffd_gltf_first_detail(const gltf_document *document, size_t node);

/* Returns the number of nodes with a mesh that only replace others at a distance. */
size_t ffd_gltf_count_stand_ins(const gltf_document *document);

#endif
