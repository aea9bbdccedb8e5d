/* triangle_kernel.h - adds the slopes of weights on several triangles to sums of their corners (src/maths.md
   9.7). */
#ifndef FFD_MESH_TRIANGLE_KERNEL_H
#define FFD_MESH_TRIANGLE_KERNEL_H

#include "base/vector/isa.h"
#include <stddef.h>
#include <stdint.h>

/* The most triangles at once: a multiple of the doubles in any register. */
#define TRIANGLE_RUN ((size_t)64)

/* Numbers of each sum: slope times area, and area, both doubled. */
#define SLOPE_STRIDE 4

typedef struct triangle_run {
    size_t count;            /* at most TRIANGLE_RUN */
    const uint32_t *corners; /* 3 for each triangle: vertices */
    const uint32_t *owners;  /* of each corner: the vertex whose sum it counts in */
    const double *positions; /* 3 for each vertex from `base` on */
    size_t base;
    const double *weights; /* of all vertices */
    double scale;          /* edges are multiplied by this */
    /* SLOPE_STRIDE numbers of each of the owners [first, first + share). Others' corners do not count, nor do
       triangles without an area, or with a corner whose weight is NaN. */
    double *sums;
    uint32_t first, share;
} triangle_run;

typedef void triangle_kernel(const triangle_run *run);

/* One function for each instruction set, from the same source. */
triangle_kernel ffd_triangle_kernel_scalar;
#define DECLARE(ISA, set, lanes) triangle_kernel ffd_triangle_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
