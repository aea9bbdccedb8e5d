/* sizes.h - with weights: bounds of the products that the determinant adds up, for a box of a cell. Rounding
   errors of its coefficients there are relative to these, and not to those of other parts of the cell, where
   weights may be far greater. */
#ifndef FFD_FOLD_SIZES_H
#define FFD_FOLD_SIZES_H

#include "fold/cell_form.h"

/* The polynomials of cell_form.size over a box. */
typedef struct row_sizes {
    double *row[FORM_ROWS][2];
} row_sizes;

/* The greatest coefficients of these, and of what the rows are known to. */
typedef struct size_bounds {
    double row[FORM_ROWS][2], known[FORM_ROWS];
    bool is_even; /* the weights differ so little that smaller boxes know the determinant no better */
} size_bounds;

/* Returns the number of doubles of row_sizes. */
size_t ffd_sizes_count(const int order[3]);

/* Copies the sizes of a cell to memory. */
void ffd_sizes_make(const cell_form *form, double *memory, row_sizes *sizes);
/* Splits them in direction a: lower receives the lower half, in memory; whole becomes the upper half. */
void ffd_sizes_halve(const cell_form *form, int a, double *memory, const row_sizes *whole, row_sizes *lower);
/* Finds the greatest coefficients; `known` is set to 0. */
void ffd_sizes_bound(const cell_form *form, const row_sizes *sizes, size_bounds *bounds);
/* The same for the part lo..hi of the cell, with `known`. scratch: ffd_sizes_count doubles. */
void ffd_sizes_bound_part(const cell_form *form, const double lo[3], const double hi[3], double *scratch,
                          size_bounds *bounds);

/* Returns a bound of the sum of the products, each without its sign; with `known`, if control points are
   known to that only. */
double ffd_sizes_products(const size_bounds *bounds, bool with_known);

#endif
