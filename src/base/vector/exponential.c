#include "base/vector/exponential.h"
#include <math.h>

/* ln 2 in two parts: products of the first with exponents of doubles are exact. */
#define LN2_HIGH 6.93147180369123816490e-01
#define LN2_LOW 1.90821492927058770002e-10
#define LOG2_E 1.44269504088896338700

/* Terms of Taylor's series: the first one left out is below 4e-18 for |r| <= ln 2 / 2. */
#define EXP_TERMS 13

double ffd_exp(double x)
{
    const double k = rint(x * LOG2_E);
    const double r = (x - k * LN2_HIGH) - k * LN2_LOW;
    double sum = 1;
    for (int i = EXP_TERMS; i > 0; i--)
        sum = 1 + r / i * sum;
    return ldexp(sum, (int)k);
}

/* log m = 2 artanh z with z = (m - 1)/(m + 1), and |z| < 0.172 for m from sqrt(1/2) to sqrt(2). */
#define ARTANH_TERMS 11

double ffd_log(double x)
{
    int exponent;
    double m = frexp(x, &exponent), sum = 0;
    if (m < 0.70710678118654752440) {
        m *= 2;
        exponent--;
    }
    const double z = (m - 1) / (m + 1), square = z * z;
    for (int i = ARTANH_TERMS - 1; i > 0; i--)
        sum = square * (sum + 1.0 / (2 * i + 1));
    return exponent * LN2_HIGH + (2 * (z + z * sum) + exponent * LN2_LOW);
}
