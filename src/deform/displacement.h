/* displacement.h - the displacement by the lattice's own parameters (public: ffd/deform.h). */
#ifndef FFD_DEFORM_DISPLACEMENT_H
#define FFD_DEFORM_DISPLACEMENT_H

#include "lattice/lattice.h"
#include <ffd/deform.h>

/* The displacement at u,v,w as ffd_displacement gives it, and by_uvw[3*r+c] = d delta_r / d uvw_c: right-hand
   at an inner knot, left-hand at the end of the domain. Returns as ffd_displacement. */
int ffd_displacement_by_uvw(const ffd_lattice *lattice, const double uvw[3], double delta[3],
                            double by_uvw[9]);

#endif
