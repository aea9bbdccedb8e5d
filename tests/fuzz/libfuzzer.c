/* libfuzzer.c - one in four mutations is libFuzzer's own, the others are those of mutate.c. */
#include "fuzz_lattice.h"

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t capacity);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed)
{
    if (seed % 4 == 0)
        return LLVMFuzzerMutate(data, size, capacity);
    return mutate_lattice(data, size, capacity, seed);
}
