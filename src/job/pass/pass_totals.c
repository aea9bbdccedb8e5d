#include "job/pass/pass_totals.h"
#include "mesh/precision.h"
#include <math.h>
#include <string.h>

void ffd_totals_clear(pass_totals *totals)
{
    memset(totals, 0, sizeof *totals);
    totals->before = totals->after = totals->shapes = totals->rounding.box = ffd_bounds_empty();
    totals->first_outside = totals->first_invalid = totals->first_overflow = UINT64_MAX;
    totals->first_shape_outside = totals->first_weighted_outside = totals->first_base_outside = UINT64_MAX;
    totals->first_missed = UINT64_MAX;
    totals->first_unshown_outside = UINT64_MAX;
    totals->first_det_outside = totals->first_inverted = UINT64_MAX;
    totals->det_min = totals->det_outside = totals->det_inverted = HUGE_VAL;
    totals->det_max = -HUGE_VAL;
}

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

void ffd_totals_join(const pass_totals *tile, pass_totals *all)
{
    all->vertices += tile->vertices;
    for (int s = 0; s < FFD_VERTEX_STATUS_COUNT; s++)
        all->counts[s] += tile->counts[s];
    all->moved += tile->moved;
    all->is_visible = all->is_visible || tile->is_visible;
    all->located += tile->located;
    all->residual_square_max = fmax(all->residual_square_max, tile->residual_square_max);
    all->residual_square_sum += tile->residual_square_sum;
    all->evaluations += tile->evaluations;
    all->evaluations_max =
        tile->evaluations_max > all->evaluations_max ? tile->evaluations_max : all->evaluations_max;
    all->displacement_square_max = fmax(all->displacement_square_max, tile->displacement_square_max);
    all->displacement_square_sum += tile->displacement_square_sum;
    ffd_bounds_join(&all->before, &tile->before);
    ffd_bounds_join(&all->after, &tile->after);
    ffd_bounds_join(&all->shapes, &tile->shapes);
    all->outside_all += tile->outside_all;
    all->misses.count += tile->misses.count;
    all->misses.looked_at += tile->misses.looked_at;
    all->misses.largest = fmax(all->misses.largest, tile->misses.largest);
    all->misses.is_least = all->misses.is_least || tile->misses.is_least;
    all->multiple_any += tile->multiple_any;
    all->moved_twice += tile->moved_twice;
    all->disagreeing += tile->disagreeing;
    all->disagreement = fmax(all->disagreement, tile->disagreement);
    all->unresolved += tile->unresolved;
    all->degenerate += tile->degenerate;
    all->unused += tile->unused;
    all->hidden += tile->hidden;
    all->unshown_outside += tile->unshown_outside;
    all->first_unshown_outside = least(all->first_unshown_outside, tile->first_unshown_outside);
    all->extended += tile->extended;
    all->extended_moved += tile->extended_moved;
    all->first_outside = least(all->first_outside, tile->first_outside);
    all->first_invalid = least(all->first_invalid, tile->first_invalid);
    all->first_overflow = least(all->first_overflow, tile->first_overflow);
    if (tile->first_missed < all->first_missed) {
        all->first_missed = tile->first_missed;
        all->missed_by = tile->missed_by;
    }
    all->shapes_outside += tile->shapes_outside;
    all->weighted_outside += tile->weighted_outside;
    all->first_weighted_outside = least(all->first_weighted_outside, tile->first_weighted_outside);
    all->first_shape_outside = least(all->first_shape_outside, tile->first_shape_outside);
    all->shapes_invalid += tile->shapes_invalid;
    all->normals_collapsed += tile->normals_collapsed;
    all->splats_carried += tile->splats_carried;
    all->splats_flattened += tile->splats_flattened;
    all->splats_broken += tile->splats_broken;
    all->transforms_singular += tile->transforms_singular;
    all->weights.off += tile->weights.off;
    all->weights.none += tile->weights.none;
    all->weights.farthest = fmax(all->weights.farthest, tile->weights.farthest);
    all->kept += tile->kept;
    if (tile->det_outside < all->det_outside) { /* the first of equal ones */
        all->det_outside = tile->det_outside;
        all->first_det_outside = tile->first_det_outside;
    }
    all->inverted += tile->inverted;
    if (tile->det_inverted < all->det_inverted) { /* likewise */
        all->det_inverted = tile->det_inverted;
        all->first_inverted = tile->first_inverted;
    }
    all->det_min = fmin(all->det_min, tile->det_min);
    all->det_max = fmax(all->det_max, tile->det_max);
    all->embed_seconds += tile->embed_seconds;
    all->deform_seconds += tile->deform_seconds;
}

void ffd_totals_add_stored(const pass_totals *stored, bool written, pass_totals *shown)
{
    shown->of_shown = true;
    shown->base_outside = stored->weighted_outside;
    shown->first_base_outside = stored->first_weighted_outside;
    shown->shapes_outside = stored->shapes_outside;
    shown->first_shape_outside = stored->first_shape_outside;
    shown->shapes_invalid = stored->shapes_invalid;
    shown->first_missed = stored->first_missed;
    shown->missed_by = stored->missed_by;
    if (written) {
        shown->first_overflow = least(shown->first_overflow, stored->first_overflow);
        shown->lost = stored->lost;
    }
    shown->embed_seconds += stored->embed_seconds;
    shown->deform_seconds += stored->deform_seconds;
}

/* A part is lost only where its floats have become coarser than they were at rest, by more than what the next
   power of two makes of them. */
#define COARSER 2

void ffd_totals_judge_rounding(const pass_totals *tiles, size_t count, double tolerance, pass_totals *all)
{
    part_rounding part = {.box = ffd_bounds_empty()};
    for (size_t i = 0; i < count; i++) {
        const part_rounding *const tile = &tiles[i].rounding;
        part.error = fmax(part.error, tile->error);
        part.before = fmax(part.before, tile->before);
        ffd_bounds_join(&part.box, &tile->box);
    }
    const double side = ffd_bounds_side(&part.box);
    if (!(side > 0) || !(part.error > tolerance * side) || !(part.error > COARSER * part.before))
        return;
    if (all->lost.side > 0 && part.error / side <= all->lost.error / all->lost.side)
        return;
    all->lost = (rounding_loss){part.error, side};
}

void ffd_totals_note_splats(pass_totals *totals, size_t part, uint64_t moved)
{
    if (moved == 0)
        return;
    totals->splats_moved += moved;
    if (totals->splat_part_count < FFD_BEHIND_NAMES)
        totals->splat_parts[totals->splat_part_count++] = part;
}
