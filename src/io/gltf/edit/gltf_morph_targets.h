/* gltf_morph_targets.h - adds morph targets of zeros to the model of a file. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPH_TARGETS_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPH_TARGETS_H

#include "io/gltf/edit/gltf_edit.h"

/* Adds a target of zeros, for the deformed attributes, to the primitives of the meshes that morph->places
   names; it replaces a target that the mesh has there. It has the same place in all primitives of a mesh:
   targets of zeros fill the gaps. Where the old offsets are the target's alone, their accessor is kept. Warns
   of what is replaced and of the bytes that this leaves unused. The results are the caller's to set. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_target(gltf_edit *edit, const gltf_morph *morph, const mesh_log *log,
                               ffd_error *error);

#endif
