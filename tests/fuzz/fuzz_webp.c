/* fuzz_webp.c - a WebP texture. */
#include "check_image.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check_image(data, size, "RIFF", 4);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_bytes(data, size, capacity, seed);
}
