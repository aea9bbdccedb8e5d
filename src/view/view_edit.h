/* view_edit.h - what the page of `ffd edit` needs beside a scene: the lattice that is edited, and the points
   that it moves. */
#ifndef FFD_VIEW_VIEW_EDIT_H
#define FFD_VIEW_VIEW_EDIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How the lattice moves a point. */
typedef enum edit_kind {
    EDIT_INSIDE = 0, /* by its u,v,w */
    EDIT_EXTENDED,   /* as the nearest point of the border, whose u,v,w it has, and fading */
    EDIT_STAYS       /* not at all */
} edit_kind;

/* Numbers that say how a point that is extended follows the nearest point of the border: the row-major
   derivative of u,v,w by the position (9), the fade, by which the displacement there is multiplied, and its
   derivative by the position (3). */
#define EDIT_WAY 13

/* Points: first all vertices of the scene, then those of morph targets. */
typedef struct edit_points {
    size_t count, vertices;
    double *start;     /* 3 each: where the lattices before the edited one take it */
    double *uvw;       /* 3 each; NaN: none. Of EDIT_STAYS: of what would move it, for torn edges */
    uint8_t *kinds;    /* edit_kind of each */
    double *ways;      /* EDIT_WAY each; NULL: no point is extended */
    double *factors;   /* the shown position of a vertex is the sum of its points times their factors */
    uint32_t *owners;  /* of the points behind the vertices: their vertices */
    double *gradients; /* 9 of each vertex: F - I of the lattices before; NULL: there are none */
} edit_points;

typedef struct view_edit {
    size_t cage; /* of the scene: the lattice that is edited */
    int degree[3];
    size_t knot_count[3];
    double *knots[3];
    double *offsets;                    /* 3 for each control point */
    double *weights, *deformed_weights; /* of each control point; NULL: all are 1 */
    char *file;                         /* text of the lattice file: JSON, whose moves the offsets replace */
    char *name, *comment;               /* as JSON, of that file; NULL: none */
    bool is_new;                        /* no file: it was laid round the mesh */
    bool has_moves;                     /* the file has moves or keys */
    char key[66];                       /* names the mesh and the rest lattice */
    bool extends;                       /* points outside are moved */
    edit_points points;
} view_edit;

/* Frees what it owns, and the structure; NULL is allowed. */
void ffd_view_edit_free(view_edit *edit);

#endif
