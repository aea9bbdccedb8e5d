/* regular.h - the quick proof that a cell does not fold: its Jacobian is near that of the centre
   everywhere. */
#ifndef FFD_FOLD_REGULAR_H
#define FFD_FOLD_REGULAR_H

#include "fold/cell_form.h"

typedef struct regularity {
    bool proven;   /* det J has the same sign in all of the cell; otherwise the other members are not set */
    bool negative; /* that sign */
    double least;  /* a lower bound of |det J| */
} regularity;

/* With Y = J(centre)^-1 the entries of B = Y J are polynomials, whose hulls bound |B_ii - 1| and |B_ij|. Let
   M have 1 minus these bounds on its diagonal, and the negative bounds elsewhere. If M is a non-singular
   M-matrix, B is an H-matrix, and det B >= det M (Ostrowski 1937; Horn & Johnson, Topics in Matrix Analysis,
   2.5). The contraction bound L < 1 is a special case. With weights the Jacobian is that of the equation A -
   p W, which is W J at the u,v,w where C = p. */
void ffd_cell_regularity(const cell_form *form, regularity *result);

#endif
