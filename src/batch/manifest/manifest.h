/* manifest.h - a job as a line of a manifest says it (data/schema/formats.md 3). */
#ifndef FFD_BATCH_MANIFEST_MANIFEST_H
#define FFD_BATCH_MANIFEST_MANIFEST_H

#include "batch/manifest/job_words.h"

/* Reads a line into an empty job whose line number is set. What is wrong with it comes into the job's error;
   returns FFD_OK or FFD_E_MEMORY. */
ffd_status ffd_job_parse(const batch_frame *frame, const char *text, size_t size, batch_job *job);

#endif
