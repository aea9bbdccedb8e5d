/* extension.h - the displacement of points outside a lattice that `--outside extend` gives them. */
#ifndef FFD_DEFORM_EXTENSION_H
#define FFD_DEFORM_EXTENSION_H

#include "embed/boundary/boundary.h"

/* How much of the displacement is left at a distance (>= 0) from the border: w(s) = 1 - 10 s^3 + 15 s^4 - 6
   s^5 with s = distance/falloff, 0 from s = 1 on. 1 and 0 are reached with first and second derivative 0. A
   falloff of 0 is none: 1 everywhere. slope: dw/d distance, or NULL. */
double ffd_extension_fade(double distance, double falloff, double *slope);

/* The displacement of a point whose nearest point of the border was found: that of the border there, faded.
     delta[3]    w(distance) delta(u,v,w), world units
     gradient[9] row by row, d delta_r / d p_c = w D (d uvw / d p) + w' delta(u,v,w) direction^T, D being the
                 derivative of delta by u,v,w. May be NULL.
   Returns 0, with exact zeros, where no moved control point acts on the border there, and from the distance
   falloff on; else 1. Thread-safe. */
int ffd_extension_displacement(const ffd_lattice *lattice, const boundary_point *nearest, double falloff,
                               double delta[3], double gradient[9]);

#endif
