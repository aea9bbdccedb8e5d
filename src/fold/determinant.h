/* determinant.h - the Bernstein coefficients of a cell's Jacobian determinant, and bounds of their rounding.
 */
#ifndef FFD_FOLD_DETERMINANT_H
#define FFD_FOLD_DETERMINANT_H

#include "fold/cell_form.h"

typedef struct determinant_bounds {
    double rounding; /* of every coefficient, exact 0 where rows of zeros make it exactly 0 */
    double coarse;   /* the same if control points are only known to 2 eps of their size */
    double greatest; /* no coefficient is greater in size */
} determinant_bounds;

/* Bounds the determinant's coefficients and their rounding by the rows of the form. */
void ffd_determinant_bounds(const cell_form *form, determinant_bounds *bounds);

/* The order of the determinant: 3 degrees (with weights 4), in each direction. */
void ffd_determinant_order(const int order[3], bool rational, int result[3]);

/* The value at a corner, whose bits say which end of each direction. */
double ffd_determinant_corner(const cell_form *form, int corner);

/* factor (-1 or 1) times the determinant's coefficients. */
size_t ffd_determinant_scratch(const int order[3], bool rational); /* doubles */
void ffd_determinant_coefficients(const cell_form *form, double factor, double *scratch,
                                  double *coefficients);

#endif
