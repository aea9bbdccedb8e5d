/* manifest.h - parses a job from a line of a manifest (data/schema/formats.md 3). */
#ifndef FFD_BATCH_MANIFEST_MANIFEST_H
#define FFD_BATCH_MANIFEST_MANIFEST_H

#include "batch/manifest/batch_job.h"

/* Parses a line into an empty job whose line number is set. Errors in the line are stored in job->error.
   Returns FFD_OK or FFD_E_MEMORY. */
ffd_status ffd_job_parse(const batch_frame *frame, const char *text, size_t size, batch_job *job);

#endif
