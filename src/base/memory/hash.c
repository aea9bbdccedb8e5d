#include "base/memory/hash.h"
#include "base/little_endian.h"

/* Compiled in, the streaming state can be on the stack: its size is then the header's, not that of
   whatever library is installed. */
#define XXH_INLINE_ALL
#include <xxhash.h>

/* Doubles turned into bytes at a time. */
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
