/* displacement_cell.h - what of a lattice displaces the points of one cell. */
#ifndef FFD_DEFORM_DISPLACEMENT_CELL_H
#define FFD_DEFORM_DISPLACEMENT_CELL_H

#include "deform/kernel.h"
#include "lattice/lattice.h"

/* Whether a moved control point acts in the cell whose last knot intervals are span. */
bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3]);

/* What is wanted of a cell's points. */
typedef enum cell_use {
    CELL_VALUES,   /* displacements */
    CELL_BY_UVW,   /* and their derivatives by u,v,w */
    CELL_GRADIENTS /* and those by the point, for which the rest points are needed where there is no inverse
                      for all */
} cell_use;

/* Numbers that the kernel's fields take in a cell of the lattice. */
size_t ffd_displacement_cell_numbers(const ffd_lattice *lattice, cell_use use);
/* Finds them, and one more for the kernel's use, for the cell with these non-empty spans. Returns whether a
   moved control point acts in it; else nothing is written. */
bool ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                  const size_t number[3], cell_use use, double *numbers);
/* The cell itself, with these numbers. */
void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t number[3], cell_use use,
                                 const double *numbers, kernel_cell *cell);

/* u,v,w within the periods of closed directions. */
void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3]);

/* From derivatives by u,v,w to those by the point: times the Jacobian's inverse; 0 where it has none. */
void ffd_displacement_to_space(const double jacobian[9], double gradient[9]);

#endif
