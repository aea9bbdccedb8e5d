/* boundary_faces.h - the parts of a boundary: the faces of the domain, their cells, a tree over them. Main
   header of the search on the border: declares boundary_faces.c, boundary_box.c, boundary_cell.c,
   boundary_search.c and boundary_settle.c. */
#ifndef FFD_EMBED_BOUNDARY_BOUNDARY_FACES_H
#define FFD_EMBED_BOUNDARY_BOUNDARY_FACES_H

#include "embed/boundary/patch.h"
#include "lattice/border.h"
#include "lattice/lattice.h"
#include <stdbool.h>
#include <stdint.h>

#define MOST_FACES 6

typedef struct boundary_face {
    border_face sums;
    double *points;     /* control points in the search's units; NULL if there are too many to store */
    int direction, end; /* the face at the first u has direction 0 and end 0 */
    int along[2];       /* the other two directions, s and t of the patches */
    size_t cells[2];    /* number of non-empty spans along them */
    uint32_t root;
} boundary_face;

/* A rectangle of cells of a face or, if patch is not NULL, one cell or a part of it. */
typedef struct boundary_node {
    bounds box;
    uint32_t child; /* inner node: index of the first child, the second one follows; leaf: 0 */
    int face;
    uint32_t cell[2], cells[2];
    const face_patch *patch; /* leaf: its stored patch; NULL: each search makes the patches of this leaf */
} boundary_node;

typedef struct boundary {
    const ffd_lattice *lattice;
    /* The search's units: powers of two that scale the lattice and its weights to size 1. x = (P - origin) *
       scale. */
    double origin[3], scale, weight_scale;
    double frame[9]; /* REST_BOX_AFFINE: sides of the box in these units, in columns; the members below are
                        then unused */
    boundary_face faces[MOST_FACES];
    int face_count;
    boundary_node *nodes;
    size_t node_count, node_capacity;
    face_patch *patches; /* list of the stored patches */
} boundary;

/* Divides the border into patches and builds the tree. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_build(boundary *border, ffd_error *error);
/* Makes the patch of a whole cell of a face, not measured yet. */
void ffd_boundary_patch(const boundary *border, int face, const size_t cell[2], face_patch *made);
/* Frees a list of patches. */
void ffd_boundary_free_patches(face_patch *list);

static inline const knot_vector *boundary_knots(const boundary *border, int face, int f)
{
    return &border->lattice->knots[border->faces[face].along[f]];
}

/* The point of a query in the search's units; `unit` is the length of a unit in the world. A point that is
   too far away is replaced by a nearer one in the same direction, and unit is increased. */
typedef struct boundary_query {
    double x[3], length; /* |x| */
    double unit;
} boundary_query;

/* The result of a search. */
typedef struct boundary_foot {
    double uvw[3];
    double residual[3]; /* x - C, in the search's units */
    int free[2];        /* the free coordinates, which follow x, */
    int free_count;     /* their number, */
    double by_x[2][3];  /* and their derivatives by x */
    bool cut_short;     /* the search stopped at its limit */
} boundary_foot;

/* Finds the nearest border point of a box (REST_BOX_AFFINE). */
void ffd_boundary_box_find(const boundary *border, const boundary_query *query, boundary_foot *foot);

/* Finds the nearest point of a border that consists of patches. *found is true only if its distance is at
   most reach (in the search's units); otherwise only foot->cut_short is set. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_search(const boundary *border, const boundary_query *query, double reach, bool *found,
                               boundary_foot *foot, ffd_error *error);

/* Decides whether the border meets a cell, given in the search's units. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_view_cell(const boundary *border, const patch_cell *cell, patch_view *view,
                                  ffd_error *error);

/* A point on the border: a cell of a face, and t in [0,1]^2 in that cell. */
typedef struct boundary_location {
    int face;
    size_t cell[2];
    double t[2];
} boundary_location;

/* Computes u,v,w of a point on the border, in the range of the knots. */
void ffd_boundary_uvw(const boundary *border, const boundary_location *location, double uvw[3]);
/* Returns whether a comes before b in the lexicographic order of (u,v,w); coordinates within 1e-9 of the
   domain are equal. */
bool ffd_boundary_before(const boundary *border, const double a[3], const double b[3]);

/* Moves a point to a nearby point of the border where the distance is stationary, and computes its derivative
   by x. scratch: a patch of MAX_ORDER by MAX_ORDER points. */
void ffd_boundary_settle(const boundary *border, const double x[3], const boundary_location *location,
                         face_patch *scratch, boundary_foot *foot);

#endif
