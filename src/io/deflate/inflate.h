/* inflate.h - decompresses and compresses deflate streams with zlib, in a module that is loaded on first use
   (inflate.c, inflate_load.c). */
#ifndef FFD_IO_DEFLATE_INFLATE_H
#define FFD_IO_DEFLATE_INFLATE_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>

/* Inflates a whole stream, of zlib (RFC 1950) or a raw one (RFC 1951), to exactly `wanted` bytes. Errors:
   FFD_E_INVALID for a broken stream, one that ends early, and one of another size; FFD_E_MEMORY; of the
   deadline; those of ffd_module_load. */
ffd_status ffd_inflate(const unsigned char *bytes, size_t size, bool is_raw, unsigned char *out,
                       size_t wanted, ffd_error *error);

/* Returns how many bytes ffd_deflate makes of so many at most: stored blocks of 16 kB have 5 bytes more. */
static inline size_t ffd_deflate_most(size_t size)
{
    return size + size / 1000 + 64;
}

/* Compresses bytes to a whole stream of zlib (RFC 1950), of *made bytes; out has room for
   ffd_deflate_most(size). Errors: FFD_E_MEMORY; of the deadline; those of ffd_module_load. */
ffd_status ffd_deflate(const unsigned char *bytes, size_t size, unsigned char *out, size_t *made,
                       ffd_error *error);

#endif
