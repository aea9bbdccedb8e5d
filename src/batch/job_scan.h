/* job_scan.h - scans the files of a job, as the first process must know them before the job works
   (files/scan.h). */
#ifndef FFD_BATCH_JOB_SCAN_H
#define FFD_BATCH_JOB_SCAN_H

#include "batch/hash_cache.h"
#include "batch/wire.h"
#include <ffd/job.h>

/* Returns the format of the output; FFD_FORMAT_AUTO: there is none, or it is unknown. */
ffd_format ffd_job_output_format(const ffd_deform_desc *desc);
/* Scans what the task asks for, and adds it to `found`. answer->scanned: there is something, which the
   first process must know first. An unreadable mesh fails the job later. Errors: FFD_E_MEMORY, those of
   listing the folder of the output. */
ffd_status ffd_job_scan(hash_cache *hashes, const wire_task *task, const ffd_deform_desc *desc,
                        byte_buffer *found, wire_answer *answer, ffd_error *error);

#endif
