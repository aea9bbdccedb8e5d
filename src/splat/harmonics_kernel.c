/* harmonics_kernel.c - compiled once for each instruction set with lanes: FFD_HARMONICS_KERNEL is the
   function's name, FFD_LANES the number of SIMD lanes, each with one splat. */
#include "base/vector/lanes.h"
#include "splat/harmonics.h"

typedef lanes number;
#include "splat/harmonics_turn.h"

static ALWAYS_INLINE void turn(double (*rotations)[9], int degree, harmonics_block *c)
{
    const double *at[FFD_LANES];
    lanes rotation[9], values[HARMONICS_MOST][HARMONICS_CHANNELS];
    const int count = degree * (degree + 2);
    for (size_t l = 0; l < FFD_LANES; l++)
        at[l] = rotations[l];
    lanes_load_nines(at, rotation);
    for (int m = 0; m < count; m++)
        for (int k = 0; k < HARMONICS_CHANNELS; k++) {
            double one[FFD_LANES];
            for (size_t l = 0; l < FFD_LANES; l++)
                one[l] = c[l][m][k];
            values[m][k] = lanes_load(one);
        }
    turn_degrees(rotation, degree, values);
    for (int m = 0; m < count; m++)
        for (int k = 0; k < HARMONICS_CHANNELS; k++)
            for (size_t l = 0; l < FFD_LANES; l++)
                c[l][m][k] = values[m][k][l];
}

size_t FFD_HARMONICS_KERNEL(double (*rotations)[9], int degree, size_t count, harmonics_block *c)
{
    size_t first = 0;
    for (; first + FFD_LANES <= count; first += FFD_LANES)
        if (degree == 1)
            turn(rotations + first, 1, c + first);
        else if (degree == 2)
            turn(rotations + first, 2, c + first);
        else if (degree == 3)
            turn(rotations + first, 3, c + first);
    return first;
}
