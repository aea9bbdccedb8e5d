/* system.h - the offsets of a lattice that carry places where they are wanted, with the least bending: a
   system of normal equations with rows that hold exactly.

   D minimises (1/W) sum w |B D - y|^2 + S s E(D) + rho |D|^2 with B_e D = y_e for the exact rows: W the sum
   of the weights, E the bending, and s = t / tr E, t = tr(B^T w B) / W, so that S has no unit. */
#ifndef FFD_FIT_SYSTEM_H
#define FFD_FIT_SYSTEM_H

#include "fit/gram.h"
#include "fit/normal.h"

typedef struct fit_system {
    const fit_unknowns *unknowns;
    const fit_bending *bending;
    const fit_places *soft;    /* count may be 0 */
    const fit_places *exact;   /* likewise; their weights do not count */
    const band_matrix *normal; /* (1/W) B^T w B, if it is there already; or NULL */
    bool minimal;    /* the offsets are to be small: of handles. Else hardly: only where nothing else
                        tells them */
    double diagonal; /* of the lattice: what is small */
    band_run run;
} fit_system;

/* What a solution has beside the offsets. */
typedef struct fit_solution {
    double *offsets;  /* 3 of each unknown */
    double rho;       /* that was needed, as a part of its unit; raised where the data told too little */
    size_t dependent; /* exact rows that others imply */
    double freedom;   /* the trace of B A^-1 B^T w / W, A without exact rows; only where it was asked for */
    uint64_t flops;   /* of the factor */
} fit_solution;

/* Returns the multiplications and additions of making (1/W) B^T w B for so many places. */
double ffd_normal_work(const fit_unknowns *unknowns, size_t places);
/* Returns those of a factor. */
double ffd_factor_work(const fit_unknowns *unknowns);
/* As many of a factor as finding the trace takes time. */
#define FREEDOM_WORK 8

/* Makes (1/W) B^T w B. To be freed in every case. Errors: FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_system_normal(const fit_system *system, band_matrix *normal, ffd_error *error);

/* Solves the system for S = smooth. wants_freedom: also find the trace, of a system with its normal; it takes
   n^2 numbers. To be freed in every case. Errors: FFD_E_UNMET (exact rows that contradict each other; places
   that tell too little), FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_system_solve(const fit_system *system, double smooth, bool wants_freedom,
                            fit_solution *solution, ffd_error *error);
/* Frees the offsets and empties it. */
void ffd_solution_free(fit_solution *solution);

#endif
