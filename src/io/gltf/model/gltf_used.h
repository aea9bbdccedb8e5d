/* gltf_used.h - finds the vertices that primitives draw. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_USED_H
#define FFD_IO_GLTF_MODEL_GLTF_USED_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's mark_used. */
mesh_mark_used_function ffd_gltf_mark_used;

#endif
