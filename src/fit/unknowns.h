/* unknowns.h - the control points of a lattice as the unknowns of a system: in what order they stand, so that
   those that some place sees together are near each other, and what a place sees of them. */
#ifndef FFD_FIT_UNKNOWNS_H
#define FFD_FIT_UNKNOWNS_H

#include "lattice/lattice.h"
#include <stdint.h>

typedef struct fit_unknowns {
    const ffd_lattice *lattice;
    size_t count;     /* control points */
    size_t stride[3]; /* from an unknown to the next one along u, v, w */
    size_t reach;     /* unknowns that a place sees together are no farther apart */
    size_t row;       /* how many a place sees: the product of degree + 1 */
} fit_unknowns;

/* Orders the control points so that reach is the least. The lattice is borrowed. */
fit_unknowns ffd_unknowns_make(const ffd_lattice *lattice);

/* Returns the unknown of a control point with the indices i,j,k. */
static inline size_t ffd_unknown_at(const fit_unknowns *unknowns, size_t i, size_t j, size_t k)
{
    return i * unknowns->stride[0] + j * unknowns->stride[1] + k * unknowns->stride[2];
}

/* Returns the unknown of a control point by its index in the lattice. */
static inline size_t ffd_unknown_of(const fit_unknowns *unknowns, size_t point)
{
    const size_t *const size = unknowns->lattice->size;
    return ffd_unknown_at(unknowns, point % size[0], point / size[0] % size[1], point / size[0] / size[1]);
}

/* Returns the number of the cell of a u,v,w in the domain: places of one cell see the same unknowns. */
size_t ffd_unknowns_cell(const fit_unknowns *unknowns, const double uvw[3]);

/* Lists what places in the cell of u,v,w see, u fastest: unknowns->row numbers. */
void ffd_unknowns_seen(const fit_unknowns *unknowns, const double uvw[3], uint32_t *seen);
/* Computes the basis functions R of these there. */
void ffd_unknowns_row(const fit_unknowns *unknowns, const double uvw[3], double *row);

/* The greatest row: that of degree MAX_DEGREE. */
#define LONGEST_ROW ((size_t)MAX_ORDER * MAX_ORDER * MAX_ORDER)

#endif
