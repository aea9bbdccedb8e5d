/* view_cages.h - the lines and points that a picture shows beside the mesh's triangles: control lattices,
   segments and points of the mesh, torn edges, the witness of a fold. */
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

/* Fills cages for the scene at a share of the way from before (0) to after (1). positions: of the scene's
   vertices at that share, lent. height: of the picture in pixels, for the widths of lines. most: control
   points that may be drawn; lattices that do not fit are left out and counted. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_cages_make(const view_scene *scene, double share, const double *positions,
                               uint32_t height, size_t most, view_cages *cages, ffd_error *error);
/* Frees the arrays; leaves all zeros. */
void ffd_view_cages_free(view_cages *cages);

#endif
