#include "job/pass/tile_rounding.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "mesh/precision.h"
#include <math.h>

double ffd_part_tolerance(const mesh_document *document)
{
    return document->part_count == 1 ? SHAPE_TOLERANCE : PART_TOLERANCE;
}

/* Whether the results are rounded to floats here. */
static bool rounds(const part_work *work)
{
    const bool *const floats = work->part->rounding.is_float;
    return work->pass->write && !work->pass->document->converted && floats[0] && floats[1] && floats[2];
}

/* Returns the bounds of the finite coordinates of the tile's positions in the file. counted: the bounds of
   the vertices that are counted, in the lattice's space: often those are all, and that space is the file's.
 */
static ffd_bounds bounds_of(const part_work *work, const tile_scratch *scratch, size_t count,
                            const pass_totals *totals, const ffd_bounds *counted)
{
    const mesh_part *const part = work->part;
    const double *const points = scratch->raw;
    ffd_bounds box = ffd_bounds_empty();
    if (part->identity && scratch->all_chosen && !part->hidden && !part->used && !part->repeats_positions &&
        totals->first_invalid == UINT64_MAX)
        return *counted;
    if (ffd_array_kernel(work->pass->chain->isa)->widen(points, count, box.min, box.max))
        return box;
    for (size_t i = 0; i < count; i++)
        ffd_bounds_widen_finite(&box, points + 3 * i);
    return box;
}

/* Returns the largest half side of the rounding cells in a box: floats grow coarser away from 0. */
static double coarsest(const mesh_rounding *rounding, const ffd_bounds *box)
{
    double farthest[3], half[3];
    for (int a = 0; a < 3; a++)
        farthest[a] = box->min[a] > box->max[a] ? 0 : larger_of(fabs(box->min[a]), fabs(box->max[a]));
    ffd_rounding_cell(rounding, farthest, half);
    return larger_of(half[0], larger_of(half[1], half[2]));
}

void ffd_tile_rounding_at_rest(const part_work *work, const tile_scratch *scratch, size_t count,
                               pass_totals *totals)
{
    part_rounding *const rounding = &totals->rounding;
    if (!rounds(work))
        return;
    const ffd_bounds box = bounds_of(work, scratch, count, totals, &totals->before);
    rounding->before = larger_of(rounding->before, coarsest(&work->part->rounding, &box));
}

/* Nearly always the first vertex that moves is the answer. */
bool ffd_tile_shows(const part_work *work, const double *raw, const double *delta, size_t count)
{
    bool shows = !rounds(work) || work->part->carried;
    for (size_t k = 0; k < 3 * count && !shows; k++)
        shows = delta[k] != 0 && (float)(raw[k] + delta[k]) != (float)raw[k];
    return shows;
}

void ffd_tile_rounding_of_results(const part_work *work, const tile_scratch *scratch, size_t count,
                                  pass_totals *totals)
{
    part_rounding *const rounding = &totals->rounding;
    if (!rounds(work))
        return;
    const ffd_bounds box = bounds_of(work, scratch, count, totals, &totals->after);
    ffd_bounds_join(&rounding->box, &box);
    /* The part is no smaller than the tile: errors within the tile's tolerance are within the part's. */
    if (coarsest(&work->part->rounding, &box) <=
        ffd_part_tolerance(work->pass->document) * ffd_bounds_side(&box))
        return;
    for (size_t i = 0; i < count; i++)
        rounding->error = larger_of(rounding->error, ffd_float_error(scratch->raw + 3 * i));
}
