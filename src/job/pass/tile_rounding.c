/* tile_rounding.c - what the rounding of results does to a tile (mesh/precision.h): to floats, to the steps
   of quantized positions, or to the doubles that they are computed in. What the file of a conversion cannot
   hold is judged by the model that is written. */
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "job/pass/tile.h"
#include "mesh/precision.h"
#include <math.h>

double ffd_part_tolerance(const mesh_document *document, const mesh_rounding *rounding)
{
    /* Whoever quantizes to 12 bits and more has chosen that rounding. */
    return document->part_count == 1 && ffd_rounding_kind(rounding) != ROUNDED_TO_STEPS ? SHAPE_TOLERANCE
                                                                                        : PART_TOLERANCE;
}

/* Returns what the results are rounded to here; ROUNDED_EACH: nothing that is judged. A conversion does not
   keep to steps. */
static rounding_kind kind_of(const pass_tile *tile)
{
    const rounding_kind kind = ffd_rounding_kind(&tile->part->rounding);
    if (!tile->pass->write)
        return ROUNDED_EACH;
    return kind == ROUNDED_TO_STEPS && tile->pass->is_converted ? ROUNDED_TO_FLOATS : kind;
}

/* Returns the error of a displacement that is rounded to the steps on which its point stands. */
static double step_error(const mesh_rounding *rounding, const double delta[3])
{
    double error = 0;
    for (int a = 0; a < 3; a++) {
        const double steps = delta[a] / rounding->step[a];
        error = larger_of(error, fabs(steps - nearest_integer(steps)) * rounding->step[a]);
    }
    return error;
}

/* Returns the bounds of the finite coordinates of the tile's positions in the file. counted: the bounds of
   the vertices that are counted, in the lattice's space: often those are all, and that space is the file's.
 */
static ffd_bounds bounds_of(const pass_tile *tile, const ffd_bounds *counted)
{
    const mesh_part *const part = tile->part;
    const double *const points = tile->scratch->base.stored;
    ffd_bounds box = ffd_bounds_empty();
    if (part->identity && !part->selected && !part->skipped && !part->hidden && !part->used &&
        !part->repeats_positions && tile->totals->first_invalid == UINT64_MAX)
        return *counted;
    if (ffd_array_kernel(tile->pass->chain->isa)->widen(points, tile->count, box.min, box.max))
        return box;
    for (size_t i = 0; i < tile->count; i++)
        ffd_bounds_widen_finite(&box, points + 3 * i);
    return box;
}

/* Returns the largest half side of the rounding cells in a box: floats and doubles grow coarser away from
   0. may_be_floats: numbers beyond the range of the steps are stored as floats. */
static double coarsest(const mesh_rounding *rounding, const ffd_bounds *box, bool may_be_floats)
{
    mesh_rounding cells = *rounding;
    double farthest[3], half[3];
    for (int a = 0; a < 3; a++)
        farthest[a] = box->min[a] > box->max[a] ? 0 : larger_of(fabs(box->min[a]), fabs(box->max[a]));
    if (ffd_rounding_is_none(rounding))
        return ffd_double_step(vec_greatest(farthest)) / 2;
    for (int a = 0; a < 3; a++)
        cells.is_float[a] = cells.is_float[a] || (may_be_floats && cells.step[a] > 0);
    ffd_rounding_cell(&cells, farthest, half);
    return larger_of(half[0], larger_of(half[1], half[2]));
}

void ffd_tile_rounding_at_rest(const pass_tile *tile)
{
    part_rounding *const rounding = &tile->totals->rounding;
    /* Steps are as coarse afterwards as they are at rest. */
    if ((kind_of(tile) != ROUNDED_TO_FLOATS && kind_of(tile) != ROUNDED_TO_DOUBLES) ||
        ffd_rounding_kind(&tile->part->rounding) == ROUNDED_TO_STEPS)
        return;
    const ffd_bounds box = bounds_of(tile, &tile->totals->before);
    rounding->before = larger_of(rounding->before, coarsest(&tile->part->rounding, &box, false));
}

/* Nearly always the first vertex that moves is the answer. */
bool ffd_tile_shows(const pass_tile *tile)
{
    const double *const stored = tile->scratch->base.stored, *const delta = tile->scratch->base.delta;
    const double *const step = tile->part->rounding.step;
    const rounding_kind kind = kind_of(tile);
    bool shows = (kind != ROUNDED_TO_FLOATS && kind != ROUNDED_TO_STEPS) || tile->part->carried;
    for (size_t k = 0; k < 3 * tile->count && !shows; k++)
        shows = kind == ROUNDED_TO_FLOATS ? delta[k] != 0 && (float)(stored[k] + delta[k]) != (float)stored[k]
                                          : nearest_integer(delta[k] / step[k % 3]) != 0;
    return shows;
}

void ffd_tile_rounding_of_results(const pass_tile *tile)
{
    part_rounding *const rounding = &tile->totals->rounding;
    const rounding_kind kind = kind_of(tile);
    if (kind == ROUNDED_EACH)
        return;
    const ffd_bounds box = bounds_of(tile, &tile->totals->after);
    ffd_bounds_join(&rounding->box, &box);
    /* The part is no smaller than the tile: errors within the tile's tolerance are within the part's. */
    const double step = coarsest(&tile->part->rounding, &box, true);
    const mesh_rounding *const stored = &tile->part->rounding;
    if (step <= ffd_part_tolerance(tile->pass->document, stored) * ffd_bounds_side(&box))
        return;
    if (kind == ROUNDED_TO_DOUBLES) /* the numbers that they round are not known */
        rounding->error = larger_of(rounding->error, step);
    for (size_t i = 0; i < tile->count && (kind == ROUNDED_TO_FLOATS || kind == ROUNDED_TO_STEPS); i++)
        rounding->float_error =
            larger_of(rounding->float_error, ffd_float_error(tile->scratch->base.stored + 3 * i));
    for (size_t i = 0; i < tile->count && kind == ROUNDED_TO_STEPS; i++)
        rounding->error = larger_of(rounding->error, step_error(stored, tile->scratch->base.delta + 3 * i));
}
