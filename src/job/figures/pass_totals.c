#include "job/figures/pass_totals.h"
#include "mesh/bounds.h"
#include "mesh/precision.h"
#include <math.h>

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
        ffd_note_first(&shown->first_overflow, stored->first_overflow);
        shown->lost = stored->lost;
    }
    shown->embed_seconds += stored->embed_seconds;
    shown->deform_seconds += stored->deform_seconds;
}

/* A part is lost only where its numbers have become coarser than they were at rest, by more than what the
   next power of two makes of them. */
#define COARSER 2

void ffd_totals_judge_rounding(const pass_totals *tiles, size_t count, double tolerance, rounding_kind kind,
                               pass_totals *all)
{
    part_rounding part = {.box = ffd_bounds_empty()};
    for (size_t i = 0; i < count; i++) {
        const part_rounding *const tile = &tiles[i].rounding;
        part.error = maximum_number(part.error, tile->error);
        part.float_error = maximum_number(part.float_error, tile->float_error);
        part.before = maximum_number(part.before, tile->before);
        ffd_bounds_join(&part.box, &tile->box);
    }
    const bool of_floats = part.float_error > part.error;
    const double side = ffd_bounds_side(&part.box);
    part.error = maximum_number(part.error, part.float_error);
    if (!(side > 0) || !(part.error > tolerance * side) || !(part.error > COARSER * part.before))
        return;
    if (all->lost.side > 0 && part.error / side <= all->lost.error / all->lost.side)
        return;
    all->lost =
        (rounding_loss){part.error, side, kind == ROUNDED_TO_DOUBLES, kind == ROUNDED_TO_STEPS && !of_floats};
}

void ffd_totals_note_splats(pass_totals *totals, size_t part, uint64_t moved)
{
    if (moved == 0)
        return;
    totals->splats_moved += moved;
    if (totals->splat_part_count < FFD_BEHIND_NAMES)
        totals->splat_parts[totals->splat_part_count++] = part;
}
