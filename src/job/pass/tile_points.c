/* tile_points.c - the way of a tile's points, the same for the base and for a morph target: into the
   lattice's space, through the chain, and back to the file's space. */
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "job/pass/tile.h"
#include "job/pass/vertex_rounding.h"
#include "mesh/bounds.h"
#include <math.h>
#include <string.h>

static vertex_transform transform_of(const tile_points *points, size_t v)
{
    return ffd_vertex_transform_of(&points->tile->scratch->transforms, v);
}

void ffd_tile_place(tile_points *points, size_t i, size_t v)
{
    const vertex_transform transform = transform_of(points, v);
    double *const x = points->position + 3 * i;
    memcpy(x, points->stored + 3 * v, 3 * sizeof *x);
    for (size_t a = 0; a < 3 && points->offsets; a++)
        x[a] += points->offsets[3 * v + a];
    ffd_vertex_transform_point(&transform, x);
}

void ffd_tile_hold(tile_points *points, size_t i, size_t v)
{
    ffd_tile_place(points, i, v);
    memset(points->delta + 3 * i, 0, 3 * sizeof *points->delta);
    memset(points->gradient + 9 * i, 0, 9 * sizeof *points->gradient);
    points->outcomes[i] = (point_outcome){.status = FFD_VERTEX_OUTSIDE};
}

/* Adds the rounding cell of a vertex's offset; for SHAPE_SHOWN, the weighted cells of all targets. */
static void add_offset_rounding(const tile_points *points, const double offset[3], double half[3])
{
    const mesh_part *const part = points->tile->part;
    const bool shown = points->shape == SHAPE_SHOWN;
    const size_t end = shown ? part->shape_count : points->shape + 1;
    for (size_t k = shown ? 0 : points->shape; k < end; k++) {
        const double weight = shown ? fabs(part->shapes[k].weight) : 1;
        double of_offset[3];
        ffd_rounding_cell(&part->shapes[k].rounding, offset, of_offset);
        for (int a = 0; a < 3; a++)
            half[a] += weight * of_offset[a];
    }
}

/* The rounding cell of a vertex in a target is the sum of those of its position and its offset. */
static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const tile_points *const points = context;
    const pass_tile *const tile = points->tile;
    const size_t v = ffd_tile_vertex(points, point);
    const vertex_transform transform = transform_of(points, v);
    double position[3];
    memcpy(position, points->stored + 3 * v, sizeof position);
    if (!is_first)
        ffd_vertex_in_file(&transform, x, position);
    ffd_vertex_cell(tile->pass->document, tile->pass->state, tile->part_index, tile->first + v, position,
                    half);
    if (points->offsets)
        add_offset_rounding(points, points->offsets + 3 * v, half);
    ffd_vertex_rounding_place(&transform, half);
}

void ffd_tile_points_begin(const pass_tile *tile, const double *offsets, size_t shape, tile_points *points)
{
    points->tile = tile;
    points->offsets = offsets;
    points->shape = shape;
    points->cells = (chain_rounding){find_rounding, points};
}

chain_run ffd_tile_run(tile_points *points, bool gradients)
{
    const bool exact = !points->offsets && ffd_rounding_is_none(&points->tile->part->rounding);
    return (chain_run){.x = points->position,
                       .count = points->count,
                       .rounding = exact ? NULL : &points->cells,
                       .scratch = &points->tile->scratch->chain,
                       .delta = points->delta,
                       .gradient = gradients ? points->gradient : NULL,
                       .outcomes = points->outcomes};
}

void ffd_tile_add_times(const pass_tile *tile, const chain_run *run)
{
    tile->totals->embed_seconds += run->embed_seconds;
    tile->totals->deform_seconds += run->deform_seconds;
}

void ffd_tile_carry(tile_points *points, bool gradients)
{
    const mesh_part *const part = points->tile->part;
    for (size_t i = 0; i < points->count && part->carried; i++) {
        if (!vec_is_finite(points->position + 3 * i))
            continue;
        if (ffd_tile_is_at_rest(points, i)) {
            memset(points->delta + 3 * i, 0, 3 * sizeof *points->delta);
            if (gradients)
                memset(points->gradient + 9 * i, 0, 9 * sizeof *points->gradient);
            continue;
        }
        ffd_part_carry(part, points->position + 3 * i, points->delta + 3 * i);
        if (gradients)
            ffd_part_carry_gradient(part, points->gradient + 9 * i);
    }
}

void ffd_tile_bring_back(tile_points *points)
{
    for (size_t i = 0; i < points->count && !points->tile->part->identity; i++) {
        const vertex_transform transform = transform_of(points, ffd_tile_vertex(points, i));
        ffd_displacement_to_file(&transform, points->delta + 3 * i);
    }
}

void ffd_tile_bring_gradients_back(tile_points *points)
{
    for (size_t i = 0; i < points->count && !points->tile->part->identity; i++) {
        const vertex_transform transform = transform_of(points, ffd_tile_vertex(points, i));
        ffd_gradient_to_file(&transform, points->gradient + 9 * i);
    }
}

/* Widens the box by the finite positions. Returns whether all are finite. (Deformed positions that overflow
   are refused elsewhere as too large.) */
static bool widen_by_all(const tile_points *points, ffd_bounds *box)
{
    const array_kernel *const arrays = ffd_array_kernel(points->tile->pass->chain->isa);
    if (arrays->widen(points->position, points->count, box->min, box->max))
        return true;
    for (size_t i = 0; i < points->count; i++)
        if (vec_is_finite(points->position + 3 * i))
            ffd_bounds_widen(box, points->position + 3 * i);
    return false;
}

bool ffd_tile_widen(const tile_points *points, ffd_bounds *box)
{
    const pass_bounds of = points->tile->pass->bounds_of;
    const mesh_part *const part = points->tile->part;
    ffd_bounds unwanted = ffd_bounds_empty();
    bool finite = true;
    if (!part->used || of != PASS_BOUNDS_SHOWN)
        return widen_by_all(points, part->hidden && of != PASS_BOUNDS_ALL ? &unwanted : box);
    for (size_t i = 0; i < points->count; i++) {
        const double *const x = points->position + 3 * i;
        if (!vec_is_finite(x))
            finite = false;
        else if (ffd_part_shows(part, points->tile->first + ffd_tile_vertex(points, i)))
            ffd_bounds_widen(box, x);
    }
    return finite;
}
