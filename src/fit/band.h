/* band.h - a symmetric band matrix, its Cholesky factor, and systems with it (Golub & Van Loan, Matrix
   Computations, 4.2 and 4.3), in square tiles. The results are the same bits for any number of threads and
   any instruction set: an entry is a sum in ascending order. */
#ifndef FFD_FIT_BAND_H
#define FFD_FIT_BAND_H

#include "base/fail.h"
#include "fit/band_kernel.h"
#include "fit/steps.h"
#include <ffd/isa.h>
#include <stddef.h>
#include <stdint.h>

typedef struct band_matrix {
    size_t n;        /* rows */
    size_t reach;    /* entries farther from the diagonal are 0 */
    size_t tiles;    /* rows of tiles; the last one is filled up by the identity */
    size_t depth;    /* tiles of a column: from the diagonal down */
    double *entries; /* the lower half: column by column of tiles, each by columns */
} band_matrix;

/* How work on a matrix runs. */
typedef struct band_run {
    ffd_isa isa;
    int threads;      /* at least 1 */
    fit_steps *steps; /* the factor is the step that runs; NULL: nothing is told */
} band_run;

/* Returns the bytes of a matrix; UINT64_MAX if they overflow. */
uint64_t ffd_band_bytes(size_t n, size_t reach);
/* Makes a matrix, whose entries are not set. Errors: FFD_E_MEMORY. */
ffd_status ffd_band_make(size_t n, size_t reach, band_matrix *band, ffd_error *error);
/* Frees the matrix and empties it; it can be freed again. */
void ffd_band_free(band_matrix *band);
/* Sets all entries to 0: by all threads, for fresh memory takes long. */
void ffd_band_clear(band_matrix *band, int threads);
/* Copies the entries of a matrix of the same rows and reach. */
void ffd_band_copy(const band_matrix *from, band_matrix *to);

/* Returns the entry in row i and column j <= i, i - j <= reach. */
static inline double *ffd_band_entry(const band_matrix *band, size_t i, size_t j)
{
    const size_t column = j / BAND_TILE, row = i / BAND_TILE - column;
    return band->entries + ((column * band->depth + row) * BAND_TILE + j % BAND_TILE) * BAND_TILE +
           i % BAND_TILE;
}

/* Returns the sum of the diagonal. */
double ffd_band_trace(const band_matrix *band);

/* Replaces the matrix by its Cholesky factor L. *is_positive: false if a pivot is not above 1e-15 of the
   largest diagonal entry; the matrix is then of no use. Errors: FFD_E_MEMORY, those of the
   deadline. */
ffd_status ffd_band_factor(band_matrix *band, const band_run *run, bool *is_positive, ffd_error *error);

/* Solves L y = x in place, for the factor L and `columns` right-hand sides: x has a row of so many numbers
   for each row of the matrix. It ends early after the deadline, which the caller checks. */
void ffd_band_forward(const band_matrix *factor, double *x, size_t columns);
/* Solves L^T y = x likewise. */
void ffd_band_backward(const band_matrix *factor, double *x, size_t columns);

#endif
