/* ring.h - a full or partial turn: a planar B-spline curve round the origin with control points on the unit
   circle, and bounds of its distance from the origin. */
#ifndef FFD_LATTICE_RING_H
#define FFD_LATTICE_RING_H

#include "base/fail.h"
#include "spline/knots.h"

typedef struct ring_point {
    double x, y; /* on the unit circle */
    double weight;
} ring_point;

/* Places knots->points control points, whose weights are given, so that the curve starts at angle first and
   ends at angle last, in degrees; a closed curve makes one turn from first. Errors: FFD_E_INVALID (too few
   control points). */
ffd_status ffd_ring_rotate(const knot_vector *knots, double first, double last, bool full_turn,
                           ring_point *points, ffd_error *error);

/* Computes bounds of the distance of the curve from the origin over the domain: least <= |C(v)| <= greatest,
   up to rounding. Both are sharp within 1e-10. */
void ffd_ring_radius(const knot_vector *knots, const ring_point *points, double *least, double *greatest);

#endif
