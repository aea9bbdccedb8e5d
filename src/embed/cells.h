/* cells.h - the span cells of a lattice cut into leaves, in bricks of a few cells that are made when a point
   first needs them. What a brick holds depends on the lattice only, so it does not matter who makes it, or
   when. */
#ifndef FFD_EMBED_CELLS_H
#define FFD_EMBED_CELLS_H

#include "embed/bezier_box.h"
#include "embed/locator.h"
#include <stdatomic.h>

#define BRICK_SIDE 4    /* cells along each direction */
#define LEAF_BOUND 0.5  /* a box is a leaf when its contraction bound is no more */
#define LEAF_DEPTH 12   /* halvings of a cell before a box is called hard */
#define LEAF_BUDGET 512 /* boxes looked at in one cell, likewise */

/* A part of a cell in which F is certain to have at most one root: u = lo + t width, t in [0,1]^3. */
typedef struct cell_region {
    int span[3];
    double lo[3], width[3];
    double inverse[9]; /* Y */
    double bound;      /* L < 1 */
    double greatest_weight, weight_ratio;
} cell_region;

typedef struct cell_leaf {
    cell_region region; /* hard: only span is set */
    bounds hull;        /* of C, origin subtracted */
    bounds image;       /* of Y C, without weights only */
    bool hard;
    double part_lo[3], part_hi[3]; /* of the cell, for hard leaves */
} cell_leaf;

typedef struct cell_brick {
    cell_leaf *leaves;
    size_t leaf_count;
    box_tree tree;
} cell_brick;

typedef struct cell_search {
    int order[3];
    size_t cells[3]; /* non-empty spans */
    size_t bricks[3];
    bool rational;
    double volume_sign;    /* of the lattice's signed volume: -1, 1 */
    double *points;        /* h (P - origin) and h: BEZIER_COMPONENTS a control point */
    double *extraction[3]; /* of each span: order x order */
    bounds *brick_hulls;
    box_tree brick_tree;
    _Atomic(cell_brick *) *made; /* one for each brick */
} cell_search;

/* The Bezier form of a cell; box->coefficients has ffd_bezier_size doubles. cell counts non-empty spans. */
void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box);

/* The region of a part of a cell whose contraction is known. */
void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result);

/* The brick with this number, made if need be; lent by the locator. */
ffd_status ffd_cells_brick(const ffd_locator *locator, uint32_t number, const cell_brick **brick,
                           ffd_error *error);

/* A(u,v,w) and W, with their derivatives, from the polynomial of the given span (also at its ends). */
typedef struct homogeneous {
    double value[BEZIER_COMPONENTS];
    double derivative[3][BEZIER_COMPONENTS]; /* by u, v, w */
} homogeneous;
void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double uvw[3],
                        homogeneous *result);

#endif
