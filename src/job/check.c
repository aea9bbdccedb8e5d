/* check.c - the job of `ffd check`. */
#include "job/deform_job.h"
#include "job/job_call.h"

ffd_status ffd_check_run(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    job_call call;
    deform_job job;
    ffd_status status = ffd_job_call_begin(&call, desc, result, error);
    if (!status) {
        status = ffd_deform_job_begin(&job, &call.desc, true, &call.result);
        if (!status)
            status = ffd_deform_job_open(&job, JOB_NEEDS_NORMALS, &call.result, &call.result.error);
        if (!status)
            status = ffd_deform_job_run(&job, &call.result, &call.result.error);
        status = ffd_deform_job_end(&job, status, &call.result, NULL);
    }
    return ffd_job_call_end(&call, status, error);
}
