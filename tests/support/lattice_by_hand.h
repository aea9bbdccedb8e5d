/* lattice_by_hand.h - a lattice without a file, for tests: knots and control points are put in, then
 * finished. */
#ifndef FFD_TESTS_LATTICE_BY_HAND_H
#define FFD_TESTS_LATTICE_BY_HAND_H

#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <stdlib.h>
#include <string.h>

/* Takes the knots over; all control points are at 0. */
static inline ffd_lattice *lattice_of_knots(const knot_vector knots[3])
{
    ffd_lattice *const lattice = ffd_alloc_zero(1, sizeof *lattice);
    if (!lattice)
        abort();
    lattice->count = 1;
    for (int a = 0; a < 3; a++) {
        lattice->knots[a] = knots[a];
        lattice->size[a] = knots[a].points;
        lattice->count *= knots[a].points;
    }
    lattice->form = REST_POINTS;
    lattice->rest = ffd_alloc_zero(lattice->count, 3 * sizeof(double));
    lattice->deformed = ffd_alloc_zero(lattice->count, 3 * sizeof(double));
    if (!lattice->rest || !lattice->deformed)
        abort();
    return lattice;
}

/* Gives the lattice weights, all 1. */
static inline void lattice_add_weights(ffd_lattice *lattice)
{
    lattice->rest_weights = ffd_alloc(lattice->count, sizeof(double));
    lattice->deformed_weights = ffd_alloc(lattice->count, sizeof(double));
    if (!lattice->rest_weights || !lattice->deformed_weights)
        abort();
    for (size_t i = 0; i < lattice->count; i++)
        lattice->rest_weights[i] = lattice->deformed_weights[i] = 1;
}

static inline size_t lattice_index(const ffd_lattice *lattice, size_t i, size_t j, size_t k)
{
    return i + lattice->size[0] * (j + lattice->size[1] * k);
}

#endif
