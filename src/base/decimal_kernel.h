/* decimal_kernel.h - the digits of many numbers at once (inside decimal). */
#ifndef FFD_BASE_DECIMAL_KERNEL_H
#define FFD_BASE_DECIMAL_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* Of the mantissa as a whole number, of numbers that have digits here. */
#define LEAST_EXPONENT (-84)
#define MANTISSA_BITS 52

/* As many as LEAST_EXPONENT asks for. */
#define POWERS_OF_FIVE 27
extern const uint64_t ffd_powers_of_five[POWERS_OF_FIVE];

/* Numbers that are found at once. */
#define DECIMAL_BATCH 24

/* A number's shortest digits: first (nothing where it is 0), the 8 of middle and the 8 of low, whose bytes
   are 0 to 9, the foremost lowest; and how many places they are to be moved by: 0 where the number is none of
   those that ffd_decimal_format is for. */
typedef struct decimal_batch {
    uint64_t first[DECIMAL_BATCH], middle[DECIMAL_BATCH], low[DECIMAL_BATCH], point[DECIMAL_BATCH];
} decimal_batch;

/* Of the one instruction set that is much faster by it than by one number after the other. */
typedef void decimal_kernel(const double values[DECIMAL_BATCH], decimal_batch *batch);

#ifdef FFD_X86
decimal_kernel ffd_decimal_kernel_avx512;
#endif

#endif
