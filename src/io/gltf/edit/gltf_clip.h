/* gltf_clip.h - adds animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_CLIP_H
#define FFD_IO_GLTF_EDIT_GLTF_CLIP_H

#include "io/gltf/edit/gltf_edit.h"
#include "mesh/morph/morph_clip.h"

/* A further morph target of the file. */
typedef struct clip_target {
    const char *name;
    const size_t *places; /* per mesh: the target's index in the mesh; GLTF_NONE: the mesh does not have it */
} clip_target;

/* Refuses (FFD_E_ARGUMENT) a clip with a target that is neither in names nor in any mesh. The message
   suggests the nearest name. */
ffd_status ffd_gltf_check_clips(const gltf_document *document, const morph_clip *clips, size_t count,
                                const char *const *names, size_t name_count, ffd_error *error);

/* Adds the clips to the edit; a clip replaces an animation of the same name. It gets a channel for each node
   whose mesh has one of the further targets, or a target that the clip names. All other targets keep the
   default weights of the node or mesh. Adds to *bytes_left the bytes that replaced animations leave unused.
   Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_clips(const morph_clip *clips, size_t clip_count, const clip_target *targets,
                              size_t target_count, gltf_edit *edit, uint64_t *bytes_left, ffd_error *error);

#endif
