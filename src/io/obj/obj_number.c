#include "io/obj/obj_number.h"
#include "base/bytes.h"
#include "base/text/decimal.h"

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_misplaced_exponent(const char *at, const char *last)
{
    if (last - at < 3 || (at[0] != '+' && at[0] != '-') || (at[1] != 'e' && at[1] != 'E'))
        return false;
    for (at += 2; at < last; at++)
        if (!is_digit(*at))
            return false;
    return true;
}

bool ffd_obj_number(text_word word, double *value)
{
    const char *end = ffd_number_parse(word.first, word.last, value);
    return end && (end == word.last || is_misplaced_exponent(end, word.last));
}

bool ffd_obj_scan_number(obj_scan *scan, double *value)
{
    const char *const at = ffd_obj_scan_argument(scan);
    const char *const end = ffd_number_parse(at, scan->last, value);
    return end && ffd_obj_scan_take(scan, end);
}

/* Reads a number of size characters. others has a bit for each byte that is not a digit, as is the one
   after the number. The digits, with zeros up to 16 of them, are read as a whole number and divided by the
   power of ten that makes it too large. With up to 15 digits that whole number is a double: the zeros add the
   factors of two that it needs. */
static ALWAYS_INLINE bool number_at(const char *text, int size, uint64_t others, double *value)
{
    const bool negative = *text == '-';
    text += negative;
    size -= negative;
    others >>= negative;
    const int before = __builtin_ctzll(others);
    const bool has_point = before < size;
    others &= others - 1;
    const int count = size - has_point;
    if ((has_point && (text[before] != '.' || !others || __builtin_ctzll(others) != size)) || count < 1 ||
        count > 16)
        return false;
    return ffd_decimal_quotient((int64_t)bytes_digits_around(text, before, count), 16 - before, negative,
                                value);
}

/* All three are within 64 bytes, which are classified at once. The first two take 38 of them at most, with
   the blanks before them, so that the digits of the third are read there too. */
bool ffd_obj_scan_numbers(obj_scan *scan, double values[3])
{
    const char *const at = scan->at;
    if (scan->last - at < 64 || *at != ' ')
        return false;
    const uint64_t others = bytes_not_digits_of_64(at);
    uint64_t ends = bytes_low_of_64(at);
    int end = 0;
    for (int i = 0; i < 3; i++) {
        const int first = end + 1;
        ends &= ends - 1;
        if (!ends || ffd_obj_class(at + end) != OBJ_BLANK)
            return false;
        end = __builtin_ctzll(ends);
        if (!number_at(at + first, end - first, others >> first, &values[i]))
            return false;
    }
    return ffd_obj_scan_take(scan, at + end);
}
