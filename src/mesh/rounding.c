#include "mesh/rounding.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Returns half the distance from a float32 to the next one away from 0. */
static double half_float(double x)
{
    static const double least = 0x1p-150, half_epsilon = 0x1p-24;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits &= (uint64_t)0x7ff << 52;
    memcpy(&x, &bits, sizeof x); /* the greatest power of two not above |x|, or 0 */
    return x * half_epsilon > least ? x * half_epsilon : least;
}

void ffd_rounding_cell(const mesh_rounding *rounding, const double position[3], double half[3])
{
    for (int a = 0; a < 3; a++) {
        const double of_float = rounding->is_float[a] ? half_float(position[a]) : 0;
        const double of_step = 0.5 * rounding->step[a];
        half[a] = of_float > of_step ? of_float : of_step;
    }
}

void ffd_rounding_transform(const double linear[9], double half[3])
{
    const double own[3] = {half[0], half[1], half[2]};
    for (int r = 0; r < 3; r++)
        half[r] = fabs(linear[3 * r]) * own[0] + fabs(linear[3 * r + 1]) * own[1] +
                  fabs(linear[3 * r + 2]) * own[2];
}
