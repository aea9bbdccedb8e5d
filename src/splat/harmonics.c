#include "splat/harmonics.h"
#include "base/vector/vec.h"
#include <stddef.h>
#include <string.h>

/* Normalising factors: sqrt(3/4pi), sqrt(15/4pi), sqrt(5/16pi), sqrt(15/16pi), sqrt(35/32pi), sqrt(105/4pi),
   sqrt(21/32pi), sqrt(7/16pi), sqrt(105/16pi). */
#define N1 0.48860251190291992159
#define N2 1.0925484305920790705
#define N20 0.31539156525252000603
#define N22 0.54627421529603953527
#define N33 0.59004358992664351035
#define N32 2.8906114426405540554
#define N31 0.45704579946446573616
#define N30 0.37317633259011539141
#define N322 1.4453057213202770277

void ffd_harmonics_values(int degree, const double direction[3], double values[7])
{
    const double x = direction[0], y = direction[1], z = direction[2];
    const double xx = x * x, yy = y * y, zz = z * z;
    if (degree == 1) {
        values[0] = -N1 * y;
        values[1] = N1 * z;
        values[2] = -N1 * x;
    } else if (degree == 2) {
        values[0] = N2 * (x * y);
        values[1] = -N2 * (y * z);
        values[2] = N20 * (2 * zz - xx - yy);
        values[3] = -N2 * (x * z);
        values[4] = N22 * (xx - yy);
    } else {
        values[0] = -N33 * y * (3 * xx - yy);
        values[1] = N32 * (x * y) * z;
        values[2] = -N31 * y * (4 * zz - xx - yy);
        values[3] = N30 * z * (2 * zz - 3 * xx - 3 * yy);
        values[4] = -N31 * x * (4 * zz - xx - yy);
        values[5] = N322 * z * (xx - yy);
        values[6] = -N33 * x * (xx - 3 * yy);
    }
}

/* A function of a degree is a sum of lobes round as many directions as it has coefficients (Nowrouzezahrai,
   Simari and Fiume, Sparse Zonal Harmonic Factorization, 2012); turned, it is the same sum round the turned
   directions. */
#define LOBES 7

/* Along z, y, y + z, x + y, x + y + z, x, x - y: degree 2 takes the first five, degree 3 all. */
static const double axes[LOBES][3] = {{0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 1, 0},
                                      {1, 1, 1}, {1, 0, 0}, {1, -1, 0}};
#define ROOT_2 1.4142135623730950488
#define ROOT_3 1.7320508075688772935
static const double lengths[LOBES] = {1, 1, ROOT_2, ROOT_2, ROOT_3, 1, ROOT_2};

/* What a coefficient adds to a lobe: an entry of the inverse of the matrix of values at the axes. */
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

static void turn_first(const double rotation[9], double c[3][HARMONICS_CHANNELS])
{
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        double vector[3] = {-c[2][k], -c[0][k], c[1][k]};
        mat_apply(rotation, vector, vector);
        c[0][k] = -vector[1];
        c[1][k] = vector[2];
        c[2][k] = -vector[0];
    }
}

static void turn_lobes(const double turned[LOBES][3], int degree, const lobe_term *terms, size_t term_count,
                       double (*c)[HARMONICS_CHANNELS])
{
    const int count = 2 * degree + 1;
    double lobes[LOBES][HARMONICS_CHANNELS] = {{0}};
    for (size_t t = 0; t < term_count; t++)
        for (int k = 0; k < HARMONICS_CHANNELS; k++)
            lobes[terms[t].lobe][k] += terms[t].weight * c[terms[t].order][k];
    memset(c, 0, (size_t)count * sizeof *c);
    for (int l = 0; l < count; l++) {
        double values[7];
        ffd_harmonics_values(degree, turned[l], values);
        for (int m = 0; m < count; m++)
            for (int k = 0; k < HARMONICS_CHANNELS; k++)
                c[m][k] += values[m] * lobes[l][k];
    }
}

/* A reversed direction changes the sign of odd degrees. */
static void reverse(double (*c)[HARMONICS_CHANNELS], int count)
{
    for (int m = 0; m < count; m++)
        for (int k = 0; k < HARMONICS_CHANNELS; k++)
            c[m][k] = -c[m][k];
}

void ffd_harmonics_turn(const splat_turn *turn, int degree, double c[HARMONICS_MOST][HARMONICS_CHANNELS])
{
    double rotation[9], turned[LOBES][3];
    ffd_splat_matrix(turn->quaternion, rotation);
    for (int l = 0; l < LOBES && degree > 1; l++) {
        mat_apply(rotation, axes[l], turned[l]);
        for (int a = 0; a < 3; a++)
            turned[l][a] /= lengths[l];
    }
    if (degree >= 1)
        turn_first(rotation, c);
    if (degree >= 2)
        turn_lobes((const double(*)[3])turned, 2, terms2, sizeof terms2 / sizeof *terms2, c + 3);
    if (degree >= 3)
        turn_lobes((const double(*)[3])turned, 3, terms3, sizeof terms3 / sizeof *terms3, c + 8);
    if (turn->is_mirrored && degree >= 1)
        reverse(c, 3);
    if (turn->is_mirrored && degree >= 3)
        reverse(c + 8, 7);
}
