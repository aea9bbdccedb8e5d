/* glb_clips.h - the animations of a new glTF file: clips of morph target weights. */
#ifndef FFD_IO_WRITE_GLB_CLIPS_H
#define FFD_IO_WRITE_GLB_CLIPS_H

#include "base/text/buffer.h"
#include "io/write/glb_plan.h"
#include "json/json_text.h"

/* All zeros: no clips. */
typedef struct glb_clips {
    const glb_plan *plan;
    byte_buffer bytes; /* per clip: its times, then the weights for each node with targets */
} glb_clips;

/* Makes the bytes. Free them with ffd_glb_free_clips, after an error too. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_glb_make_clips(const glb_plan *plan, glb_clips *clips, ffd_error *error);
/* Adds the member "animations", if there are any. first: the number of the clips' first accessor. */
void ffd_glb_add_clips(const glb_clips *clips, size_t first, json_text *json);
/* Adds the clips' accessors to an array. view: the bufferView of the bytes. */
void ffd_glb_add_clip_accessors(const glb_clips *clips, size_t view, json_text *json);
/* Frees the bytes. */
void ffd_glb_free_clips(glb_clips *clips);

#endif
