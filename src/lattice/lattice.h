/* lattice.h - what a control lattice is made of (public: ffd/lattice.h). Declares
   lattice.c and evaluate.c. */
#ifndef FFD_LATTICE_LATTICE_H
#define FFD_LATTICE_LATTICE_H

#include "spline/knots.h"
#include <ffd/lattice.h>

/* Most control points that a lattice may have (1e9 would be 24 GB a copy). */
#define FFD_MAX_CONTROL_POINTS ((size_t)1 << 26)

struct lattice_spec; /* what the file says: spec.h */

typedef enum rest_form {
    REST_BOX_AFFINE, /* C(u,v,w) = origin + frame t, t = parameter in [0,1] of the domain:
                        exact by construction */
    REST_POINTS      /* nothing is known beyond the control points */
} rest_form;

/* What is known of the displacement of a control point. */
typedef enum point_move {
    POINT_MOVED = 1, /* it is not 0, or the weight moved */
    /* The next control point along u, v, w has the same one, other than 0, and neither weight moved. */
    POINT_LIKE_NEXT_U = 2,
    POINT_LIKE_NEXT_V = 4,
    POINT_LIKE_NEXT_W = 8,
    POINT_LIKE_NEXT = POINT_LIKE_NEXT_U | POINT_LIKE_NEXT_V | POINT_LIKE_NEXT_W, /* any of these */
    /* So have the d+1 points from here on along u; of as many such rows along v; of as many such planes along
       w: all that act in the cell whose first point this is. */
    POINT_BEGINS_ROW = 16,
    POINT_BEGINS_PLANE = 32,
    POINT_BEGINS_CELL = 64
} point_move;

struct ffd_lattice {
    struct lattice_spec *spec; /* owned; kept for saving and for a later ffd_lattice_fit */
    knot_vector knots[3];
    size_t size[3];
    size_t count; /* size[0]*size[1]*size[2] */

    double fitted_min[3], fitted_max[3]; /* of a box round a mesh: the mesh's bounds */
    bool edited;                         /* control points or weights were set after the spec's moves */

    /* NULL until built (a "mesh" box is built when it is fitted to its mesh). */
    double *rest;                            /* 3*count */
    double *deformed;                        /* 3*count */
    double *rest_weights, *deformed_weights; /* count, or NULL where all are 1; both or neither */
    bool weights_moved;                      /* some deformed weight differs from its rest weight */

    rest_form form;
    double origin[3];   /* REST_BOX_AFFINE: C at the domain's lower corner */
    double frame[9];    /* REST_BOX_AFFINE: columns are the box's sides */
    double uvw_by_p[9]; /* REST_BOX_AFFINE without weights: d uvw_r / d p_c, the same everywhere */
    bool has_uvw_by_p;  /* false where the box is too flat for it, and in the other form */

    /* The displacement of the control points, made when the lattice is built. It is carried beside Q, which
       would lose its last digits: what moves by 0.1 has exactly that here. */
    double *difference;   /* 3*count */
    unsigned char *moved; /* per control point: bits of point_move */
    bool moves_alike;     /* some control point has a bit that says it moves like the next one */
    double diagonal;      /* of the bounds of the rest control points */
};

/* Makes difference, Q - P, from rest and deformed (both must be there). Errors: FFD_E_MEMORY. */
ffd_status ffd_lattice_make_difference(ffd_lattice *lattice, ffd_error *error);

/* Makes moved, moves_alike, weights_moved, diagonal anew from rest, deformed and difference. Refuses
   control points and weights that are not finite, weights that are not positive, and sizes whose differences,
   or products of weight and coordinate, overflow; the message names volume, i,j,k and value. Errors:
   FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_lattice_finish_moved(ffd_lattice *lattice, ffd_error *error);

/* The (d_u+1)(d_v+1)(d_w+1) basis functions that are not 0 at one u,v,w, per direction. */
typedef struct lattice_basis {
    int span[3];
    double value[3][MAX_ORDER], derivative[3][MAX_ORDER];
} lattice_basis;

/* uvw must be in the domain (ffd_knots_wrap). */
void ffd_lattice_basis(const ffd_lattice *lattice, const double uvw[3], lattice_basis *basis);

/* sum over the basis' control points of field[3] * R, ascending index, u innermost: R = h N N N / sum h N N N
   with these weights h (count), R = N N N where they are NULL. derivative (9, row by row, may be NULL) is by
   u,v,w, with weights by the quotient rule (NURBS Book 4.4). */
void ffd_lattice_sum_rational(const ffd_lattice *lattice, const lattice_basis *basis, const double *field,
                              const double *weights, double value[3], double derivative[9]);

/* Copies the control points (and, where rational, weights; else weights is not touched) of the cell whose
   basis functions start at first[a] = span[a] - degree[a], u fastest: (d_u+1)(d_v+1)(d_w+1) points. */
void ffd_lattice_cell_points(const ffd_lattice *lattice, const double *field, const int span[3],
                             double *points);
/* The same for the weights alone. */
void ffd_lattice_cell_weights(const ffd_lattice *lattice, const double *weights, const int span[3],
                              double *cell_weights);

#endif
