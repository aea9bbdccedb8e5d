#include "job/chain/chain_apply.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include "job/chain/blocks.h"
#include "job/chain/common_faces.h"
#include "job/chain/marks.h"
#include "job/chain/pace.h"
#include "job/chain/point_outcome.h"
#include "job/chain/point_rounding.h"
#include "lattice/lattice.h"
#include <math.h>
#include <string.h>

void ffd_gradients_compose(double gradient[9], const double next[9])
{
    double product[9];
    mat_multiply(next, gradient, product);
    for (int i = 0; i < 9; i++)
        gradient[i] = gradient[i] + next[i] + product[i];
}

/* The first link writes its displacements directly to the run, later ones to scratch memory. Where only turns
   are looked for among several links, none writes its gradients to the run. */
static displacement_batch begin_batch(chain_run *run, size_t links, size_t link)
{
    chain_scratch *scratch = run->scratch;
    displacement_batch batch = {.uvw = scratch->locations[0].uvw,
                                .stride = sizeof *scratch->locations,
                                .which = scratch->inside,
                                .delta = link == 0 ? run->delta : scratch->delta,
                                .gradient = !run->gradient ? NULL
                                            : link == 0    ? run->gradient
                                                           : scratch->gradient,
                                .turns = run->turns,
                                .only_turns = run->only_turns,
                                .moves = scratch->moves};
    if (run->turns && links > 1) {
        scratch->turns.count = 0;
        batch.turns = &scratch->turns;
        batch.gradient = run->only_turns ? scratch->gradient : batch.gradient;
    }
    return batch;
}

/* Finds the border point that a point outside follows, unless it is known. */
static ffd_status find_border(const chain_link *link, border_place *borders, double reach,
                              const chain_run *run, size_t i, boundary_point *nearest, ffd_error *error)
{
    if (borders && run->located) {
        *nearest = borders[i].nearest;
        return FFD_OK;
    }
    TRY(link->is_convex ? FFD_OK : ffd_deadline_check(error));
    TRY(ffd_boundary_find(link->border, run->x + 3 * i, reach, nearest, error));
    if (borders)
        borders[i].nearest = *nearest;
    return FFD_OK;
}

/* Extends link l to a point outside of it; writes the displacement where the batch writes the others. */
static ffd_status extend(const lattice_chain *chain, size_t l, chain_run *run,
                         const displacement_batch *batch, size_t i, ffd_error *error)
{
    const chain_link *const link = &chain->links[l];
    boundary_point nearest;
    double *const delta = batch->delta + 3 * i;
    double *const gradient = batch->gradient && !batch->only_turns ? batch->gradient + 9 * i : NULL;
    run->scratch->moves[i] = 0;
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (run->scratch->locations[i].status == FFD_VERTEX_INVALID || !link->border)
        return FFD_OK;
    const double reach = link->falloff > 0 ? link->falloff : HUGE_VAL;
    TRY(find_border(link, l == 0 ? run->borders : NULL, reach, run, i, &nearest, error));
    if (!nearest.found)
        return FFD_OK;
    ffd_mark_part(chain, l, run, i, nearest.uvw);
    run->outcomes[i].extended |= nearest.distance < reach || !(link->falloff > 0);
    run->scratch->moves[i] =
        (uint8_t)ffd_extension_displacement(ffd_link_mover(link), &nearest, link->falloff, delta, gradient);
    if (gradient)
        ffd_outcome_note_extension(ffd_link_mover(link), &nearest, link->falloff, gradient,
                                   &run->outcomes[i]);
    return FFD_OK;
}

/* Marks a point as left by link l, unless the link extends to it. */
static void mark_kept(const chain_link *link, size_t l, chain_run *run, size_t i)
{
    if (!link->border && run->scratch->locations[i].status != FFD_VERTEX_INVALID)
        ffd_mark_kept(run, i, l);
}

/* Records the outcomes of the points in a link, and lists the points that have u,v,w there. */
static ffd_status note_locations(const lattice_chain *chain, size_t l, chain_run *run,
                                 displacement_batch *batch, ffd_error *error)
{
    const chain_link *const link = &chain->links[l];
    const bool is_first = l == 0, parts = run->kept && chain->marks.parted_count > 0;
    const ffd_location *const locations = run->scratch->locations;
    for (size_t i = 0; i < run->count; i++) {
        point_outcome later, *const outcome = is_first ? &run->outcomes[i] : &later;
        ffd_outcome_make(link->lattice, &locations[i], outcome);
        if (outcome->outside && !(is_first && run->located)) {
            TRY(ffd_retry_near_border(link, link->snap, is_first, run, i, run->x + 3 * i,
                                      &run->scratch->locations[i], error));
            ffd_outcome_make(link->lattice, &locations[i], outcome);
        }
        if (!is_first)
            ffd_outcome_join(outcome, &run->outcomes[i]);
        if (outcome->located) {
            run->scratch->inside[batch->count++] = (uint32_t)i;
            if (parts)
                ffd_mark_part(chain, l, run, i,
                              locations[i].status == FFD_VERTEX_SINGULAR ? NULL : locations[i].uvw);
            continue;
        }
        ffd_mark_part(chain, l, run, i, NULL);
        mark_kept(link, l, run, i);
        TRY(extend(chain, l, run, batch, i, error));
    }
    return FFD_OK;
}

/* Adds the displacements of a link after the first. */
static void add_link(const chain_run *run, const array_kernel *arrays)
{
    const chain_scratch *scratch = run->scratch;
    arrays->add(scratch->delta, 3 * run->count, run->delta);
    for (size_t i = 0; i < run->count && run->gradient && !run->only_turns; i++) {
        const double *const next = scratch->gradient + 9 * i;
        if (scratch->moves[i] && run->outcomes[i].moved)
            ffd_gradients_compose(run->gradient + 9 * i, next);
        else if (scratch->moves[i])
            memcpy(run->gradient + 9 * i, next, 9 * sizeof *next);
    }
}

/* Notes which points a link among several turns inside out. */
static void note_turns(const double *gradients, chain_scratch *scratch)
{
    for (size_t k = 0; k < scratch->turns.count; k++) {
        const size_t i = scratch->turns.points[k];
        double f[9];
        mat_add_identity(gradients + 9 * i, f);
        scratch->is_turned[i] ^= mat_determinant(f) < 0;
    }
}

static ffd_status apply_link(const lattice_chain *chain, size_t links, size_t l, chain_run *run,
                             ffd_error *error)
{
    const chain_link *link = &chain->links[l];
    chain_scratch *scratch = run->scratch;
    const array_kernel *const arrays = ffd_array_kernel(chain->isa);
    displacement_batch batch = begin_batch(run, links, l);
    TRY(note_locations(chain, l, run, &batch, error));
    if (ffd_common_wanted(chain))
        ffd_common_note(chain, l, run);
    ffd_displacements(ffd_link_mover(link), chain->isa, &batch, &scratch->displacement);
    if (batch.turns)
        ffd_outcomes_note_collapse(ffd_link_mover(link), &batch, 0, run->outcomes);
    if (batch.turns == &scratch->turns)
        note_turns(batch.gradient, scratch);
    arrays->add(batch.delta, 3 * run->count, run->x);
    if (l > 0)
        add_link(run, arrays);
    for (size_t i = 0; i < run->count; i++)
        run->outcomes[i].moved |= scratch->moves[i];
    return ffd_common_wanted(chain) ? ffd_common_count(chain, l, batch.delta, run, error) : FFD_OK;
}

ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error)
{
    if (links == 0) {
        memset(run->delta, 0, 3 * run->count * sizeof *run->delta);
        memset(run->outcomes, 0, run->count * sizeof *run->outcomes);
        if (run->gradient)
            memset(run->gradient, 0, 9 * run->count * sizeof *run->gradient);
    }
    if (links > 0 && chain->blocks)
        return ffd_blocks_apply(chain, run, error);
    if (ffd_common_wanted(chain))
        ffd_common_begin(run);
    if (run->turns && links > 1)
        memset(run->scratch->is_turned, 0, run->count);
    for (size_t l = 0; l < links; l++) {
        const double start = ffd_clock_seconds();
        ffd_status status = FFD_OK;
        if (l > 0 || !run->located)
            status = ffd_pace_find(&chain->links[l], run->x, run->count, run->pace, run->scratch->locations,
                                   error);
        const double middle = ffd_clock_seconds();
        run->embed_seconds += middle - start;
        TRY(status);
        status = apply_link(chain, links, l, run, error);
        run->deform_seconds += ffd_clock_seconds() - middle;
        TRY(status);
    }
    for (size_t i = 0; run->turns && links > 1 && i < run->count; i++)
        if (run->scratch->is_turned[i] || run->outcomes[i].collapsed)
            run->turns->points[run->turns->count++] = (uint32_t)i;
    return FFD_OK;
}

/* Points that are looked at together: a row of a mesh is longer, and crosses the border of a link at few
   places. */
#define TOGETHER ((size_t)128)

/* Locates points [first, end) in a link; those that it misses by their rounding or the snap are inside. */
static ffd_status locate_some(const lattice_chain *chain, size_t l, chain_run *run, size_t first, size_t end,
                              ffd_error *error)
{
    const chain_link *const link = &chain->links[l];
    ffd_location *const locations = run->scratch->locations;
    const bool is_first = l == 0, is_known = is_first && run->located;
    if (!is_known)
        TRY(ffd_pace_find(link, run->x + 3 * first, end - first, run->pace, locations + first, error));
    for (size_t i = first; i < end; i++) {
        if (!is_known && !ffd_location_is_placed(&locations[i]) && locations[i].status != FFD_VERTEX_INVALID)
            TRY(ffd_retry_near_border(link, link->snap, is_first, run, i, run->x + 3 * i, &locations[i],
                                      error));
        ffd_outcome_make(link->lattice, &locations[i], &run->outcomes[i]);
    }
    return FFD_OK;
}

/* Whether a link certainly holds points [first, end). */
static bool holds_all(const lattice_chain *chain, size_t l, const chain_run *run, size_t first, size_t end)
{
    double min[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, max[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    return ffd_array_kernel(chain->isa)->widen(run->x + 3 * first, end - first, min, max) &&
           ffd_locator_holds_box(chain->links[l].locator, min, max);
}

static ffd_status locate_in(const lattice_chain *chain, size_t l, bool locates, chain_run *run,
                            ffd_error *error)
{
    for (size_t first = 0, end; first < run->count; first = end) {
        end = run->count - first < TOGETHER ? run->count : first + TOGETHER;
        if (locates || !holds_all(chain, l, run, first, end)) {
            TRY(locate_some(chain, l, run, first, end, error));
            continue;
        }
        for (size_t i = first; i < end; i++) {
            run->outcomes[i].located = true;
            run->outcomes[i].outside = false;
        }
    }
    return FFD_OK;
}

ffd_status ffd_chain_locate(const lattice_chain *chain, size_t links, bool locates, chain_run *run,
                            ffd_error *error)
{
    if (chain->blocks)
        return ffd_blocks_locate(chain, run, error);
    if (links > 0)
        TRY(ffd_chain_apply(chain, links, run, error));
    return locate_in(chain, links, locates, run, error);
}
