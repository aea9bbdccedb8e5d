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

/* Hashes the bytes of all blocks, one after the other, as if they were one block. */
hash128 ffd_hash_blocks(const hash_block *blocks, size_t count);

/* A hash of bytes that come one piece after the other, as if they were one block. */
typedef struct hash_stream hash_stream;
/* NULL if memory runs out; free with ffd_free. */
hash_stream *ffd_hash_stream_create(void);
/* Adds the next bytes. */
void ffd_hash_stream_add(hash_stream *stream, const void *bytes, size_t size);
/* Of what was added so far. */
hash128 ffd_hash_stream_value(const hash_stream *stream);

/* Hashes the values' bits, 8 bytes each, the lowest byte first: the same on every
   machine. 0 and -0 differ. */
hash128 ffd_hash_doubles(const double *values, size_t count);

static inline bool ffd_hash_equal(const hash128 *a, const hash128 *b)
{
    return memcmp(a->bytes, b->bytes, sizeof a->bytes) == 0;
}

#endif
