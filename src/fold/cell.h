/* cell.h - the verdict on one cell, and a closer look at its least determinant. */
#ifndef FFD_FOLD_CELL_H
#define FFD_FOLD_CELL_H

#include "fold/plan.h"
#include "fold/scratch.h"
#include "fold/verdict.h"

/* Looks at no more boxes than this. */
void ffd_cell_decide(const fold_plan *plan, size_t cell, long boxes, fold_scratch *scratch,
                     cell_verdict *verdict);

/* A lower bound of the determinant in the cell that is within 1 % of the least value seen, in this cell
   (*least_seen is lowered) or elsewhere, unless *boxes (lowered by those looked at) end first. */
double ffd_cell_refine(const fold_plan *plan, size_t cell, fold_scratch *scratch, double *least_seen,
                       long *boxes);

/* Returns how many boxes of this plan's size are as much work as `boxes` of a cubic
   lattice without weights. */
long ffd_cell_boxes(const fold_plan *plan, long boxes);

#endif
