/* image_header.c - finds the size of an image in its first bytes. */
#include "picture/image/image.h"
#include <string.h>

static uint32_t big_endian(const unsigned char *at, int bytes)
{
    uint32_t number = 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | at[i];
    return number;
}

static uint32_t little_endian(const unsigned char *at, int bytes)
{
    uint32_t number = 0;
    for (int i = bytes; i-- > 0;)
        number = number << 8 | at[i];
    return number;
}

/* The frame header is the first chunk (PNG specification, 11.2.1). */
static bool measure_png(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height)
{
    if (size < 24 || memcmp(bytes + 12, "IHDR", 4) != 0)
        return false;
    *width = big_endian(bytes + 16, 4);
    *height = big_endian(bytes + 20, 4);
    return true;
}

/* Whether a marker begins a frame, with the size of the image (ITU-T T.81, table B.1). */
static bool is_frame(unsigned char marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/* Skips segments up to the first frame (ITU-T T.81, annex B). */
static bool measure_jpeg(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height)
{
    for (size_t at = 2; size - at >= 9;) {
        if (bytes[at] != 0xff)
            return false;
        const unsigned char marker = bytes[at + 1];
        if (marker == 0xff) { /* a byte that fills up */
            at++;
            continue;
        }
        if (is_frame(marker)) {
            *height = big_endian(bytes + at + 5, 2);
            *width = big_endian(bytes + at + 7, 2);
            return true;
        }
        const size_t length = big_endian(bytes + at + 2, 2);
        if (length < 2 || length > size - at - 2)
            return false;
        at += 2 + length;
    }
    return false;
}

/* The first chunk is one of three kinds (WebP container specification; RFC 6386, 9.1). */
static bool measure_webp(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height)
{
    if (size < 30)
        return false;
    if (memcmp(bytes + 12, "VP8X", 4) == 0) {
        *width = little_endian(bytes + 24, 3) + 1;
        *height = little_endian(bytes + 27, 3) + 1;
    } else if (memcmp(bytes + 12, "VP8L", 4) == 0) {
        const uint32_t sides = little_endian(bytes + 21, 4);
        *width = (sides & 0x3fff) + 1;
        *height = (sides >> 14 & 0x3fff) + 1;
    } else if (memcmp(bytes + 12, "VP8 ", 4) == 0) {
        *width = little_endian(bytes + 26, 2) & 0x3fff;
        *height = little_endian(bytes + 28, 2) & 0x3fff;
    } else {
        return false;
    }
    return true;
}

bool ffd_image_measure(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height)
{
    switch (ffd_image_format(bytes, size)) {
    case IMAGE_PNG:
        return measure_png(bytes, size, width, height);
    case IMAGE_JPEG:
        return measure_jpeg(bytes, size, width, height);
    case IMAGE_WEBP:
        return measure_webp(bytes, size, width, height);
    default:
        return false;
    }
}
