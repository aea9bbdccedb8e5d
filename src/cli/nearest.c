#include "cli/nearest.h"
#include <string.h>

/* Only this many letters are compared; names are shorter. */
enum { LONGEST = 24 };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Edit distance (insert, delete, replace) by the Wagner-Fischer algorithm, with one row of the table in
   memory. */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t row[LONGEST + 1];
    a_length = least(a_length, LONGEST);
    b_length = least(b_length, LONGEST);
    for (size_t j = 0; j <= b_length; j++)
        row[j] = j;
    for (size_t i = 0; i < a_length; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b_length; j++) {
            const size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = least(replaced, least(row[j], row[j + 1]) + 1);
        }
    }
    return row[b_length];
}

void cli_nearest_offer(cli_nearest *nearest, const char *known)
{
    const size_t distance = edit_distance(nearest->word, nearest->length, known, strlen(known));
    if (nearest->best && distance >= nearest->distance)
        return;
    nearest->best = known;
    nearest->distance = distance;
}
