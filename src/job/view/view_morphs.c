/* view_morphs.c - the job of a view with --morph: a pass for each lattice over the base shape. The shape
   after has all of the targets in full: their displacements and gradients add up. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "job/input/source.h"
#include "job/morphs.h"
#include "job/view/view.h"
#include <math.h>
#include <string.h>

typedef struct morph_work {
    view_morphs *morphs;
    job_details *all; /* of all targets */
    size_t count;     /* vertices of the document */
    uint64_t taken;   /* of its budget, before a target */
} morph_work;

ffd_status ffd_view_read_positions(const mesh_document *document, mesh_state state, double **positions,
                                   ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    size_t first = 0;
    TRY(ffd_budget_take((memory_budget *)&document->budget, count, 3 * sizeof **positions, error));
    *positions = ffd_alloc(count, 3 * sizeof **positions);
    if (!*positions)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions)
            continue;
        ffd_source_positions(document, state, i, 0, part->vertex_count, *positions + 3 * first);
        first += part->vertex_count;
    }
    return FFD_OK;
}

/* Adds a target's displacements to the shape after. A vertex without a place has none. */
static ffd_status add_move(morph_work *w, memory_budget *budget, const double *deformed, ffd_error *error)
{
    view_morphs *const morphs = w->morphs;
    TRY(ffd_budget_take(budget, w->count, 3 * sizeof(float), error));
    float *const move = ffd_alloc_zero(w->count, 3 * sizeof *move);
    if (!move)
        return ffd_fail_memory(error);
    morphs->moves[morphs->count++] = move;
    for (size_t i = 0; i < 3 * w->count && deformed; i++) {
        const double by = deformed[i] - morphs->base[i];
        move[i] = isfinite((float)by) ? (float)by : 0;
        morphs->after[i] += isfinite(by) ? by : 0;
        morphs->shift[i] += isfinite(by) ? by : 0;
    }
    return FFD_OK;
}

/* As with several lattices: outside is what is outside of all; else the highest status counts. */
static void join_statuses(uint8_t *all, const uint8_t *own, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const bool is_outside = own[i] == FFD_VERTEX_OUTSIDE || all[i] == FFD_VERTEX_OUTSIDE;
        const uint8_t most = own[i] > all[i] ? own[i] : all[i], least = own[i] < all[i] ? own[i] : all[i];
        all[i] = is_outside && most == FFD_VERTEX_OUTSIDE ? least : most;
    }
}

static double largest_step(const torn_edges *torn)
{
    double most = 0;
    for (size_t i = 0; i < torn->count; i++)
        most = larger_of(most, torn->list[i].step);
    return most;
}

/* Joins the details of a target with those of the targets before. Torn edges are of the one with the largest
   step, as in the figures of all. */
static void join_details(job_details *all, job_details *own, size_t count)
{
    join_statuses(all->statuses, own->statuses, count);
    for (size_t i = 0; i < 9 * count && all->gradients && own->gradients; i++)
        all->gradients[i] += own->gradients[i];
    for (size_t i = 0; i < count && all->collapsed && own->collapsed; i++)
        all->collapsed[i] |= own->collapsed[i];
    if (largest_step(&own->tears) > largest_step(&all->tears)) {
        const torn_edges torn = all->tears;
        all->tears = own->tears;
        own->tears = torn;
    }
}

static ffd_status note_budget(void *context, deform_job *job, size_t target, ffd_error *error)
{
    (void)target;
    (void)error;
    ((morph_work *)context)->taken = job->document->budget.taken;
    return FFD_OK;
}

/* Takes the details of a target. Those of the first are kept for all, the memory of the others is free again.
 */
static ffd_status take_target(void *context, deform_job *job, size_t target, ffd_error *error)
{
    morph_work *const w = context;
    job_details *const own = job->details;
    ffd_status status;
    if (target > 0)
        job->document->budget.taken = w->taken;
    TRY_END(add_move(w, &job->document->budget, own->deformed, error));
    if (!w->all->statuses) {
        *w->all = *own;
        *own = (job_details){0};
    } else
        join_details(w->all, own, w->count);
end:
    ffd_details_free(own);
    return status;
}

static ffd_status run_each(deform_job *job, morph_work *w, ffd_job_result *result, ffd_error *error)
{
    view_morphs *const morphs = w->morphs;
    const morph_steps steps = {note_budget, take_target, w, .goes_on = true};
    TRY(ffd_view_read_positions(job->document, MESH_STORED, &morphs->base, error));
    TRY(ffd_view_read_positions(job->document, MESH_SHOWN, &morphs->after, error));
    morphs->shift = ffd_alloc_zero(w->count, 3 * sizeof *morphs->shift);
    morphs->moves = ffd_alloc_zero(job->desc->lattice_count, sizeof *morphs->moves);
    if (!morphs->shift || !morphs->moves)
        return ffd_fail_memory(error);
    return ffd_morphs_run_each(job, &steps, result, error);
}

/* Takes away what default weights show of one target of the file. */
static ffd_status take_away(const mesh_document *document, const mesh_target *target, view_morphs *morphs,
                            size_t first, ffd_error *error)
{
    const size_t count = document->parts[target->part].vertex_count;
    double *const offsets = ffd_alloc(count, 3 * sizeof *offsets);
    if (!offsets)
        return ffd_fail_memory(error);
    document->format->morphs->read_target(document, target, false, offsets);
    for (size_t i = 0; i < 3 * count; i++) {
        morphs->after[3 * first + i] -= target->weight * offsets[i];
        morphs->shift[3 * first + i] -= target->weight * offsets[i];
    }
    ffd_free(offsets);
    return FFD_OK;
}

/* A target of the file that has the name of a new one is replaced: it is not in the shape after. */
static ffd_status drop_replaced(const deform_job *job, view_morphs *morphs, ffd_error *error)
{
    const mesh_document *const document = job->document;
    mesh_targets targets = {0};
    size_t *first = NULL;
    ffd_status status;
    if (!document->format->morphs)
        return FFD_OK;
    TRY_END(document->format->morphs->list_targets(document, &targets, error));
    TRY_END(ffd_first_vertices(document, &first, error));
    for (size_t t = 0; t < targets.count; t++)
        if (targets.list[t].weight != 0 &&
            ffd_view_replaces(job->desc->morphs, job->desc->lattice_count, &targets.list[t]))
            TRY_END(take_away(document, &targets.list[t], morphs, first[targets.list[t].part], error));
end:
    ffd_mesh_targets_free(&targets);
    ffd_free(first);
    return status;
}

ffd_status ffd_view_run_morphs(deform_job *job, view_morphs *morphs, ffd_job_result *result, ffd_error *error)
{
    job_details *const all = job->details;
    job_details own = {0};
    morph_work w = {.morphs = morphs, .all = all, .count = (size_t)ffd_mesh_vertex_count(job->document)};
    job->stored = true; /* the other targets stay, and are not judged */
    TRY(ffd_morphs_begin(job, error));
    job->details = &own;
    const ffd_status status = run_each(job, &w, result, error);
    ffd_details_free(&own);
    ffd_morphs_end(job);
    job->details = all;
    result->morphs.count = 0; /* only jobs that write list them */
    /* Faces are judged by the shape that has all targets. */
    for (size_t i = 0; i < 3 * w.count && all->deformed; i++)
        all->deformed[i] = morphs->base[i] + morphs->shift[i];
    if (status && status != FFD_E_GATE)
        return status;
    const ffd_status dropped = drop_replaced(job, morphs, error);
    return dropped ? dropped : status;
}

void ffd_view_free_morphs(view_morphs *morphs)
{
    for (size_t k = 0; k < morphs->count; k++)
        ffd_free(morphs->moves[k]);
    ffd_free(morphs->moves);
    ffd_free(morphs->base);
    ffd_free(morphs->after);
    ffd_free(morphs->shift);
    *morphs = (view_morphs){0};
}
