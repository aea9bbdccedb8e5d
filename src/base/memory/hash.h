/* hash.h - 128-bit hashes (XXH3) that distinguish contents. They are not cryptographic: content with a given
   hash can be forged. */
#ifndef FFD_BASE_MEMORY_HASH_H
#define FFD_BASE_MEMORY_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* In the canonical form: big-endian on every machine. */
typedef struct hash128 {
    unsigned char bytes[16];
} hash128;

/* Hashes size bytes. bytes may be NULL if size is 0. */
hash128 ffd_hash(const void *bytes, size_t size);

typedef struct hash_block {
    const void *bytes;
    size_t size;
} hash_block;

/* Hashes several blocks as if they were one contiguous block. */
hash128 ffd_hash_blocks(const hash_block *blocks, size_t count);

/* The hash of bytes that arrive in pieces, equal to the hash of one contiguous block. */
typedef struct hash_stream hash_stream;
/* Returns NULL if memory runs out. Free with ffd_free. */
hash_stream *ffd_hash_stream_create(void);
/* Adds the next bytes. */
void ffd_hash_stream_add(hash_stream *stream, const void *bytes, size_t size);
/* Returns the hash of all bytes added so far. */
hash128 ffd_hash_stream_value(const hash_stream *stream);

/* Hashes the bits of the values as 8 little-endian bytes each, so the hash is the same on every machine. 0
   and -0 differ. */
hash128 ffd_hash_doubles(const double *values, size_t count);

static inline bool ffd_hash_equal(const hash128 *a, const hash128 *b)
{
    return memcmp(a->bytes, b->bytes, sizeof a->bytes) == 0;
}

#endif
