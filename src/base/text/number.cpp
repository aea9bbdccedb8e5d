#include "base/text/number.h"
#include "base/text/decimal.h"
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace
{

/* from_chars does not say whether a number out of range was too large or too small. It was too large exactly
   when the power of ten of its first digit that is not 0 is positive: the limits are 1e308 and 1e-324 (1e38
   and 1e-45 of a float). */
bool is_too_large(const char *first, const char *last)
{
    long long point = 0, leading = 0;
    bool seen_point = false, seen_digit = false;
    const char *c = first;
    for (; c < last && *c != 'e' && *c != 'E'; c++) {
        if (*c == '.') {
            seen_point = true;
            continue;
        }
        seen_digit = seen_digit || *c != '0';
        if (seen_digit && !seen_point)
            point++;
        if (!seen_digit && seen_point)
            leading++;
    }
    long long exponent = 0;
    if (c < last) {
        c++;
        const bool negative = c < last && *c == '-';
        if (c < last && (*c == '-' || *c == '+'))
            c++;
        for (; c < last && exponent < 1000000000000000LL; c++)
            exponent = exponent * 10 + (*c - '0');
        if (negative)
            exponent = -exponent;
    }
    return exponent + point - leading > 0;
}

template <typename T> const char *parse(const char *first, const char *last, T *value)
{
    const char *start = first;
    bool negative = false;
    if (start < last && (*start == '+' || *start == '-')) {
        negative = *start == '-';
        start++;
    }
    if (start == last || *start == '+' || *start == '-')
        return nullptr;
    T parsed = 0;
    const std::from_chars_result result = std::from_chars(start, last, parsed);
    if (result.ec == std::errc::invalid_argument)
        return nullptr;
    if (result.ec == std::errc::result_out_of_range)
        parsed = is_too_large(start, result.ptr) ? std::numeric_limits<T>::infinity() : T(0);
    *value = negative ? -parsed : parsed;
    return result.ptr;
}

template <typename T> size_t format_shortest(T value, char *text)
{
    /* A double needs at most 24 characters: sign, 17 digits, point, e, sign, 3 digits. */
    const std::to_chars_result result = std::to_chars(text, text + FFD_NUMBER_CAPACITY, value);
    return static_cast<size_t>(result.ptr - text);
}

} // namespace

extern "C" const char *ffd_number_parse(const char *first, const char *last, double *value)
{
    const char *const end = ffd_decimal_parse(first, last, value);
    return end ? end : parse(first, last, value);
}

extern "C" const char *ffd_number_parse_float(const char *first, const char *last, float *value)
{
    return parse(first, last, value);
}

extern "C" size_t ffd_number_format(double value, char text[FFD_NUMBER_CAPACITY])
{
    const size_t size = ffd_decimal_format(value, text);
    return size ? size : format_shortest(value, text);
}

extern "C" size_t ffd_number_format_float(float value, char text[FFD_NUMBER_CAPACITY])
{
    return format_shortest(value, text);
}

extern "C" number_text ffd_number_text(double value)
{
    number_text result;
    result.text[ffd_number_format(value, result.text)] = 0;
    return result;
}
