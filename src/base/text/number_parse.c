/* number_parse.c - reads numbers, to the nearest double or float. */
#include "base/text/decimal.h"
#include "base/text/number.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The number of arbitrary digits that fit in 64 bits. */
#define WHOLE_DIGITS 19

/* A midpoint between two doubles has at most 767 digits. Of the digits after MOST_DIGITS, it only matters
   whether all are 0. */
#define MOST_DIGITS 800

/* With this exponent every number of up to MOST_DIGITS digits overflows or underflows. */
#define MOST_EXPONENT 100000

/* The text of a number without its sign. */
typedef struct decimal_text {
    const char *first, *end; /* of the digits and the point; end is NULL if there is no number */
    uint64_t number;         /* the first digits that are not leading zeros, WHOLE_DIGITS at most */
    long long exponent;      /* decimal exponent of number */
    bool is_cut;             /* digits other than 0 follow */
} decimal_text;

static bool is_digit(const char *at, const char *last)
{
    return at < last && *at >= '0' && *at <= '9';
}

/* Reads the exponent that begins with 'e' at `at`. Returns its end, or `at` if there is none. */
static const char *take_exponent(const char *at, const char *last, long long *exponent)
{
    const char *digit = at + 1;
    if (at == last || (*at != 'e' && *at != 'E'))
        return at;
    const bool negative = digit < last && *digit == '-';
    if (digit < last && (*digit == '-' || *digit == '+'))
        digit++;
    if (!is_digit(digit, last))
        return at;
    long long size = 0;
    for (; is_digit(digit, last); digit++)
        if (size < LLONG_MAX / 100)
            size = size * 10 + (*digit - '0');
    *exponent += negative ? -size : size;
    return digit;
}

/* Returns the end of the digits. The number wraps round if it is too long. */
static const char *take_digits(const char *at, const char *last, uint64_t *number)
{
    uint64_t n = *number;
    for (; is_digit(at, last); at++)
        n = n * 10 + (uint64_t)(*at - '0');
    *number = n;
    return at;
}

/* Reads a number again that may have wrapped round: skips leading zeros, and takes the first digits only. */
static void read_first_digits(decimal_text *text)
{
    int count = 0;
    bool behind_point = false;
    text->number = 0;
    text->exponent = 0;
    for (const char *at = text->first; at < text->end; at++) {
        if (*at == '.') {
            behind_point = true;
            continue;
        }
        if (count == WHOLE_DIGITS) {
            text->is_cut = text->is_cut || *at != '0';
            text->exponent += !behind_point;
            continue;
        }
        text->number = text->number * 10 + (uint64_t)(*at - '0');
        count += text->number > 0;
        text->exponent -= behind_point;
    }
}

/* Returns the end of the number. */
static const char *read_decimal(const char *first, const char *last, decimal_text *text)
{
    *text = (decimal_text){.first = first};
    const char *at = take_digits(first, last, &text->number);
    ptrdiff_t count = at - first;
    if (at < last && *at == '.') {
        const char *const behind = at + 1;
        at = take_digits(behind, last, &text->number);
        text->exponent = behind - at;
        count += at - behind;
    }
    if (count == 0)
        return NULL;
    text->end = at;
    if (count > WHOLE_DIGITS)
        read_first_digits(text);
    return take_exponent(at, last, &text->exponent);
}

/* Returns the end of a word at `at`, in upper or lower case; NULL if it is not there. */
static const char *take_word(const char *at, const char *last, const char *word)
{
    for (; *word; word++, at++)
        if (at == last || (*at | 0x20) != *word)
            return NULL;
    return at;
}

/* Reads inf, infinity, nan, nan(letters, digits, _). */
static const char *take_special(const char *first, const char *last, double *value)
{
    const char *const infinity = take_word(first, last, "infinity");
    const char *end = infinity ? infinity : take_word(first, last, "inf");
    *value = HUGE_VAL;
    if (end)
        return end;
    *value = NAN;
    end = take_word(first, last, "nan");
    if (!end || end == last || *end != '(')
        return end;
    const char *at = end + 1;
    while (at < last &&
           ((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || is_digit(at, last) || *at == '_'))
        at++;
    return at < last && *at == ')' ? at + 1 : end;
}

#ifdef __SIZEOF_INT128__

__extension__ typedef unsigned __int128 uint128;

static int bits_of(uint128 number)
{
    const uint64_t high = (uint64_t)(number >> 64);
    return high ? 128 - __builtin_clzll(high) : 64 - __builtin_clzll((uint64_t)number);
}

/* Rounds number * 2^exponent, which is between 1e-30 and 1e50, to `bits` bits: to nearest, ties to even. */
static double round_to(uint128 number, int exponent, int bits)
{
    const int drop = bits_of(number) - bits;
    if (drop > 0) {
        const uint128 half = (uint128)1 << (drop - 1), low = number & (2 * half - 1);
        number >>= drop;
        number += low > half || (low == half && (number & 1));
        exponent += drop;
    }
    /* Neither factor is near the limits of a double. */
    const uint64_t power_bits = (uint64_t)(exponent + DBL_MAX_EXP - 1) << (DBL_MANT_DIG - 1);
    double power;
    memcpy(&power, &power_bits, sizeof power);
    return (double)(uint64_t)number * power;
}

/* Rounds number * 10^exponent, not 0, to `bits` bits with integer arithmetic only. Returns false if that is
   not enough. */
static bool round_whole(uint64_t number, long long exponent, int bits, double *value)
{
    if (exponent < -MOST_POWER_OF_FIVE || exponent > MOST_POWER_OF_FIVE)
        return false;
    if (exponent >= 0) {
        *value = round_to((uint128)number * ffd_powers_of_five[exponent], (int)exponent, bits);
        return true;
    }
    /* The quotient has 62 to 64 bits, more than are kept, which is what one division instruction gives. Its
       last bit is set if there is a remainder (a sticky bit). */
    const uint64_t power = ffd_powers_of_five[-exponent];
    const int shift = 63 + bits_of(power) - bits_of(number);
    const uint128 scaled = (uint128)number << shift, quotient = scaled / power;
    *value = round_to(quotient | (quotient * power != scaled), (int)exponent - shift, bits);
    return true;
}

#else

static bool round_whole(uint64_t number, long long exponent, int bits, double *value)
{
    (void)number;
    (void)exponent;
    (void)bits;
    (void)value;
    return false;
}

#endif

/* Writes an integer of at most MOST_DIGITS + 1 digits and a decimal exponent: without a decimal point, the C
   library reads it in every locale. */
static void write_whole(const decimal_text *text, char whole[MOST_DIGITS + 32])
{
    size_t count = 0;
    long long exponent = text->exponent;
    bool is_cut = false;
    for (const char *at = text->first; at < text->end; at++) {
        if (*at == '.' || (count == 0 && *at == '0'))
            continue;
        exponent -= count >= WHOLE_DIGITS && count < MOST_DIGITS;
        if (count < MOST_DIGITS)
            whole[count++] = *at;
        else
            is_cut = is_cut || *at != '0';
    }
    if (is_cut) {
        whole[count++] = '1';
        exponent--;
    }
    if (exponent > MOST_EXPONENT || exponent < -MOST_EXPONENT)
        exponent = exponent < 0 ? -MOST_EXPONENT : MOST_EXPONENT;
    snprintf(whole + count, 32, "e%lld", exponent);
}

/* Rounds any number, with the C library. Not inlined, so that the other paths do not need its space on the
   stack. */
__attribute__((noinline)) static double round_long(const decimal_text *text, bool is_float)
{
    char whole[MOST_DIGITS + 32];
    write_whole(text, whole);
    return is_float ? (double)strtof(whole, NULL) : strtod(whole, NULL);
}

/* Rounds a number by its first digits. It lies between the number of these digits and the next number with as
   many digits; both must round to the same value. */
static bool round_decimal(const decimal_text *text, int bits, double *value)
{
    double next;
    if (!round_whole(text->number, text->exponent, bits, value))
        return false;
    return !text->is_cut || (round_whole(text->number + 1, text->exponent, bits, &next) && !(next > *value));
}

/* Reads the number at first, after its sign, as a double or float. */
static const char *parse(const char *first, const char *last, bool is_float, double *value)
{
    decimal_text text;
    const char *const end = read_decimal(first, last, &text);
    if (!end)
        return take_special(first, last, value);
    *value = 0;
    if (text.number != 0 && !round_decimal(&text, is_float ? FLT_MANT_DIG : DBL_MANT_DIG, value))
        *value = round_long(&text, is_float);
    return end;
}

/* Reads the sign, then the number. */
static const char *parse_signed(const char *first, const char *last, bool is_float, double *value)
{
    const bool negative = first < last && *first == '-';
    const char *const end =
        parse(first + (negative || (first < last && *first == '+')), last, is_float, value);
    if (end && negative)
        *value = -*value;
    return end;
}

const char *ffd_number_parse(const char *first, const char *last, double *value)
{
    double parsed;
    const char *end = ffd_decimal_parse(first, last, value);
    if (end)
        return end;
    end = parse_signed(first, last, false, &parsed);
    if (end)
        *value = parsed;
    return end;
}

/* Returns whether a double is a midpoint between two floats. If it is not, rounding a number to double first
   cannot change which float is nearest. */
static bool is_halfway(double value)
{
    const uint64_t half = (uint64_t)1 << (DBL_MANT_DIG - FLT_MANT_DIG - 1);
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & (2 * half - 1)) == half;
}

const char *ffd_number_parse_float(const char *first, const char *last, float *value)
{
    double parsed;
    const char *end = ffd_decimal_parse(first, last, &parsed);
    if (!end || is_halfway(parsed))
        end = parse_signed(first, last, true, &parsed);
    if (end)
        *value = parsed > FLT_MAX ? HUGE_VALF : parsed < -FLT_MAX ? -HUGE_VALF : (float)parsed;
    return end;
}
