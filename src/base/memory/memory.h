/* memory.h - allocation with overflow checks. Tests can make any allocation fail. */
#ifndef FFD_BASE_MEMORY_MEMORY_H
#define FFD_BASE_MEMORY_MEMORY_H

#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Allocates count * size bytes, uninitialised. Returns NULL if memory runs out or the product overflows; if
   it is 0, a pointer that can be freed. Free with ffd_free. */
void *ffd_alloc(size_t count, size_t size);
/* The same, filled with zeros. */
void *ffd_alloc_zero(size_t count, size_t size);
/* Changes the size of a block of ffd_alloc, or allocates one if block is NULL. Returns NULL on failure, and
   the old block stays valid. */
void *ffd_realloc(void *block, size_t count, size_t size);
/* Frees a block that any of these functions returned; NULL is allowed. */
FFD_API void ffd_free(void *block);

/* As ffd_alloc, for a block that will be written completely: a large block gets huge pages if the system has
   them, because the page fault at the first access to a page costs more than filling it. Not for a block of
   which only a part may be used. */
void *ffd_alloc_whole(size_t count, size_t size);
/* As ffd_alloc_zero, for a large block of which parts may never be written: these take no memory, even if
   they are read. Written parts get huge pages as above. */
void *ffd_alloc_sparse(size_t count, size_t size);

/* Grows *block, which has room for *capacity elements of `size` bytes, to at least `needed` elements, and by
   at least half. Returns false if memory runs out; nothing is changed then. */
bool ffd_grow(void **block, size_t *capacity, size_t needed, size_t size);

/* For tests: all allocations after the next `successes` fail. A negative number turns this off. */
void ffd_alloc_fail_after(long successes);

/* Sets *result to a + b. Returns false on overflow. */
bool ffd_add_size(size_t a, size_t b, size_t *result);
/* Sets *result to a * b. Returns false on overflow. */
bool ffd_multiply_size(size_t a, size_t b, size_t *result);

#ifdef __cplusplus
}
#endif

#endif
