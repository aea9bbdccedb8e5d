/* check.c - the job of `ffd check`. */
#include "job/deform_job.h"

static ffd_status run_check_job(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    deform_job job;
    ffd_status status = ffd_deform_job_begin(&job, desc, true, result);
    if (!status)
        status = ffd_deform_job_open(&job, result, &result->error);
    if (!status)
        status = ffd_deform_job_run(&job, result, &result->error);
    return ffd_deform_job_end(&job, status, result, error);
}

ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    return ffd_job_for_caller(run_check_job, desc, result, error);
}
