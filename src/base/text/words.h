/* words.h - words in messages: plurals, the known word that is most similar to a misspelt one (words.c has
   ffd_nearest_word and ffd_word_meant of ffd/program.h too), names. */
#ifndef FFD_BASE_TEXT_WORDS_H
#define FFD_BASE_TEXT_WORDS_H

#include <ffd/program.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Returns whether word is one of known (count words). */
bool ffd_word_is_known(const char *word, const char *const *known, size_t count);

/* Returns the edit distance of two words (insertions, deletions, replacements, swaps of adjacent letters).
   Long words are compared by their first letters only, capitals as small letters. a has a_length letters. */
size_t ffd_word_distance(const char *a, size_t a_length, const char *b);

/* Finds the known word that is most similar to a word of the user's, by edit distance. Set word and length,
   and all other members to 0; then offer the known words one by one. */
typedef struct nearest_word {
    const char *word;
    size_t length;
    const char *best; /* borrowed; the first one if there are several; NULL before a word is offered */
    size_t distance;
    bool is_tied; /* others are as similar */
} nearest_word;

/* Offers a known word; keeps it if it is more similar than those before. */
void ffd_nearest_offer(nearest_word *nearest, const char *known);

/* Returns the word that is meant: the best one, if it is similar; NULL where it is not, as one half of a word
   of three letters, or where another is as similar at that limit, as "x" and "y" are to "xy"; nor where the
   word is the best one with a minus, which is its opposite. */
const char *ffd_nearest_meant(const nearest_word *nearest);

/* Writes what a message says of an unknown word: the known one that is meant, or all of them. Truncates to
   capacity. */
void ffd_words_hint(const char *word, const char *const *known, size_t count, char *text, size_t capacity);

/* Returns `one` if count is 1, else `many`: "1 vertex is", "0 vertices are". */
const char *ffd_plural(uint64_t count, const char *one, const char *many);

typedef struct only_text {
    char text[80];
} only_text;
/* What follows "there is no node 7": ", only 5" and the note, or ": the file has none". */
only_text ffd_only(uint64_t count, const char *note);

/* Copies a name for a message of one line: control characters become '?', and the copy is truncated at a
   UTF-8 character boundary to fit in capacity bytes with its final 0. */
void ffd_name_shown(const char *name, char *shown, size_t capacity);

/* Copies the beginning of a name of `size` bytes for a message. A NUL character becomes its symbol, U+2400.
   capacity: at least 4. */
void ffd_bytes_shown(const char *bytes, size_t size, char *shown, size_t capacity);

#endif
