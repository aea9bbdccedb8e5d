/* bytes.h - classifies many bytes at once (white space, digits), and converts digits to a number, without
   loops (SWAR and SIMD). Characters are in little-endian order: the first one is the lowest byte. */
#ifndef FFD_BASE_BYTES_H
#define FFD_BASE_BYTES_H

#include "base/inline.h"
#include "base/little_endian.h"
#include <stdint.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__AARCH64EL__)
#include <arm_neon.h>
#endif

#define BYTES_ONES UINT64_C(0x0101010101010101)
#define BYTES_TOPS UINT64_C(0x8080808080808080)

/* Marks the bytes below '!' (blanks and line ends): sets the highest bit of each of them, and clears all
   other bits. */
static ALWAYS_INLINE uint64_t bytes_low(uint64_t eight)
{
    return ~((eight | BYTES_TOPS) - '!' * BYTES_ONES) & ~eight & BYTES_TOPS;
}

/* Marks the bytes that are not digits in the same way. */
static ALWAYS_INLINE uint64_t bytes_not_digits(uint64_t eight)
{
    const uint64_t values = eight ^ '0' * BYTES_ONES;
    return (values | ((values & ~BYTES_TOPS) + 0x76 * BYTES_ONES)) & BYTES_TOPS;
}

/* Packs the highest bits of eight bytes into the lowest eight bits. */
static ALWAYS_INLINE uint64_t bytes_gather(uint64_t tops)
{
    return (tops >> 7) * UINT64_C(0x0102040810204080) >> 56;
}

/* Returns a bit mask of 64 bytes: 1 where the byte is below '!'. */
static ALWAYS_INLINE uint64_t bytes_low_of_64_by_words(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 64; i += 8)
        found |= bytes_gather(bytes_low(load_u64((const unsigned char *)at + i))) << i;
    return found;
}

/* Returns a bit mask of 32 bytes: 1 where the byte is not a digit. */
static ALWAYS_INLINE uint32_t bytes_not_digits_of_32_by_words(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 32; i += 8)
        found |= bytes_gather(bytes_not_digits(load_u64((const unsigned char *)at + i))) << i;
    return (uint32_t)found;
}

/* Returns the number of eight decimal digits (values 0 to 9, one in each byte, the most significant in the
   lowest byte): adjacent digits are combined to pairs, then pairs to groups of four. */
static ALWAYS_INLINE uint64_t bytes_number(uint64_t digits)
{
    const uint64_t pairs = (10 * digits + (digits >> 8)) & UINT64_C(0x00ff00ff00ff00ff);
    const uint64_t fours = (100 * pairs + (pairs >> 16)) & UINT64_C(0x0000ffff0000ffff);
    return (10000 * fours + (fours >> 32)) & UINT64_C(0xffffffff);
}

/* The numbers of two groups of eight digits. */
typedef struct byte_numbers {
    uint32_t first, second;
} byte_numbers;

static ALWAYS_INLINE byte_numbers bytes_two_numbers_by_words(uint64_t first, uint64_t second)
{
    return (byte_numbers){(uint32_t)bytes_number(first), (uint32_t)bytes_number(second)};
}

/* Returns a mask of the first count of eight bytes; 0 if count is 0 or negative. */
static ALWAYS_INLINE uint64_t bytes_first(int count)
{
    return count <= 0 ? 0 : count >= 8 ? UINT64_MAX : ((uint64_t)1 << (8 * count)) - 1;
}

/* Returns the number of 16 digits whose first `count` (at most 16) are those of a text, followed by zeros.
   The text has `before` digits, one character that is skipped (the decimal point), then the other digits. 17
   characters of the text are read. */
static ALWAYS_INLINE uint64_t bytes_digits_around_by_words(const char *text, int before, int count)
{
    uint64_t number = 0;
    for (int i = 0; i < 16; i += 8) {
        const uint64_t there = load_u64((const unsigned char *)text + i),
                       behind = load_u64((const unsigned char *)text + i + 1), kept = bytes_first(before - i),
                       wanted = bytes_first(count - i);
        const uint64_t digits = (((there & kept) | (behind & ~kept)) ^ '0' * BYTES_ONES) & wanted;
        number = number * 100000000 + bytes_number(digits);
    }
    return number;
}

#if defined(__SSE2__)
/* The same with SSE2, which every x86-64 has. */
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

static ALWAYS_INLINE byte_numbers bytes_join_sse2(__m128i digits)
{
    const __m128i tens = _mm_mullo_epi16(_mm_and_si128(digits, _mm_set1_epi16(0xff)), _mm_set1_epi16(10));
    const __m128i pairs = _mm_add_epi16(tens, _mm_srli_epi16(digits, 8));
    const __m128i fours = _mm_madd_epi16(pairs, _mm_set1_epi32(1 << 16 | 100));
    const __m128i eights = _mm_madd_epi16(_mm_packs_epi32(fours, fours), _mm_set1_epi32(1 << 16 | 10000));
    uint64_t both;
    _mm_storel_epi64((__m128i *)(void *)&both, eights);
    return (byte_numbers){(uint32_t)both, (uint32_t)(both >> 32)};
}

static ALWAYS_INLINE byte_numbers bytes_two_numbers_sse2(uint64_t first, uint64_t second)
{
    return bytes_join_sse2(_mm_set_epi64x((int64_t)second, (int64_t)first));
}

/* Returns a mask of the first count of 16 bytes. */
static ALWAYS_INLINE __m128i bytes_first_sse2(int count)
{
    static const signed char bytes[32] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    return bytes_sixteen((const char *)bytes + 16 - count);
}

static ALWAYS_INLINE uint64_t bytes_digits_around_sse2(const char *text, int before, int count)
{
    const __m128i there = bytes_sixteen(text), behind = bytes_sixteen(text + 1);
    const __m128i kept = bytes_first_sse2(before), wanted = bytes_first_sse2(count);
    const __m128i digits = _mm_or_si128(_mm_and_si128(kept, there), _mm_andnot_si128(kept, behind));
    const byte_numbers halves =
        bytes_join_sse2(_mm_and_si128(wanted, _mm_xor_si128(digits, _mm_set1_epi8('0'))));
    return halves.first * UINT64_C(100000000) + halves.second;
}

#define bytes_low_of_64 bytes_low_of_64_sse2
#define bytes_not_digits_of_32 bytes_not_digits_of_32_sse2
#define bytes_two_numbers bytes_two_numbers_sse2
#define bytes_digits_around bytes_digits_around_sse2
#elif defined(__AARCH64EL__)
/* The same with NEON, which every arm64 has. Pairwise sums take the place of the instruction that collects
   one bit of each byte: bit i % 8 of byte i, summed over eight bytes, is a byte of the mask. */
static ALWAYS_INLINE uint8x16_t bytes_own_bits_neon(uint8x16_t chosen)
{
    static const uint8_t bits[16] = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    return vandq_u8(chosen, vld1q_u8(bits));
}

static ALWAYS_INLINE uint8x16_t bytes_low_neon(const char *at)
{
    return bytes_own_bits_neon(vcleq_u8(vld1q_u8((const uint8_t *)at), vdupq_n_u8(' ')));
}

static ALWAYS_INLINE uint8x16_t bytes_not_digits_neon(const char *at)
{
    const uint8x16_t values = vsubq_u8(vld1q_u8((const uint8_t *)at), vdupq_n_u8('0'));
    return bytes_own_bits_neon(vcgtq_u8(values, vdupq_n_u8(9)));
}

static ALWAYS_INLINE uint64_t bytes_low_of_64_neon(const char *at)
{
    const uint8x16_t fours = vpaddq_u8(vpaddq_u8(bytes_low_neon(at), bytes_low_neon(at + 16)),
                                       vpaddq_u8(bytes_low_neon(at + 32), bytes_low_neon(at + 48)));
    return vgetq_lane_u64(vreinterpretq_u64_u8(vpaddq_u8(fours, fours)), 0);
}

static ALWAYS_INLINE uint32_t bytes_not_digits_of_32_neon(const char *at)
{
    const uint8x16_t pairs = vpaddq_u8(bytes_not_digits_neon(at), bytes_not_digits_neon(at + 16)),
                     fours = vpaddq_u8(pairs, pairs);
    return vgetq_lane_u32(vreinterpretq_u32_u8(vpaddq_u8(fours, fours)), 0);
}

#define bytes_low_of_64 bytes_low_of_64_neon
#define bytes_not_digits_of_32 bytes_not_digits_of_32_neon
#define bytes_two_numbers bytes_two_numbers_by_words
#define bytes_digits_around bytes_digits_around_by_words
#else
#define bytes_low_of_64 bytes_low_of_64_by_words
#define bytes_not_digits_of_32 bytes_not_digits_of_32_by_words
#define bytes_two_numbers bytes_two_numbers_by_words
#define bytes_digits_around bytes_digits_around_by_words
#endif

/* Returns a bit mask of 64 bytes: 1 where the byte is not a digit. */
static ALWAYS_INLINE uint64_t bytes_not_digits_of_64(const char *at)
{
    return bytes_not_digits_of_32(at) | (uint64_t)bytes_not_digits_of_32(at + 32) << 32;
}

#endif
