/* words.h - the known word nearest to one that somebody wrote. */
#ifndef FFD_BASE_TEXT_WORDS_H
#define FFD_BASE_TEXT_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* Whether word is one of known (count words). */
bool ffd_word_is_known(const char *word, const char *const *known, size_t count);

/* The edit distance (insert, delete, replace, swap of neighbours) of two words, by their first letters where
   they are long. */
size_t ffd_word_distance(const char *a, const char *b);

/* The entry of known (count words) with the least edit distance to word, the first of equals; NULL when count
 * is 0. */
const char *ffd_nearest_word(const char *word, const char *const *known, size_t count);

#endif
