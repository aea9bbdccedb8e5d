#include "job/measure/cells.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include "cells/cell_measure.h"
#include "job/input/source.h"
#include "mesh/cell_list.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Cells that a thread takes at once. */
#define CELL_TILE ((size_t)4096)

/* What a thread has found. */
typedef struct cell_counts {
    uint64_t before, after; /* cells that are inverted */
    uint64_t by_deformation, unknown;
    uint64_t unmeasured; /* cells of kinds that are not known here */
    double least_before, least_after;
    uint64_t worst; /* the first cell that has least_after */
} cell_counts;

typedef struct cell_survey {
    const mesh_document *document;
    const double *before, *after; /* positions */
    cell_rules rules;
    cell_counts *counts; /* of each thread */
} cell_survey;

static bool is_inverted(jacobian_state state)
{
    return state == JACOBIAN_NEGATIVE || state == JACOBIAN_MIXED;
}

static void count_cell(uint64_t cell, const cell_measure *before, const cell_measure *after,
                       cell_counts *counts)
{
    const bool had_sign = before->state == JACOBIAN_POSITIVE || before->state == JACOBIAN_NEGATIVE;
    const bool is_unknown =
        after->state == JACOBIAN_UNKNOWN || (before->state == JACOBIAN_UNKNOWN && is_inverted(after->state));
    counts->before += is_inverted(before->state);
    counts->after += is_inverted(after->state);
    counts->unknown += is_unknown;
    counts->by_deformation += had_sign && !is_unknown && after->state != before->state;
    counts->least_before = minimum_number(counts->least_before, before->scaled);
    if (!(after->scaled <= counts->least_after))
        return;
    if (after->scaled < counts->least_after || cell < counts->worst)
        counts->worst = cell;
    counts->least_after = after->scaled;
}

/* Whether no point of a cell has moved: it is then measured once. A polyhedron counts as moved. */
static bool is_still(const cell_survey *survey, const cell_view *view)
{
    size_t p = 0;
    if (view->number == VTK_POLYHEDRON)
        return false;
    while (p < view->count && memcmp(survey->before + 3 * (size_t)view->words[p],
                                     survey->after + 3 * (size_t)view->words[p], 3 * sizeof(double)) == 0)
        p++;
    return p == view->count;
}

static void count_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const cell_survey *const survey = context;
    const mesh_cell_calls *const calls = survey->document->format->cells;
    cell_counts counts = survey->counts[worker];
    (void)tile;
    for (size_t c = first; c < last && !(c == first && ffd_deadline_passed()); c++) {
        const cell_view view = calls->get(survey->document, c);
        if (!view.words)
            continue;
        counts.unmeasured += !ffd_cell_type(view.number, view.count);
        const cell_measure before = ffd_cell_measure(&survey->rules, &view, survey->before, survey->before);
        const cell_measure after =
            is_still(survey, &view) ? before
                                    : ffd_cell_measure(&survey->rules, &view, survey->after, survey->before);
        count_cell(c, &before, &after, &counts);
    }
    survey->counts[worker] = counts;
}

/* Makes the rules of all kinds that the mesh has. */
static ffd_status add_rules(const deform_job *job, cell_survey *survey, ffd_error *error)
{
    const mesh_cell_calls *const calls = job->document->format->cells;
    const uint64_t count = calls->count(job->document);
    const cell_type *last = NULL;
    for (uint64_t c = 0; c < count; c++) {
        const cell_view view = calls->get(job->document, c);
        const cell_type *const type = view.words ? ffd_cell_type(view.number, view.count) : NULL;
        TRY(ffd_deadline_check_at((size_t)c, error));
        if (type && type != last)
            TRY(ffd_cell_rules_add(&survey->rules, type, error));
        last = type;
    }
    return FFD_OK;
}

static cell_counts join(const cell_counts *of_threads, int threads)
{
    cell_counts all = of_threads[0];
    for (int i = 1; i < threads; i++) {
        const cell_counts *const own = &of_threads[i];
        all.before += own->before;
        all.after += own->after;
        all.by_deformation += own->by_deformation;
        all.unknown += own->unknown;
        all.unmeasured += own->unmeasured;
        all.least_before = lesser_of(all.least_before, own->least_before);
        if (own->least_after < all.least_after ||
            (own->least_after <= all.least_after && own->worst < all.worst))
            all.worst = own->worst;
        all.least_after = lesser_of(all.least_after, own->least_after);
    }
    return all;
}

static void fill(const cell_counts *counts, uint64_t volumes, ffd_cell_figures *figures)
{
    *figures = (ffd_cell_figures){.is_there = true,
                                  .count = volumes,
                                  .inverted = {counts->before, counts->after},
                                  .by_deformation = counts->by_deformation,
                                  .unknown = counts->unknown,
                                  .has_worst = isfinite(counts->least_after)};
    figures->scaled_jacobian.before = isfinite(counts->least_before) ? counts->least_before : NAN;
    figures->scaled_jacobian.after = figures->has_worst ? counts->least_after : NAN;
    figures->worst = figures->has_worst ? counts->worst : 0;
}

ffd_status ffd_cell_gates_check(const deform_job *job, ffd_error *error)
{
    const unsigned gates = job->desc->fail_on & (FFD_GATE_INVERTED | FFD_GATE_QUALITY);
    if (!gates || ffd_mesh_volumes(job->document))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_ARGUMENT, ffd_source_name(&job->desc->input),
                         "has no volume cells, which {fail_on} %s judges",
                         gates & FFD_GATE_INVERTED ? "inverted" : "quality");
}

/* Says which cells nobody has judged. */
static void warn_unmeasured(const deform_job *job, uint64_t count)
{
    if (count)
        ffd_log_line(&job->file_log, FFD_LOG_WARNING,
                     "%" PRIu64
                     " %s of kinds whose Jacobian is not known here (of higher order) and %s as unknown",
                     count, ffd_plural(count, "cell is", "cells are"), ffd_plural(count, "counts", "count"));
}

ffd_status ffd_cell_figures_find(const deform_job *job, ffd_job_result *result, ffd_error *error)
{
    const mesh_cell_calls *const calls = job->document->format->cells;
    const uint64_t volumes = ffd_mesh_volumes(job->document);
    if (!volumes)
        return FFD_OK;
    const uint64_t count = calls->count(job->document);
    const int threads = ffd_threads_for(job->threads, count / CELL_TILE + 1);
    cell_survey survey = {.document = job->document,
                          .before = calls->positions(job->document, false),
                          .after = calls->positions(job->document, true)};
    ffd_status status;
    TRY_END(ffd_budget_check(&job->document->budget, (uint64_t)threads, sizeof *survey.counts, error));
    survey.counts = ffd_alloc_zero((size_t)threads, sizeof *survey.counts);
    if (!survey.counts)
        TRY_END(ffd_fail_memory(error));
    for (int i = 0; i < threads; i++)
        survey.counts[i] =
            (cell_counts){.least_before = HUGE_VAL, .least_after = HUGE_VAL, .worst = UINT64_MAX};
    TRY_END(add_rules(job, &survey, error));
    ffd_parallel_tiles((size_t)count, CELL_TILE, threads, count_tile, &survey);
    TRY_END(ffd_deadline_check(error));
    const cell_counts all = join(survey.counts, threads);
    fill(&all, volumes, &result->cells);
    warn_unmeasured(job, all.unmeasured);
end:
    ffd_cell_rules_free(&survey.rules);
    ffd_free(survey.counts);
    return status;
}
