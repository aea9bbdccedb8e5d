/* arithmetic.h - what C's math library has for single numbers: inline, with the same bits on every processor.
   The program calls no other function of that library, which it would otherwise load first: a twelfth of its
   start (tests/bench, subject start). */
#ifndef FFD_BASE_ARITHMETIC_H
#define FFD_BASE_ARITHMETIC_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#if FLT_EVAL_METHOD != 0
#error "numbers are not rounded to their types (-msse2 -mfpmath=sse, -fexcess-precision=fast)"
#endif

/* Returns a if b is NaN, and NaN if a is. */
static inline double lesser_of(double a, double b)
{
    return b < a ? b : a;
}

static inline double larger_of(double a, double b)
{
    return b > a ? b : a;
}

/* Returns the other number if one is NaN: minimumNumber and maximumNumber of IEEE 754-2019, fmin and fmax of
   C. Of zeros they return b. */
static inline double minimum_number(double a, double b)
{
    return a < b || b != b ? a : b;
}

static inline double maximum_number(double a, double b)
{
    return a > b || b != b ? a : b;
}

/* Returns the nearest integer, the even one of two (rint), where that is 0 without a sign. */
static inline double nearest_integer(double x)
{
    const double shift = x < 0 ? -0x1p52 : 0x1p52; /* from 2^52 on the doubles are the integers */
    return fabs(x) < 0x1p52 ? (x + shift) - shift : x;
}

/* floor and ceil of C: x itself where it has no fraction, NaN or an infinity too. */
static inline double floor_of(double x)
{
    if (!(fabs(x) < 0x1p52)) /* from there on the doubles are integers */
        return x;
    const double whole = (double)(int64_t)x;
    return whole > x ? whole - 1 : whole < x ? whole : x;
}

static inline double ceil_of(double x)
{
    return -floor_of(-x);
}

/* Returns the largest integer that is not above x; |x| < 2^63. */
static inline int64_t integer_below(double x)
{
    const int64_t towards_zero = (int64_t)x;
    return towards_zero - (x < (double)towards_zero);
}

/* Returns the next double above x, which is positive or 0 and finite (nextafter). */
static inline double next_above(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits++;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline float next_float_above(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits++;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Returns the next double below a finite x (nextafter). */
static inline double next_below(double x)
{
    if (x == 0)
        return -next_above(0);
    if (x < 0)
        return -next_above(-x);
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits--;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Returns the remainder of x by m with the sign of x (fmod); NaN of an infinite x. m > 0 and finite. Each
   difference is exact: both numbers are multiples of the last place of the smaller one, and what is left is
   less than it. */
static inline double remainder_of(double x, double m)
{
    double size = fabs(x);
    if (!(size >= m))
        return x;
    if (size > DBL_MAX)
        return NAN;
    int of_size, of_m;
    frexp(m, &of_m);
    while (size >= m) {
        frexp(size, &of_size);
        double multiple = ldexp(m, of_size - of_m);
        if (multiple > size)
            multiple = ldexp(m, of_size - of_m - 1);
        size -= multiple;
    }
    return x < 0 ? -size : size;
}

#endif
