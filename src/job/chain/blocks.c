#include "job/chain/blocks.h"
#include "base/system/clock.h"
#include "base/vector/array_kernel.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/block_faces.h"
#include "job/chain/common_faces.h"
#include "job/chain/marks.h"
#include "job/chain/pace.h"
#include "job/chain/point_outcome.h"
#include "job/chain/point_rounding.h"
#include <float.h>
#include <string.h>

/* Distances to two borders count as equal if they differ by at most this relative amount. */
#define EQUAL_DISTANCE 1e-12

typedef struct block_work {
    const lattice_chain *chain;
    chain_run *run;
    bool snaps; /* second search: points that miss a block by at most the snap count as inside */
} block_work;

/* Finds the first block, from `first` on, whose box holds a point. */
typedef struct next_block {
    const bounds *boxes;
    const double *p, *slack;
    uint32_t first, found; /* found: at least first; BLOCK_NONE: no such block */
} next_block;

static bool offer_block(void *context, uint32_t block)
{
    next_block *const next = context;
    if (block >= next->first && block < next->found && bounds_hold(&next->boxes[block], next->p, next->slack))
        next->found = block;
    return true;
}

/* Returns the first block, from `first` on, whose box is reached by the rounding cell of point i of the
   run. */
static uint32_t find_next(const block_work *work, size_t i, uint32_t first)
{
    const lattice_chain *const chain = work->chain;
    const double *const p = work->run->x + 3 * i;
    double slack[3];
    ffd_rounding_find(work->run->rounding, i, true, p, slack);
    double *const cell = &work->run->scratch->cell;
    *cell = larger_of(*cell, vec_length(slack));
    for (int a = 0; a < 3; a++)
        slack[a] = 2 * slack[a] + chain->slack[a] + 16 * DBL_EPSILON * fabs(p[a]);
    next_block next = {chain->boxes, p, slack, first, BLOCK_NONE};
    ffd_box_tree_visit(&chain->tree, p, slack, offer_block, &next);
    return next.found;
}

ffd_status ffd_blocks_holding(const lattice_chain *chain, const double p[3], uint32_t *block,
                              ffd_location *location, ffd_error *error)
{
    double slack[3];
    next_block next = {chain->boxes, p, slack, 0, BLOCK_NONE};
    for (int a = 0; a < 3; a++)
        slack[a] = chain->slack[a] + 16 * DBL_EPSILON * fabs(p[a]);
    for (;; next.first = next.found + 1) {
        next.found = BLOCK_NONE;
        ffd_box_tree_visit(&chain->tree, p, slack, offer_block, &next);
        *block = next.found;
        if (next.found == BLOCK_NONE)
            return FFD_OK;
        TRY(ffd_locator_find(chain->links[next.found].locator, p, 1, location, error));
        if (ffd_location_is_placed(location))
            return FFD_OK;
    }
}

/* Bits per pass of the radix sort by block number. */
#define DIGIT_BITS 10
#define DIGITS (1u << DIGIT_BITS)

/* Stable radix sort of points by block number. last: the largest block number. Returns the sorted array,
   which is either points or spare. */
static uint32_t *sort_by_block(const uint32_t *block, uint32_t last, size_t count, uint32_t *points,
                               uint32_t *spare)
{
    for (unsigned shift = 0; shift < 32 && last >> shift; shift += DIGIT_BITS) {
        uint32_t start[DIGITS + 1] = {0};
        for (size_t i = 0; i < count; i++)
            start[(block[points[i]] >> shift) % DIGITS + 1]++;
        for (size_t d = 0; d < DIGITS; d++)
            start[d + 1] += start[d];
        for (size_t i = 0; i < count; i++)
            spare[start[(block[points[i]] >> shift) % DIGITS]++] = points[i];
        uint32_t *const sorted = spare;
        spare = points;
        points = sorted;
    }
    return points;
}

/* Returns the number of points at the start of the array that share the first one's block. */
static size_t same_block(const uint32_t *block, const uint32_t *points, size_t count)
{
    size_t same = 1;
    while (same < count && block[points[same]] == block[points[0]])
        same++;
    return same;
}

/* Initially each point is outside of all blocks, or invalid if a coordinate is not finite. */
static void begin_points(const block_work *work)
{
    chain_run *const run = work->run;
    block_scratch *const blocks = &run->scratch->blocks;
    blocks->pending_count = 0;
    run->scratch->cell = 0;
    for (size_t i = 0; i < run->count; i++) {
        const bool finite = vec_is_finite(run->x + 3 * i);
        run->scratch->owners[i] = BLOCK_NONE;
        run->outcomes[i] =
            (point_outcome){.status = finite ? FFD_VERTEX_OUTSIDE : FFD_VERTEX_INVALID, .outside = finite};
        run->scratch->locations[i] =
            (ffd_location){.uvw = {NAN, NAN, NAN}, .status = run->outcomes[i].status};
        blocks->asked[i] = 0;
        if (finite)
            blocks->pending[blocks->pending_count++] = (uint32_t)i;
    }
}

/* Looks up the next candidate block of each pending point, and drops points without one. Returns the largest
   block number found. */
static uint32_t ask_next(const block_work *work)
{
    block_scratch *const blocks = &work->run->scratch->blocks;
    size_t count = 0;
    uint32_t last = 0;
    for (size_t k = 0; k < blocks->pending_count; k++) {
        const uint32_t i = blocks->pending[k];
        const uint32_t next = find_next(work, i, blocks->asked[i]);
        blocks->asked[i] = next;
        if (next == BLOCK_NONE)
            continue;
        blocks->pending[count++] = i;
        last = next > last ? next : last;
    }
    blocks->pending_count = count;
    return last;
}

static double snap_of(const block_work *work, uint32_t block)
{
    return work->snaps ? work->chain->links[block].snap : 0;
}

/* Half the extents of the rounding cell of point i. */
static void find_half(const block_work *work, size_t i, double half[3])
{
    ffd_rounding_find(work->run->rounding, i, true, work->run->x + 3 * i, half);
}

/* Compares the displacements of a point that a second block holds too, and notes a disagreement. */
static ffd_status compare(const block_work *work, size_t i, uint32_t other, const double uvw[3],
                          ffd_error *error)
{
    chain_run *const run = work->run;
    const chain_link *const links = work->chain->links;
    const block_place own = {&links[run->scratch->owners[i]], run->scratch->locations[i].uvw};
    const block_place next = {&links[other], uvw};
    double half[3], length;
    find_half(work, i, half);
    TRY(ffd_blocks_part(&own, &next, half, snap_of(work, other), &length, error));
    if (!(length > 0))
        return FFD_OK;
    run->outcomes[i].disagrees = true;
    run->disagreement = larger_of(run->disagreement, length);
    return FFD_OK;
}

/* Whether a point's rounding cell reaches a face of its block. */
static bool is_on_face(const block_work *work, size_t i, uint32_t block, const double uvw[3])
{
    double half[3], jacobian[9];
    find_half(work, i, half);
    return ffd_faces_reached(&work->chain->links[block], uvw, half, snap_of(work, block), jacobian) != 0;
}

/* Records a point's location in a block. *again: whether later blocks must be searched too. */
static ffd_status note_location(const block_work *work, size_t i, uint32_t block, const face_ends *ends,
                                const ffd_location *location, bool *again, ffd_error *error)
{
    const chain_run *const run = work->run;
    point_outcome now, *const outcome = &run->outcomes[i];
    uint32_t *const owner = &run->scratch->owners[i];
    ffd_outcome_make(work->chain->links[block].lattice, location, &now);
    *again = true;
    if (*owner != BLOCK_NONE)
        return now.located ? compare(work, i, block, location->uvw, error) : FFD_OK;
    if (!now.located) {
        ffd_outcome_join(&now, outcome);
        return FFD_OK;
    }
    now.evaluations += outcome->evaluations;
    *outcome = now;
    *owner = block;
    run->scratch->locations[i] = *location;
    *again =
        !run->first_only && ffd_faces_at(ends, location->uvw) && is_on_face(work, i, block, location->uvw);
    return FFD_OK;
}

/* Searches the block that these points ask for. Points that need further blocks are appended to
   blocks->again. *pending: how many these are. */
static ffd_status search_block(const block_work *work, const uint32_t *points, size_t count, size_t *pending,
                               ffd_error *error)
{
    const chain_run *const run = work->run;
    block_scratch *const blocks = &run->scratch->blocks;
    const uint32_t block = blocks->asked[points[0]];
    const chain_link *const link = &work->chain->links[block];
    const double snap = snap_of(work, block);
    const face_ends ends = ffd_face_ends(link->lattice, ffd_faces_near(link, snap, run));
    for (size_t k = 0; k < count; k++)
        memcpy(blocks->x + 3 * k, run->x + 3 * (size_t)points[k], 3 * sizeof *blocks->x);
    TRY(ffd_pace_find(link, blocks->x, count, run->pace, blocks->found, error));
    for (size_t k = 0; k < count; k++) {
        const uint32_t i = points[k];
        blocks->asked[i] = block + 1;
        bool again;
        if (blocks->found[k].status == FFD_VERTEX_OUTSIDE)
            TRY(ffd_retry_near_border(link, snap, true, run, i, run->x + 3 * i, &blocks->found[k], error));
        TRY(note_location(work, i, block, &ends, &blocks->found[k], &again, error));
        if (again)
            blocks->again[(*pending)++] = i;
    }
    return FFD_OK;
}

/* Searches the pending points block by block, until none is pending. */
static ffd_status locate_pending(const block_work *work, ffd_error *error)
{
    block_scratch *const blocks = &work->run->scratch->blocks;
    while (blocks->pending_count > 0) {
        const uint32_t last = ask_next(work);
        const size_t count = blocks->pending_count;
        const uint32_t *const sorted =
            sort_by_block(blocks->asked, last, count, blocks->pending, blocks->sorted);
        size_t again = 0;
        for (size_t k = 0, size; k < count; k += size) {
            size = same_block(blocks->asked, sorted + k, count - k);
            TRY(search_block(work, sorted + k, size, &again, error));
        }
        memcpy(blocks->pending, blocks->again, again * sizeof *blocks->again);
        blocks->pending_count = again;
    }
    return FFD_OK;
}

/* Makes pending all finite points that no block has. */
static void begin_again(const block_work *work)
{
    const chain_run *const run = work->run;
    block_scratch *const blocks = &run->scratch->blocks;
    blocks->pending_count = 0;
    for (size_t i = 0; i < run->count; i++) {
        blocks->asked[i] = 0;
        if (run->scratch->owners[i] == BLOCK_NONE && run->outcomes[i].status != FFD_VERTEX_INVALID)
            blocks->pending[blocks->pending_count++] = (uint32_t)i;
    }
}

/* Makes the outcomes of points whose blocks are known. */
static void recall(const block_work *work)
{
    const chain_run *const run = work->run;
    for (size_t i = 0; i < run->count; i++) {
        const uint32_t owner = run->scratch->owners[i];
        const ffd_location *const location = &run->scratch->locations[i];
        if (owner != BLOCK_NONE)
            ffd_outcome_make(work->chain->links[owner].lattice, location, &run->outcomes[i]);
        else
            run->outcomes[i] = (point_outcome){.status = location->status,
                                               .outside = location->status != FFD_VERTEX_INVALID};
    }
}

/* Finds the block of each point. A block that holds the point has precedence over one that the point misses
   by at most the snap. */
static ffd_status locate(block_work *work, ffd_error *error)
{
    if (work->run->located) {
        recall(work);
        return FFD_OK;
    }
    begin_points(work);
    TRY(locate_pending(work, error));
    if (!(work->chain->outside.snap > 0))
        return FFD_OK;
    work->snaps = true;
    begin_again(work);
    return locate_pending(work, error);
}

/* Search for the border point of any block that is nearest to a point. */
typedef struct nearest_border {
    const lattice_chain *chain;
    const double *p;
    double reach; /* upper bound of the distance */
    boundary_point point;
    uint32_t block;
    ffd_status status;
    ffd_error *error;
} nearest_border;

/* Among equally near borders that of the first block wins, whatever the order of visits. */
static bool offer_border(void *context, uint32_t block)
{
    nearest_border *const best = context;
    boundary_point found;
    const boundary *border;
    best->status = ffd_locator_border(best->chain->links[block].locator, &border, best->error);
    if (!best->status)
        best->status = ffd_boundary_find(border, best->p, best->reach, &found, best->error);
    if (best->status || !found.found)
        return !best->status;
    const bool equal = best->point.found && found.distance >= best->point.distance * (1 - EQUAL_DISTANCE);
    if (equal && block > best->block)
        return true;
    best->point = found;
    best->block = block;
    best->reach = found.distance * (1 + EQUAL_DISTANCE);
    return true;
}

ffd_status ffd_blocks_nearest(const lattice_chain *chain, const double p[3], double reach,
                              boundary_point *nearest, uint32_t *block, ffd_error *error)
{
    nearest_border best = {.chain = chain, .p = p, .reach = reach, .block = BLOCK_NONE, .error = error};
    ffd_box_tree_visit_near(&chain->tree, p, &best.reach, offer_border, &best);
    *nearest = best.point;
    *block = best.block;
    return best.status;
}

/* Displaces a point outside of all blocks like the nearest border point. */
static ffd_status extend(const block_work *work, size_t i, ffd_error *error)
{
    const lattice_chain *const chain = work->chain;
    const chain_run *const run = work->run;
    const double falloff = chain->outside.falloff, reach = falloff > 0 ? falloff : HUGE_VAL;
    border_place own, *const place = run->borders ? &run->borders[i] : &own;
    if (!run->borders || !run->located)
        TRY(ffd_blocks_nearest(chain, run->x + 3 * i, reach, &place->nearest, &place->block, error));
    const boundary_point nearest = place->nearest;
    const uint32_t block = place->block;
    if (!nearest.found)
        return FFD_OK;
    ffd_mark_owner(chain, run, i, block | OWNER_NEAREST);
    ffd_mark_part(chain, block, run, i, nearest.uvw);
    run->outcomes[i].extended = nearest.distance < reach || !(falloff > 0);
    const ffd_lattice *const lattice = ffd_link_mover(&chain->links[block]);
    double *const gradient = run->gradient && !run->only_turns ? run->gradient + 9 * i : NULL;
    run->outcomes[i].moved =
        ffd_extension_displacement(lattice, &nearest, falloff, run->delta + 3 * i, gradient);
    if (gradient)
        ffd_outcome_note_extension(lattice, &nearest, falloff, gradient, &run->outcomes[i]);
    return FFD_OK;
}

/* Notes the block of a point that is inside. */
static void mark_inside(const block_work *work, size_t i)
{
    const chain_run *const run = work->run;
    const ffd_location *const location = &run->scratch->locations[i];
    const uint32_t owner = run->scratch->owners[i];
    ffd_mark_owner(work->chain, run, i, owner);
    ffd_mark_part(work->chain, owner, run, i, location->status == FFD_VERTEX_SINGULAR ? NULL : location->uvw);
}

/* Points outside of all blocks stay, or are extended. Lists the other points in blocks->pending. */
static ffd_status place_others(const block_work *work, ffd_error *error)
{
    chain_run *const run = work->run;
    block_scratch *const blocks = &run->scratch->blocks;
    const bool marks = run->kept && work->chain->marks.owners > 0;
    blocks->pending_count = 0;
    for (size_t i = 0; i < run->count; i++) {
        if (run->scratch->owners[i] != BLOCK_NONE) {
            blocks->pending[blocks->pending_count++] = (uint32_t)i;
            if (marks)
                mark_inside(work, i);
            continue;
        }
        memset(run->delta + 3 * i, 0, 3 * sizeof *run->delta);
        if (run->gradient && !run->only_turns)
            memset(run->gradient + 9 * i, 0, 9 * sizeof *run->gradient);
        ffd_mark_owner(work->chain, run, i, OWNER_NONE);
        ffd_mark_part(work->chain, 0, run, i, NULL);
        if (run->outcomes[i].status == FFD_VERTEX_INVALID)
            continue;
        if (work->chain->outside.extend)
            TRY(extend(work, i, error));
        else
            ffd_mark_kept(run, i, 0);
    }
    return FFD_OK;
}

/* Displaces the points inside blocks, block by block. */
static void displace(const block_work *work)
{
    const lattice_chain *const chain = work->chain;
    chain_run *const run = work->run;
    chain_scratch *const scratch = run->scratch;
    block_scratch *const blocks = &scratch->blocks;
    const size_t count = blocks->pending_count;
    const uint32_t *const sorted =
        sort_by_block(scratch->owners, (uint32_t)(chain->count - 1), count, blocks->pending, blocks->sorted);
    displacement_batch batch = {.uvw = scratch->locations[0].uvw,
                                .stride = sizeof *scratch->locations,
                                .delta = run->delta,
                                .gradient = run->gradient,
                                .turns = run->turns,
                                .only_turns = run->only_turns,
                                .moves = scratch->moves};
    for (size_t k = 0; k < count; k += batch.count) {
        batch.which = sorted + k;
        batch.count = same_block(scratch->owners, batch.which, count - k);
        const ffd_lattice *const lattice = ffd_link_mover(&chain->links[scratch->owners[sorted[k]]]);
        const size_t before = run->turns ? run->turns->count : 0;
        ffd_displacements(lattice, chain->isa, &batch, &scratch->displacement);
        if (run->turns)
            ffd_outcomes_note_collapse(lattice, &batch, before, run->outcomes);
    }
    for (size_t k = 0; k < count; k++)
        run->outcomes[sorted[k]].moved = scratch->moves[sorted[k]];
}

ffd_status ffd_blocks_locate(const lattice_chain *chain, chain_run *run, ffd_error *error)
{
    block_work work = {.chain = chain, .run = run};
    run->first_only = true; /* what other blocks do there does not matter */
    return locate(&work, error);
}

ffd_status ffd_blocks_apply(const lattice_chain *chain, chain_run *run, ffd_error *error)
{
    block_work work = {.chain = chain, .run = run};
    const double start = ffd_clock_seconds();
    ffd_status status = locate(&work, error);
    const double middle = ffd_clock_seconds();
    run->embed_seconds += middle - start;
    TRY(status);
    TRY_END(place_others(&work, error));
    displace(&work);
    ffd_array_kernel(chain->isa)->add(run->delta, 3 * run->count, run->x);
    for (size_t i = 0; i < run->count; i++)
        run->disagreeing += run->outcomes[i].disagrees;
end:
    run->deform_seconds += ffd_clock_seconds() - middle;
    return status;
}
