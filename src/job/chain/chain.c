#include "job/chain/chain.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include "lattice/lattice.h"
#include <string.h>

void ffd_chain_free(lattice_chain *chain)
{
    for (size_t i = 0; i < chain->count; i++) {
        if (!chain->links[i].border_is_lent)
            ffd_boundary_destroy(&chain->links[i].border);
        if (!chain->links[i].locator_is_lent)
            ffd_locator_destroy(&chain->links[i].locator);
        if (!chain->links[i].lattice_is_lent)
            ffd_lattice_destroy(&chain->links[i].lattice);
    }
    ffd_free(chain->links);
    *chain = (lattice_chain){0};
}

bounds ffd_chain_reach(const lattice_chain *chain, size_t link)
{
    const chain_outside *outside = &chain->outside;
    const bool everywhere = outside->extend && !(outside->falloff > 0);
    const double beyond = everywhere ? HUGE_VAL : outside->extend ? outside->falloff : 0;
    const ffd_lattice *lattice = chain->links[link].lattice;
    bounds box;
    for (int a = 0; a < 3; a++)
        box.lo[a] = box.hi[a] = lattice->rest[a];
    for (size_t i = 1; i < lattice->count; i++)
        bounds_add(&box, lattice->rest + 3 * i);
    for (int a = 0; a < 3; a++) {
        box.lo[a] -= beyond;
        box.hi[a] += beyond;
    }
    return box;
}

/* F = F2 F1 in terms of what each differs from I: E = E1 + E2 + E2 E1. Zeros stay exact. */
static void compose(double gradient[9], const double next[9])
{
    double product[9];
    mat_multiply(next, gradient, product);
    for (int i = 0; i < 9; i++)
        gradient[i] = gradient[i] + next[i] + product[i];
}

/* Member by member: a record that is made on the stack and copied has to wait for its own bytes. */
static void make_note(const ffd_lattice *lattice, const ffd_location *location, point_outcome *note)
{
    const bool invalid = location->status == FFD_POINT_INVALID;
    const bool placed = location->status != FFD_OUTSIDE && !invalid && vec_is_finite(location->uvw);
    const double relative = location->residual / lattice->diagonal;
    note->residual_square = relative * relative;
    note->evaluations = location->evaluations;
    note->status = location->status;
    note->moved = false;
    note->located = placed;
    note->outside = !placed && !invalid;
    note->multiple = location->status == FFD_MULTIPLE;
    note->unresolved = location->unresolved;
    note->extended = false;
}

static void join_note(const point_outcome *now, point_outcome *note)
{
    note->residual_square = larger_of(note->residual_square, now->residual_square);
    note->evaluations += now->evaluations;
    note->status = now->status > note->status ? now->status : note->status;
    note->located |= now->located;
    note->outside |= now->outside;
    note->multiple |= now->multiple;
    note->unresolved |= now->unresolved;
}

/* Where a link's displacements go: those of the first straight to the run. */
static displacement_batch begin_batch(const chain_run *run, size_t link)
{
    chain_scratch *scratch = run->scratch;
    return (displacement_batch){.uvw = scratch->locations[0].uvw,
                                .stride = sizeof *scratch->locations / sizeof(double),
                                .which = scratch->inside,
                                .delta = link == 0 ? run->delta : scratch->delta,
                                .gradient = !run->gradient ? NULL
                                            : link == 0    ? run->gradient
                                                           : scratch->gradient,
                                .moves = scratch->moves};
}

/* The displacement of a point outside, into where the batch puts those of the others. */
static ffd_status extend(const chain_link *link, const chain_run *run, const displacement_batch *batch,
                         size_t i, ffd_error *error)
{
    boundary_point nearest;
    double *const delta = batch->delta + 3 * i;
    double *const gradient = batch->gradient ? batch->gradient + 9 * i : NULL;
    run->scratch->moves[i] = 0;
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (run->scratch->locations[i].status == FFD_POINT_INVALID || !link->border)
        return FFD_OK;
    const double reach = link->falloff > 0 ? link->falloff : HUGE_VAL;
    const ffd_status status = ffd_boundary_find(link->border, run->x + 3 * i, reach, &nearest, error);
    if (status || !nearest.found)
        return status;
    run->notes[i].extended |= nearest.distance < reach || !(link->falloff > 0);
    run->scratch->moves[i] =
        (uint8_t)ffd_extension_displacement(link->lattice, &nearest, link->falloff, delta, gradient);
    return FFD_OK;
}

/* Notes what is known of the points, and lists those that have u,v,w in the link. */
static ffd_status note_locations(const chain_link *link, bool is_first, const chain_run *run,
                                 displacement_batch *batch, ffd_error *error)
{
    const ffd_location *const locations = run->scratch->locations;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < run->count && !status; i++) {
        point_outcome later, *const note = is_first ? &run->notes[i] : &later;
        make_note(link->lattice, &locations[i], note);
        if (!is_first)
            join_note(note, &run->notes[i]);
        if (note->located)
            run->scratch->inside[batch->count++] = (uint32_t)i;
        else
            status = extend(link, run, batch, i, error);
    }
    return status;
}

/* What a link after the first does comes to what is there. */
static void add_link(const chain_run *run, const array_kernel *arrays)
{
    const chain_scratch *scratch = run->scratch;
    arrays->add(scratch->delta, 3 * run->count, run->delta);
    for (size_t i = 0; i < run->count && run->gradient; i++) {
        const double *const next = scratch->gradient + 9 * i;
        if (scratch->moves[i] && run->notes[i].moved)
            compose(run->gradient + 9 * i, next);
        else if (scratch->moves[i])
            memcpy(run->gradient + 9 * i, next, 9 * sizeof *next);
    }
}

static ffd_status apply_link(const lattice_chain *chain, size_t l, const chain_run *run, ffd_error *error)
{
    const chain_link *link = &chain->links[l];
    chain_scratch *scratch = run->scratch;
    const array_kernel *const arrays = ffd_array_kernel(chain->isa);
    displacement_batch batch = begin_batch(run, l);
    const ffd_status status = note_locations(link, l == 0, run, &batch, error);
    if (status)
        return status;
    ffd_displacements(link->lattice, chain->isa, &batch, &scratch->displacement);
    arrays->add(batch.delta, 3 * run->count, run->x);
    if (l > 0)
        add_link(run, arrays);
    for (size_t i = 0; i < run->count; i++)
        run->notes[i].moved |= scratch->moves[i];
    return FFD_OK;
}

ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error)
{
    ffd_status status = FFD_OK;
    if (links == 0) {
        memset(run->delta, 0, 3 * run->count * sizeof *run->delta);
        memset(run->notes, 0, run->count * sizeof *run->notes);
        if (run->gradient)
            memset(run->gradient, 0, 9 * run->count * sizeof *run->gradient);
    }
    for (size_t l = 0; l < links && !status; l++) {
        const double start = ffd_clock_seconds();
        if (l > 0 || !run->located)
            status =
                ffd_locator_find(chain->links[l].locator, run->x, run->count, run->scratch->locations, error);
        const double middle = ffd_clock_seconds();
        if (!status)
            status = apply_link(chain, l, run, error);
        run->embed_seconds += middle - start;
        run->deform_seconds += ffd_clock_seconds() - middle;
    }
    return status;
}
