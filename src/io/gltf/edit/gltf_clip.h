/* gltf_clip.h - adds animations of the weights of morph targets. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_CLIP_H
#define FFD_IO_GLTF_EDIT_GLTF_CLIP_H

#include "io/gltf/edit/gltf_edit.h"
#include "mesh/morph/morph_clip.h"

/* Refuses (FFD_E_ARGUMENT) a clip with a target that is neither in names nor in any mesh. The message
   suggests the nearest name. */
ffd_status ffd_gltf_check_clips(const gltf_document *document, const morph_clip *clips, size_t count,
                                const char *const *names, size_t name_count, ffd_error *error);

/* Adds the document's clips, and weights of 0 for its further targets (document->morphs) to all other
   animations of weights. A clip replaces an animation of the same name. It gets a channel for each node whose
   mesh has one of the further targets, or a target that the clip names. All other targets keep the default
   weights of the node or mesh. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_animate_weights(gltf_edit *edit, ffd_error *error);

#endif
