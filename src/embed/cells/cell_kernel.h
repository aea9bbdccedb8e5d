/* cell_kernel.h - evaluates a volume and its derivatives at a point of a cell. */
#ifndef FFD_EMBED_CELLS_CELL_KERNEL_H
#define FFD_EMBED_CELLS_CELL_KERNEL_H

#include "base/vector/isa.h"
#include "embed/frame/bezier_box.h"
#include "lattice/lattice.h"

/* A and W with their derivatives, from the polynomial of a given span, also at its ends. */
typedef struct homogeneous {
    double value[BEZIER_COMPONENTS];
    double derivative[3][BEZIER_COMPONENTS]; /* by u, v, w */
} homogeneous;

/* The basis functions of a cell and their derivatives. */
typedef struct cell_basis {
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
} cell_basis;

/* Pointers to the rows of control points of a cell along u, indexed by w and v; BEZIER_COMPONENTS consecutive
   numbers for each point. */
typedef const double *cell_rows[MAX_ORDER][MAX_ORDER];

/* Computes sum N N N P and its derivatives: over u first, then v, then w, each in ascending index. One
   function for each instruction set, all from the same source and with the same bits: lanes are the
   components of a point. */
typedef void cell_kernel(const cell_basis *basis, const int order[3], const cell_rows *rows,
                         homogeneous *result);

cell_kernel ffd_cell_kernel_scalar;
#define DECLARE(ISA, set, lanes) cell_kernel ffd_cell_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
