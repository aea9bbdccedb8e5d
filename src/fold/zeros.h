/* zeros.h - exact zeros of the determinant of a cell from rows of equal control points, as at a collapsed
   axis, edge or face. */
#ifndef FFD_FOLD_ZEROS_H
#define FFD_FOLD_ZEROS_H

#include "fold/plan.h"

/* Returns the number of doubles of scratch memory for ffd_zeros_find. */
size_t ffd_zeros_scratch(const int order[3], bool rational);

/* Returns whether some coefficients of the rest volume's determinant in the cell are exactly 0 for that
   reason. other[v] is then a polynomial of the order of the determinant with coefficients >= 0: where one is
   0, the coefficient of volume v is 0. If it is split like the determinant, this holds for the parts too. */
bool ffd_zeros_find(const fold_plan *plan, const size_t index[3], bool rational, double *scratch,
                    double *const other[2]);

#endif
