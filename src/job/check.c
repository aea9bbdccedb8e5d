/* check.c - the job of `ffd check`. */
#include "job/deform_job.h"
#include "job/job_call.h"

static ffd_status check(const ffd_deform_desc *desc, ffd_job_result *result)
{
    deform_job job;
    ffd_status status;
    TRY_END(ffd_deform_job_begin(&job, desc, true, result));
    TRY_END(ffd_deform_job_refuse_morphs(desc, &result->error));
    TRY_END(ffd_deform_job_open(&job, JOB_NEEDS_NORMALS, result, &result->error));
    TRY_END(ffd_deform_job_run(&job, result, &result->error));
end:
    return ffd_deform_job_end(&job, status, result, NULL);
}

ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    job_call call;
    ffd_status status;
    TRY_END(ffd_job_call_begin(&call, desc, result, error));
    TRY_END(check(&call.desc, &call.result));
end:
    return ffd_job_call_end(&call, status, error);
}
