/* gltf_follow.h - indices in extensions follow the meshes and accessors that are copied. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_FOLLOW_H
#define FFD_IO_GLTF_SAVE_GLTF_FOLLOW_H

#include "io/gltf/save/gltf_saver.h"

/* Edits what extensions of a mesh name to be the accessors that hold its content for a use. */
void ffd_gltf_follow_accessors(gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits what names a copied mesh: in a node that shows a copy it names the copy, and elements of lists that
   are of one mesh are repeated for its copies. Warns of what cannot follow, accessors too: to be called last.
   Errors: FFD_E_LIMIT (more repeated elements than fit into the memory budget), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_meshes(gltf_saver *saver, ffd_error *error);

#endif
