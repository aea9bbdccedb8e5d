/* number_format.c - the shortest text of numbers. */
#include "base/text/decimal.h"
#include "base/text/number.h"
#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The decimal digits of a positive number, as an integer to be multiplied by 10^exponent. */
typedef struct shortest_digits {
    char text[DBL_DECIMAL_DIG + 1];
    int count, exponent;
} shortest_digits;

/* Returns whether the digits read back as the value. */
static bool reads_back(const shortest_digits *digits, double value, bool is_float)
{
    char whole[DBL_DECIMAL_DIG + 16]; /* without a decimal point, so that the C library reads it in every
                                         locale */
    snprintf(whole, sizeof whole, "%se%d", digits->text, digits->exponent);
    const double back = is_float ? (double)strtof(whole, NULL) : strtod(whole, NULL);
    return !(back < value) && !(back > value);
}

/* Rounds to count digits. */
static void round_to_digits(double value, int count, shortest_digits *digits)
{
    char text[DBL_DECIMAL_DIG + 16];
    snprintf(text, sizeof text, "%.*e", count - 1, value);
    const char *const exponent = strchr(text, 'e');
    digits->text[0] = text[0];
    memcpy(digits->text + 1, exponent - (count - 1), (size_t)(count - 1)); /* skips the locale's decimal
                                                                              point */
    digits->text[count] = 0;
    digits->count = count;
    digits->exponent = atoi(exponent + 1) - (count - 1);
}

/* Increments the last digit. Returns false if that needs another digit. */
static bool step_up(shortest_digits *digits)
{
    int i = digits->count - 1;
    for (; i >= 0 && digits->text[i] == '9'; i--)
        digits->text[i] = '0';
    if (i >= 0)
        digits->text[i]++;
    return i >= 0;
}

/* Finds the shortest digits of a positive number by trial, with the C library's correctly rounded
   conversions. The neighbour below a power of two is nearer than the one above, so the nearest number of n
   digits may fail to read back while the next larger one does. */
static void find_shortest(double value, bool is_float, shortest_digits *digits)
{
    int exponent;
    const bool is_power_of_two = !(frexp(value, &exponent) > 0.5);
    const int most = is_float ? FLT_DECIMAL_DIG : DBL_DECIMAL_DIG;
    const bool is_normal = value >= (is_float ? FLT_MIN : DBL_MIN);
    /* All normal numbers preserve at least this many digits; subnormal numbers may preserve fewer. */
    for (int count = !is_normal ? 1 : is_float ? FLT_DIG : DBL_DIG;; count++) {
        round_to_digits(value, count, digits);
        if (count == most || reads_back(digits, value, is_float))
            break;
        if (is_power_of_two && step_up(digits) && reads_back(digits, value, is_float))
            break;
    }
    for (; digits->count > 1 && digits->text[digits->count - 1] == '0'; digits->exponent++)
        digits->text[--digits->count] = 0;
}

static size_t write_scientific(const shortest_digits *digits, char *text)
{
    const int exponent = digits->exponent + digits->count - 1;
    return (size_t)snprintf(text, FFD_NUMBER_CAPACITY, "%c%s%se%c%02d", digits->text[0],
                            digits->count > 1 ? "." : "", digits->text + 1, exponent < 0 ? '-' : '+',
                            abs(exponent));
}

static size_t write_fixed(double value, const shortest_digits *digits, char *text)
{
    const int before = digits->count + digits->exponent;
    if (digits->exponent >= 0) /* use all digits of the number instead of zeros */
        return (size_t)snprintf(text, FFD_NUMBER_CAPACITY, "%.0f", value);
    if (before > 0)
        return (size_t)snprintf(text, FFD_NUMBER_CAPACITY, "%.*s.%s", before, digits->text,
                                digits->text + before);
    return (size_t)snprintf(text, FFD_NUMBER_CAPACITY, "0.%.*s%s", -before, "00000000", digits->text);
}

/* Writes the number in positional or scientific form, whichever is shorter. */
static size_t format_positive(double value, bool is_float, char *text)
{
    shortest_digits digits;
    if (isnan(value) || isinf(value)) {
        memcpy(text, isnan(value) ? "nan" : "inf", 3);
        return 3;
    }
    if (!(value > 0)) {
        *text = '0';
        return 1;
    }
    find_shortest(value, is_float, &digits);
    /* With a single digit the scientific form has no point. */
    const int single = digits.count == 1;
    return digits.exponent >= single - digits.count - 3 && digits.exponent <= 5 - single
               ? write_fixed(value, &digits, text)
               : write_scientific(&digits, text);
}

static size_t format(double value, bool is_float, char *text)
{
    const bool negative = signbit(value);
    *text = '-';
    return negative + format_positive(negative ? -value : value, is_float, text + negative);
}

size_t ffd_number_format(double value, char text[FFD_NUMBER_CAPACITY])
{
    const size_t size = ffd_decimal_format(value, text);
    return size ? size : format(value, false, text);
}

size_t ffd_number_format_float(float value, char text[FFD_NUMBER_CAPACITY])
{
    const size_t size = ffd_decimal_format_float(value, text);
    return size ? size : format((double)value, true, text);
}

number_text ffd_number_text(double value)
{
    number_text result;
    result.text[ffd_number_format(value, result.text)] = 0;
    return result;
}

/* Replaces a locale's decimal point, which may have several bytes. */
static void put_point(char *text)
{
    char *const at = text + strspn(text, "-0123456789");
    if (*at == 0 || isalpha((unsigned char)*at)) /* an exponent, or inf or nan */
        return;
    const char *const decimals = at + strcspn(at, "0123456789");
    *at = '.';
    memmove(at + 1, decimals, strlen(decimals) + 1);
}

number_text ffd_number_digits(double value, int digits)
{
    number_text result;
    snprintf(result.text, sizeof result.text, "%.*g", digits, value);
    put_point(result.text);
    return result;
}

number_text ffd_number_decimals(double value, int decimals)
{
    number_text result;
    snprintf(result.text, sizeof result.text, "%.*f", decimals, value);
    put_point(result.text);
    return result;
}
