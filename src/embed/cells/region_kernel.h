/* region_kernel.h - finds the roots of regions of a cell for several points at a time (src/maths.md 6.4), one
   in each lane. */
#ifndef FFD_EMBED_CELLS_REGION_KERNEL_H
#define FFD_EMBED_CELLS_REGION_KERNEL_H

#include "base/vector/isa.h"
#include "embed/cells/cell_kernel.h"
#include "spline/basis.h"
#include <stdint.h>

/* The most lanes of any instruction set. */
#define REGION_LANES 8

/* A part of a cell in which F has at most one root, which is proven: u = t_span + lo + t width, t in [0,1]^3.
   Parameters are offsets from the start of the span, because in a narrow span u itself would be too
   coarse. */
typedef struct cell_region {
    int span[3];
    double lo[3], width[3];
    double inverse[9];                /* Y */
    double bound;                     /* L < 1 */
    double centre[BEZIER_COMPONENTS]; /* A and W at the centre (ffd_cells_centre) */
    double greatest_weight;
    double grain; /* greatest change of t by rounding u,v,w, of the three directions */
} cell_region;

/* The data that all points of a cell share; for a lattice without weights. */
typedef struct region_kernel_cell {
    int order[3];
    const span_scheme *schemes[3];
    span_scheme own_schemes[3]; /* storage for schemes that are not stored elsewhere */
    cell_rows rows;
} region_kernel_cell;

typedef enum region_outcome {
    REGION_EMPTY,    /* there is no root */
    REGION_FOUND,    /* t is a root within the tolerance */
    REGION_UNCERTAIN /* not decided: ffd_search_region must be called */
} region_outcome;

/* One point in each lane. All lanes are filled, if necessary with copies of a point. */
typedef struct region_lanes {
    const cell_region *region[REGION_LANES];
    double x[3][REGION_LANES], tolerance[3][REGION_LANES], aim[3][REGION_LANES]; /* as in point_search */
    /* Results: */
    region_outcome outcome[REGION_LANES];
    double t[3][REGION_LANES], equation[3][REGION_LANES], jacobian[9][REGION_LANES]; /* as in sample */
    uint32_t evaluations[REGION_LANES];
} region_lanes;

/* Does what ffd_search_region does, with the same bits, with Newton and contraction steps. A root that may be
   on a face of the region is uncertain, and so is one with a nearly singular J. One function for each SIMD
   instruction set; without SIMD, points are searched one by one. */
typedef void region_kernel(const region_kernel_cell *cell, region_lanes *lanes);

#define DECLARE(ISA, set, lanes) region_kernel ffd_region_kernel_##set;
FOR_EACH_SIMD(DECLARE)
#undef DECLARE

#endif
