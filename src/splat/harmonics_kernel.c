/* harmonics_kernel.c - compiled once for each SIMD instruction set; FFD_HARMONICS_KERNEL is the name of the
   function, FFD_LANES the number of lanes, each with one splat. */
#include "base/vector/lanes.h"
#include "splat/harmonics.h"

typedef lanes number;
#include "splat/harmonics_turn.h"

/* Returns the index of a block of FFD_LANES coefficients of a channel that begins at m if it fits, else
   before. */
static ALWAYS_INLINE int block_of(int m)
{
    return m < HARMONICS_MOST - FFD_LANES ? m : HARMONICS_MOST - FFD_LANES;
}

static ALWAYS_INLINE void load(const harmonics_block *c, int count,
                               lanes values[HARMONICS_CHANNELS][HARMONICS_MOST])
{
    for (int k = 0; k < HARMONICS_CHANNELS; k++)
        for (int m = 0; m < count; m += FFD_LANES) {
            lanes row[FFD_LANES];
            for (int l = 0; l < FFD_LANES; l++)
                row[l] = lanes_load(c[l][k] + block_of(m));
            lanes_transpose(row);
            memcpy(&values[k][block_of(m)], row, sizeof row);
        }
}

static ALWAYS_INLINE void store(lanes values[HARMONICS_CHANNELS][HARMONICS_MOST], int count,
                                harmonics_block *c)
{
    for (int k = 0; k < HARMONICS_CHANNELS; k++)
        for (int m = 0; m < count; m += FFD_LANES) {
            lanes row[FFD_LANES];
            memcpy(row, &values[k][block_of(m)], sizeof row);
            lanes_transpose(row);
            for (int l = 0; l < FFD_LANES; l++)
                lanes_store(row[l], c[l][k] + block_of(m));
        }
}

static ALWAYS_INLINE void turn(double (*rotations)[9], int degree, harmonics_block *c)
{
    const double *at[FFD_LANES];
    lanes rotation[9], values[HARMONICS_CHANNELS][HARMONICS_MOST];
    const int count = degree * (degree + 2);
    for (size_t l = 0; l < FFD_LANES; l++)
        at[l] = rotations[l];
    lanes_load_nines(at, rotation);
    load((const harmonics_block *)c, count, values);
    turn_degrees(rotation, degree, values);
    store(values, count, c);
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
