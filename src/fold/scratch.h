/* scratch.h - the scratch memory of a worker. */
#ifndef FFD_FOLD_SCRATCH_H
#define FFD_FOLD_SCRATCH_H

#include "fold/plan.h"

/* The most halvings of a cell before a box stays undecided: 20 in each direction reduce the distance of
   coefficients from the least value of the determinant to its rounding error. There are fewer if the
   determinant has many coefficients, because the budget of boxes would not suffice for more
   (ffd_cell_boxes). */
#define CELL_DEPTH 60
#define LARGE_CELL_DEPTH 24
#define LARGE_CELL_COUNT 4096 /* number of coefficients for degree 15 in each direction */

typedef struct fold_scratch {
    double *block;
    int depth;
    double *working;                      /* shared by forms, determinants and restrictions, one after the
                                             other */
    double *rows;                         /* rows of the deformed volume's form */
    double *rest_rows;                    /* rows of the rest volume's form */
    double *rest, *rest_part;             /* coefficients of the rest volume: of the cell, and of a box */
    double *other[2], *other_part[2];     /* for each volume: marks of coefficients that may be other than 0
                                             (zeros.h) */
    double *coefficients[CELL_DEPTH + 1]; /* for the box at each depth */
    double *sizes[CELL_DEPTH + 1];        /* the same, of the rows; with weights */
    double *part_sizes;                   /* for one row of a box of either volume */
} fold_scratch;

/* Allocates scratch memory. Returns NULL if memory runs out. */
fold_scratch *ffd_fold_scratch_create(const fold_plan *plan);
/* Frees scratch memory; NULL is allowed. */
void ffd_fold_scratch_destroy(fold_scratch *scratch);

#endif
