/* determinant.h - the Bernstein coefficients of the Jacobian determinant of a cell, and bounds of their
   rounding errors. */
#ifndef FFD_FOLD_DETERMINANT_H
#define FFD_FOLD_DETERMINANT_H

#include "fold/cell_form.h"

/* Far above the effect of underflow on a sum of products. */
#define LEAST_ROUNDING 0x1p-960

typedef struct determinant_bounds {
    double rounding; /* of every coefficient; exactly 0 if rows of zeros make it so */
    double coarse;   /* the same if control points are known only to 2 eps of their magnitude */
    double greatest; /* upper bound of the magnitude of coefficients */
    double relative; /* the part of `rounding` that comes from the expansion, relative to the sum of the
                        products' sizes */
} determinant_bounds;

/* Bounds the coefficients of the determinant and their rounding errors from the rows of the form. */
void ffd_determinant_bounds(const cell_form *form, determinant_bounds *bounds);

/* Computes the order of the determinant in each direction: 3 times the degree; with weights 4 times. */
void ffd_determinant_order(const int order[3], bool rational, int result[3]);

/* Returns the value at a corner; bit a of corner selects the end of direction a. */
double ffd_determinant_corner(const cell_form *form, int corner);

/* Returns the number of doubles of scratch memory for ffd_determinant_coefficients. */
size_t ffd_determinant_scratch(const int order[3], bool rational);
/* Computes factor (-1 or 1) times the Bernstein coefficients of the determinant. */
void ffd_determinant_coefficients(const cell_form *form, double factor, double *scratch,
                                  double *coefficients);

#endif
