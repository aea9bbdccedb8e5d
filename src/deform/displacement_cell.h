/* displacement_cell.h - how the control points of a cell displace its points. */
#ifndef FFD_DEFORM_DISPLACEMENT_CELL_H
#define FFD_DEFORM_DISPLACEMENT_CELL_H

#include "deform/kernel.h"
#include "lattice/lattice.h"

/* Returns whether a moved control point acts in the cell with these spans. */
bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3]);

/* Returns the common displacement of all control points that act at u,v,w, if they have the same one, other
   than 0, and no moved weights; else NULL. On a knot fewer control points act than elsewhere in the cell. uvw
   NULL: for all control points of the cell. The result belongs to the lattice. */
const double *ffd_displacement_shared(const ffd_lattice *lattice, const int span[3], const double *uvw);

typedef enum motion_kind {
    CELL_STILL,   /* no moved control point acts in the cell */
    CELL_SHIFTED, /* all points have the same displacement, that of ffd_displacement_shared */
    CELL_BENT
} motion_kind;

/* How the points of a cell move. */
typedef struct cell_motion {
    uint8_t kind;  /* motion_kind */
    uint8_t knots; /* for other cells: the knots on which ffd_displacement_shared must be called for points.
                      Bit 2 a: first knot in direction a; bit 2 a + 1: last knot */
} cell_motion;

/* What is to be computed for the points of a cell. */
typedef enum cell_use {
    CELL_VALUES,   /* displacements */
    CELL_BY_UVW,   /* also derivatives by u,v,w */
    CELL_GRADIENTS /* also derivatives by position, for which the rest points are needed if there is no
                      constant inverse */
} cell_use;

/* Returns the number of doubles that the kernel's fields need for a cell of the lattice. */
size_t ffd_displacement_cell_width(const ffd_lattice *lattice, cell_use use);
/* Returns how the cell with these indices of non-empty spans moves. If its points have different
   displacements, also fills numbers, with room for one more that the kernel may write. */
cell_motion ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                         const size_t index[3], cell_use use, double *numbers);
/* Fills the points of a kernel_field, and behind them its slopes if wanted, with room for one number more.
   field: that of all control points. */
void ffd_displacement_cell_field(const ffd_lattice *lattice, extraction_kernel *extract,
                                 const size_t index[3], const double *field, bool with_slopes,
                                 double *numbers);
/* Converts indices of non-empty spans to spans. */
void ffd_displacement_spans(const ffd_lattice *lattice, const size_t index[3], int span[3]);
/* Sets up a cell for the kernel, with these numbers. */
void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t index[3], cell_use use,
                                 const double *numbers, kernel_cell *cell);

/* A range of the degree + 1 functions of a span: first to first + count - 1. */
typedef struct function_range {
    int first, count;
} function_range;

/* Returns the functions of a span that are not 0 at u. */
function_range ffd_displacement_acting(const knot_vector *knots, int span, double u);

/* Wraps u,v,w into the domain: closed directions modulo their period. */
void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3]);

/* Converts derivatives by u,v,w to derivatives by position, in place: multiplies by the inverse of the
   Jacobian; 0 if it is not invertible. */
void ffd_displacement_to_space(const double jacobian[9], double gradient[9]);

#endif
