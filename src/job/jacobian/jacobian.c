/* jacobian.c - the job of `ffd jacobian`. */
#include "job/jacobian/jacobian.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/deadline.h"
#include "job/input/deform_desc.h"
#include "job/input/in_memory.h"
#include "job/input/source.h"
#include "job/judge/warnings.h"
#include "job/reads.h"
#include <string.h>

void ffd_jacobian_desc_init(ffd_jacobian_desc *desc, size_t size)
{
    const ffd_jacobian_desc defaults = {.struct_size = sizeof defaults, .of = FFD_LATTICE_LAST};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static bool is_product(const ffd_jacobian_desc *desc)
{
    return desc->times || desc->transposed;
}

/* force is for older outputs, not for what is read. */
static bool is_input(const ffd_jacobian_desc *desc)
{
    const char *const arrays[] = {desc->times_bytes.data ? NULL : desc->times,
                                  desc->transposed_bytes.data ? NULL : desc->transposed};
    bool found = ffd_job_reads_mesh(&desc->job->input, desc->output);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        found = found || (arrays[i] && ffd_file_same(arrays[i], desc->output));
    found = found || ffd_job_reads_weights(desc->job, desc->output);
    return found || ffd_job_reads_lattice(desc->job->lattices, desc->job->lattice_count, desc->output);
}

static ffd_status check_output(const ffd_jacobian_desc *desc, ffd_error *error)
{
    const char *const path = desc->output;
    const bool npy = ffd_path_has_ending(path, ".npy"), by_points = desc->by == FFD_BY_POINTS;
    if (ffd_output_is_stream(path))
        return ffd_fail(error, FFD_E_ARGUMENT, "a matrix cannot be written to a stream");
    if (is_product(desc) ? !npy
                         : !npy && !ffd_path_has_ending(path, ".npz") && !ffd_path_has_ending(path, ".mtx"))
        return ffd_fail_file(error, FFD_E_ARGUMENT, path, "must end in %s",
                             is_product(desc) ? ".npy: a product is an array" : ".npz, .mtx or .npy");
    if (npy && !is_product(desc) && by_points)
        return ffd_fail_file(error, FFD_E_ARGUMENT, path,
                             "a matrix by control points is sparse: it is written as .npz or .mtx");
    if (desc->job->sink)
        return FFD_OK;
    if (is_input(desc))
        return ffd_fail_file(error, FFD_E_EXISTS, path, "is an input of this command");
    return ffd_output_check(path, desc->job->force, error);
}

static ffd_status check_desc(const ffd_jacobian_desc *desc, ffd_error *error)
{
    if (!desc->job || !desc->output)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (desc->by != FFD_BY_POINTS && desc->by != FFD_BY_PARAMETERS)
        return ffd_fail(error, FFD_E_ARGUMENT, "%d is not a value of ffd_jacobian_by", (int)desc->by);
    if (desc->times && desc->transposed)
        return ffd_fail(error, FFD_E_ARGUMENT, "{times} and {transposed} cannot be used together");
    if (desc->of != FFD_LATTICE_LAST && desc->by == FFD_BY_PARAMETERS)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "{of} is for {by=points}: parameters are those of all lattices");
    if (desc->job->blocks && desc->job->lattice_count > 1)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "the derivative is not supported for lattices side by side ({blocks})");
    return check_output(desc, error);
}

static ffd_status check_differences(const jacobian *j, double *worst, ffd_error *error)
{
    TRY(ffd_jacobian_check(j, worst, error));
    if (*worst <= JACOBIAN_TOLERANCE)
        return FFD_OK;
    return ffd_fail(error, FFD_E_GATE, "central differences disagree by %.2g, more than %g", *worst,
                    JACOBIAN_TOLERANCE);
}

static ffd_status make(jacobian *j, ffd_jacobian_result *result, ffd_error *error)
{
    uint64_t *starts = NULL;
    ffd_status status;
    TRY_END(ffd_jacobian_prepare(j, error));
    starts = ffd_alloc(j->rows + 1, sizeof *starts);
    if (!starts)
        TRY_END(ffd_fail_memory(error));
    TRY_END(ffd_jacobian_count(j, starts, &result->moving, error));
    if (j->desc->check)
        TRY_END(check_differences(j, &result->worst, error));
    TRY_END(ffd_deadline_check(error));
    TRY_END(is_product(j->desc) ? ffd_jacobian_multiply(j, error) : ffd_jacobian_write(j, starts, error));
end:
    result->rows = j->rows;
    result->columns = j->columns;
    result->vertices = j->count;
    result->entries = starts ? starts[j->rows] : 0;
    ffd_free(starts);
    return status;
}

static ffd_status differentiate(const ffd_jacobian_desc *desc, ffd_jacobian_result *result, ffd_error *error)
{
    ffd_job_result figures;
    jacobian j = {.desc = desc};
    ffd_status status;
    TRY_END(ffd_deform_job_begin(&j.job, desc->job, true, &figures));
    TRY_END(ffd_deform_job_refuse_morphs(desc->job, &figures.error));
    TRY_END(ffd_deform_job_open(&j.job, desc->by == FFD_BY_PARAMETERS ? JOB_NEEDS_DERIVATIVES : 0, &figures,
                                &figures.error));
    if (!desc->job->sink)
        TRY_END(ffd_job_check_mesh_files(desc->output, &desc->job->input, j.job.document, &figures.error));
    if (!desc->job->sink)
        TRY_END(ffd_job_check_box_files(desc->output, &j.job.chain, desc->job->lattices, &figures.error));
    TRY_END(make(&j, result, &figures.error));
end:
    ffd_jacobian_free(&j);
    return ffd_deform_job_end(&j.job, status, &figures, error);
}

/* Names and checks data in memory. The job's own output is ignored. */
static ffd_status take_memory(job_memory *memory, ffd_jacobian_desc *desc, ffd_deform_desc *job,
                              ffd_error *error)
{
    ffd_status status;
    TRY_END(ffd_in_memory_output(job->sink, desc->output, error));
    TRY_END(ffd_in_memory_bytes(desc->times_bytes, "times", &desc->times, error));
    TRY_END(ffd_in_memory_bytes(desc->transposed_bytes, "transposed", &desc->transposed, error));
end:
    job->output = NULL;
    return status ? status : ffd_in_memory_desc(memory, job, error);
}

static ffd_status take(job_memory *memory, const ffd_jacobian_desc *callers,
                       const ffd_jacobian_result *callers_result, ffd_jacobian_desc *desc,
                       ffd_deform_desc *job, ffd_error *error)
{
    ffd_jacobian_desc_init(desc, sizeof *desc);
    TRY(ffd_struct_take(desc, sizeof *desc, callers, "ffd_jacobian_desc", error));
    if (callers_result)
        TRY(ffd_struct_check(sizeof *callers_result, callers_result, "ffd_jacobian_result", error));
    if (desc->job) {
        TRY(ffd_deform_desc_take(desc->job, job, error));
        TRY(take_memory(memory, desc, job, error));
        desc->job = job;
    }
    return check_desc(desc, error);
}

ffd_status ffd_jacobian_run(const ffd_jacobian_desc *callers, ffd_jacobian_result *callers_result,
                            ffd_error *error)
{
    ffd_jacobian_desc desc;
    ffd_jacobian_result result = {.struct_size = sizeof result};
    ffd_deform_desc job;
    ffd_error own;
    job_memory memory = {0};
    deadline limit;
    ffd_status status;
    TRY_END(take(&memory, callers, callers_result, &desc, &job, &own));
    const deadline *const before = ffd_deadline_begin(&limit, job.timeout, NULL);
    status = differentiate(&desc, &result, &own);
    ffd_deadline_end(before);
    if (callers_result)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
end:
    status = ffd_in_memory_end(&memory, status, &own);
    if (status && error)
        *error = own;
    return status;
}
