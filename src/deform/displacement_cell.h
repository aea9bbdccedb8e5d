/* displacement_cell.h - what of a lattice displaces the points of one cell. */
#ifndef FFD_DEFORM_DISPLACEMENT_CELL_H
#define FFD_DEFORM_DISPLACEMENT_CELL_H

#include "deform/kernel.h"
#include "lattice/lattice.h"

/* Whether a moved control point acts in the cell whose last knot intervals are span. */
bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3]);

/* The displacement that all control points which act at u,v,w have, where it is one and the same and no
   weight of theirs moved; else NULL, as for 0. Where u,v,w is on a knot fewer of them act than elsewhere in
   the cell. uvw NULL: what those have that act anywhere in it. Lent by the lattice. */
const double *ffd_displacement_shared(const ffd_lattice *lattice, const int span[3], const double *uvw);

typedef enum motion_kind {
    CELL_STILL,   /* no moved control point acts in it */
    CELL_SHIFTED, /* all by the same displacement, which ffd_displacement_shared tells */
    CELL_BENT
} motion_kind;

/* How the points of a cell move. */
typedef struct cell_motion {
    uint8_t kind;  /* motion_kind */
    uint8_t knots; /* of a bent one: for points on these of its knots ffd_displacement_shared has to be asked.
                      Bit 2 a: on the first one along direction a, 2 a + 1: on the last */
} cell_motion;

/* What is wanted of a cell's points. */
typedef enum cell_use {
    CELL_VALUES,   /* displacements */
    CELL_BY_UVW,   /* and their derivatives by u,v,w */
    CELL_GRADIENTS /* and those by the point, for which the rest points are needed where there is no inverse
                      for all */
} cell_use;

/* Numbers that the kernel's fields take in a cell of the lattice. */
size_t ffd_displacement_cell_numbers(const ffd_lattice *lattice, cell_use use);
/* Tells how the cell with these non-empty spans moves. Where it bends, finds the numbers, and one more for
   the kernel's use; else nothing is written. */
cell_motion ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                         const size_t number[3], cell_use use, double *numbers);
/* The spans that these numbers are of. */
void ffd_displacement_spans(const ffd_lattice *lattice, const size_t number[3], int span[3]);
/* The cell itself, with these numbers. */
void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t number[3], cell_use use,
                                 const double *numbers, kernel_cell *cell);

/* u,v,w within the periods of closed directions. */
void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3]);

/* From derivatives by u,v,w to those by the point: times the Jacobian's inverse; 0 where it has none. */
void ffd_displacement_to_space(const double jacobian[9], double gradient[9]);

#endif
