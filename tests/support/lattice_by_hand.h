/* lattice_by_hand.h - makes lattices without files for tests: set knots and control points, then finish. */
#ifndef FFD_TESTS_LATTICE_BY_HAND_H
#define FFD_TESTS_LATTICE_BY_HAND_H

#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <stdlib.h>
#include <string.h>

/* Takes ownership of the knots. All control points are 0. */
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

/* Call it after points were set or changed. */
static inline ffd_status finish_by_hand(ffd_lattice *lattice, ffd_error *error)
{
    const ffd_status status = ffd_lattice_make_difference(lattice, error);
    return status ? status : ffd_lattice_finish_moved(lattice, error);
}

/* Kinds and sizes of the knots, one for each direction. */
typedef struct lattice_kinds {
    knot_kind kind[3];
    int degree[3];
    size_t size[3];
} lattice_kinds;

static inline ffd_lattice *lattice_of_kinds(const lattice_kinds *shape)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        if (ffd_knots_make(shape->kind[a], shape->degree[a], shape->size[a], NULL, 0, "uvw"[a], &knots[a],
                           NULL))
            abort();
    return lattice_of_knots(knots);
}

typedef void (*point_map)(const double g[3], double out[3]);

/* Sets each control point at rest to the image of its Greville abscissae, as fractions of the domain. */
static inline void lattice_map(ffd_lattice *lattice, point_map map)
{
    double *p = lattice->rest;
    for (size_t k = 0; k < lattice->size[2]; k++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, p += 3) {
                const size_t index[3] = {i, j, k};
                double g[3];
                for (int a = 0; a < 3; a++) {
                    const knot_vector *const knots = &lattice->knots[a];
                    g[a] = (ffd_knots_greville(knots, index[a]) - ffd_knots_first(knots)) /
                           (ffd_knots_last(knots) - ffd_knots_first(knots));
                }
                map(g, p);
            }
}

/* Adds weights, all 1. */
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
