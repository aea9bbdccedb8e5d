/* view_run.h - a picture that has its frame in common with others (view.c). */
#ifndef FFD_JOB_VIEW_VIEW_RUN_H
#define FFD_JOB_VIEW_VIEW_RUN_H

#include "view/view_frame.h"

/* All NULL: a picture has its own frame. */
typedef struct view_frames {
    const view_frame *frame; /* of the picture; or NULL */
    view_frame *measured;    /* to be filled with the frame of the scene, and nothing is written; or NULL */
} view_frames;

/* Runs a job as ffd_view_run does. Errors: all of these. */
ffd_status ffd_view_run_framed(const ffd_view_desc *desc, const view_frames *frames, ffd_job_result *result,
                               ffd_error *error);

#endif
