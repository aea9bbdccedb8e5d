/* run_reads.h - jobs that read what their run replaces. */
#ifndef FFD_BATCH_RUN_READS_H
#define FFD_BATCH_RUN_READS_H

#include "batch/manifest/job_source.h"
#include "batch/outputs.h"

/* Looks at all jobs before the first one. Fails with what is wrong with the first whose embedding is a file
   of the run (FFD_E_INVALID); jobs that can be read only once are not looked at. written: the run's own files
   (ffd_outputs_reserve). Errors: those of reading jobs, too. */
ffd_status ffd_run_check_reads(const job_source_desc *jobs, const run_outputs *written, ffd_error *error);

#endif
