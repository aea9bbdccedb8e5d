/* splat_kernel.h - several splats at a time: what the functions of splat.h do for one, with the same bits.
   Used within splat only. */
#ifndef FFD_SPLAT_SPLAT_KERNEL_H
#define FFD_SPLAT_SPLAT_KERNEL_H

#include "splat/splat_types.h"
#include <stddef.h>
#include <stdint.h>

/* What a kernel leaves to the functions for one: the last few, and those that are not ordinary. */
#define SPLAT_OPEN UINT8_MAX

/* Finds turns; open: 1 for all, and then for those that are left. One function for each instruction set that
   has lanes. */
typedef void turn_kernel(const double *gradients, size_t count, splat_turn *turns, uint8_t *open);
/* Deforms splats, as ffd_splats_deform; outcomes: SPLAT_OPEN of all, and then of those that are left. */
typedef void ellipsoid_kernel(const double *gradients, const splat_turn *turns, const splat_form *form,
                              size_t count, splat_ellipsoid *splats, uint8_t *outcomes);

#ifdef FFD_X86
turn_kernel ffd_turn_kernel_sse2, ffd_turn_kernel_avx2, ffd_turn_kernel_avx512;
ellipsoid_kernel ffd_ellipsoid_kernel_sse2, ffd_ellipsoid_kernel_avx2, ffd_ellipsoid_kernel_avx512;
#endif

/* What the gradient of a lattice that does not turn or stretch may be by rounding. */
#define STILL 0x1p-48
/* Directions that turn by less than this are not turned: coefficients of 0 stay 0. */
#define NO_TURN 0x1p-46
/* Part of a size that is left of one that F takes away: above the rounding of F, whose entries are sums over
   control points. */
#define NOTHING 1e-12
/* Entries of F that can be squared and multiplied freely. */
#define LEAST_F 1e-30
#define LARGEST_F 1e30

/* Sizes as they are computed with: parts of the largest, none of which is 0. */
#define LEAST_LOG (-150.0)
#define LEAST_PART 7e-66

/* Orders of three columns; the first two leave the last one where it is. Even ones keep the handedness. */
static const int splat_orders[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 2, 1}, {2, 0, 1}, {2, 1, 0}};

#endif
