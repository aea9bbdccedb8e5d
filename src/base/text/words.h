/* words.h - words of messages: after a count, the known one nearest to what somebody wrote, names. */
#ifndef FFD_BASE_TEXT_WORDS_H
#define FFD_BASE_TEXT_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether word is one of known (count words). */
bool ffd_word_is_known(const char *word, const char *const *known, size_t count);

/* The edit distance (insert, delete, replace, swap of neighbours) of two words, by their first letters where
   they are long. a has a_length letters. */
size_t ffd_word_distance(const char *a, size_t a_length, const char *b);

/* The known word that is nearest to one that somebody wrote, by edit distance. Start with word and length set
   and the rest 0; then offer the known words one by one. */
typedef struct nearest_word {
    const char *word;
    size_t length;
    const char *best; /* lent; the first of equals; NULL before a word was offered */
    size_t distance;
} nearest_word;

/* Offers a known word: it becomes the best one if it is nearer than those before. */
void ffd_nearest_offer(nearest_word *nearest, const char *known);

/* The entry of known (count words) that is nearest to word, the first of equals; NULL when count is 0. */
const char *ffd_nearest_word(const char *word, const char *const *known, size_t count);

/* one where count is 1, else many: "1 vertex is", "0 vertices are". */
const char *ffd_plural(uint64_t count, const char *one, const char *many);

/* Copies a name for a message, which is one line: control characters become '?', and what does not fit in
   capacity bytes, its end among them, is cut off where a character of UTF-8 ends. */
void ffd_name_shown(const char *name, char *shown, size_t capacity);

#endif
