#include "batch/run_reads.h"
#include "base/system/interrupt.h"

/* Looks at the next job, if there is one. manifest: its name, or NULL. */
static ffd_status check_next(job_source *source, const run_outputs *written, const char *manifest,
                             line_state *state, ffd_error *error)
{
    batch_job job = {0};
    ffd_status status = ffd_jobs_next(source, &job, state, error);
    if (!status && *state == LINE_READ && !job.error.status) {
        ffd_outputs_check_embedding(written, manifest, &job);
        status = job.error.status;
        if (status && error)
            *error = job.error;
    }
    ffd_job_free(&job);
    return status;
}

ffd_status ffd_run_check_reads(const job_source_desc *jobs, const run_outputs *written, ffd_error *error)
{
    job_source *source;
    line_state state = LINE_READ;
    if (ffd_jobs_come_once(jobs))
        return FFD_OK;
    ffd_status status = ffd_jobs_open(jobs, &source, error);
    const char *const manifest = !status && (jobs->manifest || jobs->table) ? ffd_jobs_name(source) : NULL;
    while (!status && state == LINE_READ && !ffd_interrupt_requested())
        status = check_next(source, written, manifest, &state, error);
    ffd_jobs_close(&source);
    return status;
}
