/* row_seal.h - rows of dX/dQ where faces are held: the control points of the sealed lattice
   (ffd_lattice_seal) are combinations of those of the lattice as given, those of held layers of none. */
#ifndef FFD_POINTS_ROW_SEAL_H
#define FFD_POINTS_ROW_SEAL_H

#include "lattice/lattice.h"

/* One direction of a sealed lattice. */
typedef struct sealed_direction {
    bool is_held;   /* at one end at least; else all of the following is empty */
    size_t held[2]; /* so many layers at the first and at the last end */
    size_t points;  /* of the sealed lattice */
    size_t *copied; /* of each of its control points: the given one that it is, or REFINE_NEW, then: */
    double *shares; /* of each of its control points, width numbers: what it has of given ones */
    size_t width, front, back; /* of the first `front` given ones, then of those from number `back` on */
} sealed_direction;

typedef struct row_seal {
    const ffd_lattice *sealed; /* borrowed */
    sealed_direction directions[3];
} row_seal;

/* Fills the seal of a lattice `sealed`, which was made of `given` by holding these faces at this continuity.
   Call ffd_row_seal_free in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_row_seal_make(const ffd_lattice *given, const ffd_lattice *sealed, int continuity,
                             unsigned faces, row_seal *made, ffd_error *error);
/* Frees and empties it; it can be freed again. */
void ffd_row_seal_free(row_seal *seal);

/* The factors of the given control points first .. first + degree in a direction with held ends, from the
   basis functions of the sealed lattice, which begin with number sealed_first: sums of these by the shares,
   without those of held layers, which no control point moves. */
void ffd_row_seal_factors(const sealed_direction *direction, int degree, size_t first, size_t sealed_first,
                          const double *basis, double *factors);

#endif
