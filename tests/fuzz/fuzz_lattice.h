/* fuzz_lattice.h - the fuzz target, and mutations that keep a lattice file a lattice file. */
#ifndef FFD_TESTS_FUZZ_FUZZ_LATTICE_H
#define FFD_TESTS_FUZZ_FUZZ_LATTICE_H

#include <stddef.h>
#include <stdint.h>

/* libFuzzer's names. Returns 0; a broken promise aborts. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Changes data of size bytes, of which there is room for capacity, by what seed says; returns its new size.
 */
size_t mutate_lattice(uint8_t *data, size_t size, size_t capacity, uint64_t seed);

#endif
