/* job_picture.h - the picture of a job of a batch: before and after, beside its output. */
#ifndef FFD_BATCH_JOB_PICTURE_H
#define FFD_BATCH_JOB_PICTURE_H

#include <ffd/job.h>
#include <stdbool.h>

/* Refuses a picture that exists (FFD_E_EXISTS) unless force, before anything of the job is written. Its
   folder need not exist yet. */
ffd_status ffd_job_picture_check(const char *path, bool force, ffd_error *error);
/* Whether the picture is there and not older than the output: it was made of the same job. */
bool ffd_job_picture_is_current(const char *path, const char *output);
/* Drops the mesh that the job has left for the next one, where it is so large that it would count beside what
   drawing takes. */
void ffd_job_picture_drop_mesh(const ffd_deform_desc *desc);
/* Draws the job as `ffd check --picture` does, and makes folders for it. result: as ffd_check_run gives it,
   with the picture. A gate that is violated (FFD_E_GATE) has its picture too. Errors: all. */
ffd_status ffd_job_picture_write(const char *path, const ffd_deform_desc *desc, bool force,
                                 ffd_job_result *result);

#endif
