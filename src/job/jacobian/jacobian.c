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
    ffd_status status = ffd_jacobian_prepare(j, error);
    if (!status)
        starts = ffd_alloc(j->rows + 1, sizeof *starts);
    if (!status && !starts)
        status = ffd_fail_memory(error);
    if (!status)
        status = ffd_jacobian_count(j, starts, &result->moving, error);
    if (!status && j->desc->check)
        status = check_differences(j, &result->worst, error);
    if (!status)
        status = ffd_deadline_check(error);
    if (!status)
        status = is_product(j->desc) ? ffd_jacobian_multiply(j, error) : ffd_jacobian_write(j, starts, error);
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
    ffd_status status = ffd_deform_job_begin(&j.job, desc->job, true, &figures);
    if (!status)
        status = ffd_deform_job_open(&j.job, desc->by == FFD_BY_PARAMETERS ? JOB_NEEDS_DERIVATIVES : 0,
                                     &figures, &figures.error);
    if (!status && !desc->job->sink)
        status = ffd_job_check_mesh_files(desc->output, &desc->job->input, j.job.document, &figures.error);
    if (!status && !desc->job->sink)
        status = ffd_job_check_box_files(desc->output, &j.job.chain, desc->job->lattices, &figures.error);
    if (!status)
        status = make(&j, result, &figures.error);
    ffd_jacobian_free(&j);
    return ffd_deform_job_end(&j.job, status, &figures, error);
}

/* Names and checks data in memory. The job's own output is ignored. */
static ffd_status take_memory(job_memory *memory, ffd_jacobian_desc *desc, ffd_deform_desc *job,
                              ffd_error *error)
{
    ffd_status status = ffd_in_memory_output(job->sink, desc->output, error);
    if (!status)
        status = ffd_in_memory_bytes(desc->times_bytes, "times", &desc->times, error);
    if (!status)
        status = ffd_in_memory_bytes(desc->transposed_bytes, "transposed", &desc->transposed, error);
    job->output = NULL;
    return status ? status : ffd_in_memory_desc(memory, job, error);
}

ffd_status ffd_jacobian_run(const ffd_jacobian_desc *callers, ffd_jacobian_result *callers_result,
                            ffd_error *error)
{
    ffd_jacobian_desc desc;
    ffd_jacobian_result result = {.struct_size = sizeof result};
    ffd_deform_desc job;
    ffd_error own;
    ffd_jacobian_desc_init(&desc, sizeof desc);
    ffd_status status = ffd_struct_take(&desc, sizeof desc, callers, "ffd_jacobian_desc", &own);
    if (!status && callers_result)
        status = ffd_struct_check(sizeof result, callers_result, "ffd_jacobian_result", &own);
    if (!status && desc.job)
        status = ffd_deform_desc_take(desc.job, &job, &own);
    job_memory memory = {0};
    if (!status && desc.job)
        status = take_memory(&memory, &desc, &job, &own);
    desc.job = desc.job ? &job : NULL;
    if (!status)
        status = check_desc(&desc, &own);
    const bool runs = !status;
    deadline limit;
    const deadline *const before = ffd_deadline_begin(&limit, runs ? job.timeout : 0, NULL);
    if (runs)
        status = differentiate(&desc, &result, &own);
    ffd_deadline_end(before);
    status = ffd_in_memory_end(&memory, status, &own);
    if (status && error)
        *error = own;
    if (callers_result && runs)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return status;
}
