/* contraction_kernel.h - the contraction bound of a box (bezier_box.h), which certifies the search in it. */
#ifndef FFD_EMBED_CELLS_CONTRACTION_KERNEL_H
#define FFD_EMBED_CELLS_CONTRACTION_KERNEL_H

#include "base/vector/isa.h"
#include "embed/frame/bezier_box.h"

typedef struct contraction_bound {
    bool regular;      /* J_F(centre) is invertible; otherwise inverse and bound are not set */
    double inverse[9]; /* Y = J_F(centre)^-1, in box coordinates t in [0,1]^3 */
    double bound;      /* L: the greatest row sum of |I - Y J_F| over the box and all p in middle +- reach;
                          HUGE_VAL if unknown */
} contraction_bound;

/* One table for each instruction set, all from the same source and with the same bits: lanes are the
   components of a point. */
typedef struct contraction_kernel {
    /* Computes the bound. columns: 3 * ffd_bezier_size doubles, filled with the coefficients of Y J_F. */
    void (*find_bound)(const bezier_box *box, const double middle[3], const double reach[3], double *columns,
                       contraction_bound *result);
    /* Returns the direction whose halving reduces that bound most. found, columns: as find_bound has filled
       them. */
    int (*find_halving)(const bezier_box *box, const contraction_bound *found, double *columns);
} contraction_kernel;

extern const contraction_kernel ffd_contraction_kernel_scalar;
#define DECLARE(ISA, set, lanes) extern const contraction_kernel ffd_contraction_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
