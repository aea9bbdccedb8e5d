/* scratch.h - the memory that one worker needs for the cells it decides. */
#ifndef FFD_FOLD_SCRATCH_H
#define FFD_FOLD_SCRATCH_H

#include "fold/plan.h"

/* Halvings of a cell before a box is left open: 20 in each direction bring the coefficients' distance from
   the determinant's least value down to its rounding. Fewer where a determinant has many coefficients: the
   boxes allowed would not suffice for more (ffd_cell_boxes). */
#define CELL_DEPTH 60
#define LARGE_CELL_DEPTH 24
#define LARGE_CELL_COUNT 4096 /* coefficients: degree 15 in each direction */

typedef struct fold_scratch {
    double *block;
    int depth;
    double *working;                  /* for forms, determinants and restrictions, one after the other */
    double *rows;                     /* of the deformed volume's form */
    double *rest_rows;                /* of the rest volume's */
    double *rest, *rest_part;         /* the rest volume's coefficients: of the cell, and of one box */
    double *other[2], *other_part[2]; /* by volume: where they may be other than 0 (zeros.h) */
    double *coefficients[CELL_DEPTH + 1], *weights[CELL_DEPTH + 1]; /* of the box at each depth */
} fold_scratch;

/* NULL if memory runs out. */
fold_scratch *ffd_fold_scratch_create(const fold_plan *plan);
/* Frees it; NULL is allowed. */
void ffd_fold_scratch_destroy(fold_scratch *scratch);

#endif
