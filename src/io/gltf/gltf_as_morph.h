/* gltf_as_morph.h - deformations as further morph targets. */
#ifndef FFD_IO_GLTF_GLTF_AS_MORPH_H
#define FFD_IO_GLTF_GLTF_AS_MORPH_H

#include "io/gltf/document/gltf_document.h"

/* mesh_format's keep_base: results become offsets of a further morph target of this name. */
mesh_keep_base_function ffd_gltf_keep_base;

/* mesh_format's keep_clips. */
mesh_keep_clips_function ffd_gltf_keep_clips;

/* mesh_format's save: with a further morph target after ffd_gltf_keep_base, else as
   ffd_gltf_save_results does. */
mesh_save_function ffd_gltf_save;

#endif
