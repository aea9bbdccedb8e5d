/* twins.h - finds vertices that share a position, by hashes of their positions. */
#ifndef FFD_MESH_TWINS_H
#define FFD_MESH_TWINS_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most threads that add positions, each with bits of its own. */
#define REPEAT_WORKERS 8

/* The most bytes of a filter for each vertex. */
#define REPEAT_BYTES ((3 + REPEAT_WORKERS) * sizeof(uint32_t))

/* Of many vertices finds those whose position others may have, and which are worth a closer look. */
typedef struct repeat_filter {
    size_t count;
    int workers, shift;
    void *own;                       /* memory of all that follows; NULL: the caller's */
    uint32_t *hashes;                /* of all vertices */
    size_t words;                    /* of each set of bits: */
    uint64_t *seen[REPEAT_WORKERS];  /* a bit for hashes that begin alike: a vertex has one of them */
    uint64_t *again[REPEAT_WORKERS]; /* and another one has */
} repeat_filter;

/* Begins a filter for so many vertices. To be ended in every case. threads: 0: all cores; workers is set to
   how many may add positions. room: room_size bytes, aligned for numbers, that the filter may use until its
   end, if they are enough; or NULL. Errors: FFD_E_MEMORY. */
ffd_status ffd_repeats_begin(repeat_filter *filter, size_t count, int threads, void *room, size_t room_size,
                             ffd_error *error);
/* Adds the vertices [first, first + count) with their positions. worker: below filter->workers; each adds by
   itself. */
void ffd_repeats_add(const repeat_filter *filter, size_t first, size_t count, const double *positions,
                     int worker);
/* Lists all vertices whose hash others have, and some more, in ascending order. The caller frees *list. The
   result does not depend on the number of threads. Errors: FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_repeats_list(repeat_filter *filter, uint32_t **list, size_t *found, ffd_error *error);
/* Frees its memory. */
void ffd_repeats_end(repeat_filter *filter);

/* Sets leaders[k] to the index of the first of `count` entries of a list with the hash and, unless positions
   is NULL, the position of entry k; 0 and -0 are equal. positions: 3 for each entry. Errors: FFD_E_MEMORY,
   those of the deadline. */
ffd_status ffd_leaders_find(const repeat_filter *filter, const double *positions, const uint32_t *list,
                            size_t count, uint32_t *leaders, ffd_error *error);

/* Of the vertices of the filter finds the first ones at their positions. list: `count` vertices that may
   share one; places: their positions, 3 numbers each. *twins: as ffd_positions_twins, which the caller frees;
   NULL: no two share a position. The errors are the same. */
ffd_status ffd_twins_find(const repeat_filter *filter, const double *places, const uint32_t *list,
                          size_t count, uint32_t **twins, ffd_error *error);

/* The most temporary bytes of ffd_positions_twins for each vertex. */
#define POSITION_TWIN_BYTES (REPEAT_BYTES + 8 * sizeof(uint32_t) + 3 * sizeof(double))

/* Sets twins[i] to the first vertex with the same coordinates as vertex i, for count vertices; 0 and -0 are
   equal. threads: 0: all cores; the result does not depend on them. Errors: FFD_E_MEMORY, those of the
   deadline. */
ffd_status ffd_positions_twins(const double *positions, size_t count, int threads, uint32_t *twins,
                               ffd_error *error);

#endif
