#include "base/vector/direction.h"
#include "base/vector/vec.h"
#include <float.h>

/* Below this sine of the angle two directions count as parallel: what is left after the subtraction would be
   mostly the rounding of the text they were written in. */
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
    /* Squares of the components as they are could overflow or vanish. */
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
    /* Once more removes what the first subtraction's rounding left. */
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
