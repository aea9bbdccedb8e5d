/* gltf_select.h - finds the primitives and nodes that `--only` selects. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SELECT_H
#define FFD_IO_GLTF_MODEL_GLTF_SELECT_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's select. */
mesh_select_function ffd_gltf_select;

#endif
