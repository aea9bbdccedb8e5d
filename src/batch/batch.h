/* batch.h - many jobs, done by several workers, so that no job can harm another
   (data/schema/formats.md 3). batch_run.c has ffd_batch_run. */
#ifndef FFD_BATCH_BATCH_H
#define FFD_BATCH_BATCH_H

#include "batch/manifest/job_source.h"
#include "batch/pool.h"

typedef struct batch_desc {
    job_source_desc jobs;
    pool_desc pool;        /* report, depfile and records are set by the batch */
    const char *report;    /* "-": standard output; or NULL */
    const char *depfile;   /* with the rules of all outputs; or NULL */
    const char *view;      /* a folder for the jobs' pictures and the page that compares them; or NULL */
    const char *journal;   /* or NULL: where ffd_journal_default_path says */
    const char *positions; /* the array of the jobs' positions, ends in .npy; or NULL */
    bool positions_double; /* of float64 numbers, else of float32 */
    bool shared_box;       /* all meshes have one box */
    bool force;            /* an existing page or array is replaced */
    bool stop;             /* at the first failure */
    bool quiet;            /* only what went wrong */
} batch_desc;

/* Runs the batch, with messages for people on standard error. Sets *failed if a job failed or was not
   reached. Errors: those of the manifest, the report and the workers; a failed job is not an error. */
ffd_status ffd_batch_run(const batch_desc *desc, bool *failed, ffd_error *error);

#endif
