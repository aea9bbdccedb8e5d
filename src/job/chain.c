#include "job/chain.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/vec.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <string.h>

ffd_status ffd_chain_load(const char *const *paths, size_t count, lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){NULL, 0};
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
            status = ffd_locator_create(link->lattice, &link->locator, error);
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
        ffd_locator_destroy(&chain->links[i].locator);
        ffd_lattice_destroy(&chain->links[i].lattice);
    }
    ffd_free(chain->links);
    *chain = (lattice_chain){NULL, 0};
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
    if (location->status == FFD_OUTSIDE)
        point->outside = true;
    point->evaluations += location->evaluations;
    memcpy(point->uvw, location->uvw, sizeof point->uvw);
}

static void displace(const ffd_lattice *lattice, const ffd_location *location, bool gradients, double x[3],
                     chain_point *point)
{
    double delta[3], gradient[9];
    if (!has_place(location) || !ffd_displacement(lattice, location->uvw, delta, gradients ? gradient : NULL))
        return;
    for (int a = 0; a < 3; a++)
        if (delta[a] != 0) {
            x[a] += delta[a];
            point->delta[a] += delta[a];
        }
    if (gradients)
        compose(point->gradient, gradient);
}

ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, double *x, size_t count, bool gradients,
                           ffd_location *locations, chain_point *points, double *embed_seconds,
                           double *deform_seconds, ffd_error *error)
{
    memset(points, 0, count * sizeof *points);
    for (size_t l = 0; l < links; l++) {
        const chain_link *link = &chain->links[l];
        const double start = ffd_clock_seconds();
        const ffd_status status = ffd_locator_find(link->locator, x, count, locations, error);
        const double middle = ffd_clock_seconds();
        *embed_seconds += middle - start;
        if (status)
            return status;
        for (size_t i = 0; i < count; i++) {
            note_location(link->lattice, &locations[i], &points[i]);
            displace(link->lattice, &locations[i], gradients, x + 3 * i, &points[i]);
        }
        *deform_seconds += ffd_clock_seconds() - middle;
    }
    return FFD_OK;
}
