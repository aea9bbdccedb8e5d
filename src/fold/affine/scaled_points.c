#include "fold/affine/scaled_points.h"
#include "base/vector/vec.h"
#include <float.h>

/* The rounding of control points: this many eps of the largest coordinates at rest and deformed, of any
   direction, for rotations mix them. A move rounds a coordinate a few times, and the four points that define
   the map pass their own rounding on. */
#define ROUNDINGS 64

void ffd_scaled_points_make(const ffd_lattice *lattice, scaled_points *points)
{
    double most[2] = {0, 0}; /* at rest, deformed */
    points->lattice = lattice;
    for (int r = 0; r < 3; r++) {
        const double *p = lattice->rest + r, *q = lattice->deformed + r, first = p[0];
        double extent = 0;
        int exponent = 0;
        for (size_t i = 0; i < 3 * lattice->count; i += 3) {
            extent = larger_of(extent, fabs(p[i] - first));
            most[0] = larger_of(most[0], fabs(p[i]));
            most[1] = larger_of(most[1], fabs(q[i]));
        }
        frexp(extent, &exponent);
        points->scale[r] = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    }
    for (int r = 0; r < 3; r++)
        points->rounding[r] =
            ROUNDINGS * DBL_EPSILON * (most[0] * points->scale[r] + most[1] * points->scale[r]);
}

void ffd_scaled_point(const scaled_points *points, size_t i, double p[3])
{
    const double *rest = points->lattice->rest;
    for (int r = 0; r < 3; r++)
        p[r] = (rest[3 * i + (size_t)r] - rest[r]) * points->scale[r];
}

void ffd_scaled_change(const scaled_points *points, size_t i, double d[3])
{
    const double *difference = points->lattice->difference;
    for (int r = 0; r < 3; r++)
        d[r] = (difference[3 * i + (size_t)r] - difference[r]) * points->scale[r];
}

bool ffd_scaled_within(const double off[3], const double rounding[3])
{
    return fabs(off[0]) <= rounding[0] && fabs(off[1]) <= rounding[1] && fabs(off[2]) <= rounding[2];
}

double ffd_scaled_rounding(const double inverse[9], const double rounding[3])
{
    double most = 0;
    for (int a = 0; a < 3; a++)
        most = larger_of(most, fabs(inverse[3 * a]) * rounding[0] + fabs(inverse[3 * a + 1]) * rounding[1] +
                                   fabs(inverse[3 * a + 2]) * rounding[2]);
    return most;
}
