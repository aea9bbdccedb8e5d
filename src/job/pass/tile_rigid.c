/* tile_rigid.c - points of a tile that move as one piece with others, and how points stretch that animations
   turn (src/maths.md 9.8). */
#include "base/vector/polar.h"
#include "job/pass/tile.h"
#include <float.h>
#include <string.h>

/* Roundings of products of some matrices, and of coordinates. */
#define TURN_ROUNDING 1e-12
#define PLACE_ROUNDING (64 * DBL_EPSILON)

/* The index in the document of point i of a tile. A part that repeats another one has the vertices of that.
 */
static size_t index_of(const tile_points *points, size_t i)
{
    const pass_tile *const tile = points->tile;
    return tile->pass->rigid->first[tile->part_index] + tile->first + ffd_tile_vertex(points, i);
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

void ffd_tile_move_pieces(tile_points *points, const chain_run *run, const double *rest)
{
    for (size_t i = 0; i < run->count; i++) {
        const rigid_motion *const motion =
            ffd_rigid_motion_of(points->tile->pass->rigid, index_of(points, i));
        double *const delta = run->delta + 3 * i;
        if (!motion || !vec_is_finite(rest + 3 * i))
            continue;
        ffd_motion_displace(motion, rest + 3 * i, delta);
        if (run->gradient)
            memcpy(run->gradient + 9 * i, motion->gradient, sizeof motion->gradient);
        run->outcomes[i].moved = !is_zero(delta);
        run->outcomes[i].collapsed = motion->scale == 0;
        for (size_t a = 0; a < 3; a++)
            run->x[3 * i + a] = rest[3 * i + a] + delta[a];
    }
}

/* Whether a motion and then the map that carries a part are no motion at all. */
static bool undoes(const mesh_part *part, const rigid_motion *motion)
{
    double carry[9], move[9], both[9], to[3], back[3], size = 0;
    mat_add_identity(part->carry, carry);
    mat_add_identity(motion->gradient, move);
    mat_multiply(carry, move, both);
    for (int a = 0; a < 3; a++)
        to[a] = motion->from[a] + motion->by[a];
    mat_apply(carry, to, back);
    for (int a = 0; a < 3; a++)
        size += fabs(motion->from[a]) + fabs(to[a]) + fabs(part->carry[9 + a]);
    bool is_still = ffd_mat_is_near_identity(both, TURN_ROUNDING);
    for (int a = 0; a < 3; a++)
        is_still = is_still && fabs(back[a] + part->carry[9 + a] - motion->from[a]) <= PLACE_ROUNDING * size;
    return is_still;
}

bool ffd_tile_is_at_rest(const tile_points *points, size_t i)
{
    const pass_tile *const tile = points->tile;
    const rigid_motion *const motion =
        tile->pass->rigid ? ffd_rigid_motion_of(tile->pass->rigid, index_of(points, i)) : NULL;
    return motion && ffd_part_selects(tile->part, tile->first + ffd_tile_vertex(points, i)) &&
           undoes(tile->part, motion);
}

void ffd_tile_note_stretches(const pass_tile *tile)
{
    const mesh_pass *const pass = tile->pass;
    const tile_points *const base = &tile->scratch->base;
    const size_t first = (size_t)tile->first_index;
    for (size_t i = 0; i < tile->count; i++) {
        const uint8_t status = base->outcomes[i].status;
        double f[9], values[3];
        if (pass->turned[first + i] == MESH_NONE || !ffd_part_selects(tile->part, tile->first + i) ||
            status == FFD_VERTEX_INVALID || status == FFD_VERTEX_SINGULAR)
            continue;
        mat_add_identity(base->gradient + 9 * i, f);
        ffd_singular_values(f, values);
        pass->stretches[2 * (first + i)] = (float)values[0];
        pass->stretches[2 * (first + i) + 1] = (float)values[2];
    }
}
