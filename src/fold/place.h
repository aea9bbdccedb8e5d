/* place.h - det J at one place, to about 58 digits of its terms. */
#ifndef FFD_FOLD_PLACE_H
#define FFD_FOLD_PLACE_H

#include "fold/plan.h"

typedef struct place_determinant {
    int sign;    /* of sign * det J; 0: no more than 2^-192 of the products that are added up */
    double size; /* its magnitude, relative to the mean at rest */
} place_determinant;

/* Returns the parameters of t in [0,1]^3 of a cell; at the end of a cell that is not the last one, the last
   double before the knot, which belongs to the next cell. */
void ffd_place_parameters(const fold_plan *plan, const size_t index[3], const double t[3], double uvw[3]);

/* Computes the determinant of the deformed volume at u,v,w of a cell. points: scratch memory, four numbers
   for each control point of the cell. */
place_determinant ffd_place_determinant(const fold_plan *plan, const size_t index[3], const double uvw[3],
                                        double *points);

#endif
