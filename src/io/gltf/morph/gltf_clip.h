/* gltf_clip.h - further animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_CLIP_H
#define FFD_IO_GLTF_MORPH_GLTF_CLIP_H

#include "io/gltf/document/gltf_document.h"
#include "mesh/morph/morph_clip.h"

/* A further morph target that the file has got. */
typedef struct clip_target {
    const char *name;
    const size_t *places; /* of each mesh: the target's among its own; GLTF_NONE: it has not got it */
} clip_target;

/* Refuses (FFD_E_ARGUMENT) a clip that names a target which is neither one of names nor one of a mesh, and
   tells the nearest. */
ffd_status ffd_gltf_check_clips(const gltf_document *document, const morph_clip *clips, size_t count,
                                const char *const *names, size_t name_count, ffd_error *error);

/* Makes the file with the document's clips, in place of the animations of their names: a channel for each
   node whose mesh has one of the further targets, or one that the clip names. All other targets keep the
   default weights of the node or mesh. *made is the caller's; its data is NULL where there is nothing to add.
   *bytes_left gets what replaced animations leave unused added.
   Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_clips(const gltf_document *document, const morph_clip *clips, size_t clip_count,
                              const clip_target *targets, size_t target_count, const mesh_log *log,
                              file_input *made, uint64_t *bytes_left, ffd_error *error);

#endif
