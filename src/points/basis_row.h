/* basis_row.h - a row of dX/dQ: how one embedded point follows the control points. */
#ifndef FFD_POINTS_BASIS_ROW_H
#define FFD_POINTS_BASIS_ROW_H

#include "points/embedding.h"

/* Control points that act at one u,v,w, at most. */
#define BASIS_ENTRIES ((size_t)MAX_ORDER * MAX_ORDER * MAX_ORDER)

typedef struct basis_row {
    size_t count;
    uint32_t columns[BASIS_ENTRIES]; /* ascending */
    double values[BASIS_ENTRIES];    /* R_j(u), none 0 */
} basis_row;

/* The weights that count: the caller's (NULL: none), which become those at rest where there are none. Errors:
   FFD_E_INVALID for one that is not positive and finite. */
ffd_status ffd_basis_weights(const ffd_embedding *embedding, const double **weights, ffd_error *error);

/* Fills the row of a point. next: the first extended point from this one on, moved to where the next point
   looks. weights: of the deformed volume; NULL: all are 1. */
void ffd_basis_row(const ffd_embedding *embedding, const double *weights, size_t point, size_t *next,
                   basis_row *row);

#endif
