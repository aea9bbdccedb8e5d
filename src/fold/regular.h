/* regular.h - the quick proof that a cell does not fold: its Jacobian stays near that of the centre. */
#ifndef FFD_FOLD_REGULAR_H
#define FFD_FOLD_REGULAR_H

#include "fold/cell_form.h"

typedef struct regularity {
    bool proven;   /* det J has one sign all over the cell; else nothing below is set */
    bool negative; /* that sign */
    double least;  /* a lower bound of |det J| */
} regularity;

/* With Y = J(centre)^-1 the entries of B = Y J are polynomials; hulls bound |B_ii - 1| and |B_ij|. If the
   matrix with 1 less these bounds on its diagonal and their negatives beside it is a non-singular M-matrix,
   B is an H-matrix and det B no less than that matrix's (Ostrowski 1937; Horn & Johnson, Topics in Matrix
   Analysis, 2.5). The contraction bound L < 1 is a special case. With weights the Jacobian is that of the
   equation A - p W, which is W J at the u,v,w where C = p. */
void ffd_cell_regularity(const cell_form *form, regularity *result);

#endif
