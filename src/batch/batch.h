/* batch.h - many jobs, by several workers, of which none can harm another (data/schema/formats.md 3). */
#ifndef FFD_BATCH_BATCH_H
#define FFD_BATCH_BATCH_H

#include "batch/job_source.h"
#include "batch/pool.h"

typedef struct batch_desc {
    job_source_desc jobs;
    pool_desc pool;      /* report, depfile and records are set by the batch */
    const char *report;  /* "-": standard output; or NULL */
    const char *depfile; /* with the rules of all outputs; or NULL */
    const char *journal; /* or NULL: where ffd_journal_default_path says */
    bool stop;           /* at the first failure */
    bool quiet;          /* only what went wrong */
} batch_desc;

/* Runs the batch; says on standard error what people want to know. *failed: a job did, or was not reached.
   Errors: those of the manifest, the report and the workers; jobs that failed are none. */
ffd_status ffd_batch_run(const batch_desc *desc, bool *failed, ffd_error *error);

#endif
