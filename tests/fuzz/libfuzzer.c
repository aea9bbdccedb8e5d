/* libfuzzer.c - one in four mutations is libFuzzer's own, the others are those of fuzz_mutate. */
#include "fuzz_target.h"

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t capacity);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t capacity, unsigned seed)
{
    if (seed % 4 == 0)
        return LLVMFuzzerMutate(data, size, capacity);
    return fuzz_mutate(data, size, capacity, seed);
}
