/* adjoint.h - the gradient of a function of the points, brought back to control points and weights. Declares
   a function of basis_transposed.c. */
#ifndef FFD_POINTS_ADJOINT_H
#define FFD_POINTS_ADJOINT_H

#include "points/embedding.h"

/* A gradient by the points, and what moves them. */
typedef struct adjoint {
    const double *weights;    /* of the deformed volume; NULL: all 1 */
    const double *dfdx;       /* 3 for each point */
    bool by_points;           /* the gradient by the control points is wanted: 3 numbers for each */
    const ffd_lattice *moved; /* NULL, or the deformed volume: that by its weights is wanted, a number for
                                 each control point */
} adjoint;

/* Fills gradient with the numbers by the control points, u fastest, and then those by the weights. Errors:
   FFD_E_ARGUMENT, FFD_E_CANCELLED, FFD_E_MEMORY. */
ffd_status ffd_embedding_adjoint(const ffd_embedding *embedding, const adjoint *wanted, double *gradient,
                                 const ffd_run_options *options, ffd_error *error);

#endif
