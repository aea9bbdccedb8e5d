#include "base/text/decimal.h"
#include "base/inline.h"
#include "base/little_endian.h"
#include "base/text/decimal_kernel.h"
#include "base/vector/isa.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifdef __SIZEOF_INT128__

__extension__ typedef unsigned __int128 uint128;

const uint64_t ffd_powers_of_five[POWERS_OF_FIVE] = {
    UINT64_C(1),
    UINT64_C(5),
    UINT64_C(25),
    UINT64_C(125),
    UINT64_C(625),
    UINT64_C(3125),
    UINT64_C(15625),
    UINT64_C(78125),
    UINT64_C(390625),
    UINT64_C(1953125),
    UINT64_C(9765625),
    UINT64_C(48828125),
    UINT64_C(244140625),
    UINT64_C(1220703125),
    UINT64_C(6103515625),
    UINT64_C(30517578125),
    UINT64_C(152587890625),
    UINT64_C(762939453125),
    UINT64_C(3814697265625),
    UINT64_C(19073486328125),
    UINT64_C(95367431640625),
    UINT64_C(476837158203125),
    UINT64_C(2384185791015625),
    UINT64_C(11920928955078125),
    UINT64_C(59604644775390625),
    UINT64_C(298023223876953125),
    UINT64_C(1490116119384765625),
};

/* LEAST_WIDE_EXPONENT: the least binary exponent that shortest_wide can convert. FLOAT_BITS: stored bits of a
   float's mantissa. */
#define LEAST_WIDE_EXPONENT (-172)
#define FLOAT_BITS 23

/* Returns the power of ten, 10^point, that scales the rounding interval of a double with this binary exponent
   to a width of 1 to 10. */
static int point_of(int exponent)
{
    return (-exponent * 315653 + (1 << 20) - 1) >> 20; /* ceil(-exponent log10(2)) */
}

/* Returns mantissa * 2^exponent * 10^point rounded to an integer of 16 or 17 digits: of the integers in the
   rounding interval (between the midpoints to the neighbouring doubles) the one with the most trailing zeros,
   and of these the nearest.

   The interval is 1 to 10 wide, so it contains an integer, and at most one multiple of 10. That multiple is
   the shortest; without one, all integers in the interval are equally short, and the nearest is best
   (Giulietti, The Schubfach way to render doubles, 2020, section 8). The arithmetic is in integers, in units
   of 2^-shift, and exact. Powers of two are not handled here, because their lower midpoint is nearer. There
   are no branches, because they would be unpredictable. */
static ALWAYS_INLINE uint64_t shortest(uint64_t mantissa, int exponent, int point)
{
    const int shift = 2 - exponent - point; /* 2 to 60, so that 10 * 2^shift fits in 64 bits */
    const uint64_t five = ffd_powers_of_five[point];
    const uint128 scaled = (uint128)(4 * mantissa) * five;
    const uint64_t low = (uint64_t)scaled, unit = (uint64_t)1 << shift;
    const uint64_t whole = (uint64_t)(scaled >> 64) << (64 - shift) | low >> shift;
    const uint64_t part = low & (unit - 1);
    const uint64_t reach = 2 * five - (mantissa & 1); /* a midpoint rounds to the even mantissa */
    const uint64_t last_digit = whole % 10, above_ten = (last_digit << shift) + part;
    const uint64_t down = above_ten <= reach, up = 10 * unit - above_ten <= reach;
    const uint64_t nearest = whole + (part + (whole & 1) > unit / 2);
    const uint64_t tens = whole - last_digit + 10 * up;
    return nearest + ((tens - nearest) & (0 - (down | up)));
}

/* The same for numbers that need powers of five beyond 64 bits. */
static uint64_t shortest_wide(uint64_t mantissa, int exponent, int point)
{
    const int shift = 2 - exponent - point; /* at most 122, so that 10 * 2^shift fits in 128 bits */
    const int more = point > MOST_POWER_OF_FIVE ? point - MOST_POWER_OF_FIVE : 0;
    const uint128 five = (uint128)ffd_powers_of_five[point - more] * ffd_powers_of_five[more];
    const uint128 low = (uint128)(4 * mantissa) * (uint64_t)five;
    const uint128 high = (uint128)(4 * mantissa) * (uint64_t)(five >> 64) + (low >> 64);
    const uint128 unit = (uint128)1 << shift;
    /* The product is high * 2^64 plus the lower half of low. */
    const uint128 lower = high << 64 | (uint64_t)low;
    const uint64_t whole =
        (uint64_t)(shift < 64 ? high << (64 - shift) | (uint64_t)low >> shift : high >> (shift - 64));
    const uint128 part = lower & (unit - 1), reach = 2 * five - (mantissa & 1);
    const uint64_t last_digit = whole % 10;
    const uint128 above_ten = ((uint128)last_digit << shift) + part;
    if (above_ten <= reach)
        return whole - last_digit;
    if (10 * unit - above_ten <= reach)
        return whole - last_digit + 10;
    return whole + (part + (whole & 1) > unit / 2);
}

#define DIGITS 17
#define EIGHT UINT32_C(100000000)

/* Up to 24 characters in registers, the first in the lowest byte. In memory, a word load of bytes that were
   just stored would stall (no store forwarding). */
typedef struct characters {
    uint64_t first, middle, last;
} characters;

static void put(characters from, char *to)
{
    store_u64((unsigned char *)to, from.first);
    store_u64((unsigned char *)to + 8, from.middle);
    store_u64((unsigned char *)to + 16, from.last);
}

/* Returns the 8 digits of a number below 10^8, one in each byte. */
static uint64_t eight_digits(uint32_t value)
{
    const uint32_t high = value / 10000;
    const uint64_t fours = high | (uint64_t)(value - high * 10000) << 32;
    const uint64_t hundreds = (fours * 10486 >> 20) & UINT64_C(0x0000007f0000007f);
    const uint64_t pairs = hundreds | (fours - 100 * hundreds) << 16;
    const uint64_t tens = (pairs * 103 >> 10) & UINT64_C(0x000f000f000f000f);
    return tens | (pairs - 10 * tens) << 8;
}

/* The 17 shortest digits of a number, values 0 to 9: the first one (0 if there are 16), then two groups of
   eight, one in each byte, the most significant in the lowest byte. */
typedef struct number_digits {
    uint64_t first, middle, low;
} number_digits;

static ALWAYS_INLINE number_digits digits_of(uint64_t number)
{
    const uint32_t upper = (uint32_t)(number / EIGHT), first = upper / EIGHT;
    return (number_digits){first, eight_digits(upper - first * EIGHT),
                           eight_digits((uint32_t)(number - (uint64_t)upper * EIGHT))};
}

/* Returns the number of trailing zeros. */
static int final_zeros(number_digits digits)
{
    return digits.low      ? __builtin_clzll(digits.low) / 8
           : digits.middle ? 8 + __builtin_clzll(digits.middle) / 8
                           : 16;
}

static characters characters_of(number_digits digits)
{
    const uint64_t text = UINT64_C(0x3030303030303030);
    const int shift = digits.first ? 8 : 0; /* if there are 17 digits */
    return (characters){(digits.middle << shift | digits.first) + text,
                        (digits.low << shift | digits.middle >> 1 >> (63 - shift)) + text,
                        (digits.low >> 1 >> (63 - shift)) + text};
}

/* Inserts a decimal point after the first 1 to 7 digits. */
static characters with_point(characters digits, int before_point)
{
    const int at = 8 * before_point;
    const uint64_t before = ((uint64_t)1 << at) - 1;
    return (characters){(digits.first & before) | (uint64_t)'.' << at | (digits.first & ~before) << 8,
                        digits.middle << 8 | digits.first >> 56, digits.last << 8 | digits.middle >> 56};
}

static char *put_fixed(char *to, characters digits, int count, int before_point)
{
    if (before_point <= 0) {
        memcpy(to, "0.0000", 6);
        put(digits, to + 2 - before_point);
        return to + 2 - before_point + count;
    }
    put(digits, to);
    if (before_point >= count)
        return to + before_point; /* the trailing zeros are part of the digits */
    memmove(to + before_point + 1, to + before_point, (size_t)(count - before_point));
    to[before_point] = '.';
    return to + count + 1;
}

static char *put_scientific(char *to, characters digits, int count, int exponent)
{
    const int size = exponent < 0 ? -exponent : exponent;
    put(with_point(digits, 1), to);
    to += count > 1 ? count + 1 : 1;
    *to++ = 'e';
    *to++ = exponent < 0 ? '-' : '+';
    *to++ = (char)('0' + size / 10);
    *to++ = (char)('0' + size % 10);
    return to;
}

/* Writes the number in positional or scientific form, whichever is shorter. */
static ALWAYS_INLINE char *put_number(char *to, characters digits, int count, int before_point)
{
    if (before_point > 0 && before_point < 8 && before_point < count) {
        put(with_point(digits, before_point), to);
        return to + count + 1;
    }
    const int fixed = before_point <= 0      ? 2 - before_point + count
                      : before_point < count ? count + 1
                                             : before_point;
    const int scientific = count + (count > 1) + 4;
    return fixed <= scientific ? put_fixed(to, digits, count, before_point)
                               : put_scientific(to, digits, count, before_point - 1);
}

static ALWAYS_INLINE size_t put_digits(double value, number_digits digits, int point, char *text)
{
    const int length = digits.first ? DIGITS : DIGITS - 1;
    *text = '-';
    char *const first = text + (signbit(value) ? 1 : 0);
    return (size_t)(put_number(first, characters_of(digits), length - final_zeros(digits), length - point) -
                    text);
}

#define LEAST_OF_DIGITS UINT64_C(1000000000000000) /* the least number with DIGITS - 1 digits */

/* Returns 2^exponent with all its decimal digits, as an integer times 10^-point. For these exponents it has
   no more digits than the type always preserves, so no shorter text reads back as the same number. */
static uint64_t power_of_two(int exponent, int *point)
{
    uint64_t number = exponent < 0 ? ffd_powers_of_five[-exponent] : (uint64_t)1 << exponent;
    *point = exponent < 0 ? -exponent : 0;
    for (; number < LEAST_OF_DIGITS; number *= 10)
        ++*point;
    return number;
}

size_t ffd_decimal_format(double value, char text[FFD_NUMBER_CAPACITY])
{
    uint64_t bits, number;
    memcpy(&bits, &value, sizeof bits);
    const uint64_t hidden = (uint64_t)1 << MANTISSA_BITS, fraction = bits & (hidden - 1);
    const int exponent = (int)(bits >> MANTISSA_BITS & 0x7ff) - 1075, size = exponent + MANTISSA_BITS;
    int point = point_of(exponent);
    if (fraction != 0 && exponent >= LEAST_EXPONENT && exponent < 0)
        number = shortest(fraction | hidden, exponent, point);
    else if (fraction == 0 && size >= -21 && size <= 49) /* 15 digits */
        number = power_of_two(size, &point);
    else if (fraction != 0 && exponent >= LEAST_WIDE_EXPONENT && exponent < 0)
        number = shortest_wide(fraction | hidden, exponent, point);
    else
        return 0;
    return put_digits(value, digits_of(number), point, text);
}

/* Extends 7 to 9 digits to the number of digits of a double. */
static uint64_t widen(uint64_t number, int *point)
{
    const bool is_short = number < EIGHT;
    *point += is_short ? 9 : 8;
    return number * (is_short ? 10 * (uint64_t)EIGHT : EIGHT);
}

size_t ffd_decimal_format_float(float value, char text[FFD_NUMBER_CAPACITY])
{
    uint32_t bits;
    uint64_t number;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t hidden = (uint32_t)1 << FLOAT_BITS, fraction = bits & (hidden - 1);
    const int exponent = (int)(bits >> FLOAT_BITS & 0xff) - 150, size = exponent + FLOAT_BITS;
    int point = point_of(exponent);
    if (fraction != 0 && exponent >= LEAST_EXPONENT && exponent < 0)
        number = widen(shortest(fraction | hidden, exponent, point), &point);
    else if (fraction == 0 && size >= -8 && size <= 19) /* 6 digits */
        number = power_of_two(size, &point);
    else if (fraction != 0 && exponent >= -149 && exponent < 0)
        number = widen(shortest_wide(fraction | hidden, exponent, point), &point);
    else
        return 0;
    return put_digits((double)value, digits_of(number), point, text);
}

/* Numbers of a run that are at most this many elements apart count as near. */
#define NEAR 8

/* Returns NULL if formatting the numbers one by one is as fast. */
static decimal_kernel *find_kernel(void)
{
#ifdef FFD_X86
    if (ffd_isa_available(FFD_ISA_AVX512))
        return ffd_decimal_kernel_avx512;
#endif
    return NULL;
}

/* Makes the text of a number available in the run, and returns whether it is. Formats ahead only if the
   previous request was near: for an array that is read in another order, most of those texts would never be
   used. */
static bool reach(decimal_run *run, const double *value)
{
    const double *const before = run->before;
    run->before = value;
    if (run->first && value >= run->first && value < run->first + DECIMAL_BATCH)
        return true;
    if (!run->kernel || !before || value < before || value - before > NEAR ||
        run->end - value < (ptrdiff_t)DECIMAL_BATCH)
        return false;
    run->first = value;
    run->kernel(value, &run->batch);
    return true;
}

void ffd_decimal_run_begin(decimal_run *run, const double *end)
{
    run->first = run->before = NULL;
    run->end = end;
    run->kernel = find_kernel();
}

size_t ffd_decimal_run_format(decimal_run *run, const double *value, char text[FFD_NUMBER_CAPACITY])
{
    if (!reach(run, value))
        return ffd_number_format(*value, text);
    const size_t i = (size_t)(value - run->first);
    const decimal_batch *const batch = &run->batch;
    if (batch->size[i] == 0)
        return ffd_number_format(*value, text);
    put((characters){batch->words[0][i], batch->words[1][i], batch->words[2][i]}, text);
    return (size_t)batch->size[i];
}

#else

size_t ffd_decimal_format_float(float value, char text[FFD_NUMBER_CAPACITY])
{
    (void)value;
    (void)text;
    return 0;
}

void ffd_decimal_run_begin(decimal_run *run, const double *end)
{
    (void)run;
    (void)end;
}

size_t ffd_decimal_run_format(decimal_run *run, const double *value, char text[FFD_NUMBER_CAPACITY])
{
    (void)run;
    return ffd_number_format(*value, text);
}

size_t ffd_decimal_format(double value, char text[FFD_NUMBER_CAPACITY])
{
    (void)value;
    (void)text;
    return 0;
}

#endif
