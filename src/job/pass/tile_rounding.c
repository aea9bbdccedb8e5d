/* tile_rounding.c - what the rounding of results does to a tile (mesh/precision.h): to floats, or to the
   doubles that they are computed in. The floats of a conversion are judged by the model that is written. */
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "job/pass/tile.h"
#include "mesh/precision.h"
#include <math.h>

double ffd_part_tolerance(const mesh_document *document)
{
    return document->part_count == 1 ? SHAPE_TOLERANCE : PART_TOLERANCE;
}

/* Whether the results are rounded to floats here. */
static bool rounds(const pass_tile *tile)
{
    const bool *const floats = tile->part->rounding.is_float;
    return tile->pass->write && !tile->pass->is_converted && floats[0] && floats[1] && floats[2];
}

static bool are_doubles(const pass_tile *tile)
{
    return tile->pass->write && ffd_rounding_is_none(&tile->part->rounding);
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
   0. */
static double coarsest(const mesh_rounding *rounding, const ffd_bounds *box)
{
    double farthest[3], half[3];
    for (int a = 0; a < 3; a++)
        farthest[a] = box->min[a] > box->max[a] ? 0 : larger_of(fabs(box->min[a]), fabs(box->max[a]));
    if (ffd_rounding_is_none(rounding))
        return ffd_double_step(vec_greatest(farthest)) / 2;
    ffd_rounding_cell(rounding, farthest, half);
    return larger_of(half[0], larger_of(half[1], half[2]));
}

void ffd_tile_rounding_at_rest(const pass_tile *tile)
{
    part_rounding *const rounding = &tile->totals->rounding;
    if (!rounds(tile) && !are_doubles(tile))
        return;
    const ffd_bounds box = bounds_of(tile, &tile->totals->before);
    rounding->before = larger_of(rounding->before, coarsest(&tile->part->rounding, &box));
}

/* Nearly always the first vertex that moves is the answer. */
bool ffd_tile_shows(const pass_tile *tile)
{
    const double *const stored = tile->scratch->base.stored, *const delta = tile->scratch->base.delta;
    bool shows = !rounds(tile) || tile->part->carried;
    for (size_t k = 0; k < 3 * tile->count && !shows; k++)
        shows = delta[k] != 0 && (float)(stored[k] + delta[k]) != (float)stored[k];
    return shows;
}

void ffd_tile_rounding_of_results(const pass_tile *tile)
{
    part_rounding *const rounding = &tile->totals->rounding;
    const bool doubles = are_doubles(tile);
    if (!rounds(tile) && !doubles)
        return;
    const ffd_bounds box = bounds_of(tile, &tile->totals->after);
    ffd_bounds_join(&rounding->box, &box);
    /* The part is no smaller than the tile: errors within the tile's tolerance are within the part's. */
    const double step = coarsest(&tile->part->rounding, &box);
    if (step <= ffd_part_tolerance(tile->pass->document) * ffd_bounds_side(&box))
        return;
    if (doubles) /* the numbers that they round are not known */
        rounding->error = larger_of(rounding->error, step);
    for (size_t i = 0; i < tile->count && !doubles; i++)
        rounding->error = larger_of(rounding->error, ffd_float_error(tile->scratch->base.stored + 3 * i));
}
