/* cells.h - the span cells of a lattice cut into leaves, in bricks of a few cells that are made when
   a point first needs them. What a brick holds depends on the lattice only, so it does not matter
   who makes it, or when. */
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

#define BRICK_SIDE 4    /* cells along each direction */
#define LEAF_BOUND 0.5  /* a box is a leaf when its contraction bound is no more */
#define LEAF_DEPTH 12   /* halvings of a cell before a box is called hard */
#define LEAF_BUDGET 512 /* boxes looked at in one cell, likewise */

typedef struct cell_leaf {
    cell_region region; /* hard: only span is set */
    bounds hull;        /* of C, in the search's units */
    union {
        bounds image; /* of Y C, without weights only */
        bounds part;  /* hard: of the cell, [0,1]^3 */
    };
    bool hard;
} cell_leaf;

typedef struct cell_brick {
    cell_leaf *leaves;
    size_t leaf_count;
    box_tree tree;
} cell_brick;

/* Leaves of light bricks (no more than so many a brick) are kept up to a total; beyond it each search makes
   the bricks it needs for itself and keeps a few. Heavy bricks, of lattices that fold in every cell, cost too
   much to be made twice: all are kept, and a mesh that needs more of them is refused (of degrees above 3 as
   many fewer as their leaves are larger). */
#define LIGHT_LEAVES (16 * BRICK_SIDE * BRICK_SIDE * BRICK_SIDE)
#define MOST_LIGHT_LEAVES ((size_t)1 << 21)
#define MOST_HEAVY_LEAVES ((size_t)1 << 20)

/* 6 faces and 12 edges. */
#define MOST_COLLAPSES 18

/* The image of a collapsed face or edge: a point, or a curve along one direction. */
typedef struct collapse {
    double uvw[3];  /* the least of its points (of a curve: with the curve's start), in the locator's knots */
    int along;      /* the curve's direction; -1: a point */
    double *points; /* the curve's control points h x, h, one a basis function; or the one point */
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
    region_kernel *region_kernel; /* for this many points at a time; NULL: one by one */
    int lanes;
    /* The search's units: powers of two that bring the lattice and its weights to size 1, so that products of
       three derivatives stay in the range of doubles. x = (P - origin) scale. */
    double scale;
    double extent[3];   /* max |x_a| over the control points */
    double size[3];     /* max |P_a|, sizes as in the file */
    double volume_sign; /* of the lattice's signed volume: -1, 1 */
    double *points;     /* h x and h: BEZIER_COMPONENTS a control point */
    bool is_seam[3];    /* the first and the last face of this direction are one (ffd_lattice_is_seam) */
    collapse_list collapses;
    double *extraction[3];   /* of each span: order x order */
    span_scheme *schemes[3]; /* of each knot interval that is a span; NULL where there are too many */
    bounds *brick_hulls;
    box_tree brick_tree;
    _Atomic(cell_brick *) *made;              /* one for each brick */
    atomic_size_t light_leaves, heavy_leaves; /* kept so far */
} cell_search;

/* ffd_locator_tolerance and ffd_locator_aim in the search's units. */
static inline void ffd_cells_tolerance(const ffd_locator *locator, const cell_search *cells,
                                       const double x[3], double tolerance[3], double aim[3])
{
    for (int a = 0; a < 3; a++) {
        tolerance[a] = 16 * DBL_EPSILON * (cells->size[a] + fabs(x[a] + locator->origin[a] * cells->scale));
        aim[a] = 16 * DBL_EPSILON * (cells->extent[a] + fabs(x[a]));
        tolerance[a] = tolerance[a] > aim[a] ? tolerance[a] : aim[a]; /* but for a rounding it is */
    }
}

/* The triangular scheme of a span, which may be made in *own. */
const span_scheme *ffd_cells_scheme(const ffd_locator *locator, int a, int span, span_scheme *own);
/* h x, h of the control point that the basis functions with these numbers share. */
const double *ffd_cells_point(const ffd_locator *locator, const size_t function[3]);
/* Spans by numbers of non-empty spans. */
void ffd_cell_spans(const ffd_lattice *lattice, const size_t cell[3], int span[3]);

/* The Bezier form of a cell; box->coefficients has ffd_bezier_size doubles. cell counts non-empty spans. */
void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box);

/* The region of a part of a cell whose contraction is known; its centre is not set. */
void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result);

/* Evaluates the region's centre. */
void ffd_cells_centre(const ffd_locator *locator, cell_region *region);

/* Numbers of the control points of a cell, whatever the degrees. */
#define CELL_NUMBERS (MAX_ORDER * MAX_ORDER * MAX_ORDER * BEZIER_COMPONENTS)
/* Finds the rows of a cell's control points along u: in the lattice's array, or copied to own where a closed
   u wraps around. */
void ffd_cells_rows(const ffd_locator *locator, const int span[3], cell_rows rows, double own[CELL_NUMBERS]);

/* At u = t_span + offset. */
void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double offset[3],
                        homogeneous *result);

#endif
