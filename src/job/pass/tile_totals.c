#include "job/pass/tile_totals.h"
#include "base/memory/memory.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "job/pass/tile_misses.h"
#include "mesh/bounds.h"

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* Widens the box by the finite points. Returns whether all are finite. (Deformed positions that overflow are
   refused elsewhere as too large.) */
static bool widen_all(const part_work *work, const double *points, size_t count, ffd_bounds *box)
{
    if (ffd_array_kernel(work->pass->chain->isa)->widen(points, count, box->min, box->max))
        return true;
    for (size_t i = 0; i < count; i++)
        if (vec_is_finite(points + 3 * i))
            ffd_bounds_widen(box, points + 3 * i);
    return false;
}

/* Widens the box by the chosen vertices that count for bounds. Returns whether all chosen vertices are
   finite. */
static bool widen_chosen(const part_work *work, const tile_scratch *scratch, size_t first, ffd_bounds *box)
{
    const pass_bounds of = work->pass->bounds_of;
    const mesh_part *const part = work->part;
    ffd_bounds others = ffd_bounds_empty();
    const bool left_out = part->hidden && of != PASS_BOUNDS_ALL;
    ffd_bounds *const wanted = left_out ? &others : box;
    if (!part->used || of != PASS_BOUNDS_SHOWN)
        return widen_all(work, scratch->position, scratch->chosen_count, wanted);
    bool finite = true;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const bool shown = ffd_part_shows(part, first + ffd_tile_chosen(scratch, i));
        finite = widen_all(work, scratch->position + 3 * i, 1, shown ? wanted : &others) && finite;
    }
    return finite;
}

static uint64_t number_of(const part_work *work, const tile_scratch *scratch, size_t first, size_t i)
{
    return work->first_vertex + first + ffd_tile_chosen(scratch, i);
}

void ffd_totals_count_rest(const part_work *work, const tile_scratch *scratch, size_t first,
                           pass_totals *totals)
{
    totals->vertices += scratch->chosen_count;
    if (widen_chosen(work, scratch, first, &totals->before))
        return;
    for (size_t i = 0; i < scratch->chosen_count; i++)
        if (!vec_is_finite(scratch->position + 3 * i))
            totals->first_invalid = least(totals->first_invalid, number_of(work, scratch, first, i));
}

/* Flags of a vertex that is not simply inside: its ffd_vertex_status in the low bits, and these. */
enum {
    OTHER_STATUS = 7,
    OTHER_OUTSIDE = 8,
    OTHER_EXTENDED = 16,
    OTHER_MULTIPLE = 32,
    OTHER_UNRESOLVED = 64,
    OTHER_MOVED = 128
};

/* Stores the flags of a vertex of the tile that is not simply inside. Returns false if memory runs out. */
static bool note_other(const point_outcome *outcome, const double delta[3], size_t vertex,
                       pass_totals *totals)
{
    const bool moved = delta[0] != 0 || delta[1] != 0 || delta[2] != 0;
    if (!totals->others)
        totals->others = ffd_alloc_zero(PASS_TILE, 1);
    if (!totals->others)
        return false;
    totals->others[vertex] =
        (uint8_t)(outcome->status | (outcome->outside ? OTHER_OUTSIDE : 0) |
                  (outcome->extended ? OTHER_EXTENDED : 0) | (outcome->multiple ? OTHER_MULTIPLE : 0) |
                  (outcome->unresolved ? OTHER_UNRESOLVED : 0) | (moved ? OTHER_MOVED : 0));
    return true;
}

static void count_other(const mesh_part *part, unsigned other, uint64_t number, pass_totals *totals)
{
    const unsigned status = other & OTHER_STATUS;
    totals->counts[status]++;
    if (other & OTHER_OUTSIDE) {
        totals->outside_all++;
        totals->first_outside = least(totals->first_outside, number);
    }
    if (other & OTHER_OUTSIDE && part->shows_shapes) {
        totals->weighted_outside++;
        totals->first_weighted_outside = least(totals->first_weighted_outside, number);
    }
    if (status == FFD_OUTSIDE && other & OTHER_EXTENDED) {
        totals->extended++;
        totals->extended_moved += (other & OTHER_MOVED) != 0;
    }
    totals->multiple_any += (other & OTHER_MULTIPLE) != 0;
    totals->unresolved += (other & OTHER_UNRESOLVED) != 0;
    totals->degenerate += status == FFD_SINGULAR && !(other & OTHER_UNRESOLVED);
}

static void count_unshown(unsigned other, bool hidden, uint64_t number, pass_totals *totals)
{
    *(hidden ? &totals->hidden : &totals->unused) += 1;
    if (!(other & OTHER_OUTSIDE))
        return;
    totals->unshown_outside++;
    totals->first_unshown_outside = least(totals->first_unshown_outside, number);
}

/* A vertex that is not finite counts even if nothing shows it: it is a fault of the mesh. */
static bool counts(const mesh_part *part, size_t vertex, unsigned other)
{
    return (other & OTHER_STATUS) == FFD_POINT_INVALID || ffd_part_shows(part, vertex);
}

void ffd_totals_count_others(const part_work *work, size_t first, size_t count, pass_totals *totals)
{
    for (size_t i = 0; i < count && totals->others; i++) {
        const uint64_t number = work->first_vertex + first + i;
        if (totals->others[i] && counts(work->part, first + i, totals->others[i]))
            count_other(work->part, totals->others[i], number, totals);
        else if (totals->others[i])
            count_unshown(totals->others[i], work->part->hidden, number, totals);
    }
    ffd_free(totals->others);
    totals->others = NULL;
}

/* Returns false if memory runs out. */
static bool count_point_outcomes(const tile_scratch *scratch, pass_totals *totals)
{
    const point_outcome *const point_outcomes = scratch->point_outcomes;
    double square_max = 0, square_sum = 0;
    uint64_t evaluations = 0;
    uint32_t evaluations_max = 0;
    size_t inside = 0, located = 0;
    bool noted = true;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const point_outcome *const outcome = &point_outcomes[i];
        square_max = larger_of(square_max, outcome->residual_square); /* 0 without u,v,w */
        square_sum += outcome->residual_square;
        located += outcome->located;
        evaluations += outcome->evaluations;
        evaluations_max = outcome->evaluations > evaluations_max ? outcome->evaluations : evaluations_max;
        if (outcome->status == FFD_INSIDE)
            inside++;
        else
            noted = note_other(outcome, scratch->delta + 3 * i, ffd_tile_chosen(scratch, i), totals) && noted;
    }
    totals->counts[FFD_INSIDE] += inside;
    totals->located += located;
    totals->residual_square_max = larger_of(totals->residual_square_max, square_max);
    totals->residual_square_sum += square_sum;
    totals->evaluations += evaluations;
    totals->evaluations_max =
        evaluations_max > totals->evaluations_max ? evaluations_max : totals->evaluations_max;
    return noted;
}

/* A vertex whose transform is singular stays, whatever the chain says. */
static bool stays(const tile_scratch *scratch, size_t i, pass_totals *totals)
{
    if (!ffd_vertex_transform_of(&scratch->transforms, ffd_tile_chosen(scratch, i)).singular)
        return false;
    totals->transforms_singular += vec_is_finite(scratch->position + 3 * i);
    return true;
}

static void count_displacements(const part_work *work, const tile_scratch *scratch, pass_totals *totals)
{
    const bool some_stay = work->part->skinned || work->part->singular;
    double square_max = 0, square_sum = 0;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const double square = vec_dot(scratch->delta + 3 * i, scratch->delta + 3 * i);
        if (some_stay && stays(scratch, i, totals))
            continue;
        square_max = larger_of(square_max, square);
        square_sum += square;
    }
    totals->displacement_square_max = larger_of(totals->displacement_square_max, square_max);
    totals->displacement_square_sum += square_sum;
}

ffd_status ffd_totals_count_deformed(const part_work *work, const tile_scratch *scratch, size_t first,
                                     pass_totals *totals, ffd_error *error)
{
    if (!count_point_outcomes(scratch, totals))
        return ffd_fail_memory(error);
    count_displacements(work, scratch, totals);
    widen_chosen(work, scratch, first, &totals->after);
    return totals->others ? ffd_tile_find_misses(work, scratch, first, &totals->misses, error) : FFD_OK;
}
