/* lattice_points.h - checks control points in tests of moves. Includes come after cmocka.h. */
#ifndef FFD_TESTS_LATTICE_POINTS_H
#define FFD_TESTS_LATTICE_POINTS_H

#include "lattice/lattice.h"
#include <math.h>

static inline const double *point_of(const ffd_lattice *l, size_t i, size_t j, size_t k)
{
    return l->deformed + 3 * (i + l->size[0] * (j + l->size[1] * k));
}

/* Checks that each coordinate is within `most` of the expected one. */
static inline void check_within(const ffd_lattice *l, const size_t ijk[3], const double expected[3],
                                double most)
{
    const double *const p = point_of(l, ijk[0], ijk[1], ijk[2]);
    for (int a = 0; a < 3; a++)
        if (!(fabs(p[a] - expected[a]) <= most))
            fail_msg("point %zu,%zu,%zu: %.17g %.17g %.17g, expected %.17g %.17g %.17g", ijk[0], ijk[1],
                     ijk[2], p[0], p[1], p[2], expected[0], expected[1], expected[2]);
}

static inline size_t count_moved(const ffd_lattice *l)
{
    size_t moved = 0;
    for (size_t i = 0; i < l->count; i++)
        moved += l->moved[i] != 0;
    return moved;
}

#endif
