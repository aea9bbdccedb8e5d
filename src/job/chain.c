#include "job/chain.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/vec.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include "job/embedding_file.h"
#include "job/share.h"
#include "lattice/lattice.h"
#include <string.h>

static ffd_status load_link(const chain_files *files, bool *used, lattice_chain *chain, size_t i,
                            ffd_error *error)
{
    chain_link *link = &chain->links[i];
    ffd_status status =
        ffd_lattice_load_set(files->paths[i], files->set, files->set_count, used, &link->lattice, error);
    if (!status && !ffd_lattice_needs_bounds(link->lattice))
        status = ffd_chain_prepare(chain, i, error);
    if (status)
        ffd_fail_name_file(error, files->paths[i]);
    return status;
}

static ffd_status refuse_unused(const chain_files *files, const bool *used, ffd_error *error)
{
    for (size_t i = 0; i < files->set_count; i++)
        if (!used[i])
            return ffd_fail_file(error, FFD_E_INVALID, files->paths[0],
                                 "there is no placeholder {\"$\": \"%.60s\"} that could be set",
                                 files->set[i].name);
    return FFD_OK;
}

ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_share *share, lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){.outside = *outside, .isa = isa, .share = share};
    if (files->count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no lattice is given");
    bool *const used = ffd_alloc_zero(files->set_count, sizeof *used);
    chain->links = ffd_alloc_zero(files->count, sizeof *chain->links);
    ffd_status status = used && chain->links ? FFD_OK : ffd_fail_memory(error);
    chain->count = status ? 0 : files->count;
    for (size_t i = 0; i < chain->count && !status; i++)
        status = load_link(files, used, chain, i, error);
    if (!status)
        status = refuse_unused(files, used, error);
    ffd_free(used);
    if (status)
        ffd_chain_free(chain);
    return status;
}

void ffd_chain_free(lattice_chain *chain)
{
    for (size_t i = 0; i < chain->count; i++) {
        ffd_boundary_destroy(&chain->links[i].border);
        if (!chain->links[i].locator_is_lent)
            ffd_locator_destroy(&chain->links[i].locator);
        ffd_lattice_destroy(&chain->links[i].lattice);
    }
    ffd_free(chain->links);
    *chain = (lattice_chain){0};
}

ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error)
{
    chain_link *made = &chain->links[link];
    ffd_status status = FFD_OK;
    if (chain->share) {
        made->rest = ffd_embedding_hash_lattice(made->lattice);
        made->locator = ffd_share_find_locator(chain->share, &made->rest, chain->isa);
        made->locator_is_lent = made->locator;
    }
    if (!made->locator)
        status = ffd_locator_create_for(made->lattice, chain->isa, &made->locator, error);
    if (status || !chain->outside.extend)
        return status;
    made->falloff = chain->outside.falloff;
    return ffd_boundary_create(made->lattice, &made->border, error);
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

static bool has_place(const ffd_location *location)
{
    return location->status != FFD_OUTSIDE && location->status != FFD_POINT_INVALID &&
           vec_is_finite(location->uvw);
}

/* F = F2 F1 in terms of what each differs from I: E = E1 + E2 + E2 E1. Zeros stay exact. */
static void compose(double gradient[9], const double next[9])
{
    double product[9];
    mat_multiply(next, gradient, product);
    for (int i = 0; i < 9; i++)
        gradient[i] = gradient[i] + next[i] + product[i];
}

static void note_location(const ffd_lattice *lattice, const ffd_location *location, chain_point *point)
{
    const double relative = location->residual / lattice->diagonal, square = relative * relative;
    if (square > point->residual_square)
        point->residual_square = square;
    if (location->status > point->status)
        point->status = location->status;
    if (has_place(location))
        point->located = true;
    if (!has_place(location) && location->status != FFD_POINT_INVALID)
        point->outside = true;
    if (location->status == FFD_MULTIPLE)
        point->multiple = true;
    point->unresolved |= location->unresolved;
    point->evaluations += location->evaluations;
    memcpy(point->uvw, location->uvw, sizeof point->uvw);
}

/* Where a link's displacements go: those of the first straight to the points. */
static displacement_batch begin_batch(const chain_run *run, size_t link)
{
    chain_scratch *scratch = run->scratch;
    const size_t point = sizeof *run->points / sizeof(double);
    displacement_batch batch = {.uvw = scratch->locations[0].uvw,
                                .stride = sizeof *scratch->locations / sizeof(double),
                                .which = scratch->inside,
                                .delta = link == 0 ? run->points[0].delta : scratch->delta,
                                .delta_step = link == 0 ? point : 3,
                                .gradient = link == 0 ? run->points[0].gradient : scratch->gradient,
                                .gradient_step = link == 0 ? point : 9,
                                .moves = scratch->moves};
    if (!run->gradients)
        batch.gradient = NULL;
    return batch;
}

/* The displacement of a point outside, into where the batch puts those of the others. */
static ffd_status extend(const chain_link *link, const chain_run *run, const displacement_batch *batch,
                         size_t i, ffd_error *error)
{
    chain_scratch *scratch = run->scratch;
    chain_point *point = &run->points[i];
    boundary_point nearest;
    scratch->moves[i] = 0;
    if (scratch->locations[i].status == FFD_POINT_INVALID || !link->border)
        return FFD_OK;
    const double reach = link->falloff > 0 ? link->falloff : HUGE_VAL;
    const ffd_status status = ffd_boundary_find(link->border, run->x + 3 * i, reach, &nearest, error);
    if (status || !nearest.found)
        return status;
    point->extended = point->extended || nearest.distance < reach || !(link->falloff > 0);
    scratch->moves[i] = (uint8_t)ffd_extension_displacement(
        link->lattice, &nearest, link->falloff, batch->delta + i * batch->delta_step,
        batch->gradient ? batch->gradient + i * batch->gradient_step : NULL);
    return FFD_OK;
}

static ffd_status find_displacements(const lattice_chain *chain, const chain_link *link, const chain_run *run,
                                     displacement_batch *batch, ffd_error *error)
{
    chain_scratch *scratch = run->scratch;
    for (size_t i = 0; i < run->count; i++) {
        if (has_place(&scratch->locations[i])) {
            scratch->inside[batch->count++] = (uint32_t)i;
            continue;
        }
        const ffd_status status = extend(link, run, batch, i, error);
        if (status)
            return status;
    }
    ffd_displacements(link->lattice, chain->isa, batch, &scratch->displacement);
    return FFD_OK;
}

static void displace(const chain_run *run, const displacement_batch *batch, size_t i)
{
    chain_point *point = &run->points[i];
    const double *delta = batch->delta + i * batch->delta_step;
    const bool is_there = delta == point->delta;
    for (int a = 0; a < 3; a++)
        if (delta[a] != 0) {
            run->x[3 * i + (size_t)a] += delta[a];
            if (!is_there)
                point->delta[a] += delta[a];
        }
    if (batch->gradient && !is_there) {
        const double *gradient = batch->gradient + i * batch->gradient_step;
        if (point->moved)
            compose(point->gradient, gradient);
        else
            memcpy(point->gradient, gradient, sizeof point->gradient);
    }
    point->moved = true;
}

ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error)
{
    chain_scratch *scratch = run->scratch;
    memset(run->points, 0, run->count * sizeof *run->points);
    for (size_t l = 0; l < links; l++) {
        const chain_link *link = &chain->links[l];
        const double start = ffd_clock_seconds();
        ffd_status status = FFD_OK;
        if (l > 0 || !run->located)
            status = ffd_locator_find(link->locator, run->x, run->count, scratch->locations, error);
        const double middle = ffd_clock_seconds();
        run->embed_seconds += middle - start;
        for (size_t i = 0; i < run->count && !status; i++)
            note_location(link->lattice, &scratch->locations[i], &run->points[i]);
        displacement_batch batch = begin_batch(run, l);
        if (!status)
            status = find_displacements(chain, link, run, &batch, error);
        for (size_t i = 0; i < run->count && !status; i++)
            if (scratch->moves[i])
                displace(run, &batch, i);
        run->deform_seconds += ffd_clock_seconds() - middle;
        if (status)
            return status;
    }
    return FFD_OK;
}
