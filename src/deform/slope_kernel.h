/* slope_kernel.h - the ranges of the steps between the control points of a cell. */
#ifndef FFD_DEFORM_SLOPE_KERNEL_H
#define FFD_DEFORM_SLOPE_KERNEL_H

#include "base/vector/isa.h"
#include <stddef.h>

/* The least and the greatest of each coordinate of steps. */
typedef struct step_range {
    double low[3], high[3];
} step_range;

/* Finds the ranges of the steps from each point of a net to the next one, along the directions from `from` to
   2 in which it has two or more: times degree / width they hold the derivatives of a Bezier volume (NURBS
   Book 1.10). points: 3 numbers each, u fastest, finite, of which order[a] lie along direction a; one number
   after them is read. factors: what each point is multiplied by, or NULL. */
typedef void slope_kernel(const size_t order[3], const double *points, const double *factors, int from,
                          step_range ranges[3]);

/* One function for each instruction set, from the same source. */
slope_kernel ffd_slope_kernel_scalar;
#define DECLARE(ISA, set, lanes) slope_kernel ffd_slope_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
