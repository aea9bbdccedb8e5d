/* exponential_lanes.h - e^x and the natural logarithm for kernels, with the same operations in the same order
   as exponential.c. */
#ifndef FFD_BASE_VECTOR_EXPONENTIAL_LANES_H
#define FFD_BASE_VECTOR_EXPONENTIAL_LANES_H

#include "base/vector/exponential_terms.h"
#include "base/vector/lanes.h"

/* Adding this to a number below 2^51 leaves the nearest integer in the lowest bits of the sum. */
#define WHOLE_BITS 0x1.8p52

static ALWAYS_INLINE lanes lanes_exp(lanes x)
{
    const lanes shifted = x * LOG2_E + WHOLE_BITS, k = shifted - WHOLE_BITS;
    const lanes r = (x - k * LN2_HIGH) - k * LN2_LOW;
    const mask bits = ((mask)shifted - (mask)lanes_all(WHOLE_BITS) + EXPONENT_BIAS) << EXPONENT_AT;
    lanes sum = lanes_all(inverse_factorials[EXP_TERMS]);
    for (int i = EXP_TERMS; i-- > 0;)
        sum = inverse_factorials[i] + r * sum;
    return (lanes)bits * sum;
}

static ALWAYS_INLINE lanes lanes_log(lanes x)
{
    const mask one = (mask)lanes_all(1), whole = (mask)lanes_all(WHOLE_BITS);
    const mask exponents = ((mask)x >> EXPONENT_AT) - EXPONENT_BIAS;
    lanes m = (lanes)(((mask)x & (((int64_t)1 << EXPONENT_AT) - 1)) | one), sum = lanes_all(0);
    const mask is_large = m > ROOT_2;
    const lanes exponent = (lanes)(exponents - is_large + whole) - WHOLE_BITS;
    m = lanes_choose(is_large, 0.5 * m, m);
    const lanes z = (m - 1.0) / (m + 1.0), square = z * z;
    for (int i = ARTANH_TERMS; i-- > 0;)
        sum = square * (artanh[i] + sum);
    return exponent * LN2_HIGH + (2.0 * (z + z * sum) + exponent * LN2_LOW);
}

#endif
