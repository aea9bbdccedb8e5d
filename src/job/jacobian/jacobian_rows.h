/* jacobian_rows.h - computes the rows of the matrix, vertex by vertex. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_ROWS_H
#define FFD_JOB_JACOBIAN_JACOBIAN_ROWS_H

#include "job/jacobian/jacobian_state.h"
#include "points/basis_row.h"

/* A stored value of row 3i+a, or of row i. */
typedef struct jacobian_entry {
    uint64_t column;
    double value;
} jacobian_entry;

/* The rows of one vertex: three, or one. Columns ascend, and zeros are not stored. */
typedef struct jacobian_rows {
    size_t counts[3];
    jacobian_entry *entries[3]; /* capacity for any vertex */
    basis_row basis;
    double *sums; /* by parameters: 3 a column */
    size_t *next; /* of each link: the next entry of its extended points */
} jacobian_rows;

/* Allocates rows. Call ffd_jacobian_rows_free also after a failure. Errors: FFD_E_MEMORY. */
ffd_status ffd_jacobian_rows_make(const jacobian *j, jacobian_rows *rows, ffd_error *error);
/* Frees the memory of rows. */
void ffd_jacobian_rows_free(jacobian_rows *rows);
/* Must be called before filling the rows of a vertex that does not follow the last one. */
void ffd_jacobian_rows_begin(const jacobian *j, size_t vertex, jacobian_rows *rows);
/* Computes the rows of a vertex. */
void ffd_jacobian_rows_fill(const jacobian *j, size_t vertex, jacobian_rows *rows);

/* Returns the weights in the basis R: those of the deformed volume, NULL if all are 1. */
static inline const double *ffd_jacobian_weights(const jacobian *j, const jacobian_link *link)
{
    return j->job.chain.links[link->number].lattice->deformed_weights;
}

#endif
