#include "job/measure/weight_tears.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "job/chain/chain_apply.h"
#include "job/pass/vertex_rounding.h"
#include <math.h>
#include <string.h>

/* Scratch memory for a run of splits. */
typedef struct split_run {
    const deform_job *job;
    const weight_split *splits; /* of the run */
    vertex_owners owners;
    double x[3 * CHAIN_RUN], delta[3 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
    chain_scratch chain;
} split_run;

/* As the vertices themselves are located. */
static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const split_run *const run = context;
    ffd_vertex_rounding(&run->owners, ffd_job_judged(run->job), run->splits[point].vertex,
                        is_first ? NULL : x, half);
}

/* Finds the displacements of a run, before they are weighted. */
static ffd_status displace(split_run *s, size_t count, ffd_error *error)
{
    const chain_rounding rounding = {find_rounding, s};
    const lattice_chain *const chain = &s->job->chain;
    chain_run run = {.x = s->x,
                     .count = count,
                     .rounding = &rounding,
                     .scratch = &s->chain,
                     .delta = s->delta,
                     .outcomes = s->outcomes};
    for (size_t i = 0; i < count; i++)
        memcpy(s->x + 3 * i, s->splits[i].position, 3 * sizeof *s->x);
    return ffd_chain_apply(chain, chain->count, &run, error);
}

/* Counts a split with its step. */
static ffd_status count_split(deform_job *job, const weight_split *split, double step, ffd_job_result *result,
                              bool *is_largest, ffd_error *error)
{
    ffd_tear_figures *const tear = &result->tear;
    if (!(step > 0))
        return FFD_OK;
    tear->edges++;
    if (step > tear->largest) {
        tear->largest = step;
        tear->vertex = split->vertex;
        tear->cause = FFD_TEAR_WEIGHTS;
        *is_largest = true;
    }
    return job->details ? ffd_torn_edges_add(&job->details->tears, split->first, split->vertex, step, error)
                        : FFD_OK;
}

static ffd_status count_run(deform_job *job, split_run *s, size_t count, ffd_job_result *result,
                            bool *is_largest, ffd_error *error)
{
    const vertex_weights *const weights = &job->weights;
    TRY(displace(s, count, error));
    for (size_t i = 0; i < count; i++) {
        const weight_split *const split = &s->splits[i];
        const double apart =
            fabs(ffd_vertex_weight(weights, split->vertex) - ffd_vertex_weight(weights, split->first));
        TRY(count_split(job, split, apart * vec_length(s->delta + 3 * i), result, is_largest, error));
    }
    return FFD_OK;
}

ffd_status ffd_weight_tears_add(deform_job *job, ffd_job_result *result, bool *is_largest, ffd_error *error)
{
    const vertex_weights *const weights = &job->weights;
    split_run *s = NULL;
    ffd_status status;
    *is_largest = false;
    if (weights->split_count == 0 || job->totals.moved == 0)
        return FFD_OK;
    s = ffd_alloc_zero(1, sizeof *s);
    TRY_END(s ? FFD_OK : ffd_fail_memory(error));
    s->job = job;
    TRY_END(ffd_vertex_owners_list(job->document, &s->owners, error));
    for (size_t first = 0; first < weights->split_count; first += CHAIN_RUN) {
        const size_t left = weights->split_count - first, count = left < CHAIN_RUN ? left : CHAIN_RUN;
        s->splits = weights->splits + first;
        TRY_END(ffd_deadline_check(error));
        TRY_END(count_run(job, s, count, result, is_largest, error));
    }
    if (job->details)
        ffd_torn_edges_thin(&job->details->tears);
end:
    if (s)
        ffd_vertex_owners_free(&s->owners);
    ffd_free(s);
    return status;
}
