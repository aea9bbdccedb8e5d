#include "io/obj/obj_value.h"
#include "base/bytes.h"
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

/* An index of so many digits, 8 at most, where 8 bytes can be read. */
static ALWAYS_INLINE obj_index index_at(const char *at, int count)
{
    const uint64_t values = load_u64((const unsigned char *)at) ^ '0' * BYTES_ONES;
    const uint64_t number = count ? join_digits(values << (64 - 8 * count)) : 0;
    return (obj_index){(int64_t)number, {at, at + count}};
}

/* Takes the digits that a text begins with: eight at most, more are a word's. */
static const char *take_digits(const char *at, const char *last, obj_index *index)
{
    if (last - at >= 8) {
        const uint64_t others = bytes_not_digits(load_u64((const unsigned char *)at));
        *index = index_at(at, others ? __builtin_ctzll(others) / 8 : 8);
        return index->text.last;
    }
    *index = (obj_index){0, {at, at}};
    for (; at < last && is_digit(*at); at++)
        index->value = 10 * index->value + (*at - '0');
    return index->text.last = at;
}

/* A corner with two slashes, where 40 bytes can be read. What it consists of is found at once: one index
   after the other would be looked for only when the end of the one before is known. */
static ALWAYS_INLINE const char *take_whole_corner(const char *at, obj_corner *corner)
{
    uint32_t others = bytes_not_digits_of_32(at);
    int end[3];
    for (int i = 0; i < 3; i++, others &= others - 1) {
        if (!others)
            return NULL;
        end[i] = __builtin_ctz(others);
    }
    const int texcoord = end[1] - end[0] - 1, normal = end[2] - end[1] - 1;
    if (at[end[0]] != '/' || at[end[1]] != '/' || end[0] == 0 || end[0] > 8 || texcoord > 8 || normal > 8)
        return NULL;
    corner->vertex = index_at(at, end[0]);
    corner->texcoord = index_at(at + end[0] + 1, texcoord);
    corner->normal = index_at(at + end[1] + 1, normal);
    return at + end[2];
}

bool ffd_obj_scan_corner(obj_scan *scan, obj_corner *corner)
{
    const char *at = ffd_obj_scan_argument(scan);
    const char *const last = scan->last;
    const char *const end = last - at >= 40 ? take_whole_corner(at, corner) : NULL;
    if (end)
        return ffd_obj_scan_take(scan, end);
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
