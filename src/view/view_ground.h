/* view_ground.h - the ground that a picture draws: a rectangle round the mesh at rest, as high as its lowest
 * point. */
#ifndef FFD_VIEW_VIEW_GROUND_H
#define FFD_VIEW_VIEW_GROUND_H

#include "view/view_cages.h"

/* Fills the corners of the ground, 3 numbers each. framed: of each vertex whether it counts; NULL: all do.
   Returns false if the mesh is not wide enough to have one. */
bool ffd_view_ground(const view_scene *scene, const uint8_t *framed, ffd_up up,
                     double corners[3 * GROUND_CORNERS]);

#endif
