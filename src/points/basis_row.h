/* basis_row.h - a row of dX/dQ: the derivative of an embedded point by the control points. */
#ifndef FFD_POINTS_BASIS_ROW_H
#define FFD_POINTS_BASIS_ROW_H

#include "points/embedding.h"
#include "points/row_seal.h"

/* The most control points that affect a point. */
#define BASIS_ENTRIES ((size_t)MAX_ORDER * MAX_ORDER * MAX_ORDER)

/* The number of control point i,j,k. */
typedef enum basis_order {
    BASIS_BY_U, /* u fastest, as in the library and in files */
    BASIS_BY_W  /* w fastest, as in Python */
} basis_order;

typedef struct basis_row {
    size_t count;
    uint32_t columns[BASIS_ENTRIES]; /* ascending, in a basis_order */
    double values[BASIS_ENTRIES];    /* R_j(u), none 0 */
} basis_row;

/* Replaces *weights = NULL by the weights at rest, and checks the caller's. Errors: FFD_E_INVALID for one
   that is not positive and finite. */
ffd_status ffd_basis_weights(const ffd_embedding *embedding, const double **weights, ffd_error *error);

/* Computes the row of a point. next: index of the first extended point not before this point; advanced for
   the next point. weights: those of the deformed volume; NULL: all 1. seal: NULL, or of a sealed lattice that
   moves the points in place of the embedding's; R_j are then what control points of the latter do. */
void ffd_basis_row(const ffd_embedding *embedding, const double *weights, const row_seal *seal,
                   basis_order order, size_t point, size_t *next, basis_row *row);
/* Fills uvw with the parameters that such a row is of, or returns false: the point does not move. next: as it
   is after ffd_basis_row. */
bool ffd_basis_uvw(const ffd_embedding *embedding, size_t point, size_t next, double uvw[3]);

#endif
