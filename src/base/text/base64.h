/* base64.h - base64 (RFC 4648, section 4). */
#ifndef FFD_BASE_TEXT_BASE64_H
#define FFD_BASE_TEXT_BASE64_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the capacity in bytes that decoding size characters needs. */
static inline size_t ffd_base64_capacity(size_t size)
{
    return size / 4 * 3 + 3;
}

/* Decodes size characters into bytes, which has a capacity of ffd_base64_capacity(size), and sets *count to
   their number. The padding '=' may be missing. Returns false at an invalid character, or if the text ends
   within a byte. */
bool ffd_base64_decode(const char *text, size_t size, unsigned char *bytes, size_t *count);

/* Decodes up to count bytes of a text, moves *at behind what it has read, and returns their number. White
   space is skipped. Each group of four characters may be the last one of a text, as where one follows
   another. Stops before '<', at last, and at what is not base64. */
size_t ffd_base64_take(const char **at, const char *last, unsigned char *bytes, size_t count);

/* Returns the number of characters that encode count bytes, with padding. */
static inline size_t ffd_base64_length(size_t count)
{
    return count / 3 * 4 + (count % 3 ? 4 : 0);
}

/* Encodes count bytes into ffd_base64_length(count) characters, without a final NUL. */
void ffd_base64_encode(const unsigned char *bytes, size_t count, char *text);

#endif
