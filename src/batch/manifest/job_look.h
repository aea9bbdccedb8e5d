/* job_look.h - how the picture of a job is drawn: as the batch says, but for what the job says itself ("view"
   among its options). */
#ifndef FFD_BATCH_MANIFEST_JOB_LOOK_H
#define FFD_BATCH_MANIFEST_JOB_LOOK_H

#include "base/fail.h"
#include <ffd/job.h>
#include <stdbool.h>

typedef struct job_look {
    ffd_view_desc view; /* camera, up, color, width, height, frames, animation and no_cage */
    const char *side;   /* named side of the camera; NULL: a direction of its own */
} job_look;

/* Begins with the look of the batch; NULL: the default one. */
void ffd_job_look_begin(job_look *look, const ffd_view_desc *batch);
/* Sets an option to what a text says, which must live as long as the look: "true" or "false" for a flag.
   Errors: FFD_E_ARGUMENT (with a message that names the option). */
ffd_status ffd_job_look_read(job_look *look, const char *option, const char *text, ffd_error *error);
/* Whether there is an option of this name. */
bool ffd_job_look_has(const char *option);
/* Ends with the direction of a named side, which depends on the axis that points upwards. */
void ffd_job_look_end(job_look *look);

#endif
