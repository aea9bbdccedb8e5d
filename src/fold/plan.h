/* plan.h - what the cells of one lattice's fold proof share. Declares plan.c and volume.c. */
#ifndef FFD_FOLD_PLAN_H
#define FFD_FOLD_PLAN_H

#include "fold/scaled.h"
#include "lattice/lattice.h"

/* The rest volume's signed volume over the domain, the integral of det J_P. */
typedef struct signed_volume {
    int sign;         /* -1 or 1, of the computed value */
    scaled reference; /* |volume|; where that is nearly 0, the volume of the lattice's bounds */
    double doubt;     /* its relative error is no more than this, < 1/2 */
} signed_volume;

typedef struct fold_plan {
    const ffd_lattice *lattice;
    int order[3];
    size_t cells[3]; /* non-empty spans */
    size_t cell_count;
    bool rational;         /* the lattice has weights */
    double *extraction[3]; /* of each span: order x order */
    signed_volume volume;
} fold_plan;

/* Extracts the Bezier form of every span and measures the rest volume. Free with ffd_fold_plan_free, after a
   failure too. Errors: FFD_E_MEMORY, FFD_E_INVALID. */
ffd_status ffd_fold_plan_make(const ffd_lattice *lattice, fold_plan *plan, ffd_error *error);
/* Frees what ffd_fold_plan_make allocated. */
void ffd_fold_plan_free(fold_plan *plan);

/* The spans of a cell by its number, u fastest; index is the cell's number in each direction. */
void ffd_fold_cell_at(const fold_plan *plan, size_t number, size_t index[3], int span[3]);

/* Copies the control points of a cell of one volume, by the cell's number in each direction, and their
   weights unless weights is NULL. matrix: the cell's extraction matrices, lent by the plan. */
void ffd_fold_cell_read(const fold_plan *plan, ffd_volume volume, const size_t index[3], double *points,
                        double *weights, const double *matrix[3]);

/* Measures the rest volume (volume.c). Errors: FFD_E_MEMORY. */
ffd_status ffd_fold_volume(const fold_plan *plan, signed_volume *volume, ffd_error *error);

#endif
