/* tear_blocks.c - tear_field.h for blocks (lattices side by side). */
#include "base/vector/vec.h"
#include "embed/locator.h"
#include "job/chain/blocks.h"
#include "job/chain/chain_apply.h"
#include "job/chain/point_outcome.h"
#include "job/measure/tear_field.h"
#include "lattice/lattice.h"
#include <math.h>
#include <string.h>

static unsigned owner_of(const tear_field *field, uint32_t vertex)
{
    return ffd_marks_owner(field->chain, &field->marks, vertex);
}

/* The foot of an end, in its own block. Moves an end that the block holds only by the vertex's rounding, or
   by the snap, to the border: at its own place, in another block, the displacement may be another one
   although the blocks agree on their common face. */
static ffd_status find_end(const tear_field *field, field_place *place, field_foot *foot, ffd_error *error)
{
    const unsigned owner = owner_of(field, place->ends[place->by == FIELD_SECOND]);
    const size_t block = owner & ~OWNER_NEAREST;
    ffd_location location;
    *foot = (field_foot){.found = owner != OWNER_NONE, .inside = true, .link = block};
    if (owner == OWNER_NONE)
        return FFD_OK;
    TRY(ffd_locator_find(field->chain->links[block].locator, place->x, 1, &location, error));
    if (ffd_location_is_placed(&location)) {
        memcpy(foot->point.uvw, location.uvw, sizeof location.uvw);
        return FFD_OK;
    }
    TRY(ffd_foot_on_border(field, block, place->x, foot, error));
    if (foot->found && !(owner & OWNER_NEAREST))
        ffd_lattice_evaluate(field->chain->links[block].lattice, FFD_VOLUME_REST, foot->point.uvw, place->x,
                             NULL);
    return FFD_OK;
}

/* The foot of a place that no block holds. */
static ffd_status find_outside(const tear_field *field, const field_place *place, field_foot *foot,
                               ffd_error *error)
{
    const chain_outside *const outside = &field->chain->outside;
    const unsigned first = owner_of(field, place->ends[0]) & ~OWNER_NEAREST;
    uint32_t block;
    if (!outside->extend && first < field->chain->count &&
        first == (owner_of(field, place->ends[1]) & ~OWNER_NEAREST))
        return ffd_foot_on_border(field, first, place->x, foot, error);
    *foot = (field_foot){0};
    TRY(ffd_blocks_nearest(field->chain, place->x, outside->falloff > 0 ? outside->falloff : HUGE_VAL,
                           &foot->point, &block, error));
    foot->found = foot->point.found;
    foot->link = block;
    return FFD_OK;
}

/* Displaces all places by the blocks that hold them. */
static ffd_status find_inside(const tear_field *field, const field_place *places, size_t count,
                              field_scratch *scratch, ffd_error *error)
{
    chain_run run = {.x = scratch->x,
                     .count = count,
                     .first_only = true,
                     .scratch = &scratch->chain,
                     .delta = scratch->delta,
                     .gradient = scratch->gradient,
                     .outcomes = scratch->outcomes};
    for (size_t i = 0; i < count; i++)
        memcpy(scratch->x + 3 * i, places[i].x, 3 * sizeof *scratch->x);
    TRY(ffd_chain_apply(&field->plain, field->plain.count, &run, error));
    long long taken = 0;
    for (size_t i = 0; i < count; i++)
        taken += scratch->outcomes[i].evaluations;
    return ffd_field_take(field, taken, error);
}

/* Whether the block that holds a place gives its displacement: that of an end is its own block. */
static bool is_held(const tear_field *field, const field_place *place, uint32_t block)
{
    return block != BLOCK_NONE &&
           (place->by == FIELD_BETWEEN || block == owner_of(field, place->ends[place->by == FIELD_SECOND]));
}

ffd_status ffd_tear_blocks_find(const tear_field *field, field_place *places, size_t count,
                                field_scratch *scratch, ffd_error *error)
{
    TRY(find_inside(field, places, count, scratch, error));
    for (size_t i = 0; i < count; i++) {
        field_place *const place = &places[i];
        field_foot foot;
        place->exits[0] = -HUGE_VAL;
        place->exits[1] = HUGE_VAL;
        place->holder = 0;
        if (is_held(field, place, scratch->chain.owners[i])) {
            memcpy(place->delta, scratch->delta + 3 * i, sizeof place->delta);
            memcpy(place->gradient, scratch->gradient + 9 * i, sizeof place->gradient);
            continue;
        }
        TRY(place->by == FIELD_BETWEEN ? find_outside(field, place, &foot, error)
                                       : find_end(field, place, &foot, error));
        ffd_foot_displacement(field, &foot, place->delta, place->gradient);
    }
    return FFD_OK;
}

/* The foot of any place. */
static ffd_status find_foot(const tear_field *field, field_place *place, field_foot *foot, ffd_error *error)
{
    ffd_location location;
    uint32_t block;
    if (place->by != FIELD_BETWEEN)
        return find_end(field, place, foot, error);
    const ffd_status status = ffd_blocks_holding(field->chain, place->x, &block, &location, error);
    if (status || block == BLOCK_NONE)
        return status ? status : find_outside(field, place, foot, error);
    *foot = (field_foot){.found = true, .inside = true, .link = block};
    memcpy(foot->point.uvw, location.uvw, sizeof foot->point.uvw);
    return FFD_OK;
}

ffd_status ffd_tear_blocks_compare(const tear_field *field, field_place pair[2], ffd_tear_cause *cause,
                                   ffd_error *error)
{
    field_foot feet[2];
    for (int i = 0; i < 2; i++)
        TRY(find_foot(field, &pair[i], &feet[i], error));
    ffd_feet_join(field, &feet[0], &feet[1]);
    for (int i = 0; i < 2; i++)
        ffd_foot_displacement(field, &feet[i], pair[i].delta, pair[i].gradient);
    *cause = feet[0].found && feet[1].found && feet[0].link == feet[1].link
                 ? ffd_feet_cause(field, &feet[0], &feet[1])
                 : FFD_TEAR_BLOCKS;
    return FFD_OK;
}
