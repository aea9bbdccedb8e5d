/* view_fit.h - the region of a scene that a picture shows: the whole mesh before and after, and as much of
   the lattices as leaves the mesh large enough to look at. */
#ifndef FFD_VIEW_VIEW_FIT_H
#define FFD_VIEW_VIEW_FIT_H

#include "picture/camera.h"
#include "view/view_scene.h"

typedef struct view_fit {
    const view_scene *scene;
    const uint8_t *framed; /* of each vertex: whether it has to be seen; NULL: all have */
    const double *ground;  /* its corners (view_cages.h); NULL: none */
    const camera *camera;
    size_t most; /* control points that may be drawn (view_cages.h) */
} view_fit;

/* Fills seen with the bounds along the camera's axes. *points: the number of control points drawn; *beyond:
   how many of them lie outside of the bounds, at rest or deformed. */
void ffd_view_fit(const view_fit *fit, ffd_bounds *seen, size_t *points, size_t *beyond);

#endif
