/* gltf_as_morph.h - the deformation as a further morph target. */
#ifndef FFD_IO_GLTF_GLTF_AS_MORPH_H
#define FFD_IO_GLTF_GLTF_AS_MORPH_H

#include "io/gltf/document/gltf_document.h"

/* mesh_format's keep_base: results become offsets of a further morph target of this name. */
mesh_keep_base_function ffd_gltf_keep_base;

/* mesh_format's save: with a further morph target after ffd_gltf_keep_base, else as
   ffd_gltf_save_results does. */
mesh_save_function ffd_gltf_save;

#endif
