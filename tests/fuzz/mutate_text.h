/* mutate_text.h - changes of an input's numbers and bytes, for the mutations of all targets. */
#ifndef FFD_TESTS_FUZZ_MUTATE_TEXT_H
#define FFD_TESTS_FUZZ_MUTATE_TEXT_H

#include "../support/draw.h"
#include <stddef.h>
#include <stdint.h>

typedef struct mutant {
    uint8_t *data;
    size_t size, capacity;
    size_t text; /* leading bytes that are text */
    draw random;
} mutant;

/* Below count, which is not 0. */
size_t mutant_pick(mutant *m, size_t count);

/* Replaces length bytes by others; changes nothing if the capacity does not suffice. */
void mutant_replace(mutant *m, size_t at, size_t length, const void *with, size_t with_length);

double mutant_changed_number(mutant *m, double value);

/* A number of the text: changed; put in the place of another. Nothing where the text has none. */
void mutant_change_number(mutant *m);
void mutant_copy_number(mutant *m);

/* A piece of the input, which is not empty, goes to another place, or away; or a byte becomes one of bytes.
 */
void mutant_change_piece(mutant *m, const char *bytes);

/* The fuzz_mutate of an input that is all text: changes a number, or a piece with those bytes. */
size_t mutate_text(uint8_t *data, size_t size, size_t capacity, uint64_t seed, const char *bytes);

#endif
