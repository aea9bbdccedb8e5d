#include "io/obj/obj_value.h"
#include "base/little_endian.h"
#include "base/number.h"

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

/* Reads an optional index at *at and goes behind it. */
static bool take_index(const char **at, const char *last, obj_index *index)
{
    /* No file has so many elements, and one more digit still fits. */
    const int64_t saturated = INT64_MAX / 100;
    const char *c = *at;
    *index = (obj_index){.text = {c, c}};
    const bool negative = c < last && *c == '-';
    if (c < last && (*c == '-' || *c == '+'))
        c++;
    const char *digits = c;
    for (; c < last && is_digit(*c); c++)
        if (index->value < saturated)
            index->value = index->value * 10 + (*c - '0');
    if (c == digits)
        return c == *at; /* a sign alone is no index */
    if (negative)
        index->value = -index->value;
    index->text.last = *at = c;
    return true;
}

bool ffd_obj_corner(text_word word, obj_corner *corner)
{
    obj_index *const indices[3] = {&corner->vertex, &corner->texcoord, &corner->normal};
    *corner = (obj_corner){0};
    const char *at = word.first;
    for (int i = 0; i < 3; i++) {
        if (!take_index(&at, word.last, indices[i]))
            return false;
        if (at == word.last)
            return corner->vertex.text.first < corner->vertex.text.last;
        if (*at++ != '/')
            return false;
    }
    return false;
}

/* The number that eight digits make, one a byte, the first lowest: neighbours join to pairs, pairs to fours.
 */
static uint64_t join_digits(uint64_t digits)
{
    const uint64_t pairs = (10 * digits + (digits >> 8)) & UINT64_C(0x00ff00ff00ff00ff);
    const uint64_t fours = (100 * pairs + (pairs >> 16)) & UINT64_C(0x0000ffff0000ffff);
    return (10000 * fours + (fours >> 32)) & UINT64_C(0xffffffff);
}

/* How many of eight bytes are digits before the first that is none, and the number that they make. */
static int read_digits(const char *eight, uint64_t *number)
{
    /* A digit's byte becomes its value; of the first that is none the highest bit gets set. */
    const uint64_t bytes = load_u64((const unsigned char *)eight) ^ UINT64_C(0x3030303030303030);
    const uint64_t others = (bytes | (bytes + UINT64_C(0x7676767676767676))) & UINT64_C(0x8080808080808080);
    const int count = others ? __builtin_ctzll(others) / 8 : 8;
    *number = count ? join_digits(bytes << (64 - 8 * count)) : 0;
    return count;
}

/* Takes the digits that a text begins with: eight at most, more are a word's. */
static inline const char *take_digits(const char *at, const char *last, obj_index *index)
{
    uint64_t number = 0;
    int count = 0;
    if (last - at >= 8)
        count = read_digits(at, &number);
    else
        for (; at + count < last && is_digit(at[count]); count++)
            number = 10 * number + (uint64_t)(at[count] - '0');
    *index = (obj_index){(int64_t)number, {at, at + count}};
    return at + count;
}

bool ffd_obj_scan_corner(obj_scan *scan, obj_corner *corner)
{
    const char *at = ffd_obj_scan_argument(scan);
    const char *const last = scan->last;
    at = take_digits(at, last, &corner->vertex);
    corner->texcoord = corner->normal = (obj_index){0, {at, at}};
    if (corner->vertex.text.first == at)
        return false;
    if (at < last && *at == '/') {
        at = take_digits(at + 1, last, &corner->texcoord);
        corner->normal.text = (text_word){at, at};
        if (at < last && *at == '/')
            at = take_digits(at + 1, last, &corner->normal);
    }
    return ffd_obj_scan_take(scan, at);
}
