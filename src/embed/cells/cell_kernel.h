/* cell_kernel.h - a volume and its derivatives at one point of a cell. */
#ifndef FFD_EMBED_CELLS_CELL_KERNEL_H
#define FFD_EMBED_CELLS_CELL_KERNEL_H

#include "embed/frame/bezier_box.h"
#include "lattice/lattice.h"

/* A and W at u = t_span + offset, with their derivatives, from the polynomial of the given
   span (also at its ends). */
typedef struct homogeneous {
    double value[BEZIER_COMPONENTS];
    double derivative[3][BEZIER_COMPONENTS]; /* by u, v, w */
} homogeneous;

/* The basis functions of a cell and their derivatives. */
typedef struct cell_basis {
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
} cell_basis;

/* The rows of its control points along u, by w and v: BEZIER_COMPONENTS numbers a
   point, one after the other. */
typedef const double *cell_rows[MAX_ORDER][MAX_ORDER];

/* sum N N N P with its derivatives, u first, then v, then w, each in ascending index. One function for each
   instruction set, all of the same source and with the same bits: the components of a point are lanes. */
typedef void cell_kernel(const cell_basis *basis, const int order[3], const cell_rows *rows,
                         homogeneous *result);

cell_kernel ffd_cell_kernel_scalar;
#ifdef FFD_X86
cell_kernel ffd_cell_kernel_sse2, ffd_cell_kernel_avx2, ffd_cell_kernel_avx512;
#endif

#endif
