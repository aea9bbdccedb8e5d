/* slope_kernel.h - the ranges of the derivatives of a volume, by the steps between its control points. */
#ifndef FFD_DEFORM_SLOPE_KERNEL_H
#define FFD_DEFORM_SLOPE_KERNEL_H

#include "base/vector/isa.h"
#include "lattice/lattice.h"

/* Control points, and what makes derivatives of the steps between them: along direction a, step i becomes
   scale[a][i] step + shift[a] (NURBS Book 3.3; of a Bezier volume the scale is degree / width, 1.10). */
typedef struct control_net {
    size_t order[3];      /* points along each direction */
    const double *points; /* 3 numbers each, u fastest, finite; one number after them is read */
    double scale[3][MAX_DEGREE], shift[3][4];
} control_net;

/* The least and the greatest of each coordinate. */
typedef struct slope_range {
    double low[3], high[3];
} slope_range;

/* Finds the ranges of a net's derivatives, along the directions from `from` to 2 in which it has two points
   or more. axes: NULL, or for each direction the coordinate by whose size the derivatives are divided; it
   must not be 0 in any. */
typedef void slope_kernel(const control_net *net, int from, const int *axes, slope_range ranges[3]);

/* One function for each instruction set, from the same source. */
slope_kernel ffd_slope_kernel_scalar;
#define DECLARE(ISA, set, lanes) slope_kernel ffd_slope_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
