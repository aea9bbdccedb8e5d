/* base64.h - RFC 4648, section 4. */
#ifndef FFD_IO_GLTF_FILE_BASE64_H
#define FFD_IO_GLTF_FILE_BASE64_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes that size characters stand for at most. */
static inline size_t ffd_base64_capacity(size_t size)
{
    return size / 4 * 3 + 3;
}

/* Decodes size characters into bytes (ffd_base64_capacity) and tells how many they are. The final '=' may be
   missing. False: some other character, or a piece that is no whole byte. */
bool ffd_base64_decode(const char *text, size_t size, unsigned char *bytes, size_t *count);

/* The characters of count bytes, with the final '='. */
static inline size_t ffd_base64_length(size_t count)
{
    return count / 3 * 4 + (count % 3 ? 4 : 0);
}

/* Encodes count bytes into ffd_base64_length(count) characters (no final 0). */
void ffd_base64_encode(const unsigned char *bytes, size_t count, char *text);

#endif
