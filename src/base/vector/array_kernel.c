/* array_kernel.c - compiled once for each instruction set; FFD_ARRAY_KERNEL is the name of its table. */
#include "base/vector/array_kernel.h"
#include "base/little_endian.h"
#include "base/vector/vec.h"
#include <string.h>

/* Points that are processed at a time: their numbers fill whole registers of every instruction set. */
#define GROUP ((size_t)8)
#define NUMBERS (3 * GROUP)

static void read_floats(const unsigned char *restrict from, size_t count, double *restrict to)
{
    for (size_t i = 0; i < count; i++)
        to[i] = load_float(from + 4 * i);
}

static uint32_t read_u32(const unsigned char *restrict from, size_t count, uint32_t *restrict to)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < count; i++) {
        to[i] = load_u32(from + 4 * i);
        largest = to[i] > largest ? to[i] : largest;
    }
    return largest;
}

static void span(const uint32_t *numbers, size_t count, uint32_t *least, uint32_t *greatest)
{
    uint32_t low = numbers[0], high = low;
    for (size_t i = 1; i < count; i++) {
        low = numbers[i] < low ? numbers[i] : low;
        high = numbers[i] > high ? numbers[i] : high;
    }
    *least = low;
    *greatest = high;
}

/* The greater one of `largest` and the size of a number, unless that is infinite or NaN. */
static inline double enlarge(double largest, double number)
{
    const double size = fabs(number);
    const bool is_more = (size > largest) & (size <= DBL_MAX);
    return is_more ? size : largest;
}

static double magnitude(const double *numbers, size_t count)
{
    double largest[GROUP] = {0};
    size_t i = 0;
    for (; i + GROUP <= count; i += GROUP)
        for (size_t k = 0; k < GROUP; k++)
            largest[k] = enlarge(largest[k], numbers[i + k]);
    for (; i < count; i++)
        largest[0] = enlarge(largest[0], numbers[i]);
    for (size_t k = 1; k < GROUP; k++)
        largest[0] = larger_of(largest[0], largest[k]);
    return largest[0];
}

static void round_to_floats(const double *restrict from, size_t count, float *restrict to)
{
    for (size_t i = 0; i < count; i++)
        to[i] = (float)from[i];
}

static void add(const double *restrict terms, size_t count, double *restrict to)
{
    for (size_t i = 0; i < count; i++) {
        const double sum = to[i] + terms[i];
        to[i] = terms[i] != 0 ? sum : to[i];
    }
}

/* Running bounds over groups of points, separately for each number of a group. */
typedef struct group_range {
    double min[NUMBERS], max[NUMBERS];
    double zero[NUMBERS]; /* NaN where a number was not finite, else 0 */
} group_range;

static void widen_group(const double *restrict numbers, group_range *restrict range)
{
    for (size_t k = 0; k < NUMBERS; k++) {
        const double value = numbers[k];
        range->min[k] = value < range->min[k] ? value : range->min[k];
        range->max[k] = value > range->max[k] ? value : range->max[k];
        range->zero[k] += 0 * value;
    }
}

static bool widen(const double *points, size_t count, double min[3], double max[3])
{
    group_range range = {{0}, {0}, {0}};
    double last[NUMBERS];
    size_t first = 0;
    if (count == 0)
        return true;
    for (size_t k = 0; k < NUMBERS; k++)
        range.min[k] = range.max[k] = points[k % 3];
    for (; first + GROUP <= count; first += GROUP)
        widen_group(points + 3 * first, &range);
    for (size_t k = 0; k < NUMBERS; k++) /* the remaining points, padded with the last one */
        last[k] = points[3 * (first + k / 3 < count ? first + k / 3 : count - 1) + k % 3];
    widen_group(last, &range);
    for (size_t k = 0; k < NUMBERS; k++)
        if (!(range.zero[k] == 0))
            return false;
    for (size_t k = 0; k < NUMBERS; k++) {
        min[k % 3] = lesser_of(min[k % 3], range.min[k]);
        max[k % 3] = larger_of(max[k % 3], range.max[k]);
    }
    return true;
}

/* The same for floats. */
#define FLOAT_GROUP ((size_t)16)
#define FLOATS (3 * FLOAT_GROUP)

typedef struct float_range {
    float min[FLOATS], max[FLOATS], zero[FLOATS];
} float_range;

static void widen_float_group(const unsigned char *restrict from, float_range *restrict range)
{
    for (size_t k = 0; k < FLOATS; k++) {
        const float value = load_float(from + 4 * k);
        range->min[k] = value < range->min[k] ? value : range->min[k];
        range->max[k] = value > range->max[k] ? value : range->max[k];
        range->zero[k] += 0 * value;
    }
}

static bool widen_floats(const unsigned char *from, size_t count, double min[3], double max[3])
{
    float_range range = {{0}, {0}, {0}};
    unsigned char last[4 * FLOATS];
    size_t first = 0;
    if (count == 0)
        return true;
    for (size_t k = 0; k < FLOATS; k++)
        range.min[k] = range.max[k] = load_float(from + 4 * (k % 3));
    for (; first + FLOAT_GROUP <= count; first += FLOAT_GROUP)
        widen_float_group(from + 12 * first, &range);
    for (size_t i = 0; i < FLOAT_GROUP; i++)
        memcpy(last + 12 * i, from + 12 * (first + i < count ? first + i : count - 1), 12);
    widen_float_group(last, &range);
    for (size_t k = 0; k < FLOATS; k++)
        if (!(range.zero[k] == 0))
            return false;
    for (size_t k = 0; k < FLOATS; k++) {
        min[k % 3] = lesser_of(min[k % 3], range.min[k]);
        max[k % 3] = larger_of(max[k % 3], range.max[k]);
    }
    return true;
}

/* What can happen to a number: it gets another value; the value is NaN or too large. */
enum { OTHER = 1, UNFIT = 2 };

/* first: index of the first point of the group. */
static void displace_group(const double *restrict vectors, double largest, size_t first,
                           double *restrict numbers, uint8_t *restrict changed, size_t *unfit)
{
    int64_t fates[NUMBERS], all = 0;
    for (size_t k = 0; k < NUMBERS; k++) { /* masks of whole numbers, so that compilers vectorise */
        const double sum = numbers[k] + vectors[k], moved = vectors[k] != 0 ? sum : numbers[k];
        const int64_t is_added = vectors[k] != 0 ? -1 : 0, is_new = moved != numbers[k] ? -1 : 0;
        const int64_t fits = fabs(moved) <= largest ? -1 : 0;
        fates[k] = is_added & is_new & (OTHER | (~fits & UNFIT));
        all |= fates[k];
        numbers[k] = moved;
    }
    for (size_t i = 0; i < GROUP; i++)
        changed[i] = (uint8_t)((fates[3 * i] | fates[3 * i + 1] | fates[3 * i + 2]) & OTHER);
    for (size_t k = NUMBERS; k-- > 0 && (all & UNFIT);)
        if ((fates[k] & UNFIT) && first + k / 3 < *unfit)
            *unfit = first + k / 3;
}

static size_t displace(const double *vectors, size_t count, double largest, double *points, uint8_t *changed)
{
    double last_vectors[NUMBERS] = {0}, last[NUMBERS] = {0};
    uint8_t last_changed[GROUP];
    size_t first = 0, unfit = count;
    for (; first + GROUP <= count; first += GROUP)
        displace_group(vectors + 3 * first, largest, first, points + 3 * first, changed + first, &unfit);
    const size_t left = count - first;
    memcpy(last_vectors, vectors + 3 * first, 3 * left * sizeof *last);
    memcpy(last, points + 3 * first, 3 * left * sizeof *last);
    displace_group(last_vectors, largest, first, last, last_changed, &unfit);
    memcpy(points + 3 * first, last, 3 * left * sizeof *last);
    memcpy(changed + first, last_changed, left);
    return unfit;
}

const array_kernel FFD_ARRAY_KERNEL = {read_floats, read_u32, span,         magnitude, round_to_floats,
                                       add,         widen,    widen_floats, displace};
