/* hash.h - 128-bit hashes (XXH3) that distinguish contents. They do not protect against somebody who makes
   contents to fit. */
#ifndef FFD_BASE_MEMORY_HASH_H
#define FFD_BASE_MEMORY_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* In the canonical form: the highest byte first, on every machine. */
typedef struct hash128 {
    unsigned char bytes[16];
} hash128;

/* bytes may be NULL where size is 0. */
hash128 ffd_hash(const void *bytes, size_t size);

typedef struct hash_block {
    const void *bytes;
    size_t size;
} hash_block;

/* Of the bytes of all blocks, one after the other, as if they were one. */
hash128 ffd_hash_blocks(const hash_block *blocks, size_t count);

/* Of the values' bits, 8 bytes each, the lowest byte first: the same on every machine. 0 and -0 differ. */
hash128 ffd_hash_doubles(const double *values, size_t count);

static inline bool ffd_hash_equal(const hash128 *a, const hash128 *b)
{
    return memcmp(a->bytes, b->bytes, sizeof a->bytes) == 0;
}

#endif
