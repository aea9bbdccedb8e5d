/* rest_box.h - whether given control points are those of a box. */
#ifndef FFD_FOLD_AFFINE_REST_BOX_H
#define FFD_FOLD_AFFINE_REST_BOX_H

#include "fold/affine/scaled_points.h"

/* Returns whether the control points at rest are a grid with straight edges, in no closed direction, and
   farther apart than their rounding. */
bool ffd_rest_is_box(const scaled_points *points);

#endif
