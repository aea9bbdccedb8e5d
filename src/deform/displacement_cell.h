/* displacement_cell.h - what of a lattice displaces the points of one cell. */
#ifndef FFD_DEFORM_DISPLACEMENT_CELL_H
#define FFD_DEFORM_DISPLACEMENT_CELL_H

#include "deform/kernel.h"
#include "lattice/lattice.h"

/* Whether a moved control point acts in the cell whose last knot intervals are span. */
bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3]);

/* Fills the cell with these non-empty spans, for displacements alone or with gradients, and the buffers that
   it points to (3 * CELL_POINTS each). Returns whether a moved control point acts in it. */
bool ffd_displacement_load(const ffd_lattice *lattice, const size_t number[3], bool gradients,
                           double *difference, double *rest, kernel_cell *cell);

/* u,v,w within the periods of closed directions. */
void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3]);

/* From derivatives by u,v,w to those by the point: times the Jacobian's inverse; 0 where it has none. */
void ffd_displacement_to_space(const double jacobian[9], double gradient[9]);

#endif
