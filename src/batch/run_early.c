/* run_early.c - reads the jobs of a batch before the first one begins, since each must know what all others
   write. */
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include "batch/batch_run.h"
#include "batch/files/run_reads.h"

/* The most jobs that are kept when they have been read for the first time. */
#define MOST_EARLY 4096

void ffd_run_drop_early(batch_run *run)
{
    early_jobs *const early = &run->early;
    for (size_t i = early->next; i < early->count; i++)
        ffd_job_free(&early->list[i]);
    ffd_free(early->list);
    *early = (early_jobs){0};
}

/* Keeps a job, which is taken over, while there are few. */
static ffd_status keep(batch_run *run, batch_job *job, ffd_error *error)
{
    early_jobs *const early = &run->early;
    if (early->are_all && early->count == MOST_EARLY)
        ffd_run_drop_early(run);
    if (!early->are_all) {
        ffd_job_free(job);
        return FFD_OK;
    }
    if (!ffd_grow((void **)&early->list, &early->capacity, early->count + 1, sizeof *early->list)) {
        ffd_job_free(job);
        return ffd_fail_memory(error);
    }
    early->list[early->count++] = *job;
    return FFD_OK;
}

/* Looks at the next job, if there is one. */
static ffd_status expect_next(batch_run *run, bool checks, line_state *state, ffd_error *error)
{
    batch_job job = {0};
    ffd_status status;
    TRY_END(ffd_jobs_next(run->source, &job, state, error));
    if (*state == LINE_READ && !job.error.status) {
        if (checks)
            ffd_reads_check_own(&run->files, &job);
        if (job.error.status && error)
            *error = job.error;
        TRY_END(job.error.status);
        TRY_END(ffd_claims_expect(&run->files, &job, error));
    }
    if (*state == LINE_READ)
        return keep(run, &job, error);
end:
    ffd_job_free(&job);
    return status;
}

ffd_status ffd_run_expect(batch_run *run, bool checks, ffd_error *error)
{
    const job_source_desc *const jobs = &run->desc->jobs;
    line_state state = LINE_READ;
    run->files.comes_once = ffd_jobs_come_once(jobs);
    run->files.has_odd_outputs = run->files.comes_once || run->view;
    if (run->files.comes_once)
        return FFD_OK;
    run->early.are_all = true;
    while (state == LINE_READ && !ffd_interrupt_requested())
        TRY(expect_next(run, checks, &state, error));
    if (run->early.are_all)
        return FFD_OK;
    ffd_jobs_close(&run->source);
    return ffd_jobs_open(jobs, &run->source, error);
}

ffd_status ffd_run_next_job(batch_run *run, batch_job *job, line_state *state, ffd_error *error)
{
    early_jobs *const early = &run->early;
    if (!early->are_all)
        return ffd_jobs_next(run->source, job, state, error);
    *state = early->next < early->count ? LINE_READ : LINE_NONE;
    if (*state == LINE_READ)
        *job = early->list[early->next++];
    return FFD_OK;
}

double ffd_run_fraction(const batch_run *run)
{
    const early_jobs *const early = &run->early;
    if (!early->are_all)
        return ffd_jobs_fraction(run->source);
    return early->count ? (double)early->next / (double)early->count : -1;
}
