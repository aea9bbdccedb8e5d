#include "base/vector/exponential.h"
#include "base/arithmetic.h"
#include "base/vector/exponential_terms.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

double ffd_exp(double x)
{
    const double k = nearest_integer(x * LOG2_E);
    const double r = (x - k * LN2_HIGH) - k * LN2_LOW;
    const uint64_t bits = (uint64_t)((int64_t)k + EXPONENT_BIAS) << EXPONENT_AT;
    double sum = inverse_factorials[EXP_TERMS], power;
    for (int i = EXP_TERMS; i-- > 0;)
        sum = inverse_factorials[i] + r * sum;
    memcpy(&power, &bits, sizeof power);
    return power * sum;
}

double ffd_log(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int exponent = (int)(bits >> EXPONENT_AT) - EXPONENT_BIAS;
    double m, sum = 0;
    bits = (bits & (((uint64_t)1 << EXPONENT_AT) - 1)) | (uint64_t)EXPONENT_BIAS << EXPONENT_AT;
    memcpy(&m, &bits, sizeof m); /* in [1, 2) */
    if (m > ROOT_2) {
        m *= 0.5;
        exponent++;
    }
    const double z = (m - 1) / (m + 1), square = z * z;
    for (int i = ARTANH_TERMS; i-- > 0;)
        sum = square * (artanh[i] + sum);
    return exponent * LN2_HIGH + (2 * (z + z * sum) + exponent * LN2_LOW);
}
