/* memory.h - allocation with counts checked for overflow, which tests can make fail. */
#ifndef FFD_BASE_MEMORY_MEMORY_H
#define FFD_BASE_MEMORY_MEMORY_H

#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* count * size bytes, not cleared; NULL if memory runs out or the product overflows. A count of 0 gives a
   pointer that can be freed. Free with ffd_free. */
void *ffd_alloc(size_t count, size_t size);
/* The same, cleared. */
void *ffd_alloc_zero(size_t count, size_t size);
/* Changes the size of a block (or NULL) of ffd_alloc. On failure the old block stays. */
void *ffd_realloc(void *block, size_t count, size_t size);
/* Frees a block of any of these; NULL is allowed. */
FFD_API void ffd_free(void *block);

/* As ffd_alloc, for a block that will be used from end to end: a large one gets huge pages if the system has
   them, since the page fault at the first touch of a page costs more than filling it. Not for memory of which
   only a little may be touched. */
void *ffd_alloc_whole(size_t count, size_t size);
/* As ffd_alloc_zero, for a large block of which parts may never be written: these take no memory, also where
   they are read. What is written gets huge pages as above. */
void *ffd_alloc_sparse(size_t count, size_t size);

/* Grows the capacity to at least `needed` elements of `size` bytes in *block, whose capacity is *capacity
   elements, by half at least. Returns false if memory runs out; nothing is changed then. */
bool ffd_grow(void **block, size_t *capacity, size_t needed, size_t size);

/* Tests: after `successes` further allocations every one fails; a negative number turns this off. */
void ffd_alloc_fail_after(long successes);

/* a + b in *result; false on overflow. */
bool ffd_add_size(size_t a, size_t b, size_t *result);
/* a * b in *result; false on overflow. */
bool ffd_multiply_size(size_t a, size_t b, size_t *result);

#ifdef __cplusplus
}
#endif

#endif
