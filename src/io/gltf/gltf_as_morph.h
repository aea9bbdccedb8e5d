/* gltf_as_morph.h - stores deformations as further morph targets. */
#ifndef FFD_IO_GLTF_GLTF_AS_MORPH_H
#define FFD_IO_GLTF_GLTF_AS_MORPH_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's keep_base: results become offsets of a further morph target of this name. */
mesh_keep_base_function ffd_gltf_keep_base;

/* mesh_format's keep_clips. */
mesh_keep_clips_function ffd_gltf_keep_clips;

/* mesh_format's save: adds the morph targets after ffd_gltf_keep_base, else works like
   ffd_gltf_save_results. */
mesh_save_function ffd_gltf_save;

#endif
