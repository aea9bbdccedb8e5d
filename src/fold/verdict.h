/* verdict.h - the result for a cell, and the accuracy that is needed. */
#ifndef FFD_FOLD_VERDICT_H
#define FFD_FOLD_VERDICT_H

#include <ffd/fold.h>
#include <math.h>

typedef struct cell_verdict {
    ffd_fold_verdict verdict;
    double lower;      /* a lower bound of the determinant in the cell; relative, as all values here */
    double least_seen; /* the least value computed at a point of the cell */
    double local[3];   /* FFD_FOLDS_SOME: position of the witness in [0,1]^3 of the cell */
    double value;      /* FFD_FOLDS_SOME: value at the witness, <= 0 */
    bool is_positive; /* with weights: but its sign is positive, by little, in a cell that is flat to rounding
                       */
} cell_verdict;

/* Returns the lower bound that is accurate enough: within 1 % of the least value found. */
static inline double ffd_fold_target(double least_seen)
{
    return least_seen - 0.01 * fabs(least_seen);
}

#endif
