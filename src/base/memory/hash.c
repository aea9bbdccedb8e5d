#include "base/memory/hash.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include <stdint.h>

/* Inlined, so that the streaming state can be on the stack: its size is then fixed by this header and does
   not depend on the installed library. */
#define XXH_INLINE_ALL
#include <xxhash.h>

/* Number of doubles that are converted to bytes at a time. */
#define RUN 512

static hash128 canonical(XXH128_hash_t hash)
{
    XXH128_canonical_t form;
    hash128 result;
    XXH128_canonicalFromHash(&form, hash);
    memcpy(result.bytes, form.digest, sizeof result.bytes);
    return result;
}

hash128 ffd_hash(const void *bytes, size_t size)
{
    const hash_block block = {bytes, size};
    return ffd_hash_blocks(&block, 1);
}

hash128 ffd_hash_blocks(const hash_block *blocks, size_t count)
{
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    for (size_t i = 0; i < count; i++)
        if (blocks[i].size)
            XXH3_128bits_update(&state, blocks[i].bytes, blocks[i].size);
    return canonical(XXH3_128bits_digest(&state));
}

struct hash_stream {
    XXH3_state_t *state; /* points into the bytes that follow, with the alignment it needs */
};

#define STATE_ALIGNMENT _Alignof(XXH3_state_t)

hash_stream *ffd_hash_stream_create(void)
{
    hash_stream *const stream = ffd_alloc(1, sizeof *stream + sizeof(XXH3_state_t) + STATE_ALIGNMENT);
    if (!stream)
        return NULL;
    unsigned char *const free = (unsigned char *)(stream + 1);
    stream->state = (void *)(free + (STATE_ALIGNMENT - (uintptr_t)free % STATE_ALIGNMENT));
    XXH3_128bits_reset(stream->state);
    return stream;
}

void ffd_hash_stream_add(hash_stream *stream, const void *bytes, size_t size)
{
    if (size)
        XXH3_128bits_update(stream->state, bytes, size);
}

hash128 ffd_hash_stream_value(const hash_stream *stream)
{
    return canonical(XXH3_128bits_digest(stream->state));
}

hash128 ffd_hash_doubles(const double *values, size_t count)
{
    unsigned char bytes[8 * RUN];
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    for (size_t done = 0; done < count;) {
        const size_t run = count - done < RUN ? count - done : RUN;
        for (size_t i = 0; i < run; i++)
            store_double(bytes + 8 * i, values[done + i]);
        XXH3_128bits_update(&state, bytes, 8 * run);
        done += run;
    }
    return canonical(XXH3_128bits_digest(&state));
}
