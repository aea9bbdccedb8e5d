#include "fold/wide.h"
#include <string.h>

enum { N = WIDE_LIMBS };

wide ffd_wide_of(double value)
{
    wide result = {0};
    int exponent;
    const double mantissa = frexp(fabs(value), &exponent);
    if (value == 0)
        return result;
    result.sign = value < 0 ? -1 : 1;
    /* The first limb holds 1 to 32 bits. */
    result.exponent = (exponent - 1) / 32 - ((exponent - 1) % 32 < 0);
    const int shift = exponent - 32 * result.exponent + 11; /* of 53 bits in 96 */
    const uint64_t bits = (uint64_t)ldexp(mantissa, 53);
    const uint64_t low = bits << shift;
    result.limb[0] = (uint32_t)(bits >> (64 - shift));
    result.limb[1] = (uint32_t)(low >> 32);
    result.limb[2] = (uint32_t)low;
    return result;
}

/* Removes limbs of 0 at the front; count limbs are given, of which the first has this exponent. */
static wide normalised(int sign, int exponent, const uint32_t *limb, int count)
{
    wide result = {0};
    int first = 0;
    while (first < count && limb[first] == 0)
        first++;
    if (first == count)
        return result;
    result.sign = sign;
    result.exponent = exponent - first;
    for (int i = 0; i < N && first + i < count; i++)
        result.limb[i] = limb[first + i];
    return result;
}

/* Returns whether |a| < |b|. */
static int is_smaller(const wide *a, const wide *b)
{
    if (a->exponent != b->exponent)
        return a->exponent < b->exponent;
    for (int i = 0; i < N; i++)
        if (a->limb[i] != b->limb[i])
            return a->limb[i] < b->limb[i];
    return 0;
}

wide ffd_wide_add(const wide *a, const wide *b)
{
    if (a->sign == 0 || b->sign == 0)
        return a->sign == 0 ? *b : *a;
    const int swap = is_smaller(a, b);
    const wide *large = swap ? b : a, *small = swap ? a : b;
    const int64_t off = (int64_t)large->exponent - small->exponent;
    if (off >= N)
        return *large;
    /* One limb before for a carry, and one after, so that little is lost where the first limbs cancel. */
    uint32_t sum[N + 2] = {0};
    int64_t carry = 0;
    memcpy(sum + 1, large->limb, sizeof large->limb);
    for (int i = N; i >= 0; i--) {
        const int64_t at = i - off;
        const int64_t other = at >= 0 && at < N ? (int64_t)small->limb[at] : 0;
        const int64_t digit = (int64_t)sum[i + 1] + carry + (a->sign == b->sign ? other : -other);
        carry = digit < 0 ? -1 : digit >> 32;
        sum[i + 1] = (uint32_t)digit;
    }
    sum[0] = (uint32_t)carry;
    return normalised(large->sign, large->exponent + 1, sum, N + 2);
}

/* Returns the number of limbs up to the last that is not 0: few for numbers that were doubles. */
static int length_of(const wide *a)
{
    int length = N;
    while (length > 0 && a->limb[length - 1] == 0)
        length--;
    return length;
}

wide ffd_wide_multiply(const wide *a, const wide *b)
{
    uint32_t product[2 * N] = {0};
    if (a->sign == 0 || b->sign == 0)
        return (wide){0};
    const int length = length_of(b);
    for (int i = length_of(a) - 1; i >= 0; i--) {
        uint64_t carry = 0;
        for (int j = length - 1; j >= 0; j--) {
            const uint64_t digit = (uint64_t)a->limb[i] * b->limb[j] + product[i + j + 1] + carry;
            product[i + j + 1] = (uint32_t)digit;
            carry = digit >> 32;
        }
        product[i] = (uint32_t)carry;
    }
    return normalised(a->sign * b->sign, a->exponent + b->exponent + 1, product, 2 * N);
}

scaled ffd_wide_scaled(const wide *a)
{
    const double size = ldexp(a->limb[0], 32) + a->limb[1] + ldexp(a->limb[2], -32);
    return scaled_make(size, 32 * (a->exponent - 1));
}
