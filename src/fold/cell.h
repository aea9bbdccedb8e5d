/* cell.h - the verdict on one cell, and a closer look at its least determinant. */
#ifndef FFD_FOLD_CELL_H
#define FFD_FOLD_CELL_H

#include "fold/plan.h"
#include "fold/scratch.h"
#include <ffd/fold.h>

typedef struct cell_verdict {
    ffd_fold_verdict verdict;
    double lower;      /* a lower bound of the determinant in the cell; relative, as everything here */
    double least_seen; /* the least value that was computed at a place of it */
    double place[3];   /* some: of the witness, in the cell's [0,1]^3 */
    double value;      /* some: there, <= 0 */
} cell_verdict;

/* No more than so many boxes are looked at. */
void ffd_cell_decide(const fold_plan *plan, size_t cell, long boxes, fold_scratch *scratch,
                     cell_verdict *verdict);

/* A lower bound of the determinant in the cell that is within 1 % of the least value seen, in this cell
   (*least_seen is lowered) or elsewhere, unless *boxes (lowered by those looked at) end first. */
double ffd_cell_refine(const fold_plan *plan, size_t cell, fold_scratch *scratch, double *least_seen,
                       long *boxes);

/* How many boxes of this plan's size are as much work as `boxes` of a cubic lattice without weights. */
long ffd_cell_boxes(const fold_plan *plan, long boxes);

/* The lower bound that is near enough to the least value seen. */
double ffd_fold_target(double least_seen);

#endif
