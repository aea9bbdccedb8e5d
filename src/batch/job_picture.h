/* job_picture.h - the picture of a batch job: before and after. */
#ifndef FFD_BATCH_JOB_PICTURE_H
#define FFD_BATCH_JOB_PICTURE_H

#include "base/memory/hash.h"
#include "view/view_frame.h"
#include <ffd/job.h>
#include <stdbool.h>

typedef struct job_picture {
    const char *path; /* of the picture */
    const char *page; /* path of the page; NULL: none is wanted */
    const ffd_deform_desc *job;
    const ffd_view_desc *look; /* how both are drawn (ffd_batch_desc) */
    const view_frame *frame;   /* of the picture; NULL: its own */
    bool force;                /* replace what is there */
} job_picture;

/* Refuses to replace an existing picture (FFD_E_EXISTS) unless force. Call it before the job writes anything.
   The picture's folder need not exist. */
ffd_status ffd_job_picture_check(const char *path, bool force, ffd_error *error);
/* Whether the picture exists and is not older than the output, so that it shows the same job. */
bool ffd_job_picture_is_current(const char *path, const char *output);
/* Drops the mesh that the job has left in the cache, if it is large: drawing needs the memory. */
void ffd_job_picture_drop_mesh(const ffd_deform_desc *desc);
/* Measures the frame of the picture. result: as of ffd_check_run. A job that a gate refuses (FFD_E_GATE) is
   measured too. Errors: all of these. */
ffd_status ffd_job_picture_measure(const job_picture *picture, view_frame *frame, ffd_job_result *result);
/* Draws the job like `ffd view`, and makes the picture's folders; then the page. result and errors: likewise.
 */
ffd_status ffd_job_picture_write(const job_picture *picture, ffd_job_result *result);
/* Hashes the bytes of a picture, and those of its page, if there is one. Errors: those of reading. */
ffd_status ffd_job_picture_hash(const char *path, const char *page, hash128 *hash, ffd_error *error);

#endif
