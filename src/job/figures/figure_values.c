#include "job/figures/figure_values.h"
#include "job/figures/figures.h"
#include "mesh/bounds.h"
#include <math.h>
#include <string.h>

static size_t size_of(figure_type type)
{
    return type == FIGURE_FLAG       ? sizeof(bool)
           : type == FIGURE_BOX      ? sizeof(ffd_bounds)
           : type == FIGURE_STATUSES ? sizeof(uint64_t[FFD_VERTEX_STATUS_COUNT])
                                     : sizeof(uint64_t);
}

/* Sets the value to which others are joined. It is 0 already. */
static void start(figure_type type, figure_join how, void *value)
{
    const double number = how == JOIN_LEAST                      ? HUGE_VAL
                          : how == JOIN_HIGHEST                  ? -HUGE_VAL
                          : how == JOIN_SAME || how == JOIN_ONLY ? NAN
                                                                 : 0;
    if (type == FIGURE_NUMBER)
        *(double *)value = number;
    else if (type == FIGURE_COUNT && (how == JOIN_LEAST || how == JOIN_WITH))
        *(uint64_t *)value = UINT64_MAX;
    else if (type == FIGURE_BOX)
        *(ffd_bounds *)value = ffd_bounds_empty();
}

/* Each of the following returns whether the value is now that of `from`. */

static bool join_number(figure_join how, double from, double *to)
{
    const bool taken = how == JOIN_LEAST ? from < *to : from > *to;
    if (how == JOIN_SUM)
        *to += from;
    else
        *to = how == JOIN_LEAST ? minimum_number(*to, from) : maximum_number(*to, from);
    return taken;
}

static bool join_count(figure_join how, uint64_t from, uint64_t *to)
{
    const bool taken = how == JOIN_LEAST ? from < *to : from > *to;
    if (how == JOIN_SUM)
        *to += from;
    else if (taken)
        *to = from;
    return taken;
}

static bool join_value(figure_type type, figure_join how, const void *from, void *to)
{
    if (how == JOIN_SAME)
        memcpy(to, from, size_of(type));
    else if (type == FIGURE_FLAG)
        *(bool *)to = *(bool *)to || *(const bool *)from;
    else if (type == FIGURE_BOX)
        ffd_bounds_join(to, from);
    else if (type == FIGURE_NUMBER)
        return join_number(how, *(const double *)from, to);
    else if (type == FIGURE_COUNT)
        return join_count(how, *(const uint64_t *)from, to);
    else
        for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
            join_count(how, ((const uint64_t *)from)[s], (uint64_t *)to + s);
    return false;
}

void ffd_totals_clear(pass_totals *totals)
{
    memset(totals, 0, sizeof *totals);
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++)
        if (f->total.type)
            start(f->total.type, f->tiles, (char *)totals + f->total.at);
}

void ffd_totals_join(const pass_totals *tile, pass_totals *all)
{
    bool taken = false;
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++) {
        const void *const from = (const char *)tile + f->total.at;
        void *const to = (char *)all + f->total.at;
        if (!f->total.type || f->tiles == JOIN_NONE)
            continue;
        if (f->tiles != JOIN_WITH)
            taken = join_value(f->total.type, f->tiles, from, to);
        else if (taken)
            memcpy(to, from, size_of(f->total.type));
    }
}

void ffd_result_clear(ffd_job_result *result)
{
    memset(result, 0, sizeof *result);
    result->struct_size = sizeof *result;
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++)
        if (*f->name)
            start(f->result.type, f->targets, (char *)result + f->result.at);
}

/* Which of -0 and 0 was found depends on the order. */
static void normalize_zeros(ffd_bounds *box)
{
    for (int a = 0; a < 3; a++) {
        box->min[a] += 0.0;
        box->max[a] += 0.0;
    }
}

void ffd_result_fill(ffd_job_result *result, const pass_totals *totals, double seconds)
{
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++)
        if (*f->name && f->total.type)
            memcpy((char *)result + f->result.at, (const char *)totals + f->total.at, size_of(f->total.type));
    normalize_zeros(&result->bounds.before);
    normalize_zeros(&result->bounds.after);
    const double vertices = (double)totals->vertices;
    const double own = totals->embed_seconds + totals->deform_seconds;
    result->morph_targets.shown_outside = totals->of_shown ? totals->weighted_outside : 0;
    result->residual.max = sqrt(totals->residual_square_max);
    result->residual.rms = totals->located ? sqrt(totals->residual_square_sum / (double)totals->located) : 0;
    result->iterations.mean = totals->vertices ? (double)totals->evaluations / vertices : 0;
    result->displacement.max = sqrt(totals->displacement_square_max);
    result->displacement.rms = totals->vertices ? sqrt(totals->displacement_square_sum / vertices) : 0;
    result->seconds.embed = own > 0 ? seconds * totals->embed_seconds / own : 0;
    result->seconds.deform = seconds - result->seconds.embed;
}

void ffd_result_note_flaws(ffd_job_result *result, const mesh_flaws *flaws)
{
    memcpy(result->flaws, flaws->list, sizeof result->flaws);
    result->flaw_count = flaws->count;
}

static int rank(ffd_fold_verdict verdict)
{
    return verdict == FFD_FOLDS_SOME ? 2 : verdict == FFD_FOLDS_UNKNOWN ? 1 : 0;
}

void ffd_folds_join(const ffd_folds *next, size_t index, ffd_folds *all)
{
    const ffd_folds before = *all;
    if (index == 0 || (!before.witness.is_there && next->witness.is_there)) {
        *all = *next;
        all->witness.lattice = next->witness.is_there ? index : 0;
    }
    if (index == 0)
        return;
    all->is_known = before.is_known && next->is_known;
    all->verdict = rank(next->verdict) > rank(before.verdict) ? next->verdict : before.verdict;
    all->cells = before.cells + next->cells;
    all->folded_cells = before.folded_cells + next->folded_cells;
    all->unknown_cells = before.unknown_cells + next->unknown_cells;
    all->min_det = before.min_det < next->min_det ? before.min_det : next->min_det;
    all->relative_to = before.min_det < next->min_det ? before.relative_to : next->relative_to;
}

/* For each kind, the result of the first target that leaves the most behind. */
static void join_behind(const ffd_job_result *target, ffd_job_result *all)
{
    for (int kind = 0; kind < FFD_BEHIND_KIND_COUNT; kind++)
        if (target->behind[kind].count > all->behind[kind].count)
            all->behind[kind] = target->behind[kind];
}

/* Lists the faces of one more target. */
static void join_seam(const ffd_seam_figures *target, ffd_seam_figures *all)
{
    const uint64_t before = all->count;
    if (!target->is_there || before == FFD_LATTICES_MOST)
        return;
    *all = before == 0 ? *target : *all;
    all->faces[before] = target->faces[0];
    all->count = before + 1;
}

/* Joins target `number` of count. before: all before that. taken: of the figure before. */
static bool join_target(const figure *f, const ffd_job_result *target, size_t index, size_t count,
                        const ffd_job_result *before, bool taken, ffd_job_result *all)
{
    const bool is_first = index == 0;
    const void *const from = (const char *)target + f->result.at;
    void *const to = (char *)all + f->result.at;
    switch (f->targets) {
    case JOIN_NONE:
        return false;
    case JOIN_FOLDS:
        ffd_folds_join(&target->folds, index, &all->folds);
        return false;
    case JOIN_BEHIND:
        join_behind(target, all);
        return false;
    case JOIN_SEAM:
        join_seam(&target->seam, &all->seam);
        return false;
    case JOIN_ALL:
        *(bool *)to = *(const bool *)from && (is_first || *((const bool *)before + f->result.at));
        return false;
    case JOIN_ONLY:
        *(double *)to = count == 1 ? *(const double *)from : NAN;
        return false;
    case JOIN_WITH:
        if (taken)
            memcpy(to, from, size_of(f->result.type));
        return taken;
    case JOIN_FEWEST:
        if (is_first || target->counts[FFD_VERTEX_INSIDE] < before->counts[FFD_VERTEX_INSIDE])
            memcpy(to, from, size_of(f->result.type));
        return false;
    case JOIN_GROUP:
        if (is_first ||
            *(const double *)((const char *)target + f->by) > *(const double *)((const char *)before + f->by))
            memcpy(to, from, f->size);
        return false;
    default:
        return join_value(f->result.type, f->targets, from, to);
    }
}

void ffd_results_join(const ffd_job_result *targets, size_t count, ffd_job_result *all)
{
    for (size_t k = 0; k < count; k++) {
        const ffd_job_result before = *all;
        bool taken = false;
        for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++)
            if (*f->name)
                taken = join_target(f, &targets[k], k, count, &before, taken, all);
    }
}
