/* harmonics_turn.h - rotates harmonics, for scalar and SIMD code: `number` is a double or a register of
   lanes. Included by harmonics.c and harmonics_kernel.c only. */
#ifndef FFD_SPLAT_HARMONICS_TURN_H
#define FFD_SPLAT_HARMONICS_TURN_H

#include "base/inline.h"
#include <string.h>

/* Normalisation factors: sqrt(3/4pi), sqrt(15/4pi), sqrt(5/16pi), sqrt(15/16pi), sqrt(35/32pi),
   sqrt(105/4pi), sqrt(21/32pi), sqrt(7/16pi), sqrt(105/16pi). */
#define N1 0.48860251190291992159
#define N2 1.0925484305920790705
#define N20 0.31539156525252000603
#define N22 0.54627421529603953527
#define N33 0.59004358992664351035
#define N32 2.8906114426405540554
#define N31 0.45704579946446573616
#define N30 0.37317633259011539141
#define N322 1.4453057213202770277

static ALWAYS_INLINE void find_values(int degree, const number direction[3], number values[7])
{
    const number x = direction[0], y = direction[1], z = direction[2];
    const number xx = x * x, yy = y * y, zz = z * z;
    if (degree == 1) {
        values[0] = -N1 * y;
        values[1] = N1 * z;
        values[2] = -N1 * x;
    } else if (degree == 2) {
        values[0] = N2 * (x * y);
        values[1] = -N2 * (y * z);
        values[2] = N20 * (2.0 * zz - xx - yy);
        values[3] = -N2 * (x * z);
        values[4] = N22 * (xx - yy);
    } else {
        values[0] = -N33 * y * (3.0 * xx - yy);
        values[1] = N32 * (x * y) * z;
        values[2] = -N31 * y * (4.0 * zz - xx - yy);
        values[3] = N30 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy);
        values[4] = -N31 * x * (4.0 * zz - xx - yy);
        values[5] = N322 * z * (xx - yy);
        values[6] = -N33 * x * (xx - 3.0 * yy);
    }
}

/* A function of a degree is a sum of zonal lobes round as many directions as there are coefficients; rotated,
   it is the same sum round the rotated directions (Nowrouzezahrai, Simari and Fiume, Sparse Zonal Harmonic
   Factorization, 2012). */
#define LOBES 7

/* The directions z, y, y + z, x + y, x + y + z, x, x - y: degree 2 uses the first five, degree 3 all. */
static const double axes[LOBES][3] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 1, 0},
                                      {1, 1, 1}, {1, 0, 0}, {1, -1, 0}};
/* The reciprocals of their lengths. */
#define ROOT_HALF 0.70710678118654752440
#define ROOT_THIRD 0.57735026918962576451
static const double shares[LOBES] = {1, 1, ROOT_HALF, ROOT_HALF, ROOT_THIRD, 1, ROOT_HALF};

/* The contribution of a coefficient to a lobe: an entry of the inverse of the matrix of values at the
   axes. */
typedef struct lobe_term {
    unsigned char lobe, order;
    double weight;
} lobe_term;

static const lobe_term terms2[] = {
    {0, 0, 0.91529123286376899335},  {0, 1, 0.91529123286376899335}, {0, 2, 1.5853309190424044053},
    {0, 4, -0.91529123286376899335}, {1, 1, 0.91529123286376899335}, {1, 3, -0.91529123286376899335},
    {1, 4, -1.8305824657275379867},  {2, 1, -1.8305824657275379867}, {2, 3, 1.8305824657275379867},
    {3, 0, 1.8305824657275379867},   {3, 3, 1.8305824657275379867},  {4, 3, -2.7458736985913069801},
};

static const lobe_term terms3[] = {
    {0, 1, 0.69189513695864065708},  {0, 3, 1.3398491713813575449},   {0, 5, -0.34594756847932032854},
    {1, 0, 0.84739502053087624265},  {1, 1, 0.69189513695864065708},  {1, 2, 1.0939822673917252674},
    {1, 5, -0.69189513695864065708}, {2, 5, -1.9569749728537994004},  {6, 0, 0.59919876536109625432},
    {6, 2, -0.7735622797705238036},  {6, 4, 0.7735622797705238036},   {6, 5, 0.97848748642689970021},
    {6, 6, 0.59919876536109625432},  {5, 1, 0.69189513695864065708},  {5, 4, 1.0939822673917252674},
    {5, 6, -0.84739502053087624265}, {3, 0, -0.59919876536109625432}, {3, 2, 0.7735622797705238036},
    {3, 4, 0.7735622797705238036},   {3, 5, -0.97848748642689970021}, {3, 6, 0.59919876536109625432},
    {4, 1, 1.7975962960832887629},
};

static ALWAYS_INLINE void apply(const number m[9], const number v[3], number out[3])
{
    for (int r = 0; r < 3; r++)
        out[r] = m[3 * r] * v[0] + m[3 * r + 1] * v[1] + m[3 * r + 2] * v[2];
}

static ALWAYS_INLINE void turn_first(const number rotation[9], number c[HARMONICS_CHANNELS][HARMONICS_MOST])
{
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const number vector[3] = {-c[k][2], -c[k][0], c[k][1]};
        number turned[3];
        apply(rotation, vector, turned);
        c[k][0] = -turned[1];
        c[k][1] = turned[2];
        c[k][2] = -turned[0];
    }
}

/* Rotates the coefficients of a degree, which begin at `first`. */
static ALWAYS_INLINE void turn_lobes(const number turned[LOBES][3], int degree, const lobe_term *terms,
                                     int term_count, int first, number c[HARMONICS_CHANNELS][HARMONICS_MOST])
{
    const int count = 2 * degree + 1;
    number lobes[LOBES][HARMONICS_CHANNELS];
    memset(lobes, 0, sizeof lobes);
    /* The number of terms of the longest table. Unrolled, the terms are constants, and the lobes stay in
       registers. */
#pragma GCC unroll 22
    for (int t = 0; t < term_count; t++)
        for (int k = 0; k < HARMONICS_CHANNELS; k++)
            lobes[terms[t].lobe][k] += terms[t].weight * c[k][first + terms[t].order];
    for (int k = 0; k < HARMONICS_CHANNELS; k++)
        memset(&c[k][first], 0, (size_t)count * sizeof **c);
    for (int l = 0; l < count; l++) {
        number values[7];
        find_values(degree, turned[l], values);
        for (int m = 0; m < count; m++)
            for (int k = 0; k < HARMONICS_CHANNELS; k++)
                c[k][first + m] += values[m] * lobes[l][k];
    }
}

/* Rotates the coefficients of degrees 1 to `degree`. */
static ALWAYS_INLINE void turn_degrees(const number rotation[9], int degree,
                                       number c[HARMONICS_CHANNELS][HARMONICS_MOST])
{
    number turned[LOBES][3];
    for (int l = 0; l < LOBES && degree > 1; l++)
        for (int r = 0; r < 3; r++)
            turned[l][r] = (axes[l][0] * rotation[3 * r] + axes[l][1] * rotation[3 * r + 1] +
                            axes[l][2] * rotation[3 * r + 2]) *
                           shares[l];
    if (degree >= 1)
        turn_first(rotation, c);
    if (degree >= 2)
        turn_lobes((const number(*)[3])turned, 2, terms2, sizeof terms2 / sizeof *terms2, 3, c);
    if (degree >= 3)
        turn_lobes((const number(*)[3])turned, 3, terms3, sizeof terms3 / sizeof *terms3, 8, c);
}

#endif
