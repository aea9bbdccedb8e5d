/* gltf_morphs.h - further morph targets and animations of the weights of all of them, in the model of a file
   and in its edit: gltf_morph_targets.c, gltf_target_names.c, gltf_clip.c and gltf_morph_weights.c. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPHS_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPHS_H

#include "io/gltf/edit/gltf_edit.h"
#include "mesh/morph/morph_clip.h"

/* Adds a target of zeros, for the deformed attributes, to the primitives of the meshes that morph->places
   names; it replaces a target that the mesh has there. It has the same place in all primitives of a mesh:
   targets of zeros fill the gaps. Where the old offsets are the target's alone, their accessor is kept. Warns
   of what is replaced and of the bytes that this leaves unused. The results are the caller's to set. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_target(gltf_edit *edit, const gltf_morph *morph, const mesh_log *log,
                               ffd_error *error);

/* Names of targets are those in extras.targetNames of the mesh and, for targets without a name there, of its
   primitives, where older exporters write them. Returns the JSON string that names each target of a mesh
   (gltf_mesh_uses); JSON_NONE: it has no name in the file. The caller frees the array. NULL: memory ran out.
 */
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

/* Refuses (FFD_E_ARGUMENT) a clip with a target that is neither in names nor in any mesh. The message
   suggests the nearest name. */
ffd_status ffd_gltf_check_clips(const gltf_document *document, const morph_clip *clips, size_t count,
                                const char *const *names, size_t name_count, ffd_error *error);
/* Adds the document's clips, and weights of 0 for its further targets (document->morphs) to all other
   animations of weights. A clip replaces an animation of the same name. It gets a channel for each node whose
   mesh has one of the further targets, or a target that the clip names. All other targets keep the default
   weights of the node or mesh. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_animate_weights(gltf_edit *edit, ffd_error *error);
/* Adds a weight 0 for each further target to all animations of the weights of meshes and of their nodes,
   except those that clips replace. */
void ffd_gltf_extend_weights(gltf_edit *edit);

#endif
