/* gltf_shown.h - what the parts have as the default weights of their morph targets show it. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SHOWN_H
#define FFD_IO_GLTF_SCENE_GLTF_SHOWN_H

#include "io/gltf/document/gltf_document.h"

/* Reads values [first, first + count) of an attribute of a part, `components` numbers each: as the file has
   them, or where document->base.shown is set with the weighted offsets of the morph targets. Directions are
   then of unit length. */
void ffd_gltf_read_shown(const gltf_document *document, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, size_t components, double *values);

#endif
