/* job_call.h - a call of ffd_deform_run or ffd_check_run: the library's own copies of the caller's structs,
   which may have the sizes of an older header, and names for what is in memory. */
#ifndef FFD_JOB_JOB_CALL_H
#define FFD_JOB_JOB_CALL_H

#include "base/system/deadline.h"
#include "job/input/in_memory.h"
#include <ffd/job.h>

typedef struct job_call {
    ffd_deform_desc desc; /* with results of morph targets of its own, if the caller wants these */
    ffd_job_result result;
    ffd_job_result *callers_result, *callers_morphs;
    const ffd_lattice_source *callers_lattices;
    size_t size; /* of each of the caller's results; 0: not known, and they are not filled */
    job_memory memory;
    deadline own;           /* by the job's timeout */
    work_watch watch;       /* by its progress */
    const deadline *before; /* of the thread */
} job_call;

/* Begins a call. A failure that concerns the result's struct is in error, others are in call->result.error.
   ffd_job_call_end must be called in every case. */
ffd_status ffd_job_call_begin(job_call *call, const ffd_deform_desc *desc, ffd_job_result *result,
                              ffd_error *error);

/* Fills the caller's results, stores the failure, if there is one, in *error (may be NULL), and returns the
   status. */
ffd_status ffd_job_call_end(job_call *call, ffd_status status, ffd_error *error);

/* Returns the caller who watches a job. */
work_watch ffd_job_watch(const ffd_deform_desc *desc);
/* Tells the caller that a job has ended, unless it has failed. */
void ffd_job_watch_end(const work_watch *watch, ffd_status status);

#endif
