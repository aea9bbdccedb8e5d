/* band_kernel.h - tiles of a band matrix: BAND_TILE columns of BAND_TILE numbers each. */
#ifndef FFD_FIT_BAND_KERNEL_H
#define FFD_FIT_BAND_KERNEL_H

#include "base/vector/isa.h"
#include <stdbool.h>
#include <stddef.h>

/* The rows, and columns, of a tile. */
#define BAND_TILE ((size_t)64)

typedef struct band_kernel {
    /* c -= a b^T, of the columns of a and b from `first` on. Each entry of c gets its products one after the
       other, in ascending order. */
    void (*subtract)(const double *a, const double *b, size_t first, double *c);
    /* x := x l^-T, for the lower triangle of l. */
    void (*divide)(const double *l, double *x);
    /* Replaces the lower triangle of a tile by its factor; what is above it is of no use then. Returns
       whether all pivots are above `least`. */
    bool (*factor)(double *tile, double least);
} band_kernel;

/* One table for each instruction set, from the same source. */
extern const band_kernel ffd_band_kernel_scalar;
#define DECLARE(ISA, set, lanes) extern const band_kernel ffd_band_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
