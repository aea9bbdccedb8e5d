/* tile_weights.c - the weights of a tile's points (src/maths.md 9.7). */
#include "deform/weighting.h"
#include "job/chain/chain_apply.h"
#include "job/pass/tile.h"
#include <string.h>

/* Where only the gradients of turns are known: weighs these. */
static void weigh_turns(const tile_points *points, const chain_run *run, size_t first)
{
    const mesh_pass *const pass = points->tile->pass;
    for (size_t k = 0; k < run->turns->count; k++) {
        const size_t i = run->turns->points[k], index = first + ffd_tile_vertex(points, i);
        double delta[3], slope[3];
        memcpy(delta, run->delta + 3 * i, sizeof delta);
        weigh_displacement(ffd_vertex_weight(pass->weights, index),
                           ffd_vertex_slope(pass->weights, pass->state, index, slope), delta,
                           run->gradient + 9 * i);
    }
}

/* Whether the points before the chain are the stored positions, in their order. */
static bool rests_are_stored(const tile_points *points)
{
    return points->tile->part->identity && points->are_all && !points->offsets;
}

/* Replaces displacements and gradients by the weighted ones. rest: the points before the chain. */
static void weigh(tile_points *points, const chain_run *run, const double *rest)
{
    const pass_tile *const tile = points->tile;
    const vertex_weights *const weights = tile->pass->weights;
    const size_t first = weights->first[tile->part_index] + tile->first;
    const bool gradients = run->gradient && !run->only_turns;
    if (run->only_turns && run->turns)
        weigh_turns(points, run, first);
    for (size_t i = 0; i < run->count; i++) {
        const size_t index = first + ffd_tile_vertex(points, i);
        const double weight = ffd_vertex_weight(weights, index);
        double own[3];
        const double *const slope = ffd_vertex_slope(weights, tile->pass->state, index, own);
        double *const delta = run->delta + 3 * i;
        if (!weight_acts(weight, slope))
            continue;
        weigh_displacement(weight, slope, delta, gradients ? run->gradient + 9 * i : NULL);
        run->outcomes[i].collapsed = false; /* of the lattices; det F is another now */
        run->outcomes[i].moved &= weight != 0;
        for (size_t a = 0; a < 3 && weight != 1; a++)
            run->x[3 * i + a] = rest[3 * i + a] + delta[a];
    }
}

ffd_status ffd_tile_send(tile_points *points, chain_run *run, ffd_error *error)
{
    const mesh_pass *const pass = points->tile->pass;
    double *const kept = points->tile->scratch->rest;
    const bool is_stored = rests_are_stored(points);
    if (!pass->weights && !pass->rigid)
        return ffd_chain_apply(pass->chain, pass->links, run, error);
    if (!is_stored)
        memcpy(kept, run->x, 3 * run->count * sizeof *kept);
    TRY(ffd_chain_apply(pass->chain, pass->links, run, error));
    if (pass->weights)
        weigh(points, run, is_stored ? points->stored : kept);
    if (pass->rigid)
        ffd_tile_move_pieces(points, run, is_stored ? points->stored : kept);
    return FFD_OK;
}
