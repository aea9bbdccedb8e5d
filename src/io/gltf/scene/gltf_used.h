/* gltf_used.h - which vertices primitives draw. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_USED_H
#define FFD_IO_GLTF_SCENE_GLTF_USED_H

#include "io/gltf/document/gltf_document.h"

/* The entry of the format's table. */
mesh_mark_used_function ffd_gltf_mark_used;

#endif
