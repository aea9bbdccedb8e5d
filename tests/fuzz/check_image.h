/* check_image.h - what holds for every image, and mutations that any format stands. */
#ifndef FFD_TESTS_FUZZ_CHECK_IMAGE_H
#define FFD_TESTS_FUZZ_CHECK_IMAGE_H

#include <stddef.h>
#include <stdint.h>

/* Decodes data, with its first bytes made those of magic. Breaks a promise where the result is neither an
   image nor an error with a message. */
void check_image(const uint8_t *data, size_t size, const void *magic, size_t magic_size);

/* Changes, moves or removes bytes; returns the new size. */
size_t mutate_bytes(uint8_t *data, size_t size, size_t capacity, uint64_t seed);

#endif
