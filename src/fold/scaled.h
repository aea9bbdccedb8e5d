/* scaled.h - positive numbers with a separate exponent, whose products do not overflow or underflow. */
#ifndef FFD_FOLD_SCALED_H
#define FFD_FOLD_SCALED_H

#include <float.h>
#include <math.h>

typedef struct scaled {
    double mantissa; /* 1/2 <= mantissa < 1 */
    int exponent;
} scaled;

static inline scaled scaled_make(double value, int exponent)
{
    scaled result;
    result.mantissa = frexp(value, &result.exponent);
    result.exponent += exponent;
    return result;
}

static inline scaled scaled_multiply(scaled a, scaled b)
{
    return scaled_make(a.mantissa * b.mantissa, a.exponent + b.exponent);
}

static inline scaled scaled_divide(scaled a, scaled b)
{
    return scaled_make(a.mantissa / b.mantissa, a.exponent - b.exponent);
}

/* Returns value times factor, limited to magnitudes up to DBL_MAX. */
static inline double scaled_apply(double value, scaled factor)
{
    const double result = ldexp(value * factor.mantissa, factor.exponent);
    return result > DBL_MAX ? DBL_MAX : result < -DBL_MAX ? -DBL_MAX : result;
}

#endif
