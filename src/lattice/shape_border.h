/* shape_border.h - compares the border of a volume with that of the box or the cylinder it was made for. */
#ifndef FFD_LATTICE_SHAPE_BORDER_H
#define FFD_LATTICE_SHAPE_BORDER_H

#include "lattice/lattice.h"

/* Returns how far the border of the volume at rest is off that of its box or cylinder, at most, in world
   units: weights pull the border away from it where knots are not clamped, and round a cylinder where they
   are no product f(u,w) g(v) (cylinder.c). Planes are compared by control points, so that 0 is certain for a
   box; radii at samples, and only where the volume ends short of them. 0 for rounding, without weights, for
   points from a file, and for a lattice without control points. */
double ffd_lattice_off_shape(const ffd_lattice *lattice);

#endif
