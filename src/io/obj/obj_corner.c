#include "io/obj/obj_corner.h"

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Reads an optional index at *at and moves *at past it. */
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
        return c == *at; /* a sign alone is not an index */
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

/* Reads an index of this many digits, at most 8, from text of which 8 bytes can be read. */
static ALWAYS_INLINE obj_index index_at(const char *at, int count)
{
    const uint64_t values = load_u64((const unsigned char *)at) ^ '0' * BYTES_ONES;
    const uint64_t number = count ? bytes_number(values << (64 - 8 * count)) : 0;
    return (obj_index){(int64_t)number, {at, at + count}};
}

/* Takes the digits that a text begins with: eight at most; longer ones are read as a word. */
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

/* A corner with two slashes. */
static ALWAYS_INLINE const char *take_whole_corner(const char *at, obj_corner *corner)
{
    obj_corner_form form;
    if (!ffd_obj_find_slashes(at, &form))
        return NULL;
    corner->vertex = index_at(at, form.vertex);
    corner->texcoord = index_at(at + form.vertex + 1, form.texcoord);
    corner->normal = index_at(at + form.end - form.normal, form.normal);
    return at + form.end;
}

bool ffd_obj_scan_corner(obj_scan *scan, obj_corner *corner)
{
    const char *at = ffd_obj_scan_argument(scan);
    const char *const last = scan->last;
    const char *const end = last - at >= OBJ_CORNER_ROOM ? take_whole_corner(at, corner) : NULL;
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
