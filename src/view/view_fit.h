/* view_fit.h - what of a scene a picture shows: the mesh before and after as a whole, and of the lattices as
   much as leaves the mesh large enough to be looked at. */
#ifndef FFD_VIEW_VIEW_FIT_H
#define FFD_VIEW_VIEW_FIT_H

#include "picture/camera.h"
#include "view/view_scene.h"

typedef struct view_fit {
    const view_scene *scene;
    const uint8_t *used; /* one a vertex: something is drawn of it; NULL: of all */
    const camera *camera;
    size_t most; /* control points that are drawn (view_cages.h) */
} view_fit;

/* Fills the bounds along the camera's axes. points: the control points that are drawn; beyond: those that are
   outside of the bounds, at rest or deformed. */
void ffd_view_fit(const view_fit *fit, ffd_bounds *seen, size_t *points, size_t *beyond);

#endif
