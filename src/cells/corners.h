/* corners.h - the corners of tetrahedra, pyramids, wedges and hexahedra: the Jacobian there, and the scaled
   Jacobian, as Verdict defines both (Stimpson and others, The Verdict Geometric Quality Library,
   SAND2007-1751; vtkMeshQuality). */
#ifndef FFD_CELLS_CORNERS_H
#define FFD_CELLS_CORNERS_H

#include "cells/cell_types.h"
#include "cells/jacobian_signs.h"

/* Adds the signs of the Jacobian at the corners, which are exact. points: the corners of a cell of the
   family. */
void ffd_corner_signs(cell_family family, const double (*points)[3], jacobian_signs *signs);

/* Returns the scaled Jacobian of the corners: the least determinant of the unit vectors along the edges of a
   corner, divided by that of the ideal cell. Of a tetrahedron it is relative to the longest edges of any
   corner, a pyramid has four of these, and a hexahedron has its axes, too. A corner with an edge of no length
   has 0, and so has an inverted pyramid. */
double ffd_corners_scaled(cell_family family, const double (*points)[3]);

#endif
