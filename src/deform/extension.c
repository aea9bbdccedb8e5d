#include "deform/extension.h"
#include "base/vector/vec.h"
#include "deform/displacement.h"
#include <string.h>

/* The smoothstep polynomial s^3 (10 - 15 s + 6 s^2), which rises from 0 to 1. */
static double rise(double s)
{
    return s * s * s * (10 - s * (15 - 6 * s));
}

/* Each half is computed from its own end, so that its relative error is small there. */
double ffd_extension_fade(double distance, double falloff, double *slope)
{
    double ignored;
    if (!slope)
        slope = &ignored;
    *slope = 0;
    if (falloff == 0)
        return 1;
    if (!(distance < falloff))
        return 0;
    const double s = distance / falloff, rest = (falloff - distance) / falloff;
    *slope = -30 * (s * s) * (rest * rest) / falloff;
    return s < 0.5 ? 1 - rise(s) : rise(rest);
}

int ffd_extension_displacement(const ffd_lattice *lattice, const boundary_point *nearest, double falloff,
                               double delta[3], double gradient[9])
{
    double slope, border[3], by_uvw[9], product[9];
    const double weight = ffd_extension_fade(nearest->distance, falloff, &slope);
    memset(delta, 0, 3 * sizeof *delta);
    if (gradient)
        memset(gradient, 0, 9 * sizeof *gradient);
    if (weight == 0 || !ffd_displacement_by_uvw(lattice, nearest->uvw, border, gradient ? by_uvw : NULL))
        return 0;
    for (int r = 0; r < 3; r++)
        delta[r] = weight * border[r];
    if (!gradient)
        return 1;
    mat_multiply(by_uvw, nearest->uvw_by_p, product);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            gradient[3 * r + c] = weight * product[3 * r + c] + slope * border[r] * nearest->direction[c];
    return 1;
}
