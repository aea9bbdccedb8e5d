/* extension.h - the displacement of points outside a lattice with `--outside extend`. */
#ifndef FFD_DEFORM_EXTENSION_H
#define FFD_DEFORM_EXTENSION_H

#include "embed/boundary/boundary.h"

/* Returns the factor of the displacement at a distance (>= 0) from the border: w(s) = 1 - 10 s^3 + 15 s^4 - 6
   s^5 with s = distance/falloff, and 0 for s >= 1. First and second derivatives are 0 at both ends. A falloff
   of 0 gives 1 everywhere. slope: receives dw/d distance; may be NULL. */
double ffd_extension_fade(double distance, double falloff, double *slope);

/* Computes the displacement of a point outside from the nearest border point: the displacement there,
   multiplied by the fade.
     delta[3]    w(distance) delta(u,v,w), world units
     gradient[9] row by row, d delta_r / d p_c = w D (d uvw / d p) + w' delta(u,v,w) direction^T, D being the
                 derivative of delta by u,v,w. May be NULL.
   Returns 1; or 0, with zeros, if no moved control point acts at that border point or the distance is at
   least falloff. Thread-safe. */
int ffd_extension_displacement(const ffd_lattice *lattice, const boundary_point *nearest, double falloff,
                               double delta[3], double gradient[9]);

#endif
