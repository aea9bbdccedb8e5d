/* wide.h - numbers of about 70 digits, for signs that doubles cannot tell. */
#ifndef FFD_FOLD_WIDE_H
#define FFD_FOLD_WIDE_H

#include "fold/scaled.h"
#include <stdint.h>

#define WIDE_LIMBS 8

/* sign * sum of limb[i] 2^(32 (exponent - i)). limb[0] is not 0, unless the number is 0. */
typedef struct wide {
    int sign; /* -1, 0, 1 */
    int exponent;
    uint32_t limb[WIDE_LIMBS];
} wide;

/* Returns a finite number, exactly. */
wide ffd_wide_of(double value);
/* Returns the sum. It is exact, or off by less than 2^-223 of the larger operand. */
wide ffd_wide_add(const wide *a, const wide *b);
/* Returns the product. It is exact, or off by less than 2^-223 of itself. */
wide ffd_wide_multiply(const wide *a, const wide *b);

static inline wide wide_negative(const wide *a)
{
    wide result = *a;
    result.sign = -a->sign;
    return result;
}

static inline wide wide_size(const wide *a)
{
    wide result = *a;
    result.sign = a->sign != 0;
    return result;
}

static inline wide wide_subtract(const wide *a, const wide *b)
{
    const wide minus = wide_negative(b);
    return ffd_wide_add(a, &minus);
}

/* Returns the size of a number, rounded to a double's digits. */
scaled ffd_wide_scaled(const wide *a);

#endif
