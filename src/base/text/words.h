/* words.h - words in messages: plurals, the known word that is most similar to a misspelt one, names. */
#ifndef FFD_BASE_TEXT_WORDS_H
#define FFD_BASE_TEXT_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Returns whether word is one of known (count words). */
bool ffd_word_is_known(const char *word, const char *const *known, size_t count);

/* Returns the edit distance of two words (insertions, deletions, replacements, swaps of adjacent letters).
   Long words are compared by their first letters only. */
size_t ffd_word_distance(const char *a, const char *b);

/* Returns the entry of known (count words) with the least edit distance to word, the first one if there are
   several; NULL if count is 0. */
const char *ffd_nearest_word(const char *word, const char *const *known, size_t count);

/* Returns `one` if count is 1, else `many`: "1 vertex is", "0 vertices are". */
const char *ffd_plural(uint64_t count, const char *one, const char *many);

/* Copies a name for a message of one line: control characters become '?', and the copy is truncated at a
   UTF-8 character boundary to fit in capacity bytes with its final 0. */
void ffd_name_shown(const char *name, char *shown, size_t capacity);

#endif
