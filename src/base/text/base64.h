/* base64.h - base64 (RFC 4648, section 4). */
#ifndef FFD_BASE_TEXT_BASE64_H
#define FFD_BASE_TEXT_BASE64_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the largest number of bytes that size characters encode. */
static inline size_t ffd_base64_capacity(size_t size)
{
    return size / 4 * 3 + 3;
}

/* Decodes size characters into bytes (of ffd_base64_capacity) and sets *count to their number. The final '='
   may be missing. Returns false at any other character, and where the text ends within a byte. */
bool ffd_base64_decode(const char *text, size_t size, unsigned char *bytes, size_t *count);

/* Returns the number of characters that count bytes take, with the final '='. */
static inline size_t ffd_base64_length(size_t count)
{
    return count / 3 * 4 + (count % 3 ? 4 : 0);
}

/* Encodes count bytes into ffd_base64_length(count) characters, without a final NUL. */
void ffd_base64_encode(const unsigned char *bytes, size_t count, char *text);

#endif
