/* mutate_lattice.c - changes of numbers, words and points: bytes at random hardly ever leave JSON behind. */
#include "fuzz_target.h"
#include "mutate_text.h"
#include <string.h>

/* Puts one word in the place of another. */
static void change_word(mutant *m)
{
    static const char *const words[] = {
        "\"clamped\"", "\"open\"", "\"uniform\"",  "\"closed\"", "\"greville\"", "\"mesh\"",   "\"box\"",
        "\"world\"",   "\"x\"",    "\"y\"",        "\"z\"",      "\"twist\"",    "\"rotate\"", "\"by\"",
        "\"to\"",      "\"all\"",  "\"periodic\"", "true",       "null"};
    const size_t count = sizeof words / sizeof *words, start = mutant_pick(m, m->text);
    const char *const with = words[mutant_pick(m, count)];
    for (size_t i = 0; i < m->text; i++) {
        const size_t at = (start + i) % m->text;
        for (size_t w = 0; w < count; w++) {
            const size_t length = strlen(words[w]);
            if (at + length <= m->text && !memcmp(m->data + at, words[w], length)) {
                mutant_replace(m, at, length, with, strlen(with));
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
        uint8_t *const at = m->data + tail + sizeof value * mutant_pick(m, numbers);
        memcpy(&value, at, sizeof value);
        value = mutant_changed_number(m, value);
        memcpy(at, &value, sizeof value);
        return;
    }
    char point[1 + 3 * sizeof(double)] = {0};
    for (size_t a = 0; a < 3; a++) {
        const double value = draw_int(&m->random, 0, 3) ? draw_unit(&m->random) : draw_int(&m->random, -1, 1);
        memcpy(point + 1 + a * sizeof value, &value, sizeof value);
    }
    const size_t skipped = m->text < m->size; /* there is a 0 already */
    mutant_replace(m, m->size, 0, point + skipped, sizeof point - skipped);
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .random = {seed}};
    const uint8_t *const end = size > 0 ? memchr(data, 0, size) : NULL;
    m.text = end ? (size_t)(end - data) : size;
    if (m.text == 0)
        return size;
    switch (mutant_pick(&m, 8)) {
    case 0:
        change_point(&m);
        break;
    case 1:
        change_word(&m);
        break;
    case 2:
    case 3:
        mutant_copy_number(&m);
        break;
    default:
        mutant_change_number(&m);
        break;
    }
    return m.size;
}
