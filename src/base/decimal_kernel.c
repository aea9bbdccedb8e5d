/* decimal_kernel.c - compiled for an instruction set with lanes: FFD_DECIMAL_KERNEL is the function's name,
   FFD_LANES the number of numbers in hand at a time. Step by step it is decimal.c. */
#include "base/decimal_kernel.h"
#include "base/lanes.h"

typedef uint64_t words __attribute__((vector_size(8 * FFD_LANES)));
typedef uint32_t halves __attribute__((vector_size(8 * FFD_LANES))); /* two in each word */

#define EIGHT UINT64_C(100000000)
#define HALF UINT64_C(0xffffffff)

/* 2^52 as a double, whose last bits then are a whole number. */
#define WHOLE UINT64_C(0x4330000000000000)

static ALWAYS_INLINE words words_of(uint64_t value)
{
    return value - (words){0};
}

/* Of numbers below 2^52. */
static ALWAYS_INLINE lanes to_lanes(words whole)
{
    return (lanes)(whole | WHOLE) - 0x1p52;
}

static ALWAYS_INLINE words to_words(lanes value)
{
    return (words)(value + 0x1p52) & (((uint64_t)1 << MANTISSA_BITS) - 1);
}

/* a b, of which the lower and upper 64 bits. */
static ALWAYS_INLINE void multiply(words a, words b, words *low, words *high)
{
    const words a0 = a & HALF, a1 = a >> 32, b0 = b & HALF, b1 = b >> 32;
    const words least = a0 * b0, one = a1 * b0 + (least >> 32), other = a0 * b1 + (one & HALF);
    *low = other << 32 | (least & HALF);
    *high = a1 * b1 + (one >> 32) + (other >> 32);
}

static ALWAYS_INLINE words choose(words which, words yes, words no)
{
    return (which & yes) | (~which & no);
}

static ALWAYS_INLINE words eight_digits(words value)
{
    const words high = value * 109951163 >> 40; /* / 10000 */
    const halves fours = (halves)(high | (value - high * 10000) << 32);
    const halves hundreds = fours * 10486 >> 20, pairs = hundreds | (fours - 100 * hundreds) << 16;
    const halves tens = pairs * 103 >> 10 & 0x000f000f;
    return (words)(tens | (pairs - 10 * tens) << 8);
}

static ALWAYS_INLINE words five_to(words power)
{
    words result;
    for (int l = 0; l < FFD_LANES; l++)
        result[l] = ffd_powers_of_five[power[l]];
    return result;
}

static ALWAYS_INLINE void find(const double *values, decimal_batch *batch, size_t at)
{
    const uint64_t hidden = (uint64_t)1 << MANTISSA_BITS;
    const words bits = (words)lanes_load(values), fraction = bits & (hidden - 1);
    const words above = (bits >> MANTISSA_BITS & 0x7ff) - (1075 + LEAST_EXPONENT);
    const words fits = (words)(fraction != 0) & (words)(above < -LEAST_EXPONENT);
    const words less = -LEAST_EXPONENT - (above & fits); /* of others something that does no harm */
    const words point = (less * 315653 + ((1 << 20) - 1)) >> 20, shift = 2 + less - point;
    const words mantissa = fraction | hidden, five = five_to(point);
    words scaled, high;
    multiply(4 * mantissa, five, &scaled, &high);
    const words unit = words_of(1) << shift, part = scaled & (unit - 1);
    const words whole = high << (64 - shift) | scaled >> shift;
    const words reach = 2 * five - (mantissa & 1);
    /* whole = 10^8 upper + lower. 10^8 = 2^8 390625, and rounding is off by one at most. */
    words upper = to_words(to_lanes(whole >> 8) * (1 / 390625.0)), lower = whole - upper * EIGHT;
    const words over = (words)((mask)lower < 0);
    upper += over;
    lower += over & EIGHT;
    const words last_digit = lower - 10 * (lower * UINT64_C(0xcccccccd) >> 35);
    const words above_ten = (last_digit << shift) + part;
    const words down = (words)(above_ten <= reach), up = (words)(10 * unit - above_ten <= reach);
    const words nearest = (words)(part + (whole & 1) > unit >> 1) & 1;
    lower += choose(down | up, (up & 10) - last_digit, nearest);
    const words carry = (words)(lower >= EIGHT);
    upper -= carry;
    lower -= carry & EIGHT;
    const words first = upper * 1441151881 >> 57; /* / 10^8 */
    lanes_store((lanes)first, (double *)batch->first + at);
    lanes_store((lanes)eight_digits(upper - first * EIGHT), (double *)batch->middle + at);
    lanes_store((lanes)eight_digits(lower), (double *)batch->low + at);
    lanes_store((lanes)(point & fits), (double *)batch->point + at);
}

void FFD_DECIMAL_KERNEL(const double values[DECIMAL_BATCH], decimal_batch *batch)
{
    for (size_t at = 0; at < DECIMAL_BATCH; at += FFD_LANES)
        find(values + at, batch, at);
}
