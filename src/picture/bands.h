/* bands.h - sorts items into bands of rows of a picture. Each list is in the order of the items, for any
   number of threads. */
#ifndef FFD_PICTURE_BANDS_H
#define FFD_PICTURE_BANDS_H

#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rows of a band: its samples fit in the L2 cache. */
#define BAND_ROWS 8

/* A callback: returns whether an item is in the picture, and sets its first and last row; the caller clips
   them to the picture. */
typedef bool (*band_rows)(const void *context, size_t item, int64_t *first, int64_t *last);

typedef struct bands {
    size_t count;   /* number of bands */
    size_t *starts; /* start of the list of each band in items, and the end of the last */
    uint32_t *items;
} bands;

/* The resources that work may use. */
typedef struct band_means {
    int threads;
    memory_budget *budget; /* NULL: unlimited; lists are taken from it */
} band_means;

/* Sorts count items (< 2^32) into the bands of rows [top, bottom), of which there are fewer than 2^18.
   Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_bands_make(int64_t top, int64_t bottom, size_t count, band_rows rows, const void *context,
                          const band_means *means, bands *result, ffd_error *error);
/* Frees the lists and empties the struct. */
void ffd_bands_free(bands *of);

#endif
