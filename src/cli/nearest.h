/* nearest.h - the known word nearest to one that somebody typed. */
#ifndef FFD_CLI_NEAREST_H
#define FFD_CLI_NEAREST_H

#include <stddef.h>

/* Start with word and length set and the rest 0; then offer the known words one by one. */
typedef struct cli_nearest {
    const char *word;
    size_t length;
    const char *best; /* the first of equals; NULL before a word was offered */
    size_t distance;
} cli_nearest;

/* Offers a known word: it becomes the best one if it is nearer than those before. */
void cli_nearest_offer(cli_nearest *nearest, const char *known);

#endif
