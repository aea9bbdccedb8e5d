/* bands.h - which items are in which rows of a picture: lists in the order of their numbers, whatever the
   number of threads. */
#ifndef FFD_PICTURE_BANDS_H
#define FFD_PICTURE_BANDS_H

#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rows of one band: its samples stay in a processor's second cache. */
#define BAND_ROWS 8

/* Returns whether an item is in the picture, and its first and last row; both are cut to the picture. */
typedef bool (*band_rows)(const void *context, size_t item, int64_t *first, int64_t *last);

typedef struct bands {
    size_t count;   /* of bands */
    size_t *starts; /* of each band's list in items; one more at the end */
    uint32_t *items;
} bands;

/* What work may take. */
typedef struct band_means {
    int threads;
    const memory_budget *budget; /* or NULL: any amount */
} band_means;

/* Sorts `count` items, below 2^32, into the bands of rows [top, bottom), fewer than
   2^18. Errors: FFD_E_MEMORY, FFD_E_LIMIT.
 */
ffd_status ffd_bands_make(int64_t top, int64_t bottom, size_t count, band_rows rows, const void *context,
                          const band_means *means, bands *result, ffd_error *error);
/* Frees what they hold; leaves empty ones. */
void ffd_bands_free(bands *of);

#endif
