/* decimal_kernel.h - formats many numbers at once; used by decimal.c only. */
#ifndef FFD_BASE_TEXT_DECIMAL_KERNEL_H
#define FFD_BASE_TEXT_DECIMAL_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* LEAST_EXPONENT: the least binary exponent, of the mantissa as an integer, that the kernel handles. */
#define LEAST_EXPONENT (-84)
#define MANTISSA_BITS 52

/* The powers that LEAST_EXPONENT needs, padded with zeros to four registers. */
#define POWERS_OF_FIVE 32
#define MOST_POWER_OF_FIVE 26
extern const uint64_t ffd_powers_of_five[POWERS_OF_FIVE];

/* Number of values in a batch. */
#define DECIMAL_BATCH 24

/* The shortest texts of numbers, as ffd_number_format writes them: three groups of 8 characters for each, the
   first in the lowest byte, and the length. A length of 0 means that the caller must format the number by
   itself: ffd_decimal_format does not handle it, or it is written with an exponent, or it has more than seven
   characters, including the sign, before the point. */
typedef struct decimal_batch {
    uint64_t words[3][DECIMAL_BATCH], size[DECIMAL_BATCH];
} decimal_batch;

/* Exists for AVX-512 only: with other instruction sets it would not be much faster than one number at a
   time. */
typedef void decimal_kernel(const double values[DECIMAL_BATCH], decimal_batch *batch);

#ifdef FFD_X86
decimal_kernel ffd_decimal_kernel_avx512;
#endif

#endif
