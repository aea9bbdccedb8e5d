/* nearest.h - finds the known word nearest to a mistyped one. */
#ifndef FFD_CLI_NEAREST_H
#define FFD_CLI_NEAREST_H

#include <stddef.h>

/* Set word and length, and the rest to 0; then offer the known words one by one. */
typedef struct cli_nearest {
    const char *word;
    size_t length;
    const char *best; /* the first of equally near ones; NULL: none was offered yet */
    size_t distance;
} cli_nearest;

/* Offers a known word, which becomes the best one if it is nearer. */
void cli_nearest_offer(cli_nearest *nearest, const char *known);

#endif
