/* mutate_text.c - changes numbers and bytes of a text. */
#include "mutate_text.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

size_t mutant_pick(mutant *m, size_t count)
{
    return (size_t)(draw_bits(&m->random) % count);
}

void mutant_replace(mutant *m, size_t at, size_t length, const void *with, size_t with_length)
{
    if (m->size - length + with_length > m->capacity)
        return;
    memmove(m->data + at + with_length, m->data + at + length, m->size - at - length);
    if (with_length > 0)
        memcpy(m->data + at, with, with_length);
    m->size = m->size - length + with_length;
}

static bool is_number_char(uint8_t c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

static bool starts_number(const mutant *m, size_t at)
{
    const uint8_t before = at > 0 ? m->data[at - 1] : '[';
    return (m->data[at] == '-' || (m->data[at] >= '0' && m->data[at] <= '9')) &&
           (before == '[' || before == ',' || before == ' ' || before == ':' || before == '\n' ||
            before == '/');
}

/* A number of the text, anywhere from a random place on. */
static bool find_number(mutant *m, size_t *at, size_t *length)
{
    if (m->text == 0)
        return false;
    const size_t from = mutant_pick(m, m->text);
    for (size_t i = 0; i < m->text; i++) {
        *at = (from + i) % m->text;
        if (!starts_number(m, *at))
            continue;
        for (*length = 1; *at + *length < m->text && is_number_char(m->data[*at + *length]);)
            ++*length;
        return true;
    }
    return false;
}

double mutant_changed_number(mutant *m, double value)
{
    static const double others[] = {0,
                                    1,
                                    -1,
                                    2,
                                    3,
                                    0.5,
                                    360,
                                    180,
                                    1e-9,
                                    1e-17,
                                    1e6,
                                    1e9,
                                    1e16,
                                    1e30,
                                    1e100,
                                    1e300,
                                    1e-300,
                                    5e-324,
                                    1e154,
                                    -1e154,
                                    1e-6,
                                    1e-30,
                                    -0.25,
                                    1.7e308,
                                    255,
                                    256,
                                    65535,
                                    65536,
                                    2147483648,
                                    4294967295,
                                    4294967296,
                                    9007199254740992,
                                    4611686018427387904,
                                    9223372036854775808.0,
                                    18446744073709551615.0};
    switch (mutant_pick(m, 8)) {
    case 0:
        return others[mutant_pick(m, sizeof others / sizeof *others)];
    case 1:
        return -value;
    case 2:
        return nextafter(value, draw_int(&m->random, 0, 1) ? INFINITY : -INFINITY);
    case 3:
        return value + draw_int(&m->random, -2, 2);
    case 4:
        return ldexp(value, draw_int(&m->random, -40, 40));
    case 5:
        return value * draw_between(&m->random, -2, 2);
    case 6:
        return value + draw_between(&m->random, -0.5, 0.5);
    default:
        return draw_int(&m->random, 0, 10);
    }
}

void mutant_change_number(mutant *m)
{
    size_t at, length;
    char text[64];
    if (!find_number(m, &at, &length) || length >= sizeof text)
        return;
    memcpy(text, m->data + at, length);
    text[length] = 0;
    const int written = snprintf(text, sizeof text, "%.17g", mutant_changed_number(m, strtod(text, NULL)));
    mutant_replace(m, at, length, text, (size_t)written);
}

void mutant_copy_number(mutant *m)
{
    size_t from, from_length, to, to_length;
    char text[64];
    if (!find_number(m, &from, &from_length) || !find_number(m, &to, &to_length) ||
        from_length >= sizeof text)
        return;
    memcpy(text, m->data + from, from_length);
    mutant_replace(m, to, to_length, text, from_length);
}

void mutant_change_piece(mutant *m, const char *bytes)
{
    uint8_t piece[64];
    const size_t from = mutant_pick(m, m->size), to = mutant_pick(m, m->size);
    const size_t most = m->size - from < sizeof piece ? m->size - from : sizeof piece;
    const size_t length = 1 + mutant_pick(m, most);
    memcpy(piece, m->data + from, length);
    switch (mutant_pick(m, 3)) {
    case 0:
        mutant_replace(m, to, 0, piece, length);
        break;
    case 1:
        mutant_replace(m, from, length, NULL, 0);
        break;
    default:
        m->data[to] = (uint8_t)bytes[mutant_pick(m, strlen(bytes))];
        break;
    }
}

size_t mutate_text(uint8_t *data, size_t size, size_t capacity, uint64_t seed, const char *bytes)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .text = size, .random = {seed}};
    if (size == 0)
        return 0;
    if (mutant_pick(&m, 4) == 0)
        mutant_change_number(&m);
    else
        mutant_change_piece(&m, bytes);
    return m.size;
}
