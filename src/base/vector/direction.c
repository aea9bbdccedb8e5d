#include "base/vector/direction.h"
#include "base/vector/vec.h"
#include <float.h>

/* If the sine of the angle between two directions is below this, they count as parallel: the difference would
   consist mostly of rounding errors of the text that they were read from. */
#define PARALLEL_SINE 1e-9

bool ffd_direction_unit(double v[3])
{
    if (fabs(vec_dot(v, v) - 1) <= 4 * DBL_EPSILON)
        return true;
    double largest = 0;
    for (int c = 0; c < 3; c++)
        largest = fabs(v[c]) > largest ? fabs(v[c]) : largest;
    if (!(largest > 0))
        return false;
    /* Scaled first, because squares of the components could overflow or underflow. */
    double scaled[3];
    for (int c = 0; c < 3; c++)
        scaled[c] = v[c] / largest;
    const double length = vec_length(scaled);
    for (int c = 0; c < 3; c++)
        v[c] = scaled[c] / length;
    return true;
}

bool ffd_direction_perpendicular(const double axis[3], double v[3])
{
    if (!ffd_direction_unit(v))
        return false;
    /* The second pass removes what the rounding of the first subtraction left. */
    for (int pass = 0; pass < 2; pass++) {
        const double along = vec_dot(axis, v);
        if (fabs(along) <= 4 * DBL_EPSILON)
            return true;
        double rest[3];
        for (int c = 0; c < 3; c++)
            rest[c] = v[c] - along * axis[c];
        if (vec_length(rest) < PARALLEL_SINE)
            return false;
        for (int c = 0; c < 3; c++)
            v[c] = rest[c];
        ffd_direction_unit(v);
    }
    return true;
}

void ffd_direction_default_zero(const double axis[3], double zero[3])
{
    int least = 0;
    for (int c = 1; c < 3; c++)
        if (fabs(axis[c]) < fabs(axis[least]))
            least = c;
    for (int c = 0; c < 3; c++)
        zero[c] = c == least;
    ffd_direction_perpendicular(axis, zero);
}
