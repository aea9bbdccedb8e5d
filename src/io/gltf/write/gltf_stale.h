/* gltf_stale.h - finds bounds of meshes that extensions and extras hold and that no longer fit. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_STALE_H
#define FFD_IO_GLTF_WRITE_GLTF_STALE_H

#include "io/gltf/write/gltf_saver.h"

/* Warns of arrays, objects and numbers in extensions and extras whose names tell that they are bounds
   (`sceneBounds`, `boundingSphere`, `bbox_min`), where what they are of is deformed or moves: they stay as
   they are. If memory runs out, saver->edits fail. */
void ffd_gltf_warn_of_stale(gltf_saver *saver);

#endif
