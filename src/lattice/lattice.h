/* lattice.h - the struct behind ffd_lattice, and the evaluation of cells (public functions: ffd/lattice.h).
   Declares lattice.c and evaluate.c, and a function of file/file.c. */
#ifndef FFD_LATTICE_LATTICE_H
#define FFD_LATTICE_LATTICE_H

#include "spline/knots.h"
#include <ffd/lattice.h>

/* The greatest number of control points of a lattice (10^9 would need 24 GB for each array). */
#define FFD_MAX_CONTROL_POINTS ((size_t)1 << 26)

struct lattice_spec; /* the content of the file: spec.h */

/* The bounds of the meshes that a box goes round. */
typedef struct fit_extent {
    double min[3], max[3];             /* of all shapes: the base, morph targets, default weights */
    double shown_min[3], shown_max[3]; /* of the shape shown: "units": "mesh" counts in it */
} fit_extent;

typedef enum rest_form {
    REST_BOX_AFFINE, /* C(u,v,w) = origin + frame t, with t in [0,1]^3 the position in the domain; exact by
                        construction */
    REST_POINTS      /* general control points */
} rest_form;

/* Flags about the displacement of a control point. */
typedef enum point_move {
    POINT_MOVED = 1, /* the displacement is not 0, or the weight is moved */
    /* The next control point along u, v, w has the same displacement, other than 0, and neither weight is
       moved. */
    POINT_LIKE_NEXT_U = 2,
    POINT_LIKE_NEXT_V = 4,
    POINT_LIKE_NEXT_W = 8,
    POINT_LIKE_NEXT = POINT_LIKE_NEXT_U | POINT_LIKE_NEXT_V | POINT_LIKE_NEXT_W, /* mask of these three */
    /* The same holds for d+1 consecutive points along u, beginning here; for d+1 such rows along v; for d+1
       such planes along w, that is, for all control points of the cell whose first point this is. */
    POINT_BEGINS_ROW = 16,
    POINT_BEGINS_PLANE = 32,
    POINT_BEGINS_CELL = 64
} point_move;

/* What the drag that misses most misses of a place. */
typedef struct drag_miss {
    char pointer[48];   /* of the move, "/moves/3" */
    double miss, asked; /* lengths; both 0: all drags meet their places */
    double place[3];    /* at rest */
} drag_miss;

struct ffd_lattice {
    struct lattice_spec *spec; /* owned; kept for saving and for a later ffd_lattice_fit */
    knot_vector knots[3];
    size_t size[3];
    size_t count; /* size[0]*size[1]*size[2] */

    fit_extent fitted; /* of a box round a mesh */
    bool edited;       /* control points or weights were set after the spec's moves */
    drag_miss missed;  /* by the spec's moves */

    /* NULL until the lattice has control points (a box "mesh" gets them in ffd_lattice_fit). */
    double *rest;                            /* 3*count */
    double *deformed;                        /* 3*count */
    double *rest_weights, *deformed_weights; /* count numbers; NULL if all are 1: both or neither */
    bool weights_moved;                      /* the deformed weights are not those at rest times a factor */

    rest_form form;
    double origin[3];   /* REST_BOX_AFFINE: C at the lower corner of the domain */
    double frame[9];    /* REST_BOX_AFFINE: the sides of the box, in columns */
    double uvw_by_p[9]; /* REST_BOX_AFFINE without weights: the constant matrix d uvw_r / d p_c */
    bool has_uvw_by_p;  /* false if the box is too flat to invert, and for REST_POINTS */

    /* The displacements of the control points. They are stored separately from Q, because Q - P would lose
       their last digits: a displacement of 0.1 is exactly 0.1 here. */
    double *difference;   /* 3*count */
    unsigned char *moved; /* count flags of point_move */
    bool moves_alike;     /* some control point has a flag of POINT_LIKE_NEXT */
    double diagonal;      /* of the bounding box of the rest control points */
    double greatest[3];   /* magnitude of each coordinate of the control points, at rest and deformed */
};

/* As ffd_lattice_fit, which takes the bounds of one shape. */
ffd_status ffd_lattice_fit_extent(ffd_lattice *lattice, const fit_extent *extent, ffd_error *error);

/* Computes difference = Q - P from rest and deformed, which must exist. Errors: FFD_E_MEMORY. */
ffd_status ffd_lattice_make_difference(ffd_lattice *lattice, ffd_error *error);

/* Recomputes moved, moves_alike, weights_moved, diagonal and greatest from rest, deformed and difference.
   Errors: FFD_E_INVALID, with volume, i,j,k and value in the message, for control points and weights that are
   not finite, weights that are not positive, and magnitudes whose differences, or products with weights,
   overflow; FFD_E_MEMORY. */
ffd_status ffd_lattice_finish_moved(ffd_lattice *lattice, ffd_error *error);
/* Whether no control point is moved. Of a box that is not laid round a mesh yet only offsets count. */
bool ffd_lattice_is_still(const ffd_lattice *lattice);

/* The basis functions that are not 0 at one u,v,w: d+1 in each direction. */
typedef struct lattice_basis {
    int span[3];
    double value[3][MAX_ORDER], derivative[3][MAX_ORDER];
} lattice_basis;

/* Evaluates the basis functions. uvw must be in the domain (ffd_knots_wrap). */
void ffd_lattice_basis(const ffd_lattice *lattice, const double uvw[3], lattice_basis *basis);

/* Sums field * R over the control points of the basis, in ascending index, u innermost. field: 3 numbers for
   each control point. weights: the h of all control points, R = h N N N / sum h N N N; NULL: R = N N N.
   derivative: 9 numbers, row-major, with respect to u,v,w, with weights by the quotient rule (NURBS Book
   4.4); may be NULL. */
void ffd_lattice_sum_rational(const ffd_lattice *lattice, const lattice_basis *basis, const double *field,
                              const double *weights, double value[3], double derivative[9]);

/* Copies the (d_u+1)(d_v+1)(d_w+1) control points of the cell of a span, u fastest. Its basis functions begin
   at span[a] - degree[a]. */
void ffd_lattice_cell_points(const ffd_lattice *lattice, const double *field, const int span[3],
                             double *points);
/* The same from the control point of function first[a] on, count[a] <= MAX_ORDER along each direction. */
void ffd_lattice_block_points(const ffd_lattice *lattice, const double *field, const size_t first[3],
                              const size_t count[3], double *points);
/* The same as ffd_lattice_cell_points for weights; does nothing if weights is NULL. */
void ffd_lattice_cell_weights(const ffd_lattice *lattice, const double *weights, const int span[3],
                              double *cell_weights);

#endif
