/* region_kernel.h - the roots of regions of one cell for several points at a time (src/maths.md 6.4), each in
   a lane. */
#ifndef FFD_EMBED_CELLS_REGION_KERNEL_H
#define FFD_EMBED_CELLS_REGION_KERNEL_H

#include "embed/cells/cell_kernel.h"
#include "spline/basis.h"
#include <stdint.h>

/* Most lanes of any instruction set. */
#define REGION_LANES 8

/* A part of a cell in which F is certain to have at most one root: u = t_span + lo + t width, t in [0,1]^3.
   Parameters are offsets from the span's start throughout: in a narrow span u itself would be too coarse. */
typedef struct cell_region {
    int span[3];
    double lo[3], width[3];
    double inverse[9];                /* Y */
    double bound;                     /* L < 1 */
    double centre[BEZIER_COMPONENTS]; /* A and W there (ffd_cells_centre) */
    double greatest_weight, weight_ratio;
    double grain; /* what the rounding of u,v,w can move t by, in the direction where it is most */
} cell_region;

/* What is the same for all points of a cell of a lattice without weights. */
typedef struct region_kernel_cell {
    int order[3];
    const span_scheme *schemes[3];
    span_scheme own_schemes[3]; /* which they may point to */
    cell_rows rows;
} region_kernel_cell;

typedef enum region_outcome {
    REGION_EMPTY,    /* there is no root */
    REGION_FOUND,    /* t is within the tolerance */
    REGION_UNCERTAIN /* the kernel does not decide: ffd_search_region must */
} region_outcome;

/* One point a lane; all lanes are filled, if need be with points twice. */
typedef struct region_lanes {
    const cell_region *region[REGION_LANES];
    double x[3][REGION_LANES], tolerance[3][REGION_LANES],
        aim[3][REGION_LANES]; /* as point_search has them */
    /* Results: */
    region_outcome outcome[REGION_LANES];
    double t[3][REGION_LANES], equation[3][REGION_LANES], jacobian[9][REGION_LANES]; /* as sample has them */
    uint32_t evaluations[REGION_LANES];
} region_lanes;

/* Does what ffd_search_region does, with the same bits, by Newton's steps and those of the contraction. A
   root that may lie on a face of the region is uncertain, and so is one whose J is nearly singular. One
   function for each SIMD instruction set; a processor without SIMD takes the points one by one. */
typedef void region_kernel(const region_kernel_cell *cell, region_lanes *lanes);

#ifdef FFD_X86
region_kernel ffd_region_kernel_sse2, ffd_region_kernel_avx2, ffd_region_kernel_avx512;
#endif

#endif
