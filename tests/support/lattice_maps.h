/* lattice_maps.h - maps that bend rest lattices in tests (lattice_map), as functions of fractions of the
   domain. */
#ifndef FFD_TESTS_LATTICE_MAPS_H
#define FFD_TESTS_LATTICE_MAPS_H

#include <math.h>

static inline void warped_map(const double g[3], double out[3])
{
    out[0] = g[0] + 0.1 * g[1] * g[1] + 0.05 * g[2];
    out[1] = g[1] + 0.15 * g[0] * g[2];
    out[2] = g[2] - 0.1 * g[0] * g[0] + 0.05 * g[1] * g[1] * g[0];
}

static inline void far_map(const double g[3], double out[3])
{
    warped_map(g, out);
    out[0] += 1e6;
    out[1] -= 1e6;
}

/* A bar bent to 3/4 of a circle; v runs along it. */
static inline void bent_map(const double g[3], double out[3])
{
    const double angle = 4.7 * g[1], radius = 1 + g[0];
    out[0] = radius * cos(angle);
    out[1] = radius * sin(angle);
    out[2] = g[2];
}

#endif
