#include "job/chain.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/vec.h"
#include "deform/extension.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <string.h>

ffd_status ffd_chain_load(const char *const *paths, size_t count, const chain_outside *outside,
                          lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){.outside = *outside};
    if (count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no lattice is given");
    chain->links = ffd_alloc_zero(count, sizeof *chain->links);
    if (!chain->links)
        return ffd_fail_memory(error);
    chain->count = count;
    for (size_t i = 0; i < count; i++) {
        chain_link *link = &chain->links[i];
        ffd_status status = ffd_lattice_load(paths[i], &link->lattice, error);
        if (!status && !ffd_lattice_needs_bounds(link->lattice))
            status = ffd_chain_prepare(chain, i, error);
        if (status) {
            ffd_fail_name_file(error, paths[i]);
            ffd_chain_free(chain);
            return status;
        }
    }
    return FFD_OK;
}

void ffd_chain_free(lattice_chain *chain)
{
    for (size_t i = 0; i < chain->count; i++) {
        ffd_boundary_destroy(&chain->links[i].border);
        ffd_locator_destroy(&chain->links[i].locator);
        ffd_lattice_destroy(&chain->links[i].lattice);
    }
    ffd_free(chain->links);
    *chain = (lattice_chain){0};
}

ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error)
{
    chain_link *made = &chain->links[link];
    const ffd_status status = ffd_locator_create(made->lattice, &made->locator, error);
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

/* *moves: false where the point stays. gradient may be NULL. */
static ffd_status find_displacement(const chain_link *link, const ffd_location *location, const double x[3],
                                    chain_point *point, bool *moves, double delta[3], double *gradient,
                                    ffd_error *error)
{
    boundary_point nearest;
    *moves = false;
    if (has_place(location)) {
        *moves = ffd_displacement(link->lattice, location->uvw, delta, gradient);
        return FFD_OK;
    }
    if (location->status == FFD_POINT_INVALID || !link->border)
        return FFD_OK;
    const double reach = link->falloff > 0 ? link->falloff : HUGE_VAL;
    const ffd_status status = ffd_boundary_find(link->border, x, reach, &nearest, error);
    if (status || !nearest.found)
        return status;
    point->extended = point->extended || nearest.distance < reach || !(link->falloff > 0);
    *moves = ffd_extension_displacement(link->lattice, &nearest, link->falloff, delta, gradient);
    return FFD_OK;
}

static ffd_status displace(const chain_link *link, const ffd_location *location, bool gradients, double x[3],
                           chain_point *point, ffd_error *error)
{
    double delta[3], gradient[9];
    bool moves;
    const ffd_status status =
        find_displacement(link, location, x, point, &moves, delta, gradients ? gradient : NULL, error);
    if (status || !moves)
        return status;
    for (int a = 0; a < 3; a++)
        if (delta[a] != 0) {
            x[a] += delta[a];
            point->delta[a] += delta[a];
        }
    if (gradients)
        compose(point->gradient, gradient);
    return FFD_OK;
}

ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error)
{
    memset(run->points, 0, run->count * sizeof *run->points);
    for (size_t l = 0; l < links; l++) {
        const chain_link *link = &chain->links[l];
        const double start = ffd_clock_seconds();
        ffd_status status = FFD_OK;
        if (l > 0 || !run->located)
            status = ffd_locator_find(link->locator, run->x, run->count, run->locations, error);
        const double middle = ffd_clock_seconds();
        run->embed_seconds += middle - start;
        for (size_t i = 0; i < run->count && !status; i++) {
            note_location(link->lattice, &run->locations[i], &run->points[i]);
            status =
                displace(link, &run->locations[i], run->gradients, run->x + 3 * i, &run->points[i], error);
        }
        run->deform_seconds += ffd_clock_seconds() - middle;
        if (status)
            return status;
    }
    return FFD_OK;
}
