/* batch.h - runs many jobs in several worker processes, so that no job can harm another
   (data/schema/formats.md 3). batch_run.c has ffd_batch_run. */
#ifndef FFD_BATCH_BATCH_H
#define FFD_BATCH_BATCH_H

#include "batch/manifest/job_source.h"
#include "batch/pool.h"

typedef struct batch_desc {
    job_source_desc jobs;
    pool_desc pool;        /* the batch sets report, depfile and records */
    const char *report;    /* path; "-": standard output; or NULL */
    const char *depfile;   /* path, for the rules of all outputs; or NULL */
    const char *view;      /* folder for pictures of the jobs and the page that compares them; or NULL */
    const char *journal;   /* path; NULL: ffd_journal_default_path */
    const char *positions; /* path (.npy) of the array of the jobs' positions; or NULL */
    bool positions_double; /* the array holds float64, else float32 */
    bool shared_box;       /* "box": "mesh" is one box for all meshes */
    bool force;            /* replace an existing page or array */
    bool stop;             /* stop at the first failure */
    bool quiet;            /* report only failures */
} batch_desc;

/* Runs the batch, with messages on standard error. *failed: a job failed or was not reached. Errors: those of
   the manifest, the report and the workers; a failed job is not an error. */
ffd_status ffd_batch_run(const batch_desc *desc, bool *failed, ffd_error *error);

#endif
