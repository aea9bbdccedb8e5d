/* fuzz_target.h - what every fuzz target consists of: what is done with an input, and mutations that know
   what the input is. */
#ifndef FFD_TESTS_FUZZ_FUZZ_TARGET_H
#define FFD_TESTS_FUZZ_FUZZ_TARGET_H

#include <stddef.h>
#include <stdint.h>

/* libFuzzer's names. Returns 0; a broken promise aborts. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Changes data of size bytes, in a buffer of capacity bytes, as seed says. Returns its new size. */
size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed);

#endif
