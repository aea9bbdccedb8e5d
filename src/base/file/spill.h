/* spill.h - arrays that may be larger than memory: beyond a size they are memory-mapped from a temporary file
   without a name, in the folder TMPDIR or /var/tmp, whose pages the system can evict (unless that is a file
   system in memory). If there is no such folder, or it is full, they are in memory. */
#ifndef FFD_BASE_FILE_SPILL_H
#define FFD_BASE_FILE_SPILL_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes that are not worth a file. */
#define SPILL_FROM ((size_t)128 << 20)

typedef struct spill_array {
    void *data;  /* NULL: nothing yet */
    size_t size; /* capacity in bytes */
    int file;    /* where is_mapped */
    bool is_mapped;
} spill_array;

/* Grows the capacity to at least `needed` bytes, by half at least; the content is kept, its address may
   change. An array of zeros is empty. Returns false if memory runs out; nothing is changed then. */
bool ffd_spill_grow(spill_array *array, size_t needed);
/* Releases the pages of bytes that are not needed for a while, if they are in a file. Thread-safe. */
void ffd_spill_release_pages(const spill_array *array, size_t offset, size_t size);
/* Frees the array and closes its file; the array is empty then. */
void ffd_spill_free(spill_array *array);

#endif
