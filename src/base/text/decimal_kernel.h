/* decimal_kernel.h - the texts of many numbers at once (inside decimal). */
#ifndef FFD_BASE_TEXT_DECIMAL_KERNEL_H
#define FFD_BASE_TEXT_DECIMAL_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* Of the mantissa as a whole number, of numbers that have digits here. */
#define LEAST_EXPONENT (-84)
#define MANTISSA_BITS 52

/* As many as LEAST_EXPONENT asks for, and zeros up to the size of four registers. */
#define POWERS_OF_FIVE 32
#define MOST_POWER_OF_FIVE 26
extern const uint64_t ffd_powers_of_five[POWERS_OF_FIVE];

/* Numbers that are made at once. */
#define DECIMAL_BATCH 24

/* The shortest texts of numbers, as ffd_number_format has them: three times 8 characters of each, the first
   lowest, and how many of them it has; 0 where it is to be made by itself: none of those that
   ffd_decimal_format is for, or one that is written with an exponent or has more than seven characters before
   the point, the sign among them. */
typedef struct decimal_batch {
    uint64_t words[3][DECIMAL_BATCH], size[DECIMAL_BATCH];
} decimal_batch;

/* The kernel of the one instruction set (AVX-512) that is much faster by it than number by number. */
typedef void decimal_kernel(const double values[DECIMAL_BATCH], decimal_batch *batch);

#ifdef FFD_X86
decimal_kernel ffd_decimal_kernel_avx512;
#endif

#endif
