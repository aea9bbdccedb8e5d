/* verdict.h - what is known of the determinant in one cell, and when that is known well enough. */
#ifndef FFD_FOLD_VERDICT_H
#define FFD_FOLD_VERDICT_H

#include <ffd/fold.h>
#include <math.h>

typedef struct cell_verdict {
    ffd_fold_verdict verdict;
    double lower;      /* a lower bound of the determinant in the cell; relative, as everything here */
    double least_seen; /* the least value that was computed at a point of it */
    double local[3];   /* some: of the witness, in the cell's [0,1]^3 */
    double value;      /* some: there, <= 0 */
} cell_verdict;

/* The lower bound that is near enough to the least value seen: within 1 % of it. */
static inline double ffd_fold_target(double least_seen)
{
    return least_seen - 0.01 * fabs(least_seen);
}

#endif
