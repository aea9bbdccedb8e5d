/* normal.h - the normal matrix B^T w B of places in a lattice, and its products: B has a row of basis
   functions for each place. */
#ifndef FFD_FIT_NORMAL_H
#define FFD_FIT_NORMAL_H

#include "fit/band.h"
#include "fit/unknowns.h"

/* The most places of a block. */
#define FIT_BLOCK ((size_t)4096)

/* Places with what is wanted there. */
typedef struct fit_places {
    const fit_unknowns *unknowns;
    size_t count;
    double *uvw;     /* 3 for each, in the domain */
    double *wanted;  /* 3 for each */
    double *weights; /* one for each */
    size_t *numbers; /* of each: what it was called by the caller */
    size_t *begins;  /* block_count + 1: places of a block are in one cell, and at most FIT_BLOCK */
    size_t block_count;
} fit_places;

/* Copies places, ordered by their cells. numbers: NULL: their indices. To be freed in every case. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_fit_places_make(const fit_unknowns *unknowns, size_t count, const double *uvw,
                               const double *wanted, const double *weights, const size_t *numbers,
                               fit_places *places, ffd_error *error);
/* Frees the arrays and empties it. */
void ffd_fit_places_free(fit_places *places);

/* Adds factor B^T w B to a band matrix. The sums are the same bits for any number of threads. Errors:
   FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_normal_add(const fit_places *places, double factor, int threads, const band_matrix *band,
                          ffd_error *error);
/* to += factor B^T w (wanted - B x), for 3 numbers of each unknown; x NULL: 0. */
void ffd_normal_residual(const fit_places *places, double factor, const double *x, double *to);
/* Computes B x at one place. */
void ffd_place_value(const fit_unknowns *unknowns, const double uvw[3], const double *x, double value[3]);

#endif
