/* exact.h - rows that hold exactly: what has to be added to a solution, by its Schur complement. */
#ifndef FFD_FIT_EXACT_H
#define FFD_FIT_EXACT_H

#include "fit/band.h"
#include "fit/normal.h"

/* The most exact rows. */
#define MOST_EXACT ((size_t)4096)

/* A row that depends on others holds, or contradicts them, by this part of the diagonal. */
#define EXACT_HOLDS 1e-9

/* Fails with FFD_E_UNMET: two rows, or a row and its mirror image, contradict each other by a distance. */
ffd_status ffd_exact_fail(size_t a, size_t b, double by, ffd_error *error);

/* Adds to x, of the system whose factor is given, the least change in its terms with which all exact rows
   hold. diagonal: a length to which rounding is small. *dependent: how many rows others imply. Errors:
   FFD_E_UNMET (rows that contradict each other), FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_exact_correct(const fit_places *rows, double diagonal, const band_matrix *factor, double *x,
                             size_t *dependent, ffd_error *error);

#endif
