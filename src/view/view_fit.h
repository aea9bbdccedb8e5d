/* view_fit.h - the region of a scene that a picture shows: the whole mesh before and after, and as much of
   the lattices as leaves the mesh large enough to look at. */
#ifndef FFD_VIEW_VIEW_FIT_H
#define FFD_VIEW_VIEW_FIT_H

#include "picture/camera.h"
#include "view/view_frame.h"
#include "view/view_scene.h"

typedef struct view_fit {
    const view_scene *scene;
    const uint8_t *framed; /* of each vertex: whether it has to be seen; NULL: all have */
    const double *ground;  /* its corners (view_cages.h); NULL: none */
    const camera *camera;
    size_t most; /* control points that may be drawn (view_cages.h) */
} view_fit;

/* Extends a frame by the mesh, and by the lattices. */
void ffd_view_fit(const view_fit *fit, view_frame *frame);
/* Returns the distance that view_frame.away has. */
double ffd_view_away(const view_fit *fit);
/* Returns the bounds along the camera's axes that a picture with this frame shows. */
ffd_bounds ffd_view_seen(const view_frame *frame);
/* *points: the number of control points drawn; *beyond: how many of them lie outside of the bounds, at rest
   or deformed. */
void ffd_view_count_beyond(const view_fit *fit, const ffd_bounds *seen, size_t *points, size_t *beyond);

#endif
