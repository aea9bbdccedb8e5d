/* fuzz_png.c - a PNG texture. The checksums of mutated chunks are made right, or hardly one would be looked
 * into. */
#include "check_image.h"
#include "fuzz_target.h"

#define HEAD 8
/* Length, kind and checksum. */
#define CHUNK 12

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check_image(data, size, "\x89PNG\r\n\x1a\n", HEAD);
    return 0;
}

/* CRC-32 (PNG, annex D). */
static uint32_t checksum(const uint8_t *data, size_t size)
{
    uint32_t sum = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        sum ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum >> 1 ^ (sum & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~sum;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    size = mutate_bytes(data, size, capacity, seed);
    for (size_t at = HEAD; seed % 8 && at <= size && size - at >= CHUNK;) {
        uint8_t *const chunk = data + at;
        const size_t length =
            (size_t)chunk[0] << 24 | (size_t)chunk[1] << 16 | (size_t)chunk[2] << 8 | chunk[3];
        if (length > size - at - CHUNK)
            break;
        const uint32_t sum = checksum(chunk + 4, 4 + length);
        for (int i = 0; i < 4; i++)
            chunk[8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i) & 0xff);
        at += CHUNK + length;
    }
    return size;
}
