/* common_shift.h - points on which only control points with one common displacement act: they have exactly
   that one, which a sum would miss by rounding. For cells whose control points are there, as
   displacement_cell.h for those of a lattice. */
#ifndef FFD_DEFORM_COMMON_SHIFT_H
#define FFD_DEFORM_COMMON_SHIFT_H

#include "lattice/lattice.h"

/* Points of a cell of a lattice without weights. */
typedef struct shift_points {
    const ffd_lattice *lattice; /* only its knots matter */
    int span[3];
    const double *uvw; /* 3 numbers for each point */
    size_t count;
    bool has_knots; /* a point is on a knot */
    double *delta;  /* of point i: delta[3 * step * i + step * c] */
    size_t step;
} shift_points;

/* Replaces the displacements of the points on which control points with one displacement, other than 0, act.
 */
void ffd_shift_points(const shift_points *points, const double *numbers);

#endif
