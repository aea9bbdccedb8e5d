#include "mesh/srgb.h"
#include "base/arithmetic.h"
#include "base/vector/root.h"
#include <float.h>
#include <math.h>
#include <stdbool.h>

double ffd_srgb_to_linear(double srgb)
{
    if (!(srgb > 0.04045 && srgb <= DBL_MAX))
        return srgb / 12.92;
    const double base = (srgb + 0.055) / 1.055, fifth = ffd_root(base, 5);
    return base * base * (fifth * fifth); /* base^2.4 */
}

/* 1.055 linear^(1/2.4) - 0.055, with linear^(5/12) = linear^(1/3) linear^(1/12). */
static double encode(double linear)
{
    if (!(linear > 0.0031308 && linear <= DBL_MAX))
        return 12.92 * linear;
    const double third = ffd_root(linear, 3), power = third * sqrt(sqrt(third));
    return power + 0.055 * (power - 1);
}

/* Returns a linear value from 0 to 1 times 65535, rounded. */
static double in_16_bits(double linear)
{
    return floor_of(65535 * linear + 0.5);
}

static bool equal(double a, double b)
{
    return a <= b && a >= b;
}

double ffd_srgb_from_linear(double linear)
{
    const double srgb = encode(linear), byte = floor_of(255 * srgb + 0.5);
    if (!(byte >= 0 && byte <= 255))
        return srgb;
    const double exact = ffd_srgb_to_linear(byte / 255);
    return equal(linear, (double)(float)exact) || equal(linear, in_16_bits(exact) / 65535) ? byte / 255
                                                                                           : srgb;
}

uint16_t ffd_srgb_byte_to_linear(unsigned byte)
{
    return (uint16_t)in_16_bits(ffd_srgb_to_linear(byte / 255.0));
}
