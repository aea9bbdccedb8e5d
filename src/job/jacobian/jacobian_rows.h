/* jacobian_rows.h - the rows of the matrix, one vertex after the other. */
#ifndef FFD_JOB_JACOBIAN_JACOBIAN_ROWS_H
#define FFD_JOB_JACOBIAN_JACOBIAN_ROWS_H

#include "job/jacobian/jacobian_state.h"
#include "points/basis_row.h"

/* One value of the matrix, of row 3i+a or i. */
typedef struct jacobian_entry {
    uint64_t column;
    double value;
} jacobian_entry;

/* The rows of one vertex: three, or one. By parameters the columns are all there; else they ascend and no
 * value is 0. */
typedef struct jacobian_rows {
    size_t counts[3];
    jacobian_entry *entries[3]; /* room for those of any vertex */
    basis_row basis;
    double *sums; /* 3 a column, by parameters */
    size_t *next; /* one a link: where its extended points go on */
} jacobian_rows;

/* Room for rows. Free it after a failure too. Errors: FFD_E_MEMORY. */
ffd_status ffd_jacobian_rows_make(const jacobian *j, jacobian_rows *rows, ffd_error *error);
/* Frees the room. */
void ffd_jacobian_rows_free(jacobian_rows *rows);
/* Must be called before the rows of a vertex that is not the one after the last. */
void ffd_jacobian_rows_begin(const jacobian *j, size_t vertex, jacobian_rows *rows);
/* Fills the rows of a vertex. */
void ffd_jacobian_rows_fill(const jacobian *j, size_t vertex, jacobian_rows *rows);

/* The weights that R has: those of the deformed volume, NULL where all are 1. */
static inline const double *ffd_jacobian_weights(const jacobian *j, const jacobian_link *link)
{
    return j->job.chain.links[link->number].lattice->deformed_weights;
}

#endif
