#include "io/obj/obj_value.h"
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

/* More digits are a word's. */
#define MOST_DIGITS 18

static const char *take_digits(const char *at, const char *last, obj_index *index)
{
    int64_t value = 0;
    const char *const first = at;
    const char *const most = last - at > MOST_DIGITS ? at + MOST_DIGITS : last;
    for (; at < most && is_digit(*at); at++)
        value = value * 10 + (*at - '0');
    *index = (obj_index){value, {first, at}};
    return at;
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
