/* cell_form.h - a cell of a volume, prepared for determinants: its Bezier form, shifted to a local origin and
   scaled to size 1, the derivatives, and bounds of their rounding errors. */
#ifndef FFD_FOLD_CELL_FORM_H
#define FFD_FOLD_CELL_FORM_H

#include "fold/plan.h"

/* The greatest number of rows of the matrix. Without weights it is 3 x 3: the derivatives of x,y,z. With
   weights it is [A_u W_u; A_v W_v; A_w W_w; A W], whose determinant is W^4 det J. */
#define FORM_ROWS 4

typedef struct form_matrix {
    double at[FORM_ROWS][FORM_ROWS]; /* row, component */
} form_matrix;

typedef struct cell_form {
    int rows; /* 3 or 4 */
    int order[FORM_ROWS][3];
    double *row[FORM_ROWS][FORM_ROWS]; /* Bernstein coefficients of each component */
    form_matrix greatest;              /* greatest magnitude of a coefficient */
    form_matrix rounding;              /* bounds of the rounding errors of coefficients */
    form_matrix coarse;                /* the same if control points are known only to 2 eps of their
                                          magnitude */
    int exponent;                      /* det J = 2^exponent times that of the scaled cell */
    /* With weights: polynomials with coefficients >= 0 that bound those of a row and their rounding errors.
       The coefficient i of A_x, A_y or A_z is at most size[0][i] in magnitude, that of W size[1][i], and they
       are known to `roundings` times that; if control points are known only to 2 eps of their magnitude, A to
       known[i] more. */
    double *size[FORM_ROWS][2], *known[FORM_ROWS];
    double roundings;
    double hull_middle[3], hull_reach[3]; /* with weights: bounds of C, in the scale of the cell */
    double least_weight, greatest_weight; /* with weights, in the scale of the cell; else 1 */
} cell_form;

/* Returns the number of doubles for the rows of a form. */
size_t ffd_cell_form_size(const int order[3], bool rational);
/* Returns the number of doubles of scratch memory for ffd_cell_form_make. */
size_t ffd_cell_form_scratch(const int order[3]);

/* Makes the form of a cell. memory: ffd_cell_form_size doubles, to which the form keeps pointers. */
void ffd_cell_form_make(const fold_plan *plan, ffd_volume volume, const size_t index[3], bool rational,
                        double *memory, double *scratch, cell_form *form);

/* Returns whether the weights of the control points of a cell differ in the rest or in the deformed
   volume. */
bool ffd_cell_is_rational(const fold_plan *plan, const int span[3], double *scratch);

#endif
