/* spill.h - arrays that may be larger than memory. From SPILL_FROM bytes on they are memory-mapped from an
   unnamed temporary file in TMPDIR or /var/tmp, so that the system can evict their pages (unless that folder
   is itself in memory). If there is no such folder, or it is full, they stay in memory. */
#ifndef FFD_BASE_FILE_SPILL_H
#define FFD_BASE_FILE_SPILL_H

#include <stdbool.h>
#include <stddef.h>

/* Smaller arrays stay in memory. */
#define SPILL_FROM ((size_t)128 << 20)

typedef struct spill_array {
    void *data;  /* NULL: empty */
    size_t size; /* capacity in bytes */
    int file;    /* only if is_mapped */
    bool is_mapped;
} spill_array;

/* Grows the capacity to at least `needed` bytes, and by at least half. The content is kept, its address may
   change. An array of zeros is empty. Returns false if memory runs out; nothing is changed then. */
bool ffd_spill_grow(spill_array *array, size_t needed);
/* Releases the pages of bytes that are not needed for a while, if the array is in a file. Thread-safe. */
void ffd_spill_release_pages(const spill_array *array, size_t offset, size_t size);
/* Frees the array, closes its file and empties the array. */
void ffd_spill_free(spill_array *array);

#endif
