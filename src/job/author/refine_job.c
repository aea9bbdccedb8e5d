/* refine_job.c - the job of `ffd lattice refine`. */
#include "author/difference.h"
#include "author/refine.h"
#include "base/struct_size.h"
#include "base/system/clock.h"
#include "base/system/thread.h"
#include "job/author/author_job.h"
#include "job/chain/lattice_memory.h"
#include "lattice/file/lattice_source.h"
#include <inttypes.h>
#include <string.h>

static void note_shape(const ffd_lattice *lattice, size_t size[3], int degree[3])
{
    for (int a = 0; a < 3; a++) {
        size[a] = lattice->size[a];
        degree[a] = lattice->knots[a].degree;
    }
}

/* Takes the memory of the refined lattice, before any of it is used. */
static ffd_status take_memory_of(const ffd_lattice *from, const ffd_refine_desc *refine, author_input *input,
                                 ffd_error *error)
{
    lattice_spec spec;
    TRY(ffd_lattice_refined_spec(from, refine, &spec, error));
    return ffd_lattice_memory_take(&input->memory, &spec, 0, error);
}

static void tell(const author_job *job, const ffd_refine_result *r)
{
    ffd_log_line(
        &job->log, FFD_LOG_INFO,
        "%s: %zu x %zu x %zu control points of degree %d, %d, %d become %zu x %zu x %zu of degree %d, "
        "%d, %d; the maps differ by at most %.2g",
        ffd_lattice_name(job->lattices), r->size_before[0], r->size_before[1], r->size_before[2],
        r->degree_before[0], r->degree_before[1], r->degree_before[2], r->size[0], r->size[1], r->size[2],
        r->degree[0], r->degree[1], r->degree[2], r->largest_difference);
}

/* Measures how far the maps differ, by as many threads as the memory that is left allows. */
static ffd_status measure(const author_job *job, const author_input *input, const ffd_lattice *made,
                          double *largest, ffd_error *error)
{
    const uint64_t each = ffd_lattice_difference_bytes(input->lattices[0], made);
    const int threads =
        ffd_budget_threads(&input->memory, ffd_threads_for(job->desc.threads, UINT64_MAX), each);
    TRY(ffd_budget_check(&input->memory, 1, each, error));
    return ffd_lattice_difference(input->lattices[0], made, threads, largest, error);
}

/* Makes the lattice and, if asked to, measures it. */
static ffd_status make(const author_job *job, const ffd_refine_desc *refine, author_input *input,
                       ffd_lattice **made, ffd_refine_result *result, bool measures, ffd_error *error)
{
    TRY(take_memory_of(input->lattices[0], refine, input, error));
    TRY(ffd_lattice_refine(input->lattices[0], refine, made, error));
    note_shape(*made, result->size, result->degree);
    return measures ? measure(job, input, *made, &result->largest_difference, error) : FFD_OK;
}

static ffd_status run(const author_job *job, const ffd_refine_desc *refine, ffd_refine_result *result,
                      bool measures, ffd_error *error)
{
    const double start = ffd_clock_seconds();
    author_input input = {0};
    ffd_lattice *made = NULL;
    ffd_status status;
    TRY_END(ffd_author_begin(job, &input, error));
    note_shape(input.lattices[0], result->size_before, result->degree_before);
    const double read = ffd_clock_seconds();
    result->seconds.read = read - start;
    TRY_END(make(job, refine, &input, &made, result, measures, error));
    const double refined = ffd_clock_seconds();
    result->seconds.refine = refined - read;
    TRY_END(ffd_author_write(job, made, error));
    result->seconds.write = ffd_clock_seconds() - refined;
    if (measures)
        tell(job, result);
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->desc.lattice.path);
    ffd_lattice_destroy(&made);
    ffd_author_end(&input);
    return status;
}

ffd_status ffd_lattice_refine_run(const ffd_author_desc *callers, const ffd_refine_desc *refine,
                                  ffd_refine_result *callers_result, ffd_error *error)
{
    ffd_refine_result result = {.struct_size = sizeof result, .largest_difference = -1};
    author_job job;
    ffd_status status;
    if (callers_result)
        TRY(ffd_struct_check(sizeof result, callers_result, "ffd_refine_result", error));
    TRY_END(ffd_author_take(callers, &job, &result.error));
    TRY_END(refine ? run(&job, refine, &result, callers_result, &result.error)
                   : ffd_fail(&result.error, FFD_E_ARGUMENT, "the job's description is not complete"));
end:
    result.status = ffd_author_leave(&job, status, &result.error);
    if (result.status && error)
        *error = result.error;
    if (callers_result)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return result.status;
}
