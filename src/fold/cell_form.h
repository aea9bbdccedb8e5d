/* cell_form.h - one cell of a volume, ready for determinants: its Bezier form moved to a local origin and
   scaled to size 1, the derivatives of that, and bounds of their rounding. */
#ifndef FFD_FOLD_CELL_FORM_H
#define FFD_FOLD_CELL_FORM_H

#include "fold/plan.h"

/* Rows and columns of the matrix whose determinant is sought. Without weights it is 3 x 3: the derivatives of
   x,y,z. With weights, [A_u W_u; A_v W_v; A_w W_w; A W], whose determinant is W^4 det J. */
#define FORM_ROWS 4

typedef struct form_matrix {
    double at[FORM_ROWS][FORM_ROWS]; /* row, component */
} form_matrix;

typedef struct cell_form {
    int rows; /* 3 or 4 */
    int order[FORM_ROWS][3];
    double *row[FORM_ROWS][FORM_ROWS]; /* Bernstein coefficients of each component of each row */
    form_matrix greatest;              /* coefficient in size */
    form_matrix rounding;              /* bounds of the coefficients' rounding */
    form_matrix coarse;                /* the same if control points are only known to 2 eps of their size */
    int exponent;                      /* det J = 2^exponent times that of the scaled cell */
    double hull_middle[3], hull_reach[3]; /* with weights: of C, in the cell's own scale */
    double least_weight, greatest_weight; /* with weights, in the cell's own scale; else 1 */
} cell_form;

/* Doubles that a form's rows need, and those that making it needs besides. */
size_t ffd_cell_form_size(const int order[3], bool rational);
/* Doubles of scratch memory that ffd_cell_form_make needs besides. */
size_t ffd_cell_form_scratch(const int order[3]);

/* memory: ffd_cell_form_size doubles, whose contents the form refers to. */
void ffd_cell_form_make(const fold_plan *plan, ffd_volume volume, const size_t index[3], bool rational,
                        double *memory, double *scratch, cell_form *form);

/* Whether the weights of the cell's control points differ in either volume. */
bool ffd_cell_is_rational(const fold_plan *plan, const int span[3], double *scratch);

#endif
