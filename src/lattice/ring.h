/* ring.h - a closed or partial turn: a planar B-spline curve round the origin from control points on the unit
   circle, and how far it stays from the origin. */
#ifndef FFD_LATTICE_RING_H
#define FFD_LATTICE_RING_H

#include "base/fail.h"
#include "spline/knots.h"

typedef struct ring_point {
    double x, y; /* on the unit circle */
    double weight;
} ring_point;

/* Turns control points (knots->points of them; weights are given) so that the curve starts at angle first and
   ends at angle last (degrees; a closed curve goes round once from first). FFD_E_INVALID where there are too
   few of them. */
ffd_status ffd_ring_rotate(const knot_vector *knots, double first, double last, bool full_turn,
                           ring_point *points, ffd_error *error);

/* Bounds of the curve's distance from the origin over the whole domain: least <= |C(v)| <= greatest, up to
   rounding, each within 1e-10 of being met. */
void ffd_ring_radius(const knot_vector *knots, const ring_point *points, double *least, double *greatest);

#endif
