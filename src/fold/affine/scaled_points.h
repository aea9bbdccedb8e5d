/* scaled_points.h - the control points at rest and how they move, in units in which the lattice has size 1.
 */
#ifndef FFD_FOLD_AFFINE_SCALED_POINTS_H
#define FFD_FOLD_AFFINE_SCALED_POINTS_H

#include "lattice/lattice.h"

/* Control points at rest are relative to the first one, each coordinate in units of a power of two near its
   extent. The determinant of a map is the same in these units. */
typedef struct scaled_points {
    const ffd_lattice *lattice;
    double scale[3];
    double rounding[3]; /* of a coordinate at rest and deformed, scaled */
} scaled_points;

/* Finds the units of a lattice. */
void ffd_scaled_points_make(const ffd_lattice *lattice, scaled_points *points);
/* Computes the place of a control point at rest. */
void ffd_scaled_point(const scaled_points *points, size_t i, double p[3]);
/* Computes the displacement of a control point less that of the first one. */
void ffd_scaled_change(const scaled_points *points, size_t i, double d[3]);

/* Returns whether each coordinate is at most its rounding. */
bool ffd_scaled_within(const double off[3], const double rounding[3]);
/* Returns the greatest coordinate that the inverse of a matrix makes of the rounding of a point. */
double ffd_scaled_rounding(const double inverse[9], const double rounding[3]);

#endif
