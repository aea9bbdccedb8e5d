/* batch_desc.h - a batch as its parts see it (public: ffd/batch.h). batch_run.c has ffd_batch_do. */
#ifndef FFD_BATCH_BATCH_DESC_H
#define FFD_BATCH_BATCH_DESC_H

#include "batch/manifest/job_source.h"
#include "batch/pool.h"
#include <ffd/batch.h>

typedef struct batch_desc {
    const ffd_batch_desc *given; /* report, depfile, view, journal, positions, callbacks, .. */
    job_source_desc jobs;
    pool_desc pool; /* the batch sets what its report, depfile, view and journal ask for */
    bool force;     /* replace an existing page or array */
} batch_desc;

/* Runs the batch. result is filled in every case. Errors: those of ffd_batch_run. */
ffd_status ffd_batch_do(const batch_desc *desc, ffd_batch_result *result, ffd_error *error);

#endif
