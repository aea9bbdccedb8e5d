/* gltf_target_names.h - the names of a mesh's morph targets: those in extras.targetNames of the mesh and, for
   targets without a name there, of its primitives, where older exporters write them. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_TARGET_NAMES_H
#define FFD_IO_GLTF_EDIT_GLTF_TARGET_NAMES_H

#include "io/gltf/read/gltf_document.h"
#include "json/json_edit.h"

/* Returns the JSON string that names each target of a mesh (gltf_mesh_uses); JSON_NONE: it has no name in the
   file. The caller frees the array. NULL: memory ran out. */
uint32_t *ffd_gltf_list_target_names(const gltf_document *document, size_t mesh);

/* Finds the first target of a mesh by its name; GLTF_NONE: none. *found: how many have it. Returns false if
   memory runs out. */
bool ffd_gltf_find_target(const gltf_document *document, size_t mesh, const char *name, size_t *target,
                          size_t *found);

/* Logs that a mesh is about to get a further target: which targets get names as well, or that its extras
   cannot hold the name. Returns false if memory runs out. */
bool ffd_gltf_log_target_name(const gltf_document *document, size_t mesh, const mesh_log *log);

/* Adds the names of further targets (document->morphs) to the list of a mesh, which is made if it is missing,
   and to those that its primitives have. Targets before them that a list lacks are entered with their names,
   or as "target_3". */
void ffd_gltf_edit_target_names(const gltf_document *document, size_t mesh, json_edits *edits);

#endif
