/* evaluate_kernel.h - the kernel that evaluates a volume without weights at many u,v,w of a cell. */
#ifndef FFD_POINTS_EVALUATE_KERNEL_H
#define FFD_POINTS_EVALUATE_KERNEL_H

#include "base/vector/isa.h"
#include "lattice/lattice.h"
#include <stdint.h>

/* Steps of the triangular scheme of a span (spline/triangle.h). */
#define SCHEME_STEPS (MAX_DEGREE * MAX_ORDER / 2)

/* The quotients (t - u) / width and (u - t) / width of the scheme, each once: those of a span between knots
   of high multiplicity are few. */
typedef struct span_quotients {
    size_t falling, count; /* the first are t - u, the others u - t */
    double knot[2 * SCHEME_STEPS], width[2 * SCHEME_STEPS];
    uint8_t fall[SCHEME_STEPS], rise[SCHEME_STEPS]; /* which two quotients each step takes */
} span_quotients;

/* Points u,v,w in one cell. */
typedef struct evaluate_cell {
    int degree[3];
    const span_quotients *span[3];
    const double *points;  /* 3 numbers for each control point of the cell, u fastest */
    const double *uvw;     /* 3 numbers for each point, in the domain */
    const uint32_t *which; /* where the result of each point is to be */
    size_t count;
    double *xyz; /* of point n: begins at xyz[3 * n] */
} evaluate_cell;

/* As ffd_lattice_evaluate for each point, with the same bits. */
typedef void evaluate_kernel(const evaluate_cell *cell);

evaluate_kernel ffd_evaluate_kernel_scalar;
#define DECLARE(ISA, set, lanes) evaluate_kernel ffd_evaluate_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
