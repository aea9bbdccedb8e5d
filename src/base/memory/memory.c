#define _DEFAULT_SOURCE /* madvise */
#include "base/memory/memory.h"
#include "base/posix.h"
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>

/* Blocks of at least this size get huge pages. */
#define LARGE_BLOCK ((size_t)4 << 20)
#define LARGE_PAGE ((size_t)2 << 20)

/* For tests only: how many more allocations succeed; negative: no limit. */
static atomic_long remaining_successes = -1;

static bool fails_on_purpose(void)
{
    const long left = atomic_load(&remaining_successes);
    if (left < 0)
        return false;
    if (left == 0)
        return true;
    atomic_store(&remaining_successes, left - 1);
    return false;
}

void ffd_alloc_fail_after(long successes)
{
    atomic_store(&remaining_successes, successes);
}

bool ffd_add_size(size_t a, size_t b, size_t *result)
{
    if (a > SIZE_MAX - b)
        return false;
    *result = a + b;
    return true;
}

bool ffd_multiply_size(size_t a, size_t b, size_t *result)
{
    if (b && a > SIZE_MAX / b)
        return false;
    *result = a * b;
    return true;
}

void *ffd_alloc(size_t count, size_t size)
{
    size_t bytes;
    if (!ffd_multiply_size(count, size, &bytes) || fails_on_purpose())
        return NULL;
    return malloc(bytes ? bytes : 1);
}

void *ffd_alloc_whole(size_t count, size_t size)
{
#ifdef MADV_HUGEPAGE
    size_t bytes;
    if (ffd_multiply_size(count, size, &bytes) && bytes >= LARGE_BLOCK && bytes <= SIZE_MAX - LARGE_PAGE) {
        /* Aligned to huge pages: the system uses them for aligned memory only. */
        const size_t whole = (bytes + LARGE_PAGE - 1) / LARGE_PAGE * LARGE_PAGE;
        void *block = fails_on_purpose() ? NULL : aligned_alloc(LARGE_PAGE, whole);
        if (block)
            madvise(block, whole, MADV_HUGEPAGE); /* only advice: a failure does no harm */
        return block;
    }
#endif
    return ffd_alloc(count, size);
}

void *ffd_alloc_zero(size_t count, size_t size)
{
    size_t bytes;
    if (!ffd_multiply_size(count, size, &bytes) || fails_on_purpose())
        return NULL;
    return calloc(bytes ? bytes : 1, 1);
}

void *ffd_alloc_sparse(size_t count, size_t size)
{
    char *const block = ffd_alloc_zero(count, size);
#ifdef MADV_HUGEPAGE
    /* calloc does not write to memory that is new from the system, so no page is allocated yet. The block may
       begin anywhere, but a huge page only at a multiple of its size. */
    const size_t before = block ? (LARGE_PAGE - (uintptr_t)block % LARGE_PAGE) % LARGE_PAGE : 0;
    if (block && count * size >= LARGE_BLOCK)
        madvise(block + before, (count * size - before) / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE);
#endif
    return block;
}

void *ffd_realloc(void *block, size_t count, size_t size)
{
    size_t bytes;
    if (!ffd_multiply_size(count, size, &bytes) || fails_on_purpose())
        return NULL;
    return realloc(block, bytes ? bytes : 1);
}

void ffd_free(void *block)
{
    free(block);
}

bool ffd_grow(void **block, size_t *capacity, size_t needed, size_t size)
{
    if (needed <= *capacity)
        return true;
    size_t larger = *capacity + *capacity / 2;
    if (larger < needed)
        larger = needed;
    if (larger < 16)
        larger = 16;
    void *grown = ffd_realloc(*block, larger, size);
    if (!grown)
        return false;
    *block = grown;
    *capacity = larger;
    return true;
}
