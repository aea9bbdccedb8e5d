/* decimal_parse.c - reads the decimal numbers for which a single division is correctly rounded. */
#include "base/text/decimal.h"
#include <stdbool.h>
#include <stdint.h>

/* The most digits that are read: with more, a 64-bit number could wrap round. */
#define MOST_DIGITS (POWERS_OF_TEN - 1)

static unsigned digit_of(char c)
{
    return (unsigned)(unsigned char)c - '0';
}

static const char *take_digits(const char *at, const char *last, uint64_t *number)
{
    uint64_t n = *number;
    for (; at < last && digit_of(*at) < 10; at++)
        n = n * 10 + digit_of(*at);
    *number = n;
    return at;
}

const double ffd_powers_of_ten[2][POWERS_OF_TEN] = {
    {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
     1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19},
    {-1e0,  -1e1,  -1e2,  -1e3,  -1e4,  -1e5,  -1e6,  -1e7,  -1e8,  -1e9,
     -1e10, -1e11, -1e12, -1e13, -1e14, -1e15, -1e16, -1e17, -1e18, -1e19},
};

const char *ffd_decimal_parse(const char *first, const char *last, double *value)
{
    const bool negative = first < last && *first == '-';
    const char *const digits = first + negative;
    uint64_t number = 0;
    ptrdiff_t behind = 0;
    const char *at = take_digits(digits, last, &number);
    ptrdiff_t count = at - digits;
    if (at < last && *at == '.') {
        const char *const point = at;
        at = take_digits(point + 1, last, &number);
        behind = at - point - 1;
        count += behind;
    }
    /* With more digits the number may have wrapped round. */
    if (count == 0 || count > MOST_DIGITS || number > (uint64_t)1 << 53 ||
        (at < last && (*at == 'e' || *at == 'E')))
        return NULL;
    return ffd_decimal_quotient((int64_t)number, (int)behind, negative, value) ? at : NULL;
}
