/* cell.h - the verdict on a cell, and the refinement of its least determinant. */
#ifndef FFD_FOLD_CELL_H
#define FFD_FOLD_CELL_H

#include "fold/plan.h"
#include "fold/scratch.h"
#include "fold/verdict.h"

/* Decides whether a cell folds, with at most `boxes` boxes. */
void ffd_cell_decide(const fold_plan *plan, size_t cell, long boxes, fold_scratch *scratch,
                     cell_verdict *verdict);

/* Returns a lower bound of the determinant in a cell that is within 1 % of *least_seen, the least value found
   in any cell, which it updates; unless the budget *boxes, which it reduces, ends first. */
double ffd_cell_refine(const fold_plan *plan, size_t cell, fold_scratch *scratch, double *least_seen,
                       long *boxes);

/* Converts a number of boxes of a cubic lattice without weights to the number of boxes of this plan that take
   as much work. */
long ffd_cell_boxes(const fold_plan *plan, long boxes);

#endif
