/* kernel.h - the displacement of many points of one cell, several at a time, and what it takes of the cell.
 */
#ifndef FFD_DEFORM_KERNEL_H
#define FFD_DEFORM_KERNEL_H

#include "lattice/lattice.h"
#include <stdint.h>

/* Control points in a cell of the highest degree. */
#define CELL_POINTS (MAX_ORDER * MAX_ORDER * MAX_ORDER)

/* Numbers of a kernel_field of the highest degree. */
#define FIELD_NUMBERS (3 * MAX_ORDER * MAX_ORDER * (MAX_ORDER + MAX_DEGREE))

/* Vectors at a cell's control points as the kernel takes them, u fastest, 3 numbers each. */
typedef struct kernel_field {
    const double *points; /* as weighted Bezier points Q_i */
    const double *slopes; /* (i+1) Q_i+1 - (d-i) Q_i along u, one fewer in a row; needed for derivatives */
} kernel_field;

/* One cell of a lattice without weights. */
typedef struct kernel_cell {
    int degree[3];
    double first[3], width[3]; /* the span's first knot and length */
    kernel_field difference;   /* Q - P */
    kernel_field rest;         /* P; needed for the Jacobian */
    const double *inverse;     /* d uvw / d p, 3 x 3, where it is the same everywhere; else NULL */
} kernel_cell;

/* Points of the cell, and where their results go. */
typedef struct kernel_points {
    const double *uvw; /* in the cell, 3 a point */
    const uint32_t
        *which;       /* the points' numbers, each greater than the one before: where results are stored */
    size_t count;     /* 1 or more */
    double *delta;    /* 3 a point: sum (Q - P) N N N */
    double *gradient; /* 9 a point, or NULL: the number 3 r + c of them is d delta_r / d p_c where the cell
                         has the inverse; else it is d delta_r / d uvw_c */
    double *jacobian; /* 9 a point, d p_r / d uvw_c; or NULL. Not without the gradient. */
} kernel_points;

/* Turns a cell's control points into a kernel_field's points: u fastest and 3 numbers each, both. Weighted:
   those with the index i along a direction of degree d have the factor binomial(d, i). extraction: of the
   span in each direction (basis.h). One number after the points is read. slopes: NULL, or where those go;
   one number after them is written. */
typedef void extraction_kernel(const int degree[3], const double *const extraction[3], double *points,
                               double *slopes);

/* One function for each instruction set, all of the same source: a point is a lane, and its operations are
   the same ones in the same order, so that all give the same bits. */
typedef void displacement_kernel(const kernel_cell *cell, const kernel_points *points);

displacement_kernel ffd_kernel_scalar;
extraction_kernel ffd_extraction_kernel_scalar;
#ifdef FFD_X86
extraction_kernel ffd_extraction_kernel_sse2, ffd_extraction_kernel_avx2, ffd_extraction_kernel_avx512;
displacement_kernel ffd_kernel_sse2, ffd_kernel_avx2, ffd_kernel_avx512;
#endif

#endif
