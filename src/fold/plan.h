/* plan.h - the data that all cells of a fold proof share. Declares plan.c and volume.c. */
#ifndef FFD_FOLD_PLAN_H
#define FFD_FOLD_PLAN_H

#include "fold/scaled.h"
#include "lattice/lattice.h"

/* The signed volume of the rest lattice: the integral of det J_P over the domain. */
typedef struct signed_volume {
    int sign;         /* sign of the computed value, -1 or 1 */
    bool is_mean;     /* false if the volume cannot be told from 0 */
    scaled reference; /* |volume|; else the volume of the bounds of the lattice */
    double doubt;     /* bound of its relative error, < 1/2 */
} signed_volume;

typedef struct fold_plan {
    const ffd_lattice *lattice;
    int order[3];
    size_t cells[3]; /* non-empty spans */
    size_t cell_count;
    bool rational;         /* the lattice has weights */
    double *extraction[3]; /* extraction matrix of each span: order x order */
    signed_volume volume;
} fold_plan;

/* Computes the extraction matrices of all spans and the rest volume. Free with ffd_fold_plan_free, also after
   a failure. Errors: FFD_E_MEMORY, FFD_E_INVALID. */
ffd_status ffd_fold_plan_make(const ffd_lattice *lattice, fold_plan *plan, ffd_error *error);
/* Frees what ffd_fold_plan_make allocated. */
void ffd_fold_plan_free(fold_plan *plan);

/* Converts the index of a cell among all (u fastest) to its index and its span in each direction. */
void ffd_fold_cell_at(const fold_plan *plan, size_t cell, size_t index[3], int span[3]);

/* Copies the control points of a cell of a volume and, unless weights is NULL, their weights. matrix:
   receives pointers to the extraction matrices of the cell, which belong to the plan. */
void ffd_fold_cell_read(const fold_plan *plan, ffd_volume volume, const size_t index[3], double *points,
                        double *weights, const double *matrix[3]);

/* Computes the rest volume (volume.c). Errors: FFD_E_MEMORY. */
ffd_status ffd_fold_volume(const fold_plan *plan, signed_volume *volume, ffd_error *error);

#endif
