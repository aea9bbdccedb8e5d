/* decimal_kernel.c - compiled for AVX-512 only, under the name FFD_DECIMAL_KERNEL. The algorithm is that of
   decimal.c, step by step; the text of each number is assembled in three 64-bit words. */
#include "base/text/decimal_kernel.h"
#include "base/vector/lanes.h"
#include <immintrin.h>

typedef uint64_t words __attribute__((vector_size(64)));
typedef uint32_t halves __attribute__((vector_size(64))); /* two in each 64-bit word */

#define EIGHT UINT64_C(100000000)
#define ONES UINT64_C(0x0101010101010101)

/* The bits of 2^52 as a double: its lowest bits then hold an integer. */
#define WHOLE UINT64_C(0x4330000000000000)

static ALWAYS_INLINE words words_of(uint64_t value)
{
    return value - (words){0};
}

/* Converts integers below 2^52. */
static ALWAYS_INLINE lanes to_lanes(words whole)
{
    return (lanes)(whole | WHOLE) - 0x1p52;
}

static ALWAYS_INLINE words to_words(lanes value)
{
    return (words)(value + 0x1p52) & (((uint64_t)1 << MANTISSA_BITS) - 1);
}

/* Multiplies the lower halves; a multiplication of whole words takes three times as long. */
static ALWAYS_INLINE words times(words a, words b)
{
    return (words)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}

/* The lower and upper 64 bits of a * b. */
static ALWAYS_INLINE void multiply(words a, words b, words *low, words *high)
{
    const words half = words_of(UINT32_MAX), a1 = a >> 32, b1 = b >> 32;
    const words least = times(a, b), one = times(a1, b) + (least >> 32), other = times(a, b1) + (one & half);
    *low = other << 32 | (least & half);
    *high = times(a1, b1) + (one >> 32) + (other >> 32);
}

static ALWAYS_INLINE words choose(words which, words yes, words no)
{
    return (which & yes) | (~which & no);
}

/* The 8 digits of numbers below 10^8, one in each byte, the most significant in the lowest byte. */
static ALWAYS_INLINE words eight_digits(words value)
{
    const words high = times(value, words_of(109951163)) >> 40; /* / 10000 */
    const halves fours = (halves)(high | (value - times(high, words_of(10000))) << 32);
    const halves hundreds = fours * 10486 >> 20, pairs = hundreds | (fours - 100 * hundreds) << 16;
    const halves tens = pairs * 103 >> 10 & 0x000f000f;
    return (words)(tens | (pairs - 10 * tens) << 8);
}

/* Looks up powers of five, which fit in four registers. */
static ALWAYS_INLINE words five_to(words power)
{
    __m512i table[4];
    memcpy(table, ffd_powers_of_five, sizeof table);
    const __m512i at = (__m512i)power;
    const words low = (words)_mm512_permutex2var_epi64(table[0], at, table[1]),
                high = (words)_mm512_permutex2var_epi64(table[2], at, table[3]);
    return choose((words)(power < 16), low, high);
}

/* The 17 shortest digits of numbers in three groups of 1, 8 and 8; the first is 0 for numbers with 16
   digits. */
typedef struct digits {
    words first, middle, low; /* one digit in each byte, the most significant in the lowest */
    words point;              /* the number was scaled by 10^point to 16 or 17 digits */
    words fits;               /* all bits set for numbers that this kernel handles */
} digits;

/* As `shortest` in decimal.c. */
static ALWAYS_INLINE digits find(words bits)
{
    const uint64_t hidden = (uint64_t)1 << MANTISSA_BITS;
    const words fraction = bits & (hidden - 1);
    const words above = (bits >> MANTISSA_BITS & 0x7ff) - (1075 + LEAST_EXPONENT);
    const words fits = (words)(fraction != 0) & (words)(above < -LEAST_EXPONENT);
    const words less = -LEAST_EXPONENT - (above & fits); /* harmless values for numbers that are not
                                                            handled */
    const words point = (times(less, words_of(315653)) + ((1 << 20) - 1)) >> 20, shift = 2 + less - point;
    const words mantissa = fraction | hidden, five = five_to(point);
    words scaled, high;
    multiply(4 * mantissa, five, &scaled, &high);
    const words unit = words_of(1) << shift, part = scaled & (unit - 1);
    const words whole = high << (64 - shift) | scaled >> shift;
    const words reach = 2 * five - (mantissa & 1);
    /* whole = 10^8 * upper + lower. 10^8 = 2^8 * 390625, so this is off by at most one after rounding. */
    words upper = to_words(to_lanes(whole >> 8) * (1 / 390625.0));
    words lower = whole - times(upper, words_of(EIGHT));
    const words over = (words)((mask)lower < 0);
    upper += over;
    lower += over & EIGHT;
    const words last_digit = lower - 10 * (times(lower, words_of(0xcccccccd)) >> 35);
    const words above_ten = (last_digit << shift) + part;
    const words down = (words)(above_ten <= reach), up = (words)(10 * unit - above_ten <= reach);
    const words nearest = (words)(part + (whole & 1) > unit >> 1) & 1;
    lower += choose(down | up, (up & 10) - last_digit, nearest);
    const words carry = (words)(lower >= EIGHT);
    upper -= carry;
    lower -= carry & EIGHT;
    const words first = times(upper, words_of(1441151881)) >> 57; /* / 10^8 */
    return (digits){first, eight_digits(upper - times(first, words_of(EIGHT))), eight_digits(lower), point,
                    fits};
}

/* Returns the number of digits up to the last one that is not 0, of eight; negative if all are 0. It is taken
   from the exponent of the word converted to double: rounding cannot carry into the next byte. */
static ALWAYS_INLINE mask last_of(words eight)
{
    return (((mask) __builtin_convertvector(eight, lanes) >> MANTISSA_BITS) - 1023 + 8) >> 3;
}

/* Assembles the texts: the sign, leading zeros if the number is below 1, the digits and the decimal point.
   The digits after the point are moved to their place first, then the digits before the point are moved back
   by one. */
static ALWAYS_INLINE void write_numbers(const digits *d, words is_negative, decimal_batch *batch, size_t at)
{
    const words has_first = (words)(d->first != 0) & 1, sign = is_negative & 1;
    const mask before = (mask)(16 + has_first - d->point);
    const mask count = (mask)choose((words)(d->low != 0), (words)(8 + last_of(d->low)),
                                    (words)((mask)(d->middle != 0) & last_of(d->middle))) +
                       (mask)has_first;
    const words below_one = (words)(before <= 0);
    const words zeros = below_one & (words)(1 - before); /* including the zero before the point */
    const words point = choose(below_one, words_of(1), (words)before) + sign;
    const mask fixed = (mask)choose((words)(count + (mask)zeros > (mask)(point - sign)),
                                    (words)(count + (mask)zeros + 1), (words)before);
    const mask scientific = count + 4 - (count > 1);
    const words fits = d->fits & (words)(fixed <= scientific) & (words)((mask)point < 8);

    const words move = 8 * ((zeros & fits) + has_first + 1 + sign), back = 64 - move;
    const words moved = d->middle << move | d->first << (move - 8);
    const words front = words_of(1) << (8 * (point & fits));
    const words text = (moved >> 8 & (front - 1)) | (moved & (0 - front) << 8);
    lanes_store((lanes)(text + '0' * ONES - 2 * front - 3 * sign), (double *)batch->words[0] + at);
    lanes_store((lanes)((d->low << move | d->middle >> back) + '0' * ONES), (double *)batch->words[1] + at);
    lanes_store((lanes)((d->low >> back) + '0' * ONES), (double *)batch->words[2] + at);
    lanes_store((lanes)(((words)fixed + sign) & fits), (double *)batch->size + at);
}

void FFD_DECIMAL_KERNEL(const double values[DECIMAL_BATCH], decimal_batch *batch)
{
    for (size_t at = 0; at < DECIMAL_BATCH; at += FFD_LANES) {
        const words bits = (words)lanes_load(values + at);
        const digits d = find(bits);
        write_numbers(&d, (words)((mask)bits < 0), batch, at);
    }
}
