/* glb_clips.h - the animations of a new glTF file: clips of the weights of its morph targets. */
#ifndef FFD_IO_WRITE_GLB_CLIPS_H
#define FFD_IO_WRITE_GLB_CLIPS_H

#include "base/text/buffer.h"
#include "io/write/glb_plan.h"
#include "json/json_text.h"

/* All zeros: there are none. */
typedef struct glb_clips {
    const glb_plan *plan;
    byte_buffer bytes; /* times, then weights for each node with targets, clip by clip */
} glb_clips;

/* Makes the bytes; freed in every case. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_glb_make_clips(const glb_plan *plan, glb_clips *clips, ffd_error *error);
/* Adds the member "animations", if there is one. first: the number of the first accessor of clips. */
void ffd_glb_add_clips(const glb_clips *clips, size_t first, json_text *json);
/* Adds the accessors to an array. view: of the bytes. */
void ffd_glb_add_clip_accessors(const glb_clips *clips, size_t view, json_text *json);
/* Frees the bytes. */
void ffd_glb_free_clips(glb_clips *clips);

#endif
