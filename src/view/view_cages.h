/* view_cages.h - the lines that a picture shows beside the mesh's triangles: the ground, control lattices,
   segments of the mesh, torn edges; and the witness of a fold. */
#ifndef FFD_VIEW_VIEW_CAGES_H
#define FFD_VIEW_VIEW_CAGES_H

#include "picture/picture.h"
#include "view/view_scene.h"

/* All zeros: none. */
typedef struct view_cages {
    picture_cage *list;
    size_t count;
    void **owned; /* arrays that list refers to */
    size_t owned_count;
    size_t left_out; /* lattices that are not drawn */
} view_cages;

/* The most control points in a panel: more would hide everything else. */
#define VIEW_PICTURE_CONTROLS 125000

/* Whether a lattice's control points fit into left, the number that may still be drawn. *count: the number of
   its points; 0 if they do not fit. */
bool ffd_view_cage_fits(const view_cage *cage, size_t left, size_t *count);

#define GROUND_CORNERS 4

/* What is drawn, and how. All arrays are lent. */
typedef struct view_cages_desc {
    const view_scene *scene;
    double share;            /* of the way from before (0) to after (1) */
    const double *positions; /* of the scene's vertices at that share */
    const uint8_t *colors;   /* of these, for segments, as picture_cage.colors; NULL: all have one colour */
    const double *ground;    /* its corners, 3 numbers each; NULL: none is drawn */
    uint32_t height;         /* of the picture in pixels, for the widths of lines */
    size_t most;             /* control points that may be drawn */
} view_cages_desc;

/* Fills cages. Lattices that do not fit are left out and counted. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_cages_make(const view_cages_desc *of, view_cages *cages, ffd_error *error);
/* Frees the arrays; leaves all zeros. */
void ffd_view_cages_free(view_cages *cages);

#endif
