/* gltf_follow.h - updates indices in extensions for meshes and accessors that are copied. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_FOLLOW_H
#define FFD_IO_GLTF_WRITE_GLTF_FOLLOW_H

#include "io/gltf/write/gltf_saver.h"

/* Edits the extensions of a mesh: they name the accessors that hold the mesh's content for this use. */
void ffd_gltf_follow_accessors(gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits references to copied meshes: a node that shows a copy refers to the copy, and elements of per-mesh
   lists are repeated for the copies. Warns of references that cannot follow, those to accessors included, so
   call it last. Errors: FFD_E_LIMIT (the repeated elements exceed the memory budget), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_meshes(gltf_saver *saver, ffd_error *error);

#endif
