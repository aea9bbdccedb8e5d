/* boundary_faces.h - what a boundary is made of: the faces of the domain, their cells, a tree over them.
   Main header of the search on the border: declares boundary_faces.c, boundary_box.c, boundary_cell.c,
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
    double *points;     /* the control points in the search's units; NULL where there are too many to keep */
    int direction, end; /* u = first is direction 0, end 0 */
    int along[2];       /* the other two directions: s and t of its patches */
    size_t cells[2];    /* non-empty spans along them */
    uint32_t root;
} boundary_face;

/* A rectangle of cells of a face, or (patch is there) one cell or a part of it. */
typedef struct boundary_node {
    bounds box;
    uint32_t child; /* inner node: its first child, the second follows; leaf: 0 */
    int face;
    uint32_t cell[2], cells[2];
    const face_patch *patch; /* leaf: kept, or NULL: made by each search that comes to it */
} boundary_node;

typedef struct boundary {
    const ffd_lattice *lattice;
    /* The search's units: powers of two that bring the lattice and its weights to size 1.
       x = (P - origin) scale. */
    double origin[3], scale, weight_scale;
    double frame[9]; /* REST_BOX_AFFINE: the box's sides in these units (columns), and nothing below */
    boundary_face faces[MOST_FACES];
    int face_count;
    boundary_node *nodes;
    size_t node_count, node_capacity;
    face_patch *patches; /* the kept ones, a list */
} boundary;

/* Cuts the border into patches and makes the tree. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_build(boundary *border, ffd_error *error);
/* The whole cell of the face as a patch (of the face's orders), not yet measured. */
void ffd_boundary_patch(const boundary *border, int face, const size_t cell[2], face_patch *made);
/* Frees a list of patches. */
void ffd_boundary_free_patches(face_patch *list);

static inline const knot_vector *boundary_knots(const boundary *border, int face, int f)
{
    return &border->lattice->knots[border->faces[face].along[f]];
}

/* A point in the search's units. One of these is `unit` long in the world; a point farther than they reach is
   replaced by a nearer one in the same direction, and unit grows. */
typedef struct boundary_query {
    double x[3], length; /* |x| */
    double unit;
} boundary_query;

/* Where a search ended. */
typedef struct boundary_foot {
    double uvw[3];
    double residual[3]; /* x - C, in the search's units */
    int free[2];        /* the coordinates that follow x, */
    int free_count;     /* so many of them, */
    double by_x[2][3];  /* and how */
    bool cut_short;     /* the search ended at its limit */
} boundary_foot;

/* Finds the nearest point of a box (REST_BOX_AFFINE). */
void ffd_boundary_box_find(const boundary *border, const boundary_query *query, boundary_foot *foot);

/* Finds the nearest point of a border of patches. Sets *found only if the border is no farther than reach (in
   the search's units); else of the foot only cut_short is set. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_search(const boundary *border, const boundary_query *query, double reach, bool *found,
                               boundary_foot *foot, ffd_error *error);

/* What is known of the border and a cell, whose numbers are in the search's units. Errors: FFD_E_MEMORY. */
ffd_status ffd_boundary_view_cell(const boundary *border, const patch_cell *cell, patch_view *view,
                                  ffd_error *error);

/* A point on the border: a cell of a face and t in [0,1]^2 of it. */
typedef struct boundary_location {
    int face;
    size_t cell[2];
    double t[2];
} boundary_location;

/* u,v,w of a point on the border, in the knots' range. */
void ffd_boundary_uvw(const boundary *border, const boundary_location *location, double uvw[3]);
/* Whether a comes before b by (u,v,w); coordinates within 1e-9 of the domain are equal. */
bool ffd_boundary_before(const boundary *border, const double a[3], const double b[3]);

/* Moves the point to where the distance is stationary on the border around it, and finds
   how it follows x. scratch is a patch of MAX_ORDER by MAX_ORDER points. */
void ffd_boundary_settle(const boundary *border, const double x[3], const boundary_location *location,
                         face_patch *scratch, boundary_foot *foot);

#endif
