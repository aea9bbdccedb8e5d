/* cells.h - the search structure: span cells of a lattice, divided into leaves, in bricks of a few cells. A
   brick is made when a point first needs it. Its content depends only on the lattice, so it does not matter
   which thread makes it, or when. */
#ifndef FFD_EMBED_CELLS_CELLS_H
#define FFD_EMBED_CELLS_CELLS_H

#include "embed/cells/cell_kernel.h"
#include "embed/cells/contraction_kernel.h"
#include "embed/cells/region_kernel.h"
#include "embed/frame/bezier_box.h"
#include "embed/frame/box_tree.h"
#include "embed/frame/frame.h"
#include "spline/basis.h"
#include <math.h>
#include <stdatomic.h>

#define BRICK_SIDE 4    /* cells in each direction */
#define LEAF_BOUND 0.5  /* a box is a leaf if its contraction bound is at most this */
#define LEAF_DEPTH 12   /* a box after this many halvings is a hard leaf */
#define LEAF_BUDGET 512 /* so are the remaining boxes of a cell after this many boxes */

typedef struct cell_leaf {
    cell_region region; /* for a hard leaf only span is set */
    bounds hull;        /* of C, in the search's units */
    union {
        bounds image; /* of Y C; only without weights */
        bounds part;  /* hard leaf: part of the cell, which is [0,1]^3 */
    };
    bool hard;
} cell_leaf;

typedef struct cell_brick {
    cell_leaf *leaves;
    size_t leaf_count;
    box_tree tree;
} cell_brick;

/* Light bricks, with at most LIGHT_LEAVES leaves, are stored up to a total number of leaves; beyond that each
   search makes the bricks it needs and caches a few. Heavy bricks, of lattices that fold in every cell, are
   too expensive to be made twice: all are stored, and a mesh that needs too many of them is refused. For
   degrees above 3 the limits are lower in proportion to the size of leaves. */
#define LIGHT_LEAVES (16 * BRICK_SIDE * BRICK_SIDE * BRICK_SIDE)
#define MOST_LIGHT_LEAVES ((size_t)1 << 21)
#define MOST_HEAVY_LEAVES ((size_t)1 << 20)

/* 6 faces + 12 edges. */
#define MOST_COLLAPSES 18

/* The image of a collapsed face or edge: a point, or a curve along one direction. */
typedef struct collapse {
    double uvw[3];  /* the least u,v,w of the set (of a curve, that of its start), in the locator's knots */
    int along;      /* direction of the curve; -1: a point */
    double *points; /* control points h x, h of the curve, one for each basis function; or the point */
    bounds box;
} collapse;

typedef struct collapse_list {
    collapse sets[MOST_COLLAPSES];
    int count;
} collapse_list;

typedef struct cell_search {
    int order[3];
    size_t cells[3]; /* non-empty spans */
    size_t bricks[3];
    bool rational;
    cell_kernel *kernel;
    const contraction_kernel *contraction;
    region_kernel *region_kernel; /* NULL: search points one by one */
    int lanes;
    /* The search's units: powers of two that scale the lattice and its weights to size 1, so that products of
       three derivatives neither overflow nor underflow. x = (P - origin) * scale. */
    double scale;
    double extent[3];   /* max |x_a| over the control points */
    double size[3];     /* max |P_a|, in the coordinates of the file */
    double volume_sign; /* sign of the lattice's signed volume: -1 or 1 */
    double *points;     /* h x and h: BEZIER_COMPONENTS numbers for each control point */
    bool is_seam[3];    /* the first and the last face of this direction coincide (ffd_lattice_is_seam) */
    collapse_list collapses;
    double *extraction[3];   /* extraction matrix of each span: order x order */
    span_scheme *schemes[3]; /* for each non-empty span; NULL if there are too many */
    bounds *brick_hulls;
    box_tree brick_tree;
    _Atomic(cell_brick *) *made;              /* one pointer for each brick */
    atomic_size_t light_leaves, heavy_leaves; /* stored so far */
} cell_search;

/* As ffd_locator_tolerance and ffd_locator_aim, in the search's units. */
static inline void ffd_cells_tolerance(const ffd_locator *locator, const cell_search *cells,
                                       const double x[3], double tolerance[3], double aim[3])
{
    for (int a = 0; a < 3; a++) {
        tolerance[a] = 16 * DBL_EPSILON * (cells->size[a] + fabs(x[a] + locator->origin[a] * cells->scale));
        aim[a] = 16 * DBL_EPSILON * (cells->extent[a] + fabs(x[a]));
        tolerance[a] = tolerance[a] > aim[a] ? tolerance[a] : aim[a]; /* true already except for rounding */
    }
}

/* Returns the triangular scheme of a span; computes it in *own if it is not stored. */
const span_scheme *ffd_cells_scheme(const ffd_locator *locator, int a, int span, span_scheme *own);
/* Returns h x, h of the control point of three basis functions. */
const double *ffd_cells_point(const ffd_locator *locator, const size_t function[3]);
/* Converts indices of non-empty spans to spans. */
void ffd_cell_spans(const ffd_lattice *lattice, const size_t cell[3], int span[3]);

/* Computes the Bezier form of a cell, given by indices of non-empty spans. box->coefficients has room for
   ffd_bezier_size doubles. */
void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box);

/* Makes the region of a part of a cell from its contraction bound, except for its centre. */
void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result);

/* Evaluates the centre of a region. */
void ffd_cells_centre(const ffd_locator *locator, cell_region *region);

/* Doubles for the control points of a cell of the greatest degree. */
#define CELL_NUMBERS (MAX_ORDER * MAX_ORDER * MAX_ORDER * BEZIER_COMPONENTS)
/* Finds the rows of control points of a cell along u: pointers into the lattice's array, or to copies in own
   if a closed u wraps round. */
void ffd_cells_rows(const ffd_locator *locator, const int span[3], cell_rows rows, double own[CELL_NUMBERS]);

/* Evaluates the volume at u = t_span + offset. */
void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double offset[3],
                        homogeneous *result);

#endif
