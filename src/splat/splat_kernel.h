/* splat_kernel.h - kernels that process several splats at a time, with the same bits as the scalar functions,
   and the constants of both. Used in src/splat only. */
#ifndef FFD_SPLAT_SPLAT_KERNEL_H
#define FFD_SPLAT_SPLAT_KERNEL_H

#include "base/vector/isa.h"
#include "splat/splat_types.h"
#include <stddef.h>
#include <stdint.h>

/* The outcome of splats that a kernel leaves to the scalar functions: the last few, and special cases. */
#define SPLAT_OPEN UINT8_MAX

/* Computes rotations. open: all 1 before the call; afterwards 1 for those that are not computed. One function
   for each SIMD instruction set. */
typedef void turn_kernel(const double *gradients, size_t count, splat_turn *turns, uint8_t *open);
/* Deforms splats as ffd_splats_deform. outcomes: all SPLAT_OPEN before the call; afterwards only those that
   are not computed. */
typedef void ellipsoid_kernel(const double *gradients, const splat_turn *turns, const splat_form *form,
                              size_t count, splat_ellipsoid *splats, uint8_t *outcomes);

#define DECLARE(ISA, set, lanes)                                                                             \
    turn_kernel ffd_turn_kernel_##set;                                                                       \
    ellipsoid_kernel ffd_ellipsoid_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

/* Upper bound of the rounding errors in the gradient of a lattice that neither rotates nor stretches. */
#define STILL 0x1p-48
/* Smaller rotations are ignored, so that coefficients of 0 stay 0. */
#define NO_TURN 0x1p-46
/* Relative size that remains of an extent that F collapses: above the rounding of F, whose entries are sums
   over control points. */
#define NOTHING 1e-12
/* Range of the entries of F in which squares and products neither overflow nor underflow. */
#define LEAST_F 1e-30
#define LARGEST_F 1e30

/* Lower limits of scales relative to the largest, so that none of them is 0. */
#define LEAST_LOG (-150.0)
#define LEAST_PART 7e-66

/* Limits of Newton's iteration, which converges quadratically in the end; scaling makes the first steps
   fast. */
#define NEWTON_STEPS 30
#define NEWTON_NEAR 1e-2    /* after a squared change below this, no more scaling */
#define NEWTON_ENOUGH 1e-18 /* after a squared change below this, the next change is below rounding */

/* Columns whose cosine is below this count as perpendicular. It is far below the precision of a float, and
   above the rounding of F, so that a rotation keeps the axes of splats with equal scales. */
#define RIGHT 1e-12
#define SWEEPS 20

/* The permutations of three columns; the first two keep the last column. Those with an even index keep the
   handedness. */
static const int splat_orders[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 2, 1}, {2, 0, 1}, {2, 1, 0}};

#endif
