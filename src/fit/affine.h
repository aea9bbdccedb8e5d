/* affine.h - the affine map that is the nearest to pairs of places, in weighted least squares. */
#ifndef FFD_FIT_AFFINE_H
#define FFD_FIT_AFFINE_H

#include <stddef.h>

typedef struct fit_affine {
    double constant[3], matrix[9]; /* offset = constant + matrix x */
    double middle[3];              /* weighted mean of the places */
    /* Directions in which the places do not differ: along these the map is not known, and taken for none. */
    double unknown[3][3];
    int unknown_count;
} fit_affine;

/* Finds the map from count places to their offsets, 3 numbers each, with weights above 0: by orthogonal
   rotations (Golub & Van Loan 5.2) and singular values (8.6), of which those below 1e-10 of the largest are
   taken for 0. */
void ffd_affine_nearest(const double *places, const double *offsets, const double *weights, size_t count,
                        fit_affine *affine);
/* Computes the offset of a place. */
void ffd_affine_nearest_offset(const fit_affine *affine, const double place[3], double offset[3]);

#endif
