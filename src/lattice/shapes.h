/* shapes.h - control points at rest that fill a box. */
#ifndef FFD_LATTICE_SHAPES_H
#define FFD_LATTICE_SHAPES_H

#include "lattice/lattice.h"

/* The region that "units" refers to, but for "world": position = origin + sum_a fraction_a * (column a of
   frame). For a box: its lower corner and its sides. For a cylinder: the bounds along x,y,z of the solid
   cylinder of a full turn, whatever its angles are. For points: the bounds along x,y,z of the rest points.
   With "mesh" the bounds of the mesh. */
typedef struct rest_region {
    double origin[3], frame[9];
} rest_region;

/* Enlarges a box on both sides of each direction by margin, a fraction of the side. Flat sides are widened
   first, so that the volume is not empty. Errors: FFD_E_INVALID (the result is not finite). */
ffd_status ffd_shape_grow_box(const double min[3], const double max[3], const double margin[3],
                              double grown_min[3], double grown_max[3], ffd_error *error);
/* Sets the region of a box from min to max along axes (in rows). */
void ffd_shape_box_region(const double min[3], const double max[3], const double axes[9],
                          rest_region *region);
/* Returns whether a curve begins and ends at its first and last control points; for presets and lists. */
bool ffd_shape_is_clamped(const knot_vector *knots);
/* Returns the position of a control point along a direction, relative to the domain (0 and 1 at its ends).
   With Greville spacing it is (g_i - t_d)/(t_n - t_d), so that the map is affine. */
double ffd_shape_fraction(const knot_vector *knots, size_t point, ffd_spacing spacing);
/* Interpolates linearly: from + fraction (to - from), exact at both ends and symmetric. */
static inline double ffd_shape_between(double from, double to, double fraction)
{
    const double length = to - from;
    return fraction <= 0.5 ? from + fraction * length : to - (1 - fraction) * length;
}
/* Fills points (3*count) with the control points of a box along axes (in rows). */
ffd_status ffd_shape_box(const ffd_lattice *lattice, const double min[3], const double max[3],
                         const double axes[9], ffd_spacing spacing, double *points, ffd_error *error);

#endif
