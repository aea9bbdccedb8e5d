/* job_picture.h - the picture of a batch job: before and after. */
#ifndef FFD_BATCH_JOB_PICTURE_H
#define FFD_BATCH_JOB_PICTURE_H

#include <ffd/job.h>
#include <stdbool.h>

/* Refuses to replace an existing picture (FFD_E_EXISTS) unless force. Call it before the job writes anything.
   The picture's folder need not exist. */
ffd_status ffd_job_picture_check(const char *path, bool force, ffd_error *error);
/* Whether the picture exists and is not older than the output, so that it shows the same job. */
bool ffd_job_picture_is_current(const char *path, const char *output);
/* Drops the mesh that the job has left in the cache, if it is large: drawing needs the memory. */
void ffd_job_picture_drop_mesh(const ffd_deform_desc *desc);
/* Draws the job like `ffd view` with a look (ffd_batch_desc), and makes the picture's folders. result: as of
   ffd_check_run. A job that a gate refuses (FFD_E_GATE) is drawn too. Errors: all of these. */
ffd_status ffd_job_picture_write(const char *path, const ffd_deform_desc *desc, const ffd_view_desc *look,
                                 bool force, ffd_job_result *result);

#endif
