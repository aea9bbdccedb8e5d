#include "base/vector/trig.h"
#include "base/arithmetic.h"
#include <math.h>

/* pi/180 as a sum of two doubles: relative error below 2^-107. */
static const double RADIAN_HIGH = 0x1.1df46a2529d39p-6, RADIAN_LOW = 0x1.5c1d8becdd291p-62;

/* A number as an unevaluated sum: low is at most half an ulp of high. */
typedef struct split_number {
    double high, low;
} split_number;

/* Dekker's splitting (Numer. Math. 18, 1971): each half has at most 26 bits, so products of halves are
   exact. */
static split_number split(double a)
{
    const double c = 134217729.0 * a;
    const double high = c - (c - a);
    return (split_number){high, a - high};
}

/* Converts degrees (|degrees| <= 45) to radians with a relative error of about 2^-105. */
static split_number to_radians(double degrees)
{
    const split_number a = split(degrees), b = split(RADIAN_HIGH);
    const double product = degrees * RADIAN_HIGH;
    const double error = ((a.high * b.high - product) + a.high * b.low + a.low * b.high) + a.low * b.low;
    const double low = error + degrees * RADIAN_LOW;
    const double high = product + low;
    return (split_number){high, low - (high - product)};
}

/* sin(h + l) = h + (l cos h + h^3 S(h^2)): the Taylor series up to h^17; the next term is below 2^-62 for h
   <= pi/4. Only the last addition has a rounding error of the result's magnitude. */
static double sine_of(split_number x)
{
    static const double term[] = {
        -1.0 / 6,        1.0 / 120,        -1.0 / 5040,           1.0 / 362880,
        -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000., 1.0 / 355687428096000.};
    const double z = x.high * x.high;
    double sum = 0;
    for (int i = (int)(sizeof term / sizeof *term) - 1; i >= 0; i--)
        sum = sum * z + term[i];
    return x.high + (x.high * z * sum + x.low * (1 - 0.5 * z));
}

/* cos(h + l) = 1 - h^2/2 + (h^4 K(h^2) - h l), up to h^18. The rounding error of 1 - h^2/2 is added back. */
static double cosine_of(split_number x)
{
    static const double term[] = {
        1.0 / 24,        -1.0 / 720,          1.0 / 40320,           -1.0 / 3628800,
        1.0 / 479001600, -1.0 / 87178291200., 1.0 / 20922789888000., -1.0 / 6402373705728000.};
    const double z = x.high * x.high, half = 0.5 * z, rest = 1 - half;
    double sum = 0;
    for (int i = (int)(sizeof term / sizeof *term) - 1; i >= 0; i--)
        sum = sum * z + term[i];
    return rest + (((1 - rest) - half) + (z * z * sum - x.high * x.low));
}

/* For |degrees| slightly above 45 at most. 30 and 45 degrees have exact cases, because the series could miss
   them by an ulp. */
static void sincos_octant(double degrees, double *sine, double *cosine)
{
    const double size = fabs(degrees);
    const split_number x = to_radians(size);
    double s = sine_of(x);
    *cosine = cosine_of(x);
    if (size == 30)
        s = 0.5;
    if (size == 45)
        s = *cosine = sqrt(0.5);
    *sine = degrees < 0 ? -s : s;
}

void ffd_sincos_degrees(double degrees, double *sine, double *cosine)
{
    /* Both operations are exact: remainder_of always is; the subtraction because its operands are within a
       factor of two (Sterbenz lemma) or the quadrant is 0. */
    const double turn = remainder_of(degrees, 360);
    const double quadrant = floor_of(turn / 90 + 0.5);
    double s, c;
    sincos_octant(turn - 90 * quadrant, &s, &c);
    /* Adding 0 turns -0 into 0. */
    switch ((int)quadrant & 3) {
    case 0:
        *sine = s + 0.0;
        *cosine = c + 0.0;
        break;
    case 1:
        *sine = c + 0.0;
        *cosine = -s + 0.0;
        break;
    case 2:
        *sine = -s + 0.0;
        *cosine = -c + 0.0;
        break;
    default:
        *sine = -c + 0.0;
        *cosine = s + 0.0;
        break;
    }
}

void ffd_axis_rotation(int axis, double degrees, double rotation[9])
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    double sine, cosine;
    ffd_sincos_degrees(degrees, &sine, &cosine);
    for (int i = 0; i < 9; i++)
        rotation[i] = i == 4 * axis ? 1 : 0;
    rotation[4 * a] = rotation[4 * b] = cosine;
    rotation[3 * a + b] = -sine;
    rotation[3 * b + a] = sine;
}

/* atan(k/8) */
static const double ARC_OF_EIGHTHS[] = {0,
                                        0x1.fd5ba9aac2f6ep-4,
                                        0x1.f5b75f92c80ddp-3,
                                        0x1.6f61941e4def1p-2,
                                        0x1.dac670561bb4fp-2,
                                        0x1.1e00babdefeb4p-1,
                                        0x1.4978fa3269ee1p-1,
                                        0x1.700a7c5784634p-1,
                                        0x1.921fb54442d18p-1};
static const double HALF_TURN = 0x1.921fb54442d18p+1, QUARTER_TURN = 0x1.921fb54442d18p+0;

/* atan(y/x) for 0 <= y <= x, 0 < x. With c the multiple of 1/8 nearest to y/x and z = (y - c x)/(x + c y),
   atan(y/x) = atan(c) + atan(z), |z| <= 1/16: the Taylor series up to z^15; the next term is below 2^-72. */
static double arc_of_octant(double y, double x)
{
    static const double term[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
    const int eighths = (int)(8 * (y / x) + 0.5);
    const double c = eighths / 8.0, z = (y - c * x) / (x + c * y), square = z * z;
    double sum = 0;
    for (int i = (int)(sizeof term / sizeof *term) - 1; i >= 0; i--)
        sum = sum * square + term[i];
    return ARC_OF_EIGHTHS[eighths] + (z + z * square * sum);
}

double ffd_arc_tangent(double y, double x)
{
    double size = fabs(x);
    if (y == 0)
        return x < 0 ? HALF_TURN : 0;
    /* Scaled so that x + c y does not overflow. */
    if (y > 0x1p1000 || size > 0x1p1000) {
        y *= 0x1p-30;
        size *= 0x1p-30;
    }
    const double arc = y <= size ? arc_of_octant(y, size) : QUARTER_TURN - arc_of_octant(size, y);
    return x < 0 ? HALF_TURN - arc : arc;
}

double ffd_angle_degrees(double y, double x)
{
    const double angle = ffd_arc_tangent(fabs(y), x) * (180 / HALF_TURN);
    return y < 0 ? -angle : angle;
}
