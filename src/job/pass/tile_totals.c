#include "job/pass/tile_totals.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "mesh/bounds.h"

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* Finite points widen the box (positions that the chain brings beyond all numbers are refused as too large).
   Returns whether all were. */
static bool widen_all(const part_work *work, const double *points, size_t count, ffd_bounds *box)
{
    if (ffd_array_kernel(work->pass->chain->isa)->widen(points, count, box->min, box->max))
        return true;
    for (size_t i = 0; i < count; i++)
        if (vec_is_finite(points + 3 * i))
            ffd_bounds_widen(box, points + 3 * i);
    return false;
}

static uint64_t number_of(const part_work *work, const tile_scratch *scratch, size_t first, size_t i)
{
    return work->first_vertex + first + ffd_tile_chosen(scratch, i);
}

void ffd_totals_count_rest(const part_work *work, const tile_scratch *scratch, size_t first,
                           pass_totals *totals)
{
    totals->vertices += scratch->chosen_count;
    if (widen_all(work, scratch->position, scratch->chosen_count, &totals->before))
        return;
    for (size_t i = 0; i < scratch->chosen_count; i++)
        if (!vec_is_finite(scratch->position + 3 * i))
            totals->first_invalid = least(totals->first_invalid, number_of(work, scratch, first, i));
}

/* Of a vertex that is not simply inside. */
static void count_other(const point_outcome *note, uint64_t number, pass_totals *totals)
{
    totals->counts[note->status]++;
    if (note->outside) {
        totals->outside_any++;
        totals->first_outside = least(totals->first_outside, number);
    }
    totals->extended += note->status == FFD_OUTSIDE && note->extended;
    totals->multiple_any += note->multiple;
    totals->unresolved += note->unresolved;
}

static void count_notes(const part_work *work, const tile_scratch *scratch, size_t first, pass_totals *totals)
{
    const point_outcome *const notes = scratch->notes;
    double square_max = 0, square_sum = 0;
    uint64_t evaluations = 0;
    uint32_t evaluations_max = 0;
    size_t inside = 0, located = 0;
    for (size_t i = 0; i < scratch->chosen_count; i++) {
        const point_outcome *const note = &notes[i];
        square_max = larger_of(square_max, note->residual_square); /* 0 where there is no u,v,w */
        square_sum += note->residual_square;
        located += note->located;
        evaluations += note->evaluations;
        evaluations_max = note->evaluations > evaluations_max ? note->evaluations : evaluations_max;
        if (note->status == FFD_INSIDE)
            inside++;
        else
            count_other(note, number_of(work, scratch, first, i), totals);
    }
    totals->counts[FFD_INSIDE] += inside;
    totals->located += located;
    totals->residual_square_max = larger_of(totals->residual_square_max, square_max);
    totals->residual_square_sum += square_sum;
    totals->evaluations += evaluations;
    totals->evaluations_max =
        evaluations_max > totals->evaluations_max ? evaluations_max : totals->evaluations_max;
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

void ffd_totals_count_deformed(const part_work *work, const tile_scratch *scratch, size_t first,
                               pass_totals *totals)
{
    count_notes(work, scratch, first, totals);
    count_displacements(work, scratch, totals);
    widen_all(work, scratch->position, scratch->chosen_count, &totals->after);
}
