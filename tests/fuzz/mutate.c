/* mutate.c - changes of numbers, words and points: bytes at random hardly ever leave JSON behind. */
#include "../support/draw.h"
#include "fuzz_lattice.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct mutant {
    uint8_t *data;
    size_t size, capacity;
    size_t text; /* bytes before the 0 */
    draw random;
} mutant;

static size_t pick(mutant *m, size_t count)
{
    return (size_t)(draw_bits(&m->random) % count);
}

/* Puts other bytes in the place of length ones; no change where there is no room. */
static void replace(mutant *m, size_t at, size_t length, const char *with, size_t with_length)
{
    if (m->size - length + with_length > m->capacity)
        return;
    memmove(m->data + at + with_length, m->data + at + length, m->size - at - length);
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
           (before == '[' || before == ',' || before == ' ' || before == ':' || before == '\n');
}

/* A number of the text, anywhere from a random place on. */
static bool find_number(mutant *m, size_t *at, size_t *length)
{
    const size_t from = pick(m, m->text);
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

static double changed_number(mutant *m, double value)
{
    static const double others[] = {0,      1,      -1,    2,      3,    0.5,   360,   180,
                                    1e-9,   1e-17,  1e6,   1e9,    1e16, 1e30,  1e100, 1e300,
                                    1e-300, 5e-324, 1e154, -1e154, 1e-6, 1e-30, -0.25, 1.7e308};
    switch (pick(m, 8)) {
    case 0:
        return others[pick(m, sizeof others / sizeof *others)];
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

static void change_number(mutant *m)
{
    size_t at, length;
    char text[64];
    if (!find_number(m, &at, &length) || length >= sizeof text)
        return;
    memcpy(text, m->data + at, length);
    text[length] = 0;
    const int written = snprintf(text, sizeof text, "%.17g", changed_number(m, strtod(text, NULL)));
    replace(m, at, length, text, (size_t)written);
}

static void copy_number(mutant *m)
{
    size_t from, from_length, to, to_length;
    char text[64];
    if (!find_number(m, &from, &from_length) || !find_number(m, &to, &to_length) ||
        from_length >= sizeof text)
        return;
    memcpy(text, m->data + from, from_length);
    replace(m, to, to_length, text, from_length);
}

/* Puts one word in the place of another. */
static void change_word(mutant *m)
{
    static const char *const words[] = {
        "\"clamped\"", "\"open\"", "\"uniform\"",  "\"closed\"", "\"greville\"", "\"mesh\"",   "\"box\"",
        "\"world\"",   "\"x\"",    "\"y\"",        "\"z\"",      "\"twist\"",    "\"rotate\"", "\"by\"",
        "\"to\"",      "\"all\"",  "\"periodic\"", "true",       "null"};
    const size_t count = sizeof words / sizeof *words, start = pick(m, m->text);
    const char *const with = words[pick(m, count)];
    for (size_t i = 0; i < m->text; i++) {
        const size_t at = (start + i) % m->text;
        for (size_t w = 0; w < count; w++) {
            const size_t length = strlen(words[w]);
            if (at + length <= m->text && !memcmp(m->data + at, words[w], length)) {
                replace(m, at, length, with, strlen(with));
                return;
            }
        }
    }
}

/* Adds a point, or changes a number of one. */
static void change_point(mutant *m)
{
    const size_t tail = m->text < m->size ? m->text + 1 : m->size;
    const size_t numbers = (m->size - tail) / sizeof(double);
    if (numbers > 0 && draw_int(&m->random, 0, 2)) {
        double value;
        uint8_t *const at = m->data + tail + sizeof value * pick(m, numbers);
        memcpy(&value, at, sizeof value);
        value = changed_number(m, value);
        memcpy(at, &value, sizeof value);
        return;
    }
    char point[1 + 3 * sizeof(double)] = {0};
    for (size_t a = 0; a < 3; a++) {
        const double value = draw_int(&m->random, 0, 3) ? draw_unit(&m->random) : draw_int(&m->random, -1, 1);
        memcpy(point + 1 + a * sizeof value, &value, sizeof value);
    }
    const size_t skipped = m->text < m->size; /* there is a 0 already */
    replace(m, m->size, 0, point + skipped, sizeof point - skipped);
}

size_t mutate_lattice(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .random = {seed}};
    const uint8_t *const end = size > 0 ? memchr(data, 0, size) : NULL;
    m.text = end ? (size_t)(end - data) : size;
    if (m.text == 0)
        return size;
    switch (pick(&m, 8)) {
    case 0:
        change_point(&m);
        break;
    case 1:
        change_word(&m);
        break;
    case 2:
    case 3:
        copy_number(&m);
        break;
    default:
        change_number(&m);
        break;
    }
    return m.size;
}
