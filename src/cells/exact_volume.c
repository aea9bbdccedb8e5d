#include "cells/exact_volume.h"
#include "base/arithmetic.h"
#include <stdbool.h>
#include <stdint.h>

/* A product of three differences of doubles has at most 3 * 2099 bits, a sum of six of them three more. */
#define LIMBS 200

/* sign * sum of limb[i] 2^(32 i). The highest limb of count is not 0. */
typedef struct whole {
    int sign; /* -1, 0 or 1 */
    int count;
    uint32_t limb[LIMBS];
} whole;

static void trim(whole *x)
{
    while (x->count > 0 && x->limb[x->count - 1] == 0)
        x->count--;
    if (x->count == 0)
        x->sign = 0;
}

/* Converts x / 2^base, which is whole. */
static void make(double x, int base, whole *result)
{
    int exponent;
    const double fraction = frexp(fabs(x), &exponent);
    uint64_t bits = (uint64_t)(fraction * 0x1p53);
    int shift = exponent - 53 - base;
    *result = (whole){.sign = x < 0 ? -1 : 1};
    for (; shift < 0 && bits; shift++) /* of the smallest numbers, whose last bits are 0 */
        bits >>= 1;
    const int first = shift / 32, within = shift % 32;
    if (bits) {
        result->limb[first] = (uint32_t)(bits << within);
        result->limb[first + 1] = (uint32_t)((bits >> 1) >> (31 - within));
        result->limb[first + 2] = within ? (uint32_t)((bits >> 32) >> (32 - within)) : 0;
        result->count = first + 3;
    }
    trim(result);
}

/* Whether |x| < |y|. */
static bool is_less(const whole *x, const whole *y)
{
    if (x->count != y->count)
        return x->count < y->count;
    for (int i = x->count - 1; i >= 0; i--)
        if (x->limb[i] != y->limb[i])
            return x->limb[i] < y->limb[i];
    return false;
}

/* x += factor y, for a factor of 1 or -1. */
static void add(whole *x, const whole *y, int factor)
{
    const int sign = y->sign * factor;
    uint64_t carry = 0;
    if (sign == 0)
        return;
    if (x->sign == -sign) {
        const bool less = is_less(x, y);
        const whole *const large = less ? y : x, *const small = less ? x : y;
        const int count = large->count;
        for (int i = 0; i < count; i++) {
            const uint64_t taken = (i < small->count ? small->limb[i] : 0) + carry;
            carry = large->limb[i] < taken;
            x->limb[i] = (uint32_t)(large->limb[i] - taken);
        }
        x->sign = less ? sign : x->sign;
        x->count = count;
    } else {
        const int count = x->count > y->count ? x->count : y->count;
        for (int i = 0; i < count; i++) {
            carry += (uint64_t)(i < x->count ? x->limb[i] : 0) + (i < y->count ? y->limb[i] : 0);
            x->limb[i] = (uint32_t)carry;
            carry >>= 32;
        }
        x->limb[count] = (uint32_t)carry;
        x->count = count + 1;
        x->sign = sign;
    }
    trim(x);
}

static void multiply(const whole *x, const whole *y, whole *result)
{
    *result = (whole){.sign = x->sign * y->sign, .count = x->count + y->count};
    for (int i = 0; i < x->count; i++) {
        uint64_t carry = 0;
        for (int k = 0; k < y->count; k++) {
            carry += result->limb[i + k] + (uint64_t)x->limb[i] * y->limb[k];
            result->limb[i + k] = (uint32_t)carry;
            carry >>= 32;
        }
        result->limb[i + y->count] = (uint32_t)carry;
    }
    trim(result);
}

/* Returns x 2^exponent: its sign, and some 64 of its bits. */
static double value_of(const whole *x, int exponent)
{
    double value = 0;
    if (x->sign == 0)
        return 0;
    for (int i = x->count - 1; i >= 0 && i >= x->count - 3; i--)
        value = value * 0x1p32 + x->limb[i];
    const int left = x->count > 3 ? x->count - 3 : 0;
    value = ldexp(value, exponent + 32 * left);
    return x->sign * (value > 0 ? value : 0x1p-1074);
}

/* Returns the exponent of the lowest bit that any of these numbers may have. */
static int lowest_bit(const double *const points[4])
{
    int lowest = 2000, exponent;
    for (int p = 0; p < 4; p++)
        for (int a = 0; a < 3; a++) {
            frexp(points[p][a], &exponent);
            if (points[p][a] != 0 && exponent - 53 < lowest)
                lowest = exponent - 53;
        }
    return lowest == 2000 ? 0 : lowest < -1074 ? -1074 : lowest;
}

/* By whole numbers, without rounding. */
static double by_wholes(const double *const points[4])
{
    const int base = lowest_bit(points);
    whole edges[3][3], product, minor, sum = {0};
    for (int p = 0; p < 3; p++)
        for (int a = 0; a < 3; a++) {
            whole start;
            make(points[p + 1][a], base, &edges[p][a]);
            make(points[0][a], base, &start);
            add(&edges[p][a], &start, -1);
        }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        multiply(&edges[1][b], &edges[2][c], &minor);
        multiply(&edges[1][c], &edges[2][b], &product);
        add(&minor, &product, -1);
        multiply(&edges[0][a], &minor, &product);
        add(&sum, &product, 1);
    }
    return value_of(&sum, 3 * base);
}

/* The error of the determinant of differences, relative to its permanent, is at most (7 + 56 u) u with
   u = 2^-53 (Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates,
   1997, 4.3), unless products underflow: they do not where both bounds hold. */
#define RELATIVE_ERROR 0x1p-50
#define LEAST_PERMANENT 0x1p-700
#define LARGEST_EDGE 0x1p300

double ffd_exact_volume(const double a[3], const double b[3], const double c[3], const double d[3])
{
    const double *const points[4] = {a, b, c, d};
    double e[3][3], volume = 0, permanent = 0, largest = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < 3; i++) {
            e[p][i] = points[p + 1][i] - a[i];
            largest = larger_of(largest, fabs(e[p][i]));
        }
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3, l = (i + 2) % 3;
        const double left = e[1][k] * e[2][l], right = e[1][l] * e[2][k];
        volume += e[0][i] * (left - right);
        permanent += fabs(e[0][i]) * (fabs(left) + fabs(right));
    }
    if (largest <= LARGEST_EDGE && permanent >= LEAST_PERMANENT && fabs(volume) > RELATIVE_ERROR * permanent)
        return volume;
    return by_wholes(points);
}
