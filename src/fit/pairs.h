/* pairs.h - the pairs of a fit: which are used, where they are in the lattice, and figures of them. */
#ifndef FFD_FIT_PAIRS_H
#define FFD_FIT_PAIRS_H

#include "base/fail.h"
#include "fit/unknowns.h"
#include <ffd/fit.h>

/* The pairs that are used, in their order. */
typedef struct fit_pairs {
    size_t count;
    size_t own_count; /* the first ones, which the caller gave; the others are their mirror images */
    size_t *numbers;  /* the caller's index of each */
    double *x;        /* sources, 3 numbers each */
    double *y;        /* from where the base takes them to their targets */
    double *uvw;
    double *given, *weights; /* those of the caller, 1 of exact pairs, all scaled; and those that count */
    bool *exact;
} fit_pairs;

/* Finds the pairs, and counts all others in the result. To be freed in every case. Errors: FFD_E_ARGUMENT,
   FFD_E_INVALID, FFD_E_EMBEDDING, FFD_E_MEMORY, FFD_E_CANCELLED. */
ffd_status ffd_pairs_make(const ffd_fit_desc *desc, const ffd_run_options *options, fit_pairs *pairs,
                          ffd_fit_result *result, ffd_error *error);
/* Frees the arrays and empties it. */
void ffd_pairs_free(fit_pairs *pairs);

/* Counts the positions whose pairs have different targets, and finds how far one is from their mean. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_pairs_find_spread(const fit_pairs *pairs, uint64_t *positions, double *largest,
                                 ffd_error *error);
/* Counts the control points whose functions are 0 at all pairs. Errors: FFD_E_MEMORY, those of the deadline.
 */
ffd_status ffd_pairs_count_unseen(const fit_pairs *pairs, const fit_unknowns *unknowns, uint64_t *count,
                                  ffd_error *error);

/* Returns the least number that a share of the numbers do not exceed, of at least one; they are reordered. */
double ffd_quantile(double *numbers, size_t count, double share);
/* Returns the median: the mean of the two in the middle. They are reordered. */
double ffd_median(double *numbers, size_t count);

#endif
