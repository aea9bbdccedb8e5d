/* collapse.h - tells where a displacement collapses space: det F is 0 within the rounding of F. */
#ifndef FFD_DEFORM_COLLAPSE_H
#define FFD_DEFORM_COLLAPSE_H

#include "lattice/lattice.h"

/* Returns a bound of the rounding error of a coordinate's derivative by one of u,v,w. scale: degree / width
   of the cell, or the largest factor of the steps between control points. */
double ffd_slope_rounding(const ffd_lattice *lattice, int coordinate, double scale);

/* Returns by how much the determinant of m can change where each entry changes by at most that of radius. */
double ffd_determinant_change(const double m[9], const double radius[9]);

/* Whether a lattice collapses space at u,v,w, or at a point outside that moves like u,v,w. gradient: F - I.
   uvw_by_p: d uvw / d p; NULL: that of the lattice. falloff: the distance over which the displacement fades;
   0: it does not. */
bool ffd_collapses(const ffd_lattice *lattice, const double uvw[3], const double *uvw_by_p, double falloff,
                   const double gradient[9]);

#endif
