/* gltf_select.h - finds the primitives and nodes that `--only` selects. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SELECT_H
#define FFD_IO_GLTF_SCENE_GLTF_SELECT_H

#include "io/gltf/document/gltf_document.h"

/* mesh_format's select. */
mesh_select_function ffd_gltf_select;

#endif
