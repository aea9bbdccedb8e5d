/* view_cages.h - the lines and points of a picture beside its mesh's triangles: control lattices on their
   way, lines and points of the mesh, torn edges, the witness of a fold. */
#ifndef FFD_VIEW_VIEW_CAGES_H
#define FFD_VIEW_VIEW_CAGES_H

#include "picture/picture.h"
#include "view/view_scene.h"

/* All zeros: none. */
typedef struct view_cages {
    picture_cage *list;
    size_t count;
    void **owned; /* what they lend */
    size_t owned_count;
    size_t left_out; /* lattices */
} view_cages;

/* Control points of a panel: more would hide all else. */
#define VIEW_PICTURE_CONTROLS 125000

/* Whether the control points of a lattice fit in what is left of those that are drawn. count: the points; 0
   where they do not fit. */
bool ffd_view_cage_fits(const view_cage *cage, size_t left, size_t *count);

/* Makes them when the scene has gone this share of its way, and its vertices are at positions. height: of the
   picture, in pixels. most: control points that are drawn; lattices beyond it are left out. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_view_cages_make(const view_scene *scene, double share, const double *positions,
                               uint32_t height, size_t most, view_cages *cages, ffd_error *error);
/* Frees them; leaves none. */
void ffd_view_cages_free(view_cages *cages);

#endif
