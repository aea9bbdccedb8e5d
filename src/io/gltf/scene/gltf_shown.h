/* gltf_shown.h - reads attributes with the default weights of the morph targets applied. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SHOWN_H
#define FFD_IO_GLTF_SCENE_GLTF_SHOWN_H

#include "io/gltf/document/gltf_document.h"

/* Reads values [first, first + count) of a part's attribute, `components` numbers each, contiguous. If
   document->base.shown is set, the weighted offsets of the morph targets are added, and directions then have
   unit length; otherwise the values are the file's. */
void ffd_gltf_read_shown(const gltf_document *document, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, size_t components, double *values);

#endif
