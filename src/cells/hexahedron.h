/* hexahedron.h - the Jacobian of trilinear hexahedra, by its Bezier coefficients. */
#ifndef FFD_CELLS_HEXAHEDRON_H
#define FFD_CELLS_HEXAHEDRON_H

#include "cells/jacobian_signs.h"

/* Decides the sign of the Jacobian everywhere in a hexahedron of 8 points in VTK's order. It lies between the
   least and the greatest of 27 coefficients, of which 8 are the Jacobians at the corners. Not decided are
   cells whose corners have one sign, and some coefficient has another or is closer to 0 than rounding, but no
   Gauss point has. *least: that of corners and Gauss points. */
jacobian_state ffd_hexahedron_state(const double (*points)[3], double *least);

#endif
