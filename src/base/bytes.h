/* bytes.h - which of many bytes are of a kind, at once. */
#ifndef FFD_BASE_BYTES_H
#define FFD_BASE_BYTES_H

#include "base/inline.h"
#include "base/little_endian.h"
#include <stdint.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#define BYTES_ONES UINT64_C(0x0101010101010101)
#define BYTES_TOPS UINT64_C(0x8080808080808080)

/* Of eight bytes, the first lowest, those below '!', as blanks and line ends are: their highest bits, and no
   others. */
static ALWAYS_INLINE uint64_t bytes_low(uint64_t eight)
{
    return ~((eight | BYTES_TOPS) - '!' * BYTES_ONES) & ~eight & BYTES_TOPS;
}

/* Likewise those that are no digits. */
static ALWAYS_INLINE uint64_t bytes_not_digits(uint64_t eight)
{
    const uint64_t values = eight ^ '0' * BYTES_ONES;
    return (values | ((values & ~BYTES_TOPS) + 0x76 * BYTES_ONES)) & BYTES_TOPS;
}

/* A bit for each of eight bytes instead of its highest. */
static ALWAYS_INLINE uint64_t bytes_gather(uint64_t tops)
{
    return (tops >> 7) * UINT64_C(0x0102040810204080) >> 56;
}

/* Of 64 bytes, a bit for each below '!'. */
static ALWAYS_INLINE uint64_t bytes_low_of_64_by_words(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 64; i += 8)
        found |= bytes_gather(bytes_low(load_u64((const unsigned char *)at + i))) << i;
    return found;
}

/* Of 32 bytes, a bit for each that is no digit. */
static ALWAYS_INLINE uint32_t bytes_not_digits_of_32_by_words(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 32; i += 8)
        found |= bytes_gather(bytes_not_digits(load_u64((const unsigned char *)at + i))) << i;
    return (uint32_t)found;
}

#ifdef __SSE2__
/* The same, with instructions that every x86-64 has. */
static ALWAYS_INLINE __m128i bytes_sixteen(const char *at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)at);
}

static ALWAYS_INLINE uint64_t bytes_low_of_64_sse2(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 64; i += 16) {
        const __m128i bytes = bytes_sixteen(at + i);
        const __m128i low = _mm_cmpeq_epi8(_mm_min_epu8(bytes, _mm_set1_epi8(' ')), bytes);
        found |= (uint64_t)(uint32_t)_mm_movemask_epi8(low) << i;
    }
    return found;
}

static ALWAYS_INLINE uint32_t bytes_not_digits_of_32_sse2(const char *at)
{
    uint32_t digits = 0;
    for (int i = 0; i < 32; i += 16) {
        const __m128i values = _mm_sub_epi8(bytes_sixteen(at + i), _mm_set1_epi8('0'));
        const __m128i are = _mm_cmpeq_epi8(_mm_min_epu8(values, _mm_set1_epi8(9)), values);
        digits |= (uint32_t)_mm_movemask_epi8(are) << i;
    }
    return ~digits;
}

#define bytes_low_of_64 bytes_low_of_64_sse2
#define bytes_not_digits_of_32 bytes_not_digits_of_32_sse2
#else
#define bytes_low_of_64 bytes_low_of_64_by_words
#define bytes_not_digits_of_32 bytes_not_digits_of_32_by_words
#endif

#endif
