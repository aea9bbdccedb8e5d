/* zeros.h - zeros of a cell's determinant that its control points show: lines of equal ones, as those of a
   collapsed axis, edge or face. */
#ifndef FFD_FOLD_ZEROS_H
#define FFD_FOLD_ZEROS_H

#include "fold/plan.h"

/* Doubles of scratch memory that ffd_zeros_find needs. */
size_t ffd_zeros_scratch(const int order[3], bool rational);

/* Whether some coefficients of the rest volume's determinant over the cell are exactly 0 for that reason.
   Then other[v] is a polynomial of the determinant's order with coefficients >= 0; where one is 0, volume v's
   is; halved like the determinants, it says so of their parts. */
bool ffd_zeros_find(const fold_plan *plan, const size_t index[3], bool rational, double *scratch,
                    double *const other[2]);

#endif
