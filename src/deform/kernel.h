/* kernel.h - the kernel that computes the displacements of points in a cell, and its input. */
#ifndef FFD_DEFORM_KERNEL_H
#define FFD_DEFORM_KERNEL_H

#include "base/vector/isa.h"
#include "lattice/lattice.h"
#include <stdint.h>

/* Control points of a cell of the greatest degree. */
#define CELL_POINTS (MAX_ORDER * MAX_ORDER * MAX_ORDER)

/* Doubles of a kernel_field of the greatest degree. */
#define FIELD_NUMBERS (3 * MAX_ORDER * MAX_ORDER * (MAX_ORDER + MAX_DEGREE))

/* A vector field on the control points of a cell, in the form that the kernel needs: u fastest, 3 numbers
   each. */
typedef struct kernel_field {
    const double *points; /* weighted Bezier points Q_i */
    const double *slopes; /* (i+1) Q_i+1 - (d-i) Q_i along u, one fewer in each row; only for derivatives */
} kernel_field;

/* A cell of a lattice without weights. */
typedef struct kernel_cell {
    int degree[3];
    double first[3], width[3]; /* first knot and length of the span */
    kernel_field difference;   /* Q - P */
    kernel_field rest;         /* P; only for the Jacobian */
    const double *inverse;     /* d uvw / d p, 3 x 3, if it is constant; else NULL */
} kernel_cell;

/* Points of a cell, and their results. */
typedef struct kernel_points {
    const double *uvw;     /* 3 numbers for each point, in the cell */
    const uint32_t *which; /* indices of the points in the result arrays, strictly ascending */
    size_t count;          /* >= 1 */
    double *delta;         /* 3 numbers for each point: sum (Q - P) N N N */
    double *gradient; /* NULL, or 9 numbers for each point: number 3 r + c is d delta_r / d p_c if the cell
                         has an inverse, else d delta_r / d uvw_c */
    double *jacobian; /* NULL, or 9 numbers for each point: d p_r / d uvw_c. Only together with gradient. */
} kernel_points;

/* Converts the control points of a cell to the points of a kernel_field, in place: u fastest, 3 numbers each.
   They are weighted: index i in a direction of degree d has the factor binomial(d, i). extraction: the
   weighted matrices of the span in each direction (spline/bezier.h). Reads one number after the points.
   slopes: NULL, or receives the slopes; one number after them is written. */
typedef void extraction_kernel(const int degree[3], const double *const extraction[3], double *points,
                               double *slopes);

/* One function for each instruction set, all from the same source. Each lane is a point, with the same
   operations in the same order, so all instruction sets give the same bits. */
typedef void displacement_kernel(const kernel_cell *cell, const kernel_points *points);

displacement_kernel ffd_kernel_scalar;
extraction_kernel ffd_extraction_kernel_scalar;
#define DECLARE(ISA, set, lanes)                                                                             \
    extraction_kernel ffd_extraction_kernel_##set;                                                           \
    displacement_kernel ffd_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
