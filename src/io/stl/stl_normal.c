/* stl_normal.c - the normal of a facet. */
#include "base/vector/vec.h"
#include "io/stl/stl_document.h"
#include <float.h>

bool ffd_stl_normal(const double corners[9], double normal[3])
{
    double extent = 0, largest = 0, sides[2][3];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++) {
            extent = maximum_number(extent, fabs(corners[3 * i + a]));
            largest = maximum_number(largest, fabs(corners[3 * i + a] - corners[a]));
        }
    if (!vec_is_finite(corners) || !vec_is_finite(corners + 3) || !vec_is_finite(corners + 6) ||
        !(largest > 0 && isfinite(largest)))
        return false;
    for (int i = 0; i < 2; i++)
        for (int a = 0; a < 3; a++)
            sides[i][a] = (corners[3 * (i + 1) + a] - corners[a]) / largest;
    vec_cross(sides[0], sides[1], normal);
    /* Rounding bound: if the differences of coordinates are off by eps * extent, their products are off by
       twice that times the length of the other side. Doubled again for safety. */
    const double length = vec_length(normal);
    if (!(length > 4 * DBL_EPSILON * (extent / largest) * (vec_length(sides[0]) + vec_length(sides[1]))))
        return false;
    for (int a = 0; a < 3; a++)
        normal[a] /= length;
    return true;
}
