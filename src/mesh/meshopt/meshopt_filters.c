#include "mesh/meshopt/meshopt_filters.h"
#include "base/arithmetic.h"
#include "base/little_endian.h"
#include <math.h>

#define LARGEST_8 127.0
#define LARGEST_16 32767.0
#define DOUBLE_BIAS 1023
#define DOUBLE_MANTISSA 52 /* bits below the exponent */

static int load_16(const unsigned char *bytes)
{
    return (int16_t)(bytes[0] | (unsigned)bytes[1] << 8);
}

static void store_16(unsigned char *bytes, int value)
{
    bytes[0] = (unsigned char)((unsigned)value & 0xff);
    bytes[1] = (unsigned char)((unsigned)value >> 8 & 0xff);
}

/* Rounds to the nearest integer, halves away from zero. Values out of range, in broken data, are clamped. */
static int to_integer(double value, double largest)
{
    const double whole = value < 0 ? ceil_of(value - 0.5) : floor_of(value + 0.5);
    return (int)maximum_number(minimum_number(whole, largest), -largest);
}

/* Converts integers in octahedral encoding, in which `one` is the coordinate of a corner, to integers of a
   unit vector. Everything before the square root is exact. */
static void unfold(const int from[3], double largest, int to[3])
{
    const double one = from[2];
    double x = from[0], y = from[1];
    const double z = one - fabs(x) - fabs(y);
    /* The lower hemisphere is folded outward. */
    const double outside = z < 0 ? -z : 0;
    x += x < 0 ? outside : -outside;
    y += y < 0 ? outside : -outside;
    const double length = sqrt(x * x + y * y + z * z), numbers[3] = {x, y, z};
    for (int a = 0; a < 3; a++)
        to[a] = length > 0 ? to_integer(numbers[a] * largest / length, largest) : 0;
}

void ffd_meshopt_unfold(unsigned char *bytes, size_t count, size_t stride)
{
    int from[3], to[3];
    for (unsigned char *at = bytes; at < bytes + count * stride; at += stride) {
        for (int a = 0; a < 3; a++)
            from[a] = stride == 4 ? (int8_t)at[a] : load_16(at + 2 * a);
        unfold(from, stride == 4 ? LARGEST_8 : LARGEST_16, to);
        for (int a = 0; a < 3; a++) {
            if (stride == 4)
                at[a] = (unsigned char)((unsigned)to[a] & 0xff);
            else
                store_16(at + 2 * a, to[a]);
        }
    }
}

/* Three components are stored, in units of 1 / (`one` sqrt(2)); the fourth is the largest, and not
   negative. */
static void complete(unsigned char *bytes)
{
    const int last = load_16(bytes + 6), largest = last & 3;
    const double one = last | 3, square = 2 * one * one;
    double rest = square;
    int to[4];
    for (int a = 0; a < 3; a++) {
        const double part = load_16(bytes + 2 * a);
        to[(largest + 1 + a) % 4] = to_integer(part * LARGEST_16 / sqrt(square), LARGEST_16);
        rest -= part * part;
    }
    to[largest] = to_integer(sqrt(maximum_number(rest, 0) / square) * LARGEST_16, LARGEST_16);
    for (int a = 0; a < 4; a++)
        store_16(bytes + 2 * a, to[a]);
}

void ffd_meshopt_complete_rotations(unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        complete(bytes + 8 * i);
}

void ffd_meshopt_find_exponents(const unsigned char *bytes, size_t count, size_t stride, int8_t *exponents)
{
    const size_t columns = stride / 4;
    for (size_t c = 0; c < columns; c++)
        exponents[c] = INT8_MAX;
    for (size_t i = 0; i < count * columns; i++) {
        const uint32_t bits = load_u32(bytes + 4 * i);
        const int8_t exponent = (int8_t)(unsigned char)(bits >> 24);
        int8_t *const least = &exponents[i % columns];
        if (bits << 8 && exponent < *least)
            *least = exponent;
    }
    for (size_t c = 0; c < columns; c++)
        if (exponents[c] == INT8_MAX)
            exponents[c] = INT8_MIN;
}

/* Returns 2^exponent of a number of 8 bits. ldexp would be ten times as slow. */
static double power_of_two(int exponent)
{
    const uint64_t bits = (uint64_t)(exponent + DOUBLE_BIAS) << DOUBLE_MANTISSA;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* A double holds each of the products exactly. */
void ffd_meshopt_scale(unsigned char *bytes, size_t count, size_t stride)
{
    for (size_t i = 0; i < count * (stride / 4); i++) {
        const uint32_t bits = load_u32(bytes + 4 * i);
        const int32_t mantissa = (int32_t)(bits & 0x7fffff) - (int32_t)(bits & 0x800000);
        store_float(bytes + 4 * i, (float)(mantissa * power_of_two((int8_t)(unsigned char)(bits >> 24))));
    }
}

static int limit(double value, double largest)
{
    return (int)(maximum_number(minimum_number(value, largest), 0) + 0.5);
}

/* Converts a colour of luma, two differences of colour, and alpha, whose highest bit tells the scale. */
static void mix(const int from[4], double largest, int to[4])
{
    int scale = from[3];
    for (int shift = 1; shift < 16; shift *= 2)
        scale |= scale >> shift;
    const int alpha = from[3] & scale >> 1, base = from[0] - from[2];
    const int mixed[4] = {base + from[1], from[0] + from[2], base - from[1], alpha << 1 | (alpha & 1)};
    for (int c = 0; c < 4; c++)
        to[c] = scale > 0 ? limit(mixed[c] * largest / scale, largest) : 0;
}

void ffd_meshopt_mix_colors(unsigned char *bytes, size_t count, size_t stride)
{
    int to[4];
    for (unsigned char *at = bytes; at < bytes + count * stride; at += stride)
        if (stride == 4) {
            mix((const int[4]){at[0], (int8_t)at[1], (int8_t)at[2], at[3]}, UINT8_MAX, to);
            for (int c = 0; c < 4; c++)
                at[c] = (unsigned char)to[c];
        } else {
            mix((const int[4]){load_16(at) & UINT16_MAX, load_16(at + 2), load_16(at + 4),
                               load_16(at + 6) & UINT16_MAX},
                UINT16_MAX, to);
            for (int c = 0; c < 4; c++)
                store_16(at + 2 * c, to[c]);
        }
}
