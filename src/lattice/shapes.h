/* shapes.h - control points at rest that fill a box. */
#ifndef FFD_LATTICE_SHAPES_H
#define FFD_LATTICE_SHAPES_H

#include "lattice/lattice.h"

/* The region that "units": "box" refers to: position = origin + sum_a fraction_a * (column a of frame).
   A box: its lower corner and its sides. A cylinder: the bounds along x,y,z of the whole solid cylinder (all
   round, whatever its angles). Points: the bounds along x,y,z of the rest points. */
typedef struct rest_region {
    double origin[3], frame[9];
} rest_region;

/* A box grown on both sides of each direction by its margin, a fraction of the side; sides of no length are
   widened first, so that the volume is not empty. FFD_E_INVALID where the result is not finite. */
ffd_status ffd_shape_grow_box(const double min[3], const double max[3], const double margin[3],
                              double grown_min[3], double grown_max[3], ffd_error *error);
/* The region of a box from min to max along axes (rows). */
void ffd_shape_box_region(const double min[3], const double max[3], const double axes[9],
                          rest_region *region);
/* Whether the curve starts and ends in its first and last control points: presets and lists alike. */
bool ffd_shape_is_clamped(const knot_vector *knots);
/* Where control point i lies between the domain's ends along one direction: 0 and 1 at the ends of the
   domain, with Greville spacing (g_i - t_d)/(t_n - t_d), so that linear maps of it are exact. */
double ffd_shape_fraction(const knot_vector *knots, size_t point, ffd_spacing spacing);
/* from + fraction (to - from), exact at both ends and symmetric. */
static inline double ffd_shape_between(double from, double to, double fraction)
{
    const double length = to - from;
    return fraction <= 0.5 ? from + fraction * length : to - (1 - fraction) * length;
}
/* The control points (3*count) of a box along axes (rows). */
ffd_status ffd_shape_box(const ffd_lattice *lattice, const double min[3], const double max[3],
                         const double axes[9], ffd_spacing spacing, double *points, ffd_error *error);

#endif
